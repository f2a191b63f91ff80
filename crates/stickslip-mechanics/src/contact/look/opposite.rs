//! How the two sides of an interface lie to each other, apart from any law.

use super::super::interface::{InterfaceDefinition, Primary};
use crate::contact::facet_point::evaluate;
use crate::contact::projection::{Patch, facet_distance};
use crate::contact::search::Tree;
use crate::contact::surface::Facet;
use crate::math::{Vec3, distance, dot, sub};
use crate::shape::ElementKind;
use crate::tolerance::NEGLIGIBLE;

/// Cosine between outward normals below which two places face each other: 17 degrees beyond a right angle, which neighbouring faces of a body have. With -0.1
/// and -0.7 all short cases (see [`tolerance`](crate::tolerance)) have the same findings. It decides what is said, and no result.
pub const FACING_COSINE: f64 = -0.3;

/// What lies nearest to a point.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    /// The facet; meaningless for an obstacle.
    pub facet: usize,
    /// Place on it.
    pub xi: [f64; 2],
    /// Distance to it `[m]`.
    pub distance: f64,
    /// Gap along its normal `[m]`.
    pub gap: f64,
    /// Normal out of the primary.
    pub normal: Vec3,
}

/// The facets of an interface, to be asked for many points.
pub struct Opposite<'a> {
    interface: &'a InterfaceDefinition,
    tree: Tree,
    found: Vec<usize>,
    time: f64,
}

/// Coordinates of the nodes of a facet in the reference configuration.
pub fn coordinates(interface: &InterfaceDefinition, facet: &Facet) -> Vec<Vec3> {
    let nodes = facet.nodes.iter();
    nodes.map(|&n| interface.reference[n]).collect()
}

impl<'a> Opposite<'a> {
    /// At time `time`, which matters to obstacles that move.
    pub fn new(interface: &'a InterfaceDefinition, time: f64) -> Self {
        let tree = match &interface.primary {
            Primary::Facets(facets) => {
                let x = |n: &usize| interface.reference[*n];
                Tree::build(facets.iter().map(|f| f.nodes.iter().map(x)))
            }
            Primary::Rigid(..) => Tree::default(),
        };
        Opposite {
            interface,
            tree,
            found: Vec::new(),
            time,
        }
    }

    /// The place on the edge of a facet that is nearest to a place beside it; `None` of one that lies opposite the facet, or opposite an obstacle.
    pub fn edge(&self, nearest: &Nearest, x: Vec3) -> Option<Vec3> {
        let Primary::Facets(facets) = &self.interface.primary else {
            return None;
        };
        let facet = &facets[nearest.facet];
        let aside = nearest.distance - nearest.gap.abs();
        let nodes = coordinates(self.interface, facet);
        let xi = within(facet.kind, nearest.xi);
        let edge = evaluate(facet.kind, &nodes, xi).x;
        (aside > NEGLIGIBLE * distance(x, edge)).then_some(edge)
    }

    /// A node of the facet that lies nearest; `None` opposite an obstacle.
    pub fn node_of(&self, nearest: &Nearest) -> Option<usize> {
        match &self.interface.primary {
            Primary::Facets(facets) => Some(self.interface.nodes[facets[nearest.facet].nodes[0]]),
            Primary::Rigid(..) => None,
        }
    }

    /// A node of the facet that lies nearest to a place; `None` where nothing does, or an obstacle.
    pub fn facing(&mut self, x: Vec3) -> Option<usize> {
        let nearest = self.nearest(x)?;
        self.node_of(&nearest)
    }

    /// What lies nearest to a place, whichever way it faces.
    pub fn nearest(&mut self, x: Vec3) -> Option<Nearest> {
        let facets = match &self.interface.primary {
            Primary::Rigid(shape, motion) => {
                let pose = motion.pose(self.time);
                let foot = shape.as_dyn().foot(pose.inward(x))?;
                return Some(Nearest {
                    facet: 0,
                    xi: [0.0; 2],
                    distance: foot.gap.abs(),
                    gap: foot.gap,
                    normal: pose.turn(foot.normal),
                });
            }
            Primary::Facets(facets) => facets,
        };
        self.tree.near(x, 0.0, &mut self.found);
        let mut best: Option<Nearest> = None;
        for &f in &self.found {
            let nodes = coordinates(self.interface, &facets[f]);
            let patch = Patch::new(facets[f].kind, &nodes);
            let Some(p) = patch.project(x) else {
                continue;
            };
            let distance = facet_distance(x, &p, patch.beyond(&p));
            if best.is_none_or(|b| distance < b.distance) {
                best = Some(Nearest {
                    facet: f,
                    xi: p.xi,
                    distance,
                    gap: dot(sub(x, p.x), p.normal),
                    normal: p.normal,
                });
            }
        }
        best
    }
}

/// A place on a facet, inside of it.
fn within(kind: ElementKind, [a, b]: [f64; 2]) -> [f64; 2] {
    match kind {
        ElementKind::Line2 | ElementKind::Line3 => [a.clamp(-1.0, 1.0), 0.0],
        ElementKind::Tri3 | ElementKind::Tri6 => {
            let [a, b] = [a.clamp(0.0, 1.0), b.clamp(0.0, 1.0)];
            let most = f64::max(a + b, 1.0);
            [a / most, b / most]
        }
        _ => [a.clamp(-1.0, 1.0), b.clamp(-1.0, 1.0)],
    }
}
