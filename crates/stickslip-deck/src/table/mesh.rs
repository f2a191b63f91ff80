//! Nodes, elements, sets, surfaces, and what ties nodes together.

use super::row::{
    Data, Fate, INPUT, Row, SUBROUTINE, card, harmless, harmless_card, idle, read, refused,
};

const IMPORT: &str =
    "results of other runs are not read: give the part, and its nodes and elements, in this deck";

pub(super) const ROWS: &[Row] = &[
    Row {
        others: Some(Fate::Idle("the title is a name")),
        ..card("HEADING", Data::Any, &[])
    },
    card("PART", Data::Nothing, &[read("NAME")]),
    card("ENDPART", Data::Nothing, &[]),
    card("ASSEMBLY", Data::Nothing, &[read("NAME")]),
    card("ENDASSEMBLY", Data::Nothing, &[]),
    card(
        "INSTANCE",
        Data::Any,
        &[
            read("NAME"),
            read("PART"),
            refused("LIBRARY", IMPORT),
            refused("INSTANCE", IMPORT),
        ],
    ),
    card("ENDINSTANCE", Data::Nothing, &[]),
    card("SYSTEM", Data::Lines("x, y, z, x, y, z"), &[]),
    card(
        "NODE",
        // Directions of normals are for shells and beams.
        Data::Lines("node, x, y, z, normal x, normal y, normal z"),
        &[read("NSET"), read("SYSTEM"), INPUT],
    ),
    card(
        "ELEMENT",
        Data::Any,
        &[
            read("TYPE"),
            read("ELSET"),
            harmless(
                "SOLIDELEMENTNUMBERING",
                "it numbers elements that CalculiX makes of shells",
            ),
            refused("OFFSET", "write the numbers of the nodes out"),
            INPUT,
        ],
    ),
    card(
        "NGEN",
        Data::Lines(
            "first node, last node, increment, node of the curve, x, y, z, normal x, normal y, normal z",
        ),
        &[read("NSET"), read("LINE"), read("SYSTEM")],
    ),
    card(
        "NFILL",
        Data::Lines("first set, second set, number of intervals, increment"),
        &[
            read("NSET"),
            read("BIAS"),
            read("TWOSTEP"),
            refused(
                "SINGULAR",
                "elements at the tip of a crack are as others are: leave it out",
            ),
        ],
    ),
    card(
        "NCOPY",
        Data::Lines("x, y, z, x, y, z, angle"),
        &[
            read("OLDSET"),
            read("NEWSET"),
            read("CHANGENUMBER"),
            read("SHIFT"),
            read("REFLECT"),
            refused(
                "POLE",
                "infinite elements are not computed: write the nodes out",
            ),
            refused(
                "MULTIPLE",
                "write the whole angle, or one *NCOPY after another",
            ),
        ],
    ),
    card(
        "ELGEN",
        Data::Lines(
            "element, number in a row, increment of nodes, increment of elements, rows, increment of nodes, increment of elements, layers, increment of nodes, increment of elements",
        ),
        &[
            read("ELSET"),
            idle("ALLNODES", "it is of nodes of rigid surfaces and of beams"),
        ],
    ),
    card(
        "ELCOPY",
        Data::Nothing,
        &[
            read("OLDSET"),
            read("NEWSET"),
            read("ELEMENTSHIFT"),
            read("SHIFTNODES"),
            read("REFLECT"),
        ],
    ),
    card(
        "NSET",
        Data::Any,
        &[
            read("NSET"),
            read("GENERATE"),
            read("ELSET"),
            harmless(
                "FREQUENCY",
                "it belongs to *NODE PRINT; CalculiX leaves it out here, too",
            ),
            read("UNSORTED"),
            idle("INTERNAL", "it hides the set in a viewer"),
            read("INSTANCE"),
            INPUT,
        ],
    ),
    card(
        "ELSET",
        Data::Any,
        &[
            read("ELSET"),
            read("GENERATE"),
            idle("UNSORTED", "sets keep the order of the deck"),
            idle("INTERNAL", "it hides the set in a viewer"),
            read("INSTANCE"),
            INPUT,
        ],
    ),
    card(
        "SURFACE",
        Data::Lines("element or set of elements or node, face"),
        &[
            read("NAME"),
            read("TYPE"),
            read("TRIM"),
            idle("INTERNAL", "it hides the surface in a viewer"),
            read("COMBINE"),
            refused("CROP", "name the faces that are meant"),
            refused(
                "MAXRATIO",
                "it is of surfaces that sections of shells smooth",
            ),
        ],
    ),
    card(
        "TRANSFORM",
        Data::Line("ax, ay, az, bx, by, bz"),
        &[read("NSET"), read("TYPE")],
    ),
    harmless_card(
        "PHYSICALCONSTANTS",
        "neither radiation nor gravitation between bodies is computed; both are refused where they are asked for",
    ),
    card(
        "EQUATION",
        Data::Any,
        &[read("REMOVE"), read("REMOVEALL"), INPUT],
    ),
    card(
        "RIGIDBODY",
        Data::Nothing,
        &[
            read("NSET"),
            read("ELSET"),
            read("REFNODE"),
            read("ROTNODE"),
            read("POSITION"),
            harmless("ISOTHERMAL", "temperatures are not computed"),
            refused(
                "PINNSET",
                "tie nodes to the body by *EQUATION, or name its elements",
            ),
            refused(
                "TIENSET",
                "tie nodes to the body by *EQUATION, or name its elements",
            ),
            refused(
                "ANALYTICALSURFACE",
                "write a stickslip problem file, which has obstacles (plane, cylinder, sphere)",
            ),
        ],
    ),
    card(
        "PRE-TENSIONSECTION",
        Data::Line("nx, ny, nz"),
        &[
            read("SURFACE"),
            read("NODE"),
            refused(
                "ELEMENT",
                "only sections through solid and plane elements are drawn together: name their faces by SURFACE",
            ),
        ],
    ),
    card(
        "COUPLING",
        Data::Nothing,
        &[
            read("CONSTRAINTNAME"),
            read("REFNODE"),
            read("SURFACE"),
            read("ORIENTATION"),
            refused(
                "INFLUENCERADIUS",
                "make a surface of the nodes that are to be tied",
            ),
            refused("ALPHA", "couplings have no damping"),
        ],
    ),
    card(
        "KINEMATIC",
        Data::Lines("first direction, last direction"),
        &[],
    ),
    card(
        "DISTRIBUTING",
        Data::Lines("first direction, last direction"),
        &[
            read("WEIGHTINGMETHOD"),
            refused("COUPLING", "moments are spread as those of a continuum are"),
        ],
    ),
    card(
        "KINEMATICCOUPLING",
        Data::Lines("node or set of nodes, first direction, last direction"),
        &[read("REFNODE"), read("ORIENTATION")],
    ),
    card(
        "DISTRIBUTINGCOUPLING",
        Data::Lines("node or set of nodes, weight"),
        &[read("ELSET")],
    ),
    card(
        "MPC",
        Data::Any,
        &[
            refused("USER", SUBROUTINE),
            refused("MODE", SUBROUTINE),
            INPUT,
        ],
    ),
    card(
        "SPRING",
        Data::Any,
        &[
            read("ELSET"),
            refused(
                "ORIENTATION",
                "springs are along the axes, or along the line of a SPRINGA",
            ),
            refused("NONLINEAR", "springs are linear: give one stiffness"),
            refused("COMPLEXSTIFFNESS", "springs are elastic"),
            refused("RTOL", "springs are linear: give one stiffness"),
        ],
    ),
    card(
        "DASHPOT",
        Data::Any,
        &[
            read("ELSET"),
            refused(
                "ORIENTATION",
                "dashpots are along the axes, or along the line of a DASHPOTA",
            ),
            refused("NONLINEAR", "dashpots are linear: give one coefficient"),
            refused("RTOL", "dashpots are linear: give one coefficient"),
        ],
    ),
    card(
        "GAP",
        Data::Line("clearance, x, y, z, area, stiffness, tension"),
        &[read("ELSET")],
    ),
    card(
        "MASS",
        Data::Line("mass"),
        &[
            read("ELSET"),
            refused("ALPHA", "masses have no damping of their own"),
            refused("COMPOSITE", "modal damping is not computed"),
            refused("TYPE", "masses are the same in all directions"),
            refused("ORIENTATION", "masses are the same in all directions"),
        ],
    ),
    card(
        "INITIALCONDITIONS",
        Data::Lines("node or set of nodes, direction or temperature, value"),
        &[
            read("TYPE"),
            refused("USER", SUBROUTINE),
            refused(
                "FILE",
                "results of other runs are not read: write the values into the deck",
            ),
            refused(
                "STEP",
                "results of other runs are not read: write the values into the deck",
            ),
            refused(
                "INC",
                "results of other runs are not read: write the values into the deck",
            ),
            INPUT,
        ],
    ),
    card(
        "AMPLITUDE",
        Data::Any,
        &[
            read("NAME"),
            read("TIME"),
            read("SHIFTX"),
            read("SHIFTY"),
            read("DEFINITION"),
            read("VALUE"),
            refused("SMOOTH", "give more points of the curve"),
            refused("USER", SUBROUTINE),
            refused("FIXEDINTERVAL", "write the times out"),
            refused("BEGIN", "write the times out"),
            INPUT,
        ],
    ),
    card(
        "TIMEPOINTS",
        Data::Any,
        &[read("NAME"), read("GENERATE"), read("TIME")],
    ),
    card("NORMAL", Data::Any, &[read("TYPE")]),
];
