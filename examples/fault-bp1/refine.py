"""Writes the case with smaller cells and several earthquakes.

    python3 refine.py CELL YEARS > fine.toml

CELL is the size of the cells on the fault down to 18 km in metres, of eight nodes; YEARS is how long the fault is followed.
"""

import pathlib
import re
import sys

BOX = 1_600_000
YEAR = 365.25 * 86400


def growing(start, end, first, factor):
    """Grid lines from start to end whose distances grow from the first by a factor."""
    lines, size = [start], first
    while lines[-1] + 1.5 * size < end:
        lines.append(round(lines[-1] + size, 3))
        size *= factor
    return lines + [end]


def main(cell, years):
    depths = growing(0, 18_000, cell, 1.0)
    depths += growing(18_000, 40_000, 1.1 * cell, 1.1)[1:]
    depths += growing(40_000, BOX, 1.2 * (depths[-1] - depths[-2]), 1.2)[1:]
    y = [-depth for depth in reversed(depths)]
    x = growing(0, BOX, cell, 1.15)
    text = (pathlib.Path(__file__).parent / "case.toml").read_text()
    text = text.replace("../../stickslip.schema.json", "./stickslip.schema.json")
    text = re.sub(r"\nx = \[.*?\]\ny = \[.*?\]\n", f'\nx = {x}\ny = {y}\nelement = "quad8"\n', text, flags=re.S)
    duration = years * YEAR
    for old, new in [
        ("y = 1.57788\n", f"y = {0.5e-9 * duration}\n"),
        ("table = [[1, 0], [3155760001, 1]]", f"table = [[1, 0], [{duration + 1}, 1]]"),
        ("duration = 3155760000", f"duration = {duration}"),
        ("# 100 years.", f"# {years} years."),
        ("over 100 years.", f"over {years} years."),
        ("# Cells of 400 m", f"# Cells of {cell} m"),
    ]:
        assert old in text, old
        text = text.replace(old, new)
    text = re.sub(r"\ntimes = \[.*?\]\n", "\n", text)
    print(text, end="")


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]))
