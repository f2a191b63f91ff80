"""Problems: from dictionaries, text and files, with the same checks."""

import copy
import pathlib

import numpy as np
import pytest

import stickslip


def test_a_dict_and_its_toml_are_the_same_problem(case, tmp_path):
    problem = stickslip.Problem.from_dict(case)
    text = problem.to_toml()
    assert stickslip.Problem.from_toml(text).to_toml() == text
    file = tmp_path / "case.toml"
    file.write_text(text)
    assert stickslip.Problem.from_toml(file).to_toml() == text
    assert stickslip.Problem.from_toml(str(file)).to_toml() == text


def test_numpy_values_paths_tuples_and_none_are_understood(case):
    wanted = stickslip.Problem.from_dict(case).to_toml()
    case["amplitude"]["press"]["table"] = np.array([[0.0, 0.0], [1.0, 1.0]])
    case["body"]["base"]["generate"]["rectangle"]["cells"] = (np.int64(12), 4)
    case["support"]["top-y"]["y"] = np.float64(-1e-3)
    case["title"] = None
    assert stickslip.Problem.from_dict(case).to_toml() == wanted


def test_all_findings_come_at_once_with_their_keys(case):
    case["suport"] = {}
    case["step"][0]["durtion"] = 1
    with pytest.raises(stickslip.ProblemError) as caught:
        stickslip.Problem.from_dict(case)
    keys = {finding["key"] for finding in caught.value.findings}
    assert keys == {"suport", "step.1.durtion"}
    assert "did you mean `support`" in str(caught.value)


def test_messages_are_those_of_the_text(case, tmp_path):
    broken = copy.deepcopy(case)
    broken["support"]["base"]["set"] = "base.botom"
    text = stickslip.Problem.from_dict(broken).to_toml()
    messages = []
    for problem in (stickslip.Problem.from_dict(broken), stickslip.Problem.from_toml(text)):
        with pytest.raises(stickslip.ProblemError) as caught:
            problem.build()
        messages.append(caught.value.findings[0]["message"])
        assert caught.value.findings[0]["key"] == "support.base.set"
    assert messages[0] == messages[1]
    file = tmp_path / "case.toml"
    file.write_text(text)
    with pytest.raises(stickslip.ProblemError) as caught:
        stickslip.Problem.from_toml(file).build()
    line = caught.value.findings[0]["line"]
    assert "botom" in text.splitlines()[line - 1]
    assert str(caught.value).startswith(f"{file}:{line}:")


def test_values_without_a_place_are_named(case):
    case["support"]["base"]["x"] = object()
    with pytest.raises(TypeError, match=r"support\.base\.x"):
        stickslip.Problem.from_dict(case)


def test_files_that_are_not_there_are_errors_of_files(tmp_path):
    with pytest.raises(stickslip.FileError) as caught:
        stickslip.Problem.from_toml(tmp_path / "none.toml")
    assert pathlib.Path(caught.value.file) == tmp_path / "none.toml"
    assert isinstance(caught.value, OSError)
    with pytest.raises(stickslip.FileError) as caught:
        stickslip.Problem.from_toml("nofile")
    assert pathlib.Path(caught.value.file) == pathlib.Path("nofile")


def test_values_can_be_changed_by_key(problem):
    other = problem.with_values({"interface.press.friction.coulomb.mu": 0.1, "step.2.increments.fixed": 3})
    assert "mu = 0.1" in other.to_toml() and "fixed = 3" in other.to_toml()
    with pytest.raises(stickslip.ProblemError):
        problem.with_values({"interface.press.friction.coulomb.mu": -1.0})


def test_check_reports_without_running(problem):
    report = problem.check()
    assert report["interfaces"][0]["name"] == "press"
    assert "press" in str(report)


def test_the_schema_is_that_of_problem_files():
    assert "interface" in stickslip.schema()["properties"]
