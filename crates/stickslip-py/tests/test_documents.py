"""The chapter of the book and the notebooks run, and notebooks are stored without results."""

import json
import re
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[1]
BOOK = HERE.parents[1] / "book" / "src" / "python.md"
NOTEBOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


def execute(code, name):
    space = {"__name__": "__main__"}
    for i, part in enumerate(code):
        exec(compile(part, f"{name}, part {i + 1}", "exec"), space)


@pytest.mark.skipif(not BOOK.exists(), reason="the book is not here")
def test_the_chapter_runs(capsys):
    pytest.importorskip("pyvista")
    code = re.findall(r"^```python\n(.*?)^```", BOOK.read_text(), re.M | re.S)
    assert len(code) > 6
    execute(code, BOOK.name)
    said = capsys.readouterr().out
    assert "suport - unknown key `suport` - did you mean `support`?" in said


def test_there_are_notebooks():
    assert len(NOTEBOOKS) >= 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_notebooks_run_and_are_clean(path, monkeypatch):
    pytest.importorskip("matplotlib").use("Agg")
    pyvista = pytest.importorskip("pyvista")
    monkeypatch.setattr(pyvista.UnstructuredGrid, "plot", lambda *a, **k: None)
    cells = json.loads(path.read_text())["cells"]
    code = [c for c in cells if c["cell_type"] == "code"]
    assert all(not c["outputs"] and c["execution_count"] is None for c in code)
    execute(["".join(c["source"]) for c in code], path.name)
