"""Simulations: problems being run, and what comes of them."""

from __future__ import annotations

import json
import logging
import os
import pickle
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Literal, Optional, Protocol, Union

import numpy as np

from . import _core, _laws, _show
from ._laws import Laws
from ._progress import progress as _progress
from ._show import Picture
from ._table import Table
from .mesh import _KINDS

if TYPE_CHECKING:
    import pyvista
    from typing_extensions import Unpack

    from ._options import PlotOptions
    from ._summary import Summary


#: What a picture calls a problem without a title.
_NAME = "simulation"
_log = logging.getLogger("stickslip")


class _Owner(Protocol):
    """A simulation, or results in a folder: what the points of an interface belong to."""

    @property
    def problem(self) -> Any: ...

    def plot(self, field: Optional[str] = None, ending: Literal["png", "svg"] = "png", **options: Unpack[PlotOptions]) -> Picture: ...

    def _body(self, interface: str) -> Optional[str]: ...


class _OfProblem(Protocol):
    """A `Problem`, which makes simulations and so knows them; they know what is behind it."""

    @property
    def _core(self) -> _core.Problem: ...


@dataclass(frozen=True)
class Step:
    """An accepted increment."""

    #: Its end.
    time: float
    #: Name of the step of the analysis that it belongs to.
    name: str
    #: Its number in that step, from 1.
    increment: int
    #: Attempts it took.
    attempt: int
    #: Newton iterations.
    iterations: int
    #: Contact points that are open.
    open: int
    #: Contact points that stick.
    stick: int
    #: Contact points that slip.
    slip: int
    #: The row of the history: resultants of interfaces, reactions of supports, energies, probes, by name.
    row: dict[str, float] = field(repr=False)


class Contact:
    """The points of the secondary of an interface at one increment. All arrays have one entry a point."""

    def __init__(
        self, columns: dict[str, np.ndarray], dim: int, name: str = "", owner: Optional[_Owner] = None, time: float = 0.0
    ) -> None:
        #: Name of the interface.
        self.name = name
        #: Time of the increment.
        self.time = time
        self._columns = columns
        self._dim = dim
        self._owner = owner

    def __getstate__(self) -> dict[str, Any]:
        # What it belongs to may be large, and is needed for pictures only.
        return {**self.__dict__, "_owner": None}

    @_show.with_options
    def plot(self, field: str = "CPRESS", ending: Literal["png", "svg"] = "png", **options: Unpack[PlotOptions]) -> Picture:
        """The picture that ``stickslip plot`` draws of a field of contact, which Jupyter shows. See `Simulation.plot`.

        In space the body of the secondary is drawn alone, as the other one would hide the surface; ``bodies="NAME"`` chooses another.

        Raises
        ------
        RuntimeError
            If the simulation has gone on since.
        """
        if self._owner is None:
            raise RuntimeError(f"interface `{self.name}`: what has been pickled has no bodies to be drawn; ask the simulation again")
        if isinstance(self._owner, Simulation) and self._owner.time != self.time:
            raise RuntimeError(
                f"interface `{self.name}`: these are the points at time {self.time:g}, and the simulation has gone on: ask it again"
            )
        body = self._owner._body(self.name)
        if self._dim == 3 and body is not None:
            options.setdefault("bodies", body)
        return self._owner.plot(field, ending, **options)

    def _told(self) -> list[tuple[str, Any]]:
        status = self.status
        counts = [f"{int((status == i).sum())} {word}" for i, word in [(1, "stick"), (2, "slip"), (0, "open")]]
        rows: list[tuple[str, Any]] = [("time", f"{self.time:g}"), ("points", ", ".join(counts))]
        if len(status) and self.pressure.max() > 0.0:
            peak = self.points[self.pressure.argmax(), : self._dim]
            rows.append(("peak pressure", f"{self.pressure.max():.4g} at ({', '.join(f'{x:.4g}' for x in peak)})"))
        return rows

    def __repr__(self) -> str:
        return _show.lines(f"<stickslip.Contact: {self.name}>", self._told())

    def _repr_html_(self) -> str:
        return _show.table(f"interface {self.name}", self._told())

    def _vectors(self, *names: str) -> np.ndarray:
        return np.column_stack([self._columns[name] for name in names])

    @property
    def points(self) -> np.ndarray:
        """Reference coordinates, ``(n, 3)``."""
        return self._vectors("x", "y", "z")

    @property
    def nodes(self) -> np.ndarray:
        """The user's numbers of the nodes, ``(n,)``; NaN for points that are no nodes."""
        return self._columns["node"]

    @property
    def pressure(self) -> np.ndarray:
        """Pressure, ``(n,)``, positive in compression."""
        return self._columns["CPRESS"]

    @property
    def shear(self) -> np.ndarray:
        """Shear traction on the secondary along the two output directions, ``(n, 2)``; ``(n, 1)`` in the plane."""
        return self._vectors("CSHEAR1", "CSHEAR2")[:, : self._dim - 1]

    @property
    def gap(self) -> np.ndarray:
        """Gap, ``(n,)``, positive if open."""
        return self._columns["COPEN"]

    @property
    def slip(self) -> np.ndarray:
        """Accumulated slip along the two output directions, ``(n, 2)``; ``(n, 1)`` in the plane."""
        return self._vectors("CSLIP1", "CSLIP2")[:, : self._dim - 1]

    @property
    def status(self) -> np.ndarray:
        """0 open, 1 stick, 2 slip, ``(n,)``."""
        return self._columns["CSTATUS"].astype(np.int8)

    @property
    def force(self) -> np.ndarray:
        """Force of pressure, ``(n,)``."""
        return self._columns["CNORMF"]

    @property
    def dissipated(self) -> np.ndarray:
        """Energy dissipated by friction per area, ``(n,)``."""
        return self._columns["CDISS"]

    @property
    def wear(self) -> np.ndarray:
        """Depth worn off, ``(n,)``."""
        return self._columns["CWEAR"]

    @property
    def table(self) -> Table:
        """All columns by name, those of ``interfaces/NAME.csv``; ``contact.table.to_pandas()`` is a ``DataFrame``."""
        return Table(self._columns)


class Simulation:
    """A problem being run. Iterating over it solves one increment after the other:

    >>> for step in simulation:
    ...     print(step.time, simulation.displacement.max())

    Arrays of the state (`displacement`, `velocity`, `acceleration`, `forces`, `points`) are views, read-only and without a copy. An
    array shows the increment at which it was taken, and stays as it is when the simulation goes on, which then works with a copy; there is a copy only if
    somebody holds on to the array.

    While it is solved other threads of Python run, but they must not use the same simulation: that raises ``RuntimeError``. Ctrl-C
    stops between two iterations with ``KeyboardInterrupt``: results so far stay, and the simulation can go on.

    It can be pickled at any time: what is made of it goes on with the same numbers, to the last bit. Results are written by the
    original only. Laws that are functions are pickled by name, as all functions are.
    """

    def __init__(
        self, core: _core.Simulation, problem: _core.Problem, laws: dict[str, dict[str, Callable[..., Any]]]
    ) -> None:
        self._core = core
        self._problem = problem
        self._laws = laws
        self._over = False

    @classmethod
    def resume(
        cls,
        directory: Union[str, os.PathLike[str]],
        problem: Optional[_OfProblem] = None,
        laws: Optional[Laws] = None,
        increments: Optional[int] = None,
    ) -> Simulation:
        """Goes on with a run that was stopped or killed, from the last checkpoint in the directory of its results, and writes there.

        Its results are those, to the last bit, of a run that was never stopped: by the command ``stickslip run``, or by `run` with a `directory`.
        `history` begins with the increments before.

        Parameters
        ----------
        problem
            The `Problem`, where it was given meshes, or where something has changed that may: ``output``, the duration of the step at hand, later
            steps. If not given, the one that was run.
        laws
            The functions that it was built with, see `Problem.build`.
        increments
            The checkpoint after so many increments; the last one if not given.

        Raises
        ------
        FileError
            If there is no checkpoint, or another run writes there.
        ProblemError
            If something has changed that must not.
        """
        core = _core.Problem.of_results(Path(directory)) if problem is None else problem._core
        functions = _laws.given(laws)
        return cls(core.resume(None, functions, Path(directory), increments), core, functions)

    def __reduce__(self) -> tuple[Any, ...]:
        for name, of in self._laws.items():
            for kind, function in of.items():
                try:
                    pickle.dumps(function)
                except Exception as error:
                    raise TypeError(
                        f"the {kind} law of interface `{name}` cannot be pickled: make it a function that a module has by name, "
                        "without what stands around it (no lambda, no function within a function)"
                    ) from error
        return _restored, (self._problem.state(), self._laws, self._core.state(), self._over)

    def __iter__(self) -> Iterator[Step]:
        return self

    def __next__(self) -> Step:
        while True:
            taken = self._core.take()
            if taken is not None:
                break
            if self._over:
                raise StopIteration
            try:
                self._over = not self._core.advance()
            finally:
                for level, text in self._core.messages():
                    _log.log(level, text)
        name, row = taken
        return Step(
            time=row["TIME"],
            name=name,
            increment=int(row["INC"]),
            attempt=int(row["ATT"]),
            iterations=int(row["ITRS"]),
            open=int(row["OPEN"]),
            stick=int(row["STICK"]),
            slip=int(row["SLIP"]),
            row=row,
        )

    def run(
        self,
        callback: Optional[Callable[[Step], Any]] = None,
        directory: Optional[Union[str, os.PathLike[str]]] = None,
        progress: bool = False,
    ) -> Simulation:
        """Runs what is left; returns itself.

        `callback` is called after every increment; if it returns ``False`` the run stops there. Results are written into `directory` if there is
        one, as by the command ``stickslip run``. `progress` shows a bar: that of `tqdm` or `rich` if one of them is there.

        Messages go to the logger ``stickslip`` of `logging`: increments as ``DEBUG``, cut-backs and notes as ``INFO``, what is probably wrong
        as ``WARNING``.

        Raises
        ------
        RunError
            If the analysis cannot go on. The state is that of the last increment.
        """
        if directory is not None:
            self._core.write_to(Path(directory))
        begin, end = self._core.span
        bar = _progress(progress, "stickslip")
        try:
            for step in self:
                if bar:
                    bar.show((step.time - begin) / (end - begin), f"{step.name}, {step.stick} stick, {step.slip} slip, {step.open} open")
                if callback is not None and ends(callback(step)):
                    break
        finally:
            if bar:
                bar.close()
        return self

    def save(self, directory: Union[str, os.PathLike[str]]) -> Path:
        """Writes what there is now, in the form in which `stickslip.open` and the commands ``plot`` and ``report`` take it; returns the folder.

        It has the history so far, and fields and tables of the last increment only: `run` with a `directory` writes those of all times that the problem
        asks for. Results of an earlier run in the folder are removed.
        """
        folder = Path(directory)
        self._core.save(folder)
        return folder

    @_show.with_options
    def plot(self, field: Optional[str] = None, ending: Literal["png", "svg"] = "png", **options: Unpack[PlotOptions]) -> Picture:
        """The picture that ``stickslip plot`` draws of the last increment, which Jupyter shows.

        Parameters
        ----------
        field
            The field in colour: ``"CPRESS"``, ``"CSTATUS"``, ``"MISES"``, ``"U1"``, ``"S22"`` ...
        ending
            ``"png"`` or ``"svg"``.
        options
            Those of ``stickslip plot``, with ``_`` for ``-``: ``scale=1``, ``view="x"``, ``bodies=["block", "base"]``, ``size=(800, 600)``;
            ``history=["press.CFN2", "press.CFS1"]`` plots columns of the history.

        Raises
        ------
        ValueError
            If there is no such field, body, column or option; with the names that come near.
        """
        with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
            return _show.draw(self.save(Path(folder) / _NAME), ending, {"field": field, **options})

    def report(self, file: Union[str, os.PathLike[str]]) -> Path:
        """Writes the report that ``stickslip report`` writes, on what there is now: one HTML file. Returns it."""
        with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
            return Path(_core.Results(self.save(Path(folder) / _NAME)).report(Path(file)))

    @property
    def time(self) -> float:
        """Time of the last increment."""
        return self._core.time

    @property
    def dim(self) -> int:
        """Displacements a point: 2 or 3."""
        return self._core.dim

    @property
    def points(self) -> np.ndarray:
        """Coordinates of all bodies, ``(n, 3)``."""
        return np.asarray(self._core.points)

    @property
    def displacement(self) -> np.ndarray:
        """Displacements, ``(n, dim)``."""
        return np.asarray(self._core.displacement)

    @property
    def velocity(self) -> np.ndarray:
        """Velocities, ``(n, dim)``; zero in quasi-static steps."""
        return np.asarray(self._core.velocity)

    @property
    def acceleration(self) -> np.ndarray:
        """Accelerations, ``(n, dim)``; zero in quasi-static steps."""
        return np.asarray(self._core.acceleration)

    @property
    def forces(self) -> np.ndarray:
        """Internal minus external forces, ``(n, dim)``: reactions where points are supported."""
        return np.asarray(self._core.forces)

    @property
    def interfaces(self) -> list[str]:
        """Names of the interfaces."""
        return self._core.interfaces

    @property
    def bodies(self) -> dict[str, range]:
        """The points of each body."""
        return {name: range(*points) for name, points, _ in self._core.bodies}

    def contact(self, name: str) -> Contact:
        """The points of an interface at the last increment. They are gathered at every call: keep the result."""
        columns = {name: np.asarray(column) for name, column in self._core.contact(name)}
        return Contact(columns, self.dim, name, self, self.time)

    @property
    def problem(self) -> dict[str, Any]:
        """The tables of the problem, as they are run."""
        return self._problem.tables()

    def _body(self, interface: str) -> Optional[str]:
        return body_of(self.problem, interface)

    def fields(self) -> dict[str, np.ndarray]:
        """All fields of the last increment by name, at points ``(n,)`` or ``(n, components)`` or at cells: those of ``fields.pvd``.

        Vectors have three components, stresses six (xx, yy, zz, xy, yz, xz). They are computed at every call: keep the result.
        """
        return {name: np.asarray(values) for name, _, values in self._core.fields()}

    @property
    def history(self) -> Table:
        """The history so far by name of column, one entry an increment; ``simulation.history.to_pandas()`` is a ``DataFrame``."""
        names, values = self._core.history()
        table = np.asarray(values)
        return Table({name: table[:, i] for i, name in enumerate(names)})

    @property
    def summary(self) -> Summary:
        """What ``summary.json`` holds: outcome, counts, times, energies, quality, findings."""
        summary: Summary = json.loads(self._core.summary)
        return summary

    @property
    def notes(self) -> list[str]:
        """What a user should know."""
        return self._core.notes

    def grid(self, warp: float = 0.0) -> pyvista.UnstructuredGrid:
        """All bodies and fields of the last increment as a grid of `pyvista`; its points are moved by `warp` times the displacements.

        The cell array ``body`` counts the bodies in the order of their names.
        """
        import pyvista

        blocks, types = [], []
        for kind, nodes in self._core.cells:
            array = np.asarray(nodes).astype(np.int64)
            padded = np.column_stack([np.full(len(array), array.shape[1]), array])
            blocks.append(padded.ravel())
            types.append(np.full(len(array), _KINDS[kind][1], dtype=np.uint8))
        points = np.array(self.points)
        if warp:
            points[:, : self.dim] += warp * self.displacement
        grid = pyvista.UnstructuredGrid(np.concatenate(blocks), np.concatenate(types), points)
        for name, at_points, values in self._core.fields():
            data = grid.point_data if at_points else grid.cell_data
            data[name] = np.asarray(values)
        body = np.zeros(grid.n_cells, dtype=np.int32)
        for i, (_, _, (first, last)) in enumerate(self._core.bodies):
            body[first:last] = i
        grid.cell_data["body"] = body
        return grid

    def _told(self) -> list[tuple[str, Any]]:
        end = self._core.span[1]
        cells = sum(last - first for _, _, (first, last) in self._core.bodies)
        state = "at its end" if self._over else f"at time {self.time:g} of {end:g}"
        rows: list[tuple[str, Any]] = [
            ("state", f"{state}, {len(self.history.get('TIME', ()))} increments"),
            ("bodies", f"{', '.join(self.bodies)}: {len(self.points)} points, {cells} cells"),
            ("interfaces", ", ".join(dict.fromkeys(self.interfaces))),
        ]
        return [*rows, *told(self.summary)]

    def __repr__(self) -> str:
        return _show.lines("<stickslip.Simulation>", self._told())

    def _repr_html_(self) -> str:
        return _show.table("simulation", self._told())


def ends(answer: Any) -> bool:
    """Whether a callback has said that it is enough: a comparison of numbers of NumPy is no ``False`` of Python."""
    return isinstance(answer, (bool, np.bool_)) and not answer


def told(summary: Summary) -> list[tuple[str, Any]]:
    """What a summary says of the physics and of how good it is, a line an interface."""
    rows: list[tuple[str, Any]] = []
    for interface in summary.get("interfaces", []):
        tied = interface.get("tied", False)
        points, peak = interface.get("points"), interface.get("peak-traction") if tied else interface.get("peak-pressure")
        counts = "" if tied or points is None else f"; {points['stick']} stick, {points['slip']} slip, {points['open']} open"
        rows.append(
            (
                f"{'tie' if tied else 'interface'} {interface.get('name')}",
                f"peak {'traction' if tied else 'pressure'} {peak['value'] if peak else 0.0:.4g} at time {peak['time'] if peak else 0.0:g}; "
                f"normal force {_size(interface.get('normal-force'))}, shear force {_size(interface.get('shear-force'))}{counts}",
            )
        )
    quality = summary.get("quality", {})
    if summary.get("completed") and quality.get("gate") != "off":
        rows.append(("quality", "all limits are kept" if quality.get("met", True) else "limits are missed: see summary['quality']"))
    return rows


def _size(vector: Optional[list[float]]) -> str:
    return f"{float(np.linalg.norm(vector or [0.0])):.4g}"


def body_of(problem: dict[str, Any], interface: str) -> Optional[str]:
    """The body of the secondary surface of an interface, if its name tells."""
    secondary = problem.get("interface", {}).get(interface, {}).get("secondary", "")
    name = secondary.split(".")[0]
    if name in problem.get("body", {}):
        return str(name)
    body = problem.get("set", {}).get(secondary, {}).get("of")
    return str(body).split(".")[0] if body else None


def _restored(
    problem_state: bytes, laws: dict[str, dict[str, Callable[..., Any]]], state: Optional[bytes], over: bool
) -> Simulation:
    problem = _core.Problem.restore(problem_state)
    core = problem.build(None, laws) if state is None else problem.go_on(None, laws, state)
    simulation = Simulation(core, problem, laws)
    simulation._over = over
    return simulation
