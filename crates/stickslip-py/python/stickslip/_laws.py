"""Functions that stand for laws, and how they are called: the compiled part does so with the arguments of all points at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Callable, Optional

import numpy as np

#: By interface its functions: ``normal``, ``friction``.
Laws = Mapping[str, Mapping[str, Callable[..., Any]]]


def given(laws: Optional[Laws]) -> dict[str, dict[str, Callable[..., Any]]]:
    """The functions that are given, as the compiled part takes them."""
    return {name: dict(of) for name, of in (laws or {}).items()}


def _numbers(values: Any, count: int, what: str) -> bytes:
    array = np.asarray(values, dtype="<f8")
    if array.ndim == 0:
        array = np.full(count, array)
    if array.shape != (count,):
        raise ValueError(f"{what} has to be of shape ({count},), as the arguments, not {array.shape}")
    return array.tobytes()


def pressures(function: Callable[..., Any], arguments: list[Any]) -> list[bytes]:
    """``function(gap)`` is ``pressure`` or ``(pressure, dpressure/dgap)``."""
    gaps = np.asarray(arguments[0])
    answer = function(gaps)
    if isinstance(answer, tuple):
        value, slope = answer
        return [_numbers(value, len(gaps), "the pressure"), _numbers(slope, len(gaps), "its derivative")]
    return [_numbers(answer, len(gaps), "the pressure")]


def limits(function: Callable[..., Any], arguments: list[Any]) -> list[bytes]:
    """``function(pressure, speed)`` is ``limit`` or ``(limit, dlimit/dpressure, dlimit/dspeed)``."""
    pressure, speed = (np.asarray(a) for a in arguments)
    answer = function(pressure, speed)
    names = ["the limit", "its derivative by pressure", "its derivative by speed"]
    if not isinstance(answer, tuple):
        answer = (answer,)
    elif len(answer) != 3:
        raise ValueError("a friction law returns the limit, or the limit and its derivatives by pressure and by speed")
    return [_numbers(value, len(pressure), name) for value, name in zip(answer, names)]
