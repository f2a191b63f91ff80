//! Where two bodies, or a body and an obstacle, overlap, touch and face each other, apart from any interface.

use std::collections::BTreeSet;

use crate::assess::doctor::places::bounds;
use crate::contact::facet_point::evaluate;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::look::FACING_COSINE;
use crate::contact::projection::{Patch, facet_distance};
use crate::contact::search::Tree;
use crate::math::{Vec3, add, distance, dot, sub};
use crate::model::definition::Model;
use crate::model::scene::Scene;
use crate::shape::ElementKind;
use crate::tolerance::SAME;

/// Part of a facet within which surfaces touch, and that curved ones may overlap by as they are meshed: an eighth of the angle by
/// which facets turn, of 23 degrees. Tests of planted defects pass with 0.015 and 0.15. It decides what is said, and no result.
pub(super) const TOUCHING_DISTANCE: f64 = 0.05;

/// The boundary of a body.
#[derive(Debug, Clone, Default)]
pub(super) struct Boundary {
    pub(super) facets: Vec<(ElementKind, Vec<usize>)>,
    pub(super) points: Vec<usize>,
}

/// How deep points of one lie in the other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Overlap {
    /// `[m]`
    pub(super) depth: f64,
    /// Length of the facet there `[m]`; zero where nothing overlaps.
    pub(super) facet: f64,
    pub(super) at: Vec3,
}

impl Overlap {
    /// The deeper one.
    pub(super) fn deeper(self, other: Overlap) -> Overlap {
        match other.depth > self.depth {
            true => other,
            false => self,
        }
    }
}

/// A model with its displacements at a time.
pub(super) struct Placed<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) u: &'a [f64],
    pub(super) t: f64,
}

impl Placed<'_> {
    fn x(&self, p: usize) -> Vec3 {
        add(
            self.scene.model.mesh.points[p],
            self.scene.model.dofs.vector(self.u, p),
        )
    }

    fn nodes(&self, points: &[usize]) -> Vec<Vec3> {
        points.iter().map(|&p| self.x(p)).collect()
    }

    fn tree(&self, boundary: &Boundary) -> Tree {
        let facets = boundary.facets.iter();
        Tree::build(facets.map(|f| f.1.iter().map(|&p| self.x(p))))
    }

    /// Lowest and highest coordinates.
    fn bounds(&self, boundary: &Boundary) -> (Vec3, Vec3) {
        let all: Vec<Vec3> = boundary.points.iter().map(|&p| self.x(p)).collect();
        bounds(&all)
    }

    /// The deepest of the points of one boundary within another body.
    pub(super) fn inside(&self, points: &Boundary, body: &Boundary) -> Overlap {
        let (low, high) = self.bounds(body);
        let rounding = SAME * self.scene.model.size;
        let flat = self.scene.model.mesh.dim;
        let within =
            |x: &Vec3| (0..flat).all(|c| x[c] > low[c] + rounding && x[c] < high[c] - rounding);
        let places: Vec<Vec3> = self
            .places(points)
            .into_iter()
            .map(|p| p.0)
            .filter(within)
            .collect();
        if places.is_empty() {
            return Overlap::default();
        }
        let tree = self.tree(body);
        let all = places.into_iter().filter_map(|x| {
            let near = self.nearest(body, &tree, x)?;
            (near.within && near.gap < 0.0).then_some(Overlap {
                depth: -near.gap,
                facet: near.facet,
                at: x,
            })
        });
        all.fold(Overlap::default(), Overlap::deeper)
    }

    /// Nodes and middles of the facets of a boundary, these with their normals.
    fn places(&self, boundary: &Boundary) -> Vec<(Vec3, Option<Vec3>)> {
        let nodes = boundary.points.iter().map(|&p| (self.x(p), None));
        let middles = boundary.facets.iter().map(|f| {
            let middle = match f.0 {
                ElementKind::Tri3 | ElementKind::Tri6 => [1.0 / 3.0; 2],
                _ => [0.0; 2],
            };
            let p = evaluate(f.0, &self.nodes(&f.1), middle);
            (p.x, Some(p.normal))
        });
        nodes.chain(middles).collect()
    }

    fn nearest(&self, body: &Boundary, tree: &Tree, x: Vec3) -> Option<Near> {
        let mut found = Vec::new();
        tree.near(x, 0.0, &mut found);
        let mut best: Option<Near> = None;
        for &f in &found {
            let facet = &body.facets[f];
            let nodes = self.nodes(&facet.1);
            let patch = Patch::new(facet.0, &nodes);
            let Some(p) = patch.project(x) else {
                continue;
            };
            let beyond = patch.beyond(&p);
            let within = beyond.distance == 0.0;
            let away = facet_distance(x, &p, beyond);
            if best.as_ref().is_none_or(|b| away < b.away) {
                best = Some(Near {
                    away,
                    within,
                    gap: dot(sub(x, p.x), p.normal),
                    normal: p.normal,
                    facet: distance(nodes[0], nodes[1]),
                });
            }
        }
        best
    }

    /// A middle of a facet of one boundary that lies on the other and faces it.
    pub(super) fn facing(&self, one: &Boundary, other: &Boundary) -> Option<Vec3> {
        let (low, high) = self.bounds(other);
        let longest = other.facets.iter().map(|f| {
            let x = self.nodes(&f.1);
            distance(x[0], x[1])
        });
        let reach = TOUCHING_DISTANCE * longest.fold(0.0, f64::max);
        let places: Vec<(Vec3, Vec3)> = (self.places(one).into_iter())
            .filter_map(|(x, n)| Some((x, n?)))
            .filter(|(x, _)| (0..3).all(|c| x[c] >= low[c] - reach && x[c] <= high[c] + reach))
            .collect();
        if places.is_empty() {
            return None;
        }
        let tree = self.tree(other);
        let touches = |(x, normal): &(Vec3, Vec3)| {
            let near = self.nearest(other, &tree, *x);
            near.is_some_and(|n| {
                n.within
                    && n.away <= TOUCHING_DISTANCE * n.facet
                    && dot(n.normal, *normal) < FACING_COSINE
            })
        };
        places.into_iter().find(touches).map(|p| p.0)
    }

    /// The deepest of the points of a body in an obstacle.
    pub(super) fn behind(&self, body: &Boundary, interface: &InterfaceDefinition) -> Overlap {
        let facet = body.facets.first().map_or(0.0, |f| {
            let x = self.nodes(&f.1);
            distance(x[0], x[1])
        });
        let all = body.points.iter().filter_map(|&p| {
            let x = self.x(p);
            let (gap, _) = gap(interface, x, self.t)?;
            (gap < 0.0).then_some(Overlap {
                depth: -gap,
                facet,
                at: x,
            })
        });
        all.fold(Overlap::default(), Overlap::deeper)
    }

    /// A middle of a facet of a body that stands on an obstacle.
    pub(super) fn standing(
        &self,
        body: &Boundary,
        interface: &InterfaceDefinition,
    ) -> Option<Vec3> {
        let middles = self.places(body).into_iter();
        let mut middles = middles.filter_map(|(x, n)| Some((x, n?))).zip(&body.facets);
        let found = middles.find(|((x, normal), facet)| {
            let nodes = self.nodes(&facet.1);
            let size = distance(nodes[0], nodes[1]);
            let foot = gap(interface, *x, self.t);
            foot.is_some_and(|(gap, n)| {
                gap.abs() <= TOUCHING_DISTANCE * size && dot(n, *normal) < FACING_COSINE
            })
        });
        found.map(|((x, _), _)| x)
    }
}

/// The facet nearest to a place.
struct Near {
    away: f64,
    /// The place lies over the facet, not beyond its edges.
    within: bool,
    gap: f64,
    normal: Vec3,
    facet: f64,
}

/// Gap of a place to the obstacle of an interface, and the normal there.
pub(super) fn gap(interface: &InterfaceDefinition, x: Vec3, t: f64) -> Option<(f64, Vec3)> {
    let Primary::Rigid(shape, motion) = &interface.primary else {
        return None;
    };
    let pose = motion.pose(t);
    let foot = shape.as_dyn().foot(pose.inward(sub(x, interface.origin)))?;
    Some((foot.gap, pose.turn(foot.normal)))
}

/// The boundaries of all bodies.
pub(super) fn boundaries(model: &Model) -> Vec<Boundary> {
    let mesh = &model.mesh;
    let mut out = vec![Boundary::default(); model.bodies.len()];
    for facet in mesh.boundary() {
        let block = facet.cell.block;
        let body = model.bodies.iter().position(|b| b.blocks.contains(&block));
        if let Some(body) = body {
            out[body].facets.push(mesh.facet_points(facet));
        }
    }
    for boundary in &mut out {
        let points = boundary.facets.iter().flat_map(|f| &f.1);
        let points: BTreeSet<usize> = points.copied().collect();
        boundary.points = points.into_iter().collect();
    }
    out
}
