"""Shapes, rings and directors in space, shown with PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .colloids import ChargedColloid
    from .rods import RodDischarge
    from .scenes import Result

N_SHAPES = 6  # side by side
RING = 0.5  # radius of the tube of a ring, in xi_N


def _plotter(screenshot, shape=(1, 1)):
    import pyvista

    size = (360 * shape[1], 400) if shape[1] > 1 else (900, 700)
    return pyvista.Plotter(off_screen=screenshot is not None, shape=shape, window_size=size, border=False)


def _finish(plotter, screenshot):
    if screenshot is None:
        return plotter.show()
    plotter.screenshot(str(screenshot))
    plotter.close()
    return screenshot


def line(points: np.ndarray, closed: bool, data: dict[str, Any] | None = None):
    """A polyline of PyVista with arrays at its vertices."""
    import pyvista

    n = len(points)
    mesh = pyvista.PolyData(np.asarray(points, float))
    # of a closed one on to the second vertex: no notch where its tube begins
    mesh.lines = np.r_[n + 2, np.arange(n), 0, 1] if closed else np.r_[n, np.arange(n)]
    for name, values in (data or {}).items():
        mesh.point_data[name] = values
    return mesh


def _row(shapes: list[tuple[str, np.ndarray, bool, np.ndarray]], radius: float, screenshot):
    picked = [shapes[k] for k in np.unique(np.linspace(0, len(shapes) - 1, N_SHAPES).astype(int))]
    plotter = _plotter(screenshot, (1, len(picked)))
    most = max(float(np.max(density)) for *_, density in picked)
    for k, (title, points, closed, density) in enumerate(picked):
        plotter.subplot(0, k)
        tube = line(points, closed, {"energy density / E_b h²": density}).tube(radius=radius)
        plotter.add_mesh(tube, clim=(0, most), cmap="inferno", smooth_shading=True, show_scalar_bar=k == len(picked) - 1)
        plotter.add_text(title, font_size=10)
    return _finish(plotter, screenshot)


def show_discharge(run: RodDischarge, screenshot=None):
    """A fibre over its discharge."""
    samples = run.samples
    rows = zip(samples["time"], samples["points"], samples["energy_density"])
    return _row([(f"t = {t:.3g} T_0", x, False, w) for t, x, w in rows], 1.0, screenshot)


def show_result(result: Result, case=None, screenshot=None):
    """A case of a result."""
    if case is None:
        case = 0
    shapes = result.shapes(case)
    if not result.is_colloid:
        radius = 0.5 * result.about(case)["tube"]["contact_diameter"]
        title = lambda s: "charged" if s.time is None else f"t = {s.time:.3g} T_0"
        return _row([(title(s), s.points, s.closed, s.data["energy_density"]) for s in shapes], radius, screenshot)
    row = list(result.columns["case"]).index(result._case(case).name)
    radius = float(result.columns["radius"][row])
    plotter = _particle(radius, screenshot)
    for shape in shapes[:1]:
        plotter.add_mesh(line(shape.points, True).tube(radius=RING), color="firebrick")
    plane = {k: np.asarray(v) for k, v in result.slices(case).items()}
    charged = np.isnan(plane["time"])
    at = np.column_stack([plane["x"], 0 * plane["x"], plane["z"]])[charged]
    director = np.column_stack([plane[f"n{a}"] for a in "xyz"])[charged]
    _rods(plotter, at, director, plane["order"][charged], radius)
    return _finish(plotter, screenshot)


def show_charged(charged: ChargedColloid, screenshot=None):
    """A charged colloid."""
    plotter, ring = _particle(charged.radius, screenshot), charged.ring()
    if ring is not None:
        plotter.add_mesh(line(ring.points, True).tube(radius=RING), color="firebrick")
    fields = charged.fields
    x, y, z = fields.axes
    middle = len(y) // 2
    at = np.stack(np.meshgrid(x, [0.0], z, indexing="ij"), -1).reshape(-1, 3)
    director, fluid = fields.director[:, middle].reshape(-1, 3), fields.fluid[:, middle].reshape(-1)
    order = fields.order[:, middle].reshape(-1)
    _rods(plotter, at[fluid], director[fluid], order[fluid], charged.radius)
    return _finish(plotter, screenshot)


def show_rings(radius: float, rings: list[tuple[float, np.ndarray]], screenshot=None):
    """A ring as it is drawn in."""
    plotter = _particle(radius, screenshot)
    for k, (_, points) in enumerate(rings):
        shade = 0.2 + 0.8 * k / max(len(rings) - 1, 1)
        plotter.add_mesh(line(points, True).tube(radius=RING), color=(shade, 0.1, 1.0 - shade))
    return _finish(plotter, screenshot)


def _particle(radius: float, screenshot):
    import pyvista

    plotter = _plotter(screenshot)
    plotter.add_mesh(pyvista.Sphere(radius=radius, theta_resolution=60, phi_resolution=60), color="lightgrey", opacity=0.6)
    plotter.view_vector((0.5, -1.0, 0.35))
    return plotter


def _rods(plotter, at: np.ndarray, director: np.ndarray, order: np.ndarray, radius: float) -> None:
    import pyvista

    near = np.linalg.norm(at, axis=1) < 2.2 * radius
    every = max(1, int(np.sqrt(near.sum() / 900)))
    kept = np.flatnonzero(near)[:: every * every]
    points = pyvista.PolyData(at[kept])
    points["director"], points["order S"] = director[kept], order[kept]
    rod = pyvista.Cylinder(radius=0.08, height=1.0, direction=(1, 0, 0))
    glyphs = points.glyph(orient="director", scale=False, factor=0.08 * radius, geom=rod)
    plotter.add_mesh(glyphs, scalars="order S", cmap="viridis")
