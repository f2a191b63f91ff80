//! Folders and files that come from somebody else: nothing outside a folder of results is written to, nothing acts on the terminal, and what was changed is not
//! taken for what a run has written.

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use crate::support::{self, CASE, code, text};

const SUITE: &str = "strangers";

fn place(name: &str) -> PathBuf {
    support::place(SUITE, name, CASE)
}

/// Runs the command; the exit code and what it said on both streams.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = support::command(folder).args(arguments).output();
    let output = output.expect("the binary runs");
    let said = text(&output.stderr) + &text(&output.stdout);
    assert!(!said.contains("panicked at"), "{said}");
    (code(&output), said)
}

fn write(path: &Path, content: &str) {
    std::fs::write(path, content).expect("it can be written");
}

fn read(path: &Path) -> String {
    let bytes = std::fs::read(path).expect("it is there");
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A folder with results and checkpoints, and an `.frd` file.
fn with_results(name: &str) -> PathBuf {
    let folder = place(name);
    let all = [
        "run",
        "case.toml",
        "-q",
        "--set",
        "output.frd=text",
        // Interiors of several increments would be waited for together.
        "--set",
        "solver.method=sparse",
        "--set",
        "output.checkpoint.increments=1",
        "--set",
        "output.every=1",
    ];
    assert_eq!(run(&folder, &all), (Some(0), String::new()));
    folder
}

#[test]
fn a_run_writes_through_no_link_in_its_folder() {
    for name in ["run.lock", "interfaces"] {
        let folder = place(&format!("run-{name}"));
        let out = folder.join("case.out");
        std::fs::create_dir(&out).unwrap();
        let elsewhere = folder.join("elsewhere");
        if name == "interfaces" {
            std::fs::create_dir(&elsewhere).unwrap();
            write(&elsewhere.join("base.csv"), "precious");
        } else {
            write(&elsewhere, "precious");
        }
        symlink(&elsewhere, out.join(name)).unwrap();
        let (code, said) = run(&folder, &["run", "case.toml", "-q"]);
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains(name) && said.contains("this is a link"),
            "{said}"
        );
        match name {
            "interfaces" => {
                assert_eq!(std::fs::read_dir(&elsewhere).unwrap().count(), 1);
                assert_eq!(read(&elsewhere.join("base.csv")), "precious");
            }
            _ => assert_eq!(read(&elsewhere), "precious"),
        }
    }
}

/// Files that are made anew take the place of a link, and so does the name under which they are written first.
#[test]
fn files_that_are_replaced_leave_alone_what_a_link_leads_to() {
    let folder = place("replaced");
    let out = folder.join("case.out");
    std::fs::create_dir(&out).unwrap();
    let victim = folder.join("victim");
    write(&victim, "precious");
    for name in ["summary.json", "history.csv", "problem.toml", "fields.pvd"] {
        symlink(&victim, out.join(name)).unwrap();
    }
    let (code, said) = run(&folder, &["run", "case.toml", "-q"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(read(&victim), "precious");
    assert!(read(&out.join("history.csv")).starts_with("STEP,"));
}

#[test]
fn a_run_goes_on_through_no_link_in_its_folder() {
    for (name, hard) in [
        ("history.csv", false),
        ("history.csv", true),
        ("fields.frd", false),
        ("interfaces", false),
        ("run.lock", false),
    ] {
        let folder = with_results(&format!("resume-{name}-{hard}"));
        let (inside, victim) = (folder.join("case.out").join(name), folder.join("victim"));
        match inside.exists() {
            true => std::fs::rename(&inside, &victim).unwrap(),
            false => write(&victim, "precious"),
        }
        match hard {
            true => std::fs::hard_link(&victim, &inside).unwrap(),
            false => symlink(&victim, &inside).unwrap(),
        }
        let before = (!victim.is_dir()).then(|| read(&victim));
        let (code, said) = run(&folder, &["resume", "case.out", "-q"]);
        assert_eq!(code, Some(1), "{name}: {said}");
        let why = if hard { "hard link" } else { "this is a link" };
        assert!(said.contains(name) && said.contains(why), "{name}: {said}");
        assert_eq!((!victim.is_dir()).then(|| read(&victim)), before);
    }
}

/// A spreadsheet ends lines otherwise, so that nothing is where it was.
#[test]
fn a_history_that_was_changed_is_not_gone_on_with() {
    let folder = with_results("changed");
    let history = folder.join("case.out/history.csv");
    let before = read(&history);
    write(&history, &before.replace('\n', "\r\n"));
    let (code, said) = run(&folder, &["resume", "case.out", "-q"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("carriage returns"), "{said}");
    assert_eq!(read(&history), before.replace('\n', "\r\n"));
    // One digit less, and what came later.
    write(&history, &(before.replacen("5e-1", "5e-2", 1) + "1,1,1\n"));
    let (code, said) = run(&folder, &["resume", "case.out", "-q"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("the file was changed since the run wrote it"),
        "{said}"
    );
    write(&history, &(before.clone() + "what came later"));
    let (code, said) = run(&folder, &["resume", "case.out", "-q"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(read(&history), before);
}

/// The last line of the file is what a full disk takes first.
#[test]
fn a_run_goes_on_after_a_disk_was_full() {
    let folder = with_results("full");
    let frd = folder.join("case.out/fields.frd");
    let before = read(&frd);
    let cut = before.strip_suffix(" 9999\n").expect("a whole file");
    write(&frd, cut);
    let (code, said) = run(&folder, &["resume", "case.out", "-q"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(read(&frd), before);
}

#[test]
fn a_run_goes_on_without_fields_that_were_removed() {
    let folder = with_results("fields");
    let out = folder.join("case.out");
    std::fs::remove_file(out.join("fields_00000.vtu")).unwrap();
    let (code, said) = run(&folder, &["resume", "case.out", "--from", "1", "-q"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("1 of 1 files of fields are no longer there"),
        "{said}"
    );
    let listed = read(&out.join("fields.pvd"));
    assert!(!listed.contains("fields_00000"), "{listed}");
    // Numbers go on where they were.
    let next = "fields_00001.vtu";
    assert!(listed.contains(next) && out.join(next).exists(), "{listed}");
}

#[test]
fn tables_of_others_stay_where_interfaces_have_theirs() {
    let folder = with_results("tables");
    let tables = folder.join("case.out/interfaces");
    for name in ["notes.csv", "base-copy.csv", "mine_00001.vtp"] {
        write(&tables.join(name), "mine");
    }
    assert!(tables.join("base_00001.vtp").exists());
    let fewer = ["run", "case.toml", "-q", "--set", "output.every=0"];
    let (code, said) = run(&folder, &fewer);
    assert_eq!(code, Some(0), "{said}");
    for name in ["notes.csv", "base-copy.csv", "mine_00001.vtp"] {
        assert_eq!(read(&tables.join(name)), "mine", "{name}");
    }
    // What the run before had written and this one does not is gone.
    assert!(!tables.join("base_00001.vtp").exists());
    assert!(tables.join("base.csv").exists());
}

#[test]
fn nothing_in_a_file_acts_on_the_terminal() {
    let folder = place("terminal");
    write(&folder.join("a.msh"), "$MeshFormat\n2.2 0 8\u{1b}[31m\n");
    write(&folder.join("a.inp"), "*NODE\n1,0,0\n*FOO\u{1b}]0;t\u{7}\n");
    write(
        &folder.join("a.vtu"),
        "<VTKFile type=\"\u{1b}[2J\"><a\u{9b}></VTKFile>",
    );
    write(&folder.join("a.txt"), "dim 2 contacts \u{1b}[2J\n");
    let strange = CASE.replace("mu = 0.3", "\"m\\u001b[31mu\" = 0.3");
    write(&folder.join("b.toml"), &strange);
    write(&folder.join("c\u{1b}[31m.toml"), "nothing\u{1b}[2J = [");
    for arguments in [
        &["convert", "a.msh", "a2.vtu"][..],
        &["check", "a.inp"],
        &["convert", "a.vtu", "a2.msh"],
        &["friction", "a.txt"],
        &["check", "b.toml"],
        &["check", "c\u{1b}[31m.toml"],
        &["check", "none\u{1b}[31m.toml"],
        &["compare", "none\u{1b}[31m", "other\u{9b}"],
        &["run", "case.toml", "more\u{1b}[31m"],
        &["run", "case.toml", "--set", "interface.base.\u{1b}[31m=1"],
    ] {
        let (code, said) = run(&folder, arguments);
        assert_eq!(code, Some(1), "{arguments:?}: {said:?}");
        let acts = |c: char| c.is_control() && c != '\n' && c != '\t';
        assert!(!said.contains(acts), "{arguments:?}: {said:?}");
    }
}

#[test]
fn nobody_is_waited_for_at_the_other_end_of_a_pipe() {
    let folder = place("pipe");
    let made = std::process::Command::new("mkfifo")
        .args(["a.toml", "a.msh", "a.inp"])
        .current_dir(&folder)
        .status();
    assert!(made.expect("mkfifo runs").success());
    for name in ["a.toml", "a.inp"] {
        let (code, said) = run(&folder, &["check", name]);
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("a pipe or a socket"), "{said}");
    }
    let (code, said) = run(&folder, &["convert", "a.msh", "b.vtu"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("a pipe or a socket"), "{said}");
}

#[test]
fn a_name_is_no_formula_of_a_spreadsheet() {
    for begin in ["=", "+", "-", "@"] {
        let folder = support::place(
            SUITE,
            "formula",
            &CASE.replace("interface.base", &format!("interface.\"{begin}cmd\"")),
        );
        let (code, said) = run(&folder, &["check", "case.toml"]);
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains("takes a column of that name for a formula"),
            "{said}"
        );
    }
}

#[test]
fn tables_of_laws_have_some_rows_and_a_pressure() {
    let folder = place("curve");
    for wrong in [
        &["--pressure", "nan"][..],
        &["--pressure", "-1"],
        &["--pressure", "inf"],
        &["--rows", "1000000000000"],
        &["--rows", "1"],
    ] {
        let all = [&["curve", "case.toml"], wrong].concat();
        assert_eq!(run(&folder, &all).0, Some(1), "{wrong:?}");
    }
    let (code, said) = run(&folder, &["curve", "case.toml", "--rows", "3"]);
    assert_eq!((code, said.lines().count()), (Some(0), 4), "{said}");
}

#[test]
fn the_exit_codes_are_in_the_help() {
    let folder = place("help");
    let (_, said) = run(&folder, &["--help"]);
    assert!(said.contains("101  a fault of this program"), "{said}");
}
