//! The verification report: every check of every example with the number that a run gives.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::workspace;

/// A run is given up after this time `[s]`.
const PATIENCE: u64 = 1800;

/// What a run of `expected*.toml` has given.
struct Run {
    /// The file, from `examples/` on.
    expected: String,
    /// The command, as a user would type it.
    command: String,
    /// How long it took; not on the page, which should change only when numbers do.
    seconds: f64,
    /// A row a check: what, value, expected, error, tolerance, source.
    rows: Vec<[String; 6]>,
    /// Why there are no rows.
    failure: Option<String>,
}

/// Runs all examples and writes the page. Runs that take too long for a test are left out unless `full`.
pub fn page(full: bool) -> Result<String, String> {
    let binary = workspace::stickslip()?;
    let folder = workspace::root().join("examples");
    let work = workspace::target().join("verification");
    let mut examples: Vec<PathBuf> = list(&folder)?;
    examples.retain(|p| p.join("case.toml").is_file());
    let mut runs: BTreeMap<String, Vec<Run>> = BTreeMap::new();
    for example in &examples {
        let name = name(example);
        for file in list(example)? {
            let stem = self::name(&file);
            if stem.starts_with("expected") && stem.ends_with(".toml") {
                let run = check(&binary, example, &file, &work, full)?;
                println!(
                    "{}: {} checks, {:.1} s",
                    run.expected,
                    run.rows.len(),
                    run.seconds
                );
                runs.entry(name.clone()).or_default().push(run);
            }
        }
    }
    Ok(written(&runs))
}

fn check(
    binary: &Path,
    example: &Path,
    file: &Path,
    work: &Path,
    full: bool,
) -> Result<Run, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let expected: toml::Table =
        toml::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let case = expected
        .get("case")
        .and_then(|c| c.as_str())
        .unwrap_or("case.toml");
    let overrides: Vec<&str> = expected
        .get("overrides")
        .and_then(|o| o.as_array())
        .into_iter()
        .flatten()
        .filter_map(|o| o.as_str())
        .collect();
    let label = format!("{}/{}", name(example), name(file));
    let out = work.join(label.replace('/', "-"));
    let mut command = format!("stickslip run examples/{}/{case}", name(example));
    for change in &overrides {
        let _ = write!(command, " --set '{change}'");
    }
    let mut run = Run {
        expected: label,
        command,
        seconds: 0.0,
        rows: Vec::new(),
        failure: None,
    };
    if !full && expected.get("tested").and_then(|t| t.as_bool()) == Some(false) {
        run.failure =
            Some("Left out here, as it takes minutes: see the README of the example.".to_string());
        return Ok(run);
    }
    let start = Instant::now();
    let mut process = Command::new("timeout");
    process
        .arg(PATIENCE.to_string())
        .arg(binary)
        .args(["run", "--quiet"]);
    process.arg(example.join(case)).arg("--output").arg(&out);
    for change in &overrides {
        process.args(["--set", change]);
    }
    let output = process
        .output()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    run.seconds = start.elapsed().as_secs_f64();
    if !output.status.success() {
        run.failure = Some(match output.status.code() {
            Some(124) => format!("Not run: it takes more than {PATIENCE} s."),
            code => format!("**The run ended with exit code {code:?}.**"),
        });
        return Ok(run);
    }
    let output = Command::new(binary)
        .arg("compare")
        .args([&out, file])
        .output()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    let common = expected
        .get("source")
        .and_then(|s| s.as_str())
        .unwrap_or("");
    let checks = expected.get("check").and_then(|c| c.as_array());
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    for (line, check) in lines.lines().skip(1).zip(checks.into_iter().flatten()) {
        let what = check.get("what").and_then(|w| w.as_str()).unwrap_or("");
        let source = check
            .get("source")
            .and_then(|s| s.as_str())
            .unwrap_or(common);
        let mut cells = line.rsplit("  ").map(str::trim).filter(|c| !c.is_empty());
        let mut cell = || cells.next().unwrap_or("").to_string();
        let (tolerance, error, reference, value) = (cell(), cell(), cell(), cell());
        let mark = if line.starts_with("ok") {
            ""
        } else {
            "**fails** "
        };
        run.rows.push([
            format!("{mark}{what}"),
            value,
            reference,
            error,
            tolerance,
            source.to_string(),
        ]);
    }
    Ok(run)
}

fn written(runs: &BTreeMap<String, Vec<Run>>) -> String {
    let all = || runs.values().flatten();
    let rows = || all().flat_map(|r| &r.rows);
    let failed = rows().filter(|r| r[0].starts_with("**")).count();
    let left = all().filter(|r| r.failure.is_some()).count();
    let mut page = String::from(
        "# Verification report\n\n<!-- Generated by `cargo xtask book --verification`. -->\n\n",
    );
    let _ = write!(
        page,
        "Every check of every example of `examples/`, with the number that a run gave, the reference, the difference, the tolerance, \
        and where the reference comes from. References are closed forms, published numbers, independent solutions and the statements of \
        conservation that any solution has to obey; \
        tolerances follow from mesh and source, not from what the program gives. The same checks are run by `cargo test`, and single ones by \
        `stickslip compare`.\n\n\
        {} checks in {} runs of {} examples: **{} pass**, {failed} fail; {left} runs were left out.\n\n\
        [Input decks of CalculiX](decks.md) has the same for the decks of its test suite.\n",
        rows().count(),
        all().count() - left,
        runs.len(),
        rows().count() - failed,
    );
    page += "\n| example | runs | checks |\n|---|---|---|\n";
    for (name, list) in runs {
        let count: usize = list.iter().map(|r| r.rows.len()).sum();
        let _ = writeln!(page, "| [{name}](#{name}) | {} | {count} |", list.len());
    }
    for (name, list) in runs {
        let _ = write!(page, "\n## {name}\n");
        for run in list {
            let _ = write!(
                page,
                "\n### {}\n\n`{}`\n\n",
                run.expected,
                run.command.replace('|', "\\|")
            );
            if let Some(failure) = &run.failure {
                let _ = writeln!(page, "{failure}");
                continue;
            }
            table(&mut page, &run.rows);
        }
    }
    page
}

/// The rows, with the sources below as numbered notes, because many rows share one.
fn table(page: &mut String, rows: &[[String; 6]]) {
    let mut sources: Vec<&str> = Vec::new();
    *page += "| quantity | value | reference | error | tolerance | source |\n|---|---|---|---|---|---|\n";
    for [what, value, reference, error, tolerance, source] in rows {
        let number = match sources.iter().position(|s| s == source) {
            Some(number) => number,
            None => {
                sources.push(source);
                sources.len() - 1
            }
        };
        let cells = [what, value, reference, error, tolerance].map(|c| escaped(c));
        let _ = writeln!(page, "| {} | {} |", cells.join(" | "), number + 1);
    }
    page.push('\n');
    for (i, source) in sources.iter().enumerate() {
        let _ = writeln!(page, "{}. {}", i + 1, escaped(source));
    }
}

fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
        .replace('<', "&lt;")
        .replace('\n', " ")
}

fn list(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    Ok(paths)
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
