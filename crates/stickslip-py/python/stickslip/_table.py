"""Tables of columns and of rows, which pandas takes if it is there."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

if TYPE_CHECKING:
    import pandas

#: Rows of a table that a notebook shows: so many at its beginning, and at its end.
_SHOWN = 5


def _pandas(what: str) -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError(f"{what} needs pandas: `pip install pandas`") from error
    return pandas


class Table(dict[str, np.ndarray]):
    """Columns by name: a dict of arrays of one length. `to_pandas` makes a ``DataFrame`` of it."""

    def to_pandas(self) -> pandas.DataFrame:
        """As a ``pandas.DataFrame``; that of a history has the time as its index."""
        frame = _pandas("Table.to_pandas").DataFrame(dict(self))
        return frame.set_index("TIME") if "TIME" in frame and frame["TIME"].is_unique else frame

    def __missing__(self, name: str) -> NoReturn:
        raise KeyError(f"there is no column `{name}`{_near(name, list(self))}")

    def __repr__(self) -> str:
        rows = len(next(iter(self.values()), ()))
        return f"<stickslip.Table: {rows} rows of {len(self)} columns: {_some(list(self))}>"

    def _repr_html_(self) -> str:
        names = list(self)
        return _html(names, list(zip(*(self[name] for name in names))))


class Rows(list[dict[str, Any]]):
    """Rows, each a dict. `to_pandas` makes a ``DataFrame`` of them."""

    def to_pandas(self) -> pandas.DataFrame:
        """As a ``pandas.DataFrame``, a row a run; what a run has no value for is NaN."""
        return _pandas("Rows.to_pandas").DataFrame(list(self))

    def __repr__(self) -> str:
        outcomes = [row.get("outcome") for row in self]
        failed = sum(outcome != "done" for outcome in outcomes)
        well = "all done" if not failed else f"{failed} not done"
        return f"<stickslip.Rows: {len(self)} runs, {well}; columns {_some(self._names())}>"

    def _names(self) -> list[str]:
        return list(dict.fromkeys(name for row in self for name in row))

    def _repr_html_(self) -> str:
        names = self._names()
        return _html(names, [tuple(row.get(name, "") for name in names) for row in self])


def _some(names: list[str]) -> str:
    return ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")


def _near(name: str, names: list[str]) -> str:
    import difflib

    close = difflib.get_close_matches(str(name), names, n=5, cutoff=0.5)
    return f"; near: {', '.join(close)}" if close else f"; there are: {_some(names)}"


def _html(names: list[str], rows: list[tuple[Any, ...]]) -> str:
    def cell(value: Any) -> str:
        number = isinstance(value, (float, np.floating)) and not isinstance(value, bool)
        return f"<td>{html.escape(f'{value:.6g}' if number else str(value))}</td>"

    shown = rows if len(rows) <= 2 * _SHOWN else [*rows[:_SHOWN], ("...",) * len(names), *rows[-_SHOWN:]]
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = "".join("<tr>" + "".join(cell(value) for value in row) + "</tr>" for row in shown)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{len(rows)} rows</p>"
