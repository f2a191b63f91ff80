"""Input decks of Abaqus and CalculiX."""

import pytest

import stickslip

DECK = """*HEADING
Two cubes
*NODE, NSET=ALL
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*MATERIAL, NAME=STEEL
*ELASTIC
210e9, 0.3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=TOP
LOWER, S2
*SURFACE, NAME=UNDER
UPPER, S1
*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e13
*FRICTION
0.3, 1e13
*CONTACT PAIR, INTERACTION=JOINT, TYPE=SURFACE TO SURFACE
UNDER, TOP
*NSET, NSET=BASE
1, 2, 3, 4
*NSET, NSET=HEAD
15, 16, 17, 18
*STEP
*STATIC
1., 1.
*BOUNDARY
BASE, 1, 3, 0.
HEAD, 1, 2, 0.
HEAD, 3, 3, -1e-4
*END STEP
"""


def test_a_deck_runs(tmp_path):
    file = tmp_path / "cubes.inp"
    file.write_text(DECK)
    problem = stickslip.Problem.from_inp(file)
    simulation = problem.build().run()
    (name,) = simulation.interfaces
    assert simulation.displacement[:, 2].min() == pytest.approx(-1e-4)
    assert simulation.contact(name).force.sum() > 0.0
    assert isinstance(problem.notes, list)
    assert "[interface." in problem.to_toml()


def test_what_a_deck_lacks_is_said_at_its_line(tmp_path):
    file = tmp_path / "cubes.inp"
    file.write_text(DECK.replace("MATERIAL=STEEL\n*SURFACE", "MATERIAL=STEL\n*SURFACE"))
    with pytest.raises(stickslip.ProblemError) as caught:
        stickslip.Problem.from_inp(file).build()
    finding = caught.value.findings[0]
    assert "STEL" in DECK.replace("STEEL", "STEL").splitlines()[finding["line"] - 1]
    assert f"cubes.inp:{finding['line']}: error: " in str(caught.value)
