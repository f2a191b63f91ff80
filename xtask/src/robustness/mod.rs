//! `cargo xtask robustness`: random problems of two bodies, run one after the other, and what becomes of them.

mod body;
mod law;
mod outcome;
mod path;
mod problem;
mod random;

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use crate::workspace;
use outcome::{End, Outcome};

/// What a problem may take; one takes seconds.
const LIMIT: Duration = Duration::from_secs(120);

/// What the command line asks for.
struct Wish {
    count: u64,
    first: u64,
    discretisation: Option<String>,
    keep: Option<PathBuf>,
}

/// Runs the problems and prints a table in Markdown and a summary.
pub fn sweep(words: &[String]) -> Result<(), String> {
    let wish = read(words)?;
    let binary = workspace::stickslip()?;
    let folder = match &wish.keep {
        Some(folder) => folder.clone(),
        None => workspace::target().join("robustness"),
    };
    println!(
        "| seed | problem | dofs | end | increments | iterations | most | cut-backs | penetration / approach | s |"
    );
    println!("|{}", "---|".repeat(10));
    let mut outcomes = Vec::new();
    for seed in wish.first..wish.first + wish.count {
        let problem = problem::problem(seed, wish.discretisation.as_deref());
        let place = folder.join(format!("{seed:03}"));
        let file = place.join("case.toml");
        fs::create_dir_all(&place)
            .and_then(|()| fs::write(&file, &problem.text))
            .map_err(|e| format!("{}: {e}", file.display()))?;
        let outcome = outcome::run(&binary, &place, LIMIT)?;
        println!(
            "| {seed} | {} | {} | {} | {} | {} | {} | {} | {:.1e} | {:.2} |",
            problem.words,
            outcome.dofs,
            outcome.end.word(),
            outcome.iterations.len(),
            outcome.total,
            outcome.iterations.iter().max().unwrap_or(&0),
            outcome.cutbacks,
            outcome.penetration,
            outcome.seconds
        );
        if wish.keep.is_none() && outcome.end == End::Good {
            let _ = fs::remove_dir_all(&place);
        }
        outcomes.push((seed, problem.words, outcome));
    }
    summarise(&outcomes);
    println!("\ncases and results that are kept: {}", folder.display());
    Ok(())
}

/// Reads the command line.
fn read(words: &[String]) -> Result<Wish, String> {
    let mut wish = Wish {
        count: 200,
        first: 1,
        discretisation: None,
        keep: None,
    };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        let number = || {
            let n = value.parse::<u64>().ok().filter(|n| *n <= 1_000_000);
            n.ok_or(format!("{word}: a whole number up to a million"))
        };
        match word.as_str() {
            "--count" => wish.count = number()?,
            "--first" => wish.first = number()?,
            "--discretisation" if ["mortar", "node-to-facet"].contains(&value.as_str()) => {
                wish.discretisation = Some(value.clone());
            }
            "--discretisation" => return Err(format!("{word}: mortar or node-to-facet")),
            "--keep" => {
                let path = std::path::absolute(value).map_err(|e| format!("{value}: {e}"))?;
                wish.keep = Some(path);
            }
            _ => return Err(format!("robustness has no option {word}")),
        }
    }
    Ok(wish)
}

fn summarise(outcomes: &[(u64, String, Outcome)]) {
    let count = |end: End| outcomes.iter().filter(|o| o.2.end == end).count();
    let finished = count(End::Good) + count(End::Gate);
    let mut iterations: Vec<u64> = outcomes
        .iter()
        .flat_map(|o| o.2.iterations.iter().copied())
        .collect();
    iterations.sort_unstable();
    let at = |fraction: f64| {
        let place = (iterations.len() as f64 * fraction) as usize;
        let place = place.min(iterations.len().saturating_sub(1));
        iterations.get(place).copied().unwrap_or(0)
    };
    let cutbacks: u64 = outcomes.iter().map(|o| o.2.cutbacks).sum();
    let cut = outcomes.iter().filter(|o| o.2.cutbacks > 0).count();
    let seconds: f64 = outcomes.iter().map(|o| o.2.seconds).sum();
    let total: u64 = outcomes.iter().map(|o| o.2.total).sum();
    println!("\n| | |\n|---|---|");
    println!("| problems | {} |", outcomes.len());
    println!("| finished | {finished} |");
    println!(
        "| finished and passed the quality gate | {} |",
        count(End::Good)
    );
    println!(
        "| stopped at the gate, failed, refused, late | {}, {}, {}, {} |",
        count(End::Gate),
        count(End::Failed),
        count(End::Refused),
        count(End::Late)
    );
    println!("| increments | {} |", iterations.len());
    println!(
        "| iterations an increment: median, 95 %, most | {}, {}, {} |",
        at(0.5),
        at(0.95),
        at(1.0)
    );
    println!("| iterations in all | {total} |");
    println!("| cut-backs (in how many problems) | {cutbacks} ({cut}) |");
    println!("| wall time, one thread | {seconds:.1} s |");
    let bad: Vec<_> = outcomes.iter().filter(|o| o.2.end != End::Good).collect();
    if bad.is_empty() {
        return;
    }
    println!();
    for (seed, words, outcome) in bad {
        println!(
            "- {seed}, {}: {words}: {}",
            outcome.end.word(),
            outcome.message
        );
    }
}

#[cfg(test)]
mod tests {
    use super::read;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_string).collect()
    }

    #[test]
    fn options_are_read_in_any_order() {
        let wish = read(&words("--discretisation mortar --first 20 --count 3")).expect("a wish");
        assert_eq!((wish.first, wish.count), (20, 3));
        assert_eq!(wish.discretisation.as_deref(), Some("mortar"));
        let wish = read(&[]).expect("a wish");
        assert_eq!((wish.first, wish.count), (1, 200));
        assert!(wish.discretisation.is_none() && wish.keep.is_none());
    }

    #[test]
    fn what_is_not_known_is_refused() {
        assert!(read(&words("--count many")).is_err());
        assert!(read(&words("--discretisation points")).is_err());
        assert!(read(&words("--speed 3")).is_err());
        assert!(read(&words("--count")).is_err());
    }
}
