"""The nematic battery: a colloid is charged by a pattern on its surface, switched and discharged.

Lengths in ξ_N, times in τ_N, energies in L ξ_N. Fields have shape (nx, ny, nz, ...), relative to the particle's centre.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _topo, table
from .errors import refuse
from .rods import Observer, Run, _file, _given, _Here

if TYPE_CHECKING:
    from .table import Table


@dataclass
class Fields:
    """A nematic on its grid; the arrays are views into memory that was made once."""

    #: Largest eigenvalue of Q (nx, ny, nz).
    order: np.ndarray
    #: Director with n_z >= 0 (nx, ny, nz, 3).
    director: np.ndarray
    #: Five components of Q (nx, ny, nz, 5).
    q_tensor: np.ndarray
    #: Whether a cell lies in the fluid (nx, ny, nz).
    fluid: np.ndarray
    #: Centre of the first cell relative to the particle's, and distance of neighbours.
    origin: list[float]
    spacing: float

    @classmethod
    def _of(cls, said: dict) -> Fields:
        turned = {name: said[name].transpose(2, 1, 0) for name in ("order", "fluid")}
        turned["director"] = said["director"].transpose(2, 1, 0, 3)
        turned["q_tensor"] = said["q_tensor"].transpose(3, 2, 1, 0)
        return cls(**turned, origin=said["origin"], spacing=said["spacing"])

    @property
    def axes(self) -> list[np.ndarray]:
        """Coordinates of the cells along x, y and z."""
        return [o + self.spacing * np.arange(n) for o, n in zip(self.origin, self.order.shape)]


@dataclass
class Ring:
    """The defect ring around a particle."""

    #: Mean distance from the axis, and mean height, in ξ_N.
    radius: float
    height: float
    #: The strongest mode of the height, its amplitude, and the amplitudes of all modes 1, 2, ...
    mode: int
    amplitude: float
    modes: np.ndarray = field(repr=False)
    #: Its line (128, 3).
    points: np.ndarray = field(repr=False)


@dataclass
class ColloidDischarge(Run):
    """The discharge of a switched colloid. Released shares count down to the energy of equilibrium. It can be pickled."""

    #: Energy after the switch, what the switch removed, that of equilibrium, and what could be released, in L ξ_N.
    start: float
    removed: float
    final: float
    final_source: str
    stored: float | None
    times: list[tuple[float, float | None]]
    #: At output times: time, energy, order_parameter, ring_radius, max_speed, flow_correlation.
    samples: list[dict[str, float | None]]
    #: Times with the points of the ring (128, 3), while there is one.
    rings: list[tuple[float, np.ndarray]]
    #: Largest speed, in ξ_N/τ_N; ``None`` without flow.
    max_speed: float | None
    #: The last state.
    fields: Fields
    radius: float

    @property
    def series(self) -> Table:
        """``samples`` as a table."""
        names = self.samples[0] if self.samples else {}
        columns = {n: np.array([np.nan if s[n] is None else s[n] for s in self.samples], float) for n in names}
        return table.frame(columns)

    def time_to(self, share: float) -> float | None:
        """Time at which a share of the energy was released, in τ_N; ``None`` if it was not."""
        return _topo.release_time(self.time, self.energy, self.start, self.final, share)

    def _listed(self, share: float) -> float | None:
        return dict(self.times)[share]

    @property
    def t50(self) -> float | None:
        """Time at which half of the energy was released, in τ_N."""
        return self._listed(0.5)

    @property
    def t90(self) -> float | None:
        """The same for 90 %."""
        return self._listed(0.9)

    @property
    def t99(self) -> float | None:
        """The same for 99 %."""
        return self._listed(0.99)

    @property
    def t999(self) -> float | None:
        """The same for 99.9 %."""
        return self._listed(0.999)

    def plot(self, ax=None):
        """Energy by part against time, with matplotlib."""
        from .plots import plot_run

        return plot_run(self, r"time after the switch / $\tau_N$", r"energy / $L\xi_N$", ax)

    def show(self, screenshot=None):
        """The particle with its ring as it is drawn in, with PyVista."""
        from .view import show_rings

        return show_rings(self.radius, self.rings, screenshot)


class Colloid:
    """A sphere between plates whose surface prefers a pattern of topological charge q.

    Args:
        radius: of the particle, in ξ_N.
        q: topological charge.
        spacing: edge of a cell of the grid, in ξ_N.
        tolerance: local error of a step of the discharge.
        precision: ``"double"`` or ``"single"`` for the field while it is discharged.
        more: further keys of a scene's table ``[nematic]``: ``cell``, ``anchoring``, ``boundary``, ``material``, ``field``, ...
    """

    def __init__(
        self,
        radius: float = 25.0,
        q: int | None = 1,
        *,
        spacing: float = 1.5,
        tolerance: float = 3e-5,
        precision: str | None = None,
        **more: Any,
    ) -> None:
        nematic = dict(radius=float(radius), spacing=float(spacing), **more)
        if q is not None:
            if "pattern" in more:
                raise refuse("q", q, "a pattern is given too: q=None with pattern=..., or keep q")
            if int(q) != q or not 0 <= q <= 10_000:
                raise refuse("q", q, "give a whole number from 0 to 10000")
            nematic["pattern"] = {"charge": int(q)}
        self.radius, self.q = float(radius), q
        self._made = (nematic, _given(tolerance=float(tolerance), precision=precision))
        self._colloid = _topo.ColloidBattery(*self._made)
        #: What is unusual about it, though possible.
        self.warnings: list[str] = self._colloid.warnings
        #: Cells of the grid along x, y, z.
        self.cells: list[int] = self._colloid.cells
        #: R²/(Γ L), in τ_N.
        self.diffusion_time: float = self._colloid.diffusion_time

    def charge(
        self,
        *,
        tolerance: float | None = None,
        tilts: list[float] | None = None,
        observer: Observer | None = None,
        checkpoint: str | os.PathLike | None = None,
    ) -> ChargedColloid:
        """Lets the nematic relax with the pattern on the particle.

        Args:
            tolerance: root mean square of the molecular field that counts as converged.
            tilts: start fields, tilted by so many radians each: the state of least energy is kept.
            observer: called every few steps with ``phase``, ``step``, ``energy`` and ``rms_field``.
            checkpoint: a file from which the same call goes on after it was stopped; written every 30 s and on Ctrl-C.
        """
        given = _given(tolerance=tolerance, seeds=tilts)
        return ChargedColloid(self._colloid.charge(given, observer, _file(checkpoint)), self.radius)

    def __getstate__(self):
        return self._made, {k: v for k, v in self.__dict__.items() if k not in ("_colloid", "_made")}

    def __setstate__(self, state) -> None:
        self._made, others = state
        self.__dict__.update(others)
        self._colloid = _topo.ColloidBattery(*self._made)

    def __repr__(self) -> str:
        return f"Colloid(radius {self.radius:g} xi_N, q = {self.q}, cells {self.cells})"


class ChargedColloid(_Here):
    """A charged colloid with its defect ring."""

    def __init__(self, made, radius: float) -> None:
        self._colloid, self.radius = made, radius
        report = made.report()
        #: How it was charged: stop, finished, n_steps, rms_field, energy by part, azimuth, lowest_eigenvalue.
        self.report: dict[str, Any] = report
        #: Free energy, in L ξ_N.
        self.energy: float = report["energy"]
        #: Size of the mean horizontal tilt: zero below the buckling.
        self.order_parameter: float = report["order_parameter"]
        #: ``"minimum"``, ``"saddle"`` or ``"marginal"``.
        self.state: str | None = report["state"]

    def ring(self, threshold: float = 0.35) -> Ring | None:
        """The line of lowest order around the particle, of cells whose order is below a threshold; ``None`` without one."""
        found = self._colloid.ring(threshold)
        return found and Ring(**found)

    @property
    def fields(self) -> Fields:
        """Order, director and tensor of every cell."""
        return Fields._of(self._colloid.fields())

    def switch(self, *, ramp: float | None = None, to: dict | str | None = None) -> SwitchedColloid:
        """Switches the anchoring off.

        Args:
            ramp: time over which, in τ_N; at once when left out.
            to: what the surface does then, as ``to`` of a scene's table ``[switch]``.
        """
        return SwitchedColloid(self._colloid.switch(_given(ramp=ramp, to=to)), self.radius)

    def show(self, screenshot=None):
        """The particle, its ring and the director in the vertical plane, with PyVista."""
        from .view import show_charged

        return show_charged(self, screenshot)

    def __repr__(self) -> str:
        return f"ChargedColloid(energy {self.energy:.6g} L xi_N, order parameter {self.order_parameter:.4g}, {self.state})"


class SwitchedColloid(_Here):
    """A colloid whose anchoring has just been switched."""

    def __init__(self, made, radius: float) -> None:
        self._colloid, self.radius = made, radius
        #: Energy after the switch, and what the switch removed, in L ξ_N.
        self.energy, self.removed = made.energies

    def discharge(
        self,
        flow: bool = False,
        *,
        until_released: float | None = None,
        longest: float | None = None,
        outputs_per_decade: float | None = None,
        observer: Observer | None = None,
        checkpoint: str | os.PathLike | None = None,
    ) -> ColloidDischarge:
        """Lets the nematic go.

        Args:
            flow: whether the fluid flows.
            until_released: share of the energy whose release ends the run.
            longest: longest time followed, in R²/(Γ L).
            outputs_per_decade: output times a decade of time, at which the observer looks too.
            observer: called at output times with time, energy, order_parameter, ring_radius, max_speed, and ``ring`` (128, 3).
            checkpoint: a file, other than that of the charge, from which the same call goes on after it was stopped.
        """
        given = _given(until_released=until_released, longest=longest, outputs_per_decade=outputs_per_decade)
        said = self._colloid.discharge(given, bool(flow), observer, _file(checkpoint))
        return ColloidDischarge(**{**said, "fields": Fields._of(said["fields"])}, radius=self.radius)
