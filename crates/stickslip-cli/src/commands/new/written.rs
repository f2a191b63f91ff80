//! What is written: a template with its numbers, what is expected of it, and what is told.

use crate::style::digits;

/// Millimetres in a metre, for lengths of files in mm, N, MPa.
pub const MM: f64 = 1e3;
/// Megapascals in a pascal; also N/mm in a N/m times [`MM`].
pub const MPA: f64 = 1e-6;

/// One problem with what is known of it.
#[derive(Debug, Default)]
pub struct Written {
    /// What it is, in a line.
    pub title: String,
    /// The problem file.
    pub problem: String,
    /// Checks of its results.
    pub checks: Vec<Check>,
    /// Figures: a name and a value with its unit and formula.
    pub told: Vec<(&'static str, String)>,
    /// What else is to be said.
    pub notes: Vec<String>,
}

/// One line of what is expected.
#[derive(Debug)]
pub struct Check {
    /// What.
    pub what: &'static str,
    /// Where it is in the results: lines of TOML.
    pub at: String,
    /// What it should be.
    pub value: f64,
    /// By which part of it results may differ.
    pub relative: f64,
    /// Where the number comes from.
    pub source: String,
}

impl Written {
    /// The file of what is expected.
    pub fn expected(&self) -> String {
        let mut text = format!(
            "# What theory says of it: {}.\nformat = 1\nsource = \"closed forms\"\n",
            self.title
        );
        for check in &self.checks {
            text += &format!(
                "\n[[check]]\nwhat = \"{}\"\n{}\nvalue = {}\nrelative = {}\nsource = \"{}\"\n",
                check.what,
                check.at,
                number(check.value),
                digits(check.relative, 2),
                check.source
            );
        }
        text
    }

    /// Adds a check of a column of the history, at its end.
    pub fn check(
        &mut self,
        what: &'static str,
        column: &str,
        value: f64,
        relative: f64,
        source: impl Into<String>,
    ) {
        self.checks.push(Check {
            what,
            at: format!("history = \"{column}\""),
            value,
            relative,
            source: source.into(),
        });
    }

    /// Adds a figure.
    pub fn tell(&mut self, name: &'static str, value: String) {
        self.told.push((name, value));
    }
}

/// A number as files have it: eight digits, more than any of it is worth.
pub fn number(x: f64) -> String {
    digits(x, 8)
}

/// A template with `@name@` replaced by what stands for it.
pub fn fill(template: &str, values: &[(&str, String)]) -> String {
    values
        .iter()
        .fold(template.to_string(), |text, (name, value)| {
            text.replace(&format!("@{name}@"), value)
        })
}
