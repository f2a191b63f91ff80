//! What laws are told of a point and an increment, beside gap and slip.

use crate::contact::law::friction::{LawState, Limit};
use crate::friction::ellipse::Ellipse;
use crate::math::{Slope, Vec3};

/// What one evaluation of the laws needs beside the stencil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawInput {
    /// Time since the last accepted state.
    pub dt: f64,
    /// How stiffly contact and stick are enforced.
    pub stiffness: Stiffnesses,
    /// Tractions that are known before anything is asked.
    pub kept: Kept,
    /// What friction sees of the motion.
    pub slip: Sliding,
    /// Gap from which springs count `[m]`; zero but for springs that took over from multipliers.
    pub rest: f64,
    /// By how much sliding over the increment wears the surfaces away: the gap opens by that.
    pub worn: Worn,
    /// Closing velocity over the increment `[m/s]`.
    pub closing: f64,
    /// Whether the point did not slide at the last accepted state.
    pub sticking: bool,
    /// State variables of the friction law at the last accepted state.
    pub state: LawState,
    /// Where the point is in the reference configuration `[m]`.
    pub place: Vec3,
    /// The shape of what friction allows in the frame where that is no circle.
    pub ellipse: Option<Ellipse>,
    /// Asked is what the point would do if it was pressed and stuck: in contact even if that takes tension, sticking even beyond the limit, and under a load
    /// that counts. A law that is hardly touched answers with the line that touches it where it is as stiff as the body.
    pub pressed: bool,
    /// What laws that are asked for all points at once have said.
    pub answers: Answers,
}

/// What is worn off over an increment as a line over the pressure: the tangent of the law at the pressure that there is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worn {
    /// Its value at no pressure `[m]`; zero where the depth is in proportion to the pressure.
    pub base: f64,
    /// Its slope `[m/Pa]`.
    pub slope: f64,
}

impl Worn {
    /// The depth at a pressure `[m]`.
    pub fn depth(self, pressure: f64) -> f64 {
        self.base + self.slope * pressure
    }
}

/// How stiffly a point is held `[Pa/m]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffnesses {
    /// Against penetration; infinite where the normal law itself is followed.
    pub normal: f64,
    /// Of sticking.
    pub tangential: f64,
    /// That by which a perturbed Lagrangian weighs gaps against multipliers when it decides on status.
    pub weight: f64,
    /// Slope of the pressure that a point which just touches is given although it carries nothing yet; zero but in the first iteration of a first contact,
    /// when nothing else may hold a body.
    pub first_contact: f64,
}

/// Tractions from before the evaluation, in the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kept {
    /// Whether the multipliers are unknowns.
    pub unknown: bool,
    /// Multipliers where they are unknowns: pressure, and shear traction.
    pub multiplier: [f64; 3],
    /// What the enforcement pulls the multipliers to: zero pressure and the shear carried over in a perturbed Lagrangian, the last estimate in an augmented
    /// one.
    pub centre: [f64; 3],
    /// Shear traction carried over from the last accepted state.
    pub shear: [f64; 2],
}

/// Motion along the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// What friction sees as slip over the increment, along the frame, belt included `[m]`: velocity at its end times its length in dynamics, the slip itself
    /// in statics.
    pub seen: [f64; 2],
    /// The slip itself, belt included `[m]`, where it is not what friction sees.
    pub path: Option<[f64; 2]>,
    /// Whether the rule acts through a spring, as in explicit increments; see [`SlipRule::sprung`](crate::contact::law::slip::SlipRule::sprung).
    pub sprung: bool,
    /// Whether the point slides all the time, whatever it would take to stick: a rule that sticks is not asked.
    pub steady: bool,
    /// Slack of the slip rule, see [`Tangential::slack`](crate::contact::law::slip::Tangential::slack).
    pub slack: f64,
}

/// Answers of laws that are asked for all points at once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Answers {
    /// Pressure at the gap.
    pub pressure: Option<Slope>,
    /// Limit of the shear traction.
    pub limit: Option<Limit>,
}
