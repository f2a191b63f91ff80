"""The options of `plot`. Written by `crates/stickslip-py/written.py` from those of the command `stickslip plot`."""

from __future__ import annotations

from typing import Literal, TypedDict, Union


class PlotOptions(TypedDict, total=False):
    """Options of ``stickslip plot``."""

    time: Union[Literal["peak", "last", "all"], int]
    """Output time: `peak`, when the contact pressure or the chosen field is largest (for wear and dissipation the last); `last`; a number from 1; or `all`, a file each"""

    scale: Union[Literal["auto"], float]
    """Factor of the displacements. `auto`: 1 for fields of contact, otherwise the largest becomes about a twentieth of the model, or less where that would open or close gaps"""

    view: str
    """View direction: iso, x, y, z, -x, -y, -z. Plane models are seen from z"""

    bodies: Union[str, list[str]]
    """Draw these bodies only. Can be repeated"""

    range: Union[str, tuple[Union[str, float], ...]]
    """Values at the ends of the colours. Default: the least and the largest value, or 99 % of the area where single points are far above the rest"""

    bands: int
    """Number of colours"""

    threshold: float
    """Do not draw values below this one"""

    apart: Union[Literal["auto"], float]
    """Distance at which bodies in contact are drawn apart. `auto`: as far as needed to see fields of contact in 3D; 0: not at all"""

    zoom: Union[Literal["auto", "contact", "whole"], float]
    """Part of the model: `contact`, `whole`, or a factor. `auto`: the contact, if it is small and a field of contact is shown"""

    at: Union[str, tuple[Union[str, float], ...]]
    """Centre of the picture"""

    mode: Union[str, int]
    """Draw a mode shape or a harmonic response: its number in the last modal step, or STEP:MODE with the name or number of the step"""

    animate: Literal["gif", "png"]
    """Write an animation through all output times, or the phases of a mode: animated PNG or GIF"""

    rate: int
    """Pictures per second"""

    regimes: Union[str, tuple[Union[str, float], ...]]
    """Draw which runs of a sweep stick, slip partially and slide, over two axes: `amplitude,load`; the ends of their names suffice"""

    stability: Union[str, tuple[Union[str, float], ...]]
    """Draw in which runs of a sweep steady sliding is stable, flutters or diverges, over two axes, with the boundary from `sweep --critical`"""

    coupling: str
    """Draw mode coupling, frequencies and growth, over a column of a map (`pad.out/modes-2-map.csv --coupling mu`) or an axis of a sweep, a picture each"""

    waterfall: bool
    """Draw a waterfall of spectra over time and frequency: `pad.out/modes-3-waterfall.csv --waterfall`"""

    along: str
    """Draw pressure, shear and status along this interface: in 2D curves over the arc length, in 3D maps in plan or unrolled. With --field that field alone; in 2D with --time all a line for each time. CWEAR and CDISS of the opposite surface go into a second file (NAME-opposite.svg)"""

    path: Union[str, tuple[Union[str, float], ...]]
    """Draw the field along a straight line through the bodies, between two undeformed places: `0,0,0:10,0,0`. With --time all a line for each time; with -o NAME.csv a table"""

    arrows: Literal["yes", "no"]
    """Draw tractions as arrows in the colours of stick and slip. Default: yes for contact fields in 2D"""

    cut: str
    """Draw only cells below this plane, to look inside. Default place: the middle of the model"""

    mirror: Union[str, list[str]]
    """Add the mirrored half beyond a plane of symmetry. Default place: the side of the model nearer to zero. Repeat it with a second plane for a quarter model"""

    loads: bool
    """Draw supports and loads as symbols, and the undeformed outline. Needs the mesh files of the problem beside the result folder"""

    units: Union[str, tuple[Union[str, float], ...]]
    """Units of length and stress in the legend: `mm,MPa`. Numbers are not converted"""

    size: tuple[int, int]
    """Width and height in pixels"""

    history: Union[str, list[str]]
    """Plot these columns of history.csv instead of bodies"""

    right: Union[str, list[str]]
    """Plot these columns on a second vertical axis, at the right"""

    table: str
    """Take the columns from this table instead of history.csv, for example `modes-2-map.csv`. The picture gets its name"""

    against: str
    """The column of the horizontal axis"""
