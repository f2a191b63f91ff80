use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::model::{Frequencies, HarmonicPlan, Modal, ModalDamping};

/// Amplitude and phase of the displacements at probes under harmonic loads, about the state of the step before, with its closed contacts, the friction of
/// `steady` sliding, and all damping. `harmonic = { loads = ["shaker"], from = 10, to = 500, points = 100 }`. Harmonic loads must not act before: leave
/// them out of `loads` of the steps before. Supports do not vibrate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Harmonic {
    /// The loads, in full: amplitudes over time do not count.
    pub loads: Vec<String>,
    /// Phase lead of loads, by name: `phases.second = 90`; zero if not given `[degrees]`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub phases: BTreeMap<String, f64>,
    /// The frequencies `[1/time]`, instead of `from`, `to` and `points`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<f64>,
    /// Lowest frequency `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    pub from: f64,
    /// Highest frequency `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// How many frequencies, ends counted.
    #[cfg_attr(feature = "schema", schemars(range(min = 2, max = 100_000)))]
    pub points: usize,
    /// Concentrates frequencies near the modes: `points` of them between neighbouring real modes, and between these and `from` and `to`, ends counted;
    /// the larger, the closer to the ends. 1 is even; 3 is the default of Abaqus and CalculiX. If not given, `points` are spread evenly from `from` to
    /// `to`.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 1)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias: Option<f64>,
    /// Damping of the real modes, beside that of bodies, dashpots and contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<ModalDamping>,
    /// Largest number of superposed modes; those up to one and a half times the highest frequency are used, with a static correction for the others.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub count: usize,
    /// Whether displacements of all points are written as fields, real and imaginary parts, for each frequency.
    pub shapes: bool,
}

impl Default for Harmonic {
    fn default() -> Self {
        Harmonic {
            loads: Vec::new(),
            phases: BTreeMap::new(),
            frequencies: Vec::new(),
            from: 0.0,
            to: None,
            points: 101,
            bias: None,
            damping: None,
            count: 200,
            shapes: false,
        }
    }
}

impl Harmonic {
    /// What is looked for.
    pub(super) fn plan(&self) -> Modal {
        let phase = |name: &String| self.phases.get(name).copied().unwrap_or(0.0).to_radians();
        let loads = self.loads.iter().map(|l| (l.clone(), phase(l)));
        let (from, last) = (self.from, self.points.max(2) - 1);
        let to = self.to.unwrap_or(from);
        let range = (0..=last).map(|k| from + (to - from) * k as f64 / last as f64);
        let frequencies = match (self.frequencies.is_empty(), self.bias) {
            (false, _) => Frequencies::At(self.frequencies.clone()),
            (true, None) => Frequencies::At(range.collect()),
            (true, Some(bias)) => Frequencies::AmongModes {
                range: [from, to],
                points: self.points,
                bias,
            },
        };
        Modal::Harmonic(HarmonicPlan {
            loads: loads.collect(),
            frequencies,
            damping: self.damping.clone().unwrap_or_default(),
            count: self.count,
            shapes: self.shapes,
        })
    }
}
