//! Nodes, elements, sets, surfaces, and what ties nodes together.

use super::row::{
    Data, Fate, INPUT, Row, SUBROUTINE, card, harmless, harmless_card, idle, read, refused,
};
use crate::deck::Way;
use crate::parse::{
    couplings, elements, generate, generate_elements, initial, instances, links, nodes, sets, step,
    structure::Level, surfaces, times,
};

const IMPORT: &str =
    "results of other runs are not read: give the part, and its nodes and elements, in this deck";

pub(super) const ROWS: &[Row] = &[
    Row {
        others: Some(Fate::Idle("the title is a name")),
        ..card("HEADING", |r, c| step::heading(&mut r.deck, c), Data::Any, &[])
    },
    card("PART", instances::part, Data::Nothing, &[read("NAME")]).at(Level::Structure).kept(),
    card("ENDPART", instances::end_part, Data::Nothing, &[]).at(Level::Structure).kept(),
    card("ASSEMBLY", instances::assembly, Data::Nothing, &[read("NAME")])
        .at(Level::Structure)
        .kept(),
    card("ENDASSEMBLY", instances::end_assembly, Data::Nothing, &[]).at(Level::Structure).kept(),
    card(
        "INSTANCE",
        instances::instance,
        Data::Any,
        &[
            read("NAME"),
            read("PART"),
            refused("LIBRARY", IMPORT),
            refused("INSTANCE", IMPORT),
        ],
    ).at(Level::Structure).kept(),
    card("ENDINSTANCE", instances::end_instance, Data::Nothing, &[]).at(Level::Structure).kept(),
    card("SYSTEM", nodes::system, Data::Lines("x, y, z, x, y, z"), &[]).at(Level::Mesh),
    card(
        "NODE",
        nodes::nodes,
        // Directions of normals are for shells and beams.
        Data::Lines("node, x, y, z, normal x, normal y, normal z"),
        &[read("NSET"), read("SYSTEM"), INPUT],
    ).at(Level::Mesh).kept(),
    card(
        "ELEMENT",
        elements::elements,
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
    ).at(Level::Mesh).kept(),
    card(
        "NGEN",
        generate::generate_nodes,
        Data::Lines(
            "first node, last node, increment, node of the curve, x, y, z, normal x, normal y, normal z",
        ),
        &[read("NSET"), read("LINE"), read("SYSTEM")],
    ).at(Level::Mesh).kept(),
    card(
        "NFILL",
        generate::fill_nodes,
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
    ).at(Level::Mesh).kept(),
    card(
        "NCOPY",
        generate::copy_nodes,
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
    ).at(Level::Mesh).kept(),
    card(
        "ELGEN",
        generate_elements::generate_elements,
        Data::Lines(
            "element, number in a row, increment of nodes, increment of elements, rows, increment of nodes, increment of elements, layers, increment of nodes, increment of elements",
        ),
        &[
            read("ELSET"),
            idle("ALLNODES", "it is of nodes of rigid surfaces and of beams"),
        ],
    ).at(Level::Mesh).kept(),
    card(
        "ELCOPY",
        generate_elements::copy_elements,
        Data::Nothing,
        &[
            read("OLDSET"),
            read("NEWSET"),
            read("ELEMENTSHIFT"),
            read("SHIFTNODES"),
            read("REFLECT"),
        ],
    ).at(Level::Mesh).kept(),
    card(
        "NSET",
        sets::node_set,
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
    ).at(Level::Mesh).kept(),
    card(
        "ELSET",
        sets::element_set,
        Data::Any,
        &[
            read("ELSET"),
            read("GENERATE"),
            idle("UNSORTED", "sets keep the order of the deck"),
            idle("INTERNAL", "it hides the set in a viewer"),
            read("INSTANCE"),
            INPUT,
        ],
    ).at(Level::Mesh).kept(),
    card(
        "SURFACE",
        surfaces::surface,
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
    ).at(Level::Mesh).kept(),
    card(
        "TRANSFORM",
        nodes::transform,
        Data::Line("ax, ay, az, bx, by, bz"),
        &[read("NSET"), read("TYPE")],
    ).at(Level::Mesh),
    harmless_card(
        "PHYSICALCONSTANTS",
        "neither radiation nor gravitation between bodies is computed; both are refused where they are asked for",
    ),
    card(
        "EQUATION",
        links::equation,
        Data::Any,
        &[read("REMOVE"), read("REMOVEALL"), INPUT],
    ).at(Level::Mesh),
    card(
        "RIGIDBODY",
        links::rigid_body,
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
    ).at(Level::Mesh),
    card(
        "PRE-TENSIONSECTION",
        links::pretension,
        Data::Line("nx, ny, nz"),
        &[
            read("SURFACE"),
            read("NODE"),
            refused(
                "ELEMENT",
                "only sections through solid and plane elements are drawn together: name their faces by SURFACE",
            ),
        ],
    ).at(Level::Mesh),
    card(
        "COUPLING",
        couplings::coupling,
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
    ).at(Level::Mesh),
    card(
        "KINEMATIC",
        |r, c| couplings::way(r, c, Way::Kinematic),
        Data::Lines("first direction, last direction"),
        &[],
    ).at(Level::Mesh),
    card(
        "DISTRIBUTING",
        |r, c| couplings::way(r, c, Way::Distributing),
        Data::Lines("first direction, last direction"),
        &[
            read("WEIGHTINGMETHOD"),
            refused("COUPLING", "moments are spread as those of a continuum are"),
        ],
    ).at(Level::Mesh),
    card(
        "KINEMATICCOUPLING",
        couplings::kinematic_coupling,
        Data::Lines("node or set of nodes, first direction, last direction"),
        &[read("REFNODE"), read("ORIENTATION")],
    ).at(Level::Mesh),
    card(
        "DISTRIBUTINGCOUPLING",
        couplings::distributing_coupling,
        Data::Lines("node or set of nodes, weight"),
        &[read("ELSET")],
    ).at(Level::Mesh),
    card(
        "MPC",
        couplings::multi_point,
        Data::Any,
        &[
            refused("USER", SUBROUTINE),
            refused("MODE", SUBROUTINE),
            INPUT,
        ],
    ).at(Level::Mesh),
    card(
        "SPRING",
        links::spring,
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
    ).at(Level::Mesh),
    card(
        "DASHPOT",
        links::spring,
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
    ).at(Level::Mesh),
    card(
        "GAP",
        links::gap,
        Data::Line("clearance, x, y, z, area, stiffness, tension"),
        &[read("ELSET")],
    ).at(Level::Mesh),
    card(
        "MASS",
        links::mass,
        Data::Line("mass"),
        &[
            read("ELSET"),
            refused("ALPHA", "masses have no damping of their own"),
            refused("COMPOSITE", "modal damping is not computed"),
            refused("TYPE", "masses are the same in all directions"),
            refused("ORIENTATION", "masses are the same in all directions"),
        ],
    ).at(Level::Mesh),
    card(
        "INITIALCONDITIONS",
        initial::initial_conditions,
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
        times::amplitude,
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
    ).kept(),
    card(
        "TIMEPOINTS",
        times::time_points,
        Data::Any,
        &[read("NAME"), read("GENERATE"), read("TIME")],
    ),
    card("NORMAL", |r, c| nodes::normal(&mut r.messages, c), Data::Any, &[read("TYPE")]).at(Level::Mesh),
];
