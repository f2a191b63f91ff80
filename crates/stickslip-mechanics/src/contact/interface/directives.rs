//! What the solver has told an interface: it holds until it is told something else, and is no part of what the interface has been through.

use crate::math::Vec3;

/// Sliding that lasts: where the surface of the primary moves by itself, friction sees that motion alone, and points slide all the time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Steady {
    /// A place on the axis about which the surface turns, beside the velocity of its belt `[m]`.
    pub centre: Vec3,
    /// Its angular velocity `[rad/s]`.
    pub turning: Vec3,
    /// Its velocity beside that of its belt `[m/s]`.
    pub velocity: Vec3,
}

crate::keep!(Steady {
    centre,
    turning,
    velocity
});

/// How an interface is to act at present.
#[derive(Debug, Clone, Default)]
pub struct Directives {
    /// Mass per area behind each point `[kg/m²]`; empty where it plays no part.
    pub(in crate::contact) inertia: Vec<f64>,
    /// Tractions are means over the increment, as where masses meet what does not give way, not those at its end.
    pub impulses: bool,
    /// Points that do not take part; empty where all do.
    pub(in crate::contact) excluded: Vec<bool>,
    /// Points within the part of the reach in which contact is expected to stay.
    pub(in crate::contact) inner: Vec<bool>,
    /// Cycles beside that at hand which it stands for: what slides wears as often as that in addition.
    pub(in crate::contact) skipped: f64,
    /// Sliding lasts; `None` where friction sees slips over increments as it does otherwise.
    pub steady: Option<Steady>,
}

crate::keep!(Directives {
    inertia,
    impulses,
    excluded,
    inner,
    skipped,
    steady
});
