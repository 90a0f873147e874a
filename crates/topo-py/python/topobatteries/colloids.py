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
from .rods import Observer, Run, _Battery, _Discharge, _file, _given, _Here

if TYPE_CHECKING:
    from .table import Table


@dataclass
class Fields:
    """A nematic on its grid; the arrays are views into memory that was made once."""

    order: np.ndarray
    """Largest eigenvalue of Q (nx, ny, nz)."""
    director: np.ndarray
    """Director with n_z >= 0 (nx, ny, nz, 3)."""
    q_tensor: np.ndarray
    """Five components of Q (nx, ny, nz, 5)."""
    fluid: np.ndarray
    """Whether a cell lies in the fluid (nx, ny, nz)."""
    origin: list[float]
    """Centre of the first cell relative to the particle's, in ξ_N."""
    spacing: float
    """Distance of neighbours, in ξ_N."""

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

    radius: float
    """Mean distance from the axis, in ξ_N."""
    height: float
    """Mean height, in ξ_N."""
    mode: int
    """The strongest mode of the height."""
    amplitude: float
    """Its amplitude, in ξ_N."""
    modes: np.ndarray = field(repr=False)
    """The amplitudes of all modes 1, 2, ..."""
    points: np.ndarray = field(repr=False)
    """Its line (128, 3)."""


@dataclass
class ColloidDischarge(_Discharge, Run):
    """The discharge of a switched colloid. Released shares count down to the energy of equilibrium. It can be pickled."""

    start: float
    """Energy after the switch, in L ξ_N."""
    removed: float
    """What the switch removed, in L ξ_N."""
    final: float
    """Energy of equilibrium, in L ξ_N."""
    final_source: str
    """Where that is known from."""
    stored: float | None
    """What could be released, in L ξ_N."""
    times: list[tuple[float, float | None]]
    """Shares with the times at which they were released, in τ_N."""
    samples: list[dict[str, float | None]]
    """At output times: time, energy, order_parameter, ring_radius, max_speed, flow_correlation."""
    rings: list[tuple[float, np.ndarray]]
    """Times with the points of the ring (128, 3), while there is one."""
    max_speed: float | None
    """Largest speed, in ξ_N/τ_N; ``None`` without flow."""
    fields: Fields
    """The last state."""
    radius: float
    """Of the particle, in ξ_N."""

    @property
    def series(self) -> Table:
        """``samples`` as a table."""
        names = self.samples[0] if self.samples else {}
        columns = {n: np.array([np.nan if s[n] is None else s[n] for s in self.samples], float) for n in names}
        return table.frame(columns)

    @property
    def t999(self) -> float | None:
        """Time at which 99.9 % were released."""
        return dict(self.times)[0.999]

    def plot(self, ax=None):
        """Energy by part against time, with matplotlib."""
        from .plots import plot_run

        return plot_run(self, r"time after the switch / $\tau_N$", r"energy / $L\xi_N$", ax)

    def show(self, screenshot=None):
        """The particle with its ring as it is drawn in, with PyVista."""
        from .view import show_rings

        return show_rings(self.radius, self.rings, screenshot)


class Colloid(_Battery):
    """A sphere between plates whose surface prefers a pattern of topological charge q.

    Args:
        radius: of the particle, in ξ_N.
        q: topological charge.
        spacing: edge of a cell of the grid, in ξ_N.
        tolerance: local error of a step of the discharge.
        precision: ``"double"`` or ``"single"`` for the field while it is discharged.
        more: further keys of a scene's table ``[nematic]``: ``cell``, ``anchoring``, ``boundary``, ``material``, ``field``, ...
    """

    _kind = _topo.ColloidBattery

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
        nematic = dict(radius=radius, spacing=spacing, **more)
        if q is not None:
            if "pattern" in more:
                raise refuse("q", q, "a pattern is given too: q=None with pattern=..., or keep q")
            if q not in range(10_001):
                raise refuse("q", q, "give a whole number from 0 to 10000")
            nematic["pattern"] = {"charge": int(q)}
        self._make(nematic, _given(tolerance=tolerance, precision=precision))
        self.radius, self.q = float(radius), q
        self.warnings: list[str] = self._battery.warnings
        """What is unusual about it, though possible."""
        self.cells: list[int] = self._battery.cells
        """Cells of the grid along x, y, z."""
        self.diffusion_time: float = self._battery.diffusion_time
        """R²/(Γ L), in τ_N."""

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
        return ChargedColloid(self._battery.charge(given, observer, _file(checkpoint)), self.radius)

    def __repr__(self) -> str:
        return f"Colloid(radius {self.radius:g} xi_N, q = {self.q}, cells {self.cells})"


class ChargedColloid(_Here):
    """A charged colloid with its defect ring."""

    def __init__(self, made, radius: float) -> None:
        self._colloid, self.radius = made, radius
        report = made.report()
        self.report: dict[str, Any] = report
        """How it was charged: stop, finished, n_steps, rms_field, energy by part, azimuth, lowest_eigenvalue."""
        self.energy: float = report["energy"]
        """Free energy, in L ξ_N."""
        self.order_parameter: float = report["order_parameter"]
        """Size of the mean horizontal tilt: zero below the buckling."""
        self.state: str | None = report["state"]
        """What is charged: ``"minimum"``, ``"saddle"`` or ``"marginal"``."""

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
        self.energy: float = made.energies[0]
        """Energy after the switch, in L ξ_N."""
        self.removed: float = made.energies[1]
        """What the switch removed, in L ξ_N."""

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
