use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::contact::interface::Steady;
use crate::math::{Vec3, norm};
use crate::model::{ComplexPlan, KickPlan, MapOver, MapPlan, Modal, RealPlan, SteadyPlan};

/// `modes` of a step: real modes, the lowest first. An empty table takes the defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Modes {
    /// At most so many modes.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub count: usize,
    /// Lowest frequency `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Highest frequency `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Whether shapes are written as fields.
    pub shapes: bool,
}

impl Default for Modes {
    fn default() -> Self {
        Modes {
            count: 10,
            from: None,
            to: None,
            shapes: true,
        }
    }
}

impl Modes {
    /// What is looked for.
    pub(super) fn plan(&self) -> Modal {
        Modal::Real(RealPlan {
            count: self.count,
            range: [self.from.unwrap_or(0.0), self.to.unwrap_or(f64::INFINITY)],
            shapes: self.shapes,
        })
    }
}

/// `complex-modes` of a step: modes of steady sliding, those of least frequency first. An empty table takes the defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct ComplexModes {
    /// At most so many modes, pairs counted once.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub count: usize,
    /// Highest frequency `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Whether shapes are written as fields, real and imaginary parts.
    pub shapes: bool,
    /// Whether friction damps: by turning with the sliding, and by the slope of its coefficient over the speed. The least damping is the safe side, and the default of
    /// Abaqus.
    pub friction_damping: bool,
    /// Frequencies and growth for other friction, speed or load: the contact state is kept, and what friction adds to the equations is multiplied, or evaluated anew.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<FrictionRange>,
    /// Whether eigenvalues are differentiated by friction, contact stiffness, moduli, densities and damping, the contact state kept.
    pub sensitivity: bool,
    /// Whether the matrices are written for other programs: over all unknowns as MatrixMarket files, condensed to few displacements as arrays of NumPy.
    pub export: bool,
}

impl Default for ComplexModes {
    fn default() -> Self {
        ComplexModes {
            count: 20,
            to: None,
            shapes: true,
            friction_damping: true,
            map: None,
            sensitivity: false,
            export: false,
        }
    }
}

impl ComplexModes {
    /// What is looked for.
    pub(super) fn plan(&self) -> Modal {
        Modal::Complex(ComplexPlan {
            count: self.count,
            to: self.to.unwrap_or(f64::INFINITY),
            shapes: self.shapes,
            friction_damping: self.friction_damping,
            map: self.map.as_ref().map(|m| MapPlan {
                over: m.over,
                range: [m.from, m.to],
                points: m.points,
            }),
            export: self.export,
            sensitivity: self.sensitivity,
        })
    }
}

/// Adds displacements and velocities of a mode to the state of the step before, one with `modes` or `complex-modes`. The history has the amplitude of the
/// mode, `MODE.A`, its phase, `MODE.PHASE`, and `MODE.REST`, the part of the kinetic energy outside the mode; `modes-N-growth.csv` compares with the
/// eigenvalue.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Kick {
    /// Largest displacement of a point in the mode at the start `[length]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub amplitude: f64,
    /// Number of the mode in the table of the step before; the one that grows fastest if not given.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<usize>,
}

impl Kick {
    /// What is done.
    pub(super) fn plan(self) -> KickPlan {
        KickPlan {
            mode: self.mode,
            amplitude: self.amplitude,
        }
    }
}

/// A map of the modes over a factor of the friction, the speed or the load of the step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct FrictionRange {
    /// What is multiplied.
    pub over: MapOver,
    /// Smallest factor `[-]`; above 0 where it is one of the speed.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    pub from: f64,
    /// Largest factor `[-]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub to: f64,
    /// How many factors, ends counted.
    #[cfg_attr(feature = "schema", schemars(range(min = 2, max = 100_000)))]
    pub points: usize,
}

impl Default for FrictionRange {
    fn default() -> Self {
        FrictionRange {
            over: MapOver::default(),
            from: 0.0,
            to: 2.0,
            points: 51,
        }
    }
}

/// Steady sliding.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct SteadySliding {
    /// Rotating surfaces of primaries, by interface, such as a disc under pads: `turning.pad = { axis = [0, 0, 1], speed = 6 }`. The mesh does not move;
    /// centrifugal and gyroscopic forces are not included.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub turning: BTreeMap<String, Turning>,
    /// Velocities `[length/time]` of surfaces of primaries in this step, by interface, beside their `primary-velocity`: `velocity = { pad = [2, 0, 0] }`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub velocity: BTreeMap<String, Vec<f64>>,
}

/// How a surface turns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Turning {
    /// A place on the axis; the origin if not given `[length]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub centre: Vec<f64>,
    /// Direction of the axis in 3D; in 2D it is across the plane.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis: Vec<f64>,
    /// Angular velocity about it `[rad/time]`.
    pub speed: f64,
}

impl SteadySliding {
    /// How interfaces are told.
    pub(super) fn plan(&self) -> SteadyPlan {
        let mut surfaces: BTreeMap<String, Steady> = BTreeMap::new();
        for (name, turning) in &self.turning {
            surfaces.insert(name.clone(), turning.steady());
        }
        for (name, velocity) in &self.velocity {
            surfaces.entry(name.clone()).or_default().velocity = vector(velocity);
        }
        SteadyPlan {
            surfaces: surfaces.into_iter().collect(),
        }
    }
}

fn vector(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

impl Turning {
    fn steady(&self) -> Steady {
        let axis = match self.axis.is_empty() {
            true => [0.0, 0.0, 1.0],
            false => vector(&self.axis),
        };
        let scale = self.speed / norm(axis).max(f64::MIN_POSITIVE);
        Steady {
            centre: vector(&self.centre),
            turning: axis.map(|a| scale * a),
            ..Steady::default()
        }
    }
}
