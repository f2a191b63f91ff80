//! How much the pressure goes up and down from point to point.

use std::collections::{BTreeMap, BTreeSet};

use crate::contact::interface::view::ContactView;
use crate::contact::surface::{ContactPoint, Facet};
use crate::math::{Vec3, add, add_scaled, distance, dot, inverse, norm, scale, sub};

/// How much farther than the nearest of its face a quadrature point may be and still count as beside another: less
/// than the root of two, as far as those across a square are.
const BESIDE_NEAREST: f64 = 1.3;

/// The points beside each point of a secondary surface with these facets and reference coordinates, in order.
///
/// Nodes are beside each other along the edges of facets, so that a checkerboard changes sign from each to the next. Of quadrature points
/// it is the nearest of the same face, and the nearest of each face that shares an edge.
pub fn neighbours(points: &[ContactPoint], facets: &[Facet], x: &[Vec3]) -> Vec<Vec<usize>> {
    let mut beside: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); points.len()];
    let mut at_node: BTreeMap<usize, usize> = BTreeMap::new();
    let mut faces: BTreeMap<&[usize], Vec<usize>> = BTreeMap::new();
    for (i, point) in points.iter().enumerate() {
        match point.node() {
            Some(one) => {
                at_node.insert(one, i);
            }
            None => faces.entry(&point.nodes).or_default().push(i),
        }
    }
    for facet in facets {
        for pair in pairs(facet) {
            if let [Some(&a), Some(&b)] = pair.map(|n| at_node.get(&n)) {
                beside[a].insert(b);
                beside[b].insert(a);
            }
        }
    }
    let groups: Vec<(&[usize], Vec<usize>)> = faces.into_iter().collect();
    for (i, near) in across(points, &groups, x) {
        beside[i].extend(near);
    }
    beside
        .into_iter()
        .map(|s| s.into_iter().collect())
        .collect()
}

/// Nodes that follow each other along the edges of a facet, those in the middle of edges included.
fn pairs(facet: &Facet) -> Vec<[usize; 2]> {
    let n = &facet.nodes;
    let order: &[usize] = match (facet.kind.dim(), n.len()) {
        (1, 2) => return vec![[n[0], n[1]]],
        (1, _) => return vec![[n[0], n[2]], [n[2], n[1]]],
        (_, 3) => &[0, 1, 2],
        (_, 4) => &[0, 1, 2, 3],
        (_, 6) => &[0, 3, 1, 4, 2, 5],
        _ => &[0, 4, 1, 5, 2, 6, 3, 7],
    };
    let next = order.iter().cycle().skip(1);
    order
        .iter()
        .zip(next)
        .map(|(&a, &b)| [n[a], n[b]])
        .collect()
}

/// For quadrature points: the nearest of their own face and of those that share an edge with it.
fn across(
    points: &[ContactPoint],
    groups: &[(&[usize], Vec<usize>)],
    x: &[Vec3],
) -> Vec<(usize, Vec<usize>)> {
    let mut by_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (g, (nodes, _)) in groups.iter().enumerate() {
        for &n in *nodes {
            by_node.entry(n).or_default().push(g);
        }
    }
    let apart = |i: usize, j: usize| distance(points[i].position(x), points[j].position(x));
    let mut out = Vec::new();
    for (g, (nodes, members)) in groups.iter().enumerate() {
        let mut touching: BTreeMap<usize, usize> = BTreeMap::new();
        for n in *nodes {
            for &other in &by_node[n] {
                *touching.entry(other).or_default() += usize::from(other != g);
            }
        }
        // an edge of a quadratic face has three nodes
        let touching: Vec<usize> = touching
            .into_iter()
            .filter(|&(_, shared)| shared >= 3)
            .map(|(other, _)| other)
            .collect();
        for &i in members {
            let own: Vec<(f64, usize)> = members
                .iter()
                .filter(|&&j| j != i)
                .map(|&j| (apart(i, j), j))
                .collect();
            let nearest = own.iter().map(|o| o.0).fold(f64::INFINITY, f64::min);
            let mut near: Vec<usize> = own
                .iter()
                .filter(|o| o.0 <= BESIDE_NEAREST * nearest)
                .map(|o| o.1)
                .collect();
            for &other in &touching {
                let distances = groups[other].1.iter().map(|&j| (apart(i, j), j));
                let closest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
                near.extend(
                    closest
                        .filter(|c| c.0 <= BESIDE_NEAREST * nearest)
                        .map(|c| c.1),
                );
            }
            out.push((i, near));
        }
    }
    out
}

/// What the value at the origin should be, as weights of those at these places, if it varied linearly; `None` where they lie on one side.
fn linear(places: &[Vec3]) -> Option<Vec<f64>> {
    if places.len() < 2 {
        return None;
    }
    let n = places.len() as f64;
    let mean = scale(1.0 / n, places.iter().fold([0.0; 3], |s, &p| add(s, p)));
    let mut m = [[0.0; 3]; 3];
    for &p in places {
        let d = sub(p, mean);
        for (row, a) in m.iter_mut().zip(d) {
            for (m, b) in row.iter_mut().zip(d) {
                *m += a * b;
            }
        }
    }
    // The places lie in a line or a plane: a little in all directions makes the inverse exist and costs six digits of nothing.
    let little = 1e-6 * (m[0][0] + m[1][1] + m[2][2]);
    for (i, row) in m.iter_mut().enumerate() {
        row[i] += little;
    }
    let (inverse, _) = inverse(&m)?;
    let slope = inverse.map(|row| dot(row, mean));
    let weights: Vec<f64> = places
        .iter()
        .map(|&p| 1.0 / n - dot(sub(p, mean), slope))
        .collect();
    let weighted = places.iter().zip(&weights);
    let left = weighted.fold([0.0; 3], |s, (&p, &w)| add_scaled(s, w, p));
    let size = places.iter().map(|&p| norm(p)).sum::<f64>() / n;
    let inside = weights.iter().all(|&w| w > -0.1);
    (inside && norm(left) < 0.1 * size).then_some(weights)
}

/// The oscillation index of the pressure `[-]`: the part of it that goes up and down from each point to the next, relative to its mean.
///
/// At every point inside the contact (all its neighbours are in contact) the pressure is compared with that of a plane through its
/// neighbours: `d = p - p̂`. A smooth pressure is concave or convex over many points, `d` has the same sign there, and so do the flanks
/// of a singular one; where it oscillates the sign changes from each point to the next. What counts at a point is the smaller of
/// `|d|` there and at the neighbour of opposite sign, and the index is the sum of half of that over the sum of pressures, weighted by
/// areas: 1 for a checkerboard of zero and twice the mean, `a` for `p̄ (1 ± a)`, some 1e-3 or less for a Hertz pressure.
pub fn oscillation(contact: ContactView) -> f64 {
    let committed = &contact.state.points;
    if committed.len() != contact.points.len() || contact.neighbours.len() != contact.points.len() {
        return 0.0;
    }
    let at = |i: usize| contact.points[i].position(&contact.reference);
    let pressure = |i: usize| committed[i].pressure;
    let deviation: Vec<f64> = (0..contact.points.len())
        .map(|i| {
            let beside = &contact.neighbours[i];
            let closed = pressure(i) > 0.0 && beside.iter().all(|&j| pressure(j) > 0.0);
            if !closed {
                return 0.0;
            }
            let x = at(i);
            let places: Vec<Vec3> = beside.iter().map(|&j| sub(at(j), x)).collect();
            linear(&places).map_or(0.0, |weights| {
                let fit = beside.iter().zip(weights).map(|(&j, w)| w * pressure(j));
                pressure(i) - fit.sum::<f64>()
            })
        })
        .collect();
    let (mut swing, mut all) = (0.0, 0.0);
    for (i, &d) in deviation.iter().enumerate() {
        let area = contact.area_of(i);
        let against = |&j: &usize| match d * deviation[j] < 0.0 {
            true => d.abs().min(deviation[j].abs()),
            false => 0.0,
        };
        let most = contact.neighbours[i]
            .iter()
            .map(against)
            .fold(0.0, f64::max);
        swing += 0.5 * area * most;
        all += area * pressure(i).max(0.0);
    }
    if all > 0.0 { swing / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::interface::History;
    use crate::contact::interface::history::PointHistory;
    use crate::contact::interface::tests::sample;
    use crate::contact::kinematics::KinematicsModel;
    use crate::shape::ElementKind;

    const SIDE: usize = 17;

    /// A square of nodes, graded towards one corner, with this pressure at the places in the unit square.
    fn index(pressure: impl Fn(f64, f64, usize) -> f64) -> f64 {
        let at = |k: usize| (k as f64 / (SIDE - 1) as f64).powf(1.2);
        let reference: Vec<Vec3> = (0..SIDE * SIDE)
            .map(|k| [at(k % SIDE), at(k / SIDE), 0.0])
            .collect();
        let facets: Vec<Facet> = (0..(SIDE - 1) * (SIDE - 1))
            .map(|k| {
                let n = (k / (SIDE - 1)) * SIDE + k % (SIDE - 1);
                Facet {
                    kind: ElementKind::Quad4,
                    nodes: vec![n, n + 1, n + SIDE + 1, n + SIDE],
                    continues: Vec::new(),
                    modulus: 1.0,
                    cell: 0,
                }
            })
            .collect();
        let points: Vec<ContactPoint> = (0..SIDE * SIDE)
            .map(|k| ContactPoint {
                nodes: vec![k],
                weights: vec![1.0],
                area: 1.0,
                stiffness: 1.0,
                normal: [0.0, 0.0, -1.0],
                size: 1.0,
                across: Default::default(),
            })
            .collect();
        let mut interface = sample(ElementKind::Quad4, KinematicsModel::default());
        let mesh = interface.definition.mesh_mut();
        mesh.neighbours = neighbours(&points, &facets, &reference);
        mesh.nodes = (0..reference.len()).collect();
        mesh.points = points;
        let inner = &interface.neighbours[SIDE + 1];
        assert_eq!(*inner, [1, SIDE, SIDE + 2, 2 * SIDE + 1]);
        let history = reference.iter().enumerate().map(|(k, x)| PointHistory {
            pressure: pressure(x[0], x[1], k / SIDE + k % SIDE),
            ..PointHistory::default()
        });
        let state = History {
            points: history.collect(),
            ..History::default()
        };
        interface.definition.mesh_mut().reference = reference;
        oscillation(interface.view(&state))
    }

    #[test]
    fn a_checkerboard_has_the_index_of_its_amplitude_and_smooth_pressures_have_next_to_none() {
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        for amplitude in [0.05, 0.3, 0.99] {
            let found = index(|_, _, k| 3.0 * (1.0 + amplitude * sign(k)));
            assert!(
                (found / amplitude - 1.0).abs() < 0.1,
                "{found} for {amplitude}"
            );
        }
        let linear = index(|x, y, _| 1.0 + 2.0 * x - 0.5 * y);
        assert!(linear < 1e-5, "{linear}");
        let hertz = index(|x, y, _| {
            let r2 = ((x - 0.5).powi(2) + (y - 0.5).powi(2)) / 0.16;
            (1.0 - r2).max(0.0).sqrt()
        });
        assert!(hertz < 5e-3, "{hertz}");
        let punch = index(|x, _, _| 1.0 / (1.02 - (2.0 * x - 1.0).powi(2)).sqrt());
        assert!(punch < 2e-2, "{punch}");
    }

    #[test]
    fn a_linear_field_is_met_by_its_neighbours() {
        let places = [
            [1.0, 0.2, 0.0],
            [-0.7, 0.1, 0.0],
            [0.1, -1.0, 0.0],
            [0.0, 0.5, 0.0],
        ];
        let weights = linear(&places).expect("all around");
        let value = |p: Vec3| 3.0 + 2.0 * p[0] - p[1];
        let met: f64 = places
            .iter()
            .zip(&weights)
            .map(|(&p, w)| w * value(p))
            .sum();
        assert!((met - 3.0).abs() < 1e-5, "{met}");
        assert!(linear(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).is_none());
    }
}
