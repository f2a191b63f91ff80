use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::error::{Diagnostic, Error, ProblemError};

/// An `expected.toml`; the [module](super) explains its keys.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// Version of the format: 1.
    pub format: u32,
    /// Source of the checks that name none.
    pub source: Option<String>,
    /// The problem file beside this one that the results are of, for the tests; `case.toml` if not given.
    pub case: Option<String>,
    /// Changes `path=value` with which it is run, as for `stickslip run --set`.
    #[serde(default)]
    pub overrides: Vec<String>,
    /// `false` where a run takes too long for a test.
    #[serde(default = "yes")]
    pub tested: bool,
    /// The checks.
    pub check: Vec<Check>,
}

fn yes() -> bool {
    true
}

/// One check: where the number is (`history`, `summary` or `table`), and what it should be (`value`, bounds or `curve`).
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// What is checked, for the report.
    pub what: String,
    /// Where the expected number comes from.
    pub source: Option<String>,
    /// A column of `history.csv`.
    pub history: Option<String>,
    /// A path in `summary.json`.
    pub summary: Option<String>,
    /// A table in the folder of results.
    pub table: Option<String>,
    /// The column of `table`.
    pub column: Option<String>,
    /// The column of `table` that is the abscissa.
    pub along: Option<String>,
    /// Rows of `table` to take: those with these values in these columns.
    #[serde(default, rename = "where")]
    pub only: BTreeMap<String, f64>,
    /// Time (`history`) or abscissa (`table`) of the value.
    pub at: Option<f64>,
    /// What to make of all rows.
    pub reduce: Option<Reduce>,
    /// The expected value.
    pub value: Option<f64>,
    /// Upper bound.
    pub below: Option<f64>,
    /// Lower bound.
    pub above: Option<f64>,
    /// The expected curve.
    pub curve: Option<Curve>,
    /// Tolerance relative to the value, or to the largest value of the curve.
    pub relative: Option<f64>,
    /// Tolerance in the unit of the value.
    pub absolute: Option<f64>,
}

/// How a column becomes one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reduce {
    /// The last row.
    Last,
    /// The largest.
    Max,
    /// The smallest.
    Min,
    /// The largest absolute value.
    MaxAbs,
}

/// A reference curve.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// A CSV table beside `expected.toml`.
    pub file: String,
    /// Its column of abscissae.
    pub along: String,
    /// Its column of values.
    pub column: String,
}

impl Expected {
    /// Reads and checks an `expected.toml`.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, [`Error::Problem`] for syntax, unknown keys and checks that are not complete or
    /// contradict themselves.
    pub fn read(path: &Path) -> Result<Expected, Error> {
        let text = crate::io::input::read_text(path).map_err(|e| Error::io(path, e))?;
        let problem = |findings| {
            Error::Problem(ProblemError {
                file: Some(path.to_path_buf()),
                source: text.clone(),
                findings,
            })
        };
        let expected: Expected = toml::from_str(&text).map_err(|e| {
            let mut finding = Diagnostic::new("", e.message());
            finding.span = e.span();
            problem(vec![finding])
        })?;
        let mut findings = Vec::new();
        if expected.format != 1 {
            findings.push(
                Diagnostic::new("format", format!("{} is not known", expected.format))
                    .help("this version reads format = 1"),
            );
        }
        if expected.check.is_empty() {
            findings.push(Diagnostic::new("check", "there are no checks"));
        }
        for (i, check) in expected.check.iter().enumerate() {
            let key = format!("check[{i}] (\"{}\")", check.what);
            let faults = check.faults().into_iter();
            findings.extend(faults.map(|(message, help)| {
                let finding = Diagnostic::new(key.clone(), message);
                finding.help(help)
            }));
        }
        match findings.is_empty() {
            true => Ok(expected),
            false => Err(problem(findings)),
        }
    }
}

impl Check {
    /// What is missing or contradictory, with what to do.
    fn faults(&self) -> Vec<(&'static str, &'static str)> {
        let count = |given: &[bool]| given.iter().filter(|g| **g).count();
        let table = self.table.is_some();
        let bounds = self.below.is_some() || self.above.is_some();
        let curve = self.curve.is_some();
        let tolerance = self.relative.is_some() || self.absolute.is_some();
        let sources = [self.history.is_some(), self.summary.is_some(), table];
        let expectations = [self.value.is_some(), bounds, curve];
        let numbers = [
            self.at,
            self.value,
            self.below,
            self.above,
            self.relative,
            self.absolute,
        ];
        let selects = self.at.is_some() || self.reduce.is_some();
        let rules = [
            (
                count(&sources) != 1,
                "a check takes its number from one place",
                "give one of `history`, `summary` or `table`",
            ),
            (
                count(&expectations) != 1,
                "a check has one expectation",
                "give one of `value`, `below` and/or `above`, or `curve`",
            ),
            (
                tolerance && bounds,
                "bounds have no tolerance",
                "remove `relative` and `absolute`, or give a `value`",
            ),
            (
                !tolerance && !bounds,
                "the tolerance is missing",
                "give `relative`, `absolute`, or both: the larger counts",
            ),
            (
                self.value == Some(0.0) && self.absolute.is_none(),
                "a relative tolerance on zero allows nothing",
                "give `absolute`",
            ),
            (
                self.at.is_some() && self.reduce.is_some(),
                "`at` and `reduce` exclude each other",
                "keep one",
            ),
            (
                self.summary.is_some() && selects,
                "`at` and `reduce` choose rows, which a summary does not have",
                "remove them",
            ),
            (
                table != self.column.is_some(),
                "`table` and `column` go together",
                "name the file and its column",
            ),
            (
                !table && (self.along.is_some() || !self.only.is_empty() || curve),
                "`along`, `where` and `curve` belong to a `table`",
                "give `table` and `column`, or remove them",
            ),
            (
                table && self.along.is_none() && (self.at.is_some() || curve),
                "the abscissa is missing",
                "name its column with `along`",
            ),
            (
                table && !curve && !selects,
                "a value from a table needs a row",
                "give `along` and `at`, or `reduce`",
            ),
            (
                curve && selects,
                "a curve is compared at all its abscissae",
                "remove `at` and `reduce`",
            ),
            (
                numbers.iter().flatten().any(|n| !n.is_finite())
                    || self.only.values().any(|n| !n.is_finite()),
                "a number is not finite",
                "give a finite one",
            ),
            (
                self.relative.is_some_and(|r| r < 0.0) || self.absolute.is_some_and(|a| a < 0.0),
                "a tolerance is negative",
                "tolerances are zero or more",
            ),
        ];
        let broken = rules.into_iter().filter(|rule| rule.0);
        broken.map(|(_, message, help)| (message, help)).collect()
    }
}
