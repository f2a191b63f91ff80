use std::f64::consts::PI;

use super::grid;
use super::hertz::{Hertz, Materials, Shape};
use super::quantity::{self, LENGTH, LINE_LOAD, WEAR};
use super::target::Target;
use super::written::{MM, MPA, Values, Written};
use crate::failure::Failure;
use stickslip::number::digits;

/// Fretting of a cylinder on a flat: both wear by Archard's law over many cycles.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Radius of the cylinder.
    #[arg(long, value_name = "LENGTH", default_value = "6mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    radius: f64,
    /// Load per length.
    #[arg(long, value_name = "LOAD", default_value = "18.5N/mm", value_parser = quantity::of(LINE_LOAD), allow_hyphen_values = true)]
    load: f64,
    #[command(flatten)]
    materials: Materials,
    /// Amplitude of the motion of the flat.
    #[arg(long, value_name = "LENGTH", default_value = "25um", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    amplitude: f64,
    /// Coefficient of friction.
    #[arg(long, value_name = "MU", default_value = "0.9", value_parser = quantity::friction)]
    friction: f64,
    /// Wear rate of each surface: worn volume per load and sliding distance.
    #[arg(long, value_name = "RATE", default_value = "2.4e-8/MPa", value_parser = quantity::of(WEAR), allow_hyphen_values = true)]
    wear: f64,
    /// Cycles.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..))]
    cycles: u32,
    /// Number of computed cycles; each stands for the same number of cycles. More of them reduce the error of the wear depth.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    computed: u32,
    /// Cells on the initial contact half-width.
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(3..=100))]
    cells: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const TEMPLATE: &str = include_str!("fretting.template");

/// Lines of equal cells up to which a mesh is a matter of minutes: the surface has 800 small cells then.
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
    let finest = test.hertz.half_width / f64::from(a.cells);
    let fine = test.fine / finest;
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
    Ok(written(a, &test, finest))
}

fn written(a: &Arguments, t: &Test, finest: f64) -> Written {
    let (h, um) = (&t.hertz, 1e6);
    let (young, nu) = a.materials.flat();
    let along = grid::both_ways(&grid::outward(finest, t.fine, t.size));
    let down = grid::downward(&grid::outward(finest, 4.0 * finest, t.size));
    let numbers = [
        ("radius", a.radius * MM),
        ("load", a.load / MM),
        ("amplitude", a.amplitude * MM),
        ("amplitude-um", a.amplitude * um),
        ("half-width", h.half_width * MM),
        ("pressure", h.pressure * MPA),
        ("modulus", h.modulus * 1e-9),
        ("shear", a.friction * a.load / MM),
        ("yielding", t.yielding * um),
        ("volume", t.volume * MM * MM),
        // How much bodies give way is known to a third.
        (
            "volume-error",
            0.02 + 0.33 * t.yielding / (a.amplitude - t.yielding),
        ),
        ("worn", t.worn * MM),
        ("depth", t.worn * t.worn / (4.0 * a.radius) * um),
        ("cells", f64::from(a.cells)),
        ("finest", finest * MM),
        ("fine", t.fine * MM),
        ("asked", f64::from(a.cycles)),
        ("cycles", f64::from(t.cycles)),
        ("computed", f64::from(t.cycles / t.jump)),
        ("jump", f64::from(t.jump)),
        ("coarse", a.radius * MM / 6.0),
        ("growth", grid::CELL_GROWTH),
        ("young-round", a.materials.young * MPA),
        ("poisson-round", a.materials.poisson),
        ("young-flat", young * MPA),
        ("poisson-flat", nu),
        ("mu", a.friction),
        ("wear", a.wear / MPA),
        ("push", 2.0 * h.half_width * h.half_width / a.radius * MM),
    ];
    Written::of(
        TEMPLATE,
        &Values {
            numbers: &numbers,
            texts: &[("x", grid::list(&along, MM)), ("y", grid::list(&down, MM))],
            holds: &[
                ("slides", a.amplitude > 1.2 * t.yielding),
                ("more cycles", t.cycles != a.cycles),
            ],
        },
    )
}
