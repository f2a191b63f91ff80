//! What a criterion is asked.

/// A point over a cycle as a plane through it sees it, one entry an increment.
#[derive(Debug, Clone, Default)]
pub struct OnPlane {
    /// Stress across the plane, positive in tension `[Pa]`.
    pub normal: Vec<f64>,
    /// Shear along two directions in it `[Pa]`.
    pub shear: Vec<[f64; 2]>,
    /// Elastic strain across it `[-]`.
    pub strain: Vec<f64>,
    /// A third of the trace of the stress `[Pa]`: the same on all planes.
    pub hydrostatic: Vec<f64>,
}

impl OnPlane {
    /// The largest stress across the plane `[Pa]`.
    pub fn opening(&self) -> f64 {
        self.normal
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

/// What a point of a surface has been through over a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rubbed {
    /// Largest stress along the surface, in the direction of the slip; zero where it is compressed all the time `[Pa]`.
    pub tension: f64,
    /// Largest shear traction `[Pa]`.
    pub shear: f64,
    /// Slip from end to end `[m]`.
    pub slip: f64,
}

/// How badly a cycle treats a point.
pub trait Criterion: Send + Sync {
    /// Its name in tables and fields.
    fn name(&self) -> &'static str;

    /// Its value on a plane; `None` where it looks at the surface.
    fn on_plane(&self, _at: &OnPlane) -> Option<f64> {
        None
    }

    /// Its value at a point of a surface; `None` where it looks at planes.
    fn on_surface(&self, _at: &Rubbed) -> Option<f64> {
        None
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// A finding if a factor is negative or no number.
pub(super) fn factor(key: &'static str, value: f64) -> Vec<(&'static str, String)> {
    match value.is_finite() && value >= 0.0 {
        true => Vec::new(),
        false => vec![(key, format!("must be zero or positive, but is {value}"))],
    }
}
