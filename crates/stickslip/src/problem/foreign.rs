//! Files of other kinds that are given where a problem file is wanted: what they are, and what takes them.

use std::path::Path;

use crate::error::{Diagnostic, Error, IoError};

/// A kind of file: how it begins, in small letters, what it is, and what to do with it.
type Kind = (&'static [&'static [u8]], &'static str, &'static str);

const KINDS: &[Kind] = &[
    (
        &[b"$meshformat", b"$comments", b"$physicalnames"],
        "a mesh of Gmsh",
        "name it in a problem file, `body.NAME.gmsh.file = \"FILE\"`; `stickslip convert` makes a .vtu or .inp of it",
    ),
    (
        &[b"<vtkfile", b"<?xml"],
        "a file in XML, a mesh or results",
        "problem files are TOML; `stickslip plot` and `stickslip report` take the folder of results, and a mesh in VTU becomes one of Gmsh by `stickslip convert FILE.vtu FILE.msh`",
    ),
    (
        &[b"*"],
        "an input deck of Abaqus or CalculiX",
        "`stickslip run` and `stickslip check` take decks with names that end in `.inp`; `stickslip convert FILE.inp FILE.toml` makes a problem file of one",
    ),
    (
        &[b"# vtk datafile"],
        "a file of the old VTK format",
        "save it as .vtu, in ParaView for one; `stickslip convert FILE.vtu FILE.msh` makes a mesh of it that a problem file can name",
    ),
    (
        &[b"{"],
        "a file in JSON",
        "problem files are TOML: lines `key = value` below headings `[table]`; `stickslip explain` takes the folder of a summary.json",
    ),
    (
        &[
            b"import ",
            b"from ",
            b"#!/usr/bin/env python",
            b"#!/usr/bin/python",
        ],
        "a Python script",
        "run it with `python`; `stickslip run` takes problem files in TOML, and decks (.inp)",
    ),
    (
        &[b"<!doctype", b"<html"],
        "a page in HTML",
        "`stickslip report` makes such pages, of a folder of results; a problem file is TOML",
    ),
    (
        &[b"solid ", b"stl"],
        "a surface in STL",
        "bodies have cells inside: mesh it with Gmsh, and name the .msh in a problem file, `body.NAME.gmsh.file = \"FILE\"`",
    ),
    (
        &[b"iso-10303-21"],
        "a geometry in STEP",
        "mesh it with Gmsh, and name the .msh in a problem file, `body.NAME.gmsh.file = \"FILE\"`",
    ),
];

/// The same by the ending of the name, for kinds that have no beginning of their own.
const ENDINGS: &[(&str, &str)] = &[
    ("py", "a Python script"),
    ("ipynb", "a file in JSON"),
    ("json", "a file in JSON"),
    ("msh", "a mesh of Gmsh"),
    ("vtu", "a file in XML, a mesh or results"),
    ("pvd", "a file in XML, a mesh or results"),
    ("stl", "a surface in STL"),
    ("step", "a geometry in STEP"),
    ("stp", "a geometry in STEP"),
];

/// A finding if the file is one of a kind that is known and no problem file.
pub(super) fn kind(file: &Path, bytes: &[u8]) -> Option<Diagnostic> {
    let mut start = bytes.trim_ascii_start();
    start = start.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(start);
    let begins = |words: &&[u8]| {
        let head = start.get(..words.len());
        head.is_some_and(|head| head.eq_ignore_ascii_case(words))
    };
    let ending = file.extension().unwrap_or_default().to_string_lossy();
    let named = ENDINGS.iter().find(|(e, _)| ending.eq_ignore_ascii_case(e));
    let by_name = || {
        KINDS
            .iter()
            .find(|(_, what, _)| named.is_some_and(|(_, n)| n == what))
    };
    let by_start = KINDS.iter().find(|(starts, ..)| starts.iter().any(begins));
    let (_, what, help) = by_start.or_else(by_name)?;
    Some(Diagnostic::new("", format!("this is {what}, not a problem file")).help(*help))
}

/// Most files of a folder that are listed.
const LISTED_FILES: usize = 5;

/// A folder where a problem file is wanted: what in it may be meant.
pub(super) fn folder(folder: &Path) -> Error {
    if folder.join("summary.json").is_file() {
        return Error::Io(IoError {
            file: folder.to_path_buf(),
            message: "this is a folder of results, and a problem file is wanted; `stickslip explain`, `plot`, `report`, `compare` and `resume` take folders of results, and `problem.toml` in it is the problem as it was run".into(),
        });
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<String> = entries
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml") || name.ends_with(".inp"))
        .collect();
    files.sort();
    let more = files.len() > LISTED_FILES;
    files.truncate(LISTED_FILES);
    let what = match files.is_empty() {
        true => "there is no problem file in it".to_string(),
        false => format!(
            "name one of its files: {}{}",
            files.join(", "),
            if more { ", …" } else { "" }
        ),
    };
    Error::Io(IoError {
        file: folder.to_path_buf(),
        message: format!("this is a folder, and a problem file is wanted; {what}"),
    })
}
