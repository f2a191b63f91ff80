//! What is simulated: bodies, supports, loads, steps.

use std::ops::Range;
use std::sync::Arc;

use super::cycling::Cycling;
use super::heat::Heat;
use super::limits::Limits;
use super::modal::{KickPlan, Modal, SteadyPlan};
use super::second_field::SecondField;
use crate::body::loads::{Load, Spring};
use crate::body::{Elastic, MassKind, Space, fields};
use crate::contact::interface::{Change, Steady};
use crate::fatigue::FatigueModel;
use crate::io::frd::Encoding;
use crate::keep::Keep;
use crate::math::{Mat3, Vec3};
use crate::mesh::Mesh;
use crate::newton::condensed::engine::EngineModel;
use crate::newton::{BodyPoints, Settings};
use crate::system::{BodyFrames, Corotations, Dofs, Fields, Links, Motion, Schedule, State};
use crate::time::Increments;
use crate::time::scheme::Method;
pub use crate::time::{ContactAt, ContactMass};

/// Everything that is simulated and does not change while it is.
pub struct Model {
    /// Title for reports.
    pub title: String,
    /// Kind of space.
    pub space: Space,
    /// All bodies in one mesh; bodies share no points.
    pub mesh: Arc<Mesh>,
    /// Its diameter `[m]`.
    pub size: f64,
    /// Numbering of the unknowns: the points of the mesh, then two hidden ones for each rigid body and each reference point.
    pub dofs: Dofs,
    /// The rigid bodies, then the reference points.
    pub links: Links,
    /// The bodies that turn by any angle. Their displacements and the forces on their points are along the axes of their frames.
    pub frames: Arc<BodyFrames>,
    /// The bodies with frames of their own, which turn freely by any angle. Their displacements and forces are along the axes of space.
    pub corotations: Arc<Corotations>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The reference points.
    pub references: Vec<Reference>,
    /// What acts on bodies, and how they begin.
    pub actions: Actions,
    /// Steps, in order of time.
    pub steps: Vec<Step>,
    /// What is reported of an analysis, and how it is judged.
    pub reports: ReportPlan,
    /// How increments are solved.
    pub solution: SolutionPlan,
    /// Tables of the problem that nothing uses, obstacles first: `amplitude.NAME`.
    pub unused: Vec<String>,
    /// Interfaces, by name, whose roughness is a sum of waves, and the shortest of these `[m]`.
    pub waves: Vec<(String, f64)>,
}

/// What acts on bodies, and how they begin.
pub struct Actions {
    /// Loads.
    pub loads: Vec<Load>,
    /// Temperatures, where some are given.
    pub heat: Option<Heat>,
    /// Fields beside the displacements.
    pub fields: Vec<Arc<dyn SecondField>>,
    /// Springs to ground.
    pub springs: Vec<Spring>,
    /// Masses at points beside those of the cells `[kg]`.
    pub masses: Vec<(usize, f64)>,
    /// Supports and prescribed displacements.
    pub supports: Vec<Support>,
    /// Initial displacements and velocities.
    pub initials: Vec<Initial>,
}

/// How increments are solved.
pub struct SolutionPlan {
    /// Settings of Newton's method.
    pub settings: Settings,
    /// How its systems are solved.
    pub method: Solution,
    /// The linear solver that factors condensed bodies.
    pub engine: EngineModel,
    /// Largest displacement increment relative to the size of the model.
    pub largest_change: f64,
    /// Largest residual of the energy balance, relative to the energy stored and dissipated, that counts as good.
    pub energy_limit: f64,
    /// Whether bodies that only contact can hold are followed until it does.
    pub follow: bool,
}

/// What is reported of an analysis, and how it is judged.
pub struct ReportPlan {
    /// Quantities for the history.
    pub probes: Vec<Probe>,
    /// What is written when.
    pub output: OutputPlan,
    /// What counts as a good solution.
    pub quality: Limits,
}

/// A body: a range of points and blocks of the mesh.
pub struct Body {
    /// Name in the problem file.
    pub name: String,
    /// Its points.
    pub points: Range<usize>,
    /// Its blocks.
    pub blocks: Range<usize>,
    /// The points of its parts that pretensions have cut off from the first, part by part, ascending.
    pub pieces: Vec<Vec<usize>>,
    /// Its elasticity; of a rigid body only mass and volume count.
    pub elastic: Elastic,
    /// Its mass if it is rigid.
    pub rigid: Option<Rigid>,
    /// Rayleigh damping: factors of mass `[1/s]` and stiffness `[s]`.
    pub rayleigh: [f64; 2],
}

/// A point that belongs to no mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Name in the problem file.
    pub name: String,
    /// Index of its link.
    pub link: usize,
    /// Its mass if it has one.
    pub rigid: Option<Rigid>,
    /// The one body that is tied to it, if it is one.
    pub body: Option<usize>,
    /// By step the dofs that are left out because nothing resists them.
    pub still: Vec<Vec<usize>>,
}

/// What resists the motion of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid {
    /// Index of its link.
    pub link: usize,
    /// Mass `[kg]`.
    pub mass: f64,
    /// Moments of inertia about the centre of mass over the square of the length of the link `[kg]`, in the order of the dofs of its
    /// second hidden point.
    pub spin: Mat3,
}

impl Body {
    /// Adds the fields of a state. In a rigid body there is no stress.
    pub fn fields(&self, state: &State, out: &mut Fields) {
        if self.rigid.is_none() {
            fields::fields(&self.elastic, state, out);
            return;
        }
        let at_rest = State {
            t: state.t,
            u: vec![0.0; state.u.len()],
            ..State::default()
        };
        fields::fields(&self.elastic, &at_rest, out);
    }

    /// Adds strain and strain energy per volume at the points, `E` and `ENER`: more than [`fields`](Body::fields) has.
    pub fn strain_fields(&self, state: &State, out: &mut Fields) {
        match self.rigid {
            None => fields::strain_fields(&self.elastic, state, out),
            Some(_) => fields::strain_fields(&self.elastic, &vec![0.0; state.u.len()], out),
        }
    }
}

/// Initial values of some dofs.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// Name in the problem file.
    pub name: String,
    /// Displacements at the start of the analysis, by dof `[m]`.
    pub displacements: Vec<(usize, f64)>,
    /// Velocities at the start of a step, by dof `[m/s]`.
    pub velocities: Vec<(usize, f64)>,
    /// The step, a dynamic one.
    pub step: usize,
}

/// How the systems of Newton's method are solved.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, Keep,
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Solution {
    /// The method with the least estimated cost.
    #[default]
    Automatic,
    /// Bodies are factored once and condensed to the contact candidates.
    Condensed,
    /// The sparse matrix of the whole model is factored again when the contact state has changed much.
    Sparse,
    /// The sparse matrix of the whole model is solved by multigrid and GMRES: for bodies whose factors would be too large.
    Multigrid,
}

impl Solution {
    /// The name in the summary.
    pub fn key(self) -> &'static str {
        match self {
            Solution::Automatic => "automatic",
            Solution::Condensed => "condensed",
            Solution::Sparse => "sparse",
            Solution::Multigrid => "multigrid",
        }
    }

    /// Whether bodies may be condensed.
    pub fn condenses(self) -> bool {
        !matches!(self, Solution::Sparse | Solution::Multigrid)
    }
}

/// How a dynamic step is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dynamic {
    /// The scheme.
    pub method: Method,
    /// How masses are given to points; always lumped in an explicit scheme.
    pub mass: MassKind,
    /// Whether points in contact have mass; `None`: only where the normal law is compliant.
    pub contact_mass: Option<ContactMass>,
    /// Where in the increment interfaces act.
    pub contact_at: ContactAt,
    /// Largest local error of the displacements relative to the motion so far `[-]`.
    pub error: Option<f64>,
    /// Time to which changes of status are located `[s]`.
    pub events: Option<f64>,
}

impl Model {
    /// Whether a body turns by any angle, in frames of its own or one that a reference point carries.
    pub(crate) fn has_frames(&self, body: &Body) -> bool {
        let first = body.points.start;
        body.elastic.is_corotational()
            || self.corotations.of_point(first).is_some()
            || self.frames.of_point(first).is_some()
    }

    /// Whether any step is dynamic.
    pub fn moves(&self) -> bool {
        self.steps.iter().any(|s| s.dynamic.is_some())
    }

    /// The sliding of an interface that lasts in a step, if any does. Modes are about that of the last step in which something moved, where a belt runs all the time,
    /// whoever set it going.
    pub(crate) fn sliding(&self, step: usize, interface: &str) -> Option<Steady> {
        let mut before = self.steps[..=step].iter().rev();
        let moving = before.find(|s| s.modal.is_none());
        let plan = moving.and_then(|s| s.steady.as_ref());
        let modal = self.steps[step].modal.as_ref();
        let plan = plan.map(|plan| plan.of(interface));
        plan.or(modal.map(|_| Steady::default()))
    }

    /// What multigrid has to know of the mesh; see [`Factors::multigrid`](crate::newton::Factors::multigrid).
    pub fn places(&self) -> BodyPoints {
        let meshed = self.mesh.points.len();
        let mut bodies = vec![self.bodies.len() as u32; self.dofs.points];
        for (i, body) in self.bodies.iter().enumerate() {
            bodies[body.points.clone()].fill(i as u32);
        }
        let mut coordinates = self.mesh.points.clone();
        coordinates.resize(self.dofs.points, [0.0; 3]);
        BodyPoints {
            coordinates,
            bodies,
            elastic: meshed,
        }
    }

    /// Whether increments at rest are sought in passes: bodies turn freely by any angle, and not in the plane as rigid ones.
    pub(crate) fn turns_freely(&self) -> bool {
        !self.corotations.is_empty() || !self.frames.spun().is_empty()
    }

    /// Masses of rigid bodies and reference points.
    pub fn rigid(&self) -> impl Iterator<Item = Rigid> + '_ {
        let bodies = self.bodies.iter().filter_map(|b| b.rigid);
        bodies.chain(self.references.iter().filter_map(|r| r.rigid))
    }

    /// What such reference points do, by dof, as are tied to what moves without strain: its velocity by place, and how it turns.
    pub(crate) fn carried(
        &self,
        tied: impl Fn(&Reference) -> bool,
        velocity: impl Fn(Vec3) -> Vec3,
        turn: Vec3,
    ) -> Vec<(usize, f64)> {
        let own = self.references.iter().filter(|r| tied(r));
        let links = own.map(|r| &self.links.all()[r.link]);
        let motions = links.flat_map(|link| {
            let moved = velocity(link.centre);
            let of = move |motion| match motion {
                Motion::Translation(i) => moved[i],
                Motion::Rotation(i) => turn[i] * link.length,
            };
            let motions = link.motions(self.dofs).into_iter();
            motions.map(move |(dof, motion)| (dof, of(motion)))
        });
        motions.collect()
    }

    /// The points of a body, and the hidden ones that are displaced with them: its own where it is rigid, and those of reference points that are tied to it.
    pub(crate) fn displaced_with(&self, body: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.bodies[body].rigid.map(|r| r.link);
        let tied = self.references.iter();
        let tied = tied.filter(move |r| r.body == Some(body)).map(|r| r.link);
        let hidden = own
            .into_iter()
            .chain(tied)
            .map(|l| self.links.all()[l].hidden);
        self.bodies[body].points.clone().chain(hidden)
    }

    /// The bodies that deform.
    pub fn elastic(&self) -> impl Iterator<Item = &Body> {
        self.bodies.iter().filter(|b| b.rigid.is_none())
    }

    /// Whether cells of some body have frames of their own, so that what the bodies resist with is not linear.
    pub fn is_corotational(&self) -> bool {
        self.elastic().any(|b| b.elastic.is_corotational())
    }

    /// Sets the velocities that are given for the start of a step.
    pub(crate) fn apply_initial_velocities(&self, step: usize, v: &mut [f64]) {
        for initial in self.actions.initials.iter().filter(|i| i.step == step) {
            for &(dof, value) in &initial.velocities {
                v[dof] = value;
            }
        }
        self.links.impose(v);
    }
}

/// Prescribed displacements of a set.
#[derive(Debug, Clone)]
pub struct Support {
    /// Name in the problem file.
    pub name: String,
    /// The dofs and their values at factor 1.
    pub entries: Vec<Prescribed>,
    /// When it acts and with which factor.
    pub schedule: Schedule,
    /// `true` if the factor multiplies the value; `false` if it leads from the displacement at the start of the first step in
    /// which it acts to the value.
    pub table: bool,
}

/// One prescribed dof.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prescribed {
    /// The dof.
    pub dof: usize,
    /// Displacement `[m]`; without meaning where held.
    pub value: f64,
    /// Stays where it is when the support begins to act.
    pub hold: bool,
}

/// A step.
#[derive(Debug, Clone)]
pub struct Step {
    /// Name.
    pub name: String,
    /// Start.
    pub start: f64,
    /// End.
    pub end: f64,
    /// Size of increments.
    pub increments: Increments,
    /// Times that increments must land on.
    pub milestones: Vec<f64>,
    /// Those of them at which what drives the bodies may change its course: all but times of output.
    pub corners: Vec<f64>,
    /// Whether increments are of one given length.
    pub fixed: bool,
    /// Largest relative change of the state variables of friction laws over an increment.
    pub state_change: f64,
    /// How motion is integrated; `None` in a quasi-static step.
    pub dynamic: Option<Dynamic>,
    /// Sliding that lasts; `None` where friction follows slips.
    pub steady: Option<SteadyPlan>,
    /// What is looked for in a step without increments.
    pub modal: Option<Modal>,
    /// A mode that the step before has found, along which the motion begins.
    pub kick: Option<KickPlan>,
    /// Interfaces, by name, whose laws change at its start.
    pub changes: Vec<(String, Change)>,
    /// How often it is gone through.
    pub cycles: Option<Cycling>,
}

impl Step {
    /// Whether motion is integrated without solving equations.
    pub fn is_explicit(&self) -> bool {
        matches!(
            self.dynamic,
            Some(Dynamic {
                method: Method::Explicit { .. },
                ..
            })
        )
    }
}

/// A point whose displacement and stress go into the history.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Name: the columns are `name.U1`, …
    pub name: String,
    /// The mesh point.
    pub point: usize,
}

/// When sliding counts as an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EventPlan {
    /// Speed above which it does `[m/s]`.
    pub speed: f64,
    /// Shear modulus by which slip integrated over the surface is a moment `[Pa]`.
    pub modulus: Option<f64>,
}

/// What is written when.
#[derive(Debug, Clone, Default)]
pub struct OutputPlan {
    /// Fields after every so many increments; 0: only at `times` and at the end of steps.
    pub every: usize,
    /// Times of field output.
    pub times: Vec<f64>,
    /// How the `.frd` file is written, if one is.
    pub frd: Option<Encoding>,
    /// A row of the history after every so many increments, and at times of output; at least 1.
    pub history_every: usize,
    /// Criteria of fatigue, and how far from interfaces they are evaluated `[m]`.
    pub fatigue: Vec<FatigueModel>,
    /// See `fatigue`.
    pub fatigue_depth: Option<f64>,
    /// Speed above which sliding is an event `[m/s]`, and shear modulus for its moment `[Pa]`.
    pub slip_events: Option<EventPlan>,
    /// A checkpoint after every so many increments, and after so many seconds of wall clock; 0: not by that.
    pub checkpoint: (usize, f64),
}
