//! What a damping law says.

/// The extra pressure and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Extra {
    /// Pressure on top of the elastic one `[Pa]`, negative while the surfaces part.
    pub value: f64,
    /// Derivative with respect to the elastic pressure `[-]`.
    pub d_pressure: f64,
    /// Derivative with respect to the closing velocity `[Pa s/m]`.
    pub d_rate: f64,
}

/// Extra pressure while surfaces approach or part.
///
/// Surfaces in contact push and never pull: where elastic and extra pressure together would be tension, the caller cuts
/// the sum off at zero. A model says only what it would add.
pub trait NormalDamping: Send + Sync {
    /// The extra pressure at a point in contact: `pressure` is the elastic pressure `[Pa]` of the normal law, positive;
    /// `rate` the closing velocity `[m/s]`, positive while the surfaces approach.
    fn extra(&self, pressure: f64, rate: f64) -> Extra;

    /// `false` if there is never any extra pressure.
    fn active(&self) -> bool {
        true
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}
