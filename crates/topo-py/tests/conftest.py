"""What tests share: small scenes, and the program whose results are those of the package."""

import os
import subprocess
from pathlib import Path

import pytest
import topobatteries as topo

ROOT = Path(__file__).parents[3]

#: A trefoil, coarse: a fraction of a second.
QUICK = {
    "rod": {"knot": "3_1", "contact": {}, "friction": {"ratio": 0.1}},
    "accuracy": {"edges": 60, "tolerance": 4e-3},
}
#: A small colloid.
SMALL = {
    "nematic": {"radius": 5, "spacing": 1.0, "q": [1, 2]},
    "charge": {"tolerance": 1e-4},
    "discharge": {"until_released": 0.9},
    "accuracy": {"tolerance": 1e-3},
}


@pytest.fixture(scope="session")
def quick(tmp_path_factory):
    """Results of the trefoil."""
    return topo.run(QUICK, out=tmp_path_factory.mktemp("quick"), name="quick", progress=False)


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """Results of the colloid."""
    return topo.run(SMALL, out=tmp_path_factory.mktemp("small"), name="small", progress=False)


@pytest.fixture(scope="session")
def program():
    """Runs the program."""
    path = os.environ.get("TOPO_PROGRAM")
    if not path:
        pytest.skip("TOPO_PROGRAM names no program: cargo xtask test does")

    def run(*arguments):
        return subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)

    return run
