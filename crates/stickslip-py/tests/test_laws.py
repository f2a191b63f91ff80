"""Laws of contact as functions."""

import numpy as np
import pytest

import stickslip


def without_laws(case):
    del case["interface"]["press"]["normal"]
    del case["interface"]["press"]["friction"]
    return stickslip.Problem.from_dict(case)


@pytest.mark.parametrize("method", ["sparse", "condensed"])
@pytest.mark.parametrize("derivatives", [True, False])
def test_a_function_does_what_the_same_law_does(case, problem, method, derivatives):
    method = {"solver.method": method}
    wanted = problem.with_values(method).build().run()
    calls = []

    def normal(gap):
        calls.append(len(gap))
        pressure = 2e12 * np.maximum(-gap, 0.0)
        return (pressure, np.where(gap < 0.0, -2e12, 0.0)) if derivatives else pressure

    def friction(pressure, speed):
        limit = 0.3 * pressure
        return (limit, np.full_like(pressure, 0.3), 0.0) if derivatives else limit

    laws = {"press": {"normal": normal, "friction": friction}}
    got = without_laws(case).with_values(method).build(laws=laws).run()
    assert np.allclose(got.displacement, wanted.displacement, rtol=0.0, atol=1e-9 * np.abs(wanted.displacement).max())
    assert got.history["ALLFD"][-1] == pytest.approx(wanted.history["ALLFD"][-1], rel=1e-6)
    assert got.history["ALLCE"][-1] == pytest.approx(wanted.history["ALLCE"][-1], rel=1e-6)
    assert got.summary["quality"]["met"]
    # All points at once.
    assert max(calls) >= 6


def test_one_of_the_two_laws_can_be_a_function(problem):
    weaker = problem.with_values({"interface.press.friction.coulomb.mu": 0.15})
    wanted = weaker.build().run().history["press.CFS1"][-1]
    laws = {"press": {"friction": lambda pressure, speed: 0.15 * pressure}}
    assert problem.build(laws=laws).run().history["press.CFS1"][-1] == pytest.approx(wanted, rel=1e-6)


def test_an_exception_in_a_law_ends_the_run_and_is_raised(problem):
    def broken(gap):
        raise ZeroDivisionError("in my law")

    simulation = problem.build(laws={"press": {"normal": broken}})
    with pytest.raises(ZeroDivisionError, match="in my law"):
        simulation.run()


def test_a_result_of_the_wrong_shape_is_refused(problem):
    simulation = problem.build(laws={"press": {"normal": lambda gap: gap[:-1]}})
    with pytest.raises(ValueError, match=r"the pressure has to be of shape \(6,\)"):
        simulation.run()


def test_laws_for_what_is_not_there_are_refused(problem):
    with pytest.raises(ValueError, match="there is no interface `pres`; near: press"):
        problem.build(laws={"pres": {"normal": lambda gap: gap}})
    with pytest.raises(ValueError, match="no `norml`"):
        problem.build(laws={"press": {"norml": lambda gap: gap}})
