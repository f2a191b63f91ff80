//! `cargo xtask book`: the two books, and the pages of them that are generated.
//!
//! `book` is for users, `book/verification` has every check with its numbers, measurements, and how the program works inside. In the first:
//!
//! - `reference/*.md`, the keys of the problem file, from `stickslip.schema.json`;
//! - `reference/command-line.md`, from the help of the commands;
//! - `reference/combinations.md`, from `stickslip models --matrix`.
//!
//! In the second:
//!
//! - `verification.md`, from running all examples (`--verification` only, as that takes minutes).
//!
//! Generated pages are committed, so that they can be read where the sources are; tests fail when they are stale.

mod commands;
mod links;
mod reference;
mod verification;

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::workspace;

/// The version of mdBook that is installed where none is. No pre-processors: formulas are typeset by the page, with what is in `book/src/katex`, so that the
/// book needs neither a network nor another program.
const VERSION: &str = "0.4.52";

/// Writes the generated pages and builds the books into `target/book`, the second one inside of the first.
pub fn build(what: &[String]) -> Result<(), String> {
    let (mut pages_only, mut measure, mut full) = (false, false, false);
    for argument in what {
        match argument.as_str() {
            "--pages" => pages_only = true,
            "--verification" => measure = true,
            "--full" => full = true,
            other => return Err(format!("book: unknown argument {other}")),
        }
    }
    for (page, text) in reference::pages()? {
        write(&source().join("reference").join(page), &text)?;
    }
    write(
        &source().join("reference/command-line.md"),
        &commands::page(&workspace::stickslip()?)?,
    )?;
    write(
        &source().join("reference/combinations.md"),
        &commands::combinations(&workspace::stickslip()?)?,
    )?;
    if measure {
        write(
            &workspace::root().join("book/verification/src/verification.md"),
            &verification::page(full)?,
        )?;
    }
    if pages_only {
        return Ok(());
    }
    let mdbook = mdbook()?;
    // The first one empties the folder.
    for book in ["book", "book/verification"] {
        let status = Command::new(&mdbook)
            .arg("build")
            .arg(workspace::root().join(book))
            .status()
            .map_err(|e| format!("cannot run mdbook: {e}"))?;
        if !status.success() {
            return Err(format!("{book} does not build"));
        }
    }
    let built = workspace::root().join("target/book");
    links::connect(&built)?;
    println!("{}", built.join("index.html").display());
    Ok(())
}

/// `book/src`.
fn source() -> PathBuf {
    workspace::root().join("book/src")
}

/// Writes a file that has changed.
fn write(file: &Path, text: &str) -> Result<(), String> {
    if std::fs::read_to_string(file).is_ok_and(|old| old == text) {
        return Ok(());
    }
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    println!("{}", file.display());
    std::fs::write(file, text).map_err(|e| format!("{}: {e}", file.display()))
}

/// mdBook: the one that is installed, or else one under `target/tools`, where it is installed if it is missing. As a library it would make
/// two hundred crates of every build of this one.
fn mdbook() -> Result<PathBuf, String> {
    let works = |program: &Path| {
        let version = Command::new(program).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    };
    let root = workspace::target().join("tools");
    let own = root
        .join("bin")
        .join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    for program in [PathBuf::from("mdbook"), own.clone()] {
        if works(&program) {
            return Ok(program);
        }
    }
    println!("installing mdbook {VERSION} into {}", root.display());
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["install", "mdbook", "--version", VERSION, "--locked"])
        .args(["--no-default-features", "--features", "search"])
        // It renders a hundred pages: how long it takes to compile matters more than how fast it is.
        .args(["--config", "profile.release.opt-level=1"])
        .arg("--root")
        .arg(&root)
        .current_dir(workspace::root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    match status.success() && works(&own) {
        true => Ok(own),
        false => Err("mdbook cannot be installed".to_string()),
    }
}
