//! What is no mistake but most likely not meant, or would be refused by CalculiX: for `stickslip check`.

use std::collections::BTreeSet;

use stickslip::math::{Vec3, add, cross, dot, norm, scale, sub};
use stickslip::mesh::FacetRef;

use crate::deck::{Deck, Interaction, Pair, SurfaceParts};
use crate::finding::{Finding, Severity};
use crate::source::{Card, Place, Source, label};
use crate::translate::Bodies;

/// So many names are listed in one finding.
const LISTED: usize = 12;

/// Names that are defined and never mentioned again, from the cards alone.
pub(crate) fn unused(source: &Source) -> Vec<(Place, String)> {
    const KINDS: &[(&str, &[&str], &str)] = &[
        ("sets of nodes", &["NSET"], "NSET"),
        ("sets of elements", &["ELSET"], "ELSET"),
        ("surfaces", &["SURFACE"], "NAME"),
        ("materials", &["MATERIAL"], "NAME"),
        ("orientations", &["ORIENTATION"], "NAME"),
        ("amplitudes", &["AMPLITUDE"], "NAME"),
        ("surface interactions", &["SURFACEINTERACTION"], "NAME"),
        ("time points", &["TIMEPOINTS"], "NAME"),
    ];
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
    let mut out = Vec::new();
    for (what, keywords, parameter) in KINDS {
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

/// What only the translated deck tells.
pub(crate) fn findings(deck: &Deck, bodies: &Bodies) -> Vec<Finding> {
    let mut out = Vec::new();
    let mut say = |severity, place: Place, message: String, help: &str| {
        out.push(Finding {
            severity,
            file: deck.files.get(place.file).cloned().unwrap_or_default(),
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
        deck.rigid
            .iter()
            .flat_map(|r| [r.reference, r.rotation])
            .flatten(),
    );
    let loose: Vec<u64> = deck
        .nodes
        .keys()
        .copied()
        .filter(|n| !named.contains(n))
        .collect();
    if let Some(first) = loose.first() {
        let message = format!(
            "{} nodes are in no element, the first is {first}",
            loose.len()
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
    for (name, i) in &deck.interactions {
        for (message, help) in of_interaction(deck, name, i) {
            say(Severity::Warning, i.place, message, help);
        }
    }
    for pair in &deck.pairs {
        for (message, help) in of_pair(deck, bodies, pair) {
            say(Severity::Warning, pair.place, message, help);
        }
    }
    out.sort_by_key(|f| (deck.files.iter().position(|p| *p == f.file), f.line));
    out
}

/// What CalculiX needs of an interaction.
fn of_interaction(deck: &Deck, name: &str, i: &Interaction) -> Vec<(String, &'static str)> {
    let mut out = Vec::new();
    if !deck.pairs.iter().any(|p| p.interaction == name) {
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

/// The sum of area vectors, the area, and the number of facets of a surface.
pub(crate) fn measure(bodies: &Bodies, facets: &[FacetRef]) -> (Vec3, f64) {
    let mesh = bodies.mesh();
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for facet in facets {
        let (kind, points) = mesh.facet_points(*facet);
        let x: Vec<Vec3> = points.iter().map(|p| mesh.points[*p]).collect();
        let corners = kind.corner_count().min(x.len());
        let area = match corners {
            2 => {
                let d = sub(x[1], x[0]);
                [d[1], -d[0], 0.0]
            }
            _ => (1..corners.saturating_sub(1)).fold([0.0; 3], |s, i| {
                add(s, scale(0.5, cross(sub(x[i], x[0]), sub(x[i + 1], x[0]))))
            }),
        };
        sum = add(sum, area);
        total += norm(area);
    }
    (sum, total)
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
            format!("the surfaces {} and {} look the same way: they can never touch", pair.slave, pair.master),
            "one of them consists of the faces on the far side of its body; check the numbers of the faces (S1 to S6)",
        ));
    }
    let (size_s, size_m) = (area_s / slave.len() as f64, area_m / master.len() as f64);
    let bodies_differ = if bodies.mesh().dim == 3 { 2.25 } else { 1.5 };
    if pair.by_nodes && size_s > bodies_differ * size_m {
        out.push((
            format!("the slave surface {} is coarser than the master {}: nodes of the master can enter it unseen", pair.slave, pair.master),
            "exchange the two, or use TYPE=SURFACE TO SURFACE",
        ));
    }
    out
}
