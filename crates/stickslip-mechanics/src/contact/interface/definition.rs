//! What an interface is: its two sides and its laws.

use std::sync::Arc;

use super::history::History;
use super::initial::Initial;
use crate::contact::kinematics::KinematicsModel;
use crate::contact::law::friction::LawState;
use crate::contact::mortar::Mortar;
use crate::contact::obstacle::{Motion, ObstacleShape};
use crate::contact::response::Laws;
use crate::contact::surface::{ContactPoint, Facet, Skin};
use crate::contact::walls::Walls;
use crate::contact::worn::OppositeWear;
use crate::friction::ellipse::Ellipse;
use crate::math::{Vec3, add, distance, norm, sub};
use crate::system::{BodyFrames, Dofs, FramePose, Schedule, Stage};

/// What the secondary touches.
#[derive(Debug, Clone)]
pub enum Primary {
    /// Facets of a body; node indices are local to the interface.
    Facets(Vec<Facet>),
    /// A rigid obstacle and its motion.
    Rigid(ObstacleShape, Motion),
}

/// The two sides of an interface. Node indices in points and facets are positions in `nodes`.
#[derive(Debug, Clone)]
pub struct InterfaceMesh {
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
    /// By point, the earlier ones at nodes that move as its own does, as at the ends of a period; empty where there are none. Of points that move alike, the first that
    /// lies over the primary carries, for the area of all.
    pub alike: Vec<Vec<usize>>,
    /// The secondary as faces, where gaps are weighted over them; `None` where they are those of the points themselves.
    pub mortar: Option<Mortar>,
    /// The faces of the secondary, to be looked at between points; empty where it is not asked for.
    pub skin: Vec<Skin>,
    /// For each of the points the others beside it, see [`neighbours`](crate::contact::look::neighbours); empty where it is not asked how smooth the pressure is.
    pub neighbours: Vec<Vec<usize>>,
    /// What they touch.
    pub primary: Primary,
    /// How what is worn off the primary is divided among its nodes; empty where nothing wears.
    pub opposite_wear: OppositeWear,
    /// The axes along which each node is prescribed in all steps, or follows what is; over an obstacle those alone along which it follows: a support leaves no multiplier there.
    /// Empty where it has not been determined.
    pub clamped: Vec<[bool; 3]>,
    /// How thick the primary is behind its facets.
    pub walls: Walls,
    /// Height of the real surface above the mesh at each point, towards the primary `[m]`; empty where they are the same. To first order, as of waves that are
    /// long beside their heights.
    pub relief: Vec<f64>,
}

/// What an interface is: all that the problem says of it.
#[derive(Debug, Clone)]
pub struct InterfaceDefinition {
    /// Name in the problem file.
    pub name: String,
    /// Its sides; shared by what differs in laws alone.
    pub mesh: Arc<InterfaceMesh>,
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
    /// What becomes of the gaps of the meshes.
    pub initial: Initial,
}

impl std::ops::Deref for InterfaceDefinition {
    type Target = InterfaceMesh;

    fn deref(&self) -> &InterfaceMesh {
        &self.mesh
    }
}

impl InterfaceDefinition {
    /// Reference coordinates plus displacement of the nodes of the interface.
    pub(in crate::contact) fn coordinates(&self, u: &[f64]) -> Vec<Vec3> {
        let mut out = Vec::new();
        self.coordinates_into(&self.frames, u, &mut out);
        out
    }

    /// The same of bodies that are seen in these frames.
    pub(in crate::contact) fn coordinates_into(
        &self,
        frames: &BodyFrames,
        u: &[f64],
        out: &mut Vec<Vec3>,
    ) {
        out.clear();
        let poses = self.poses_of(frames, u);
        let nodes = self.nodes.iter().zip(&self.reference);
        out.extend(nodes.map(|(&node, &x)| {
            let moved = self.dofs.vector(u, node);
            match frames.of_point(node) {
                Some(body) => poses[body].place(x, moved),
                None => add(x, moved),
            }
        }));
    }

    /// Displacements of the nodes in space.
    pub(in crate::contact) fn displacements(&self, u: &[f64]) -> Vec<Vec3> {
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
    pub(in crate::contact) fn frame_poses(&self, u: &[f64]) -> Vec<FramePose> {
        self.poses_of(&self.frames, u)
    }

    /// The same of other frames.
    pub(in crate::contact) fn poses_of(&self, frames: &BodyFrames, u: &[f64]) -> Vec<FramePose> {
        let poses = frames.poses(u).into_iter();
        poses.map(|pose| pose.counted_from(self.origin)).collect()
    }

    /// The frames in which bodies of its sides that turn are seen in an evaluation.
    pub(in crate::contact) fn frames_at<'a>(&'a self, stage: &Stage<'a>) -> &'a Arc<BodyFrames> {
        let takes_part = |frames: &BodyFrames| {
            let mut nodes = self.nodes.iter();
            nodes.any(|&node| frames.of_point(node).is_some())
        };
        let seen = stage.frames.filter(|frames| takes_part(frames));
        seen.unwrap_or(&self.frames)
    }

    /// Whether the primary is an obstacle.
    pub fn rigid(&self) -> bool {
        matches!(self.primary, Primary::Rigid(..))
    }

    /// The facets of the primary; none of an obstacle.
    pub(in crate::contact) fn facets(&self) -> &[Facet] {
        match &self.primary {
            Primary::Facets(facets) => facets,
            Primary::Rigid(..) => &[],
        }
    }

    /// Whether the primary is a body, or an obstacle that does not move between these times.
    pub fn stands(&self, from: f64, to: f64) -> bool {
        match &self.primary {
            Primary::Rigid(_, motion) => motion.way(from, to) == [[0.0; 3]; 2],
            Primary::Facets(_) => true,
        }
    }

    /// How far the obstacle moves between two times where points of the secondary are `[m]`; zero without one.
    pub fn obstacle_way(&self, from: f64, to: f64) -> f64 {
        let Primary::Rigid(_, motion) = &self.primary else {
            return 0.0;
        };
        let (first, last) = (motion.pose(from), motion.pose(to));
        let ways = self.points.iter().map(|p| {
            let x = p.position(&self.reference);
            norm(sub(last.outward(first.inward(x)), x))
        });
        ways.fold(0.0, f64::max)
    }

    /// Where a point lies in space in the reference configuration `[m]`.
    pub fn place(&self, point: &ContactPoint) -> Vec3 {
        add(point.position(&self.reference), self.origin)
    }

    /// Where its points lie in the reference configuration `[m]`.
    pub fn places(&self) -> Vec<Vec3> {
        self.points.iter().map(|point| self.place(point)).collect()
    }

    /// What is known of it before anything has happened.
    pub fn first_history(&self) -> History {
        History::new(&self.places(), self.laws.friction_law())
    }

    /// The shape of what friction allows at a place, counted like all coordinates here, in a contact frame; `None` where it is a circle.
    pub(in crate::contact) fn ellipse(&self, x: Vec3, frame: [Vec3; 2]) -> Option<Ellipse> {
        let orthotropy = self.laws.friction_law().orthotropy()?;
        orthotropy.ellipse(add(x, self.origin), frame, self.dofs.dim)
    }

    /// Springs that stand for the bodies at a contact point `[N/m]` and the height of the cell beneath `[m]`, mean values.
    pub fn typical(&self) -> (f64, f64) {
        let count = self.points.len().max(1) as f64;
        let springs = self.points.iter().map(|p| p.stiffness * p.area);
        let sizes = self.points.iter().map(|p| p.size);
        (springs.sum::<f64>() / count, sizes.sum::<f64>() / count)
    }

    /// The mean length of facets `[m]`.
    pub(in crate::contact) fn facet_size(&self) -> f64 {
        let lengths = self.skin.iter().map(|s| {
            let [a, b] = [0, 1].map(|k| self.reference[s.facet.nodes[k]]);
            distance(a, b)
        });
        lengths.sum::<f64>() / self.skin.len() as f64
    }

    /// Factor of vectors on the secondary that makes them those on the side that the problem calls so.
    pub(in crate::contact) fn named(&self) -> f64 {
        if self.exchanged { -1.0 } else { 1.0 }
    }

    /// Nodes of the secondary that a point hangs on, with weights that add up to one.
    pub(in crate::contact) fn own_weights(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let p = &self.points[i];
        p.nodes.iter().copied().zip(p.weights.iter().copied())
    }

    /// Memory that a history takes `[bytes]`. A point of a mortar is taken to meet a facet more than it has faces around it.
    pub fn history_bytes(&self) -> usize {
        let facet = self.facets().iter().map(|f| f.nodes.len()).max();
        let facets: usize = match &self.mortar {
            Some(mortar) => mortar.around.iter().map(|faces| faces.len() + 1).sum(),
            None => self.points.len(),
        };
        let opposite = facets * facet.unwrap_or(0);
        let states = match self.laws.friction_law().states() {
            [] => 0,
            _ => self.points.len() * size_of::<LawState>(),
        };
        History::bytes(self.points.len(), opposite, self.nodes.len()) + states
    }

    /// Memory that what goes into a factor takes, point by point `[bytes]`, about: its dofs twice, and a matrix over them.
    pub fn stand_in_bytes(&self, dim: usize) -> usize {
        let facet = self.facets().iter().map(|f| f.nodes.len()).max();
        let facet = facet.unwrap_or(0);
        let bytes = |nodes: usize| {
            let dofs = dim * nodes;
            size_of::<f64>() * (dofs * dofs + 3 * dofs)
        };
        match &self.mortar {
            // A node meets a facet more than it has faces around it, and shares each of these with another node.
            Some(mortar) => (mortar.around.iter())
                .map(|faces| bytes((faces.len() + 1) * (facet + 1)))
                .sum(),
            None => self.points.len() * bytes(facet + 2),
        }
    }

    /// Nodes of the primary, each as often as it has facets.
    pub(in crate::contact) fn primary_nodes(&self) -> impl Iterator<Item = usize> {
        let facets = match &self.primary {
            Primary::Facets(facets) => facets.as_slice(),
            Primary::Rigid(..) => &[],
        };
        facets.iter().flat_map(|f| f.nodes.iter().copied())
    }

    /// The sides, to be changed before anything else knows them.
    pub fn mesh_mut(&mut self) -> &mut InterfaceMesh {
        Arc::make_mut(&mut self.mesh)
    }

    /// The same surfaces under other laws.
    pub(super) fn with_laws(&self, laws: Laws) -> Self {
        InterfaceDefinition {
            laws,
            ..self.clone()
        }
    }

    /// Whether sliding wears off one of the surfaces.
    pub fn wears(&self) -> bool {
        self.laws.wear.as_dyn().active()
    }
}
