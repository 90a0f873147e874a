"""Scenes: the results of the program, to the byte."""

import os
import pickle
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import topobatteries as topo
from conftest import QUICK, ROOT, SMALL

FEW = ["3_1", "m3_1"]
ALL = ["3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_1", "7_2", "7_3", "7_4", "7_5", "7_6", "7_7"]
LONG = pytest.mark.skipif("TOPO_LONG" not in os.environ, reason="long: cargo xtask test --long")


def test_tables_series_and_shapes(quick):
    assert len(quick.cases) == 1 and quick.cases[0].startswith("3_1_untwisted_shrunk_n60")
    assert 1 < quick.columns["t99"][0] < 100
    # not the number 31
    assert list(quick.columns["knot"]) == ["3_1"]
    assert len(quick.table["t99"]) == 1
    series = quick.series()
    assert list(series["time"]) == sorted(series["time"]) and series["energy"][0] > 0
    assert quick.series(0, "charge")["time"][0] == 0
    shapes = quick.shapes()
    assert shapes[0].time is None and shapes[0].closed and shapes[1].cut is not None
    times = [s.time for s in shapes[1:]]
    assert times == sorted(times) and len(times) > 5
    assert shapes[0].curve.identify().name == "3_1"
    assert quick.about()["schema"] == "topo-elastic-case/1"


def test_a_colloids_rings_and_slices(small):
    assert small.is_colloid and list(small.columns["q"]) == [1, 2]
    ring = small.shapes(0)[0]
    assert ring.time is None and ring.points.shape[1] == 3
    assert len(np.unique(small.slices(1)["x"])) > 10


@pytest.mark.parametrize("knots", [FEW, pytest.param(ALL, marks=LONG)], ids=["few", "fourteen"])
def test_knots_are_those_of_the_program_to_the_byte(knots, program, tmp_path):
    scene = {**QUICK, "rod": {**QUICK["rod"], "knot": knots}}
    (tmp_path / "tied.toml").write_text(topo._topo.scene_text(scene), encoding="utf-8")
    said = program("run", tmp_path / "tied.toml", "--out", tmp_path / "a")
    assert said.returncode == 0, said.stderr
    shutil.copytree(tmp_path / "a/knots", tmp_path / "b/knots")
    topo.run(tmp_path / "tied.toml", out=tmp_path / "b", progress=False)
    result = topo.load(tmp_path / "b/tied")
    assert sorted(result.columns["knot"]) == sorted(knots)
    compared = program("compare", tmp_path / "a", tmp_path / "b")
    assert compared.returncode == 0, compared.stdout


def test_a_colloid_is_that_of_the_program_to_the_byte(program, small, tmp_path):
    (tmp_path / "small.toml").write_text(topo._topo.scene_text(SMALL), encoding="utf-8")
    said = program("run", tmp_path / "small.toml", "--out", tmp_path)
    assert said.returncode == 0, said.stderr
    compared = program("compare", tmp_path / "small", small.folder)
    assert compared.returncode == 0, compared.stdout


def test_finished_cases_are_reused_and_events_told(quick):
    events = []
    again = topo.run(QUICK, out=quick.folder.parent, name="quick", progress=events.append)
    assert again.columns["t99"][0] == quick.columns["t99"][0]
    assert [e.kind for e in events] == ["begin"] and events[0].done == events[0].total == 1
    events.clear()
    topo.run(QUICK, out=quick.folder.parent, name="quick", progress=events.append, fresh=True)
    assert [e.kind for e in events if e.kind != "working"] == ["begin", "knot", "case"]


def test_results_are_loaded_and_pickled(quick, tmp_path):
    loaded = topo.load(quick.folder)
    assert loaded.cases == quick.cases
    moved = pickle.loads(pickle.dumps(quick))
    assert moved.columns["t99"][0] == quick.columns["t99"][0] and moved.folder == quick.folder
    assert loaded.warnings == quick.warnings and not loaded.failed


def test_what_a_scene_asks_for_can_be_given(tmp_path, quick):
    shutil.copytree(quick.folder.parent / "knots", tmp_path / "knots")
    result = topo.run(QUICK, out=tmp_path, name="cuts", cuts=[0.1, 0.6], jobs=1, progress=False)
    assert list(np.round(result.columns["cut"], 1)) == [0.1, 0.6]
    fine = {**QUICK, "accuracy": {"edges": 60}}
    result = topo.run(fine, out=tmp_path, name="fine", quality="standard", cuts="argmax", progress=False)
    assert result.columns["tolerance"][0] == 5e-4


def test_an_exception_of_the_callers_stops_the_run(tmp_path):
    def refuse(event):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        topo.run(SMALL, out=tmp_path, progress=refuse)


SLOW = """
import sys, topobatteries as topo
scene = {"rod": {"knot": "3_1", "twist": {"from": 0.1, "to": 2.0, "n": 40}, "contact": {}}, "accuracy": {"edges": 60}}
def heard(event):
    if event.kind == "case" and event.done == 2:
        print("now", flush=True)
topo.run(scene, out=sys.argv[1], name="slow", jobs=1, progress=heard)
"""
HELD = """
import topobatteries as topo
battery = topo.Rod(topo.Knot("0_1").tight(), twist=2.0, edges=2000, tolerance=1e-7)
print("now", flush=True)
battery.charge(duration=1000)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX has them")
@pytest.mark.parametrize("script", [SLOW, HELD], ids=["scene", "object"])
def test_ctrl_c_stops_at_once_and_keeps_what_is_done(script, tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", script, str(tmp_path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "now\n", process.stderr.read()
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    start = time.monotonic()
    _, said = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in said and process.returncode != 0
    # minutes without the interrupt
    assert time.monotonic() - start < 30
    if script is SLOW:
        assert "the same call goes on from them" in said
        assert 2 <= len(topo.load(tmp_path / "slow").columns["t99"]) < 40


def test_importing_needs_numpy_only():
    code = "import sys, topobatteries; print([m for m in ('pandas', 'matplotlib', 'pyvista', 'tqdm') if m in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert said.stdout.strip() == "[]", said.stderr
