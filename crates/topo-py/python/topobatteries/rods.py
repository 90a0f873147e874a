"""The elastic battery: a knotted fibre is twisted, fused, charged, cut and discharged.

Lengths in h, times in T_0 = 2 L η/(h E_b), energies in E_0 = E_b h² L, densities in E_b h².
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from numbers import Real
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

    time: np.ndarray
    """Time at every accepted step (n,)."""
    energy: np.ndarray
    """Elastic energy of a fibre, or free energy of a nematic, at every step (n,)."""
    parts: dict[str, np.ndarray]
    """Energy by part, each (n,)."""
    dissipated: dict[str, np.ndarray]
    """What each channel dissipated so far, each (n,)."""
    stop: str
    """Why it ended."""
    finished: bool
    """Whether that is an end as asked."""
    n_steps: int
    """Steps accepted."""
    n_rejected: int
    """Steps refused."""
    ledger_residual: float
    """What the energy account does not close by, relative."""
    cpu_seconds: float
    """What it took of the processor, on the thread that led it, in seconds."""
    wall_seconds: float
    """What it took by the clock, in seconds: what the call takes beyond that is the package's."""


class _Discharge:
    """When a discharge released its energy; times are in the unit of ``time``."""

    def time_to(self, share: float) -> float | None:
        """Time at which a share of the energy was released; ``None`` if it was not."""
        # a fibre ends without energy, a nematic in its equilibrium
        return _topo.release_time(self.time, self.energy, self.start, getattr(self, "final", 0.0), share)

    @property
    def t50(self) -> float | None:
        """Time at which half of the energy was released."""
        return dict(self.times)[0.5]

    @property
    def t90(self) -> float | None:
        """Time at which 90 % were released."""
        return dict(self.times)[0.9]

    @property
    def t99(self) -> float | None:
        """Time at which 99 % were released."""
        return dict(self.times)[0.99]


@dataclass
class RodRun(Run):
    """A phase of a fibre."""

    samples: dict[str, np.ndarray]
    """At output times: ``time``, ``energy``, ``writhe``, ``total_twist`` (turns), ``n_contacts``, ``min_distance``,
    ``end_to_end``, each (T,); ``points`` (T, n, 3), ``twist`` and ``energy_density`` (T, n)."""
    min_distance_over_contact: float | None
    """Least distance of strands over the contact diameter; ``None`` if none came in reach."""
    link_drift: float | None
    """Largest change of Tw + Wr while closed, in turns."""

    @property
    def series(self) -> Table:
        """The numbers of ``samples`` as a table."""
        return table.frame({k: v for k, v in self.samples.items() if v.ndim == 1})


@dataclass
class RodDischarge(_Discharge, RodRun):
    """The discharge of a cut fibre. Released shares count from the energy before the cut. It can be pickled."""

    at: float
    """Place of the cut s/L."""
    removed: float
    """Energy that the cut itself removed, in E_0."""
    start: float
    """Elastic energy before the cut, in E_0."""
    after_cut: float
    """The same after it."""
    parted: float | None
    """When the tips had parted, in T_0."""
    times: list[tuple[float, float | None]]
    """Shares with the times at which they were released, in T_0."""

    @property
    def t95(self) -> float | None:
        """Time at which 95 % were released."""
        return dict(self.times)[0.95]

    def plot(self, ax=None):
        """Energy by part against time, with matplotlib."""
        from .plots import plot_run

        return plot_run(self, "time after the cut / $T_0$", "energy / $E_0$", ax)

    def show(self, screenshot=None):
        """The fibre at six times, coloured by energy density, with PyVista."""
        from .view import show_discharge

        return show_discharge(self, screenshot)


class _Battery:
    """What is pickled as the arguments it was made of, and made again."""

    _kind: type

    def _make(self, *arguments) -> None:
        self._arguments, self._battery = arguments, self._kind(*arguments)

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in self.__dict__.items() if k != "_battery"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._make(*self._arguments)


class _Here:
    """Something that lives in this process only."""

    def __reduce__(self):
        name = type(self).__name__
        raise TypeError(f"a {name} cannot be pickled: pickle the discharge, or send the {name.replace('Charged', '')} and charge it there")


class Rod(_Battery):
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

    _kind = _topo.RodBattery

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
        if not (isinstance(poisson_ratio, Real) and -1.0 < poisson_ratio <= 0.5):
            raise refuse("poisson_ratio", repr(poisson_ratio), "give a number above -1 and at most 0.5")
        if isinstance(friction, Real):
            friction = {"ratio": friction}
        stiff = {} if contact is True else {"stiffness": contact}
        rod: dict[str, Any] = dict(
            slenderness=slenderness, reading=reading, twist=twist, stretch_ratio=stretch_ratio,
            twist_ratio=1.0 / (1.0 + poisson_ratio), friction=dict(friction) if isinstance(friction, Mapping) else friction,
            contact=stiff if contact is not False and contact is not None else None,
        )
        if edges is not None:
            rod["n_edges"] = edges
        self._make(points, quality, rod, _given(tolerance=tolerance), imperfection, seed)
        self.ropelength: float = self._battery.ropelength
        """Length over thickness of the curve that was given."""
        tube = self._battery.tube
        self.length: float = tube[0]
        """Length L, in h."""
        self.contact_diameter: float = tube[1]
        """Distance below which strands repel each other, in h."""
        self.friction_range: float = tube[2]
        """Distance below which friction acts between strands, in h."""
        self.start_length: float = tube[3]
        """Length of the start curve, in h."""

    @property
    def points(self) -> np.ndarray:
        """Vertices before charging (n, 3), in h."""
        return self._battery.points

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
        return ChargedRod(self._battery.charge(given, observer, _file(checkpoint)))

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
        self.run: RodRun = RodRun(**made.record())
        """How it was charged."""
        last = {k: v[-1] for k, v in self.run.samples.items() if v.ndim == 1}
        self.energy: float = last["energy"]
        """Elastic energy, in E_0."""
        self.writhe: float = last["writhe"]
        """Writhe Wr."""
        self.total_twist: float = last["total_twist"]
        """Twist Tw, in turns."""
        self.points: np.ndarray = made.points
        """Vertices (n, 3), in h."""
        self.twist: np.ndarray = made.twist
        """Twist density θ'h at the vertices."""
        self.energy_density: np.ndarray = made.energy_density
        """Elastic energy per length at the vertices, in E_b h²."""

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
        self.at: float = made.at
        """Place of the cut s/L."""
        self.points: np.ndarray = made.points
        """Vertices of the open fibre (n + 1, 3), in h."""

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
