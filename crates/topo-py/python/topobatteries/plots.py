"""Panels of results, drawn with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .errors import refuse

if TYPE_CHECKING:
    from .rods import Run
    from .scenes import Result

MOST_CURVES = 40  # more of them hide each other


def _axes(ax, n: int = 1):
    if ax is not None:
        return ax.figure, [ax]
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, n, figsize=(4.6 * n, 3.4), layout="constrained", squeeze=False)
    return figure, list(axes[0])


def plot_run(run: Run, x: str, y: str, ax=None):
    """Energy by part against time."""
    figure, (ax,) = _axes(ax)
    ax.plot(run.time, run.energy, "k", label="all")
    for name, values in run.parts.items():
        if np.any(values):
            ax.plot(run.time, values, lw=1, label=name)
    first = run.time[run.time > 0]
    ax.set(xscale="log", xlabel=x, ylabel=y, xlim=(first[0], first[-1]) if len(first) else None)
    ax.legend(frameon=False)
    return figure


def plot_result(result: Result, panel: str | None = None, ax=None):
    """The panels of a result."""
    panels = {"released": released, "times": times, "energy": energy}
    if panel is not None and panel not in panels:
        raise refuse("panel", panel, f"give one of {', '.join(panels)}")
    names = [panel] if panel else list(panels)
    figure, axes = _axes(ax, len(names))
    if ax is not None and panel is None:
        raise refuse("panel", panel, f"axes hold one panel: give one of {', '.join(panels)}")
    for name, one in zip(names, axes):
        panels[name](result, one)
    return figure


def _unit(result: Result) -> str:
    return r"\tau_N" if result.is_colloid else "T_0"


def _groups(result: Result) -> dict[str, np.ndarray]:
    """Rows of each line: a knot, or colloids without and with flow."""
    columns = result.columns
    key = columns["flow" if result.is_colloid else "knot"].astype(str)
    return {name: np.flatnonzero(key == name) for name in dict.fromkeys(key)}


def _x(result: Result) -> tuple[np.ndarray, str]:
    if result.is_colloid:
        return result.columns["q"], "topological charge $q$"
    return result.columns["twist"], r"twist $\theta' h$"


def _label(result: Result, name: str) -> str:
    return f"flow {name}" if result.is_colloid else name


def _plain(ax) -> None:
    """Few numbers below, and those of a logarithmic axis beside it without powers."""
    from matplotlib.ticker import LogFormatter

    ax.locator_params(axis="x", nbins=5)
    ax.yaxis.set_major_formatter("{x:g}")
    ax.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))


def released(result: Result, ax) -> None:
    """What is stored over time, of every discharge."""
    final = dict(zip(result.columns["case"], result.columns["f_final"])) if result.is_colloid else {}
    for case in result.cases[:MOST_CURVES]:
        series = result.series(case)
        time, stored = np.asarray(series["time"], float), np.asarray(series["energy"], float) - final.get(case, 0.0)
        cuts = np.asarray(series["cut"], float) if "cut" in series else np.zeros(len(time))
        for cut in np.unique(cuts):
            t, e = time[cuts == cut], stored[cuts == cut]
            ax.plot(t[t > 0], (e / e[0])[t > 0], lw=1, label=case.split("_shrunk")[0])
    ax.set(xscale="log", xlabel=f"time / ${_unit(result)}$", ylabel="stored energy / initial", ylim=(0, 1.02))
    if len(result.cases) <= 8:
        ax.legend(frameon=False, fontsize=7)


def times(result: Result, ax) -> None:
    """Time to release 99 % of the energy of a fibre, 99.9 % of a colloid's."""
    x, label = _x(result)
    column = "t999" if result.is_colloid else "t99"
    y = result.columns[column].astype(float)
    for name, rows in _groups(result).items():
        rows = rows[np.argsort(x[rows], kind="stable")]
        ax.plot(x[rows], y[rows], "o-", ms=3, lw=1, label=_label(result, name))
    share = "99.9" if result.is_colloid else "99"
    ax.set(yscale="log", xlabel=label, ylabel=rf"$t_{{{share}\,\%}}$ / ${_unit(result)}$")
    _plain(ax)
    ax.legend(frameon=False, fontsize=7)


def energy(result: Result, ax) -> None:
    """Stored energy; of colloids the order parameter of buckling too."""
    x, label = _x(result)
    columns = result.columns
    y = columns["f_charged" if result.is_colloid else "energy"].astype(float)
    for name, rows in _groups(result).items():
        rows = rows[np.argsort(x[rows], kind="stable")]
        ax.plot(x[rows], y[rows], "o-", ms=3, lw=1, label=_label(result, name))
    ax.locator_params(axis="x", nbins=5)
    ax.set(xlabel=label, ylabel=r"free energy / $L\xi_N$" if result.is_colloid else "stored energy / $E_0$")
    if result.is_colloid:
        order = ax.twinx()
        order.plot(x, columns["order_parameter"], "s", ms=3, color="C3")
        order.set_ylabel("order parameter of buckling", color="C3")
    else:
        ax.legend(frameon=False, fontsize=7)
