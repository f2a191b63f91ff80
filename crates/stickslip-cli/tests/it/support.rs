//! What the suites share: the binary, what it says, and folders for its files.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A block that is pressed on a floor, in two increments.
pub const CASE: &str = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb = { mu = 0.3 } }
support.top = { set = "block.top", x = 0.0, y = -1e-5 }
probe.corner.point = [0.0, 0.02]
step = [{ name = "press", increments = { fixed = 2 } }]
"#;

/// Runs the binary to its end.
pub fn stickslip<S: AsRef<OsStr>>(arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(arguments)
        .output()
        .expect("the binary runs")
}

/// The exit code, if no signal ended it.
pub fn code(output: &Output) -> Option<i32> {
    output.status.code()
}

/// What a stream said.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// An empty folder of a test; suites have folders of their own.
pub fn folder(suite: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join(suite)
        .join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    folder
}

/// The same with a problem in it, `case.toml`.
pub fn place(suite: &str, name: &str, case: &str) -> PathBuf {
    let folder = folder(suite, name);
    std::fs::write(folder.join("case.toml"), case).expect("the folder can be written to");
    folder
}

/// The binary, to be run in a folder without anybody who types.
pub fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.current_dir(folder).stdin(Stdio::null());
    command
}
