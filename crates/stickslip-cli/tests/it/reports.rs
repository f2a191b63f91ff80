//! Reports and pictures from outside: what a run leaves is enough for them.

use crate::support::{self, CASE, stickslip, text};
use std::path::PathBuf;

/// The results of the case, with another coefficient of friction, in a folder of its own.
fn results(name: &str) -> PathBuf {
    let folder = support::place("reports", name, &format!("title = \"A block\"\n{CASE}"));
    let case = folder.join("case.toml");
    let set = "interface.base.friction.coulomb.mu=0.4";
    let output = stickslip(&["run", "--quiet", "--set", set, &case.to_string_lossy()]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    folder.join("case.out")
}

#[test]
fn a_run_leaves_its_problem_with_what_was_changed() {
    let results = results("problem");
    let text = std::fs::read_to_string(results.join("problem.toml")).unwrap();
    let again = stickslip::problem::Problem::from_toml(&text, None).unwrap();
    assert_eq!(again.title.as_deref(), Some("A block"));
    assert!(text.contains("mu = 0.4"), "{text}");
}

#[test]
fn a_report_and_pictures_are_made_of_what_a_run_leaves() {
    let results = results("all");
    let folder = results.to_string_lossy();
    let output = stickslip(&["report", &folder]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("report.html"));
    let page = std::fs::read_to_string(results.join("report.html")).unwrap();
    assert!(page.contains("<title>A block</title>") && page.contains("0.4"));
    for (arguments, file) in [
        (&[][..], "plot.png"),
        (
            &[
                "--field", "CPRESS", "--time", "1", "--scale", "10", "--view", "-z", "--size",
                "300x200",
            ],
            "plot.png",
        ),
        (&["--history", "base.CFN2,ALLSE"], "history.png"),
        (&["--along", "base", "--zoom", "whole"], "base.png"),
        (
            &[
                "--zoom", "2", "--at", "-0.5,0", "--arrows", "no", "--mirror", "x", "--units",
                "m,Pa",
            ],
            "plot.png",
        ),
    ] {
        let _ = std::fs::remove_file(results.join(file));
        let mut all = vec!["plot", &folder];
        all.extend(arguments);
        let output = stickslip(&all);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(results.join(file).is_file(), "{arguments:?}");
    }
}

#[test]
fn what_cannot_be_drawn_is_an_error_of_the_input() {
    let results = results("errors");
    let folder = results.to_string_lossy();
    for (arguments, message) in [
        (vec!["report", "nowhere"], "there is no such folder"),
        (vec!["plot", "nowhere"], "there is no such folder"),
        (
            vec!["plot", &folder, "--field", "NO"],
            "there is no field `NO`",
        ),
        (
            vec!["plot", &folder, "--field", "CPRES"],
            "did you mean `CPRESS`?",
        ),
        (
            vec!["plot", &folder, "--time", "now"],
            "`peak`, `last`, `all` or a number",
        ),
        (
            vec!["plot", &folder, "--along", "bass"],
            "did you mean `base`?",
        ),
        (vec!["plot", &folder, "--zoom", "far"], "`contact`, `whole`"),
        (vec!["plot", &folder, "--cut", "w"], "x, y or z"),
        (vec!["plot", &folder, "--units", "mm"], "`mm,MPa`"),
        (
            vec!["plot", &folder, "--at", "1"],
            "two or three coordinates",
        ),
        (
            vec!["plot", &folder, "--size", "big"],
            "width and height like 1200x900",
        ),
        (
            vec!["plot", &folder, "-o", "x.pdf"],
            "ends with .png or .svg",
        ),
        (vec!["plot", &folder, "--history", "NO"], "no column `NO`"),
        (
            vec!["plot", &folder, "--history", ","],
            "no column is named",
        ),
    ] {
        let output = stickslip(&arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let said = text(&output.stderr);
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}
