use std::f64::consts::PI;

use super::quantity;
use super::target::Target;
use super::written::{MM, MPA, Written, fill, number};
use crate::failure::Failure;
use crate::style::digits;

/// A bolt that is tightened, holds a sleeve on a base, and is pulled.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Diameter of the shank.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::length, allow_hyphen_values = true)]
    diameter: f64,
    /// Force to which it is tightened.
    #[arg(long, value_name = "FORCE", default_value = "20kN", value_parser = quantity::force, allow_hyphen_values = true)]
    preload: f64,
    /// Length that it grips.
    #[arg(long, value_name = "LENGTH", default_value = "40mm", value_parser = quantity::length, allow_hyphen_values = true)]
    grip: f64,
    /// Outer diameter of the sleeve; two and a half times that of the bolt if not given.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::length, allow_hyphen_values = true)]
    sleeve: Option<f64>,
    /// Force that pulls at the sleeve once the bolt is tight.
    #[arg(long, value_name = "FORCE", default_value = "5kN", value_parser = quantity::force, allow_hyphen_values = true)]
    pull: f64,
    /// Young's modulus of bolt and sleeve.
    #[arg(long, value_name = "STRESS", default_value = "210GPa", value_parser = quantity::stress, allow_hyphen_values = true)]
    young: f64,
    /// Poisson's ratio of both.
    #[arg(long, value_name = "NU", default_value = "0.3", value_parser = quantity::poisson)]
    poisson: f64,
    /// Yield stress of the bolt; property class 8.8 has 640 MPa (ISO 898-1).
    #[arg(long = "yield", value_name = "STRESS", default_value = "640MPa", value_parser = quantity::stress, allow_hyphen_values = true)]
    strength: f64,
    #[command(flatten)]
    pub(super) target: Target,
}

const PROBLEM: &str = include_str!("bolt.toml");

/// Hole and head of a bolt over its diameter: a hole of the medium series, a head of ISO 4017 as a disc.
const HOLE: f64 = 1.1;
const HEAD: f64 = 1.6;
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
    let title = format!(
        "a bolt of {} mm tightened to {} kN, pulled with {} kN",
        digits(a.diameter * MM, 4),
        digits(a.preload * 1e-3, 4),
        digits(a.pull * 1e-3, 4)
    );
    let mut written = Written {
        problem: problem(a, &joint, &title),
        title,
        ..Written::default()
    };
    tell(&mut written, a, &joint);
    written.check("the bolt is tightened", "screw.F", a.preload, 1e-6, "given");
    written.check(
        "and so is the joint pressed",
        "joint.CFN2",
        a.preload,
        1e-3,
        "equilibrium",
    );
    for check in &mut written.checks {
        check.at += "\nat = 1.0";
    }
    // Between none and all of the bolt's share, as the pull acts half way up the sleeve.
    let middle = 0.5 * joint.share * a.pull;
    let half = middle / (a.preload + middle) + 0.01;
    written.check(
        "force of the bolt in service",
        "screw.F",
        a.preload + middle,
        half,
        "bars: between none and all of k_b/(k_b + k_c) of the pull",
    );
    let left = a.preload + middle - a.pull;
    written.check(
        "what is left of the joint",
        "joint.CFN2",
        left,
        middle / left + 0.01,
        "equilibrium with the force of the bolt",
    );
    Ok(written)
}

fn joint(a: &Arguments) -> Result<Joint, Failure> {
    let shank = area(a.diameter, 0.0);
    let stress = a.preload / shank;
    let sleeve = a.sleeve.unwrap_or(2.5 * a.diameter);
    sound(a, stress, sleeve).map_err(|(message, help)| Failure::Arguments(message, help))?;
    // Of the sleeve what lies within the head and a cone of 30° to each end takes part (VDI 2230, in its plainest form).
    let cone = HEAD * a.diameter + a.grip * f64::tan(PI / 6.0);
    let pressed = area(sleeve.min(cone), HOLE * a.diameter);
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
    let hole = HOLE * a.diameter;
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

fn problem(a: &Arguments, j: &Joint, title: &str) -> String {
    let d = a.diameter;
    let mm = |x: f64| number(x * MM);
    let cells = |length: f64, size: f64| ((length / size).round().max(2.0) as u32).to_string();
    let size = d / 8.0;
    let wall = 0.5 * (j.sleeve - HOLE * d);
    // The pull acts along the outside of the sleeve.
    let traction = a.pull / (PI * j.sleeve * a.grip);
    fill(
        PROBLEM,
        &[
            ("title", title.to_string()),
            ("r", mm(0.5 * d)),
            ("deep", mm(d)),
            ("grip", mm(a.grip)),
            ("half-grip", mm(0.5 * a.grip)),
            ("head", mm(0.5 * HEAD * d)),
            ("top", mm(a.grip + HEAD_HEIGHT * d)),
            ("hole", mm(0.5 * HOLE * d)),
            ("sleeve", mm(0.5 * j.sleeve)),
            ("shank-cells", cells(a.grip + d, size)),
            ("head-cells", cells(0.5 * HEAD * d, size)),
            ("head-rows", cells(HEAD_HEIGHT * d, size)),
            ("wall-cells", cells(wall, size)),
            ("grip-cells", cells(a.grip, size)),
            ("young", number(a.young * MPA)),
            ("poisson", number(a.poisson)),
            ("traction", number(traction * MPA)),
            ("preload", number(a.preload)),
        ],
    )
}

fn tell(written: &mut Written, a: &Arguments, j: &Joint) {
    written.tell(
        "stress of the shank",
        format!(
            "{} MPa when tightened, {} % of the yield stress    4 F / (pi d^2)",
            digits(j.stress * MPA, 3),
            digits(100.0 * j.stress / a.strength, 2)
        ),
    );
    written.tell("bolt's share", format!("{} of a pull under the head, some half of it half way up (k_b / (k_b + k_c), bars and a cone of 30°)", digits(j.share, 2)));
    written.tell(
        "in service",
        format!(
            "bolt between {} and {} kN; joint left with that less {} kN",
            digits(a.preload * 1e-3, 4),
            digits((a.preload + j.share * a.pull) * 1e-3, 4),
            digits(a.pull * 1e-3, 4)
        ),
    );
    written.tell(
        "mesh",
        format!(
            "cells of {} mm, axisymmetric; forces are those of the full turn",
            digits(a.diameter * MM / 8.0, 3)
        ),
    );
}
