//! The interface as a force: the only place that scatters contact into residual and tangent.

mod evaluate;
mod report;
mod springs;

use rayon::prelude::*;

pub use report::{Quality, Resultant};

use super::enforcement::Multipliers;
use super::kinematics::KinematicsModel;
use super::obstacle::{Motion, ObstacleShape, Pose};
use super::pairing::FacetPoint;
use super::response::{Laws, Status};
use super::search::Tree;
use super::surface::{ContactPoint, Facet};
use crate::math::{Vec3, add, add_scaled, distance, dot, scale};
use crate::system::{
    Assembler, Augmentation, Culprit, Dofs, Energy, Fields, Force, Role, Saddle, Schedule, Stage,
    State, StepFailure, Tally, Tangent,
};
use evaluate::Evaluation;

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
    /// Their user's numbers.
    pub node_ids: Vec<u64>,
    /// Their reference coordinates.
    pub reference: Vec<Vec3>,
    /// Points of the secondary.
    pub points: Vec<ContactPoint>,
    /// What they touch.
    pub primary: Primary,
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
    /// Histories and the last evaluation; `Memory::default()` to start with.
    pub memory: Memory,
}

/// What an interface remembers.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    committed: Vec<History>,
    multipliers: Vec<Multiplier>,
    last: Vec<Evaluation>,
    flips: Vec<Flips>,
    candidates: Vec<Vec<usize>>,
    searched_at: Vec<Vec3>,
    margin: f64,
    frozen: Vec<Option<(usize, FacetPoint)>>,
    dissipated: f64,
    belt_work: f64,
    damped: f64,
    /// Largest velocity of slip below the limit over the last increment.
    creep: f64,
    changed: usize,
    /// Nothing has been in contact yet, and this is the first tangent of the attempt.
    untouched: bool,
    /// Explicit dynamics: springs, whatever the enforcement.
    explicit: bool,
    /// Gaps at which springs that replace multipliers carry nothing `[m]`; empty where all of them are zero.
    rest: Vec<f64>,
    /// Mass per area behind each point `[kg/m²]`; empty where it plays no part.
    inertia: Vec<f64>,
    softening: Option<f64>,
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
    /// The part of the pressure that damping added.
    damping: f64,
}

/// Multipliers of a contact point in the current attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Multiplier {
    pressure: f64,
    shear: Vec3,
    /// What an augmented Lagrangian pulls them to: the estimate of the last round.
    centre_pressure: f64,
    centre_shear: Vec3,
    /// The same as components, at the last tangent: Newton steps from here.
    base: [f64; 3],
    frame: [Vec3; 2],
}

/// Status changes of a point over the iterations of an attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Flips {
    count: usize,
    last: [Option<Status>; 4],
    /// Whether it lay over the primary, and how often it has slid off its outer edge.
    over: bool,
    left: usize,
}

/// Contact points evaluated by one task. Fixed, so that no number depends on how many threads there are.
const CHUNK: usize = 16;

impl Interface {
    /// Reference coordinates plus displacement of the nodes of the interface.
    fn coordinates(&self, u: &[f64]) -> Vec<Vec3> {
        self.nodes
            .iter()
            .zip(&self.reference)
            .map(|(&node, &x)| add(x, self.dofs.vector(u, node)))
            .collect()
    }

    /// Tells the masses of the points of the mesh `[kg]`, zero for those that have none; an empty list where inertia plays no part.
    pub fn set_masses(&mut self, by_point: &[f64]) {
        let mass = |p: &ContactPoint| -> f64 {
            let nodes = p.nodes.iter().zip(&p.weights);
            nodes
                .map(|(&node, w)| w * by_point.get(self.nodes[node]).copied().unwrap_or(0.0))
                .sum()
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
        self.prepare(stage)?;
        self.begin();
        for e in self.evaluate_all(stage, false, true) {
            for (&dof, r) in e.dofs.iter().zip(&e.residual) {
                residual[dof] += r;
            }
        }
        Ok(())
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
        memory.margin = facets.iter().map(size).fold(0.0, f64::max);
        let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
        memory.candidates.resize(self.points.len(), Vec::new());
        for (point, candidates) in self.points.iter().zip(&mut memory.candidates) {
            tree.near(point.position(x), memory.margin, candidates);
        }
        memory.searched_at = x.to_vec();
    }

    /// Pairs in the reference configuration, for small sliding.
    fn freeze(&mut self) {
        if !self.kinematics.as_dyn().frozen() || !self.memory.frozen.is_empty() {
            return;
        }
        let x = self.reference.clone();
        self.search(&x);
        self.memory.frozen = (0..self.points.len())
            .map(|i| self.closest(i, &x, None).ok())
            .collect();
    }

    fn evaluate_all(&self, stage: &Stage, tangent: bool, initial: bool) -> Vec<Evaluation> {
        let x = self.coordinates(&stage.at.u);
        let before = self.coordinates(&stage.from.u);
        let poses = self.poses(stage);
        let belt = self.belt_path(stage);
        let belt_end = scale(stage.dt, self.belt_velocity(stage.at.t));
        let indices: Vec<usize> = (0..self.points.len()).collect();
        indices
            .par_chunks(CHUNK)
            .flat_map_iter(|chunk| {
                let scene = evaluate::Scene {
                    x: &x,
                    before: &before,
                    poses: poses.as_ref(),
                    belt,
                    belt_end,
                    rate: stage.rate,
                    dt: stage.dt,
                    tangent,
                    initial,
                };
                chunk
                    .iter()
                    .map(|&i| self.evaluate(i, &scene))
                    .collect::<Vec<_>>()
            })
            .collect()
    }
}

impl Force for Interface {
    fn name(&self) -> &str {
        &self.name
    }

    fn role(&self) -> Role {
        Role::Contact
    }

    fn prepare(&mut self, stage: &Stage) -> Result<(), StepFailure> {
        self.ready();
        self.freeze();
        if !self.kinematics.as_dyn().frozen() {
            let x = self.coordinates(&stage.at.u);
            self.search(&x);
        }
        Ok(())
    }

    fn begin(&mut self) {
        self.ready();
        let memory = &mut self.memory;
        for (m, h) in memory.multipliers.iter_mut().zip(&memory.committed) {
            *m = Multiplier {
                pressure: h.pressure,
                shear: h.shear,
                centre_pressure: h.pressure,
                centre_shear: h.shear,
                ..Multiplier::default()
            };
        }
        memory.flips.fill(Flips::default());
        memory.last.clear();
        memory.untouched = memory.committed.iter().all(|h| h.status == Status::Open);
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        if !self.schedule.active(stage.at.t) {
            self.memory.last.clear();
            return Ok(());
        }
        let evaluations = self.evaluate_all(stage, out.wants_tangent, false);
        let unknown = self.unknown();
        for (i, e) in evaluations.iter().enumerate() {
            if out.wants_tangent && !e.dofs.is_empty() {
                out.couplings.push(e.dofs.clone());
            }
            if e.residual.is_empty() {
                continue;
            }
            out.add_residual(&e.dofs, &e.residual);
            out.rounding += e.rounding * e.rounding;
            if let Some(saddle) = &e.saddle {
                let worst = saddle.r_l.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
                out.multiplier_residual = out.multiplier_residual.max(worst * self.points[i].area);
                if out.wants_tangent {
                    out.add_saddle(
                        &e.dofs,
                        e.tangent(),
                        Saddle {
                            k_ul: &saddle.k_ul,
                            k_lu: &saddle.k_lu,
                            k_ll_inverse: &saddle.k_ll_inverse,
                            r_l: &saddle.r_l,
                        },
                    );
                }
            } else if out.wants_tangent {
                out.add_tangent(&e.dofs, e.tangent());
            }
        }
        let memory = &mut self.memory;
        if out.wants_tangent {
            memory.untouched = false;
            memory.changed = 0;
            for (flips, e) in memory.flips.iter_mut().zip(&evaluations) {
                let now = Some(e.response.status);
                if flips.last[0].is_some() && flips.last[0] != now {
                    flips.count += 1;
                    memory.changed += 1;
                }
                let over = e.facet.is_some();
                flips.left += usize::from(flips.over && !over);
                flips.over = over;
                flips.last.rotate_right(1);
                flips.last[0] = now;
            }
            if unknown {
                for (m, e) in memory.multipliers.iter_mut().zip(&evaluations) {
                    m.base = e.multiplier;
                    m.frame = e.frame_before;
                }
            }
        }
        // The multiplier rows of the tangent evaluation are needed until the step has been taken.
        if out.wants_tangent || !unknown {
            memory.last = evaluations;
        } else {
            for (kept, e) in memory.last.iter_mut().zip(evaluations) {
                kept.response = e.response;
                kept.gap = e.gap;
            }
        }
        Ok(())
    }

    fn soften(&mut self, factor: Option<f64>) -> bool {
        self.memory.softening = factor;
        self.laws.friction.as_dyn().frictional()
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        if !self.unknown() {
            return;
        }
        let memory = &mut self.memory;
        for (m, e) in memory.multipliers.iter_mut().zip(&memory.last) {
            let Some(saddle) = &e.saddle else {
                continue;
            };
            let n = e.dofs.len();
            // dl = -K_ll⁻¹ (r_l + K_lu du)
            let row: [f64; 3] = std::array::from_fn(|p| {
                let k = &saddle.k_lu[p * n..(p + 1) * n];
                let k_du: f64 = k.iter().zip(&e.dofs).map(|(k, &dof)| k * du[dof]).sum();
                saddle.r_l[p] + k_du
            });
            let now: [f64; 3] = std::array::from_fn(|p| {
                let k = &saddle.k_ll_inverse[p * 3..p * 3 + 3];
                m.base[p] - step * (k[0] * row[0] + k[1] * row[1] + k[2] * row[2])
            });
            m.pressure = now[0];
            m.shear = add_scaled(scale(now[1], m.frame[0]), now[2], m.frame[1]);
        }
    }

    fn augment(&mut self, stage: &Stage) -> Augmentation {
        let Multipliers::Augmented { error } = self.laws.enforcement.as_dyn().multipliers() else {
            return Augmentation::Done;
        };
        // Violations are lengths, compared with the compression of one layer of cells under the largest pressure, or with the way that
        // the pressure moves the mass of a point over the increment.
        let moving = stage.rate.map(|_| stage.dt);
        let approach = (self.memory.last.iter().enumerate())
            .map(|(i, e)| e.response.traction[0] / self.own_stiffness(i, moving))
            .fold(0.0, f64::max);
        let memory = &mut self.memory;
        let mut worst: f64 = 0.0;
        for (m, e) in memory.multipliers.iter_mut().zip(&memory.last) {
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
        }
        let reach = memory.searched_at.iter().chain(&self.reference);
        let reach = reach.map(|&x| crate::math::norm(x)).fold(0.0, f64::max);
        if worst <= (error * approach).max(16.0 * f64::EPSILON * reach) {
            Augmentation::Done
        } else {
            Augmentation::Again(worst / (error * approach).max(f64::MIN_POSITIVE))
        }
    }

    fn switched(&self) -> usize {
        let memory = &self.memory;
        memory
            .committed
            .iter()
            .zip(&memory.last)
            .filter(|(h, e)| h.status != e.response.status)
            .count()
    }

    fn commit(&mut self, stage: &Stage) {
        let active = self.schedule.active(stage.at.t);
        let belt = self.belt_path(stage);
        let memory = &mut self.memory;
        if !active || memory.last.is_empty() {
            for h in &mut memory.committed {
                *h = History {
                    slip: h.slip,
                    ..History::default()
                };
            }
            return;
        }
        memory.creep = 0.0;
        let creeps = self.laws.friction.as_dyn().frictional() && !self.laws.slip.as_dyn().sticks();
        for ((h, e), point) in memory
            .committed
            .iter_mut()
            .zip(&memory.last)
            .zip(&self.points)
        {
            let r = &e.response;
            let shear = e.along(&e.frame);
            // By the trapezoidal rule, like the work of the loads: exact where the traction grows in proportion.
            let carried = e.carried;
            let mean = [0, 1].map(|i| 0.5 * (carried[i] + r.traction[i + 1]));
            let work = mean[0] * r.sliding_path[0] + mean[1] * r.sliding_path[1];
            memory.dissipated += (-work * point.area).max(0.0);
            memory.belt_work += 0.5 * dot(add(h.shear, shear), belt) * point.area;
            if creeps && r.status == Status::Stick {
                memory.creep = memory.creep.max(crate::math::norm(e.moved) / stage.dt);
            }
            if r.damping != 0.0 || h.damping != 0.0 {
                let closed = if h.normal == [0.0; 3] {
                    0.0
                } else {
                    h.gap - e.gap
                };
                let work = 0.5 * (h.damping + r.damping) * closed;
                memory.damped += (work * point.area).max(0.0);
            }
            let slid = if r.status == Status::Open {
                [0.0; 3]
            } else {
                e.moved
            };
            *h = History {
                pressure: r.traction[0],
                shear,
                slip: add(h.slip, slid),
                gap: e.gap,
                normal: e.normal,
                status: r.status,
                facet: e.facet,
                damping: r.damping,
            };
        }
    }

    fn energy(&self) -> Energy {
        Energy {
            stored: self.stored_energy(),
            dissipated: self.memory.dissipated,
            work: self.memory.belt_work,
            damped: self.memory.damped,
        }
    }

    fn fields(&self, _state: &State, out: &mut Fields) {
        self.add_fields(out);
    }

    fn tally(&self) -> Option<Tally> {
        let mut tally = Tally {
            changed: self.memory.changed,
            ..Tally::default()
        };
        for e in &self.memory.last {
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
}

impl Evaluation {
    /// What a tangent evaluation leaves for the assembler.
    fn tangent(&self) -> Tangent<'_> {
        Tangent {
            whole: &self.tangent,
            surrogate: &self.surrogate,
            rows: &self.rows,
            change: &self.change,
        }
    }

    /// Shear traction on the secondary along the given directions.
    fn along(&self, frame: &[Vec3; 2]) -> Vec3 {
        let t = self.response.traction;
        add_scaled(scale(t[1], frame[0]), t[2], frame[1])
    }

    /// A point that carries nothing.
    fn open(gap: f64) -> Self {
        Evaluation {
            gap,
            ..Evaluation::default()
        }
    }
}

/// The parts of a saddle-point block that an evaluation keeps.
#[derive(Debug, Clone, Default)]
struct SaddleRows {
    k_ul: Vec<f64>,
    k_lu: Vec<f64>,
    k_ll_inverse: Vec<f64>,
    r_l: Vec<f64>,
}
