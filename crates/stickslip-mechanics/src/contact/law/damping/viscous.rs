use serde::{Deserialize, Serialize};

use super::law::{Extra, NormalDamping};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// A dashpot: extra pressure proportional to the velocity at which the surfaces approach.
///
/// It acts in full from the first touch: surfaces that meet at a velocity feel a jump of pressure, and surfaces that part
/// lose contact before the gap opens. [Hunt and Crossley 1975](stickslip_base::references::hunt_crossley_1975) avoid both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Viscous {
    /// Pressure per closing velocity `[Pa s/m]`.
    pub coefficient: f64,
}

impl NormalDamping for Viscous {
    fn extra(&self, _pressure: f64, rate: f64) -> Extra {
        Extra {
            value: self.coefficient * rate,
            d_pressure: 0.0,
            d_rate: self.coefficient,
        }
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        positive("coefficient", self.coefficient)
            .into_iter()
            .collect()
    }
}

impl Samples for Viscous {
    fn samples() -> Vec<Self> {
        vec![Viscous { coefficient: 2e6 }]
    }
}
