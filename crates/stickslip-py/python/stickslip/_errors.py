"""Exceptions, by the phase in which something goes wrong."""

from __future__ import annotations

from typing import Any, Optional


class Error(Exception):
    """What stickslip raises."""


class ProblemError(Error):
    """The problem is wrong.

    ``findings`` lists all that was found, each a dict: ``key`` (the path of the key, ``interface.base.friction``), ``message``,
    ``help``, and ``line`` and ``column`` of the text or ``None``.
    """

    def __init__(self, message: str, findings: Optional[list[dict[str, Any]]] = None) -> None:
        super().__init__(message)
        self.findings = findings or []


class MeshError(Error):
    """A mesh cannot be used. ``help`` says what to do, if anything is known."""

    def __init__(self, message: str, help: Optional[str] = None) -> None:
        super().__init__(message)
        self.help = help


class RunError(Error):
    """The analysis stopped before its end; results so far stay.

    ``time`` is how far it came, ``culprits`` names the points to look at, ``help`` says what to try.
    """

    def __init__(
        self, message: str, time: float = 0.0, culprits: Optional[list[str]] = None, help: Optional[str] = None
    ) -> None:
        super().__init__(message)
        self.time = time
        self.culprits = culprits or []
        self.help = help


class FileError(Error, OSError):
    """A file cannot be read or written. ``file`` is its path."""

    def __init__(self, message: str, file: Any = None) -> None:
        super().__init__(message)
        self.file = file


class Interrupted(Error):
    """The analysis was asked to stop at ``time``; results so far stay, and it can go on."""

    def __init__(self, message: str, time: float = 0.0) -> None:
        super().__init__(message)
        self.time = time
