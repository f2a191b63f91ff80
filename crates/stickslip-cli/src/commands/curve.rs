use std::path::PathBuf;
use std::process::ExitCode;

use stickslip::contact::law::friction::FrictionPoint;
use stickslip::contact::law::slip::Tangential;

use crate::failure::{Failure, Outcome};
use crate::given;
use crate::input::Input;
use crate::print;

/// Tabulate the laws of an interface as CSV: pressure and friction limit over the gap, shear traction over slip.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The problem file, or an input deck of Abaqus or CalculiX (`.inp`).
    file: PathBuf,
    /// The interface; optional if there is only one.
    interface: Option<String>,
    /// Largest pressure of the table, in the stress unit of the problem.
    #[arg(long, default_value_t = 1e8, value_parser = pressure)]
    pressure: f64,
    /// Number of rows.
    #[arg(long, default_value_t = 21, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    rows: u32,
    /// Change a value: path=value.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

fn pressure(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number".into()),
    }
}

/// Prints the table.
pub fn run(arguments: &Arguments) -> Outcome {
    let problem = Input::open(&arguments.file, &arguments.set)?.problem;
    let known: Vec<&str> = problem.interface.keys().map(String::as_str).collect();
    let interface = match &arguments.interface {
        Some(name) => problem.interface.get(name),
        None if problem.interface.len() == 1 => problem.interface.values().next(),
        None => None,
    };
    let Some(interface) = interface else {
        if let Some(name) = &arguments.interface {
            return Err(given::unknown("interface", name, &known));
        }
        return Err(Failure::Arguments(
            "say which interface".into(),
            format!("interfaces: {}", known.join(", ")),
        ));
    };
    let (normal, friction, slip) = (
        interface.normal.as_dyn(),
        interface.friction.as_dyn(),
        interface.slip.as_dyn(),
    );
    let mut text = String::from("gap,pressure,slope,energy,limit,shear_at_slip_speed_1\n");
    let rows = arguments.rows;
    for i in 0..rows {
        let p = arguments.pressure * f64::from(i) / f64::from(rows - 1);
        let gap = if p > 0.0 {
            normal.gap(p).value
        } else {
            normal.gap(f64::MIN_POSITIVE).value
        };
        let slope = normal.pressure(gap).map_or(f64::NEG_INFINITY, |s| s.slope);
        let limit = |sticking| {
            let at = FrictionPoint {
                penetration: (-gap).max(0.0),
                speed: 1.0,
                sticking,
                ..FrictionPoint::at_rest(friction, p)
            };
            friction.limit(&at).value
        };
        // far beyond stick for any stiffness: the full shear of the slip rule at unit speed
        let motion = Tangential {
            slip: [1.0, 0.0],
            dt: 1.0,
            stiffness: 1e6 * arguments.pressure,
            ..Tangential::default()
        };
        let shear = -slip.traction(limit(false), &motion).traction[0];
        text += &format!(
            "{gap:?},{p:?},{slope:?},{:?},{:?},{shear:?}\n",
            normal.energy(gap),
            limit(true)
        );
    }
    print::out(&text)?;
    Ok(ExitCode::SUCCESS)
}
