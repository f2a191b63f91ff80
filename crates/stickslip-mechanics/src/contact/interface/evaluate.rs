//! Evaluation of one contact point: where it meets the primary, what the laws answer, force and tangent.

use rayon::prelude::*;

use super::definition::Primary;
use super::evaluation::{Batch, EVALUATED_PER_TASK, Evaluation, Evaluations};
use super::on_facet::evaluate_facet;
use super::on_mortar::evaluate_mortar;
use super::on_obstacle::evaluate_rigid;
use super::scene::Scene;
use crate::contact::pairing::Anchor;

/// Evaluates a point.
fn evaluate(i: usize, scene: &Scene, anchor: &mut Option<Anchor>, batch: &mut Batch) -> Evaluation {
    let interface = scene.interface;
    let glued = interface.state.start.glued.get(i);
    let unglued = glued.is_some_and(|gap| gap.is_nan());
    let excluded = interface.conditions.candidates.excluded.get(i) == Some(&true);
    if unglued || excluded && !scene.wants.everywhere {
        return Evaluation::open(f64::INFINITY);
    }
    match &interface.primary {
        Primary::Rigid(shape, _) => evaluate_rigid(i, shape.as_dyn(), scene, batch),
        Primary::Facets(_) if interface.mortar.is_some() => evaluate_mortar(i, scene, batch),
        Primary::Facets(facets) => evaluate_facet(i, facets, scene, anchor, batch),
    }
}

/// Evaluates all points, chunk by chunk.
pub(super) fn evaluate_points(
    scene: &Scene,
    out: &mut Evaluations,
    anchors: &mut [Option<Anchor>],
) {
    out.points
        .par_chunks_mut(EVALUATED_PER_TASK)
        .zip(out.batches.par_iter_mut())
        .zip(anchors.par_chunks_mut(EVALUATED_PER_TASK))
        .enumerate()
        .for_each(|(chunk, ((points, batch), anchors))| {
            batch.clear();
            for (k, (e, anchor)) in points.iter_mut().zip(anchors).enumerate() {
                *e = evaluate(chunk * EVALUATED_PER_TASK + k, scene, anchor, batch);
            }
        });
}
