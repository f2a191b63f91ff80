//! `cargo xtask robustness`: random problems and given ones, run one after the other and audited by what they leave behind.

pub mod entry;
pub mod outcome;
pub mod summary;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use stickslip_audit::draw;
use stickslip_audit::mix::pair;
use stickslip_audit::verdict::Verdict;

use entry::Entry;
use xtask::workspace;

/// What a problem may take; one takes seconds.
const LIMIT: Duration = Duration::from_secs(60);

/// What the command line asks for.
#[derive(Debug)]
struct Wish {
    seed: u64,
    from: u64,
    count: u64,
    keep: Option<PathBuf>,
    files: Vec<PathBuf>,
}

/// Runs and audits the problems, prints a table in Markdown and a summary.
///
/// # Errors
/// The command line is wrong, a file cannot be written, or a result was wrong with exit code 0 or failed by the gate without a reason.
pub fn sweep(words: &[String]) -> Result<(), String> {
    let wish = read(words)?;
    let binary = workspace::stickslip()?;
    let folder = match &wish.keep {
        Some(folder) => folder.clone(),
        None => workspace::target().join("robustness"),
    };
    entry::heads();
    let mut entries = Vec::new();
    if wish.files.is_empty() {
        for number in wish.from..wish.from + wish.count {
            let draft = draw::problem(wish.seed, number);
            let name = match wish.seed {
                1 => format!("{number:03}"),
                seed => format!("{seed}-{number:03}"),
            };
            let place = folder.join(&name);
            let file = place.join("case.toml");
            fs::create_dir_all(&place)
                .and_then(|()| fs::write(&file, &draft.text))
                .map_err(|e| format!("{}: {e}", file.display()))?;
            let entry = Entry {
                name,
                family: draft.family,
                words: draft.words,
                outcome: outcome::run(
                    &binary,
                    &pair::run(&file, &place.join("case.out"), "1"),
                    &place,
                    LIMIT,
                )?,
            };
            finish(entry, &place, wish.keep.is_some(), &mut entries);
        }
    }
    for file in &wish.files {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let place = folder.join(stem.as_ref());
        fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
        let entry = Entry {
            name: stem.into_owned(),
            family: "given",
            words: file.display().to_string(),
            outcome: outcome::run(
                &binary,
                &pair::run(file, &place.join("case.out"), "1"),
                &place,
                LIMIT,
            )?,
        };
        finish(entry, &place, true, &mut entries);
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
            "wrong with exit 0, or a false alarm: {}",
            broken.join(", ")
        )),
    }
}

/// Prints the row of a problem, and keeps what it left if there is a reason to look at it.
fn finish(entry: Entry, place: &Path, keep: bool, entries: &mut Vec<Entry>) {
    entry.print();
    let outcome = &entry.outcome;
    if !keep && outcome.verdict == Verdict::Sound {
        let _ = fs::remove_dir_all(place);
    }
    entries.push(entry);
}

/// Reads the command line.
fn read(words: &[String]) -> Result<Wish, String> {
    let mut wish = Wish {
        seed: 1,
        from: 1,
        count: 300,
        keep: None,
        files: Vec::new(),
    };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        if !word.starts_with("--") {
            let path = Path::new(word);
            if !path.is_file() {
                return Err(format!("there is no file {word}"));
            }
            wish.files.push(path.to_path_buf());
            continue;
        }
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        let number = || {
            let n = value.parse::<u64>().ok().filter(|n| *n <= 1_000_000);
            n.ok_or(format!("{word}: a whole number up to a million"))
        };
        match word.as_str() {
            "--seed" => wish.seed = number()?,
            "--from" => wish.from = number()?,
            "--count" => wish.count = number()?,
            "--keep" => {
                let path = std::path::absolute(value).map_err(|e| format!("{value}: {e}"))?;
                wish.keep = Some(path);
            }
            _ => return Err(format!("robustness has no option {word}")),
        }
    }
    Ok(wish)
}

#[cfg(test)]
mod tests {
    use super::read;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_string).collect()
    }

    #[test]
    fn options_are_read_in_any_order() {
        let wish = read(&words("--seed 7 --from 20 --count 3")).expect("a wish");
        assert_eq!((wish.seed, wish.from, wish.count), (7, 20, 3));
        let wish = read(&[]).expect("a wish");
        assert_eq!((wish.seed, wish.from, wish.count), (1, 1, 300));
        assert!(wish.keep.is_none() && wish.files.is_empty());
    }

    #[test]
    fn what_is_not_known_is_refused() {
        assert!(read(&words("--count many")).is_err());
        assert!(read(&words("--speed 3")).is_err());
        assert!(read(&words("--count")).is_err());
        assert!(read(&words("no-such-file.toml")).is_err());
    }
}
