//! Compares the results of a run with expected values, the checker of every verification case, or with those of [another run](differences()).
//!
//! An `expected.toml` lists checks. Each takes one number or one curve from the results, and says what it should be:
//!
//! ```toml
//! format = 1
//! source = "where the numbers below come from, unless a check says otherwise"
//!
//! [[check]]
//! what = "u_x at A"               # free text for the report
//! history = "A.U1"                # a column of history.csv
//! at = 1.0                        # its row: the value of column TIME; the last row if absent
//! value = 2.84594e-5
//! relative = 5e-4                 # |error| <= 5e-4 |value|
//! source = "table 3"
//!
//! [[check]]
//! what = "largest pressure on the base"
//! history = "base.CPRESSMAX"
//! reduce = "max"                  # "last", "max", "min", "max-abs" over the rows
//! value = 0.0
//! absolute = 1e-9                 # with `relative`, the larger of both counts
//!
//! [[check]]
//! what = "penetration is negligible"
//! summary = "interfaces.0.quality.relative-to-size"   # a path in summary.json; numbers index lists
//! below = 1e-3                    # and/or `above`; both bounds count as inside
//!
//! [[check]]
//! what = "pressure at the centre"
//! table = "interfaces/base.csv"   # a table in the folder of results
//! column = "CPRESS"
//! along = "x"                     # the abscissa of `at`, linear in between
//! at = 0.0
//! where = { z = 0.0 }             # only rows with these values, to 1e-9 of the largest in the column
//! value = 3.4e8
//! relative = 0.01
//!
//! [[check]]
//! what = "distribution of pressure"
//! table = "interfaces/base.csv"
//! column = "CPRESS"
//! along = "x"
//! curve = { file = "reference.csv", along = "x", column = "p" }   # beside expected.toml
//! relative = 0.02                 # largest |difference| over largest |reference|
//! ```
//!
//! A check whose file, column or row is missing fails and says which names come near; so does one that meets a NaN.

mod differences;
mod evaluate;
mod expected;
mod near;
mod report;
mod select;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::error::{Error, IoError};

pub use differences::{Difference, Differences, differences};
pub use expected::{Check, Curve, Expected, Reduce};
pub use near::near;
pub use report::{Comparison, Outcome, Report, Target, Verdict};

/// Compares the results in the folder `dir` with the checks of the file `expected`.
///
/// # Errors
/// [`Error::Problem`] if `expected` is not as described [above](self), [`Error::Io`] if it cannot be read or there is no
/// folder `dir`. Results that are missing or wrong are not errors but failed checks.
pub fn compare(dir: &Path, expected: &Path) -> Result<Report, Error> {
    let checks = Expected::read(expected)?;
    if !dir.is_dir() {
        return Err(Error::Io(IoError {
            file: dir.to_path_buf(),
            message: "there is no folder of results here; run the case with `-o` first".into(),
        }));
    }
    let mut results = evaluate::Results::new(dir, expected);
    let outcomes = checks.check.iter().map(|check| Outcome {
        what: check.what.clone(),
        source: check.source.clone().or_else(|| checks.source.clone()),
        verdict: results.judge(check),
    });
    Ok(Report {
        outcomes: outcomes.collect(),
    })
}
