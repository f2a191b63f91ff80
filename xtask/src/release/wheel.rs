//! The wheel, and that it works where there is no compiler.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace::{self, Scratch, output, succeed};

/// What is done with an installed wheel: an analysis, its results, a picture, all from Python.
const TRY: &str = "
import stickslip
results = stickslip.open('stickslip-demo/lug.out')
assert results.summary['completed'] and len(results.history['TIME']) > 10, results
assert results.plot('CPRESS').data.startswith(b'\\x89PNG')
problem = stickslip.Problem.from_toml('stickslip-demo/lug.toml')
step = next(problem.build())
assert step.stick + step.slip > 0, step
print('stickslip', stickslip.__version__)
";

/// Builds the wheel of this machine in the environment of `ci.sh`, which has maturin; returns it.
pub fn build() -> Result<PathBuf, String> {
    let environment = workspace::target().join("python");
    if !environment.join("bin/python").is_file() {
        succeed(
            Command::new("python3")
                .args(["-m", "venv"])
                .arg(&environment),
        )?;
    }
    let mut pip = Command::new(environment.join("bin/pip"));
    succeed(pip.args([
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "maturin>=1.7,<2",
    ]))?;
    let out = Scratch::new("wheel")?;
    let mut maturin = Command::new(environment.join("bin/maturin"));
    maturin.args(["build", "--release", "--locked", "--manifest-path"]);
    maturin
        .arg("crates/stickslip-py/Cargo.toml")
        .arg("--out")
        .arg(&out.0);
    succeed(maturin.current_dir(workspace::root()))?;
    let entries = std::fs::read_dir(&out.0).map_err(|e| e.to_string())?;
    let mut wheels = entries.flatten().map(|entry| entry.path());
    let built = wheels.find(|path| path.extension().is_some_and(|e| e == "whl"));
    let built = built.ok_or("maturin has built no wheel")?;
    let dist = workspace::root().join("dist");
    std::fs::create_dir_all(&dist).map_err(|e| format!("{}: {e}", dist.display()))?;
    let wheel = dist.join(built.file_name().unwrap_or_default());
    std::fs::copy(&built, &wheel).map_err(|e| format!("{}: {e}", wheel.display()))?;
    Ok(wheel)
}

/// Installs the wheel into a new environment and uses it, with nothing on the path but that environment: no compiler, no Rust.
pub fn bare(wheel: &Path) -> Result<(), String> {
    let folder = Scratch::new("bare")?;
    let environment = folder.0.join("environment");
    succeed(
        Command::new("python3")
            .args(["-m", "venv"])
            .arg(&environment),
    )?;
    let bin = environment.join("bin");
    let alone = |program: &str| {
        let mut command = Command::new(bin.join(program));
        // Where packages come from is a matter of the machine.
        let kept = std::env::vars().filter(|(name, _)| {
            name.starts_with("PIP_") || name.ends_with("_proxy") || name.contains("CERT")
        });
        command
            .env_clear()
            .envs(kept)
            .env("PATH", &bin)
            .env("HOME", &folder.0);
        command.current_dir(&folder.0);
        command
    };
    let compiler = alone("python").args(["-c", "import shutil, sys; sys.exit(any(map(shutil.which, ['cc', 'gcc', 'clang', 'cargo', 'rustc'])))"]).status();
    if !compiler.is_ok_and(|status| status.success()) {
        return Err("the environment that shall have no compiler has one".into());
    }
    let mut pip = alone("pip");
    pip.args([
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--only-binary",
        ":all:",
    ]);
    succeed(pip.arg(wheel))?;
    succeed(alone("stickslip").args(["demo", "--no-open", "--quiet"]))?;
    let said = output(alone("python").args(["-I", "-c", TRY]))?;
    let name = wheel.file_name().unwrap_or_default().display();
    print!(
        "{name}: used without a compiler: {}",
        String::from_utf8_lossy(&said)
    );
    Ok(())
}
