use std::f64::consts::PI;

use super::quantity::{self, LENGTH, STRESS, TORQUE};
use super::target::Target;
use super::written::{MM, MPA, Values, Written};
use crate::failure::Failure;

/// Two spur gears that turn through two pitches under a torque.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Teeth of the driving pinion.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(5..=200))]
    teeth: u32,
    /// Teeth of the wheel.
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(5..=200))]
    wheel: u32,
    /// Module: pitch diameter over number of teeth.
    #[arg(long, value_name = "LENGTH", default_value = "2mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    module: f64,
    /// Width of the teeth.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    width: f64,
    /// Load torque on the wheel.
    #[arg(long, value_name = "TORQUE", default_value = "20Nm", value_parser = quantity::of(TORQUE), allow_hyphen_values = true)]
    torque: f64,
    /// Young's modulus of both.
    #[arg(long, value_name = "STRESS", default_value = "210GPa", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    young: f64,
    /// Poisson's ratio of both.
    #[arg(long, value_name = "NU", default_value = "0.3", value_parser = quantity::poisson)]
    poisson: f64,
    /// Cells along a flank.
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u32).range(40..=400))]
    cells: u32,
    /// Computed positions in each of the two pitches.
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(8..=1000))]
    positions: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const TEMPLATE: &str = include_str!("gear.template");

/// Pressure angle of the generator.
const PRESSURE_ANGLE: f64 = 20.0 * PI / 180.0;
/// Height of a tooth above the pitch circle, over the module: that of the generator.
const ADDENDUM: f64 = 1.0;
/// Depth of a gap below the pitch circle, over the module: that of the generator.
const DEDENDUM: f64 = 1.25;
/// Play over the module.
const BACKLASH: f64 = 0.025;
/// Stiffness of a pair of teeth of steel per width, about, over Young's modulus `[-]`: 14 N/(mm µm) (ISO 6336-1).
const TOOTH_STIFFNESS: f64 = 14e9 / 2.1e11;
const PITCHES: u32 = 2;

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
    // What the teeth give way under the torque, as a displacement along the line of action.
    let gives = pair.force(a) / a.width / (TOOTH_STIFFNESS * a.young);
    // Until the teeth are pressed as the torque will press them.
    let close = 0.25 * BACKLASH * a.module / pair.pitch[0] + gives / pair.base[0];
    let pitches = f64::from(PITCHES);
    let turned = -2.0 * PI * pitches / f64::from(a.wheel);
    let begun = close * pair.pitch[0] / pair.pitch[1];
    let bore = |r: f64| 0.5 * (r - DEDENDUM * a.module) * MM;
    let positions = PITCHES * a.positions;
    // Ratios of the torques are off by less with 80 cells along a flank, where a tip comes in too; the error is that of chains of straight
    // edges.
    let off = 5e-3 * (80.0 / f64::from(a.cells)).max(1.0).powi(2);
    let numbers = [
        ("z1", f64::from(a.teeth)),
        ("z2", f64::from(a.wheel)),
        ("module", a.module * MM),
        ("wheel-Nm", a.torque),
        ("torque", a.torque * MM),
        ("centres", pair.centres * MM),
        ("pinion-Nm", pair.torque(a)),
        ("pinion", pair.torque(a) * MM),
        ("force", pair.force(a)),
        ("ratio", pair.ratio),
        ("pressure", pair.pressure(a) * MPA),
        ("off", off),
        ("turned", turned),
        ("turned-error", 2.0 * begun / turned.abs() + 1e-4),
        ("width", a.width * MM),
        ("bore1", bore(pair.pitch[0])),
        ("bore2", bore(pair.pitch[1])),
        ("backlash", BACKLASH * a.module * MM),
        ("cells", f64::from(a.cells)),
        ("across", f64::from((a.cells / 13).max(3))),
        // Written in full: play is a matter of its last digits.
        ("angle", PI + PI / f64::from(a.wheel)),
        ("young", a.young * MPA),
        ("poisson", a.poisson),
        ("pitches", pitches),
        ("close", close),
        ("end", close + 2.0 * PI * pitches / f64::from(a.teeth)),
        ("positions", f64::from(positions)),
        ("half", f64::from(positions / 2)),
    ];
    Ok(Written::of(
        TEMPLATE,
        &Values {
            numbers: &numbers,
            ..Values::default()
        },
    ))
}
