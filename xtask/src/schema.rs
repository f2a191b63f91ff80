//! `cargo xtask schema`

use std::process::Command;

use crate::workspace;

/// Writes what `stickslip schema` prints to `stickslip.schema.json`, which editors find through the first line of
/// the examples.
pub fn write() -> Result<(), String> {
    let output = Command::new(workspace::stickslip()?)
        .arg("schema")
        .output()
        .map_err(|e| format!("cannot run stickslip: {e}"))?;
    if !output.status.success() {
        return Err(format!(
            "stickslip schema failed: {}",
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    serde_json::from_slice::<serde_json::Value>(&output.stdout)
        .map_err(|e| format!("stickslip schema printed no JSON: {e}"))?;
    let file = workspace::root().join("stickslip.schema.json");
    std::fs::write(&file, &output.stdout).map_err(|e| format!("{}: {e}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}
