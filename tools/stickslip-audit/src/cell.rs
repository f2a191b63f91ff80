//! Matrices of a cell: `K = ∫ Bᵀ D B`, `M = ∫ ρ Nᵀ N` (Zienkiewicz, Taylor and Zhu 2005, chapters 2 and 6).
//!
//! Strains are ordered xx yy zz xy yz xz with engineering shears; around an axis zz is the hoop strain `u / r`.

use crate::case::Space;
use crate::element::{Kind, Rule};
use crate::vec3::Vec3;

/// What is done with the strains of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// As the displacements give them.
    Standard,
    /// The dilatation is its mean over the cell (Hughes 1980, eq. 12-15).
    MeanDilatation,
    /// Fewer points; for quad4 and hex8 the mean strain, and a stiffness against what has none (Flanagan and Belytschko 1981).
    Reduced,
    /// Modes inside quad4 and hex8 (Taylor, Beresford and Wilson 1976), without mean (Ibrahimbegovic and Wilson 1991).
    Incompatible,
}

impl Formulation {
    /// By the word of the problem file.
    pub fn of(word: &str) -> Formulation {
        match word {
            "mean-dilatation" => Formulation::MeanDilatation,
            "reduced" => Formulation::Reduced,
            "incompatible-modes" => Formulation::Incompatible,
            _ => Formulation::Standard,
        }
    }
}

/// An isotropic material.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density.
    pub density: f64,
}

/// A matrix row by row.
pub type Matrix = Vec<Vec<f64>>;

/// Hooke's law for the strains above.
fn hooke(material: &Material, space: Space) -> [[f64; 6]; 6] {
    let (e, nu) = (material.young, material.poisson);
    let mut d = [[0.0; 6]; 6];
    let shear = e / (2.0 * (1.0 + nu));
    if let Space::Stress(_) = space {
        let c = e / (1.0 - nu * nu);
        d[0][0] = c;
        d[1][1] = c;
        d[0][1] = nu * c;
        d[1][0] = nu * c;
        d[3][3] = shear;
        return d;
    }
    let lame = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    for i in 0..3 {
        d[i][..3].fill(lame);
        d[i][i] += 2.0 * shear;
        d[i + 3][i + 3] = shear;
    }
    d
}

/// A point of a rule on a cell.
struct Sample {
    /// Values of the shape functions.
    n: Vec<f64>,
    /// Their derivatives in space.
    d: Vec<Vec3>,
    /// Radius, around an axis.
    radius: f64,
    /// Weight times Jacobian times thickness.
    volume: f64,
    /// Reference coordinates, and the Jacobian there.
    xi: [f64; 3],
    jacobian: f64,
}

/// Inverse and determinant of a Jacobian whose missing directions are unit ones.
fn invert(j: [[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let minor = |a: usize, b: usize| {
        let (r, s) = ((a + 1) % 3, (a + 2) % 3);
        let (p, q) = ((b + 1) % 3, (b + 2) % 3);
        j[r][p] * j[s][q] - j[r][q] * j[s][p]
    };
    let det: f64 = (0..3).map(|b| j[0][b] * minor(0, b)).sum();
    (
        std::array::from_fn(|a| std::array::from_fn(|b| minor(b, a) / det)),
        det,
    )
}

/// `∂x_i/∂ξ_k` of a cell.
fn jacobian(dim: usize, x: &[Vec3], slopes: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let mut j = [[0.0; 3]; 3];
    for (i, row) in j.iter_mut().enumerate() {
        for (k, entry) in row.iter_mut().enumerate() {
            *entry = match i < dim && k < dim {
                true => x.iter().zip(slopes).map(|(x, d)| x[i] * d[k]).sum(),
                false => f64::from(u8::from(i == k)),
            };
        }
    }
    j
}

fn samples(kind: Kind, x: &[Vec3], space: Space, rule: &Rule) -> Vec<Sample> {
    let dim = space.dim();
    let sample = |&(xi, weight): &([f64; 3], f64)| {
        let slopes = kind.gradients(xi);
        let (inverse, det) = invert(jacobian(dim, x, &slopes));
        let n = kind.values(xi);
        let place: Vec3 = std::array::from_fn(|i| n.iter().zip(x).map(|(n, x)| n * x[i]).sum());
        let space_slope = |d: &[f64; 3]| -> Vec3 {
            std::array::from_fn(|i| (0..dim).map(|k| inverse[k][i] * d[k]).sum())
        };
        Sample {
            d: slopes.iter().map(space_slope).collect(),
            n,
            radius: place[0],
            volume: weight * det.abs() * space.extent(place),
            xi,
            jacobian: det,
        }
    };
    rule.iter().map(sample).collect()
}

/// Columns of strains: one a displacement, node by node.
type Strains = Vec<[f64; 6]>;

/// The strains of functions with these values and derivatives, each in every direction.
fn strains(space: Space, values: &[f64], slopes: &[Vec3], radius: f64) -> Strains {
    let dim = space.dim();
    let mut b = Vec::with_capacity(values.len() * dim);
    for (n, d) in values.iter().zip(slopes) {
        let hoop = if space == Space::Ring {
            n / radius
        } else {
            0.0
        };
        b.push([d[0], 0.0, hoop, d[1], 0.0, d[2]]);
        b.push([0.0, d[1], 0.0, d[0], d[2], 0.0]);
        if dim == 3 {
            b.push([0.0, 0.0, d[2], 0.0, d[1], d[0]]);
        }
    }
    b
}

/// `Σ w aᵀ D b`, added.
fn add_product(out: &mut Matrix, a: &Strains, d: &[[f64; 6]; 6], b: &Strains, w: f64) {
    let stress: Vec<[f64; 6]> = b
        .iter()
        .map(|e| std::array::from_fn(|i| w * (0..6).map(|j| d[i][j] * e[j]).sum::<f64>()))
        .collect();
    for (row, a) in out.iter_mut().zip(a) {
        for (entry, s) in row.iter_mut().zip(&stress) {
            *entry += (0..6).map(|i| a[i] * s[i]).sum::<f64>();
        }
    }
}

fn zeros(rows: usize, columns: usize) -> Matrix {
    vec![vec![0.0; columns]; rows]
}

/// The stiffness of a cell.
pub fn stiffness(
    kind: Kind,
    x: &[Vec3],
    space: Space,
    material: &Material,
    formulation: Formulation,
) -> Matrix {
    let d = hooke(material, space);
    let bilinear = matches!(kind, Kind::Quad(4) | Kind::Hexahedron(8));
    let rule = match (kind, space) {
        // With one point a ring of triangles would have a motion without energy.
        (Kind::Triangle(3), Space::Ring) => Kind::Triangle(6).rule(),
        _ if formulation == Formulation::Reduced => kind.reduced_rule(),
        _ => kind.rule(),
    };
    let points = samples(kind, x, space, &rule);
    let mut all: Vec<Strains> = points
        .iter()
        .map(|p| strains(space, &p.n, &p.d, p.radius))
        .collect();
    let size = x.len() * space.dim();
    let mut k = zeros(size, size);
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    let mean_of = |all: &[Strains]| -> Strains {
        let mut mean = vec![[0.0; 6]; size];
        for (b, p) in all.iter().zip(&points) {
            for (mean, b) in mean.iter_mut().zip(b) {
                for i in 0..6 {
                    mean[i] += p.volume * b[i] / volume;
                }
            }
        }
        mean
    };
    match formulation {
        Formulation::MeanDilatation => {
            let mean = mean_of(&all);
            for b in &mut all {
                for (b, mean) in b.iter_mut().zip(&mean) {
                    let change = (mean[0] + mean[1] + mean[2] - b[0] - b[1] - b[2]) / 3.0;
                    b[..3].iter_mut().for_each(|b| *b += change);
                }
            }
        }
        Formulation::Reduced if bilinear => {
            let mean = mean_of(&all);
            add_hourglass(&mut k, kind, x, space, &mean, material.young * volume);
            all.iter_mut().for_each(|b| b.clone_from(&mean));
        }
        _ => {}
    }
    for (b, p) in all.iter().zip(&points) {
        add_product(&mut k, b, &d, b, p.volume);
    }
    if formulation == Formulation::Incompatible && bilinear {
        condense_modes(&mut k, kind, x, space, &d, &points, &all);
    }
    k
}

/// `ε E V Σ b·b γ γᵀ` in each direction with `ε` = 5e-4 (Flanagan and Belytschko 1981, eq. 27-30 and 63 onwards). The mean gradients are
/// read from the mean strains; around an axis this is not all of it.
fn add_hourglass(k: &mut Matrix, kind: Kind, x: &[Vec3], space: Space, mean: &Strains, ev: f64) {
    let dim = space.dim();
    let slope = |node: usize, i: usize| mean[node * dim + i][i];
    let signs: Vec<Vec3> = match dim {
        2 => vec![[-1., -1., 0.], [1., -1., 0.], [1., 1., 0.], [-1., 1., 0.]],
        _ => (0..8)
            .map(|a| {
                let low = |bit: bool| if bit { 1.0 } else { -1.0 };
                [low(matches!(a % 4, 1 | 2)), low(a % 4 > 1), low(a > 3)]
            })
            .collect(),
    };
    let modes: Vec<fn(&Vec3) -> f64> = match kind {
        Kind::Quad(_) => vec![|s| s[0] * s[1]],
        _ => vec![|s| s[0] * s[1], |s| s[1] * s[2], |s| s[2] * s[0], |s| {
            s[0] * s[1] * s[2]
        }],
    };
    let square: f64 = (0..x.len())
        .map(|a| (0..dim).map(|i| slope(a, i).powi(2)).sum::<f64>())
        .sum();
    for mode in modes {
        let h: Vec<f64> = signs.iter().map(mode).collect();
        let mut gamma = h.clone();
        for i in 0..dim {
            let with: f64 = h.iter().zip(x).map(|(h, x)| h * x[i]).sum();
            for (a, g) in gamma.iter_mut().enumerate() {
                *g -= with * slope(a, i);
            }
        }
        for a in 0..x.len() {
            for b in 0..x.len() {
                for i in 0..dim {
                    k[a * dim + i][b * dim + i] += 5e-4 * ev * square * gamma[a] * gamma[b];
                }
            }
        }
    }
}

/// Subtracts `K_uaᵀ K_aa⁻¹ K_au` of the modes `1 - ξ²`, `1 - η²` (and `1 - ζ²`), whose gradients are made with the Jacobian at the centre.
fn condense_modes(
    k: &mut Matrix,
    kind: Kind,
    x: &[Vec3],
    space: Space,
    d: &[[f64; 6]; 6],
    points: &[Sample],
    all: &[Strains],
) {
    let dim = space.dim();
    let (inverse, centre) = invert(jacobian(dim, x, &kind.gradients([0.0; 3])));
    let mut modes: Vec<Strains> = points
        .iter()
        .map(|p| {
            let slopes: Vec<Vec3> = (0..dim)
                .map(|m| {
                    let s = -2.0 * p.xi[m] * centre / p.jacobian;
                    std::array::from_fn(|i| if i < dim { s * inverse[m][i] } else { 0.0 })
                })
                .collect();
            let values: Vec<f64> = (0..dim).map(|m| 1.0 - p.xi[m] * p.xi[m]).collect();
            strains(space, &values, &slopes, p.radius)
        })
        .collect();
    let count = dim * dim;
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    for c in 0..count {
        for i in 0..6 {
            let mean: f64 = modes
                .iter()
                .zip(points)
                .map(|(g, p)| g[c][i] * p.volume / volume)
                .sum();
            modes.iter_mut().for_each(|g| g[c][i] -= mean);
        }
    }
    let (mut inner, mut outer) = (zeros(count, count), zeros(count, k.len()));
    for ((g, b), p) in modes.iter().zip(all).zip(points) {
        add_product(&mut inner, g, d, g, p.volume);
        add_product(&mut outer, g, d, b, p.volume);
    }
    let Some(solved) = solve(inner, outer.clone()) else {
        return;
    };
    for (a, row) in k.iter_mut().enumerate() {
        for (b, entry) in row.iter_mut().enumerate() {
            *entry -= (0..count).map(|c| outer[c][a] * solved[c][b]).sum::<f64>();
        }
    }
}

/// Gauss's elimination with pivots, for several right-hand sides.
fn solve(mut a: Matrix, mut b: Matrix) -> Option<Matrix> {
    let n = a.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&p, &q| a[p][i].abs().total_cmp(&a[q][i].abs()))?;
        a.swap(i, pivot);
        b.swap(i, pivot);
        if a[i][i] == 0.0 {
            return None;
        }
        for r in (0..n).filter(|r| *r != i) {
            let f = a[r][i] / a[i][i];
            let (from, other) = (a[i].clone(), b[i].clone());
            a[r].iter_mut().zip(&from).for_each(|(x, y)| *x -= f * y);
            b[r].iter_mut().zip(&other).for_each(|(x, y)| *x -= f * y);
        }
    }
    for (i, row) in b.iter_mut().enumerate() {
        row.iter_mut().for_each(|x| *x /= a[i][i]);
    }
    Some(b)
}

/// The consistent mass of a cell, one direction.
pub fn mass(kind: Kind, x: &[Vec3], space: Space, density: f64) -> Matrix {
    let mut m = zeros(x.len(), x.len());
    for p in samples(kind, x, space, &kind.mass_rule()) {
        for (row, a) in m.iter_mut().zip(&p.n) {
            for (entry, b) in row.iter_mut().zip(&p.n) {
                *entry += density * p.volume * a * b;
            }
        }
    }
    m
}

/// `∫ N f` of a density of force that may depend on the place; `[node]`.
pub fn spread(kind: Kind, x: &[Vec3], space: Space, force: &dyn Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let mut out = vec![[0.0; 3]; x.len()];
    for p in samples(kind, x, space, &kind.fine_rule()) {
        let place: Vec3 = std::array::from_fn(|i| p.n.iter().zip(x).map(|(n, x)| n * x[i]).sum());
        let f = force(place);
        for (out, n) in out.iter_mut().zip(&p.n) {
            for i in 0..3 {
                out[i] += p.volume * n * f[i];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Formulation, Material, mass, stiffness};
    use crate::case::Space;
    use crate::element::Kind;
    use crate::vec3::Vec3;

    const STEEL: Material = Material {
        young: 2.0,
        poisson: 0.3,
        density: 3.0,
    };

    fn bent_hex() -> Vec<Vec3> {
        let mut x: Vec<Vec3> = Vec::new();
        for (a, z) in [(0, 0.0), (1, 1.0)] {
            let s = 0.1 * f64::from(a);
            x.extend([[s, 0., z], [1.1, s, z + 0.2], [1., 1., z], [-0.1, 0.9, z]]);
        }
        x
    }

    #[test]
    fn a_linear_field_has_the_energy_of_its_strain_in_every_formulation() {
        let x = bent_hex();
        let volume = mass(Kind::Hexahedron(8), &x, Space::Solid, 1.0)
            .concat()
            .iter()
            .sum::<f64>();
        // u = (e x, 0, 0): a stress C11 e.
        let c11 = 2.0 * 0.7 / (1.3 * 0.4);
        for formulation in [
            "standard",
            "mean-dilatation",
            "reduced",
            "incompatible-modes",
        ] {
            let k = stiffness(
                Kind::Hexahedron(8),
                &x,
                Space::Solid,
                &STEEL,
                Formulation::of(formulation),
            );
            let u: Vec<f64> = x.iter().flat_map(|x| [x[0], 0.0, 0.0]).collect();
            let twice: f64 = (0..24)
                .map(|i| u[i] * (0..24).map(|j| k[i][j] * u[j]).sum::<f64>())
                .sum();
            assert!(
                (twice / (c11 * volume) - 1.0).abs() < 1e-12,
                "{formulation}: {twice}"
            );
        }
    }

    #[test]
    fn a_rigid_motion_has_no_force() {
        let x = bent_hex();
        let u: Vec<f64> = x
            .iter()
            .flat_map(|x| [1.0 - x[1], 2.0 + x[0], 3.0])
            .collect();
        for formulation in [
            "standard",
            "mean-dilatation",
            "reduced",
            "incompatible-modes",
        ] {
            let k = stiffness(
                Kind::Hexahedron(8),
                &x,
                Space::Solid,
                &STEEL,
                Formulation::of(formulation),
            );
            let most = k
                .iter()
                .map(|row| row.iter().zip(&u).map(|(k, u)| k * u).sum::<f64>().abs());
            assert!(most.fold(0.0, f64::max) < 1e-12, "{formulation}");
        }
    }
}
