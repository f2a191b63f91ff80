//! Friction problems as text.
//!
//! ```text
//! # anything
//! dim 3 contacts 2
//! mu 0.7 0.7
//! q
//! -0.08            n values, a line each, the normal component of each point first
//! W 36 row column value, from 0
//! 0 0 0.012        as many lines
//! ```
//!
//! An optional line `adhesion` below `mu` has limits without contact force, one a point. An optional line `ellipse` after these has four values a point for friction that depends on the
//! direction: both half axes over the limit, the angle of the first axis, and 1 for the associated rule or 0 for slip against the traction; `1 1 0 1` is a circle. Entries of `W` that are not there are zero.

use std::fmt::Write as _;

use super::ellipse::{Ellipse, SlipDirection};
use super::problem::{FrictionProblem, PointLaw};

/// What is wrong with a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextFault {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

/// The lines that count, with their numbers.
struct Lines<'a> {
    rest: Vec<(usize, &'a str)>,
    last: usize,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        let mut rest: Vec<(usize, &str)> = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or("").trim()))
            .filter(|(_, line)| !line.is_empty())
            .collect();
        rest.reverse();
        Lines {
            rest,
            last: text.lines().count().max(1),
        }
    }

    fn next(&mut self, wanted: &str) -> Result<(usize, &'a str), TextFault> {
        self.rest.pop().ok_or_else(|| TextFault {
            line: self.last,
            message: format!("the file ends where {wanted} is wanted"),
            help: "the file is incomplete: write it again".into(),
        })
    }

    /// The numbers behind a word.
    fn numbers(&mut self, word: &str, count: usize) -> Result<Vec<f64>, TextFault> {
        let (line, text) = self.next(&format!("`{word}`"))?;
        let mut words = text.split_whitespace();
        if words.next() != Some(word) {
            return Err(fault(
                line,
                format!("`{word}` is wanted here, not `{}`", short(text)),
            ));
        }
        let values: Result<Vec<f64>, TextFault> = words.map(|w| number(line, w)).collect();
        let values = values?;
        if values.len() != count {
            let message = format!(
                "`{word}` has {} values, and {count} are wanted",
                values.len()
            );
            return Err(fault(line, message));
        }
        if let Some(bad) = values.iter().find(|v| **v < 0.0) {
            return Err(fault(
                line,
                format!("`{word}` has the value {bad:e}; it is not negative"),
            ));
        }
        Ok(values)
    }
}

/// The help of most faults.
const FORM: &str = "the lines are `dim D contacts N`, `mu` and N values, `q` with D N lines of one value, `W ENTRIES` with lines of row, column (from 0) and value";

/// More points than memory has room for a dense operator.
const MOST_DENSE_POINTS: usize = 20_000;

fn fault(line: usize, message: String) -> TextFault {
    TextFault {
        line,
        message,
        help: FORM.into(),
    }
}

fn short(text: &str) -> String {
    text.chars().take(30).collect()
}

fn number(line: usize, word: &str) -> Result<f64, TextFault> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(fault(
            line,
            format!("`{}` is no finite number", short(word)),
        )),
    }
}

/// Reads a problem.
///
/// # Errors
/// A line that is not as it should be.
pub fn read(text: &str) -> Result<FrictionProblem, TextFault> {
    let mut lines = Lines::of(text);
    let (dimension, points) = head(&mut lines)?;
    let mu = lines.numbers("mu", points)?;
    let adheres = (lines.rest.last()).is_some_and(|(_, text)| text.starts_with("adhesion"));
    let adhesion = match adheres {
        true => lines.numbers("adhesion", points)?,
        false => vec![0.0; points],
    };
    let ellipses = match (lines.rest.last()).is_some_and(|(_, text)| text.starts_with("ellipse")) {
        true => (lines
            .numbers("ellipse", 4 * points)?
            .chunks_exact(4)
            .map(ellipse))
        .collect(),
        false => vec![None; points],
    };
    let n = dimension * points;
    let (line, word) = lines.next("`q`")?;
    if word != "q" {
        return Err(fault(
            line,
            format!("`q` alone is wanted here, not `{}`", short(word)),
        ));
    }
    let mut free = Vec::with_capacity(n);
    for i in 0..n {
        let (line, word) = lines.next(&format!("value {i} of `q`"))?;
        free.push(number(line, word)?);
    }
    let operator = entries(&mut lines, n)?;
    if let Some((line, text)) = lines.rest.last() {
        return Err(fault(
            *line,
            format!(
                "nothing is wanted behind the operator, and here is `{}`",
                short(text)
            ),
        ));
    }
    let laws = mu.into_iter().zip(adhesion).zip(ellipses);
    Ok(FrictionProblem {
        dimension,
        operator,
        free,
        laws: laws
            .map(|((mu, adhesion), ellipse)| PointLaw {
                mu,
                adhesion,
                ellipse,
            })
            .collect(),
    })
}

/// The shape that four values stand for.
fn ellipse(values: &[f64]) -> Option<Ellipse> {
    let &[first, second, angle, associated] = values else {
        return None;
    };
    ([first, second] != [1.0; 2]).then_some(Ellipse {
        half: [first, second],
        angle,
        flow: match associated == 1.0 {
            true => SlipDirection::Associated,
            false => SlipDirection::AgainstTraction,
        },
    })
}

/// Dimension and number of points.
fn head(lines: &mut Lines) -> Result<(usize, usize), TextFault> {
    let (line, text) = lines.next("`dim D contacts N`")?;
    let words: Vec<&str> = text.split_whitespace().collect();
    let found = match words[..] {
        ["dim", d, "contacts", n] => d.parse().ok().zip(n.parse().ok()),
        _ => None,
    };
    let Some((dimension, points)) = found else {
        return Err(fault(
            line,
            format!("`dim D contacts N` is wanted here, not `{}`", short(text)),
        ));
    };
    if dimension != 2 && dimension != 3 {
        return Err(fault(
            line,
            format!("the dimension is 2 or 3, not {dimension}"),
        ));
    }
    if points > MOST_DENSE_POINTS {
        return Err(TextFault {
            line,
            message: format!(
                "{points} points are more than the {MOST_DENSE_POINTS} that are solved with a dense operator"
            ),
            help: "split the problem where no force passes".into(),
        });
    }
    Ok((dimension, points))
}

/// The operator.
fn entries(lines: &mut Lines, n: usize) -> Result<Vec<f64>, TextFault> {
    let (line, text) = lines.next("`W`")?;
    let mut words = text.split_whitespace();
    let count = match (words.next(), words.next().map(str::parse::<usize>)) {
        (Some("W"), Some(Ok(count))) => count,
        _ => {
            return Err(fault(
                line,
                format!(
                    "`W` and its number of entries are wanted here, not `{}`",
                    short(text)
                ),
            ));
        }
    };
    let mut operator = vec![0.0; n * n];
    let mut given = vec![false; n * n];
    for i in 0..count {
        let (line, text) = lines.next(&format!("entry {i} of {count} of `W`"))?;
        let words: Vec<&str> = text.split_whitespace().collect();
        let place = |w: &str| w.parse::<usize>().ok().filter(|i| *i < n);
        let found = match words[..] {
            [row, column, value] => place(row).zip(place(column)).zip(Some(value)),
            _ => None,
        };
        let Some(((row, column), value)) = found else {
            let message = format!(
                "row and column below {n} and a value are wanted here, not `{}`",
                short(text)
            );
            return Err(fault(line, message));
        };
        if given[row * n + column] {
            return Err(fault(
                line,
                format!("entry {row} {column} of `W` is given twice"),
            ));
        }
        given[row * n + column] = true;
        operator[row * n + column] = number(line, value)?;
    }
    Ok(operator)
}

/// The four values of a shape.
fn shape_of(law: &PointLaw) -> [f64; 4] {
    law.ellipse.map_or([1.0, 1.0, 0.0, 1.0], |ellipse| {
        let associated = ellipse.flow == SlipDirection::Associated;
        let [first, second] = ellipse.half;
        [first, second, ellipse.angle, f64::from(associated)]
    })
}

/// Writes a problem, below lines of remarks; [`read`] gives it back to the last bit.
pub fn write(problem: &FrictionProblem, remarks: &str) -> String {
    let mut out = String::new();
    let n = problem.size();
    for line in remarks.lines() {
        let _ = writeln!(out, "# {line}");
    }
    let _ = writeln!(
        out,
        "dim {} contacts {}",
        problem.dimension,
        problem.points()
    );
    let row = |word: &str, values: &mut dyn Iterator<Item = f64>| {
        let words: Vec<String> = values.map(|v| format!(" {v:?}")).collect();
        format!("{word}{}\n", words.concat())
    };
    out += &row("mu", &mut problem.laws.iter().map(|law| law.mu));
    if problem.laws.iter().any(|law| law.adhesion != 0.0) {
        out += &row("adhesion", &mut problem.laws.iter().map(|law| law.adhesion));
    }
    if problem.laws.iter().any(|law| law.ellipse.is_some()) {
        out += &row("ellipse", &mut problem.laws.iter().flat_map(shape_of));
    }
    out += "q\n";
    for q in &problem.free {
        let _ = writeln!(out, "{q:?}");
    }
    let entries = problem.operator.iter().filter(|w| **w != 0.0).count();
    let _ = writeln!(out, "W {entries} row column value, from 0");
    for (i, w) in problem
        .operator
        .iter()
        .enumerate()
        .filter(|(_, w)| **w != 0.0)
    {
        let _ = writeln!(out, "{} {} {w:?}", i / n, i % n);
    }
    out
}
