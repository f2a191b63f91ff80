//! What analyses cost, in counts that do not depend on how busy the machine is: arithmetic, iterations, pages of memory, bytes written. `counts.txt`
//! holds what they were; more is a regression, less is to be written down, so that it stays.

use crate::support::{self, command, text};
use std::path::{Path, PathBuf};

/// Problems, each a name, an example and keys set in it. One a way to solve and to integrate, and sizes that take about a second.
const PROBLEMS: [(&str, &str, &[&str]); 9] = [
    (
        "stick",
        "press-and-slide/case.toml",
        &["solver.method=\"condensed\""],
    ),
    (
        "slip",
        "press-and-slide/case-slip.toml",
        &["solver.method=\"condensed\""],
    ),
    (
        "sparse",
        "press-and-slide/case.toml",
        &["solver.method=\"sparse\""],
    ),
    (
        "multigrid",
        "press-and-slide/case.toml",
        &["solver.method=\"multigrid\""],
    ),
    (
        "multigrid-slip",
        "press-and-slide/case-slip.toml",
        &["solver.method=\"multigrid\""],
    ),
    ("fretting", "fretting-sphere/case.toml", &[]),
    (
        "small-sliding",
        "press-and-slide/case.toml",
        &[
            "solver.method=\"condensed\"",
            "interface.joint.kinematics.small-sliding={}",
            "interface.joint.friction.coulomb.mu=0.1",
        ],
    ),
    (
        "implicit",
        "steel-bar/case.toml",
        &["step=[{ duration = 2.5e-4, increments.fixed = 50, dynamic.scheme.newmark = {} }]"],
    ),
    (
        "explicit",
        "steel-bar/case.toml",
        &[
            "step=[{ duration = 5e-5, increments.fixed = 100, dynamic.scheme.central-difference = {} }]",
        ],
    ),
];

/// Counts, where `summary.json` has them, and the share by which each may differ from its row: rounding, which differs between processors, moves
/// iterations by a few; what allocators and kernels do with memory differs more.
const COUNTS: [(&str, &str, f64); 11] = [
    ("flops", "/solver/flops", 0.01),
    ("nonzeros", "/solver/factor-nonzeros", 0.01),
    ("factorisations", "/solver/factorisations", 0.0),
    ("iterations", "/solver/iterations", 0.05),
    ("krylov", "/solver/krylov", 0.08),
    ("reduced", "/solver/reduced", 0.08),
    ("kept-gaps", "/solver/kept-gaps", 0.08),
    ("evaluations", "/solver/evaluations", 0.05),
    ("setups", "/solver/setups", 0.0),
    ("faults", "/page-faults", 0.25),
    ("bytes", "", 0.03),
];

fn size(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten();
    let size = entries.map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(e) => panic!("{}: {e}", entry.path().display()),
    });
    size.sum()
}

/// Runs a problem on one thread, and counts.
fn counts(name: &str, case: &str, set: &[&str]) -> [f64; COUNTS.len()] {
    let folder = support::folder("counts", name);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut run = command(&folder);
    run.arg("run").arg(root.join(case));
    run.args(["--threads=1", "--output=out", "--quiet"]);
    for key in set {
        run.args(["--set", key]);
    }
    let output = run.output().expect("the binary runs");
    assert!(output.status.success(), "{name}: {}", text(&output.stderr));
    let summary = std::fs::read(folder.join("out/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    COUNTS.map(|(count, pointer, _)| match pointer {
        "" => size(&folder.join("out")) as f64,
        _ => match summary.pointer(pointer).and_then(|v| v.as_f64()) {
            Some(number) => number,
            None => panic!("{name}: the summary has no {count}"),
        },
    })
}

fn line(name: &str, counts: &[f64]) -> String {
    let numbers = counts.iter().map(|c| match *c {
        c if c >= 1e8 => format!("{c:>15.4e}"),
        c => format!("{c:>15}"),
    });
    format!("{name:<16}{}", numbers.collect::<String>())
}

#[test]
fn analyses_cost_what_they_did() {
    let table = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/it/counts.txt");
    let before = std::fs::read_to_string(&table).expect("the table of counts");
    let row = |name: &str| -> Vec<f64> {
        let line = before
            .lines()
            .find(|l| l.split_whitespace().next() == Some(name));
        let words = line.into_iter().flat_map(|l| l.split_whitespace().skip(1));
        words.map(|w| w.parse().expect("a number")).collect()
    };
    let head: String = COUNTS.iter().map(|c| format!("{:>15}", c.0)).collect();
    let (mut now, mut differences) = (format!("{:<16}{head}\n", "problem"), Vec::new());
    for (name, case, set) in PROBLEMS {
        let counted = counts(name, case, set);
        now += &line(name, &counted);
        now.push('\n');
        let was = row(name);
        for (i, (count, _, share)) in COUNTS.iter().enumerate() {
            let was = was.get(i).copied().unwrap_or(0.0);
            // Of few iterations one is a large share.
            if (counted[i] - was).abs() > (share * was).max(if *share > 0.0 { 1.0 } else { 0.0 }) {
                differences.push(format!("{name}: {count} {was} -> {}", counted[i]));
            }
        }
    }
    assert!(
        differences.is_empty(),
        "{}\nA change that means it puts this into {}:\n{now}",
        differences.join("\n"),
        table.display()
    );
}
