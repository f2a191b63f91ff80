//! Which keywords are known, and what becomes of those that are not read.

/// What becomes of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Treatment {
    /// It is read.
    Read,
    /// It does not change the answer; why.
    Note(&'static str),
    /// It changes the answer and is not supported; what to do.
    Refuse(&'static str),
    /// It is no keyword of either program.
    Unknown,
}

/// Keywords that are read.
pub(crate) const READ: &[&str] = &[
    "HEADING",
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "SURFACE",
    "SOLIDSECTION",
    "MATERIAL",
    "ELASTIC",
    "DENSITY",
    "DAMPING",
    "ORIENTATION",
    "TRANSFORM",
    "AMPLITUDE",
    "BOUNDARY",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "INITIALCONDITIONS",
    "CONTACTPAIR",
    "SURFACEINTERACTION",
    "SURFACEBEHAVIOR",
    "FRICTION",
    "CHANGEFRICTION",
    "CHANGESURFACEBEHAVIOR",
    "CONTACTDAMPING",
    "CLEARANCE",
    "TIE",
    "SPRING",
    "MASS",
    "EQUATION",
    "RIGIDBODY",
    "STEP",
    "ENDSTEP",
    "STATIC",
    "DYNAMIC",
    "CONTROLS",
    "TIMEPOINTS",
    "NODEPRINT",
    "ELPRINT",
    "CONTACTPRINT",
    "NODEFILE",
    "ELFILE",
    "CONTACTFILE",
    "NODEOUTPUT",
    "ELEMENTOUTPUT",
    "CONTACTOUTPUT",
    "OUTPUT",
    "NORMAL",
];

const NOTES: &[(&str, &str)] = &[
    ("PREPRINT", "it only controls printing"),
    ("PRINT", "it only controls printing"),
    ("MONITOR", "it only controls printing"),
    ("FILEFORMAT", "results are written as VTU, CSV and JSON"),
    ("FILEOUTPUT", "results are written as VTU, CSV and JSON"),
    ("ENERGYFILE", "energies are in history.csv"),
    ("ENERGYPRINT", "energies are in history.csv"),
    ("ENERGYOUTPUT", "energies are in history.csv"),
    (
        "SECTIONPRINT",
        "sections are not printed; resultants of interfaces and supports are in history.csv",
    ),
    (
        "SECTIONFILE",
        "sections are not printed; resultants of interfaces and supports are in history.csv",
    ),
    ("FILTER", "results are not filtered"),
    ("EXPANSION", "temperatures stay as they are"),
    ("CONDUCTIVITY", "temperatures are not computed"),
    ("SPECIFICHEAT", "temperatures are not computed"),
    ("GAPCONDUCTANCE", "temperatures are not computed"),
    ("GAPHEATGENERATION", "temperatures are not computed"),
    (
        "PHYSICALCONSTANTS",
        "temperatures and gravitation are not computed",
    ),
    ("RESTART", "restart files are not written"),
    (
        "NOANALYSIS",
        "use `stickslip check` to read without running",
    ),
    ("VISCOSITY", "bodies are elastic"),
    (
        "SECTIONCONTROLS",
        "control of hourglass modes is stickslip's own",
    ),
    (
        "HOURGLASSSTIFFNESS",
        "control of hourglass modes is stickslip's own",
    ),
    (
        "CONTACTCONTROLS",
        "contact is controlled by stickslip itself",
    ),
    ("DIAGNOSTICS", "it only controls printing"),
    ("INCREMENTATIONOUTPUT", "it only controls printing"),
    (
        "INTEGRATEDOUTPUT",
        "resultants of interfaces and supports are in history.csv",
    ),
    ("MODALOUTPUT", "it only controls printing"),
    ("ELECTRICALCONDUCTIVITY", "fields are mechanical"),
    ("MAGNETICPERMEABILITY", "fields are mechanical"),
    ("FLUIDCONSTANTS", "bodies are solid"),
    ("SPECIFICGASCONSTANT", "bodies are solid"),
    ("USEROUTPUTVARIABLES", "it only controls printing"),
    ("SURFACEPROPERTY", "it is not used by contact"),
];

const TIME: &str = "only *STATIC and *DYNAMIC steps are computed";
const HEAT: &str = "temperatures are not computed: take the thermal part out, or prescribe what it does as displacements and loads";
const SECTION: &str = "only solid, plane and axisymmetric continuum elements are computed: model the part with continuum elements";
const LAW: &str =
    "bodies are linear elastic (*ELASTIC): replace the material, or use another program";
const PARTS: &str = "write a flat deck, without parts and assemblies (Abaqus/CAE: Model, Edit Attributes, `Do not use parts and assemblies in input files`)";
const LINK: &str = "express it by *EQUATION, *TIE or *RIGID BODY";

const REFUSED: &[(&str, &str)] = &[
    ("PART", PARTS),
    ("ENDPART", PARTS),
    ("INSTANCE", PARTS),
    ("ENDINSTANCE", PARTS),
    ("ASSEMBLY", PARTS),
    ("ENDASSEMBLY", PARTS),
    ("PLASTIC", LAW),
    ("CYCLICHARDENING", LAW),
    ("HYPERELASTIC", LAW),
    ("HYPERFOAM", LAW),
    ("CREEP", LAW),
    ("USERMATERIAL", LAW),
    ("DEPVAR", LAW),
    ("VISCO", LAW),
    ("DEFORMATIONPLASTICITY", LAW),
    ("MOHRCOULOMB", LAW),
    ("VISCOELASTIC", LAW),
    ("DRUCKERPRAGER", LAW),
    ("BEAMSECTION", SECTION),
    ("SHELLSECTION", SECTION),
    ("MEMBRANESECTION", SECTION),
    ("BEAMGENERALSECTION", SECTION),
    ("SHELLGENERALSECTION", SECTION),
    ("FLUIDSECTION", SECTION),
    ("USERSECTION", SECTION),
    ("COHESIVESECTION", SECTION),
    ("GASKETSECTION", SECTION),
    ("NODALTHICKNESS", SECTION),
    ("SUBSTRUCTUREGENERATE", TIME),
    ("MATRIXASSEMBLE", TIME),
    ("COUPLEDTEMPERATURE-DISPLACEMENT", HEAT),
    ("UNCOUPLEDTEMPERATURE-DISPLACEMENT", HEAT),
    ("HEATTRANSFER", HEAT),
    ("TEMPERATURE", HEAT),
    ("CFLUX", HEAT),
    ("DFLUX", HEAT),
    ("FILM", HEAT),
    ("RADIATE", HEAT),
    ("SFILM", HEAT),
    ("SRADIATE", HEAT),
    ("MASSFLOW", HEAT),
    ("ELECTROMAGNETICS", TIME),
    ("FREQUENCY", TIME),
    ("BUCKLE", TIME),
    ("MODALDYNAMIC", TIME),
    ("MODALDAMPING", TIME),
    ("STEADYSTATEDYNAMICS", TIME),
    ("COMPLEXFREQUENCY", TIME),
    ("GREEN", TIME),
    ("SENSITIVITY", TIME),
    ("CFD", TIME),
    ("CRACKPROPAGATION", TIME),
    ("FEASIBLEDIRECTION", TIME),
    ("ROBUSTDESIGN", TIME),
    ("GEOSTATIC", TIME),
    ("BASEMOTION", TIME),
    (
        "PRE-TENSIONSECTION",
        "stretch the bolt by a prescribed displacement or an overlap (`initial = \"ramp\"`) instead",
    ),
    ("MPC", LINK),
    ("KINEMATIC", LINK),
    ("DISTRIBUTING", LINK),
    ("DISTRIBUTINGCOUPLING", LINK),
    ("COUPLING", LINK),
    ("NETWORKMPC", LINK),
    ("EMBEDDEDELEMENT", LINK),
    ("CYCLICSYMMETRYMODEL", LINK),
    ("SELECTCYCLICSYMMETRYMODES", LINK),
    ("MULTIPOINTCONSTRAINT", LINK),
    (
        "SUBMODEL",
        "prescribe the displacements of the cut by *BOUNDARY",
    ),
    (
        "DASHPOT",
        "dashpots are not computed; *DAMPING gives bodies damping of their own, *CONTACT DAMPING interfaces",
    ),
    ("GAP", "model the gap as two surfaces with a *CONTACT PAIR"),
    (
        "CONTACT",
        "general contact is not computed: name the pairs of surfaces with *CONTACT PAIR",
    ),
    (
        "CONTACTINCLUSIONS",
        "general contact is not computed: name the pairs of surfaces with *CONTACT PAIR",
    ),
    (
        "MODELCHANGE",
        "contact pairs and elements cannot be taken away or added by *MODEL CHANGE: write a stickslip problem file, where steps list `interfaces`",
    ),
    (
        "CONTACTINTERFERENCE",
        "let the meshes overlap, or use *CLEARANCE; `initial = \"ramp\"` in a stickslip file resolves overlaps over a step",
    ),
    (
        "CHANGECONTACTTYPE",
        "the type of a contact pair stays the same",
    ),
    ("KINEMATICCOUPLING", LINK),
    ("CONNECTORSECTION", LINK),
    ("CONNECTORBEHAVIOR", LINK),
    ("FASTENER", LINK),
    ("SHELLTOSOLIDCOUPLING", LINK),
    (
        "CONTACTPROPERTYASSIGNMENT",
        "general contact is not computed: name the pairs of surfaces with *CONTACT PAIR",
    ),
    (
        "CONTACTEXCLUSIONS",
        "general contact is not computed: name the pairs of surfaces with *CONTACT PAIR",
    ),
    ("GEOMETRICCONSTRAINT", TIME),
    ("HCF", TIME),
    ("RANDOMFIELD", TIME),
    ("REFINEMESH", "refine the mesh before"),
    ("RETAINEDNODALDOFS", TIME),
    ("DESIGNRESPONSE", TIME),
    ("PARAMETER", "write numbers in place of parameters"),
    (
        "DISTRIBUTIONTABLE",
        "give each set of elements an *ORIENTATION of its own",
    ),
    ("MOHRCOULOMBHARDENING", LAW),
    ("RATEDEPENDENT", LAW),
    ("CONCRETE", LAW),
    ("CLAYPLASTICITY", LAW),
    ("POROUSELASTIC", LAW),
    ("SYSTEM", "give coordinates in the global system"),
    ("NCOPY", "write the nodes out"),
    ("NFILL", "write the nodes out"),
    ("NGEN", "write the nodes out"),
    ("NMAP", "write the nodes out"),
    ("ELGEN", "write the elements out"),
    ("ELCOPY", "write the elements out"),
    (
        "DISTRIBUTION",
        "give each set of elements an *ORIENTATION of its own",
    ),
    ("ADDRESTRAINT", "use *BOUNDARY"),
    ("VIEWFACTOR", HEAT),
    ("INITIALSTRAININCREASE", TIME),
    ("VALUESATINFINITY", TIME),
    ("MASSLESS", TIME),
    ("CHANGEMATERIAL", LAW),
    ("CHANGEPLASTIC", LAW),
    ("CHANGESOLIDSECTION", LAW),
    ("USERELEMENT", SECTION),
    ("UEL", SECTION),
    ("BASE MOTION", TIME),
    ("CORRELATIONLENGTH", TIME),
    ("CONSTRAINT", TIME),
    ("DESIGNVARIABLES", TIME),
    ("OBJECTIVE", TIME),
];

/// What becomes of a keyword, in capitals without blanks.
pub(crate) fn treatment(keyword: &str) -> Treatment {
    if READ.contains(&keyword) {
        return Treatment::Read;
    }
    let find = |table: &[(&str, &'static str)]| {
        table
            .iter()
            .find(|(k, _)| *k == keyword)
            .map(|(_, why)| *why)
    };
    match (find(NOTES), find(REFUSED)) {
        (Some(why), _) => Treatment::Note(why),
        (None, Some(why)) => Treatment::Refuse(why),
        (None, None) => Treatment::Unknown,
    }
}

/// The keyword that is most like this one, if one is.
pub(crate) fn nearest(keyword: &str) -> Option<&'static str> {
    let all = READ.iter().copied().chain(REFUSED.iter().map(|(k, _)| *k));
    let best = all.map(|k| (distance(keyword, k), k)).min()?;
    (best.0 <= 2 + keyword.len() / 8).then_some(best.1)
}

/// Edits between two words.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().take(64).collect(), b.chars().collect());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
