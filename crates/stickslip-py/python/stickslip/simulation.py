"""Simulations: problems being run, and what comes of them."""

from __future__ import annotations

import json
import os
import pickle
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Optional, Protocol, Union

import numpy as np

from . import _core, _laws
from ._laws import Laws
from .mesh import _KINDS

if TYPE_CHECKING:
    import pyvista


class _OfProblem(Protocol):
    """A `Problem`, which makes simulations and so knows them; they know what is behind it."""

    _core: _core.Problem


@dataclass(frozen=True)
class Step:
    """An accepted increment."""

    #: Its end [s].
    time: float
    #: Name of the step of the analysis that it belongs to.
    name: str
    #: Its number in that step, from 1.
    increment: int
    #: Attempts it took.
    attempt: int
    #: Newton iterations.
    iterations: int
    #: Contact points that are open, stick and slip.
    open: int
    stick: int
    slip: int
    #: The row of the history: resultants of interfaces, reactions of supports, energies, probes, by name.
    row: dict[str, float] = field(repr=False)


class Contact:
    """The points of the secondary of an interface at one increment. All arrays have one entry a point."""

    def __init__(self, columns: dict[str, np.ndarray], dim: int) -> None:
        self._columns = columns
        self._dim = dim

    def _vectors(self, *names: str) -> np.ndarray:
        return np.column_stack([self._columns[name] for name in names])

    @property
    def points(self) -> np.ndarray:
        """Reference coordinates, ``(n, 3)`` [length]."""
        return self._vectors("x", "y", "z")

    @property
    def nodes(self) -> np.ndarray:
        """The user's numbers of the nodes, ``(n,)``; NaN for points that are no nodes."""
        return self._columns["node"]

    @property
    def pressure(self) -> np.ndarray:
        """Pressure, ``(n,)`` [Pa], positive in compression."""
        return self._columns["CPRESS"]

    @property
    def shear(self) -> np.ndarray:
        """Shear traction on the secondary along the two output directions, ``(n, 2)`` [Pa]; ``(n, 1)`` in the plane."""
        return self._vectors("CSHEAR1", "CSHEAR2")[:, : self._dim - 1]

    @property
    def gap(self) -> np.ndarray:
        """Gap, ``(n,)`` [length], positive if open."""
        return self._columns["COPEN"]

    @property
    def slip(self) -> np.ndarray:
        """Accumulated slip along the two output directions, ``(n, 2)`` [length]; ``(n, 1)`` in the plane."""
        return self._vectors("CSLIP1", "CSLIP2")[:, : self._dim - 1]

    @property
    def status(self) -> np.ndarray:
        """0 open, 1 stick, 2 slip, ``(n,)``."""
        return self._columns["CSTATUS"].astype(np.int8)

    @property
    def force(self) -> np.ndarray:
        """Force of pressure, ``(n,)`` [N]."""
        return self._columns["CNORMF"]

    @property
    def dissipated(self) -> np.ndarray:
        """Energy dissipated by friction per area, ``(n,)`` [J/m²]."""
        return self._columns["CDISS"]

    @property
    def wear(self) -> np.ndarray:
        """Depth worn off, ``(n,)`` [length]."""
        return self._columns["CWEAR"]

    @property
    def table(self) -> dict[str, np.ndarray]:
        """All columns by name, those of ``interfaces/NAME.csv``: ``pandas.DataFrame(contact.table)``."""
        return dict(self._columns)


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
            self._over = not self._core.advance()
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
    ) -> Simulation:
        """Runs what is left; returns itself.

        `callback` is called after every increment; if it returns ``False`` the run stops there. Results are written into `directory` if there is
        one, as by the command ``stickslip run``.

        Raises
        ------
        RunError
            If the analysis cannot go on. The state is that of the last increment.
        """
        if directory is not None:
            self._core.write_to(Path(directory))
        for step in self:
            if callback is not None and callback(step) is False:
                break
        return self

    @property
    def time(self) -> float:
        """Time of the last increment [s]."""
        return self._core.time

    @property
    def dim(self) -> int:
        """Displacements a point: 2 or 3."""
        return self._core.dim

    @property
    def points(self) -> np.ndarray:
        """Coordinates of all bodies, ``(n, 3)`` [length]."""
        return np.asarray(self._core.points)

    @property
    def displacement(self) -> np.ndarray:
        """Displacements, ``(n, dim)`` [length]."""
        return np.asarray(self._core.displacement)

    @property
    def velocity(self) -> np.ndarray:
        """Velocities, ``(n, dim)`` [length/time]; zero in quasi-static steps."""
        return np.asarray(self._core.velocity)

    @property
    def acceleration(self) -> np.ndarray:
        """Accelerations, ``(n, dim)`` [length/time²]; zero in quasi-static steps."""
        return np.asarray(self._core.acceleration)

    @property
    def forces(self) -> np.ndarray:
        """Internal minus external forces, ``(n, dim)`` [force]: reactions where points are supported."""
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
        return Contact(columns, self.dim)

    def fields(self) -> dict[str, np.ndarray]:
        """All fields of the last increment by name, at points ``(n,)`` or ``(n, components)`` or at cells: those of ``fields.pvd``.

        Vectors have three components, stresses six (xx, yy, zz, xy, yz, xz). They are computed at every call: keep the result.
        """
        return {name: np.asarray(values) for name, _, values in self._core.fields()}

    @property
    def history(self) -> dict[str, np.ndarray]:
        """The history so far by name of column, one entry an increment: ``pandas.DataFrame(simulation.history)``."""
        names, values = self._core.history()
        table = np.asarray(values)
        return {name: table[:, i] for i, name in enumerate(names)}

    @property
    def summary(self) -> dict[str, Any]:
        """What ``summary.json`` holds: outcome, counts, times, energies, quality, findings."""
        summary: dict[str, Any] = json.loads(self._core.summary)
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

    def __repr__(self) -> str:
        state = "over" if self._over else f"at time {self.time:g}"
        return f"<stickslip.Simulation: {len(self.points)} points, {state}>"


def _restored(
    problem_state: bytes, laws: dict[str, dict[str, Callable[..., Any]]], state: Optional[bytes], over: bool
) -> Simulation:
    problem = _core.Problem.restore(problem_state)
    core = problem.build(None, laws) if state is None else problem.go_on(None, laws, state)
    simulation = Simulation(core, problem, laws)
    simulation._over = over
    return simulation
