//! The interface as a force: the only place that scatters contact into residual and tangent.

mod between;
mod change;
mod cone;
mod continuation;
mod curvature;
mod evaluate;
mod faces;
mod meeting;
mod oscillation;
mod own;
mod quality;
mod reach;
mod report;
mod resolution;
mod sides;
mod spacing;
mod springs;
mod start;
mod steady;
mod symptoms;
mod turned;
mod turning;
mod work;

#[cfg(test)]
mod objective;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

pub use between::Between;
pub use change::Change;
pub use meeting::Meeting;
pub use oscillation::neighbours;
pub use quality::{Balance, Quality};
pub use reach::Reach;
pub use report::Resultant;
pub use resolution::Resolution;
pub use sides::WearReport;
pub use start::{CLOSE, GLUE, Initial, Start, Within};

use super::enforcement::Multipliers;
use super::kinematics::{KinematicsModel, carried_over};
use super::mortar::{FaceIntegral, Mortar};
use super::obstacle::{Motion, ObstacleShape, Pose};
use super::pairing::FacetPoint;
use super::response::{Laws, Status};
use super::search::{Box3, Tree};
use super::surface::{ContactPoint, Facet, Skin};
use crate::math::{Vec3, add, add_scaled, distance, dot, mat_vec, scale};
use crate::system::{
    ActiveSet, Assembler, Augmentation, ContactPair, Continuation, Culprit, Dofs, Energy, Fields,
    Force, Schedule, Stage, StepFailure, Tally,
};
use evaluate::{Anchor, Batch, Evaluation, components};
use steady::Steady;

/// What the secondary touches.
#[derive(Debug, Clone)]
pub enum Primary {
    /// Facets of a body; node indices are local to the interface.
    Facets(Vec<Facet>),
    /// A rigid obstacle and its motion.
    Rigid(ObstacleShape, Motion),
}

/// The data of an interface. Node indices in points and facets are positions in `nodes`.
#[derive(Debug, Clone)]
pub struct Interface {
    /// Name in the problem file.
    pub name: String,
    /// Numbering of the unknowns.
    pub dofs: Dofs,
    /// Mesh points of both sides.
    pub nodes: Vec<usize>,
    /// How many of them, the first, are those of the primary.
    pub primary_nodes: usize,
    /// Their user's numbers.
    pub node_ids: Vec<u64>,
    /// The place in space from which all coordinates of the interface are counted, those of an obstacle too `[m]`: near enough that gaps, which are
    /// differences of coordinates, do not lose their digits where a model lies far from where the user counts from.
    pub origin: Vec3,
    /// Their reference coordinates.
    pub reference: Vec<Vec3>,
    /// Points of the secondary.
    pub points: Vec<ContactPoint>,
    /// The secondary as faces, where gaps are weighted over them; `None` where they are those of the points themselves.
    pub mortar: Option<Mortar>,
    /// The faces of the secondary, to be looked at between points; empty where nobody asks.
    pub skin: Vec<Skin>,
    /// For each of the points the others beside it, see [`neighbours`]; empty where nobody asks how smooth the pressure is.
    pub neighbours: Vec<Vec<usize>>,
    /// What they touch.
    pub primary: Primary,
    /// Part of the pressure that this interface carries: a half where the other surface is secondary in another one.
    pub share: f64,
    /// The points are those of the side that the problem calls primary, because its cells are smaller. What is reported of forces, slip and normals
    /// is that of the sides as they are named.
    pub exchanged: bool,
    /// Normal law, friction, slip rule, enforcement.
    pub laws: Laws,
    /// How gap and slip are measured.
    pub kinematics: KinematicsModel,
    /// Velocity of the primary surface beyond the motion of its body, U_T^C, as rows of `[time, vx, vy, vz]` `[m/s]`.
    pub belt: Vec<[f64; 4]>,
    /// When it acts.
    pub schedule: Schedule,
    /// How far a point may lie beyond the outer edge of the primary and still be carried, relative to the facet.
    pub edge_tolerance: f64,
    /// What becomes of the gaps of the meshes.
    pub initial: Initial,
    /// Histories and the last evaluation; `Memory::default()` to start with.
    pub memory: Memory,
}

/// What an interface remembers.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    committed: Vec<History>,
    multipliers: Vec<Multiplier>,
    last: Evaluations,
    /// Memory for the next evaluation, and coordinates at it and at the last accepted state.
    trial: Evaluations,
    x: Vec<Vec3>,
    before: Vec<Vec3>,
    boxes: Vec<Box3>,
    anchors: Vec<Option<Anchor>>,
    flips: Vec<Flips>,
    candidates: Vec<Vec<usize>>,
    searched_at: Vec<Vec3>,
    margin: f64,
    frozen: Vec<Option<(usize, FacetPoint)>>,
    /// Facets that a face of a mortar may meet, and the coordinates for which they were found.
    opposite: Vec<Vec<usize>>,
    opposite_at: Vec<Vec3>,
    /// Integrals over the faces of a mortar.
    integrals: Vec<FaceIntegral>,
    /// Tied surfaces: distances that stay, NaN where nothing near lies opposite.
    glued: Vec<f64>,
    dissipated: f64,
    /// Sum of area times `rubbed` over all points and increments `[N m]`.
    rubbed: f64,
    /// Forces on the nodes at the last accepted state `[N]`; empty before there was one.
    nodal: Vec<Vec3>,
    /// Dissipated energy and `rubbed` per area at the nodes of the primary, by node; empty before anything slid.
    traces: Vec<[f64; 2]>,
    belt_work: f64,
    damped: f64,
    /// See [`Energy::path`], [`Energy::uncertain`] and [`Energy::excess`].
    path: f64,
    uncertain: f64,
    excess: f64,
    /// Recoverable energy at the last accepted state `[J]`.
    stored: f64,
    /// Force, and moment about the centre of rotation, with which a moving obstacle pushed then.
    pushed: [Vec3; 2],
    /// Largest velocity of slip below the limit over the last increment.
    creep: f64,
    /// Whether the shear is what friction says.
    cone: cone::Cone,
    changed: usize,
    /// The last evaluation, a tentative one, may become the next iterate.
    pending: bool,
    /// Nothing has been in contact yet, and this is the first tangent of the attempt.
    untouched: bool,
    /// Explicit dynamics: springs, whatever the enforcement.
    explicit: bool,
    /// Gaps at which springs that replace multipliers carry nothing `[m]`; empty where all of them are zero.
    rest: Vec<f64>,
    /// Gap that multipliers leave as it is where a point stays in contact `[m]`.
    accepted: f64,
    /// Mass per area behind each point `[kg/m²]`; empty where it plays no part.
    inertia: Vec<f64>,
    softening: Option<f64>,
    /// Part of the limit of friction that acts; `None`: all of it.
    mobilised: Option<f64>,
    /// How often the stiffness of the enforcement has been raised tenfold in this attempt, and the violation after the round before.
    tightened: u32,
    violation: Option<f64>,
    steady: Steady,
    /// Outward normals when it was last searched, by point; empty where those of the reference serve.
    facing: Vec<Vec3>,
    /// Points that do not take part; empty where all do.
    asleep: Vec<bool>,
    /// Points within the part of the reach in which contact is expected to stay.
    inner: Vec<bool>,
}

/// An evaluation of all points.
#[derive(Debug, Clone, Default)]
struct Evaluations {
    points: Vec<Evaluation>,
    batches: Vec<Batch>,
}

impl Evaluations {
    /// The numbers of a point.
    fn batch(&self, i: usize) -> &Batch {
        &self.batches[i / CHUNK]
    }
}

/// What is asked of an evaluation.
#[derive(Debug, Clone, Copy, Default)]
struct Wants {
    tangent: bool,
    surrogate: bool,
    /// See [`Assembler`].
    holds_turns: bool,
    /// See [`evaluate::Scene`].
    initial: bool,
}

/// Committed history of a contact point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct History {
    pressure: f64,
    /// Shear traction on the secondary.
    shear: Vec3,
    /// Accumulated slip of the secondary over the primary.
    slip: Vec3,
    gap: f64,
    normal: Vec3,
    status: Status,
    facet: Option<usize>,
    /// Area that the point stands for.
    area: f64,
    /// The part of the pressure that damping added.
    damping: f64,
    /// Energy that friction has dissipated here `[J/m²]`.
    dissipated: f64,
    /// Pressure times path of sliding, accumulated: `∫ p |ds|` `[Pa m]`.
    rubbed: f64,
    /// The largest shear traction that could be carried `[Pa]`.
    limit: f64,
    /// Elastic energy of the spring that sticks `[J/m²]`.
    sheared: f64,
}

/// Multipliers of a contact point in the current attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Multiplier {
    pressure: f64,
    shear: Vec3,
    /// The normal it is perpendicular to; zero where that is not known.
    normal: Vec3,
    /// What an augmented Lagrangian pulls them to: the estimate of the last round.
    centre_pressure: f64,
    centre_shear: Vec3,
    centre_normal: Vec3,
    /// The same as components, at the last tangent: Newton steps from here.
    base: [f64; 3],
    frame: [Vec3; 2],
    frame_normal: Vec3,
}

/// Status changes of a point over the iterations of an attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Flips {
    count: usize,
    /// The last statuses that differ from the one before, latest first.
    last: [Option<Status>; 4],
    /// Whether it lay over the primary, and how often it has slid off its outer edge.
    over: bool,
    left: usize,
    /// It has been put back onto the primary.
    returned: bool,
}

impl Flips {
    /// Takes note of the status after an iteration; whether it has changed.
    fn note(&mut self, now: Status) -> bool {
        if self.last[0] == Some(now) {
            return false;
        }
        let changed = self.last[0].is_some();
        self.count += usize::from(changed);
        self.last.rotate_right(1);
        self.last[0] = Some(now);
        changed
    }
}

/// Part of a violation that an update of the multipliers may leave before the enforcement is tightened.
const GAIN: f64 = 0.1;

/// Cosine of the angle up to which a surface looks where it looked in the reference configuration, for finding facets that look back.
const UNTURNED: f64 = 0.95;

/// Contact points evaluated by one task. Fixed, so that no number depends on how many threads there are.
const CHUNK: usize = 16;

impl Interface {
    /// Reference coordinates plus displacement of the nodes of the interface.
    fn coordinates(&self, u: &[f64]) -> Vec<Vec3> {
        let mut out = Vec::new();
        self.coordinates_into(u, &mut out);
        out
    }

    fn coordinates_into(&self, u: &[f64], out: &mut Vec<Vec3>) {
        out.clear();
        let nodes = self.nodes.iter().zip(&self.reference);
        out.extend(nodes.map(|(&node, &x)| add(x, self.dofs.vector(u, node))));
    }

    /// Tells the masses of the points of the mesh `[kg]`, zero for those that have none; an empty list where inertia plays no part.
    pub fn set_masses(&mut self, by_point: &[f64]) {
        let mass = |p: &ContactPoint| -> f64 {
            let nodes = p.nodes.iter().zip(&p.weights);
            nodes
                .map(|(&node, w)| w * by_point.get(self.nodes[node]).copied().unwrap_or(0.0))
                .sum::<f64>()
                .max(0.0)
        };
        self.memory.inertia = self.points.iter().map(|p| mass(p) / p.area).collect();
    }

    /// How stiffly the bodies resist at a point `[Pa/m]`: the cell beneath, and over an increment of length `moving` its mass, a tenth of
    /// what the trapezoidal rule makes of it. More would turn the rounding of gaps into pressure where supports hold a body already.
    fn own_stiffness(&self, i: usize, moving: Option<f64>) -> f64 {
        let inertia = self.memory.inertia.get(i).copied().unwrap_or(0.0);
        let inertia = moving.map_or(0.0, |dt| 0.4 * inertia / (dt * dt));
        self.points[i].stiffness + inertia
    }

    /// The gap that an augmented Lagrangian may leave, by half: the part `error` of the elastic approach of the last accepted state.
    fn accepted(&self) -> f64 {
        let Multipliers::Augmented { error } = self.laws.enforcement.as_dyn().multipliers() else {
            return 0.0;
        };
        if !self.laws.needs_normal_stiffness() {
            return 0.0;
        }
        let points = self.points.iter().zip(&self.memory.committed);
        let approach = points.map(|(p, h)| h.pressure.abs() / p.stiffness);
        0.5 * error * approach.fold(0.0, f64::max)
    }

    /// Whether multipliers are unknowns of the present attempt.
    fn unknown(&self) -> bool {
        self.laws.unknown_multipliers() && !self.memory.explicit
    }

    /// Velocity of the belt.
    fn belt_velocity(&self, t: f64) -> Vec3 {
        if self.belt.is_empty() {
            return [0.0; 3];
        }
        std::array::from_fn(|i| {
            let table = self.belt.iter().map(|row| [row[0], row[i + 1]]).collect();
            crate::system::Amplitude::new(table).map_or(0.0, |v| v.at(t))
        })
    }

    /// Belt displacement over the increment; exact, as increments land on the rows of its table.
    fn belt_path(&self, stage: &Stage) -> Vec3 {
        let sum = add(
            self.belt_velocity(stage.from.t),
            self.belt_velocity(stage.at.t),
        );
        scale(0.5 * stage.dt, sum)
    }

    /// Adds the forces that the laws ask for at `stage.at` to the residual, before anything is solved and without touching the
    /// history: for the acceleration at the start.
    pub fn add_initial(&mut self, stage: &Stage, residual: &mut [f64]) -> Result<(), StepFailure> {
        if !self.schedule.active(stage.at.t) {
            return Ok(());
        }
        self.prepare(stage);
        self.begin();
        let evaluations = self.evaluate_all(
            stage,
            Wants {
                initial: true,
                ..Wants::default()
            },
        );
        for (i, e) in evaluations.points.iter().enumerate() {
            let batch = evaluations.batch(i);
            let force = batch.force(e).unwrap_or_default();
            for (&dof, r) in batch.dofs(e).iter().zip(force) {
                residual[dof] += r;
            }
        }
        self.memory.trial = evaluations;
        Ok(())
    }

    /// Takes the tractions of an attempt, by what it remembered, as those of the last accepted state: what acts from the first instant of a motion. Where
    /// a point sticks, what the others carry is only being built up, and all is left as it is.
    pub fn adopt(&mut self, tried: &Memory) {
        let points = &tried.last.points;
        if points.iter().any(|e| e.response.status == Status::Stick) {
            return;
        }
        let all = self.memory.committed.iter_mut().zip(points);
        for (history, e) in all.filter(|(_, e)| e.response.status == Status::Slip) {
            history.pressure = e.response.traction[0];
            history.shear = e.along(&e.frame);
        }
    }

    /// Whether a point touched or was near at the last evaluation, by the height of the cell beneath it.
    pub fn touches(&self) -> bool {
        let points = self.memory.trial.points.iter().zip(&self.points);
        let mut points =
            points.map(|(e, point)| e.over && e.gap <= evaluate::TOUCHING * point.size);
        points.any(|touching| touching)
    }

    fn poses(&self, stage: &Stage) -> Option<(Pose, Pose)> {
        match &self.primary {
            Primary::Rigid(_, motion) => Some((motion.pose(stage.at.t), motion.pose(stage.from.t))),
            Primary::Facets(_) => None,
        }
    }

    fn ready(&mut self) {
        let n = self.points.len();
        if self.memory.committed.len() != n {
            self.memory.committed = vec![History::default(); n];
            self.memory.multipliers = vec![Multiplier::default(); n];
            self.memory.flips = vec![Flips::default(); n];
        }
    }

    /// Searches anew when the points have moved so far that a nearer facet might be missing from the candidates.
    fn search(&mut self, x: &[Vec3]) {
        let Primary::Facets(facets) = &self.primary else {
            return;
        };
        let memory = &mut self.memory;
        let moved = memory
            .searched_at
            .iter()
            .zip(x)
            .map(|(&a, &b)| distance(a, b))
            .fold(0.0, f64::max);
        if memory.searched_at.len() == x.len() && moved <= 0.25 * memory.margin {
            return;
        }
        let size = |f: &Facet| distance(x[f.nodes[0]], x[f.nodes[1]]);
        // Curved facets leave the boxes of their nodes by a part of their size. Flat ones do not, and where a mesh is graded the longest of them
        // would bring in far too many of the small ones.
        let curved = |f: &Facet| f.kind.order() > 1;
        memory.margin = if facets.iter().any(curved) {
            facets.iter().map(size).fold(0.0, f64::max)
        } else {
            facets.iter().map(size).sum::<f64>() / facets.len().max(1) as f64
        };
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        memory.candidates.resize(self.points.len(), Vec::new());
        let margin = memory.margin;
        self.points
            .par_chunks(CHUNK)
            .zip(memory.candidates.par_chunks_mut(CHUNK))
            .for_each(|(points, candidates)| {
                for (point, candidates) in points.iter().zip(candidates) {
                    tree.near(point.position(x), margin, candidates);
                }
            });
        memory.searched_at.clear();
        memory.searched_at.extend_from_slice(x);
        self.memory.facing = self.facing(x);
    }

    /// Outward normals of the contact points that have turned far since the reference configuration, by their faces; empty if none has.
    fn facing(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut around = vec![Vec::new(); self.points.len()];
        for skin in &self.skin {
            let corners = &skin.facet.nodes[..skin.facet.kind.corner_count()];
            for &p in &skin.points {
                around[p].push((corners, 1.0));
            }
        }
        let turned = |(point, around): (&ContactPoint, &Vec<turning::Part>)| {
            let parts = around.iter().copied();
            let turn = turning::rotation_of(parts, (x, &self.reference), self.dofs.dim);
            mat_vec(&turn, point.normal)
        };
        let normals: Vec<Vec3> = self.points.iter().zip(&around).map(turned).collect();
        let mut pairs = normals.iter().zip(&self.points);
        match pairs.any(|(n, p)| dot(*n, p.normal) < UNTURNED) {
            true => normals,
            false => Vec::new(),
        }
    }

    /// Pairs in the reference configuration, for small sliding.
    fn freeze(&mut self) {
        if self.mortar.is_some()
            || !self.kinematics.as_dyn().frozen()
            || !self.memory.frozen.is_empty()
        {
            return;
        }
        let x = self.reference.clone();
        self.search(&x);
        let mut boxes = Vec::new();
        self.enclose(&x, &mut boxes);
        self.memory.frozen = (0..self.points.len())
            .map(|i| self.closest(i, &x, &boxes, None, None).ok())
            .collect();
    }

    /// Boxes around the facets.
    fn enclose(&self, x: &[Vec3], out: &mut Vec<Box3>) {
        out.clear();
        if let Primary::Facets(facets) = &self.primary {
            let around = |f: &Facet| Box3::around(f.kind, f.nodes.iter().map(|&n| x[n]));
            out.extend(facets.iter().map(around));
        }
    }

    /// Evaluates all points, in the memory of `trial`: whoever asks puts that back.
    fn evaluate_all(&mut self, stage: &Stage, wants: Wants) -> Evaluations {
        let memory = &mut self.memory;
        let mut out = std::mem::take(&mut memory.trial);
        let mut x = std::mem::take(&mut memory.x);
        let mut before = std::mem::take(&mut memory.before);
        let mut boxes = std::mem::take(&mut memory.boxes);
        let mut anchors = std::mem::take(&mut memory.anchors);
        self.coordinates_into(&stage.at.u, &mut x);
        self.coordinates_into(&stage.from.u, &mut before);
        if self.mortar.is_some() {
            let turned = if wants.holds_turns { &before } else { &x };
            self.integrate(&x, turned);
        } else if !self.kinematics.as_dyn().frozen() {
            self.enclose(&x, &mut boxes);
        }
        let integrals = std::mem::take(&mut self.memory.integrals);
        let poses = self.poses(stage);
        let scene = evaluate::Scene {
            x: &x,
            before: &before,
            boxes: &boxes,
            integrals: &integrals,
            poses: poses.as_ref(),
            belt: self.belt_path(stage),
            belt_end: scale(stage.dt, self.belt_velocity(stage.at.t)),
            rate: stage.rate,
            dt: stage.dt,
            t: stage.at.t,
            tangent: wants.tangent,
            surrogate: wants.surrogate,
            initial: wants.initial,
            told: &[],
            asking: evaluate::Asking::Nothing,
        };
        let count = self.points.len();
        anchors.resize(count, None);
        out.points.resize(count, Evaluation::default());
        out.batches
            .resize_with(count.div_ceil(CHUNK), Batch::default);
        let told = self.ask(&scene, &mut out, &mut anchors);
        let scene = evaluate::Scene {
            told: &told,
            ..scene
        };
        self.evaluate_points(&scene, &mut out, &mut anchors);
        let memory = &mut self.memory;
        memory.x = x;
        memory.before = before;
        memory.boxes = boxes;
        memory.integrals = integrals;
        memory.anchors = anchors;
        out
    }

    fn evaluate_points(
        &self,
        scene: &evaluate::Scene,
        out: &mut Evaluations,
        anchors: &mut [Option<Anchor>],
    ) {
        let last = &self.memory.last.points;
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
}

impl Interface {
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
            let normal = e.map_or([0.0; 3], |e| e.normal);
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
        let unknown = self.unknown();
        let memory = &mut self.memory;
        let last = &memory.last.points;
        memory.untouched = false;
        memory.changed = 0;
        for (flips, e) in memory.flips.iter_mut().zip(last) {
            memory.changed += usize::from(flips.note(e.response.status));
            let over = e.over;
            flips.left += usize::from(flips.over && !over);
            flips.over = over;
        }
        memory.steady.note(last);
        if unknown {
            for (m, e) in memory.multipliers.iter_mut().zip(last) {
                m.base = e.multiplier;
                m.frame = e.frame_before;
                m.frame_normal = e.normal_before;
            }
        }
    }
}

impl Force for Interface {
    fn prepare(&mut self, stage: &Stage) {
        self.ready();
        self.glue(stage);
        self.freeze();
        if self.mortar.is_none() && !self.kinematics.as_dyn().frozen() {
            let mut x = std::mem::take(&mut self.memory.x);
            self.coordinates_into(&stage.at.u, &mut x);
            self.search(&x);
            self.memory.x = x;
        }
    }

    fn begin(&mut self) {
        self.ready();
        self.memory.accepted = self.accepted();
        let memory = &mut self.memory;
        for (m, h) in memory.multipliers.iter_mut().zip(&memory.committed) {
            *m = Multiplier {
                pressure: h.pressure,
                shear: h.shear,
                normal: h.normal,
                centre_pressure: h.pressure,
                centre_shear: h.shear,
                centre_normal: h.normal,
                ..Multiplier::default()
            };
        }
        memory.flips.fill(Flips::default());
        memory.steady.clear();
        memory.tightened = 0;
        memory.violation = None;
        memory.last.points.clear();
        memory.pending = false;
        memory.untouched = memory.committed.iter().all(|h| h.status == Status::Open);
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        if !self.schedule.active(stage.at.t) {
            self.memory.last.points.clear();
            self.memory.pending = false;
            self.add_pairs(&Evaluations::default(), out);
            return Ok(());
        }
        let evaluations = self.evaluate_all(
            stage,
            Wants {
                tangent: out.wants_tangent,
                surrogate: out.wants_surrogate,
                holds_turns: out.holds_turns,
                initial: false,
            },
        );
        self.add_pairs(&evaluations, out);
        let unknown = self.unknown();
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
                let worst = rest.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
                out.multiplier_residual = out.multiplier_residual.max(worst * area);
                out.multiplier_merit += rest.iter().map(|r| (r * area).powi(2)).sum::<f64>();
            }
            if let Some(tangent) = batch.tangent(e) {
                if let Some((_, shift)) = e.saddle {
                    out.add_condensed(dofs, tangent, shift);
                }
                out.add_tangent(dofs, tangent);
            }
        }
        self.add_curvature(&evaluations, out);
        let memory = &mut self.memory;
        memory.pending = out.wants_tangent && out.tentative;
        // The multiplier rows of the last iterate are needed until the step has been taken.
        if unknown && (memory.pending || !out.wants_tangent) {
            for (kept, e) in memory.last.points.iter_mut().zip(&evaluations.points) {
                kept.response = e.response;
                kept.gap = e.gap;
            }
            memory.trial = evaluations;
        } else {
            memory.trial = std::mem::replace(&mut memory.last, evaluations);
        }
        if out.wants_tangent && !out.tentative {
            self.record();
        }
        Ok(())
    }

    fn settle(&mut self) {
        let unknown = self.unknown();
        let memory = &mut self.memory;
        if std::mem::take(&mut memory.pending) {
            if unknown {
                std::mem::swap(&mut memory.last, &mut memory.trial);
            }
            self.record();
        }
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        if !self.unknown() {
            return;
        }
        let memory = &mut self.memory;
        let last = &memory.last;
        for (i, (m, e)) in memory.multipliers.iter_mut().zip(&last.points).enumerate() {
            let batch = last.batch(i);
            let (Some((_, shift)), Some(tangent)) = (e.saddle, batch.tangent(e)) else {
                continue;
            };
            let dofs = batch.dofs(e);
            // dl = -K_ll⁻¹ (r_l + K_lu du)
            let now: [f64; 3] = std::array::from_fn(|p| {
                let row = &tangent.change[p * dofs.len()..(p + 1) * dofs.len()];
                let along: f64 = row.iter().zip(dofs).map(|(k, &dof)| k * du[dof]).sum();
                m.base[p] - step * (shift[p] + along)
            });
            m.pressure = now[0];
            m.shear = add_scaled(scale(now[1], m.frame[0]), now[2], m.frame[1]);
            m.normal = m.frame_normal;
        }
    }

    fn augment(&mut self, stage: &Stage) -> Augmentation {
        let Multipliers::Augmented { error } = self.laws.enforcement.as_dyn().multipliers() else {
            return Augmentation::Done;
        };
        // Violations are lengths, compared with the compression of one layer of cells under the largest pressure, or with the way that
        // the pressure moves the mass of a point over the increment.
        let moving = stage.rate.map(|_| stage.dt);
        let approach = (self.memory.last.points.iter().enumerate())
            .map(|(i, e)| {
                let [p, t1, t2] = e.response.traction;
                let largest = if self.laws.tied {
                    p.abs().max(t1.hypot(t2))
                } else {
                    p
                };
                largest / self.own_stiffness(i, moving)
            })
            .fold(0.0, f64::max);
        let memory = &mut self.memory;
        let mut worst: f64 = 0.0;
        for (m, e) in memory.multipliers.iter_mut().zip(&memory.last.points) {
            let r = &e.response;
            if e.normal_stiffness.is_finite() {
                let change = (r.traction[0] - m.centre_pressure).abs();
                worst = worst.max(change / e.normal_stiffness);
            }
            let shear = e.along(&e.frame_before);
            if r.status == Status::Stick && e.tangential_stiffness.is_finite() {
                worst = worst.max(distance(shear, m.centre_shear) / e.tangential_stiffness);
            }
            m.centre_pressure = r.traction[0];
            m.centre_shear = shear;
            m.centre_normal = e.normal_before;
        }
        let reach = memory.searched_at.iter().chain(&self.reference);
        let reach = reach.map(|&x| crate::math::norm(x)).fold(0.0, f64::max);
        if worst <= (error * approach).max(16.0 * f64::EPSILON * reach) {
            Augmentation::Done
        } else {
            // An update that gains little says that the stiffness is low for what presses on it.
            if memory.violation.is_some_and(|before| worst > GAIN * before) {
                memory.tightened += 1;
            }
            memory.violation = Some(worst);
            Augmentation::Again(worst / (error * approach).max(f64::MIN_POSITIVE))
        }
    }

    fn commit(&mut self, stage: &Stage) {
        self.accept(stage);
    }

    fn tally(&self) -> Option<Tally> {
        let mut tally = Tally {
            changed: self.memory.changed,
            ..Tally::default()
        };
        for e in &self.memory.last.points {
            match e.response.status {
                Status::Open => tally.open += 1,
                Status::Stick => tally.stick += 1,
                Status::Slip => tally.slip += 1,
            }
        }
        Some(tally)
    }

    fn diagnose(&self) -> Vec<Culprit> {
        self.culprits()
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }

    fn continuation(&mut self) -> Option<&mut dyn Continuation> {
        let frictional = self.laws.friction_law().frictional();
        frictional.then_some(self as &mut dyn Continuation)
    }
}

impl Interface {
    /// How many points have another status in the present attempt than at the last accepted state.
    pub fn switched(&self) -> usize {
        let points = self.memory.committed.iter().zip(&self.memory.last.points);
        points
            .filter(|(h, e)| h.status != e.response.status)
            .count()
    }

    /// Energies at the last committed state.
    pub fn energy(&self) -> Energy {
        Energy {
            stored: self.stored_energy(),
            dissipated: self.memory.dissipated,
            work: self.memory.belt_work,
            damped: self.memory.damped,
            path: self.memory.path,
            uncertain: self.memory.uncertain,
            excess: self.memory.excess,
        }
    }

    /// Adds the fields of the contact points at the last committed state.
    pub fn fields(&self, out: &mut Fields) {
        self.add_fields(out);
    }
}

impl Evaluation {
    /// Shear traction on the secondary along the given directions.
    fn along(&self, frame: &[Vec3; 2]) -> Vec3 {
        let t = self.response.traction;
        add_scaled(scale(t[1], frame[0]), t[2], frame[1])
    }

    /// A tangent vector of the last accepted state, where the normal was `normal`, as it is carried into the tangent plane of now.
    fn forward(&self, v: Vec3, normal: Vec3, dim: usize) -> Vec3 {
        if normal == [0.0; 3] || self.normal_before == [0.0; 3] {
            return v;
        }
        let there = carried_over(v, normal, self.normal_before);
        let [a, b] = components(there, &self.frame_before, dim);
        add_scaled(scale(a, self.frame[0]), b, self.frame[1])
    }
}
