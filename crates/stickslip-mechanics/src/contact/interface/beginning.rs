//! How an interface begins to act: the gaps it counts from, and the places its points are moved to.

use super::definition::{Interface, Primary};
use super::initial::{CLOSE, Start, Within};
use super::search::Search;
use crate::contact::facet_point::evaluate;
use crate::contact::surface::{ContactPoint, skin};
use crate::math::{Vec3, add_scaled, cross, dot, normalize, scale, sub};
use crate::system::Stage;

impl Interface {
    /// Takes note of the gaps with which the interface begins to act, if it has not begun yet, in a step from `span[0]` to `span[1]`.
    pub fn begin_acting(&mut self, stage: &Stage, span: [f64; 2]) {
        if self.history.start.begun || !self.schedule.active(0.5 * (span[0] + span[1])) {
            return;
        }
        self.history.start.begun = true;
        self.history.start.span = span;
        if !matches!(self.initial.start, Start::Offset | Start::Ramp) {
            return;
        }
        let excluded = std::mem::take(&mut self.directives.excluded);
        let gaps = self.gaps_at(stage);
        self.directives.excluded = excluded;
        let largest = match self.initial.start {
            Start::Offset => self.initial.within.unwrap_or(CLOSE),
            _ => Within::Distance(0.0),
        };
        let points = gaps.iter().zip(&self.points).enumerate();
        self.history.start.offset = points
            .map(|(i, (&gap, point))| {
                // It is the gap of the meshes that counts as another one: heights stay.
                let gap = gap + self.relief.get(i).copied().unwrap_or(0.0);
                if gap <= largest.of(point.size) {
                    gap - self.initial.gap
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
        let nodal = Interface {
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

    /// Points of the mesh on both surfaces with the unit normal out of their body, a mean over the faces around each.
    pub fn outward(&self) -> Vec<(usize, Vec3)> {
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        let own = self.skin.iter().map(|skin| &skin.facet);
        for facet in own.chain(self.facets()) {
            let x: Vec<Vec3> = facet.nodes.iter().map(|&n| self.reference[n]).collect();
            let [s, t, _] = facet.kind.centre();
            let at = evaluate(facet.kind, &x, [s, t]);
            for &n in &facet.nodes {
                sums[n] = add_scaled(sums[n], 1.0, cross(at.a[0], at.a[1]));
            }
        }
        let nodes = self.nodes.iter().copied().zip(sums);
        nodes
            .filter_map(|(node, sum)| Some((node, normalize(sum)?)))
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
    fn feet(&self, x: &[Vec3], t: f64) -> Vec<Option<(f64, Vec3)>> {
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
                let mut search = Search::default();
                self.search(&mut search, x);
                let feet = self.closest_of_all(x, &search).into_iter().enumerate();
                feet.map(|(i, found)| {
                    let (_, foot) = found.ok()?;
                    let away = sub(self.points[i].position(x), foot.x);
                    Some((dot(away, foot.normal), foot.normal))
                })
                .collect()
            }
        }
    }
}
