"""Curves and knots: measures, names and tight shapes."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from . import _topo
from .errors import TopoError, refuse


def vertices(points: ArrayLike) -> np.ndarray:
    """Vertices as an array of doubles of shape (n, 3); not copied where they are that already."""
    try:
        array = np.ascontiguousarray(points, dtype=float)
    except (TypeError, ValueError) as error:
        raise TopoError(f"points: {error}; give numbers of shape (n, 3), a vertex a row", key="points") from None
    if array.ndim != 2 or array.shape[1] != 3:
        remedy = "give shape (n, 3), a vertex a row"
        if array.ndim == 2 and array.shape[0] == 3:
            remedy += ": transpose the array"
        raise TopoError(f"points of shape {array.shape}: {remedy}", key="points", value=str(array.shape), remedy=remedy)
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        remedy = "check the input"
        message = f"points: vertex {bad[0]} is {array[bad[0]].tolist()}, not finite ({len(bad)} of {len(array)}): {remedy}"
        raise TopoError(message, key="points", value=str(array[bad[0]].tolist()), remedy=remedy)
    return array


@dataclass(frozen=True)
class KnotType:
    """The knot type of a curve, as far as its invariants tell."""

    name: str | None
    """The name with its hand, ``m3_1`` for the mirror image of ``3_1``; ``None`` if several fit or none."""
    candidates: list[str]
    """All names that fit."""
    certain: bool
    """Whether the name is proved."""
    handedness: str
    """Which hand it has."""
    crossings: int
    """Crossings of the simplest diagram found."""
    determinant: int
    """|Δ(−1)| of the Alexander polynomial."""
    signature: int
    """Signature, -2 for the right-handed trefoil."""
    alexander: str
    """Coefficients of the Alexander polynomial."""
    jones: str | None
    """Jones polynomial, where it was computed."""
    description: str
    """The finding as a sentence."""
    closures: list[tuple[str, float]]
    """Of an open curve: each type with its share of the closures, most frequent first."""

    def __str__(self) -> str:
        return self.description


class Curve:
    """A polygon in space, closed or open, in any unit of length.

    Args:
        points: vertices of shape (n, 3); a closed curve does not repeat its first one.
        closed: whether the last vertex is joined to the first.
    """

    def __init__(self, points: ArrayLike, closed: bool = True) -> None:
        self.points = vertices(points)
        self.closed = bool(closed)
        _topo.check(self.points, self.closed)

    @cached_property
    def _measures(self) -> tuple[float, float, float, float, float]:
        return _topo.measure(self.points, self.closed)

    @property
    def length(self) -> float:
        """Length."""
        return self._measures[0]

    @property
    def writhe(self) -> float:
        """Writhe."""
        return self._measures[1]

    @property
    def average_crossing_number(self) -> float:
        """Average crossing number."""
        return self._measures[2]

    @property
    def thickness(self) -> float:
        """Radius of the thickest tube around the curve that does not touch itself."""
        return self._measures[3]

    @property
    def ropelength(self) -> float:
        """Length over thickness."""
        return self._measures[4]

    @classmethod
    def read(cls, path: str | os.PathLike) -> Curve:
        """The curve of a file of coordinates (CSV, XYZ, VECT, Numpy's .npy): the first one if there are several."""
        if hasattr(path, "read"):
            state = "closed" if getattr(path, "closed", False) else "open"
            raise refuse("path", path, f"this is an {state} file: give its path".replace("an closed", "a closed"))
        path = Path(path)
        if path.suffix == ".npy":
            return cls(np.load(path))
        points, closed = _topo.read_curves(path)[0]
        return cls(points, closed)

    def resampled(self, edges: int) -> Curve:
        """The same curve with so many equal edges."""
        return Curve(_topo.resampled(self.points, self.closed, edges), self.closed)

    def mirrored(self) -> Curve:
        """The mirror image in the plane z = 0."""
        return Curve(self.points * [1.0, 1.0, -1.0], self.closed)

    def identify(self, closures: int = 100, seed: int = 1, knots: str | os.PathLike | None = None) -> KnotType:
        """The knot type. An open curve is closed along so many directions; a name then has more than half of them.

        Args:
            closures: directions along which an open curve is closed.
            seed: turns these directions.
            knots: folder with knots of your own.
        """
        found = _topo.identify(self.points, self.closed, closures, seed, knots and Path(knots))
        return KnotType(**found)

    @property
    def centreline(self) -> np.ndarray:
        """The points that a rod starts from."""
        return self.points

    def __len__(self) -> int:
        return len(self.points)

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        return np.array(self.points, dtype=dtype, copy=bool(copy))

    def __repr__(self) -> str:
        kind = "closed" if self.closed else "open"
        return f"Curve({len(self)} vertices, {kind}, length {self.length:.6g}, writhe {self.writhe:.4f})"


class TightKnot(Curve):
    """A knot pulled tight, in units of the radius of its tube, with what was checked on the curve itself."""

    def __init__(self, said: dict) -> None:
        super().__init__(said["points"])
        self.name: str = said["name"]
        self.length_over_radius: float = said["length_over_radius"]
        """Ropelength of the tight knot, in tube radii."""
        self.certificate: dict = {k: v for k, v in said.items() if k not in ("points", "centreline", "name")}
        """thickness, writhe, n_struts, n_kinks, residual of the force balance, converged."""
        self._centreline: np.ndarray = said["centreline"]

    @property
    def centreline(self) -> np.ndarray:
        """The curve after two passes of a binomial filter, as a rod starts from it: a tight curve has jumps of curvature."""
        return self._centreline

    def __repr__(self) -> str:
        return f"TightKnot({self.name}, {len(self)} vertices, L/h = {self.length_over_radius:.3f})"


class Knot:
    """A knot of the table, by its Rolfsen name: ``"3_1"``, its mirror image ``"m3_1"``, a sum ``"3_1#4_1"``.

    Args:
        name: the name, or an alias such as ``"trefoil"``.
        knots: folder with knots of your own, one TOML file each.
    """

    def __init__(self, name: str, knots: str | os.PathLike | None = None) -> None:
        self._folder = knots and Path(knots)
        said = _topo.knot(str(name), self._folder)
        self.name: str = said["name"]
        """Its name in the table."""
        self.crossing_number: int = said["crossing_number"]
        """Least number of crossings of a diagram."""
        self.braid: list[int] = said["braid"]
        """A braid word whose closure it is."""
        self.amphichiral: bool = said["amphichiral"]
        """Whether the knot equals its mirror image."""
        self.determinant: int = said["determinant"]
        """|Δ(−1)| of the Alexander polynomial."""
        self.signature: int = said["signature"]
        """Signature, -2 for the right-handed trefoil."""
        self.alexander: str = said["alexander"]
        """Coefficients of the Alexander polynomial."""
        self.length_over_radius: float | None = said["length_over_radius"]
        """Published ropelength, in tube radii; ``None`` where none is."""

    def tight(self, quality: str = "draft", cache: str | os.PathLike | None = None) -> TightKnot:
        """Pulls the knot tight.

        Args:
            quality: ``"draft"`` (within half a percent of the tight length), ``"standard"`` or ``"paper"``.
            cache: folder where the shape is kept and looked for, such as ``results/knots/cache``.
        """
        return TightKnot(_topo.tight(self.name, quality, self._folder, cache and Path(cache)))

    def __repr__(self) -> str:
        return f"Knot({self.name!r})"


def identify(points: ArrayLike, closed: bool = True, **options) -> KnotType:
    """The knot type of the curve through points of shape (n, 3); options as `Curve.identify`."""
    return Curve(points, closed).identify(**options)


def knots(crossings: int = 8, folder: str | os.PathLike | None = None) -> list[str]:
    """Names of the prime knots of at most so many crossings, and of those of a folder."""
    return _topo.knots(crossings, folder and Path(folder))
