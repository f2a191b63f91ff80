//! From gap and slip to traction, in the frame of a stencil: normal law × friction law × slip rule × enforcement.

use super::enforcement::{EnforcementModel, Multipliers, pressure};
use super::kinematics::Stencil;
use super::law::friction::{FrictionLaw, FrictionModel, FrictionPoint};
use super::law::normal::{NormalLaw, NormalModel};
use super::law::slip::{SlipModel, SlipRule, Tangential};

/// The laws of an interface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Laws {
    /// Pressure against gap.
    pub normal: NormalModel,
    /// Limit of the shear traction.
    pub friction: FrictionModel,
    /// Stick and slip.
    pub slip: SlipModel,
    /// How contact and stick are enforced.
    pub enforcement: EnforcementModel,
}

/// What one evaluation of the laws needs beside the stencil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circumstances {
    /// Time since the last accepted state.
    pub dt: f64,
    /// Stiffness against penetration `[Pa/m]`; infinite where the normal law itself is followed.
    pub normal_stiffness: f64,
    /// Stiffness of sticking `[Pa/m]`.
    pub tangential_stiffness: f64,
    /// Multipliers: pressure, and shear traction in the frame. For a perturbed Lagrangian they are the unknowns.
    pub multiplier: [f64; 3],
    /// Shear traction carried over from the last accepted state, in the frame.
    pub carried: [f64; 2],
    /// Slope of the pressure `[Pa/m]` that a point which just touches is given although it carries nothing yet; zero but in the
    /// first iteration of a first contact, when nothing else may hold a body.
    pub touching: f64,
    /// Displacement of the belt since the last accepted state, along the frame `[m]`.
    pub belt: [f64; 2],
}

/// Status of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
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
    /// Derivatives with respect to gap and slips `[Pa/m]`.
    pub d_gap: [[f64; 3]; 3],
    /// Derivatives with respect to the skew `[Pa]`.
    pub d_skew: [f64; 3],
    /// Derivatives of the shear with respect to the multiplier of the pressure, for a perturbed Lagrangian `[-]`.
    pub d_pressure: [f64; 2],
    /// Largest shear `[Pa]`.
    pub limit: f64,
    /// Open, stick or slip.
    pub status: Status,
    /// Irreversible slip since the last accepted state `[m]`.
    pub sliding_path: [f64; 2],
}

impl Laws {
    /// The laws in a few words, for reports.
    pub fn describe(&self) -> String {
        use crate::registry::Family;
        format!(
            "normal {}, friction {}, slip {}, {}",
            self.normal.kind(),
            self.friction.kind(),
            self.slip.kind(),
            self.enforcement.kind()
        )
    }

    /// Whether a normal stiffness is needed: set-valued laws have no pressure of their own.
    pub fn needs_normal_stiffness(&self) -> bool {
        self.normal.as_dyn().pressure(0.0).is_none()
    }

    /// Whether shear traction needs a stiffness of sticking.
    pub fn needs_tangential_stiffness(&self) -> bool {
        self.friction.as_dyn().frictional() && self.slip.as_dyn().sticks()
    }

    /// Evaluates the laws at a stencil.
    pub fn respond(&self, stencil: &Stencil, at: &Circumstances) -> Response {
        let unknown = self.enforcement.as_dyn().multipliers() == Multipliers::Unknown;
        let augmented = matches!(
            self.enforcement.as_dyn().multipliers(),
            Multipliers::Augmented { .. }
        );
        let normal: &dyn NormalLaw = self.normal.as_dyn();
        let held = if augmented { at.multiplier[0] } else { 0.0 };
        let p = pressure(normal, stencil.gap, held, at.normal_stiffness);
        let mut response = Response::default();
        response.traction[0] = p.value;
        response.d_gap[0][0] = p.slope;
        if p.value > 0.0 {
            response.status = Status::Stick;
        } else if at.touching > 0.0 {
            let sides = if self.friction.as_dyn().frictional() {
                3
            } else {
                1
            };
            for i in 0..sides {
                response.d_gap[i][i] = -at.touching;
            }
            return response;
        }
        let friction: &dyn FrictionLaw = self.friction.as_dyn();
        // In a perturbed Lagrangian the limit follows the unknown pressure, not the one the gap would give.
        // While that is still zero the gap has to do, or nothing would hold a point in its first iteration.
        let unknown = unknown && at.multiplier[0] > 0.0;
        let pressed = if unknown { at.multiplier[0] } else { p.value };
        if !friction.frictional() {
            if p.value > 0.0 {
                response.status = Status::Slip;
            }
            return response;
        }
        if pressed <= 0.0 {
            return response;
        }
        let motion = Tangential {
            slip: [stencil.slip[0] - at.belt[0], stencil.slip[1] - at.belt[1]],
            dt: at.dt,
            stiffness: at.tangential_stiffness,
            base: if augmented {
                [at.multiplier[1], at.multiplier[2]]
            } else {
                at.carried
            },
            skew: stencil.skew,
        };
        let path = motion.length(motion.slip);
        let limit = friction.limit(&FrictionPoint {
            pressure: pressed,
            penetration: (-stencil.gap).max(0.0),
            speed: path / at.dt,
        });
        let rule: &dyn SlipRule = self.slip.as_dyn();
        let shear = rule.traction(limit.value, &motion);
        response.limit = limit.value;
        response.sliding_path = shear.sliding_path;
        if shear.sliding {
            response.status = Status::Slip;
        }
        let (own, penetration) = if unknown {
            (0.0, limit.d_penetration)
        } else {
            (limit.d_pressure * p.slope, limit.d_penetration)
        };
        // penetration = -gap where closed
        let d_limit_gap = own - if stencil.gap < 0.0 { penetration } else { 0.0 };
        let toward = if path > 0.0 && limit.d_speed != 0.0 {
            motion.length_slope(motion.slip, path)
        } else {
            [0.0; 2]
        };
        for i in 0..2 {
            response.traction[i + 1] = shear.traction[i];
            response.d_gap[i + 1][0] = shear.d_limit[i] * d_limit_gap;
            for (j, toward) in toward.iter().enumerate() {
                response.d_gap[i + 1][j + 1] =
                    shear.d_slip[i][j] + shear.d_limit[i] * limit.d_speed * toward / at.dt;
            }
            response.d_skew[i + 1] = shear.d_skew[i];
            response.d_pressure[i] = if unknown {
                shear.d_limit[i] * limit.d_pressure
            } else {
                0.0
            };
        }
        response
    }
}
