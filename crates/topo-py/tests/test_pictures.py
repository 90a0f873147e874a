"""Panels and views are drawn."""

import numpy as np
import pytest
import topobatteries as topo


@pytest.fixture(autouse=True)
def no_window(request):
    if "plot" in request.node.name:
        pytest.importorskip("matplotlib").use("agg")
    else:
        pytest.importorskip("pyvista")


@pytest.mark.parametrize("which", ["quick", "small"])
def test_panels_are_plotted(which, request, tmp_path):
    result = request.getfixturevalue(which)
    figure = result.plot()
    assert [a.get_xscale() for a in figure.axes[:3]] == ["log", "linear", "linear"]
    stored = figure.axes[0].lines[0].get_ydata()
    assert stored[0] == pytest.approx(1, abs=0.1) and stored[-1] < 0.2
    figure.savefig(tmp_path / "panels.png")
    one = result.plot("times")
    assert len(one.axes) == 1


def is_drawn(path):
    from PIL import Image

    pixels = np.asarray(Image.open(path).convert("L"))
    return (pixels != pixels[0, 0]).mean() > 0.01


@pytest.mark.parametrize("which", ["quick", "small"])
def test_cases_are_shown(which, request, tmp_path):
    request.getfixturevalue(which).show(0, screenshot=tmp_path / "case.png")
    assert is_drawn(tmp_path / "case.png")


def test_a_charged_colloid_is_shown(tmp_path):
    charged = topo.Colloid(radius=5, q=2, spacing=1.0).charge(tolerance=1e-3)
    charged.show(screenshot=tmp_path / "charged.png")
    assert is_drawn(tmp_path / "charged.png")
