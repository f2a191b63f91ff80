"""What people see: how objects tell of themselves, pictures, results in folders, tables, progress, messages."""

import copy
import inspect
import logging
import pickle
import re

import numpy as np
import pytest

import stickslip


@pytest.fixture
def done(problem):
    return problem.build().run()


def test_objects_tell_what_they_are(problem, done):
    said = repr(problem)
    assert "press" in said and "block.bottom on base.top" in said and "coulomb(mu=0.3)" in said and "plane-strain" in said
    assert "time 0 to 2" in said
    said = repr(done)
    history = done.history
    assert f"{len(history['TIME'])} increments" in said and "base, block" in said and "peak pressure" in said
    contact = done.contact("press")
    assert f"{(contact.status == 2).sum()} slip" in repr(contact) and f"{contact.pressure.max():.4g}" in repr(contact)
    for thing in [problem, done, contact, history, contact.table]:
        html = thing._repr_html_()
        assert html.startswith("<table") and html.count("<tr>") == html.count("</tr>") > 1


def test_what_stands_in_html_cannot_be_code(case):
    case["title"] = "<script>alert(1)</script>"
    problem = stickslip.Problem.from_dict(case)
    assert "<script>" not in problem._repr_html_() and "&lt;script&gt;" in problem._repr_html_()


def test_pictures_are_those_of_the_program(done, tmp_path):
    picture = done.plot("CPRESS", size=(400, 300))
    assert picture._repr_png_().startswith(b"\x89PNG") and picture._repr_svg_() is None
    width, height = np.frombuffer(picture.data[16:24], dtype=">u4")
    assert (width, height) == (400, 300)
    assert picture.save(tmp_path / "a.png").read_bytes() == picture.data
    with pytest.raises(ValueError, match="this picture is a .png"):
        picture.save(tmp_path / "a.svg")
    drawn = done.plot("U1", ending="svg", scale=1, bodies=["block"])
    assert "<svg" in drawn._repr_svg_() and "U1" in drawn._repr_svg_()
    lines = done.plot(history=["press.CFN2", "press.CFS1"], ending="svg")
    assert "press.CFN2" in lines._repr_svg_()
    # The same picture comes of the files that a run writes.
    folder = done.save(tmp_path / "simulation")
    assert stickslip.open(folder).plot("CPRESS", size=(400, 300)).data == picture.data


def test_options_of_pictures_are_in_the_signature(done):
    parameters = inspect.signature(done.plot).parameters
    assert {"field", "ending", "scale", "view", "history", "against"} <= set(parameters)
    assert set(stickslip.PlotOptions.__annotations__) == set(parameters) - {"field", "ending"}


def test_pictures_say_what_is_wrong_with_them(done):
    for options, said in [
        ({"field": "CPRES"}, "did you mean `CPRESS`"),
        ({"body": "blok"}, "did you mean `block`"),
        ({"history": ["press.CFN3"]}, "near: press.CFN"),
        ({"colour": "red"}, "--colour"),
        ({"time": "all"}, "one time"),
    ]:
        with pytest.raises(ValueError, match=re.escape(said)):
            done.plot(**options)


def test_an_interface_is_drawn_as_it_is_now(problem):
    simulation = problem.build()
    next(simulation)
    contact = simulation.contact("press")
    assert contact.plot().data.startswith(b"\x89PNG")
    next(simulation)
    with pytest.raises(RuntimeError, match="the simulation has gone on"):
        contact.plot()
    again = pickle.loads(pickle.dumps(contact))
    assert np.array_equal(again.pressure, contact.pressure) and again.name == "press"
    with pytest.raises(RuntimeError, match="no bodies to be drawn"):
        again.plot()


def test_in_space_the_body_of_the_secondary_is_drawn():
    box = {"generate": {"box": {"to": [1, 1, 1], "cells": [1, 1, 1]}}, "material": "steel"}
    problem = stickslip.Problem.from_dict(
        {
            "format": 1,
            "model": {"space": "solid"},
            "material": {"steel": {"isotropic": {"young": 210e9, "poisson": 0.3}}},
            "body": {"cube": box},
            "obstacle": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
            "interface": {"foot": {"secondary": "cube.bottom", "primary": "floor"}},
            "support": {"top": {"set": "cube.top", "x": 0, "y": 0, "z": -1e-5}},
            "step": [{}],
        }
    )
    contact = problem.build().run().contact("foot")
    assert contact.plot(size=(300, 300)).data.startswith(b"\x89PNG")


def test_results_of_a_folder_are_opened(problem, tmp_path):
    folder = tmp_path / "case.out"
    simulation = problem.build().run(directory=folder)
    results = stickslip.open(folder)
    assert results.summary["completed"] is True
    assert results.interfaces == ["press"] and results.times[-1] == simulation.time
    assert list(results.history) == list(simulation.history)
    for name, column in simulation.history.items():
        assert np.array_equal(results.history[name], column, equal_nan=True)
    assert np.array_equal(results.points, simulation.points)
    fields = results.fields()
    assert np.allclose(fields["U"][:, :2], simulation.displacement, rtol=1e-12, atol=1e-300)
    assert np.allclose(results.contact("press").pressure, simulation.contact("press").pressure)
    assert "the run has come to its end" in repr(results) and "peak pressure" in results._repr_html_()
    assert results.report().name == "report.html"
    assert np.array_equal(pickle.loads(pickle.dumps(results)).times, results.times)
    with pytest.raises(KeyError, match="near: press"):
        results.contact("pres")
    with pytest.raises(IndexError, match="fields were written at"):
        results.fields(99)


def test_saved_results_are_those_of_now(problem, tmp_path):
    simulation = problem.build()
    for step in simulation:
        if step.time >= 1.0:
            break
    results = stickslip.open(simulation.save(tmp_path / "now.out"))
    assert results.times.tolist() == [simulation.time] and len(results.history["TIME"]) == len(simulation.history["TIME"])
    assert results.summary["completed"] is False
    assert stickslip.Problem.from_toml(tmp_path / "now.out" / "problem.toml").build().dim == 2
    simulation.run()
    assert simulation.time == 2.0 and simulation.summary["completed"] is True


def test_results_are_drawn_by_pyvista_too(problem, tmp_path):
    pytest.importorskip("pyvista")
    simulation = problem.build().run(directory=tmp_path / "case.out")
    grid = stickslip.open(tmp_path / "case.out").grid(warp=2.0)
    live = simulation.grid(warp=2.0)
    assert grid.n_cells == live.n_cells and np.allclose(grid.points, live.points)
    assert np.array_equal(grid.celltypes, live.celltypes)


def test_pictures_in_motion(problem, tmp_path):
    results = problem.build().run(directory=tmp_path / "case.out") and stickslip.open(tmp_path / "case.out")
    film = results.plot("U", animate="gif", rate=5, size=(300, 200))
    assert film.ending == "gif" and film.data.startswith(b"GIF89a")
    assert film._repr_mimebundle_() == {"image/gif": film.data} and film._repr_png_() is None
    assert b"acTL" in results.plot("U", animate="png", size=(300, 200)).data
    with pytest.raises(ValueError, match="no shapes of modes"):
        results.plot(mode=1)


def test_tables_become_data_frames(done, problem):
    pandas = pytest.importorskip("pandas")
    frame = done.history.to_pandas()
    assert frame.index.name == "TIME" and frame["press.CFN2"].iloc[-1] == done.history["press.CFN2"][-1]
    assert len(done.contact("press").table.to_pandas()) == 6
    rows = stickslip.sweep(problem, {"interface.press.friction.coulomb.mu": [0.1, 0.2]})
    frame = rows.to_pandas()
    assert list(frame["outcome"]) == ["done", "done"] and isinstance(frame, pandas.DataFrame)
    assert "2 runs, all done" in repr(rows) and rows._repr_html_().count("<tr>") == 3
    assert pickle.loads(pickle.dumps(rows)) == rows and type(copy.copy(done.history)) is stickslip.Table
    with pytest.raises(KeyError, match="near: press.CFN"):
        done.history["press.CFN"]


@pytest.mark.parametrize("missing", [[], ["tqdm"], ["tqdm", "rich"]], ids=["tqdm", "rich", "plain"])
def test_progress_is_shown_with_what_there_is(problem, monkeypatch, capsys, missing):
    for name in missing:
        monkeypatch.setitem(__import__("sys").modules, name, None)
        monkeypatch.setitem(__import__("sys").modules, f"{name}.auto", None)
    assert problem.build().run(progress=True).time == 2.0
    out, err = capsys.readouterr()
    assert "100" in out + err and "stickslip" in out + err
    assert problem.build().run().time == 2.0
    assert capsys.readouterr() == ("", "")


def test_what_happens_is_logged(problem, caplog):
    with caplog.at_level(logging.DEBUG, logger="stickslip"):
        problem.build().run()
    increments = [r for r in caplog.records if r.levelno == logging.DEBUG]
    assert len(increments) == 20 and "iterations" in increments[0].message


def test_findings_are_warnings(case, caplog):
    # Nothing presses the block on the base: it is pulled off.
    case["support"]["top-y"]["y"] = 1e-3
    with caplog.at_level(logging.INFO, logger="stickslip"):
        stickslip.Problem.from_dict(case).build().run()
    assert any(r.levelno == logging.WARNING and "press" in r.message for r in caplog.records)


def test_the_namespace_is_clean():
    import types

    public = {n for n, v in vars(stickslip).items() if not n.startswith("_") and not isinstance(v, types.ModuleType)}
    assert public | {"tables"} == set(stickslip.__all__)
    modules = {n for n, v in vars(stickslip).items() if not n.startswith("_") and isinstance(v, types.ModuleType)}
    assert modules <= {"mesh", "problem", "results", "simulation", "tables"}
    assert set(stickslip.__all__) <= set(dir(stickslip)) and "json" not in dir(stickslip)


def test_factors_are_made_again_where_they_are_missing(problem):
    factors = pickle.loads(pickle.dumps(stickslip.Factors()))
    first, second = (problem.build(factors=factors).run() for _ in range(2))
    assert np.array_equal(first.displacement, second.displacement)


def test_files_that_are_not_there_are_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text("format = 1\n")
    for read, name, said in [
        (stickslip.Problem.from_toml, "nofile", "nofile: there is no such file"),
        (stickslip.Problem.from_toml, "caes.toml", "there is no such file; near: case.toml"),
        (stickslip.Problem.from_toml, "no/case.toml", "there is no folder no"),
        (stickslip.Problem.from_inp, "job.inp", "job.inp: there is no such file"),
        (stickslip.open, "case.out", "case.out: there is no such folder"),
        (stickslip.open, "case.toml", "case.toml: this is a file"),
    ]:
        with pytest.raises(stickslip.FileError, match=re.escape(said)):
            read(name)


def test_a_name_with_an_equals_sign_may_be_a_file(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = stickslip.Problem.from_dict(case).to_toml()
    (tmp_path / "mu=0.3").write_text(text)
    assert "coulomb(mu=0.3)" in repr(stickslip.Problem.from_toml("mu=0.3"))
    with pytest.raises(stickslip.ProblemError):
        stickslip.Problem.from_toml("mu=0.4")


def test_messages_about_laws_name_the_function(problem):
    def halves(gap):
        return np.zeros(1 + len(gap))

    def words(gap):
        return "much"

    def three(gap):
        return gap, gap, gap

    for function, said in [(halves, "has to be of shape"), (words, "has to be numbers"), (three, "returns the pressure")]:
        with pytest.raises((ValueError, TypeError), match=said) as raised:
            problem.build(laws={"press": {"normal": function}}).run()
        assert function.__name__ in str(raised.value) and "test_results.py" in str(raised.value)
    with pytest.raises(TypeError, match="normal has to be a function, not float"):
        problem.build(laws={"press": {"normal": 2.0}})
