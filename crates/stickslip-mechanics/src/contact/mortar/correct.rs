//! Integrals of shape functions over distorted faces and facets that are wholly opposite the other side.
//!
//! The shape functions of a quadrilateral that is no parallelogram, or of a quadratic facet, are no polynomials in space: quadrature over the pieces
//! cut out of it leaves an error, and a uniform pressure would not pass. Where the pieces make up the whole facet their sum is known: it is the
//! integral over the facet itself. The error is taken away, shared by the pieces according to their areas. It has no resultant and no
//! moment, so that neither force nor gap of a flat surface changes.

use super::face::{FACE_NODES, Face};
use super::integral::{Entry, FaceIntegral};
use super::sides::Sides;
use crate::math::{Vec3, add_scaled, cross, distance, norm, scale};
use crate::shape::{ElementKind, mass_rule};

/// Integrals over a facet itself.
struct Itself {
    area: f64,
    sums: [f64; FACE_NODES],
    centroid: Vec3,
}

fn integrals(kind: ElementKind, x: &[Vec3]) -> Itself {
    let n = kind.node_count();
    let mut out = Itself {
        area: 0.0,
        sums: [0.0; FACE_NODES],
        centroid: [0.0; 3],
    };
    for q in mass_rule(kind) {
        let mut v = [0.0; FACE_NODES];
        let mut d = [[0.0; 3]; FACE_NODES];
        kind.reference().values(q.xi, &mut v[..n]);
        kind.reference().gradients(q.xi, &mut d[..n]);
        let (mut a, mut b, mut place) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for k in 0..n {
            a = add_scaled(a, d[k][0], x[k]);
            b = add_scaled(b, d[k][1], x[k]);
            place = add_scaled(place, v[k], x[k]);
        }
        let w = q.weight * norm(cross(a, b));
        out.area += w;
        out.centroid = add_scaled(out.centroid, w, place);
        for (sum, v) in out.sums.iter_mut().zip(v) {
            *sum += w * v;
        }
    }
    out.centroid = scale(1.0 / out.area, out.centroid);
    out
}

/// Whether shape functions are polynomials in space, as long as edges are straight.
fn affine(kind: ElementKind, x: &[Vec3], size: f64) -> bool {
    if kind.is_simplex() {
        return true;
    }
    let diagonal = |i: usize| x[0][i] - x[1][i] + x[2][i] - x[3][i];
    norm([diagonal(0), diagonal(1), diagonal(2)]) < 1e-14 * size
}

/// What is missing in the integrals `sums` of the shape functions over parts of a face or facet with nodes at `x`, `area` in all; `None` if nothing
/// is, or if the parts do not make up the whole.
fn missing(
    kind: ElementKind,
    x: &[Vec3],
    area: f64,
    sums: &[f64; FACE_NODES],
) -> Option<[f64; FACE_NODES]> {
    let n = x.len();
    if area <= 0.0 || kind.dim() == 1 {
        return None;
    }
    let size = distance(x[0], x[1]);
    if affine(kind, x, size) {
        return None;
    }
    let itself = integrals(kind, x);
    let placed = x.iter().zip(sums);
    let centroid = placed.fold([0.0; 3], |c, (&x, s)| add_scaled(c, s / area, x));
    // The correction has faded away where the centroid of the pieces is a thousandth of the size of the facet from that of the facet.
    let off = distance(centroid, itself.centroid) / (1e-3 * size);
    // The same of the area, at a twentieth.
    let off = off.max((area / itself.area - 1.0).abs() / 0.05);
    let fade = (2.0 * (1.0 - off)).min(1.0);
    if fade <= 0.0 {
        return None;
    }
    let mut error = [0.0; FACE_NODES];
    for (k, e) in error.iter_mut().enumerate().take(n) {
        *e = fade * (itself.sums[k] * area / itself.area - sums[k]);
    }
    without_resultant(&mut error[..n], x);
    Some(error)
}

/// Takes the part of `v` away that has a sum or a moment about the nodes `x`.
fn without_resultant(v: &mut [f64], x: &[Vec3]) {
    let n = v.len();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let rows = std::iter::once(vec![1.0; n])
        .chain((0..3).map(|i| x.iter().map(|at| at[i] - x[0][i]).collect()));
    for mut row in rows {
        let before = row.iter().map(|r| r * r).sum::<f64>();
        // twice: once is not enough for vectors that are nearly parallel
        for _ in 0..2 {
            for b in &basis {
                let along: f64 = b.iter().zip(&row).map(|(b, r)| b * r).sum();
                for (r, b) in row.iter_mut().zip(b) {
                    *r -= along * b;
                }
            }
        }
        let left = row.iter().map(|r| r * r).sum::<f64>();
        if left > 1e-16 * before {
            let s = 1.0 / left.sqrt();
            basis.push(row.into_iter().map(|r| r * s).collect());
        }
    }
    for b in &basis {
        let along: f64 = b.iter().zip(&*v).map(|(b, v)| b * v).sum();
        for (v, b) in v.iter_mut().zip(b) {
            *v -= along * b;
        }
    }
}

/// Corrects the integrals over all faces, those of the primary and those of the secondary itself.
pub fn correct(sides: &Sides, faces: &[Face], integrals: &mut [FaceIntegral]) {
    let gather = |nodes: &[usize], from: &[Vec3]| {
        let mut x = [[0.0; 3]; FACE_NODES];
        for (x, &node) in x.iter_mut().zip(nodes) {
            *x = from[node];
        }
        x
    };
    let mut covered = vec![(0.0, [0.0; FACE_NODES]); sides.facets.len()];
    for piece in integrals.iter().flat_map(|f| &f.pieces) {
        let (area, sums) = &mut covered[piece.facet];
        *area += piece.area;
        for (sum, s) in sums.iter_mut().zip(piece.sums) {
            *sum += s;
        }
    }
    let errors: Vec<Option<[f64; FACE_NODES]>> = covered
        .iter()
        .zip(sides.facets)
        .map(|((area, sums), facet)| {
            let x = gather(&facet.nodes, sides.x);
            missing(facet.kind, &x[..facet.nodes.len()], *area, sums)
        })
        .collect();
    for (face, integral) in faces.iter().zip(integrals) {
        correct_secondary(
            face,
            &gather(&face.nodes, sides.reference)[..face.nodes.len()],
            integral,
        );
        let count = integral.nodes.len();
        // A facet that no place of the face meets has no share.
        for piece in integral.pieces.iter().filter(|p| p.area > 0.0) {
            let Some(error) = &errors[piece.facet] else {
                continue;
            };
            let whole = covered[piece.facet].0;
            let facet = &sides.facets[piece.facet];
            let direction = scale(1.0 / piece.area, piece.direction);
            for (&node, e) in facet.nodes.iter().zip(error) {
                let Some(k) = integral.nodes.iter().position(|&n| n == node) else {
                    continue;
                };
                for (a, share) in piece.shares.iter().enumerate() {
                    if let Some(entry) = integral.primary.get_mut(a * count + k) {
                        shift(entry, e * share / whole, direction);
                    }
                }
            }
        }
    }
}

fn shift(entry: &mut Entry, w: f64, direction: Vec3) {
    entry.weight += w;
    entry.gradient = add_scaled(entry.gradient, w, direction);
}

/// The same for the shape functions of a face itself.
fn correct_secondary(face: &Face, reference: &[Vec3], integral: &mut FaceIntegral) {
    let n = face.nodes.len();
    if integral.secondary.is_empty() {
        return;
    }
    let area: f64 = integral.area.iter().sum();
    let mut sums = [0.0; FACE_NODES];
    let mut direction = [0.0; 3];
    for row in integral.secondary.chunks_exact(n) {
        for (sum, entry) in sums.iter_mut().zip(row) {
            *sum += entry.weight;
            direction = add_scaled(direction, 1.0 / area, entry.gradient);
        }
    }
    let Some(error) = missing(face.kind, reference, area, &sums) else {
        return;
    };
    for (row, share) in integral.secondary.chunks_exact_mut(n).zip(integral.area) {
        for (entry, e) in row.iter_mut().zip(error) {
            shift(entry, e * share / area, direction);
        }
    }
}
