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

/// Builds the binary `stickslip` in the profile of this program (`cargo xtask` is a release build) and returns its path; where the environment variable `STICKSLIP`
/// names a binary, that one.
pub fn stickslip() -> Result<PathBuf, String> {
    if let Some(binary) = std::env::var_os("STICKSLIP") {
        return std::path::absolute(&binary)
            .ok()
            .filter(|p| p.is_file())
            .ok_or_else(|| format!("STICKSLIP: no file {}", Path::new(&binary).display()));
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["build", "--package", "stickslip-cli", "--bin", "stickslip"])
        .args((!cfg!(debug_assertions)).then_some("--release"))
        .current_dir(root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    if !status.success() {
        return Err("stickslip does not build".to_string());
    }
    let name = format!("stickslip{}", std::env::consts::EXE_SUFFIX);
    let profile = if cfg!(debug_assertions) {
        "debug"
    } else {
        "release"
    };
    Ok(target().join(profile).join(name))
}

/// What a command that has to succeed prints.
pub fn output(command: &mut Command) -> Result<Vec<u8>, String> {
    let name = command.get_program().display().to_string();
    let output = command.output().map_err(|e| format!("{name}: {e}"))?;
    match output.status.success() {
        true => Ok(output.stdout),
        false => Err(format!(
            "{name} failed: {}",
            String::from_utf8_lossy(&output.stderr)
        )),
    }
}

/// Runs a command that has to succeed; what it prints is seen if it does not.
pub fn succeed(command: &mut Command) -> Result<(), String> {
    output(command).map(|_| ())
}

/// A folder for temporary files, which goes away with its owner.
pub struct Scratch(pub PathBuf);

impl Scratch {
    /// An empty one.
    pub fn new(name: &str) -> Result<Self, String> {
        let name = format!("stickslip-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(Scratch(folder))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
