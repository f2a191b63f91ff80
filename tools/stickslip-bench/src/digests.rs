//! `cargo xtask digests FILE`: what every example, random problem and deck writes, as digests that two versions can be compared by.

use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use stickslip_audit::csv;
use stickslip_audit::draw;

use xtask::examples;
use xtask::workspace;

/// A run is given up after this time `[s]`, and its digest compared with nothing.
const PATIENCE: u64 = 300;

/// What is not the same for the same result: times, and what the run was called with.
const NO_RESULTS: [&str; 4] = ["summary.json", "problem.toml", "run.lock", "report.html"];

/// A run to make: its name, and how it is called.
struct Case {
    name: String,
    file: PathBuf,
    overrides: Vec<String>,
}

/// What the command line asks for.
struct Wish {
    table: PathBuf,
    problems: u64,
    decks: PathBuf,
}

/// Runs everything, and writes the table or compares with the one that is there.
///
/// # Errors
/// The command line is wrong, a file cannot be read or written, or something differs.
pub fn run(words: &[String]) -> Result<(), String> {
    let wish = read(words)?;
    let binary = workspace::stickslip()?;
    // The histories of the table's own run stay beside it, so that a difference has a size.
    let kept = wish.table.with_extension("histories");
    let before = fs::read_to_string(&wish.table).ok();
    let work = match before {
        None => kept.clone(),
        Some(_) => workspace::target().join("digests"),
    };
    let mut now = String::new();
    for case in cases(&wish, &work)? {
        let line = one(&binary, &case, &work.join(&case.name))?;
        println!("{line}");
        now += &line;
        now.push('\n');
    }
    let Some(before) = before else {
        return fs::write(&wish.table, now).map_err(|e| format!("{}: {e}", wish.table.display()));
    };
    let differences = differences(&before, &now, &kept, &work);
    match differences.is_empty() {
        true => {
            println!("all {} digests are equal", now.lines().count());
            Ok(())
        }
        false => Err(format!("these differ:\n{}", differences.join("\n"))),
    }
}

fn read(words: &[String]) -> Result<Wish, String> {
    let mut wish = Wish {
        table: PathBuf::new(),
        problems: 60,
        decks: workspace::root().join("../shared/decks/calculix"),
    };
    let mut paths = Vec::new();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--problems" => {
                let count = words.next().and_then(|n| n.parse().ok());
                wish.problems = count.ok_or("--problems needs a whole number")?;
            }
            path => {
                paths.push(std::path::absolute(path).map_err(|e| format!("{path}: {e}"))?);
            }
        }
    }
    let mut paths = paths.into_iter();
    wish.table = paths.next().ok_or("digests needs the name of a file")?;
    wish.decks = paths.next().unwrap_or(wish.decks);
    Ok(wish)
}

fn cases(wish: &Wish, work: &Path) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for example in examples::all()?.into_iter().filter(|e| e.tested) {
        cases.push(Case {
            name: example.label.replace('/', "-").replace(".toml", ""),
            file: example.folder.join(example.case),
            overrides: example.overrides,
        });
    }
    let drawn = work.join("drawn");
    fs::create_dir_all(&drawn).map_err(|e| format!("{}: {e}", drawn.display()))?;
    for number in 1..=wish.problems {
        let file = drawn.join(format!("{number:03}.toml"));
        fs::write(&file, draw::problem(1, number).text)
            .map_err(|e| format!("{}: {e}", file.display()))?;
        cases.push(Case {
            name: format!("random-{number:03}"),
            file,
            overrides: vec!["output.every=1".to_string()],
        });
    }
    // Decks are not part of the project; without them the rest is worth comparing all the same.
    for file in examples::list(&wish.decks).unwrap_or_default() {
        if file.extension().is_some_and(|e| e == "inp") {
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            cases.push(Case {
                name: format!("deck-{stem}"),
                file,
                overrides: Vec::new(),
            });
        }
    }
    Ok(cases)
}

/// Makes a run and digests what it leaves: name, exit code, and digests of histories, fields and everything else.
fn one(binary: &Path, case: &Case, out: &Path) -> Result<String, String> {
    let _ = fs::remove_dir_all(out);
    let status = Command::new("timeout")
        .arg(PATIENCE.to_string())
        .arg(binary)
        .args(["run", "--quiet", "--threads", "1", "--output"])
        .args([out, &case.file])
        .args(case.overrides.iter().flat_map(|o| ["--set", o]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    let exit = match status.code() {
        Some(124) => return Ok(format!("{} late", case.name)),
        code => code.unwrap_or(-1),
    };
    let mut kinds: BTreeMap<&str, DefaultHasher> = BTreeMap::new();
    for kind in ["histories", "fields", "others"] {
        kinds.insert(kind, DefaultHasher::new());
    }
    for file in files(out) {
        let ending = file.extension().unwrap_or_default().to_string_lossy();
        let kind = match ending.as_ref() {
            "csv" => "histories",
            "vtu" | "pvd" => "fields",
            _ => "others",
        };
        let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        if let Some(digest) = kinds.get_mut(kind) {
            digest.write(examples::name(&file).as_bytes());
            digest.write(&bytes);
        }
        if kind == "fields" {
            // Fields are large, and their size is not looked at.
            let _ = fs::remove_file(&file);
        }
    }
    let digests: Vec<String> = kinds
        .iter()
        .map(|(kind, digest)| format!("{kind} {:016x}", digest.finish()))
        .collect();
    Ok(format!("{} exit {exit} {}", case.name, digests.join(" ")))
}

/// All result files of a folder and those in it, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = all_files(folder);
    found.retain(|path| !NO_RESULTS.contains(&examples::name(path).as_str()));
    found
}

/// All files of a folder and those in it, by name.
pub fn all_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in examples::list(folder).unwrap_or_default() {
        match path.is_dir() {
            true => found.extend(all_files(&path)),
            false => found.push(path),
        }
    }
    found
}

/// A line for every run that is not the same in both tables.
fn differences(before: &str, now: &str, kept: &Path, work: &Path) -> Vec<String> {
    let rows = |text: &str| -> BTreeMap<String, String> {
        let split = |line: &str| line.split_once(' ').map(|(n, r)| (n.into(), r.into()));
        text.lines().filter_map(split).collect()
    };
    let (before, now) = (rows(before), rows(now));
    let mut lines = Vec::new();
    for (name, was) in &before {
        let Some(is) = now.get(name) else {
            lines.push(format!("{name}: not run"));
            continue;
        };
        if was == is || was == "late" || is == "late" {
            continue;
        }
        let history = |folder: &Path| folder.join(name).join("history.csv");
        let size = difference(&history(kept), &history(work));
        lines.push(format!("{name}: {size}\n  was {was}\n  is  {is}"));
    }
    let new = now.keys().filter(|name| !before.contains_key(*name));
    lines.extend(new.map(|name| format!("{name}: was not run before")));
    lines
}

/// By how much two histories differ: the largest difference of a column over the largest value in it.
fn difference(before: &Path, now: &Path) -> String {
    let (Ok(before), Ok(now)) = (csv::read(before), csv::read(now)) else {
        return "one of them has no history".to_string();
    };
    if before.rows() != now.rows() {
        return format!("{} increments, {} before", now.rows(), before.rows());
    }
    let mut worst = (0.0, "");
    for (name, a) in &before.columns {
        let Some(b) = now.column(name) else {
            return format!("there is no column {name}");
        };
        let scale = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let off = a
            .iter()
            .zip(b)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        if off > worst.0 * scale && off > 0.0 {
            worst = (off / scale, name);
        }
    }
    match worst {
        (_, "") => "histories have the same numbers".to_string(),
        (off, name) => format!("{name} by {off:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_listed_and_what_was_late_is_not() {
        let before = "a exit 0 fields 1\nb late\nc exit 0 fields 2\nd exit 0 fields 3\n";
        let now = "a exit 0 fields 1\nb exit 0 fields 9\nc exit 2 fields 2\ne exit 0 fields 4\n";
        let nowhere = Path::new("/nowhere");
        let lines = differences(before, now, nowhere, nowhere);
        let names: Vec<&str> = lines.iter().filter_map(|l| l.split(':').next()).collect();
        assert_eq!(names, ["c", "d", "e"]);
    }
}
