"""Parameter studies."""

import sys
import types

import numpy as np
import pytest

import stickslip

MU = "interface.press.friction.coulomb.mu"
PRESS = "support.top-y.y"


def test_a_row_a_run(problem):
    rows = stickslip.sweep(problem, {MU: [0.1, 0.2], PRESS: [-1e-3, -2e-3]})
    assert [(row[MU], row[PRESS]) for row in rows] == [(0.1, -1e-3), (0.1, -2e-3), (0.2, -1e-3), (0.2, -2e-3)]
    assert all(row["outcome"] == "done" for row in rows)
    shear = [row["press.CFS1"] for row in rows]
    alone = problem.with_values({MU: 0.2}).build().run().history["press.CFS1"][-1]
    assert shear[2] == alone


def test_bodies_are_factored_once(problem):
    seen = []
    stickslip.sweep(
        problem.with_values({"solver.method": "condensed"}),
        {MU: [0.1, 0.2, 0.3]},
        callback=lambda row, simulation: seen.append(simulation.summary["solver"]["factorisations"]),
    )
    assert seen[0] > 0 and seen[1:] == [0, 0]


def test_side_by_side_and_own_columns(problem):
    rows = stickslip.sweep(
        problem,
        {MU: [0.1, 0.2], PRESS: [-1e-3, -2e-3]},
        side_by_side=True,
        callback=lambda row, simulation: {"peak": simulation.contact("press").pressure.max()},
    )
    assert len(rows) == 2 and rows[1]["peak"] > 1.9 * rows[0]["peak"]
    with pytest.raises(ValueError, match="of equal length"):
        stickslip.sweep(problem, {MU: [0.1], PRESS: [-1e-3, -2e-3]}, side_by_side=True)


def test_values_are_checked_before_the_first_run(problem):
    with pytest.raises(stickslip.ProblemError):
        stickslip.sweep(problem, {MU: [0.1, "much"]})


def test_parts_have_all_runs_once(problem):
    axes = {MU: [0.1, 0.2, 0.3], PRESS: [-1e-3]}
    parts = [stickslip.sweep(problem, axes, shard=(part, 2)) for part in (1, 2)]
    assert [[row["run"] for row in rows] for rows in parts] == [[1, 3], [2]]
    together = sorted((row for rows in parts for row in rows), key=lambda row: row["run"])
    whole = stickslip.sweep(problem, axes)
    assert [{k: v for k, v in row.items() if k != "run"} for row in together] == list(whole)
    with pytest.raises(ValueError, match="counted from 1 to 2"):
        stickslip.sweep(problem, axes, shard=(3, 2))


def test_values_may_be_arrays_ranges_and_series(problem):
    pandas = pytest.importorskip("pandas")
    cases = [np.linspace(0.1, 0.2, 2), (0.1 * i for i in (1, 2)), pandas.Series([0.1, 0.2])]
    for values in cases:
        rows = stickslip.sweep(problem, {MU: values, "step.2.increments.fixed": range(2, 3)})
        assert [row[MU] for row in rows] == [0.1, 0.2] and all(row["outcome"] == "done" for row in rows)


def peak(row, simulation):
    return {"peak": simulation.contact("press").pressure.max()}


def sticks(row, simulation):
    return np.bool_(row["SLIP"] == 0)


def test_processes_give_the_rows_of_one(problem, monkeypatch):
    problem["step.2.increments.fixed"] = 2
    axes = {MU: [0.1, 0.2, 0.3]}
    alone = stickslip.sweep(problem, axes, callback=peak)
    assert stickslip.sweep(problem, axes, callback=peak, processes=2) == alone
    with pytest.raises(TypeError, match="functions of a module"):
        stickslip.sweep(problem, axes, callback=lambda row, simulation: None, processes=2)
    # A function that this process knows, and no other.
    module = types.ModuleType("module_of_this_process")
    exec("def peak(row, simulation): return {}", vars(module))
    monkeypatch.setitem(sys.modules, module.__name__, module)
    with pytest.raises(RuntimeError, match="under `if __name__"):
        stickslip.sweep(problem, axes, callback=module.peak, processes=2)
    with pytest.raises(ValueError, match="processes: 0"):
        stickslip.sweep(problem, axes, processes=0)


@pytest.mark.parametrize("processes", [None, 2])
def test_a_sweep_stops_early(problem, processes):
    problem["step.2.increments.fixed"] = 2
    axes = {MU: [0.1, 0.2, 0.3, 0.4, 0.5]}
    whole = stickslip.sweep(problem, axes)
    at = whole[1]["press.CFS1"]
    assert stickslip.sweep(problem, axes, stop=lambda row: row["press.CFS1"] == at, processes=processes) == whole[:2]
    slides = [row["SLIP"] > 0 for row in whole]
    assert True in slides[:-1]
    ended = stickslip.sweep(problem, axes, callback=sticks, processes=processes)
    assert ended == whole[: slides.index(True) + 1]
