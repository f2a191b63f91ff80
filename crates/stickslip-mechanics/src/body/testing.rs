//! Small meshes of every kind and a dense solver, for the tests.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Elastic, Formulation, Part, Space};
use crate::linear::BlockCsr;
use crate::material::{Anisotropic, Elasticity, Isotropic, Stiffness};
use crate::math::{Vec3, add, scale};
use crate::mesh::{Block, Mesh};
use crate::registry::Samples;
use crate::shape::{ElementKind, QuadraturePoint};

pub const PLANE_STRAIN: Space = Space::PlaneStrain { thickness: 0.5 };
pub const PLANE_STRESS: Space = Space::PlaneStress { thickness: 0.5 };

/// Every kind of cell in every space and formulation that it can be in.
pub fn combinations() -> Vec<(ElementKind, Space, Formulation)> {
    let mut all = Vec::new();
    for kind in ElementKind::ALL {
        let spaces: &[Space] = match kind.dim() {
            2 => &[PLANE_STRAIN, PLANE_STRESS, Space::Axisymmetric],
            3 => &[Space::Solid],
            _ => &[],
        };
        for &space in spaces {
            all.push((kind, space, Formulation::Standard));
            if space != PLANE_STRESS {
                all.push((kind, space, Formulation::MeanDilatation));
            }
            // The rest changes some kinds only.
            let bilinear = matches!(kind, ElementKind::Quad4 | ElementKind::Hex8);
            let points = |rule: &[QuadraturePoint]| rule.len();
            let reference = kind.reference();
            if points(reference.reduced_quadrature()) != points(reference.quadrature()) {
                all.push((kind, space, Formulation::Reduced));
            }
            if bilinear {
                all.push((kind, space, Formulation::IncompatibleModes));
            }
        }
    }
    all
}

pub fn isotropic(young: f64, poisson: f64) -> Stiffness {
    Isotropic {
        young,
        poisson,
        density: 0.0,
    }
    .stiffness()
    .expect("sound")
}

pub fn anisotropic() -> Stiffness {
    Anisotropic::samples()[0].stiffness().expect("sound")
}

/// A grid of `n` cells on the unit square or cube, simplices and wedges by splitting, whose corners are moved by `map`; edges
/// stay straight.
pub fn grid(kind: ElementKind, n: [usize; 3], map: &dyn Fn(Vec3) -> Vec3) -> Mesh {
    let dim = kind.dim();
    let n = if dim == 2 { [n[0], n[1], 0] } else { n };
    let id = |i: usize, j: usize, k: usize| (k * (n[1] + 1) + j) * (n[0] + 1) + i;
    let mut points = Vec::new();
    for k in 0..=n[2] {
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                let z = if dim == 3 {
                    k as f64 / n[2] as f64
                } else {
                    0.0
                };
                points.push(map([i as f64 / n[0] as f64, j as f64 / n[1] as f64, z]));
            }
        }
    }
    let mut corners: Vec<Vec<usize>> = Vec::new();
    for k in 0..n[2].max(1) {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let at = |c: usize| id(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
                match kind {
                    ElementKind::Tri3 | ElementKind::Tri6 => {
                        corners.push(vec![at(0), at(1), at(3)]);
                        corners.push(vec![at(0), at(3), at(2)]);
                    }
                    ElementKind::Quad4 | ElementKind::Quad8 => {
                        corners.push(vec![at(0), at(1), at(3), at(2)]);
                    }
                    ElementKind::Tet4 | ElementKind::Tet10 => {
                        // One tetrahedron for every way from corner 0 to corner 7 along the axes.
                        for (a, b, even) in [
                            (1, 2, true),
                            (2, 4, true),
                            (4, 1, true),
                            (2, 1, false),
                            (4, 2, false),
                            (1, 4, false),
                        ] {
                            let mut tet = vec![at(0), at(a), at(a | b), at(7)];
                            if !even {
                                tet.swap(1, 2);
                            }
                            corners.push(tet);
                        }
                    }
                    ElementKind::Wedge6 | ElementKind::Wedge15 => {
                        corners.push([0, 1, 3, 4, 5, 7].map(at).to_vec());
                        corners.push([0, 3, 2, 4, 7, 6].map(at).to_vec());
                    }
                    _ => corners.push([0, 1, 3, 2, 4, 5, 7, 6].map(at).to_vec()),
                }
            }
        }
    }
    let mut middles = BTreeMap::new();
    let reference = kind.reference().nodes();
    let mut connectivity = Vec::new();
    for cell in &corners {
        connectivity.extend(cell);
        for &xi in &reference[cell.len()..] {
            let pair = (0..cell.len())
                .flat_map(|a| (0..a).map(move |b| (a, b)))
                .find(|&(a, b)| scale(0.5, add(reference[a], reference[b])) == xi)
                .expect("a mid node lies between two corners");
            let (p, q) = (cell[pair.0], cell[pair.1]);
            let middle = *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                points.push(scale(0.5, add(points[p], points[q])));
                points.len() - 1
            });
            connectivity.push(middle);
        }
    }
    let cells = connectivity.len() / kind.node_count();
    Mesh {
        dim,
        point_ids: (1..=points.len() as u64).collect(),
        points,
        blocks: vec![Block {
            kind,
            connectivity,
            cell_ids: (1..=cells as u64).collect(),
        }],
        ..Mesh::default()
    }
}

/// A smooth distortion that keeps `x > 0` and all cells sound.
pub fn distort(x: Vec3) -> Vec3 {
    [
        1.0 + 1.3 * x[0] + 0.07 * (3.0 * x[1] + 1.0 + x[2]).sin(),
        x[1] + 0.06 * (4.0 * x[0] - x[2]).cos(),
        0.8 * x[2] + 0.05 * x[2] * (2.0 * x[0] + x[1]).sin(),
    ]
}

pub fn body(mesh: Mesh, space: Space, formulation: Formulation, stiffness: Stiffness) -> Elastic {
    let parts = (0..mesh.blocks.len())
        .map(|block| Part {
            block,
            stiffness,
            density: 2.0,
            ..Part::default()
        })
        .collect();
    Elastic::new("block", Arc::new(mesh), space, formulation, parts).expect("sound")
}

/// A distorted patch with points inside.
pub fn patch(kind: ElementKind, space: Space, formulation: Formulation) -> Elastic {
    body(
        grid(kind, [3, 3, 2], &distort),
        space,
        formulation,
        anisotropic(),
    )
}

pub fn matrix(body: &Elastic) -> BlockCsr {
    let mesh = body.mesh();
    let mut m = BlockCsr::from_couplings(mesh.points.len(), mesh.dim, &mut |visit| {
        body.couplings(visit)
    });
    body.stiffness(&mut m);
    m
}

/// Deterministic numbers in `[-1, 1]`.
pub fn noise(count: usize) -> Vec<f64> {
    (0..count)
        .map(|i| (12.9898 * i as f64 + 4.1).sin())
        .collect()
}

/// Solves `K u = f` with the given dofs held at zero, by dense Cholesky.
pub fn solve(body: &Elastic, fixed: &[usize], f: &[f64]) -> Vec<f64> {
    let m = matrix(body);
    let free: Vec<usize> = (0..m.rows()).filter(|d| !fixed.contains(d)).collect();
    let n = free.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let s: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let a = m.entry(free[i], free[j]) - s;
            l[i][j] = if i == j { a.sqrt() } else { a / l[j][j] };
        }
    }
    let mut y: Vec<f64> = free.iter().map(|&d| f[d]).collect();
    for i in 0..n {
        let s: f64 = (0..i).map(|k| l[i][k] * y[k]).sum();
        y[i] = (y[i] - s) / l[i][i];
    }
    for i in (0..n).rev() {
        let s: f64 = (i + 1..n).map(|k| l[k][i] * y[k]).sum();
        y[i] = (y[i] - s) / l[i][i];
    }
    let mut u = vec![0.0; m.rows()];
    for (&d, y) in free.iter().zip(y) {
        assert!(y.is_finite());
        u[d] = y;
    }
    u
}
