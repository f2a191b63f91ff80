//! The map of `ARCHITECTURE.md`, held against the code: a module knows only the layers below it.

use std::path::{Path, PathBuf};

/// The layers, lowest first. Modules of one layer do not know each other.
const LAYERS: &[&[&str]] = &[
    &["error", "machine", "math", "references", "registry"],
    &["material", "shape"],
    &["linear", "mesh"],
    &["system"],
    &["body", "contact", "newton"],
    &["io", "time"],
    &["simulation"],
    &["problem"],
];

/// What the numbers-only parts of contact may mention besides themselves.
const NUMBERS: &[&str] = &["math", "references", "registry"];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// All source files below `folder`, in a fixed order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut out = Vec::new();
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder of sources")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            out.extend(files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
    out
}

/// The paths `crate::a::b` that a file mentions outside comments and strings, each as `[a, b]` with its line number.
fn mentions(text: &str) -> Vec<(usize, Vec<String>)> {
    let mut out = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        // Every second piece between quotation marks is a string.
        let code: String = code.split('"').step_by(2).collect();
        for (at, found) in code.match_indices("crate::") {
            let path = code[at + found.len()..]
                .split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'))
                .next()
                .unwrap_or_default();
            let path = path.split("::").map(str::to_string).collect();
            out.push((i + 1, path));
        }
    }
    out
}

/// The top module of a file, `None` for `lib.rs`.
fn module(file: &Path) -> Option<String> {
    let below = file.strip_prefix(source()).expect("a source file");
    let first = below.components().next()?;
    let name = Path::new(first.as_os_str()).file_stem()?;
    let name = name.to_string_lossy().into_owned();
    (name != "lib").then_some(name)
}

#[test]
fn modules_know_only_the_layers_below() {
    let (mut seen, mut wrong) = (0, Vec::new());
    for file in files(&source()) {
        let Some(from) = module(&file) else {
            continue;
        };
        let Some(own) = layer(&from) else {
            wrong.push(format!("{}: `{from}` has no layer", file.display()));
            continue;
        };
        let text = std::fs::read_to_string(&file).expect("a source file");
        for (line, path) in mentions(&text) {
            let to = path[0].as_str();
            if to == from || to == "family" {
                continue;
            }
            seen += 1;
            // Grouped imports would hide what is imported from this scan; items of the root belong to the layers they come from.
            if layer(to).is_none_or(|other| other >= own) {
                wrong.push(format!(
                    "{}:{line}: `{from}` mentions `crate::{to}`",
                    file.display()
                ));
            }
        }
    }
    assert!(seen > 100, "only {seen} mentions found: the scan is broken");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn laws_and_enforcement_see_numbers_only() {
    let contact = source().join("contact");
    let (mut seen, mut wrong) = (0, Vec::new());
    for part in ["law", "enforcement"] {
        for file in files(&contact.join(part)) {
            let text = std::fs::read_to_string(&file).expect("a source file");
            for (line, path) in mentions(&text) {
                seen += 1;
                let inner = path.get(1).map_or("", String::as_str);
                let own = path[0] == "contact" && ["law", "enforcement"].contains(&inner);
                if !own && path[0] != "family" && !NUMBERS.contains(&path[0].as_str()) {
                    wrong.push(format!("{}:{line}: {}", file.display(), path.join("::")));
                }
            }
        }
    }
    assert!(seen > 20, "only {seen} mentions found: the scan is broken");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_module_of_the_library_has_a_layer_and_exists() {
    let text = std::fs::read_to_string(source().join("lib.rs")).expect("lib.rs");
    let mut declared: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .collect();
    declared.sort_unstable();
    let mut listed: Vec<&str> = LAYERS.iter().copied().flatten().copied().collect();
    listed.sort_unstable();
    assert_eq!(declared, listed);
}

#[test]
fn the_scan_finds_what_it_must() {
    let text = "use crate::mesh::Mesh; // crate::io\n/// [`crate::time`]\nlet x = crate::linear::Dense(\"crate::shape\");\nuse crate::{math};\n";
    let found: Vec<(usize, String)> = mentions(text)
        .into_iter()
        .map(|(line, path)| (line, path.join("::")))
        .collect();
    let expected = [(1, "mesh::Mesh"), (3, "linear::Dense"), (4, "")];
    assert_eq!(found, expected.map(|(line, path)| (line, path.to_string())));
}
