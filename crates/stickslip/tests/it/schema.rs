//! The published JSON schema, which the program reads, is the one that the structs give.

use std::path::Path;

/// Where this variable is set the schema is written instead: `cargo xtask schema` does that.
const WRITE: &str = "STICKSLIP_WRITE_SCHEMA";

/// The first line of every example, by which editors find the schema.
const NAMED: &str = "#:schema ../../stickslip.schema.json\n";

#[test]
fn every_example_names_the_schema() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = std::fs::read_dir(examples).expect("the examples");
    let mut seen = 0;
    for folder in folders.map(|entry| entry.expect("an entry").path()) {
        let Ok(files) = std::fs::read_dir(&folder) else {
            continue;
        };
        for file in files.map(|entry| entry.expect("an entry").path()) {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with("case") && name.ends_with(".toml") {
                let text = std::fs::read_to_string(&file).expect("a problem file");
                assert!(text.starts_with(NAMED), "{}", file.display());
                seen += 1;
            }
        }
    }
    assert!(seen > 50, "only {seen} examples were found");
}

#[test]
fn the_published_schema_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stickslip.schema.json");
    let derived = stickslip::problem::derived_schema();
    if std::env::var_os(WRITE).is_some() {
        std::fs::write(&file, format!("{derived:#}\n")).expect("the schema can be written");
        return;
    }
    assert!(
        derived == stickslip::problem::schema(),
        "stickslip.schema.json is not current: run `cargo xtask schema`"
    );
}
