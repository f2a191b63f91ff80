use std::fmt;

use crate::number::digits;

/// What became of all checks.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// In the order of the file.
    pub outcomes: Vec<Outcome>,
}

/// What became of one check.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What was checked.
    pub what: String,
    /// Where the expected number comes from.
    pub source: Option<String>,
    /// The result.
    pub verdict: Verdict,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// A number was found and compared.
    Compared(Comparison),
    /// There was nothing to compare, and why.
    Missing(String),
}

/// A number and what it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// The number found; for a curve the largest difference.
    pub found: f64,
    /// What it should be.
    pub target: Target,
}

/// What a number should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A value.
    Value {
        /// The value.
        value: f64,
        /// Largest absolute error.
        tolerance: f64,
    },
    /// Between bounds.
    Bounds {
        /// Lower bound.
        above: Option<f64>,
        /// Upper bound.
        below: Option<f64>,
    },
    /// A difference of curves that should vanish.
    Curve {
        /// Largest absolute value of the reference.
        largest: f64,
        /// Largest difference allowed.
        tolerance: f64,
    },
}

impl Comparison {
    /// Absolute error, where there is a value or curve to compare with.
    pub fn error(&self) -> Option<f64> {
        match self.target {
            Target::Value { value, .. } => Some((self.found - value).abs()),
            Target::Curve { .. } => Some(self.found),
            Target::Bounds { .. } => None,
        }
    }

    /// Whether the number is as it should be. Never for NaN.
    pub fn passes(&self) -> bool {
        match self.target {
            Target::Value { tolerance, .. } => self.error().is_some_and(|error| error <= tolerance),
            Target::Curve { largest, tolerance } => largest.is_finite() && self.found <= tolerance,
            Target::Bounds { above, below } => {
                self.found.is_finite()
                    && above.is_none_or(|bound| self.found >= bound)
                    && below.is_none_or(|bound| self.found <= bound)
            }
        }
    }

    /// Value found, expected, error and tolerance, as text. Errors are relative where the value is not zero.
    fn cells(&self) -> [String; 4] {
        let share = |number: f64, size: f64| match size > 0.0 {
            true => format!("{} rel", digits(number / size, 3)),
            false => format!("{} abs", digits(number, 3)),
        };
        let error = self.error().unwrap_or(f64::NAN);
        match self.target {
            Target::Value { value, tolerance } => [
                shown(self.found),
                shown(value),
                share(error, value.abs()),
                share(tolerance, value.abs()),
            ],
            Target::Curve { largest, tolerance } => [
                "curve".to_string(),
                format!("max {}", shown(largest)),
                share(error, largest),
                share(tolerance, largest),
            ],
            Target::Bounds { above, below } => {
                let bounds = [above.map(|b| (">=", b)), below.map(|b| ("<=", b))];
                let bounds: Vec<String> = bounds
                    .iter()
                    .flatten()
                    .map(|(sign, bound)| format!("{sign} {}", shown(*bound)))
                    .collect();
                [
                    shown(self.found),
                    bounds.join(", "),
                    "-".to_string(),
                    "-".to_string(),
                ]
            }
        }
    }
}

/// Six digits; whole numbers as such.
fn shown(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e6 {
        format!("{value}")
    } else {
        digits(value, 6)
    }
}

impl Outcome {
    /// Whether the check is fulfilled.
    pub fn passes(&self) -> bool {
        matches!(&self.verdict, Verdict::Compared(comparison) if comparison.passes())
    }
}

impl Report {
    /// Whether all checks are fulfilled.
    pub fn passes(&self) -> bool {
        self.outcomes.iter().all(Outcome::passes)
    }

    /// Number of checks that are not.
    pub fn failures(&self) -> usize {
        self.outcomes.iter().filter(|o| !o.passes()).count()
    }
}

/// An aligned table, one line a check; under a check without a number, why.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let header = ["", "check", "value", "expected", "error", "tolerance"].map(String::from);
        let mut lines = vec![header];
        for outcome in &self.outcomes {
            let verdict = if outcome.passes() { "ok" } else { "FAIL" };
            let [value, expected, error, tolerance] = match &outcome.verdict {
                Verdict::Compared(comparison) => comparison.cells(),
                Verdict::Missing(_) => ["-"; 4].map(String::from),
            };
            let what = outcome.what.clone();
            lines.push([verdict.to_string(), what, value, expected, error, tolerance]);
        }
        let mut widths = [0; 6];
        for line in &lines {
            for (width, cell) in widths.iter_mut().zip(line) {
                *width = (*width).max(cell.chars().count());
            }
        }
        let outcomes = std::iter::once(None).chain(self.outcomes.iter().map(Some));
        for (line, outcome) in lines.iter().zip(outcomes) {
            let mut text = String::new();
            for (i, (cell, &width)) in line.iter().zip(&widths).enumerate() {
                text += &match i {
                    0 | 1 => format!("{cell:<width$}  "),
                    _ => format!("{cell:>width$}  "),
                };
            }
            writeln!(f, "{}", text.trim_end())?;
            if let Some(Verdict::Missing(why)) = outcome.map(|o| &o.verdict) {
                writeln!(f, "{:indent$}{why}", "", indent = widths[0] + 4)?;
            }
        }
        let (all, failed) = (self.outcomes.len(), self.failures());
        write!(f, "{} of {all} checks passed", all - failed)
    }
}
