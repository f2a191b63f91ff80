//! Heights of rough surfaces: what the problem file names under `roughness`, one file a kind; measured maps, and figures of heights.

mod csv;
mod map;
mod measured;
mod model;
pub(crate) mod random;
mod sdf;
mod self_affine;
mod statistics;
mod wave;

pub use map::HeightMap;
pub use measured::{Measured, Tilt};
pub use model::{Figures, Heights, Relief, RoughnessModel};
pub use self_affine::SelfAffine;
pub use statistics::Statistics;
pub use wave::Wave;

crate::family! {
    /// Where heights come from.
    RoughnessKind: "roughness", dyn RoughnessModel {
        /// A measured map or profile.
        Measured(Measured) = "measured",
        /// A random surface that looks alike in a range of lengths.
        SelfAffine(SelfAffine) = "self-affine",
        /// A cosine along one axis or two.
        Wave(Wave) = "wave",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn samples_are_sound_and_round_trip() {
        for kind in RoughnessKind::samples() {
            assert_eq!(kind.as_dyn().faults(3), []);
            let text = serde_json::to_string(&kind).expect("plain data");
            let back: RoughnessKind = serde_json::from_str(&text).expect("its own text");
            assert_eq!(back, kind);
        }
    }
}
