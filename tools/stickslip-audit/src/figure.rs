//! What the audit measures, and from where on it is wrong.

use std::collections::BTreeMap;

/// A kind of figure: its name, from where on a result is doubtful, from where on it is wrong, and what it is.
pub struct Kind {
    /// Name.
    pub name: &'static str,
    /// A gate that fails a result above this has reason to.
    pub doubtful: f64,
    /// A result above this must not pass.
    pub wrong: f64,
    /// What it is relative to.
    pub meaning: &'static str,
}

const fn kind(name: &'static str, doubtful: f64, wrong: f64, meaning: &'static str) -> Kind {
    Kind {
        name,
        doubtful,
        wrong,
        meaning,
    }
}

/// All figures. They have no dimension.
pub const KINDS: &[Kind] = &[
    kind(
        "finite",
        0.5,
        0.5,
        "fields and histories that are not numbers",
    ),
    kind(
        "equilibrium",
        1e-6,
        1e-5,
        "K u less loads, reactions and CFORCE at a node, of the largest nodal force of the run",
    ),
    kind(
        "body-balance",
        1e-6,
        1e-5,
        "contact forces, reactions, loads and springs on a body at rest that do not cancel, of the largest resultant of the run",
    ),
    kind(
        "body-moment",
        1e-2,
        5e-2,
        "their moment, of the same times the size of the body",
    ),
    kind(
        "beyond-loads",
        3.0,
        30.0,
        "contact force of a body over what its loads, and its supports away from contact surfaces, give",
    ),
    kind(
        "rigid-balance",
        1e-6,
        1e-5,
        "forces on a rigid body that do not cancel, of the largest",
    ),
    kind(
        "rigid-moment",
        1e-2,
        5e-2,
        "moments on a rigid body that do not cancel, of the largest force times its size",
    ),
    kind(
        "motion",
        1e-4,
        1e-3,
        "inertia, damping, elasticity and loads at a node without contact, of the largest nodal force",
    ),
    kind(
        "integration",
        1e-6,
        1e-5,
        "displacement that does not follow from velocities and accelerations, of the largest",
    ),
    kind(
        "action-reaction",
        1e-8,
        1e-6,
        "sum of the contact forces of two bodies, of the largest resultant of the run",
    ),
    kind(
        "moment",
        3e-3,
        5e-2,
        "sum of the moments of the contact forces of bodies, of the largest resultant of the run times the smallest surface",
    ),
    kind(
        "resultant",
        1e-8,
        1e-6,
        "CFN + CFS of the history less the sum of CFORCE, of the largest resultant of the run",
    ),
    kind(
        "cone",
        1e-3,
        1e-2,
        "shear beyond the limit, of the largest limit of the run",
    ),
    kind(
        "mobilised",
        1e-3,
        1e-2,
        "what a slipping point carries less than its limit, of the largest limit of the run",
    ),
    kind(
        "direction",
        0.1,
        0.3,
        "1 + cosine between shear and slip of slipping points",
    ),
    kind(
        "slip",
        0.1,
        0.3,
        "slip less that of the own projection, of the largest slip of the run",
    ),
    kind("tension", 1e-6, 1e-4, "negative pressure, of the largest"),
    kind(
        "complementarity",
        1e-3,
        1e-2,
        "pressure times open gap, of the largest pressure times the approach",
    ),
    kind(
        "law",
        1e-4,
        1e-2,
        "pressure less that of the normal law at the gap, of the largest",
    ),
    kind(
        "gap",
        1e-2,
        0.1,
        "COPEN less the distance by the own projection, of the approach",
    ),
    kind(
        "penetration",
        0.05,
        0.5,
        "depth of points of either side in the other beyond what the law has, of the approach",
    ),
    kind(
        "between",
        0.05,
        f64::INFINITY,
        "depth of an obstacle in faces between nodes beyond that of nodes, of the approach",
    ),
    kind(
        "yielding",
        5e-3,
        0.1,
        "depth of points that a law does not let into the other side, of the approach",
    ),
    kind(
        "apart",
        0.05,
        0.5,
        "distance by which surfaces stand apart all around a mortar point beyond what it says, times its pressure of the largest, of the approach",
    ),
    kind(
        "energy",
        2e-3,
        1.2e-2,
        "work less what is stored (strain energy by the own stiffness) and dissipated, of the energy in play",
    ),
    kind(
        "strain-energy",
        1e-6,
        1e-4,
        "ALLSE less the own strain energy, of the largest",
    ),
    kind(
        "kinetic-energy",
        1e-4,
        1e-2,
        "ALLKE less the own kinetic energy, of the largest",
    ),
    kind(
        "growth",
        1e-2,
        5e-2,
        "energy that the scheme of integration made, of the energy in play",
    ),
    kind(
        "dissipation",
        0.1,
        0.5,
        "ALLFD less shear times slip over the own areas, of the energy in play",
    ),
    kind(
        "backwards",
        1e-6,
        1e-3,
        "friction that feeds energy in, of the energy in play",
    ),
    kind(
        "support",
        1e-9,
        1e-6,
        "displacement at a support less the prescribed one, of the size of the model",
    ),
    kind(
        "coupling",
        1e-7,
        1e-5,
        "the sum of an equation less its value, of the largest displacement",
    ),
    kind(
        "tie",
        1e-2,
        0.1,
        "change of distance between tied surfaces, of the largest displacement",
    ),
    kind("rotation", 0.02, 0.12, "mean rotation of a body"),
    kind("way", 0.3, 1.0, "displacement, of the size of the model"),
    kind(
        "coarse",
        0.5,
        f64::INFINITY,
        "1 where fewer than three points across carry the contact at its largest",
    ),
    kind(
        "oscillation",
        0.1,
        f64::INFINITY,
        "second difference of the pressure along the surface, of its mean",
    ),
];

/// A measured figure.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Name, one of [`KINDS`].
    pub name: &'static str,
    /// Body, interface or support.
    pub place: String,
    /// Its largest value.
    pub value: f64,
    /// When.
    pub time: f64,
}

impl Figure {
    fn kind(&self) -> &'static Kind {
        KINDS
            .iter()
            .find(|k| k.name == self.name)
            .unwrap_or(&KINDS[0])
    }

    /// Whether a result with it must not pass.
    pub fn wrong(&self) -> bool {
        self.value.is_nan() || self.value > self.kind().wrong
    }

    /// Whether a gate may have failed because of it.
    pub fn doubtful(&self) -> bool {
        self.value.is_nan() || self.value > self.kind().doubtful
    }
}

impl std::fmt::Display for Figure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Figure {
            name,
            place,
            value,
            time,
        } = self;
        write!(f, "{name} of {place} {value:.2e} at {time:.4e}")
    }
}

/// What an audit found.
#[derive(Debug, Clone, Default)]
pub struct Report {
    figures: BTreeMap<(&'static str, String), Figure>,
    /// What could not be measured, and why.
    pub skipped: Vec<String>,
}

impl Report {
    /// Enters a figure; the largest of a name and place stays.
    pub fn note(&mut self, name: &'static str, place: &str, value: f64, time: f64) {
        debug_assert!(KINDS.iter().any(|k| k.name == name), "{name}");
        let new = Figure {
            name,
            place: place.to_string(),
            value,
            time,
        };
        let key = (name, place.to_string());
        let known = self
            .figures
            .get(&key)
            .map_or(f64::NEG_INFINITY, |f| f.value);
        if value.is_nan() || value > known {
            self.figures.insert(key, new);
        }
    }

    /// Says that something is not measured.
    pub fn skip(&mut self, why: String) {
        if !self.skipped.contains(&why) {
            self.skipped.push(why);
        }
    }

    /// All figures.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.figures.values()
    }

    /// Those that make a result wrong, the worst of its kind first.
    pub fn wrong(&self) -> Vec<&Figure> {
        self.figures().filter(|f| f.wrong()).collect()
    }

    /// Those that a gate may fail.
    pub fn doubtful(&self) -> Vec<&Figure> {
        self.figures().filter(|f| f.doubtful()).collect()
    }
}
