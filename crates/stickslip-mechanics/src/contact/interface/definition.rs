//! What an interface is: its two sides, its laws, and what it knows.

use std::sync::Arc;

use super::attempt::Attempt;
use super::cache::Cache;
use super::directives::Directives;
use super::history::History;
use super::hollows::Hollows;
use super::initial::Initial;
use crate::contact::kinematics::KinematicsModel;
use crate::contact::mortar::Mortar;
use crate::contact::obstacle::{Motion, ObstacleShape};
use crate::contact::response::Laws;
use crate::contact::surface::{ContactPoint, Facet, Skin};
use crate::contact::walls::Walls;
use crate::math::{Vec3, add, sub};
use crate::system::{BodyFrames, Dofs, FramePose, Schedule};

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
    /// For each of the points the others beside it, see [`neighbours`](super::neighbours); empty where nobody asks how smooth the pressure is.
    pub neighbours: Vec<Vec<usize>>,
    /// What they touch.
    pub primary: Primary,
    /// How what is worn off the primary is divided among its nodes; empty where nothing wears.
    pub hollows: Hollows,
    /// The axes along which each node is prescribed in all steps, or follows what is; over an obstacle those alone along which it follows: a support leaves no multiplier there.
    /// Empty where nobody has looked.
    pub clamped: Vec<[bool; 3]>,
    /// How thick the primary is behind its facets.
    pub walls: Walls,
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
    /// The bodies of its sides that turn; shared by all interfaces, and empty where none of its points is one of theirs.
    pub frames: Arc<BodyFrames>,
    /// Whether a body of its sides turns by any angle as a whole, in a frame or free.
    pub turns: bool,
    /// How far a point may lie beyond the outer edge of the primary and still be carried, relative to the facet.
    pub edge_tolerance: f64,
    /// What becomes of the gaps of the meshes.
    pub initial: Initial,
    /// Height of the real surface above the mesh at each point, towards the primary `[m]`; empty where they are the same. To first order, as of waves that are
    /// long beside their heights.
    pub relief: Vec<f64>,
    /// What accepted increments have left; all that a checkpoint has to hold.
    pub history: History,
    /// The attempt at the next one.
    pub attempt: Attempt,
    /// How it is to act at present.
    pub directives: Directives,
    /// What can be made again.
    pub cache: Cache,
}

impl Interface {
    /// Reference coordinates plus displacement of the nodes of the interface.
    pub(super) fn coordinates(&self, u: &[f64]) -> Vec<Vec3> {
        let mut out = Vec::new();
        self.coordinates_into(u, &mut out);
        out
    }

    pub(super) fn coordinates_into(&self, u: &[f64], out: &mut Vec<Vec3>) {
        out.clear();
        let poses = self.frame_poses(u);
        let nodes = self.nodes.iter().zip(&self.reference);
        out.extend(nodes.map(|(&node, &x)| {
            let moved = self.dofs.vector(u, node);
            match self.frames.of_point(node) {
                Some(body) => poses[body].place(x, moved),
                None => add(x, moved),
            }
        }));
    }

    /// Displacements of the nodes in space.
    pub(super) fn displacements(&self, u: &[f64]) -> Vec<Vec3> {
        let poses = self.frame_poses(u);
        let nodes = self.nodes.iter().zip(&self.reference);
        let moved = nodes.map(|(&node, &x)| {
            let moved = self.dofs.vector(u, node);
            match self.frames.of_point(node) {
                Some(body) => sub(poses[body].place(x, moved), x),
                None => moved,
            }
        });
        moved.collect()
    }

    /// Where the frames of bodies that turn are at displacements `u`, counted like all coordinates here.
    pub(super) fn frame_poses(&self, u: &[f64]) -> Vec<FramePose> {
        let poses = self.frames.poses(u).into_iter();
        poses.map(|pose| pose.counted_from(self.origin)).collect()
    }

    /// Whether the primary is an obstacle.
    pub fn rigid(&self) -> bool {
        matches!(self.primary, Primary::Rigid(..))
    }

    /// The facets of the primary; none of an obstacle.
    pub(super) fn facets(&self) -> &[Facet] {
        match &self.primary {
            Primary::Facets(facets) => facets,
            Primary::Rigid(..) => &[],
        }
    }

    /// What is subtracted from the gap of a point at time `t` `[m]`, with what was worn off at the last accepted state.
    pub(super) fn offset(&self, i: usize, t: f64) -> f64 {
        self.offset_at_start(i, t) - self.history.points.get(i).map_or(0.0, |h| h.hollow)
    }

    /// The same without what is worn off.
    pub(super) fn offset_at_start(&self, i: usize, t: f64) -> f64 {
        let relief = self.relief.get(i).copied().unwrap_or(0.0);
        relief + self.initial.offset(&self.history.start, i, t)
    }

    /// Makes room for all points, and begins an attempt if there is none.
    pub(super) fn ready(&mut self) {
        self.history.fit(self.points.len());
        if self.attempt.multipliers.len() != self.points.len() {
            self.begin_attempt();
        }
    }

    /// An attempt from the committed history.
    pub(super) fn begin_attempt(&mut self) {
        let accepted = self.accepted();
        let before = std::mem::take(&mut self.attempt);
        self.attempt = before.next(&self.history.points, accepted);
        self.cache.last.points.clear();
    }

    /// Does something with what can be made again, which is lent out for that: the rest stays as it is.
    pub(super) fn lend<T>(&mut self, work: impl FnOnce(&Self, &mut Cache) -> T) -> T {
        let mut cache = std::mem::take(&mut self.cache);
        let done = work(self, &mut cache);
        self.cache = cache;
        done
    }
}
