//! What a discretisation says.

/// A way to discretise an interface.
pub trait Discretisation: Send + Sync {
    /// Whether gaps are weighted over faces, and then the largest angle `[°]` between faces of one smooth surface.
    fn weighted(&self) -> Option<f64> {
        None
    }

    /// Whether both surfaces are secondary, each for one half.
    fn two_sided(&self) -> bool {
        false
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}
