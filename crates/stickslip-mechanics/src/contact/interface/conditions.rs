//! What holds while an interface is evaluated, and is no part of what it has been through.

use crate::math::{Vec3, scale};

/// Sliding that lasts: where the surface of the primary moves by itself, friction sees that motion alone, and points slide all the time.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Steady {
    /// A place on the axis about which the surface turns, beside the velocity of its belt `[m]`.
    pub centre: Vec3,
    /// Its angular velocity `[rad/s]`.
    pub turning: Vec3,
    /// Its velocity beside that of its belt `[m/s]`.
    pub velocity: Vec3,
}

/// Which points of an interface take part.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct CandidatePoints {
    /// Points that do not; empty where all do.
    pub(in crate::contact) excluded: Vec<bool>,
    /// Points within the part of the reach in which contact is expected to stay.
    pub(in crate::contact) inner: Vec<bool>,
}

/// What holds in an attempt: who evaluates for something else does so under conditions of its own.
#[derive(Debug, Clone, crate::keep::Keep)]
pub struct Conditions {
    /// Mass per area behind each point `[kg/m²]`; empty where it plays no part.
    pub inertia: Vec<f64>,
    /// Tractions are means over the increment, as where masses meet what does not give way, not those at its end.
    pub impulses: bool,
    /// Which points take part.
    pub candidates: CandidatePoints,
    /// Cycles beside that at hand which it stands for: what slides wears as often as that in addition.
    pub skipped: f64,
    /// Sliding lasts; `None` where friction sees slips over increments as it does otherwise.
    pub steady: Option<Steady>,
    /// How many times as fast as its table says the belt runs.
    pub pace: f64,
}

impl Default for Conditions {
    fn default() -> Self {
        Conditions {
            inertia: Vec::new(),
            impulses: false,
            candidates: CandidatePoints::default(),
            skipped: 0.0,
            steady: None,
            pace: 1.0,
        }
    }
}

impl Conditions {
    /// The same where this sliding lasts, and all that slides by itself does so many times as fast.
    pub fn at_pace(&self, sliding: Option<Steady>, factor: f64) -> Self {
        let steady = sliding.map(|steady| Steady {
            velocity: scale(factor, steady.velocity),
            turning: scale(factor, steady.turning),
            ..steady
        });
        Conditions {
            steady,
            pace: factor,
            ..self.clone()
        }
    }

    /// How many times wear counts what slides.
    pub(in crate::contact) fn cycles(&self) -> f64 {
        1.0 + self.skipped
    }
}
