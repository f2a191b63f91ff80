"""Simulations: iteration, arrays, callbacks, files, signals."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import stickslip


@pytest.mark.parametrize("method", ["sparse", "condensed"])
def test_every_increment_is_seen_with_its_own_state(problem, method):
    problem = problem.with_values({"solver.method": method})
    seen = []
    simulation = problem.build()
    for step in simulation:
        assert simulation.time == step.time
        # The prescribed motion of the top tells which increment the state is of.
        assert simulation.displacement[:, 0].max() >= max(0.0, step.time - 1.0) * 1e-3 - 1e-15
        assert simulation.contact("press").force.sum() == pytest.approx(step.row["press.CFN2"], rel=1e-6)
        assert step.open + step.stick + step.slip == 6
        seen.append(step.time)
    assert len(seen) == 20 and seen == sorted(seen) and seen[-1] == 2.0
    assert simulation.summary["completed"] and simulation.summary["method"] == method
    assert list(simulation.history["TIME"]) == seen
    # What is over stays over.
    assert list(simulation) == []


def test_arrays_are_views_that_keep_their_increment(problem):
    simulation = problem.build()
    first = next(simulation)
    u = simulation.displacement
    assert u.shape == (13 * 5 + 6 * 6, 2) and not u.flags.writeable and not u.flags.owndata
    again = simulation.displacement
    assert u.__array_interface__["data"][0] == again.__array_interface__["data"][0]
    kept = u.copy()
    next(simulation)
    assert np.array_equal(u, kept) and not np.array_equal(simulation.displacement, kept)
    assert first.time == 0.5
    # They outlive the simulation.
    points = simulation.points
    last = simulation.displacement
    copies = points.copy(), last.copy()
    del simulation
    gc.collect()
    assert np.array_equal(points, copies[0]) and np.array_equal(last, copies[1])


def test_a_loop_can_be_left_and_taken_up(problem):
    wanted = problem.build().run().displacement
    simulation = problem.build()
    assert simulation.run(callback=lambda step: step.time < 1.2) is simulation
    assert 1.2 <= simulation.time < 1.3
    simulation.run()
    assert np.array_equal(simulation.displacement, wanted)


def test_results_are_written_into_a_directory(problem, tmp_path):
    problem.build().run(directory=tmp_path / "out")
    assert {"fields.pvd", "history.csv", "summary.json", "interfaces"} <= set(os.listdir(tmp_path / "out"))


def test_fields_and_the_grid(problem):
    pyvista = pytest.importorskip("pyvista")
    simulation = problem.build().run()
    fields = simulation.fields()
    assert fields["U"].shape == (101, 3) and fields["S"].shape[-1] == 6
    assert np.array_equal(fields["U"][:, :2], simulation.displacement)
    grid = simulation.grid(warp=2.0)
    assert isinstance(grid, pyvista.UnstructuredGrid)
    assert (grid.n_points, grid.n_cells) == (101, 73)
    assert np.allclose(grid.points[:, :2], simulation.points[:, :2] + 2.0 * simulation.displacement)
    assert np.count_nonzero(grid.cell_data["body"] == 1) == 25
    assert np.nanmax(grid.point_data["CPRESS"]) == pytest.approx(simulation.contact("press").pressure.max())
    assert grid.compute_cell_sizes()["Area"].sum() == pytest.approx(4.0, rel=1e-2)


def test_contact_has_one_entry_a_point(problem):
    contact = problem.build().run().contact("press")
    assert contact.pressure.shape == (6,) and contact.shear.shape == (6, 1) and contact.points.shape == (6, 3)
    assert set(contact.status) <= {0, 1, 2}
    slides = contact.status == 2
    assert np.allclose(np.abs(contact.shear[slides, 0]), 0.3 * contact.pressure[slides], rtol=1e-6)
    with pytest.raises(KeyError, match="near: press"):
        problem.build().contact("prss")


def test_a_run_that_cannot_go_on_says_why(case):
    case["support"]["top-x"] = {"set": "block.top", "x": 0.0}
    del case["support"]["top-y"]
    case["load"] = {"pull": {"set": "block.top", "traction": {"value": [0.0, 1e6]}}}
    simulation = stickslip.Problem.from_dict(case).build()
    with pytest.raises(stickslip.RunError) as caught:
        simulation.run()
    assert caught.value.help
    assert not simulation.summary["completed"]


def test_other_threads_run_while_it_solves(case):
    case["body"]["base"]["generate"]["rectangle"]["cells"] = [120, 60]
    case["step"] = [{"increments": {"fixed": 2}}]
    simulation = stickslip.Problem.from_dict(case).build()
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.perf_counter()
    simulation.run()
    ended = time.perf_counter()
    done.set()
    thread.join()
    inside = [t for t in ticks if begun < t < ended]
    assert len(inside) > 3


SLEEPER = """
import faulthandler, os, signal, sys, threading
import stickslip

# Where it hangs, if it does.
faulthandler.dump_traceback_later(90, exit=True)
# Shells start jobs in the background with the signal ignored, and Python then leaves it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
case = {case!r}
case["step"] = [{{"increments": {{"fixed": 100000}}}}]
simulation = stickslip.Problem.from_dict(case).build()
next(simulation)
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    simulation.run()
except KeyboardInterrupt:
    steps = len(simulation.history["TIME"])
    u = simulation.displacement
    assert not simulation.summary["completed"]
    assert steps < 100000 and simulation.time > 0.0 and u.min() < 0.0
    # Increments that were accepted, but not looked at yet, come first.
    for _ in range(40):
        next(simulation)
    assert len(simulation.history["TIME"]) > steps
    print("interrupted")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_interrupts_and_results_stay(case):
    done = subprocess.run(
        [sys.executable, "-c", SLEEPER.format(case=case)], capture_output=True, text=True, timeout=120
    )
    assert done.stdout.strip() == "interrupted", done.stderr
