"""The elastic battery: a knotted fibre is twisted, fused, charged, cut and discharged.

Lengths in h, times in T_0 = 2 L η/(h E_b), energies in E_0 = E_b h² L, densities in E_b h².
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from . import _topo, table
from .curves import Curve, Knot, vertices
from .errors import TopoError, refuse

if TYPE_CHECKING:
    from .table import Table

#: A function that looks on: it is called between two steps, on the calling thread, and changes nothing.
Observer = Callable[[dict], object]


@dataclass
class Run:
    """What a phase of an experiment leaves behind."""

    #: Time at every accepted step (n,).
    time: np.ndarray
    #: Elastic energy of a fibre, or free energy of a nematic, at every step (n,).
    energy: np.ndarray
    #: Energy by part, each (n,).
    parts: dict[str, np.ndarray]
    #: What each channel dissipated so far, each (n,).
    dissipated: dict[str, np.ndarray]
    #: Why it ended, and whether that is an end as asked.
    stop: str
    finished: bool
    n_steps: int
    n_rejected: int
    #: What the energy account does not close by, relative.
    ledger_residual: float


@dataclass
class RodRun(Run):
    """A phase of a fibre."""

    #: At output times: ``time``, ``energy``, ``writhe``, ``total_twist`` (turns), ``n_contacts``, ``min_distance``,
    #: ``end_to_end``, each (T,); ``points`` (T, n, 3), ``twist`` and ``energy_density`` (T, n).
    samples: dict[str, np.ndarray]
    #: Least distance of strands over the contact diameter; ``None`` if none came in reach.
    min_distance_over_contact: float | None
    #: Largest change of Tw + Wr while closed, in turns.
    link_drift: float | None

    @property
    def series(self) -> Table:
        """The numbers of ``samples`` as a table."""
        return table.frame({k: v for k, v in self.samples.items() if v.ndim == 1})


@dataclass
class RodDischarge(RodRun):
    """The discharge of a cut fibre. Released shares count from the energy before the cut. It can be pickled."""

    #: Place of the cut s/L.
    at: float
    #: Energy that the cut itself removed, in E_0.
    removed: float
    #: Elastic energy before and after the cut, in E_0.
    start: float
    after_cut: float
    #: When the tips had parted, in T_0.
    parted: float | None
    #: Shares with the times at which they were released.
    times: list[tuple[float, float | None]]

    def time_to(self, share: float) -> float | None:
        """Time at which a share of the stored energy was released, in T_0; ``None`` if it was not."""
        return _topo.release_time(self.time, self.energy, self.start, 0.0, share)

    def _listed(self, share: float) -> float | None:
        return dict(self.times)[share]

    @property
    def t50(self) -> float | None:
        """Time at which half of the energy was released, in T_0."""
        return self._listed(0.5)

    @property
    def t90(self) -> float | None:
        """The same for 90 %."""
        return self._listed(0.9)

    @property
    def t95(self) -> float | None:
        """The same for 95 %."""
        return self._listed(0.95)

    @property
    def t99(self) -> float | None:
        """The same for 99 %."""
        return self._listed(0.99)

    def plot(self, ax=None):
        """Energy by part against time, with matplotlib."""
        from .plots import plot_run

        return plot_run(self, "time after the cut / $T_0$", "energy / $E_0$", ax)

    def show(self, screenshot=None):
        """The fibre at six times, coloured by energy density, with PyVista."""
        from .view import show_discharge

        return show_discharge(self, screenshot)


class _Here:
    """Something that lives in this process only."""

    def __reduce__(self):
        name = type(self).__name__
        raise TypeError(f"a {name} cannot be pickled: pickle the discharge, or send the {name.replace('Charged', '')} and charge it there")


class Rod:
    """A fibre tied into a closed curve, twisted, its ends fused: a battery to be charged.

    What is left out is not modelled, but for contact between strands.

    Args:
        curve: a `TightKnot`, a `Curve`, or points (n, 3), closed, in any unit: the length follows from
            ``slenderness``. A `Knot` is pulled tight first.
        twist: θ'h tied in before the ends are fused; ``None`` models no twist at all.
        friction: η_f/η between strands, such as 0.1, or a dictionary with ``ratio`` and ``range``.
        contact: whether strands repel, or the stiffness k_c in E_b/h³.
        slenderness: L/h.
        reading: how L/h is read for a knot of another ropelength: ``"shrunk"``, ``"hard"``, ``"tight"``, ``"own-length"``.
        poisson_ratio: sets the ratio of twist to bending stiffness, 1/(1 + ν).
        stretch_ratio: E/E_b.
        quality: preset of edges and tolerance: ``"draft"``, ``"standard"``, ``"paper"``, ``"reference"``.
        edges: number of edges instead of the preset's.
        tolerance: local error aimed at, in h, instead of the preset's.
        imperfection: random displacement of the start curve, in h, that breaks its symmetry.
        seed: of the imperfection.
    """

    def __init__(
        self,
        curve: Curve | Knot | ArrayLike,
        *,
        twist: float | None = 0.0,
        friction: float | Mapping[str, Any] | None = None,
        contact: bool | float = True,
        slenderness: float = 50.0,
        reading: str = "shrunk",
        poisson_ratio: float = 0.3,
        stretch_ratio: float = 5.0,
        quality: str = "draft",
        edges: int | None = None,
        tolerance: float | None = None,
        imperfection: float = 0.0,
        seed: int = 1,
    ) -> None:
        if isinstance(curve, Knot):
            curve = curve.tight()
        if isinstance(curve, Curve) and not curve.closed:
            raise refuse("curve", curve, "a battery needs a closed curve: Curve(points, closed=True)")
        points = curve.centreline if isinstance(curve, Curve) else vertices(curve)
        if not -1.0 < poisson_ratio <= 0.5:
            raise refuse("poisson_ratio", poisson_ratio, "give a number above -1 and at most 0.5")
        if isinstance(friction, (int, float)):
            friction = {"ratio": float(friction)}
        stiff = {} if contact is True else {"stiffness": float(contact)}
        rod: dict[str, Any] = dict(
            slenderness=float(slenderness), reading=reading, twist=twist, stretch_ratio=float(stretch_ratio),
            twist_ratio=1.0 / (1.0 + poisson_ratio), friction=friction and dict(friction),
            contact=stiff if contact is not False and contact is not None else None,
        )
        if edges is not None:
            rod["n_edges"] = edges
        accuracy = {} if tolerance is None else {"tolerance": float(tolerance)}
        self._made = (points, quality, rod, accuracy, float(imperfection), seed)
        self._rod = _topo.RodBattery(*self._made)
        #: Length over thickness of the curve that was given.
        self.ropelength: float = self._rod.ropelength
        #: Length L, contact diameter, friction range, and length of the start curve, in h.
        self.length, self.contact_diameter, self.friction_range, self.start_length = self._rod.tube

    @property
    def points(self) -> np.ndarray:
        """Vertices before charging (n, 3), in h."""
        return self._rod.points

    def charge(
        self,
        *,
        duration: float | None = None,
        outputs_per_decade: float | None = None,
        observer: Observer | None = None,
        checkpoint: str | os.PathLike | None = None,
    ) -> ChargedRod:
        """Lets the twisted closed fibre relax.

        Args:
            duration: of the relaxation, in T_0.
            outputs_per_decade: output times a decade of time.
            observer: called at output times with ``phase``, the numbers of `RodRun.samples` and ``points`` (n, 3).
            checkpoint: a file from which the same call goes on after it was stopped; written every 30 s and on Ctrl-C.
        """
        given = _given(duration=duration, outputs_per_decade=outputs_per_decade)
        return ChargedRod(self._rod.charge(given, observer, _file(checkpoint)))

    def __getstate__(self):
        return self._made, {k: v for k, v in self.__dict__.items() if k not in ("_rod", "_made")}

    def __setstate__(self, state) -> None:
        self._made, others = state
        self.__dict__.update(others)
        self._rod = _topo.RodBattery(*self._made)

    def __repr__(self) -> str:
        return f"Rod(L = {self.length:g} h, ropelength {self.ropelength:.3f})"


def _file(checkpoint: str | os.PathLike | None):
    return None if checkpoint is None else (os.fspath(checkpoint), 30.0)


def _given(**settings: Any) -> dict[str, Any]:
    return {k: v for k, v in settings.items() if v is not None}


class ChargedRod(_Here):
    """A charged battery: the relaxed closed fibre, and how it got there."""

    def __init__(self, made) -> None:
        self._rod = made
        #: How it was charged.
        self.run = RodRun(**made.record())
        last = {k: v[-1] for k, v in self.run.samples.items() if v.ndim == 1}
        #: Elastic energy, in E_0.
        self.energy: float = last["energy"]
        self.writhe: float = last["writhe"]
        #: In turns.
        self.total_twist: float = last["total_twist"]
        #: Vertices (n, 3), in h.
        self.points: np.ndarray = made.points
        #: Twist density θ'h at the vertices.
        self.twist: np.ndarray = made.twist
        #: Elastic energy per length at the vertices, in E_b h².
        self.energy_density: np.ndarray = made.energy_density

    @property
    def curve(self) -> Curve:
        """The closed fibre as a curve."""
        return Curve(self.points)

    def cut_candidates(self, share: float = 0.02) -> list[float]:
        """Places s/L where the smoothed energy density is within a share of its maximum, largest first."""
        return self._rod.cut_candidates(share)

    def cut(self, at: float | None = None) -> CutRod:
        """Cuts the fibre at s/L = ``at``, or where its energy density is largest."""
        if not self.run.finished:
            raise TopoError(f"the charge did not finish: {self.run.stop}")
        return CutRod(self._rod.cut(at))

    def __repr__(self) -> str:
        return f"ChargedRod(energy {self.energy:.6g} E_0, writhe {self.writhe:.3f}, twist {self.total_twist:.3f})"


class CutRod(_Here):
    """A fibre that has just been cut."""

    def __init__(self, made) -> None:
        self._rod = made
        #: Place of the cut s/L.
        self.at: float = made.at
        #: Vertices of the open fibre (n + 1, 3), in h.
        self.points: np.ndarray = made.points

    def discharge(
        self,
        *,
        until_released: float | None = None,
        longest: float | None = None,
        outputs_per_decade: float | None = None,
        observer: Observer | None = None,
        checkpoint: str | os.PathLike | None = None,
    ) -> RodDischarge:
        """Lets the open fibre go.

        Args:
            until_released: share of the energy whose release ends the run.
            longest: longest time followed, in T_0.
            outputs_per_decade: output times a decade of time.
            observer: called at output times as that of `Rod.charge`.
            checkpoint: a file, other than that of the charge, from which the same call goes on after it was stopped.
        """
        given = _given(until_released=until_released, longest=longest, outputs_per_decade=outputs_per_decade)
        return RodDischarge(**self._rod.discharge(given, observer, _file(checkpoint)))

    def __repr__(self) -> str:
        return f"CutRod(at s/L = {self.at:.4f})"
