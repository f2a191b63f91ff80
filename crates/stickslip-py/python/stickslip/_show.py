"""How things look in a notebook: pictures, and tables of a few lines."""

from __future__ import annotations

import html
import inspect
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Callable, Optional, TypeVar, Union

from . import _core
from ._options import PlotOptions


class Picture:
    """A picture that the program has drawn. Jupyter shows it; elsewhere `save` writes it."""

    def __init__(self, data: bytes, ending: str, notes: Iterable[str] = ()) -> None:
        #: The content of the file.
        self.data = data
        #: ``"png"``, ``"svg"`` or ``"gif"``.
        self.ending = ending
        #: What was chosen for the reader.
        self.notes = list(notes)

    def save(self, path: Union[str, os.PathLike[str]]) -> Path:
        """Writes the picture; its name has to end as the picture does, ``.png`` if nothing else was asked for."""
        file = Path(path)
        if file.suffix.lower() != f".{self.ending}":
            raise ValueError(f"{file}: this picture is a .{self.ending}; `plot(ending=\"{file.suffix[1:]}\")` may draw it so")
        file.write_bytes(self.data)
        return file

    def _repr_png_(self) -> Optional[bytes]:
        return self.data if self.ending == "png" else None

    def _repr_svg_(self) -> Optional[str]:
        return self.data.decode() if self.ending == "svg" else None

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, bytes]:
        return {"image/gif": self.data} if self.ending == "gif" else {}

    def __repr__(self) -> str:
        return f"<stickslip.Picture: {self.ending}, {len(self.data) / 1e3:.0f} kB; .save(\"NAME.{self.ending}\") writes it>"


_Plot = TypeVar("_Plot", bound=Callable[..., Any])


def with_options(plot: _Plot) -> _Plot:
    """A function that plots, with the options of the command in its signature: notebooks complete them, and `help` shows them."""
    signature = inspect.signature(plot)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    options = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in PlotOptions.__annotations__]
    setattr(plot, "__signature__", signature.replace(parameters=[*own, *options]))
    return plot


def draw(directory: Path, ending: str, options: dict[str, Any]) -> Picture:
    """A picture of a folder of results; the options are those of the command ``stickslip plot``."""
    if options.get("time") == "all":
        raise ValueError("time: a picture shows one time, `last` or a number from 1; `stickslip plot --time all` writes a file each")
    with tempfile.TemporaryDirectory(prefix="stickslip-") as folder:
        animated = options.get("animate")
        ending = animated or ending
        file = Path(folder) / f"plot.{ending}"
        arguments = [str(directory), "--animate" if animated else "--output", str(file)]
        options = {name: value for name, value in options.items() if name != "animate"}
        for name, value in options.items():
            arguments += _option(name, value)
        try:
            files, notes = _core.pictures(arguments)
        except ValueError as error:
            # The folder may be a temporary one.
            raise ValueError(str(error).removeprefix("error: ").removeprefix(f"{directory}: ")) from None
        return Picture(Path(files[0]).read_bytes(), ending, notes)


def _option(name: str, value: Any) -> list[str]:
    """An option of the command: lists are given one by one, pairs as the command writes them."""
    flag = "--" + name.rstrip("_").replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    if isinstance(value, list):
        return [part for one in value for part in _option(name, one)]
    if isinstance(value, tuple):
        value = ("x" if name == "size" else ",").join(str(part) for part in value)
    return [f"{flag}={value}"]


def table(title: str, rows: Iterable[tuple[str, Any]]) -> str:
    """A heading and lines of two columns, as HTML; lines without anything to say are left out."""
    body = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>{html.escape(str(value))}</td></tr>"
        for name, value in rows
        if value not in ("", None)
    )
    return f"<table><caption style='text-align:left'><b>{html.escape(title)}</b></caption>{body}</table>"


def lines(title: str, rows: Iterable[tuple[str, Any]]) -> str:
    """The same as text, for a terminal."""
    shown = [(name, str(value)) for name, value in rows if value not in ("", None)]
    width = max((len(name) for name, _ in shown), default=0)
    return "\n".join([title, *(f"  {name:<{width}}  {value}" for name, value in shown)])
