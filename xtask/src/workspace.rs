//! Where things are in the workspace, and its binary.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the workspace.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// Where cargo builds.
pub fn target() -> PathBuf {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(directory) => root().join(directory),
        None => root().join("target"),
    }
}

/// Builds the release binary `stickslip` and returns its path; where the environment variable `STICKSLIP` names a binary, that one.
pub fn stickslip() -> Result<PathBuf, String> {
    if let Some(binary) = std::env::var_os("STICKSLIP") {
        return std::path::absolute(&binary)
            .ok()
            .filter(|p| p.is_file())
            .ok_or_else(|| format!("STICKSLIP: no file {}", Path::new(&binary).display()));
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["build", "--release", "--package", "stickslip-cli"])
        .current_dir(root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    if !status.success() {
        return Err("stickslip does not build".to_string());
    }
    let name = format!("stickslip{}", std::env::consts::EXE_SUFFIX);
    Ok(target().join("release").join(name))
}
