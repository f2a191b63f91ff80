//! From gap and slip to traction, in the frame of a stencil: normal law × friction law × slip rule × enforcement.

use super::enforcement::{EnforcementModel, Multipliers, pressure};
use super::kinematics::Stencil;
use super::law::Wear;
use super::law::damping::DampingModel;
use super::law::friction::{FrictionLaw, FrictionModel, FrictionPoint, Limit};
use super::law::normal::{NormalLaw, NormalModel};
use super::law::own::Own;
use super::law::slip::{SlipModel, SlipRule, SlipState, Tangential};
use crate::math::Slope;

/// The laws of an interface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Laws {
    /// Pressure against gap.
    pub normal: NormalModel,
    /// Pressure while surfaces approach or part.
    pub damping: DampingModel,
    /// Limit of the shear traction.
    pub friction: FrictionModel,
    /// Stick and slip.
    pub slip: SlipModel,
    /// How contact and stick are enforced.
    pub enforcement: EnforcementModel,
    /// The surfaces are glued: neither gap nor slip changes, and the laws have no meaning.
    pub tied: bool,
    /// What sliding wears off, if that is followed.
    pub wear: Option<Wear>,
    /// Laws of the program that take the place of `normal` and `friction`.
    pub own: Own,
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
    /// Multipliers where they are unknowns: pressure, and shear traction in the frame.
    pub multiplier: [f64; 3],
    /// What the enforcement pulls the multipliers to: zero pressure and the shear carried over in a perturbed Lagrangian, the
    /// last estimate in an augmented one.
    pub centre: [f64; 3],
    /// Shear traction carried over from the last accepted state, in the frame.
    pub carried: [f64; 2],
    /// Stiffness `[Pa/m]` by which a perturbed Lagrangian weighs gaps against multipliers when it decides on status.
    pub weight: f64,
    /// Slope of the pressure `[Pa/m]` that a point which just touches is given although it carries nothing yet; zero but in the
    /// first iteration of a first contact, when nothing else may hold a body.
    pub touching: f64,
    /// Slip per limit `[m/Pa]` over which a regularised rule is smoothed at least; zero but in a continuation.
    pub softness: f64,
    /// Slack of the slip rule, see [`Tangential::slack`].
    pub slack: f64,
    /// What friction sees as slip over the increment, along the frame, belt included `[m]`: velocity at its end times its
    /// length in dynamics, the slip itself in statics.
    pub slip: [f64; 2],
    /// The slip itself, belt included `[m]`, where it is not what friction sees.
    pub path: Option<[f64; 2]>,
    /// Whether the multipliers are unknowns.
    pub unknown: bool,
    /// Gap from which springs count `[m]`; zero but for springs that took over from multipliers.
    pub rest: f64,
    /// Whether the point did not slide at the last accepted state.
    pub sticking: bool,
    /// Closing velocity over the increment `[m/s]`.
    pub closing: f64,
    /// What the point does whatever the laws say; `None` but where it has gone to and fro.
    pub held: Option<Held>,
    /// Part of the limit of friction that acts `[-]`; one but in a continuation.
    pub mobilised: f64,
    /// What laws that are asked for all points at once have said.
    pub told: Told,
}

/// Answers of laws that are asked for all points at once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Told {
    /// Pressure at the gap.
    pub pressure: Option<Slope>,
    /// Limit of the shear traction.
    pub limit: Option<Limit>,
}

/// A status that a point is held in until the rest has settled. The branch of the laws that belongs to it goes on where they would leave it, so
/// that what is solved is smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// Nothing acts, even if the point penetrates.
    Open,
    /// In contact even if that takes tension, sticking even beyond the limit.
    Stick,
    /// In contact even if that takes tension, and sliding: shear traction in this direction, given in the frame, with length one.
    Slip([f64; 2]),
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
    /// Derivatives with respect to gap and slips (as friction sees them) `[Pa/m]`.
    pub d_gap: [[f64; 3]; 3],
    /// Derivatives with respect to the skew `[Pa]`.
    pub d_skew: [f64; 3],
    /// Derivatives with respect to the multipliers, for a perturbed Lagrangian `[-]`.
    pub d_multiplier: [[f64; 3]; 3],
    /// Largest shear `[Pa]`.
    pub limit: f64,
    /// Open, stick or slip.
    pub status: Status,
    /// Irreversible slip since the last accepted state `[m]`.
    pub sliding_path: [f64; 2],
    /// The part of the pressure that damping adds `[Pa]`, negative while surfaces part.
    pub damping: f64,
}

/// Gap and slip tied to zero, in tension too.
fn tie(stencil: &Stencil, at: &Circumstances) -> Response {
    let mut response = Response {
        status: Status::Stick,
        limit: f64::INFINITY,
        ..Response::default()
    };
    let moved = [stencil.gap - at.rest, at.slip[0], at.slip[1]];
    let carried = [0.0, at.carried[0], at.carried[1]];
    for q in 0..3 {
        let stiffness = match q {
            0 => at.normal_stiffness,
            _ => at.tangential_stiffness,
        };
        let (stiffness, base) = if at.unknown {
            let keep = 1.0 - at.weight / stiffness;
            response.d_multiplier[q][q] = keep;
            let base = keep * at.multiplier[q] + (1.0 - keep) * at.centre[q];
            (at.weight, base)
        } else {
            (stiffness, carried[q])
        };
        response.traction[q] = base - stiffness * moved[q];
        response.d_gap[q][q] = -stiffness;
    }
    response
}

impl Laws {
    /// The laws in a few words, for reports.
    pub fn describe(&self) -> String {
        use crate::registry::Family;
        if self.tied {
            return format!("tied, {}", self.enforcement.kind());
        }
        format!(
            "normal {}, friction {}, slip {}, {}",
            self.own
                .normal
                .as_ref()
                .map_or(self.normal.kind(), |_| "own"),
            self.own
                .friction
                .as_ref()
                .map_or(self.friction.kind(), |_| "own"),
            self.slip.kind(),
            self.enforcement.kind()
        )
    }

    /// The normal law that counts.
    pub fn normal_law(&self) -> &dyn NormalLaw {
        match &self.own.normal {
            Some(own) => own,
            None => self.normal.as_dyn(),
        }
    }

    /// The friction law that counts.
    pub fn friction_law(&self) -> &dyn FrictionLaw {
        match &self.own.friction {
            Some(own) => own,
            None => self.friction.as_dyn(),
        }
    }

    /// Whether the normal law has no pressure of its own at a gap. A law of the program is not asked: it has one.
    pub fn set_valued(&self) -> bool {
        self.own.normal.is_none() && self.normal.as_dyn().pressure(0.0).is_none()
    }

    /// Whether the multipliers are unknowns of Newton's iteration.
    pub fn unknown_multipliers(&self) -> bool {
        // Where the laws themselves say pressure and shear there is nothing to enforce.
        self.enforcement.as_dyn().multipliers() != Multipliers::None
            && (self.needs_normal_stiffness() || self.needs_tangential_stiffness())
    }

    /// Whether a normal stiffness is needed: set-valued laws have no pressure of their own.
    pub fn needs_normal_stiffness(&self) -> bool {
        self.tied || self.set_valued()
    }

    /// Whether shear traction needs a stiffness of sticking.
    pub fn needs_tangential_stiffness(&self) -> bool {
        self.tied || (self.friction_law().frictional() && self.slip.as_dyn().sticks())
    }

    /// Evaluates the laws at a stencil.
    ///
    /// Where multipliers are unknowns the traction returned is what the multipliers `Σ` have to equal,
    /// `Σ = P(Σ - r C)`: `P` cuts off tension and shear beyond the limit, `C_n = g + (Σ_n - λ_n)/ω` (with λ = 0 the paper's
    /// `G - Σ/ω`, whose `Σ_n` is negative in compression) and `C_t = s + (Σ_t - λ_t)/ω`. In contact and stick this is `C = 0` whatever the weight `r`;
    /// a weight of the order of the bodies' stiffness makes status change when multiplier and gap together say so, where `ω` would
    /// send points from slip in one direction to slip in the other.
    pub fn respond(&self, stencil: &Stencil, at: &Circumstances) -> Response {
        let unknown = at.unknown;
        if self.tied {
            return tie(stencil, at);
        }
        if at.held == Some(Held::Open) {
            return Response::default();
        }
        let mut response = self.press(stencil.gap - at.rest, at, unknown);
        let pressure = response.traction[0];
        let friction = self.friction_law();
        let pressed = pressure > 0.0 || at.held.is_some();
        if pressed {
            response.status = if friction.frictional() {
                Status::Stick
            } else {
                Status::Slip
            };
        } else if at.touching > 0.0 {
            let sides = if friction.frictional() { 3 } else { 1 };
            for i in 0..sides {
                response.d_gap[i][i] = -at.touching;
            }
        }
        if !friction.frictional() || !pressed {
            return response;
        }
        self.shear(stencil, at, unknown, &mut response);
        response
    }

    /// The normal part: pressure and its derivatives.
    fn press(&self, gap: f64, at: &Circumstances, unknown: bool) -> Response {
        let normal = self.normal_law();
        let set_valued = || at.told.pressure.is_none() && normal.pressure(gap).is_none();
        let mut response = Response::default();
        if unknown && set_valued() {
            let keep = 1.0 - at.weight / at.normal_stiffness;
            let p = keep * at.multiplier[0] + (1.0 - keep) * at.centre[0] - at.weight * gap;
            if p > 0.0 || at.held.is_some() {
                response.traction[0] = p;
                response.d_gap[0][0] = -at.weight;
                response.d_multiplier[0][0] = keep;
            }
            return response;
        }
        if at.held.is_some() && set_valued() {
            response.traction[0] = -at.normal_stiffness * gap;
            response.d_gap[0][0] = -at.normal_stiffness;
            return response;
        }
        let asked = || pressure(normal, gap, at.normal_stiffness);
        let p = at.told.pressure.unwrap_or_else(asked);
        response.traction[0] = p.value;
        response.d_gap[0][0] = p.slope;
        self.damp(at, &mut response);
        response
    }

    /// Adds what damping does to a pressure that follows from the gap. Surfaces do not pull: what would is cut off.
    fn damp(&self, at: &Circumstances, response: &mut Response) {
        let damping = self.damping.as_dyn();
        let elastic = response.traction[0];
        if !damping.active() || elastic <= 0.0 {
            return;
        }
        let extra = damping.extra(elastic, at.closing);
        if elastic + extra.value <= 0.0 {
            response.damping = -elastic;
            response.traction[0] = 0.0;
            response.d_gap[0][0] = 0.0;
            return;
        }
        response.damping = extra.value;
        response.traction[0] += extra.value;
        // the closing velocity falls with the gap
        response.d_gap[0][0] =
            response.d_gap[0][0] * (1.0 + extra.d_pressure) - extra.d_rate / at.dt;
    }

    /// What a friction law is asked at a stencil, if it is; `at` tells the pressure where the normal law is the program's own.
    pub fn question(&self, stencil: &Stencil, at: &Circumstances) -> Option<FrictionPoint> {
        if self.tied || at.held == Some(Held::Open) || !self.friction_law().frictional() {
            return None;
        }
        let pressure = self.press(stencil.gap - at.rest, at, at.unknown).traction[0];
        let motion = Tangential {
            skew: stencil.skew,
            ..Tangential::default()
        };
        let path = motion.length(at.slip);
        (pressure > 0.0 || at.held.is_some())
            .then(|| Self::friction_point(stencil, at, pressure, path))
    }

    fn friction_point(
        stencil: &Stencil,
        at: &Circumstances,
        pressure: f64,
        path: f64,
    ) -> FrictionPoint {
        FrictionPoint {
            pressure: pressure.max(0.0),
            penetration: (-stencil.gap).max(0.0),
            speed: path / at.dt,
            sticking: at.sticking,
        }
    }

    /// The tangential part, added to a response with pressure.
    fn shear(&self, stencil: &Stencil, at: &Circumstances, unknown: bool, response: &mut Response) {
        let keep = if unknown && at.tangential_stiffness.is_finite() {
            1.0 - at.weight / at.tangential_stiffness
        } else {
            0.0
        };
        let motion = Tangential {
            slip: at.slip,
            dt: at.dt,
            stiffness: if unknown {
                at.weight
            } else {
                at.tangential_stiffness
            },
            base: if unknown {
                [1, 2].map(|i| keep * at.multiplier[i] + (1.0 - keep) * at.centre[i])
            } else {
                at.carried
            },
            skew: stencil.skew,
            smoothing: 0.0,
            slack: at.slack,
        };
        let path = motion.length(motion.slip);
        let asked = || {
            let point = Self::friction_point(stencil, at, response.traction[0], path);
            self.friction_law().limit(&point)
        };
        let mut limit = at.told.limit.unwrap_or_else(asked);
        limit.value *= at.mobilised;
        limit.d_pressure *= at.mobilised;
        limit.d_penetration *= at.mobilised;
        limit.d_speed *= at.mobilised;
        if response.traction[0] < 0.0 {
            limit.d_pressure = 0.0;
        }
        let motion = Tangential {
            smoothing: at.softness * limit.value / at.dt,
            ..motion
        };
        let rule: &dyn SlipRule = self.slip.as_dyn();
        let shear = match at.held {
            None | Some(Held::Open) => rule.traction(limit.value, &motion),
            Some(Held::Stick) => rule.stuck(limit.value, &motion),
            Some(Held::Slip(direction)) => SlipState {
                traction: direction.map(|d| limit.value * d),
                d_limit: direction,
                sliding: true,
                sliding_path: motion.slip,
                ..SlipState::default()
            },
        };
        response.limit = limit.value;
        response.sliding_path = at.path.unwrap_or(shear.sliding_path);
        if shear.sliding {
            response.status = Status::Slip;
        }
        // penetration = -gap where closed
        let d_limit_gap = limit.d_pressure * response.d_gap[0][0]
            - if stencil.gap < 0.0 {
                limit.d_penetration
            } else {
                0.0
            };
        let toward = if path > 0.0 && limit.d_speed != 0.0 {
            motion.length_slope(motion.slip, path)
        } else {
            [0.0; 2]
        };
        for i in 0..2 {
            // the smoothing follows the limit
            let d_limit = shear.d_limit[i] + shear.d_smoothing[i] * at.softness / at.dt;
            response.traction[i + 1] = shear.traction[i];
            response.d_gap[i + 1][0] = d_limit * d_limit_gap;
            response.d_skew[i + 1] = shear.d_skew[i];
            response.d_multiplier[i + 1][0] =
                d_limit * limit.d_pressure * response.d_multiplier[0][0];
            for (j, toward) in toward.iter().enumerate() {
                response.d_gap[i + 1][j + 1] =
                    shear.d_slip[i][j] + d_limit * limit.d_speed * toward / at.dt;
                if keep != 0.0 && rule.sticks() {
                    // the trial traction is keep Σ_t + … - r s
                    response.d_multiplier[i + 1][j + 1] = -keep * shear.d_slip[i][j] / at.weight;
                }
            }
        }
    }
}
