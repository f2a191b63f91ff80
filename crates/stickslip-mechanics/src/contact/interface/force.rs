//! The interface as Newton's method sees it: the only place that scatters contact into residual and tangent.

use super::axles::hold_axles;
use super::candidates::{pair_reference, update_candidates};
use super::evaluation::Evaluations;
use super::parts::Interface;
use super::scene::Wants;
use super::symptoms::culprits;
use crate::contact::response::Status;
use crate::math::{add_scaled, larger, scale};
use crate::system::{
    ActiveSet, Assembler, Augmentation, ContactPair, Culprit, Force, PointAlone, Stage,
    StepFailure, Tally,
};

impl Force for Interface {
    fn prepare(&mut self, stage: &Stage) {
        self.ready();
        self.glue(stage);
        let (definition, cache) = (&self.definition, &mut self.cache);
        pair_reference(definition, cache);
        if definition.mortar.is_none() && !definition.kinematics.as_dyn().frozen() {
            definition.coordinates_into(&stage.at.u, &mut cache.x);
            update_candidates(definition, &mut cache.search, &cache.x);
        }
    }

    fn begin(&mut self) {
        self.history.fit(self.points.len());
        self.begin_attempt();
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        match self.frames.is_empty() {
            true => self.assemble_in_space(stage, out),
            false => self.assemble_in_frames(stage, out),
        }
        Ok(())
    }

    fn curve(&self, out: &mut Assembler) {
        let first = out.blocks.len();
        self.add_curvature(&self.cache.last, out);
        self.cache.in_space.blocks(&mut out.blocks[first..]);
    }

    fn hold_back(&self, b: &[f64], out: &mut Assembler) {
        hold_axles(self, b, out);
    }

    fn settle(&mut self) {
        if std::mem::take(&mut self.attempt.tentative) {
            if self.view().unknown() {
                std::mem::swap(&mut self.cache.last, &mut self.cache.trial);
            }
            self.record();
        }
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        if !self.view().unknown() {
            return;
        }
        let last = &self.cache.last;
        let in_space = &self.cache.in_space;
        let multipliers = self.attempt.multipliers.iter_mut();
        for (i, (m, e)) in multipliers.zip(&last.points).enumerate() {
            let batch = last.batch(i);
            let (Some((_, shift)), Some(tangent)) = (e.saddle, batch.tangent(e)) else {
                continue;
            };
            let dofs = batch.dofs(e);
            // dl = -K_ll⁻¹ (r_l + K_lu du)
            let now: [f64; 3] = std::array::from_fn(|p| {
                let row = &tangent.change[p * dofs.len()..(p + 1) * dofs.len()];
                let moved = row.iter().zip(dofs);
                let along: f64 = moved.map(|(k, &dof)| k * in_space.moved(dof, du)).sum();
                m.base[p] - step * (shift[p] + along)
            });
            m.pressure = now[0];
            m.shear = add_scaled(scale(now[1], m.frame[0]), now[2], m.frame[1]);
            m.normal = m.frame_normal;
        }
    }

    fn augment(&mut self, stage: &Stage) -> Augmentation {
        self.update_multipliers(stage)
    }

    fn alone(&mut self, stage: &Stage) -> Option<Vec<Option<PointAlone>>> {
        self.points_alone(stage)
    }

    fn adopt(&mut self, forces: &[Option<[f64; 3]>]) {
        self.adopt_forces(forces);
    }

    fn commit(&mut self, stage: &Stage) {
        self.accept(stage);
    }

    fn tally(&self) -> Option<Tally> {
        let mut tally = Tally {
            changed: self.attempt.changed,
            ..Tally::default()
        };
        // Tied surfaces neither stick nor slip.
        let points = self.cache.last.points.iter().filter(|_| !self.laws.tied);
        for e in points {
            match e.response.status {
                Status::Open => tally.open += 1,
                Status::Stick => tally.stick += 1,
                Status::Slip => tally.slip += 1,
            }
        }
        Some(tally)
    }

    fn diagnose(&self) -> Vec<Culprit> {
        culprits(self)
    }

    fn place(&self, point: usize) -> Option<Culprit> {
        (point < self.points.len()).then(|| self.culprit(point))
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
}

/// Adds residual and tangent of all points.
fn scatter(evaluations: &Evaluations, out: &mut Assembler) {
    for (i, e) in evaluations.points.iter().enumerate() {
        let (batch, area) = (evaluations.batch(i), e.area);
        let dofs = batch.dofs(e);
        if !dofs.is_empty() {
            out.add_coupling(dofs);
        }
        let Some(force) = batch.force(e) else {
            continue;
        };
        out.add_residual(dofs, force);
        out.rounding += e.rounding * e.rounding;
        if let Some((rest, _)) = &e.saddle {
            let worst = rest.iter().fold(0.0, |m, r| larger(m, r.abs()));
            out.multiplier_residual = larger(out.multiplier_residual, worst * area);
        }
        if let Some(tangent) = batch.tangent(e) {
            if let Some((_, shift)) = e.saddle {
                out.add_condensed(dofs, tangent, shift);
            }
            out.add_tangent(dofs, tangent);
        }
    }
}

impl Interface {
    /// Residual and tangent as they act on bodies and frames of bodies that turn.
    fn assemble_in_frames(&mut self, stage: &Stage, out: &mut Assembler) {
        let mut spatial = std::mem::take(&mut self.cache.spatial);
        if spatial.residual.len() != out.residual.len() {
            spatial = Assembler::new(out.residual.len());
        }
        spatial.wants_surrogate = out.wants_surrogate;
        spatial.wants_pairs = out.wants_pairs;
        spatial.holds_turns = out.holds_turns;
        spatial.tentative = out.tentative;
        spatial.reset(out.wants_tangent);
        self.assemble_in_space(stage, &mut spatial);
        self.cache.in_space.assemble(&mut spatial, out);
        self.cache.spatial = spatial;
    }

    /// Residual and tangent as they act on points in space.
    fn assemble_in_space(&mut self, stage: &Stage, out: &mut Assembler) {
        if !self.schedule.active(stage.at.t) {
            self.cache.last.points.clear();
            self.attempt.tentative = false;
            self.add_pairs(&Evaluations::default(), out);
            return;
        }
        let wants = Wants {
            tangent: out.wants_tangent,
            surrogate: out.wants_surrogate,
            holds_turns: out.holds_turns,
            ..Wants::default()
        };
        let evaluations = self.evaluate_all(stage, wants);
        for (flips, e) in self.attempt.flips.iter_mut().zip(&evaluations.points) {
            flips.meets(e.facet);
        }
        self.add_pairs(&evaluations, out);
        scatter(&evaluations, out);
        let pending = out.wants_tangent && out.tentative;
        self.attempt.tentative = pending;
        // The multiplier rows of the last iterate are needed until the step has been taken.
        if self.view().unknown() && (pending || !out.wants_tangent) {
            for (kept, e) in (self.cache.last.points.iter_mut()).zip(&evaluations.points) {
                kept.response = e.response;
                kept.gap = e.gap;
            }
            self.cache.trial = evaluations;
        } else {
            self.cache.trial = std::mem::replace(&mut self.cache.last, evaluations);
        }
        if out.wants_tangent && !out.tentative {
            self.record();
        }
    }

    /// Tells of all points that are points of the mesh and of the facets they meet, if that is wanted. Without evaluations they meet
    /// none.
    fn add_pairs(&self, evaluations: &Evaluations, out: &mut Assembler) {
        if !out.wants_tangent || !out.wants_pairs {
            return;
        }
        for (i, point) in self.points.iter().enumerate() {
            let Some(node) = point.node() else {
                continue;
            };
            let e = evaluations.points.get(i);
            let facet = e.filter(|e| e.over).map_or(Vec::new(), |e| {
                let sides = evaluations.batch(i).sides(e).iter();
                let met = sides.filter(|(n, _)| *n < self.primary_nodes);
                met.map(|&(n, w)| (self.nodes[n], -w)).collect()
            });
            let normal = e.map_or([0.0; 3], |e| e.frames.normal);
            out.pairs.push(ContactPair {
                point: self.nodes[node],
                facet,
                normal: if normal == [0.0; 3] {
                    point.normal
                } else {
                    normal
                },
            });
        }
    }

    /// Makes the last evaluation the iterate from which Newton's method steps.
    fn record(&mut self) {
        let unknown = self.view().unknown();
        let attempt = &mut self.attempt;
        let last = &self.cache.last.points;
        attempt.never_in_contact = false;
        attempt.changed = 0;
        for (flips, e) in attempt.flips.iter_mut().zip(last) {
            attempt.changed += usize::from(flips.note(e.response.status));
            flips.slid(e);
            let over = e.over;
            flips.left += usize::from(flips.over && !over);
            flips.over = over;
        }
        if unknown {
            for (m, e) in attempt.multipliers.iter_mut().zip(last) {
                m.base = e.multiplier;
                m.frame = e.frames.before;
                m.frame_normal = e.frames.normal_before;
            }
        }
    }
}
