"""What the builders of `stickslip.tables` have in common."""

from __future__ import annotations

from typing import Any


class Table(dict[str, Any]):
    """A table of the problem file: a dictionary, with keys as they are written there."""

    def __init__(self, given: dict[str, Any]) -> None:
        """From the arguments of a builder: ``rotation_z`` is ``rotation-z``, ``from_`` is ``from``, and ``None`` is left out."""
        names = (name for name, value in given.items() if value is not None and name not in ("self", "__class__"))
        super().__init__({name.rstrip("_").replace("_", "-"): given[name] for name in names})
