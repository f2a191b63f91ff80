//! `cargo xtask walk`: the binary with numbers that make no sense and with damaged files, and whether it panics or hangs.
//!
//! Every numeric key that some example has is set, once, to each of [`VALUES`]: `check` judges the problem, and `run` begins it for some seconds. Then meshes, decks
//! and problem files are damaged at random and given to `check` and `convert`. What is well ends with an exit code of the table; a run that goes on is well, too,
//! and a check that does is not.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use stickslip_audit::draw::Random;

use xtask::workspace::{self, Scratch};

/// What stands in place of each number.
const VALUES: [&str; 9] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1e300",
    "1e-300",
    "9223372036854775807",
    "-1e-6",
];

/// Tables whose keys are names that somebody has chosen.
const NAMED: [&str; 14] = [
    "amplitude",
    "body",
    "coupling",
    "initial",
    "interface",
    "load",
    "mass",
    "material",
    "obstacle",
    "pretension",
    "probe",
    "reference",
    "support",
    "temperature",
];

/// How long a check may take, and how long a run is looked at.
const CHECK: Duration = Duration::from_secs(20);
const RUN: Duration = Duration::from_secs(4);

/// Words that a number or a key of a damaged file may have become.
const WORDS: [&str; 10] = [
    "nan",
    "-1",
    "1e300",
    "99999999999",
    "18446744073709551615",
    "",
    "\0",
    "\u{1b}[2J",
    "[",
    "*NODE",
];

/// Larger files are slow and reach nothing that small ones do not.
const LARGEST: u64 = 64 << 10;

/// How a command ended.
#[derive(Debug, PartialEq, Eq)]
enum End {
    Well,
    /// With a panic, or a signal.
    Broken(String),
    /// Not in time.
    Late,
}

/// Walks; the arguments are `--damages N` and `--seed S`.
pub fn walk(arguments: &[String]) -> Result<(), String> {
    let (mut damages, mut seed) = (3000_u64, 1_u64);
    for pair in arguments.chunks(2) {
        let [name, value] = pair else {
            return Err("usage: cargo xtask walk [--damages N] [--seed S]".into());
        };
        let number: u64 = value.parse().map_err(|_| format!("{value}: no number"))?;
        match name.as_str() {
            "--damages" => damages = number,
            "--seed" => seed = number,
            other => return Err(format!("{other} is not known")),
        }
    }
    let binary = workspace::stickslip()?;
    let scratch = Scratch::new("walk")?;
    let mut broken = Vec::new();
    let keys = keys()?;
    println!("{} keys, {} values of each", keys.len(), VALUES.len());
    for (file, path) in &keys {
        for value in VALUES {
            let change = format!("{path}={value}");
            let name = file.to_string_lossy();
            let out = scratch.0.join("out").to_string_lossy().into_owned();
            let check = ["check", &name, "--set", &change];
            let run = [
                "run",
                &name,
                "--set",
                &change,
                "-q",
                "--threads",
                "1",
                "-o",
                &out,
            ];
            for (arguments, limit) in [(&check[..], CHECK), (&run[..], RUN)] {
                match end(&binary, arguments, limit)? {
                    End::Broken(why) => broken.push(format!("{}: {why}", arguments.join(" "))),
                    End::Late if arguments[0] == "check" => {
                        broken.push(format!("{}: it does not end", arguments.join(" ")));
                    }
                    _ => {}
                }
            }
        }
    }
    println!("{damages} damaged files");
    let files = files()?;
    for i in 0..damages {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(i));
        let source = &files[below(&mut random, files.len())];
        let ending = source.extension().unwrap_or_default().to_string_lossy();
        let file = scratch.0.join(format!("damaged.{ending}"));
        let bytes = fs::read(source).map_err(|e| format!("{}: {e}", source.display()))?;
        let bytes = damaged(&bytes, &mut random);
        fs::write(&file, bytes).map_err(|e| format!("{}: {e}", file.display()))?;
        let name = file.to_string_lossy();
        let other = scratch.0.join("other.vtu").to_string_lossy().into_owned();
        let check = ["check", &name];
        let convert = ["convert", &name, &other];
        let arguments: &[&str] = match &*ending {
            "msh" | "vtu" => &convert,
            _ => &check,
        };
        let what = format!("{}, damage {i} of seed {seed}", source.display());
        match end(&binary, arguments, CHECK)? {
            End::Well => {}
            End::Broken(why) => broken.push(format!("{what}: {why}")),
            End::Late => broken.push(format!("{what}: it does not end")),
        }
    }
    for line in &broken {
        println!("{line}");
    }
    match broken.len() {
        0 => Ok(()),
        n => Err(format!("{n} are not well")),
    }
}

/// Runs a command for so long.
fn end(binary: &Path, arguments: &[&str], limit: Duration) -> Result<End, String> {
    let log = std::env::temp_dir().join(format!("stickslip-walk-{}.log", std::process::id()));
    let file = fs::File::create(&log).map_err(|e| e.to_string())?;
    let mut child = Command::new(binary)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(file)
        .spawn()
        .map_err(|e| format!("{}: {e}", binary.display()))?;
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
            break Some(status);
        }
        if begun.elapsed() > limit {
            let _ = child.kill();
            let _ = child.wait();
            break None;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let said = fs::read(&log).unwrap_or_default();
    let said = String::from_utf8_lossy(&said);
    if let Some(at) = said.find("panicked at") {
        let lines: Vec<&str> = said[at..].lines().take(2).collect();
        return Ok(End::Broken(lines.join(" ")));
    }
    Ok(match status {
        None => End::Late,
        Some(status) => match status.code() {
            Some(0..=3) => End::Well,
            _ => End::Broken(status.to_string()),
        },
    })
}

/// Each key once, in the smallest file that has it: the file, and the path there.
fn keys() -> Result<Vec<(PathBuf, String)>, String> {
    let examples = workspace::root().join("examples");
    let mut all = below_folder(&examples, &["toml"])?;
    let is_case = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        !name.starts_with("expected")
    };
    all.retain(is_case);
    all.sort_by_key(|path| fs::metadata(path).map_or(u64::MAX, |m| m.len()));
    let (mut known, mut keys) = (BTreeSet::new(), Vec::new());
    for file in all {
        let text = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        let Ok(table) = text.parse::<toml::Table>() else {
            continue;
        };
        let mut found = Vec::new();
        numbers(
            &toml::Value::Table(table),
            String::new(),
            String::new(),
            0,
            &mut found,
        );
        for (path, kind) in found {
            if known.insert(kind) {
                keys.push((file.clone(), path));
            }
        }
    }
    Ok(keys)
}

/// The paths of all numbers below a value, with the same without names and places in lists.
fn numbers(
    value: &toml::Value,
    path: String,
    kind: String,
    depth: usize,
    out: &mut Vec<(String, String)>,
) {
    match value {
        toml::Value::Integer(_) | toml::Value::Float(_) => out.push((path, kind)),
        toml::Value::Table(table) => {
            for (name, value) in table {
                let named = depth == 1 && NAMED.contains(&kind.trim_end_matches('.'));
                let quoted = match name.contains('.') {
                    true => format!("'{name}'"),
                    false => name.clone(),
                };
                let dot = if path.is_empty() { "" } else { "." };
                let below = format!("{path}{dot}{quoted}");
                let kind = match named {
                    true => format!("{kind}*."),
                    false => format!("{kind}{name}."),
                };
                numbers(value, below, kind, depth + 1, out);
            }
        }
        toml::Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                numbers(
                    value,
                    format!("{path}.{i}"),
                    format!("{kind}#."),
                    depth + 1,
                    out,
                );
            }
        }
        _ => {}
    }
}

/// The files that are damaged.
fn files() -> Result<Vec<PathBuf>, String> {
    let mut all = Vec::new();
    for folder in ["examples", "crates"] {
        let folder = workspace::root().join(folder);
        all.extend(below_folder(&folder, &["toml", "msh", "vtu", "inp"])?);
    }
    all.retain(|path| path.file_name().is_some_and(|name| name != "Cargo.toml"));
    all.retain(|path| fs::metadata(path).is_ok_and(|m| m.len() <= LARGEST));
    match all.is_empty() {
        true => Err("there are no files to damage".into()),
        false => Ok(all),
    }
}

/// The files below a folder that end so, in order.
fn below_folder(folder: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut all = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            all.extend(below_folder(&path, endings)?);
        } else if (path.extension()).is_some_and(|e| endings.iter().any(|ending| e == *ending)) {
            all.push(path);
        }
    }
    all.sort();
    Ok(all)
}

fn below(random: &mut Random, count: usize) -> usize {
    match count {
        0 => 0,
        count => random.whole(0, count as u64 - 1) as usize,
    }
}

/// Bytes that are others, words in place of others, pieces that are gone or doubled.
fn damaged(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..1 + below(random, 3) {
        let at = below(random, out.len());
        let end = (at + 1 + below(random, 40)).min(out.len());
        match below(random, 6) {
            0 if !out.is_empty() => out[at] = below(random, 256) as u8,
            1 => drop(out.drain(at..end)),
            2 => {
                let copy = out[at..end].to_vec();
                let to = below(random, out.len() + 1);
                out.splice(to..to, copy);
            }
            3 => out.truncate(at),
            _ => {
                let is_part = |b: &u8| b.is_ascii_alphanumeric() || b"+-._".contains(b);
                let begin = at + out[at..].iter().position(is_part).unwrap_or(0);
                let length = out[begin..].iter().take_while(|b| is_part(b)).count();
                let word = WORDS[below(random, WORDS.len())];
                out.splice(begin..begin + length, word.bytes());
            }
        }
    }
    out
}
