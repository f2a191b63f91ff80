//! Linear elastic materials: the tensor `a_ijkl` of [`pop_1995`](stickslip_base::references::pop_1995), eq. (2), one file a model.
//!
//! Stresses and strains are 6-vectors in the order xx yy zz xy yz xz; shear strains are engineering strains
//! (`γ_xy = 2 ε_xy`), so that `σ = C ε` with the same `C` that handbooks print.

// Tensor components read best by their indices.
#![allow(clippy::needless_range_loop)]

mod anisotropic;
mod axes;
mod check;
mod elasticity;
mod expansion;
mod isotropic;
mod orthotropic;
mod reduce;
mod stiffness;

pub use anisotropic::{Anisotropic, Entries};
pub use check::{MaterialError, smallest_eigenvalue};
pub use elasticity::Elasticity;
pub use expansion::{Dilation, Expansion, ExpansionTable};
pub use isotropic::Isotropic;
pub use orthotropic::Orthotropic;
pub use reduce::{constrained_modulus, plane_stress};
pub use stiffness::{Stiffness, VOIGT};

crate::family! {
    /// The materials.
    Material: "material", dyn Elasticity {
        /// The same in all directions: two constants.
        Isotropic(Isotropic) = "isotropic",
        /// Three orthogonal planes of symmetry: nine constants.
        Orthotropic(Orthotropic) = "orthotropic",
        /// The full tensor: up to 21 constants.
        Anisotropic(Anisotropic) = "anisotropic",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn samples_are_elliptic_and_round_trip() {
        let samples = Material::samples();
        for kind in Material::KINDS {
            assert!(samples.iter().any(|m| m.kind() == *kind));
        }
        for material in samples {
            let model = material.as_dyn();
            model.check().expect("samples are sound");
            let c = model.stiffness().expect("samples are sound");
            assert!(smallest_eigenvalue(&c) > 0.0);
            assert!(model.characteristic_modulus().expect("checked") > 0.0);
            let text = serde_json::to_string(&material).expect("plain data");
            let back: Material = serde_json::from_str(&text).expect("its own text");
            assert_eq!(back, material);
        }
    }
}
