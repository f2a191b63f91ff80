//! Steps, loads and supports.

use super::row::{
    Data, NUMERICS, Row, SUBROUTINE, card, harmless, harmless_card, idle, read, refused,
};
use crate::parse::{harmonic, initial, loads, material_motion, step};

const FLUID: &str = "it is about fluids, and bodies are solid";
const SUBMODEL: &str =
    "results of other runs are not read: prescribe the displacements of the cut by *BOUNDARY";
const CYCLIC: &str = "cyclic symmetry is not computed: model the whole body";
const STILL: &str =
    "base excitation is not supported in steady-state dynamics: use harmonic forces";
const DIRECT: &str = "the answer is as good as the residual that is told of each frequency, however it is found: leave it out, and write INTERVAL=RANGE for frequencies without regard to modes";
const FOLLOWER: &str = "forces keep their direction: leave FOLLOWER out";
const NOT_FROM_FILES: &str = "results of a heat analysis are not read from a file: write the temperature of each node on data lines";
const TIME_GOES_ON: &str = "the time of the analysis goes on from step to step: leave it out, and begin amplitudes of the total time where the step does";
const GYROSCOPIC: &str = "what turns does so slowly here, without gyroscopic forces; modes of steady sliding are found by *COMPLEX FREQUENCY alone, after a *STATIC step with *MOTION";
const ACCURACY: &str = "it controls the lengths of increments; those are stickslip's own, in the bounds of the data line";

pub(super) const ROWS: &[Row] = &[
    card(
        "STEP",
        step::step,
        Data::Any,
        &[
            read("NLGEOM"),
            read("AMPLITUDE"),
            idle(
                "INC",
                "it bounds the number of increments; a step runs to its end or fails",
            ),
            harmless("INCF", FLUID),
            harmless("TURBULENCEMODEL", FLUID),
            harmless("SHOCKSMOOTHING", FLUID),
            idle("NAME", "steps are known by their number"),
            harmless("UNSYMM", NUMERICS),
            harmless("EXTRAPOLATION", NUMERICS),
            idle("SOLVER", NUMERICS),
            harmless("CONVERTSDI", NUMERICS),
            read("PERTURBATION"),
        ],
    ).kept(),
    card("ENDSTEP", step::end_step, Data::Nothing, &[]),
    card(
        "STATIC",
        step::statics,
        Data::Line("first increment, period, smallest increment, largest increment"),
        &[
            read("DIRECT"),
            idle("SOLVER", NUMERICS),
            harmless(
                "NLGEOM",
                "it belongs to *STEP; CalculiX leaves it out here, too",
            ),
            harmless(
                "STABILIZE",
                "it is meant not to change the answer; bodies that are free to move are said by name",
            ),
            harmless("ALLSDTOL", "it goes with STABILIZE"),
            harmless("FACTOR", "it goes with STABILIZE"),
            harmless("CONTINUE", "it goes with STABILIZE"),
            harmless(
                "LONGTERM",
                "without *VISCOELASTIC, which is refused, moduli are those of any time",
            ),
            refused("FULLYPLASTIC", "bodies are linear elastic"),
            refused(
                "RIKS",
                "loads are prescribed: prescribe a displacement where a load would fall",
            ),
            refused("TIMERESET", TIME_GOES_ON),
            refused("TOTALTIMEATSTART", TIME_GOES_ON),
        ],
    ).kept(),
    card(
        "DYNAMIC",
        step::dynamics,
        Data::Line("first increment, period, smallest increment, largest increment"),
        &[
            read("DIRECT"),
            read("EXPLICIT"),
            read("ALPHA"),
            read("APPLICATION"),
            read("INITIAL"),
            idle("SOLVER", NUMERICS),
            harmless(
                "NLGEOM",
                "it belongs to *STEP; CalculiX leaves it out here, too",
            ),
            harmless("NOHAF", ACCURACY),
            harmless("HALFINCSCALEFACTOR", ACCURACY),
            harmless("HAFTOL", ACCURACY),
            harmless("SCALEFACTOR", ACCURACY),
            harmless("IMPROVEDDTMETHOD", ACCURACY),
            refused(
                "RELATIVETOABSOLUTE",
                "displacements are absolute throughout: write the step with absolute ones",
            ),
            refused("TIMERESET", TIME_GOES_ON),
            refused("TOTALTIMEATSTART", TIME_GOES_ON),
            refused("SUBSPACE", "modal dynamics is not computed"),
            refused("ADIABATIC", "temperatures are not computed"),
        ],
    ).kept(),
    card(
        "FREQUENCY",
        step::frequency,
        Data::Any,
        &[
            idle("SOLVER", NUMERICS),
            idle("EIGENSOLVER", NUMERICS),
            idle(
                "STORAGE",
                "shapes are written as fields, and matrices on demand",
            ),
            idle("NORMALIZATION", "shapes have the mass one"),
            refused("GLOBAL", "matrices are not written: leave GLOBAL out"),
            refused("CYCMPC", CYCLIC),
            refused("ALPHA", CYCLIC),
        ],
    ).kept(),
    card(
        "COMPLEXFREQUENCY",
        step::complex_frequency,
        Data::Line("number of modes, lowest frequency, highest frequency, shift"),
        &[
            read("FRICTIONDAMPING"),
            idle("NORMALIZATION", "shapes have the mass one"),
            idle(
                "PROPERTYEVALUATION",
                "nothing that is read depends on the frequency",
            ),
            harmless("UNSTABLEMODESONLY", "all modes are in the table"),
            harmless("LEFTEIGENVECTORS", "shapes are the right ones"),
            idle("RIGHTEIGENVECTORS", "shapes are the right ones"),
            idle("SOLVER", NUMERICS),
            refused(
                "STIFFNESSPROJECTION",
                "friction is in the stiffness: leave STIFFNESS PROJECTION out",
            ),
            refused("CORIOLIS", GYROSCOPIC),
            refused("FLUTTER", GYROSCOPIC),
        ],
    ).kept(),
    card(
        "STEADYSTATEDYNAMICS",
        harmonic::steady_state,
        Data::Line("lowest frequency, highest frequency, number of points, bias"),
        &[
            read("INTERVAL"),
            read("FREQUENCYSCALE"),
            read("HARMONIC"),
            idle("SOLVER", NUMERICS),
            idle(
                "FRICTIONDAMPING",
                "friction of steady sliding damps here as in modes",
            ),
            refused("DIRECT", DIRECT),
            refused("SUBSPACEPROJECTION", DIRECT),
            refused("REALONLY", "damping counts: leave REAL ONLY out"),
            refused("CYCMPC", CYCLIC),
            refused(
                "NLGEOM",
                "stress does not stiffen bodies, as strains are small: leave NLGEOM out",
            ),
        ],
    ).kept(),
    card(
        "MODALDAMPING",
        harmonic::modal_damping,
        Data::Any,
        &[
            read("RAYLEIGH"),
            read("MODAL"),
            refused(
                "STRUCTURAL",
                "damping that does not grow with the frequency is not computed: near a resonance a ratio of half its size does the same",
            ),
            refused("DEFINITION", "give ratios by the number of modes"),
            refused("VISCOUS", "give ratios by the number of modes"),
        ],
    ),
    card(
        "MOTION",
        material_motion::material_motion,
        Data::Any,
        &[
            read("ROTATION"),
            read("TRANSLATION"),
            read("TYPE"),
            refused(
                "AMPLITUDE",
                "sliding lasts and has one velocity in a step: leave AMPLITUDE out, and write the velocity that counts",
            ),
            refused(
                "DEFINITION",
                "give two points of the axis, DEFINITION=COORDINATES, and leave it out",
            ),
            refused("ELEMENT", "currents are not computed: name nodes"),
            refused("USER", SUBROUTINE),
        ],
    ),
    card(
        "BOUNDARY",
        loads::boundary,
        Data::Lines("node or set of nodes, first direction, last direction, value"),
        &[
            read("OP"),
            read("AMPLITUDE"),
            read("TIMEDELAY"),
            read("FIXED"),
            read("TYPE"),
            refused("LOADCASE", STILL),
            refused("SUBMODEL", SUBMODEL),
            refused("STEP", SUBMODEL),
            refused("DATASET", SUBMODEL),
            refused("MASSFLOW", "flows are not computed"),
            refused("REGIONTYPE", "the mesh moves with the material"),
            refused("USER", SUBROUTINE),
            refused("OMEGA0", CYCLIC),
        ],
    ),
    card(
        "CLOAD",
        loads::forces,
        Data::Lines("node or set of nodes, direction, force"),
        &[
            read("OP"),
            read("AMPLITUDE"),
            read("TIMEDELAY"),
            read("LOADCASE"),
            refused("SUBMODEL", SUBMODEL),
            refused("STEP", SUBMODEL),
            refused("DATASET", SUBMODEL),
            refused("SECTOR", CYCLIC),
            refused("OMEGA0", CYCLIC),
            refused("CYCLICMODE", CYCLIC),
            refused("FOLLOWER", FOLLOWER),
            read("REAL"),
            read("IMAGINARY"),
            refused("USER", SUBROUTINE),
        ],
    ),
    card(
        "TEMPERATURE",
        initial::temperature,
        Data::Lines("node or set of nodes, temperature"),
        &[
            read("OP"),
            read("AMPLITUDE"),
            read("TIMEDELAY"),
            refused("FILE", NOT_FROM_FILES),
            refused("BSTEP", NOT_FROM_FILES),
            refused("ESTEP", NOT_FROM_FILES),
            refused("BINC", NOT_FROM_FILES),
            refused("EINC", NOT_FROM_FILES),
            refused("INTERPOLATE", NOT_FROM_FILES),
            refused("MIDSIDE", NOT_FROM_FILES),
            refused("ABSOLUTEEXTERIORTOLERANCE", NOT_FROM_FILES),
            refused("SUBMODEL", SUBMODEL),
            refused("STEP", SUBMODEL),
            refused("DATASET", SUBMODEL),
            refused("USER", SUBROUTINE),
        ],
    ),
    card(
        "DLOAD",
        loads::distributed,
        Data::Lines("elements, kind, value, x, y, z, dx, dy, dz"),
        &[
            read("OP"),
            read("AMPLITUDE"),
            read("TIMEDELAY"),
            read("LOADCASE"),
            refused("SUBMODEL", SUBMODEL),
            refused("STEP", SUBMODEL),
            refused("DATASET", SUBMODEL),
            refused("SECTOR", CYCLIC),
            refused("CYCLICMODE", CYCLIC),
            refused("FOLLOWER", FOLLOWER),
            refused("ORIENTATION", "give components along the global axes"),
            read("REAL"),
            read("IMAGINARY"),
            harmless(
                "CONSTANTRESULTANT",
                "pressures act on the faces as they were at first, which keeps their resultant",
            ),
        ],
    ),
    card(
        "DSLOAD",
        loads::surface_loads,
        Data::Lines("surface, kind, value"),
        &[
            read("OP"),
            read("AMPLITUDE"),
            read("TIMEDELAY"),
            read("LOADCASE"),
            refused("SUBMODEL", SUBMODEL),
            refused("STEP", SUBMODEL),
            refused("DATASET", SUBMODEL),
            refused("FOLLOWER", FOLLOWER),
            refused("ORIENTATION", "give components along the global axes"),
            read("REAL"),
            read("IMAGINARY"),
            harmless(
                "CONSTANTRESULTANT",
                "pressures act on the faces as they were at first, which keeps their resultant",
            ),
        ],
    ),
    card(
        "RESTART",
        |_, _| {},
        Data::Any,
        &[
            harmless(
                "WRITE",
                "restart files are not written; `stickslip run` keeps its own",
            ),
            idle("FREQUENCY", "restart files are not written"),
            harmless("NUMBERINTERVAL", "restart files are not written"),
            harmless("OVERLAY", "restart files are not written"),
            harmless("TIMEMARKS", "restart files are not written"),
            refused(
                "READ",
                "restart files of other programs are not read: write all steps into one deck",
            ),
            refused(
                "STEP",
                "restart files of other programs are not read: write all steps into one deck",
            ),
            refused(
                "INC",
                "restart files of other programs are not read: write all steps into one deck",
            ),
            refused(
                "ENDSTEP",
                "restart files of other programs are not read: write all steps into one deck",
            ),
        ],
    ),
    harmless_card(
        "CONTROLS",
        "tolerances and cut-backs are stickslip's own, see [solver] and [quality]: they say how exactly and by which increments the answer is found",
    ),
    harmless_card("SOLUTIONTECHNIQUE", NUMERICS),
];
