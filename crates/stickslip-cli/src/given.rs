//! What is given where something else is wanted: a file of another kind, a file for a folder of results, a name that is nearly one that is there.

use std::io::Read;
use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::problem::{Document, nearest};

use crate::failure::Failure;

/// Kinds of files that nothing here reads: how they begin, endings of their names, what they are, and what to do.
type Kind = (
    &'static [u8],
    &'static [&'static str],
    &'static str,
    &'static str,
);

const EXPORT: &str = "export the mesh as .inp (Abaqus) or .msh (Gmsh), and name that";
const FILE_KINDS: &[Kind] = &[
    (
        b"\x89PNG",
        &["png", "jpg", "jpeg", "svg"],
        "a picture",
        "`stickslip plot` makes pictures, and nothing reads them",
    ),
    (
        b"%PDF",
        &["pdf"],
        "a document in PDF",
        "a problem file is text, in TOML",
    ),
    (
        b"\x1f\x8b",
        &["gz", "tgz", "xz", "bz2", "zst"],
        "a compressed file",
        "unpack it first",
    ),
    (
        b"",
        &["fcstd"],
        "a document of FreeCAD",
        "let its FEM workbench write the .inp file, and name that",
    ),
    (
        b"PK\x03\x04",
        &["zip", "xlsx"],
        "an archive",
        "unpack it first; a table of numbers is CSV",
    ),
    (
        b"\x89HDF",
        &["med", "h5", "hdf", "rmed"],
        "a file in HDF5 or MED",
        EXPORT,
    ),
    (b"CDF", &["exo", "e"], "a file in NetCDF or Exodus", EXPORT),
    (
        b"    1C",
        &["frd"],
        "results of CalculiX",
        "CalculiX GraphiX or PrePoMax shows them; the deck they came from ends in .inp",
    ),
    (
        b"",
        &["odb", "cae"],
        "a database of Abaqus",
        "Abaqus writes the deck of a job: `Write Input`, a file that ends in .inp",
    ),
    (
        b"",
        &["k", "key", "dyn"],
        "an input deck of LS-DYNA",
        EXPORT,
    ),
    (
        b"",
        &["bdf", "nas", "fem"],
        "an input deck of Nastran or OptiStruct",
        EXPORT,
    ),
    (b"/COM", &["cdb"], "an input deck of Ansys", EXPORT),
    (
        b"",
        &["csv"],
        "a table",
        "tables are given within problem files; `stickslip compare` and `stickslip plot` take the folder of a history.csv",
    ),
];

/// Whether a file is a deck, by its name.
pub fn is_deck(file: &Path) -> bool {
    file.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("inp"))
}

/// Refuses what is not there, and files of kinds that nothing reads; folders are for others to judge.
///
/// # Errors
/// [`Failure::Arguments`] with what is there under a name that comes near; `endings` are those of files that may be meant.
pub fn file(path: &Path, endings: &[&str]) -> Result<(), Failure> {
    let name = path.display();
    if path.is_dir() {
        return Ok(());
    }
    if path.exists() {
        return match foreign(path) {
            Some((what, help)) => Err(refusal(format!("{name}: this is {what}"), help)),
            None => Ok(()),
        };
    }
    let names = beside(path, |p| {
        let ending = p.extension().unwrap_or_default();
        p.is_file() && endings.iter().any(|e| ending.eq_ignore_ascii_case(e))
    });
    Err(refusal(
        format!("{name}: there is no such file"),
        meant(path, &names),
    ))
}

/// Refuses what is no folder of results: says what it is, and what was probably meant.
///
/// # Errors
/// [`Failure::Arguments`].
pub fn results(path: &Path) -> Result<(), Failure> {
    let name = path.display();
    if has_results(path) {
        return Ok(());
    }
    if path.is_dir() {
        let inside = beside(&path.join("results"), has_results);
        let inside: Vec<String> = inside
            .iter()
            .map(|n| path.join(n).display().to_string())
            .collect();
        let help = match inside.is_empty() {
            true => RUN.to_string(),
            false => format!("results are in {}", some(&inside)),
        };
        return Err(refusal(
            format!("{name}: there are no results in this folder"),
            help,
        ));
    }
    if path.exists() {
        let message = format!(
            "{name}: this is {}, and a folder of results is wanted",
            what(path)
        );
        return Err(refusal(message, folder_of(path)));
    }
    let problem = ["toml", "inp"].map(|ending| path.with_extension(ending));
    let problem = problem.iter().find(|p| p.is_file());
    let help = match problem {
        Some(problem) => format!("run it first: `stickslip run {}`", problem.display()),
        None => meant(path, &beside(path, has_results)),
    };
    Err(refusal(format!("{name}: there is no such folder"), help))
}

/// What is said where there is nothing better to say.
const RUN: &str = "`stickslip run FILE.toml` writes them, into FILE.out if nothing else is chosen";

fn refusal(message: String, help: impl Into<String>) -> Failure {
    Failure::Arguments(message, help.into())
}

fn has_results(folder: &Path) -> bool {
    let files = ["summary.json", "history.csv", "fields.pvd"];
    files.iter().any(|name| folder.join(name).is_file())
}

/// Where the results are that a file has to do with.
fn folder_of(file: &Path) -> String {
    let own = file.with_extension("out");
    if has_results(&own) {
        return format!("its results are in {}", own.display());
    }
    let mut above = file.ancestors().skip(1).take(2);
    if let Some(folder) = above.find(|folder| has_results(folder)) {
        return match folder.as_os_str().is_empty() {
            true => "name the folder that it is in: `.`".into(),
            false => format!("name the folder that it is in: {}", folder.display()),
        };
    }
    match what(file) {
        A_PROBLEM_FILE | DECK => format!("run it first: `stickslip run {}`", file.display()),
        _ => RUN.into(),
    }
}

const A_PROBLEM_FILE: &str = "a problem file";
const DECK: &str = "an input deck";

/// What a file is, as far as its name and its beginning tell.
fn what(file: &Path) -> &'static str {
    if is_deck(file) {
        return DECK;
    }
    if let Some((what, _)) = foreign(file) {
        return what;
    }
    let ending = file.extension().unwrap_or_default();
    match Document::read(file) {
        Ok(document) if document.problem().is_ok() => A_PROBLEM_FILE,
        Ok(_) if file.file_name().is_some_and(|n| n == "expected.toml") => {
            "a list of expected values"
        }
        Ok(_) if ending == "toml" => A_PROBLEM_FILE,
        _ => "a file",
    }
}

/// What a file is that nothing reads, and what to do with it.
fn foreign(path: &Path) -> Option<(&'static str, &'static str)> {
    let mut head = [0; 8];
    let read = stickslip::io::input::check(path)
        .and_then(|()| std::fs::File::open(path))
        .and_then(|mut file| file.read(&mut head));
    let head = &head[..read.unwrap_or(0)];
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    let by_name = FILE_KINDS
        .iter()
        .find(|(_, endings, ..)| endings.contains(&ending.as_str()));
    let by_start = || {
        FILE_KINDS
            .iter()
            .find(|(start, ..)| !start.is_empty() && head.starts_with(start))
    };
    by_name
        .or_else(by_start)
        .map(|(_, _, what, help)| (*what, *help))
}

/// Names in the folder of a path that may be meant.
fn beside(path: &Path, may_be: impl Fn(&Path) -> bool) -> Vec<String> {
    let entries = std::fs::read_dir(parent(path))
        .into_iter()
        .flatten()
        .flatten();
    let paths = entries.map(|entry| entry.path()).filter(|p| may_be(p));
    let mut names: Vec<String> = paths
        .filter_map(|p| Some(p.file_name()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// What may be meant by a path where there is nothing.
fn meant(path: &Path, names: &[String]) -> String {
    let folder = parent(path);
    if !folder.is_dir() {
        return format!("there is no folder {}", folder.display());
    }
    let word = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    match nearest(&word, &known) {
        Some(name) => format!("did you mean `{}`?", path.with_file_name(name).display()),
        None if names.is_empty() => {
            "there is nothing like it in this folder: check the path".into()
        }
        None => format!("there are {}", some(names)),
    }
}

/// Names in a list, the first few of many.
fn some(names: &[String]) -> String {
    const NAMES_IN_A_LIST: usize = 5;
    let shown = names[..names.len().min(NAMES_IN_A_LIST)].join(", ");
    match names.len() > NAMES_IN_A_LIST {
        true => format!("{shown}, …"),
        false => shown,
    }
}

/// A name that is not known, with the one that was probably meant, and what there is.
pub fn unknown(what: &str, name: &str, names: &[&str]) -> Failure {
    let meant = nearest(name, names).map(|meant| format!("did you mean `{meant}`? "));
    let names: Vec<String> = names.iter().map(ToString::to_string).collect();
    Failure::Arguments(
        format!("there is no {what} `{name}`"),
        format!("{}there are {}", meant.unwrap_or_default(), some(&names)),
    )
}

/// The text of a file, which is of a kind that is read here.
///
/// # Errors
/// As [`file`]; [`Error::Io`] if it cannot be read.
pub fn text(path: &Path, endings: &[&str]) -> Result<String, Failure> {
    file(path, endings)?;
    let text = stickslip::io::input::read_text(path);
    text.map_err(|e| Error::io(path, e).into())
}
