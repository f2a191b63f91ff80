use std::f64::consts::TAU;

use super::quantity::{self, FORCE, LINE_LOAD, MASS, SPEED};
use super::target::Target;
use super::written::{Values, Written};
use crate::failure::Failure;
use stickslip::number::digits;

/// A mass on a spring on a moving belt, with static and kinetic friction: stick-slip.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Mass.
    #[arg(long, value_name = "MASS", default_value = "1kg", value_parser = quantity::of(MASS), allow_hyphen_values = true)]
    mass: f64,
    /// Normal force on the belt.
    #[arg(long, value_name = "FORCE", default_value = "10N", value_parser = quantity::of(FORCE), allow_hyphen_values = true)]
    load: f64,
    /// Stiffness of the spring.
    #[arg(long, value_name = "FORCE/LENGTH", default_value = "100N/m", value_parser = quantity::of(LINE_LOAD), allow_hyphen_values = true)]
    stiffness: f64,
    /// Velocity of the belt.
    #[arg(long, value_name = "VELOCITY", default_value = "0.1m/s", value_parser = quantity::of(SPEED), allow_hyphen_values = true)]
    speed: f64,
    /// Coefficient of friction at rest.
    #[arg(long = "static", value_name = "MU", default_value = "0.5", value_parser = quantity::friction)]
    rest: f64,
    /// Coefficient of friction in motion, lower than at rest.
    #[arg(long, value_name = "MU", default_value = "0.3", value_parser = quantity::friction)]
    kinetic: f64,
    /// Cycles of stick and slip.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    cycles: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const TEMPLATE: &str = include_str!("belt.template");

/// The closed solution: the mass sticks to the belt, lets go at `F_s/k`, and swings about `F_k/k` until its velocity is that of the belt again.
struct Cycle {
    /// `F_k/k` `[m]`.
    middle: f64,
    /// `(F_s - F_k)/k` `[m]`.
    reach: f64,
    /// `[rad/s]`
    omega: f64,
    /// `[s]`
    stick: f64,
    /// `[s]`
    slip: f64,
    /// Amplitude of the swing about `middle` `[m]`.
    swing: f64,
}

impl Cycle {
    fn of(a: &Arguments) -> Self {
        let middle = a.kinetic * a.load / a.stiffness;
        let reach = (a.rest - a.kinetic) * a.load / a.stiffness;
        let omega = (a.stiffness / a.mass).sqrt();
        let stick = 2.0 * reach / a.speed;
        let slip = (TAU - 2.0 * (omega * reach / a.speed).atan()) / omega;
        let swing = reach.hypot(a.speed / omega);
        Cycle {
            middle,
            reach,
            omega,
            stick,
            slip,
            swing,
        }
    }
}

/// Times of stick or of a swing over each other from which on one of them needs increments that the other does not: the
/// longer one of 200 periods takes 60 000 increments of the other.
const UNEVEN_TIMES: f64 = 200.0;

/// The problem and what is expected of it.
///
/// # Errors
/// Friction that does not fall, and times of stick and slip that are too far apart.
pub fn write(a: &Arguments) -> Result<Written, Failure> {
    if a.kinetic >= a.rest {
        return Err(Failure::Arguments(
            format!(
                "friction of {} in motion is no less than {} at rest: the mass would come to rest in the belt's pull",
                a.kinetic, a.rest
            ),
            "a `--kinetic` below `--static`".into(),
        ));
    }
    let cycle = Cycle::of(a);
    let period = TAU / cycle.omega;
    if cycle.stick > UNEVEN_TIMES * period {
        return Err(Failure::Arguments(
            format!(
                "the mass would stick for {} s and slip for {} s: too far apart for increments of one size",
                digits(cycle.stick, 3),
                digits(cycle.slip, 3)
            ),
            format!(
                "a belt that is faster than {} m/s, or a softer spring",
                digits(2.0 * cycle.reach / (UNEVEN_TIMES * period), 3)
            ),
        ));
    }
    // Tolerances are relative to body and pressure: both are of a size that suits the motion.
    let width = 50.0 * cycle.reach;
    let pressure = a.load / width;
    let cycles = f64::from(a.cycles);
    // It begins as it begins to stick, and ends in the middle of a stick.
    let duration = cycles * (cycle.stick + cycle.slip) + 0.5 * cycle.stick;
    let (upstream, downstream) = (cycle.middle - cycle.swing, cycle.middle + cycle.swing);
    let error = |x: f64| 1e-3 * cycle.swing / x.abs().max(1e-3 * cycle.swing);
    let slip_path = a.speed * cycle.slip + 2.0 * cycle.reach;
    let numbers = [
        ("mass", a.mass),
        ("speed", a.speed),
        ("stiffness", a.stiffness),
        ("stick", cycle.stick),
        ("slip", cycle.slip),
        ("omega", cycle.omega),
        ("upstream", upstream),
        ("upstream-error", error(upstream)),
        ("downstream", downstream),
        ("downstream-error", error(downstream)),
        ("loss", cycles * a.kinetic * a.load * slip_path),
        ("half", 0.5 * width),
        ("height", 0.2 * width),
        ("young", 1e5 * pressure),
        ("density", a.mass / (0.2 * width * width)),
        ("static", a.rest),
        ("kinetic", a.kinetic),
        ("pressure", pressure),
        ("spring", 0.5 * a.stiffness),
        ("start", cycle.middle - cycle.reach),
        ("press", 1e-5 * period),
        ("duration", duration),
        ("part", period / 300.0 / duration),
        ("least", 1e-6 * period / duration),
        ("event", 1e-5 * period),
    ];
    Ok(Written::of(
        TEMPLATE,
        &Values {
            numbers: &numbers,
            ..Values::default()
        },
    ))
}
