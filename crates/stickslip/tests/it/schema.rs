//! The published JSON schema, which the program reads, is the one that the structs give.

use std::path::Path;

/// Where this variable is set the schema is written instead: `cargo xtask schema` does that.
const WRITE: &str = "STICKSLIP_WRITE_SCHEMA";

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
