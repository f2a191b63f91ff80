"""Peak, duration and impulse of the contact force of steel-bar: python3 filter.py [DIR ...], with the folders of results.

The force of an increment is taken as constant over it. It is smoothed by a moving mean over the period of the fastest wave
that the mesh can carry with lumped masses, pi h / c = 7.57 us: what swings faster or as fast is not of the bar. Then

- peak:     the largest smoothed force;
- duration: the time between the two moments at which the smoothed force crosses rho c v A / 2;
- plateau:  mean force over the middle 80 % of the theoretical duration, and the largest distance from it, smoothed and not;
- impulse:  the sum of force times increment, not smoothed.

All over their theoretical values.
"""

import csv
import sys
from pathlib import Path

import numpy as np

E, RHO, V, L, AREA, CELLS = 210e9, 7800.0, 10.0, 1.0, 0.01, 80
C = (E / RHO) ** 0.5
FORCE = RHO * C * V * AREA
DURATION = 2 * L / C
IMPULSE = 2 * RHO * AREA * L * V
WIDTH = np.pi * (L / CELLS) / C
STEP = 1e-7


def history(folder):
    """Time, increment and contact force."""
    with open(Path(folder) / "history.csv") as file:
        rows = list(csv.DictReader(file))
    return [np.array([float(row[key]) for row in rows]) for key in ("TIME", "DT", "hit.CFN3")]


def smoothed(time, dt, force, width=WIDTH):
    """The moving mean on a fine grid."""
    times = np.concatenate([[0.0], time])
    impulse = np.concatenate([[0.0], np.cumsum(force * dt)])
    grid = np.arange(-width, time[-1] - width / 2, STEP)
    ends = [np.interp(grid + side * width / 2, times, impulse) for side in (-1, 1)]
    return grid, (ends[1] - ends[0]) / width


def crossings(grid, force, level):
    """The first rise through the level and the last fall."""
    above = force >= level
    rise = np.nonzero(~above[:-1] & above[1:])[0][0]
    fall = np.nonzero(above[:-1] & ~above[1:])[0][-1]
    at = lambda i: grid[i] + STEP * (level - force[i]) / (force[i + 1] - force[i])
    return at(rise), at(fall)


def main():
    print(f"theory: {FORCE:.4g} N, {DURATION:.4g} s, {IMPULSE:.0f} N s; smoothed over {WIDTH:.3g} s")
    for folder in sys.argv[1:] or [Path(__file__).parent / "case.out"]:
        time, dt, force = history(folder)
        grid, smooth = smoothed(time, dt, force)
        rise, fall = crossings(grid, smooth, FORCE / 2)
        raw = (time > 0.1 * DURATION) & (time < 0.9 * DURATION)
        middle = (grid > 0.1 * DURATION) & (grid < 0.9 * DURATION)
        mean = np.sum((force * dt)[raw]) / np.sum(dt[raw])
        print(
            f"{folder}: peak {smooth.max() / FORCE:.4f} (not smoothed {force.max() / FORCE:.4f}), "
            f"duration {(fall - rise) / DURATION:.4f}, impulse {np.sum(force * dt) / IMPULSE:.4f}, "
            f"plateau {mean / FORCE:.4f}, off by {abs(smooth[middle] / FORCE - 1).max():.4f} "
            f"(not smoothed {abs(force[raw] / FORCE - 1).max():.4f})"
        )


if __name__ == "__main__":
    main()
