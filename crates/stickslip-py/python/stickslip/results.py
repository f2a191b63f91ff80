"""Results of a run in a folder: what ``stickslip run`` and `Simulation.run` write."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np

from . import _core, _show
from ._show import Picture
from ._table import Table
from .simulation import Contact, body_of, told

if TYPE_CHECKING:
    import pyvista
    from typing_extensions import Unpack

    from ._options import PlotOptions
    from ._summary import Summary


class Results:
    """A folder of results, see `open`. Files of fields are read when they are asked for."""

    def __init__(self, directory: Union[str, os.PathLike[str]]) -> None:
        #: The folder.
        self.directory = Path(directory)
        self._core = _core.Results(self.directory)

    def __reduce__(self) -> tuple[Any, ...]:
        return Results, (self.directory,)

    @property
    def title(self) -> str:
        """The title of the problem, or the name of the folder."""
        return self._core.title

    @property
    def missing(self) -> list[str]:
        """What a finished run would have left and is not there, a sentence each."""
        return self._core.missing

    @property
    def summary(self) -> Summary:
        """What ``summary.json`` holds: outcome, counts, times, energies, quality, findings. Empty where the run has not come to its end."""
        summary: Optional[Summary] = json.loads(self._core.summary)
        return summary or {}

    @property
    def problem(self) -> str:
        """The text of the problem as it was run: names of meshes in it are relative to the folder of the original file."""
        return self._core.problem

    @property
    def history(self) -> Table:
        """The history by name of column, one entry an increment."""
        return Table({name: np.asarray(column) for name, column in self._core.history()})

    @property
    def times(self) -> np.ndarray:
        """Times at which fields were written, ``(times,)``."""
        return np.asarray(self._core.times, dtype=float)

    @property
    def interfaces(self) -> list[str]:
        """Names of the interfaces that have a table."""
        return self._core.interfaces

    def contact(self, name: str) -> Contact:
        """The points of an interface at the last time at which fields were written.

        Raises
        ------
        KeyError
            If there is no such interface; with the names that come near.
        """
        columns = {name: np.asarray(column) for name, column in self._core.table(name)}
        # In the plane all points lie at z = 0.
        dim = 3 if np.ptp(columns["z"]) > 0.0 else 2
        times = self._core.times
        return Contact(columns, dim, name, self, times[-1] if times else 0.0)

    def _number(self, index: int) -> int:
        count = len(self._core.times)
        if not -count <= index < count:
            raise IndexError(f"{self.directory}: there is no time {index}: fields were written at {count} times")
        return index % count

    @property
    def points(self) -> np.ndarray:
        """Coordinates of all bodies, ``(n, 3)``."""
        return np.asarray(self._core.grid(self._number(-1))[0])

    def fields(self, index: int = -1) -> dict[str, np.ndarray]:
        """Fields at one of `times`, by name, at points ``(n,)`` or ``(n, components)`` or at cells; the last one if no other is named."""
        _, at_points, _, at_cells = self._core.grid(self._number(index))
        return {name: np.asarray(values) for name, values in [*at_points, *at_cells]}

    def grid(self, index: int = -1, warp: float = 0.0) -> pyvista.UnstructuredGrid:
        """Bodies and fields at one of `times` as a grid of `pyvista`; its points are moved by `warp` times the displacements."""
        import pyvista

        points, at_points, (types, offsets, nodes), at_cells = self._core.grid(self._number(index))
        ends = np.asarray(offsets)
        starts = np.concatenate([[0], ends[:-1]])
        cells = np.insert(np.asarray(nodes), starts, ends - starts)
        grid = pyvista.UnstructuredGrid(cells, np.frombuffer(types, dtype=np.uint8), np.array(np.asarray(points)))
        for data, arrays in [(grid.point_data, at_points), (grid.cell_data, at_cells)]:
            for name, values in arrays:
                data[name] = np.asarray(values)
        if warp:
            grid.points = grid.points + warp * grid.point_data["U"]
        return grid

    @_show.with_options
    def plot(self, field: Optional[str] = None, ending: Literal["png", "svg"] = "png", **options: Unpack[PlotOptions]) -> Picture:
        """The picture that ``stickslip plot`` draws, which Jupyter shows. See `Simulation.plot`."""
        return _show.draw(self.directory, ending, {"field": field, **options})

    def report(self, file: Optional[Union[str, os.PathLike[str]]] = None) -> Path:
        """Writes the report that ``stickslip report`` writes; returns its file, ``report.html`` in the folder if no other is named."""
        return Path(self._core.report(None if file is None else Path(file)))

    def _told(self) -> list[tuple[str, Any]]:
        summary, history = self.summary, self.history
        ended: dict[Any, str] = {True: "the run has come to its end", False: "the run stopped before its end"}
        rows = [
            ("folder", str(self.directory)),
            ("outcome", ended.get(summary.get("completed", ""), "no summary: it still runs, or was killed")),
            ("increments", len(history.get("TIME", ()))),
            ("fields", f"{len(self.times)} times" + (f", the last {self.times[-1]:g}" if len(self.times) else "")),
        ]
        return [*rows, *told(summary)]

    def __repr__(self) -> str:
        return _show.lines(f"<stickslip.Results: {self.title}>", self._told())

    def _repr_html_(self) -> str:
        return _show.table(self.title, self._told())

    def _body(self, interface: str) -> Optional[str]:
        return body_of(json.loads(self._core.tables()), interface)


def open(directory: Union[str, os.PathLike[str]]) -> Results:
    """Opens a folder of results.

    >>> results = stickslip.open("case.out")
    >>> results.history.to_pandas()
    >>> results.plot("CPRESS")

    Raises
    ------
    FileError
        If there is no such folder, or none of the files of a run in it.
    """
    return Results(directory)
