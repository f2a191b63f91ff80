//! What laws answer: traction with its derivatives, and status.

use crate::contact::law::friction::LawState;
use crate::friction::cone::Cone;
use crate::friction::ellipse::Ellipse;

/// Status of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, crate::keep::Keep)]
pub enum Status {
    /// Not in contact.
    #[default]
    Open,
    /// In contact without slip.
    Stick,
    /// In contact and sliding.
    Slip,
}

/// Traction on the secondary in the frame `(normal, 1, 2)` and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Response {
    /// Pressure and shear `[Pa]`.
    pub traction: [f64; 3],
    /// Derivatives with respect to gap and slips (as friction sees them) `[Pa/m]`.
    pub d_gap: [[f64; 3]; 3],
    /// The part of the diagonal of `d_gap` that is there because laws see velocities, as gap and slip over the increment `[Pa/m]`.
    pub d_rate: [f64; 3],
    /// Derivatives with respect to the skew `[Pa]`.
    pub d_skew: [f64; 3],
    /// Derivatives with respect to the multipliers, for a perturbed Lagrangian `[-]`.
    pub d_multiplier: [[f64; 3]; 3],
    /// Largest shear `[Pa]`.
    pub limit: f64,
    /// The shape of what friction allows where that is no circle; the limit is then that along its longer axis.
    pub ellipse: Option<Ellipse>,
    /// State variables of the friction law at the end of the increment.
    pub state: LawState,
    /// By how much the limit grows with the pressure, directly and through the penetration `[-]`.
    pub d_limit: f64,
    /// Open, stick or slip.
    pub status: Status,
    /// Irreversible slip since the last accepted state `[m]`.
    pub sliding_path: [f64; 2],
    /// By how much the length of that grows with the pressure `[m/Pa]` and with the slips `[-]`.
    pub d_path: [f64; 3],
    /// The part of the pressure that damping adds `[Pa]`, negative while surfaces part.
    pub damping: f64,
}

impl Response {
    /// The largest shear in the direction of the shear that there is `[Pa]`.
    pub fn limit_along(&self) -> f64 {
        let cone = Cone {
            limit: self.limit,
            skew: 0.0,
            ellipse: self.ellipse,
        };
        cone.limit_along([self.traction[1], self.traction[2]])
    }
}
