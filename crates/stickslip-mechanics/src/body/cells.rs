//! What is printed of a cell: stresses at its integration points, and its energy.

use super::geometry::{Table, by_nodes, point};
use super::recover::stress_of;
use super::scheme::{Scheme, printed_rule};
use super::{At, Elastic, StressPoint};
use crate::body::recover;
use crate::mesh::CellRef;
use crate::shape::QuadraturePoint;

/// Numbers a point.
const NUMBERS_A_POINT: usize = 22;

/// The state of one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellState {
    /// The cell.
    pub cell: CellRef,
    /// Strain energy `[J]`, by the points of the stiffness; that of the stiffness against hourglassing included.
    pub energy: f64,
    /// What of it is energy of the stiffness against hourglassing `[J]`; CalculiX leaves it out.
    pub hourglass: f64,
    /// Volume `[m³]`, with thickness or all around the axis.
    pub volume: f64,
    /// Its integration points as CalculiX and Abaqus have and number them: local coordinates in the order ξ, η, ζ, ξ fastest;
    /// in wedges the triangle faster than its axis.
    ///
    /// hex8 and hex8 with incompatible modes 8, reduced 1; hex20 27, reduced 8; tet4 1; tet10 4; wedge6 2; wedge15 9; in the plane
    /// tri3 1, tri6 3, quad4 4 (reduced 1), quad8 9 (reduced 4). Volumes are those of that rule. Where the stiffness is made at
    /// other points (wedge6 unless reduced, tri3 around an axis), the strains are evaluated here nevertheless.
    pub points: Vec<StressPoint>,
}

/// Visits every cell at displacements, parts and cells in order.
pub fn each_cell_state<'a>(
    body: &Elastic,
    at: impl Into<At<'a>>,
    visit: &mut (dyn FnMut(&CellState) + Send),
) {
    let at = at.into();
    for (part, p) in body.parts.iter().enumerate() {
        by_nodes!(
            body.mesh.blocks[p.block].kind,
            part_states(body, part, at, visit)
        );
    }
}

fn part_states<const N: usize>(
    body: &Elastic,
    part: usize,
    at: At,
    visit: &mut (dyn FnMut(&CellState) + Send),
) {
    let block = body.parts[part].block;
    let kind = body.mesh.blocks[block].kind;
    let rule: &[QuadraturePoint] = printed_rule(kind, body.formulation);
    let table = Table::<N>::with_rule(kind, rule);
    recover::each_cell::<N>(
        body,
        part,
        at,
        3 + rule.len() * NUMBERS_A_POINT,
        |medium, [x, v], recovered, values| {
            values[0] = recovered.energy();
            values[1] = recovered.volume();
            values[2] = recovered.hourglass();
            // Strains that are more than those of the displacements are at hand: these schemes have the points of the rule.
            let own = matches!(medium.scheme, Scheme::Uniform | Scheme::Incompatible);
            for (q, out) in values[3..].chunks_exact_mut(NUMBERS_A_POINT).enumerate() {
                let (n, volume, strain) = if own {
                    let p = &recovered.points[q];
                    (medium.values(q), p.volume, recovered.strain[q])
                } else {
                    let p = point(&table, q, x, body.space);
                    let strain = recovered.strain_at(medium, &p, v);
                    (&table.values[q], p.volume, strain)
                };
                for (o, row) in out.iter_mut().zip(x) {
                    *o = n.iter().zip(row).map(|(n, x)| n * x).sum();
                }
                out[3] = volume;
                // Where the points are others, the thermal strain is the same in all of the cell.
                let thermal = recovered.thermal[q];
                let elastic = std::array::from_fn(|v| strain[v] - thermal[v]);
                let stress = stress_of(&medium.acting, &elastic);
                let [strain, thermal, stress] = recovered.in_space([strain, thermal, stress]);
                out[4..10].copy_from_slice(&strain);
                out[10..16].copy_from_slice(&stress);
                out[16..].copy_from_slice(&thermal);
            }
        },
        |cell, values| {
            let cell = CellRef { block, cell };
            let point = |v: &[f64]| StressPoint {
                cell,
                x: [v[0], v[1], v[2]],
                volume: v[3],
                strain: std::array::from_fn(|i| v[4 + i]),
                stress: std::array::from_fn(|i| v[10 + i]),
                thermal: std::array::from_fn(|i| v[16 + i]),
            };
            visit(&CellState {
                cell,
                energy: values[0],
                volume: values[1],
                hourglass: values[2],
                points: values[3..]
                    .chunks_exact(NUMBERS_A_POINT)
                    .map(point)
                    .collect(),
            });
        },
    );
}

/// Stress and strain at every quadrature point at displacements; parts, cells and points in order. A cell with the
/// mean of all strains has one point, its centre.
pub fn stress_at_quadrature<'a>(body: &Elastic, at: impl Into<At<'a>>) -> Vec<StressPoint> {
    let at = at.into();
    let mut all = Vec::new();
    for (part, p) in body.parts.iter().enumerate() {
        let kind = body.mesh.blocks[p.block].kind;
        by_nodes!(
            kind,
            part_stress(body, part, at, &mut |point| all.push(point))
        );
    }
    all
}

fn part_stress<const N: usize>(
    body: &Elastic,
    part: usize,
    at: At,
    visit: &mut (dyn FnMut(StressPoint) + Send),
) {
    let block = body.parts[part].block;
    let points = recover::medium::<N>(body, part).stations();
    recover::each_cell::<N>(
        body,
        part,
        at,
        points * NUMBERS_A_POINT,
        |medium, [x, _], recovered, values| {
            for (q, out) in values.chunks_exact_mut(NUMBERS_A_POINT).enumerate() {
                let n = medium.values(q);
                for (o, row) in out.iter_mut().zip(x) {
                    *o = n.iter().zip(row).map(|(n, x)| n * x).sum();
                }
                out[3] = recovered.points[q].volume;
                let [strain, thermal, stress] = recovered.at(q);
                out[4..10].copy_from_slice(&strain);
                out[10..16].copy_from_slice(&stress);
                out[16..].copy_from_slice(&thermal);
            }
        },
        |cell, values| {
            for v in values.chunks_exact(NUMBERS_A_POINT) {
                visit(StressPoint {
                    cell: CellRef { block, cell },
                    x: [v[0], v[1], v[2]],
                    volume: v[3],
                    strain: std::array::from_fn(|i| v[4 + i]),
                    stress: std::array::from_fn(|i| v[10 + i]),
                    thermal: std::array::from_fn(|i| v[16 + i]),
                });
            }
        },
    );
}
