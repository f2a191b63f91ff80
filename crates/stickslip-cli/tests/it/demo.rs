//! What whoever has nothing but the binary sees first.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Output;

use crate::support::{code, command, folder, text};

fn demo(folder: &Path, browser: &str, arguments: &[&str]) -> Output {
    let mut command = command(folder);
    // Nothing of this machine: neither a screen nor what is on the path.
    command.env_clear().env("BROWSER", browser);
    command
        .arg("demo")
        .args(arguments)
        .output()
        .expect("the binary runs")
}

/// A browser that leaves the name of the page in the file `opened`.
fn browser(folder: &Path) -> String {
    let script = folder.join("browse");
    std::fs::write(&script, "#!/bin/sh\necho \"$1\" > opened\n")
        .expect("the folder can be written to");
    std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o755)).expect("a script");
    format!("/no/such/browser:{}", script.display())
}

#[test]
fn the_demo_runs_alone_and_says_what_it_shows_and_where() {
    let folder = folder("demo", "alone");
    let output = demo(&folder, &browser(&folder), &["shown", "--no-open"]);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(code(&output), Some(0), "{err}");
    assert!(!folder.join("opened").exists());
    for file in [
        "lug.toml",
        "lug.msh",
        "lug.out/plot.png",
        "lug.out/report.html",
        "lug.out/summary.json",
    ] {
        assert!(folder.join("shown").join(file).is_file(), "{file}");
    }
    // The numbers of the README of the example.
    let said = out.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "pressure carries 16.4 kN and friction 3.65 kN of the load",
        "68 points of the hole slip",
        "55 have lifted off",
        "in balance with 1.81 kN",
        "open the report in a browser",
    ] {
        assert!(said.contains(part), "{part} in\n{out}");
    }
    assert!(
        out.contains("report   shown/lug.out/report.html\n"),
        "{out}"
    );
    assert!(out.lines().all(|l| l.chars().count() <= 100), "{out}");
    assert!(err.contains("peak pressure"), "{err}");

    // What it advises is sound, and the demo does not run over what somebody has changed.
    let advised = out
        .lines()
        .find_map(|l| l.trim().strip_prefix("stickslip run "));
    let (advised, _) = advised
        .and_then(|l| l.split_once(" -o "))
        .expect("a command");
    let check = command(&folder)
        .arg("check")
        .args(advised.split(' '))
        .output();
    assert_eq!(code(&check.expect("the binary runs")), Some(0));
    let case = folder.join("shown/lug.toml");
    std::fs::write(&case, "format = 1\n# my own\n").expect("the folder can be written to");
    let output = demo(&folder, "", &["shown", "-q"]);
    assert_eq!(code(&output), Some(1));
    let err = text(&output.stderr);
    assert!(
        err.contains("lug.toml: this file has been changed, and is not written over"),
        "{err}"
    );
    assert!(std::fs::read_to_string(&case).is_ok_and(|t| t.ends_with("my own\n")));
}

#[test]
fn the_demo_opens_the_browser_that_there_is() {
    let folder = folder("demo", "browser");
    let output = demo(&folder, &browser(&folder), &["-q"]);
    assert_eq!(code(&output), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("the report is open in your browser"));
    let opened = std::fs::read_to_string(folder.join("opened")).expect("the script ran");
    assert_eq!(
        Path::new(opened.trim()),
        folder.join("stickslip-demo/lug.out/report.html")
    );
}
