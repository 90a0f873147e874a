"""Scenes: what ``topo run`` does, with its results as tables and arrays."""

from __future__ import annotations

import json
import os
import warnings as python_warnings
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from . import _topo, table
from .curves import Curve
from .errors import TopoError, near, refuse
from .progress import Progress, listener

if TYPE_CHECKING:
    from .table import Table


def run(
    scene: str | os.PathLike | Mapping[str, Any],
    *,
    out: str | os.PathLike = "results",
    progress: Progress = True,
    jobs: int | None = None,
    quality: str | None = None,
    accuracy: float | None = None,
    budget: str | None = None,
    cuts: str | list[float] | None = None,
    knots: str | os.PathLike | None = None,
    fields: bool = False,
    fresh: bool = False,
    name: str = "scene",
) -> Result:
    """Runs a scene: charges, cuts or switches, and discharges every case of it.

    The same as ``topo run``, to the byte: results go to a folder of the scene's name below ``out``, finished cases are
    reused, and Ctrl-C keeps what is done.

    Args:
        scene: a TOML file, or a dictionary with the same tables and keys. What is left out, or ``None``, is not modelled.
        out: folder of the results.
        progress: whether to show a bar, or a function that is called with each `Event`.
        jobs: cases at a time; all processors when left out.
        quality: ``"draft"``, ``"standard"``, ``"paper"`` or ``"reference"``, instead of the preset of a fibre's scene.
        accuracy: largest relative error of the discharge times: picks the settings, and estimates each error.
        budget: time that the scene may take, such as ``"10 min"``.
        cuts: where to cut: ``"argmax"``, ``"near-ties"``, ``"all:8"``, or places s/L in [0, 1).
        knots: folder with knots of your own, one TOML file each.
        fields: keep the whole nematic field at each time looked at.
        fresh: compute everything again.
        name: what a dictionary is called in messages; its results go to a folder of this name.

    Returns:
        The results. Cases that failed are in ``failed``, and a warning says so.

    Raises:
        SceneError: with file, line, key, value and remedy.
        KeyboardInterrupt: Ctrl-C; finished cases are kept, and the same call goes on from them.
    """
    text = None
    if isinstance(scene, Mapping):
        text, scene = _topo.scene_text(dict(scene)), Path(f"{name}.toml")
    elif hasattr(scene, "read"):
        raise refuse("scene", scene, "an open file has no place for its results: give its path, or a dictionary")
    if cuts is not None and not isinstance(cuts, str):
        cuts = ",".join(repr(float(s)) for s in cuts)
    if jobs is not None and (not isinstance(jobs, int) or not 1 <= jobs <= 1024):
        raise refuse("jobs", jobs, "give a whole number from 1 to 1024, or leave it out")
    asked = SimpleNamespace(
        path=Path(scene), text=text, out=Path(out), jobs=jobs or 0, fresh=fresh, fields=fields, preset=quality,
        accuracy=accuracy, budget=budget, cuts=cuts, knots=knots and Path(knots),
    )
    heard, end = listener(progress)
    try:
        ran = _topo.run(asked, heard)
    finally:
        end()
    result = Result(Path(ran["folder"]), ran["warnings"], dict(ran["failed"]))
    if result.failed:
        python_warnings.warn(f"{len(result.failed)} cases failed: {next(iter(result.failed.items()))}", stacklevel=2)
    return result


def load(folder: str | os.PathLike) -> Result:
    """The results that a run left in a folder, its own or the program's; computes nothing.

    Args:
        folder: the folder of a scene, such as ``results/my-scene``.
    """
    folder = Path(folder)
    if not (folder / "sweep.csv").is_file():
        scenes = [p.parent.name for p in folder.glob("*/sweep.csv")]
        remedy = f"give one of its scenes: {', '.join(scenes)}" if scenes else "give the folder of a scene that was run"
        raise TopoError(f"{folder} has no results (sweep.csv): {remedy}", file=str(folder), remedy=remedy)
    failed = {}
    if (folder / "failed.csv").is_file():
        columns = table.read(folder / "failed.csv")
        failed = dict(zip(columns["case"], columns["reason"]))
    result = Result(folder, [], failed)
    result.warnings = [w for cell in result.columns.get("warnings", []) for w in str(cell).split(";") if w]
    return result


@dataclass
class Shape:
    """A fibre, or the ring of a colloid, at one time."""

    time: float | None
    """Since the cut or the switch, in T_0 or τ_N; ``None`` while charged."""
    points: np.ndarray
    """Vertices (n, 3), in h or ξ_N."""
    closed: bool
    """Whether its last vertex is joined to its first."""
    cut: float | None = None
    """Place of the cut s/L; ``None`` while closed, and for rings."""
    data: dict[str, np.ndarray] = field(default_factory=dict)
    """Arrays at the vertices: ``energy_density`` (E_b h²) and ``twist`` (θ'h) of a fibre, ``angle`` of a ring's cross-section."""

    @property
    def curve(self) -> Curve:
        """The curve through the vertices."""
        return Curve(self.points, self.closed)


@dataclass
class Result:
    """What a run left behind. It can be pickled: the table goes with it, series and shapes stay in the folder."""

    folder: Path
    warnings: list[str]
    """What is doubtful about the results."""
    failed: dict[str, str]
    """Cases without a result, and why."""
    _columns: dict[str, np.ndarray] | None = field(default=None, repr=False)

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """The table as arrays, one row a discharge."""
        if self._columns is None:
            self._columns = table.read(self.folder / "sweep.csv")
        return self._columns

    @property
    def table(self) -> Table:
        """One row a discharge, as ``sweep.csv``: a pandas DataFrame, or a dictionary of arrays without pandas."""
        return table.frame(self.columns)

    @property
    def is_colloid(self) -> bool:
        """Whether the battery is a colloid."""
        return "f_charged" in self.columns

    @property
    def cases(self) -> list[str]:
        """Names of the cases, each a folder in ``folder``."""
        return list(dict.fromkeys(self.columns["case"]))

    def _case(self, case: str | int | None) -> Path:
        cases = self.cases
        if case is None:
            if len(cases) != 1:
                raise refuse("case", case, f"there are {len(cases)} cases: give a name or a number from 0")
            case = 0
        if isinstance(case, (int, np.integer)):
            if not -len(cases) <= case < len(cases):
                raise refuse("case", case, f"there are {len(cases)} cases, counted from 0")
            case = cases[case]
        if case not in cases:
            raise refuse("case", case, near(case, cases))
        return self.folder / case

    def series(self, case: str | int | None = None, phase: str = "discharge") -> Table:
        """Energies, dissipation and more of a case over time.

        Args:
            case: its name or number.
            phase: ``"discharge"``, or ``"charge"`` of a fibre.
        """
        files = {"discharge": "series.csv", "charge": "charge.csv"}
        if phase not in files or (self.is_colloid and phase == "charge"):
            raise refuse("phase", phase, "give discharge" + ("" if self.is_colloid else " or charge"))
        return table.frame(table.read(self._case(case) / files[phase]))

    def shapes(self, case: str | int | None = None) -> list[Shape]:
        """The fibre, or the ring, of a case: charged first, then at about ten times of each discharge."""
        folder = self._case(case)
        if self.is_colloid:
            return _shapes(table.read(folder / "ring.csv"), ["time"], closed=True)
        charged = _shapes(table.read(folder / "charged.csv"), [], closed=True)
        return charged + _shapes(table.read(folder / "snapshots.csv"), ["cut", "time"], closed=False)

    def slices(self, case: str | int | None = None) -> Table:
        """Order, director and flow of a colloid in the vertical plane through its centre; ``time`` is NaN while charged."""
        if not self.is_colloid:
            raise TopoError("a fibre has no slices: shapes(case) gives its shapes")
        return table.frame(table.read(self._case(case) / "slices.csv"))

    def about(self, case: str | int | None = None) -> dict[str, Any]:
        """All that a case says of itself: settings, versions, counters, energy account."""
        return json.loads((self._case(case) / "run.json").read_text(encoding="utf-8"))

    def plot(self, panel: str | None = None, ax=None):
        """The published panels of the results, drawn with matplotlib.

        Args:
            panel: one of ``released``, ``times``, ``energy``; all that apply when left out.
            ax: axes to draw one panel into.
        """
        from .plots import plot_result

        return plot_result(self, panel, ax)

    def show(self, case: str | int | None = None, screenshot: str | os.PathLike | None = None):
        """The shapes of a case, or its particle, ring and director, with PyVista.

        Args:
            case: its name or number.
            screenshot: a picture to write instead of a window.
        """
        from .view import show_result

        return show_result(self, case, screenshot)

    def __getstate__(self) -> dict:
        return {**self.__dict__, "_columns": self.columns}


def _shapes(columns: dict[str, np.ndarray], by: list[str], closed: bool) -> list[Shape]:
    n = len(columns["x"])
    keys = np.array([columns[name] for name in by], dtype=float).reshape(len(by), n).T
    same = np.isclose(keys[1:], keys[:-1], rtol=0, atol=0, equal_nan=True).all(axis=1)
    starts = np.flatnonzero(np.r_[True, ~same]) if n else []
    shapes = []
    for start, end in zip(starts, [*starts[1:], n]):
        rows = {name: values[start:end] for name, values in columns.items()}
        one = {name: rows[name][0] for name in by}
        known = one.get("time", np.nan)
        points = np.column_stack([rows[c] for c in "xyz"]).astype(float)
        data = {k: v for k, v in rows.items() if k not in ("x", "y", "z", "cut", "time", "line", "closed")}
        time = None if np.isnan(known) else float(known)
        shapes.append(Shape(time, points, closed, one.get("cut"), data))
    return shapes
