use super::grid;
use super::hertz::{Hertz, Materials, Shape};
use super::quantity::{self, Load};
use super::target::Target;
use super::written::{MM, MPA, Written, fill, number};
use crate::failure::Failure;
use crate::style::digits;

/// Hertz's contact of a cylinder (a load per length) or of a ball (a force) on a flat, without friction.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Radius of the round body.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::length, allow_hyphen_values = true)]
    radius: f64,
    /// A load per length, as 100N/mm, presses a cylinder; a force, as 50N, a ball.
    #[arg(long, value_name = "LOAD", default_value = "100N/mm", value_parser = quantity::load, allow_hyphen_values = true)]
    load: Load,
    #[command(flatten)]
    materials: Materials,
    /// The flat is rigid.
    #[arg(long, conflicts_with_all = ["flat_young", "flat_poisson"])]
    rigid: bool,
    /// Cells on the half-width of contact.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(4..=200))]
    cells: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const PROBLEM: &str = include_str!("hertz.toml");
const ELASTIC: &str = include_str!("hertz-flat.toml");
const RIGID: &str = "[obstacle.flat]\nplane = { point = [0, 0], normal = [0, 1] }\n";

/// The flat reaches as far as so many half-widths of a line contact, or as the radius.
const REACH: f64 = 40.0;

/// The problem and what is expected of it.
///
/// # Errors
/// Numbers for which the theory does not hold.
pub fn write(a: &Arguments) -> Result<Written, Failure> {
    let (shape, load) = match a.load {
        Load::PerLength(load) => (Shape::Line, load),
        Load::Force(load) => (Shape::Point, load),
    };
    let hertz = Hertz::of(shape, a.radius, load, a.materials.compliance(a.rigid));
    hertz.sound(a.materials.strength)?;
    let mut written = Written {
        title: title(&hertz, a.rigid),
        problem: problem(a, &hertz),
        ..Written::default()
    };
    tell(&mut written, a, &hertz);
    checks(&mut written, a, &hertz);
    Ok(written)
}

fn title(h: &Hertz, rigid: bool) -> String {
    let radius = digits(h.radius * MM, 4);
    let flat = if rigid {
        "a rigid flat"
    } else {
        "an elastic flat"
    };
    match h.shape {
        Shape::Line => format!(
            "a cylinder of radius {radius} mm on {flat}, {} N/mm",
            digits(h.load / MM, 4)
        ),
        Shape::Point => format!(
            "a ball of radius {radius} mm on {flat}, {} N",
            digits(h.load, 4)
        ),
    }
}

fn problem(a: &Arguments, h: &Hertz) -> String {
    let finest = h.half_width / f64::from(a.cells);
    let fine = 1.25 * h.half_width;
    let push = 0.5 * h.half_width * h.half_width / h.radius;
    let (space, kind, load, area) = match h.shape {
        Shape::Line => (
            "plane-strain",
            "cylinder; half of the section is modelled",
            format!("{} N/mm on the diameter", number(h.load / MM)),
            2.0 * h.radius,
        ),
        Shape::Point => (
            "axisymmetric",
            "ball, turned about the axis x = 0",
            format!("{} N on the section", number(h.load)),
            std::f64::consts::PI * h.radius * h.radius,
        ),
    };
    // What a rigid flat has instead, and what an elastic one has beyond it.
    let say = |rigid: &str, elastic: &str| if a.rigid { rigid } else { elastic }.to_string();
    let ground = "\n[support.ground]\nset = \"flat.bottom\"\ny = 0.0\n";
    let mirror = say("\"round.axis\"", "\"round.axis\", \"flat.left\"");
    fill(
        PROBLEM,
        &[
            ("title", title(h, a.rigid)),
            ("space", space.into()),
            ("kind", kind.into()),
            ("flat", flat(a, h, finest, fine)),
            ("primary", say("flat", "flat.top")),
            ("mirror", mirror),
            ("ground", say("", ground)),
            ("held", say("\"symmetry\"", "\"symmetry\", \"ground\"")),
            ("radius", number(h.radius * MM)),
            ("coarse", number(h.radius * MM / 8.0)),
            ("finest", number(finest * MM)),
            ("width", number(fine * MM)),
            ("growth", number(grid::GROWTH)),
            ("cells", a.cells.to_string()),
            ("young-round", number(a.materials.young * MPA)),
            ("poisson-round", number(a.materials.poisson)),
            ("a", number(h.half_width * MM)),
            ("p0", number(h.pressure * MPA)),
            ("push", number(push * MM)),
            ("pressure", number(h.load / area * MPA)),
            ("load", load),
        ],
    )
}

/// The tables of the flat.
fn flat(a: &Arguments, h: &Hertz, finest: f64, fine: f64) -> String {
    if a.rigid {
        return RIGID.into();
    }
    let (young, nu) = a.materials.flat();
    let lines = grid::outward(finest, fine, a.radius.max(REACH * h.half_width));
    fill(
        ELASTIC,
        &[
            ("x", grid::list(&lines, MM)),
            ("y", grid::list(&grid::downward(&lines), MM)),
            ("young", number(young * MPA)),
            ("poisson", number(nu)),
        ],
    )
}

fn tell(written: &mut Written, a: &Arguments, h: &Hertz) {
    let (width, pressure) = match h.shape {
        Shape::Line => ("a = sqrt(4 P R / (pi E*))", "p0 = 2 P / (pi a)"),
        Shape::Point => ("a = (3 F R / (4 E*))^(1/3)", "p0 = 3 F / (2 pi a^2)"),
    };
    written.tell(
        "half-width",
        format!(
            "{} mm    {width}, E* = {} GPa",
            digits(h.half_width * MM, 4),
            digits(h.modulus * 1e-9, 4)
        ),
    );
    written.tell(
        "largest pressure",
        format!("{} MPa    {pressure}", digits(h.pressure * MPA, 4)),
    );
    written.tell(
        "yield begins",
        format!(
            "in bodies with a yield stress below {} MPa    p0 / {}",
            digits(h.pressure * MPA / h.onset(), 3),
            h.onset()
        ),
    );
    written.tell(
        "mesh",
        format!(
            "{} cells of {} mm on the half-width; expected errors: largest pressure {} %, half-width {} % (a cell)",
            a.cells,
            digits(h.half_width * MM / f64::from(a.cells), 3),
            digits(100.0 * h.pressure_error(a.cells), 2),
            digits(100.0 * h.width_error(a.cells), 2)
        ),
    );
}

fn checks(written: &mut Written, a: &Arguments, h: &Hertz) {
    let pressure = h.pressure_error(a.cells);
    let width = h.width_error(a.cells);
    written.check(
        "largest pressure",
        "contact.CPRESSMAX",
        h.pressure * MPA,
        pressure,
        "Hertz; the error is that of the mesh",
    );
    let half = h.half_width * MM;
    match h.shape {
        Shape::Line => {
            written.check(
                "force on the half that is modelled",
                "contact.CFN2",
                0.5 * h.load / MM,
                1e-4,
                "equilibrium",
            );
            written.check(
                "half-width, from the length in contact",
                "contact.CAREA",
                half,
                width,
                "Hertz; contact comes in whole cells",
            );
        }
        Shape::Point => {
            written.check("force", "contact.CFN2", h.load, 1e-3, "equilibrium");
            let area = std::f64::consts::PI * half * half;
            written.check(
                "area of contact, pi a^2",
                "contact.CAREA",
                area,
                2.0 * width,
                "Hertz; contact comes in whole rings of cells",
            );
        }
    }
}
