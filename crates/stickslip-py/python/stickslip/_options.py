"""The options of `plot`. Written by `crates/stickslip-py/written.py` from those of the command `stickslip plot`."""

from __future__ import annotations

from typing import Literal, TypedDict, Union


class PlotOptions(TypedDict, total=False):
    """Options of ``stickslip plot``."""

    time: Union[Literal["peak", "last", "all"], int]
    """Which of the times at which fields were written: `peak`, at which contact presses most, or the field that is named is largest, and of wear and dissipation the last; `last`; a number from 1; or `all`, a file each"""

    scale: Union[Literal["auto"], float]
    """Factor of the displacements; with `auto` 1 where a field of contact is shown, elsewhere the largest is about a twentieth of the model, or less where that would open or close gaps"""

    view: str
    """From where one looks: iso, x, y, z, -x, -y, -z. Plane models are seen from z"""

    bodies: Union[str, list[str]]
    """Draw these bodies only; may be repeated"""

    range: Union[str, tuple[Union[str, float], ...]]
    """What the ends of the colours stand for. If not given, the least and the largest value; where single points are far from the rest, 99 % of the area"""

    bands: int
    """Draw in so many colours"""

    threshold: float
    """What is below is drawn as nothing"""

    apart: Union[Literal["auto"], float]
    """How far bodies that touch are drawn apart; with `auto` as far as contact needs to be seen, where a field of contact is shown in space; 0 leaves them where they are"""

    zoom: Union[Literal["auto", "contact", "whole"], float]
    """Which part is seen: `contact`, the patch that presses, `whole`, or how many times nearer. With `auto` the patch, if it is small and a field of contact is shown"""

    at: Union[str, tuple[Union[str, float], ...]]
    """What is in the middle of the picture"""

    along: str
    """Draw what this interface carries along its surface: in a plane pressure, shear and status over the arc, in space maps of them, in plan or unrolled. With --field that field alone, in a plane, with --time all a line a time; of CWEAR and CDISS that of the surface opposite as well, in a file of its own (NAME-opposite.svg)"""

    arrows: Literal["yes", "no"]
    """Tractions as arrows, in the colours of stick and slip: by themselves in contact views of plane problems"""

    cut: str
    """Draw only cells whose middle is below this plane, to look inside; through the middle of the model if no place is given"""

    mirror: Union[str, list[str]]
    """Draw the other half beyond a plane of symmetry as well; at the side of the model that is nearer to zero if no place is given. May be repeated: two planes make a whole of a quarter"""

    loads: bool
    """Draw supports and loads as symbols, and the outline of the bodies before any displacement. Mesh files of the problem are looked for beside the folder of the results"""

    units: Union[str, tuple[Union[str, float], ...]]
    """Units of length and stress for the legend: `mm,MPa`. Numbers stay as they are"""

    size: tuple[int, int]
    """Width and height in pixels"""

    history: Union[str, list[str]]
    """Plot these columns of history.csv instead of the bodies"""

    table: str
    """The table whose columns are meant, where it is not history.csv: `modes-2-map.csv`, say. The picture is named after it"""

    regimes: Union[str, tuple[Union[str, float], ...]]
    """Draw which runs of a sweep stick, slip in part and slide, over two of its axes: `amplitude,load`, the ends of their names will do"""

    stability: Union[str, tuple[Union[str, float], ...]]
    """Draw in which runs of a sweep steady sliding is stable, flutters and diverges, over two of its axes, with the boundary that `sweep --critical` has found"""

    coupling: str
    """Draw how modes couple: frequencies and growth of all over a column of a map (`pad.out/modes-2-map.csv --coupling mu`) or an axis of a sweep, a picture each"""

    waterfall: bool
    """Draw how strong a vibration is over time and frequency, from the table of its spectra: `pad.out/modes-3-waterfall.csv --waterfall`"""

    against: str
    """The column along the horizontal axis"""
