//! Hertz's contact of a cylinder or a ball on a flat, and what of it a mesh can show.

use std::f64::consts::PI;

use stickslip::assess::doctor::WIDEST_CONTACT;

use super::quantity::{self, STRESS};
use crate::failure::Failure;
use stickslip::number::figure;

/// What both bodies are made of.
#[derive(Debug, Clone, clap::Args)]
pub struct Materials {
    /// Young's modulus of the round body.
    #[arg(long, value_name = "STRESS", default_value = "210GPa", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    pub young: f64,
    /// Poisson's ratio of the round body.
    #[arg(long, value_name = "NU", default_value = "0.3", value_parser = quantity::poisson)]
    pub poisson: f64,
    /// Young's modulus of the flat, if it is of another material.
    #[arg(long, value_name = "STRESS", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    pub flat_young: Option<f64>,
    /// Poisson's ratio of the flat.
    #[arg(long, value_name = "NU", value_parser = quantity::poisson)]
    pub flat_poisson: Option<f64>,
    /// Yield stress of the softer body; a load above the elastic limit is refused.
    #[arg(long = "yield", value_name = "STRESS", value_parser = quantity::of(STRESS), allow_hyphen_values = true)]
    pub strength: Option<f64>,
}

impl Materials {
    /// Young's modulus `[Pa]` and Poisson's ratio of the flat.
    pub fn flat(&self) -> (f64, f64) {
        (
            self.flat_young.unwrap_or(self.young),
            self.flat_poisson.unwrap_or(self.poisson),
        )
    }

    /// `(1 - nu²)/E` of both bodies, of the round one alone where the flat is rigid `[1/Pa]`.
    pub fn compliance(&self, rigid: bool) -> f64 {
        let plane = |(young, nu): (f64, f64)| (1.0 - nu * nu) / young;
        let flat = if rigid { 0.0 } else { plane(self.flat()) };
        plane((self.young, self.poisson)) + flat
    }
}

/// The shape of the round body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A cylinder: contact along a line, load per length.
    Line,
    /// A ball.
    Point,
}

/// A contact, as the theory has it ([Johnson 1985](stickslip::references::johnson_1985), §4.2): half-spaces, no friction.
#[derive(Debug, Clone, Copy)]
pub struct Hertz {
    /// Of what.
    pub shape: Shape,
    /// Radius of the round body `[m]`.
    pub radius: f64,
    /// Load `[N]`, per length `[N/m]`.
    pub load: f64,
    /// Composite modulus `E*` `[Pa]`.
    pub modulus: f64,
    /// Half-width or radius of contact `[m]`.
    pub half_width: f64,
    /// Largest pressure `[Pa]`.
    pub pressure: f64,
}

impl Hertz {
    /// Contact of a body of this radius under a load, with the compliance of both.
    pub fn of(shape: Shape, radius: f64, load: f64, compliance: f64) -> Self {
        let modulus = 1.0 / compliance;
        let (half_width, pressure) = match shape {
            Shape::Line => {
                let a = (4.0 * load * radius / (PI * modulus)).sqrt();
                (a, 2.0 * load / (PI * a))
            }
            Shape::Point => {
                let a = (0.75 * load * radius / modulus).cbrt();
                (a, 1.5 * load / (PI * a * a))
            }
        };
        Hertz {
            shape,
            radius,
            load,
            modulus,
            half_width,
            pressure,
        }
    }

    /// Largest pressure over the yield stress where yield begins, beneath the surface (Johnson 1985, §6.1: Tresca, von Mises for the ball is the same).
    pub fn onset(&self) -> f64 {
        match self.shape {
            Shape::Line => 1.67,
            Shape::Point => 1.60,
        }
    }

    /// Refuses what elastic half-spaces do not describe.
    ///
    /// # Errors
    /// Contact that is too wide, or a pressure at which a body flows.
    pub fn sound(&self, strength: Option<f64>) -> Result<(), Failure> {
        let part = self.half_width / self.radius;
        // The load grows with the square of the half-width on a line, with its cube on a ball.
        let power = if self.shape == Shape::Line { 2 } else { 3 };
        let less = |ratio: f64| {
            format!(
                "at most {} {} do",
                figure(self.load * ratio.powi(power)),
                self.unit()
            )
        };
        if part > WIDEST_CONTACT {
            return Err(Failure::Arguments(
                format!(
                    "the contact would be {:.2} of the radius wide to each side: too wide for Hertz's theory, and strains would be large",
                    part
                ),
                format!(
                    "a larger radius, stiffer bodies, or less load: {}",
                    less(WIDEST_CONTACT / part)
                ),
            ));
        }
        let Some(strength) = strength else {
            return Ok(());
        };
        let most = self.onset() * strength;
        if self.pressure > most {
            return Err(Failure::Arguments(
                format!(
                    "the largest pressure would be {:.0} MPa: from {:.0} MPa on, {} times the yield stress, bodies flow, and this program has no plasticity",
                    self.pressure * 1e-6,
                    most * 1e-6,
                    self.onset()
                ),
                format!(
                    "a larger radius or less load: {}",
                    less(most / self.pressure)
                ),
            ));
        }
        Ok(())
    }

    fn unit(&self) -> &'static str {
        match self.shape {
            Shape::Line => "N/m",
            Shape::Point => "N",
        }
    }

    /// Error of the largest pressure that is expected with so many cells on the half-width `[-]`.
    ///
    /// Bounds of what 112 runs gave, with 4 to 40 cells and half-widths of 0.003 to 0.19 of the radius, on rigid and elastic flats: the mesh, and bodies that are
    /// no half-spaces. At the axis of a ball the pressure is low by more.
    pub fn pressure_error(&self, cells: u32) -> f64 {
        let cells = f64::from(cells);
        let width = (self.half_width / self.radius).powi(2);
        match self.shape {
            Shape::Line => 0.001 + 0.12 / (cells * cells) + 0.3 * width,
            Shape::Point => 0.002 + 0.1 / cells + 0.6 / (cells * cells) + 0.1 * width,
        }
    }

    /// Error of the half-width: contact comes in whole cells `[-]`.
    pub fn width_error(&self, cells: u32) -> f64 {
        1.0 / f64::from(cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_benchmarks_have_their_numbers() {
        // NAFEMS contact benchmark 1, and the ball of the example `hertz-sphere`.
        let compliance = (1.0 - 0.09) / 210e9 + (1.0 - 0.09) / 70e9;
        let line = Hertz::of(Shape::Line, 0.05, 35e6, compliance);
        assert!((line.half_width / 6.214628e-3 - 1.0).abs() < 1e-6);
        assert!((line.pressure / 3585.362e6 - 1.0).abs() < 1e-6);
        let point = Hertz::of(Shape::Point, 10.0, 1000.0, 0.91 / 1e5);
        assert!((point.half_width / 0.4086651 - 1.0).abs() < 1e-6);
        assert!((point.pressure / 2858.9482 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn loads_that_are_advised_are_allowed() {
        for shape in [Shape::Line, Shape::Point] {
            let of = |load| Hertz::of(shape, 0.01, load, 1e-11);
            let wide = of(1e9);
            let Err(Failure::Arguments(said, help)) = wide.sound(None) else {
                panic!("too wide");
            };
            assert!(said.contains("too wide"), "{said}");
            let load: f64 = help
                .split_whitespace()
                .find_map(|word| word.parse().ok())
                .expect("a load");
            assert!(of(0.999 * load).sound(None).is_ok(), "{help}");
            assert!(of(1.01 * load).sound(None).is_err(), "{help}");
            assert!(of(0.5 * load).sound(Some(1e8)).is_err());
        }
    }
}
