//! What is no mistake but most likely not meant, or would be refused by CalculiX: for `stickslip check`.

use std::collections::BTreeSet;

use stickslip::math::{Vec3, dot, norm};
use stickslip::mesh::FacetRef;

use super::bodies::Bodies;
use super::measure::measure;
use crate::card::Place;
use crate::deck::{Deck, Interaction, Pair, SurfaceParts};
use crate::finding::{Finding, Severity};

/// What only the translated deck tells.
pub(super) fn findings(deck: &Deck, bodies: &Bodies) -> Vec<Finding> {
    let mut out = Vec::new();
    let mut say = |severity, place: Place, message: String, help: &str| {
        out.push(Finding {
            severity,
            file: deck
                .output
                .files
                .get(place.file)
                .cloned()
                .unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        });
    };
    for (place, message) in &deck.unused {
        say(Severity::Note, *place, message.clone(), "");
    }
    let mut named: BTreeSet<u64> = deck
        .elements
        .values()
        .flat_map(|e| e.nodes.iter().copied())
        .collect();
    named.extend(
        deck.connectors
            .rigid
            .iter()
            .flat_map(|r| [r.reference, r.rotation])
            .flatten(),
    );
    named.extend(bodies.references.keys());
    let loose: Vec<u64> = deck
        .nodes
        .keys()
        .copied()
        .filter(|n| !named.contains(n))
        .collect();
    if let Some(first) = loose.first() {
        let message = format!(
            "{} nodes are in no element, the first is {}",
            loose.len(),
            deck.label(*first)
        );
        say(Severity::Note, Place::default(), message, "");
    }
    for step in deck
        .steps
        .iter()
        .filter(|s| s.prints.is_empty() && s.output_every.is_none() && s.output_times.is_empty())
    {
        say(
            Severity::Note,
            step.place,
            "the step asks for no output".into(),
            "write *NODE FILE and *EL FILE in it; stickslip writes the end of every step anyway",
        );
    }
    for (name, i) in &deck.contact.interactions {
        for (message, help) in of_interaction(deck, name, i) {
            say(Severity::Warning, i.place, message, help);
        }
    }
    for pair in &deck.contact.pairs {
        for (message, help) in of_pair(deck, bodies, pair) {
            say(Severity::Warning, pair.place, message, help);
        }
    }
    out.sort_by_key(|f| (deck.output.files.iter().position(|p| *p == f.file), f.line));
    out
}

/// What CalculiX needs of an interaction.
fn of_interaction(deck: &Deck, name: &str, i: &Interaction) -> Vec<(String, &'static str)> {
    let mut out = Vec::new();
    if !deck.contact.pairs.iter().any(|p| p.interaction == name) {
        return out;
    }
    if i.behavior.is_none() {
        out.push((
            format!("the interaction {name} has no *SURFACE BEHAVIOR: it is hard here and in Abaqus, CalculiX refuses it"),
            "write *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD, or LINEAR with 5 to 50 times Young's modulus",
        ));
    }
    match &i.friction {
        Some(f) if f.stick.is_none() && !f.rough && f.decay.is_none() && f.table.is_empty() => out.push((
            format!("the friction of {name} has no stick slope: sticking is exact here, CalculiX needs a slope"),
            "write coefficient, stick slope; a tenth of the slope of the pressure is customary",
        )),
        _ => {}
    }
    out
}

fn of_pair(deck: &Deck, bodies: &Bodies, pair: &Pair) -> Vec<(String, &'static str)> {
    let mut out = Vec::new();
    let facets = |name: &str| -> Option<Vec<FacetRef>> {
        let parts = &deck.surfaces.get(name)?.parts;
        match parts {
            SurfaceParts::Nodes(_) => None,
            faces => Some(bodies.faces(faces).into_values().flatten().collect()),
        }
    };
    let (Some(slave), Some(master)) = (facets(&pair.slave), facets(&pair.master)) else {
        return out;
    };
    if slave.is_empty() || master.is_empty() {
        return out;
    }
    let ((ns, area_s), (nm, area_m)) = (measure(bodies, &slave), measure(bodies, &master));
    // Surfaces that are closed, such as a bore, have no direction as a whole.
    let plain = |n: Vec3, area: f64| norm(n) > 0.5 * area;
    if plain(ns, area_s) && plain(nm, area_m) && dot(ns, nm) > 0.5 * norm(ns) * norm(nm) {
        out.push((
            format!("the surfaces {} and {} face the same direction: they cannot touch", pair.slave, pair.master),
            "one surface probably lies on the opposite side of its body; check its face numbers (S1 to S6)",
        ));
    }
    let (size_s, size_m) = (area_s / slave.len() as f64, area_m / master.len() as f64);
    let bodies_differ = if bodies.mesh().dim == 3 { 2.25 } else { 1.5 };
    if pair.by_nodes && size_s > bodies_differ * size_m {
        out.push((
            format!("the slave surface {} is coarser than the master {}: penetration by nodes of the master is not detected", pair.slave, pair.master),
            "exchange the two, or use TYPE=SURFACE TO SURFACE",
        ));
    }
    out
}
