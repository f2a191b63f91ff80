//! `cargo xtask mixes`: random mixes of features, each run by itself and in pairs that must agree, judged without a reference.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use stickslip_audit::mix::{self, Mix, Relation, WITHOUT_PENALTY, pair};
use stickslip_audit::verdict::Verdict;

use crate::robustness::entry::{self, Entry};
use crate::robustness::{outcome, summary};
use xtask::workspace;

/// What a run may take; one takes a second.
const LIMIT: Duration = Duration::from_secs(60);

/// What the command line asks for.
#[derive(Debug)]
struct Wish {
    seed: u64,
    from: u64,
    count: u64,
    keep: Option<PathBuf>,
    binary: Option<PathBuf>,
}

/// Runs the mixes and prints a table in Markdown and a summary.
///
/// # Errors
/// The command line is wrong, a file cannot be written, or the program broke a promise.
pub fn sweep(words: &[String]) -> Result<(), String> {
    let wish = read(words)?;
    let binary = match &wish.binary {
        Some(binary) => binary.clone(),
        None => workspace::stickslip()?,
    };
    let folder = match &wish.keep {
        Some(folder) => folder.clone(),
        None => workspace::target().join("mixes"),
    };
    entry::heads();
    let mut entries = Vec::new();
    for number in wish.from..wish.from + wish.count {
        let mix = mix::problem(wish.seed, number);
        let place = folder.join(format!("{}-{number:03}", wish.seed));
        let entry = one(&binary, &mix, wish.seed, number, &place)?;
        entry.print();
        let kept = wish.keep.is_some()
            || entry.outcome.verdict != Verdict::Sound
            || !entry.outcome.lines.is_empty();
        if !kept {
            let _ = fs::remove_dir_all(&place);
        }
        entries.push(entry);
    }
    summary::print(&entries);
    println!("\ncases and results that are kept: {}", folder.display());
    let broken: Vec<&str> = entries
        .iter()
        .filter(|e| e.outcome.verdict.broken())
        .map(|e| e.name.as_str())
        .collect();
    match broken.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "the program broke a promise in {}",
            broken.join(", ")
        )),
    }
}

/// Runs a mix and what must agree with it.
fn one(binary: &Path, mix: &Mix, seed: u64, number: u64, place: &Path) -> Result<Entry, String> {
    let file = place.join("case.toml");
    let title = format!("Mix {number} of series {seed}");
    fs::create_dir_all(place)
        .and_then(|()| fs::write(&file, mix.text(mix.view, &title)))
        .map_err(|e| format!("{}: {e}", file.display()))?;
    let out = place.join("case.out");
    let mut outcome = outcome::run(binary, &pair::first(mix, &file, &out), place, LIMIT)?;
    let mut names = Vec::new();
    if matches!(outcome.exit, Some(0 | 2)) {
        for relation in &mix.relations {
            names.push(relation.name);
            let passed = outcome.exit == Some(0);
            let second = again(binary, mix, relation, &out, passed, place)?;
            outcome.seconds += second.seconds;
            outcome.lines.extend(second.lines);
            if let Some(verdict) = second.verdict.filter(|_| !outcome.verdict.broken()) {
                outcome.verdict = verdict;
            }
        }
    }
    if outcome.verdict == Verdict::FalseAlarm && WITHOUT_PENALTY.fits(&mix.features) {
        names.push(WITHOUT_PENALTY.name);
        let folder = place.join("without-penalty");
        let job = pair::prepare(mix, &WITHOUT_PENALTY, &out, &folder)?;
        let exact = outcome::run(binary, &job.words, &folder, LIMIT)?;
        outcome.seconds += exact.seconds;
        if exact.exit == Some(0) {
            let (off, what) = pair::judge(mix, &WITHOUT_PENALTY, &out, &job.out)?;
            if off > 1.0 {
                outcome.verdict = Verdict::Rightly;
                outcome.lines.push(format!("without penalty: {what}"));
            }
        }
    }
    let spaces = ["plane-strain", "plane-stress", "axisymmetric", "solid"];
    let family = spaces.into_iter().find(|s| mix.features.contains(s));
    Ok(Entry {
        name: format!("{seed}-{number:03}"),
        family: family.unwrap_or(""),
        words: format!("{}; {}", mix.words(), names.join(", ")),
        outcome,
    })
}

/// What a second run adds to the judgement of the first.
struct Second {
    seconds: f64,
    lines: Vec<String>,
    verdict: Option<Verdict>,
}

fn again(
    binary: &Path,
    mix: &Mix,
    relation: &Relation,
    first: &Path,
    passed: bool,
    place: &Path,
) -> Result<Second, String> {
    let name = relation.name;
    let folder = place.join(name.replace(' ', "-"));
    let job = pair::prepare(mix, relation, first, &folder)?;
    let run = outcome::run(binary, &job.words, &folder, LIMIT)?;
    let mut second = Second {
        seconds: run.seconds,
        lines: Vec::new(),
        verdict: None,
    };
    match run.exit {
        Some(0 | 2) => {
            let (off, what) = pair::judge(mix, relation, first, &job.out)?;
            if off.is_nan() || off > 1.0 {
                second
                    .lines
                    .push(format!("{name}, exit {}: {what}", run.exit.unwrap_or(-1)));
                // Where the gate failed one of them the program said so.
                if passed && run.exit == Some(0) {
                    second.verdict = Some(Verdict::Disagreement);
                }
            } else if job.own && run.verdict.broken() {
                second.verdict = Some(run.verdict);
                second
                    .lines
                    .extend(run.lines.iter().map(|line| format!("{name}: {line}")));
            }
        }
        // It stopped where the first did not: counted by its word.
        _ => {
            second.lines.extend(
                run.lines
                    .iter()
                    .map(|line| format!("{name}, {}: {line}", run.verdict.words())),
            );
            if run.verdict.broken() {
                second.verdict = Some(run.verdict);
            }
        }
    }
    Ok(second)
}

/// Reads the command line.
fn read(words: &[String]) -> Result<Wish, String> {
    let mut wish = Wish {
        seed: 1,
        from: 1,
        count: 300,
        keep: None,
        binary: None,
    };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        let number = || {
            let n = value.parse::<u64>().ok().filter(|n| *n <= 1_000_000);
            n.ok_or(format!("{word}: a whole number up to a million"))
        };
        let path = || std::path::absolute(value).map_err(|e| format!("{value}: {e}"));
        match word.as_str() {
            "--seed" => wish.seed = number()?,
            "--from" => wish.from = number()?,
            "--count" => wish.count = number()?,
            "--keep" => wish.keep = Some(path()?),
            "--binary" => wish.binary = Some(path()?),
            _ => return Err(format!("mixes has no option {word}")),
        }
    }
    Ok(wish)
}
