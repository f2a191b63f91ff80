"""Problems that several tests use."""

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
