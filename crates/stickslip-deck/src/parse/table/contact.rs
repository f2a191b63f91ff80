//! Interactions, contact pairs and ties.

use super::row::{Data, NUMERICS, Row, SUBROUTINE, card, harmless, harmless_card, read, refused};
use crate::parse::{interaction, pairs, reader::Context, structure::Level};

const EXACT: &str = "hard contact and sticking are exact here, which is what it approximates";
const HEAT_OF_CONTACT: &str =
    "temperatures are not computed, and what would change them is refused";
const SOLID: &str = "it is about shells, which are refused";
const TIE: &str = "only surfaces that stay together are tied; *EQUATION ties nodes otherwise";

pub(super) const ROWS: &[Row] = &[
    card(
        "SURFACEINTERACTION",
        interaction::interaction,
        Data::Line("thickness"),
        &[
            read("NAME"),
            refused("USER", "give *SURFACE BEHAVIOR and *FRICTION"),
            refused(
                "PADTHICKNESS",
                "let the meshes have the distance of the pad",
            ),
            refused("PAD", "let the meshes have the distance of the pad"),
            refused("DEPVAR", SUBROUTINE),
            refused("PROPERTIES", SUBROUTINE),
            refused("TRACKING", "write *CONTACT PAIR with two surfaces"),
        ],
    ).kept(),
    card(
        "SURFACEBEHAVIOR",
        interaction::behavior,
        Data::Any,
        &[
            read("PRESSURE-OVERCLOSURE"),
            harmless("PENALTY", EXACT),
            harmless("DIRECT", EXACT),
            harmless("AUGMENTEDLAGRANGE", EXACT),
            refused("NOSEPARATION", "use *TIE, or a tied interface"),
        ],
    ).beneath(),
    card(
        "FRICTION",
        interaction::friction,
        Data::Any,
        &[
            read("TAUMAX"),
            read("EXPONENTIALDECAY"),
            read("ROUGH"),
            read("SHEARTRACTIONSLOPE"),
            refused(
                "DEPENDENCIES",
                "friction depends on slip rate and pressure only",
            ),
            harmless("LAGRANGE", EXACT),
            harmless("SLIPTOLERANCE", EXACT),
            harmless("ELASTICSLIP", EXACT),
            refused(
                "ANISOTROPIC",
                "its directions are those of the slave surface, which are not read: leave ANISOTROPIC out, and give both coefficients and an axis by `friction.orthotropic` in the problem file",
            ),
            refused("USER", "see `stickslip models` for the laws there are"),
            refused("DEPVAR", SUBROUTINE),
            refused("PROPERTIES", SUBROUTINE),
            refused("TESTDATA", "give the coefficients and the decay"),
        ],
    ).beneath(),
    card(
        "CHANGEFRICTION",
        |r, c| interaction::change(r, c, Context::ChangeFriction),
        Data::Nothing,
        &[
            read("INTERACTION"),
            refused("RESET", "write the *FRICTION that is meant beneath"),
            refused(
                "AMPLITUDE",
                "the change holds from the start of the step: leave AMPLITUDE out",
            ),
        ],
    ),
    card(
        "CHANGESURFACEBEHAVIOR",
        |r, c| interaction::change(r, c, Context::ChangeBehavior),
        Data::Nothing,
        &[
            read("INTERACTION"),
            refused("RESET", "write the *SURFACE BEHAVIOR that is meant beneath"),
        ],
    ),
    card(
        "CONTACTDAMPING",
        interaction::contact_damping,
        Data::Line("damping coefficient"),
        &[read("DEFINITION"), read("TANGENTFRACTION")],
    ).beneath(),
    card(
        "CONTACTPAIR",
        pairs::contact_pair,
        Data::Lines("slave surface, master surface"),
        &[
            read("INTERACTION"),
            read("TYPE"),
            read("SMALLSLIDING"),
            read("ADJUST"),
            read("TIED"),
            refused(
                "CPSET",
                "write a *CONTACT PAIR without CPSET, and *CLEARANCE for its gap",
            ),
            refused("HCRIT", "contact is found at any penetration: leave it out"),
            refused("OP", "pairs act from the first step on"),
            harmless(
                "EXTENSIONZONE",
                "what lies beyond the edge of the master is not in contact but for a thousandth of a face",
            ),
            harmless("SMOOTH", "surfaces are as their elements have them"),
            harmless(
                "GEOMETRICCORRECTION",
                "surfaces are as their elements have them",
            ),
            harmless("MECHANICALCONSTRAINT", EXACT),
            harmless("NOTHICKNESS", SOLID),
            harmless("SUPPLEMENTARYCONSTRAINTS", NUMERICS),
            harmless("TRACKING", NUMERICS),
            harmless("WEIGHT", EXACT),
            harmless("SLIDINGTRANSITION", NUMERICS),
            harmless("MINIMUMDISTANCE", NUMERICS),
        ],
    ),
    card(
        "MODELCHANGE",
        pairs::model_change,
        Data::Any,
        &[
            read("TYPE"),
            read("ADD"),
            read("REMOVE"),
            refused(
                "ACTIVATE",
                "contact pairs need not be announced: write ADD or REMOVE in the step",
            ),
            refused(
                "MECHSTRAINTORESIDUAL",
                "bodies are elastic and keep no strains: leave it out",
            ),
        ],
    ),
    card(
        "CLEARANCE",
        pairs::clearance,
        Data::Nothing,
        &[
            read("MASTER"),
            read("SLAVE"),
            read("VALUE"),
            refused(
                "TABULAR",
                "give one VALUE for the whole surface, or move the nodes",
            ),
            refused("CPSET", "name the surfaces by MASTER and SLAVE"),
            refused("BOLT", "give one VALUE for the whole surface"),
        ],
    ),
    card(
        "TIE",
        pairs::tie,
        Data::Lines("slave surface, master surface"),
        &[
            read("NAME"),
            read("POSITIONTOLERANCE"),
            read("ADJUST"),
            harmless("TYPE", "surfaces are glued in the mean over their faces"),
            harmless("NOROTATION", "solid elements have no rotations at nodes"),
            harmless("CONSTRAINTRATIO", SOLID),
            harmless("NOTHICKNESS", SOLID),
            refused("TIEDNSET", "make a surface of the faces that are meant"),
            refused("CYCLICSYMMETRY", TIE),
            refused("MULTISTAGE", TIE),
            refused("FLUIDPERIODIC", TIE),
            refused("FLUIDCYCLIC", TIE),
        ],
    ).at(Level::Assembly),
    harmless_card("CONTACTCONTROLS", NUMERICS),
    harmless_card("GAPCONDUCTANCE", HEAT_OF_CONTACT),
    harmless_card("GAPHEATGENERATION", HEAT_OF_CONTACT),
    harmless_card("SURFACEPROPERTY", "it is about acoustics"),
];
