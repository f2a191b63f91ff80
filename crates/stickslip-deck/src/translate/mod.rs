//! A [`Deck`] to a problem file and its mesh.

mod acting;
mod bodies;
mod body_tables;
mod contact;
mod courses;
mod harmonic;
mod job;
mod links;
mod lint;
mod loads;
mod materials;
mod measure;
mod multi_point;
mod names;
mod part;
mod pretensions;
mod references;
mod sets;
mod sliding;
mod spans;
mod steps;
mod supports;
mod temperatures;
mod translation;
mod volumes;

pub use translation::{PrintPlan, Translation};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use stickslip::mesh::Mesh;
use stickslip::problem::brief_toml;

use crate::axes;
use crate::card::Place;
use crate::deck::{Deck, Print, SurfaceParts};
use crate::finding::DeckError;
use crate::parse;
use bodies::Bodies;
use job::Job;
use names::problem_name;
use sets::Sets;

/// The problem that the deck describes. `path` is the deck: its name gives that of the mesh.
///
/// # Errors
/// What has no counterpart here, with its line.
pub fn translate(deck: &Deck, path: &Path) -> Result<Translation, DeckError> {
    let mut job = Job::new(deck);
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
    let mesh_name = PathBuf::from(format!("{}.msh", stem.as_deref().unwrap_or("job")));
    let Some(mut bodies) = bodies::find(&mut job) else {
        return Err(job.failed());
    };
    (bodies.materials, bodies.material) = materials::assign(&mut job, &bodies.section);
    references::find(&mut job, &mut bodies);
    let bodies = bodies;
    let mut sets = Sets::new(deck, &bodies);
    let title = deck.output.title.as_deref().map(str::trim);
    job.problem.title = title.filter(|t| !t.is_empty()).map(str::to_string);
    body_tables::write(&mut job, &bodies, &mut sets, &mesh_name);
    materials::write(&mut job, &bodies);
    references::write(&mut job, &bodies, &mut sets);
    contact::write(&mut job, &bodies, &mut sets);
    sliding::write(&mut job, &bodies);
    supports::write(&mut job, &bodies, &mut sets);
    loads::write(&mut job, &bodies, &mut sets);
    harmonic::write(&mut job, &bodies);
    temperatures::write(&mut job, &bodies, &mut sets);
    links::write(&mut job, &bodies, &mut sets);
    let drawn = pretensions::write(&mut job, &bodies, &mut sets);
    multi_point::write(&mut job, &bodies, &mut sets);
    quality(&mut job);
    steps::write(&mut job);
    unprinted(&mut job, &bodies);
    modal_output(&mut job);
    job.problem.set = sets.unions();
    if !job.errors.is_empty() {
        return Err(job.failed());
    }
    let toml = match brief_toml(&job.problem) {
        Ok(text) => text,
        Err(e) => {
            let findings = e.findings.iter();
            findings.for_each(|f| job.error(Place::default(), f.message.clone(), ""));
            return Err(job.failed());
        }
    };
    let mesh = Arc::new(sets.into_mesh(&bodies));
    let mut notes = deck.notes.clone();
    notes.append(&mut job.notes);
    let node_axes = deck.properties.transforms.iter().filter_map(|(n, t)| {
        let x = *deck.nodes.get(n)?;
        Some((*n, axes::at_node(t, x)?))
    });
    let element_axes = bodies.section.iter().filter_map(|(e, s)| {
        let axes = materials::axes_of(deck, *e, &deck.properties.sections[*s])?;
        Some((*e, axes))
    });
    Ok(Translation {
        plan: PrintPlan {
            times: times(&job),
            node_axes: node_axes.collect(),
            element_axes: element_axes.collect(),
            prints: deck.steps.iter().map(|s| s.prints.clone()).collect(),
            node_sets: printed(deck, &deck.node_sets),
            element_sets: printed(deck, &deck.element_sets),
            surfaces: carried(deck, &bodies),
            pairs: job.pairs,
            drawn,
            references: references::printed(deck, &bodies),
            numbering: deck.numbering.clone(),
        },
        elements: deck.elements.iter().map(|(n, e)| (*n, e.place)).collect(),
        lint: lint::findings(deck, &bodies),
        toml,
        mesh_name,
        mesh,
        notes,
        filed: deck.steps.iter().map(|s| s.filed.clone()).collect(),
        path: path.to_path_buf(),
        places: job.places,
        files: deck.output.files.clone(),
    })
}

/// Limits of the gate that do not hold where the deck gives springs of its own, and those that the deck asks for.
fn quality(job: &mut Job) {
    let (stick, soft) = (deck_has_stick(job.deck), contact::ties_by_springs(job.deck));
    let limits = &mut job.problem.quality;
    if stick || soft {
        // The slip and the stretch of springs that the deck gives are no errors of the solution.
        limits.elastic_slip = NO_LIMIT;
    }
    if soft {
        limits.penetration_to_approach = NO_LIMIT;
    }
    if job.strains {
        limits.strain = Some(0.05);
    }
}

/// A limit that nothing reaches.
const NO_LIMIT: f64 = 1e300;

/// What steps that look for modes ask to be printed and written: modes have files of their own.
fn modal_output(job: &mut Job) {
    let steps = job.deck.steps.iter();
    let modal: Vec<_> = steps.filter(|s| s.is_modal() && !s.is_harmonic()).collect();
    for step in modal {
        let mut asked = Vec::new();
        let prints = |nodes: bool| {
            let mut all = step.prints.iter();
            all.any(|p| matches!(p, Print::Node { .. }) == nodes)
        };
        if prints(true) {
            asked.push("*NODE PRINT");
        }
        if prints(false) {
            asked.push("*EL PRINT, *CONTACT PRINT or *SECTION PRINT");
        }
        if !step.filed.is_empty() {
            asked.push("*NODE FILE, *EL FILE or *CONTACT FILE");
        }
        if !asked.is_empty() {
            let message = format!(
                "{}: left out in a step that looks for modes, of which nothing goes to the .dat and .frd files",
                asked.join(", ")
            );
            job.warn(step.place, message, "frequencies and shapes are in modes-N.csv and modes-N.pvd of the results, N the number of the step");
        }
    }
}

/// Notes on printed nodes that are in no body.
fn unprinted(job: &mut Job, bodies: &Bodies) {
    let deck = job.deck;
    for step in &deck.steps {
        for print in &step.prints {
            let Print::Node { set, .. } = print else {
                continue;
            };
            let all = deck.node_sets.get(set).into_iter().flatten();
            let known = |n: &&u64| {
                let turned = deck.connectors.rigid.iter().any(|r| {
                    let reference = r
                        .reference
                        .is_some_and(|n| bodies.references.contains_key(&n));
                    r.rotation == Some(**n) && reference
                });
                turned
                    || bodies.of_node.contains_key(n)
                    || bodies.references.contains_key(n)
                    || deck.pretension(**n).is_some()
            };
            let none = all.filter(|n| !known(n)).count();
            if none > 0 {
                let message = format!(
                    "*NODE PRINT of {set}: {none} nodes that are in no body, such as reference nodes, are not printed"
                );
                job.note(step.place, message);
            }
        }
    }
}

/// The sets of a kind that are printed.
fn printed(deck: &Deck, sets: &BTreeMap<String, Vec<u64>>) -> BTreeMap<String, Vec<u64>> {
    let name = |p: &Print| match p {
        Print::Node { set, .. } | Print::Element { set, .. } => Some(set.clone()),
        Print::Contact { .. } | Print::Section { .. } => None,
    };
    let names = deck.steps.iter().flat_map(|s| &s.prints).filter_map(name);
    names
        .filter_map(|n| Some((n.clone(), sets.get(&n)?.clone())))
        .collect()
}

/// The faces of the surfaces whose forces are printed: element, and face from 0.
fn carried(deck: &Deck, bodies: &Bodies) -> BTreeMap<String, Vec<(u64, usize)>> {
    let name = |p: &Print| match p {
        Print::Section { surface, .. } => Some(surface.clone()),
        _ => None,
    };
    let mesh = bodies.mesh();
    let faces = |name: &String| -> Vec<(u64, usize)> {
        let by = deck.surfaces.get(name).map(|s| bodies.faces(&s.parts));
        let all = by.into_iter().flat_map(BTreeMap::into_values).flatten();
        all.map(|f| (mesh.cell_id(f.cell), f.face)).collect()
    };
    let names = deck.steps.iter().flat_map(|s| &s.prints).filter_map(name);
    names.map(|n| (n.clone(), faces(&n))).collect()
}

/// Times of `*TIME POINTS` that are asked for, in the time of the analysis.
fn times(job: &Job) -> BTreeMap<String, Vec<f64>> {
    let mut times: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (step, span) in job.deck.steps.iter().zip(&job.spans) {
        for name in &step.output_times {
            let points = steps::points(job.deck, name, *span);
            times.entry(name.clone()).or_default().extend(points);
        }
    }
    times
}

/// The mesh of a deck with all its sets and surfaces, whatever else it says: it may consist of a mesh alone.
///
/// # Errors
/// What is wrong with its nodes, elements, sets and surfaces.
pub fn read_mesh(path: &Path) -> Result<Mesh, DeckError> {
    let deck = parse::read(path)?;
    let mut job = Job::new(&deck);
    let Some(bodies) = bodies::connected(&mut job) else {
        return Err(job.failed());
    };
    let mut sets = Sets::new(&deck, &bodies);
    for (name, nodes) in &deck.node_sets {
        sets.keep_points(&bodies, &problem_name(name), nodes);
    }
    for (name, elements) in &deck.element_sets {
        sets.keep_cells(&bodies, &problem_name(name), elements);
    }
    for (name, elements) in &deck.element_sets {
        // What bounds cells in a file of Gmsh is what its user has named.
        let faces = SurfaceParts::Faces(elements.iter().map(|e| (*e, Some(0))).collect());
        let by = bodies.faces(&faces);
        if by.values().any(|list| !list.is_empty()) {
            sets.keep_facets(&problem_name(name), &by);
        }
    }
    for (name, surface) in &deck.surfaces {
        match &surface.parts {
            SurfaceParts::Nodes(nodes) => sets.keep_points(&bodies, &problem_name(name), nodes),
            faces => sets.keep_facets(&problem_name(name), &bodies.faces(faces)),
        }
    }
    Ok(sets.into_mesh(&bodies))
}

/// Whether sticking is a spring of the deck's own.
fn deck_has_stick(deck: &Deck) -> bool {
    let mut all = deck.contact.interactions.values();
    all.any(|i| contact::compliant(i) && i.friction.as_ref().is_some_and(|f| f.stick.is_some()))
}

#[cfg(test)]
mod tests;
