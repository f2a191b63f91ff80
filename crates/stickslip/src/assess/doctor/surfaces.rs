//! How the two sides of an interface lie to each other, apart from any law.

use crate::contact::interface::{Interface, Primary};
use crate::contact::projection::{Patch, facet_distance};
use crate::contact::search::Tree;
use crate::contact::surface::Facet;
use crate::math::{Vec3, distance, dot, sub};

/// What lies nearest to a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
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
pub(crate) struct Opposite<'a> {
    interface: &'a Interface,
    tree: Tree,
    found: Vec<usize>,
    time: f64,
}

/// Coordinates of the nodes of a facet in the reference configuration.
pub(super) fn coordinates(interface: &Interface, facet: &Facet) -> Vec<Vec3> {
    let nodes = facet.nodes.iter();
    nodes.map(|&n| interface.reference[n]).collect()
}

impl<'a> Opposite<'a> {
    /// At time `time`, which matters to obstacles that move.
    pub fn new(interface: &'a Interface, time: f64) -> Self {
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

/// A length of a facet: half of it where it has nodes on its edges.
pub(super) fn spacing(interface: &Interface, facet: &Facet) -> f64 {
    let x = coordinates(interface, facet);
    let order = facet.kind.order().max(1) as f64;
    let corners = match (facet.kind.dim(), x.len()) {
        (1, _) => 2,
        (_, 3 | 6) => 3,
        _ => 4,
    };
    let longest: f64 = (0..corners)
        .map(|i| distance(x[i], x[(i + 1) % corners]))
        .sum::<f64>()
        / corners as f64;
    longest / order
}
