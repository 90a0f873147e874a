"""Objects: single experiments, against what is known of them."""

import pickle
import re
from pathlib import Path

import numpy as np
import pytest
import topobatteries as topo
from conftest import QUICK


def circle(n=100, radius=1.0):
    angle = 2 * np.pi * np.arange(n) / n
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle])


def trefoil(n=200):
    u = 2 * np.pi * np.arange(n) / n
    r = 2 + np.cos(3 * u)
    return np.column_stack([r * np.cos(2 * u), r * np.sin(2 * u), -1.2 * np.sin(3 * u)])


def test_the_unknot_discharges_in_its_exact_time():
    # 4.395152 of the slowest bending times 2 L²η/(π² h² E_b): the series of a cut circle, share 0.99
    run = topo.Rod(topo.Knot("0_1").tight(), edges=400, tolerance=1e-5).charge().cut().discharge()
    assert run.t99 == pytest.approx(4.395152 * 50 / np.pi**2, rel=2e-3)
    assert run.time_to(0.99) == run.t99
    assert run.time_to(0.5) == pytest.approx(0.485414 * 50 / np.pi**2, rel=5e-3)


def test_the_programs_of_the_readme_run(monkeypatch, tmp_path):
    pytest.importorskip("matplotlib").use("agg")
    text = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    first, _, colloid = re.findall(r"```python\n(.*?)```", text, re.S)
    assert len(first.strip().splitlines()) <= 8
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(first, names)
    assert 1 < names["run"].t99 < 100
    exec(colloid.replace("radius=15", "radius=5, spacing=1.0"), names)
    assert names["run"].max_speed > 0


def test_an_experiment_is_the_case_of_a_scene_to_the_bit(quick):
    scene = {**QUICK, "rod": {**QUICK["rod"], "imperfection": 0.0}}
    # neither has a twist modelled
    made = topo.Rod(topo.Knot("3_1").tight(), twist=None, friction=0.1, edges=60, tolerance=4e-3)
    charged = made.charge()
    run = charged.cut().discharge()
    result = topo.run(scene, out=quick.folder.parent, name="plain", progress=False)
    row = {name: values[0] for name, values in result.columns.items()}
    assert (charged.energy, run.t50, run.t99, run.at) == (row["energy"], row["t50"], row["t99"], row["cut"])
    series = result.series()
    assert np.array_equal(run.samples["energy"], series["energy"])
    charged_shape = result.shapes()[0]
    assert np.array_equal(charged.points, charged_shape.points)
    assert np.array_equal(charged.energy_density, charged_shape.data["energy_density"])


def test_energy_is_accounted_for():
    charged = topo.Rod(trefoil(), twist=1.0, edges=60, tolerance=4e-3).charge()
    assert charged.run.link_drift < 1e-9
    run = charged.cut(0.25).discharge(until_released=0.9)
    assert run.at == 0.25 and run.finished and run.ledger_residual < 0.02
    gone = sum(values[-1] for values in run.dissipated.values())
    assert gone == pytest.approx(run.start - run.energy[-1], rel=0.1)
    assert run.samples["points"].shape == (len(run.samples["time"]), 61, 3)


def test_curves_are_measured():
    ring = topo.Curve(circle(400, 3.0))
    assert ring.length == pytest.approx(6 * np.pi, rel=1e-4)
    assert ring.writhe == pytest.approx(0, abs=1e-12)
    assert ring.ropelength == pytest.approx(2 * np.pi, rel=1e-3)
    knot = topo.Curve(trefoil())
    assert knot.mirrored().writhe == pytest.approx(-knot.writhe)
    assert len(knot.resampled(64)) == 64
    points = circle()
    assert topo.Curve(points).points is points or np.shares_memory(topo.Curve(points).points, points)


def test_curves_are_named():
    right = topo.identify(trefoil())
    left = topo.identify(trefoil() * [1, 1, -1])
    assert {right.name, left.name} == {"3_1", "m3_1"}
    assert right.certain and right.determinant == 3
    assert topo.identify(circle()).name == "0_1"
    opened = topo.identify(trefoil()[:-4], closed=False, closures=50)
    assert opened.name == right.name and opened.closures[0][1] > 0.5
    knot = topo.Knot("8_19")
    assert (knot.crossing_number, knot.determinant) == (8, 3)
    assert "7_4" in topo.knots(7) and "8_1" not in topo.knots(7)


def test_tight_knots_have_their_ropelength():
    tight = topo.Knot("3_1").tight()
    assert tight.length_over_radius == pytest.approx(topo.Knot("3_1").length_over_radius, rel=5e-3)
    assert tight.identify().name == "3_1"
    assert tight.thickness == pytest.approx(1, rel=1e-2)
    again = pickle.loads(pickle.dumps(tight))
    assert np.array_equal(again.points, tight.points) and again.name == "3_1"


def test_a_colloid_is_charged_and_discharged_under_observation(tmp_path):
    colloid = topo.Colloid(radius=5, q=2, spacing=1.0, tolerance=1e-3)
    steps, seen = [], []
    charged = colloid.charge(tolerance=1e-4, observer=steps.append, checkpoint=tmp_path / "charge")
    assert charged.report["finished"] and steps and steps[0]["phase"] == "charge"
    ring, fields = charged.ring(), charged.fields
    assert ring.points.shape == (128, 3) and 4 < ring.radius < 9
    assert fields.order.shape == tuple(colloid.cells) and fields.director.shape[-1] == 3
    assert np.allclose(np.linalg.norm(fields.director[fields.fluid], axis=-1), 1)
    run = charged.switch().discharge(until_released=0.9, observer=seen.append)
    assert run.finished and run.t50 < run.t90 and run.time_to(0.9) == run.t90
    assert run.energy[-1] < 0.2 * run.start
    at = [s["time"] for s in seen if s["phase"] == "discharge"]
    assert at == [s["time"] for s in run.samples] and at == sorted(at)
    # the charge has left its result: the same call has it at once
    again = pickle.loads(pickle.dumps(colloid)).charge(tolerance=1e-4, checkpoint=tmp_path / "charge")
    assert again.energy == charged.energy
    assert pickle.loads(pickle.dumps(run)).t90 == run.t90


def test_a_fibre_is_observed_and_goes_on_from_a_checkpoint(tmp_path):
    rod = topo.Rod(trefoil(), twist=1.0, edges=40, tolerance=1e-2)
    seen = []
    charged = rod.charge(duration=0.05, observer=seen.append)
    assert [s["time"] for s in seen] == list(charged.run.samples["time"]) and seen[0]["phase"] == "charge"
    assert np.array_equal(seen[-1]["points"], charged.run.samples["points"][-1])
    whole = charged.cut(0.25).discharge(until_released=0.9)

    class Enough(Exception):
        pass

    def stop(sample):
        if sample["energy"] < 0.5 * whole.start:
            raise Enough

    with pytest.raises(Enough):
        charged.cut(0.25).discharge(until_released=0.9, observer=stop, checkpoint=tmp_path / "discharge")
    assert (tmp_path / "discharge").exists()
    again = []
    rest = charged.cut(0.25).discharge(until_released=0.9, observer=again.append, checkpoint=tmp_path / "discharge")
    assert np.array_equal(rest.energy, whole.energy) and np.array_equal(rest.time, whole.time)
    assert rest.t50 == whole.t50
    # it did not begin again
    assert 0 < len(again) < len(whole.samples["time"])


def test_what_lives_in_one_process_says_so():
    rod = topo.Rod(trefoil(), edges=40, tolerance=1e-2)
    assert pickle.loads(pickle.dumps(rod)).ropelength == rod.ropelength
    with pytest.raises(TypeError, match="send the Rod and charge it there"):
        pickle.dumps(rod.charge(duration=0.01))
