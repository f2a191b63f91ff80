use std::f64::consts::PI;

use super::quantity::{self, FORCE, LENGTH, STRESS};
use super::target::Target;
use super::written::{MM, MPA, Values, Written};
use crate::failure::Failure;
use stickslip::number::digits;

/// A bolt that clamps a sleeve on a base, tightened and then loaded.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Diameter of the shank.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    diameter: f64,
    /// Preload of the bolt.
    #[arg(long, value_name = "FORCE", default_value = "20kN", value_parser = quantity::of(FORCE), allow_hyphen_values = true)]
    preload: f64,
    /// Grip length.
    #[arg(long, value_name = "LENGTH", default_value = "40mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    grip: f64,
    /// Outer diameter of the sleeve; default: 2.5 bolt diameters.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    sleeve: Option<f64>,
    /// Pulling force on the sleeve after tightening.
    #[arg(long, value_name = "FORCE", default_value = "5kN", value_parser = quantity::of(FORCE), allow_hyphen_values = true)]
    pull: f64,
    /// Young's modulus of bolt and sleeve.
    #[arg(long, value_name = "STRESS", default_value = "210GPa", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    young: f64,
    /// Poisson's ratio of both.
    #[arg(long, value_name = "NU", default_value = "0.3", value_parser = quantity::poisson)]
    poisson: f64,
    /// Yield stress of the bolt; property class 8.8 has 640 MPa (ISO 898-1).
    #[arg(long = "yield", value_name = "STRESS", default_value = "640MPa", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    strength: f64,
    #[command(flatten)]
    pub(super) target: Target,
}

const TEMPLATE: &str = include_str!("bolt.template");

/// Diameter of the hole over that of the bolt: the medium series.
const HOLE_DIAMETER: f64 = 1.1;
/// Diameter of the head of a bolt, as a disc, over that of the bolt (ISO 4017).
const HEAD_DIAMETER: f64 = 1.6;
/// Height of the head of a bolt over the diameter of the bolt (ISO 4017).
const HEAD_HEIGHT: f64 = 0.65;

/// Bars: what bolt and sleeve do, with the head rigid.
struct Joint {
    sleeve: f64,
    /// Stress of the shank `[Pa]`.
    stress: f64,
    /// Bolt's part of a pull at the end of the sleeve under the head, `k_b / (k_b + k_c)`.
    share: f64,
}

fn area(outer: f64, inner: f64) -> f64 {
    0.25 * PI * (outer * outer - inner * inner)
}

/// The problem and what is expected of it.
///
/// # Errors
/// A bolt that yields, a sleeve that the head does not press, a joint that opens.
pub fn write(a: &Arguments) -> Result<Written, Failure> {
    let joint = joint(a)?;
    let d = a.diameter;
    let cells = |length: f64| (length / (d / 8.0)).round().max(2.0);
    // The pull acts along the outside of the sleeve.
    let traction = a.pull / (PI * joint.sleeve * a.grip);
    // Between none and all of the bolt's share, as the pull acts half way up the sleeve.
    let middle = 0.5 * joint.share * a.pull;
    let left = a.preload + middle - a.pull;
    let numbers = [
        ("diameter", d * MM),
        ("preload", a.preload),
        ("preload-kN", a.preload * 1e-3),
        ("pull-kN", a.pull * 1e-3),
        ("most-kN", (a.preload + joint.share * a.pull) * 1e-3),
        ("stress", joint.stress * MPA),
        ("strained", 100.0 * joint.stress / a.strength),
        ("share", joint.share),
        ("size", d * MM / 8.0),
        ("service", a.preload + middle),
        ("service-error", middle / (a.preload + middle) + 0.01),
        ("left", left),
        ("left-error", middle / left + 0.01),
        ("r", 0.5 * d * MM),
        ("grip", a.grip * MM),
        ("half-grip", 0.5 * a.grip * MM),
        ("head", 0.5 * HEAD_DIAMETER * d * MM),
        ("top", (a.grip + HEAD_HEIGHT * d) * MM),
        ("hole", 0.5 * HOLE_DIAMETER * d * MM),
        ("sleeve", 0.5 * joint.sleeve * MM),
        ("shank-cells", cells(a.grip + d)),
        ("head-cells", cells(0.5 * HEAD_DIAMETER * d)),
        ("head-rows", cells(HEAD_HEIGHT * d)),
        (
            "wall-cells",
            cells(0.5 * (joint.sleeve - HOLE_DIAMETER * d)),
        ),
        ("grip-cells", cells(a.grip)),
        ("young", a.young * MPA),
        ("poisson", a.poisson),
        ("traction", traction * MPA),
    ];
    Ok(Written::of(
        TEMPLATE,
        &Values {
            numbers: &numbers,
            ..Values::default()
        },
    ))
}

fn joint(a: &Arguments) -> Result<Joint, Failure> {
    let shank = area(a.diameter, 0.0);
    let stress = a.preload / shank;
    let sleeve = a.sleeve.unwrap_or(2.5 * a.diameter);
    sound(a, stress, sleeve).map_err(|(message, help)| Failure::Arguments(message, help))?;
    // Of the sleeve what lies within the head and a cone of 30° to each end takes part (VDI 2230, in its plainest form).
    let cone = HEAD_DIAMETER * a.diameter + a.grip * f64::tan(PI / 6.0);
    let pressed = area(sleeve.min(cone), HOLE_DIAMETER * a.diameter);
    // The shank goes on below the joint to where it is held.
    let bolt = shank / (a.grip + a.diameter);
    let share = bolt / (bolt + pressed / a.grip);
    Ok(Joint {
        sleeve,
        stress,
        share,
    })
}

/// What is wrong with the numbers, and what would do.
fn sound(a: &Arguments, stress: f64, sleeve: f64) -> Result<(), (String, String)> {
    let mm = |x: f64| digits(x * MM, 3);
    let kilo = |force: f64| digits(force * 1e-3, 3);
    let hole = HOLE_DIAMETER * a.diameter;
    if stress > a.strength {
        let (found, most) = (stress * MPA, a.strength * MPA);
        return Err((
            format!(
                "the shank would be stressed to {found:.0} MPa by the preload alone, above its yield stress of {most:.0} MPa"
            ),
            format!(
                "at most {} kN, a thicker bolt, or another `--yield`",
                kilo(a.strength / stress * a.preload)
            ),
        ));
    }
    if sleeve < 1.3 * hole {
        return Err((
            format!(
                "the sleeve of {} mm is hardly wider than its hole of {} mm",
                mm(sleeve),
                mm(hole)
            ),
            format!("a sleeve of {} mm or more", mm(1.3 * hole)),
        ));
    }
    if a.grip < 0.5 * a.diameter {
        return Err((
            format!(
                "a grip of {} mm is shorter than half of the diameter: nothing of the bolt is a bar",
                mm(a.grip)
            ),
            "a longer grip".into(),
        ));
    }
    if a.pull > 0.9 * a.preload {
        return Err((
            format!("a pull of {} kN opens the joint, or nearly", kilo(a.pull)),
            format!(
                "at most nine tenths of the preload: {} kN",
                kilo(0.9 * a.preload)
            ),
        ));
    }
    Ok(())
}
