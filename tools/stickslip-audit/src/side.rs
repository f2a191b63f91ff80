//! The two sides of an interface: points and facets of bodies, or an obstacle that moves.

use std::collections::{BTreeMap, BTreeSet};

use toml::Table;

use crate::case::{Case, Space, interpolate, kind, number, rows, text_of, vector};
use crate::element::Kind;
use crate::loads::{place, sense, stretch};
use crate::mesh::{Facet, Mesh};
use crate::vec3::{Vec3, add, along, cross, dot, norm, scale, sub, tangential, turned, unit};

/// A rigid shape with its motion.
#[derive(Debug, Clone)]
pub struct Obstacle {
    table: Table,
    flat: bool,
}

/// A surface.
pub enum Side {
    /// Of a body.
    Body {
        /// Its points.
        points: BTreeSet<usize>,
        /// Its facets.
        facets: Vec<Facet>,
    },
    /// A rigid shape.
    Rigid(Obstacle),
}

impl Side {
    /// By the name that an interface has for it.
    pub fn named(case: &Case, mesh: &Mesh, name: &str) -> Option<Side> {
        if let Some(table) = case.of("obstacle", name) {
            let flat = case.space.dim() == 2;
            return Some(Side::Rigid(Obstacle {
                table: table.clone(),
                flat,
            }));
        }
        let set = mesh.set(case, name)?;
        let facets: Vec<Facet> = mesh.facets_of(&set).cloned().collect();
        // Points of a set that are on none of its facets are no contact points.
        let points = facets.iter().flat_map(|f| f.nodes.clone()).collect();
        Some(Side::Body { points, facets })
    }
}

/// A point over a surface.
#[derive(Debug, Clone)]
pub struct Foot {
    /// Distance along the normal, negative inside.
    pub gap: f64,
    /// Normal out of the surface.
    pub normal: Vec3,
    /// What of the surface it is over: points and weights; none for an obstacle.
    pub weights: Vec<(usize, f64)>,
    /// The foot itself.
    pub place: Vec3,
}

impl Obstacle {
    fn frame(&self, t: f64) -> ([Vec3; 2], f64, Vec3) {
        let empty = Table::new();
        let motion = self
            .table
            .get("motion")
            .and_then(toml::Value::as_table)
            .unwrap_or(&empty);
        let table = rows(motion.get("translation"));
        let shift = std::array::from_fn(|i| interpolate(&table, t, i + 1));
        let Some(rotation) = motion.get("rotation").and_then(toml::Value::as_table) else {
            return ([[0.0; 3], [0.0, 0.0, 1.0]], 0.0, shift);
        };
        let axis = match rotation.contains_key("axis") {
            true => unit(vector(rotation, "axis")),
            false => [0.0, 0.0, 1.0],
        };
        let angle = interpolate(&rows(rotation.get("angle")), t, 1);
        ([vector(rotation, "centre"), axis], angle, shift)
    }

    /// Where what was at `x` when the obstacle was as drawn is at `t`.
    pub fn outward(&self, x: Vec3, t: f64) -> Vec3 {
        let ([centre, axis], angle, shift) = self.frame(t);
        add(add(turned(sub(x, centre), axis, angle), centre), shift)
    }

    fn inward(&self, x: Vec3, t: f64) -> Vec3 {
        let ([centre, axis], angle, shift) = self.frame(t);
        add(turned(sub(sub(x, shift), centre), axis, -angle), centre)
    }

    /// A point over it.
    pub fn foot(&self, x: Vec3, t: f64) -> Option<Foot> {
        let y = self.inward(x, t);
        let (name, keys) = ["plane", "cylinder", "sphere"]
            .into_iter()
            .find_map(|name| Some((name, self.table.get(name)?.as_table()?)))?;
        let (gap, normal) = if name == "plane" {
            let normal = unit(vector(keys, "normal"));
            (dot(sub(y, vector(keys, "point")), normal), normal)
        } else {
            let mut arm = sub(y, vector(keys, "centre"));
            if name == "cylinder" {
                let axis = if self.flat {
                    [0.0, 0.0, 1.0]
                } else {
                    unit(vector(keys, "axis"))
                };
                arm = tangential(arm, axis);
            }
            let sign = match keys.get("inside").and_then(toml::Value::as_bool) {
                Some(true) => -1.0,
                _ => 1.0,
            };
            (
                sign * (norm(arm) - number(keys, "radius")?),
                scale(sign, unit(arm)),
            )
        };
        let ([_, axis], angle, _) = self.frame(t);
        let normal = turned(normal, axis, angle);
        Some(Foot {
            gap,
            normal,
            weights: Vec::new(),
            place: sub(x, scale(gap, normal)),
        })
    }

    /// The angle by which what is now at `x` and has moved by `u` since `from` was turned about the axis together with the obstacle: no further than
    /// that, and not the other way.
    pub fn followed(&self, x: Vec3, u: Vec3, from: f64, to: f64) -> f64 {
        let ([centre, axis], before, shift) = self.frame(from);
        let (_, angle, now) = self.frame(to);
        let turn = angle - before;
        let start = tangential(sub(sub(x, u), add(centre, shift)), axis);
        let end = tangential(sub(x, add(centre, now)), axis);
        let own = dot(axis, cross(start, end)).atan2(dot(start, end));
        own.clamp(turn.min(0.0), turn.max(0.0))
    }

    /// How far what is now at `x` moves from one time to another.
    pub fn carried(&self, x: Vec3, from: f64, to: f64) -> Vec3 {
        sub(self.outward(self.inward(x, from), to), x)
    }
}

/// The nearest foot on facets whose normals look at the point or away from it; only feet inside a facet count, and the edge or the tip of a notch above a
/// point that is inside the body.
pub fn foot(mesh: &Mesh, facets: &[Facet], at: &[Vec3], x: Vec3) -> Option<Foot> {
    let inside = foot_inside(mesh, facets, at, x);
    let away = |node: &usize| norm(sub(x, at[*node]));
    let nodes = facets.iter().flat_map(|f| &f.nodes);
    let tip = nodes.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let distance = away(tip);
    if inside
        .as_ref()
        .is_some_and(|f| f.gap.abs() <= distance * (1.0 + 1e-9))
    {
        return inside;
    }
    // No facet is as near as this node: beyond an edge there is no foot, beneath a notch all facets around face away from the point.
    if let Some((edge, s)) = nearest_edge(facets, at, x) {
        return foot_on_edge(mesh, facets, at, x, edge, s);
    }
    let around: Vec<&Facet> = facets.iter().filter(|f| f.nodes.contains(tip)).collect();
    if !beneath(mesh, &around, at, x, at[*tip]) || on_border(&around, *tip) {
        return None;
    }
    Some(Foot {
        gap: -distance,
        normal: unit(sub(at[*tip], x)),
        weights: vec![(*tip, 1.0)],
        place: at[*tip],
    })
}

/// Whether all facets around a place face away from a point.
fn beneath(mesh: &Mesh, around: &[&Facet], at: &[Vec3], x: Vec3, place: Vec3) -> bool {
    around
        .iter()
        .all(|f| dot(sub(x, place), outward(mesh, f, at)) < 0.0)
}

/// The normal out of the body in the middle of a facet.
fn outward(mesh: &Mesh, facet: &Facet, at: &[Vec3]) -> Vec3 {
    let corners: Vec<Vec3> = facet.nodes.iter().map(|n| at[*n]).collect();
    let normal = unit(stretch(facet.kind, &corners, facet.kind.middle()));
    scale(sense(mesh, facet, at), normal)
}

/// The nearest edge and how far along it its nearest place is, as a part of its length; `None` where that is a node.
fn nearest_edge(facets: &[Facet], at: &[Vec3], x: Vec3) -> Option<([usize; 2], f64)> {
    let mut nearest: Option<(f64, [usize; 2], f64)> = None;
    for [a, b] in facets.iter().flat_map(edges) {
        let (along, arm) = (sub(at[b], at[a]), sub(x, at[a]));
        let s = (dot(along, arm) / dot(along, along)).clamp(0.0, 1.0);
        let off = norm(sub(arm, scale(s, along)));
        if nearest.is_none_or(|(least, _, _)| off < least) {
            nearest = Some((off, [a, b], s));
        }
    }
    let (_, edge, s) = nearest?;
    (0.0 < s && s < 1.0).then_some((edge, s))
}

/// The foot on an edge, if facets on both sides of it face away from the point.
fn foot_on_edge(
    mesh: &Mesh,
    facets: &[Facet],
    at: &[Vec3],
    x: Vec3,
    [a, b]: [usize; 2],
    s: f64,
) -> Option<Foot> {
    let place = add(scale(1.0 - s, at[a]), scale(s, at[b]));
    let beside = |f: &&Facet| f.nodes.contains(&a) && f.nodes.contains(&b);
    let both: Vec<&Facet> = facets.iter().filter(beside).collect();
    if both.len() < 2 || !beneath(mesh, &both, at, x, place) {
        return None;
    }
    let normals = both.iter().map(|f| outward(mesh, f, at));
    Some(Foot {
        gap: -norm(sub(x, place)),
        normal: unit(normals.fold([0.0; 3], add)),
        weights: vec![(a, 1.0 - s), (b, s)],
        place,
    })
}

/// The edges of a face by their ends, those of a quadratic one in two halves; a line has none.
fn edges(facet: &Facet) -> Vec<[usize; 2]> {
    if facet.kind.dim() < 2 {
        return Vec::new();
    }
    let (corners, middles) = facet.nodes.split_at(facet.kind.corners());
    let whole = |k: usize| [corners[k], corners[(k + 1) % corners.len()]];
    let halves = |k: usize| {
        let [a, b] = whole(k);
        middles
            .get(k)
            .map_or(vec![[a, b]], |m| vec![[a, *m], [*m, b]])
    };
    (0..corners.len()).flat_map(halves).collect()
}

/// The straight lines and plane triangles that stand for a facet where contact knows no others: a quadrilateral is divided along its first diagonal, of what is
/// quadratic the corners are cut off at the middles of the edges beside them.
fn pieces(facet: &Facet) -> Vec<Facet> {
    let (kind, pieces): (Kind, &[&[usize]]) = match facet.kind {
        Kind::Line(3) => (Kind::Line(2), &[&[0, 2], &[2, 1]]),
        Kind::Triangle(6) => (
            Kind::Triangle(3),
            &[&[0, 3, 5], &[1, 4, 3], &[2, 5, 4], &[3, 4, 5]],
        ),
        Kind::Quad(4) => (Kind::Triangle(3), &[&[0, 1, 2], &[0, 2, 3]]),
        Kind::Quad(8) => (
            Kind::Triangle(3),
            &[
                &[0, 4, 7],
                &[1, 5, 4],
                &[2, 6, 5],
                &[3, 7, 6],
                &[4, 5, 6],
                &[4, 6, 7],
            ],
        ),
        _ => return vec![facet.clone()],
    };
    let piece = |local: &&[usize]| Facet {
        kind,
        nodes: local.iter().map(|i| facet.nodes[*i]).collect(),
        ..facet.clone()
    };
    pieces.iter().map(piece).collect()
}

/// Whether the surface ends at a node, by the facets around it: at an edge that only one of them has, or of lines at a node that only one has.
fn on_border(around: &[&Facet], node: usize) -> bool {
    let mut edges: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for facet in around {
        let n = facet.kind.corners();
        let Some(at) = facet.nodes.iter().position(|p| *p == node) else {
            continue;
        };
        let edge = |a: usize, b: usize| {
            let [a, b] = [facet.nodes[a % n], facet.nodes[b % n]];
            [a.min(b), a.max(b)]
        };
        let own = match (facet.kind.dim(), at < n) {
            (1, true) => vec![[node, node]],
            (1, false) => Vec::new(),
            (_, true) => vec![edge(at, at + 1), edge(at, at + n - 1)],
            (_, false) => vec![edge(at, at + 1)],
        };
        for edge in own {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.values().any(|count| *count < 2)
}

/// The nearest foot inside a facet.
fn foot_inside(mesh: &Mesh, facets: &[Facet], at: &[Vec3], x: Vec3) -> Option<Foot> {
    let mut best: Option<Foot> = None;
    for facet in facets {
        let corners: Vec<Vec3> = facet.nodes.iter().map(|n| at[*n]).collect();
        let middle = place(facet.kind, &corners, facet.kind.middle());
        let radius = corners
            .iter()
            .map(|c| norm(sub(*c, middle)))
            .fold(0.0, f64::max);
        let far = norm(sub(x, middle)) - 1.1 * radius;
        if best.as_ref().is_some_and(|b| far > b.gap.abs()) {
            continue;
        }
        let Some(xi) = project(facet.kind, &corners, x) else {
            continue;
        };
        let foot = place(facet.kind, &corners, xi);
        let sense = sense(mesh, facet, at);
        let normal = unit(scale(sense, stretch(facet.kind, &corners, xi)));
        let gap = dot(sub(x, foot), normal);
        if best.as_ref().is_none_or(|b| gap.abs() < b.gap.abs()) {
            let weights = facet
                .nodes
                .iter()
                .copied()
                .zip(facet.kind.values(xi))
                .collect();
            best = Some(Foot {
                gap,
                normal,
                weights,
                place: foot,
            });
        }
    }
    best
}

/// Reference coordinates of the nearest place of a facet, by the method of Gauss and Newton; `None` if it is beyond the edge.
fn project(kind: Kind, x: &[Vec3], at: Vec3) -> Option<[f64; 3]> {
    let mut xi = kind.middle();
    for _ in 0..30 {
        let d = kind.gradients(xi);
        let rest = sub(at, place(kind, x, xi));
        let tangent = |k: usize| -> Vec3 {
            std::array::from_fn(|i| x.iter().zip(&d).map(|(x, d)| x[i] * d[k]).sum())
        };
        let (a, b) = (tangent(0), tangent(1));
        let step = match kind.dim() {
            1 => [dot(a, rest) / dot(a, a), 0.0],
            _ => {
                let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
                let (ra, rb) = (dot(a, rest), dot(b, rest));
                let det = aa * bb - ab * ab;
                [(bb * ra - ab * rb) / det, (aa * rb - ab * ra) / det]
            }
        };
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() {
            return None;
        }
        let share = if longest > 1.0 { 1.0 / longest } else { 1.0 };
        xi[0] += share * step[0];
        xi[1] += share * step[1];
        if longest < 1e-12 {
            break;
        }
    }
    const EDGE: f64 = 1e-9;
    let inside = match kind {
        Kind::Triangle(_) => xi[0] >= -EDGE && xi[1] >= -EDGE && xi[0] + xi[1] <= 1.0 + EDGE,
        _ => xi[0].abs() <= 1.0 + EDGE && xi[1].abs() <= 1.0 + EDGE,
    };
    inside.then_some(xi)
}

/// The nodes in the middle of edges of quadratic facets, with the ends of these edges.
pub(crate) fn middles(facets: &[Facet]) -> BTreeMap<usize, [usize; 2]> {
    let mut out = BTreeMap::new();
    for facet in facets {
        let (corners, middles) = facet.nodes.split_at(facet.kind.corners());
        for (k, middle) in middles.iter().enumerate() {
            out.insert(*middle, [corners[k], corners[(k + 1) % corners.len()]]);
        }
    }
    out
}

/// The two sides and the settings of an interface that the audit needs.
pub struct Pair {
    /// Name.
    pub name: String,
    /// Points are checked on this side.
    pub secondary: Side,
    /// This side carries the normal.
    pub primary: Side,
    /// `mortar` or `node-to-facet`.
    pub mortar: bool,
    /// Nodes whose points are means over their faces, each with the ends of its edge: the middle ones of quadratic faces in mortar contact, and in space and on
    /// rings on obstacles. See [`Pair::mean`].
    pub means: BTreeMap<usize, [usize; 2]>,
    /// Whether both sides are secondary.
    pub two_sided: bool,
    /// Whether the sides are glued together.
    pub tied: bool,
    /// The word of the kinematics.
    pub kinematics: String,
    /// Whether gaps count as meshed.
    pub as_meshed: bool,
    /// Whether surfaces resist approach as well.
    pub damped: bool,
    /// Whether the material of the primary moves by itself.
    pub belt: bool,
    /// Whether the side that the problem calls secondary is `primary` here. What is written of forces and slip is that of the sides as they are named.
    pub exchanged: bool,
}

impl Pair {
    /// Reads an interface, of which the points may be those of the side that is named primary (`exchanged`).
    pub fn new(
        case: &Case,
        mesh: &Mesh,
        name: &str,
        table: &Table,
        exchanged: bool,
    ) -> Option<Pair> {
        let mut keys = ["secondary", "primary"];
        if exchanged {
            keys.reverse();
        }
        let kinematics = kind(table, "kinematics")
            .map_or("convective", |k| k.0)
            .to_string();
        let discretisation = kind(table, "discretisation");
        let plane = kinematics == "pop-1995" || text_of(table, "facets") == Some("triangles");
        let mortar = match discretisation {
            Some((word, _)) => word == "mortar",
            None => !plane,
        };
        let primary = match Side::named(case, mesh, text_of(table, keys[1])?)? {
            Side::Body { points, facets } if plane => Side::Body {
                points,
                facets: facets.iter().flat_map(pieces).collect(),
            },
            side => side,
        };
        let flag =
            |table: &Table, key: &str| table.get(key).and_then(toml::Value::as_bool) == Some(true);
        let initial = text_of(table, "initial").unwrap_or("as-meshed");
        let secondary = Side::named(case, mesh, text_of(table, keys[0])?)?;
        let obstacle = matches!(primary, Side::Rigid(_));
        let mortar = mortar && !obstacle;
        // On obstacles points of quadratic faces are means over the faces around them in space, and of edges around an axis.
        let means = match (&secondary, case.space) {
            (Side::Body { facets, .. }, Space::Solid | Space::Ring) if mortar || obstacle => {
                middles(facets)
            }
            (Side::Body { facets, .. }, _) if mortar => middles(facets),
            _ => BTreeMap::new(),
        };
        Some(Pair {
            name: name.to_string(),
            means,
            secondary,
            mortar,
            primary,
            two_sided: discretisation.is_some_and(|(_, keys)| flag(keys, "two-sided")),
            tied: flag(table, "tied"),
            kinematics,
            as_meshed: initial == "as-meshed",
            damped: kind(table, "damping").is_some_and(|d| d.0 != "none"),
            belt: table.contains_key("primary-velocity")
                || table.contains_key("primary-velocity-table")
                || case.steps.iter().any(|s| s.table.contains_key("steady")),
            exchanged,
        })
    }

    /// What a point has of something that the nodes have: of the middle node of an edge the mean over the faces around it weighted by the dual of its
    /// function, which has a fifth of that of the middle node at each corner (Popp et al., SIAM Journal on Scientific Computing 34 (2012) B421).
    pub fn mean(&self, node: usize, of: impl Fn(usize) -> Option<f64>) -> Option<f64> {
        match self.means.get(&node) {
            Some(&[a, b]) => Some((of(node)? - 0.2 * (of(a)? + of(b)?)) / 0.6),
            None => of(node),
        }
    }

    /// The forces of points, of the forces that they put on nodes: what [`Pair::mean`] does to gaps the other way round.
    pub fn gathered(&self, mut nodes: Vec<Vec3>) -> Vec<Vec3> {
        for (middle, corners) in &self.means {
            let whole = nodes[*middle];
            for corner in corners {
                nodes[*corner] = along(nodes[*corner], 0.2, whole);
            }
            nodes[*middle] = scale(0.6, whole);
        }
        nodes
    }

    /// By how much of it the slip so far of a point is turned together with an obstacle while nodes move by `u` to where they are.
    pub fn swing(
        &self,
        node: usize,
        x: &[Vec3],
        u: &dyn Fn(usize) -> Vec3,
        times: [f64; 2],
    ) -> f64 {
        let Side::Rigid(obstacle) = &self.primary else {
            return 0.0;
        };
        let of = |n: usize| obstacle.followed(x[n], u(n), times[0], times[1]).abs();
        match self.means.get(&node) {
            Some(&[a, b]) => (of(node) + 0.2 * (of(a) + of(b))) / 0.6,
            None => of(node),
        }
    }

    /// The points of the secondary.
    pub fn points(&self) -> Option<&BTreeSet<usize>> {
        match &self.secondary {
            Side::Body { points, .. } => Some(points),
            Side::Rigid(_) => None,
        }
    }
}

#[cfg(test)]
impl Pair {
    /// A pair of nothing.
    pub(crate) fn bare(name: &str) -> Pair {
        let nowhere = || {
            Side::Rigid(Obstacle {
                table: Table::new(),
                flat: true,
            })
        };
        Pair {
            name: name.to_string(),
            secondary: nowhere(),
            primary: nowhere(),
            means: BTreeMap::new(),
            mortar: true,
            two_sided: false,
            tied: false,
            kinematics: String::new(),
            as_meshed: true,
            damped: false,
            exchanged: false,
            belt: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_over_quadratic_faces_are_those_of_their_dual_functions() {
        let facet = Facet {
            kind: Kind::Line(3),
            nodes: vec![4, 6, 5],
            cell: 0,
            body: 0,
        };
        let pair = Pair {
            means: middles(&[facet]),
            ..Pair::bare("joint")
        };
        // Dual to N̂ = (N_a + N_m / 5, N_b + N_m / 5, 3 N_m / 5) means that what is a sum of these has its coefficients for means: here f = s² at s = -1, 1, 0.
        let square = |node: usize| Some(if node == 5 { 0.0 } else { 1.0 });
        assert_eq!(pair.mean(4, square), Some(1.0));
        assert_eq!(pair.mean(6, square), Some(1.0));
        let middle = pair.mean(5, square).unwrap_or(f64::NAN);
        assert!((middle + 2.0 / 3.0).abs() < 1e-12, "{middle}");
        let nothing = |node: usize| (node != 4).then_some(0.0);
        assert_eq!(pair.mean(5, nothing), None);
    }

    /// Two faces that meet in a valley above a point: the edge between them is its foot, however far the nearest node is.
    #[test]
    fn a_point_beneath_the_edge_between_two_faces_has_its_foot_there() {
        let face = |nodes: [usize; 4], cell: usize| Facet {
            kind: Kind::Quad(4),
            nodes: nodes.to_vec(),
            cell,
            body: 0,
        };
        let rise = 1e-3;
        let line = |x: f64, z: f64| [0.0, 1.0, 2.0].map(|y| [x, y, z]);
        let mut points: Vec<Vec3> = [line(-1.0, rise), line(0.0, 0.0), line(1.0, rise)].concat();
        points.extend([[-0.5, 0.5, -1.0], [0.5, 0.5, -1.0]]);
        let facets = [
            face([0, 3, 4, 1], 0),
            face([1, 4, 5, 2], 0),
            face([3, 6, 7, 4], 1),
            face([4, 7, 8, 5], 1),
        ];
        let mesh = Mesh {
            points: points.clone(),
            cells: vec![
                (Kind::Tetrahedron(4), vec![0, 3, 4, 9]),
                (Kind::Tetrahedron(4), vec![3, 6, 7, 10]),
            ],
            owner: vec![0; 2],
            body: vec![0; 11],
            names: vec!["block".into()],
            facets: Vec::new(),
        };
        let found = foot(&mesh, &facets, &points, [0.0, 0.8, -0.01]).expect("a foot");
        assert!((found.gap + 0.01).abs() < 1e-12, "{found:?}");
        assert!((found.normal[2] - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.place[1] - 0.8).abs() < 1e-12, "{found:?}");
        assert_eq!(found.weights.len(), 2);
        // Outside, beyond a ridge, there is none.
        let ridge: Vec<Vec3> = points
            .iter()
            .map(|p| [p[0], p[1], p[2].min(-p[2])])
            .collect();
        assert!(foot(&mesh, &facets, &ridge, [0.0, 0.8, 0.01]).is_none());
    }

    /// Only within a surface is a node the tip of a notch.
    #[test]
    fn a_surface_ends_where_facets_have_no_neighbour() {
        let facet = |a: usize, b: usize| Facet {
            kind: Kind::Line(2),
            nodes: vec![a, b],
            cell: 0,
            body: 0,
        };
        let facets = [facet(0, 1), facet(1, 2)];
        let around: Vec<&Facet> = facets.iter().collect();
        assert!(!on_border(&around, 1));
        assert!(on_border(&around[..1], 0));
        let face = |nodes: [usize; 4]| Facet {
            kind: Kind::Quad(4),
            nodes: nodes.to_vec(),
            cell: 0,
            body: 0,
        };
        // Four faces around node 4 of a grid of nine.
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]].map(face);
        let all: Vec<&Facet> = faces.iter().collect();
        assert!(!on_border(&all, 4));
        assert!(on_border(&all[..2], 1));
    }

    /// A quadrilateral is divided along its first diagonal; what is quadratic loses nothing of its area.
    #[test]
    fn plane_pieces_meet_along_the_first_diagonal() {
        let facet = |kind, n: usize| Facet {
            kind,
            nodes: (10..10 + n).collect(),
            cell: 0,
            body: 0,
        };
        let nodes = |f: &Facet| f.nodes.clone();
        let whole = facet(Kind::Quad(4), 4);
        let two: Vec<_> = pieces(&whole).iter().map(nodes).collect();
        assert_eq!(two, [[10, 11, 12], [10, 12, 13]]);
        // The area of what is quadratic, with straight sides, is that of its pieces, each the right way round.
        let corners = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [0.0, 2.0],
            [1.0, 0.0],
            [2.0, 1.0],
            [1.0, 2.0],
            [0.0, 1.0],
        ];
        let area = |f: &Facet| {
            let [a, b, c] = [0, 1, 2].map(|k| corners[f.nodes[k] - 10]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        let areas: Vec<f64> = pieces(&facet(Kind::Quad(8), 8)).iter().map(area).collect();
        assert_eq!(areas.len(), 6);
        assert!(areas.iter().all(|a| *a > 0.0) && areas.iter().sum::<f64>() == 4.0);
        assert_eq!(pieces(&facet(Kind::Triangle(6), 6)).len(), 4);
        assert_eq!(pieces(&facet(Kind::Line(2), 2)).len(), 1);
    }

    /// Forces of points 3 on a middle and 1 and 2 on its corners, as nodes get them, are gathered again.
    #[test]
    fn forces_of_points_are_found_in_those_of_nodes() {
        let pair = Pair {
            means: BTreeMap::from([(2, [0, 1])]),
            ..Pair::bare("joint")
        };
        let up = |z: f64| [0.0, 0.0, z];
        let spread = vec![
            up(1.0 - 0.2 * 3.0 / 0.6),
            up(2.0 - 0.2 * 3.0 / 0.6),
            up(3.0 / 0.6),
        ];
        let found = pair.gathered(spread);
        for (found, due) in found.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found[2] - due).abs() < 1e-15, "{found:?}");
        }
    }

    /// On a plate that turns by 0.2 a point that turned by 0.1 with it has followed by that much, one that went the other way not at all.
    #[test]
    fn a_point_follows_an_obstacle_as_far_as_it_goes_along() {
        let table = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmotion.rotation = { centre = [1, 0, 0], axis = [0, 0, 1], angle = [[0, 0], [1, 0.2]] }";
        let pair = Pair {
            primary: Side::Rigid(Obstacle {
                table: table.parse().expect("a table"),
                flat: false,
            }),
            ..Pair::bare("joint")
        };
        let swing = |angle: f64| {
            let x = [1.0 + 2.0 * angle.cos(), 2.0 * angle.sin(), 0.0];
            pair.swing(0, &[x], &|_| sub(x, [3.0, 0.0, 0.0]), [0.0, 1.0])
        };
        for (angle, due) in [(0.1, 0.1), (-0.1, 0.0), (0.5, 0.2)] {
            assert!((swing(angle) - due).abs() < 1e-12, "{angle}");
        }
    }
}
