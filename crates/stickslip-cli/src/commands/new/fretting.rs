use std::f64::consts::PI;

use super::grid;
use super::hertz::{Hertz, Materials, Shape};
use super::quantity;
use super::target::Target;
use super::written::{MM, MPA, Written, fill, number};
use crate::failure::Failure;
use crate::style::digits;

/// A cylinder pressed on a flat that is driven to and fro: both wear after Archard, over many cycles.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Radius of the cylinder.
    #[arg(long, value_name = "LENGTH", default_value = "6mm", value_parser = quantity::length, allow_hyphen_values = true)]
    radius: f64,
    /// Load per length.
    #[arg(long, value_name = "LOAD", default_value = "18.5N/mm", value_parser = quantity::line_load, allow_hyphen_values = true)]
    load: f64,
    #[command(flatten)]
    materials: Materials,
    /// How far the flat is driven to each side.
    #[arg(long, value_name = "LENGTH", default_value = "25um", value_parser = quantity::length, allow_hyphen_values = true)]
    amplitude: f64,
    /// Coefficient of friction.
    #[arg(long, value_name = "MU", default_value = "0.9", value_parser = quantity::friction)]
    friction: f64,
    /// Volume worn off each of both surfaces over load and path.
    #[arg(long, value_name = "RATE", default_value = "2.4e-8/MPa", value_parser = quantity::wear, allow_hyphen_values = true)]
    wear: f64,
    /// Cycles.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..))]
    cycles: u32,
    /// Cycles of them that are computed; each stands for the same number. More of them, the smaller the error of the scar.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    computed: u32,
    /// Cells on the half-width of first contact.
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(3..=100))]
    cells: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const PROBLEM: &str = include_str!("fretting.toml");

/// Lines of equal cells up to which a mesh is a matter of minutes.
const FINE_CELLS: f64 = 400.0;

/// What is expected of the whole test.
struct Test {
    hertz: Hertz,
    /// Cycles that one computed cycle stands for.
    jump: u32,
    cycles: u32,
    /// By how much bodies give way before all of the contact slides `[m]`.
    yielding: f64,
    /// Volume worn off both surfaces, per length `[m²]`.
    volume: f64,
    /// Half-width of contact at the end `[m]`.
    worn: f64,
    /// Depth of the flat's body, and half of its length `[m]`.
    size: f64,
    /// Half-width of the region of small cells `[m]`.
    fine: f64,
}

impl Test {
    fn of(a: &Arguments) -> Self {
        let hertz = Hertz::of(Shape::Line, a.radius, a.load, a.materials.compliance(false));
        let jump = a.cycles.div_ceil(a.computed);
        // Whole computed cycles.
        let cycles = a.cycles.div_ceil(jump) * jump;
        let size = a.radius.max(40.0 * hertz.half_width);
        // A half-plane under a line of shear, seen at a depth: u = 2 (1 - nu²)/(pi E) Q (ln(2 L/a) + c); c is fitted to runs, and bodies here are finite.
        let shear = a.friction * a.load;
        let yielding = 2.0 / (PI * hertz.modulus) * shear * (2.0 * size / hertz.half_width).ln();
        let path = 4.0 * (a.amplitude - yielding).max(0.0) * f64::from(cycles);
        let volume = 2.0 * a.wear * a.load * path;
        // What is worn off both is the segment that the cylinder would enter into the flat, 2 b³/(3 R).
        let worn = (hertz.half_width.powi(3) + 1.5 * a.radius * volume).cbrt();
        let fine = 1.15 * (worn + a.amplitude) + 2.0 * hertz.half_width / f64::from(a.cells);
        Test {
            hertz,
            jump,
            cycles,
            yielding,
            volume,
            worn,
            size,
            fine,
        }
    }

    fn slides(&self, a: &Arguments) -> bool {
        a.amplitude > 1.2 * self.yielding
    }

    fn finest(&self, a: &Arguments) -> f64 {
        self.hertz.half_width / f64::from(a.cells)
    }
}

/// The problem and what is expected of it.
///
/// # Errors
/// Numbers for which the theory does not hold, and scars that would be wider than the cylinder.
pub fn write(a: &Arguments) -> Result<Written, Failure> {
    let test = Test::of(a);
    test.hertz.sound(a.materials.strength)?;
    if test.worn > 0.2 * a.radius {
        return Err(Failure::Arguments(
            format!(
                "the scar would be {} mm wide: a fifth of the radius to each side, and more",
                digits(2.0 * test.worn * MM, 3)
            ),
            "fewer cycles, a lower wear rate, or a larger radius".into(),
        ));
    }
    let fine = test.fine / test.finest(a);
    if fine > FINE_CELLS {
        return Err(Failure::Arguments(
            format!(
                "the scar and the stroke are {} times the half-width of the first contact: the mesh would have {} small cells along the surface",
                digits(fine / f64::from(a.cells), 2),
                digits(2.0 * fine, 2)
            ),
            format!(
                "fewer `--cells` on the half-width ({} do), fewer cycles, or less amplitude",
                (FINE_CELLS / fine * f64::from(a.cells)) as u32
            ),
        ));
    }
    let mut written = Written {
        title: title(a),
        problem: problem(a, &test),
        ..Written::default()
    };
    tell(&mut written, a, &test);
    checks(&mut written, a, &test);
    Ok(written)
}

fn title(a: &Arguments) -> String {
    format!(
        "fretting of a cylinder of radius {} mm on a flat, {} N/mm, {} um to each side",
        digits(a.radius * MM, 4),
        digits(a.load / MM, 4),
        digits(a.amplitude * 1e6, 4)
    )
}

fn problem(a: &Arguments, t: &Test) -> String {
    let lines = grid::outward(t.finest(a), t.fine, t.size);
    let (young, nu) = a.materials.flat();
    fill(
        PROBLEM,
        &[
            ("title", title(a)),
            ("x", grid::list(&grid::both_ways(&lines), MM)),
            (
                "y",
                grid::list(
                    &grid::downward(&grid::outward(t.finest(a), 4.0 * t.finest(a), t.size)),
                    MM,
                ),
            ),
            ("radius", number(a.radius * MM)),
            ("coarse", number(a.radius * MM / 6.0)),
            ("finest", number(t.finest(a) * MM)),
            ("fine", number(t.fine * MM)),
            ("growth", number(grid::GROWTH)),
            ("young-round", number(a.materials.young * MPA)),
            ("poisson-round", number(a.materials.poisson)),
            ("young-flat", number(young * MPA)),
            ("poisson-flat", number(nu)),
            ("mu", number(a.friction)),
            ("wear", number(a.wear / MPA)),
            ("amplitude", number(a.amplitude * MM)),
            (
                "push",
                number(2.0 * t.hertz.half_width * t.hertz.half_width / a.radius * MM),
            ),
            ("load", number(a.load / MM)),
            ("cycles", t.cycles.to_string()),
            ("jump", t.jump.to_string()),
        ],
    )
}

fn tell(written: &mut Written, a: &Arguments, t: &Test) {
    let h = &t.hertz;
    let mm = |x: f64| digits(x * MM, 3);
    let um = |x: f64| digits(x * 1e6, 3);
    written.tell(
        "first contact",
        format!(
            "half-width {} mm, largest pressure {} MPa    Hertz, E* = {} GPa",
            mm(h.half_width),
            digits(h.pressure * MPA, 4),
            digits(h.modulus * 1e-9, 4)
        ),
    );
    written.tell(
        "friction",
        format!(
            "{} N/mm where all slides    mu P",
            digits(a.friction * a.load / MM, 4)
        ),
    );
    written.tell(
        "regime",
        match t.slides(a) {
            true => format!("gross slip: bodies give way by some {} um before all slides, {} um are driven", um(t.yielding), um(a.amplitude)),
            false => format!("partial slip or its border: bodies give way by some {} um before all slides, {} um are driven", um(t.yielding), um(a.amplitude)),
        },
    );
    if t.slides(a) {
        written.tell("worn off both", format!("{} mm2 after {} cycles (k P 4 (amplitude - what bodies give way) cycles, k of both)", digits(t.volume * MM * MM, 3), t.cycles));
        written.tell("scar", format!("half-width of contact {} mm, depth in each body some {} um    b^3 = a^3 + 3/2 R V, b^2/(4 R)", mm(t.worn), um(t.worn * t.worn / (4.0 * a.radius))));
    }
    written.tell(
        "mesh",
        format!(
            "{} cells of {} mm on the first half-width, as small out to {} mm",
            a.cells,
            mm(t.finest(a)),
            mm(t.fine)
        ),
    );
    written.tell(
        "cycles",
        format!(
            "{} in all; {} are computed, each for {}",
            t.cycles,
            t.cycles / t.jump,
            t.jump
        ),
    );
    if t.cycles != a.cycles {
        written.notes.push(format!(
            "{} cycles are no whole number of jumps; {} are written",
            a.cycles, t.cycles
        ));
    }
    if !t.slides(a) {
        written.notes.push("in partial slip only the rim of the contact wears; no figures are expected of the scar".into());
    }
}

fn checks(written: &mut Written, a: &Arguments, t: &Test) {
    written.check(
        "load",
        "contact.CFN2",
        -a.load / MM,
        5e-3,
        "equilibrium; along the normal of the surface as it lies",
    );
    if !t.slides(a) {
        return;
    }
    written.check("cycles", "CYCLES", f64::from(t.cycles), 1e-6, "the problem");
    let shear = a.friction * a.load / MM;
    written.check(
        "friction where all slides",
        "contact.CFS1",
        shear,
        0.02,
        "mu P",
    );
    if let Some(check) = written.checks.last_mut() {
        check.at += "\nreduce = \"max\"";
    }
    // How much bodies give way is known to a third.
    let share = 0.02 + 0.33 * t.yielding / (a.amplitude - t.yielding);
    written.check(
        "volume worn off both",
        "contact.CWEARVOL",
        t.volume * MM * MM,
        share,
        "Archard: k P 4 (amplitude - what bodies give way) cycles",
    );
}
