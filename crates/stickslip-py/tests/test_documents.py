"""The chapter of the book and the notebooks run, and notebooks are stored with what they show."""

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


def kept(cell):
    """What a cell has printed when it was stored."""
    return "".join("".join(o["text"]) for o in cell["outputs"] if o["output_type"] == "stream" and o["name"] == "stdout")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_notebooks_run_and_print_what_is_stored(path, capsys):
    pytest.importorskip("matplotlib").use("Agg")
    cells = json.loads(path.read_text())["cells"]
    code = [c for c in cells if c["cell_type"] == "code"]
    assert [c["execution_count"] for c in code] == list(range(1, len(code) + 1)), "store.py has not been run"
    space = {"__name__": "__main__"}
    for i, cell in enumerate(code):
        exec(compile("".join(cell["source"]), f"{path.name}, part {i + 1}", "exec"), space)
        assert capsys.readouterr().out == kept(cell), "what is stored is old: run notebooks/store.py"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_notebooks_are_stored_with_their_figures(path):
    cells = [c for c in json.loads(path.read_text())["cells"] if c["cell_type"] == "code"]
    drawn = [c for c in cells if any(word in "".join(c["source"]) for word in ["plt.plot", ".plot("])]
    assert drawn
    for cell in drawn:
        assert any("image/png" in output.get("data", {}) for output in cell["outputs"]), "".join(cell["source"])
    assert path.stat().st_size < 250_000
    assert not any(output["output_type"] == "error" for cell in cells for output in cell["outputs"])
