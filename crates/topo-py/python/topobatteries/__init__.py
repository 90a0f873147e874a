"""Topological batteries: knotted elastic fibres and nematic colloids, charged and discharged.

Two layers. *Scenes* are what the program ``topo`` runs: `run` takes a file or a dictionary and gives a
`Result`. *Objects* are single experiments: `Knot`, `Curve`, `Rod`, `Colloid`.

Units. Fibres: lengths in h, times in T_0 = 2 L η/(h E_b), energies in E_0 = E_b h² L, densities in E_b h².
Colloids: lengths in ξ_N, times in τ_N, energies in L ξ_N.
"""

from ._topo import __version__
from .colloids import ChargedColloid, Colloid, ColloidDischarge, SwitchedColloid
from .curves import Curve, Knot, KnotType, TightKnot, identify, knots
from .errors import KnotError, SceneError, TopoError
from .progress import Event
from .rods import ChargedRod, CutRod, Rod, RodDischarge
from .scenes import Result, Shape, load, run

__all__ = [
    "ChargedColloid", "ChargedRod", "Colloid", "ColloidDischarge", "Curve", "CutRod", "Event", "Knot", "KnotError",
    "KnotType", "Result", "Rod", "RodDischarge", "SceneError", "Shape", "SwitchedColloid", "TightKnot", "TopoError",
    "__version__", "identify", "knots", "load", "run",
]
