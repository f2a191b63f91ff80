//! Input decks through the command: run as they are, and converted to a problem file first.

use crate::support::{stickslip, text};
use std::path::{Path, PathBuf};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/decks")
        .join(name)
}

/// An empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn run(file: &Path, results: &Path) {
    let output = stickslip(&[Path::new("run"), file, Path::new("--output"), results]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[test]
fn a_deck_and_the_problem_file_made_of_it_give_the_same_bits() {
    let folder = folder("deck-round-trip");
    let deck = deck("slide.inp");
    run(&deck, &folder.join("deck"));
    let problem = folder.join("slide.toml");
    let output = stickslip(&[Path::new("convert"), &deck, &problem]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(folder.join("slide.msh").exists());
    run(&problem, &folder.join("problem"));
    let read = |results: &str, name: &str| {
        std::fs::read(folder.join(results).join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let (mut fields, mut interfaces) = (0, 0);
    for (inner, ending, count) in [
        ("", "vtu", &mut fields),
        ("interfaces", "csv", &mut interfaces),
    ] {
        for entry in std::fs::read_dir(folder.join("deck").join(inner)).expect("results") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|e| e == ending) {
                let name = path
                    .strip_prefix(folder.join("deck"))
                    .expect("it is in there");
                let name = name.to_string_lossy();
                assert!(
                    read("deck", &name) == read("problem", &name),
                    "{name} differs"
                );
                *count += 1;
            }
        }
    }
    assert!(fields > 3 && interfaces > 0, "{fields} {interfaces}");
    assert!(read("deck", "history.csv") == read("problem", "history.csv"));
    // What the deck prints is beside its results.
    let dat = text(&read("deck", "slide.dat"));
    let forces = dat.lines().filter(|l| l.contains("total force")).count();
    assert!(forces >= 6, "{dat}");
    assert!(text(&read("deck", "slide.sta")).contains("COMPLETED SUCCESSFULLY"));
}

#[test]
fn check_reads_a_deck_for_those_who_solve_it_elsewhere() {
    let output = stickslip(&[Path::new("check"), &deck("slide.inp")]);
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(
        out.contains("INTERNAL_SURFACE-2-INTERNAL_SURFACE-1"),
        "{out}"
    );
    assert!(!out.contains("warning"), "{out}");

    let folder = folder("deck-lint");
    let odd = folder.join("odd.inp");
    let mesh = deck("mesh.inp");
    let plain = std::fs::read_to_string(deck("slide.inp")).expect("the deck");
    let plain = plain
        .replace("Input=mesh.inp", &format!("Input=\"{}\"", mesh.display()))
        // The far side of the upper block, and no friction slope.
        .replace("Internal_Surface-2, Internal_Surface-1", "Wrong_side, Internal_Surface-1")
        .replace("0.3, 2.1E+05", "0.3")
        .replace(
            "** Materials",
            "*Surface, Name=Wrong_side\n55, S2\n*Nset, Nset=Forgotten\n1\n*Amplitude, Name=Idle\n0, 0, 1, 1\n*Node\n9999, 0, 0, 9\n** Materials",
        );
    std::fs::write(&odd, plain).expect("a file");
    let output = stickslip(&[Path::new("check"), &odd]);
    let out = text(&output.stdout);
    for wanted in [
        "sets of nodes that nothing uses: FORGOTTEN",
        "amplitudes that nothing uses: IDLE",
        "surfaces that nothing uses: INTERNAL_SURFACE-2",
        "1 nodes are in no element, the first is 9999",
        "face the same direction",
        "no stick slope",
    ] {
        assert!(
            out.contains(wanted),
            "{wanted}:\n{out}\n{}",
            text(&output.stderr)
        );
    }
}

#[test]
fn what_a_deck_prints_goes_on_where_it_was() {
    let folder = folder("deck-goes-on");
    let out = folder.join("out");
    let mut words: Vec<String> = ["run", "-q", "--output"].map(String::from).to_vec();
    words.extend([
        out.display().to_string(),
        deck("slide.inp").display().to_string(),
    ]);
    for value in [
        "step.1.increments={ fixed = 4 }",
        "step.2.increments={ fixed = 6 }",
        "output.checkpoint.increments=1",
        "solver.method=sparse",
    ] {
        words.extend(["--set".to_string(), value.to_string()]);
    }
    let output = stickslip(&words);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let files = ["slide.dat", "slide.sta", "slide.frd", "history.csv"];
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap_or_default();
    let whole = files.map(read);
    let results = out.display().to_string();
    let words = ["resume", results.as_str(), "-q", "--from", "9"];
    let output = stickslip(&words);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for (name, before) in files.iter().zip(&whole) {
        assert!(read(name) == *before, "{name} differs");
    }
    assert_eq!(whole[0].matches("S T E P").count(), 2);
    // The second step asks for nodes anew, and for the rest as before.
    for name in ["DISP", "FORC", "STRESS", "TOSTRAIN", "CONTACT"] {
        let line = format!("\n -4  {name:<8}");
        assert_eq!(whole[2].matches(&line).count(), 10, "{name}");
    }
    assert!(whole[2].ends_with("\n -3\n 9999\n"));
}

#[test]
fn a_problem_and_a_deck_write_frd_files_only_if_they_are_asked_to() {
    let folder = folder("deck-frd");
    let there = |out: &str, name: &str| folder.join(out).join(name).exists();
    let run = |out: &str, set: &str| {
        let (deck, out) = (deck("slide.inp"), folder.join(out));
        let words: [&std::ffi::OsStr; 7] = [
            "run".as_ref(),
            "-q".as_ref(),
            deck.as_os_str(),
            "--set".as_ref(),
            set.as_ref(),
            "--output".as_ref(),
            out.as_os_str(),
        ];
        let output = stickslip(&words);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    };
    run("out", "output.frd=binary");
    assert!(there("out", "slide.frd") && !there("out", "fields.frd"));
    // What an older run left goes.
    run("out", "output.frd=none");
    assert!(!there("out", "slide.frd"));
}

/// A deck is swept and its laws are tabulated as those of a problem file; the last run is that of the deck as it stands, to the last bit.
#[test]
fn a_deck_is_swept_as_a_problem_file_is() {
    let folder = folder("deck-sweep");
    for name in ["slide.inp", "mesh.inp"] {
        std::fs::copy(deck(name), folder.join(name)).expect("a copy");
    }
    let place = |name: &str| folder.join(name).display().to_string();
    let output = stickslip(&["convert".into(), place("slide.inp"), place("slide.toml")]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let problem = std::fs::read_to_string(folder.join("slide.toml")).expect("a problem file");
    let table = |line: &str| line.starts_with("[interface.") && line.matches('.').count() == 1;
    let header = problem.lines().find(|l| table(l)).expect("an interface");
    let interface = header.trim_matches(['[', ']']);
    let key = format!("{interface}.friction.coulomb.mu");
    let name = interface.trim_start_matches("interface.");

    let output = stickslip(&[
        "sweep".into(),
        place("slide.inp"),
        format!("--set={key}=0.05,0.1"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(folder.join("slide.sweep.csv")).expect("a table");
    let rows: Vec<&str> = written.lines().collect();
    assert_eq!(rows.len(), 3, "{written}");
    assert!(
        rows[1].starts_with("1,0.05,done") && rows[2].starts_with("2,0.1,done"),
        "{written}"
    );

    // Run alone with that value it gives what its row says, and another what the comparison of folders says.
    for (value, results) in [("0.05", "low"), ("0.1", "high")] {
        let set = format!("--set={key}={value}");
        let output = stickslip(&[
            "run".into(),
            place("slide.inp"),
            set,
            format!("--output={}", place(results)),
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    let last = std::fs::read_to_string(folder.join("low/history.csv")).expect("a history");
    let last = last
        .lines()
        .last()
        .expect("a row")
        .split(',')
        .next_back()
        .expect("a value");
    assert!(rows[1].ends_with(last), "{} against {last}", rows[1]);
    let compare = |a: &str, b: &str, more: &[&str]| {
        let mut all = vec!["compare".to_string(), place(a), place(b)];
        all.extend(more.iter().map(|m| m.to_string()));
        stickslip(&all)
    };
    let same = compare("low", "low", &["--relative", "0"]);
    assert_eq!(same.status.code(), Some(0), "{}", text(&same.stdout));
    assert!(text(&same.stdout).contains("all differ by at most 0\n"));
    let other = compare("low", "high", &["--relative", "0.1"]);
    assert_eq!(other.status.code(), Some(2), "{}", text(&other.stdout));
    let said = text(&other.stdout);
    let shear = said
        .lines()
        .find(|l| l.contains(&format!("history {name}.CFS1")));
    let shear = shear.unwrap_or_else(|| panic!("{said}"));
    // Twice the friction in gross slip: half of the larger force is missing.
    assert!(
        shear.contains(" 0.5 ") || shear.contains(" 0.49") || shear.contains(" 0.50"),
        "{shear}"
    );
    assert_eq!(compare("low", "high", &[]).status.code(), Some(0));
    let alone = stickslip(&["compare".into(), place("low"), "--relative=1".to_string()]);
    assert_eq!(alone.status.code(), Some(1));

    let curve = stickslip(&["curve".into(), place("slide.inp"), name.to_string()]);
    assert_eq!(curve.status.code(), Some(0), "{}", text(&curve.stderr));
    assert!(text(&curve.stdout).starts_with("gap,pressure,slope"));
}
