//! The interface as Newton's method sees it: the only place that scatters contact into residual and tangent.

use super::alone::{set_multipliers, stick_trials};
use super::augment::update_multipliers;
use super::axles::damp_axles;
use super::cache::Cache;
use super::candidates::{pair_reference, update_candidates};
use super::curvature::add_curvature;
use super::definition::InterfaceDefinition;
use super::evaluation::Evaluations;
use super::parts::InterfaceForce;
use super::pass::evaluate_all;
use super::scene::Wants;
use super::symptoms::{LastAttempt, culprit, culprits};
use crate::math::{add_scaled, larger, scale};
use crate::system::{
    ActiveSet, Assembler, Augmentation, ContactPair, Culprit, Force, Stage, StepFailure,
    StickTrial, Tally,
};

impl Force for InterfaceForce<'_> {
    fn prepare(&mut self, stage: &Stage) {
        if self.attempt.multipliers.len() != self.points.len() {
            self.begin_attempt();
        }
        let (definition, geometry) = (self.definition, &mut self.cache.geometry);
        pair_reference(definition, geometry);
        if definition.mortar.is_none() && !definition.kinematics.as_dyn().frozen() {
            definition.coordinates_into(definition.frames_at(stage), &stage.at.u, &mut geometry.x);
            update_candidates(definition, &mut geometry.search, &geometry.x);
        }
    }

    fn begin(&mut self) {
        self.begin_attempt();
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        let active = self.schedule.active(stage.at.t);
        if active {
            let wants = Wants {
                tangent: out.wants_tangent,
                surrogate: out.wants_surrogate,
                holds_turns: out.holds_turns,
                ..Wants::default()
            };
            let (input, cache) = self.parts();
            evaluate_all(input, cache, stage, wants);
            let points = &self.cache.trial.points;
            for (flips, e) in self.attempt.flips.iter_mut().zip(points) {
                flips.meets(e.foot.facet);
            }
        }
        let nothing = Evaluations::default();
        let Cache {
            trial,
            spatial,
            geometry,
            ..
        } = &mut *self.cache;
        let evaluations = if active { trial } else { &nothing };
        match self.definition.frames_at(stage).is_empty() {
            true => scatter(self.definition, evaluations, out),
            // As they act on points in space, and then on bodies and frames of bodies that turn.
            false => {
                spatial.begin_beside(out);
                scatter(self.definition, evaluations, spatial);
                geometry.in_space.assemble(spatial, out);
            }
        }
        match active {
            true => keep(self, out),
            false => {
                self.cache.last.points.clear();
                self.attempt.tentative = false;
            }
        }
        Ok(())
    }

    fn curve(&self, out: &mut Assembler) {
        let first = out.blocks.len();
        add_curvature(self.input(), self.cache, out);
        self.cache
            .geometry
            .in_space
            .blocks(&mut out.blocks[first..]);
    }

    fn damp_step(&self, b: &[f64], out: &mut Assembler) {
        damp_axles(
            self.definition,
            self.cache.geometry.in_space.frames(),
            b,
            out,
        );
    }

    fn settle(&mut self) {
        if self.attempt.tentative {
            self.attempt.tentative = false;
            if self.view().unknown() {
                self.cache.take_trial();
            }
            record(self);
        }
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        if !self.view().unknown() {
            return;
        }
        let last = &self.cache.last;
        let in_space = &self.cache.geometry.in_space;
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
        update_multipliers(self, stage)
    }

    fn alone(&mut self, stage: &Stage) -> Option<Vec<Option<StickTrial>>> {
        let (input, cache) = self.parts();
        stick_trials(input, cache, stage)
    }

    fn adopt(&mut self, forces: &[Option<[f64; 3]>]) {
        set_multipliers(self, forces);
    }

    fn tally(&self) -> Option<Tally> {
        Some(tried(self).tally())
    }

    fn diagnose(&self) -> Vec<Culprit> {
        culprits(tried(self))
    }

    fn place(&self, point: usize) -> Option<Culprit> {
        (point < self.points.len()).then(|| culprit(tried(self), point))
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
}

/// What it did in the present attempt.
fn tried<'a>(force: &'a InterfaceForce) -> LastAttempt<'a> {
    LastAttempt {
        interface: force.definition,
        attempt: force.attempt,
        cache: force.cache,
    }
}

/// Adds residual and tangent of all points, and tells which facets they meet.
fn scatter(definition: &InterfaceDefinition, evaluations: &Evaluations, out: &mut Assembler) {
    add_pairs(definition, evaluations, out);
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

/// Tells of all points that are points of the mesh and of the facets they meet, if that is wanted. Without evaluations they meet
/// none.
fn add_pairs(definition: &InterfaceDefinition, evaluations: &Evaluations, out: &mut Assembler) {
    if !out.wants_tangent || !out.wants_pairs {
        return;
    }
    for (i, point) in definition.points.iter().enumerate() {
        let Some(node) = point.node() else {
            continue;
        };
        let e = evaluations.points.get(i);
        let facet = e.filter(|e| e.over).map_or(Vec::new(), |e| {
            let sides = evaluations.batch(i).sides(e).iter();
            let met = sides.filter(|(n, _)| *n < definition.primary_nodes);
            met.map(|&(n, w)| (definition.nodes[n], -w)).collect()
        });
        let normal = e.map_or([0.0; 3], |e| e.frames.normal);
        out.pairs.push(ContactPair {
            point: definition.nodes[node],
            facet,
            normal: if normal == [0.0; 3] {
                point.normal
            } else {
                normal
            },
        });
    }
}

/// Keeps the trial for what comes next: where the iterate stays, its multiplier rows are needed until the step has been taken.
fn keep(interface: &mut InterfaceForce, out: &Assembler) {
    let pending = out.wants_tangent && out.tentative;
    interface.attempt.tentative = pending;
    let unknown = interface.view().unknown();
    let cache = &mut *interface.cache;
    if unknown && (pending || !out.wants_tangent) {
        for (kept, e) in cache.last.points.iter_mut().zip(&cache.trial.points) {
            kept.response = e.response;
            kept.gap = e.gap;
        }
    } else {
        cache.take_trial();
    }
    if out.wants_tangent && !out.tentative {
        record(interface);
    }
}

/// Makes the last evaluation the iterate from which Newton's method steps.
fn record(interface: &mut InterfaceForce) {
    let unknown = interface.view().unknown();
    let attempt = &mut *interface.attempt;
    let last = &interface.cache.last.points;
    attempt.before_first_contact = false;
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
            m.base = e.kept.multiplier;
            m.frame = e.frames.before;
            m.frame_normal = e.frames.normal_before;
        }
    }
}
