"""Functions that stand for laws, and how they are called: the compiled part does so with the arguments of all points at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Callable, Optional

import numpy as np

#: By interface its functions: ``normal``, ``friction``.
Laws = Mapping[str, Mapping[str, Callable[..., Any]]]


def given(laws: Optional[Laws]) -> dict[str, dict[str, Callable[..., Any]]]:
    """The functions that are given, as the compiled part takes them."""
    for name, of in (laws or {}).items():
        for kind, function in of.items():
            if not callable(function):
                raise TypeError(f"laws of {name}: {kind} has to be a function, not {type(function).__name__}")
    return {name: dict(of) for name, of in (laws or {}).items()}


def _called(function: Callable[..., Any]) -> str:
    """How a function is named in messages, with its file and line where they are known."""
    name = getattr(function, "__qualname__", type(function).__name__)
    code = getattr(function, "__code__", None)
    return f"`{name}`" if code is None else f"`{name}` ({code.co_filename}:{code.co_firstlineno})"


def _numbers(function: Callable[..., Any], values: Any, count: int, what: str) -> bytes:
    try:
        array = np.asarray(values, dtype="<f8")
    except (TypeError, ValueError) as error:
        raise TypeError(f"{_called(function)}: {what} has to be numbers: {error}") from None
    if array.ndim == 0:
        array = np.full(count, array)
    if array.shape != (count,):
        raise ValueError(f"{_called(function)}: {what} has to be of shape ({count},), as the arguments, not {array.shape}")
    return array.tobytes()


def pressures(function: Callable[..., Any], arguments: list[Any]) -> list[bytes]:
    """``function(gap)`` is ``pressure`` or ``(pressure, dpressure/dgap)``."""
    gaps = np.asarray(arguments[0])
    answer = function(gaps)
    if isinstance(answer, tuple):
        if len(answer) != 2:
            raise ValueError(f"{_called(function)}: a normal law returns the pressure, or the pressure and its derivative by the gap")
        return [_numbers(function, v, len(gaps), what) for v, what in zip(answer, ["the pressure", "its derivative"])]
    return [_numbers(function, answer, len(gaps), "the pressure")]


def limits(function: Callable[..., Any], arguments: list[Any]) -> list[bytes]:
    """``function(pressure, speed)`` is ``limit`` or ``(limit, dlimit/dpressure, dlimit/dspeed)``."""
    pressure, speed = (np.asarray(a) for a in arguments)
    answer = function(pressure, speed)
    names = ["the limit", "its derivative by pressure", "its derivative by speed"]
    if not isinstance(answer, tuple):
        answer = (answer,)
    elif len(answer) != 3:
        raise ValueError(f"{_called(function)}: a friction law returns the limit, or the limit and its derivatives by pressure and by speed")
    return [_numbers(function, value, len(pressure), name) for value, name in zip(answer, names)]
