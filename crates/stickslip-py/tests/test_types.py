"""Types: the package, notebooks and snippets of the READMEs pass `mypy --strict`, and mistakes do not; the types of a summary are those of a run."""

import json
import re
import subprocess
import sys
import typing
from pathlib import Path

import pytest

from stickslip import _summary

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]

WRONG = """
import numpy as np
import stickslip
from stickslip import tables as t

problem = stickslip.Problem.from_toml("case.toml")
simulation = problem.build().run()
simulation.plot("U1", scale=1, view="x", size=(800, 600), bodies=["a", "b"], time="last").save("a.png")
simulation.plot("U1", vew="x")  # wrong
simulation.plot("U1", size="800x600")  # wrong
simulation.summary["size"]["points"] + 1
simulation.summary["sise"]  # wrong
simulation.summary["interfaces"][0]["points"]["stik"]  # wrong
simulation.history["TIME"].max()
simulation.dips  # wrong
t.Interface(secondary="a.x", primary="b.y", friction=t.Friction.coulomb(mu=0.3))
t.Interface(secondary="a.x", primary="b.y", friction=t.Normal.linear(c=1.0))  # wrong
t.Interface(secondary="a.x", primary="b.y", fricton=t.Friction.coulomb(mu=0.3))  # wrong
t.Support(set="a.x", x="far")  # wrong
t.Model(space="plain-strain")  # wrong
t.Body(material="steel", mesh=stickslip.Mesh(np.zeros((3, 2)), {"tri3": [[0, 1, 2]]}))
stickslip.sweep(problem, {"a": np.linspace(0, 1, 3), "b": range(3), "c": [1, "x"]}, processes=2, stop=lambda row: row["a"] > 1)
stickslip.sweep(problem, {"a": 3})  # wrong
"""


def snippets():
    """A file for each notebook and for each README, with the Python that it has."""
    for path in sorted((HERE / "notebooks").glob("*.ipynb")):
        cells = [c for c in json.loads(path.read_text())["cells"] if c["cell_type"] == "code"]
        yield path.stem, "\n\n".join("".join(c["source"]) for c in cells)
    for page in [ROOT / "README.md", HERE / "README.md", ROOT / "book" / "src" / "python.md"]:
        if page.exists():
            yield f"{page.parent.name}-{page.stem}", "\n".join(re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S))


def mypy(folder, *arguments):
    pytest.importorskip("mypy")
    # What is known of NumPy is kept between runs, where there is a place for it.
    kept = ROOT / "target" if (ROOT / "target").exists() else folder
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file", HERE / "pyproject.toml", "--cache-dir", kept / "mypy", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder).stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("types")


def test_the_package_is_typed(folder):
    assert mypy(folder, HERE / "python" / "stickslip").startswith("Success")


def test_notebooks_and_readmes_are_typed_and_mistakes_are_found(folder):
    files = {"snippet_" + re.sub(r"\W", "_", name) + ".py": text for name, text in snippets()}
    assert len(files) >= 5 and all("stickslip" in text for text in files.values())
    for name, text in {**files, "wrong.py": WRONG}.items():
        (folder / name).write_text(text)
    # Each is a program of its own.
    said = mypy(folder, "--scripts-are-modules", *files, "wrong.py")
    found = {int(number) for number in re.findall(r"^wrong\.py:(\d+): error", said, re.M)}
    wanted = {i + 1 for i, line in enumerate(WRONG.splitlines()) if line.endswith("# wrong")}
    assert found == wanted, said
    assert not re.search(r"^snippet_.*error", said, re.M), said


def compare(value, kind, path):
    """Whether a value is of a type, and a dictionary has the keys of its type and no others."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if hasattr(kind, "__total__"):
        hints = typing.get_type_hints(kind)
        assert set(value) <= set(hints), f"{path}: {set(value) - set(hints)}"
        missing = set(hints) - set(value) - {"peak-pressure", "peak-traction"}
        assert not missing, f"{path}: {missing}"
        for key, entry in value.items():
            compare(entry, hints[key], f"{path}.{key}")
    elif origin is list:
        for entry in value:
            compare(entry, arguments[0], f"{path}.*")
    elif origin is dict:
        for key, entry in value.items():
            compare(entry, arguments[1], f"{path}.{key}")
    elif origin is typing.Union:
        assert value is None or not compare(value, arguments[0], path)
    elif kind is not typing.Any:
        assert isinstance(value, (int, float) if kind is float else kind), f"{path}: {value!r} is no {kind}"


def test_the_summary_has_the_keys_and_types_that_are_told(problem, case):
    import stickslip

    compare(problem.build().run().summary, _summary.Summary, "summary")
    # One with findings: nothing presses the block on the base.
    case["support"]["top-y"]["y"] = 1e-3
    summary = stickslip.Problem.from_dict(case).build().run().summary
    assert summary["findings"] and summary["findings"][0]["suspects"]
    compare(summary, _summary.Summary, "summary")
