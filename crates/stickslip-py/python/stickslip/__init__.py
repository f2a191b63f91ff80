"""Frictional contact of elastic bodies, in 2D and 3D.

>>> import stickslip
>>> problem = stickslip.Problem.from_toml("case.toml")
>>> simulation = problem.build()
>>> for step in simulation:
...     print(step.time, step.row["press.CFN2"])

stickslip knows no units: any consistent set will do, and the units in the documentation say what is multiplied with what.
"""

import copyreg as _copyreg

from . import _core
from ._core import Factors
from ._errors import Error, FileError, Interrupted, MeshError, ProblemError, RunError
from ._functions import schema, set_threads
from ._show import Picture
from ._sweep import sweep
from ._table import Rows, Table
from .mesh import Mesh
from .problem import Problem
from .results import Results, open
from .simulation import Contact, Simulation, Step

__version__: str = _core.VERSION

__all__ = [
    "Contact",
    "Error",
    "Factors",
    "FileError",
    "Interrupted",
    "Mesh",
    "MeshError",
    "Picture",
    "Problem",
    "ProblemError",
    "Results",
    "Rows",
    "RunError",
    "Simulation",
    "Step",
    "Table",
    "open",
    "schema",
    "set_threads",
    "sweep",
]

# Factors are made again where they are missing: what is pickled is that there shall be some.
_copyreg.pickle(Factors, lambda factors: (Factors, ()))


def __dir__() -> list:  # type: ignore[type-arg]
    return [*__all__, "__doc__", "__version__"]
