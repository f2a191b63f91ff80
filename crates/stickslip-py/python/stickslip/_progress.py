"""How far a run is: a bar of tqdm or rich where one of them is there, a plain line otherwise."""

from __future__ import annotations

import sys
import time
from typing import Any, Optional

#: Seconds between two plain lines on a terminal, and where output is not on a terminal.
_PATIENCE = (0.1, 10.0)
_WIDTH = 30


class Progress:
    """A bar from zero to one; `close` ends it."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._bar, self._close = _tqdm(title) or _rich(title) or _plain(title)

    def show(self, part: float, text: str = "") -> None:
        """Shows that this part is done."""
        self._bar(min(max(part, 0.0), 1.0), text)

    def close(self) -> None:
        """Leaves the bar as it is."""
        self._close()


def progress(wanted: Optional[bool], title: str) -> Optional[Progress]:
    """A bar if one is wanted."""
    return Progress(title) if wanted else None


def _tqdm(title: str) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    bar = tqdm(total=1.0, desc=title, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}{postfix}")

    def show(part: float, text: str) -> None:
        bar.set_postfix_str(text, refresh=False)
        bar.update(part - bar.n)

    return show, bar.close


def _rich(title: str) -> Any:
    try:
        from rich import progress as rich
    except ImportError:
        return None
    columns = (*rich.Progress.get_default_columns(), rich.TextColumn("{task.fields[text]}"))
    bar = rich.Progress(*columns)
    task = bar.add_task(title, total=1.0, text="")
    bar.start()
    return lambda part, text: bar.update(task, completed=part, text=text), bar.stop


def _plain(title: str) -> Any:
    terminal = sys.stderr.isatty()
    said = -float("inf")
    last = ""

    def show(part: float, text: str) -> None:
        nonlocal said, last
        now = time.monotonic()
        last = f"{title}: {100 * part:3.0f} % [{'#' * round(_WIDTH * part):<{_WIDTH}}] {text}"
        if now - said < _PATIENCE[not terminal] and part < 1.0:
            return
        said = now
        print(f"\r{last}\x1b[K" if terminal else last, end="" if terminal else "\n", file=sys.stderr, flush=True)

    def close() -> None:
        if terminal:
            print(f"\r{last}\x1b[K", file=sys.stderr, flush=True)

    return show, close
