//! Problem files from a few numbers: they run, and what comes out is what was told.

use std::path::Path;
use std::process::Output;

use crate::support::{code, command, folder, text};

fn stickslip(folder: &Path, line: &str) -> Output {
    let mut command = command(folder);
    command.args(line.split_whitespace());
    command.output().expect("the binary runs")
}

/// Writes a problem, checks it, runs it and compares it with what was expected; what was told.
fn through(name: &str, line: &str) -> String {
    let folder = folder("new", name);
    let made = stickslip(&folder, &format!("new {line} -o case.toml"));
    assert_eq!(code(&made), Some(0), "{}", text(&made.stderr));
    for next in [
        "check case.toml",
        "run case.toml -q",
        "compare case.out case.expected.toml",
    ] {
        let output = stickslip(&folder, next);
        let said = text(&output.stdout) + &text(&output.stderr);
        assert_eq!(code(&output), Some(0), "{next}\n{said}");
    }
    let problem = std::fs::read_to_string(folder.join("case.toml")).expect("the problem file");
    assert!(
        problem.starts_with("#:schema ./stickslip.schema.json\n"),
        "{problem}"
    );
    let told = text(&made.stdout);
    assert!(told.lines().all(|l| l.chars().count() <= 100), "{told}");
    assert!(told.contains("next: stickslip run case.toml"), "{told}");
    told
}

#[test]
fn a_cylinder_on_a_flat_has_the_pressure_that_was_told() {
    // NAFEMS contact benchmark 1: 6.2146 mm and 3585 MPa.
    let steel_on_aluminium = "--young 210GPa --flat-young 70GPa --radius 50mm --load 35kN/mm";
    let told = through("line", &format!("hertz {steel_on_aluminium}"));
    assert!(
        told.contains("6.215 mm") && told.contains("3585 MPa"),
        "{told}"
    );
    through(
        "line-rigid",
        "hertz --rigid --cells 8 --load 1kN/m --radius 2in",
    );
}

#[test]
fn a_ball_on_a_flat_has_the_pressure_that_was_told() {
    through("point", "hertz --radius 10mm --load 50N");
    through(
        "point-rigid",
        "hertz --radius 1m --load 2kN --rigid --young 10MPa --cells 16",
    );
}

#[test]
fn a_fretting_test_slides_and_wears_as_was_told() {
    let told = through("fretting", "fretting --cycles 300 --computed 3 --cells 3");
    assert!(told.contains("gross slip"), "{told}");
    let told = through(
        "fretting-partial",
        "fretting --amplitude 0.3um --cycles 2 --cells 4",
    );
    assert!(told.contains("partial slip"), "{told}");
}

#[test]
fn a_bolt_has_the_forces_that_were_told() {
    through("bolt", "bolt");
    through(
        "bolt-short",
        "bolt --diameter 16mm --preload 60kN --grip 20mm --pull 30kN --sleeve 60mm",
    );
}

#[test]
fn a_belt_takes_its_mass_along_as_was_told() {
    let told = through("belt", "belt");
    assert!(
        told.contains("0.4 s") && told.contains("0.4069 s"),
        "{told}"
    );
    through(
        "belt-stiff",
        "belt --mass 50g --load 2N --stiffness 5N/mm --speed 10mm/s --static 0.4 --kinetic 0.35 --cycles 2",
    );
}

#[test]
fn gears_carry_the_torques_that_were_told() {
    let told = through(
        "gear",
        "gear --teeth 24 --wheel 20 --torque 15Nm --cells 60 --positions 8",
    );
    assert!(
        told.contains("44 mm apart") && told.contains("18 Nm"),
        "{told}"
    );
}

#[test]
fn numbers_that_no_theory_holds_for_are_refused_with_advice() {
    let folder = folder("new", "wrong");
    for (line, parts) in [
        ("hertz --radius -3mm", ["-3 is not above zero", ""]),
        ("hertz --radius 3", ["the unit is missing", "10mm"]),
        ("hertz --load 3MPa", ["a force or a force per length", ""]),
        (
            "hertz --load 1MN/mm",
            ["too wide for Hertz's theory", "N/m do"],
        ),
        (
            "hertz --load 1kN/mm --yield 250MPa",
            ["times the yield stress", "at most"],
        ),
        (
            "fretting --cycles 100000000",
            ["the scar would be", "fewer cycles"],
        ),
        (
            "fretting --amplitude 3mm",
            ["small cells along the surface", "amplitude"],
        ),
        (
            "bolt --preload 90kN",
            ["above its yield stress", "at most 50.3 kN"],
        ),
        ("bolt --pull 30kN", ["opens the joint", "18 kN"]),
        ("bolt --sleeve 11mm", ["hardly wider than its hole", ""]),
        (
            "belt --kinetic 0.6",
            ["no less than 0.5 at rest", "--kinetic"],
        ),
        ("gear --teeth 8", ["no involute", "17 teeth"]),
        (
            "gear --torque 3N",
            ["`N` is not the unit of a torque", "20Nm"],
        ),
        ("belt --speed 1um/s", ["too far apart", "faster than"]),
    ] {
        let output = stickslip(&folder, &format!("new {line}"));
        assert_eq!(code(&output), Some(1), "{line}");
        let said = text(&output.stderr)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        for part in parts {
            assert!(said.contains(part), "{line}: {part} in\n{said}");
        }
    }
    let left = std::fs::read_dir(&folder).expect("a folder").count();
    assert_eq!(left, 0, "nothing is written");
}

#[test]
fn no_file_is_written_over() {
    let folder = folder("new", "taken");
    std::fs::write(folder.join("belt.expected.toml"), "mine").expect("a file");
    let output = stickslip(&folder, "new belt");
    assert_eq!(code(&output), Some(1));
    assert!(text(&output.stderr).contains("not written over"));
    assert!(!folder.join("belt.toml").exists());
    let kept = std::fs::read_to_string(folder.join("belt.expected.toml"));
    assert_eq!(kept.expect("a file"), "mine");
}
