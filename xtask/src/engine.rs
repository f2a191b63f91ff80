//! Programs beside the main binary that factor bodies: `cargo xtask engine mumps`.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace::{root, target};

/// What Debian calls what is needed.
const PACKAGES: [&str; 3] = ["libmumps-dev", "mpi-default-dev", "mpi-default-bin"];

/// Compiles an engine into `target/engines`. With `--if-possible` a machine that lacks what it needs and cannot install it is no failure, but it is said.
pub fn build(arguments: &[String]) -> Result<(), String> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let possible = match words[..] {
        ["mumps"] => false,
        ["mumps", "--if-possible"] => true,
        _ => return Err("usage: cargo xtask engine mumps [--if-possible]".into()),
    };
    if let Err(why) = requirements() {
        if possible {
            println!("NOT RUN: the engine mumps. {why}");
            return Ok(());
        }
        return Err(why);
    }
    let folder = target().join("engines");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let program = folder.join("stickslip-mumps");
    compile(&root().join("engines/mumps"), &build_cells()?, &program)?;
    println!("{}", program.display());
    Ok(())
}

/// Whether there are a compiler for MPI, the header of MUMPS and what starts ranks; installs them where one may.
fn requirements() -> Result<(), String> {
    let missing = || {
        let mut missing = Vec::new();
        for program in ["mpicc", "mpirun"] {
            let there = Command::new(program).arg("--version").output();
            if !there.is_ok_and(|o| o.status.success()) {
                missing.push(program);
            }
        }
        if missing.is_empty() && !has_header() {
            missing.push("dmumps_c.h");
        }
        missing
    };
    if !missing().is_empty() {
        let apt = |what: &[&str]| {
            Command::new("apt-get")
                .args(what)
                .env("DEBIAN_FRONTEND", "noninteractive")
                .output()
                .is_ok_and(|o| o.status.success())
        };
        // Fails at once where one may not install.
        let install: Vec<&str> = ["install", "--yes"].into_iter().chain(PACKAGES).collect();
        let _ = apt(&["update"]) && apt(&install);
    }
    match missing()[..] {
        [] => Ok(()),
        ref missing => Err(format!(
            "It needs an MPI with its compiler, and MUMPS for it; not there: {}, and it could not be installed. On Debian: apt-get install {}. \
             CFLAGS and LDFLAGS say where they are if not in the usual places.",
            missing.join(", "),
            PACKAGES.join(" ")
        )),
    }
}

/// Words of an environment variable.
fn words(name: &str) -> Vec<String> {
    let text = std::env::var(name).unwrap_or_default();
    text.split_whitespace().map(str::to_string).collect()
}

fn has_header() -> bool {
    let source = target().join("engines").join("probe.c");
    let written = std::fs::create_dir_all(target().join("engines"))
        .and_then(|()| std::fs::write(&source, "#include <dmumps_c.h>\n"));
    let compiled = Command::new("mpicc")
        .args(words("CFLAGS"))
        .arg("-fsyntax-only")
        .arg(&source)
        .output();
    // A probe that stays does no harm.
    let _ = std::fs::remove_file(&source);
    written.is_ok() && compiled.is_ok_and(|o| o.status.success())
}

/// Builds what computes cells on the ranks, in the profile that this program was built in, and returns the library.
fn build_cells() -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let (profile, folder) = match cfg!(debug_assertions) {
        true => ("dev", "debug"),
        false => ("release", "release"),
    };
    let mut build = Command::new(cargo);
    // With all that `cargo test` builds, so that dependencies have the same features, and are built once.
    build.args(["build", "--lib", "--profile", profile]);
    let status = build.current_dir(root()).status();
    match status.map_err(|e| format!("cargo: {e}"))?.success() {
        true => Ok(target().join(folder).join("libstickslip_mumps_cells.a")),
        false => Err("what computes cells on the ranks does not build".into()),
    }
}

/// What the library is called that MUMPS itself needs: by Debian, and by others.
const SCALAPACK: [&str; 3] = ["-lscalapack-openmpi", "-lscalapack-mpich", "-lscalapack"];

/// What keeps the names in a library to the program: MUMPS may bring another METIS along than the library has.
const HIDDEN: &[&str] = match cfg!(target_os = "linux") {
    true => &["-Wl,--gc-sections", "-Wl,--exclude-libs,ALL"],
    false => &[],
};

/// Compiles the sources of a folder, with a library and the first name of ScaLAPACK that there is.
fn compile(folder: &Path, library: &Path, program: &Path) -> Result<(), String> {
    let listed = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let paths = listed.flatten().map(|entry| entry.path());
    let mut sources: Vec<_> = paths
        .filter(|p| p.extension() == Some("c".as_ref()))
        .collect();
    sources.sort();
    let mut said = String::new();
    for scalapack in SCALAPACK {
        let output = Command::new("mpicc")
            .args(["-O2", "-Wall", "-Wextra", "-std=gnu11", "-o"])
            .arg(program)
            .args(&sources)
            .arg(library)
            .args(HIDDEN)
            .args(words("CFLAGS"))
            .args(words("LDFLAGS"))
            .args(["-ldmumps", scalapack, "-lpthread", "-ldl", "-lm"])
            .output()
            .map_err(|e| format!("mpicc: {e}"))?;
        said = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.success() {
            print!("{said}");
            return Ok(());
        }
    }
    Err(format!("mpicc failed:\n{said}"))
}
