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

/// The value of an attribute of a line of SVG.
fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
    let (_, rest) = line.split_once(&format!(" {name}=\"")).expect(name);
    rest.split_once('"').expect("an end").0
}

/// The last curve of a picture, the latest time, in the units of its axes: the part of them that a pixel is follows from the first two numbers of each.
fn last_curve(picture: &str) -> Vec<[f64; 2]> {
    let scale = |anchor: &str, at: &str| -> f64 {
        let numbers = picture.lines().filter(|l| {
            l.starts_with("<text") && attribute(l, "text-anchor") == anchor && l.contains("#56616f")
        });
        let numbers = numbers.map(|l| {
            let (_, said) = l.split_once('>').expect("a text");
            let said = said.trim_end_matches("</text>").replace('\u{2212}', "-");
            [&*said, attribute(l, at)].map(|n| n.parse::<f64>().expect("a number"))
        });
        let numbers: Vec<[f64; 2]> = numbers.take(2).collect();
        (numbers[1][0] - numbers[0][0]) / (numbers[1][1] - numbers[0][1])
    };
    let [across, up] = [scale("middle", "x"), scale("end", "y")];
    let curve = picture.lines().rfind(|l| l.starts_with("<polyline"));
    let curve = attribute(curve.expect("a curve"), "points").split(' ');
    let curve = curve.map(|point| {
        let (x, y) = point.split_once(',').expect("two numbers");
        [x, y].map(|n| n.parse::<f64>().expect("a number"))
    });
    let zero = picture
        .lines()
        .find(|l| l.contains(">0</text>") && attribute(l, "text-anchor") == "end");
    let axis = picture
        .lines()
        .zip(picture.lines().skip(1))
        .find(|(_, l)| Some(*l) == zero);
    let axis = attribute(axis.expect("the axis of zero").0, "points");
    let level: f64 = axis
        .split([',', ' '])
        .nth(1)
        .expect("a height")
        .parse()
        .expect("a number");
    curve.map(|[x, y]| [x * across, (y - level) * up]).collect()
}

/// A block that slides over a plane wears, and the plane twice as fast: the scars of both are drawn, and hold the volumes.
#[test]
fn the_scars_of_both_surfaces_are_drawn() {
    let case = CASE
        .replace(
            "friction.coulomb = { mu = 0.3 }",
            "friction.coulomb = { mu = 0.3 }, wear.archard = { coefficient = 1e-15, primary-coefficient = 2e-15 }",
        )
        .replace("step = [", "support.slide = { set = \"block.top\", x = 0.02, y = -1e-5 }\nstep = [")
        .replace(
            "increments = { fixed = 2 } }",
            "supports = [\"top\"], increments = { fixed = 2 } }, { name = \"slide\", supports = [\"slide\"], increments = { fixed = 4 } }",
        );
    let folder = support::place("reports", "scars", &case);
    let output = stickslip(&[
        "run",
        "--quiet",
        &folder.join("case.toml").to_string_lossy(),
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let results = folder.join("case.out");
    let picture = folder.join("scar.svg");
    let arguments = ["--along", "base", "--field", "CWEAR", "--time", "all", "-o"];
    let (results, file) = (results.to_string_lossy(), picture.to_string_lossy());
    let mut all = vec!["plot", &results];
    all.extend(arguments);
    all.push(&file);
    let output = stickslip(&all);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(
        said.contains("scar.svg") && said.contains("scar-opposite.svg"),
        "{said}"
    );
    let history = std::fs::read_to_string(folder.join("case.out/history.csv")).unwrap();
    let of_row =
        |l: Option<&str>| -> Vec<String> { l.unwrap().split(',').map(String::from).collect() };
    let (names, row) = (
        of_row(history.lines().next()),
        of_row(history.lines().last()),
    );
    let volume = names.iter().position(|n| n == "base.CWEARVOL").unwrap();
    let volume: f64 = row[volume].parse().unwrap();
    for (file, part) in [("scar.svg", 1.0), ("scar-opposite.svg", 2.0)] {
        let picture = std::fs::read_to_string(folder.join(file)).unwrap();
        for time in ["0.5", "1", "1.25", "1.5", "1.75", "2"] {
            assert!(
                picture.contains(&format!(">CWEAR at {time}<")),
                "{file}: {time}"
            );
        }
        let curve = last_curve(&picture);
        let length = curve[1][0] - curve[0][0];
        // Points at the ends of the block have half an area, places of the track a whole one each.
        let ends = [curve.first(), curve.last()].map(|p| p.unwrap()[1]);
        let left_out = if part == 1.0 {
            0.5 * (ends[0] + ends[1])
        } else {
            0.0
        };
        let drawn = length * (curve.iter().map(|p| p[1]).sum::<f64>() - left_out);
        let worn = volume * part / 3.0;
        assert!((drawn / worn - 1.0).abs() < 1e-3, "{file}: {drawn} {worn}");
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
