use std::f64::consts::PI;

use super::grid;
use super::hertz::{Hertz, Materials, Shape};
use super::quantity::{self, LENGTH, Load};
use super::target::Target;
use super::written::{MM, MPA, Values, Written};
use crate::failure::Failure;

/// Hertz's contact of a cylinder (a load per length) or of a ball (a force) on a flat, without friction.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Radius of the round body.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = quantity::of(LENGTH), allow_hyphen_values = true)]
    radius: f64,
    /// Load per length (100N/mm) for a cylinder, force (50N) for a ball.
    #[arg(long, value_name = "LOAD", default_value = "100N/mm", value_parser = quantity::load, allow_hyphen_values = true)]
    load: Load,
    #[command(flatten)]
    materials: Materials,
    /// The flat is rigid.
    #[arg(long, conflicts_with_all = ["flat_young", "flat_poisson"])]
    rigid: bool,
    /// Cells on the contact half-width.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(4..=200))]
    cells: u32,
    #[command(flatten)]
    pub(super) target: Target,
}

const TEMPLATE: &str = include_str!("hertz.template");

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
    Ok(written(a, &hertz))
}

fn written(a: &Arguments, h: &Hertz) -> Written {
    let line = h.shape == Shape::Line;
    let finest = h.half_width / f64::from(a.cells);
    let fine = 1.25 * h.half_width;
    let (young, nu) = a.materials.flat();
    // The flat reaches as far as 40 half-widths of a line contact, or as the radius.
    let lines = grid::outward(finest, fine, a.radius.max(40.0 * h.half_width));
    let half = h.half_width * MM;
    let load = if line { h.load / MM } else { h.load };
    // What the pressure acts on.
    let section = match h.shape {
        Shape::Line => 2.0 * h.radius,
        Shape::Point => PI * h.radius * h.radius,
    };
    let (pressure, width) = (h.pressure_error(a.cells), h.width_error(a.cells));
    let numbers = [
        ("radius", h.radius * MM),
        ("load", load),
        ("half-load", 0.5 * load),
        ("a", half),
        ("area", PI * half * half),
        ("modulus", h.modulus * 1e-9),
        ("p0", h.pressure * MPA),
        ("onset", h.onset()),
        ("yields", h.pressure * MPA / h.onset()),
        ("cells", f64::from(a.cells)),
        ("finest", finest * MM),
        ("pressure-error", pressure),
        ("pressure-percent", 100.0 * pressure),
        ("width-error", width),
        ("width-percent", 100.0 * width),
        ("area-error", 2.0 * width),
        ("coarse", h.radius * MM / 8.0),
        ("width", fine * MM),
        ("growth", grid::CELL_GROWTH),
        ("young-round", a.materials.young * MPA),
        ("poisson-round", a.materials.poisson),
        ("young-flat", young * MPA),
        ("poisson-flat", nu),
        ("push", 0.5 * h.half_width * h.half_width / h.radius * MM),
        ("pressure", h.load / section * MPA),
    ];
    let flat = if a.rigid {
        "a rigid flat"
    } else {
        "an elastic flat"
    };
    Written::of(
        TEMPLATE,
        &Values {
            numbers: &numbers,
            texts: &[
                ("flat", flat.into()),
                ("x", grid::list(&lines, MM)),
                ("y", grid::list(&grid::downward(&lines), MM)),
            ],
            holds: &[("line", line), ("rigid", a.rigid)],
        },
    )
}
