//! Names that a deck defines and never uses.

use std::collections::BTreeSet;

use crate::card::{Card, Place};
use crate::source::Source;
use crate::text::label;

/// So many names are listed in one finding.
const LISTED: usize = 12;

/// Names that are defined and never mentioned again, from the cards alone.
pub(super) fn unused(source: &Source) -> Vec<(Place, String)> {
    const DEFINITIONS: &[(&str, &[&str], &str)] = &[
        ("sets of nodes", &["NSET"], "NSET"),
        ("sets of elements", &["ELSET"], "ELSET"),
        ("surfaces", &["SURFACE"], "NAME"),
        ("materials", &["MATERIAL"], "NAME"),
        ("orientations", &["ORIENTATION"], "NAME"),
        ("amplitudes", &["AMPLITUDE"], "NAME"),
        ("surface interactions", &["SURFACEINTERACTION"], "NAME"),
        ("time points", &["TIMEPOINTS"], "NAME"),
    ];
    let mentioned = mentioned(source);
    let mut out = Vec::new();
    for (what, keywords, parameter) in DEFINITIONS {
        let mut names: Vec<(Place, &str)> = Vec::new();
        for card in source
            .cards
            .iter()
            .filter(|c| keywords.contains(&c.keyword.as_str()))
        {
            if let Some(name) = card.get(parameter)
                && !mentioned.contains(name)
                && names.iter().all(|(_, n)| *n != name)
            {
                names.push((card.place, name));
            }
        }
        let Some((place, _)) = names.first() else {
            continue;
        };
        let mut list: Vec<&str> = names.iter().take(LISTED).map(|n| n.1).collect();
        if names.len() > LISTED {
            list.push("...");
        }
        out.push((
            *place,
            format!("{what} that nothing uses: {}", list.join(", ")),
        ));
    }
    out
}

/// What cards mention, but where they define it.
fn mentioned(source: &Source) -> BTreeSet<String> {
    let defines = |card: &Card, parameter: &str| {
        matches!(
            (card.keyword.as_str(), parameter),
            ("NSET" | "NODE", "NSET") | ("ELSET" | "ELEMENT", "ELSET") | (_, "NAME")
        )
    };
    let mut mentioned: BTreeSet<String> = BTreeSet::new();
    for card in &source.cards {
        let values = card.parameters.iter().filter(|p| !defines(card, &p.name));
        mentioned.extend(values.filter_map(|p| p.value.clone()));
        if matches!(card.keyword.as_str(), "NODE" | "ELEMENT" | "HEADING") {
            continue;
        }
        let fields = card.data.iter().flat_map(|d| &d.fields);
        let names =
            fields.filter(|f| f.starts_with(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))));
        mentioned.extend(names.map(|f| label(f)));
    }
    // Of a name behind an instance or the assembly, what has been given.
    let behind = |name: &String| -> Vec<String> {
        let points = name.match_indices('.');
        points.map(|(at, _)| name[at + 1..].to_string()).collect()
    };
    let more: Vec<String> = mentioned.iter().flat_map(behind).collect();
    mentioned.extend(more);
    mentioned
}
