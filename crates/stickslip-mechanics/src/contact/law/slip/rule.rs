//! What a slip rule is asked and says.

use crate::friction::cone::Cone;
use crate::friction::ellipse::Ellipse;

/// The tangential motion of a contact point over an increment, in the two directions of its frame.
///
/// The frame of the paper's kinematics is not orthogonal; lengths are those of a [`Cone`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tangential {
    /// Displacement of the secondary relative to the primary surface since the last accepted state `[m]`.
    pub slip: [f64; 2],
    /// Time since then `[s]`.
    pub dt: f64,
    /// Stiffness of sticking `[Pa/m]`.
    pub stiffness: f64,
    /// Traction carried over: the committed one, or the multiplier `[Pa]`.
    pub base: [f64; 2],
    /// Cosine of the angle between the two directions.
    pub skew: f64,
    /// The shape of what friction allows where that is no circle.
    pub ellipse: Option<Ellipse>,
    /// Fraction by which a trial traction may exceed the limit and still count as stick; zero but in the first iteration of an
    /// increment, where a point that slid before would otherwise slide or stick by rounding alone.
    pub slack: f64,
}

impl Tangential {
    /// The shear that a limit `[Pa]` allows.
    pub fn cone(&self, limit: f64) -> Cone {
        Cone {
            limit,
            skew: self.skew,
            ellipse: self.ellipse,
        }
    }

    /// Length of a vector along the two directions, see [`Cone`].
    pub fn length(&self, v: [f64; 2]) -> f64 {
        self.cone(0.0).length(v)
    }

    /// The derivative of `length(v)` with respect to `v`, for a length that is not zero.
    pub fn length_slope(&self, v: [f64; 2], length: f64) -> [f64; 2] {
        self.cone(0.0).length_slope(v, length)
    }
}

/// Shear traction on the secondary and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlipState {
    /// Traction on the secondary `[Pa]`.
    pub traction: [f64; 2],
    /// Derivative with respect to the slip `[Pa/m]`, row: traction.
    pub d_slip: [[f64; 2]; 2],
    /// Derivative with respect to the limit `[-]`.
    pub d_limit: [f64; 2],
    /// Derivative with respect to the skew `[Pa]`.
    pub d_skew: [f64; 2],
    /// The limit is reached.
    pub sliding: bool,
    /// The irreversible part of the slip `[m]`.
    pub sliding_path: [f64; 2],
}

/// Turns a limit and a motion into a traction.
pub trait SlipRule: Send + Sync {
    /// Traction for a limit `[Pa]` and a motion.
    fn traction(&self, limit: f64, motion: &Tangential) -> SlipState;

    /// The same where the rule acts through the spring of the motion's stiffness, as in explicit increments: what springs carry follows from
    /// displacements, and nothing in it is stiffer than they are, whatever the length of the increment. Rules that stick have the spring anyhow.
    fn sprung(&self, limit: f64, motion: &Tangential) -> SlipState {
        self.traction(limit, motion)
    }

    /// The traction of a point that sticks whatever the limit is.
    fn stuck(&self, limit: f64, motion: &Tangential) -> SlipState;

    /// Whether the rule sticks through a stiffness (and so can be made exact by multipliers).
    fn sticks(&self) -> bool;

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}
