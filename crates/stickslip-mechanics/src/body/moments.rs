//! Mass, centre of mass and moments of inertia.

use super::geometry::{Table, by_nodes, coordinates, point};
use super::{Elastic, Space};
use crate::math::{Mat3, Vec3};
use crate::mesh::{Block, Mesh};
use crate::shape::mass_rule;

/// What the motion of a rigid body needs to know of its mass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MassMoments {
    /// Mass `[kg]` (in a plane body of its thickness, around an axis of the full ring).
    pub mass: f64,
    /// Centre of mass `[m]` of the mesh.
    pub centre: Vec3,
    /// `∫ ρ r rᵀ dV` with `r` from the centre of mass `[kg m²]`.
    pub second: Mat3,
}

impl MassMoments {
    /// Moments of inertia about the centre of mass `[kg m²]`, `∫ ρ (|r|² 1 - r rᵀ) dV`; in the plane that about z is the polar one.
    pub fn inertia(&self) -> Mat3 {
        let trace = self.trace();
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (if i == j { trace } else { 0.0 }) - self.second[i][j])
        })
    }

    /// The root of the mean square distance of the mass from its centre `[m]`.
    pub fn radius(&self) -> f64 {
        (self.trace() / self.mass).sqrt()
    }

    fn trace(&self) -> f64 {
        self.second[0][0] + self.second[1][1] + self.second[2][2]
    }
}

/// Mass, centre and moments of inertia by quadrature.
///
/// Mass and centre are integrated as weight is, so that weight acts at the centre also where cells are curved.
pub fn mass_moments(body: &Elastic) -> MassMoments {
    let mut sums = [0.0; 4];
    each_mass_point(body, false, &mut |x, mass| {
        sums[0] += mass;
        for (s, x) in sums[1..].iter_mut().zip(x) {
            *s += mass * x;
        }
    });
    let mass = sums[0];
    let centre: Vec3 = std::array::from_fn(|i| sums[i + 1] / mass);
    let mut second = [[0.0; 3]; 3];
    each_mass_point(body, true, &mut |x, mass| {
        let r: Vec3 = std::array::from_fn(|i| x[i] - centre[i]);
        for (row, a) in second.iter_mut().zip(r) {
            for (s, b) in row.iter_mut().zip(r) {
                *s += mass * a * b;
            }
        }
    });
    MassMoments {
        mass,
        centre,
        second,
    }
}

/// Hands out the quadrature points of all cells and the mass of each, by the rule of the cells or that of masses.
fn each_mass_point(body: &Elastic, fine: bool, visit: &mut dyn FnMut(Vec3, f64)) {
    for part in &body.parts {
        let block = &body.mesh.blocks[part.block];
        by_nodes!(
            block.kind,
            mass_points(&body.mesh, block, body.space, part.density, fine, visit)
        );
    }
}

fn mass_points<const N: usize>(
    mesh: &Mesh,
    block: &Block,
    space: Space,
    density: f64,
    fine: bool,
    visit: &mut dyn FnMut(Vec3, f64),
) {
    let table = match fine {
        true => Table::<N>::with_rule(block.kind, &mass_rule(block.kind)),
        false => Table::<N>::new(block.kind, space),
    };
    for cell in 0..block.connectivity.len() / N {
        let nodes = coordinates(&mesh.points, block, cell);
        for (q, n) in table.values.iter().enumerate() {
            let x = nodes.map(|row: [f64; N]| row.iter().zip(n).map(|(x, n)| x * n).sum());
            visit(x, density * point(&table, q, &nodes, space).volume);
        }
    }
}
