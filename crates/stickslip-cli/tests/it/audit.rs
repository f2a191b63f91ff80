//! A few random problems of every family, run by the binary and audited by what it writes; the audit shares no code with the program. Many
//! more: `cargo xtask robustness`.

use crate::support;
use std::path::PathBuf;
use std::process::Command;

use stickslip_audit::audit::audit;
use stickslip_audit::draw::{self, FAMILIES};
use stickslip_audit::figure::Report;
use stickslip_audit::verdict::Verdict;

/// Series and numbers of small problems, all families among them. Each takes a fraction of a second, but for the last, which takes some.
const NUMBERS: [(u64, u64); 23] = [
    (1, 3),
    (1, 8),
    (1, 14),
    (1, 15),
    (1, 17),
    (1, 26),
    (1, 30),
    (1, 32),
    (1, 39),
    (1, 60),
    (1, 63),
    (1, 67),
    // The limit of friction falls faster than the springs of stick let go.
    (19, 205),
    // A node of a mortar just outside the other body, under a steep law.
    (19, 305),
    // A ball of three facets comes in beside the few integration points that press.
    (19, 462),
    // Points touch and part in large increments of sliding.
    (19, 490),
    // A node of a mortar gets something opposite.
    (20, 82),
    // Friction that is not against slip: the paper's kinematics on triangles.
    (20, 365),
    // A node that slides through the valleys between facets.
    (22, 52),
    // Slivers of faces on the flanks of two balls, far above each other.
    (21, 132),
    // An obstacle that turns far in an increment: slip is along an arc.
    (23, 123),
    // A body that rubs between two others is followed, and where it goes is slip.
    (23, 165),
    // Light nodes of a body that is thrown swing while they rub.
    (24, 227),
];

/// Runs a problem file; the folder of its results and the exit code.
fn run(name: &str, text: &str) -> (PathBuf, Option<i32>) {
    let folder = support::folder("audit", name);
    let (file, out) = (folder.join("case.toml"), folder.join("case.out"));
    std::fs::write(&file, text).expect("the problem file");
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .arg("run")
        .arg(&file)
        .args(["--quiet", "--threads", "1", "-o"])
        .arg(&out)
        .output()
        .expect("the binary runs");
    (out, output.status.code())
}

fn lines(report: &Result<Report, String>) -> Vec<String> {
    match report {
        Ok(report) => report.doubtful().iter().map(|f| f.to_string()).collect(),
        Err(why) => vec![why.clone()],
    }
}

#[test]
fn random_problems_of_all_families_are_right_or_the_program_says_so() {
    let mut families = Vec::new();
    let mut broken = Vec::new();
    for (series, number) in NUMBERS {
        let draft = draw::problem(series, number);
        let (out, exit) = run(&format!("{series}-{number}"), &draft.text);
        let report = audit(&out);
        let verdict = Verdict::new(exit, &report);
        if verdict.broken() || verdict == Verdict::Refused {
            broken.push(format!(
                "{series}-{number}, {}: {}: {:?}",
                verdict.words(),
                draft.words,
                lines(&report)
            ));
        }
        families.push(draft.family);
    }
    assert!(broken.is_empty(), "{broken:#?}");
    let missing: Vec<_> = FAMILIES.iter().filter(|f| !families.contains(f)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// A block pressed on a floor and dragged over it.
const DRAGGED: &str = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [6, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.joint = { secondary = "block.bottom", primary = "floor", normal.linear = { c = 1e14 }, friction.coulomb = { mu = 0.3 } }
support.press = { set = "block.top", y = -1e-5, amplitude = "press" }
support.drag = { set = "block.top", x = 1e-4, amplitude = "drag" }
amplitude.press.table = [[0, 0], [1, 1], [2, 1]]
amplitude.drag.table = [[1, 0], [2, 1]]
step = [{ increments.fixed = 2 }, { increments.fixed = 4 }]
"#;

#[test]
fn an_audit_sees_what_does_not_belong_to_its_problem() {
    let (out, _) = run("dragged", DRAGGED);
    let wrong = || -> Vec<&'static str> {
        let report = audit(&out).expect("an audit");
        report
            .wrong()
            .iter()
            .map(|f| f.name)
            .filter(|name| *name != "energy")
            .collect()
    };
    assert_eq!(wrong(), [""; 0], "{:?}", lines(&audit(&out)));
    let problem = out.join("problem.toml");
    let text = std::fs::read_to_string(&problem).expect("the problem as it was run");
    let planted = [
        ("poisson = 0.3", "poisson = 0.29", "equilibrium"),
        ("normal = [0.0, 1.0]", "normal = [0.1, 1.0]", "gap"),
        ("point = [0.0, 0.0]", "point = [0.0, 0.0001]", "penetration"),
        (
            "young = 210000000000.0",
            "young = 209000000000.0",
            "strain-energy",
        ),
        ("mu = 0.3", "mu = 0.28", "cone"),
        ("mu = 0.3", "mu = 0.32", "mobilised"),
        ("c = 100000000000000.0", "c = 104000000000000.0", "law"),
        ("y = -0.00001", "y = -0.000011", "support"),
    ];
    for (from, to, figure) in planted {
        assert!(text.contains(from), "{from}\n{text}");
        std::fs::write(&problem, text.replace(from, to)).expect("the other problem");
        assert!(wrong().contains(&figure), "{from} for {to}: {:?}", wrong());
    }
}
