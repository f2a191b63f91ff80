//! What an interface takes along from one attempt to the next beside its history: with both, another copy of it goes on with the same bits.

use super::attempt::Attempt;
use super::cache::Cache;
use super::candidates::{pair_reference, update_candidates};
use super::conditions::Conditions;
use super::definition::Primary;
use super::evaluation::{Evaluations, Trace};
use super::faces::integrate_faces;
use super::history::History;
use super::parts::Interface;
use super::scene::Wants;
use crate::contact::mortar::Merged;
use crate::math::Vec3;

/// What an interface takes along beside its [`History`](super::History).
///
/// Of the [`Cache`] it is the places for which facets were looked for last, as which facets a point may meet follows from them, and they are as old as the
/// search, not those of the accepted state; and of the last evaluation how fast tractions changed and which nodes
/// took part, by which explicit increments get their length. All else that is kept there is made for every evaluation, or is a function of the definition.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Memory {
    attempt: Attempt,
    conditions: Conditions,
    searched: Vec<Vec3>,
    faces_searched: Vec<Vec3>,
    /// Nodes of faces without a multiplier at the last evaluation.
    merged: Vec<Merged>,
    /// Of the last evaluation what the length of an explicit increment follows from.
    last: Vec<Trace>,
    /// Pairs or integrals of the reference configuration were made.
    paired: bool,
}

/// What it takes along beside its history.
pub fn memory(interface: &Interface, conditions: &Conditions) -> Memory {
    let Cache { last, geometry, .. } = &interface.cache;
    Memory {
        attempt: interface.attempt.clone(),
        conditions: conditions.clone(),
        searched: geometry.search.at().to_vec(),
        faces_searched: geometry.faces.at().to_vec(),
        merged: geometry.merged.nodes.clone(),
        last: last.traces(),
        paired: interface.kinematics.as_dyn().frozen()
            && !(geometry.frozen.is_empty() && geometry.integrals.is_empty()),
    }
}

/// Goes on with that, and what can be made again made again. Of an interface whose history is that of the memory, after an accepted increment that ended
/// with displacements `u`, those of increments that wait for their interiors too. The conditions of the memory are returned.
pub fn remember(
    interface: &mut Interface,
    state: &History,
    memory: Memory,
    u: &[f64],
) -> Conditions {
    let Memory {
        attempt,
        conditions,
        searched,
        faces_searched,
        merged,
        last,
        paired,
    } = memory;
    interface.attempt = attempt;
    interface.cache = Cache::default();
    let evaluated = !last.is_empty();
    interface.cache.last = Evaluations::of_traces(last);
    let mut interface = interface.force(state, &conditions);
    let (interface, Cache { geometry, .. }) = interface.parts();
    geometry.merged.nodes = merged;
    if paired {
        pair_reference(&interface, geometry);
        integrate_faces(interface, geometry, Wants::default());
    }
    if geometry.search.at() != searched.as_slice() {
        geometry.search = super::search::Search::default();
        update_candidates(&interface, &mut geometry.search, &searched);
    }
    // The weights of a mortar's points are those of the last evaluation.
    if interface.mortar.is_some() && !paired && evaluated {
        interface.coordinates_into(&interface.frames, u, &mut geometry.x);
        integrate_faces(interface, geometry, Wants::default());
    }
    // After the integrals, which look for facets anew where the last attempt did so far from `u`.
    if let (Some(mortar), Primary::Facets(facets)) = (&interface.mortar, &interface.primary)
        && !faces_searched.is_empty()
        && geometry.faces.at() != faces_searched.as_slice()
    {
        geometry.faces = super::search::FaceSearch::default();
        geometry.faces.renew(&mortar.faces, facets, &faces_searched);
    }
    conditions
}
