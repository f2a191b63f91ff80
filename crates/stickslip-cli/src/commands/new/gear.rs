use std::f64::consts::PI;

use super::quantity;
use super::target::Target;
use super::written::{MM, MPA, Written, fill, number};
use crate::failure::Failure;
use crate::style::digits;

/// Two spur gears that turn through two pitches under a torque.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Teeth of the pinion, which drives.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(5..=200))]
    teeth: u32,
    /// Teeth of the wheel.
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(5..=200))]
    wheel: u32,
    /// Module: pitch diameter over number of teeth.
    #[arg(long, value_name = "LENGTH", default_value = "2mm", value_parser = quantity::length, allow_hyphen_values = true)]
    module: f64,
    /// Width of the teeth.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::length, allow_hyphen_values = true)]
    width: f64,
    /// Torque that holds the wheel back.
    #[arg(long, value_name = "TORQUE", default_value = "20Nm", value_parser = quantity::torque, allow_hyphen_values = true)]
    torque: f64,
    /// Young's modulus of both.
    #[arg(long, value_name = "STRESS", default_value = "210GPa", value_parser = quantity::stress, allow_hyphen_values = true)]
    young: f64,
    /// Poisson's ratio of both.
    #[arg(long, value_name = "NU", default_value = "0.3", value_parser = quantity::poisson)]
    poisson: f64,
    /// Cells along a flank.
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u32).range(40..=400))]
    cells: u32,
    /// Positions in each of the two pitches.
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(8..=1000))]
    positions: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const PROBLEM: &str = include_str!("gear.toml");

/// Pressure angle, height of a tooth above and depth of a gap below the pitch circle, over the module: those of the generator.
const PRESSURE_ANGLE: f64 = 20.0 * PI / 180.0;
const ADDENDUM: f64 = 1.0;
const DEDENDUM: f64 = 1.25;
/// Play over the module.
const BACKLASH: f64 = 0.025;
/// Stiffness of a pair of teeth of steel per width, about, over Young's modulus `[-]`: 14 N/(mm µm) (ISO 6336-1).
const STIFFNESS: f64 = 14e9 / 2.1e11;
const PITCHES: u32 = 2;
/// Ratios of the torques are off by less with 80 cells along a flank, where a tip comes in too; the error is that of chains of straight edges.
const OFF: f64 = 5e-3;

/// Circles of a pair `[m]`.
struct Pair {
    pitch: [f64; 2],
    base: [f64; 2],
    centres: f64,
    /// Pairs of teeth in contact, in the mean.
    ratio: f64,
}

impl Pair {
    /// # Errors
    /// Teeth that do not hand over, and tips that reach below the involute of the other gear.
    fn of(a: &Arguments) -> Result<Self, Failure> {
        let teeth = [a.teeth, a.wheel].map(f64::from);
        let pitch = teeth.map(|z| 0.5 * a.module * z);
        let base = pitch.map(|r| r * PRESSURE_ANGLE.cos());
        let centres = pitch[0] + pitch[1];
        // Along the line of action: where it leaves the base circles, and to the tips.
        let whole = centres * PRESSURE_ANGLE.sin();
        let tips = [0, 1].map(|i| {
            let tip = pitch[i] + ADDENDUM * a.module;
            (tip * tip - base[i] * base[i]).sqrt()
        });
        if tips[0].max(tips[1]) > whole {
            let least = [a.teeth, a.wheel].into_iter().min().unwrap_or(0);
            return Err(Failure::Arguments(
                format!(
                    "with {least} teeth the tips of the other gear reach below the base circle, where there is no involute"
                ),
                "17 teeth or more, or two gears with nearly as many teeth each".into(),
            ));
        }
        let ratio = (tips[0] + tips[1] - whole) / (PI * a.module * PRESSURE_ANGLE.cos());
        Ok(Pair {
            pitch,
            base,
            centres,
            ratio,
        })
    }

    /// Force along the line of action `[N]`.
    fn force(&self, a: &Arguments) -> f64 {
        a.torque / self.base[1]
    }

    /// Largest pressure where one pair carries all at the pitch point, by Hertz `[Pa]`.
    fn pressure(&self, a: &Arguments) -> f64 {
        let modulus = 0.5 * a.young / (1.0 - a.poisson * a.poisson);
        let curvature: f64 = self
            .pitch
            .iter()
            .map(|r| 1.0 / (r * PRESSURE_ANGLE.sin()))
            .sum();
        (self.force(a) / a.width * modulus * curvature / PI).sqrt()
    }

    /// Torque on the pinion `[Nm]`.
    fn torque(&self, a: &Arguments) -> f64 {
        a.torque * self.base[0] / self.base[1]
    }
}

/// The problem and what is expected of it.
///
/// # Errors
/// Gears whose teeth are no involutes where they touch.
pub fn write(a: &Arguments) -> Result<Written, Failure> {
    let pair = Pair::of(a)?;
    let title = format!(
        "{} and {} teeth of module {} mm, {} Nm on the wheel",
        a.teeth,
        a.wheel,
        digits(a.module * MM, 4),
        digits(a.torque, 4)
    );
    let mut written = Written {
        problem: problem(a, &pair, &title),
        title,
        ..Written::default()
    };
    tell(&mut written, a, &pair);
    let torque = pair.torque(a) * MM;
    let off = OFF * (80.0 / f64::from(a.cells)).max(1.0).powi(2);
    for (what, at) in [
        ("torque on the pinion as it begins to turn", 2.0),
        ("a pitch later", 2.5),
        ("and another", 3.0),
    ] {
        written.check(
            what,
            "one.RM3",
            torque,
            off,
            "forces lie on the line of action: T z1 / z2",
        );
        if let Some(check) = written.checks.last_mut() {
            check.at += &format!("\nat = {at:?}");
        }
    }
    let turned = -2.0 * PI * f64::from(PITCHES) / f64::from(a.wheel);
    let begun = close(a, &pair) * pair.pitch[0] / pair.pitch[1];
    written.check(
        "the wheel has turned by two of its pitches, but for play and what the teeth give way",
        "two.UR3",
        turned,
        2.0 * begun / turned.abs() + 1e-4,
        "as many teeth pass on both",
    );
    Ok(written)
}

/// Angle by which the pinion is turned until the teeth are pressed as the torque will press them `[rad]`.
fn close(a: &Arguments, pair: &Pair) -> f64 {
    let gives = pair.force(a) / a.width / (STIFFNESS * a.young);
    0.25 * BACKLASH * a.module / pair.pitch[0] + gives / pair.base[0]
}

fn problem(a: &Arguments, pair: &Pair, title: &str) -> String {
    let close = close(a, pair);
    let turn = 2.0 * PI * f64::from(PITCHES) / f64::from(a.teeth);
    let bore = |r: f64| 0.5 * (r - DEDENDUM * a.module) * MM;
    let positions = PITCHES * a.positions;
    fill(
        PROBLEM,
        &[
            ("title", title.to_string()),
            ("width", number(a.width * MM)),
            ("centres", number(pair.centres * MM)),
            ("z1", a.teeth.to_string()),
            ("z2", a.wheel.to_string()),
            ("module", number(a.module * MM)),
            ("bore1", number(bore(pair.pitch[0]))),
            ("bore2", number(bore(pair.pitch[1]))),
            ("backlash", number(BACKLASH * a.module * MM)),
            ("cells", a.cells.to_string()),
            ("across", (a.cells / 13).max(3).to_string()),
            // Written in full: play is a matter of its last digits.
            ("angle", format!("{:?}", PI + PI / f64::from(a.wheel))),
            ("young", number(a.young * MPA)),
            ("poisson", number(a.poisson)),
            ("torque", number(a.torque * MM)),
            ("pitches", PITCHES.to_string()),
            ("close", format!("{close:?}")),
            ("end", format!("{:?}", close + turn)),
            ("positions", positions.to_string()),
            ("half", (positions / 2).to_string()),
        ],
    )
}

fn tell(written: &mut Written, a: &Arguments, pair: &Pair) {
    written.tell(
        "centres",
        format!(
            "{} mm apart    m (z1 + z2) / 2",
            digits(pair.centres * MM, 4)
        ),
    );
    written.tell(
        "torque on the pinion",
        format!(
            "{} Nm at every position    T z1 / z2",
            digits(pair.torque(a), 4)
        ),
    );
    written.tell(
        "force of the teeth",
        format!(
            "{} N on the line of action    T / (r2 cos 20 deg)",
            digits(pair.force(a), 4)
        ),
    );
    written.tell(
        "pairs in contact",
        format!(
            "{} in the mean    length of the path of contact over the base pitch",
            digits(pair.ratio, 3)
        ),
    );
    written.tell(
        "largest pressure",
        format!(
            "about {} MPa where one pair carries all    Hertz at the pitch point",
            digits(pair.pressure(a) * MPA, 3)
        ),
    );
    written.notes.push(
        "cells along the flanks resolve forces; for the pressure they have to be smaller than the half-width of contact".into(),
    );
}
