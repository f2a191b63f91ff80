//! `cargo xtask release --dry-run`: all that a release gives away, built and tried here; a tag has the workflows build it again, and publish.

mod contents;
mod wheel;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::dist;
use xtask::workspace;

const USAGE: &str = "usage: cargo xtask release --dry-run [--archive FILE] [--wheel FILE]
the archive and the wheel are built if they are not given; releases are published by the workflows in .github, from a tag; here they are built and tried";

/// Builds and tries everything, into `dist/`.
pub fn run(what: &[String]) -> Result<(), String> {
    let (mut dry, mut archive, mut wheel) = (false, None, None);
    let mut arguments = what.iter();
    while let Some(argument) = arguments.next() {
        let given = match argument.as_str() {
            "--dry-run" => {
                dry = true;
                continue;
            }
            "--archive" => &mut archive,
            "--wheel" => &mut wheel,
            _ => return Err(USAGE.into()),
        };
        *given = Some(taken(arguments.next().ok_or(USAGE)?)?);
    }
    if !dry {
        return Err(USAGE.into());
    }
    contents::licences()?;
    deny()?;
    let archive = archive.map_or_else(dist::pack, Ok)?;
    bare(&archive)?;
    let wheel = wheel.map_or_else(wheel::build, Ok)?;
    wheel::bare(&wheel)?;
    let list = contents::list(&dist())?;
    sums(&[archive, wheel, list])
}

/// Where all of it is.
fn dist() -> PathBuf {
    workspace::root().join("dist")
}

/// A file that has been built elsewhere, beside the others.
fn taken(file: &str) -> Result<PathBuf, String> {
    let name = Path::new(file).file_name().ok_or(USAGE)?;
    std::fs::create_dir_all(dist()).map_err(|e| e.to_string())?;
    let here = dist().join(name);
    let there = std::fs::canonicalize(file).map_err(|e| format!("{file}: {e}"))?;
    if here.canonicalize().ok().as_ref() != Some(&there) {
        std::fs::copy(&there, &here).map_err(|e| format!("{file}: {e}"))?;
    }
    Ok(here)
}

/// Advisories, licences and sources of the dependencies, where `cargo-deny` is there.
fn deny() -> Result<(), String> {
    let cargo = || Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let there = cargo().args(["deny", "--version"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!(
            "NOT RUN: cargo deny (`cargo install cargo-deny --locked`); licences were compared with deny.toml, advisories were not"
        );
        return Ok(());
    }
    let mut deny = cargo();
    workspace::succeed(deny.args(["deny", "check"]).current_dir(workspace::root()))
}

/// Unpacks the archive where there is nothing, and runs what is in it without any environment.
fn bare(archive: &Path) -> Result<(), String> {
    let folder = workspace::Scratch::new("release")?;
    workspace::succeed(
        Command::new("tar")
            .arg("-xzf")
            .arg(archive)
            .arg("-C")
            .arg(&folder.0),
    )?;
    let name = archive.file_name().unwrap_or_default().to_string_lossy();
    let unpacked = folder.0.join(name.trim_end_matches(".tar.gz"));
    let binary = unpacked.join("bin/stickslip");
    let mut demo = Command::new(&binary);
    demo.env_clear().current_dir(&folder.0);
    workspace::succeed(demo.args(["demo", "--no-open", "--quiet"]))?;
    for file in [
        "share/bash-completion/completions/stickslip",
        "share/zsh/site-functions/_stickslip",
        "share/fish/vendor_completions.d/stickslip.fish",
        "share/man/man1/stickslip.1",
        "share/man/man1/stickslip-demo.1",
        "share/stickslip/stickslip.schema.json",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "THIRD-PARTY.txt",
    ] {
        if !unpacked.join(file).is_file() {
            return Err(format!("{name} has no {file}"));
        }
    }
    println!("{name}: ran the demo without an environment");
    Ok(())
}

/// Checksums of what is given away, checked by the program that users have.
fn sums(files: &[PathBuf]) -> Result<(), String> {
    let dist = dist();
    let names = files.iter().filter_map(|f| f.file_name());
    let mut sum = Command::new("sha256sum");
    let text = workspace::output(sum.arg("--").args(names).current_dir(&dist))?;
    let file = dist.join("SHA256SUMS");
    std::fs::write(&file, &text).map_err(|e| format!("{}: {e}", file.display()))?;
    let mut check = Command::new("sha256sum");
    workspace::succeed(
        check
            .args(["--check", "--strict", "SHA256SUMS"])
            .current_dir(&dist),
    )?;
    print!("{}", String::from_utf8_lossy(&text));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tag can be moved; what builds and signs a release is the commit that was looked at.
    #[test]
    fn workflows_use_actions_by_commit() {
        let folder = workspace::root().join(".github/workflows");
        let mut seen = 0;
        for entry in std::fs::read_dir(folder).expect("the workflows") {
            let path = entry.expect("a file").path();
            let text = std::fs::read_to_string(&path).expect("a text");
            for line in text.lines().filter(|line| line.contains("uses: ")) {
                let commit = line.split_once('@').map_or("", |(_, commit)| commit);
                let (commit, version) = commit.split_once(" # ").unwrap_or((commit, ""));
                let whole = commit.len() == 40 && commit.bytes().all(|b| b.is_ascii_hexdigit());
                let named = version.starts_with('v');
                assert!(whole && named, "{}: {line}", path.display());
                seen += 1;
            }
        }
        assert!(seen > 0);
    }
}
