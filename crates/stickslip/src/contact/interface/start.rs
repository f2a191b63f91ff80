//! What becomes of the gaps that the meshes have when an interface begins to act.

use serde::{Deserialize, Serialize};

use super::{Interface, Primary};
use crate::contact::surface::{ContactPoint, skin};
use crate::math::{Vec3, add_scaled, dot, normalize, scale, sub};
use crate::system::Stage;

/// What becomes of gaps and overlaps that the meshes have when an interface begins to act.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// They count as they are.
    #[default]
    AsMeshed,
    /// Points of the secondary within the tolerance are moved onto the primary before anything is computed: another mesh, without strain.
    Snap,
    /// The gap counts from its initial value where that is within the tolerance, or where the surfaces overlap: contact that is closed
    /// from the start, whatever the meshes say.
    Offset,
    /// Overlap is resolved in proportion to time over the first step in which the interface acts: a shrink fit.
    Ramp,
}

/// How an interface starts, and the gaps it starts with.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// What becomes of the gaps.
    pub start: Start,
    /// Gap up to which points are moved, count as closed or are glued; what is usual if not given.
    pub within: Option<Within>,
    /// Points of the mesh that may be moved, ascending; all if not given.
    pub only: Option<Vec<usize>>,
    /// Gap at which a point counts as closed `[m]`, by point; empty until the interface acts, and where there is nothing to subtract.
    offset: Vec<f64>,
    /// The time over which overlap is resolved `[s]`.
    span: [f64; 2],
    /// The interface has begun to act.
    begun: bool,
}

/// How near a point has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Within {
    /// Relative to the height of the cell beneath `[-]`.
    Fraction(f64),
    /// A length `[m]`.
    Distance(f64),
}

impl Within {
    /// The distance for a point above a cell of this height `[m]`.
    pub fn of(self, height: f64) -> f64 {
        match self {
            Within::Fraction(fraction) => fraction * height,
            Within::Distance(distance) => distance,
        }
    }
}

/// How near a point has to be to be moved or to count as closed, if nothing else is said.
pub const CLOSE: Within = Within::Fraction(0.1);

/// How near tied surfaces have to be to be glued, if nothing else is said.
pub const GLUE: Within = Within::Fraction(0.5);

impl Default for Initial {
    fn default() -> Self {
        Initial::new(Start::default(), None)
    }
}

impl Initial {
    /// The start of an interface that has not begun to act.
    pub fn new(start: Start, within: Option<Within>) -> Self {
        Initial {
            start,
            within,
            only: None,
            offset: Vec::new(),
            span: [0.0; 2],
            begun: false,
        }
    }

    /// What is subtracted from the gap of a point at time `t` `[m]`.
    pub fn offset(&self, i: usize, t: f64) -> f64 {
        let Some(&offset) = self.offset.get(i) else {
            return 0.0;
        };
        match self.start {
            Start::Ramp => {
                let [from, to] = self.span;
                offset * (1.0 - ((t - from) / (to - from)).clamp(0.0, 1.0))
            }
            _ => offset,
        }
    }
}

impl Interface {
    /// Takes note of the gaps with which the interface begins to act, if it has not begun yet, in a step from `span[0]` to `span[1]`.
    pub fn begin_acting(&mut self, stage: &Stage, span: [f64; 2]) {
        if self.initial.begun || !self.schedule.active(0.5 * (span[0] + span[1])) {
            return;
        }
        self.initial.begun = true;
        self.initial.span = span;
        if !matches!(self.initial.start, Start::Offset | Start::Ramp) {
            return;
        }
        let asleep = std::mem::take(&mut self.memory.asleep);
        let gaps = self.gaps_at(stage);
        self.memory.asleep = asleep;
        let largest = match self.initial.start {
            Start::Offset => self.initial.within.unwrap_or(CLOSE),
            _ => Within::Distance(0.0),
        };
        let points = gaps.iter().zip(&self.points);
        self.initial.offset = points
            .map(|(&gap, point)| {
                if gap <= largest.of(point.size) {
                    gap
                } else {
                    0.0
                }
            })
            .collect();
    }

    /// How the points of the secondary have to move to lie on the primary, where they are within the tolerance of it at time `t`.
    pub fn snaps(&self, t: f64) -> Vec<(usize, Vec3)> {
        let points = self.nodal_points();
        let facets = self.skin.iter().map(|s| s.facet.clone()).collect();
        let mut nodal = Interface {
            // Faces know their points by number.
            skin: skin(facets, &points, None),
            points,
            ..self.clone()
        };
        let x = nodal.reference.clone();
        let feet = nodal.feet(&x, t);
        let within = self.initial.within.unwrap_or(CLOSE);
        let near = |i: usize, gap: f64| {
            let size = nodal.points[i].size;
            // A distance is one of the gap: what overlaps is moved out, unless it lies beneath the whole cell and faces something else.
            let deepest = match within {
                Within::Fraction(_) => within.of(size),
                Within::Distance(d) => d.max(size),
            };
            gap != 0.0 && gap <= within.of(size) && -gap <= deepest
        };
        let chosen = |node: usize| {
            let only = self.initial.only.as_ref();
            only.is_none_or(|only| only.binary_search(&node).is_ok())
        };
        let feet = feet.into_iter().enumerate();
        feet.filter_map(|(i, foot)| Some((i, foot?)))
            .filter(|(i, (gap, _))| near(*i, *gap))
            .map(|(i, (gap, normal))| {
                let node = nodal.nodes[nodal.points[i].nodes[0]];
                (node, scale(-gap, normal))
            })
            .filter(|(node, _)| chosen(*node))
            .collect()
    }

    /// A point for every node of the secondary, whether contact is checked there or not.
    fn nodal_points(&self) -> Vec<ContactPoint> {
        let mut of = vec![None; self.nodes.len()];
        let mut out: Vec<ContactPoint> = Vec::new();
        for point in &self.points {
            for &node in &point.nodes {
                let k = *of[node].get_or_insert_with(|| {
                    out.push(ContactPoint {
                        nodes: vec![node],
                        weights: vec![1.0],
                        normal: [0.0; 3],
                        ..point.clone()
                    });
                    out.len() - 1
                });
                out[k].normal = add_scaled(out[k].normal, 1.0, point.normal);
            }
        }
        for point in &mut out {
            point.normal = normalize(point.normal).unwrap_or_default();
        }
        out
    }

    /// Gap and normal of every point at coordinates `x` of the nodes and time `t`; `None` where nothing lies opposite.
    fn feet(&mut self, x: &[Vec3], t: f64) -> Vec<Option<(f64, Vec3)>> {
        self.memory.searched_at.clear();
        match &self.primary {
            Primary::Rigid(shape, motion) => {
                let pose = motion.pose(t);
                let foot = |p: &ContactPoint| {
                    let foot = shape.as_dyn().foot(pose.inward(p.position(x)))?;
                    Some((foot.gap, pose.turn(foot.normal)))
                };
                self.points.iter().map(foot).collect()
            }
            Primary::Facets(_) => {
                self.search(x);
                let mut boxes = Vec::new();
                self.enclose(x, &mut boxes);
                (0..self.points.len())
                    .map(|i| {
                        let (_, foot) = self.closest(i, x, &boxes, None, None).ok()?;
                        let away = sub(self.points[i].position(x), foot.x);
                        Some((dot(away, foot.normal), foot.normal))
                    })
                    .collect()
            }
        }
    }
}
