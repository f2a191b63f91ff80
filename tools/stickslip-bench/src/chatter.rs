//! `cargo xtask chatter`: cases in which many points change status, with the iterations and fallbacks they take.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::peers::table::Table;
use xtask::workspace;

/// Runs all cases and prints a table.
pub fn measure() -> Result<(), String> {
    let binary = workspace::stickslip()?;
    let table = Table::new(
        "Chatter: points that open, close, stick and slip in turn",
        &[
            "case",
            "increments",
            "cut-backs",
            "iterations, median",
            "largest",
            "largest change of open or sticking points over an increment",
            "fallbacks",
        ],
    );
    let fixed = |step: usize, n: usize| format!("step.{}.increments={{ fixed = {n} }}", step + 1);
    for cells in [32, 128] {
        for n in [1, 5, 20] {
            let mut settings: Vec<String> = (0..4).map(|step| fixed(step, n)).collect();
            settings.push(format!(
                "body.block.generate.rectangle.cells=[{cells}, {cells}]"
            ));
            let name = format!("GRECO {cells} × {cells}, {n} an act");
            run(&binary, &table, &name, "greco", &settings)?;
        }
    }
    for n in [1, 4] {
        let settings = [
            fixed(1, n),
            fixed(2, 2 * n),
            fixed(3, n),
            "body.block.generate.rectangle.cells=[40, 80]".to_string(),
            "body.lower.generate.rectangle.cells=[128, 32]".to_string(),
        ];
        let name = format!("rocking block, {n} a quarter");
        run(&binary, &table, &name, "rocking", &settings)?;
    }
    for n in [10, 30] {
        let name = format!("ironing, {n} increments");
        run(&binary, &table, &name, "ironing", &[fixed(1, n)])?;
    }
    Ok(())
}

fn run(
    binary: &Path,
    table: &Table,
    name: &str,
    case: &str,
    settings: &[String],
) -> Result<(), String> {
    let out = workspace::target().join("chatter").join(case);
    let _ = fs::remove_dir_all(&out);
    let file = workspace::root().join(format!("crates/stickslip/tests/chatter/{case}.toml"));
    let mut command = Command::new(binary);
    command
        .arg("run")
        .arg(&file)
        .arg("--quiet")
        .arg("-o")
        .arg(&out);
    for setting in settings {
        command.args(["--set", setting]);
    }
    // A run that fails is a row of the table.
    command
        .stdout(Stdio::null())
        .status()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    let read = |name: &str| {
        let file = out.join(name);
        fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))
    };
    let summary: Value =
        serde_json::from_str(&read("summary.json")?).map_err(|e| format!("summary.json: {e}"))?;
    let history = read("history.csv")?;
    let mut iterations = column(&history, "ITRS")?;
    let statuses = [column(&history, "OPEN")?, column(&history, "STICK")?];
    let moved = (1..iterations.len())
        .map(|k| {
            let change = statuses.iter().map(|s| (s[k] - s[k - 1]).abs());
            change.fold(0.0, f64::max)
        })
        .fold(0.0, f64::max);
    iterations.sort_by(f64::total_cmp);
    let n = iterations.len();
    let median = match n {
        0 => 0.0,
        n => 0.5 * (iterations[(n - 1) / 2] + iterations[n / 2]),
    };
    let done = summary["completed"].as_bool().unwrap_or(false);
    table.row([
        format!("{name}{}", if done { "" } else { " (not finished)" }),
        n.to_string(),
        summary["cutbacks"].to_string(),
        median.to_string(),
        iterations.last().unwrap_or(&0.0).to_string(),
        moved.to_string(),
        fallbacks(&summary["fallbacks"]),
    ]);
    Ok(())
}

/// How often which way was taken, and how often it helped.
fn fallbacks(list: &Value) -> String {
    let mut kinds: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for tried in list.as_array().into_iter().flatten() {
        let counts = kinds
            .entry(tried["kind"].as_str().unwrap_or("?"))
            .or_default();
        counts[0] += 1;
        counts[1] += usize::from(tried["converged"].as_bool().unwrap_or(false));
    }
    if kinds.is_empty() {
        return "none".into();
    }
    let each = kinds
        .iter()
        .map(|(kind, [n, of])| format!("{kind} {of} of {n}"));
    each.collect::<Vec<_>>().join(", ")
}

/// A column of a table with heads.
fn column(text: &str, name: &str) -> Result<Vec<f64>, String> {
    let mut lines = text.lines();
    let heads = lines.next().unwrap_or("");
    let at = heads.split(',').position(|head| head == name);
    let at = at.ok_or_else(|| format!("the history has no {name}"))?;
    let numbers = lines.map(|line| line.split(',').nth(at)?.parse().ok());
    let numbers: Option<Vec<f64>> = numbers.collect();
    numbers.ok_or_else(|| format!("{name} is not a column of numbers"))
}
