//! The stiffness of a stress against rotation: what a body under stress has beyond its own stiffness, to first order.
//!
//! A stress `σ` does the work `½ ∫ σ_ij u_k,i u_k,j` on the second order of the strains of small motions `u`, Green's `½ u_k,i u_k,j`: the geometric or initial stress
//! matrix of textbooks. Tension makes a body stiffer, compression softer.

use super::geometry::by_nodes;
use super::{At, Elastic, Space};
use crate::body::recover;
use crate::material::VOIGT;

/// `∫ σ_ij u_k,i u_k,j` of the stress at a state with each of the motions `u` `[J]`, by dof of the whole mesh: twice the work that the stress does on their second order.
pub fn work_of_stress<'a>(body: &Elastic, at: impl Into<At<'a>>, motions: &[&[f64]]) -> Vec<f64> {
    let (at, mut out) = (at.into(), vec![0.0; motions.len()]);
    for (part, p) in body.parts.iter().enumerate() {
        let kind = body.mesh.blocks[p.block].kind;
        by_nodes!(kind, add_work_of_stress(body, part, at, motions, &mut out));
    }
    out
}

fn add_work_of_stress<const N: usize>(
    body: &Elastic,
    part: usize,
    at: At,
    motions: &[&[f64]],
    out: &mut [f64],
) {
    let (dim, dofs) = (body.space.dim(), body.dofs());
    let hoop = matches!(body.space, Space::Axisymmetric);
    let connectivity = &body.mesh.blocks[body.parts[part].block].connectivity;
    // Between nodes of a cell: what all components have, then what the radial one has of the hoop stress.
    let width = 2 * N * N;
    recover::each_cell::<N>(
        body,
        part,
        at,
        width,
        |_, _, recovered, values| {
            values.fill(0.0);
            let (all, radial) = values.split_at_mut(N * N);
            for (q, p) in recovered.points.iter().enumerate() {
                let [_, _, stress] = recovered.at(q);
                for a in 0..N {
                    for b in 0..N {
                        let mut sum = 0.0;
                        for (i, row) in VOIGT.iter().enumerate().take(dim) {
                            for (j, &v) in row.iter().enumerate().take(dim) {
                                sum += stress[v] * p.d[i][a] * p.d[j][b];
                            }
                        }
                        all[a * N + b] += p.volume * sum;
                        if hoop {
                            radial[a * N + b] += p.volume * stress[2] * p.d[2][a] * p.d[2][b];
                        }
                    }
                }
            }
        },
        |cell, values| {
            let nodes = &connectivity[cell * N..(cell + 1) * N];
            let (all, radial) = values.split_at(N * N);
            for (out, u) in out.iter_mut().zip(motions) {
                for (a, &p) in nodes.iter().enumerate() {
                    for (b, &r) in nodes.iter().enumerate() {
                        let both = |c: usize| u[dofs.of(p, c)] * u[dofs.of(r, c)];
                        *out += all[a * N + b] * (0..dim).map(both).sum::<f64>();
                        *out += radial[a * N + b] * both(0);
                    }
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;
    use crate::body::cells;

    #[test]
    fn a_body_that_turns_does_the_work_of_its_stress() {
        for (kind, space, formulation) in testing::combinations() {
            if matches!(space, Space::Axisymmetric) {
                continue;
            }
            let body = testing::patch(kind, space, formulation);
            let dim = space.dim();
            let points = &body.mesh().points;
            let by = |f: &dyn Fn([f64; 3]) -> [f64; 3]| -> Vec<f64> {
                points
                    .iter()
                    .flat_map(|&x| f(x).into_iter().take(dim))
                    .collect()
            };
            // Drawn along x. A rotation about z by φ has u_k,i u_k,j = φ² in the plane: the work is φ² ∫ (σ_xx + σ_yy).
            let drawn = by(&|x| [1e-3 * x[0], 0.0, 0.0]);
            let turned = by(&|x| [-0.1 * x[1], 0.1 * x[0], 0.0]);
            let stresses = cells::stress_at_quadrature(&body, &drawn);
            let each = stresses
                .iter()
                .map(|p| 0.01 * p.volume * (p.stress[0] + p.stress[1]));
            let sum: f64 = each.sum();
            let work = work_of_stress(&body, &drawn, &[&turned, &vec![0.0; turned.len()]]);
            assert!((work[0] / sum - 1.0).abs() < 1e-9, "{kind}: {work:?}");
            assert_eq!(work[1], 0.0);
        }
    }
}
