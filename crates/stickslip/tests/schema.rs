//! The published JSON schema is the one that the structs give.

use std::path::Path;

#[test]
fn the_published_schema_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stickslip.schema.json");
    let text = std::fs::read_to_string(&file).expect("the published schema");
    let published: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    assert!(
        published == stickslip::problem::schema(),
        "stickslip.schema.json is not current: run `cargo xtask schema`"
    );
}
