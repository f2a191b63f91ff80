//! `cargo xtask decks [FOLDER]`: decks of CalculiX with the numbers that it prints, against ours, as a page of the book.

mod blocks;
mod outcome;
mod page;

use std::path::{Path, PathBuf};
use std::process::Command;

use outcome::{Outcome, Variant};
use xtask::workspace;

/// Runs all decks of a folder that holds `NAME.inp` and `NAME.dat.ref`.
pub fn run(arguments: &[String]) -> Result<(), String> {
    let folder = match arguments {
        [] => workspace::root().join("../shared/decks/calculix"),
        [one] => PathBuf::from(one),
        _ => return Err("usage: cargo xtask decks [FOLDER]".into()),
    };
    let binary = workspace::stickslip()?;
    let fault = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut decks: Vec<PathBuf> = std::fs::read_dir(&folder)
        .map_err(fault)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .collect();
    decks.sort();
    let out = workspace::target().join("decks");
    let mut outcomes = Vec::new();
    for deck in decks {
        let outcome = one(&binary, &deck, &out)?;
        println!("{}", page::line(&outcome));
        outcomes.push(outcome);
    }
    let page = workspace::root().join("book/verification/src/decks.md");
    std::fs::write(&page, page::text(&outcomes)).map_err(|e| format!("{}: {e}", page.display()))
}

fn one(binary: &Path, deck: &Path, out: &Path) -> Result<Outcome, String> {
    let name = deck
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let reference = deck.with_extension("dat.ref");
    let reference = std::fs::read_to_string(reference).unwrap_or_default();
    let text = std::fs::read_to_string(deck).map_err(|e| format!("{}: {e}", deck.display()))?;
    let mut found = Vec::new();
    let mut variants = vec![(Variant::Plain, Vec::new())];
    let hard = text
        .to_uppercase()
        .replace(' ', "")
        .contains("OVERCLOSURE=HARD");
    if hard && !reference.trim().is_empty() {
        variants.push((Variant::Stiffness, stiffness(binary, deck, &text, out)?));
    }
    for (variant, settings) in variants {
        let folder = out.join(format!("{name}-{variant:?}").to_lowercase());
        let output = Command::new(binary)
            .args(["run", "--output"])
            .args([&folder, deck])
            .args(settings.iter().flat_map(|s| ["--set", s]))
            .output()
            .map_err(|e| format!("{}: {e}", binary.display()))?;
        let errors = String::from_utf8_lossy(&output.stderr);
        // A failed check of quality leaves results.
        let finding = errors.lines().find(|l| l.contains(": error: "));
        if let (Some(finding), true) = (finding, output.status.code() != Some(0)) {
            let short = finding.rsplit('/').next().unwrap_or(finding);
            return Ok(Outcome {
                name,
                refusal: Some(short.to_string()),
                found,
            });
        }
        let ours = folder.join(&name).with_extension("dat");
        let ours = std::fs::read_to_string(ours).unwrap_or_default();
        found.push((variant, blocks::compare(&ours, &reference)));
    }
    Ok(Outcome {
        name,
        refusal: None,
        found,
    })
}

/// Settings that give every interface fifty times Young's modulus as its stiffness, as CalculiX does where contact is hard.
fn stiffness(binary: &Path, deck: &Path, text: &str, out: &Path) -> Result<Vec<String>, String> {
    let fault = |e: std::io::Error| format!("{}: {e}", deck.display());
    std::fs::create_dir_all(out).map_err(fault)?;
    let toml = out.join("converted.toml");
    let status = Command::new(binary)
        .arg("convert")
        .args([deck, &toml])
        .output()
        .map_err(fault)?;
    if !status.status.success() {
        return Ok(Vec::new());
    }
    let problem = std::fs::read_to_string(toml).map_err(fault)?;
    let mut lines = text.lines();
    let mut young: f64 = 0.0;
    while let Some(line) = lines.next() {
        if line.to_uppercase().starts_with("*ELASTIC") {
            let first = lines.next().and_then(|l| l.split(',').next());
            young = young.max(first.and_then(|f| f.trim().parse().ok()).unwrap_or(0.0));
        }
    }
    let named = problem
        .lines()
        .filter_map(|l| l.strip_prefix("[interface.")?.strip_suffix(']'));
    Ok(named
        .map(|n| format!("interface.{n}.normal.linear.c={:e}", 50.0 * young))
        .collect())
}
