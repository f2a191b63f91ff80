//! Materials and sections.

use super::row::{Data, Row, SUBROUTINE, card, harmless, harmless_card, idle, read, refused};
use crate::parse::{material, orientation, structure::Level};

const HEAT_OF_MATERIAL: &str = "temperatures are given, not computed: heat does not flow";
const CONSTANT: &str = "constants depend on temperature only";

pub(super) const ROWS: &[Row] = &[
    card(
        "MATERIAL",
        material::material,
        Data::Nothing,
        &[
            read("NAME"),
            harmless(
                "SRATE",
                "elastic constants do not depend on the rate of strain",
            ),
            refused("RTOL", "give elastic constants"),
        ],
    )
    .kept(),
    card(
        "ELASTIC",
        material::elastic,
        Data::Any,
        &[
            read("TYPE"),
            harmless(
                "MODULI",
                "without *VISCOELASTIC, which is refused, moduli are those of any time",
            ),
            refused("DEPENDENCIES", CONSTANT),
        ],
    )
    .beneath(),
    card(
        "DENSITY",
        material::density,
        Data::Lines("density, temperature"),
        &[refused("DEPENDENCIES", CONSTANT)],
    )
    .beneath(),
    card(
        "DAMPING",
        material::damping,
        Data::Nothing,
        &[
            read("ALPHA"),
            read("BETA"),
            harmless(
                "STRUCTURAL",
                "it acts in the frequency domain, where nothing is computed",
            ),
            harmless("COMPOSITE", "it acts on modes, which are not computed"),
        ],
    )
    .beneath(),
    card(
        "EXPANSION",
        material::expansion,
        Data::Any,
        &[
            read("TYPE"),
            read("ZERO"),
            refused("DEPENDENCIES", CONSTANT),
            refused("USER", SUBROUTINE),
            refused("PORE", "fluids in pores are not computed"),
        ],
    )
    .beneath(),
    harmless_card("CONDUCTIVITY", HEAT_OF_MATERIAL),
    harmless_card("SPECIFICHEAT", HEAT_OF_MATERIAL),
    harmless_card("LATENTHEAT", HEAT_OF_MATERIAL),
    harmless_card(
        "VISCOSITY",
        "it is a property of fluids, and bodies are solid",
    ),
    harmless_card(
        "FLUIDCONSTANTS",
        "it is a property of fluids, and bodies are solid",
    ),
    harmless_card(
        "SPECIFICGASCONSTANT",
        "it is a property of fluids, and bodies are solid",
    ),
    harmless_card("ELECTRICALCONDUCTIVITY", "no currents are computed"),
    harmless_card("MAGNETICPERMEABILITY", "no magnetic fields are computed"),
    harmless_card(
        "USEROUTPUTVARIABLES",
        "it makes room for results of user subroutines",
    ),
    card(
        "SOLIDSECTION",
        material::solid_section,
        Data::Line("thickness"),
        &[
            read("ELSET"),
            read("MATERIAL"),
            read("ORIENTATION"),
            idle(
                "CONTROLS",
                "elements under reduced integration have stickslip's own hourglass control",
            ),
            harmless(
                "STACKDIRECTION",
                "it orders layers, and sections with layers are refused",
            ),
            harmless(
                "OFFSET",
                "solid and plane elements lie where their nodes are",
            ),
            harmless(
                "NODALTHICKNESS",
                "*NODAL THICKNESS, which would give it, is refused",
            ),
            refused(
                "COMPOSITE",
                "give each layer elements and a *SOLID SECTION of its own",
            ),
            refused(
                "REFNODE",
                "generalised plane strain is not computed: use CPE elements, or solid ones",
            ),
            refused(
                "SYMMETRIC",
                "give each layer elements and a *SOLID SECTION of its own",
            ),
            refused(
                "LAYUP",
                "give each layer elements and a *SOLID SECTION of its own",
            ),
        ],
    )
    .at(Level::Mesh),
    harmless_card(
        "SECTIONCONTROLS",
        "elements under reduced integration have stickslip's own hourglass control",
    ),
    harmless_card(
        "HOURGLASSSTIFFNESS",
        "elements under reduced integration have stickslip's own hourglass control",
    ),
    card(
        "DISTRIBUTION",
        orientation::distribution,
        Data::Any,
        &[
            read("NAME"),
            read("LOCATION"),
            idle("TABLE", "*DISTRIBUTION TABLE is held against what is read"),
        ],
    )
    .at(Level::Mesh),
    card(
        "DISTRIBUTIONTABLE",
        orientation::distribution_table,
        Data::Any,
        &[read("NAME")],
    )
    .at(Level::Mesh),
    card(
        "ORIENTATION",
        orientation::orientation,
        Data::Lines("ax, ay, az, bx, by, bz, cx, cy, cz"),
        &[
            read("NAME"),
            read("SYSTEM"),
            read("DEFINITION"),
            refused("LOCALDIRECTIONS", "give the axes of a rectangular system"),
        ],
    )
    .at(Level::Mesh),
];
