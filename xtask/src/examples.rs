//! What the examples are run with: a case and its overrides for every `expected*.toml`.

use std::path::{Path, PathBuf};

use crate::workspace;

/// A file `expected*.toml`, and the run that it is about.
pub struct Expectation {
    /// The file, from `examples/` on.
    pub label: String,
    /// The file.
    pub file: PathBuf,
    /// What stands in it.
    pub table: toml::Table,
    /// The folder of the example.
    pub folder: PathBuf,
    /// The problem file, as it stands in the folder.
    pub case: String,
    /// What is changed of it.
    pub overrides: Vec<String>,
    /// Whether tests run it; else it takes minutes.
    pub tested: bool,
}

/// Those of all examples, by name.
pub fn all() -> Result<Vec<Expectation>, String> {
    let mut found = Vec::new();
    for folder in list(&workspace::root().join("examples"))? {
        if !folder.join("case.toml").is_file() {
            continue;
        }
        for file in list(&folder)? {
            let stem = name(&file);
            if stem.starts_with("expected") && stem.ends_with(".toml") {
                found.push(read(&folder, file)?);
            }
        }
    }
    Ok(found)
}

fn read(folder: &Path, file: PathBuf) -> Result<Expectation, String> {
    let say = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let text = std::fs::read_to_string(&file).map_err(|e| say(&e))?;
    let table: toml::Table = toml::from_str(&text).map_err(|e| say(&e))?;
    let text = |key: &str| table.get(key).and_then(|value| value.as_str());
    let overrides = table.get("overrides").and_then(|o| o.as_array());
    let overrides = overrides.into_iter().flatten().filter_map(|o| o.as_str());
    Ok(Expectation {
        label: format!("{}/{}", name(folder), name(&file)),
        folder: folder.to_path_buf(),
        case: text("case").unwrap_or("case.toml").to_string(),
        overrides: overrides.map(str::to_string).collect(),
        tested: table.get("tested").and_then(|t| t.as_bool()) != Some(false),
        table,
        file,
    })
}

/// What is in a folder, by name.
pub fn list(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    Ok(paths)
}

/// The last part of a path.
pub fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
