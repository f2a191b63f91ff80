"""Problems: what is solved."""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional, Union

from . import _core, _laws, _show
from ._errors import FileError
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

        A path object, or a string without line breaks that names a file, ends with ``.toml`` or has no ``=`` in it, is taken as a path.
        `meshes` are found by the names that the problem gives mesh files.

        Raises
        ------
        ProblemError
            With all findings.
        FileError
            If there is no such file, or it cannot be read.
        """
        text = os.fspath(source)
        if isinstance(source, str) and not _is_path(text):
            return cls(_core.Problem.from_text(text, None, _given(meshes)))
        file = Path(text)
        if not file.exists():
            raise FileError(f"{file}: there is no such file{_beside(file)}", file)
        return cls(_core.Problem.from_file(file, _given(meshes)))

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
        file = Path(path)
        if not file.exists():
            raise FileError(f"{file}: there is no such file{_beside(file)}", file)
        return cls(_core.Problem.from_inp(file))

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

    def _told(self) -> list[tuple[str, Any]]:
        tables = json.loads(self._core.tables())

        def named(key: str) -> str:
            return ", ".join(tables.get(key) or {})

        rows: list[tuple[str, Any]] = [
            ("space", tables["model"]["space"]),
            *((what, named(key)) for what, key in [("bodies", "body"), ("materials", "material"), ("obstacles", "obstacle")]),
        ]
        for name, table in (tables.get("interface") or {}).items():
            laws = [_kind(table[key]) for key in ("normal", "friction", "enforcement") if table.get(key)]
            tied = ["tied"] if table.get("tied") else laws
            rows.append((f"interface {name}", f"{table['secondary']} on {table['primary']}: {', '.join(tied)}"))
        rows += [("loads", named("load")), ("supports", named("support"))]
        steps = tables.get("step") or []
        names = [step.get("name") or f"step {i + 1}" for i, step in enumerate(steps)]
        rows.append(("steps", f"{', '.join(names)}: time 0 to {sum(step['duration'] for step in steps):g}"))
        return rows

    def _title(self) -> str:
        title = json.loads(self._core.tables()).get("title")
        return title or "no title"

    def __repr__(self) -> str:
        return _show.lines(f"<stickslip.Problem: {self._title()}>", self._told())

    def _repr_html_(self) -> str:
        return _show.table(self._title(), self._told())


class Report(dict):  # type: ignore[type-arg]
    """What `Problem.check` found, as a dictionary; ``print`` shows it as text."""

    def __init__(self, text: str, data: Mapping[str, Any]) -> None:
        super().__init__(data)
        self.text = text

    def __str__(self) -> str:
        return self.text


def _kind(table: Any) -> str:
    """The kind of a model and what it is given: ``coulomb(mu=0.3)``."""
    if not isinstance(table, dict):
        return str(table)
    kind, values = next(iter(table.items()))
    given = [f"{k}={v:g}" for k, v in values.items() if isinstance(v, (int, float)) and not isinstance(v, bool)]
    return f"{kind}({', '.join(given)})" if given else str(kind)


def _is_path(text: str) -> bool:
    if "\n" in text or not text.strip():
        return False
    try:
        there = os.path.exists(text)
    except ValueError:
        there = False
    return there or text.endswith(".toml") or "=" not in text


def _beside(file: Path) -> str:
    """What is there under a name that comes near, or the folder that is missing."""
    if not file.parent.is_dir():
        return f": there is no folder {file.parent}"
    ending = file.suffix or ".toml"
    names = [path.name for path in file.parent.iterdir() if path.suffix == ending]
    close = difflib.get_close_matches(file.name, names, n=3, cutoff=0.6)
    return f"; near: {', '.join(close)}" if close else ""


def _restored(state: bytes) -> Problem:
    return Problem(_core.Problem.restore(state))


def _given(meshes: Optional[Mapping[str, Mesh]]) -> dict[str, _core.Mesh]:
    return {name: mesh._core for name, mesh in (meshes or {}).items()}
