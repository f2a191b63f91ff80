//! A few random mixes of features, each with runs that must agree with it: what is sound by itself is tested together. Many more: `cargo xtask mixes`.

use crate::support;
use std::path::Path;
use std::process::Command;

use stickslip_audit::audit::audit;
use stickslip_audit::mix::{self, pair};
use stickslip_audit::verdict::Verdict;

/// A series, and numbers of small problems that are right. A fraction of a second each, second runs included.
const SERIES: u64 = 3;
const NUMBERS: [u64; 30] = [
    1, 2, 3, 5, 6, 8, 10, 11, 13, 14, 15, 16, 17, 18, 19, 22, 23, 24, 26, 28, 30, 31, 34, 37, 38,
    40, 41, 42, 43, 44,
];

/// Series and numbers of others that were wrong, disagreed or did not solve once.
const ONCE_WRONG: [(u64, u64); 23] = [
    (4207, 55),
    (4207, 128),
    (4207, 148),
    (4207, 195),
    (4207, 200),
    (4207, 240),
    (4207, 251),
    (4207, 275),
    (4311, 33),
    (4311, 86),
    (5501, 28),
    (5501, 301),
    (5501, 326),
    (5501, 344),
    (5501, 404),
    (5501, 460),
    (5501, 887),
    (5501, 941),
    (6007, 377),
    (9102, 294),
    (9102, 741),
    (9104, 47),
    (9104, 164),
];

/// Runs the binary; its exit code.
fn run(words: &[String]) -> Option<i32> {
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(words)
        .output();
    output.expect("the binary runs").status.code()
}

/// What a run of its own is by its exit code and its audit.
fn judged(exit: Option<i32>, out: &Path) -> (Verdict, Vec<String>) {
    let report = audit(out);
    let lines = match &report {
        Ok(report) => report.doubtful().iter().map(|f| f.to_string()).collect(),
        Err(why) => vec![why.clone()],
    };
    (Verdict::new(exit, &report), lines)
}

/// What is wrong with a mix and the runs that must agree with it.
fn faults((series, number): (u64, u64)) -> Vec<String> {
    let mix = mix::problem(series, number);
    let folder = support::folder("mixes", &format!("{series}-{number}"));
    let (file, out) = (folder.join("case.toml"), folder.join("case.out"));
    std::fs::write(&file, mix.text(mix.view, "A mix")).expect("the problem file");
    let exit = run(&pair::first(&mix, &file, &out));
    let (verdict, lines) = judged(exit, &out);
    if verdict != Verdict::Sound {
        return vec![format!("{}: {lines:?}", verdict.words())];
    }
    let mut faults = Vec::new();
    for relation in &mix.relations {
        let place = folder.join(relation.name.replace(' ', "-"));
        let job = pair::prepare(&mix, relation, &out, &place).expect("a second run");
        let exit = run(&job.words);
        if exit != Some(0) {
            faults.push(format!("{}: exit code {exit:?}", relation.name));
            continue;
        }
        let (off, what) = pair::judge(&mix, relation, &out, &job.out).expect("two histories");
        if off.is_nan() || off > 1.0 {
            faults.push(format!("{}: {what}", relation.name));
        }
    }
    faults
}

#[test]
fn mixes_of_features_are_right_and_agree_with_themselves() {
    let mut all = Vec::new();
    let first = NUMBERS.map(|number| (SERIES, number));
    for (series, number) in first.into_iter().chain(ONCE_WRONG) {
        let words = mix::problem(series, number).words();
        let found = faults((series, number)).into_iter();
        all.extend(found.map(|f| format!("{series}-{number}, {words}: {f}")));
    }
    assert!(all.is_empty(), "{all:#?}");
}
