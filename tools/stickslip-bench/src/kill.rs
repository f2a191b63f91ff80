//! `cargo xtask kill`: runs that are killed at random times and go on, compared with runs that never stopped.
//!
//! A case is run once to its end. Then it is begun anew again and again, killed (SIGKILL) after a random part of the time it takes, taken up by
//! `stickslip resume` (`sweep --resume`), killed once more, up to [`MOST`] times, and run to its end. All files that are then in its folder have
//! to be those of the first run, byte by byte, and none may be there besides: histories, fields, tables, `.dat` and `.sta` files, the problem. Left out is
//! what names the process: `run.lock`; checkpoints, in which counts of factors are; of `summary.json` times, memory and counts of factors; and
//! the table of what the runs of a sweep took.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use stickslip_audit::draw::Random;

use crate::digests::all_files;
use xtask::examples::name;
use xtask::workspace;

/// Kills of one run at most.
const MOST: usize = 5;

/// The latest kill, over the time of a whole run: some come when a run that goes on has ended.
const LATEST: f64 = 0.8;

/// A run that takes longer than so many times the whole one hangs.
const PATIENCE: f64 = 60.0;

/// A case: what is run, and how it goes on.
struct Case {
    name: &'static str,
    /// The command that begins, behind the binary; `OUT` is the folder of its results, `CACHE` one of factors beside it.
    begin: &'static [&'static str],
    /// It is a sweep, which goes on by its own command.
    sweep: bool,
}

const CASES: [Case; 7] = [
    Case {
        name: "statics",
        begin: &[
            "run",
            "examples/cattaneo-mindlin/case.toml",
            "--set",
            "solver.method=sparse",
            "--set",
            "output={ every = 4, checkpoint = { increments = 1 } }",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
    Case {
        name: "implicit",
        begin: &[
            "run",
            "examples/compliance-impact/case.toml",
            "--set",
            "output={ every = 20, checkpoint = { increments = 3 } }",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
    Case {
        name: "explicit",
        begin: &[
            "run",
            "examples/steel-bar/case.toml",
            "--set",
            "body.bar.generate.box.cells=[2,2,80]",
            "--set",
            "output={ every = 50, checkpoint = { increments = 10 } }",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
    Case {
        name: "sweep",
        begin: &[
            "sweep",
            "examples/belt-mass/case.toml",
            "--set",
            "step.2.duration=0.1,0.2,0.3,0.4",
            "--set",
            "step.2.increments.initial=4e-4,8e-4",
            "--results",
            "OUT/runs",
            "--output",
            "OUT/table.csv",
        ],
        sweep: true,
    },
    Case {
        name: "deck",
        begin: &[
            "run",
            "crates/stickslip-cli/tests/decks/slide.inp",
            "--set",
            "step.1.increments={ fixed = 40 }",
            "--set",
            "step.2.increments={ fixed = 60 }",
            "--set",
            "output={ every = 1, checkpoint = { increments = 1 } }",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
    Case {
        name: "multigrid",
        begin: &[
            "run",
            "examples/shrink-fit/case.toml",
            "--set",
            "solver.method=multigrid",
            "--set",
            "step.1.increments.fixed=80",
            "--set",
            "output={ every = 4, checkpoint = { increments = 1 } }",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
    Case {
        name: "condensed",
        begin: &[
            "run",
            "examples/fretting-sphere/case.toml",
            "--set",
            "step.1.increments.fixed=2",
            "--set",
            "step.2.increments.fixed=4",
            "--set",
            "step.3.increments.fixed=8",
            "--set",
            "step.4.increments.fixed=8",
            "--set",
            "output={ every = 4, checkpoint = { increments = 1 } }",
            "--cache",
            "CACHE",
            "--output",
            "OUT",
        ],
        sweep: false,
    },
];

/// What came of a case.
#[derive(Default)]
struct Outcome {
    kills: usize,
    runs: usize,
    /// What was not the same, a line each.
    faults: Vec<String>,
}

/// Kills and compares.
///
/// # Errors
/// The command line is wrong, a case cannot be run, or a run that went on came to something else.
pub fn run(words: &[String]) -> Result<(), String> {
    let (kills, seed, only) = read(words)?;
    let binary = workspace::stickslip()?;
    let work = workspace::target().join("kill");
    let cases: Vec<&Case> = CASES
        .iter()
        .filter(|case| only.is_empty() || only.iter().any(|name| name == case.name))
        .collect();
    let mut random = Random::new(seed);
    let mut faults = Vec::new();
    println!(
        "| case | whole run, s | kills | runs killed and taken up | not the same |\n|---|---|---|---|---|"
    );
    for (i, case) in cases.iter().enumerate() {
        // The first cases get what is left over.
        let share = kills / cases.len() + usize::from(i < kills % cases.len());
        let folder = work.join(case.name);
        let _ = fs::remove_dir_all(&folder);
        let begun = Instant::now();
        let whole = folder.join("whole");
        let status = patient(start(&binary, case, &whole, false)?, f64::INFINITY)?;
        let seconds = begun.elapsed().as_secs_f64();
        let wanted = contents(&whole)?;
        let mut outcome = Outcome::default();
        while outcome.kills < share {
            outcome.runs += 1;
            let out = folder.join(format!("{:04}", outcome.runs));
            let left = (share - outcome.kills).min(MOST);
            let (killed, last) = torment(&binary, case, &out, left, seconds, &mut random)?;
            outcome.kills += killed;
            let found = contents(&out)?;
            let mut lines = differences(&wanted, &found);
            if last != status {
                lines.push(format!(
                    "exit code {last:?}, and {status:?} of the whole run"
                ));
            }
            if lines.is_empty() {
                let _ = fs::remove_dir_all(&out);
                let _ = fs::remove_dir_all(beside(&out));
            }
            let label = format!("{} {:04}", case.name, outcome.runs);
            outcome
                .faults
                .extend(lines.iter().map(|line| format!("{label}: {line}")));
        }
        println!(
            "| {} | {seconds:.2} | {} | {} | {} |",
            case.name,
            outcome.kills,
            outcome.runs,
            outcome.faults.len()
        );
        faults.extend(outcome.faults);
    }
    match faults.is_empty() {
        true => Ok(()),
        false => Err(format!("in {}:\n{}", work.display(), faults.join("\n"))),
    }
}

fn read(words: &[String]) -> Result<(usize, u64, Vec<String>), String> {
    let (mut kills, mut seed, mut only) = (200, 1, Vec::new());
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let number = |next: Option<&String>| {
            let number = next.and_then(|n| n.parse::<u64>().ok());
            number.ok_or(format!("{word} needs a whole number"))
        };
        match word.as_str() {
            "--kills" => kills = number(words.next())? as usize,
            "--seed" => seed = number(words.next())?,
            name if CASES.iter().any(|case| case.name == name) => only.push(word.clone()),
            other => {
                let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
                return Err(format!("there is no case {other}: {}", names.join(", ")));
            }
        }
    }
    Ok((kills, seed, only))
}

/// The folder of factors of a run.
fn beside(out: &Path) -> PathBuf {
    out.with_extension("cache")
}

/// Begins a run, or goes on with it.
fn start(binary: &Path, case: &Case, out: &Path, on: bool) -> Result<Child, String> {
    let mut command = Command::new(binary);
    command.current_dir(workspace::root());
    match on && !case.sweep {
        true => {
            command.arg("resume").arg(out);
        }
        false => {
            let place = |word: &&str| {
                word.replace("OUT", &out.to_string_lossy())
                    .replace("CACHE", &beside(out).to_string_lossy())
            };
            command.args(case.begin.iter().map(place));
            command.args((on && case.sweep).then_some("--resume"));
        }
    }
    fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let told = fs::File::create(out.with_extension("log"));
    let told = told.map_err(|e| format!("{}: {e}", out.display()))?;
    command
        .args(["--quiet", "--threads", "1"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(told)
        .spawn()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))
}

/// Waits for the end; the exit code.
fn patient(mut child: Child, seconds: f64) -> Result<Option<i32>, String> {
    match wait(&mut child, seconds)? {
        Some(code) => Ok(code),
        None => {
            let _ = child.kill();
            let _ = child.wait();
            Err(format!("a run has not ended after {seconds:.0} s"))
        }
    }
}

/// The exit code, if it ends in so many seconds.
fn wait(child: &mut Child, seconds: f64) -> Result<Option<Option<i32>>, String> {
    let begun = Instant::now();
    loop {
        let ended = child
            .try_wait()
            .map_err(|e| format!("a run is lost: {e}"))?;
        if let Some(status) = ended {
            return Ok(Some(status.code()));
        }
        let left = seconds - begun.elapsed().as_secs_f64();
        if left <= 0.0 {
            return Ok(None);
        }
        std::thread::sleep(Duration::from_secs_f64(left.min(2e-3)));
    }
}

/// Runs a case that is killed up to so many times, to its end; how often it was, and the last exit code.
fn torment(
    binary: &Path,
    case: &Case,
    out: &Path,
    kills: usize,
    seconds: f64,
    random: &mut Random,
) -> Result<(usize, Option<i32>), String> {
    let mut killed = 0;
    loop {
        let on = case.sweep || !checkpoints(out).is_empty();
        let mut child = start(binary, case, out, on && killed > 0)?;
        if killed == kills {
            let late = PATIENCE * (seconds + 1.0);
            return patient(child, late).map(|code| (killed, code));
        }
        let moment = random.between(0.0, LATEST) * seconds;
        if let Some(code) = wait(&mut child, moment)? {
            return Ok((killed, code));
        }
        child.kill().map_err(|e| format!("cannot kill: {e}"))?;
        child.wait().map_err(|e| format!("a run is lost: {e}"))?;
        killed += 1;
    }
}

fn checkpoints(folder: &Path) -> Vec<PathBuf> {
    let mut all = xtask::examples::list(folder).unwrap_or_default();
    all.retain(|path| name(path).starts_with("checkpoint_"));
    all
}

/// What is in the files of a folder, by name, without what names the process.
fn contents(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let mut out = BTreeMap::new();
    for path in all_files(folder) {
        let bytes = fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let own = name(&path);
        let kept = match own.as_str() {
            own if own.starts_with("checkpoint_") || own.ends_with(".lock") => continue,
            "summary.json" => summary(&bytes).unwrap_or(bytes),
            // What the runs of a sweep took.
            "table.effort.csv" => continue,
            _ => bytes,
        };
        let inner = path.strip_prefix(folder).unwrap_or(&path);
        out.insert(inner.to_string_lossy().into_owned(), kept);
    }
    Ok(out)
}

/// A summary without times, memory, and counts of what one process has in memory and another makes again.
fn summary(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut value: Value = serde_json::from_slice(bytes).ok()?;
    let all = value.as_object_mut()?;
    for key in [
        "phases",
        "linear-solve",
        "relative-to-linear",
        "peak-memory",
        "page-faults",
        "method-reason",
    ] {
        all.remove(key);
    }
    if let Some(solver) = all.get_mut("solver").and_then(|s| s.as_object_mut()) {
        let of_process = [
            "seconds",
            "substructures",
            "analyses",
            "factor",
            "flops",
            "linear",
        ];
        solver.retain(|key, _| of_process.iter().all(|word| !key.starts_with(word)));
    }
    serde_json::to_vec(&value).ok()
}

/// A line for every file that is not the same.
fn differences(
    wanted: &BTreeMap<String, Vec<u8>>,
    found: &BTreeMap<String, Vec<u8>>,
) -> Vec<String> {
    let mut lines = Vec::new();
    for (name, bytes) in wanted {
        match found.get(name) {
            None => lines.push(format!("{name} is missing")),
            Some(other) if other != bytes => {
                let same = bytes.iter().zip(other).take_while(|(a, b)| a == b).count();
                let sizes = (bytes.len(), other.len());
                lines.push(format!(
                    "{name} differs from byte {same} on, {} bytes and {}",
                    sizes.0, sizes.1
                ));
            }
            Some(_) => {}
        }
    }
    let more = found.keys().filter(|name| !wanted.contains_key(*name));
    lines.extend(more.map(|name| format!("{name} is left over")));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_names_the_process_is_left_out_and_the_rest_is_compared() {
        let one = br#"{"phases": 1, "increments": 2, "solver": {"flops": 3, "iterations": 4}}"#;
        let other = br#"{"phases": 9, "increments": 2, "solver": {"flops": 9, "iterations": 4}}"#;
        assert!(summary(one).is_some());
        assert_eq!(summary(one), summary(other));
        let a = BTreeMap::from([("a".to_string(), vec![1, 2]), ("b".to_string(), vec![3])]);
        let b = BTreeMap::from([("a".to_string(), vec![1, 9]), ("c".to_string(), vec![3])]);
        assert_eq!(
            differences(&a, &b),
            [
                "a differs from byte 1 on, 2 bytes and 2",
                "b is missing",
                "c is left over"
            ]
        );
        assert!(differences(&a, &a).is_empty());
    }
}
