"""Problems are edited in place, and builders make the same tables as dictionaries."""

import copy
import pickle

import numpy as np
import pytest

import stickslip
from stickslip import tables as t

MU = "interface.press.friction.coulomb.mu"


def test_tables_and_values_are_read_by_their_paths(problem):
    assert problem["interface"]["press"]["friction"] == {"coulomb": {"mu": 0.3}}
    assert problem[MU] == 0.3 and problem["step.2.increments.fixed"] == 18
    assert MU in problem and "load.push" not in problem and "step.3" not in problem and "step.0" not in problem
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
    problem["interface.press.friction"] = t.Friction.coulomb(mu=0.1)
    assert shear(pickle.loads(pickle.dumps(problem))) == wanted
    assert "mu = 0.1" in problem.to_toml()
    del problem["interface.press.friction"]
    assert shear(problem) == 0.0


def test_steps_and_tables_are_put_in_and_taken_out(problem):
    problem["load.push"] = {"set": "block.right", "traction": {"value": np.array([-1e6, 0.0])}}
    problem["step"].append({"name": "more", "increments": {"fixed": 1}})
    problem["step.1.duration"] = 2
    assert problem.build().run().time == 4.0
    assert "load.push" in problem
    del problem["load.push"], problem["step.more"]
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


def test_builders_make_the_dictionary_of_a_case(case):
    steel = t.Isotropic(young=210e9, poisson=0.3)
    built = t.File(
        format=1,
        model=t.Model(space="plane-strain"),
        material={"steel": t.Material(isotropic=steel)},
        body={
            "base": t.Body(material="steel", generate=t.Generator.rectangle(from_=[0, -1], to=[3, 0], cells=[12, 4])),
            "block": t.Body(material="steel", generate=t.Generator.rectangle(from_=[1, 0], to=[2, 1], cells=[5, 5])),
        },
        interface={
            "press": t.Interface(
                secondary="block.bottom",
                primary="base.top",
                normal=t.Normal.linear(c=2e12),
                friction=t.Friction.coulomb(mu=0.3),
            )
        },
        support={
            "base": t.Support(set="base.bottom", x=0, y=0),
            "top-y": t.Support(set="block.top", y=-1e-3, amplitude="press"),
            "top-x": t.Support(set="block.top", x=1e-3, amplitude="drag"),
        },
        amplitude={"press": t.AmplitudeTable(table=[[0, 0], [1, 1]]), "drag": t.AmplitudeTable(table=np.array([[1, 0], [2, 1]]))},
        step=[t.Step(increments=t.Increments(fixed=2)), t.Step(increments=t.Increments(fixed=18))],
    )
    assert stickslip.Problem.from_dict(built).to_toml() == stickslip.Problem.from_dict(case).to_toml()
    # Keys that are no names of Python, words, and kinds that are words or tables.
    assert t.Support(set="a", rotation_z=1e-3, hold=["x"]) == {"set": "a", "rotation-z": 1e-3, "hold": ["x"]}
    assert t.BodyRotation.with_("axle") == {"with": "axle"}
    assert copy.deepcopy(steel) == steel and type(pickle.loads(pickle.dumps(steel))) is t.Isotropic


def test_every_table_of_the_schema_has_a_builder_with_its_keys():
    """What is built with all keys of a table has these keys."""
    import inspect

    schema = stickslip.schema()
    for name in ["Body", "Interface", "Step", "Support", "Load", "Material", "Obstacle", "Solver", "Output"]:
        builder = getattr(t, name)
        given = {argument: name for argument in inspect.signature(builder).parameters}
        table = schema["$defs"][name]
        kinds = [key for kind in table.get("oneOf", []) for key in kind["properties"]]
        assert set(builder(**given)) == {*table["properties"], *kinds}
