//! What a friction law is asked and says.

/// What a friction law may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrictionPoint {
    /// Pressure `[Pa]`, not negative.
    pub pressure: f64,
    /// Penetration `max(0, -gap)` `[m]`.
    pub penetration: f64,
    /// Sliding speed `[m/s]`.
    pub speed: f64,
    /// The point stuck, or was open, at the last accepted state.
    pub sticking: bool,
}

/// The limit of the shear traction and its derivatives.
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
}

impl Limit {
    /// The limit, but at most `cap`.
    pub fn capped(self, cap: Option<f64>) -> Self {
        match cap {
            Some(cap) if self.value > cap => Limit {
                value: cap,
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
