"""The command that comes with the package."""

import shutil
import subprocess
import sys

import pytest

import stickslip


def run(*arguments, **options):
    return subprocess.run(arguments, capture_output=True, text=True, timeout=120, **options)


def test_the_command_runs_a_case(problem, tmp_path):
    (tmp_path / "case.toml").write_text(problem.to_toml())
    done = run(sys.executable, "-m", "stickslip", "run", "case.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "case.out" / "summary.json").exists()
    bad = run(sys.executable, "-m", "stickslip", "run", "none.toml", cwd=tmp_path)
    assert bad.returncode == 1 and "none.toml" in bad.stderr


def test_a_script_beside_a_picture_draws_it_with_pyvista(problem, tmp_path):
    pytest.importorskip("pyvista")
    problem.build().run(directory=tmp_path / "case.out")
    drawn = run(sys.executable, "-m", "stickslip", "plot", "case.out", "-o", "p.png", "--script", "--mirror", "x=0", cwd=tmp_path)
    assert drawn.returncode == 0 and drawn.stdout.split() == ["p.png", "p.py"], drawn.stderr
    done = run(sys.executable, "p.py", "again.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "again.png").read_bytes().startswith(b"\x89PNG")


def test_the_command_is_installed():
    command = shutil.which("stickslip")
    if command is None:
        pytest.skip("the scripts of this environment are not on the path")
    done = run(command, "--version")
    assert done.returncode == 0 and stickslip.__version__ in done.stdout
