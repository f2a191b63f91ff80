//! Files that are wrong in every way we could think of, or that fuzzing found: each with the message it must give.
//!
//! `malformed/FORMAT/NAME.FORMAT` has its message in `NAME.message` beside it; with `BLESS=1` in the environment the messages are
//! written anew. Read them: each has to say which file, where, what is wrong and what to do.

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::{gmsh, vtu};
use stickslip::problem::Document;

/// The message for a file, which must not be accepted.
fn message(path: &Path, format: &str) -> String {
    let outcome: Result<(), Error> = match format {
        "toml" => problem(path),
        "msh" => gmsh::read(path).map(drop).map_err(Error::Mesh),
        "vtu" => vtu::read_mesh(path).map(drop).map_err(Error::Mesh),
        other => panic!("no reader for {other}"),
    };
    match outcome {
        Ok(()) => panic!("{}: the mistake goes unnoticed", path.display()),
        Err(e) => format!("{e}\n"),
    }
}

fn problem(path: &Path) -> Result<(), Error> {
    let document = Document::read(path)?;
    let located = |error| match error {
        Error::Problem(e) if e.source.is_empty() => Error::Problem(document.error(e.findings)),
        other => other,
    };
    let problem = document.problem()?;
    problem.build(&document.folder()).map(drop).map_err(located)
}

/// The files of a format, sorted; paths are relative to the package, so that messages are the same everywhere.
fn files(format: &str) -> Vec<PathBuf> {
    let folder = Path::new("tests/malformed").join(format);
    let entries = std::fs::read_dir(folder).expect("a folder of files");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == format))
        .collect();
    paths.sort();
    paths
}

/// Compares the messages of a format, and what every message has to have.
fn compare(format: &str, least: usize) {
    let bless = std::env::var_os("BLESS").is_some();
    let mut wrong = Vec::new();
    let files = files(format);
    assert!(files.len() >= least, "{} files", files.len());
    for path in files {
        let found = message(&path, format);
        let expected = path.with_extension("message");
        if bless {
            std::fs::write(&expected, &found).expect("the folder can be written to");
        }
        let wanted = std::fs::read_to_string(&expected).unwrap_or_default();
        if found != wanted {
            wrong.push(format!(
                "{}\n--- expected\n{wanted}--- found\n{found}",
                path.display()
            ));
        }
        let name = path.display().to_string();
        // Findings in a mesh that a problem file names are about the problem file or about the mesh.
        let about =
            found.contains(&name) || (format == "toml" && found.contains("tests/malformed"));
        if !about || !found.contains("help: ") {
            wrong.push(format!("{name}: no file or no help in\n{found}"));
        }
        if found.len() > 2000 {
            wrong.push(format!("{name}: a message of {} bytes", found.len()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn problem_files() {
    compare("toml", 50);
}

#[test]
fn gmsh_meshes() {
    compare("msh", 40);
}

#[test]
fn grids() {
    compare("vtu", 30);
}
