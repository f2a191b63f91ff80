//! Sums over the quadrature points of a face.

use super::dual::{Matrix, dual};
use super::face::{FACE_NODES, Face};
use super::integral::{Entry, FaceIntegral};
use super::merge::{Merged, give};
use super::sides::Sides;
use super::view::Sample;
use crate::math::add_scaled;

/// Sums over the quadrature points.
pub(super) fn sum(
    face: &Face,
    merged: Merged,
    sides: &Sides,
    samples: &[Sample],
    out: &mut FaceIntegral,
) {
    let n = face.nodes.len();
    let mut m = Matrix::default();
    for s in samples {
        for (row, a) in m.iter_mut().zip(&s.positive[..n]) {
            for (m, b) in row.iter_mut().zip(&s.positive[..n]) {
                *m += s.w * a * b;
            }
        }
    }
    let mut functions = functions(&m, n, sides.compliant.then_some(face.area));
    give(face.kind, merged, &mut functions);
    // Nodes of the primary, and where those of each piece are among them.
    let mut places: Vec<[usize; FACE_NODES]> = Vec::with_capacity(out.pieces.len());
    for piece in &out.pieces {
        let mut at = [0; FACE_NODES];
        for (at, &node) in at.iter_mut().zip(&sides.facets[piece.facet].nodes) {
            *at = match out.nodes.iter().position(|&known| known == node) {
                Some(known) => known,
                None => {
                    out.nodes.push(node);
                    out.nodes.len() - 1
                }
            };
        }
        places.push(at);
    }
    let opposite = out.nodes.len();
    out.secondary.resize(n * n, Entry::default());
    out.primary.resize(n * opposite, Entry::default());
    out.levers.resize(n * opposite, [0.0; 3]);
    for s in samples {
        let piece = &mut out.pieces[s.piece];
        let count = sides.facets[piece.facet].nodes.len();
        let at = &places[s.piece][..count];
        piece.area += s.w;
        piece.direction = add_scaled(piece.direction, s.w, s.direction);
        for (sum, x) in piece.place.iter_mut().zip(s.place) {
            *sum += s.w * x;
        }
        for (sum, n) in piece.own[..n].iter_mut().zip(&s.n) {
            *sum += s.w * n;
        }
        for (sum, n) in piece.sums.iter_mut().zip(&s.opposite[..count]) {
            *sum += s.w * n;
        }
        for (a, function) in functions.iter().enumerate().take(n) {
            let phi: f64 = (0..n).map(|k| function[k] * s.positive[k]).sum();
            let w = s.w * phi;
            out.area[a] += w;
            out.gap[a] += w * s.gap;
            piece.shares[a] += w;
            for (b, entry) in out.secondary[a * n..(a + 1) * n].iter_mut().enumerate() {
                entry.add(w * s.n[b], s.direction);
            }
            let row = a * opposite..(a + 1) * opposite;
            let (row, levers) = (&mut out.primary[row.clone()], &mut out.levers[row]);
            for ((&k, n), lever) in at.iter().zip(s.opposite).zip(s.levers) {
                row[k].add(w * n, s.direction);
                levers[k] = add_scaled(levers[k], w, lever);
            }
        }
    }
    out.reach.resize(opposite, 0.0);
    for (piece, at) in out.pieces.iter().zip(&places) {
        let count = sides.facets[piece.facet].nodes.len();
        for &k in &at[..count] {
            out.reach[k] += piece.area / count as f64;
        }
    }
    let size = match face.kind.dim() {
        1 => face.area,
        _ => face.area.sqrt(),
    };
    // Gap relative to the size of a face beyond which all that a part of it has opposite is far: nodes at the rim of what is covered are
    // held by gaps next to it that are small, not by such ones.
    if let Some(floor) = floor(samples, 0.05 * size) {
        for (gap, area) in out.gap.iter_mut().zip(out.area) {
            *gap = gap.max(floor * area);
        }
    }
}

/// The gap below which no mean over the part of a face is believed, where that is above `far`: a node that a sliver far from it reaches takes the field over the
/// sliver to itself, and would meet what is nowhere near. What lies farther off than it varies over the part, and than a part of the face, stays open.
fn floor(samples: &[Sample], far: f64) -> Option<f64> {
    let ends = samples
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], s| {
            [least.min(s.gap), most.max(s.gap)]
        });
    let floor = 2.0 * ends[0] - ends[1];
    (floor > far && floor.is_finite()).then_some(floor)
}

/// The functions of the multipliers on the part of a face that has the primary opposite, in those of positive integral: `m` are the integrals of
/// their products, `compliant` is the area of the whole face where pressure follows from the gap ([Cichosz and Bischoff 2011](stickslip_base::references::cichosz_2011) make functions that are dual
/// on the part).
///
/// Functions that are dual on a part take a linear field to its value at the node, also at a node that lies outside: they extrapolate, and the pressure
/// that a law makes of such a gap, the farther the smaller the part, is found nowhere on the surfaces. The positive functions themselves take it to a mean
/// over the part. Between them lies what takes it no farther than to the edge of the part. Where a share `c` of a line is covered from one
/// end, the mean by the function of the other end is that at `2c/3` of its length; with the share `b` of the dual function, which takes
/// the field to the end, it is at `c` for `b = c / (3 - 2c)`. Multipliers, which are what keeps the gap closed, need no such mean.
fn functions(m: &Matrix, n: usize, compliant: Option<f64>) -> Matrix {
    let mut out = Matrix::default();
    for (k, row) in out.iter_mut().enumerate().take(n) {
        row[k] = 1.0;
    }
    // On a sliver there are none that are dual.
    let Some(dual) = dual(m, n) else {
        return out;
    };
    let Some(area) = compliant else {
        return dual;
    };
    let covered = m.iter().flatten().sum::<f64>() / area;
    let c = covered.min(1.0);
    let b = c / (3.0 - 2.0 * c);
    for (row, dual) in out.iter_mut().zip(&dual) {
        for (v, d) in row.iter_mut().zip(dual) {
            *v += b * (d - *v);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sliver whose gaps lie far above what they vary by is open, whatever a node far from it makes of them; what may touch is left as it is.
    #[test]
    fn gaps_have_a_floor_where_all_of_them_are_far() {
        let sample = |gap: f64| Sample {
            w: 1.0,
            n: [0.0; FACE_NODES],
            positive: [0.0; FACE_NODES],
            piece: 0,
            opposite: [0.0; FACE_NODES],
            place: [0.0; 2],
            gap,
            direction: [0.0; 3],
            levers: [[0.0; 3]; FACE_NODES],
        };
        let of = |gaps: &[f64]| {
            let samples: Vec<Sample> = gaps.iter().map(|g| sample(*g)).collect();
            floor(&samples, 0.5)
        };
        assert_eq!(of(&[6.0, 7.0, 6.5]), Some(5.0));
        assert_eq!(of(&[1.0, 3.0]), None);
        assert_eq!(of(&[0.4, 0.401]), None, "next to it");
        assert_eq!(of(&[-1e-3, 1.0]), None);
        assert_eq!(of(&[]), None);
    }

    /// A line that is covered from its first end to the share `c`: the mean of a field by the function of the other end is its value at the edge of what is
    /// covered, and at the node where all is.
    #[test]
    fn means_reach_to_the_edge_of_what_is_covered() {
        for c in [1e-3_f64, 0.1, 0.5, 0.9, 1.0] {
            // ∫ (1-s)², ∫ s (1-s), ∫ s² from 0 to c
            let [one, two, three] = [c, c * c / 2.0, c.powi(3) / 3.0];
            let mut m = Matrix::default();
            m[0][..2].copy_from_slice(&[one - 2.0 * two + three, two - three]);
            m[1][..2].copy_from_slice(&[two - three, three]);
            let f = functions(&m, 2, Some(1.0));
            // ∫ N_k and ∫ N_k s
            let (areas, moments) = ([one - two, two], [two - three, three]);
            let sum = |a: usize, of: [f64; 2]| f[a][0] * of[0] + f[a][1] * of[1];
            let mean = sum(1, moments) / sum(1, areas);
            assert!((mean / c - 1.0).abs() < 1e-9, "{c}: {mean}");
            for k in 0..2 {
                assert!(
                    (f[0][k] + f[1][k] - 1.0).abs() < 1e-9,
                    "{c}: they add up to one"
                );
                assert!((sum(k, areas) - areas[k]).abs() < 1e-12, "{c}: areas stay");
            }
        }
    }
}
