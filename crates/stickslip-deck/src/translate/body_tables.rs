//! The tables of the model and of its bodies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use stickslip::body::Formulation;
use stickslip::io::abaqus::{self, Integration, Space};
use stickslip::problem::{self, BodyRotation, GmshFile, MeshSource, Rayleigh, SpaceKind};

use super::bodies::{Bodies, Body};
use super::job::Job;
use super::sets::Sets;
use crate::card::Place;
use crate::deck::{Action, Distributed, Procedure, Section, Step};

fn space_kind(space: Space) -> SpaceKind {
    match space {
        Space::Solid => SpaceKind::Solid,
        Space::PlaneStress => SpaceKind::PlaneStress,
        Space::PlaneStrain => SpaceKind::PlaneStrain,
        Space::Axisymmetric => SpaceKind::Axisymmetric,
    }
}

/// How the elements of a body are integrated.
fn formulation(job: &mut Job, body: &Body) -> Formulation {
    let deck = job.deck;
    let mut found: Option<(Integration, u64)> = None;
    for id in &body.elements {
        let e = &deck.elements[id];
        let Ok(t) = abaqus::element_type(&e.kind) else {
            continue;
        };
        // Linear triangles and tetrahedra are the same however they are integrated.
        let simple = matches!(
            t.kind.name(),
            "tri3" | "tet4" | "tet10" | "wedge6" | "tri6" | "wedge15"
        );
        match found {
            _ if simple && t.integration == Integration::Full => {}
            None => found = Some((t.integration, *id)),
            Some((f, first)) if f != t.integration => {
                let message = format!(
                    "{} and {} (element {}) are mixed in one body: all are taken as fully integrated",
                    e.kind,
                    deck.elements[&first].kind,
                    deck.label(first)
                );
                job.warn(e.place, message, "use one type of element in a body");
                return Formulation::Standard;
            }
            Some(_) => {}
        }
    }
    // C3D6 has two integration points; ours has six unless it is reduced.
    let wedges = |id: &u64| deck.elements[id].kind.starts_with("C3D6");
    if found.is_none() && body.elements.iter().any(wedges) {
        return Formulation::Reduced;
    }
    match found.map(|f| f.0) {
        Some(Integration::Reduced) => Formulation::Reduced,
        Some(Integration::Incompatible) => Formulation::IncompatibleModes,
        Some(Integration::Full) | None => Formulation::Standard,
    }
}

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets, mesh_name: &Path) {
    let deck = job.deck;
    job.problem.model.space = space_kind(bodies.space);
    if matches!(bodies.space, Space::PlaneStress | Space::PlaneStrain) {
        let thick: BTreeMap<u64, &Section> = deck
            .properties
            .sections
            .iter()
            .map(|s| (s.thickness.unwrap_or(1.0).to_bits(), s))
            .collect();
        if thick.len() > 1 {
            let place = deck
                .properties
                .sections
                .last()
                .map_or(Place::default(), |s| s.place);
            job.error(
                place,
                "sections of different thickness",
                "all bodies of a plane problem have the same thickness",
            );
        }
        let mut thicknesses = deck.properties.sections.iter().map(|s| s.thickness);
        job.problem.model.thickness = thicknesses.find_map(|t| t);
    }
    let held = held(job);
    let bends = bends(job, bodies.space);
    // Where cells turn the strain is judged anyway.
    job.strains = !bends && job.deck.steps.iter().any(|s| s.nonlinear);
    for body in &bodies.all {
        let formulation = formulation(job, body);
        let group = sets.cells(bodies, &body.name, body.elements.iter().copied().collect());
        let mut regions: BTreeMap<String, Vec<u64>> = BTreeMap::new();
        for e in &body.elements {
            if let Some(m) = bodies.material.get(e) {
                let name = bodies.materials[*m].name.clone();
                regions.entry(name).or_default().push(*e);
            }
        }
        let alone = regions.len() == 1;
        let material = regions.keys().next().filter(|_| alone).cloned();
        regions.retain(|_, _| !alone);
        let regions = regions.into_iter().map(|(material, elements)| {
            let wanted = format!("{}-{material}", body.name);
            (sets.cells(bodies, &wanted, elements), material)
        });
        let regions = regions.collect();
        let rotation = if body.rigid.is_some() {
            BodyRotation::Small
        } else if turns_freely(job, &held, bodies.space, body) {
            let message = format!(
                "NLGEOM: body {} is held by nothing and may turn by any angle; its strains are taken as small",
                body.name
            );
            job.note(body.place, message);
            BodyRotation::Large
        } else if bends {
            BodyRotation::Corotational
        } else {
            BodyRotation::Small
        };
        let table = problem::Body {
            material,
            regions,
            rigid: body.rigid.is_some(),
            rotation,
            formulation,
            scale: 1.0,
            translate: None,
            rayleigh: damping(job, bodies, body),
            mesh: MeshSource::Gmsh(GmshFile {
                file: mesh_name.to_path_buf(),
                group: Some(group),
            }),
        };
        job.add(&body.name, body.place, table);
    }
}

/// Nodes that supports hold.
fn held(job: &Job) -> BTreeSet<u64> {
    let deck = job.deck;
    let actions = deck.steps.iter().flat_map(|s| &s.actions);
    let later = actions.filter_map(|action| match action {
        Action::Boundary(b) => Some(b),
        _ => None,
    });
    let all = deck.supports.iter().chain(later);
    all.flat_map(|b| job.nodes(&b.target)).collect()
}

/// Whether a body may turn by any angle: where motion is asked for with `NLGEOM`, and its points are not supported one by one or ties them to others.
fn turns_freely(job: &Job, held: &BTreeSet<u64>, space: Space, body: &Body) -> bool {
    let deck = job.deck;
    let moving = |s: &Step| s.nonlinear && s.is_dynamic();
    let joined = !deck.connectors.equations.is_empty()
        || !deck.connectors.couplings.is_empty()
        || !deck.connectors.constraints.is_empty()
        || !deck.connectors.springs.is_empty()
        || !deck.connectors.dashpots.is_empty()
        || !deck.connectors.gaps.is_empty()
        || !deck.connectors.pretensions.is_empty()
        || !deck.start.temperatures.is_empty()
        || !deck.connectors.ties.is_empty();
    let elements = body.elements.iter().filter_map(|e| deck.elements.get(e));
    let mut nodes = elements.flat_map(|e| &e.nodes);
    !deck.steps.is_empty()
        && deck.steps.iter().all(moving)
        && !joined
        && space != Space::Axisymmetric
        && deck.contact.pairs.iter().all(|p| !p.small_sliding)
        && nodes.all(|n| !held.contains(n))
}

/// Whether bodies turn and bend by any angle, held or not: where `NLGEOM` is asked for at rest. Says so, or why not.
fn bends(job: &mut Job, space: Space) -> bool {
    let deck = job.deck;
    let Some(first) = deck.steps.iter().find(|s| s.nonlinear && !s.is_dynamic()) else {
        return false;
    };
    let turns = |a: &Action| {
        matches!(
            a,
            Action::Distributed {
                load: Distributed::Centrifugal(..),
                ..
            }
        )
    };
    let at_rest = |s: &Step| matches!(s.procedure, Procedure::Static { .. }) && !s.perturbation;
    let reasons = [
        (!deck.steps.iter().all(at_rest), "a step is not *STATIC"),
        (space == Space::Axisymmetric, "elements are axisymmetric"),
        (
            !deck.start.temperatures.is_empty(),
            "there are temperatures",
        ),
        (
            deck.contact.pairs.iter().any(|p| p.small_sliding),
            "a pair slides by little (SMALL SLIDING)",
        ),
        (
            !deck.connectors.ties.is_empty(),
            "surfaces are tied where they lie at the start (*TIE)",
        ),
        (
            super::contact::ties_by_springs(deck),
            "surfaces are tied by springs where they lie at the start (TIED)",
        ),
        (
            deck.steps.iter().flat_map(|s| &s.actions).any(turns),
            "there are centrifugal forces",
        ),
    ];
    let message = match reasons.iter().find(|(applies, _)| *applies) {
        None => "NLGEOM: elements turn by any angle, each in a frame of its own in which its strains are taken as small; \
                 rotations of reference nodes are small. Where nothing turns, NLGEOM=NO is faster, and contact follows the surfaces all the same"
            .to_string(),
        Some((_, reason)) => {
            format!(
                "NLGEOM: rotations of the bodies are taken as small, as {reason}; contact follows the surfaces. Forces are wrong by about the strain, and by half the square of a rotation \
                 over the strain that it comes with: the run ends with exit code 2 where a body is strained or turns by more than a twentieth"
            )
        }
    };
    job.note(first.place, message);
    reasons.iter().all(|(applies, _)| !applies)
}

fn damping(job: &mut Job, bodies: &Bodies, body: &Body) -> Option<Rayleigh> {
    let deck = job.deck;
    let of = |e: &u64| {
        let s = &deck.properties.sections[*bodies.section.get(e)?];
        Some((
            deck.properties
                .materials
                .get(&s.material)?
                .damping
                .unwrap_or_default(),
            s.place,
        ))
    };
    let mut all = body.elements.iter().filter_map(of);
    let (first, place) = all.next()?;
    if all.any(|(d, _)| d != first) {
        job.error(
            place,
            format!(
                "the materials of the body {} have different damping",
                body.name
            ),
            "Rayleigh damping is that of a whole body",
        );
    }
    let [mass, stiffness] = first;
    (first != [0.0; 2]).then_some(Rayleigh { mass, stiffness })
}
