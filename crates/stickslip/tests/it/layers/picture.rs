//! The picture of the rooms in `ARCHITECTURE.md`, drawn from the imports.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Who imports whom, by name.
pub type Arrows = BTreeMap<String, BTreeSet<String>>;

/// What stands before and after the picture.
pub const BEGIN: &str = "<!-- rooms: written by `cargo xtask rooms` -->\n";
pub const END: &str = "<!-- end of rooms -->\n";

/// Whether a way of two arrows or more leads from one to the other.
fn by_others(arrows: &Arrows, from: &str, to: &str) -> bool {
    let mut seen = BTreeSet::new();
    let first = arrows.get(from).into_iter().flatten().filter(|n| *n != to);
    let mut next: Vec<&String> = first.collect();
    while let Some(at) = next.pop() {
        if at == to {
            return true;
        }
        if seen.insert(at) {
            next.extend(arrows.get(at).into_iter().flatten());
        }
    }
    false
}

/// A flow chart for Mermaid: layers of the library from top to bottom, the other crates above. An arrow that others imply is left out.
pub fn draw(layers: &[&[&str]], rooms: &Arrows, crates: &Arrows) -> String {
    let mut out = String::from("```mermaid\nflowchart TD\n");
    let lines = |out: &mut String, arrows: &Arrows| {
        for (from, all) in arrows {
            for to in all.iter().filter(|to| !by_others(arrows, from, to)) {
                // Writing to a string cannot fail.
                let _ = writeln!(out, "    {from} --> {to}");
            }
        }
    };
    let names: BTreeSet<&String> = crates.keys().chain(crates.values().flatten()).collect();
    for name in names.iter().filter(|n| **n != "stickslip") {
        let _ = writeln!(out, "    {name}[[{name}]]");
    }
    lines(&mut out, crates);
    out.push_str("    subgraph stickslip\n");
    for (i, layer) in layers.iter().enumerate().rev() {
        let _ = writeln!(
            out,
            "    subgraph layer{i} [\" \"]\n    direction LR\n    {}\n    end",
            layer.join("\n    ")
        );
    }
    out.push_str("    end\n");
    lines(&mut out, rooms);
    out.push_str("```\n");
    out
}

/// The text with the picture in its place; `None` if the marks are missing.
pub fn placed(text: &str, picture: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}{picture}{END}{after}"))
}
