//! Where a quantity goes through zero between two runs of a sweep: the value of the last axis is bracketed, run by run.

use std::path::Path;

use stickslip::io::write_atomically;
use stickslip::tolerance::NEGLIGIBLE;

use super::done::Row;
use super::table::line;
use crate::failure::Failure;

/// Most runs for one critical value.
const MOST_CRITICAL_RUNS: usize = 40;

/// A change of sign between two runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Bracket {
    /// Values of the axes but the last.
    pub others: Vec<String>,
    /// Values of the last axis, and of the quantity there.
    pub ends: [[f64; 2]; 2],
}

/// The changes of sign of a quantity along the last axis.
pub fn brackets(rows: &[Row], quantity: &str) -> Vec<Bracket> {
    let at = |row: &Row| -> Option<(Vec<String>, [f64; 2])> {
        let (last, others) = row.values.split_last()?;
        Some((
            others.to_vec(),
            [last.parse().ok()?, *row.last.get(quantity)?],
        ))
    };
    let pairs = rows.windows(2).filter_map(|pair| {
        let (others, a) = at(&pair[0])?;
        let (same, b) = at(&pair[1])?;
        let changes = others == same && (a[1] > 0.0) != (b[1] > 0.0);
        changes.then_some(Bracket {
            others,
            ends: [a, b],
        })
    });
    pairs.collect()
}

/// Narrows a bracket by regula falsi with the weights of Illinois, and by halves where that is slow; the value, and the quantity there.
///
/// # Errors
/// What `run` returns; `None` of it, a run without the quantity, ends the search.
pub fn narrow(
    bracket: &Bracket,
    run: &mut dyn FnMut(f64) -> Result<Option<f64>, Failure>,
) -> Result<[f64; 2], Failure> {
    let [mut a, mut b] = bracket.ends;
    let mut weights = [1.0, 1.0];
    // A critical value is known to this width, relative to the step of the axis.
    let width = NEGLIGIBLE * (b[0] - a[0]).abs();
    for k in 0..MOST_CRITICAL_RUNS {
        if (b[0] - a[0]).abs() <= width {
            break;
        }
        let (fa, fb) = (weights[0] * a[1], weights[1] * b[1]);
        let straight = (a[0] * fb - b[0] * fa) / (fb - fa);
        // Without damping stable modes have no growth at all, and a straight line says nothing.
        let halve = k % 4 == 3 || a[1] * b[1] == 0.0 || !straight.is_finite();
        let x = match halve {
            true => 0.5 * (a[0] + b[0]),
            // Off the end that is near already, so that it moves at last.
            false => straight.clamp(a[0].min(b[0]) + 0.25 * width, a[0].max(b[0]) - 0.25 * width),
        };
        let Some(value) = run(x)? else {
            break;
        };
        if (value > 0.0) == (a[1] > 0.0) {
            a = [x, value];
            weights = [1.0, 0.5 * weights[1]];
        } else {
            b = [x, value];
            weights = [0.5 * weights[0], 1.0];
        }
    }
    let first = a[1] != 0.0 && a[1].abs() < b[1].abs();
    Ok(if first || b[1] == 0.0 { a } else { b })
}

/// Writes critical values: a row each.
///
/// # Errors
/// If the file cannot be written.
pub fn write(
    path: &Path,
    axes: &[String],
    quantity: &str,
    found: &[(Vec<String>, [f64; 2])],
) -> Result<(), Failure> {
    let names = axes.iter().cloned().chain([quantity.into()]);
    let mut text = line(names);
    for (others, [value, there]) in found {
        let numbers = [value, there].map(|v| format!("{v:?}"));
        text += &line(others.iter().cloned().chain(numbers));
    }
    write_atomically(path, text.as_bytes()).map_err(Failure::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: [&str; 2], growth: f64) -> Row {
        Row {
            values: values.map(String::from).to_vec(),
            last: [("G".to_string(), growth)].into(),
            ..Row::default()
        }
    }

    #[test]
    fn changes_of_sign_are_found_and_narrowed() {
        let rows = [
            row(["a", "1"], -1.0),
            row(["a", "2"], 6.0),
            row(["b", "1"], -1.0),
            row(["b", "2"], -0.5),
        ];
        let found = brackets(&rows, "G");
        assert_eq!(found.len(), 1, "{found:?}");
        let mut runs = 0;
        let root = narrow(&found[0], &mut |x| {
            runs += 1;
            Ok(Some(x * x * x - 2.0))
        });
        let [x, _] = root.unwrap();
        assert!((x - 2.0_f64.cbrt()).abs() < 1e-6, "{x}");
        assert!(runs < 20, "{runs}");
        assert!(brackets(&rows, "H").is_empty());
    }
}
