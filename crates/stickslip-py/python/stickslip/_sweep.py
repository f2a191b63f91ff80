"""Parameter studies."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any, Callable, Optional

from . import _core
from ._errors import Error
from ._laws import Laws
from ._progress import progress as _progress
from ._table import Rows
from .problem import Problem
from .simulation import Simulation


def sweep(
    problem: Problem,
    axes: Mapping[str, Sequence[Any]],
    side_by_side: bool = False,
    callback: Optional[Callable[[dict[str, Any], Simulation], Any]] = None,
    laws: Optional[Laws] = None,
    progress: bool = False,
    shard: Optional[tuple[int, int]] = None,
) -> Rows:
    """Runs a problem for many values; bodies that stay the same are factored once.

    Parameters
    ----------
    axes
        Values by the path of their key, ``{"interface.base.friction.coulomb.mu": [0.1, 0.2]}``. Several make all combinations, the last
        one changing fastest.
    side_by_side
        Axes of equal length run together instead of in all combinations.
    callback
        Called after every run with its row and the simulation, for what the history does not have. What it returns, if a dict, is added to
        the row.
    laws
        See `Problem.build`.
    progress
        Shows a bar, see `Simulation.run`.
    shard
        ``(2, 4)`` makes the second of four parts, for one of several processes: runs 2, 6, 10, … of the sweep, as `stickslip sweep --shard 2/4` does.
        Rows then have their ``run``, counted from 1, by which those of all parts are brought together.

    Returns
    -------
    Rows
        A list with a dict a run: the values of the axes, ``outcome`` (``done`` or why not), and the last row of the history;
        ``rows.to_pandas()`` is a ``DataFrame``. A run that fails does not stop the others.
    """
    values = [list(axes[path]) for path in axes]
    if side_by_side and len({len(v) for v in values}) > 1:
        raise ValueError("axes that run side by side have to be of equal length")
    runs = list(zip(*values) if side_by_side else itertools.product(*values))
    # All values are checked before the first run.
    problems = [problem.with_values(dict(zip(axes, run))) for run in runs]
    numbers = range(1, len(runs) + 1)
    if shard is not None:
        part, of = shard
        if not 1 <= part <= of:
            raise ValueError(f"shard ({part}, {of}): parts are counted from 1 to {of}")
        numbers, runs, problems = (list(all)[part - 1 :: of] for all in (numbers, runs, problems))
    factors = _core.Factors()
    rows = Rows()
    bar = _progress(progress, "sweep")
    for number, run, variant in zip(numbers, runs, problems):
        row: dict[str, Any] = {} if shard is None else {"run": number}
        row.update(zip(axes, run))
        simulation = None
        try:
            simulation = variant.build(laws, factors)
            simulation.run()
            row["outcome"] = "done"
        except Error as error:
            row["outcome"] = str(error).splitlines()[0]
        if simulation is not None:
            row.update({name: column[-1] for name, column in simulation.history.items() if len(column)})
            added = callback(row, simulation) if callback is not None else None
            if isinstance(added, dict):
                row.update(added)
        rows.append(row)
        if bar:
            bar.show(len(rows) / len(runs), f"{len(rows)} of {len(runs)} runs")
    if bar:
        bar.close()
    return rows
