"""Problems and pages of the book that several tests use."""

import re
from pathlib import Path

import numpy as np
import pytest

import stickslip


@pytest.fixture
def case():
    """A block pressed on a base, then dragged, in plane strain."""
    return {
        "format": 1,
        "model": {"space": "plane-strain"},
        "material": {"steel": {"isotropic": {"young": 210e9, "poisson": 0.3}}},
        "body": {
            "base": {"material": "steel", "generate": {"rectangle": {"from": [0, -1], "to": [3, 0], "cells": [12, 4]}}},
            "block": {"material": "steel", "generate": {"rectangle": {"from": [1, 0], "to": [2, 1], "cells": [5, 5]}}},
        },
        "interface": {
            "press": {
                "secondary": "block.bottom",
                "primary": "base.top",
                "normal": {"linear": {"c": 2e12}},
                "friction": {"coulomb": {"mu": 0.3}},
            }
        },
        "support": {
            "base": {"set": "base.bottom", "x": 0, "y": 0},
            "top-y": {"set": "block.top", "y": -1e-3, "amplitude": "press"},
            "top-x": {"set": "block.top", "x": 1e-3, "amplitude": "drag"},
        },
        "amplitude": {"press": {"table": [[0, 0], [1, 1]]}, "drag": {"table": [[1, 0], [2, 1]]}},
        "step": [{"increments": {"fixed": 2}}, {"increments": {"fixed": 18}}],
    }


@pytest.fixture
def run_page(tmp_path, monkeypatch):
    """Runs the Python of a how-to of the book among its files, in a folder of its own; returns its names."""
    monkeypatch.chdir(tmp_path)

    def run(name):
        page = Path(__file__).resolve().parents[3] / "book" / "src" / "how-to" / name
        if not page.exists():
            pytest.skip("the book is not there")
        text = page.read_text()
        for file, body in re.findall(r"^```toml\n# file: (\S+)\n(.*?)^```", text, re.M | re.S):
            (tmp_path / file).write_text(body)
        names = {}
        for part in re.findall(r"^```python\n(.*?)^```", text, re.M | re.S):
            exec(compile(part, name, "exec"), names)
        return names

    return run


@pytest.fixture
def problem(case):
    return stickslip.Problem.from_dict(case)


def grid(x, y):
    """Points and quadrilaterals of a rectangle."""
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(points)).reshape(len(x), len(y))
    cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    return points, cells.reshape(-1, 4)


@pytest.fixture
def rectangle():
    return grid
