//! What became of all problems, by verdict and family, and a line on each that is not sound.

use std::collections::BTreeMap;

use stickslip_audit::verdict::Verdict;

use super::entry::Entry;

const VERDICTS: [Verdict; 10] = [
    Verdict::Sound,
    Verdict::Wrong,
    Verdict::Rightly,
    Verdict::FalseAlarm,
    Verdict::Disagreement,
    Verdict::Crash,
    Verdict::Failure,
    Verdict::Refused,
    Verdict::Late,
    Verdict::Unreadable,
];

/// Prints counts, effort and the list.
pub fn print(entries: &[Entry]) {
    let mut families: Vec<&str> = Vec::new();
    for entry in entries {
        if !families.contains(&entry.family) {
            families.push(entry.family);
        }
    }
    println!("\n| | {} | all |", families.join(" | "));
    println!("|{}", "---|".repeat(families.len() + 2));
    let row = |head: &str, count: &dyn Fn(&Entry) -> bool| {
        let of = |family: Option<&str>| {
            let mine = entries
                .iter()
                .filter(|e| family.is_none_or(|f| e.family == f));
            mine.filter(|e| count(e)).count().to_string()
        };
        let cells: Vec<String> = families.iter().map(|f| of(Some(f))).collect();
        println!("| {head} | {} | {} |", cells.join(" | "), of(None));
    };
    row("problems", &|_| true);
    for verdict in VERDICTS {
        row(verdict.words(), &|e| e.outcome.verdict == verdict);
    }
    effort(entries);
    println!();
    for entry in entries
        .iter()
        .filter(|e| e.outcome.verdict != Verdict::Sound || !e.outcome.lines.is_empty())
    {
        println!(
            "- {}, {}: {}",
            entry.name,
            entry.outcome.verdict.words(),
            entry.words
        );
        for line in &entry.outcome.lines {
            println!("  - {line}");
        }
    }
}

fn effort(entries: &[Entry]) {
    let mut iterations: Vec<u64> = entries
        .iter()
        .flat_map(|e| e.outcome.iterations.iter().copied())
        .collect();
    iterations.sort_unstable();
    let at = |fraction: f64| {
        let place = (iterations.len() as f64 * fraction) as usize;
        let place = place.min(iterations.len().saturating_sub(1));
        iterations.get(place).copied().unwrap_or(0)
    };
    let sum = |of: fn(&Entry) -> u64| entries.iter().map(of).sum::<u64>();
    let seconds: f64 = entries.iter().map(|e| e.outcome.seconds).sum();
    println!("\n| | |\n|---|---|");
    println!("| increments | {} |", iterations.len());
    println!(
        "| iterations an increment: median, 95 %, most | {}, {}, {} |",
        at(0.5),
        at(0.95),
        at(1.0)
    );
    let mut solvers: BTreeMap<&str, u64> = BTreeMap::new();
    for (solver, count) in entries.iter().flat_map(|e| &e.outcome.solvers) {
        *solvers.entry(solver).or_default() += count;
    }
    let by_forces: u64 = solvers.values().sum();
    println!(
        "| increments solved by plain iteration, or explicit | {} |",
        (iterations.len() as u64).saturating_sub(by_forces)
    );
    for (solver, count) in solvers {
        println!("| solved as friction problems, by {solver} | {count} |");
    }
    println!("| iterations in all | {} |", sum(|e| e.outcome.total));
    println!("| cut-backs | {} |", sum(|e| e.outcome.cutbacks));
    println!(
        "| things that the audit leaves out | {} |",
        entries.iter().map(|e| e.outcome.skipped).sum::<usize>()
    );
    println!("| wall time of the runs, one thread | {seconds:.1} s |");
}
