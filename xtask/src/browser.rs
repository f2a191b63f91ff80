//! Reports in headless Chromium: `cargo xtask browser`.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace::{root, target};

/// The examples whose reports are opened, with what is changed in them.
const CASES: &[(&str, &[&str])] = &[
    ("press-and-slide", &[]),
    // Fields at the ends of steps alone would give the slider nothing to do.
    ("belt-mass", &["--set", "output.every=20"]),
];

/// Runs the examples, writes their reports, and opens them. With `--if-possible` a machine that lacks Chromium or Node and cannot
/// install them is no failure, but it is said.
pub fn check(arguments: &[String]) -> Result<(), String> {
    let possible = match arguments {
        [] => false,
        [only] if only == "--if-possible" => true,
        _ => return Err("usage: cargo xtask browser [--if-possible]".into()),
    };
    let tools = chromium().and_then(|chromium| Ok((chromium, modules()?)));
    let (chromium, modules) = match tools {
        Ok(tools) => tools,
        Err(why) if possible => {
            println!("NOT RUN: the browser test of reports. {why}");
            return Ok(());
        }
        Err(why) => return Err(why),
    };
    let binary = binary()?;
    let place = target().join("browser");
    let mut reports = Vec::new();
    for (case, changes) in CASES {
        let results = place.join(case);
        // Left over files of an earlier version would be taken for results.
        let _ = std::fs::remove_dir_all(&results);
        let problem = root().join("examples").join(case).join("case.toml");
        run(Command::new(&binary)
            .arg("run")
            .arg(&problem)
            .args(["--quiet", "--output"])
            .arg(&results)
            .args(*changes))?;
        run(Command::new(&binary).arg("report").arg(&results))?;
        reports.push(results.join("report.html"));
    }
    let pictures = place.join("pictures");
    run(Command::new("node")
        .arg(folder().join("check.mjs"))
        .arg(&pictures)
        .args(&reports)
        .env("CHROMIUM", chromium)
        .env("NODE_MODULES", modules))?;
    println!("pictures are in {}", pictures.display());
    Ok(())
}

fn folder() -> PathBuf {
    root().join("crates/stickslip-report/tests/browser")
}

fn run(command: &mut Command) -> Result<(), String> {
    let shown = format!("{:?}", command.get_program());
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{shown} failed: {status}")),
        Err(e) => Err(format!("cannot run {shown}: {e}")),
    }
}

/// Whether a program says its version.
fn there(program: &Path) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|o| o.status.success())
}

/// Chromium: `CHROMIUM`, or where Debian has it, or from Debian's packages if it may be installed.
fn chromium() -> Result<PathBuf, String> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        let named = PathBuf::from(named);
        return match there(&named) {
            true => Ok(named),
            false => Err(format!("CHROMIUM: {} does not run", named.display())),
        };
    }
    let usual = Path::new("/usr/bin/chromium");
    if !there(usual) {
        let apt = |what: &[&str]| {
            Command::new("apt-get")
                .args(what)
                .env("DEBIAN_FRONTEND", "noninteractive")
                .output()
                .is_ok_and(|o| o.status.success())
        };
        // Fails at once where one may not install.
        let _ = apt(&["update"]) && apt(&["install", "--yes", "chromium"]);
    }
    match there(usual) {
        true => Ok(usual.to_path_buf()),
        false => Err(
            "There is no Chromium, and it could not be installed; CHROMIUM may name one.".into(),
        ),
    }
}

/// A folder with playwright-core, which drives the browser: installed as `package-lock.json` says.
fn modules() -> Result<PathBuf, String> {
    for program in ["node", "npm"] {
        if !there(Path::new(program)) {
            return Err(format!("There is no {program}."));
        }
    }
    let place = target().join("browser").join("node");
    std::fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
    for name in ["package.json", "package-lock.json"] {
        std::fs::copy(folder().join(name), place.join(name)).map_err(|e| format!("{name}: {e}"))?;
    }
    let npm = Command::new("npm")
        .args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"])
        .current_dir(&place)
        .output();
    match npm {
        Ok(output) if output.status.success() => Ok(place),
        Ok(output) => Err(format!(
            "npm ci failed: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        )),
        Err(e) => Err(format!("cannot run npm: {e}")),
    }
}

/// The binary, built as the tests build it; where `STICKSLIP` names one, that one.
fn binary() -> Result<PathBuf, String> {
    if std::env::var_os("STICKSLIP").is_some() {
        return xtask::workspace::stickslip();
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    run(Command::new(cargo)
        .args(["build", "--package", "stickslip-cli"])
        .current_dir(root()))?;
    let name = format!("stickslip{}", std::env::consts::EXE_SUFFIX);
    Ok(target().join("debug").join(name))
}
