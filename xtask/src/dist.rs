//! `cargo xtask dist`

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace::{self, output};

/// Builds the static binary and packs it with completions, manual pages, schema and licences:
/// `dist/stickslip-VERSION-x86_64-linux.tar.gz`.
pub fn pack() -> Result<PathBuf, String> {
    let triple = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let binary = build(&triple)?;
    check(&binary)?;
    let name = format!(
        "stickslip-{}-{}-linux",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH
    );
    let dist = workspace::root().join("dist");
    let folder = dist.join(&name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    fill(&folder, &binary)?;
    let archive = dist.join(format!("{name}.tar.gz"));
    // Names sorted and no times, so that the same sources make the same archive.
    output(
        Command::new("tar")
            .args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner"])
            .args(["--mtime=@0", "--use-compress-program=gzip -9n", "-cf"])
            .arg(&archive)
            .arg("-C")
            .arg(&dist)
            .arg(&name),
    )?;
    let bytes = archive.metadata().map_err(|e| e.to_string())?.len();
    println!("{} ({:.1} MB)", archive.display(), bytes as f64 / 1e6);
    Ok(archive)
}

/// The release binary, linked with a C library of its own. With a target the flags do not reach build scripts.
fn build(triple: &str) -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args([
            "build",
            "--release",
            "--package",
            "stickslip-cli",
            "--target",
            triple,
        ])
        .args(["--config", "profile.release.debug=false"])
        .args(["--config", "profile.release.strip=true"])
        .env("RUSTFLAGS", "-C target-feature=+crt-static")
        .current_dir(workspace::root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    if !status.success() {
        return Err(
            "the static binary does not build; it needs the C library as an archive (libc.a)"
                .into(),
        );
    }
    Ok(workspace::target().join(triple).join("release/stickslip"))
}

/// That it needs no loader and no libraries, and runs without any environment.
fn check(binary: &Path) -> Result<(), String> {
    let bytes = std::fs::read(binary).map_err(|e| format!("{}: {e}", binary.display()))?;
    if interpreter(&bytes).ok_or("the binary is no 64-bit ELF file")? {
        return Err("the binary is not static: it asks for a loader".into());
    }
    let case = workspace::root().join("examples/greco/case.toml");
    let out = std::env::temp_dir().join(format!("stickslip-dist-{}", std::process::id()));
    output(
        Command::new(binary)
            .env_clear()
            .arg("run")
            .arg(case)
            .arg("-q")
            .arg("-o")
            .arg(&out),
    )?;
    std::fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))
}

/// Whether an ELF file has a segment that names its loader; `None` if it is something else.
fn interpreter(bytes: &[u8]) -> Option<bool> {
    const LOADER: u32 = 3;
    if !bytes.starts_with(b"\x7fELF\x02\x01") {
        return None;
    }
    let number = |at: usize, length: usize| -> Option<u64> {
        let bytes = bytes.get(at..at + length)?;
        Some(bytes.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b)))
    };
    let (first, size, count) = (number(32, 8)?, number(54, 2)?, number(56, 2)?);
    for i in 0..count {
        if number((first + i * size) as usize, 4)? == u64::from(LOADER) {
            return Some(true);
        }
    }
    Some(false)
}

fn fill(folder: &Path, binary: &Path) -> Result<(), String> {
    let write = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent)
            .and_then(|()| std::fs::write(&path, content))
            .map_err(|e| format!("{}: {e}", path.display()))
    };
    std::fs::create_dir_all(folder.join("bin")).map_err(|e| e.to_string())?;
    let here = folder.join("bin/stickslip");
    std::fs::copy(binary, &here).map_err(|e| format!("{}: {e}", here.display()))?;
    let say = |arguments: &[&str]| output(Command::new(&here).args(arguments));
    for (shell, name) in [
        ("bash", "share/bash-completion/completions/stickslip"),
        ("zsh", "share/zsh/site-functions/_stickslip"),
        ("fish", "share/fish/vendor_completions.d/stickslip.fish"),
    ] {
        write(name, &say(&["completions", shell])?)?;
    }
    let pages = folder.join("share/man/man1");
    say(&["man", "-o", &pages.display().to_string()])?;
    write("share/stickslip/stickslip.schema.json", &say(&["schema"])?)?;
    for name in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        let content = std::fs::read(workspace::root().join(name));
        write(name, &content.map_err(|e| format!("{name}: {e}"))?)?;
    }
    write("THIRD-PARTY.txt", third_party()?.as_bytes())
}

fn cargo() -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(workspace::root());
    command
}

/// What cargo knows of all packages.
pub fn metadata() -> Result<serde_json::Value, String> {
    let metadata = output(cargo().args(["metadata", "--format-version=1", "--locked"]))?;
    serde_json::from_slice(&metadata).map_err(|e| format!("cargo metadata: {e}"))
}

/// Names and versions of the crates in the binary.
pub fn used() -> Result<BTreeSet<(String, String)>, String> {
    let tree = output(cargo().args([
        "tree",
        "--package=stickslip-cli",
        "--edges=normal",
        "--prefix=none",
        "--format={p}",
    ]))?;
    let tree = String::from_utf8_lossy(&tree);
    // `name v1.2.3`, perhaps with a place or a mark behind it.
    let package = |line: &str| {
        let mut words = line.split_whitespace();
        let name = words.next()?.to_string();
        Some((name, words.next()?.strip_prefix('v')?.to_string()))
    };
    Ok(tree.lines().filter_map(package).collect())
}

/// The crates in the binary with the texts of their licences, which these want to be passed on.
fn third_party() -> Result<String, String> {
    let (used, metadata) = (used()?, metadata()?);
    let mut out = String::from("The binary contains these crates.\n");
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        let (name, version) = (text("name"), text("version"));
        if package["source"].is_null() || !used.contains(&(name.into(), version.into())) {
            continue;
        }
        out += &format!("\n==== {name} {version} ({})\n", text("license"));
        let folder = Path::new(text("manifest_path"))
            .parent()
            .unwrap_or(Path::new(""));
        let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
            .map_err(|e| format!("{}: {e}", folder.display()))?
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let name = name.to_ascii_uppercase();
                path.is_file()
                    && ["LICENSE", "LICENCE", "COPYING", "NOTICE"]
                        .iter()
                        .any(|start| name.starts_with(start))
            })
            .collect();
        files.sort();
        for file in files {
            let text = std::fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            out += &format!("\n{}\n", String::from_utf8_lossy(&text).trim_end());
        }
    }
    Ok(out)
}
