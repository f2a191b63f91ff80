//! What a cycle does to a material: criteria of fretting fatigue, from the history of stress at a point or of what rubs on it.
//!
//! A criterion sees numbers. Those of the volume are asked for every plane through a point, and the worst plane is looked for ([`worst`]); those of the surface for what happens on it. None of them says
//! how long something lasts: that takes a curve of the material, against which their values are held.

mod circle;
mod criterion;
mod dang_van;
mod findley;
mod planes;
mod record;
mod ruiz;
mod smith_watson_topper;

pub use criterion::{Criterion, OnPlane, Rubbed};
pub use dang_van::DangVan;
pub use findley::Findley;
pub use planes::{Directions, History, Worst, worst};
pub use record::{CycleIncrement, Found, Maximum, Record};
pub use ruiz::{Ruiz, RuizWork};
pub use smith_watson_topper::SmithWatsonTopper;

crate::family! {
    /// A criterion of fretting fatigue.
    FatigueModel: "fatigue", dyn Criterion {
        /// Stress along the surface times shear times slip.
        Ruiz(Ruiz) = "ruiz",
        /// Shear times slip.
        RuizWork(RuizWork) = "ruiz-work",
        /// Largest normal stress times amplitude of the normal strain, on the worst plane.
        SmithWatsonTopper(SmithWatsonTopper) = "smith-watson-topper",
        /// Amplitude of shear and a part of the largest normal stress, on the worst plane.
        Findley(Findley) = "findley",
        /// Shear about its mean and a part of the hydrostatic stress at the same time, on the worst plane.
        DangVan(DangVan) = "dang-van",
    }
}

#[cfg(test)]
mod tests;
