//! The quality gate: figures by which accepted increments are judged, and their limits.

use std::collections::BTreeMap;

use serde::Serialize;

use super::limits::{GateMode, Limits};
use super::run::Simulation;
use super::summary::{InterfaceSummary, NumericalStiffness};
use crate::contact::interface::{Interface, Quality, Resultant};
use crate::math::norm;

/// The outcome of the quality gate.
#[derive(Debug, Clone, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Gate {
    /// What becomes of a figure above its limit.
    pub gate: GateMode,
    /// Whether all figures kept their limits.
    pub met: bool,
    /// The worst of each figure at each place.
    pub figures: Vec<Figure>,
    /// The largest forces of any body so far `[N]`.
    #[serde(skip)]
    pub(super) forces: f64,
    /// Of figures in motion: the largest violation so far, and the largest of what it is relative to.
    #[serde(skip)]
    so_far: BTreeMap<(&'static str, String), [f64; 2]>,
}

/// A figure at its worst.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Figure {
    /// Its name: the key of its limit in `[quality]`.
    pub figure: &'static str,
    /// Where: `interface NAME`, `body NAME` or `model`.
    pub place: String,
    /// Its largest value `[-]`.
    pub value: f64,
    /// The limit; `null` where it is not judged.
    pub limit: Option<f64>,
    /// Whether the value does not exceed it.
    pub met: bool,
    /// Time of the increment that it comes from `[s]`.
    pub time: f64,
}

impl Figure {
    /// Where, which, how much and how much too much.
    pub fn brief(&self) -> String {
        format!(
            "{}: {} is {:.2e}, above its limit {:.1e}",
            self.place,
            self.figure,
            self.value,
            self.limit.unwrap_or(f64::INFINITY)
        )
    }

    /// What is wrong and what may help, for a figure above its limit.
    pub fn sentence(&self) -> String {
        let (what, help) = match self.figure {
            "penetration-to-size" => (
                "surfaces penetrate by this part of the cell beneath",
                "raise the `factor` of the enforcement, or use enforcement.augmented-lagrangian",
            ),
            "penetration-to-approach" => (
                "surfaces penetrate by this part of the elastic approach, and forces are wrong by about as much",
                "raise the `factor` of the enforcement, or use enforcement.augmented-lagrangian",
            ),
            "false-slip" => (
                "points that stick have slipped by this part of the elastic approach",
                "raise the `factor` or `tangential-factor` of the enforcement, or use enforcement.augmented-lagrangian",
            ),
            "complementarity" => (
                "pressure bridges an open gap of this part of the cells",
                "lower `solver.tolerance` or the `error` of the enforcement",
            ),
            "oscillation" => (
                "this part of the pressure goes up and down from point to point",
                "choose the finer or softer surface as secondary, or match the meshes; forces may be right where pressures are not",
            ),
            "excess-shear" => (
                "the shear traction exceeds the limit of friction by this part",
                "lower `solver.tolerance`",
            ),
            "action-reaction" => (
                "the forces on the two sides differ by this part",
                "this should not happen: please report it",
            ),
            "moment" => (
                "the moments of the forces on the two sides differ by this part",
                "surfaces that slide far need kinematics other than small-sliding, and curved ones cells that are small beside the area in contact",
            ),
            "equilibrium" => (
                "forces and moments on the body are out of balance by this part",
                "lower `solver.tolerance`",
            ),
            _ => (
                "the balance of energies is open by this part",
                "take smaller increments, or add damping where bodies bounce",
            ),
        };
        format!(
            "{} (at time {:.4e}): {what}; {help}",
            self.brief(),
            self.time
        )
    }
}

impl Gate {
    /// The figures above their limits.
    pub fn violations(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|f| !f.met)
    }

    /// Whether the run has to end with an error.
    pub fn failed(&self) -> bool {
        self.gate == GateMode::Error && !self.met
    }

    pub(super) fn note(
        &mut self,
        figure: &'static str,
        place: &str,
        value: f64,
        limit: f64,
        time: f64,
    ) {
        // An infinite limit is none, and JSON has no infinity.
        let limit = limit.is_finite().then_some(limit);
        // What is not a number is above every limit.
        let met = limit.is_none_or(|limit| value <= limit);
        let known = self.figures.iter_mut();
        let mut same = known.filter(|f| f.figure == figure && f.place == place);
        match same.next() {
            Some(f) if value > f.value || !met && f.met => {
                f.value = value;
                f.time = time;
                f.met = met;
            }
            Some(_) => {}
            None => self.figures.push(Figure {
                figure,
                place: place.to_string(),
                value,
                limit,
                met,
                time,
            }),
        }
        self.met = self.figures.iter().all(|f| f.met);
    }

    /// The same for a figure in motion, where what it is relative to comes and goes: the largest violation so far is compared with the largest
    /// of that so far.
    pub(super) fn note_in_motion(
        &mut self,
        figure: &'static str,
        place: &str,
        [left, scale]: [f64; 2],
        limit: f64,
        time: f64,
    ) {
        let so_far = self.so_far.entry((figure, place.to_string()));
        let so_far = so_far.or_default();
        *so_far = [so_far[0].max(left), so_far[1].max(scale)];
        let value = ratio(so_far[0], so_far[1]);
        let known = self.figures.iter_mut();
        let mut same = known.filter(|f| f.figure == figure && f.place == place);
        if let Some(f) = same.next() {
            // What looked bad beside small forces may be nothing beside those that came later.
            f.value = 0.0;
            f.met = true;
        }
        self.note(figure, place, value, limit, time);
    }
}

/// How far the bodies have come nearer elastically `[m]`: `2 U / F`, at least the compression of one layer of cells.
fn approach(energy: f64, resultant: &Resultant, quality: &Quality) -> f64 {
    let whole = 2.0 * energy / resultant.total.max(f64::MIN_POSITIVE);
    whole.max(quality.layer)
}

/// Forces that move by less than this part of the size of the model do no work worth a balance.
const STILL: f64 = 1e-6;

fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 || scale <= 0.0 {
        0.0
    } else {
        value / scale
    }
}

impl Simulation {
    /// Elastic energy of bodies and compliant interfaces `[J]`.
    fn elastic_energy(&self) -> f64 {
        let interfaces = self.model.interfaces.iter();
        let compliant = interfaces.map(Interface::law_energy).sum::<f64>();
        self.summary.energy.strain + compliant
    }

    /// Judges the last accepted state.
    pub(super) fn judge_quality(&mut self, limits: &Limits) {
        let mut gate = std::mem::take(&mut self.summary.quality);
        gate.gate = limits.gate;
        if limits.gate != GateMode::Off {
            self.judge_interfaces(limits, &mut gate);
            if self.explicit.is_none() {
                self.judge_bodies(limits, &mut gate);
            }
        }
        gate.met = gate.figures.iter().all(|f| f.met);
        self.summary.quality = gate;
    }

    fn judge_interfaces(&self, limits: &Limits, gate: &mut Gate) {
        let t = self.state.t;
        let energy = self.elastic_energy();
        for interface in &self.model.interfaces {
            let q = interface.quality();
            let r = interface.resultant(&self.state.u);
            if r.total <= 0.0 {
                continue;
            }
            let place = format!("interface {}", interface.name);
            let mut note = |figure, value, limit| gate.note(figure, &place, value, limit, t);
            let approach = approach(energy, &r, &q);
            if !interface.on_springs() {
                note(
                    "penetration-to-size",
                    q.relative_to_size,
                    limits.penetration_to_size,
                );
                note("complementarity", q.complementarity, limits.complementarity);
                let (figure, limit) = ("penetration-to-approach", limits.penetration_to_approach);
                if self.motion.is_some() {
                    let pair = [q.penetration, approach];
                    gate.note_in_motion(figure, &place, pair, limit, t);
                } else {
                    note(figure, ratio(q.penetration, approach), limit);
                    let false_slip = ratio(q.false_slip, approach);
                    note("false-slip", false_slip, limits.false_slip);
                }
            }
            let mut note = |figure, value, limit| gate.note(figure, &place, value, limit, t);
            note("oscillation", q.oscillation, limits.oscillation);
            note("excess-shear", q.excess_shear, limits.excess_shear);
            let b = interface.balance(&self.state.u);
            if b.scale > 0.0 {
                note(
                    "action-reaction",
                    norm(b.force) / b.scale,
                    limits.action_reaction,
                );
                note(
                    "moment",
                    ratio(norm(b.moment), b.scale * b.size),
                    limits.moment,
                );
            }
        }
    }

    /// Judges the energy balance, once all is done.
    pub(super) fn judge_energy(&mut self, limits: &Limits) {
        if limits.gate == GateMode::Off || self.summary.increments == 0 {
            return;
        }
        let in_motion = self.model.moves().then_some(self.model.energy_limit);
        let limit = limits.energy.or(in_motion).unwrap_or(f64::INFINITY);
        let quality = &self.summary.energy_quality;
        // Where nothing happens there are no energies to compare with, but forces that have moved by their rounding.
        let least = STILL * self.model.mesh.diameter() * self.summary.quality.forces;
        let value = ratio(quality.largest, quality.scale.max(least));
        let t = self.state.t;
        self.summary
            .quality
            .note("energy", "model", value, limit, t);
    }
}

/// The interfaces at the last accepted state.
pub(super) fn interfaces(simulation: &Simulation) -> Vec<InterfaceSummary> {
    let energy = simulation.elastic_energy();
    let all = simulation.model.interfaces.iter();
    all.map(|interface| {
        let quality = interface.quality();
        let r = interface.resultant(&simulation.state.u);
        let b = interface.balance(&simulation.state.u);
        let strain = simulation.summary.energy.strain;
        let whole = 2.0 * strain / r.total.max(f64::MIN_POSITIVE);
        let factor = interface.numerical_factor();
        InterfaceSummary {
            name: interface.name.clone(),
            quality,
            relative_to_approach: ratio(quality.penetration, whole),
            action_reaction: ratio(norm(b.force), b.scale),
            moment: ratio(norm(b.moment), b.scale * b.size),
            numerical_stiffness: factor
                .filter(|_| energy > 0.0)
                .map(|factor| NumericalStiffness {
                    factor,
                    independent_to: quality.violation_work / (2.0 * energy),
                }),
        }
    })
    .collect()
}
