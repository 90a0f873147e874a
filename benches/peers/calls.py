"""What calls from Python cost: against the work inside of them, and against the program.

    TOPO_PROGRAM=target/release/topo python benches/peers/calls.py [knots [rounds]]

First, objects: the time of `Rod.charge` and `CutRod.discharge` by the clock against that of the computation inside of them.
Then the same sweep of `knots` knots (14 unless said) by the program and by `topobatteries.run`, in turns, `rounds` times each (5), with
tight shapes made before; both compute afresh. To be run on a machine that does nothing else.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import topobatteries as topo

KNOTS = ["3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_1", "7_2", "7_3", "7_4", "7_5", "7_6", "7_7"]


def seconds(call):
    start = time.perf_counter()
    result = call()
    return time.perf_counter() - start, result


def objects(rounds):
    """Share of a call that is not work, in percent: charge and discharge."""
    shares = {"charge": [], "discharge": []}
    start = topo.Knot("3_1").tight()
    for _ in range(rounds):
        rod = topo.Rod(start, twist=1.0, friction=0.1)
        wall, charged = seconds(rod.charge)
        shares["charge"].append((wall, charged.run.wall_seconds))
        wall, run = seconds(charged.cut().discharge)
        shares["discharge"].append((wall, run.wall_seconds))
    for name, pairs in shares.items():
        wall, work = (median(column) for column in zip(*pairs))
        over = median(100 * (w - c) / c for w, c in pairs)
        print(f"{name:<10} {wall:8.4f} s a call, {work:8.4f} s of them the computation: {over:+.2f} %")


def sweeps(knots, rounds, folder):
    """The same scene by the program and by the package, in turns."""
    program = os.environ.get("TOPO_PROGRAM") or sys.exit("TOPO_PROGRAM names no program: cargo build --release -p topo-cli")
    scene = folder / "calls.toml"
    names = ", ".join(f'"{knot}"' for knot in knots)
    scene.write_text(f"[rod]\nknot = [{names}]\ntwist = 1.0\n[rod.contact]\n[rod.friction]\n[discharge]\ncuts = 0.25\n", encoding="utf-8")

    def by_program(out):
        subprocess.run([program, "run", scene, "--out", out], check=True, capture_output=True)

    def by_package(out):
        topo.run(scene, out=out, progress=False)

    first = folder / "first"
    by_program(first)  # with the tight shapes
    taken = {by_program: [], by_package: []}
    for _ in range(rounds):
        for way, times in taken.items():
            out = folder / "again"
            shutil.copytree(first / "knots", out / "knots")
            times.append(seconds(lambda: way(out))[0])
            shutil.rmtree(out)
    program, package = (median(times) for times in taken.values())
    print(f"{len(knots)} knots, median of {rounds}: program {program:.3f} s, package {package:.3f} s, ratio {package / program:.3f}")


if __name__ == "__main__":
    n_knots, n_rounds = (int(word) for word in (sys.argv[1:] + ["14", "5"][len(sys.argv) - 1 :]))
    objects(n_rounds)
    with tempfile.TemporaryDirectory() as place:
        sweeps(KNOTS[:n_knots], n_rounds, Path(place))
