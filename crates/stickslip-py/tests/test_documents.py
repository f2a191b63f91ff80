"""The chapter of the book and the notebooks run, and notebooks are stored without results."""

import json
import re
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[1]
BOOK = HERE.parents[1] / "book" / "src"
PAGES = sorted(p for p in BOOK.rglob("*.md") if "```python\n" in p.read_text())
NOTEBOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


def execute(code, name):
    space = {"__name__": "__main__"}
    for i, part in enumerate(code):
        exec(compile(part, f"{name}, part {i + 1}", "exec"), space)


def test_the_book_has_pages_with_python():
    assert not BOOK.exists() or len(PAGES) >= 2


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_pages_of_the_book_run(page, capsys, tmp_path, monkeypatch):
    """The Python of a page is one script, which may read the files that the page defines."""
    pytest.importorskip("pyvista")
    monkeypatch.chdir(tmp_path)
    for name, body in re.findall(r"^```\w+\n# file: (\S+)\n(.*?)^```", page.read_text(), re.M | re.S):
        (tmp_path / name).write_text(body)
    code = re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)
    execute(code, page.name)
    said = capsys.readouterr().out
    if page.name == "python.md":
        assert len(code) > 6
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
