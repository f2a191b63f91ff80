//! The command from outside: exit codes, and what goes to which stream.

use crate::support::{code, stickslip, text};
use std::path::{Path, PathBuf};

/// A problem file in the folder for temporary files of this test.
fn file(name: &str, content: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).expect("the folder can be written to");
    path
}

const SOUND: &str = r#"format = 1

[model]
space = "plane-strain"

[body.block]
generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }
material = "steel"

[material.steel.isotropic]
young = 210e9
poisson = 0.3

[obstacle.floor.plane]
point = [0, 0]
normal = [0, 1]

[interface.base]
secondary = "block.bottom"
primary = "floor"

[support.top]
set = "block.top"
x = 0.0
y = -1e-5

[[step]]
name = "press"
"#;

#[test]
fn check_tells_what_was_understood() {
    let path = file("sound.toml", SOUND);
    let output = stickslip(&["check", &path.display().to_string()]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let out = text(&output.stdout);
    assert!(
        out.contains("model: plane-strain\nbodies: block\n"),
        "{out}"
    );
    assert!(
        out.contains("interface base: block.bottom on floor; unilateral, none,"),
        "{out}"
    );
}

#[test]
fn check_shows_the_line_of_a_mistake() {
    let path = file("wrong.toml", &SOUND.replace("young", "yuong"));
    let output = stickslip(&["check", &path.display().to_string()]);
    assert_eq!(code(&output), Some(1));
    assert!(output.stdout.is_empty());
    let err = text(&output.stderr);
    for part in [
        "wrong.toml:11:1",
        "11 | yuong = 210e9",
        "did you mean `young`?",
    ] {
        assert!(err.contains(part), "{part} in\n{err}");
    }
}

#[test]
fn overrides_reach_the_check() {
    let path = file("override.toml", SOUND).display().to_string();
    let wrong = "material.steel.isotropic.young=-1";
    let output = stickslip(&["check", &path, "--set", wrong]);
    assert_eq!(code(&output), Some(1));
    let err = text(&output.stderr);
    assert!(
        err.contains("material.steel.isotropic.young: young = -1"),
        "{err}"
    );
}

#[test]
fn a_missing_file_and_a_wrong_command_line_are_wrong_input() {
    let output = stickslip(&["check", "no-such-file.toml"]);
    assert_eq!(code(&output), Some(1));
    assert!(text(&output.stderr).contains("no-such-file.toml"));
    assert_eq!(code(&stickslip(&["chek", "x.toml"])), Some(1));
    assert_eq!(code(&stickslip(&["--help"])), Some(0));
}

#[test]
fn models_lists_families_and_parameters() {
    let output = stickslip(&["models"]);
    assert_eq!(code(&output), Some(0));
    assert!(text(&output.stdout).contains("\n  coulomb "));
    let one = text(&stickslip(&["models", "friction.coulomb"]).stdout);
    assert!(one.starts_with("friction.coulomb\n"), "{one}");
    assert!(one.contains("  mu: number (required)\n"), "{one}");
    let both = text(&stickslip(&["models", "power-law"]).stdout);
    assert!(both.contains("normal.power-law\n") && both.contains("friction.power-law\n"));
    let none = stickslip(&["models", "glue"]);
    assert_eq!(code(&none), Some(1));
    assert!(text(&none.stderr).contains("no model or family `glue`"));
    for (word, meant) in [
        ("coulumb", "`coulomb`"),
        ("fricton", "`friction`"),
        ("friction.coulumb", "`friction.coulomb`"),
        ("frction.colomb", "`friction.coulomb`"),
    ] {
        let said = text(&stickslip(&["models", word]).stderr);
        assert!(said.contains(&format!("did you mean {meant}?")), "{said}");
    }
}

#[test]
fn schema_is_json() {
    let output = stickslip(&["schema"]);
    let schema: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("the schema is JSON");
    assert_eq!(schema["title"], "stickslip problem file");
    assert!(!text(&output.stdout).contains("crate::"));
}

#[test]
fn check_prints_findings_for_programs() {
    let path = file(
        "smells.toml",
        &SOUND.replace("point = [0, 0]", "point = [0, 0.5]"),
    );
    let output = stickslip(&["check", "--json", &path.display().to_string()]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["findings"][0]["cause"], "normals-not-opposed");
    assert_eq!(report["interfaces"][0]["name"], "base");
    let output = stickslip(&["check", &path.display().to_string()]);
    assert!(text(&output.stdout).contains("warning (normals-not-opposed)"));
}

/// A block of mass one that is pushed along with three and down with two, at a coefficient of a half.
const FRICTION: &str = "# one\ndim 2 contacts 1\nmu 0.5\nq\n-2\n3\nW 2\n0 0 1\n1 1 1\n";

#[test]
fn friction_problems_are_solved_alone() {
    let path = file("sliding.txt", FRICTION);
    let folder = path.with_file_name("sliding-forces");
    let (path, folder) = (path.display().to_string(), folder.display().to_string());
    let output = stickslip(&["friction", &path, "-v", "-o", &folder]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    let out = text(&output.stdout);
    assert!(out.contains("| sliding | 1 | "), "{out}");
    assert!(out.ends_with("1 of 1 solved\n"), "{out}");
    let table = std::fs::read_to_string(Path::new(&folder).join("sliding.csv")).expect("forces");
    let values: Vec<f64> = table
        .lines()
        .nth(1)
        .expect("a row")
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    for (value, expected) in values.iter().zip([2.0, -1.0, 0.0, 2.0]) {
        assert!((value - expected).abs() < 1e-12, "{table}");
    }
}

#[test]
fn a_friction_problem_without_a_solution_is_not_called_solved() {
    // Painlevé: pushing in the direction of slip presses the point away from its surface faster than the pressure lets it go.
    let stuck = FRICTION
        .replace("0 0 1\n1 1 1", "0 0 1\n0 1 3\n1 0 3\n1 1 9")
        .replace("mu 0.5", "mu 0.9")
        .replace("W 2", "W 4");
    let path = file("painleve.txt", &stuck).display().to_string();
    let output = stickslip(&["friction", &path]);
    assert_eq!(code(&output), Some(3), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("**none**"));
}

#[test]
fn a_wrong_friction_problem_is_named_with_its_line() {
    let path = file("wrong.txt", &FRICTION.replace("mu 0.5", "mu x"))
        .display()
        .to_string();
    let output = stickslip(&["friction", &path]);
    assert_eq!(code(&output), Some(1));
    let said = text(&output.stderr);
    assert!(
        said.contains("wrong.txt:3: `x` is no finite number"),
        "{said}"
    );
    assert!(said.contains("help: the lines are"), "{said}");
}

/// GRECO's punch, with so many iterations of Newton's method for an increment.
fn punch(iterations: usize, mu: f64, more: &[&str]) -> std::process::Output {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/greco/case.toml");
    let (case, iterations) = (
        case.display().to_string(),
        format!("solver.max-iterations={iterations}"),
    );
    let mu = format!("interface.base.friction.coulomb.mu={mu}");
    let fixed = ["run", &case, "-q", "--set", &iterations, "--set", &mu];
    stickslip(&[&fixed[..], more].concat())
}

#[test]
fn a_friction_problem_finds_what_two_iterations_do_not() {
    for method in ["condensed", "sparse"] {
        let folder = crate::support::folder("commands", &format!("punch-{method}"))
            .display()
            .to_string();
        let solver = format!("solver.method={method:?}");
        let output = punch(2, 1.0, &["-o", &folder, "--set", &solver]);
        assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
        let summary =
            std::fs::read_to_string(Path::new(&folder).join("summary.json")).expect("a summary");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        let fallbacks = summary["fallbacks"].as_array().expect("a list");
        let found =
            |f: &&serde_json::Value| f["kind"] == "friction-problem" && f["converged"] == true;
        assert!(
            fallbacks.iter().any(|f| found(&f)),
            "{method}: {fallbacks:?}"
        );
        // Each increment counts once, by a solver that has a name.
        let counts = summary["friction-solvers"].as_object().expect("counts");
        let found = fallbacks.iter().filter(found).count() as u64;
        let all = counts.values().map(|n| n.as_u64().expect("a number"));
        assert_eq!(all.sum::<u64>(), found, "{method}: {counts:?}");
        let named = |f: &serde_json::Value| counts.contains_key(f["solver"].as_str().unwrap_or(""));
        assert!(fallbacks.iter().all(named), "{counts:?}");
        let told = text(&stickslip(&["explain", &folder]).stdout);
        let by = counts.iter().map(|(name, n)| format!("{n} by {name}"));
        assert!(by.into_iter().all(|by| told.contains(&by)), "{told}");
    }
}

/// The last finding of a run says what became of the friction problem, and where.
fn blames_the_friction_problem(folder: &str, said: &str) {
    let summary = std::fs::read_to_string(Path::new(folder).join("summary.json"));
    let summary: serde_json::Value =
        serde_json::from_str(&summary.expect("a summary")).expect("JSON");
    let finding = summary["findings"].as_array().and_then(|all| all.last());
    let finding = finding.expect("a finding");
    let message = finding["message"].as_str().expect("a sentence");
    assert!(message.contains("friction problem of"), "{message}");
    assert!(!message.contains("of 0 points"), "{message}");
    assert!(message.contains("by proximal newton"), "{message}");
    let suspects = finding["suspects"].as_array().expect("places");
    let known = |g: &serde_json::Value| g["interface"] == "base" && g["position"].is_array();
    assert!(suspects.iter().all(known), "{suspects:?}");
    let ids: std::collections::BTreeSet<_> = suspects.iter().map(|g| g["id"].as_u64()).collect();
    assert!(
        ids.len() == suspects.len() && !ids.is_empty(),
        "{suspects:?}"
    );
    let advice = finding["advice"].to_string();
    assert!(advice.contains("a smoother law"), "{advice}");
    assert!(said.contains("is solved, by proximal newton"), "{said}");
}

#[test]
fn an_increment_that_fails_is_written_as_a_friction_problem_and_solved_alone() {
    for mu in [0.3, 1.0, 2.0] {
        let folder = crate::support::folder("commands", &format!("dumped-{mu}"));
        let (out, dumped) = (
            folder.join("out").display().to_string(),
            folder.join("dumped"),
        );
        // A law that is no straight line is not found by one linear problem.
        let law = "interface.base.normal={ power-law = { c = 1e20, m = 2.0 } }";
        let whole = "step.1.increments={ fixed = 1 }";
        let dumped_in = dumped.display().to_string();
        let more = ["-o", &out, "--dump-failures", &dumped_in];
        let output = punch(
            1,
            mu,
            &[&more[..], &["--set", law, "--set", whole]].concat(),
        );
        assert_eq!(code(&output), Some(3), "{}", text(&output.stderr));
        blames_the_friction_problem(&out, &text(&output.stderr));
        let written = dumped.join("case.txt").display().to_string();
        let output = stickslip(&["friction", &written]);
        assert_eq!(
            code(&output),
            Some(0),
            "{}{}",
            text(&output.stdout),
            text(&output.stderr)
        );
        assert!(text(&output.stdout).contains("1 of 1 solved"));
    }
}
