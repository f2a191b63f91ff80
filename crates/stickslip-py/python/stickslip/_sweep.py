"""Parameter studies."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import pickle
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Callable, Optional

from . import _core
from ._errors import Error
from ._functions import set_threads
from ._laws import Laws
from ._progress import progress as _progress
from ._table import Rows
from .problem import Problem
from .simulation import Simulation, ends

#: Called after a run with its row and the simulation.
Callback = Callable[[dict[str, Any], Simulation], Any]


@dataclass(frozen=True)
class _Work:
    """What all runs of a sweep share."""

    problem: Problem
    laws: Optional[Laws]
    callback: Optional[Callback]
    factors: _core.Factors

    def run(self, values: dict[str, Any]) -> tuple[dict[str, Any], bool]:
        """The row of a run, and whether the sweep goes on."""
        row: dict[str, Any] = {}
        simulation = None
        try:
            simulation = self.problem.with_values(values).build(self.laws, self.factors)
            simulation.run()
            row["outcome"] = "done"
        except Error as error:
            row["outcome"] = str(error).splitlines()[0]
        if simulation is None:
            return {**values, **row}, True
        row.update({name: float(column[-1]) for name, column in simulation.history.items() if len(column)})
        row = {**values, **row}
        answer = self.callback(row, simulation) if self.callback is not None else None
        return {**row, **answer} if isinstance(answer, dict) else row, not ends(answer)


_FUNCTIONS = "callback and laws have to be functions of a module that other processes can import, no lambdas and none of a notebook"
_MAIN = 'a script has to call sweep under `if __name__ == "__main__":`'

#: What the runs of this process share, where it is one of several.
_work: Optional[_Work] = None


def _begin(work: bytes, threads: int) -> None:
    global _work
    set_threads(threads)
    _work = pickle.loads(work)


def _run(values: dict[str, Any]) -> tuple[dict[str, Any], bool]:
    assert _work is not None
    return _work.run(values)


@contextmanager
def _runs(
    work: _Work, runs: list[dict[str, Any]], processes: Optional[int]
) -> Iterator[Iterable[tuple[dict[str, Any], bool]]]:
    """The rows of runs in their order, as they become known."""
    if processes is None:
        yield map(work.run, runs)
        return
    try:
        shared = pickle.dumps(work)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise TypeError(f"processes: {_FUNCTIONS}: {error}") from None
    # A process that is forked has no threads but knows of some: a new one knows of none.
    threads = max(1, (os.cpu_count() or 1) // processes)
    new = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, new, _begin, (shared, threads)) as pool:
        answers = pool.map(_run, runs)
        try:
            yield answers
        except BrokenProcessPool:
            raise RuntimeError(f"processes: one of them could not begin, or was killed. {_FUNCTIONS}; {_MAIN}") from None
        finally:
            pool.shutdown(cancel_futures=True)


def sweep(
    problem: Problem,
    axes: Mapping[str, Iterable[Any]],
    side_by_side: bool = False,
    callback: Optional[Callback] = None,
    laws: Optional[Laws] = None,
    progress: bool = False,
    shard: Optional[tuple[int, int]] = None,
    processes: Optional[int] = None,
    stop: Optional[Callable[[dict[str, Any]], bool]] = None,
) -> Rows:
    """Runs a problem for many values; bodies that stay the same are factored once.

    Parameters
    ----------
    axes
        Values by the path of their key, ``{"interface.base.friction.coulomb.mu": np.linspace(0.1, 0.5, 5)}``: lists, ranges, arrays, series. Several
        make all combinations, the last one changing fastest.
    side_by_side
        Axes of equal length run together instead of in all combinations.
    callback
        Called after every run with its row and the simulation, for what the history does not have. What it returns, if a dict, is added to
        the row; ``False`` ends the sweep with this run.
    laws
        See `Problem.build`.
    progress
        Shows a bar, see `Simulation.run`.
    shard
        ``(2, 4)`` makes the second of four parts, for one of several processes: runs 2, 6, 10, … of the sweep, as `stickslip sweep --shard 2/4` does.
        Rows then have their ``run``, counted from 1, by which those of all parts are brought together.
    processes
        So many processes run side by side, with the processors shared among them; each factors the bodies once. Rows are those of one process, in the same
        order. `callback` and `laws` are called there and have to be functions of a module. As in all programs that use `multiprocessing`, a script has to
        call this under ``if __name__ == "__main__":``.
    stop
        Called after every run with its row, in the order of the runs and in this process; where it returns ``True`` the sweep ends with that run.

    Returns
    -------
    Rows
        A list with a dict a run: the values of the axes, ``outcome`` (``done`` or why not), and the last row of the history;
        ``rows.to_pandas()`` is a ``DataFrame``. A run that fails does not stop the others.
    """
    values = [list(axes[path]) for path in axes]
    if side_by_side and len({len(v) for v in values}) > 1:
        raise ValueError("axes that run side by side have to be of equal length")
    if processes is not None and processes < 1:
        raise ValueError(f"processes: {processes} is less than one")
    runs = [dict(zip(axes, run)) for run in (zip(*values) if side_by_side else itertools.product(*values))]
    # All values are checked before the first run.
    for run in runs:
        problem.with_values(run)
    numbers: Iterable[int] = range(1, len(runs) + 1)
    if shard is not None:
        part, of = shard
        if not 1 <= part <= of:
            raise ValueError(f"shard ({part}, {of}): parts are counted from 1 to {of}")
        numbers, runs = list(numbers)[part - 1 :: of], runs[part - 1 :: of]
    rows = Rows()
    bar = _progress(progress, "sweep")
    try:
        with _runs(_Work(problem, laws, callback, _core.Factors()), runs, processes) as answers:
            for number, (row, goes_on) in zip(numbers, answers):
                rows.append(row if shard is None else {"run": number, **row})
                if bar:
                    bar.show(len(rows) / len(runs), f"{len(rows)} of {len(runs)} runs")
                if not goes_on or (stop is not None and stop(rows[-1])):
                    break
    finally:
        if bar:
            bar.close()
    return rows
