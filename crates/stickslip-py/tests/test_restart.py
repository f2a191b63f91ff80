"""Going on: from checkpoints in a folder of results, and from pickles."""

import os
import pickle

import numpy as np
import pytest

import stickslip


def weakening(pressure, speed):
    """A law that a module has by name."""
    return 0.4 * pressure / (1 + pressure / 1e9)


def bits(simulation):
    """All that there is to see, as bytes."""
    history = simulation.history
    contact = simulation.contact("press").table
    columns = [*history.values(), *contact.values(), simulation.displacement, simulation.forces]
    return list(history), [np.ascontiguousarray(column).tobytes() for column in columns]


@pytest.mark.parametrize("method", ["sparse", "condensed"])
def test_a_pickled_simulation_goes_on_with_the_same_bits(problem, method):
    problem = problem.with_values({"solver.method": method})
    whole = problem.build().run()
    for count in [0, 1, 5, 13, 20]:
        simulation = problem.build()
        for _ in range(count):
            next(simulation)
        data = pickle.dumps(simulation)
        again = pickle.loads(data)
        assert len(again.history.get("TIME", [])) == len(simulation.history.get("TIME", []))
        assert again.time == simulation.time
        again.run()
        assert bits(again) == bits(whole), count
        # The original is none the worse.
        assert bits(simulation.run()) == bits(whole), count
    # What is over stays over.
    assert list(pickle.loads(pickle.dumps(whole))) == []


def test_a_pickle_that_was_changed_is_refused(problem):
    simulation = problem.build()
    next(simulation)
    state = bytearray(simulation._core.state())
    state[len(state) // 2] ^= 1
    with pytest.raises(ValueError, match="the simulation is damaged"):
        problem._core.go_on(None, {}, bytes(state))


def test_problems_and_meshes_are_pickled_with_what_they_were_given(case, rectangle):
    points, cells = rectangle(np.linspace(1, 2, 6), np.linspace(0, 1, 6))
    sets = {"bottom": np.flatnonzero(points[:, 1] == 0.0), "top": np.flatnonzero(points[:, 1] == 1.0)}
    edges = np.column_stack([sets["bottom"][:-1], sets["bottom"][1:]])
    mesh = stickslip.Mesh(points, {"quad4": cells}, {"top": sets["top"]}, facet_sets={"bottom": edges})
    again = pickle.loads(pickle.dumps(mesh))
    assert (again.point_count, again.cell_count, again.sets) == (36, 25, mesh.sets)
    case["body"]["block"] = {"material": "steel", "gmsh": {"file": "block"}}
    problem = stickslip.Problem.from_dict(case, meshes={"block": mesh})
    again = pickle.loads(pickle.dumps(problem))
    assert again.to_toml() == problem.to_toml()
    assert bits(again.build().run()) == bits(problem.build().run())


def stopped(problem, directory, laws=None, until=1.2):
    """A run that is left in the middle."""
    problem.build(laws).run(lambda step: step.time < until, directory)


def files(directory):
    """What is in a folder of results, but for what is of a process."""
    out = {}
    for folder, _, names in os.walk(directory):
        for name in names:
            if not name.startswith("checkpoint_") and name != "summary.json":
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    out[os.path.relpath(path, directory)] = file.read()
    return out


@pytest.fixture
def saving(problem):
    return problem.with_values({"solver.method": "sparse", "output.checkpoint.increments": 4})


def test_a_run_in_a_folder_is_taken_up(saving, tmp_path):
    whole = saving.build().run(directory=tmp_path / "whole")
    stopped(saving, tmp_path / "stopped")
    again = stickslip.Simulation.resume(tmp_path / "stopped")
    assert len(again.history["TIME"]) == 4 * (len(whole.history["TIME"][: len(again.history["TIME"])]) // 4) > 0
    again.run()
    assert bits(again) == bits(whole)
    assert files(tmp_path / "stopped") == files(tmp_path / "whole")
    # From the command line as well.
    stopped(saving, tmp_path / "other")
    assert stickslip._core.command(["stickslip", "resume", str(tmp_path / "other"), "-q"]) == 0
    assert files(tmp_path / "other")["history.csv"] == files(tmp_path / "whole")["history.csv"]


def test_what_no_file_has_is_asked_for(saving, tmp_path):
    laws = {"press": {"friction": weakening}}
    whole = saving.build(laws).run()
    stopped(saving, tmp_path, laws)
    with pytest.raises(stickslip.FileError, match=r"the law press\.friction of this run is a function"):
        stickslip.Simulation.resume(tmp_path)
    assert stickslip._core.command(["stickslip", "resume", str(tmp_path), "-q"]) == 1
    again = stickslip.Simulation.resume(tmp_path, laws=laws)
    pickled = pickle.dumps(again)
    again.run()
    assert bits(again) == bits(whole)
    assert bits(pickle.loads(pickled).run()) == bits(whole)


def test_functions_without_a_name_cannot_be_pickled(problem):
    simulation = problem.build({"press": {"friction": lambda pressure, speed: 0.3 * pressure}})
    with pytest.raises(TypeError, match="friction law of interface `press` cannot be pickled: make it a function"):
        pickle.dumps(simulation)


def test_what_must_not_change_is_refused_by_its_key(saving, tmp_path):
    stopped(saving, tmp_path)
    other = saving.with_values({"interface.press.friction.coulomb.mu": 0.2})
    with pytest.raises(stickslip.ProblemError, match=r"interface\.press\.friction\.coulomb\.mu"):
        stickslip.Simulation.resume(tmp_path, other)
    longer = saving.with_values({"step.2.duration": 2})
    assert stickslip.Simulation.resume(tmp_path, longer).run().time == 3.0
    with pytest.raises(stickslip.FileError, match="no folder of results"):
        stickslip.Simulation.resume(tmp_path / "nowhere")
