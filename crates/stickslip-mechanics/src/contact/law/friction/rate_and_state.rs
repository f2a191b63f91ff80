use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, LawState, Limit, StateVariable};
use super::profile::Profile;
use crate::contact::law::normal::{not_negative, positive};
use crate::math::Vec3;
use crate::registry::Samples;

/// Rate-and-state friction of [Dieterich 1979](stickslip_base::references::dieterich_1979) and [Ruina 1983](stickslip_base::references::ruina_1983), regularised at low speed as by
/// [Rice, Lapusta and Ranjith 2001](stickslip_base::references::rice_2001): shear
/// `p a asinh(V/(2 V₀) exp((f₀ + b ln(V₀ θ/D_c))/a)) + η V` at the sliding velocity V. The state θ is about the time for which contacts of roughness last:
/// they heal while surfaces rest and are renewed over the way `D_c`.
///
/// Surfaces under this law always slide, however slowly: the slip rule is not asked, and V is of any size. V and θ at the end of an increment are solved together
/// with it; both are fields of results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RateAndState {
    /// Coefficient of friction in steady sliding at `v0` `[-]`.
    pub f0: f64,
    /// Direct effect a `[-]`: by how much friction rises with ln V at once.
    pub a: Profile,
    /// Evolution effect b `[-]`: by how much it falls with it after the way `dc`. Sliding can be unstable where `b > a`.
    pub b: Profile,
    /// Way `D_c` over which the state is renewed `[m]`.
    pub dc: Profile,
    /// Reference velocity V₀ `[m/s]`.
    pub v0: f64,
    /// How the state changes. Default: `ageing`.
    #[serde(default)]
    pub evolution: Evolution,
    /// Radiation damping η `[Pa s/m]`: shear modulus over twice the speed of shear waves, where waves that sliding sends off are not computed. Default: 0.
    #[serde(default)]
    pub eta: f64,
    /// Sliding velocity at the start `[m/s]`.
    pub velocity: Profile,
    /// State θ at the start `[s]`. Default: `dc` over `velocity`, that of steady sliding.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta: Option<Profile>,
    /// Instead of `theta`: shear over pressure at the start `[-]`, radiation damping left out. θ is what carries it at `velocity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Profile>,
}

/// How the state of rate-and-state friction changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Evolution {
    /// `dθ/dt = 1 - V θ/D_c`: contacts heal at rest too.
    #[default]
    Ageing,
    /// `dθ/dt = -(V θ/D_c) ln(V θ/D_c)`: the state changes by sliding alone.
    Slip,
}

const STATES: [StateVariable; 2] = [
    StateVariable {
        name: "THETA",
        unit: "s",
    },
    StateVariable {
        name: "V",
        unit: "m/s",
    },
];

/// Parameters at a point.
struct Here {
    a: f64,
    b: f64,
    dc: f64,
}

/// A value, and its derivative with respect to the mean velocity over the increment.
#[derive(Debug, Clone, Copy)]
struct Varying {
    value: f64,
    slope: f64,
}

impl RateAndState {
    fn here(&self, place: Vec3) -> Here {
        Here {
            a: self.a.at(place),
            b: self.b.at(place),
            dc: self.dc.at(place),
        }
    }

    /// The coefficient at a velocity and the logarithm of `V₀ θ/D_c`, and its derivative with respect to the logarithm of the velocity.
    fn coefficient(&self, here: &Here, velocity: f64, state: f64) -> (f64, f64) {
        // The argument of asinh overflows where `a` is small: its logarithm does not.
        let y = (velocity / (2.0 * self.v0)).ln() + (self.f0 + here.b * state) / here.a;
        let asinh = match y > 20.0 {
            // asinh x = ln 2x + 1/(4 x²) - ...
            true => y + std::f64::consts::LN_2,
            false => y.exp().asinh(),
        };
        (here.a * asinh, here.a / (1.0 + (-2.0 * y).exp()).sqrt())
    }

    /// The velocity at the end of an increment with a mean velocity.
    fn end_velocity(at: &FrictionPoint, before: f64) -> Varying {
        match at.speed_at_end || at.dt == 0.0 || before <= 0.0 {
            true => Varying {
                value: at.speed,
                slope: 1.0,
            },
            false => end_of(at.speed, before),
        }
    }

    /// The mean velocity of an increment: the logarithmic mean of those at its ends.
    fn mean_velocity(at: &FrictionPoint, before: f64) -> Varying {
        match at.speed_at_end && before > 0.0 {
            true => mean_of(at.speed, before),
            false => Varying {
                value: at.speed,
                slope: 1.0,
            },
        }
    }

    /// The logarithm of `V₀ θ/D_c` at the end of an increment with a mean velocity: the law of evolution is solved exactly at that velocity.
    fn evolved(&self, here: &Here, theta: f64, dt: f64, mean: Varying) -> Varying {
        let x = mean.value * dt / here.dc;
        let by_mean = mean.slope * dt / here.dc;
        let decay = (-x).exp();
        match self.evolution {
            Evolution::Ageing => {
                // θ e^-x + dt (1 - e^-x)/x
                let (part, slope) = one_minus_exp(x);
                let end = theta * decay + dt * part;
                Varying {
                    value: (self.v0 * end / here.dc).ln(),
                    slope: (dt * slope - theta * decay) / end * by_mean,
                }
            }
            Evolution::Slip if mean.value == 0.0 => Varying {
                value: (self.v0 * theta / here.dc).ln(),
                slope: 0.0,
            },
            Evolution::Slip => {
                // ln θ goes to ln (D_c/V) as e^-x.
                let steady = (self.v0 / mean.value).ln();
                let off = (self.v0 * theta / here.dc).ln() - steady;
                let d_steady = -mean.slope / mean.value;
                Varying {
                    value: steady + off * decay,
                    slope: d_steady * (1.0 - decay) - off * decay * by_mean,
                }
            }
        }
    }
}

/// `(1 - e^-x)/x` and its derivative.
fn one_minus_exp(x: f64) -> (f64, f64) {
    if x < 1e-3 {
        // Its series, of which the next term is x⁴/120.
        let value = 1.0 - x / 2.0 + x * x / 6.0 - x * x * x / 24.0;
        return (value, -0.5 + x / 3.0 - x * x / 8.0 + x * x * x / 30.0);
    }
    let value = -(-x).exp_m1() / x;
    (value, ((-x).exp() - value) / x)
}

/// `(e^y - 1)/y`, the logarithmic mean of 1 and `e^y`, and its derivative.
fn growth(y: f64) -> (f64, f64) {
    if y.abs() < 1e-2 {
        let value = 1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y / 120.0)));
        let slope = 0.5 + y * (1.0 / 3.0 + y * (0.125 + y * (1.0 / 30.0 + y / 144.0)));
        return (value, slope);
    }
    let value = y.exp_m1() / y;
    (value, (y.exp() - value) / y)
}

/// Iterations by which a logarithm of velocities is found to rounding.
const LOGARITHM_ITERATIONS: usize = 60;

/// The velocity at the end of an increment whose logarithmic mean with that `before` is `mean`.
fn end_of(mean: f64, before: f64) -> Varying {
    let ratio = mean / before;
    if ratio < 1.0 / 700.0 {
        // e^(-1/ratio) is no number of this machine.
        return Varying {
            value: 0.0,
            slope: 0.0,
        };
    }
    // ln((e^y - 1)/y) = ln ratio, convex and rising in y: Newton's method comes from the right.
    let mut y = match ratio < 1.0 {
        true => -1.0 / ratio,
        false => 2.0 * ratio.ln(),
    };
    for _ in 0..LOGARITHM_ITERATIONS {
        let (value, slope) = growth(y);
        let step = (value / ratio).ln() * value / slope;
        y -= step;
        if step.abs() <= 1e-15 * y.abs() {
            break;
        }
    }
    let end = before * y.exp();
    Varying {
        value: end,
        slope: y.exp() / growth(y).1,
    }
}

/// The logarithmic mean of two velocities, and its derivative with respect to the one at the end.
fn mean_of(end: f64, before: f64) -> Varying {
    if end <= 0.0 {
        return Varying {
            value: 0.0,
            slope: 0.0,
        };
    }
    let y = (end / before).ln();
    let (value, slope) = growth(y);
    Varying {
        value: before * value,
        slope: slope * (-y).exp(),
    }
}

impl FrictionLaw for RateAndState {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let here = self.here(at.place);
        let [theta, before, ..] = at.state;
        let end = Self::end_velocity(at, before);
        let state = self.evolved(&here, theta, at.dt, Self::mean_velocity(at, before));
        let theta = here.dc / self.v0 * state.value.exp();
        if end.value <= 0.0 {
            // A velocity that is too small for a number carries nothing.
            return Limit {
                state: [theta, 0.0, 0.0, 0.0],
                ..Limit::default()
            };
        }
        let (mu, by_log) = self.coefficient(&here, end.value, state.value);
        let d_mu = by_log * (end.slope / end.value + here.b / here.a * state.slope);
        Limit {
            value: mu * at.pressure + self.eta * end.value,
            d_pressure: mu,
            d_penetration: 0.0,
            d_speed: d_mu * at.pressure + self.eta * end.slope,
            state: [theta, end.value, 0.0, 0.0],
        }
    }

    fn states(&self) -> &'static [StateVariable] {
        &STATES
    }

    fn flows(&self) -> bool {
        true
    }

    fn speed_in(&self, state: &LawState) -> Option<f64> {
        Some(state[1])
    }

    fn typical_speed(&self) -> f64 {
        self.v0
    }

    fn initial_state(&self, place: Vec3) -> LawState {
        let here = self.here(place);
        let velocity = self.velocity.at(place);
        let theta = match (&self.theta, &self.ratio) {
            (Some(theta), _) => theta.at(place),
            (None, Some(ratio)) => {
                // ln(2 V₀/V sinh(ratio/a)), whose sinh may overflow
                let y = ratio.at(place) / here.a;
                let ln_sinh = y + (-(-2.0 * y).exp()).ln_1p() - std::f64::consts::LN_2;
                let state = here.a * ((2.0 * self.v0 / velocity).ln() + ln_sinh) - self.f0;
                here.dc / self.v0 * (state / here.b).exp()
            }
            (None, None) => here.dc / velocity,
        };
        [theta, velocity, 0.0, 0.0]
    }

    fn open_state(&self, state: &LawState, dt: f64) -> LawState {
        let [theta, velocity, ..] = *state;
        match self.evolution {
            Evolution::Ageing => [theta + dt, velocity, 0.0, 0.0],
            Evolution::Slip => *state,
        }
    }

    fn rate_of_change(&self, state: &LawState, place: Vec3) -> f64 {
        let here = self.here(place);
        let [theta, velocity, ..] = *state;
        let renewal = velocity / here.dc;
        let healing = match self.evolution {
            Evolution::Ageing => (1.0 / theta - renewal).abs(),
            Evolution::Slip => (renewal * (renewal * theta).max(f64::MIN_POSITIVE).ln()).abs(),
        };
        renewal.max(healing)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let one = [
            not_negative("f0", self.f0),
            positive("v0", self.v0),
            not_negative("eta", self.eta),
            self.a.fault("a", positive),
            self.b.fault("b", positive),
            self.dc.fault("dc", positive),
            self.velocity.fault("velocity", positive),
            self.theta.as_ref().and_then(|p| p.fault("theta", positive)),
            self.ratio.as_ref().and_then(|p| p.fault("ratio", positive)),
        ];
        let both = (self.theta.is_some() && self.ratio.is_some()).then(|| {
            let message = "excludes `theta`, as one follows from the other";
            ("ratio", message.to_string())
        });
        one.into_iter().flatten().chain(both).collect()
    }
}

impl Samples for RateAndState {
    fn samples() -> Vec<Self> {
        let law = RateAndState {
            f0: 0.6,
            a: Profile::Constant(0.01),
            b: Profile::Constant(0.015),
            dc: Profile::Constant(8e-3),
            v0: 1e-6,
            evolution: Evolution::Ageing,
            eta: 0.0,
            velocity: Profile::Constant(1e-9),
            theta: None,
            ratio: None,
        };
        vec![
            law.clone(),
            RateAndState {
                evolution: Evolution::Slip,
                eta: 4.6e6,
                ratio: Some(Profile::Constant(0.53)),
                ..law
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of all kinds: locked, creeping and fast, speeding up and slowing down over the increment.
    fn points() -> Vec<FrictionPoint> {
        let mut points = Vec::new();
        for (theta, before, dt) in [(1e9, 1e-17, 1e6), (8e6, 1e-9, 1e5), (1e-2, 0.8, 1e-3)] {
            for change in [0.2, 0.9, 0.999_999, 1.0, 1.000_01, 1.3, 40.0] {
                for speed_at_end in [true, false] {
                    points.push(FrictionPoint {
                        pressure: 5e7,
                        speed: before * change,
                        speed_at_end,
                        dt,
                        state: [theta, before, 0.0, 0.0],
                        ..FrictionPoint::default()
                    });
                }
            }
        }
        points
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for law in RateAndState::samples() {
            for at in points() {
                let limit = law.limit(&at);
                let h = 1e-5;
                let value = |speed: f64| {
                    let mut moved = at;
                    moved.speed = speed;
                    law.limit(&moved).value
                };
                let ends = [value(at.speed * (1.0 - h)), value(at.speed * (1.0 + h))];
                let slope = (ends[1] - ends[0]) / (2.0 * h * at.speed);
                let rounding = 4.0 * f64::EPSILON * limit.value / (h * at.speed);
                assert!(
                    (limit.d_speed - slope).abs() <= 1e-7 * slope.abs() + rounding,
                    "{at:?}: {} {slope}",
                    limit.d_speed
                );
                assert!(limit.state[0] > 0.0 && limit.state[1] > 0.0, "{at:?}");
            }
        }
    }

    /// A step of the velocity at infinite stiffness: the state goes to that of the new velocity over the way `D_c`, and friction jumps before it falls.
    #[test]
    fn a_velocity_step_has_its_peak_and_its_end() {
        let law = RateAndState {
            dc: Profile::Constant(1e-5),
            velocity: Profile::Constant(1e-6),
            ..RateAndState::samples().remove(0)
        };
        let state = law.initial_state([0.0; 3]);
        let at = |dt: f64, state: LawState| {
            law.limit(&FrictionPoint {
                pressure: 1.0,
                speed: 1e-5,
                speed_at_end: true,
                dt,
                state,
                ..FrictionPoint::default()
            })
        };
        let peak = at(0.0, state).value;
        assert!((peak - 0.623_025_850_9).abs() < 1e-10, "{peak}");
        let (mut now, mut t) = ([state[0], 1e-5, 0.0, 0.0], 0.0);
        for _ in 0..40 {
            now = at(0.25, now).state;
            t += 0.25;
            let theta = 1.0 + 9.0 * f64::exp(-t);
            assert!((now[0] / theta - 1.0).abs() < 1e-13, "{t}: {}", now[0]);
        }
        let end = at(1e3, now).value;
        assert!((end - 0.588_487_074_5).abs() < 1e-10, "{end}");
    }

    /// Both laws of evolution agree with a numerical solution at a velocity that does not change.
    #[test]
    fn the_state_follows_its_law() {
        for evolution in [Evolution::Ageing, Evolution::Slip] {
            let law = RateAndState {
                evolution,
                ..RateAndState::samples().remove(0)
            };
            let (velocity, dc, dt): (f64, f64, f64) = (3e-4, 8e-3, 20.0);
            let mut theta: f64 = 100.0;
            let rate = |theta: f64| {
                let ratio = velocity * theta / dc;
                match evolution {
                    Evolution::Ageing => 1.0 - ratio,
                    Evolution::Slip => -ratio * ratio.ln(),
                }
            };
            let parts = 4000;
            let h = dt / f64::from(parts);
            for _ in 0..parts {
                let k1 = rate(theta);
                let k2 = rate(theta + 0.5 * h * k1);
                let k3 = rate(theta + 0.5 * h * k2);
                let k4 = rate(theta + h * k3);
                theta += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            }
            let found = law.limit(&FrictionPoint {
                pressure: 1.0,
                speed: velocity,
                dt,
                state: [100.0, velocity, 0.0, 0.0],
                ..FrictionPoint::default()
            });
            assert!(
                (found.state[0] / theta - 1.0).abs() < 1e-10,
                "{evolution:?}"
            );
        }
    }

    /// The state at the start carries the shear that is given, at the velocity that is given.
    #[test]
    fn the_start_carries_its_shear() {
        for ratio in [0.3, 0.53, 0.9] {
            let law = RateAndState {
                ratio: Some(Profile::Constant(ratio)),
                ..RateAndState::samples().remove(0)
            };
            let state = law.initial_state([0.0; 3]);
            let found = law.limit(&FrictionPoint {
                pressure: 1.0,
                speed: 1e-9,
                state,
                ..FrictionPoint::default()
            });
            assert!(
                (found.value - ratio).abs() < 1e-12,
                "{ratio}: {}",
                found.value
            );
        }
    }

    #[test]
    fn velocities_at_the_end_have_the_mean_of_the_increment() {
        for ratio in [2e-3, 0.3, 1.0 - 1e-9, 1.0 + 1e-7, 1.7, 1e9] {
            let end = end_of(ratio * 1e-9, 1e-9);
            let mean = mean_of(end.value, 1e-9);
            let off = mean.value / (ratio * 1e-9) - 1.0;
            assert!(end.value == 0.0 || off.abs() < 1e-12, "{ratio}: {off:e}");
            let product = mean.slope * end.slope;
            assert!(
                end.value == 0.0 || (product - 1.0).abs() < 1e-9,
                "{ratio}: {product}"
            );
        }
    }
}
