//! The integrator of the step at hand.

use super::explicit::Explicit;
use super::implicit::Implicit;
use super::integrator::Integrator;
use super::quasi_static::QuasiStatic;

/// The integrator of the step at hand.
pub(crate) enum Integration {
    QuasiStatic(QuasiStatic),
    Implicit(Implicit),
    Explicit(Box<Explicit>),
}

impl Integration {
    /// It, whichever it is.
    pub fn as_dyn(&self) -> &dyn Integrator {
        match self {
            Integration::QuasiStatic(one) => one,
            Integration::Implicit(one) => one,
            Integration::Explicit(one) => one.as_ref(),
        }
    }

    /// It, to make increments.
    pub fn as_dyn_mut(&mut self) -> &mut dyn Integrator {
        match self {
            Integration::QuasiStatic(one) => one,
            Integration::Implicit(one) => one,
            Integration::Explicit(one) => one.as_mut(),
        }
    }

    /// What explicit increments need, if they are made.
    pub fn explicit(&self) -> Option<&Explicit> {
        match self {
            Integration::Explicit(one) => Some(one),
            _ => None,
        }
    }
}
