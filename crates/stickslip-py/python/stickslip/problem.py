"""Problems: what is solved."""

from __future__ import annotations

import copy
import difflib
import itertools
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Optional, Union

from . import _core, _laws, _show
from ._core import Factors
from ._errors import FileError, ProblemError
from ._laws import Laws
from .mesh import Mesh
from .simulation import Simulation


class Problem:
    """A problem: bodies, what holds and loads them, interfaces, steps, solver, output.

    It is made by `from_toml`, `from_dict` or `from_inp`. All of them go through the same checks: keys, types and defaults are those of
    the problem file (`stickslip.schema()`).

    Its tables can be read and edited, one by one or by the path of a key; they are checked when the problem is next used:

    >>> problem["interface"]["press"]["friction"] = {"coulomb": {"mu": 0.2}}
    >>> problem["interface.press.friction.coulomb.mu"]
    0.2

    It can be pickled, with the meshes it was given; files that it names have to be there when it is built.
    """

    def __init__(self, core: _core.Problem) -> None:
        # What was checked last, the tables as people edit them, and as they were when they were checked.
        self._checked = core
        self._tables: Optional[dict[str, Any]] = None
        self._seen: Optional[dict[str, Any]] = None
        self._meshes: dict[str, Mesh] = {}

    @property
    def _core(self) -> _core.Problem:
        """The problem as it stands now, checked."""
        if self._tables is not None and _differ(self._tables, self._seen):
            tables, meshes = _named(self._tables, {}, [*self._checked.meshes, *self._meshes], self._meshes)
            self._checked = self._checked.with_tables(tables, _given(meshes))
            self._meshes.update(meshes)
            self._seen = copy.deepcopy(self._tables)
        return self._checked

    @property
    def tables(self) -> dict[str, Any]:
        """The tables of the problem file, with the values that hold where nothing is said. What is changed in them changes the problem."""
        if self._tables is None:
            self._tables = self._checked.tables()
            self._seen = copy.deepcopy(self._tables)
        return self._tables

    def __getitem__(self, key: str) -> Any:
        """A table or a value by its path: ``problem["support"]``, ``problem["step.1.duration"]``, ``problem["step.press.duration"]``.

        Entries of lists are counted from 1 in paths, or called by their name.
        """
        at: Any = self.tables
        for name in self._path(key):
            at = _entry(at, name, key)
        return at

    def __setitem__(self, key: str, value: Any) -> None:
        """Sets a table or a value by its path; tables on the way that are missing are made."""
        *path, last = self._path(key)
        at: Any = self.tables
        for name in path:
            at = at.setdefault(name, {}) if isinstance(at, dict) else _entry(at, name, key)
        if isinstance(at, list):
            _entry(at, last, key)
            at[_position(at, last)] = value
        elif isinstance(at, dict):
            at[last] = value
        else:
            raise KeyError(f"{key}: `{'.'.join(path)}` is no table")

    def __delitem__(self, key: str) -> None:
        """Takes out a table or a value: what is not said has its default."""
        *path, last = self._path(key)
        at: Any = self.tables
        for name in path:
            at = _entry(at, name, key)
        _entry(at, last, key)
        del at[_position(at, last) if isinstance(at, list) else last]

    def __contains__(self, key: object) -> bool:
        try:
            self[str(key)]
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self.tables)

    def _path(self, key: str) -> list[str]:
        return [key] if key in self.tables else key.split(".")

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

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

        Values may be NumPy arrays and numbers, and paths. ``None`` leaves a key out. The builders of `stickslip.tables` are such dictionaries. A mesh of arrays
        stands in its body, ``{"block": {"mesh": mesh, "material": "steel"}}``, or is one of `meshes` and named there, ``{"mesh": {"name": "NAME"}}``. Files are
        looked for in `folder` (default: the working directory).
        """
        place = None if folder is None else Path(folder)
        whole, all_meshes = _named(tables, dict(meshes or {}), [], {})
        problem = cls(_core.Problem.from_dict(whole, place, _given(all_meshes)))
        problem._meshes = all_meshes
        return problem

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

    def build(self, laws: Optional[Laws] = None, factors: Optional[Factors] = None) -> Simulation:
        """Reads or makes the meshes, assembles the bodies, and returns what can be run.

        Parameters
        ----------
        laws
            Functions that take the place of the laws of interfaces, for prototypes: ``{"press": {"normal": f, "friction": g}}``.

            ``f(gap)`` returns the pressure at gaps (negative: penetration), falling and zero far from the surface, or ``(pressure, dpressure)`` with the
            derivative by the gap. ``g(pressure, speed)`` returns the limit of the shear traction at pressures and sliding speeds, or ``(limit,
            dlimit_dpressure, dlimit_dspeed)``. Arguments and results are arrays of one length: a few times in every iteration all points of the interface, and
            now and then a single one. The same arguments have to give the same result. Derivatives that are not returned are found by differences.
        factors
            Factors of bodies shared with other simulations, see `sweep`.
        """
        functions = _laws.given(laws)
        return Simulation(self._core.build(factors, functions), self._core, functions)

    def _told(self) -> list[tuple[str, Any]]:
        tables = self._core.tables()

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

    def _shown(self) -> tuple[str, list[tuple[str, Any]]]:
        """Title and lines; of a problem that was edited and is wrong what is wrong with it."""
        try:
            return self._core.tables().get("title") or "no title", self._told()
        except (ProblemError, TypeError) as error:
            return "not sound", [("edited", line) for line in str(error).splitlines() if line.strip()]

    def __repr__(self) -> str:
        title, rows = self._shown()
        return _show.lines(f"<stickslip.Problem: {title}>", rows)

    def _repr_html_(self) -> str:
        return _show.table(*self._shown())


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


def _differ(tables: Any, seen: Any) -> bool:
    try:
        return bool(tables != seen)
    except ValueError:
        # Arrays among the values have no single answer.
        return True


def _position(entries: list[Any], name: str) -> int:
    """The index of an entry of a list by its number, counted from 1, or by its name."""
    if name.isdigit() and 0 < int(name) <= len(entries):
        return int(name) - 1
    named = (i for i, entry in enumerate(entries) if isinstance(entry, dict) and entry.get("name") == name)
    return next(named, len(entries))


def _entry(at: Any, name: str, key: str) -> Any:
    try:
        return at[_position(at, name) if isinstance(at, list) else name]
    except (KeyError, IndexError, TypeError):
        numbers = [str(i + 1) for i in range(len(at))] if isinstance(at, list) else []
        names = list(at) if isinstance(at, dict) else numbers
        close = difflib.get_close_matches(name, names, n=3, cutoff=0.5) or names[:8]
        there = f"; there is: {', '.join(close)}" if close else ""
        raise KeyError(f"{key}: there is no `{name}`{there}") from None


def _named(
    tables: Mapping[str, Any], meshes: dict[str, Mesh], taken: Iterable[str], known: Mapping[str, Mesh]
) -> tuple[dict[str, Any], dict[str, Mesh]]:
    """The tables with meshes by their names, and the meshes by these names."""
    whole = dict(tables)

    def name(mesh: Mesh, body: str) -> str:
        for there, other in [*meshes.items(), *known.items()]:
            if other is mesh:
                return there
        numbers = itertools.chain([""], (f"-{i}" for i in itertools.count(2)))
        new = next(body + n for n in numbers if body + n not in meshes and body + n not in taken)
        meshes[new] = mesh
        return new

    bodies = whole.get("body")
    if isinstance(bodies, Mapping):
        whole["body"] = dict(bodies)
        for body, table in bodies.items():
            source = table.get("mesh") if isinstance(table, Mapping) else None
            if isinstance(source, Mesh):
                source = {"name": source}
            if isinstance(source, Mapping) and isinstance(source.get("name"), Mesh):
                whole["body"][body] = {**table, "mesh": {**source, "name": name(source["name"], str(body))}}
    return whole, meshes


def _given(meshes: Optional[Mapping[str, Mesh]]) -> dict[str, _core.Mesh]:
    return {name: mesh._core for name, mesh in (meshes or {}).items()}
