//! What a wear law says.

use crate::contact::law::normal::not_negative;

/// What has slid over a point, per area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Pressure times path `[Pa m]`.
    pub pressed: f64,
    /// Shear times path `[J/m²]`.
    pub dissipated: f64,
}

/// How fast a surface wears.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WearRate {
    /// Depth over pressure times path `[1/Pa]`.
    pub pressed: f64,
    /// Depth over shear times path `[1/Pa]`.
    pub dissipated: f64,
}

impl WearRate {
    /// Depth that is lost `[m]`.
    pub fn depth(self, slid: Sliding) -> f64 {
        self.pressed * slid.pressed + self.dissipated * slid.dissipated
    }

    /// Depth over pressure times path, where the shear is this part of the pressure `[1/Pa]`.
    pub fn per_path(self, shear: f64) -> f64 {
        self.pressed + self.dissipated * shear
    }
}

/// What sliding takes away: a depth in proportion to pressure, or shear, and path.
///
/// That it is in proportion is what lets wear be solved for together with the pressure: over an increment with a path `ds` it is a compliance
/// `k ds` in series with the contact.
pub trait WearLaw: Send + Sync {
    /// How fast the secondary and the primary wear at a point that has slid a `path` so far `[m]`.
    fn rates(&self, path: f64) -> [WearRate; 2];

    /// `false` if nothing ever wears.
    fn active(&self) -> bool {
        true
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

/// A finding if `value` is neither zero nor positive and finite.
pub(super) fn rate_fault(key: &'static str, value: f64) -> Option<(&'static str, String)> {
    not_negative(key, value)
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
pub(super) fn is_zero(x: &f64) -> bool {
    *x == 0.0
}
