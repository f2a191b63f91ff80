//! Pressure that follows faces where they go: its forces and their derivative at displacements.
//!
//! ```text
//! f_a = -p ∫ N_a (t₁ × t₂) dξ,   t_k = Σ_b ∂N_b/∂ξ_k x_b
//! ```
//!
//! The derivative has the faces' own tangents only, and is not symmetric: Bonet and Wood, *Nonlinear Continuum Mechanics for Finite Element Analysis*, section 8.5.2.

use super::super::Space;
use super::super::facets::{Faced, each_face_point};
use crate::linear::BlockCsr;
use crate::math::{Vec3, add, cross, scale};
use crate::mesh::{FacetRef, Mesh};
use crate::system::Dofs;

/// A pressure on faces that move.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressing {
    /// The faces.
    pub facets: Vec<FacetRef>,
    /// Pressure `[Pa]`, positive when it pushes.
    pub value: f64,
}

impl Pressing {
    /// Adds so many times its forces at displacements `u` `[m]` by dof to `out` `[N]`.
    pub fn external(&self, mesh: &Mesh, space: Space, times: f64, u: &[f64], out: &mut [f64]) {
        let dofs = dofs(mesh, space);
        self.each(mesh, space, u, &mut |q, thick| {
            let force = scale(-times * self.value * thick, q.across);
            for (&p, n) in q.points.iter().zip(q.values) {
                for (c, f) in force.iter().enumerate().take(dofs.dim) {
                    out[dofs.of(p, c)] += n * f;
                }
            }
        });
    }

    /// Adds so many times the derivative of these forces by displacements to a matrix `[N/m]`.
    pub fn add_tangent(
        &self,
        mesh: &Mesh,
        space: Space,
        times: f64,
        u: &[f64],
        matrix: &mut BlockCsr,
    ) {
        let dim = space.dim();
        self.each(mesh, space, u, &mut |q, thick| {
            let width = q.points.len() * dim;
            let mut dense = vec![0.0; width * width];
            for b in 0..q.points.len() {
                for j in 0..dim {
                    let change = scale(-times * self.value * thick, q.change(b, j, dim));
                    for (a, n) in q.values.iter().enumerate() {
                        for (i, c) in change.iter().enumerate().take(dim) {
                            dense[(a * dim + i) * width + b * dim + j] = n * c;
                        }
                    }
                }
            }
            matrix.add_group(q.points, &dense);
        });
    }

    /// Visits points of the faces where they are, with weight and thickness.
    fn each(&self, mesh: &Mesh, space: Space, u: &[f64], visit: &mut dyn FnMut(&Faced, f64)) {
        let dofs = dofs(mesh, space);
        let place = |p: usize| -> Vec3 { add(mesh.points[p], dofs.vector(u, p)) };
        for &facet in &self.facets {
            each_face_point(mesh, facet, &place, &mut |q| {
                visit(q, q.weight * space.extent(q.x));
            });
        }
    }
}

fn dofs(mesh: &Mesh, space: Space) -> Dofs {
    Dofs {
        dim: space.dim(),
        points: mesh.points.len(),
    }
}

impl Faced<'_> {
    /// How the normal, as long as the area is large, changes with the displacement of one of the points along an axis.
    fn change(&self, point: usize, axis: usize, dim: usize) -> Vec3 {
        let mut e = [0.0; 3];
        e[axis] = 1.0;
        let [d1, d2] = [self.gradients[point][0], self.gradients[point][1]];
        match dim {
            2 => [d1 * e[1], -d1 * e[0], 0.0],
            _ => add(
                scale(d1, cross(e, self.tangents[1])),
                scale(d2, cross(self.tangents[0], e)),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing;
    use super::*;
    use crate::mesh::CellRef;

    #[test]
    fn the_derivative_is_the_slope_of_the_forces() {
        for (kind, space, formulation) in testing::combinations() {
            if space == Space::Axisymmetric {
                continue;
            }
            let body = testing::patch(kind, space, formulation);
            let mesh = body.mesh();
            let faces = 0..kind.reference().faces().len();
            let pressing = Pressing {
                facets: faces
                    .map(|face| FacetRef {
                        cell: CellRef { block: 0, cell: 1 },
                        face,
                    })
                    .collect(),
                value: 3.0,
            };
            let dim = space.dim();
            let count = mesh.points.len() * dim;
            let wave = |i: usize, by: f64| (by * (i as f64 + 1.0)).sin();
            let u: Vec<f64> = (0..count).map(|i| 0.1 * wave(i, 1.7)).collect();
            let way: Vec<f64> = (0..count).map(|i| wave(i, 2.9)).collect();
            let force = |s: f64| {
                let at: Vec<f64> = u.iter().zip(&way).map(|(u, w)| u + s * w).collect();
                let mut out = vec![0.0; count];
                pressing.external(mesh, space, 2.0, &at, &mut out);
                out
            };
            // All faces of a cell are closed.
            let sum: f64 = force(0.0).iter().sum();
            assert!(sum.abs() < 1e-13, "{kind}: {sum}");
            let mut matrix =
                BlockCsr::from_couplings(mesh.points.len(), dim, &mut |v| body.couplings(v));
            pressing.add_tangent(mesh, space, 2.0, &u, &mut matrix);
            let mut product = vec![0.0; count];
            matrix.mul(&way, &mut product);
            let both = force(1e-5).into_iter().zip(force(-1e-5));
            for ((a, b), p) in both.zip(product) {
                assert!(((a - b) / 2e-5 - p).abs() < 1e-8, "{kind}");
            }
        }
    }
}
