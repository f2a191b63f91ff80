//! `cargo xtask fuzz TARGET SECONDS`

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace;

/// The fuzz targets, the files that seed each, and where these are.
const TARGETS: &[(&str, &str, &[&str])] = &[
    (
        "toml",
        "toml",
        &["examples", "crates/stickslip/tests/malformed/toml"],
    ),
    (
        "msh",
        "msh",
        &[
            "crates/stickslip/tests/meshes",
            "crates/stickslip/tests/malformed/msh",
        ],
    ),
    ("vtu", "vtu", &["crates/stickslip/tests/malformed/vtu"]),
    ("checkpoint", "", &[]),
    ("inp", "inp", &["crates/stickslip-deck/tests/malformed"]),
];

/// Larger seeds make executions slow and reach nothing that small ones do not.
const LARGEST: u64 = 16 << 10;

/// Memory `[MiB]` and time `[s]` that one input may take.
const LIMITS: [&str; 3] = ["-rss_limit_mb=2048", "-malloc_limit_mb=1024", "-timeout=20"];

/// Runs `cargo fuzz` on a target for a while. What it finds is left in `fuzz/artifacts`.
pub fn run(arguments: &[String]) -> Result<(), String> {
    let [target, seconds] = arguments else {
        return Err("usage: cargo xtask fuzz TARGET SECONDS".into());
    };
    let names: Vec<&str> = TARGETS.iter().map(|t| t.0).collect();
    let &(_, ending, folders) = TARGETS
        .iter()
        .find(|t| t.0 == target)
        .ok_or_else(|| format!("no target {target}: there are {}", names.join(", ")))?;
    let seconds: u64 = seconds
        .parse()
        .map_err(|_| format!("`{seconds}` is no number of seconds"))?;
    let fuzz = workspace::root().join("fuzz");
    let corpus = fuzz.join("corpus").join(target);
    let seeds = fuzz.join("corpus").join(format!("{target}-seeds"));
    for folder in [&corpus, &seeds] {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    for folder in folders {
        sow(&workspace::root().join(folder), ending, &seeds)?;
    }
    let mut command = Command::new("cargo");
    command
        .current_dir(workspace::root())
        // Coverage is the one thing of the compiler that is not stable, and the reason why cargo-fuzz asks for a nightly one.
        .env("RUSTC_BOOTSTRAP", "1")
        .args(["fuzz", "run", "--sanitizer", "none", target.as_str()])
        .args([&corpus, &seeds])
        .arg("--")
        .arg(format!("-max_total_time={seconds}"))
        .args(LIMITS);
    let dictionary = fuzz.join("dictionaries").join(format!("{target}.dict"));
    if dictionary.exists() {
        command.arg(format!("-dict={}", dictionary.display()));
    }
    let status = command
        .status()
        .map_err(|e| format!("cannot run cargo fuzz: {e}; cargo install cargo-fuzz"))?;
    match status.success() {
        true => Ok(()),
        false => Err(format!(
            "cargo fuzz ended with {status}; what it found is in fuzz/artifacts/{target} \
             (if there is no such command: cargo install cargo-fuzz)"
        )),
    }
}

/// Copies the small files with an ending from a folder and those in it.
fn sow(from: &Path, ending: &str, to: &Path) -> Result<(), String> {
    let fault = |e: std::io::Error| format!("{}: {e}", from.display());
    for entry in std::fs::read_dir(from).map_err(fault)? {
        let path = entry.map_err(fault)?.path();
        if path.is_dir() {
            sow(&path, ending, to)?;
        } else if path.extension().is_some_and(|e| e == ending)
            && path.metadata().map_err(fault)?.len() <= LARGEST
        {
            let name: PathBuf = path.iter().rev().take(2).collect();
            let name = name.to_string_lossy().replace(['/', '\\'], "-");
            std::fs::copy(&path, to.join(name)).map_err(fault)?;
        }
    }
    Ok(())
}
