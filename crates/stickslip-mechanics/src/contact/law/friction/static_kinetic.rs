use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::normal::{not_negative, positive};
use crate::registry::Samples;

/// Static and kinetic friction: limit `μ_s p` for a point that stuck or was open at the last accepted state, `μ_k p` for one
/// that slid, at most `cap`. See [Oden and Martins 1985](stickslip_base::references::oden_martins_1985).
///
/// The limit jumps between two increments, never within one: a point that lets go carries `μ_s p` to the end of its
/// increment and drops to `μ_k p` in the next. So the increments say how soon after the start of slip the jump comes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StaticKinetic {
    /// Coefficient of static friction μ_s `[-]`.
    pub r#static: f64,
    /// Coefficient of kinetic friction μ_k `[-]`, at most `static`.
    pub kinetic: f64,
    /// Largest shear traction `[Pa]`, e.g. the shear yield stress. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cap: Option<f64>,
}

impl FrictionLaw for StaticKinetic {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let mu = if at.sticking {
            self.r#static
        } else {
            self.kinetic
        };
        Limit {
            value: mu * at.pressure,
            d_pressure: mu,
            ..Limit::default()
        }
        .capped(self.cap)
    }

    fn frictional(&self) -> bool {
        self.r#static > 0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = [("static", self.r#static), ("kinetic", self.kinetic)]
            .into_iter()
            .filter_map(|(key, value)| not_negative(key, value))
            .collect();
        // the other way round a point that lets go would be held at once, and let go again
        if faults.is_empty() && self.kinetic > self.r#static {
            let message = format!(
                "must not be larger than `static`, {}, but is {}",
                self.r#static, self.kinetic
            );
            faults.push(("kinetic", message));
        }
        faults.extend(self.cap.and_then(|cap| positive("cap", cap)));
        faults
    }
}

impl Samples for StaticKinetic {
    fn samples() -> Vec<Self> {
        vec![
            StaticKinetic {
                r#static: 0.5,
                kinetic: 0.3,
                cap: None,
            },
            StaticKinetic {
                r#static: 0.4,
                kinetic: 0.25,
                cap: Some(1e7),
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_that_slid_carries_less() {
        // VERIFICATION S1: a mass pressed with 10 N on a belt lets go at 5 N and slides at 3 N
        let law = StaticKinetic::samples()[0];
        let at = |sticking| FrictionPoint {
            pressure: 10.0,
            speed: 0.1,
            sticking,
            ..FrictionPoint::default()
        };
        assert_eq!(law.limit(&at(true)).value, 5.0);
        assert_eq!(law.limit(&at(false)).value, 3.0);
        let capped = StaticKinetic {
            cap: Some(4.0),
            ..law
        };
        assert_eq!(capped.limit(&at(true)).value, 4.0);
        assert_eq!(capped.limit(&at(true)).d_pressure, 0.0);
        assert_eq!(capped.limit(&at(false)).value, 3.0);
    }

    #[test]
    fn faults_name_the_parameter() {
        let faults = |r#static, kinetic, cap| {
            let law = StaticKinetic {
                r#static,
                kinetic,
                cap,
            };
            let keys = law.faults().into_iter().map(|(key, _)| key);
            keys.collect::<Vec<_>>()
        };
        assert!(faults(0.3, 0.3, None).is_empty());
        assert_eq!(faults(-0.5, 0.3, None), ["static"]);
        assert_eq!(faults(f64::NAN, -0.3, None), ["static", "kinetic"]);
        assert_eq!(faults(0.3, 0.5, Some(0.0)), ["kinetic", "cap"]);
    }
}
