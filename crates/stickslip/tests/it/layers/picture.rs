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

/// A flow chart for Mermaid: crates of the library with their layers from top to bottom, the other crates above. An arrow that others imply is left
/// out, and one between crates of the library, as rooms show it.
pub fn draw(library: &[(&str, &[&[&str]])], rooms: &Arrows, crates: &Arrows) -> String {
    let mut out = String::from("```mermaid\nflowchart TD\n");
    let own = |name: &str| library.iter().any(|(of, _)| *of == name);
    let lines = |out: &mut String, arrows: &Arrows| {
        for (from, all) in arrows {
            let hidden = |to: &str| own(from) && own(to) || by_others(arrows, from, to);
            for to in all.iter().filter(|to| !hidden(to)) {
                // Writing to a string cannot fail.
                let _ = writeln!(out, "    {from} --> {to}");
            }
        }
    };
    let names: BTreeSet<&String> = crates.keys().chain(crates.values().flatten()).collect();
    for name in names.iter().filter(|n| !own(n)) {
        let _ = writeln!(out, "    {name}[[{name}]]");
    }
    lines(&mut out, crates);
    let mut below: usize = library.iter().map(|(_, layers)| layers.len()).sum();
    for (name, layers) in library.iter().rev() {
        let _ = writeln!(out, "    subgraph {name}");
        for layer in layers.iter().rev() {
            below -= 1;
            let _ = writeln!(
                out,
                "    subgraph layer{below} [\" \"]\n    direction LR\n    {}\n    end",
                layer.join("\n    ")
            );
        }
        out.push_str("    end\n");
    }
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
