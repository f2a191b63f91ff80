"""Frictional contact of elastic bodies, in 2D and 3D.

>>> import stickslip
>>> problem = stickslip.Problem.from_toml("case.toml")
>>> simulation = problem.build()
>>> for step in simulation:
...     print(step.time, step.row["press.CFN2"])

stickslip knows no units: what goes in and what comes out is in those of the problem, which have to be consistent.
"""

import copyreg as _copyreg

from . import _core, tables
from ._core import Factors
from ._errors import Error, FileError, Interrupted, MeshError, ProblemError, RunError
from ._functions import schema, set_threads
from ._options import PlotOptions
from ._show import Picture
from ._summary import Summary
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
    "PlotOptions",
    "Problem",
    "ProblemError",
    "Results",
    "Rows",
    "RunError",
    "Simulation",
    "Step",
    "Summary",
    "Table",
    "open",
    "schema",
    "set_threads",
    "sweep",
    "tables",
]

# Factors are made again where they are missing: what is pickled is that there shall be some.
_copyreg.pickle(Factors, lambda factors: (Factors, ()))


def __dir__() -> list[str]:
    return [*__all__, "__doc__", "__version__"]
