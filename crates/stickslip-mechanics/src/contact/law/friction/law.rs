//! What a friction law is asked and says.

use super::orthotropy::Orthotropy;
use crate::math::Vec3;

/// Most state variables of a friction law.
pub const MOST_STATES: usize = 4;

/// State variables of a friction law at a contact point, in the order of [`FrictionLaw::states`]; zero beyond them.
pub type LawState = [f64; MOST_STATES];

/// A number that a friction law keeps at each contact point from one increment to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateVariable {
    /// Name of the field in results: `THETA`.
    pub name: &'static str,
    /// Unit, as in `s`.
    pub unit: &'static str,
}

/// What a friction law may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrictionPoint {
    /// Pressure `[Pa]`, not negative.
    pub pressure: f64,
    /// Penetration `max(0, -gap)` `[m]`.
    pub penetration: f64,
    /// Sliding speed `[m/s]`: the mean over the increment, or that at its end.
    pub speed: f64,
    /// `speed` is that at the end of the increment, as in motion.
    pub speed_at_end: bool,
    /// The point stuck, or was open, at the last accepted state.
    pub sticking: bool,
    /// Time since the last accepted state `[s]`.
    pub dt: f64,
    /// State variables at the last accepted state.
    pub state: LawState,
    /// Where the point is in the reference configuration `[m]`.
    pub place: Vec3,
}

impl FrictionPoint {
    /// A point at rest under a pressure `[Pa]` to which nothing has happened yet; under a law that flows, one that slides at its typical speed.
    pub fn at_rest(law: &dyn FrictionLaw, pressure: f64) -> Self {
        FrictionPoint {
            pressure,
            sticking: true,
            speed: law.typical_speed(),
            state: law.initial_state([0.0; 3]),
            ..FrictionPoint::default()
        }
    }
}

/// The limit of the shear traction and its derivatives. They are total ones: state variables follow pressure and speed within the increment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limit {
    /// Limit `[Pa]`, not negative.
    pub value: f64,
    /// Derivative with respect to pressure `[-]`.
    pub d_pressure: f64,
    /// Derivative with respect to penetration `[Pa/m]`.
    pub d_penetration: f64,
    /// Derivative with respect to speed `[Pa s/m]`.
    pub d_speed: f64,
    /// State variables at the end of the increment.
    pub state: LawState,
}

impl Limit {
    /// The limit, but at most `cap`.
    pub fn capped(self, cap: Option<f64>) -> Self {
        match cap {
            Some(cap) if self.value > cap => Limit {
                value: cap,
                state: self.state,
                ..Limit::default()
            },
            _ => self,
        }
    }
}

/// States the largest shear traction. What happens below and at the limit is the slip rule's business.
pub trait FrictionLaw: Send + Sync {
    /// The limit at a point in contact.
    fn limit(&self, at: &FrictionPoint) -> Limit;

    /// The state variables that a point keeps, at most [`MOST_STATES`]; most laws have none. The law is asked with those of the last accepted state, and answers with
    /// those at the end of the increment, solved together with the limit.
    fn states(&self) -> &'static [StateVariable] {
        &[]
    }

    /// State variables before anything has happened, of a point of the reference configuration.
    fn initial_state(&self, place: Vec3) -> LawState {
        let _ = place;
        LawState::default()
    }

    /// `true` if surfaces slide under any shear, however slowly: the limit falls to zero with the speed, and is what is carried at each of them. The slip rule is not
    /// asked then. The limit has to rise with the speed, or fall more slowly than the bodies give way.
    fn flows(&self) -> bool {
        false
    }

    /// The sliding speed among the state variables `[m/s]`, of laws that keep it.
    fn speed_in(&self, state: &LawState) -> Option<f64> {
        let _ = state;
        None
    }

    /// Speed `[m/s]` at which to ask for the limit where none is known.
    fn typical_speed(&self) -> f64 {
        0.0
    }

    /// How fast state variables change relative to what they are `[1/s]`. Increments are kept so short that this times their length is small.
    fn rate_of_change(&self, state: &LawState, place: Vec3) -> f64 {
        let _ = (state, place);
        0.0
    }

    /// State variables of a point that was open for a time `dt` `[s]`.
    fn open_state(&self, state: &LawState, dt: f64) -> LawState {
        let _ = dt;
        *state
    }

    /// How the limit depends on the direction of the shear: it is then that along the axis with the larger one. `None` where all directions are alike.
    fn orthotropy(&self) -> Option<Orthotropy> {
        None
    }

    /// `false` if there is never any shear traction; saves the tangential unknowns.
    fn frictional(&self) -> bool {
        true
    }

    /// `true` if the law depends on the penetration, which only a compliant normal law gives a physical meaning.
    fn needs_penetration(&self) -> bool {
        false
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}
