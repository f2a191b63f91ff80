"""The condensed model that `export` writes, as NumPy reads it."""

import subprocess
import sys

import numpy as np

CASE = """
format = 1
model.space = "plane-strain"
body.pad = { generate.rectangle = { to = [1, 0.4], cells = [6, 3] }, material = "m", rayleigh = { mass = 0.01, stiffness = 1e-4 } }
material.m.isotropic = { young = 100.0, poisson = 0.3, density = 1.0 }
obstacle.belt.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "pad.bottom", primary = "belt", normal.linear = { c = 500.0 }, friction.coulomb = { mu = 0.6 }, primary-velocity = [1, 0] }
support.back = { set = "pad.top", x = 0, y = -1e-2 }
[[step]]
steady = {}
[[step]]
complex-modes = { count = 8, export = true }
"""


def condensed(folder, step):
    """Eigenvalues of the condensed model of a step, by NumPy."""
    part = lambda name: np.load(folder / f"modes-{step}-{name}.npy")
    k = part("reduced-stiffness") + part("reduced-friction-left") @ part("reduced-friction-right").T
    c = part("reduced-damping") + part("reduced-drag-left") @ part("reduced-drag-right").T
    m, one, none = part("reduced-mass"), np.eye(len(k)), np.zeros_like(k)
    companion = np.block([[none, one], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]])
    return np.linalg.eigvals(companion)


def check(folder):
    """Holds the arrays against the tables beside them."""
    table = np.genfromtxt(folder / "modes-2.csv", delimiter=",", names=True)
    assert len(table) == 8 and table["growth"].max() > 1e-3
    values = condensed(folder, 2)
    for row in table:
        ours = row["growth"] + 2j * np.pi * row["frequency"]
        assert np.abs(values - ours).min() < 1e-6 * abs(ours)
    basis, dofs = (np.load(folder / f"modes-2-{name}.npy") for name in ["reduced-basis", "dofs"])
    assert dofs.dtype == np.int64 and len(dofs) == len(basis) and set(dofs[:, 1]) == {0, 1}
    points = np.load(folder / "modes-2-friction-points.npy")
    right = np.load(folder / "modes-2-reduced-friction-right.npy")
    compliance = np.load(folder / "modes-2-compliance.npy")
    assert points.shape == (7, 2) and right.shape == (basis.shape[1], 7) and compliance.shape == (7, 7)
    # The gap at a sliding point is a displacement across the belt of the points there.
    assert (points[:, 0] == 0).all() and len(set(points[:, 1])) == 7


def test_the_condensed_model_has_the_eigenvalues_of_the_program(tmp_path):
    (tmp_path / "pad.toml").write_text(CASE)
    run = [sys.executable, "-m", "stickslip", "run", "pad.toml"]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    check(tmp_path / "pad.out")
