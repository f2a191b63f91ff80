use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use super::orthotropy::{Lines, Orthotropy};
use crate::contact::law::normal::{not_negative, positive};
use crate::friction::ellipse::SlipDirection;
use crate::math::Vec3;
use crate::registry::Samples;

/// Orthotropic friction: one coefficient along an axis of the surface and another across it, `(t₁/μ₁)² + (t₂/μ₂)² <= p²`.
///
/// The axis is that of scratches, rolling marks or fibres of the primary surface. It keeps its direction in space, and at each point counts as projected on the surface. The two
/// slip directions, with the shear that belongs to a slip, are those of [Michałowski and Mróz 1978](stickslip_base::references::michalowski_mroz_1978). In two dimensions
/// a point slides in one direction alone, and the coefficient is that of this direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Orthotropic {
    /// Coefficients of friction along the axis and across it `[-]`.
    pub mu: [f64; 2],
    /// The axis. Its part along the normal of the surface has no effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Instead of `axis`: the line around which the axes are circles, as turning leaves them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub around: Option<Around>,
    /// How a point slips at the limit. Default: associated.
    #[serde(default, skip_serializing_if = "is_default")]
    pub slip: SlipDirection,
    /// Largest shear traction `[Pa]` along the axis with the larger coefficient; across it is less in the ratio of the coefficients. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cap: Option<f64>,
}

/// A line around which circles run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Around {
    /// A point on the line `[m]`. Default: the origin.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub centre: Vec<f64>,
    /// Direction of the line.
    pub axis: Vec<f64>,
}

fn is_default(flow: &SlipDirection) -> bool {
    *flow == SlipDirection::default()
}

/// What is wrong with a vector that has to have a direction.
fn no_direction(key: &'static str, v: &[f64]) -> Option<(&'static str, String)> {
    let fine = (2..=3).contains(&v.len()) && v.iter().all(|x| x.is_finite());
    (!fine || v.iter().all(|x| *x == 0.0)).then(|| {
        let message = format!(
            "must be a vector of two or three finite components that has a direction, but is {v:?}"
        );
        (key, message)
    })
}

/// A vector with a third component.
fn in_space(v: &[f64]) -> Vec3 {
    std::array::from_fn(|c| v.get(c).copied().unwrap_or(0.0))
}

impl Orthotropic {
    fn largest(&self) -> f64 {
        self.mu[0].max(self.mu[1])
    }
}

impl FrictionLaw for Orthotropic {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let mu = self.largest();
        Limit {
            value: mu * at.pressure,
            d_pressure: mu,
            ..Limit::default()
        }
        .capped(self.cap)
    }

    fn orthotropy(&self) -> Option<Orthotropy> {
        let lines = match (&self.axis, &self.around) {
            (Some(axis), _) => Lines::Along(in_space(axis)),
            (None, Some(around)) => Lines::Around {
                centre: in_space(&around.centre),
                axis: in_space(&around.axis),
            },
            (None, None) => return None,
        };
        // Without a difference the law is that of Coulomb.
        (self.mu[0] != self.mu[1]).then(|| Orthotropy {
            lines,
            half: self.mu.map(|mu| mu / self.largest()),
            flow: self.slip,
        })
    }

    fn frictional(&self) -> bool {
        self.largest() > 0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = (self.mu.into_iter())
            .filter_map(|mu| not_negative("mu", mu))
            .collect();
        let none = self.mu.contains(&0.0) && self.frictional();
        if none && self.slip == SlipDirection::AgainstTraction {
            let message = "must be larger than zero in both directions where slip is against the traction; \
                           no friction in one direction goes with `slip = \"associated\"`";
            faults.push(("mu", message.into()));
        }
        match (&self.axis, &self.around) {
            (Some(_), Some(_)) => {
                faults.push(("around", "takes the place of `axis`: remove one of them".into()));
            }
            (None, None) => faults.push((
                "axis",
                "is missing: give a vector along which the first coefficient acts, or a line `around` which the axes are circles".into(),
            )),
            (Some(axis), None) => faults.extend(no_direction("axis", axis)),
            (None, Some(around)) => {
                faults.extend(no_direction("around", &around.axis));
                let centre = &around.centre;
                if centre.len() == 1 || centre.len() > 3 || centre.iter().any(|x| !x.is_finite()) {
                    let message = format!("has the centre {centre:?}, which is no point");
                    faults.push(("around", message));
                }
            }
        }
        faults.extend(self.cap.and_then(|cap| positive("cap", cap)));
        faults
    }
}

impl Samples for Orthotropic {
    fn samples() -> Vec<Self> {
        let scratched = Orthotropic {
            mu: [0.5, 0.2],
            axis: Some(vec![2.0, 1.0, 0.5]),
            around: None,
            slip: SlipDirection::Associated,
            cap: None,
        };
        vec![
            scratched.clone(),
            Orthotropic {
                mu: [0.1, 0.3],
                axis: None,
                around: Some(Around {
                    centre: vec![0.3, -1.0, 0.0],
                    axis: vec![0.0, 0.0, 1.0],
                }),
                slip: SlipDirection::AgainstTraction,
                cap: Some(1e7),
            },
        ]
    }
}
