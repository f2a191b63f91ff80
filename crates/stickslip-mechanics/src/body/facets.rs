//! Integrals over boundary facets.

use super::Space;
use crate::math::{Vec3, add_scaled, cross, norm, scale};
use crate::mesh::{FacetRef, Mesh};
use crate::shape::MAX_NODES;

/// A quadrature point of a facet.
pub(super) struct FacetPoint<'a> {
    /// Points of the facet.
    pub points: &'a [usize],
    /// Shape functions there.
    pub values: &'a [f64],
    /// Area it stands for `[m²]`, with thickness or circumference.
    pub area: f64,
    /// Unit normal out of the body.
    pub normal: Vec3,
}

/// A quadrature point of a facet, wherever its points are.
pub(super) struct Faced<'a> {
    /// Points of the facet.
    pub points: &'a [usize],
    /// Shape functions there.
    pub values: &'a [f64],
    /// Their derivatives along the facet.
    pub gradients: &'a [Vec3],
    /// Weight.
    pub weight: f64,
    /// Place.
    pub x: Vec3,
    /// Tangents.
    pub tangents: [Vec3; 2],
    /// Normal out of the body, as long as the area is large.
    pub across: Vec3,
}

/// Visits the quadrature points of a facet whose points are at some places.
pub(super) fn each_face_point(
    mesh: &Mesh,
    facet: FacetRef,
    place: &dyn Fn(usize) -> Vec3,
    visit: &mut dyn FnMut(&Faced),
) {
    let block = &mesh.blocks[facet.cell.block];
    let nodes = block.kind.node_count();
    let connectivity = &block.connectivity[facet.cell.cell * nodes..][..nodes];
    let face = &block.kind.reference().faces()[facet.face];
    let count = face.nodes.len();
    let mut points = [0; MAX_NODES];
    for (p, &local) in points.iter_mut().zip(face.nodes) {
        *p = connectivity[local];
    }
    let points = &points[..count];
    let element = face.kind.reference();
    let mut n = [0.0; MAX_NODES];
    let mut d = [[0.0; 3]; MAX_NODES];
    for q in element.quadrature() {
        element.values(q.xi, &mut n[..count]);
        element.gradients(q.xi, &mut d[..count]);
        let (mut x, mut t1, mut t2) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (a, &p) in points.iter().enumerate() {
            let at = place(p);
            x = add_scaled(x, n[a], at);
            t1 = add_scaled(t1, d[a][0], at);
            t2 = add_scaled(t2, d[a][1], at);
        }
        visit(&Faced {
            points,
            values: &n[..count],
            gradients: &d[..count],
            weight: q.weight,
            x,
            tangents: [t1, t2],
            across: match mesh.dim {
                2 => [t1[1], -t1[0], 0.0],
                _ => cross(t1, t2),
            },
        });
    }
}

/// Visits the quadrature points of a facet. Facets that have shrunk to nothing have none.
pub(super) fn visit_facet(
    mesh: &Mesh,
    space: Space,
    facet: FacetRef,
    visit: &mut dyn FnMut(FacetPoint),
) {
    each_face_point(mesh, facet, &|p| mesh.points[p], &mut |q| {
        let measure = norm(q.across);
        if measure > 0.0 {
            visit(FacetPoint {
                points: q.points,
                values: q.values,
                area: q.weight * measure * space.extent(q.x),
                normal: scale(1.0 / measure, q.across),
            });
        }
    });
}

/// Sums the entries of equal index; ascending, and each sum in the order of the entries.
pub(super) fn combine(entries: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    let Some(most) = entries.iter().map(|e| e.0).max() else {
        return entries;
    };
    // Entries of a whole body are many times its points: to sort them takes longer than to make them. Those of a patch are few in a large body.
    if most >= SCATTERED * entries.len() {
        return combine_sorted(entries);
    }
    let mut sums: Vec<Option<f64>> = vec![None; most + 1];
    for (index, value) in entries {
        let sum = &mut sums[index];
        *sum = Some(sum.map_or(value, |s| s + value));
    }
    let found = sums.into_iter().enumerate();
    found.filter_map(|(i, sum)| Some((i, sum?))).collect()
}

/// Places to an entry from which on it is faster to sort entries than to go through all places.
const SCATTERED: usize = 8;

fn combine_sorted(mut entries: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    entries.sort_by_key(|e| e.0);
    let mut out: Vec<(usize, f64)> = Vec::new();
    for (index, value) in entries {
        match out.last_mut() {
            Some(last) if last.0 == index => last.1 += value,
            _ => out.push((index, value)),
        }
    }
    out
}

/// The area `∫ N_i dA` `[m²]` that belongs to each point of the facets, points ascending; thickness or circumference
/// included.
///
/// These are the weights that make a constant pressure consistent. For quadratic facets in space they are not
/// positive: zero at the corners of tri6, negative at those of quad8. [`positive_areas`] are.
pub fn tributary_areas(mesh: &Mesh, facets: &[FacetRef], space: Space) -> Vec<(usize, f64)> {
    let mut entries = Vec::new();
    for &facet in facets {
        visit_facet(mesh, space, facet, &mut |q| {
            entries.extend(q.points.iter().zip(q.values).map(|(&p, n)| (p, n * q.area)));
        });
    }
    combine(entries)
}

/// The area `∫ N_i n dA` `[m²]` of each point of the facets, as a vector along their normals, points ascending; thickness or circumference included.
pub fn area_vectors(mesh: &Mesh, facets: &[FacetRef], space: Space) -> Vec<(usize, Vec3)> {
    let along = |c: usize| {
        let mut entries = Vec::new();
        for &facet in facets {
            visit_facet(mesh, space, facet, &mut |q| {
                let values = q.points.iter().zip(q.values);
                entries.extend(values.map(|(&p, n)| (p, n * q.area * q.normal[c])));
            });
        }
        combine(entries)
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    let both = x.into_iter().zip(y).zip(z);
    both.map(|(((p, x), (_, y)), (_, z))| (p, [x, y, z]))
        .collect()
}

/// The area of each facet divided among its points in the proportion of `∫ N_i² dA` `[m²]`, points ascending.
///
/// Positive for every kind of facet, and with the same sum as [`tributary_areas`]; a constant pressure is not
/// represented exactly on quadratic facets.
pub fn positive_areas(mesh: &Mesh, facets: &[FacetRef], space: Space) -> Vec<(usize, f64)> {
    let mut entries = Vec::new();
    for &facet in facets {
        let mut total = 0.0;
        let first = entries.len();
        let mut started = false;
        visit_facet(mesh, space, facet, &mut |q| {
            if !started {
                entries.extend(q.points.iter().map(|&p| (p, 0.0)));
                started = true;
            }
            total += q.area;
            for ((_, w), n) in entries[first..].iter_mut().zip(q.values) {
                *w += n * n * q.area;
            }
        });
        let sum: f64 = entries[first..].iter().map(|e| e.1).sum();
        if sum > 0.0 {
            for (_, w) in &mut entries[first..] {
                *w *= total / sum;
            }
        }
    }
    combine(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways to combine give the same bits, sums being in the order of the entries.
    #[test]
    fn entries_are_summed_in_their_order_whichever_way() {
        let entries: Vec<(usize, f64)> = (0..500)
            .map(|k| {
                (
                    3 * (k * k % 71),
                    (k as f64).sin() * 10f64.powi(k as i32 % 20),
                )
            })
            .collect();
        let sorted = combine_sorted(entries.clone());
        assert!(sorted.len() > 30);
        assert_eq!(combine(entries), sorted);
        let far = vec![(1_000_000, 1.0), (3, 2.0), (1_000_000, 0.5)];
        assert_eq!(combine(far), [(3, 2.0), (1_000_000, 1.5)]);
        assert!(combine(Vec::new()).is_empty());
    }
}
