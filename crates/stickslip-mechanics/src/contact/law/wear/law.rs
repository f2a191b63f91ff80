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

/// A point that slides over an increment, and what it has come through before. Cycles that are not computed count in both.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WearPoint {
    /// Path before the increment `[m]`.
    pub path: f64,
    /// Path of the increment `[m]`.
    pub way: f64,
    /// Energy that friction dissipated before the increment `[J/m²]`.
    pub energy: f64,
    /// Energy that it dissipates in the increment `[J/m²]`.
    pub spent: f64,
    /// Pressure `[Pa]`.
    pub pressure: f64,
    /// Speed of sliding `[m/s]`.
    pub speed: f64,
}

/// How fast a surface wears.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WearRate {
    /// Depth over pressure times path `[1/Pa]`.
    pub pressed: f64,
    /// Depth over shear times path `[1/Pa]`.
    pub dissipated: f64,
    /// Change of `pressed` with the pressure `[1/Pa²]`.
    pub d_pressure: f64,
}

impl WearRate {
    /// A rate that depends on no pressure.
    pub fn pressed(pressed: f64) -> Self {
        WearRate {
            pressed,
            ..WearRate::default()
        }
    }

    /// Depth that is lost `[m]`.
    pub fn depth(self, slid: Sliding) -> f64 {
        self.pressed * slid.pressed + self.dissipated * slid.dissipated
    }

    /// Depth over pressure times path, where the shear is this part of the pressure `[1/Pa]`.
    pub fn per_path(self, shear: f64) -> f64 {
        self.pressed + self.dissipated * shear
    }
}

/// What sliding takes away: a depth that rises with pressure, or shear, and is in proportion to the path.
///
/// That it is a function of the pressure alone, over an increment with a given path, is what lets wear be solved for together with the pressure: it is a compliance
/// in series with the contact, `k ds` where the rate does not depend on the pressure, and otherwise the slope `(k + p dk/dp) ds`.
pub trait WearLaw: Send + Sync {
    /// How fast the secondary and the primary wear at a point, in the mean over an increment.
    fn rates(&self, at: &WearPoint) -> [WearRate; 2];

    /// The largest slopes of the depth over pressure and path that there are; by default those of a fresh surface.
    fn fastest(&self) -> [WearRate; 2] {
        self.rates(&WearPoint::default())
    }

    /// `false` if nothing ever wears.
    fn active(&self) -> bool {
        true
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

/// The part of what an increment adds to a sum that is more than a threshold.
pub(super) fn beyond(before: f64, more: f64, threshold: f64) -> f64 {
    match more > 0.0 {
        true => ((before + more - threshold) / more).clamp(0.0, 1.0),
        false if before >= threshold => 1.0,
        false => 0.0,
    }
}

/// What is wrong with keys that must not be negative.
pub(super) fn negative<const N: usize>(
    keys: [(&'static str, f64); N],
) -> Vec<(&'static str, String)> {
    let faults = keys.into_iter();
    faults.filter_map(|(key, x)| not_negative(key, x)).collect()
}

/// What is wrong with the coefficients of both sides.
pub(super) fn coefficients([own, other]: [f64; 2]) -> Vec<(&'static str, String)> {
    let mut faults = negative([("coefficient", own), ("primary-coefficient", other)]);
    if own == 0.0 && other == 0.0 {
        faults.push((
            "coefficient",
            "one of `coefficient` and `primary-coefficient` must be positive".into(),
        ));
    }
    faults
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
pub(super) fn is_zero(x: &f64) -> bool {
    *x == 0.0
}
