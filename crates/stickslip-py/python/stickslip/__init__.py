"""Frictional contact of elastic bodies, in 2D and 3D.

>>> import stickslip
>>> problem = stickslip.Problem.from_toml("case.toml")
>>> simulation = problem.build()
>>> for step in simulation:
...     print(step.time, step.row["press.CFN2"])

stickslip knows no units: any consistent set will do, and the units in the documentation say what is multiplied with what.
"""

from __future__ import annotations

import json
from typing import Any

from . import _core
from ._errors import Error, FileError, Interrupted, MeshError, ProblemError, RunError
from ._sweep import sweep
from .mesh import Mesh
from .problem import Problem
from .simulation import Contact, Simulation, Step

__version__: str = _core.VERSION

__all__ = [
    "Contact",
    "Error",
    "FileError",
    "Interrupted",
    "Mesh",
    "MeshError",
    "Problem",
    "ProblemError",
    "RunError",
    "Simulation",
    "Step",
    "schema",
    "set_threads",
    "sweep",
]


def schema() -> dict[str, Any]:
    """The JSON schema of problem files and of the dictionaries that `Problem.from_dict` takes."""
    table: dict[str, Any] = json.loads(_core.schema())
    return table


def set_threads(count: int) -> None:
    """Sets the number of threads; all processors if not called. Results do not depend on it.

    Raises ``RuntimeError`` if threads have been used already.
    """
    if not _core.set_threads(count):
        raise RuntimeError("the number of threads has to be set before anything is solved")
