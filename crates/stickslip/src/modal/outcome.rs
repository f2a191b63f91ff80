//! What comes of a step without increments, as plain data.

use super::quadratic::UNSTABLE_GROWTH;
use serde::Serialize;

use crate::io::npy::Numbers;

/// Names of growth and frequency of the mode that grows fastest, beside the last row of the history.
pub const FIGURES: [&str; 2] = ["MODES.GROWTH", "MODES.FREQUENCY"];

/// Of so many modes there are figures beside the last row of the history.
pub const TOLD: usize = 50;

/// What each of them adds to it, by its number from 1.
pub fn figures_of_mode(number: usize) -> [String; 2] {
    ["FREQUENCY", "GROWTH"].map(|what| format!("MODES.{number}.{what}"))
}

/// Modes about a state.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct ModalOutcome {
    /// Name of the step.
    pub step: String,
    /// Whether friction and damping have a part in them.
    pub complex: bool,
    /// The modes, by frequency.
    pub modes: Vec<Mode>,
    /// Directions of participation: `x`, `rotation-z`, ….
    pub directions: Vec<String>,
    /// Mass, or moment of inertia about the origin, by direction.
    pub masses: Vec<f64>,
    /// Interfaces that slide, of which modes say what they feed.
    pub sliding: Vec<String>,
    /// Contact points that stick, that slide all the time, and that slid without a direction that lasts.
    pub points: [usize; 3],
    /// Matrices over all dofs that were factored.
    pub factorisations: usize,
    /// Right-hand sides that were solved for, those of the map among them.
    pub solves: usize,
    /// Whether shapes are wanted as fields.
    pub shapes: bool,
    /// Growth for other friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<FrictionMap>,
    /// How eigenvalues change.
    pub sensitivities: Vec<Sensitivity>,
    /// The answer to forces at frequencies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub response: Option<Response>,
    /// Matrices by name, to be written when they are found.
    #[serde(skip)]
    #[keep(again)]
    pub export: Vec<Export>,
    /// Dense arrays by name, to be written when they are found.
    #[serde(skip)]
    #[keep(again)]
    pub arrays: Vec<Array>,
    /// What a user should know.
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl ModalOutcome {
    /// What is left of the equations of motion in the worst mode, or at the worst frequency.
    pub(crate) fn worst_residual(&self) -> Option<f64> {
        let modes = self.modes.iter().map(|mode| mode.residual);
        let response = self.response.iter().flat_map(|r| &r.rows);
        let all = modes.chain(response.map(|row| row.residual));
        all.max_by(f64::total_cmp)
    }

    /// The same without shapes and matrices.
    pub(crate) fn figures(&self) -> Self {
        let modes = self.modes.iter().map(|mode| Mode {
            shape: [Vec::new(), Vec::new()],
            ..mode.clone()
        });
        let mut response = self.response.clone();
        for row in response.iter_mut().flat_map(|r| &mut r.rows) {
            row.shape = [Vec::new(), Vec::new()];
        }
        ModalOutcome {
            response,
            modes: modes.collect(),
            export: Vec::new(),
            arrays: Vec::new(),
            ..self.clone()
        }
    }
}

/// A mode: displacements go with `e^(λ t)`, `λ` = growth + 2π i frequency.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Mode {
    /// Cycles per unit of time.
    pub frequency: f64,
    /// Rate at which it grows `[1/time]`; below zero it decays.
    pub growth: f64,
    /// Damping relative to the critical one: less than zero where it grows.
    pub damping_ratio: f64,
    /// What is left of the equations of motion, relative to what is in the mode: the root of the energies that either would store.
    pub residual: f64,
    /// By direction: `φᵀ M r` of the mode with `φᵀ M φ = 1`. Of real modes alone.
    pub participation: Vec<f64>,
    /// Its square: the mass that moves along.
    pub effective_mass: Vec<f64>,
    /// By interface that slides: the part of the growth that comes from it `[1/time]`; the last is that of damping.
    pub feed: Vec<f64>,
    /// Displacements by dof, real and imaginary part; the latter empty in a real mode.
    #[serde(skip)]
    pub shape: [Vec<f64>; 2],
}

impl Mode {
    /// Whether it grows, by more than rounding.
    pub fn is_unstable(&self) -> bool {
        grows(self.damping_ratio)
    }
}

/// Whether a mode with this damping ratio grows, by more than rounding.
pub fn grows(damping_ratio: f64) -> bool {
    -damping_ratio > UNSTABLE_GROWTH
}

/// Frequencies and growth over friction, speed or load relative to that of the step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct FrictionMap {
    /// What is multiplied: `friction`, `speed` or `load`.
    pub over: String,
    /// Mean coefficient of friction of the step: limit over pressure, weighted by pressure.
    pub mu: f64,
    /// Dimension of the space in which the map was made.
    pub dimension: usize,
    /// Right-hand sides over all dofs that were solved for.
    pub solves: usize,
    /// Rows by factor.
    pub rows: Vec<MapRow>,
    /// Factors at which the largest growth rate comes up through zero, over speed and load down through it as well, with the frequency there.
    pub critical: Vec<[f64; 2]>,
    /// The largest residual in the equations of motion of all dofs of the modes at that factor at which they are estimated to be worst.
    pub residual: f64,
    /// Critical factor without the damping of bodies, where there is one and with damping the factor is less.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undamped: Option<f64>,
}

/// The modes of one factor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct MapRow {
    /// Friction, speed or load relative to that of the step.
    pub factor: f64,
    /// Mean coefficient of friction.
    pub mu: f64,
    /// Frequency and growth by mode.
    pub modes: Vec<[f64; 2]>,
    /// What the worst of them leaves open in the equations of motion of all dofs, estimated: displacements at rest under the forces that are left, relative to those of the
    /// mode, both weighted by mass.
    pub residual: f64,
}

/// Displacements under forces that go with `e^(i ω t)`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Response {
    /// Displacements of probes, as in the history: `tip.U1`.
    pub columns: Vec<String>,
    /// Dimension of the space in which they were found.
    pub dimension: usize,
    /// Rows by frequency.
    pub rows: Vec<ResponseRow>,
}

/// The answer at a frequency.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct ResponseRow {
    /// Cycles per unit of time.
    pub frequency: f64,
    /// What is left of the equations of motion of all dofs, relative to what is in the answer, as that of a mode.
    pub residual: f64,
    /// Real and imaginary part by column `[length]`: what goes with the cosine of the forces, and with minus their sine.
    pub values: Vec<[f64; 2]>,
    /// Displacements by dof, real and imaginary part.
    #[serde(skip)]
    pub shape: [Vec<f64>; 2],
}

/// How the eigenvalue of a mode changes with a quantity, per relative change of it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Sensitivity {
    /// Number of the mode, from 1.
    pub mode: usize,
    /// The quantity: `friction.pad`, `contact.pad`, `modulus.disc`, `density.disc`, `damping.disc`.
    pub of: String,
    /// Change of the growth rate `[1/time]`.
    pub growth: f64,
    /// Change of the frequency `[1/time]`.
    pub frequency: f64,
}

/// A matrix as it is exported: entries by row and column, from 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Export {
    /// Name of its file.
    pub name: String,
    /// Rows and columns.
    pub shape: [usize; 2],
    /// Whether it is symmetric: entries above the diagonal are left out.
    pub symmetric: bool,
    /// Row, column, value.
    pub entries: Vec<(usize, usize, f64)>,
}

/// A dense array as it is exported.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Name of its file.
    pub name: String,
    /// Rows and columns.
    pub shape: [usize; 2],
    /// Its numbers, row by row.
    pub numbers: Numbers,
}
