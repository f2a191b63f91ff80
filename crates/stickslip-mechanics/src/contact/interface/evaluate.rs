//! Evaluation of one contact point: where it meets the primary, what the laws answer, force and tangent.

use super::definition::Primary;
use super::evaluation::{Batch, Evaluation};
use super::parts::Interface;
use super::scene::Scene;
use crate::contact::pairing::Anchor;

/// A point whose stencil is made: the area it stands for, and where its nodes begin among those of the batch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    pub i: usize,
    pub area: f64,
    pub sides: usize,
}

impl Interface {
    /// A point, which at the evaluation before, in this attempt, was `last`.
    pub(super) fn evaluate(
        &self,
        i: usize,
        scene: &Scene,
        last: Option<&Evaluation>,
        anchor: &mut Option<Anchor>,
        batch: &mut Batch,
    ) -> Evaluation {
        let glued = self.history.start.glued.get(i);
        let unglued = glued.is_some_and(|gap| gap.is_nan());
        let excluded = self.directives.excluded.get(i) == Some(&true);
        if unglued || excluded && !scene.wants.everywhere {
            return Evaluation::open(f64::INFINITY);
        }
        match &self.primary {
            Primary::Rigid(shape, _) => self.evaluate_rigid(i, shape.as_dyn(), scene, batch),
            Primary::Facets(_) if self.mortar.is_some() => self.evaluate_mortar(i, scene, batch),
            Primary::Facets(facets) => self.evaluate_facet(i, facets, scene, last, anchor, batch),
        }
    }
}
