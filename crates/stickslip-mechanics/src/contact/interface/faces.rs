//! A mortar's integrals at a state: which facets its faces may meet, and the integrals over what they have in common.

use rayon::prelude::*;

use super::cache::{Geometry, MergedNodes};
use super::definition::{InterfaceDefinition, Primary};
use super::input::InterfaceInput;
use super::scene::Wants;
use super::search::{FACES_PER_TASK, FaceSearch};
use crate::contact::kinematics::of_points;
use crate::contact::mortar::{
    FACE_NODES, FaceIntegral, Merged, Scratch, Sides, correct, integrate, merged,
};
use crate::contact::symmetry::Across;
use crate::math::{Mat3, Vec3, identity};
use crate::system::Stage;

/// Integrates over all faces at the coordinates of the evaluation, along normals that have turned as the surface has, at the last accepted state where it
/// `holds_turns`; at that state where [`holds_integrals`] says so; over the reference configuration, once, where sliding is small.
pub(super) fn integrate_faces(interface: InterfaceInput, geometry: &mut Geometry, wants: Wants) {
    let (Some(mortar), Primary::Facets(facets)) = (&interface.mortar, &interface.primary) else {
        return;
    };
    let frozen = interface.kinematics.as_dyn().frozen();
    if frozen && !geometry.integrals.is_empty() {
        return;
    }
    let Geometry {
        x,
        before,
        faces,
        merged,
        integrals,
        integrated,
        ..
    } = geometry;
    match frozen {
        true => merge(interface, faces, merged, &interface.reference, &[]),
        // An attempt asks at one state for all of its iterations. After a restart those of the last attempt are known.
        false if !before.is_empty() => {
            let there = *integrated == *before;
            let found = if there { integrals.as_slice() } else { &[] };
            merge(interface, faces, merged, before, found);
        }
        false => {}
    }
    let reference = &interface.reference;
    let held = holds_integrals(&interface) && !before.is_empty();
    let x: &[Vec3] = match (frozen, held) {
        (true, _) => reference,
        (_, true) => before,
        _ => x,
    };
    if held && integrated.as_slice() == x {
        return;
    }
    let turned = if wants.holds_turns { &**before } else { x };
    let (before, turn): (&[Vec3], Mat3) = match frozen {
        true => (&[], identity()),
        false => {
            let turn = of_points(own_nodes(&interface), turned, reference, interface.dofs.dim);
            (before, across(&interface).turn(turn))
        }
    };
    // A face takes part as long as one of its points does. What is frozen must serve for ever.
    let excluded = &interface.conditions.candidates.excluded;
    let all = frozen || wants.everywhere || excluded.is_empty();
    let included = |points: &[usize]| all || points.iter().any(|&p| !excluded[p]);
    integrated.clear();
    if all && !frozen && std::ptr::eq(turned, x) {
        integrated.extend_from_slice(x);
    }
    faces.renew(&mortar.faces, facets, x);
    let mirrors = mirrors(&interface);
    let sides = Sides {
        x,
        before,
        reference,
        turn,
        facets,
        walls: interface.walls.of(facets, reference),
        mirrors: &mirrors,
        compliant: !interface.laws.needs_normal_stiffness(),
    };
    integrals.resize_with(mortar.faces.len(), FaceIntegral::default);
    merged.nodes.resize(mortar.faces.len(), Merged::default());
    mortar
        .faces
        .par_chunks(FACES_PER_TASK)
        .zip(integrals.par_chunks_mut(FACES_PER_TASK))
        .zip(faces.opposite.par_chunks(FACES_PER_TASK))
        .zip(merged.nodes.par_chunks(FACES_PER_TASK))
        .for_each(|(((faces, integrals), opposite), merged)| {
            let mut scratch = Scratch::default();
            let all = faces.iter().zip(integrals).zip(opposite).zip(merged);
            for (((face, integral), opposite), &merged) in all {
                if included(&face.points) {
                    integrate(face, merged, &sides, opposite, &mut scratch, integral);
                } else {
                    integral.clear();
                }
            }
        });
    if interface.dofs.dim == 3 {
        correct(&sides, &mortar.faces, integrals);
    }
}

/// Whether integrals are those of the accepted state in all iterations of an attempt, and turn with the surface from there: of tied surfaces, whose faces stay where they are on
/// each other. Integrals that were found anew in each iteration would follow a strain of rounding size wherever edges of both sides coincide, as pieces
/// between them come and go.
pub(super) fn holds_integrals(interface: &InterfaceDefinition) -> bool {
    interface.laws.tied && interface.mortar.is_some() && !interface.kinematics.as_dyn().frozen()
}

/// Integrates at an accepted state where that serves for the next attempt.
pub(super) fn integrate_accepted(
    interface: InterfaceInput,
    geometry: &mut Geometry,
    stage: &Stage,
) {
    if holds_integrals(&interface) {
        interface.coordinates_into(interface.frames_at(stage), &stage.at.u, &mut geometry.x);
        geometry.before.clone_from(&geometry.x);
        integrate_faces(interface, geometry, Wants::default());
    }
}

/// Finds the nodes without a multiplier, at coordinates `at`: those of the accepted state that an attempt starts from, as what is covered must not change
/// from iteration to iteration. `found` has the integrals over all faces at these coordinates, or is empty.
fn merge(
    interface: InterfaceInput,
    faces: &mut FaceSearch,
    known: &mut MergedNodes,
    at: &[Vec3],
    found: &[FaceIntegral],
) {
    let (Some(mortar), false) = (&interface.mortar, known.at == at) else {
        return;
    };
    let covered = covered(&interface, faces, at, found, &known.nodes);
    known.nodes = merged(&mortar.faces, &covered);
    known.at = at.to_vec();
}

/// By point of a mortar the part of its area that has the primary opposite, on the face on which that is most. One where pressure follows from the gap, so that no
/// constraint asks for a force, and where the faces around have no edge of the primary near. A face that was integrated at these coordinates with
/// a multiplier at each of its nodes is not integrated again: `known` has the integrals, or none, and `merged` the nodes that had no multiplier.
fn covered(
    interface: &InterfaceDefinition,
    search: &mut FaceSearch,
    at: &[Vec3],
    known: &[FaceIntegral],
    merged: &[Merged],
) -> Vec<f64> {
    let mut out = vec![1.0; interface.points.len()];
    let compliant = !interface.laws.needs_normal_stiffness();
    let (Some(mortar), Primary::Facets(facets), false) =
        (&interface.mortar, &interface.primary, compliant)
    else {
        return out;
    };
    let ends: Vec<bool> = (facets.iter())
        .map(|facet| facet.continues.iter().any(|c| !c))
        .collect();
    if !ends.contains(&true) {
        return out;
    }
    search.renew(&mortar.faces, facets, at);
    let turn = of_points(
        own_nodes(interface),
        at,
        &interface.reference,
        interface.dofs.dim,
    );
    let mirrors = mirrors(interface);
    let sides = Sides {
        x: at,
        before: &[],
        reference: &interface.reference,
        turn: across(interface).turn(turn),
        facets,
        walls: interface.walls.of(facets, &interface.reference),
        mirrors: &mirrors,
        compliant,
    };
    // A face without area was excluded, or nothing lay opposite: that is found anew.
    let area_of = |f: usize| {
        let area = known.get(f)?.area;
        let all_nodes = merged.get(f) == Some(&Merged::default());
        (all_nodes && sides.walls.is_empty() && area != [0.0; FACE_NODES]).then_some(area)
    };
    let faces = mortar.faces.par_iter().zip(&search.opposite).enumerate();
    let found: Vec<Option<[f64; FACE_NODES]>> = faces
        .map_init(
            || (Scratch::default(), FaceIntegral::default()),
            |(scratch, integral), (f, (face, opposite))| {
                opposite.iter().any(|&f| ends[f]).then(|| {
                    area_of(f).unwrap_or_else(|| {
                        integrate(face, Merged::default(), &sides, opposite, scratch, integral);
                        integral.area
                    })
                })
            },
        )
        .collect();
    for (part, around) in out.iter_mut().zip(&mortar.around) {
        let of = |&(f, a): &(usize, usize)| {
            found[f].map_or(1.0, |areas| areas[a] / mortar.faces[f].areas[a])
        };
        *part = around.iter().map(of).fold(0.0, f64::max);
    }
    out
}

/// Planes of symmetry on which both surfaces end: the axis across, and where they are along it.
fn mirrors(interface: &InterfaceDefinition) -> Vec<(usize, f64)> {
    let mut out: Vec<(usize, f64)> = Vec::new();
    for point in interface.points.iter().filter(|p| p.across.any()) {
        let x = interface.reference[point.nodes[0]];
        for c in (0..interface.dofs.dim).filter(|&c| point.across.0[c]) {
            if !out.contains(&(c, x[c])) {
                out.push((c, x[c]));
            }
        }
    }
    out
}

/// What the mean turn of the whole surface does not have, because it ends on planes of symmetry.
fn across(interface: &InterfaceDefinition) -> Across {
    let points = interface.points.iter().map(|p| p.across.0);
    Across(points.fold([false; 3], |all, p| std::array::from_fn(|c| all[c] || p[c])))
}

/// The nodes of the faces of a mortar, each as often as it has faces.
fn own_nodes(interface: &InterfaceDefinition) -> impl Iterator<Item = usize> + Clone {
    let faces = interface.mortar.iter().flat_map(|m| &m.faces);
    faces.flat_map(|face| face.nodes.iter().copied())
}
