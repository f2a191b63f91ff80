//! Running, comparing and tabulating from outside: results on disk, exit codes 0 to 3.

use crate::support::{self, CASE, code, stickslip, text};
use std::path::{Path, PathBuf};

/// What the case must give: the top moves as prescribed.
const EXPECTED: &str = r#"format = 1
source = "the support prescribes it"

[[check]]
what = "displacement of the top"
history = "corner.U2"
value = -1e-5
relative = 1e-12
"#;

/// A folder of its own for each test, with the case in it.
struct Place {
    folder: PathBuf,
}

impl Place {
    fn new(name: &str) -> Self {
        let folder = support::place("runs", name, CASE);
        let place = Place { folder };
        place.write("expected.toml", EXPECTED);
        place
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    fn write(&self, name: &str, content: &str) {
        std::fs::write(self.folder.join(name), content).expect("the folder can be written to");
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

/// The last value of a column of `history.csv`.
fn last(history: &str, column: &str) -> f64 {
    let mut lines = history.lines().filter(|l| !l.starts_with('#'));
    let header = lines.next().expect("a header");
    let i = header
        .split(',')
        .position(|name| name.trim_matches('"') == column)
        .unwrap_or_else(|| panic!("{column} in {header}"));
    let row = lines.next_back().expect("a row");
    row.split(',')
        .nth(i)
        .and_then(|x| x.parse().ok())
        .expect("a number")
}

#[test]
fn a_run_writes_its_results() {
    let place = Place::new("results");
    let output = stickslip(&["run", &place.path("case.toml"), "-o", &place.path("out")]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
    assert!(!output.stderr.is_empty(), "no progress");
    let history = place.read("out/history.csv");
    assert!((last(&history, "corner.U2") / -1e-5 - 1.0).abs() < 1e-12);
    assert!(last(&history, "base.CFN2") > 0.0);
    assert!(place.read("out/fields.pvd").contains(".vtu"));
    assert!(place.read("out/interfaces/base.csv").contains("CPRESS"));
    let summary: serde_json::Value =
        serde_json::from_str(&place.read("out/summary.json")).expect("JSON");
    assert_eq!(summary["increments"], 2);
}

#[test]
fn results_lie_beside_the_file_and_progress_can_be_silenced() {
    let place = Place::new("beside");
    let output = stickslip(&["run", &place.path("case.toml"), "--quiet"]);
    assert_eq!(code(&output), Some(0));
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    assert!(!place.read("case.out/history.csv").is_empty());
}

#[test]
fn values_and_threads_are_taken_from_the_command_line() {
    let place = Place::new("set");
    let case = place.path("case.toml");
    let mut histories = Vec::new();
    for threads in ["1", "3"] {
        let out = place.path(threads);
        let set = "support.top.y=-2e-5";
        let arguments = [
            "run",
            &case,
            "-o",
            &out,
            "--threads",
            threads,
            "--set",
            set,
            "-q",
        ];
        let output = stickslip(&arguments);
        assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
        histories.push(place.read(&format!("{threads}/history.csv")));
    }
    assert!((last(&histories[0], "corner.U2") / -2e-5 - 1.0).abs() < 1e-12);
    assert_eq!(histories[0], histories[1]);
    let wrong = stickslip(&["run", &case, "--set", "support.top.w=1"]);
    assert_eq!(code(&wrong), Some(1));
    assert!(
        text(&wrong.stderr).contains("unknown key `w`"),
        "{}",
        text(&wrong.stderr)
    );
    assert_eq!(
        code(&stickslip(&["run", &case, "--threads", "many"])),
        Some(1)
    );
}

#[test]
fn comparing_tells_agreement_from_difference() {
    let place = Place::new("compare");
    let out = place.path("out");
    let run = stickslip(&["run", &place.path("case.toml"), "-o", &out, "-q"]);
    assert_eq!(code(&run), Some(0));
    // expected.toml beside the results, or named
    let agrees = stickslip(&["compare", &out]);
    assert_eq!(code(&agrees), Some(0), "{}", text(&agrees.stderr));
    assert!(text(&agrees.stdout).contains("displacement of the top"));
    place.write("other.toml", &EXPECTED.replace("-1e-5", "-1.1e-5"));
    let differs = stickslip(&["compare", &out, &place.path("other.toml")]);
    assert_eq!(code(&differs), Some(2));
    assert!(text(&differs.stdout).contains("displacement of the top"));
    place.write("unknown.toml", &EXPECTED.replace("corner.U2", "corner.U7"));
    let unknown = stickslip(&["compare", &out, &place.path("unknown.toml")]);
    assert_eq!(code(&unknown), Some(2));
    assert!(text(&unknown.stdout).ends_with("0 of 1 checks passed\n"));
    let all = text(&unknown.stdout) + &text(&unknown.stderr);
    assert!(all.contains("corner.U7"), "{all}");
    let nothing = stickslip(&["compare", &place.path("no-results")]);
    assert_eq!(code(&nothing), Some(1));
    assert!(
        text(&nothing.stderr).contains("no-results"),
        "{}",
        text(&nothing.stderr)
    );
}

#[test]
fn an_analysis_that_fails_says_so_and_keeps_its_summary() {
    let place = Place::new("fails");
    // Held sideways by nothing.
    place.write(
        "case.toml",
        &CASE
            .replace("x = 0.0, ", "")
            .replace("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
    );
    let output = stickslip(&[
        "run",
        &place.path("case.toml"),
        "-o",
        &place.path("out"),
        "-q",
    ]);
    assert_eq!(code(&output), Some(3), "{}", text(&output.stderr));
    let err = text(&output.stderr);
    assert!(
        err.contains("body block: translation x is held neither"),
        "{err}"
    );
    assert!(place.read("out/summary.json").contains("free to move"));
}

#[test]
fn a_mistake_that_the_mesh_shows_has_its_line() {
    let place = Place::new("line");
    place.write("case.toml", &CASE.replace("block.bottom", "block.botom"));
    for command in ["run", "check"] {
        let output = stickslip(&[command, &place.path("case.toml")]);
        assert_eq!(code(&output), Some(1), "{command}");
        let err = text(&output.stderr);
        for part in [
            "case.toml:6:",
            "`block.botom` has no points",
            "block.bottom, ",
        ] {
            assert!(err.contains(part), "{command}: {part} in\n{err}");
        }
    }
    assert!(!place.folder.join("case.out").exists());
}

#[test]
fn check_tells_gaps_and_free_motions() {
    let place = Place::new("check");
    place.write("case.toml", &CASE.replace("x = 0.0, ", ""));
    let output = stickslip(&["check", &place.path("case.toml")]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let out = text(&output.stdout);
    for part in ["base", "translation x"] {
        assert!(out.contains(part), "{part} in\n{out}");
    }
}

#[test]
fn curve_tabulates_the_laws_of_an_interface() {
    let place = Place::new("curve");
    let case = place.path("case.toml");
    let law = "interface.base.normal.power-law={ c = 1e20, m = 2.0 }";
    let output = stickslip(&[
        "curve",
        &case,
        "--pressure",
        "1e8",
        "--rows",
        "3",
        "--set",
        law,
    ]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let out = text(&output.stdout);
    let rows: Vec<Vec<f64>> = out
        .lines()
        .skip(1)
        .map(|l| l.split(',').map(|x| x.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 3);
    // p = c δ², limit = μ p
    let end = &rows[2];
    assert!((end[0] / -1e-6 - 1.0).abs() < 1e-12 && (end[1] / 1e8 - 1.0).abs() < 1e-12);
    assert!((end[4] / 3e7 - 1.0).abs() < 1e-12);
    let unknown = stickslip(&["curve", &case, "joint"]);
    assert_eq!(code(&unknown), Some(1));
    assert!(
        text(&unknown.stderr).contains("there is no interface `joint`"),
        "{}",
        text(&unknown.stderr)
    );
}

/// Springs as soft as the block itself: it sinks into the floor.
fn soft() -> String {
    let friction = "friction.coulomb = { mu = 0.3 }";
    CASE.replace(
        friction,
        &format!("{friction}, enforcement.penalty = {{ factor = 1 }}"),
    )
}

#[test]
fn a_poor_result_is_kept_and_ends_with_code_2_and_a_sentence() {
    let place = Place::new("quality");
    place.write("case.toml", &soft());
    let (case, out) = (place.path("case.toml"), place.path("out"));
    let output = stickslip(&["run", &case, "-o", &out, "--quiet"]);
    let said = text(&output.stderr);
    assert_eq!(code(&output), Some(2), "{said}");
    assert!(
        said.contains("error: quality: interface base: penetration-to-approach is"),
        "{said}"
    );
    assert!(said.contains("above its limit"), "{said}");
    assert!(last(&place.read("out/history.csv"), "base.CFN2") > 0.0);
    let summary: serde_json::Value =
        serde_json::from_str(&place.read("out/summary.json")).expect("JSON");
    assert_eq!(summary["completed"], true);
    assert_eq!(summary["quality"]["met"], false);
    assert_eq!(summary["quality"]["gate"], "error");

    let warn = "quality.gate=\"warn\"";
    let output = stickslip(&["run", &case, "-o", &out, "-v", "--set", warn]);
    let said = text(&output.stderr);
    assert_eq!(code(&output), Some(0), "{said}");
    assert!(
        said.contains("warning: quality: interface base: penetration-to-approach"),
        "{said}"
    );
    assert!(
        said.contains("independent of the numerical stiffness to"),
        "{said}"
    );

    let output = stickslip(&["run", &case, "-o", &out, "--set", "quality.gate=\"off\""]);
    assert_eq!(code(&output), Some(0));
    assert!(!text(&output.stderr).contains("quality:"));
}

#[test]
fn a_sweep_says_which_runs_are_poor() {
    let place = Place::new("quality-sweep");
    let case = place.path("case.toml");
    place.write("case.toml", &soft());
    let axis = "interface.base.enforcement.penalty.factor=1,1e4";
    let output = stickslip(&["sweep", &case, "--set", axis, "-q"]);
    assert_eq!(code(&output), Some(2), "{}", text(&output.stderr));
    let table = place.read("case.sweep.csv");
    let rows: Vec<&str> = table.lines().filter(|l| !l.starts_with('#')).collect();
    assert!(
        rows[1].contains("quality: interface base: penetration"),
        "{table}"
    );
    assert!(rows[2].contains("done"), "{table}");
}

#[test]
fn explain_tells_how_a_run_went() {
    let place = Place::new("explain");
    let out = place.path("out");
    let output = stickslip(&["run", &place.path("case.toml"), "-q", "-o", &out]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let output = stickslip(&["explain", &out]);
    assert_eq!(code(&output), Some(0));
    let said = text(&output.stdout);
    assert!(said.contains("The run finished."), "{said}");
    assert!(said.contains("Nothing went wrong."), "{said}");
    assert!(!Path::new(&out).join("culprits.vtu").exists());

    // Nothing holds the block sideways.
    place.write(
        "loose.toml",
        &CASE
            .replace("x = 0.0, ", "")
            .replace("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
    );
    let output = stickslip(&["run", &place.path("loose.toml"), "-q", "-o", &out]);
    assert_eq!(code(&output), Some(3), "{}", text(&output.stderr));
    let output = stickslip(&["explain", &out]);
    assert_eq!(code(&output), Some(0));
    let said = text(&output.stdout);
    for part in [
        "The run stopped",
        "error: free-rigid-mode",
        "body block",
        "translation x",
        "try",
    ] {
        assert!(said.contains(part), "`{part}` is missing in:\n{said}");
    }
    let output = stickslip(&["explain", "--json", &out]);
    let findings: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let last = findings
        .as_array()
        .and_then(|all| all.last())
        .expect("a finding");
    assert_eq!(last["cause"], "free-rigid-mode");
    assert_eq!(last["severity"], "error");
    assert_eq!(last["suspects"][0]["what"], "body");
    assert!(last["suspects"][0]["position"].is_array());
    let places = std::fs::read(Path::new(&out).join("culprits.vtu")).expect("places");
    assert!(String::from_utf8_lossy(&places).contains("Name=\"CAUSE\""));
}

#[test]
fn explain_repeats_what_the_gate_said() {
    let place = Place::new("explain-poor");
    place.write("case.toml", &soft());
    let (case, out) = (place.path("case.toml"), place.path("out"));
    let output = stickslip(&["run", &case, "-o", &out, "--quiet"]);
    assert_eq!(code(&output), Some(2), "{}", text(&output.stderr));
    let said = text(&stickslip(&["explain", &out]).stdout);
    for part in [
        "exit code 2",
        "error: quality, penetration-to-approach of interface base",
        "above its limit 0.01",
        "augmented-lagrangian",
    ] {
        assert!(said.contains(part), "`{part}` is missing in:\n{said}");
    }
    assert!(!said.contains("Nothing went wrong"), "{said}");

    // What was left by a run that was killed, whatever stands in it.
    let mut killed: serde_json::Value =
        serde_json::from_str(&place.read("out/summary.json")).expect("JSON");
    killed["status"] = "running".into();
    killed["quality"]["figures"] = serde_json::json!([]);
    let killed = killed.to_string();
    place.write("out/summary.json", &killed);
    let said = text(&stickslip(&["explain", &out]).stdout);
    assert!(
        said.contains("killed") && !said.contains("Nothing went wrong"),
        "{said}"
    );
}

#[test]
fn a_run_says_first_what_check_would_warn_of() {
    let place = Place::new("warned");
    let rubber = CASE.replace("poisson = 0.3", "poisson = 0.4999");
    place.write(
        "case.toml",
        &rubber.replace("to = [0.04, 0.02]", "to = [40, 20]"),
    );
    let (case, out) = (place.path("case.toml"), place.path("out"));
    let checked: serde_json::Value =
        serde_json::from_slice(&stickslip(&["check", "--json", &case]).stdout).expect("JSON");
    let output = stickslip(&["run", &case, "-o", &out]);
    let said = text(&output.stderr);
    assert_eq!(code(&output), Some(0), "{said}");
    let summary: serde_json::Value =
        serde_json::from_str(&place.read("out/summary.json")).expect("JSON");
    assert_eq!(summary["findings"], checked["findings"]);
    let causes: Vec<&str> = ["locking", "mixed-units"].into_iter().collect();
    for cause in causes {
        let lines: Vec<&str> = said.lines().filter(|l| l.contains(cause)).collect();
        assert_eq!(lines.len(), 1, "{cause} in\n{said}");
        assert!(
            lines[0].contains("warning") && lines[0].contains("body block"),
            "{said}"
        );
    }
    let explained = text(&stickslip(&["explain", &out]).stdout);
    assert!(explained.contains("before the run"), "{explained}");
    // B-bar cures the one.
    let cured = "body.block.formulation=\"mean-dilatation\"";
    let output = stickslip(&["run", &case, "-o", &out, "--set", cured]);
    assert!(!text(&output.stderr).contains("locking"));
}

#[test]
fn explain_refuses_what_is_no_result() {
    let place = Place::new("no-result");
    let output = stickslip(&["explain", &place.path("nowhere")]);
    assert_eq!(code(&output), Some(1));
    assert!(
        text(&output.stderr).contains("there is no such folder"),
        "{}",
        text(&output.stderr)
    );
    for content in [
        "{\"title\": ",
        "[]",
        "{}",
        "{\"findings\": [{\"cause\": \"gremlins\"}]}",
    ] {
        place.write("summary.json", content);
        let output = stickslip(&["explain", &place.path("")]);
        assert_eq!(code(&output), Some(1), "{content}");
        let said = text(&output.stderr);
        assert!(said.contains("is damaged"), "{content}: {said}");
    }
}
