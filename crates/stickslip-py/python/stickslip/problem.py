"""Problems: what is solved."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional, Union

from . import _core, _laws
from ._laws import Laws
from .mesh import Mesh
from .simulation import Simulation


class Problem:
    """A problem: bodies, what holds and loads them, interfaces, steps, solver, output.

    It is made by `from_toml`, `from_dict` or `from_inp`. All of them go through the same checks: keys, types and defaults are those of
    the problem file (`stickslip.schema()`).

    It can be pickled, with the meshes it was given; files that it names have to be there when it is built.
    """

    def __init__(self, core: _core.Problem) -> None:
        self._core = core

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._core.state(),)

    @classmethod
    def from_toml(cls, source: Union[str, os.PathLike[str]], meshes: Optional[Mapping[str, Mesh]] = None) -> Problem:
        """From a problem file, or from its text.

        A path object, or a string without line breaks that ends with ``.toml`` or has no ``=`` in it, is taken as a path. `meshes` are
        found by the names that the problem gives mesh files.

        Raises
        ------
        ProblemError
            With all findings.
        """
        text = os.fspath(source)
        named = "\n" not in text and text.strip() != "" and (text.endswith(".toml") or "=" not in text)
        if not isinstance(source, str) or named:
            return cls(_core.Problem.from_file(Path(text), _given(meshes)))
        return cls(_core.Problem.from_text(text, None, _given(meshes)))

    @classmethod
    def from_dict(
        cls,
        tables: Mapping[str, Any],
        meshes: Optional[Mapping[str, Mesh]] = None,
        folder: Optional[Union[str, os.PathLike[str]]] = None,
    ) -> Problem:
        """From a dictionary with the tables of a problem file.

        Values may be NumPy arrays and numbers, and paths. ``None`` leaves a key out. `meshes` are found by the names that the problem gives
        mesh files, ``{"gmsh": {"file": "NAME"}}``; other files are looked for in `folder` (default: the working directory).
        """
        place = None if folder is None else Path(folder)
        return cls(_core.Problem.from_dict(dict(tables), place, _given(meshes)))

    @classmethod
    def from_inp(cls, path: Union[str, os.PathLike[str]]) -> Problem:
        """From an input deck of Abaqus or CalculiX.

        `notes` says what was left out or taken differently without changing the answer.

        Raises
        ------
        ProblemError
            With all that is wrong or not supported; its findings have a ``file`` and a ``line``.
        """
        return cls(_core.Problem.from_inp(Path(path)))

    @property
    def notes(self) -> list[str]:
        """What is to be said about the deck that the problem comes from, a sentence each with its file and line."""
        return self._core.notes

    def with_values(self, values: Mapping[str, Any]) -> Problem:
        """The same problem with other values, by the paths of their keys: ``{"interface.base.friction.coulomb.mu": 0.3}``."""
        return Problem(self._core.with_values(dict(values)))

    def to_toml(self) -> str:
        """The text of a problem file that gives the same problem."""
        return self._core.to_toml()

    def check(self) -> Report:
        """What the doctor says before the run: bodies, interfaces with their gaps, free motions, findings."""
        text, data = self._core.check()
        return Report(text, json.loads(data))

    def build(self, laws: Optional[Laws] = None, factors: Optional[_core.Factors] = None) -> Simulation:
        """Reads or makes the meshes, assembles the bodies, and returns what can be run.

        Parameters
        ----------
        laws
            Functions that take the place of the laws of interfaces, for prototypes: ``{"press": {"normal": f, "friction": g}}``.

            ``f(gap)`` returns the pressure [Pa] at gaps [m] (negative: penetration), falling and zero far from the surface, or
            ``(pressure, dpressure)`` with the derivative by the gap [Pa/m]. ``g(pressure, speed)`` returns the limit of the shear traction
            [Pa] at pressures [Pa] and sliding speeds [m/s], or ``(limit, dlimit_dpressure, dlimit_dspeed)``. Arguments and results are
            arrays of shape ``(points,)``. Functions are called a few times in every iteration with all points of the interface at
            once, and must be functions: the same arguments give the same result. What derivatives they do not return are found by differences.
        factors
            Factors of bodies shared with other simulations, see `sweep`.
        """
        functions = _laws.given(laws)
        return Simulation(self._core.build(factors, functions), self._core, functions)

    def __repr__(self) -> str:
        return "<stickslip.Problem>"


class Report(dict):  # type: ignore[type-arg]
    """What `Problem.check` found, as a dictionary; ``print`` shows it as text."""

    def __init__(self, text: str, data: Mapping[str, Any]) -> None:
        super().__init__(data)
        self.text = text

    def __str__(self) -> str:
        return self.text


def _restored(state: bytes) -> Problem:
    return Problem(_core.Problem.restore(state))


def _given(meshes: Optional[Mapping[str, Mesh]]) -> dict[str, _core.Mesh]:
    return {name: mesh._core for name, mesh in (meshes or {}).items()}
