use std::f64::consts::TAU;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::model::{Heights, Relief, RoughnessModel, positive};
use crate::error::Error;
use crate::registry::Samples;

/// `h = a cos(2π s/λ₁)`, or `h = a cos(2π s/λ₁) cos(2π t/λ₂)`: a waviness whose contact is known in closed form
/// ([Westergaard 1939](stickslip_base::references::westergaard_1939)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Wave {
    /// Height of crests above the mean `[length]`.
    pub amplitude: f64,
    /// Distance from crest to crest along the first axis, and if it varies along the second too, along that `[length]`.
    pub wavelength: Vec<f64>,
    /// Where along the axes a crest lies, from the origin `[length]`. Default: 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub crest: Vec<f64>,
}

impl Heights for Wave {
    fn at(&self, place: [f64; 2]) -> Option<f64> {
        let crest = |i: usize| self.crest.get(i).copied().unwrap_or(0.0);
        let along = self.wavelength.iter().enumerate();
        let factors = along.map(|(i, length)| (TAU * (place[i] - crest(i)) / length).cos());
        Some(self.amplitude * factors.product::<f64>())
    }
}

impl RoughnessModel for Wave {
    fn heights(&self, _: &Path, _: bool) -> Result<Relief, Error> {
        Ok(self.clone().into())
    }

    fn shortest(&self) -> Option<f64> {
        self.wavelength.iter().copied().reduce(f64::min)
    }

    fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = positive("amplitude", self.amplitude).into_iter().collect();
        for length in &self.wavelength {
            faults.extend(positive("wavelength", *length));
        }
        if !(1..dim).contains(&self.wavelength.len()) {
            let count = self.wavelength.len();
            let most = dim - 1;
            faults.push((
                "wavelength",
                format!("has {count} lengths; give 1 to {most}"),
            ));
        }
        if self.crest.len() > self.wavelength.len() || self.crest.iter().any(|c| !c.is_finite()) {
            let message = "has to be a number for each of the lengths of `wavelength`";
            faults.push(("crest", message.into()));
        }
        faults
    }
}

impl Samples for Wave {
    fn samples() -> Vec<Self> {
        vec![Wave {
            amplitude: 1e-6,
            wavelength: vec![1e-3],
            crest: Vec::new(),
        }]
    }
}
