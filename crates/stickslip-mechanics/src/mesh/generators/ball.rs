//! The ball and the half-ball.

use super::cuboid::hex8;
use super::generate::Generate;
use super::round::Round;
use super::round_options::{Refinement, Sector};
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

fn downwards() -> [f64; 3] {
    [0.0, 0.0, -1.0]
}

/// The body and the half of it, which differ by what is cut off.
macro_rules! bodies {
    ($($(#[$doc:meta])* $name:ident { $(#[$centre:meta])* centre, half: $half:literal })+) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(deny_unknown_fields, rename_all = "kebab-case")]
        pub struct $name {
            $(#[$centre])*
            #[serde(default)]
            pub centre: [f64; 3],
            /// Radius `[length]`.
            pub radius: f64,
            /// From the centre to the contact point; only its direction counts. The planes of the sectors contain it and stay
            /// as near to x = 0 and y = 0 as they can; where it is near to the x axis, to y = 0 and z = 0.
            #[serde(default = "downwards")]
            pub direction: [f64; 3],
            /// Largest size of the cells at the surface `[length]`; an eighth of the radius unless given.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub size: Option<f64>,
            /// Smaller cells at the contact point.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub refine: Option<Refinement>,
            /// Element: hex8, hex20, tet4 or tet10.
            #[serde(default = "hex8")]
            pub element: ElementKind,
            /// The part to mesh, by symmetry.
            #[serde(default)]
            pub sector: Sector,
        }

        impl Generate for $name {
            fn generate(&self) -> Result<Mesh, MeshError> {
                Round {
                    dim: 3,
                    centre: self.centre,
                    radius: self.radius,
                    direction: self.direction,
                    size: self.size,
                    refine: self.refine,
                    element: self.element,
                    symmetric: [self.sector != Sector::Full, self.sector == Sector::Quarter],
                    half: $half,
                }
                .generate()
            }
        }

        impl Samples for $name {
            fn samples() -> Vec<Self> {
                let plain = |element, sector| $name {
                    centre: [0.01, 0.02, -0.01],
                    radius: 0.05,
                    direction: downwards(),
                    size: Some(0.015),
                    refine: None,
                    element,
                    sector,
                };
                vec![
                    plain(ElementKind::Hex8, Sector::Full),
                    plain(ElementKind::Hex20, Sector::Half),
                    plain(ElementKind::Tet4, Sector::Full),
                    plain(ElementKind::Tet10, Sector::Quarter),
                    $name {
                        direction: [0.0, 0.0, 1.0],
                        refine: Some(Refinement {
                            finest: 1e-3,
                            width: 2e-3,
                            growth: 1.5,
                        }),
                        ..plain(ElementKind::Hex8, Sector::Quarter)
                    },
                    $name {
                        direction: [2.0, -1.0, 0.5],
                        ..plain(ElementKind::Hex8, Sector::Half)
                    },
                ]
            }
        }
    )+};
}

bodies! {
    /// A ball, refined towards a contact point.
    ///
    /// Facet sets: `arc` (the sphere); `symmetry-x`, `symmetry-y` (the cuts) by `sector`. Point sets: `pole` (the contact
    /// point), `centre`. Every point of `arc` lies on the sphere.
    Ball {
        /// Centre `[length]`.
        centre,
        half: false
    }

    /// A half-ball, refined towards its pole: the body of Hertz's point contact.
    ///
    /// Facet sets: `arc` (the half-sphere), `flat`; `symmetry-x`, `symmetry-y` (the cuts) by `sector`. Point sets: `pole`
    /// (the contact point), `centre`. Every point of `arc` lies on the sphere.
    HalfBall {
        /// Middle of the flat side `[length]`.
        centre,
        half: true
    }
}
