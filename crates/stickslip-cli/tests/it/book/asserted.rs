//! What a page claims of results, held against the results.
//!
//! A claim stands in a comment behind the commands that it is about, where readers of the book do not see it:
//!
//! ```text
//! <!-- asserted: checks belt.out
//! [[check]]
//! what = "..."          (as in expected.toml, see examples/README.md)
//! -->
//! <!-- asserted: cycle belt.out heel.U1 after 2 = period 0.9476, range 0.016077, within 0.01 -->
//! <!-- asserted: follows belt.out heel.V1 0.03 for 0.3, within 0.01 -->
//! <!-- asserted: equal job.out converted.out -->
//! <!-- asserted: written belt.out/plot.png -->
//! <!-- asserted: says "translation x is free" -->
//! ```

use std::path::Path;
use std::process::Command;

/// What was printed by the last commands of the page.
pub struct Said<'a>(pub &'a str);

/// The claim of a comment, if it is one.
pub fn claim(comment: &str) -> Option<&str> {
    comment.trim().strip_prefix("asserted:").map(str::trim)
}

/// Holds a claim against the results in the folder of its page.
pub fn hold(claim: &str, folder: &Path, said: &Said) -> Result<(), String> {
    let (kind, rest) = claim.split_once(char::is_whitespace).unwrap_or((claim, ""));
    match kind {
        "checks" => checks(rest, folder),
        "cycle" => cycle(rest, folder),
        "follows" => follows(rest, folder),
        "equal" => equal(rest, folder),
        "written" => written(rest.trim(), folder),
        "says" => says(rest.trim().trim_matches('"'), said),
        other => Err(format!("there is no claim `{other}`")),
    }
}

/// Words of output, as lines are broken somewhere.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// That something was printed, wherever lines are broken.
pub fn says(text: &str, Said(said): &Said) -> Result<(), String> {
    match words(said).contains(&words(text)) {
        true => Ok(()),
        false => Err(format!("`{text}` was not said, but\n{said}")),
    }
}

fn written(name: &str, folder: &Path) -> Result<(), String> {
    match std::fs::metadata(folder.join(name)) {
        Ok(about) if about.len() > 0 => Ok(()),
        _ => Err(format!("{name} was not written")),
    }
}

fn checks(rest: &str, folder: &Path) -> Result<(), String> {
    let (results, checks) = rest.split_once('\n').ok_or("there are no checks")?;
    let file = folder.join("asserted.toml");
    let text = format!("format = 1\nsource = \"the text of the page\"\n{checks}\n");
    std::fs::write(&file, text).map_err(|e| e.to_string())?;
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(["compare", results.trim(), "asserted.toml"])
        .current_dir(folder)
        .output()
        .map_err(|e| e.to_string())?;
    match output.status.success() {
        true => Ok(()),
        false => Err([output.stdout, output.stderr]
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .concat()),
    }
}

/// `TIME` and a column of the history of a run.
fn columns(folder: &Path, results: &str, name: &str) -> Result<Vec<(f64, f64)>, String> {
    let path = folder.join(results).join("history.csv");
    let table = stickslip::io::csv::read(&path).map_err(|e| e.to_string())?;
    let column = |name: &str| {
        let at = table.names.iter().position(|n| n == name);
        at.map(|i| &table.columns[i])
            .ok_or_else(|| format!("there is no column {name}"))
    };
    let pairs = column("TIME")?.iter().zip(column(name)?);
    Ok(pairs.map(|(&t, &x)| (t, x)).collect())
}

/// A number behind a word.
fn number(text: &str, word: &str) -> Result<f64, String> {
    let mut words = text.split([' ', ',', '=']).filter(|w| !w.is_empty());
    words
        .find(|w| *w == word)
        .and_then(|_| words.next()?.parse().ok())
        .ok_or_else(|| format!("`{text}` has no number behind `{word}`"))
}

fn near(what: &str, found: f64, wanted: f64, within: f64) -> Result<(), String> {
    match (found - wanted).abs() <= within * wanted.abs() {
        true => Ok(()),
        false => Err(format!("{what} is {found}, not {wanted} to {within}")),
    }
}

/// Period and range of a column that goes up and down: from where it rises through the middle of its range.
fn cycle(rest: &str, folder: &Path) -> Result<(), String> {
    let mut names = rest.split_whitespace();
    let (results, column) = (names.next().unwrap_or(""), names.next().unwrap_or(""));
    let after = number(rest, "after")?;
    let all = columns(folder, results, column)?;
    let late: Vec<(f64, f64)> = all.into_iter().filter(|(t, _)| *t > after).collect();
    let values = late.iter().map(|(_, x)| *x);
    let high = values.clone().fold(f64::NEG_INFINITY, f64::max);
    let low = values.fold(f64::INFINITY, f64::min);
    let middle = 0.5 * (high + low);
    let rises: Vec<f64> = late
        .windows(2)
        .filter(|w| w[0].1 < middle && middle <= w[1].1)
        .map(|w| w[0].0 + (middle - w[0].1) / (w[1].1 - w[0].1) * (w[1].0 - w[0].0))
        .collect();
    let [first, .., last] = rises.as_slice() else {
        return Err(format!("{column} does not go up and down after {after}"));
    };
    let within = number(rest, "within")?;
    let period = (last - first) / (rises.len() - 1) as f64;
    near("the period", period, number(rest, "period")?, within)?;
    near("the range", high - low, number(rest, "range")?, within)
}

/// That a column stays at a value for a time at least.
fn follows(rest: &str, folder: &Path) -> Result<(), String> {
    let mut names = rest.split_whitespace();
    let (results, column) = (names.next().unwrap_or(""), names.next().unwrap_or(""));
    let value: f64 = (names.next().and_then(|w| w.parse().ok())).ok_or("a value is missing")?;
    let (wanted, within) = (number(rest, "for")?, number(rest, "within")?);
    let (mut since, mut longest) = (None, 0.0_f64);
    for (t, x) in columns(folder, results, column)? {
        if near(column, x, value, within).is_ok() {
            longest = longest.max(t - *since.get_or_insert(t));
        } else {
            since = None;
        }
    }
    match longest >= wanted {
        true => Ok(()),
        false => Err(format!("{column} stays at {value} for {longest} only")),
    }
}

/// That two runs have the same history, to the bit.
fn equal(rest: &str, folder: &Path) -> Result<(), String> {
    let read = |results: &str| std::fs::read(folder.join(results).join("history.csv"));
    let [a, b] = rest.split_whitespace().collect::<Vec<_>>()[..] else {
        return Err("two folders of results are compared".into());
    };
    match (read(a), read(b)) {
        (Ok(x), Ok(y)) if x == y => Ok(()),
        (Ok(_), Ok(_)) => Err(format!("the histories of {a} and {b} differ")),
        (Err(e), _) | (_, Err(e)) => Err(e.to_string()),
    }
}
