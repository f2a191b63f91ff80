//! Which function reads a card that the table calls read.

use super::reader::{Context, Reader};
use crate::card::Card;
use crate::deck::Way;

/// What reads a card.
type Read = fn(&mut Reader<'_>, &Card);

/// Every card that is read, with what reads it.
const CARDS: &[(&str, Read)] = &[
    ("HEADING", |r, c| r.heading(c)),
    ("PART", |r, c| r.part(c)),
    ("ENDPART", |r, c| r.end_part(c)),
    ("ASSEMBLY", |r, c| r.assembly(c)),
    ("ENDASSEMBLY", |r, c| r.end_assembly(c)),
    ("INSTANCE", |r, c| r.instance(c)),
    ("ENDINSTANCE", |r, c| r.end_instance(c)),
    ("SYSTEM", |r, c| r.system(c)),
    ("NODE", |r, c| r.nodes(c)),
    ("ELEMENT", |r, c| r.elements(c)),
    ("NGEN", |r, c| r.generate_nodes(c)),
    ("NFILL", |r, c| r.fill_nodes(c)),
    ("NCOPY", |r, c| r.copy_nodes(c)),
    ("ELGEN", |r, c| r.generate_elements(c)),
    ("ELCOPY", |r, c| r.copy_elements(c)),
    ("NSET", |r, c| r.node_set(c)),
    ("ELSET", |r, c| r.element_set(c)),
    ("SURFACE", |r, c| r.surface(c)),
    ("TRANSFORM", |r, c| r.transform(c)),
    ("EQUATION", |r, c| r.equation(c)),
    ("RIGIDBODY", |r, c| r.rigid_body(c)),
    ("PRE-TENSIONSECTION", |r, c| r.pretension(c)),
    ("COUPLING", |r, c| r.coupling(c)),
    ("KINEMATIC", |r, c| r.way(c, Way::Kinematic)),
    ("DISTRIBUTING", |r, c| r.way(c, Way::Distributing)),
    ("KINEMATICCOUPLING", |r, c| r.kinematic_coupling(c)),
    ("DISTRIBUTINGCOUPLING", |r, c| r.distributing_coupling(c)),
    ("MPC", |r, c| r.multi_point(c)),
    ("SPRING", |r, c| r.spring(c)),
    ("DASHPOT", |r, c| r.spring(c)),
    ("GAP", |r, c| r.gap(c)),
    ("MASS", |r, c| r.mass(c)),
    ("INITIALCONDITIONS", |r, c| r.initial_conditions(c)),
    ("MATERIAL", |r, c| r.material(c)),
    ("ELASTIC", |r, c| r.elastic(c)),
    ("DENSITY", |r, c| r.density(c)),
    ("DAMPING", |r, c| r.damping(c)),
    ("EXPANSION", |r, c| r.expansion(c)),
    ("SOLIDSECTION", |r, c| r.solid_section(c)),
    ("ORIENTATION", |r, c| r.orientation(c)),
    ("DISTRIBUTION", |r, c| r.distribution(c)),
    ("DISTRIBUTIONTABLE", |r, c| r.distribution_table(c)),
    ("AMPLITUDE", |r, c| r.amplitude(c)),
    ("SURFACEINTERACTION", |r, c| r.interaction(c)),
    ("SURFACEBEHAVIOR", |r, c| r.behavior(c)),
    ("FRICTION", |r, c| r.friction(c)),
    ("CONTACTDAMPING", |r, c| r.contact_damping(c)),
    ("CHANGEFRICTION", |r, c| {
        r.change(c, Context::ChangeFriction)
    }),
    ("CHANGESURFACEBEHAVIOR", |r, c| {
        r.change(c, Context::ChangeBehavior)
    }),
    ("CONTACTPAIR", |r, c| r.contact_pair(c)),
    ("MODELCHANGE", |r, c| r.model_change(c)),
    ("CLEARANCE", |r, c| r.clearance(c)),
    ("TIE", |r, c| r.tie(c)),
    ("TIMEPOINTS", |r, c| r.time_points(c)),
    ("STEP", |r, c| r.step(c)),
    ("ENDSTEP", |r, c| r.end_step(c)),
    ("STATIC", |r, c| r.statics(c)),
    ("DYNAMIC", |r, c| r.dynamics(c)),
    ("FREQUENCY", |r, c| r.frequency(c)),
    ("COMPLEXFREQUENCY", |r, c| r.complex_frequency(c)),
    ("STEADYSTATEDYNAMICS", |r, c| r.steady_state(c)),
    ("MODALDAMPING", |r, c| r.modal_damping(c)),
    ("MOTION", |r, c| r.material_motion(c)),
    ("BOUNDARY", |r, c| r.boundary(c)),
    ("CLOAD", |r, c| r.forces(c)),
    ("TEMPERATURE", |r, c| r.temperature(c)),
    ("DLOAD", |r, c| r.distributed(c)),
    ("DSLOAD", |r, c| r.surface_loads(c)),
    ("NODEPRINT", |r, c| r.print(c)),
    ("ELPRINT", |r, c| r.print(c)),
    ("CONTACTPRINT", |r, c| r.print(c)),
    ("SECTIONPRINT", |r, c| r.section_print(c)),
    ("NODEFILE", |r, c| r.output(c)),
    ("ELFILE", |r, c| r.output(c)),
    ("CONTACTFILE", |r, c| r.output(c)),
    ("NODEOUTPUT", |r, c| r.output(c)),
    ("ELEMENTOUTPUT", |r, c| r.output(c)),
    ("CONTACTOUTPUT", |r, c| r.output(c)),
    ("OUTPUT", |r, c| r.output(c)),
    ("NORMAL", |r, c| r.normal(c)),
    // What is refused of it has been said, and nothing else of it matters.
    ("RESTART", |_, _| {}),
];

/// Cards that stand beneath a material or an interaction.
pub(super) const BENEATH: [&str; 7] = [
    "ELASTIC",
    "DENSITY",
    "DAMPING",
    "EXPANSION",
    "SURFACEBEHAVIOR",
    "FRICTION",
    "CONTACTDAMPING",
];

/// Cards that name something, and are read in spite of errors. What they name is looked for later: that it is missing would only be a second error.
pub(super) const NAMES: [&str; 25] = [
    "PART",
    "ENDPART",
    "ASSEMBLY",
    "ENDASSEMBLY",
    "INSTANCE",
    "ENDINSTANCE",
    "NODE",
    "ELEMENT",
    "NGEN",
    "NFILL",
    "NCOPY",
    "ELGEN",
    "ELCOPY",
    "NSET",
    "ELSET",
    "SURFACE",
    "MATERIAL",
    "SURFACEINTERACTION",
    "AMPLITUDE",
    "STEP",
    "STATIC",
    "DYNAMIC",
    "FREQUENCY",
    "COMPLEXFREQUENCY",
    "STEADYSTATEDYNAMICS",
];

/// Procedures that are refused.
pub(super) const OTHER_PROCEDURES: [&str; 21] = [
    "ANNEAL",
    "BUCKLE",
    "CFD",
    "COUPLEDTEMPERATURE-DISPLACEMENT",
    "CRACKPROPAGATION",
    "DIRECTCYCLIC",
    "ELECTROMAGNETICS",
    "FEASIBLEDIRECTION",
    "GEOSTATIC",
    "GREEN",
    "HCF",
    "HEATTRANSFER",
    "MODALDYNAMIC",
    "RANDOMRESPONSE",
    "RESPONSESPECTRUM",
    "ROBUSTDESIGN",
    "SENSITIVITY",
    "SOILS",
    "SUBSTRUCTUREGENERATE",
    "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
    "VISCO",
];

/// The function that reads a card.
pub(super) fn reader_of(keyword: &str) -> Option<Read> {
    let card = CARDS.iter().find(|(name, _)| *name == keyword);
    card.map(|(_, read)| *read)
}
