//! An evaluation of all points of an interface.

use super::candidates::enclose;
use rayon::prelude::*;

use super::cache::Cache;
use super::evaluation::{Batch, CHUNK, Evaluation, Evaluations};
use super::parts::Interface;
use super::scene::{LawQuery, Scene, Wants};
use crate::contact::pairing::Anchor;
use crate::math::scale;
use crate::system::{Force, InSpace, Stage};

impl Interface {
    /// Evaluates all points, in the memory of `trial`: whoever asks puts that back.
    pub(super) fn evaluate_all(&mut self, stage: &Stage, wants: Wants) -> Evaluations {
        self.lend(|interface, cache| interface.evaluate_with(cache, stage, wants))
    }

    fn evaluate_with(&self, cache: &mut Cache, stage: &Stage, wants: Wants) -> Evaluations {
        self.coordinates_into(&stage.at.u, &mut cache.x);
        self.coordinates_into(&stage.from.u, &mut cache.before);
        if !self.frames.is_empty() {
            let places = self.nodes.iter().copied().zip(cache.x.iter().copied());
            cache.in_space = InSpace::new(&self.frames, self.frame_poses(&stage.at.u), places);
        } else if !cache.in_space.is_empty() {
            cache.in_space = InSpace::default();
        }
        if self.mortar.is_some() {
            self.integrate(cache, wants);
        } else if !self.kinematics.as_dyn().frozen() {
            enclose(&self.definition, &cache.x, &mut cache.bounds);
        }
        let mut out = std::mem::take(&mut cache.trial);
        let mut anchors = std::mem::take(&mut cache.anchors);
        let count = self.points.len();
        anchors.resize(count, None);
        out.points.resize(count, Evaluation::default());
        out.batches
            .resize_with(count.div_ceil(CHUNK), Batch::default);
        let poses = self.poses(stage);
        let scene = Scene {
            cache,
            poses: poses.as_ref(),
            belt: self.belt_path(stage),
            belt_end: scale(stage.dt, self.belt_velocity(stage.at.t)),
            rate: stage.rate,
            dt: stage.dt,
            t: stage.at.t,
            wants,
            answers: &[],
            query: LawQuery::Nothing,
        };
        let answers = self.ask(&scene, &mut out, &mut anchors);
        let scene = Scene {
            answers: &answers,
            ..scene
        };
        self.evaluate_points(&scene, &mut out, &mut anchors);
        cache.anchors = anchors;
        out
    }

    pub(super) fn evaluate_points(
        &self,
        scene: &Scene,
        out: &mut Evaluations,
        anchors: &mut [Option<Anchor>],
    ) {
        let last = &scene.cache.last.points;
        out.points
            .par_chunks_mut(CHUNK)
            .zip(out.batches.par_iter_mut())
            .zip(anchors.par_chunks_mut(CHUNK))
            .enumerate()
            .for_each(|(chunk, ((points, batch), anchors))| {
                batch.clear();
                for (k, (e, anchor)) in points.iter_mut().zip(anchors).enumerate() {
                    let i = chunk * CHUNK + k;
                    *e = self.evaluate(i, scene, last.get(i), anchor, batch);
                }
            });
    }

    /// Gaps of all points at a stage, without touching the history; infinite where nothing lies opposite.
    pub fn gaps_at(&mut self, stage: &Stage) -> Vec<f64> {
        self.gaps_with(stage, Wants::default())
    }

    /// The same of all points, those too that do not take part.
    pub(super) fn all_gaps_at(&mut self, stage: &Stage) -> Vec<f64> {
        let wants = Wants {
            everywhere: true,
            ..Wants::default()
        };
        self.gaps_with(stage, wants)
    }

    fn gaps_with(&mut self, stage: &Stage, wants: Wants) -> Vec<f64> {
        self.prepare(stage);
        self.begin();
        let evaluations = self.evaluate_all(stage, wants);
        let gap = |e: &Evaluation| if e.over { e.gap } else { f64::INFINITY };
        let gaps = evaluations.points.iter().map(gap).collect();
        self.cache.trial = evaluations;
        gaps
    }
}
