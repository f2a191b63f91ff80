//! Steps in which nothing moves: which vibrations are looked for about the state that is reached.

use serde::{Deserialize, Serialize};

use crate::contact::interface::Steady;

/// What is looked for in a step without increments.
#[derive(Debug, Clone, PartialEq)]
pub enum Modal {
    /// Modes without friction and damping.
    Real(RealPlan),
    /// Modes of steady sliding.
    Complex(ComplexPlan),
    /// The answer to forces at frequencies.
    Harmonic(HarmonicPlan),
}

impl Modal {
    /// At most so many modes are found.
    pub fn count(&self) -> usize {
        match self {
            Modal::Real(plan) => plan.count,
            Modal::Complex(plan) => plan.count,
            Modal::Harmonic(_) => 0,
        }
    }
}

/// Which modes, in cycles per unit of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RealPlan {
    /// At most so many.
    pub count: usize,
    /// Lowest and highest frequency `[1/s]`.
    pub range: [f64; 2],
    /// Whether shapes are written.
    pub shapes: bool,
}

/// Which modes of steady sliding, and what else is asked about them.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexPlan {
    /// At most so many.
    pub count: usize,
    /// Highest frequency `[1/s]`.
    pub to: f64,
    /// Whether shapes are written.
    pub shapes: bool,
    /// Whether friction has a part in the damping.
    pub friction_damping: bool,
    /// Growth rates for other friction.
    pub map: Option<MapPlan>,
    /// Whether matrices are written.
    pub export: bool,
    /// Whether it is asked how growth rates change with friction, contact stiffness, moduli, densities and damping.
    pub sensitivity: bool,
}

/// Which forces, and at which frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicPlan {
    /// Loads by name, with the phases by which they lead `[rad]`.
    pub loads: Vec<(String, f64)>,
    /// At which.
    pub frequencies: Frequencies,
    /// Damping of the real modes, beside all other.
    pub damping: ModalDamping,
    /// Most modes of the space in which it is found.
    pub count: usize,
    /// Whether displacements of all points are written.
    pub shapes: bool,
}

/// At which frequencies an answer is looked for `[1/s]`.
#[derive(Debug, Clone, PartialEq)]
pub enum Frequencies {
    /// At these.
    At(Vec<f64>),
    /// From each of the lowest, those of the real modes between, and the highest to the next.
    AmongModes {
        /// Lowest and highest.
        range: [f64; 2],
        /// How many from one to the next, both counted.
        points: usize,
        /// How much they crowd at the two: 1 is even.
        bias: f64,
    },
}

impl Frequencies {
    /// The highest.
    pub(crate) fn highest(&self) -> f64 {
        match self {
            Frequencies::At(all) => all.iter().copied().fold(0.0, f64::max),
            Frequencies::AmongModes { range, .. } => range[1],
        }
    }

    /// All of them, where real modes have these frequencies, the lowest first.
    pub(crate) fn among(&self, modes: &[f64]) -> Vec<f64> {
        let (range, points, bias) = match self {
            Frequencies::At(all) => return all.clone(),
            Frequencies::AmongModes {
                range,
                points,
                bias,
            } => (*range, (*points).max(2), *bias),
        };
        let mut ends = vec![range[0]];
        ends.extend(modes.iter().filter(|f| range[0] < **f && **f < range[1]));
        ends.push(range[1]);
        let mut all = vec![range[0]];
        for pair in ends.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            let at = |k: usize| {
                let even = 2.0 * k as f64 / (points - 1) as f64 - 1.0;
                middle + half * even.abs().powf(1.0 / bias) * even.signum()
            };
            all.extend((1..points - 1).map(at));
            all.push(pair[1]);
        }
        all.dedup();
        all
    }
}

/// Modal damping, in addition to that of bodies, dashpots and contact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct ModalDamping {
    /// Damping ratios by the number of the mode, 1 being critical; the last is that of all that follow.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ratios: Vec<f64>,
    /// Adds `mass / (2 ω)` to each ratio `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    pub mass: f64,
    /// Adds `stiffness ω / 2` to each ratio `[time]`.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    pub stiffness: f64,
}

impl ModalDamping {
    /// What the velocity of a mode of mass one is multiplied with, by its number from 0 and its angular frequency: `2 ζ ω`.
    pub(crate) fn of(&self, number: usize, omega: f64) -> f64 {
        let ratio = self.ratios.get(number).or(self.ratios.last());
        2.0 * ratio.unwrap_or(&0.0) * omega + self.mass + self.stiffness * omega * omega
    }
}

/// What a map multiplies: the contact state of the step is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum MapOver {
    /// Friction: what it adds to stiffness and damping.
    #[default]
    Friction,
    /// The speed of sliding: laws are evaluated at each, with their coefficients and slopes, at the pressures of the step. Exact where pressures do not depend on friction.
    Speed,
    /// The pressures at which friction damps, as a load does that presses in proportion on contact of which stiffness and damping do not depend on it.
    Load,
}

impl MapOver {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            MapOver::Friction => "friction",
            MapOver::Speed => "speed",
            MapOver::Load => "load",
        }
    }
}

/// So many factors of a map are tried before it is made, at most.
const MOST_TRIED_FACTORS: usize = 15;

/// A map over a factor of something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPlan {
    /// What is multiplied.
    pub over: MapOver,
    /// Smallest and largest factor.
    pub range: [f64; 2],
    /// How many factors.
    pub points: usize,
}

impl MapPlan {
    /// The factors at which the space of a map has to be good: some over all of its range.
    pub(crate) fn tried(&self) -> Vec<f64> {
        let few = self.points.clamp(2, MOST_TRIED_FACTORS);
        MapPlan {
            points: few,
            ..*self
        }
        .factors()
    }

    /// All factors.
    pub(crate) fn factors(&self) -> Vec<f64> {
        let ([from, last], points) = (self.range, self.points.max(2));
        let step = (last - from) / (points - 1) as f64;
        let inner = (0..points - 1).map(|k| from + step * k as f64);
        inner.chain([last]).collect()
    }
}

/// A mode along which a motion begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KickPlan {
    /// Its number in the table of the step before, from 1; the one that grows fastest if not given.
    pub mode: Option<usize>,
    /// Largest displacement of a point `[m]`.
    pub amplitude: f64,
}

/// Sliding that lasts, by interface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SteadyPlan {
    /// How surfaces move beside their belts.
    pub surfaces: Vec<(String, Steady)>,
}

impl SteadyPlan {
    /// How an interface is told.
    pub fn of(&self, interface: &str) -> Steady {
        let mut all = self.surfaces.iter();
        all.find(|(name, _)| name == interface)
            .map_or(Steady::default(), |(_, steady)| *steady)
    }
}
