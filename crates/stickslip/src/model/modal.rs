//! Steps in which nothing moves: which vibrations are looked for about the state that is reached.

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
    /// Whether it is asked how growth rates change with friction, moduli and densities.
    pub sensitivity: bool,
}

/// Which forces, and at which frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicPlan {
    /// Loads by name, with the phases by which they lead `[rad]`.
    pub loads: Vec<(String, f64)>,
    /// Frequencies `[1/s]`.
    pub frequencies: Vec<f64>,
    /// Most modes of the space in which it is found.
    pub count: usize,
    /// Whether displacements of all points are written.
    pub shapes: bool,
}

/// Friction relative to that of the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPlan {
    /// Smallest and largest factor.
    pub range: [f64; 2],
    /// How many factors.
    pub points: usize,
}

impl MapPlan {
    /// The largest factor by its size.
    pub(crate) fn largest(&self) -> f64 {
        self.range[1].abs().max(self.range[0].abs())
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
