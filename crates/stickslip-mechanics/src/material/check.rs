//! Symmetry and ellipticity of the stiffness: eq. (2) of [`pop_1995`](stickslip_base::references::pop_1995).

use std::fmt;

use super::stiffness::Stiffness;
use crate::math::symmetric_eigen;
use crate::number::digits;
use crate::tolerance::{NEGLIGIBLE, ROUNDING};

/// A material that cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialError {
    /// The key of the parameter at fault, inside the material's table: `young`, `nu12`.
    pub parameter: String,
    /// What is wrong, in a sentence without a final stop.
    pub message: String,
    /// Smallest eigenvalue of the stiffness in Mandel's scaling `[Pa]`, where that is what is wrong.
    pub smallest_eigenvalue: Option<f64>,
    /// What to do about it.
    pub help: Option<String>,
}

impl MaterialError {
    /// A finding about `parameter`.
    pub fn new(parameter: impl Into<String>, message: impl Into<String>) -> Self {
        MaterialError {
            parameter: parameter.into(),
            message: message.into(),
            smallest_eigenvalue: None,
            help: None,
        }
    }

    /// Adds the smallest eigenvalue `[Pa]`.
    pub fn eigenvalue(mut self, value: f64) -> Self {
        self.smallest_eigenvalue = Some(value);
        self
    }

    /// Adds what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for MaterialError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if let Some(value) = self.smallest_eigenvalue {
            write!(
                f,
                "; the smallest eigenvalue of the stiffness is {value}",
                value = digits(value, 5)
            )?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for MaterialError {}

/// A modulus must be positive and finite.
pub(super) fn modulus(parameter: &str, value: f64) -> Result<(), MaterialError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(
        MaterialError::new(parameter, format!("{parameter} = {value} is not positive"))
            .help("a modulus is a positive number, in the problem's unit of stress"),
    )
}

/// A density must be zero or more, and finite.
pub(super) fn density(value: f64) -> Result<(), MaterialError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(MaterialError::new(
        "density",
        format!("density = {value} is not zero or a positive number"),
    ))
}

/// `C` in Mandel's scaling, in which `|ξ|²` of the tensor is that of the 6-vector: shear rows and columns times √2.
fn mandel(c: &Stiffness) -> Vec<Vec<f64>> {
    let scale = |i: usize| if i < 3 { 1.0 } else { std::f64::consts::SQRT_2 };
    (0..6)
        .map(|i| (0..6).map(|j| scale(i) * scale(j) * c[i][j]).collect())
        .collect()
}

/// The largest `c` in `a_ijkl ξ_ij ξ_kl ≥ c |ξ|²` `[Pa]`, the smallest eigenvalue of the tensor.
pub fn smallest_eigenvalue(c: &Stiffness) -> f64 {
    symmetric_eigen(&mandel(c)).0[0]
}

/// Ellipticity; the error is about `parameter`.
pub(super) fn elliptic(c: &Stiffness, parameter: &str) -> Result<(), MaterialError> {
    if c.iter().flatten().any(|x| !x.is_finite()) {
        return Err(MaterialError::new(
            parameter,
            "the stiffness has an entry that is not a finite number",
        ));
    }
    let (values, _) = symmetric_eigen(&mandel(c));
    // Below this part of the largest eigenvalue, rounding decides the sign of the smallest.
    if values[0] > ROUNDING * values[5] {
        return Ok(());
    }
    Err(MaterialError::new(
        parameter,
        "the stiffness is not positive definite: some strain would release energy",
    )
    .eigenvalue(values[0])
    .help("every eigenvalue must be positive; check signs, the order xx yy zz xy yz xz, and units"))
}

/// Makes `c` exactly symmetric, or names the pair that differs.
pub(super) fn symmetric(c: &mut Stiffness, parameter: &str) -> Result<(), MaterialError> {
    let largest = c.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..6 {
        for j in 0..i {
            let (a, b) = (c[i][j], c[j][i]);
            // Printed tables are rounded.
            if (a - b).abs() > NEGLIGIBLE * largest {
                return Err(MaterialError::new(
                    parameter,
                    format!(
                        "the stiffness is not symmetric: entry ({}, {}) is {b} and entry ({}, {}) is {a}",
                        j + 1,
                        i + 1,
                        i + 1,
                        j + 1
                    ),
                )
                .help("a_ijkl = a_klij must hold for the stress to come from an energy"));
            }
            c[i][j] = 0.5 * (a + b);
            c[j][i] = c[i][j];
        }
    }
    Ok(())
}
