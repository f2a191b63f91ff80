//! What elastic bodies resist with at each node, `K u`, found without anything of the library: shape functions from the places of the nodes of the
//! elements, forces from the stresses.
// Loops over indices are the formulas.
#![allow(clippy::needless_range_loop)]

use stickslip::mesh::Mesh;

type Vec3 = [f64; 3];

/// Isotropic elasticity and the kind of space.
#[derive(Clone, Copy)]
pub struct Medium {
    pub young: f64,
    pub poisson: f64,
    pub space: Space,
    /// In plane problems.
    pub thickness: f64,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Space {
    Strain,
    Stress,
    Axisymmetric,
    Solid,
}

/// Corners of the square or cube, then midsides, in the order of Gmsh's first elements and VTK.
const SQUARE: [[i32; 3]; 8] = [
    [-1, -1, 0],
    [1, -1, 0],
    [1, 1, 0],
    [-1, 1, 0],
    [0, -1, 0],
    [1, 0, 0],
    [0, 1, 0],
    [-1, 0, 0],
];
const CUBE: [[i32; 3]; 8] = [
    [-1, -1, -1],
    [1, -1, -1],
    [1, 1, -1],
    [-1, 1, -1],
    [-1, -1, 1],
    [1, -1, 1],
    [1, 1, 1],
    [-1, 1, 1],
];

/// Places of the nodes, and powers of the monomials that the shape functions are made of.
fn element(nodes: usize, dim: usize) -> (Vec<Vec3>, Vec<[i32; 3]>) {
    let real = |all: &[[i32; 3]]| all.iter().map(|p| p.map(f64::from)).collect();
    let plane = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]];
    let linear = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    match (nodes, dim) {
        (3, 2) => (real(&linear[..3]), linear[..3].to_vec()),
        (4, 2) => (real(&SQUARE[..4]), plane.to_vec()),
        (8, 2) => {
            let more = [[2, 0, 0], [0, 2, 0], [2, 1, 0], [1, 2, 0]];
            (real(&SQUARE), [&plane[..], &more[..]].concat())
        }
        (4, 3) => (real(&linear), linear.to_vec()),
        (10, 3) => {
            let mut places: Vec<Vec3> = real(&linear);
            for (a, b) in [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)] {
                places.push([0, 1, 2].map(|c| 0.5 * (places[a][c] + places[b][c])));
            }
            let more = [
                [2, 0, 0],
                [0, 2, 0],
                [0, 0, 2],
                [1, 1, 0],
                [0, 1, 1],
                [1, 0, 1],
            ];
            (places, [&linear[..], &more[..]].concat())
        }
        (8, 3) => (real(&CUBE), CUBE.map(|c| c.map(|x| (x + 1) / 2)).to_vec()),
        _ => panic!("no element of {nodes} nodes"),
    }
}

/// Solves `a x = b` for many right-hand sides, with pivots.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()));
        let pivot = pivot.expect("a row");
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k] / a[k][k];
            for j in 0..n {
                a[i][j] -= factor * a[k][j];
            }
            for j in 0..b[i].len() {
                b[i][j] -= factor * b[k][j];
            }
        }
    }
    for (k, row) in b.iter_mut().enumerate() {
        row.iter_mut().for_each(|x| *x /= a[k][k]);
    }
    b
}

/// Gauss points on the line.
fn gauss(order: usize) -> Vec<(f64, f64)> {
    let (a, b) = (1.0 / 3.0_f64.sqrt(), 0.6_f64.sqrt());
    match order {
        2 => vec![(-a, 1.0), (a, 1.0)],
        _ => vec![(-b, 5.0 / 9.0), (0.0, 8.0 / 9.0), (b, 5.0 / 9.0)],
    }
}

fn quadrature(nodes: usize, dim: usize) -> Vec<(Vec3, f64)> {
    match (nodes, dim) {
        (3, 2) => return vec![([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)],
        (4, 3) => return vec![([0.25; 3], 1.0 / 6.0)],
        (10, 3) => {
            let (a, b) = (
                (5.0 + 3.0 * 5.0_f64.sqrt()) / 20.0,
                (5.0 - 5.0_f64.sqrt()) / 20.0,
            );
            let points = [[b, b, b], [a, b, b], [b, a, b], [b, b, a]];
            return points.map(|p| (p, 1.0 / 24.0)).to_vec();
        }
        _ => {}
    }
    let line = gauss(if nodes == 8 && dim == 2 { 3 } else { 2 });
    let mut all = Vec::new();
    for &(x, a) in &line {
        for &(y, b) in &line {
            match dim {
                2 => all.push(([x, y, 0.0], a * b)),
                _ => all.extend(line.iter().map(|&(z, c)| ([x, y, z], a * b * c))),
            }
        }
    }
    all
}

/// `x^p`, and its derivative.
fn power(x: f64, p: i32) -> (f64, f64) {
    match p {
        0 => (1.0, 0.0),
        _ => (x.powi(p), f64::from(p) * x.powi(p - 1)),
    }
}

/// Forces with which the cells resist the displacements `u` (three a point) `[N]`.
pub fn resist(mesh: &Mesh, medium: &dyn Fn(usize) -> Medium, u: &[f64]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; mesh.points.len()];
    for block in &mesh.blocks {
        let cells = block.connectivity.len() / block.cell_ids.len();
        for nodes in block.connectivity.chunks(cells) {
            add_cell(mesh, nodes, medium(nodes[0]), u, &mut forces);
        }
    }
    forces
}

fn add_cell(mesh: &Mesh, nodes: &[usize], medium: Medium, u: &[f64], forces: &mut [Vec3]) {
    let (dim, n) = (mesh.dim, nodes.len());
    let (places, powers) = element(n, dim);
    let monomials = |at: Vec3| -> Vec<(f64, Vec3)> {
        let value = |p: &[i32; 3]| {
            let [x, y, z] = [0, 1, 2].map(|c| power(at[c], p[c]));
            let slope = [x.1 * y.0 * z.0, x.0 * y.1 * z.0, x.0 * y.0 * z.1];
            (x.0 * y.0 * z.0, slope)
        };
        powers.iter().map(value).collect()
    };
    // Rows: nodes. Coefficients of shape function a: column a of the inverse.
    let vandermonde = places
        .iter()
        .map(|p| monomials(*p).into_iter().map(|m| m.0).collect());
    let unit = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect());
    let coefficients = solve(vandermonde.collect(), unit.collect());
    let lame =
        medium.young * medium.poisson / ((1.0 + medium.poisson) * (1.0 - 2.0 * medium.poisson));
    let shear = medium.young / (2.0 * (1.0 + medium.poisson));
    for (at, weight) in quadrature(n, dim) {
        let monomials = monomials(at);
        let mut shapes = vec![(0.0, [0.0; 3]); n];
        for (m, row) in monomials.iter().zip(&coefficients) {
            for (shape, c) in shapes.iter_mut().zip(row) {
                shape.0 += c * m.0;
                (0..3).for_each(|k| shape.1[k] += c * m.1[k]);
            }
        }
        let mut jacobian = vec![vec![0.0; dim]; dim];
        let mut radius = 0.0;
        for (shape, &p) in shapes.iter().zip(nodes) {
            radius += shape.0 * mesh.points[p][0];
            for i in 0..dim {
                for j in 0..dim {
                    jacobian[i][j] += shape.1[i] * mesh.points[p][j];
                }
            }
        }
        let determinant = match dim {
            2 => jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0],
            _ => (0..3)
                .map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    jacobian[0][i]
                        * (jacobian[1][j] * jacobian[2][k] - jacobian[1][k] * jacobian[2][j])
                })
                .sum(),
        };
        // Rows: directions in space. Columns: nodes.
        let slopes = (0..dim).map(|i| shapes.iter().map(|s| s.1[i]).collect());
        let slopes = solve(jacobian, slopes.collect());
        let mut gradient = [[0.0; 3]; 3];
        for (a, &p) in nodes.iter().enumerate() {
            for i in 0..dim {
                for (j, slope) in slopes.iter().enumerate() {
                    gradient[i][j] += u[3 * p + i] * slope[a];
                }
            }
            if medium.space == Space::Axisymmetric {
                gradient[2][2] += u[3 * p] * shapes[a].0 / radius;
            }
        }
        if medium.space == Space::Stress {
            gradient[2][2] =
                -medium.poisson / (1.0 - medium.poisson) * (gradient[0][0] + gradient[1][1]);
        }
        let trace = gradient[0][0] + gradient[1][1] + gradient[2][2];
        let stress = |i: usize, j: usize| {
            let volume = if i == j { lame * trace } else { 0.0 };
            volume + shear * (gradient[i][j] + gradient[j][i])
        };
        let around = match medium.space {
            Space::Axisymmetric => std::f64::consts::TAU * radius,
            _ => medium.thickness,
        };
        let weight = weight * determinant * around;
        for (a, &p) in nodes.iter().enumerate() {
            for i in 0..dim {
                let along: f64 = (0..dim).map(|j| stress(i, j) * slopes[j][a]).sum();
                forces[p][i] += weight * along;
            }
            if medium.space == Space::Axisymmetric {
                forces[p][0] += weight * stress(2, 2) * shapes[a].0 / radius;
            }
        }
    }
}
