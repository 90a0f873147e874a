"""Reads the files of two exported cases with PyVista and numpy, runs the example of a page, and says what it found as JSON."""

import json
import os
import re
import sys
import warnings
from pathlib import Path

import numpy as np
import pyvista as pv

warnings.filterwarnings("ignore")
fibre, colloid, page = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3])
found = {}

charged = pv.read(fibre / "charged.vtp")
found["fibre_points"] = charged.n_points
found["fibre_arrays"] = sorted(charged.point_data.keys())
found["fibre_length"] = float(charged.length) if charged.n_cells == 0 else float(
    np.linalg.norm(np.diff(charged.points[charged.lines[1:]], axis=0), axis=1).sum())
found["fibre_curvature"] = float(charged["curvature"].mean())
found["contact_diameter"] = float(charged.field_data["contact_diameter"][0])
found["tube_radius"] = float(charged.field_data["tube_radius"][0])

# strands: points of the fibre further apart along it than contact cares for
around = np.r_[charged.points, charged.points[:1]]
fine = np.concatenate([a + (b - a) * np.arange(8)[:, None] / 8 for a, b in zip(around, around[1:])])
arc = np.r_[0, np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))]
length = arc[-1] + np.linalg.norm(fine[-1] - fine[0])
apart = np.abs(arc[:, None] - arc)
apart = np.minimum(apart, length - apart)
distance = np.linalg.norm(fine[:, None] - fine, axis=2)
found["strand_distance"] = float(distance[apart > np.pi / 2 * found["contact_diameter"]].min())

# the example of the page, as it stands there
shown = []
pv.DataSet.plot = lambda self, **options: shown.append((self, options))
example = re.search(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S).group(1)
before = os.getcwd()
os.chdir(fibre)
exec(example, {})
os.chdir(before)
tube, options = shown[0]
found["shown_array"] = options["scalars"] in tube.point_data
far = np.linalg.norm(tube.points[:, None] - charged.points, axis=2).min(axis=1)
found["shown_radius"] = float(np.median(far))

reader = pv.get_reader(fibre / "discharge-1.pvd")
found["fibre_times"] = [float(t) for t in reader.time_values]
reader.set_active_time_value(reader.time_values[-1])
found["last_points"] = reader.read()[0].n_points

z = np.load(fibre / "fibre.npz")
found["npz_same"] = bool(
    np.array_equal(z["charged_points"], charged.points)
    and np.array_equal(z["charged_energy_density"], charged["energy_density"])
    and z["discharge1_points"].shape == (len(reader.time_values), found["last_points"], 3)
    and np.array_equal(z["discharge1_time"], reader.time_values))

field = pv.read(colloid / "field-charged.vti")
found["field_dimensions"] = list(field.dimensions)
found["field_arrays"] = sorted(field.point_data.keys())
n, q, s = field["director"], field["Q"].reshape(-1, 3, 3), field["order"]
fluid = field["fluid"] > 0
found["traceless"] = float(np.abs(np.trace(q, axis1=1, axis2=2)).max())
found["eigen"] = float(np.abs(np.einsum("ijk,ik->ij", q, n) - s[:, None] * n)[fluid].max())
found["unit"] = float(np.abs(np.linalg.norm(n[fluid], axis=1) - 1).max())
found["bulk_order"] = float(s[fluid].max())
reader = pv.get_reader(colloid / "field.pvd")
found["field_times"] = len(reader.time_values)
late = pv.read(colloid / "field-03.vti")
found["speed"] = float(np.linalg.norm(late["velocity"], axis=1).max()) if "velocity" in late.point_data else 0.0
z = np.load(colloid / "field-charged.npz")
found["field_npz_same"] = bool(
    np.array_equal(z["Q"].reshape(-1, 3, 3), q)
    and z["order"].shape == tuple(reversed(field.dimensions))
    and np.allclose(z["origin"], field.origin))

nem = pv.read(colloid / "nemaktis-charged.vti")
qn, mask = nem["Q"], nem["domain_mask"]
found["nemaktis_arrays"] = sorted(nem.point_data.keys())
found["nemaktis_components"] = [nem["n"].shape[1], qn.shape[1]]
found["nemaktis_trace"] = float(np.abs(qn[:, :3].sum(axis=1)).max())
found["nemaktis_mask"] = bool(np.array_equal(mask > 0, fluid))
nn = nem["n"]
qnn = sum(qn[:, k] * nn[:, k] ** 2 for k in range(3)) + 2 * (
    qn[:, 3] * nn[:, 0] * nn[:, 1] + qn[:, 4] * nn[:, 0] * nn[:, 2] + qn[:, 5] * nn[:, 1] * nn[:, 2])
found["nemaktis_order"] = float(np.median(qnn[fluid]))
found["nemaktis_spacing"] = float(nem.spacing[0] / field.spacing[0])

sphere = pv.read(colloid / "particle.vtu")
found["sphere_area"] = float(sphere.extract_surface().area)
found["sphere_unit"] = float(np.abs(np.linalg.norm(sphere["director"], axis=1) - 1).max())
found["line_times"] = len(pv.get_reader(colloid / "lines.pvd").time_values)
found["last_lines"] = pv.read(sorted(colloid.glob("lines-[0-9]*.vtu"))[-1]).n_cells
plane = pv.read(colloid / "plane-charged.vti")
found["plane_dimensions"] = list(plane.dimensions)
z = np.load(colloid / "colloid.npz")
found["plane_same"] = bool(np.array_equal(z["plane_order"][0].ravel(), plane["order"]))
print(json.dumps(found))
