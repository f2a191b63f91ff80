"""Functions of the package."""

from __future__ import annotations

import json
from typing import Any

from . import _core


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
