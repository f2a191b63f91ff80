//! The laws that act together at an interface.

use std::fmt;
use std::sync::Arc;

use crate::contact::enforcement::{EnforcementModel, Multipliers};
use crate::contact::law::damping::DampingModel;
use crate::contact::law::friction::{FrictionLaw, FrictionModel};
use crate::contact::law::normal::{NormalLaw, NormalModel};
use crate::contact::law::slip::SlipModel;
use crate::contact::law::user::UserLaws;
use crate::contact::law::wear::{Feedback, WearModel};

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
    /// How the contact and sticking constraints are enforced.
    pub enforcement: EnforcementModel,
    /// The surfaces are glued: neither gap nor slip changes, and the laws have no meaning.
    pub tied: bool,
    /// What sliding wears off.
    pub wear: WearModel,
    /// Whether contact feels that.
    pub feedback: Feedback,
    /// Laws of the program that take the place of `normal` and `friction`.
    pub user: UserLaws,
    /// A law of the program that takes the place of `friction`, and is asked like it.
    pub own_friction: Option<OwnFriction>,
}

/// A friction law of the program, as its type has it.
#[derive(Clone)]
pub struct OwnFriction(pub Arc<dyn FrictionLaw>);

impl fmt::Debug for OwnFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnFriction")
    }
}

impl PartialEq for OwnFriction {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
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
            self.user
                .normal
                .as_ref()
                .map_or(self.normal.kind(), |_| "own"),
            match self.own_friction.is_some() || self.user.friction.is_some() {
                true => "own",
                false => self.friction.kind(),
            },
            self.slip.kind(),
            self.enforcement.kind()
        )
    }

    /// The normal law that counts.
    pub fn normal_law(&self) -> &dyn NormalLaw {
        match &self.user.normal {
            Some(user) => user,
            None => self.normal.as_dyn(),
        }
    }

    /// The friction law that counts.
    pub fn friction_law(&self) -> &dyn FrictionLaw {
        match (&self.own_friction, &self.user.friction) {
            (Some(own), _) => own.0.as_ref(),
            (None, Some(user)) => user,
            (None, None) => self.friction.as_dyn(),
        }
    }

    /// Whether the normal law has no pressure of its own at a gap. A law of the program is not asked: it has one.
    pub fn set_valued(&self) -> bool {
        self.user.normal.is_none() && self.normal.as_dyn().pressure(0.0).is_none()
    }

    /// Whether something wears, and contact feels it.
    pub fn wears_away(&self) -> bool {
        self.wear.as_dyn().active() && self.feedback != Feedback::None
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

    /// Whether friction acts through a spring that the enforcement says nothing of, as `springs` take the place of all else.
    pub fn lends_spring(&self, springs: bool) -> bool {
        springs && self.friction_law().frictional() && !self.needs_tangential_stiffness()
    }

    /// Whether shear traction needs a stiffness of sticking.
    pub fn needs_tangential_stiffness(&self) -> bool {
        self.tied || (self.friction_law().frictional() && self.slip.as_dyn().sticks())
    }
}
