//! Surfaces of the joined mesh as contact points and facets.

use std::collections::BTreeMap;

use super::faces::FaceGroups;
use super::fault::problem_error;
use crate::body::{Space, tributary_areas};
use crate::contact::crossing::crossing;
use crate::contact::facet_point::evaluate;
use crate::contact::mortar::{Face, Mortar, mean_weights, positive_areas};
use crate::contact::surface::{ContactPoint, Facet};
use crate::contact::walls::{depth_behind, depths};
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, add_scaled, cross, dot, norm, normalize, sub};
use crate::mesh::{FacetRef, Mesh, geometry};
use crate::model::Body;
use crate::shape::{ElementKind, QuadraturePoint, mass_rule};
use crate::tolerance::SAME;

/// Divisions of a quadrilateral, each way, with 2 × 2 points in each part.
const DIVISIONS: usize = 3;

/// Points of a quadratic face. 2 × 2 points integrate the serendipity functions exactly, and more would overconstrain the face. Where laws yield
/// it is the pressure that is integrated, which may act on a part of the face only and would go unseen between so few.
fn face_rule(kind: ElementKind, yields: bool) -> Vec<QuadraturePoint> {
    let plain = ElementKind::Quad4.reference().quadrature();
    match (kind, yields) {
        (ElementKind::Quad8, false) => plain.to_vec(),
        (ElementKind::Line3, false) => ElementKind::Line2.reference().quadrature().to_vec(),
        (_, false) => kind.reference().quadrature().to_vec(),
        (ElementKind::Quad8, true) => {
            let h = 1.0 / DIVISIONS as f64;
            let middle = |k: usize| (2 * k + 1) as f64 * h - 1.0;
            let parts =
                (0..DIVISIONS * DIVISIONS).map(|k| [middle(k / DIVISIONS), middle(k % DIVISIONS)]);
            let points = parts.flat_map(|[s, t]| {
                plain.iter().map(move |q| QuadraturePoint {
                    xi: [s + h * q.xi[0], t + h * q.xi[1], 0.0],
                    weight: h * h * q.weight,
                })
            });
            points.collect()
        }
        (_, true) => mass_rule(kind),
    }
}

/// Mesh points to positions in the interface.
#[derive(Default)]
pub(super) struct Numbering {
    pub(super) nodes: Vec<usize>,
    pub(super) local: BTreeMap<usize, usize>,
}

impl Numbering {
    pub(super) fn of(&mut self, node: usize) -> usize {
        *self.local.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            self.nodes.len() - 1
        })
    }
}

pub(super) struct Surfaces<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) space: Space,
    pub(super) bodies: &'a [Body],
}

/// What a facet adds to its contact points.
pub(super) struct Beneath {
    pub(super) normal: Vec3,
    pub(super) measure: f64,
    pub(super) modulus: f64,
    pub(super) height: f64,
}

impl Surfaces<'_> {
    pub(super) fn modulus(&self, block: usize) -> f64 {
        self.bodies
            .iter()
            .find(|b| b.blocks.contains(&block))
            .and_then(|b| b.elastic.constrained_modulus(block))
            .unwrap_or(0.0)
    }

    /// Where the coordinates of interfaces are counted from: near the middle of a model that lies many times its size away from where the user counts
    /// from, with so few digits that nothing is lost where it is taken off. Never another radius.
    pub(super) fn origin(&self) -> Vec3 {
        let Some(&first) = self.mesh.points.first() else {
            return [0.0; 3];
        };
        let (mut low, mut high) = (first, first);
        for x in &self.mesh.points {
            low = std::array::from_fn(|c| low[c].min(x[c]));
            high = std::array::from_fn(|c| high[c].max(x[c]));
        }
        let size = norm(sub(high, low));
        let unit = size.log2().ceil().exp2();
        std::array::from_fn(|c| {
            let middle = 0.5 * (low[c] + high[c]);
            // Multiple of its size by which a model lies away before its interfaces count coordinates from somewhere nearer.
            let far = middle.abs() > 16.0 * size && unit.is_normal();
            let radius = c == 0 && self.space == Space::Axisymmetric;
            match far && !radius {
                true => unit * (middle / unit).round(),
                false => 0.0,
            }
        })
    }

    pub(super) fn coordinates(&self, nodes: &[usize]) -> Vec<Vec3> {
        nodes.iter().map(|&n| self.mesh.points[n]).collect()
    }

    /// Normal and measure of a facet, and the stiffness and height of the cell beneath.
    pub(super) fn beneath(&self, facet: FacetRef) -> Beneath {
        let (kind, nodes) = self.mesh.facet_points(facet);
        let x = self.coordinates(&nodes);
        let (mut measure, mut normal) = (0.0, [0.0; 3]);
        for q in kind.reference().quadrature() {
            let p = evaluate(kind, &x, [q.xi[0], q.xi[1]]);
            let da = q.weight * norm(cross(p.a[0], p.a[1]));
            measure += da;
            normal = add_scaled(normal, da, p.normal);
        }
        let cell = self.mesh.cell_kind(facet.cell);
        // height of a prism is volume over base, of a pyramid (triangle, tetrahedron) dim times that, of a wedge on its side twice that
        let factor = match (cell.linear(), kind.linear()) {
            _ if cell.is_simplex() => cell.dim() as f64,
            (ElementKind::Wedge6, ElementKind::Quad4) => 2.0,
            _ => 1.0,
        };
        Beneath {
            normal,
            measure,
            modulus: self.modulus(facet.cell.block),
            height: factor * geometry::cell_measure(self.mesh, facet.cell) / measure,
        }
    }

    pub(super) fn facets(&self, facets: &[FacetRef], numbering: &mut Numbering) -> Vec<Facet> {
        facets
            .iter()
            .map(|&f| {
                let (kind, nodes) = self.mesh.facet_points(f);
                Facet {
                    kind,
                    nodes: nodes.iter().map(|&n| numbering.of(n)).collect(),
                    continues: Vec::new(),
                    modulus: self.modulus(f.cell.block),
                    cell: self.mesh.cell_id(f.cell),
                }
            })
            .collect()
    }

    /// Contact points: the nodes, each with its share of the area. Corners of quadratic faces in space have no share or a negative one, those of quadratic
    /// edges that are turned about an axis one in proportion to their radius, which is none on the axis: there points are means over the faces around each
    /// node on an `obstacle`, and quadrature points on facets.
    pub(super) fn points(
        &self,
        facets: &[FacetRef],
        without: &[usize],
        primary: f64,
        obstacle: bool,
        yields: bool,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let (curved, plain): (Vec<FacetRef>, Vec<FacetRef>) = facets.iter().partition(|&&f| {
            match self.mesh.facet_kind(f) {
                ElementKind::Tri6 | ElementKind::Quad8 => true,
                // Means are those of the whole surface; quadrature points are needed where a node has nothing.
                ElementKind::Line3 => self.turned(obstacle, f),
                _ => false,
            }
        });
        let mut out = self.nodal_points(&plain, without, primary, numbering);
        out.extend(match obstacle {
            true => self.mean_points(&curved, primary, numbering),
            false => self.quadrature_points(&curved, primary, yields, numbering),
        });
        out
    }

    /// Whether an edge is turned about an axis, of facets whether it begins or ends there.
    pub(super) fn turned(&self, obstacle: bool, facet: FacetRef) -> bool {
        let (_, nodes) = self.mesh.facet_points(facet);
        let extents = || {
            nodes
                .iter()
                .map(|&n| self.space.extent(self.mesh.points[n]))
        };
        let most = extents().fold(0.0, f64::max);
        matches!(self.space, Space::Axisymmetric)
            && (obstacle || extents().any(|e| e <= SAME * most))
    }

    /// One point a node, the mean over the quadratic faces around it weighted by its dual function: as many points as a body can follow, with
    /// positive areas that make a uniform pressure exact. See [`mean_weights`].
    pub(super) fn mean_points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let mut at: BTreeMap<usize, usize> = BTreeMap::new();
        let mut out: Vec<ContactPoint> = Vec::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (kind, nodes) = self.mesh.facet_points(facet);
            let x = self.coordinates(&nodes);
            let areas = positive_areas(kind, &x, |at| self.space.extent(at));
            let stiffness = b.modulus.min(primary) / b.height;
            for (k, &node) in nodes.iter().enumerate() {
                let i = *at.entry(node).or_insert_with(|| {
                    let (hung, weights) = mean_weights(kind, k);
                    out.push(ContactPoint {
                        nodes: hung.iter().map(|&k| numbering.of(nodes[k])).collect(),
                        weights,
                        area: 0.0,
                        stiffness: 0.0,
                        normal: [0.0; 3],
                        size: 0.0,
                        across: Default::default(),
                    });
                    out.len() - 1
                });
                let point = &mut out[i];
                point.area += areas[k];
                point.stiffness += areas[k] * stiffness;
                point.size += areas[k] * b.height;
                point.normal = add_scaled(point.normal, areas[k] / b.measure, b.normal);
            }
        }
        for point in &mut out {
            point.stiffness /= point.area;
            point.size /= point.area;
            point.normal = normalize(point.normal).unwrap_or_default();
        }
        out
    }

    /// One point a node, but for those that have none: their share of the area goes to their neighbours.
    pub(super) fn nodal_points(
        &self,
        facets: &[FacetRef],
        without: &[usize],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        // sums over the facets around a node: normal, area, area × stiffness, area × height
        let mut sums: BTreeMap<usize, (Vec3, f64, f64, f64)> = BTreeMap::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (_, nodes) = self.mesh.facet_points(facet);
            let stiffness = b.modulus.min(primary) / b.height;
            for n in nodes {
                let s = sums.entry(n).or_default();
                s.0 = add_scaled(s.0, 1.0, b.normal);
                s.1 += b.measure;
                s.2 += b.measure * stiffness;
                s.3 += b.measure * b.height;
            }
        }
        let mut areas = tributary_areas(self.mesh, facets, self.space);
        self.hand_on(facets, without, &mut areas);
        areas
            .into_iter()
            .map(|(n, area)| {
                let (normal, measure, stiffness, height) = sums[&n];
                ContactPoint {
                    nodes: vec![numbering.of(n)],
                    weights: vec![1.0],
                    area,
                    stiffness: stiffness / measure,
                    normal: normalize(normal).unwrap_or_default(),
                    size: height / measure,
                    across: Default::default(),
                }
            })
            .collect()
    }

    /// Takes points of the mesh out of a list of areas, and gives the area of each to the others of the facets around it, in equal parts.
    fn hand_on(&self, facets: &[FacetRef], without: &[usize], areas: &mut Vec<(usize, f64)>) {
        let left_out = |n: &usize| without.binary_search(n).is_ok();
        for &tip in without {
            let Some(at) = areas.iter().position(|(n, _)| *n == tip) else {
                continue;
            };
            let around = facets.iter().map(|&f| self.mesh.facet_points(f).1);
            let around = around.filter(|nodes| nodes.contains(&tip));
            let mut heirs: Vec<usize> = around.flatten().filter(|n| !left_out(n)).collect();
            heirs.sort_unstable();
            heirs.dedup();
            let (_, area) = areas.remove(at);
            let part = area / heirs.len() as f64;
            for (n, area) in areas.iter_mut() {
                if heirs.binary_search(n).is_ok() {
                    *area += part;
                }
            }
        }
    }

    pub(super) fn quadrature_points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        yields: bool,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let mut out = Vec::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (kind, nodes) = self.mesh.facet_points(facet);
            let x = self.coordinates(&nodes);
            let rule = face_rule(kind, yields);
            let local: Vec<usize> = nodes.iter().map(|&n| numbering.of(n)).collect();
            for q in rule {
                let p = evaluate(kind, &x, [q.xi[0], q.xi[1]]);
                out.push(ContactPoint {
                    nodes: local.clone(),
                    weights: p.n[..nodes.len()].to_vec(),
                    area: q.weight * norm(cross(p.a[0], p.a[1])) * self.space.extent(p.x),
                    stiffness: b.modulus.min(primary) / b.height,
                    normal: p.normal,
                    size: b.height,
                    across: Default::default(),
                });
            }
        }
        out
    }

    /// How deep behind each face of a surface a place may lie and be met; empty where any depth will do.
    fn depths(&self, faces: &[FacetRef]) -> Vec<f64> {
        let mut numbering = Numbering::default();
        let faces = self.facets(faces, &mut numbering);
        depths(&faces, &self.coordinates(&numbering.nodes))
    }

    /// One contact point a node and smooth part of the surface, and the faces that they are weighted over. Points of the mesh `without` one have no
    /// multiplier of their own: on each face their dual function goes to the nearest node that has one.
    pub(super) fn mortar(
        &self,
        facets: &[FacetRef],
        without: &[usize],
        primary: f64,
        angle: f64,
        numbering: &mut Numbering,
    ) -> (Vec<ContactPoint>, Mortar) {
        let beneath: Vec<Beneath> = facets.iter().map(|&f| self.beneath(f)).collect();
        let shapes: Vec<(ElementKind, Vec<usize>)> =
            facets.iter().map(|&f| self.mesh.facet_points(f)).collect();
        let normals: Vec<Vec3> = (beneath.iter())
            .map(|b| normalize(b.normal).unwrap_or_default())
            .collect();
        let groups = FaceGroups::new(&shapes, &normals, angle);
        let depths = self.depths(facets);
        let mut points: Vec<ContactPoint> = Vec::new();
        let mut known: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut faces = Vec::new();
        for (k, (kind, nodes)) in shapes.iter().enumerate() {
            let x = self.coordinates(nodes);
            let areas = positive_areas(*kind, &x, |at| self.space.extent(at));
            let b = &beneath[k];
            let stiffness = b.modulus.min(primary) / b.height;
            let mut face = Face {
                kind: *kind,
                nodes: nodes.iter().map(|&n| numbering.of(n)).collect(),
                points: Vec::new(),
                normals: groups.normals(k).to_vec(),
                extents: x.iter().map(|&x| self.space.extent(x)).collect(),
                area: areas.iter().sum(),
                held: vec![false; nodes.len()],
                areas: areas.clone(),
                depth: depth_behind(&depths, k),
                continues: Vec::new(),
            };
            for (a, area) in areas.iter().enumerate() {
                let own = heir(nodes, &x, without, a);
                let normal = face.normals[own];
                let at = *known
                    .entry((nodes[own], groups.group(k)))
                    .or_insert_with(|| {
                        points.push(ContactPoint {
                            nodes: vec![face.nodes[own]],
                            weights: vec![1.0],
                            area: 0.0,
                            stiffness: 0.0,
                            normal,
                            size: 0.0,
                            across: Default::default(),
                        });
                        points.len() - 1
                    });
                face.points.push(at);
                let point = &mut points[at];
                point.area += area;
                point.stiffness += area * stiffness;
                point.size += area * b.height;
            }
            faces.push(face);
        }
        for point in &mut points {
            point.stiffness /= point.area;
            point.size /= point.area;
        }
        let mortar = Mortar::new(faces, points.len());
        (points, mortar)
    }

    /// No facet of a surface runs through another.
    pub(super) fn simple(&self, key: &str, facets: &[FacetRef]) -> Result<(), Error> {
        let mut numbering = Numbering::default();
        let surface = self.facets(facets, &mut numbering);
        let x = self.coordinates(&numbering.nodes);
        let Some((i, j)) = crossing(&surface, &x) else {
            return Ok(());
        };
        let cell = |k: usize| {
            let body = self
                .bodies
                .iter()
                .find(|b| b.blocks.contains(&facets[k].cell.block));
            format!(
                "cell {} of body {}",
                surface[k].cell,
                body.map_or("?", |b| b.name.as_str())
            )
        };
        let at = x[surface[i].nodes[0]];
        let at: Vec<String> = at[..self.space.dim()].iter().map(f64::to_string).collect();
        Err(problem_error(vec![
            Diagnostic::new(
                key,
                format!(
                    "the surface runs through itself: at {} and {}, near ({})",
                    cell(i),
                    cell(j),
                    at.join(", ")
                ),
            )
            .help(
                "mend the mesh there, or make the set smaller; two surfaces that overlap belong on the two sides of an interface",
            ),
        ]))
    }

    /// The points that the two sides have in common: the tips of a slit, if any.
    ///
    /// # Errors
    /// If they have others in common.
    pub(super) fn tips(
        &self,
        key: &str,
        secondary: &[FacetRef],
        primary: &[FacetRef],
    ) -> Result<Vec<usize>, Error> {
        let ours = self.mesh.points_of_facets(secondary);
        let theirs = self.mesh.points_of_facets(primary);
        let mut shared = ours;
        shared.retain(|p| theirs.binary_search(p).is_ok());
        let others: Vec<String> = shared
            .iter()
            .filter(|&&p| !self.is_tip(p, &shared, secondary, primary))
            .map(|&p| self.mesh.point_ids[p].to_string())
            .collect();
        let nodes = match others.as_slice() {
            [] => return Ok(shared),
            [one] => format!("node {one}"),
            some if some.len() <= 5 => format!("nodes {}", some.join(", ")),
            many => format!("nodes {}, … {} in all", many[..5].join(", "), many.len()),
        };
        Err(problem_error(vec![
            Diagnostic::new(
                key,
                format!("primary and secondary share points ({nodes})"),
            )
            .help("the two surfaces must belong to different bodies or be apart; duplicate the nodes of a conforming interface. Only the tips of a slit, where its faces meet, may belong to both"),
        ]))
    }

    /// Whether a point that two surfaces share is one at which a slit ends: on both sides faces begin there that have points of their own, and
    /// they look at each other.
    fn is_tip(
        &self,
        point: usize,
        shared: &[usize],
        secondary: &[FacetRef],
        primary: &[FacetRef],
    ) -> bool {
        let at = self.mesh.points[point];
        // The faces around it: their mean normal, and the way to their middle.
        let side = |facets: &[FacetRef]| -> Option<(Vec3, Vec3)> {
            let (mut normal, mut way) = ([0.0; 3], [0.0; 3]);
            for &facet in facets {
                let (_, nodes) = self.mesh.facet_points(facet);
                if !nodes.contains(&point) {
                    continue;
                }
                if nodes.iter().all(|n| shared.binary_search(n).is_ok()) {
                    return None;
                }
                normal = add_scaled(normal, 1.0, self.beneath(facet).normal);
                for &n in &nodes {
                    way = add_scaled(way, 1.0, sub(self.mesh.points[n], at));
                }
            }
            Some((normalize(normal)?, normalize(way)?))
        };
        let (Some((n, to)), Some((m, too))) = (side(secondary), side(primary)) else {
            return false;
        };
        // The faces of a slit look at each other where it ends (cosine of the angle), and meshes may have them penetrate a little
        // there (sine of the angle).
        dot(n, m) < -0.5 && dot(to, m) > -0.1 && dot(too, n) > -0.1
    }
}

/// The node of a face whose contact point a node belongs to: its own, or that of the nearest one that has any.
fn heir(nodes: &[usize], x: &[Vec3], without: &[usize], a: usize) -> usize {
    let has = |k: &usize| without.binary_search(&nodes[*k]).is_err();
    if has(&a) {
        return a;
    }
    let others = (0..nodes.len()).filter(has);
    let away = |k: usize| norm(sub(x[k], x[a]));
    others
        .min_by(|&j, &k| away(j).total_cmp(&away(k)))
        .unwrap_or(a)
}
