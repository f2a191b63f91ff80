"""Builders of the tables of a problem file: dictionaries whose keys an editor completes and `mypy` checks.

>>> from stickslip import Problem, tables as t
>>> steel = t.Material(isotropic=t.Isotropic(young=210e9, poisson=0.3))
>>> press = t.Interface(secondary="block.bottom", primary="base.top", friction=t.Friction.coulomb(mu=0.3))

Each is a dictionary with the keys of the problem file, and may stand among others. What a table is for and what its keys mean is said as in the reference
of the problem file, from which they come.

Written by `crates/stickslip-py/written.py` from `stickslip.schema.json`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np

from ._builders import Table
from .mesh import Mesh

#: Numbers, and rows of numbers.
Numbers = Union[Sequence[float], np.ndarray]
Rows = Union[Sequence[Sequence[float]], Sequence[np.ndarray], np.ndarray]

#: A direction of space, or an axis about which reference points turn.
Component = Literal["x", "y", "z", "rotation-x", "rotation-y", "rotation-z"]

#: Where in the increment contact forces are evaluated. Default: `stage` if the laws of all interfaces are compliant and couplings are springs and
ContactAt = Literal["end", "stage"]

#: Whether points in contact have mass.
ContactMass = Literal["redistributed", "as-meshed"]

#: Which diagonal splits a quadrilateral into two triangles. Of no effect on other plane elements.
Diagonal = Literal["up", "down", "alternating", "union-jack"]

#: The element family.
ElementKind = Literal["line2", "line3", "tri3", "tri6", "quad4", "quad8", "tet4", "tet10", "hex8", "hex20", "wedge6", "wedge15"]

#: How the state of rate-and-state friction changes.
Evolution = Literal["ageing", "slip"]

#: How quadrilateral facets of a primary surface are taken.
FacetShape = Literal["bilinear", "triangles"]

#: How the worn depth changes the gap.
Feedback = Literal["implicit", "explicit", "none"]

#: How the elements make strains of displacements.
Formulation = Literal["standard", "mean-dilatation", "reduced", "incompatible-modes"]

#: How the `.frd` file is written.
Frd = Literal["none", "text", "binary"]

#: Action on a figure above its limit.
GateMode = Literal["error", "warn", "off"]

#: What a map multiplies: the contact state of the step is kept.
MapOver = Literal["friction", "speed", "load"]

#: How the mass of a cell is given to its nodes.
MassKind = Literal["consistent", "lumped"]

#: Which of two surfaces is the secondary one.
Roles = Literal["by-mesh", "as-named"]

#: Which part of a ball is meshed.
Sector = Literal["full", "half", "quarter"]

#: How a point slips whose shear is on the boundary of an ellipse.
SlipDirection = Literal["associated", "against-traction"]

#: How the systems of Newton's method are solved.
Solution = Literal["automatic", "condensed", "sparse", "multigrid"]

#: The space in which the bodies live.
SpaceKind = Literal["plane-strain", "plane-stress", "axisymmetric", "solid"]

#: Treatment of initial gaps and overlaps of the meshes.
Start = Literal["as-meshed", "snap", "offset", "ramp"]

#: What becomes of the plane nearest to all heights.
Tilt = Literal["remove", "keep"]


class Along(Table):
    """A table over the reference coordinate along a direction, linear between its rows and constant beyond them.

    Parameters
    ----------
    along
        Direction of the coordinate, which is `along · x` for a point at `x`: [0, -1] is the depth below `y = 0`.
    table
        Rows [coordinate, value]; coordinates ascend.
    """

    def __init__(self, *, along: Numbers, table: Rows) -> None:
        super().__init__(locals())


class AmplitudeTable(Table):
    """[amplitude.NAME]: a factor over the time of the analysis, linear between the rows, constant outside.
    Increments land on its times.

    Parameters
    ----------
    table
        Rows [time, factor] with increasing times. Time counts from the start of the first step.
    """

    def __init__(self, *, table: Rows) -> None:
        super().__init__(locals())


class Anisotropic(Table):
    """The full tensor `a_ijkl` of pop_1995, eq. (2).

    The symmetries `a_ijkl = a_jikl = a_klij` and ellipticity are checked.

    Parameters
    ----------
    stiffness
        The stiffness, stresses and engineering strains in the order xx yy zz xy yz xz: six rows of six, or a
        list of 36 numbers (row by row), of 21 (the upper triangle, row by row), or of 81 (`a_ijkl`, the last index
        fastest).
    density
        Mass per volume; needed for gravity and dynamics only.
    """

    def __init__(self, *, stiffness: Entries, density: float | None = None) -> None:
        super().__init__(locals())


class Around(Table):
    """A line around which circles run.

    Parameters
    ----------
    axis
        Direction of the line.
    centre
        A point on the line. Default: the origin.
    """

    def __init__(self, *, axis: Numbers, centre: Numbers | None = None) -> None:
        super().__init__(locals())


class AxialSpring(Table):
    """A spring along the line between two points. The line is that between the points where they are meshed: their motion relative to the distance
    has to be small.

    Sets of n points stand for n springs, paired in the order of the points in the mesh; a set of one point pairs with all.

    Parameters
    ----------
    from_
        Where it begins: `body.set`, a [set.NAME], a body, or a [reference.NAME].
    stiffness
        Stiffness of each spring: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    to
        Where it ends: `body.set`, a [set.NAME], a body, or a [reference.NAME].
    """

    def __init__(self, *, from_: str, stiffness: float, to: str) -> None:
        super().__init__(locals())


class BallRegion(Table):
    """A ball; in 2D a disc.

    Parameters
    ----------
    centre
        Its centre.
    radius
        Its radius.
    """

    def __init__(self, *, centre: Numbers, radius: float) -> None:
        super().__init__(locals())


class Body(Table):
    """[body.NAME]: an elastic or rigid body: its mesh and what it is made of.

    Parameters
    ----------
    formulation
        Element formulation.
    material
        The [material.NAME] of all cells that are in none of the `regions`.
    rayleigh
        Damping of its own in dynamic steps.
    regions
        Materials by cell set of the mesh: `regions.coat = "bronze"`.
    rigid
        Whether the body is rigid: it moves and turns as a whole, with the mass and the moments of inertia of its mesh and `density`,
        which it must have. It may touch, be loaded, hang on springs and be supported like any other.

        Its rotation is linearised about the start, as that of elastic bodies is, unless `rotation` says otherwise; above about 0.1 rad (`largest-rotation` in the
        summary) it shows. The stiffness of its material is still wanted: interfaces take their scale from it. A support of some
        of its points must hold each of its motions fully or not at all, so that a point off the centre of mass is no support. Around
        an axis it moves along y alone.
    rotation
        How far the body may turn.
    scale
        Factor on the coordinates of the mesh, applied before `translate`: 1e-3 for a mesh in mm and a problem in m.
    translate
        Shift of the mesh.
    generate
        Built in: `generate.rectangle = { to = [0.04, 0.02], cells = [20, 10] }`.
    gmsh
        From a file of Gmsh: `.msh`, format 2.2 or 4.1, ASCII or binary.
    mesh
        From arrays, in Python: a `stickslip.Mesh`.
    """

    def __init__(self, *, formulation: Formulation | None = None, material: str | None = None, rayleigh: Rayleigh | None = None, regions: Mapping[str, str] | None = None, rigid: bool | None = None, rotation: BodyRotation | Literal["small", "large", "corotational"] | None = None, scale: float | None = None, translate: Numbers | None = None, generate: Generator | None = None, gmsh: GmshFile | None = None, mesh: Mesh | GivenMesh | None = None) -> None:
        super().__init__(locals())


class BodyForce(Table):
    """Force per volume, on cells.

    Parameters
    ----------
    value
        Force per volume, as many components as the space has.
    """

    def __init__(self, *, value: Numbers) -> None:
        super().__init__(locals())


class BodyRotation(Table):
    """How far a body may turn.

    Parameters
    ----------
    "small"
        By a few degrees: displacements and rotations are those of the linear theory.
    "large"
        By any angle, freely, in motion and at rest: the body has a frame of its own, which fits its points best, and strains are small in it. Supports hold its points
        altogether or not at all. At rest systems are solved sparse. An implicit scheme keeps the angular momentum where it is `generalised-alpha` with `rho = 1`, and central
        differences do; numerical dissipation takes spin as it does vibration. A rigid body turns with its moments of inertia; its supports hold its motions as wholes.
    "corotational"
        By any angle, cell by cell: each cell has a frame of its own, which fits its points best, and strains are small in it, so that the body may bend as far as it
        likes. Supports, springs, couplings and contact act on it as on any other body. Quasi-static steps; systems are solved sparse, with a matrix that is made and
        factored anew in most iterations.
    """

    @staticmethod
    def with_(value: str) -> BodyRotation:
        """By any angle, with the [reference.NAME] that is named: `rotation.with = "axle"`. The body is described in a frame that the reference point carries, and
        strains are small in it. Supports of its sets act along the axes of the frame: they hold the body *on the axle*; the axle itself is supported and turned
        at the reference point. What the body presses on, and loads unless they `follow`, are in space. In quasi-static steps. A rigid body needs no supports of its own,
        and moves in dynamic steps as well: a reference point that is held in all directions is a hinge. Off its centre of mass it has to be.
        """
        return BodyRotation({"with": value})


class BoxRegion(Table):
    """A box with sides along the axes.

    Parameters
    ----------
    from_
        Corner with the smallest coordinates.
    to
        Corner with the largest coordinates.
    """

    def __init__(self, *, from_: Numbers, to: Numbers) -> None:
        super().__init__(locals())


class Centrifugal(Table):
    """Centrifugal force of bodies that turn about an axis at a constant speed: density times `ω² r`, on cells, `r` the distance from the axis where the
    points are meshed.

    An amplitude, and the growth of the load over its first step, multiply the force, which goes with the square of the speed. Point masses at the cells
    take part.

    Parameters
    ----------
    speed
        Angular speed ω.
    axis
        Direction of the axis, of any length: needed in 3D. In the plane it is perpendicular to it.
    point
        A point of the axis, as many components as the space has; the origin if not given. In axial symmetry the axis is that of symmetry.
    """

    def __init__(self, *, speed: float, axis: Numbers | None = None, point: Numbers | None = None) -> None:
        super().__init__(locals())


class Change(Table):
    """Laws of an interface from this step on. Laws that are not given stay. Points keep their pressure, status and shear traction; the new laws apply from
    the first increment on.

    Parameters
    ----------
    friction
        The friction law: the largest shear traction of the interface.
    normal
        The normal law: pressure as a function of the gap.
    """

    def __init__(self, *, friction: Friction | None = None, normal: Normal | None = None) -> None:
        super().__init__(locals())


class CheckpointPlan(Table):
    """When checkpoints are written: whichever comes first.

    Parameters
    ----------
    increments
        After so many increments; 0: not by their number. Of condensed bodies up to sixteen are found together: then after the last of them.
    minutes
        Wall-clock minutes between checkpoints; 0: not by time.
    """

    def __init__(self, *, increments: int | None = None, minutes: float | None = None) -> None:
        super().__init__(locals())


class ChosenJump(Table):
    """Jumps that are as long as an error allows. `TIME` and `output.times` are those of all cycles then: where some are jumped over time jumps as well, and no jump goes past a time of
    output.

    Parameters
    ----------
    error
        Largest error of jumps, compared with computing all cycles: of the worn volume relative to itself, summed over the places of a surface without
        sign, and of the depth at every place relative to the greatest. A jump that is too long is repeated with fewer cycles.
    first
        Number of cycles of the first jump. Default: 1.
    largest
        Largest number of cycles of a jump. Default: all that remain.
    """

    def __init__(self, *, error: float, first: int | None = None, largest: int | None = None) -> None:
        super().__init__(locals())


class ComplexModes(Table):
    """`complex-modes` of a step: modes of steady sliding, those of least frequency first. An empty table takes the defaults.

    Parameters
    ----------
    count
        At most so many modes, pairs counted once.
    export
        Whether the matrices are written for other programs: over all unknowns as MatrixMarket files, condensed to few displacements as arrays of NumPy.
    friction_damping
        Whether friction damps: by turning with the sliding, and by the slope of its coefficient over the speed. The least damping is the safe side, and the default of
        Abaqus.
    map
        Frequencies and growth for other friction, speed or load: the contact state is kept, and what friction adds to the equations is multiplied, or evaluated anew.
    sensitivity
        Whether eigenvalues are differentiated by friction, contact stiffness, moduli, densities and damping, the contact state kept.
    shapes
        Whether shapes are written as fields, real and imaginary parts.
    to
        Highest frequency.
    """

    def __init__(self, *, count: int | None = None, export: bool | None = None, friction_damping: bool | None = None, map: FrictionRange | None = None, sensitivity: bool | None = None, shapes: bool | None = None, to: float | None = None) -> None:
        super().__init__(locals())


class ConstantsAt(Table):
    """Elastic constants at a temperature.

    Parameters
    ----------
    temperature
        The temperature.
    isotropic
        The same in all directions: two constants.
    orthotropic
        Three orthogonal planes of symmetry: nine constants.
    anisotropic
        The full tensor: up to 21 constants.
    """

    def __init__(self, *, temperature: float, isotropic: Isotropic | None = None, orthotropic: Orthotropic | None = None, anisotropic: Anisotropic | None = None) -> None:
        super().__init__(locals())


class Coupling(Table):
    """[coupling.NAME]: an equation between displacements, a spring, a gap or a dashpot between points, or what ties points to a reference point.

    Over the step in which it becomes active an equation leads its sum linearly from what it is to the value, unless an amplitude says otherwise; in a step
    that does not list it, it lets go like a support. A spring that is active in the first step acts in full from the beginning; later the
    stiffness grows and falls linearly over a quasi-static step, like a load. So do the stiffness of a gap, which without one acts at once, and the
    coefficient of a dashpot.

    Parameters
    ----------
    amplitude
        An [amplitude.NAME] over the time of the analysis, by which the value of an equation, the stiffness of a spring or gap, or
        the coefficient of a dashpot is multiplied.
    equation
        A weighted sum of displacements has a given value.
    spring
        A spring against a weighted sum of displacements.
    axial_spring
        A spring along the line between two points.
    gap
        A weighted sum of displacements does not fall below a value.
    dashpot
        A damper against the rate of a weighted sum of displacements.
    kinematic
        Points follow a reference point as if they were rigid with it.
    distributing
        A reference point follows the mean motion of points, and hands its forces on to them.
    """

    def __init__(self, *, amplitude: str | None = None, equation: Equation | None = None, spring: Spring | None = None, axial_spring: AxialSpring | None = None, gap: Gap | None = None, dashpot: Dashpot | None = None, kinematic: Kinematic | None = None, distributing: Distributing | None = None) -> None:
        super().__init__(locals())


class Cycles(Table):
    """Cycles of a step. The time of the analysis advances by one duration for each computed cycle, with chosen jumps for each completed cycle; amplitude
    tables count one cycle.

    Parameters
    ----------
    count
        Number of cycles.
    jump
        Number of cycles that each computed one stands for: its wear counts that often. Or the largest error of jumps over cycles, `{ error = 0.01 }`,
        from which each jump is chosen. Default: 1.
    """

    def __init__(self, *, count: int, jump: Jump | None = None) -> None:
        super().__init__(locals())


class Cylinder(Table):
    """A rigid circular cylinder, infinitely long; in a plane problem a circle.

    Parameters
    ----------
    centre
        A point on its axis.
    radius
        Radius.
    axis
        Direction of its axis; not given in a plane problem.
    inside
        `true` for a bore: the bodies are inside. Default: `false`.
    """

    def __init__(self, *, centre: Numbers, radius: float, axis: Numbers | None = None, inside: bool | None = None) -> None:
        super().__init__(locals())


class Damping(Table):
    """Contact damping: pressure as a function of the closing velocity."""

    @staticmethod
    def none() -> Damping:
        """No damping: pressure follows from the gap alone. No parameters."""
        return Damping({"none": Table(locals())})

    @staticmethod
    def viscous(*, coefficient: float) -> Damping:
        """A dashpot: extra pressure proportional to the velocity at which the surfaces approach.

        It acts in full from the first touch: surfaces that meet at a velocity feel a jump of pressure, and surfaces that part
        lose contact before the gap opens. Hunt and Crossley 1975 avoid both.

        Parameters
        ----------
        coefficient
            Pressure per closing velocity [Pa s/m].
        """
        return Damping({"viscous": Table(locals())})

    @staticmethod
    def hunt_crossley(*, coefficient: float) -> Damping:
        """Damping in proportion to the pressure: `p (1 + coefficient ġ)` in all, with the closing velocity ġ
        (Hunt and Crossley 1975).

        The extra pressure is zero where contact begins and ends, so that nothing jumps. On a normal law that is a power of the
        penetration a rigid mass that strikes at a velocity `v` comes back at about `v (1 - 2/3 coefficient v)`, whatever the
        power, if that is a small loss.

        Parameters
        ----------
        coefficient
            Extra pressure over pressure, per closing velocity.
        """
        return Damping({"hunt-crossley": Table(locals())})


class Dashpot(Table):
    """A dashpot: a viscous force on a linear combination of velocities. It does not act in quasi-static steps.

    Sets of n points stand for n dashpots, as with equations. What they take counts with damping in the balance of energies.

    Parameters
    ----------
    coefficient
        Force of each dashpot per velocity [N s/m]: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    terms
        The elongation: [{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }].
    """

    def __init__(self, *, coefficient: float, terms: Sequence[Term]) -> None:
        super().__init__(locals())


class Discretisation(Table):
    """Where contact is evaluated."""

    @staticmethod
    def mortar(*, smooth_angle: float | None = None, two_sided: bool | None = None) -> Discretisation:
        """Surface to surface, the default: the gap of a node is a mean over the faces around it, weighted by a dual function, over what the two
        surfaces have in common (Puso and Laursen 2004,
        Popp et al. 2012).

        A uniform pressure passes between any two meshes without error, and forces do not jump when nodes slide from facet to facet. Linear and
        quadratic faces, in 2D and 3D. On an obstacle, which has no facets, contact is checked at points, as with `node-to-facet`.

        Parameters
        ----------
        smooth_angle
            Angle between neighbouring faces of the secondary [°] up to which the surface is taken as smooth there, and normals are
            averaged; across sharper edges each side has contact points of its own. Default: 30.
        two_sided
            Both surfaces are secondary, each for one half of the pressure: the result does not depend on which is called primary. Costs twice as
            much, and needs `enforcement.penalty` or a compliant normal law without friction: multipliers of both sides would not be determined. Results of the
            second half stand under `NAME-reverse`. Default: false.
        """
        return Discretisation({"mortar": Table(locals())})

    @staticmethod
    def node_to_facet() -> Discretisation:
        """The paper's contact elements (Pop 1995, eq. 27-40): each point of the secondary meets the facet it lies over.
        Cheaper by a part, and with second derivatives in the tangent, but between meshes that do not match a uniform pressure comes out wrong by some
        5 to 20 %, however fine they are. No parameters.
        """
        return Discretisation({"node-to-facet": Table(locals())})


class Distributing(Table):
    """A reference point follows the mean motion of points: its displacement and rotation are those of the rigid motion that comes nearest to theirs, each point
    counting by its weight. Forces and moments on it spread over them: by weight, and for a moment by weight and distance from their centre. Nothing
    becomes stiffer.

    Where the points lie on a line, or are one, nothing turns about it, and a moment there is refused. As long as the reference point bears nothing but loads the
    coupling costs nothing; where it is supported, or tied to something else, it is six equations over all points.

    Parameters
    ----------
    reference
        The [reference.NAME] that follows them.
    set
        The points: `body.set`, a [set.NAME], or a body.
    weights
        How much each point counts.
    """

    def __init__(self, *, reference: str, set: str, weights: Weights | Literal["area", "uniform"] | None = None) -> None:
        super().__init__(locals())


class Dynamic(Table):
    """[step.dynamic]: the bodies have inertia in this step. An empty table takes the defaults.

    The velocities at its start are those of the step before (zero after a quasi-static one) or those of [initial.NAME]; the
    accelerations follow from the equations of motion. A load without an amplitude acts at once in full, and a support
    or load that is not listed any more lets go at once.

    Parameters
    ----------
    contact_at
        Where in the increment contact forces are evaluated. Default: `stage` if the laws of all interfaces are compliant and couplings are springs and
        dashpots only, else `end`.
    contact_mass
        Mass of contact points. Default: redistributed if the normal law is unilateral, as meshed if it is compliant or the scheme explicit. Tied surfaces
        keep their mass.
    error
        Largest local error of the displacements over an increment, relative to the motion since the start of the step; an increment with
        more is halved. Not checked if not given.
    events
        Time to which opening, closing, sticking and slipping are located: an increment over which a point changes
        status is halved until it is no longer than this. Not located if not given.
    mass
        Mass matrix of cells. An explicit scheme has lumped masses.
    scheme
        How the equations of motion are integrated.
    """

    def __init__(self, *, contact_at: ContactAt | None = None, contact_mass: ContactMass | None = None, error: float | None = None, events: float | None = None, mass: MassKind | None = None, scheme: Scheme | None = None) -> None:
        super().__init__(locals())


class Enforcement(Table):
    """How the contact and sticking constraints are enforced."""

    @staticmethod
    def penalty(*, factor: float | None = None, stiffness: float | None = None, tangential_factor: float | None = None, tangential_stiffness: float | None = None) -> Enforcement:
        """Springs against penetration and slip of sticking points. Their penetration is reported and not corrected.

        Parameters
        ----------
        factor
            Stiffness against penetration as a multiple of the bodies' own, `M / h`. Default: 100.
        stiffness
            Stiffness against penetration per area, instead of `factor`.
        tangential_factor
            Stiffness of sticking as a multiple of `M / h`. Default: as against penetration.
        tangential_stiffness
            Stiffness of sticking per area, instead of `tangential-factor`.
        """
        return Enforcement({"penalty": Table(locals())})

    @staticmethod
    def perturbed_lagrangian(*, factor: float | None = None, stiffness: float | None = None, tangential_factor: float | None = None, tangential_stiffness: float | None = None) -> Enforcement:
        """Perturbed Lagrangian: the tractions are unknowns of Newton's iteration, coupled to the gaps by the blocks `-1/ω` of
        Pop 1995, eq. (27) and (33)-(38). They are eliminated point by point before the solve.

        Parameters
        ----------
        factor
            ω against penetration as a multiple of the bodies' own stiffness `M / h`. Default: 10⁴.
        stiffness
            ω against penetration per area, instead of `factor`.
        tangential_factor
            ω of sticking as a multiple of `M / h`. Default: as against penetration.
        tangential_stiffness
            ω of sticking per area, instead of `tangential-factor`.
        """
        return Enforcement({"perturbed-lagrangian": Table(locals())})

    @staticmethod
    def augmented_lagrangian(*, error: float | None = None, factor: float | None = None, stiffness: float | None = None) -> Enforcement:
        """Augmented Lagrangian: as the perturbed one, with a moderate stiffness whose yielding is removed by updating the multipliers until what is left is
        below `error` times the elastic approach (Simo and Laursen 1992). The default:
        the answer does not depend on the stiffness, only the number of updates does. Where an update gains less than a factor of ten the stiffness
        is raised tenfold, up to 10⁶ times the bodies' own, so that even the wrong one gets there.

        Parameters
        ----------
        error
            Largest penetration, and largest false slip of a sticking point, relative to the elastic approach. Default: 10⁻⁴.
        factor
            Stiffness to start with as a multiple of the bodies' own, `M / h`. Default: 1000.
        stiffness
            Stiffness to start with per area, instead of `factor`.
        """
        return Enforcement({"augmented-lagrangian": Table(locals())})


class Engine(Table):
    """The linear solver that factors condensed bodies, and keeps the factors."""

    @staticmethod
    def multifrontal() -> Engine:
        """The built-in multifrontal factorisation, on the threads of this process: the same bits in every run, on any number of threads. No parameters."""
        return Engine({"multifrontal": Table(locals())})

    @staticmethod
    def mumps(*, low_rank: float | None = None, memory: float | None = None, out_of_core: bool | None = None, ranks: int | None = None, spread: bool | None = None) -> Engine:
        """MUMPS on the ranks of an MPI job: one body over many processes, for factors that are too large for one.

        The job is started by `mpirun`, the program of its ranks is built by `cargo xtask engine mumps`. Last digits may differ from run to run.

        Parameters
        ----------
        low_rank
            Accuracy, relative to the matrix, to which blocks of the factor are compressed: less work for large bodies. Nothing is compressed if not given.
        memory
            Most memory that a rank may take for a body, in MB: a body that takes more is refused. No limit if not given.
        out_of_core
            Whether factors are kept in files instead of in memory.
        ranks
            Processes.
        spread
            Whether the compliance of the contact candidates stays with the ranks. If not given, where it would take more than half of what is free in the first process.
        """
        return Engine({"mumps": Table(locals())})


class Equation(Table):
    """A linear equation between displacements: the sum of factor times displacement has a value. It holds exactly, not by a stiff spring.

    Sets of n points stand for n equations, paired in the order of the points in the mesh; a set of one point pairs with all, itself left out. Equations that
    say the same twice do no harm. They hold exactly in explicit steps, too.

    Parameters
    ----------
    terms
        What is summed up: [{ set = "a.left", component = "x" }, { set = "b.right", component = "x", factor = -1 }].
    value
        What the sum is; zero if not given.
    """

    def __init__(self, *, terms: Sequence[Term], value: float | None = None) -> None:
        super().__init__(locals())


class ExpansionTable(Table):
    """Coefficients of thermal expansion by temperature.

    They are secants, as Abaqus and CalculiX have them: at the temperature `T` a material is `α(T) (T - zero)` longer than at `zero`. Between rows
    they are linear, outside constant. The strain is what has come since the start: none at the initial temperature.

    Parameters
    ----------
    table
        Rows of a temperature and one coefficient, or three along the axes; temperatures increase.
    axes
        Directions of the axes 1 and 2 in space, where they are not those of the elastic constants.
    zero
        The temperature at which the secants begin.
    """

    def __init__(self, *, table: Rows, axes: Rows | None = None, zero: float | None = None) -> None:
        super().__init__(locals())


class FacetSection(Table):
    """A section along facets inside a mesh: a physical surface of Gmsh within a volume, faces of elements of a deck.

    Parameters
    ----------
    set
        The facets, `body.set`. They run through the whole section, from surface to surface.
    normal
        Along the bolt, of any length; the mean normal of the facets if not given.
    """

    def __init__(self, *, set: str, normal: Numbers | None = None) -> None:
        super().__init__(locals())


class Fatigue(Table):
    """[output.fatigue]: criteria of fretting fatigue, which are evaluated for every cycle that is computed in steps with `cycles`.

    Parameters
    ----------
    criteria
        Criteria: `criteria = [{ findley = { k = 0.3 } }, { ruiz = {} }]`. Each has a field of its name with the values of the last cycle and one with the
        normals of the worst planes, columns of its largest value in `cycles.csv`, and an entry in the summary.
    depth
        Distance from interfaces within which points are evaluated, as meshed. Default: all points of bodies at an interface.
    """

    def __init__(self, *, criteria: Sequence[FatigueModel], depth: float | None = None) -> None:
        super().__init__(locals())


class FatigueModel(Table):
    """A criterion of fretting fatigue."""

    @staticmethod
    def ruiz() -> FatigueModel:
        """The second parameter named after Ruiz (see Ruiz, Boddington and Chen 1984), `σ_T τ δ` [Pa² m]: the largest tension along the surface in the direction of the slip, times the
        largest shear traction, times the slip from end to end of a cycle. At points of interfaces, on both sides.
        """
        return FatigueModel({"ruiz": Table(locals())})

    @staticmethod
    def ruiz_work() -> FatigueModel:
        """The first parameter named after Ruiz (see Ruiz, Boddington and Chen 1984), `τ δ`: the largest shear traction times the slip from end to end of a cycle. At points of
        interfaces, on both sides.
        """
        return FatigueModel({"ruiz-work": Table(locals())})

    @staticmethod
    def smith_watson_topper() -> FatigueModel:
        """Smith, Watson and Topper 1970 on the critical plane: the largest `σ_n,max ε_a` of all planes, with the largest stress across the plane and the amplitude of the elastic strain
        across it, half of its range. Zero where no plane ever opens.
        """
        return FatigueModel({"smith-watson-topper": Table(locals())})

    @staticmethod
    def findley(*, k: float) -> FatigueModel:
        """Findley 1959: the largest `τ_a + k σ_n,max` of all planes. The amplitude `τ_a` is the radius of the smallest circle around the path of the shear in the plane,
        `σ_n,max` the largest stress across it.

        Parameters
        ----------
        k
            How much the normal stress counts: 0.2 to 0.3 for ductile steels.
        """
        return FatigueModel({"findley": Table(locals())})

    @staticmethod
    def dang_van(*, a: float) -> FatigueModel:
        """Dang Van 1993 by planes: the largest `τ(t) + a p_h(t)` of all planes and times. The microscopic shear `τ(t)` is counted from the middle of the smallest circle around the path of the
        shear in the plane, where grains that adapt leave it; `p_h` is a third of the trace of the stress, positive in tension.

        Parameters
        ----------
        a
            How much the hydrostatic stress counts; from the limits of torsion `t` and of bending `f`, both alternating: `3 (t/f - 1/2)`.
        """
        return FatigueModel({"dang-van": Table(locals())})


class Friction(Table):
    """The friction law: the largest shear traction of the interface."""

    @staticmethod
    def none() -> Friction:
        """No friction: the interface carries pressure only. No parameters."""
        return Friction({"none": Table(locals())})

    @staticmethod
    def coulomb(*, mu: float, cap: float | None = None) -> Friction:
        """Coulomb friction: limit `μ p`, at most `cap`.

        Parameters
        ----------
        mu
            Coefficient of friction μ.
        cap
            Largest shear traction, e.g. the shear yield stress. Default: none.
        """
        return Friction({"coulomb": Table(locals())})

    @staticmethod
    def orthotropic(*, mu: Numbers, around: Around | None = None, axis: Numbers | None = None, cap: float | None = None, slip: SlipDirection | None = None) -> Friction:
        """Orthotropic friction: one coefficient along an axis of the surface and another across it, `(t₁/μ₁)² + (t₂/μ₂)² <= p²`.

        The axis is that of scratches, rolling marks or fibres of the primary surface. It keeps its direction in space, and at each point counts as projected on the surface. The two
        slip directions, with the shear that belongs to a slip, are those of Michałowski and Mróz 1978. In two dimensions
        a point slides in one direction alone, and the coefficient is that of this direction.

        Parameters
        ----------
        mu
            Coefficients of friction along the axis and across it.
        around
            Instead of `axis`: the line around which the axes are circles, as turning leaves them.
        axis
            The axis. Its part along the normal of the surface has no effect.
        cap
            Largest shear traction along the axis with the larger coefficient; across it is less in the ratio of the coefficients. Default: none.
        slip
            How a point slips at the limit. Default: associated.
        """
        return Friction({"orthotropic": Table(locals())})

    @staticmethod
    def power_law(*, c: float, m: float, cap: float | None = None) -> Friction:
        """Generalised friction `c δ^m`, at most `cap`, with the penetration δ: Pop 1995, eq. (6).

        With the exponent of the normal compliance it is Coulomb's law with `μ = c / c_n`; otherwise the coefficient
        depends on pressure. It needs a compliant normal law: without one the penetration has no meaning.

        Parameters
        ----------
        c
            Coefficient c_T.
        m
            Exponent m_T, at least 1.
        cap
            Largest shear traction. Default: none.
        """
        return Friction({"power-law": Table(locals())})

    @staticmethod
    def static_kinetic(*, kinetic: float, static: float, cap: float | None = None) -> Friction:
        """Static and kinetic friction: limit `μ_s p` for a point that stuck or was open at the last accepted state, `μ_k p` for one
        that slid, at most `cap`. See Oden and Martins 1985.

        The limit jumps between two increments, never within one: a point that lets go carries `μ_s p` to the end of its
        increment and drops to `μ_k p` in the next. So the increments say how soon after the start of slip the jump comes.

        Parameters
        ----------
        kinetic
            Coefficient of kinetic friction μ_k, at most `static`.
        static
            Coefficient of static friction μ_s.
        cap
            Largest shear traction, e.g. the shear yield stress. Default: none.
        """
        return Friction({"static-kinetic": Table(locals())})

    @staticmethod
    def exponential_decay(*, decay: float, kinetic: float, static: float, cap: float | None = None) -> Friction:
        """Friction that decays with the sliding speed v from static to kinetic: limit `μ p` with
        `μ = μ_k + (μ_s - μ_k) exp(-decay v)`, at most `cap`. See Wriggers 2006.

        With `kinetic` above `static` friction grows with speed. In a quasi-static analysis "speed" is slip per unit of the
        problem's time.

        Parameters
        ----------
        decay
            How fast the coefficient changes from one to the other.
        kinetic
            Coefficient of friction at high speed μ_k.
        static
            Coefficient of friction at rest μ_s.
        cap
            Largest shear traction, e.g. the shear yield stress. Default: none.
        """
        return Friction({"exponential-decay": Table(locals())})

    @staticmethod
    def stribeck(*, kinetic: float, static: float, velocity: float, exponent: float | None = None, viscous: float | None = None) -> Friction:
        """Stribeck friction: limit `μ p + viscous v` with `μ = μ_k + (μ_s - μ_k) exp(-(v/v_s)^δ)` at the sliding speed v, as
        surveyed by Armstrong-Hélouvry et al. 1994.

        The exponents in use are δ = 1, an exponential, and δ = 2, a Gaussian, which starts without slope. Below 1 the slope at
        rest would be infinite. In a quasi-static analysis "speed" is slip per unit of the problem's time.

        Parameters
        ----------
        kinetic
            Coefficient of friction μ_k that is left at high speed, without the viscous part.
        static
            Coefficient of friction at rest μ_s.
        velocity
            Stribeck velocity v_s.
        exponent
            Exponent δ, at least 1. Default: 1.
        viscous
            Shear traction per speed [Pa s/m], whatever the pressure. Default: 0.
        """
        return Friction({"stribeck": Table(locals())})

    @staticmethod
    def tabular(*, mu: Rows, pressures: Numbers | None = None, speeds: Numbers | None = None) -> Friction:
        """Measured coefficients over pressure and speed: limit `μ(p, v) p`, with μ bilinear between the entries of the table and
        constant outside.

        One row a pressure, one column a speed. A list that is left out does not matter to friction. Without `pressures` there
        is one row: `tabular = { speeds = [0, 0.1, 1], mu = [[0.5, 0.4, 0.3]] }`. Without `speeds` there is one column, which
        may be written as a row as well. In a quasi-static analysis "speed" is slip per unit of the problem's time.

        Parameters
        ----------
        mu
            Coefficients of friction, one row a pressure.
        pressures
            Pressures of the rows, increasing. Default: none.
        speeds
            Sliding speeds of the columns, increasing. Default: none.
        """
        return Friction({"tabular": Table(locals())})

    @staticmethod
    def rate_and_state(*, a: Profile, b: Profile, dc: Profile, f0: float, v0: float, velocity: Profile, eta: float | None = None, evolution: Evolution | None = None, ratio: Profile | None = None, theta: Profile | None = None) -> Friction:
        """Rate-and-state friction of Dieterich 1979 and Ruina 1983, regularised at low speed as by
        Rice, Lapusta and Ranjith 2001: shear
        `p a asinh(V/(2 V₀) exp((f₀ + b ln(V₀ θ/D_c))/a)) + η V` at the sliding velocity V. The state θ is about the time for which contacts of roughness last:
        they heal while surfaces rest and are renewed over the way `D_c`.

        Surfaces under this law always slide, however slowly: the slip rule is not asked, and V is of any size. V and θ at the end of an increment are solved together
        with it; both are fields of results.

        Parameters
        ----------
        a
            Direct effect a: by how much friction rises with ln V at once.
        b
            Evolution effect b: by how much it falls with it after the way `dc`. Sliding can be unstable where `b > a`.
        dc
            Way `D_c` over which the state is renewed.
        f0
            Coefficient of friction in steady sliding at `v0`.
        v0
            Reference velocity V₀.
        velocity
            Sliding velocity at the start.
        eta
            Radiation damping η [Pa s/m]: shear modulus over twice the speed of shear waves, where waves that sliding sends off are not computed. Default: 0.
        evolution
            How the state changes. Default: `ageing`.
        ratio
            Instead of `theta`: shear over pressure at the start, radiation damping left out. θ is what carries it at `velocity`.
        theta
            State θ at the start. Default: `dc` over `velocity`, that of steady sliding.
        """
        return Friction({"rate-and-state": Table(locals())})


class FrictionRange(Table):
    """A map of the modes over a factor of the friction, the speed or the load of the step.

    Parameters
    ----------
    from_
        Smallest factor; above 0 where it is one of the speed.
    over
        What is multiplied.
    points
        How many factors, ends counted.
    to
        Largest factor.
    """

    def __init__(self, *, from_: float | None = None, over: MapOver | None = None, points: int | None = None, to: float | None = None) -> None:
        super().__init__(locals())


class Gap(Table):
    """A stop: a weighted sum of displacements does not fall below minus the clearance. Of two points with terms of opposite factors along an axis that is
    contact between them, without friction and along that axis, wherever they are; with terms of one point it is contact with the ground.

    Sets of n points stand for n gaps, as with equations. What is met does not give way, unless it has a stiffness. In explicit steps it has one in any
    case, as equations have.

    Parameters
    ----------
    terms
        The opening: [{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }].
    clearance
        How far the sum may fall before it meets something; below zero there is an overlap at the start. Zero if not given.
    stiffness
        Stiffness of what is met, for each gap: over the whole thickness of a plane body, around the whole circumference of an axisymmetric
        one. Nothing that gives way if not given.
    """

    def __init__(self, *, terms: Sequence[Term], clearance: float | None = None, stiffness: float | None = None) -> None:
        super().__init__(locals())


class Generator(Table):
    """The built-in meshes."""

    @staticmethod
    def rectangle(*, cells: Numbers | None = None, diagonal: Diagonal | None = None, element: ElementKind | None = None, from_: Numbers | None = None, grading: Grading | None = None, to: Numbers | None = None, x: Numbers | None = None, y: Numbers | None = None) -> Generator:
        """A rectangle with sides parallel to the axes.

        Facet sets: `left`, `right` (x), `bottom`, `top` (y). Point sets: `bottom-left`, `bottom-right`, `top-left`,
        `top-right`.

        Parameters
        ----------
        cells
            Number of cells along x and y. Needed unless `x` and `y` are given.
        diagonal
            Which diagonal splits a cell into triangles.
        element
            Element: quad4, quad8, tri3 or tri6. Triangles are halves of the cells.
        from_
            Lower left corner.
        grading
            How the cells grow along x and y.
        to
            Upper right corner. Needed unless `x` and `y` are given.
        x
            The grid lines' x, increasing; replaces `from`, `to`, `cells` and `grading` along x.
        y
            The grid lines' y, increasing; replaces `from`, `to`, `cells` and `grading` along y.
        """
        return Generator({"rectangle": Table(locals())})

    @staticmethod
    def box(*, cells: Numbers | None = None, element: ElementKind | None = None, from_: Numbers | None = None, grading: Grading | None = None, to: Numbers | None = None, x: Numbers | None = None, y: Numbers | None = None, z: Numbers | None = None) -> Generator:
        """A box with faces parallel to the axes.

        Facet sets: `left`, `right` (x), `front`, `back` (y), `bottom`, `top` (z). Point sets: its corners, as in
        `bottom-front-left`.

        Parameters
        ----------
        cells
            Number of cells along x, y and z. Needed unless `x`, `y` and `z` are given.
        element
            Element: hex8, hex20, tet4, tet10, wedge6 or wedge15. A cell is split into six tetrahedra, or into two wedges that stand on
            triangles in the xy plane.
        from_
            Corner with the lowest coordinates.
        grading
            How the cells grow along x, y and z.
        to
            Corner with the highest coordinates. Needed unless `x`, `y` and `z` are given.
        x
            The grid planes' x, increasing; replaces `from`, `to`, `cells` and `grading` along x.
        y
            The grid planes' y, likewise.
        z
            The grid planes' z, likewise.
        """
        return Generator({"box": Table(locals())})

    @staticmethod
    def disc(*, radius: float, centre: Numbers | None = None, direction: Numbers | None = None, element: ElementKind | None = None, refine: Refinement | None = None, size: float | None = None, symmetric: bool | None = None) -> Generator:
        """A disc, refined towards a contact point on its rim.

        Facet sets: `arc` (the rim); `axis` (the cut through the contact point) if `symmetric`. Point sets: `pole` (the
        contact point), `centre`. Every point of the rim lies on the circle.

        Parameters
        ----------
        radius
            Radius.
        centre
            Centre.
        direction
            From the centre to the contact point; only its direction counts.
        element
            Element: quad4, quad8, tri3 or tri6.
        refine
            Smaller cells at the contact point.
        size
            Largest size of the cells at the surface; an eighth of the radius unless given.
        symmetric
            Only the half on one side of the line through centre and contact point: the right one (for a horizontal
            `direction` the upper one), also where the contact point is on top. With the centre on the axis it serves
            axisymmetric bodies.
        """
        return Generator({"disc": Table(locals())})

    @staticmethod
    def half_disc(*, radius: float, centre: Numbers | None = None, direction: Numbers | None = None, element: ElementKind | None = None, refine: Refinement | None = None, size: float | None = None, symmetric: bool | None = None) -> Generator:
        """A half-disc, refined towards the middle of its arc: the body of Hertz's line contact, and with `symmetric` of his
        point contact in axisymmetry.

        Facet sets: `arc`, `flat` (the diameter); `axis` (the cut through the contact point) if `symmetric`. Point sets:
        `pole` (the contact point), `centre`. Every point of the arc lies on the circle.

        Parameters
        ----------
        radius
            Radius.
        centre
            Middle of the flat side.
        direction
            From the centre to the contact point; only its direction counts.
        element
            Element: quad4, quad8, tri3 or tri6.
        refine
            Smaller cells at the contact point.
        size
            Largest size of the cells at the surface; an eighth of the radius unless given.
        symmetric
            Only the half on one side of the line through centre and contact point: the right one (for a horizontal
            `direction` the upper one), also where the contact point is on top. With the centre on the axis it serves
            axisymmetric bodies.
        """
        return Generator({"half-disc": Table(locals())})

    @staticmethod
    def ball(*, radius: float, centre: Numbers | None = None, direction: Numbers | None = None, element: ElementKind | None = None, refine: Refinement | None = None, sector: Sector | None = None, size: float | None = None) -> Generator:
        """A ball, refined towards a contact point.

        Facet sets: `arc` (the sphere); `symmetry-x`, `symmetry-y` (the cuts) by `sector`. Point sets: `pole` (the contact
        point), `centre`. Every point of `arc` lies on the sphere.

        Parameters
        ----------
        radius
            Radius.
        centre
            Centre.
        direction
            From the centre to the contact point; only its direction counts. The planes of the sectors contain it and stay
            as near to x = 0 and y = 0 as they can; where it is near to the x axis, to y = 0 and z = 0.
        element
            Element: hex8, hex20, tet4 or tet10.
        refine
            Smaller cells at the contact point.
        sector
            The part to mesh, by symmetry.
        size
            Largest size of the cells at the surface; an eighth of the radius unless given.
        """
        return Generator({"ball": Table(locals())})

    @staticmethod
    def half_ball(*, radius: float, centre: Numbers | None = None, direction: Numbers | None = None, element: ElementKind | None = None, refine: Refinement | None = None, sector: Sector | None = None, size: float | None = None) -> Generator:
        """A half-ball, refined towards its pole: the body of Hertz's point contact.

        Facet sets: `arc` (the half-sphere), `flat`; `symmetry-x`, `symmetry-y` (the cuts) by `sector`. Point sets: `pole`
        (the contact point), `centre`. Every point of `arc` lies on the sphere.

        Parameters
        ----------
        radius
            Radius.
        centre
            Middle of the flat side.
        direction
            From the centre to the contact point; only its direction counts. The planes of the sectors contain it and stay
            as near to x = 0 and y = 0 as they can; where it is near to the x axis, to y = 0 and z = 0.
        element
            Element: hex8, hex20, tet4 or tet10.
        refine
            Smaller cells at the contact point.
        sector
            The part to mesh, by symmetry.
        size
            Largest size of the cells at the surface; an eighth of the radius unless given.
        """
        return Generator({"half-ball": Table(locals())})

    @staticmethod
    def ring(*, bore: float, cells: Numbers, radius: float, centre: Numbers | None = None, element: ElementKind | None = None, ratio: float | None = None) -> Generator:
        """A ring, or a disc with a bore: a roller on its shaft, the race of a bearing, a cam.

        Facet sets: `bore` (the inner circle), `rim` (the outer one). Every point of both lies on its circle.

        Parameters
        ----------
        bore
            Radius of the bore.
        cells
            Cells around and from the bore to the rim.
        radius
            Radius of the rim.
        centre
            Centre.
        element
            Element: quad4, quad8, tri3 or tri6.
        ratio
            Size of the cells at the rim over that at the bore, along the radius.
        """
        return Generator({"ring": Table(locals())})

    @staticmethod
    def gear(*, bore: float, cells: Numbers, module: float, teeth: int, addendum: float | None = None, angle: float | None = None, backlash: float | None = None, centre: Numbers | None = None, dedendum: float | None = None, element: ElementKind | None = None, pressure_angle: float | None = None) -> Generator:
        """A spur gear with involute flanks (ISO 21771), in the plane.

        Above the base circle nodes lie on the involute of the circle of radius `teeth module cos(pressure-angle) / 2`, those in the middle of edges too; below it flanks
        are radial, without the fillet of a real tool. The first tooth is centred about `angle`. Two gears of one module mesh at a distance of
        `module (teeth + teeth') / 2`; to the right of a gear with the angle 0 another with the angle `π + π / teeth` has a gap where that one has a tooth.

        Facet sets: `bore`, `teeth` (everything outside: flanks, tips and roots).

        Parameters
        ----------
        bore
            Radius of the bore.
        cells
            Cells along a flank, across a tooth, across a gap, and from the bore to the roots.
        module
            Module: pitch diameter over number of teeth.
        teeth
            Number of teeth.
        addendum
            Height of a tooth above the pitch circle over the module.
        angle
            Direction of the middle of the first tooth, from x [rad].
        backlash
            By how much a tooth is thinner than a gap is wide, along the pitch circle.
        centre
            Centre.
        dedendum
            Depth of a gap below the pitch circle over the module.
        element
            Element: quad4, quad8, tri3 or tri6.
        pressure_angle
            Pressure angle [rad].
        """
        return Generator({"gear": Table(locals())})


class GivenMesh(Table):
    """A mesh that a program has in memory. Its sets are those of the body.

    Parameters
    ----------
    name
        The name by which the program gives it: `Problem.from_toml(FILE, meshes={"NAME": mesh})`.
    group
        The cell set that is this body; all cells if not given.
    """

    def __init__(self, *, name: Mesh | str, group: str | None = None) -> None:
        super().__init__(locals())


class GmshFile(Table):
    """A mesh file of Gmsh. Its physical groups become sets.

    Parameters
    ----------
    file
        The file, relative to the folder of the problem file.
    group
        The physical group of cells that is this body; all cells if not given.
    """

    def __init__(self, *, file: str, group: str | None = None) -> None:
        super().__init__(locals())


class Grading(Table):
    """The growth of the cells in each direction; equal cells where nothing is said.

    Parameters
    ----------
    x
        Along x.
    y
        Along y.
    z
        Along z; boxes only.
    """

    def __init__(self, *, x: Stretch | None = None, y: Stretch | None = None, z: Stretch | None = None) -> None:
        super().__init__(locals())


class Gravity(Table):
    """Weight: the density of the material times an acceleration, on cells, and that of point masses at them.

    Parameters
    ----------
    acceleration
        Acceleration, as many components as the space has: [0, -9.81].
    """

    def __init__(self, *, acceleration: Numbers) -> None:
        super().__init__(locals())


class GroundSpring(Table):
    """Springs between each point of a set and the ground, one along each axis. Not scaled by an amplitude.

    Parameters
    ----------
    stiffness
        Stiffness along each axis at each point, zero or more, as many as the space has: over the whole thickness
        of a plane body, around the whole circumference of an axisymmetric one.
    """

    def __init__(self, *, stiffness: Numbers) -> None:
        super().__init__(locals())


class Harmonic(Table):
    """Amplitude and phase of the displacements at probes under harmonic loads, about the state of the step before, with its closed contacts, the friction of
    `steady` sliding, and all damping. `harmonic = { loads = ["shaker"], from = 10, to = 500, points = 100 }`. Harmonic loads must not act before: leave
    them out of `loads` of the steps before. Supports do not vibrate.

    Parameters
    ----------
    bias
        Concentrates frequencies near the modes: `points` of them between neighbouring real modes, and between these and `from` and `to`, ends counted;
        the larger, the closer to the ends. 1 is even; 3 is the default of Abaqus and CalculiX. If not given, `points` are spread evenly from `from` to
        `to`.
    count
        Largest number of superposed modes; those up to one and a half times the highest frequency are used, with a static correction for the others.
    damping
        Damping of the real modes, beside that of bodies, dashpots and contact.
    frequencies
        The frequencies, instead of `from`, `to` and `points`.
    from_
        Lowest frequency.
    loads
        The loads, in full: amplitudes over time do not count.
    phases
        Phase lead of loads, by name: `phases.second = 90`; zero if not given [degrees].
    points
        How many frequencies, ends counted.
    shapes
        Whether displacements of all points are written as fields, real and imaginary parts, for each frequency.
    to
        Highest frequency.
    """

    def __init__(self, *, bias: float | None = None, count: int | None = None, damping: ModalDamping | None = None, frequencies: Numbers | None = None, from_: float | None = None, loads: Sequence[str] | None = None, phases: Mapping[str, float] | None = None, points: int | None = None, shapes: bool | None = None, to: float | None = None) -> None:
        super().__init__(locals())


class Increments(Table):
    """How a step is divided into increments. All sizes are fractions of the duration of the step.

    Parameters
    ----------
    fixed
        This many equal increments, never cut or grown: one that fails ends the analysis. Excludes the other keys.
    initial
        Size of the first increment [fraction of the duration].
    largest
        Size that is never exceeded [fraction of the duration].
    smallest
        Size below which the analysis gives up [fraction of the duration].
    state_change
        Largest change of the state variables of friction laws over an increment, relative to what they are: of θ of rate-and-state friction, and of the slip relative to `dc`. Increments
        are chosen by it, and one over which more than twice as much changes is halved. The error falls with its square. No meaning under laws without a state.
    """

    def __init__(self, *, fixed: int | None = None, initial: float | None = None, largest: float | None = None, smallest: float | None = None, state_change: float | None = None) -> None:
        super().__init__(locals())


class Initial(Table):
    """[initial.NAME]: displacements and temperatures at the start of the analysis, and velocities at the start of a dynamic step.

    Parameters
    ----------
    set
        The points: a body, `body.set` or a [set.NAME].
    displacement
        Displacement at the start of the analysis.
    result
        Displacements and velocities from a result file `.vtu` of the same mesh, relative to the folder of the problem file; instead of
        `displacement`, `velocity` and `spin`.
    spin
        Angular velocity about the centre of the points of the set, added to `velocity`: one number in the plane, a vector
        in 3D.
    step
        The name of the dynamic step at whose start the velocity is given; the first dynamic step if not given.
    temperature
        Temperature at the start of the analysis, at which nothing has expanded: `temperature.uniform = { value = 20 }`; 0 if not given.
    velocity
        Velocity.
    """

    def __init__(self, *, set: str, displacement: Numbers | None = None, result: str | None = None, spin: Numbers | None = None, step: str | None = None, temperature: TemperatureKind | None = None, velocity: Numbers | None = None) -> None:
        super().__init__(locals())


class Interface(Table):
    """[interface.NAME]: a contact pair: two surfaces that may touch, and their laws.

    Parameters
    ----------
    primary
        The primary (master) surface, which defines the normal: `body.set`, a [set.NAME], or an obstacle.
    secondary
        The secondary (slave) surface, whose points may not penetrate the primary: `body.set` or a [set.NAME]. Choose the softer
        of the two; the more finely meshed one takes its place unless `roles` say otherwise.
    damping
        Contact damping: pressure as a function of the closing velocity.
    discretisation
        Where contact is evaluated. Default: `mortar`; `node-to-facet` where the kinematics is `pop-1995` or facets are `triangles`.
    enforcement
        How the contact and sticking constraints are enforced.
    facets
        Geometry of quadrilateral facets of the primary. Default: bilinear, unless the kinematics needs triangles. Without effect in 2D and on obstacles.
    friction
        The friction law: the largest shear traction of the interface.
    initial
        Treatment of initial gaps and overlaps of the meshes.
    initial_distance
        Tolerance as a length, instead of `initial-tolerance`. `snap` also moves points that overlap by more, up to the height of the cell.
    initial_gap
        Gap at the start with `initial = "offset"`: a clearance; negative for an overlap. Default: 0.
    initial_set
        Points to which `snap` is restricted: `body.set` or a [set.NAME]. Default: all of the secondary.
    initial_tolerance
        Gap up to which `initial` applies to a point, as a fraction of the height of the cell beneath; a tenth if not given. Without effect for
        `as-meshed` and `ramp`, unless the surfaces are `tied`.
    kinematics
        How gap and slip are measured.
    normal
        The normal law: pressure as a function of the gap.
    primary_velocity
        Velocity of the material of the primary surface relative to its body, such as a belt, constant. Its normal component has no
        effect.
    primary_velocity_table
        Velocity over the time of the analysis, instead of `primary-velocity`: rows [time, vx, vy], in 3D [time, vx, vy, vz], linear in between,
        constant outside.
    roles
        Which surface has the contact points.
    roughness
        Heights of the secondary surface above its mesh. Default: none, it is smooth.
    slip
        The slip rule: shear traction as a function of relative motion.
    tied
        Ties the surfaces where they lie opposite each other at the start, closer than half the height of a cell (or than `initial-tolerance` or
        `initial-distance`), at their initial distance: neither gap nor slip changes, in tension too, and contact laws have no effect. For meshes that do
        not match. Default: false.
    wear
        The wear law: depth in the field CWEAR, depth and volume in the history. The worn depth opens the gap, unless `wear-feedback` says otherwise.
    wear_feedback
        How the worn depth changes the gap.
    worn
        Result files `fields_*.vtu` of earlier runs of the same mesh that have worn this interface, relative to the folder of the problem file, the first run first: the points of both surfaces
        move into their bodies by the depths in them (`CWEAR`), along the normals that the surfaces had in that run, and depths count from zero again. Default: none.
    """

    def __init__(self, *, primary: str, secondary: str, damping: Damping | None = None, discretisation: Discretisation | None = None, enforcement: Enforcement | None = None, facets: FacetShape | None = None, friction: Friction | None = None, initial: Start | None = None, initial_distance: float | None = None, initial_gap: float | None = None, initial_set: str | None = None, initial_tolerance: float | None = None, kinematics: Kinematics | None = None, normal: Normal | None = None, primary_velocity: Numbers | None = None, primary_velocity_table: Rows | None = None, roles: Roles | None = None, roughness: Roughness | None = None, slip: Slip | None = None, tied: bool | None = None, wear: Wear | None = None, wear_feedback: Feedback | None = None, worn: Sequence[str] | None = None) -> None:
        super().__init__(locals())


class Isotropic(Table):
    """The same in all directions.

    Parameters
    ----------
    poisson
        Poisson's ratio, between -1 and 0.5, bounds excluded.
    young
        Young's modulus, positive.
    density
        Mass per volume; needed for gravity and dynamics only.
    """

    def __init__(self, *, poisson: float, young: float, density: float | None = None) -> None:
        super().__init__(locals())


class Kick(Table):
    """Adds displacements and velocities of a mode to the state of the step before, one with `modes` or `complex-modes`. The history has the amplitude of the
    mode, `MODE.A`, its phase, `MODE.PHASE`, and `MODE.REST`, the part of the kinetic energy outside the mode; `modes-N-growth.csv` compares with the
    eigenvalue.

    Parameters
    ----------
    amplitude
        Largest displacement of a point in the mode at the start.
    mode
        Number of the mode in the table of the step before; the one that grows fastest if not given.
    """

    def __init__(self, *, amplitude: float, mode: int | None = None) -> None:
        super().__init__(locals())


class Kinematic(Table):
    """Points follow a reference point as if they were rigid with it: `u = q + θ × (x - X)`, `q` and `θ` its displacement and rotation, `X` where it is.

    Rotations are small: above about 0.1 rad it shows. Between the points nothing deforms any more, in the components that follow. In explicit steps
    it acts by springs as equations do, and the reference point needs a mass and a moment of inertia. Around an axis of symmetry a reference point moves
    along y alone, and what follows it in x keeps its radius.

    Parameters
    ----------
    reference
        The [reference.NAME] that they follow.
    set
        The points that follow: `body.set`, a [set.NAME], or a body.
    components
        The displacements in which they do; all if not given.
    """

    def __init__(self, *, reference: str, set: str, components: Sequence[Component] | None = None) -> None:
        super().__init__(locals())


class Kinematics(Table):
    """How gap and slip are measured."""

    @staticmethod
    def convective() -> Kinematics:
        """Large sliding in convective coordinates, the default: slip is the change of the projection's coordinates on the facet, measured in
        orthonormal frames that go with it (Laursen 2002,
        Wriggers 2006). Shear acts in the tangent plane where the point is.

        Slip is objective: a point that rides on a straining or rotating facet has none. Force and moment of a contact element add up
        to zero. Works on lines, triangles and quadrilaterals, linear or quadratic. No parameters.
        """
        return Kinematics({"convective": Table(locals())})

    @staticmethod
    def small_sliding() -> Kinematics:
        """Small sliding: every point keeps the facet, the weights and the normal it has in the reference configuration. Gap and slip
        are linear in the displacements. For joints that slip by a small part of an element; cheap, and free of geometric
        effects. No parameters.
        """
        return Kinematics({"small-sliding": Table(locals())})

    @staticmethod
    def pop_1995() -> Kinematics:
        """The tangential gaps of Pop 1995, eq. (29)-(30), as printed: `g_t = e·t - a_t°|a|`, `g_τ = e·τ - a_τ°|b|`
        along two edges of the triangle `x_1 x_2 x_3`, with `e = x_s - x_1` and `a°` the values at the last accepted state.

        Kept for comparison with the paper, not for work. Its known defects in 3D (in 2D there are none):
        - the `a_t, a_τ` are orthogonal projections (covariant), not convective coordinates, although (29) calls them so;
        - with edges at an angle β ≠ 90° they are used as force components (contravariant): sticking has stiffness `ω(1 ± cos β)` in
          different directions and friction is not opposite to slip (at β = 60°, slip at 60° meets friction at 41°), though
          its size is right: the quality figure `friction-law` says so;
        - it is not objective: a point glued to a facet that shears has a spurious slip of first order.

        Facets must be lines or triangles. No parameters.
        """
        return Kinematics({"pop-1995": Table(locals())})


class Limits(Table):
    """[quality]: the quality gate. Every accepted increment that gives a row of the history is judged by figures that have no dimension; the worst
    of each must not exceed its limit. `inf` switches a limit off.

    Parameters
    ----------
    action_reaction
        Action against reaction: sum of the forces on both sides, over the sum of the magnitudes of those on one.
    complementarity
        Complementarity: mean gap that pressure bridges, `Σ A p max(0, g - h(p)) / Σ A p height`. Not judged in an explicit step.
    cone_violation
        Shear beyond the limit of friction, over the largest limit of the interface.
    displacement
        Displacement of each body over the size of the model and the prescribed displacements. A body beyond it is lost. In dynamic steps it is a finding.
    elastic_slip
        Elastic slip of sticking points over an increment, over the elastic approach. Not judged in dynamic steps, where a point that comes to rest
        sticks.
    energy
        Residual of the energy balance over the energy stored and dissipated (at least the work of the forces along a millionth of the model), at the end. If not given: `solver.energy-limit`. In a
        quasi-static analysis no force follows from the ledger: works and losses are off by that part. Above a thousandth it is a note.
    equilibrium
        Balance of each body: resultant force and moment of interfaces, loads, springs and supports (in motion also of inertia and damping),
        over the largest of them (in motion: the largest so far). Moments are taken with the positions of the reference, as the bodies are linear. Not judged in an
        explicit step, where accelerations are made to balance.
    explicit_opening
        In explicit steps, where springs stand for rigid stops and ties by a penalty: their energy over the elastic energy of all bodies, the largest so far of both. Under the same force that is what
        they give way over what the bodies do.
    explicit_penetration
        In explicit steps, where springs as stiff as the cells beneath keep surfaces apart and in stick: work of their forces along what they give way, halved, over the elastic energy of all
        bodies, the largest so far of both.
    explicit_wear
        Way that an increment slides, times the cycles that it stands for, over the longest up to which explicit wear is stable, `4 Δx / (π k E*)`; of interfaces with
        `wear-feedback = "explicit"`. The limit is that of a half-plane: bodies that are softer at their surface bear more.
    friction_law
        Friction obeyed: by how much the shear of points that slip is not their limit or acts along their slip, and that of points that stick is above it,
        over the largest limit of the interface. Found from the tractions that are reported and from how the points have moved.
    gate
        Action on a figure above its limit.
    local_rotation
        Rotation of the cell of each body that turns most, in radians: parts of a body may turn where it does not as a whole. The false strain there is
        half the square. The limit is wider, as cells at corners turn far and carry little.
    mode_residual
        Residual of the equations of motion with a mode, or with steady vibrations, `√(rᵀ A⁻¹ r / xᵀ A x)` with the matrix `A` that is factored: the part of the displacements that is off, in
        the norm of energy.
    moment
        Sum of the moments of the forces on both sides, over the sum of their magnitudes on one times the size of the interface. What
        faces each other across a gap, or slides where sliding is taken as small, has a moment.
    oscillation
        Oscillation index of the pressure: the part of it that goes up and down from each point of the secondary to the next, over its mean;
        1 for a checkerboard of zero and twice the mean.
    outdated_normals
        What the pressure of an interface with `small-sliding` has along its surfaces, which have turned while its normals stayed: beside the limit of friction, or beside itself where there is no
        friction. It is shear that is not there.
    penetration_to_approach
        The same penetration over the elastic approach: `2 U / F` of the elastic energy of bodies and compliant interfaces and the force of
        the interface, at least the mean compression of one layer of cells. In motion the largest so far of both are compared. Not judged in an explicit step.
    penetration_to_size
        Penetration that the normal law did not ask for, `max(h(p) - g)` over the height of the cell beneath. Not judged in an explicit
        step, which presses by springs.
    prestress
        By how much the stress that modes begin from would change their frequencies, as a part of each: half of `φᵀ K_σ φ` over `φᵀ K φ`, where `K_σ` is the stiffness of that stress
        against rotation, `∫ σ_ij u_k,i u_k,j`. Stress does not stiffen bodies here.
    rotation
        Rotation of each body and reference point in radians, of an elastic body by its mean displacement gradient. Strains and rotations are taken as small: a body that
        turns by `θ` grows by `θ²/2`, and forces are balanced as if it had not turned, an error of a part in a thousand to one in a hundred
        at 0.05.
    rotation_to_approach
        What small rotations leave out of the gap, over the elastic approach: a body that turns by `θ` misses `½ θ × (θ × r)` at the distance `r` from where supports hold it,
        along the normals and in the mean over what presses. In an unconstrained direction a body goes along, and only what differs from point to point counts. In motion the
        largest so far of both are compared. Bodies that turn in frames miss nothing.
    scheme_dissipation
        Energy that the scheme has dissipated (`ALLND`), over the energy stored and dissipated, at the end. What moves is slower for it, by half that part: at the limit by one in
        a hundred, as much as the balance of energies may be open. What the scheme feeds in counts in `energy`.
    strain
        Strain of each body that turns in frames, of every body where this is given: the root of the mean square, weighted with the energy. Strains are taken as small, and
        forces are wrong by about that part. If not given: 0.05, of bodies that turn in frames alone. Decks give it where `NLGEOM` asks for large strains.
    tie_opening
        By how much tied surfaces come apart or slide, as the root of the mean square over places all over the secondary: over the elastic approach, or the largest displacement where
        that is less. Measured from the geometry alone, as a tie holds points or means over faces. The largest so far of both are compared.
    undetected_approach
        The same depth, or the distance by which the surfaces stand apart all around a point that carries pressure, over itself plus the elastic
        approach: the part of the approach that contact points do not see. 1 where surfaces penetrate and nothing presses them
        apart. The largest so far of both are compared.
    undetected_penetration
        Penetration between contact points, beyond what the points say, over the height of the cell beneath: nodes of
        the primary in faces of the secondary, and places all over these faces in the primary. Measured from the geometry alone.
    """

    def __init__(self, *, action_reaction: float | None = None, complementarity: float | None = None, cone_violation: float | None = None, displacement: float | None = None, elastic_slip: float | None = None, energy: float | None = None, equilibrium: float | None = None, explicit_opening: float | None = None, explicit_penetration: float | None = None, explicit_wear: float | None = None, friction_law: float | None = None, gate: GateMode | None = None, local_rotation: float | None = None, mode_residual: float | None = None, moment: float | None = None, oscillation: float | None = None, outdated_normals: float | None = None, penetration_to_approach: float | None = None, penetration_to_size: float | None = None, prestress: float | None = None, rotation: float | None = None, rotation_to_approach: float | None = None, scheme_dissipation: float | None = None, strain: float | None = None, tie_opening: float | None = None, undetected_approach: float | None = None, undetected_penetration: float | None = None) -> None:
        super().__init__(locals())


class LinearSolver(Table):
    """[solver.linear]: how systems of linear equations are solved.

    Parameters
    ----------
    patience
        Krylov iterations with one factorisation after which the matrix is factored anew.
    tolerance
        Largest residual of a linear system, as a fraction of its right-hand side.
    """

    def __init__(self, *, patience: int | None = None, tolerance: float | None = None) -> None:
        super().__init__(locals())


class LinearTemperature(Table):
    """A temperature that changes along a straight line: `value + gradient · (x - point)`.

    Parameters
    ----------
    gradient
        Its slope, as many components as the space has.
    point
        A point, as many components as the space has.
    value
        The temperature at `point`.
    """

    def __init__(self, *, gradient: Numbers, point: Numbers, value: float) -> None:
        super().__init__(locals())


class Load(Table):
    """[load.NAME]: a force or springs on a set.

    Over the step in which it becomes active, a load grows linearly from zero, unless an amplitude says otherwise.

    Parameters
    ----------
    set
        Where it acts: `body.set`, a [set.NAME], a body, or, of a force at points, a moment or springs, a [reference.NAME].
    amplitude
        An [amplitude.NAME] over the time of the analysis, by which the load is multiplied.
    follow
        On a body that turns (`body.NAME.rotation`): whether the load turns with it. A pressure and a centrifugal force do in any case; others keep their
        direction in space unless this says so.
    traction
        Force per area, fixed in direction.
    pressure
        Force per area against the outward normal.
    body_force
        Force per volume.
    gravity
        Weight.
    centrifugal
        Centrifugal force.
    nodal_force
        Force at each point.
    moment
        Moment on a reference point or a rigid body.
    spring
        Springs to ground at each point.
    """

    def __init__(self, *, set: str, amplitude: str | None = None, follow: bool | None = None, traction: Traction | None = None, pressure: Pressure | None = None, body_force: BodyForce | None = None, gravity: Gravity | None = None, centrifugal: Centrifugal | None = None, nodal_force: NodalForce | None = None, moment: Moment | None = None, spring: GroundSpring | None = None) -> None:
        super().__init__(locals())


class Mass(Table):
    """[mass.NAME]: a mass at each point of a set, beside that of the cells: what is fixed to a body and not meshed.

    It takes part in dynamic steps, in all directions, and bears the gravity and the centrifugal forces that act on the cells of its point; it has no moment
    of inertia. Points of rigid bodies cannot carry any. A point of an interface that carries a mass keeps that of its cells as well.

    Parameters
    ----------
    mass
        Mass at each point: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    set
        The points: `body.set`, a [set.NAME], a body, or a [reference.NAME].
    """

    def __init__(self, *, mass: float, set: str) -> None:
        super().__init__(locals())


class Material(Table):
    """[material.NAME]: elastic constants, and how the material expands when it is heated.

    Parameters
    ----------
    at
        Elastic constants at higher temperatures, in ascending order. Stiffnesses in between are linear, outside constant. Each cell has those of its
        temperature at the start, and bodies keep theirs.
    expansion
        Thermal expansion: a coefficient, three along the axes of the material, or a table by temperature. Without it nothing expands.
    temperature
        The temperature at which the elastic constants hold; needed where `at` gives others.
    isotropic
        The same in all directions: two constants.
    orthotropic
        Three orthogonal planes of symmetry: nine constants.
    anisotropic
        The full tensor: up to 21 constants.
    """

    def __init__(self, *, at: Sequence[ConstantsAt] | None = None, expansion: Expansion | None = None, temperature: float | None = None, isotropic: Isotropic | None = None, orthotropic: Orthotropic | None = None, anisotropic: Anisotropic | None = None) -> None:
        super().__init__(locals())


class Measured(Table):
    """A measured map or profile: an SDF file (ISO 25178-71, as text or binary), or text with a matrix of heights or with nodes `x z` or `x y z`, a line
    each.

    Points that were not measured get the mean of those beside them.

    Parameters
    ----------
    file
        The file.
    repeat
        Whether the map goes on beyond its edges with a copy of itself. Default: false.
    scale
        A factor for heights alone; below zero for a replica of the surface. Default: 1.
    spacing
        Distances of nodes along a line of the file and from line to line, in its unit: for a matrix of heights.
    tilt
        What becomes of the plane nearest to all heights, mean included.
    unit
        The file's unit of length in that of the problem, for heights and distances: 1e-6 for micrometres in a problem in metres, 1e3 for
        SDF, which has metres, in one in millimetres. Default: 1.
    """

    def __init__(self, *, file: str, repeat: bool | None = None, scale: float | None = None, spacing: Numbers | None = None, tilt: Tilt | None = None, unit: float | None = None) -> None:
        super().__init__(locals())


class ModalDamping(Table):
    """Modal damping, in addition to that of bodies, dashpots and contact.

    Parameters
    ----------
    mass
        Adds `mass / (2 ω)` to each ratio.
    ratios
        Damping ratios by the number of the mode, 1 being critical; the last is that of all that follow.
    stiffness
        Adds `stiffness ω / 2` to each ratio.
    """

    def __init__(self, *, mass: float | None = None, ratios: Numbers | None = None, stiffness: float | None = None) -> None:
        super().__init__(locals())


class Model(Table):
    """[model]: the space in which the bodies live.

    Parameters
    ----------
    space
        Plane strain, plane stress, axisymmetric or solid (3D).
    thickness
        Thickness of a plane problem, 1 if not given. Forces are those of this thickness.
    """

    def __init__(self, *, space: SpaceKind, thickness: float | None = None) -> None:
        super().__init__(locals())


class Modes(Table):
    """`modes` of a step: real modes, the lowest first. An empty table takes the defaults.

    Parameters
    ----------
    count
        At most so many modes.
    from_
        Lowest frequency.
    shapes
        Whether shapes are written as fields.
    to
        Highest frequency.
    """

    def __init__(self, *, count: int | None = None, from_: float | None = None, shapes: bool | None = None, to: float | None = None) -> None:
        super().__init__(locals())


class Moment(Table):
    """A moment on a reference point or a rigid body, what is named by `set`.

    Parameters
    ----------
    value
        Moment about the axes [N m]: [x, y, z], in the plane the one about z, over the whole thickness.
    """

    def __init__(self, *, value: Numbers) -> None:
        super().__init__(locals())


class Motion(Table):
    """The prescribed motion of an obstacle: a rotation, then a translation, both from tables over time (linear in between,
    constant outside).

    Parameters
    ----------
    rotation
        Rotation about a fixed axis.
    translation
        Rows of [time, dx, dy] (plane problems) or [time, dx, dy, dz].
    """

    def __init__(self, *, rotation: Rotation | None = None, translation: Rows | None = None) -> None:
        super().__init__(locals())


class NodalForce(Table):
    """The same force at each point of a set.

    Parameters
    ----------
    value
        Force at each point, as many components as the space has: over the whole thickness of a plane body, around
        the whole circumference of an axisymmetric one.
    """

    def __init__(self, *, value: Numbers) -> None:
        super().__init__(locals())


class Nodes(Table):
    """A temperature for each node, by its number in the mesh file: what a heat analysis elsewhere has found.

    Parameters
    ----------
    values
        Rows of the number of a node and its temperature, one for each node of the set; numbers increase.
    """

    def __init__(self, *, values: Rows) -> None:
        super().__init__(locals())


class Normal(Table):
    """The normal law: pressure as a function of the gap."""

    @staticmethod
    def unilateral() -> Normal:
        """Unilateral contact (Signorini): gap ≥ 0, pressure ≥ 0, and one of them is zero. No parameters."""
        return Normal({"unilateral": Table(locals())})

    @staticmethod
    def linear(*, c: float) -> Normal:
        """Linear compliance: `p = c δ` with the penetration `δ = max(0, -gap)`.

        A physical compliance, as of a thin soft layer; it is not a penalty and does not depend on the mesh.

        Parameters
        ----------
        c
            Stiffness per area.
        """
        return Normal({"linear": Table(locals())})

    @staticmethod
    def power_law(*, c: float, m: float) -> Normal:
        """Normal compliance `p = c δ^m` with the penetration `δ = max(0, -gap)`:
        Pop 1995, eq. (5); Oden and Martins 1985,
        who find `m` between 2 and 3.33 for metal surfaces.

        Parameters
        ----------
        c
            Coefficient c_n.
        m
            Exponent m_n, at least 1.
        """
        return Normal({"power-law": Table(locals())})

    @staticmethod
    def micro_contact(*, c1: float, c2: float, sigma: float, slope: float, separation: float | None = None) -> Normal:
        """Statistical micro-contact of rough surfaces, Zavarise et al. 1992 and the second
        form of eq. (5) of Pop 1995. With `d = separation + gap` the distance of the mean planes:

        `p(d) = c1 (1617646.152 σ/m)^c2 / 5.589^k · exp(-k d² / (1.363 σ)²)`, `k = 1 + 0.0711 c2`, lengths in metres.

        The formula is even in `d` and would soften below its inflection `d* = 1.363 σ/√(2k)`; there it is continued along
        its tangent. Beyond `5 σ` it ends in a parabola, so that the pressure is continuously differentiable and exactly zero
        where the asperities no longer touch. The constant 1617646.152 makes the law dimensional: σ must be in metres.

        Parameters
        ----------
        c1
            Vickers correlation coefficient c1.
        c2
            Vickers size index c2, negative for most metals.
        sigma
            Combined root-mean-square roughness σ.
        slope
            Combined mean absolute asperity slope m.
        separation
            Distance of the mean planes at zero gap. Default: where the asperities just touch, about 5.4 σ.
        """
        return Normal({"micro-contact": Table(locals())})

    @staticmethod
    def exponential(*, c0: float, p0: float) -> Normal:
        """Exponential compliance `p = p0 exp(-ln(100) gap / c0)`: `p0` where the gap closes, a hundredth of it at the clearance `c0`.

        This is the law of `PRESSURE-OVERCLOSURE=EXPONENTIAL` in CalculiX, which drops what little pressure there is beyond `c0`. A jump has no equilibrium:
        here the tangent at `c0` goes on until it meets zero, at a clearance of 1.217 `c0`. Beyond a penetration of 5 `c0`, where the pressure is 10¹⁰ `p0`,
        the curve goes on as its tangent as well.

        Parameters
        ----------
        c0
            Clearance at which the pressure is `p0 / 100`.
        p0
            Pressure at zero gap.
        """
        return Normal({"exponential": Table(locals())})

    @staticmethod
    def tabular(*, table: Rows) -> Normal:
        """A measured curve of pressure over penetration: linear between the rows, continued with the slope of the last piece.
        The first row is where contact begins and must have zero pressure; both columns increase.

        Parameters
        ----------
        table
            Rows of [penetration, pressure].
        """
        return Normal({"tabular": Table(locals())})


class NormalRegion(Table):
    """Facets by the direction in which they look.

    Parameters
    ----------
    direction
        The direction of the outward normal, of any length.
    angle
        Largest angle between the normal of a facet, at its middle, and the direction [degrees].
    """

    def __init__(self, *, direction: Numbers, angle: float | None = None) -> None:
        super().__init__(locals())


class Obstacle(Table):
    """[obstacle.NAME]: a rigid body that can be the primary of an interface.

    Parameters
    ----------
    motion
        Its prescribed motion; at rest if not given.
    plane
        Half-space.
    cylinder
        Cylinder (2D: circle).
    sphere
        Sphere.
    """

    def __init__(self, *, motion: Motion | None = None, plane: Plane | None = None, cylinder: Cylinder | None = None, sphere: Sphere | None = None) -> None:
        super().__init__(locals())


class Orthotropic(Table):
    """Three orthogonal planes of symmetry.

    `nu12` is the contraction along axis 2 under stress along axis 1, so that `nu12 / e1 = nu21 / e2`.

    Parameters
    ----------
    e1
        Young's modulus along axis 1.
    e2
        Young's modulus along axis 2.
    e3
        Young's modulus along axis 3.
    g12
        Shear modulus in the plane 1-2.
    g13
        Shear modulus in the plane 1-3.
    g23
        Shear modulus in the plane 2-3.
    nu12
        Poisson's ratio: contraction along 2 under stress along 1.
    nu13
        Poisson's ratio: contraction along 3 under stress along 1.
    nu23
        Poisson's ratio: contraction along 3 under stress along 2.
    axes
        Directions of the axes 1 and 2 in space; they are normalised, and axis 2 is made orthogonal to axis 1.
        Without it the axes are x, y, z.
    density
        Mass per volume; needed for gravity and dynamics only.
    """

    def __init__(self, *, e1: float, e2: float, e3: float, g12: float, g13: float, g23: float, nu12: float, nu13: float, nu23: float, axes: Rows | None = None, density: float | None = None) -> None:
        super().__init__(locals())


class Output(Table):
    """[output]: when fields are written to `fields.pvd`. The summary covers every increment.

    Parameters
    ----------
    checkpoint
        Checkpoints, from which `stickslip resume` continues. One is also written when a run is interrupted.
    every
        Fields are written every so many increments, and at the end of every step; 0 for the ends of steps only.
    fatigue
        Criteria of fretting fatigue, for every cycle that is computed.
    frd
        Writes fields also to an `.frd` file for CalculiX GraphiX, PrePoMax, FreeCAD and ccx2paraview: `fields.frd`, and for a deck `JOB.frd` with what it
        asks for.
    history_every
        A row of `history.csv` is written every so many increments, at times of output, and at the end of every step.
    slip_events
        Events of fast slip, as earthquakes, of interfaces under friction laws that keep their speed: a table `interfaces/NAME-events.csv`.
    times
        Further times at which fields are written, increasing. Increments land on them.
    """

    def __init__(self, *, checkpoint: CheckpointPlan | None = None, every: int | None = None, fatigue: Fatigue | None = None, frd: Frd | None = None, history_every: int | None = None, slip_events: SlipEvents | None = None, times: Numbers | None = None) -> None:
        super().__init__(locals())


class Plane(Table):
    """A rigid half-space.

    Parameters
    ----------
    normal
        Normal out of it, towards the bodies; need not be a unit vector.
    point
        A point on its surface.
    """

    def __init__(self, *, normal: Numbers, point: Numbers) -> None:
        super().__init__(locals())


class PlaneRegion(Table):
    """A plane; in 2D a line.

    Parameters
    ----------
    normal
        Its normal, of any length.
    point
        A point on it.
    """

    def __init__(self, *, normal: Numbers, point: Numbers) -> None:
        super().__init__(locals())


class Pressure(Table):
    """Force per area against the outward normal, on boundary facets. The normal is that of the undeformed body.

    Parameters
    ----------
    value
        Pressure, positive when it pushes.
    """

    def __init__(self, *, value: float) -> None:
        super().__init__(locals())


class Pretension(Table):
    """[pretension.NAME]: a cut through a bolt, whose two sides are drawn together as tightening does it.

    The two sides stay together across the normal, and along it all of the section has one displacement between them, the shortening. In the
    problem of a bolted joint a force draws them together in the first step, and later steps keep the shortening that it has come to, so that the force
    changes with what the joint has to carry. What is done in which step is said in the steps: `pretension.NAME = { force = 2e4 }`, then
    `pretension.NAME = { hold = true }`. The history has the force of the section, positive in tension, and the shortening.

    Parameters
    ----------
    of
        The body that a plane cuts, or a set of cells `body.set`, if it is to cut no others. Facets say by themselves of which body they are.
    plane
        The layer of faces between cells that is nearest to a plane; of several sections that the plane meets the one nearest to its point. The normal is along
        the bolt.
    facets
        Facets inside a mesh.
    """

    def __init__(self, *, of: str | None = None, plane: PlaneRegion | None = None, facets: FacetSection | None = None) -> None:
        super().__init__(locals())


class Probe(Table):
    """[probe.NAME]: a point whose displacement and stress are written to `history.csv` at every increment and to the
    summary at the end. The forces of interfaces and the reactions of supports are there without being asked for.

    Parameters
    ----------
    point
        Undeformed coordinates; the nearest point of the mesh is taken.
    of
        The body of the point; that with the nearest point if not given. Where points of several bodies are equally near, it has to be given.
    """

    def __init__(self, *, point: Numbers, of: str | None = None) -> None:
        super().__init__(locals())


class Radial(Table):
    """A temperature over the distance from an axis, or in the plane from a point: linear between the rows of a table, constant outside.

    Parameters
    ----------
    table
        Rows of distance and temperature; distances increase.
    axis
        Direction of the axis, of any length: needed in 3D. In the plane it is perpendicular to it.
    point
        A point of the axis, as many components as the space has; the origin if not given. In axial symmetry the axis is that of symmetry.
    """

    def __init__(self, *, table: Rows, axis: Numbers | None = None, point: Numbers | None = None) -> None:
        super().__init__(locals())


class Rayleigh(Table):
    """Rayleigh damping `C = mass M + stiffness K`: the damping ratio at the angular frequency ω is `mass / (2 ω) + stiffness ω / 2`.

    Parameters
    ----------
    mass
        Factor of the mass matrix.
    stiffness
        Factor of the stiffness matrix.
    """

    def __init__(self, *, mass: float | None = None, stiffness: float | None = None) -> None:
        super().__init__(locals())


class Reference(Table):
    """[reference.NAME]: a point that belongs to no mesh. It moves and turns, can be supported, loaded and tied by equations and springs, and points of bodies
    follow it (`coupling.kinematic`) or it them (`coupling.distributing`).

    Its name stands for it wherever a set of one point does: in `support`, `load` (`nodal-force`, `moment`, `spring`), `mass`, `initial` and `coupling`.
    The history has its displacement and rotation, and the force and moment of its supports. Rotations are small: above about 0.1 rad it shows. In the
    plane it turns about z; around an axis of symmetry it moves along y alone. A motion that nothing resists is left out, and a load along it refused.

    Parameters
    ----------
    point
        Where it is, before any deformation.
    inertia
        Moments of inertia about the axes through it [mass length²]: [xx, yy, zz] or [xx, yy, zz, xy, yz, xz], in the plane the one about z,.
    mass
        Mass there [mass], in dynamic steps: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    """

    def __init__(self, *, point: Numbers, inertia: Numbers | None = None, mass: float | None = None) -> None:
        super().__init__(locals())


class Refinement(Table):
    """Smaller cells around the contact point: equal ones out to `width`, then growing, along the surface and into the
    depth.

    Parameters
    ----------
    finest
        Largest size of the cells at the contact point.
    growth
        Size of a cell over that of its neighbour nearer to the contact point.
    width
        Distance from the contact point out to which cells have that size. Choose it a little wider than the
        half-width of the contact.
    """

    def __init__(self, *, finest: float, growth: float | None = None, width: float | None = None) -> None:
        super().__init__(locals())


class Rotation(Table):
    """Rotation about a fixed axis.

    Parameters
    ----------
    angle
        Rows of [time, angle [rad]].
    centre
        A point on the axis.
    axis
        Direction of the axis; out of the plane if not given.
    """

    def __init__(self, *, angle: Rows, centre: Numbers, axis: Numbers | None = None) -> None:
        super().__init__(locals())


class Roughness(Table):
    """`interface.NAME.roughness`: heights of the secondary surface above its mesh, which its gaps are less by.

    Meshes and matrices stay as they are, so that bodies are factored once for all roughnesses. That is right to first order, for waves that are long beside their heights.
    Heights belong to the points of the secondary and move with them; the primary is smooth.

    Parameters
    ----------
    along
        The first axis, along the lines of a map; the part of it that is normal to the surface has no effect. The second one is to the left of it for who
        looks at the surface from outside. Default: x, or y if the surface faces along x.
    origin
        The place on the surface from which heights are counted along its axes. Default: the corner in which both are least.
    measured
        A measured map or profile.
    self_affine
        A random surface that looks alike in a range of lengths.
    wave
        A cosine along one axis or two.
    """

    def __init__(self, *, along: Numbers | None = None, origin: Numbers | None = None, measured: Measured | None = None, self_affine: SelfAffine | None = None, wave: Wave | None = None) -> None:
        super().__init__(locals())


class Scheme(Table):
    """How the equations of motion are integrated."""

    @staticmethod
    def newmark(*, beta: float | None = None, gamma: float | None = None) -> Scheme:
        """Newmark's method (newmark_1959). With the defaults it is the trapezoidal rule:
        unconditionally stable, second order, without dissipation in linear motion.

        Parameters
        ----------
        beta
            β. Default: 1/4.
        gamma
            γ. Above 1/2 high frequencies are damped and the method is of first order. Default: 1/2.
        """
        return Scheme({"newmark": Table(locals())})

    @staticmethod
    def hht(*, alpha: float | None = None) -> Scheme:
        """The method of Hilber, Hughes and Taylor (hht_1977): second order, damps high frequencies.

        Parameters
        ----------
        alpha
            α, between -1/3 (most damping) and 0 (the trapezoidal rule). Default: -0.05.
        """
        return Scheme({"hht": Table(locals())})

    @staticmethod
    def generalised_alpha(*, rho: float | None = None) -> Scheme:
        """The generalised-α method of Chung and Hulbert (chung_hulbert_1993): second
        order, damps high frequencies as asked for and low ones as little as possible.

        Parameters
        ----------
        rho
            What one increment leaves of the amplitude of infinitely high frequencies, ρ∞, between 0 and 1. Default: 0.9.
        """
        return Scheme({"generalised-alpha": Table(locals())})

    @staticmethod
    def central_difference(*, mass_scaling: float | None = None, safety: float | None = None) -> Scheme:
        """Central differences: explicit, second order, with lumped masses and without a matrix. Contact and stick are enforced by
        springs, whatever `enforcement` says: those of a penalty, or of the stiffness of the bodies' own cells. Equations, and ties but for those by a penalty, hold exactly.

        The increment follows from the highest frequency of the bodies and the stiffness of the contact. `increments.fixed` sets it instead;
        more than the stable one is refused. Give `increments.largest` to bound it.

        Parameters
        ----------
        mass_scaling
            Increment to be reached by raising the masses of cells that are too small for it. What this adds is reported. Default:
            masses stay as they are.
        safety
            Fraction of the stable increment that is used. Default: 0.9.
        """
        return Scheme({"central-difference": Table(locals())})


class SelfAffine(Table):
    """A random self-affine surface: waves of random phase whose power falls with the wave number like `q^(-2H-2)`, in a profile `q^(-2H-1)`,
    between a longest and a shortest wavelength (Persson 2001).

    It repeats itself after its period, has no grid, and is the same on every machine for the same seed.

    Parameters
    ----------
    hurst
        Hurst exponent, above 0 and up to 1; most surfaces have 0.7 to 0.9.
    period
        Length after which it repeats itself, along each axis; one number is for both.
    shortest
        The shortest wave: a few times the distance of nodes, or they will not show it.
    longest
        The longest wave, from which on the power of waves falls. Default: the period.
    rms
        Root mean square of heights. Give this or `slope`.
    seed
        Which of all such surfaces. Default: 0.
    slope
        Root mean square of the gradient, of both axes together.
    """

    def __init__(self, *, hurst: float, period: Numbers, shortest: float, longest: float | None = None, rms: float | None = None, seed: int | None = None, slope: float | None = None) -> None:
        super().__init__(locals())


class Set(Table):
    """[set.NAME]: a set of points chosen by geometry, before any deformation. Where facets are wanted (pressure,
    interfaces), it stands for the boundary facets, and where cells are wanted (weight) for the cells, all of whose points are in
    the set.

    Meshes bring sets of their own, `body.set`; the name of a body alone stands for all of it.

    Parameters
    ----------
    of
        The body, or the set `body.set`, from which points are chosen. Needed by all but `union`.
    tolerance
        How far a point may lie from the place described, as a fraction of the body's diagonal.
    point
        The one point at these coordinates; an error if there is none within the tolerance.
    box
        The points in a box with sides along the axes.
    plane
        The points on a plane (in 2D: a line).
    ball
        The points in a ball (in 2D: a disc).
    normal
        The points of the boundary facets that look in a direction; where facets are wanted, these.
    numbers
        The points with these numbers of the mesh.
    union
        The points of other sets, `body.set` or names of [set.NAME].
    """

    def __init__(self, *, of: str | None = None, tolerance: float | None = None, point: Numbers | None = None, box: BoxRegion | None = None, plane: PlaneRegion | None = None, ball: BallRegion | None = None, normal: NormalRegion | None = None, numbers: Numbers | None = None, union: Sequence[str] | None = None) -> None:
        super().__init__(locals())


class SetWeight(Table):
    """What the points of a set count.

    Parameters
    ----------
    set
        The points: `body.set`, a [set.NAME], or a body.
    weight
        How much each of them counts.
    """

    def __init__(self, *, set: str, weight: float) -> None:
        super().__init__(locals())


class SlipEvents(Table):
    """`output.slip-events`: when sliding counts as an event. Events are found in the rows of the history.

    Parameters
    ----------
    speed
        An event lasts while some point slides faster than that.
    modulus
        Shear modulus by which slip integrated over the surface is a moment; the table has no moment without it.
    """

    def __init__(self, *, speed: float, modulus: float | None = None) -> None:
        super().__init__(locals())


class Slip(Table):
    """The slip rule: shear traction as a function of relative motion."""

    @staticmethod
    def return_mapping() -> Slip:
        """Stick until the limit, then slide: the trial traction `base - ω_T slip` is returned radially to the limit
        (Simo and Laursen 1992), or to the point of an ellipse that its slip direction asks for. There is no creep; what gives in stick is only the
        stiffness of the enforcement, which the augmented Lagrangian removes. No parameters.
        """
        return Slip({"return-mapping": Table(locals())})

    @staticmethod
    def regularised(*, epsilon: float) -> Slip:
        """The smooth friction of Pop 1995, eq. (14)-(20): `t = -limit φ_ε(w)` with the sliding velocity
        `w = slip / dt`.

        On an ellipse `|w|` is the length by which the direction of slip is divided there: `√((h₁ w₁)² + (h₂ w₂)²)` by the associated rule, `√((w₁/h₁)² + (w₂/h₂)²)` against the
        traction, with half axes `h` over the longer one.

        It never quite sticks: under a steady shear `q` below the limit `T` the interface
        creeps at `ε (1 - √(1 - q/T))`, which it reports in the summary. In a quasi-static
        analysis "velocity" is slip per unit of the problem's time.

        Parameters
        ----------
        epsilon
            Velocity ε above which the full limit acts.
        """
        return Slip({"regularised": Table(locals())})


class Solver(Table):
    """[solver]: convergence criteria and solvers. All dimensionless.

    Parameters
    ----------
    energy_limit
        Largest residual of the energy balance, relative to the energy stored and dissipated, that counts as good; the summary says whether it was
        kept.
    engine
        The linear solver that factors condensed bodies, and keeps the factors.
    follow_loose_bodies
        Whether unconstrained bodies under load are moved in quasi-static steps until they touch, and stabilised by weak springs until contact is
        established and the springs carry nothing.
    largest_change
        Largest change of displacement over one increment, as a fraction of the size of the model; an increment that
        changes more is cut. No limit if not given.
    line_search
        Halvings of a Newton step that does not reduce the out-of-balance forces; 0 takes every step in full.
    linear
        Systems of linear equations.
    max_iterations
        Newton iterations after which an increment is cut.
    method
        How the systems of Newton's method are solved.
    tolerance
        Largest out-of-balance force, relative to the largest of reactions, external forces and contact forces.
    """

    def __init__(self, *, energy_limit: float | None = None, engine: Engine | None = None, follow_loose_bodies: bool | None = None, largest_change: float | None = None, line_search: int | None = None, linear: LinearSolver | None = None, max_iterations: int | None = None, method: Solution | None = None, tolerance: float | None = None) -> None:
        super().__init__(locals())


class Sphere(Table):
    """A rigid sphere (in an axisymmetric problem with its centre on the axis).

    Parameters
    ----------
    centre
        Centre.
    radius
        Radius.
    inside
        `true` for a socket: the bodies are inside. Default: `false`.
    """

    def __init__(self, *, centre: Numbers, radius: float, inside: bool | None = None) -> None:
        super().__init__(locals())


class Spring(Table):
    """A spring whose elongation is a weighted sum of displacements: of one point against the ground with one term, between two points with two
    terms of opposite factors.

    Sets of n points stand for n springs, as with equations. The springs are free of force where nothing has moved.

    Parameters
    ----------
    stiffness
        Stiffness of each spring: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    terms
        The elongation: [{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }].
    """

    def __init__(self, *, stiffness: float, terms: Sequence[Term]) -> None:
        super().__init__(locals())


class SteadySliding(Table):
    """Steady sliding.

    Parameters
    ----------
    turning
        Rotating surfaces of primaries, by interface, such as a disc under pads: `turning.pad = { axis = [0, 0, 1], speed = 6 }`. The mesh does not move;
        centrifugal and gyroscopic forces are not included.
    velocity
        Velocities of surfaces of primaries in this step, by interface, beside their `primary-velocity`: `velocity = { pad = [2, 0, 0] }`.
    """

    def __init__(self, *, turning: Mapping[str, Turning] | None = None, velocity: Mapping[str, Numbers] | None = None) -> None:
        super().__init__(locals())


class Step(Table):
    """[[step]]: a stretch of the analysis with its own supports, loads and interfaces. Steps follow each other in the
    order of the file; a step starts from the state at the end of the one before.

    Parameters
    ----------
    change
        Laws that change in this step, by interface: `change.base = { friction.coulomb = { mu = 0.1 } }`.
    complex_modes
        Complex modes of steady sliding about the state of the step before: frequencies and growth rates, with friction and damping. The step has no
        increments.
    couplings
        The couplings active in this step; all if not given.
    cycles
        Repeats the step, for fretting and wear: amplitude tables describe one cycle, which must end as it begins.
    duration
        Duration of the step, or with `cycles` of one cycle.
    dynamic
        Makes the step dynamic; quasi-static if not given.
    harmonic
        Response to harmonic loads about the state of the step before, by modal superposition: amplitudes and phases over the frequency. The step has no
        increments.
    increments
        Time increments of the step, or with `cycles` of one cycle.
    interfaces
        The interfaces active in this step; all if not given.
    kick
        Starts a dynamic step with a mode of the step before: `kick = { amplitude = 1e-6 }`.
    loads
        The loads active in this step; all if not given. A load that was active in the step before and is not listed
        falls linearly to zero.
    modes
        Real modes about the state of the step before: frequencies, shapes and participation factors, without friction. The step has no increments.
    name
        A name for messages and results; `step 1`, `step 2` if not given.
    pretension
        Pretensions in this step: `pretension.bolt = { force = 2e4 }`, `pretension.bolt = { hold = true }`. Until a step names a pretension, its cut is
        closed as meshed.
    steady
        Steady sliding: `steady = {}`. Where the surface of a primary moves (`primary-velocity`, or `velocity` and `turning` here), contact points slide
        along that motion from the first increment on. Interfaces without such a velocity stick and slip as usual.
    supports
        The supports active in this step; all if not given.
    temperatures
        The temperatures active in this step; all if not given. Points without an active temperature return to their temperature at the start.
    """

    def __init__(self, *, change: Mapping[str, Change] | None = None, complex_modes: ComplexModes | None = None, couplings: Sequence[str] | None = None, cycles: Cycles | None = None, duration: float | None = None, dynamic: Dynamic | None = None, harmonic: Harmonic | None = None, increments: Increments | None = None, interfaces: Sequence[str] | None = None, kick: Kick | None = None, loads: Sequence[str] | None = None, modes: Modes | None = None, name: str | None = None, pretension: Mapping[str, Tension] | None = None, steady: SteadySliding | None = None, supports: Sequence[str] | None = None, temperatures: Sequence[str] | None = None) -> None:
        super().__init__(locals())


class Stretch(Table):
    """How the cells of one direction grow.

    Parameters
    ----------
    ratio
        Size of the last cell over that of the first; the sizes between are a geometric sequence.
    """

    def __init__(self, *, ratio: float) -> None:
        super().__init__(locals())


class Support(Table):
    """[support.NAME]: displacements prescribed on a set. Components that are not given stay free.

    Over the step in which it becomes active, a support moves linearly from the displacement the points have to the
    one prescribed, unless an amplitude says otherwise. In a step that does not list it, it lets go.

    Parameters
    ----------
    set
        The points: `body.set`, a [set.NAME], a body, or a [reference.NAME].
    amplitude
        An [amplitude.NAME] over the time of the analysis, by which the displacements are multiplied.
    hold
        Components that are held where they are when the support begins to act: `hold = ["y"]`.
    rotation_x
        Rotation about x [rad], in 3D, of a reference point.
    rotation_y
        Rotation about y [rad], in 3D, of a reference point.
    rotation_z
        Rotation about z [rad], of a reference point.
    x
        Displacement along x; in an axisymmetric problem the radial one.
    y
        Displacement along y.
    z
        Displacement along z, in 3D.
    """

    def __init__(self, *, set: str, amplitude: str | None = None, hold: Sequence[Component] | None = None, rotation_x: float | None = None, rotation_y: float | None = None, rotation_z: float | None = None, x: float | None = None, y: float | None = None, z: float | None = None) -> None:
        super().__init__(locals())


class Temperature(Table):
    """[temperature.NAME]: the temperature of a set, which makes its bodies expand.

    Over the step in which it becomes active, the temperature of each point goes linearly from what it was to what is given; in a dynamic step
    at once. Where a step does not list it, points go back to their temperature at the start, or on to what takes its place.

    Parameters
    ----------
    set
        The points: a body, `body.set` or a [set.NAME].
    amplitude
        An [amplitude.NAME] over the time of the analysis, by which the temperature is multiplied as long as it acts.
    uniform
        The same everywhere.
    linear
        Changing along a straight line.
    radial
        A table over the distance from an axis.
    nodes
        A number for each node.
    """

    def __init__(self, *, set: str, amplitude: str | None = None, uniform: UniformTemperature | None = None, linear: LinearTemperature | None = None, radial: Radial | None = None, nodes: Nodes | None = None) -> None:
        super().__init__(locals())


class TemperatureKind(Table):
    """Fields of temperature."""

    @staticmethod
    def uniform(value: float) -> TemperatureKind:
        """One temperature everywhere.

        Parameters
        ----------
        value
            The temperature, in any unit whose steps are those of the coefficients of expansion.
        """
        return TemperatureKind({"uniform": Table(locals())})

    @staticmethod
    def linear(*, gradient: Numbers, point: Numbers, value: float) -> TemperatureKind:
        """A temperature that changes along a straight line: `value + gradient · (x - point)`.

        Parameters
        ----------
        gradient
            Its slope, as many components as the space has.
        point
            A point, as many components as the space has.
        value
            The temperature at `point`.
        """
        return TemperatureKind({"linear": Table(locals())})

    @staticmethod
    def radial(*, table: Rows, axis: Numbers | None = None, point: Numbers | None = None) -> TemperatureKind:
        """A temperature over the distance from an axis, or in the plane from a point: linear between the rows of a table, constant outside.

        Parameters
        ----------
        table
            Rows of distance and temperature; distances increase.
        axis
            Direction of the axis, of any length: needed in 3D. In the plane it is perpendicular to it.
        point
            A point of the axis, as many components as the space has; the origin if not given. In axial symmetry the axis is that of symmetry.
        """
        return TemperatureKind({"radial": Table(locals())})

    @staticmethod
    def nodes(values: Rows) -> TemperatureKind:
        """A temperature for each node, by its number in the mesh file: what a heat analysis elsewhere has found.

        Parameters
        ----------
        values
            Rows of the number of a node and its temperature, one for each node of the set; numbers increase.
        """
        return TemperatureKind({"nodes": Table(locals())})


class Tension(Table):
    """Pretension in a step: one of `force`, `shortening` and `hold`.

    Parameters
    ----------
    amplitude
        An [amplitude.NAME] over the time of the analysis, by which force or shortening is multiplied instead.
    force
        Force of the whole section, reached linearly over the step.
    hold
        Keeps the present shortening.
    shortening
        Overlap of the two sides, as if that length of the bolt was removed, reached linearly over the step.
    """

    def __init__(self, *, amplitude: str | None = None, force: float | None = None, hold: bool | None = None, shortening: float | None = None) -> None:
        super().__init__(locals())


class Term(Table):
    """One displacement in a sum.

    Parameters
    ----------
    component
        The direction of the displacement; of a reference point its rotation as well, in rad: `rotation-z`.
    set
        The points: `body.set`, a [set.NAME], a body, or a [reference.NAME].
    factor
        What it is multiplied by.
    """

    def __init__(self, *, component: Component, set: str, factor: float | None = None) -> None:
        super().__init__(locals())


class Traction(Table):
    """Force per area with a fixed direction, on boundary facets.

    Parameters
    ----------
    value
        Traction, as many components as the space has; radius and axis in an axisymmetric problem.
    """

    def __init__(self, *, value: Numbers) -> None:
        super().__init__(locals())


class Turning(Table):
    """How a surface turns.

    Parameters
    ----------
    speed
        Angular velocity about it.
    axis
        Direction of the axis in 3D; in 2D it is across the plane.
    centre
        A place on the axis; the origin if not given.
    """

    def __init__(self, *, speed: float, axis: Numbers | None = None, centre: Numbers | None = None) -> None:
        super().__init__(locals())


class UniformTemperature(Table):
    """One temperature everywhere.

    Parameters
    ----------
    value
        The temperature, in any unit whose steps are those of the coefficients of expansion.
    """

    def __init__(self, *, value: float) -> None:
        super().__init__(locals())


class Wave(Table):
    """`h = a cos(2π s/λ₁)`, or `h = a cos(2π s/λ₁) cos(2π t/λ₂)`: a waviness whose contact is known in closed form
    (Westergaard 1939).

    Parameters
    ----------
    amplitude
        Height of crests above the mean.
    wavelength
        Distance from crest to crest along the first axis, and if it varies along the second too, along that.
    crest
        Where along the axes a crest lies, from the origin. Default: 0.
    """

    def __init__(self, *, amplitude: float, wavelength: Numbers, crest: Numbers | None = None) -> None:
        super().__init__(locals())


class Wear(Table):
    """What sliding wears off the surfaces."""

    @staticmethod
    def none() -> Wear:
        """No wear. No parameters."""
        return Wear({"none": Table(locals())})

    @staticmethod
    def archard(*, coefficient: float, primary_coefficient: float | None = None, running_in: float | None = None, running_in_path: float | None = None) -> Wear:
        """Wear after Archard 1953: a surface that slides by `ds` under a pressure `p` loses a layer of
        depth `k p |ds|`.

        A surface that runs in wears faster at first, by the factor `1 + running-in exp(-s / running-in-path)` after a path `s`.

        Parameters
        ----------
        coefficient
            Specific wear rate `k` of the secondary: volume lost over force and path, Archard's dimensionless coefficient over the
            hardness.
        primary_coefficient
            The same of the primary, whose surface has a depth of its own. Default: 0, it does not wear.
        running_in
            By what part of the coefficients both surfaces wear faster at first. Default: 0.
        running_in_path
            Path over which they do; needed with `running-in`.
        """
        return Wear({"archard": Table(locals())})

    @staticmethod
    def archard_hardness(*, coefficient: float, hardness: float, primary_coefficient: float | None = None, primary_hardness: float | None = None) -> Wear:
        """Wear after Archard 1953 with the hardness written out: a surface that slides by `ds` under a pressure `p` loses a layer of
        depth `K p |ds| / H`.

        Parameters
        ----------
        coefficient
            Archard's coefficient `K` of the secondary.
        hardness
            Hardness `H` of the secondary; a Vickers number times 9.807e6 Pa.
        primary_coefficient
            The coefficient of the primary, whose surface has a depth of its own. Default: 0, it does not wear.
        primary_hardness
            The hardness of the primary. Default: that of the secondary.
        """
        return Wear({"archard-hardness": Table(locals())})

    @staticmethod
    def archard_threshold(*, coefficient: float, energy: float | None = None, path: float | None = None, pressure: float | None = None, primary_coefficient: float | None = None) -> Wear:
        """Wear that begins beyond a threshold: a surface that slides by `ds` under a pressure `p` loses a layer of depth `k (p - p₀) |ds|` where the pressure is above `p₀`, once the
        point has slid a path, and friction has dissipated an energy there.

        Thresholds of path and energy are met in the middle of an increment, and of the cycles that it stands for.

        Parameters
        ----------
        coefficient
            Specific wear rate `k` of the secondary.
        energy
            Energy that friction has to dissipate at a point before it wears. Default: 0.
        path
            Path of a point over which nothing wears at first. Default: 0.
        pressure
            Pressure `p₀` below which nothing wears. Default: 0.
        primary_coefficient
            The same of the primary, whose surface has a depth of its own. Default: 0, it does not wear.
        """
        return Wear({"archard-threshold": Table(locals())})

    @staticmethod
    def tabular(*, coefficient: Rows, pressures: Numbers | None = None, primary_coefficient: Rows | None = None, speeds: Numbers | None = None) -> Wear:
        """Measured rates over pressure and speed: depth `k(p, v) p |ds|`, with k bilinear between the entries of the table and
        constant outside.

        One row a pressure, one column a speed, as in `friction.tabular`; a list that is left out does not matter to wear. In a quasi-static analysis "speed" is path per unit of the problem's
        time, in cycles of the one that is computed. Where the rate falls with the pressure it must not fall so fast that more pressure wears less.

        Parameters
        ----------
        coefficient
            Specific wear rates of the secondary, one row a pressure.
        pressures
            Pressures of the rows, increasing. Default: none.
        primary_coefficient
            The same of the primary, whose surface has a depth of its own. Default: none, it does not wear.
        speeds
            Sliding speeds of the columns, increasing. Default: none.
        """
        return Wear({"tabular": Table(locals())})

    @staticmethod
    def dissipated_energy(*, coefficient: float, energy: float | None = None, primary_coefficient: float | None = None) -> Wear:
        """Wear in proportion to the energy that friction dissipates (Fouvry et al. 2003): a surface
        that slides by `ds` under a shear traction `τ` loses a layer of depth `α τ |ds|`, once it has taken up the energy that it takes to begin.

        Parameters
        ----------
        coefficient
            Volume of the secondary lost over energy dissipated `α`.
        energy
            Energy that friction has to dissipate at a point before it wears. Default: 0.
        primary_coefficient
            The same of the primary, whose surface has a depth of its own. Default: 0, it does not wear.
        """
        return Wear({"dissipated-energy": Table(locals())})


class Weights(Table):
    """How much points count in a mean.

    Parameters
    ----------
    "area"
        By the area of the surface that belongs to each, `∫ N dA`, so that a force acts as a constant traction. All the same where the set has no facets.
    "uniform"
        All the same.
    """

    @staticmethod
    def sets(value: Sequence[SetWeight]) -> Weights:
        """Given by sets; points that are in none count nothing."""
        return Weights({"sets": value})


class File(Table):
    """A problem as plain data: bodies, what holds and loads them, interfaces, steps, solver, output.

    It can be filled in by hand or read from TOML; `Problem.check` applies the same rules to both.

    Parameters
    ----------
    body
        Elastic bodies, by name.
    format
        The format of the file: 1.
    model
        The space in which the bodies live.
    step
        The steps of the analysis, in order.
    amplitude
        Factors over time, by name.
    coupling
        Equations between displacements, springs between points and ties to reference points, by name.
    initial
        Initial displacements, velocities and temperatures, by name.
    interface
        Pairs of surfaces that may touch, by name.
    load
        Forces and springs, by name.
    mass
        Masses at points, by name.
    material
        Materials, by name.
    obstacle
        Rigid obstacles, by name.
    output
        What is written, and when.
    pretension
        Cuts through bolts that are tightened, by name.
    probe
        Quantities followed over the analysis, by name.
    quality
        What counts as a good solution.
    reference
        Points that belong to no mesh, by name.
    set
        Sets chosen by geometry, by name.
    solver
        Tolerances and limits of the solution.
    support
        Prescribed displacements, by name.
    temperature
        Temperatures of sets, by name.
    title
        A title for reports.
    """

    def __init__(self, *, body: Mapping[str, Body], format: int, model: Model, step: Sequence[Step], amplitude: Mapping[str, AmplitudeTable] | None = None, coupling: Mapping[str, Coupling] | None = None, initial: Mapping[str, Initial] | None = None, interface: Mapping[str, Interface] | None = None, load: Mapping[str, Load] | None = None, mass: Mapping[str, Mass] | None = None, material: Mapping[str, Material] | None = None, obstacle: Mapping[str, Obstacle] | None = None, output: Output | None = None, pretension: Mapping[str, Pretension] | None = None, probe: Mapping[str, Probe] | None = None, quality: Limits | None = None, reference: Mapping[str, Reference] | None = None, set: Mapping[str, Set] | None = None, solver: Solver | None = None, support: Mapping[str, Support] | None = None, temperature: Mapping[str, Temperature] | None = None, title: str | None = None) -> None:
        super().__init__(locals())


#: Entries of a stiffness, in rows or in one list.
Entries = Union[Rows, Numbers]


#: How a material expands when it is heated.
Expansion = Union[float, Numbers, ExpansionTable]


#: How many cycles one that is computed stands for: what slides in it wears as often.
Jump = Union[int, ChosenJump]


#: A parameter of a law: one number, or a table over a coordinate.
Profile = Union[float, Along]
