//! What is in the binary: the crates, in a list in the format of CycloneDX, and whether their licences are among those of `deny.toml`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::json;

use crate::dist;
use xtask::workspace;

/// Compares the licences of all dependencies with those that `deny.toml` allows.
pub fn licences() -> Result<(), String> {
    let path = workspace::root().join("deny.toml");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("deny.toml: {e}"))?;
    let table: toml::Table = text.parse().map_err(|e| format!("deny.toml: {e}"))?;
    let allowed = table
        .get("licenses")
        .and_then(|l| l.get("allow")?.as_array());
    let allowed = allowed.ok_or("deny.toml has no list `licenses.allow`")?;
    let allowed: Vec<&str> = allowed.iter().filter_map(toml::Value::as_str).collect();
    let metadata = dist::metadata()?;
    let mut wrong = Vec::new();
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let licence = package["license"].as_str().unwrap_or_default();
        if !may(licence, &allowed) {
            wrong.push(format!(
                "{} {}: {licence}",
                package["name"], package["version"]
            ));
        }
    }
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "licences that deny.toml does not allow:\n{}",
            wrong.join("\n")
        )),
    }
}

/// Whether one of the licences that may be chosen, with all that come with it, is allowed: `(A OR B) AND C`, `A/B`.
fn may(expression: &str, allowed: &[&str]) -> bool {
    let text = expression.trim().replace('/', " OR ");
    // Where an `AND` or `OR` stands outside of brackets.
    let split = |word: &str| {
        let mut depth = 0;
        text.char_indices().find_map(|(i, c)| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            (depth == 0 && text[i..].starts_with(word))
                .then(|| (&text[..i], &text[i + word.len()..]))
        })
    };
    if let Some((a, b)) = split(" OR ") {
        return may(a, allowed) || may(b, allowed);
    }
    if let Some((a, b)) = split(" AND ") {
        return may(a, allowed) && may(b, allowed);
    }
    match text.strip_prefix('(').and_then(|t| t.strip_suffix(')')) {
        Some(inner) => may(inner, allowed),
        None => allowed.contains(&text.as_str()),
    }
}

/// Writes the list of the crates in the binary, with where they come from and their checksums; returns it.
pub fn list(folder: &Path) -> Result<PathBuf, String> {
    let used = dist::used()?;
    let sums = checksums()?;
    let metadata = dist::metadata()?;
    let version = env!("CARGO_PKG_VERSION");
    let mut components = Vec::new();
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_string();
        let of = (text("name"), text("version"));
        if !used.contains(&of) || package["source"].is_null() {
            continue;
        }
        let sum = sums.get(&of);
        let (name, version) = of;
        components.push(json!({
            "type": "library",
            "bom-ref": format!("pkg:cargo/{name}@{version}"),
            "name": name,
            "version": version,
            "purl": format!("pkg:cargo/{name}@{version}"),
            "licenses": [{ "expression": text("license").replace('/', " OR ") }],
            "hashes": sum.map(|sum| vec![json!({ "alg": "SHA-256", "content": sum })]).unwrap_or_default(),
        }));
    }
    if components.len() + 8 < used.len() {
        return Err("crates of the binary are missing in `cargo metadata`".into());
    }
    let list = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": {
            "type": "application",
            "bom-ref": format!("pkg:cargo/stickslip-cli@{version}"),
            "name": "stickslip",
            "version": version,
            "licenses": [{ "expression": "MIT OR Apache-2.0" }],
        } },
        "components": components,
    });
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let file = folder.join(format!("stickslip-{version}.cdx.json"));
    std::fs::write(&file, format!("{list:#}\n")).map_err(|e| format!("{}: {e}", file.display()))?;
    println!("{}: {} crates", file.display(), components.len());
    Ok(file)
}

/// Checksums of the crates, from `Cargo.lock`.
fn checksums() -> Result<BTreeMap<(String, String), String>, String> {
    let text = std::fs::read_to_string(workspace::root().join("Cargo.lock"));
    let lock: toml::Table = text
        .map_err(|e| e.to_string())?
        .parse()
        .map_err(|e| format!("Cargo.lock: {e}"))?;
    let packages = lock.get("package").and_then(toml::Value::as_array);
    let sum = |package: &toml::Value| {
        let text = |key: &str| Some(package.get(key)?.as_str()?.to_string());
        Some(((text("name")?, text("version")?), text("checksum")?))
    };
    Ok(packages.into_iter().flatten().filter_map(sum).collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::*;

    #[test]
    fn one_licence_of_several_is_enough_and_all_that_belong_together_count() {
        let allowed = ["MIT", "Apache-2.0 WITH LLVM-exception", "Unicode-3.0"];
        for licence in [
            "MIT",
            "GPL-3.0 OR MIT",
            "Apache-2.0/MIT",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception",
        ] {
            assert!(may(licence, &allowed), "{licence}");
        }
        for licence in [
            "",
            "GPL-3.0",
            "MIT AND GPL-3.0",
            "(MIT OR Apache-2.0) AND GPL-2.0",
            "Apache-2.0",
        ] {
            assert!(!may(licence, &allowed), "{licence}");
        }
    }

    #[test]
    fn all_dependencies_may_be_given_away() {
        assert_eq!(licences(), Ok(()));
    }

    #[test]
    fn the_list_has_the_crates_of_the_binary_with_their_checksums() {
        let folder = workspace::Scratch::new("list").expect("a folder");
        let file = list(&folder.0).expect("a list");
        let list: Value =
            serde_json::from_slice(&std::fs::read(file).expect("a file")).expect("JSON");
        let components = list["components"].as_array().expect("a list");
        let find = |name: &str| components.iter().find(|c| c["name"] == name);
        let faer = find("faer").expect("a solver of linear systems");
        assert_eq!(
            faer["hashes"][0]["content"].as_str().map(str::len),
            Some(64)
        );
        assert!(find("stickslip").is_none() && find("pyo3").is_none());
        let names: BTreeSet<&str> = components
            .iter()
            .filter_map(|c| c["bom-ref"].as_str())
            .collect();
        assert_eq!(names.len(), components.len());
    }
}
