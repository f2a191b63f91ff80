"""The wear coefficient that the page of the book fits to made-up scars is the one they were made with."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[3] / "book" / "src" / "how-to" / "wear-coefficient.md"


@pytest.mark.skipif(not PAGE.exists(), reason="the book is not there")
def test_the_coefficient_comes_back_from_scars_with_noise(tmp_path, monkeypatch):
    text = PAGE.read_text()
    monkeypatch.chdir(tmp_path)
    for name, body in re.findall(r"^```toml\n# file: (\S+)\n(.*?)^```", text, re.M | re.S):
        (tmp_path / name).write_text(body)
    space = {}
    for part in re.findall(r"^```python\n(.*?)^```", text, re.M | re.S):
        exec(compile(part, PAGE.name, "exec"), space)
    k, true, deviation = space["k"], space["true"], space["deviation"]
    assert k != space["guess"]
    assert abs(k - true) < 4 * deviation + 0.005 * true
    assert deviation < 0.01 * true
    # Without noise what is left is what jumps of 50 cycles and straight lines between them do.
    clean = [h for n in (500, 1000, 2000) for h in space["np"].interp(space["x_read"], space["places"], space["measured"][abs(space["n_measured"] - n).argmin()])]
    assert abs(space["model"](true) - clean).max() < 0.03 * max(clean)
