//! The disc and the half-disc.

use super::generate::Generate;
use super::rectangle::quad4;
use super::round::Round;
use super::round_options::Refinement;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

fn downwards() -> [f64; 2] {
    [0.0, -1.0]
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
            pub centre: [f64; 2],
            /// Radius `[length]`.
            pub radius: f64,
            /// From the centre to the contact point; only its direction counts.
            #[serde(default = "downwards")]
            pub direction: [f64; 2],
            /// Largest size of the cells at the surface `[length]`; an eighth of the radius unless given.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub size: Option<f64>,
            /// Smaller cells at the contact point.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub refine: Option<Refinement>,
            /// Element: quad4, quad8, tri3 or tri6.
            #[serde(default = "quad4")]
            pub element: ElementKind,
            /// Only the half on one side of the line through centre and contact point: the right one (for a horizontal
            /// `direction` the upper one), also where the contact point is on top. With the centre on the axis it serves
            /// axisymmetric bodies.
            #[serde(default)]
            pub symmetric: bool,
        }

        impl Generate for $name {
            fn generate(&self) -> Result<Mesh, MeshError> {
                let flat = |v: [f64; 2]| [v[0], v[1], 0.0];
                Round {
                    dim: 2,
                    centre: flat(self.centre),
                    radius: self.radius,
                    direction: flat(self.direction),
                    size: self.size,
                    refine: self.refine,
                    element: self.element,
                    symmetric: [self.symmetric, false],
                    half: $half,
                }
                .generate()
            }
        }

        impl Samples for $name {
            fn samples() -> Vec<Self> {
                let kinds = [
                    ElementKind::Tri3,
                    ElementKind::Tri6,
                    ElementKind::Quad4,
                    ElementKind::Quad8,
                ];
                let plain = |element| $name {
                    centre: [0.01, 0.02],
                    radius: 0.05,
                    direction: downwards(),
                    size: None,
                    refine: None,
                    element,
                    symmetric: false,
                };
                let mut all: Vec<Self> = kinds.into_iter().map(plain).collect();
                all.push($name {
                    direction: [0.0, 1.0],
                    refine: Some(Refinement {
                        finest: 2e-4,
                        width: 1e-3,
                        growth: 1.3,
                    }),
                    symmetric: true,
                    ..plain(ElementKind::Quad4)
                });
                all.push($name {
                    direction: [-3.0, 4.0],
                    ..plain(ElementKind::Tri6)
                });
                all
            }
        }
    )+};
}

bodies! {
    /// A disc, refined towards a contact point on its rim.
    ///
    /// Facet sets: `arc` (the rim); `axis` (the cut through the contact point) if `symmetric`. Point sets: `pole` (the
    /// contact point), `centre`. Every point of the rim lies on the circle.
    Disc {
        /// Centre `[length]`.
        centre,
        half: false
    }

    /// A half-disc, refined towards the middle of its arc: the body of Hertz's line contact, and with `symmetric` of his
    /// point contact in axisymmetry.
    ///
    /// Facet sets: `arc`, `flat` (the diameter); `axis` (the cut through the contact point) if `symmetric`. Point sets:
    /// `pole` (the contact point), `centre`. Every point of the arc lies on the circle.
    HalfDisc {
        /// Middle of the flat side `[length]`.
        centre,
        half: true
    }
}
