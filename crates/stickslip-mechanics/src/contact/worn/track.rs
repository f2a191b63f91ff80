//! What is worn off a primary that has no mesh to keep it on, an obstacle, or whose material moves past under its mesh: a depth in the coordinates of that matter.
//!
//! The depth is kept at places of a [`Chart`] that are about as far apart as the points of the secondary. A point lies over those beneath the faces around it, sampled so finely that an
//! even pressure leaves an even depth; what it takes is divided among them, and the gap sees their mean with the same weights. What is taken in an increment is left along the
//! way, in parts as long as places are apart, so that a long increment leaves the trace of many short ones. The volume of the depths is what the law says, to rounding.

use std::collections::BTreeMap;

use crate::contact::facet_point::evaluate;
use crate::contact::mortar::{FACE_NODES, positive};
use crate::contact::obstacle::{Chart, Place, Pose, Shape};
use crate::contact::surface::{ContactPoint, Facet, Skin, spacing};
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, normalize, sub};
use crate::shape::ElementKind;

/// Samples of a face along the distance of two places, in the plane and in space.
const SAMPLES_A_PLACE: [f64; 2] = [4.0, 2.0];

/// Where the depth of such a primary is kept, and what of it lies beneath each point.
#[derive(Debug, Clone, PartialEq)]
pub struct WearTrack {
    pub(in crate::contact) chart: Chart,
    /// Extent out of the plane, and by how much it grows with the radius.
    pub(in crate::contact) extent: [f64; 2],
    /// Places of the secondary by point.
    samples: Vec<Vec<Sample>>,
}

/// A place of the secondary: its nodes with their weights, and the part of a point that it stands for.
#[derive(Debug, Clone, PartialEq)]
struct Sample {
    nodes: Vec<(usize, f64)>,
    share: f64,
}

/// The depths of a track.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct TrackDepths {
    /// By place `[m]`.
    pub places: BTreeMap<Place, f64>,
    /// What each point has taken `[m³]`; empty before one has.
    pub taken: Vec<f64>,
    /// The part of what the other side loses on the way of each point that lay beneath it at the end of the last increment; empty before there was one.
    pub felt: Vec<f64>,
}

/// Where the matter of a primary is: the frame of an obstacle, and by how much it has moved in it since it was meshed.
pub(in crate::contact) struct Under {
    pub pose: Option<Pose>,
    pub moved: Vec3,
}

impl Under {
    /// A place in space, in the coordinates of the matter that is there.
    fn matter(&self, x: Vec3) -> Vec3 {
        match &self.pose {
            Some(pose) => sub(pose.inward(x), pose.turn_back(self.moved)),
            None => sub(x, self.moved),
        }
    }
}

/// The secondary of a track: its points, its faces and their nodes.
#[derive(Clone, Copy)]
pub struct TrackSampling<'a> {
    /// Points.
    pub points: &'a [ContactPoint],
    /// Faces; none where single points were chosen.
    pub skin: &'a [Skin],
    /// Coordinates of the nodes `[m]`.
    pub x: &'a [Vec3],
    /// Dimension of the space.
    pub dim: usize,
}

impl TrackSampling<'_> {
    /// The distance of its points, where they are nearest to each other.
    fn finest(&self) -> f64 {
        let faces = self.skin.iter().map(|s| spacing(&s.facet, self.x));
        let finest = faces.fold(f64::INFINITY, f64::min);
        let areas = self.points.iter().map(|p| p.area);
        match finest.is_finite() {
            true => finest,
            // Nothing better is known of single points.
            false => areas.fold(f64::INFINITY, f64::min).sqrt(),
        }
    }

    /// Samples by point, about so many to a distance.
    fn samples(&self, apart: f64, extent: &impl Fn(Vec3) -> f64) -> Vec<Vec<Sample>> {
        let mut out = vec![Vec::new(); self.points.len()];
        let per = SAMPLES_A_PLACE[usize::from(self.dim == 3)];
        for skin in self.skin {
            self.sample_face(skin, per / apart, extent, &mut out);
        }
        for (point, samples) in self.points.iter().zip(&mut out) {
            let whole: f64 = samples.iter().map(|s| s.share).sum();
            match whole > 0.0 {
                true => samples.iter_mut().for_each(|s| s.share /= whole),
                false => {
                    *samples = vec![Sample {
                        nodes: point
                            .nodes
                            .iter()
                            .copied()
                            .zip(point.weights.iter().copied())
                            .collect(),
                        share: 1.0,
                    }];
                }
            }
        }
        out
    }

    /// Adds the samples of a face, so many on a length.
    fn sample_face(
        &self,
        skin: &Skin,
        density: f64,
        extent: &impl Fn(Vec3) -> f64,
        out: &mut [Vec<Sample>],
    ) {
        let facet = &skin.facet;
        let count = facet.nodes.len();
        let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| self.x[n]).collect();
        let of_node = |n: usize| {
            let mut points = skin.points.iter().copied();
            points.find(|&i| self.points[i].node() == Some(n))
        };
        let points: Vec<Option<usize>> = facet.nodes.iter().map(|&n| of_node(n)).collect();
        let length = spacing(facet, self.x) * facet.kind.order().max(1) as f64;
        let divisions = (density * length).round().max(1.0) as usize;
        for xi in middles(facet.kind, divisions) {
            let at = evaluate(facet.kind, &nodes, xi);
            let area = norm(cross(at.a[0], at.a[1])) * extent(at.x);
            let mut weights = [0.0; FACE_NODES];
            weights[..count].copy_from_slice(&at.n[..count]);
            positive(facet.kind, &mut weights);
            for (&point, w) in points.iter().zip(weights) {
                if let Some(i) = point
                    && w != 0.0
                {
                    out[i].push(Sample {
                        nodes: facet.nodes.iter().copied().zip(at.n).collect(),
                        share: w * area,
                    });
                }
            }
        }
    }
}

/// Middles of equal parts of a face in reference coordinates, with so many divisions each way.
fn middles(kind: ElementKind, divisions: usize) -> Vec<[f64; 2]> {
    let n = divisions as f64;
    let middle = |k: usize| (2 * k + 1) as f64 / n - 1.0;
    match kind.linear() {
        ElementKind::Line2 => (0..divisions).map(|k| [middle(k), 0.0]).collect(),
        ElementKind::Tri3 => {
            // Triangles that stand up, and between them those that hang down.
            let third = |k: usize, part: f64| (k as f64 + part / 3.0) / n;
            let rows = (0..divisions).flat_map(|j| (0..divisions - j).map(move |i| (i, j)));
            let up = rows.clone().map(|(i, j)| [third(i, 1.0), third(j, 1.0)]);
            let down = rows.filter(|(i, j)| i + j + 1 < divisions);
            up.chain(down.map(|(i, j)| [third(i, 2.0), third(j, 2.0)]))
                .collect()
        }
        _ => (0..divisions * divisions)
            .map(|k| [middle(k % divisions), middle(k / divisions)])
            .collect(),
    }
}

impl WearTrack {
    /// Of an obstacle; `extent` is that out of the plane, thickness or `2πr`.
    pub fn of_obstacle(
        shape: &dyn Shape,
        above: TrackSampling,
        extent: impl Fn(Vec3) -> f64,
    ) -> Self {
        let chart = shape.chart(above.dim, above.finest());
        Self::on(chart, above, extent)
    }

    /// Of facets whose matter moves along a direction; `None` where they are not plane.
    pub fn of_facets(
        facets: &[Facet],
        direction: Vec3,
        above: TrackSampling,
        extent: impl Fn(Vec3) -> f64,
    ) -> Option<Self> {
        let at = facets.iter().map(|facet| {
            let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| above.x[n]).collect();
            let [s, t, _] = facet.kind.centre();
            evaluate(facet.kind, &nodes, [s, t])
        });
        let at: Vec<_> = at.collect();
        let sum = at.iter().fold([0.0; 3], |sum, p| add(sum, p.normal));
        let normal = normalize(sum)?;
        // From this cosine of the angle between facets and their mean on a surface is not plane.
        let plane = at.iter().all(|p| dot(p.normal, normal) > 1.0 - 1e-6);
        let chart = Chart::plane(at.first()?.x, normal, above.dim, above.finest());
        plane.then(|| Self::on(chart.along(direction), above, extent))
    }

    fn on(chart: Chart, above: TrackSampling, extent: impl Fn(Vec3) -> f64) -> Self {
        let [least, most] = [0.0, 1.0].map(|r| extent([r, 0.0, 0.0]));
        WearTrack {
            samples: above.samples(chart.spacing(), &extent),
            extent: [least, most - least],
            chart,
        }
    }

    /// The places beneath a point, with weights that add up to one.
    pub(in crate::contact) fn beneath<'a>(
        &'a self,
        i: usize,
        x: &'a [Vec3],
        under: &'a Under,
    ) -> impl Iterator<Item = (Place, f64)> + 'a {
        self.samples[i].iter().flat_map(move |sample| {
            let at = (sample.nodes.iter()).fold([0.0; 3], |at, &(n, w)| add_scaled(at, w, x[n]));
            let around = self.chart.around(under.matter(at));
            around.map(|(place, w)| (place, w * sample.share))
        })
    }
}
