"""Problems are edited in place."""

import pickle

import numpy as np
import pytest

import stickslip

MU = "interface.press.friction.coulomb.mu"


def test_tables_and_values_are_read_by_their_paths(problem):
    assert problem["interface"]["press"]["friction"] == {"coulomb": {"mu": 0.3}}
    assert problem[MU] == 0.3 and problem["step.1.increments.fixed"] == 18
    assert MU in problem and "load.push" not in problem and "step.2" not in problem
    assert {"body", "interface", "step", "support"} <= set(problem)
    # What was not given has its default.
    assert problem["solver.tolerance"] == stickslip.schema()["properties"]["solver"]["default"]["tolerance"]
    with pytest.raises(KeyError, match="there is no `fricton`; there is: friction"):
        problem["interface.press.fricton"]


def test_what_is_changed_is_what_runs(problem):
    def shear(problem):
        return problem.build().run().history["press.CFS1"][-1]

    wanted = shear(problem.with_values({MU: 0.1}))
    before = shear(problem)
    problem["interface"]["press"]["friction"] = {"coulomb": {"mu": 0.1}}
    assert shear(problem) == wanted != before
    problem[MU] = np.float64(0.3)
    assert shear(problem) == before
    problem["interface.press.friction"] = {"coulomb": {"mu": 0.1}}
    assert shear(pickle.loads(pickle.dumps(problem))) == wanted
    assert "mu = 0.1" in problem.to_toml()
    del problem["interface.press.friction"]
    assert shear(problem) == 0.0


def test_steps_and_tables_are_put_in_and_taken_out(problem):
    problem["load.push"] = {"set": "block.right", "traction": {"value": np.array([-1e6, 0.0])}}
    problem["step"].append({"name": "more", "increments": {"fixed": 1}})
    problem["step.0.duration"] = 2
    assert problem.build().run().time == 4.0
    assert "load.push" in problem
    del problem["load.push"], problem["step.2"]
    assert "push" not in problem.to_toml() and len(problem["step"]) == 2
    problem["title"] = "edited"
    assert "edited" in repr(problem)


def test_an_edited_problem_is_checked_when_it_is_used(problem):
    problem["interface"]["press"]["fricton"] = {}
    assert "fricton" in repr(problem) and "not sound" in repr(problem)
    with pytest.raises(stickslip.ProblemError, match="did you mean `friction`"):
        problem.build()
    del problem["interface.press.fricton"]
    problem.build()
    problem["support.base.x"] = object()
    with pytest.raises(TypeError, match=r"support\.base\.x"):
        problem.check()


def test_all_examples_are_the_same_after_their_tables_are_read_and_changed_back():
    from pathlib import Path

    examples = Path(__file__).resolve().parents[3] / "examples"
    if not examples.exists():
        pytest.skip("the examples are not there")
    files = sorted(examples.glob("*/case*.toml"))
    assert len(files) > 40
    for file in files:
        problem = stickslip.Problem.from_toml(file)
        text = problem.to_toml()
        problem["title"] = "another"
        assert "another" in problem.to_toml(), file
        problem["title"] = stickslip.Problem.from_toml(text)["title"] if "title" in stickslip.Problem.from_toml(text) else None
        assert problem.to_toml() == text, file
