//! Output fields of a body.

use super::geometry::by_nodes;
use super::{At, Elastic};
use crate::body::recover;
use crate::system::{Fields, Location, State};

/// The von Mises stress of a stress xx yy zz xy yz xz, in its unit.
fn von_mises(s: &[f64]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// What the output of a body is made of.
struct Recovery {
    /// Stress by point of the body, in the order of [`Elastic::points`].
    stress: Vec<[f64; 6]>,
    /// Strain energy and volume of every cell, part by part.
    cells: Vec<Vec<[f64; 2]>>,
}

/// Values at the points of a mesh summed over cells, and how many there are.
struct Sums<const K: usize> {
    values: Vec<[f64; K]>,
    cells: Vec<f64>,
    /// What they are, from the strain at a quadrature point, what of it is thermal, and the stress.
    of: Quantity<K>,
}

/// A quantity that follows from strain, thermal strain and stress.
type Quantity<const K: usize> = fn([&[f64; 6]; 3]) -> [f64; K];

impl<const K: usize> Sums<K> {
    fn new(count: usize, of: Quantity<K>) -> Self {
        Sums {
            values: vec![[0.0; K]; count],
            cells: vec![0.0; count],
            of,
        }
    }

    /// The mean at each of these points.
    fn means(&self, points: &[usize]) -> Vec<[f64; K]> {
        let mean = |&p: &usize| self.values[p].map(|s| s / self.cells[p]);
        points.iter().map(mean).collect()
    }

    /// Adds the values of a part of a body, and returns energy and volume of every cell.
    fn add_part<const N: usize>(&mut self, body: &Elastic, part: usize, at: At) -> Vec<[f64; 2]> {
        let block = &body.mesh.blocks[body.parts[part].block];
        let fit = &body.to_nodes[part];
        let of = self.of;
        let mut energies = Vec::with_capacity(block.connectivity.len() / N);
        recover::each_cell::<N>(
            body,
            part,
            at,
            K * N + 2,
            |_, _, recovered, values| {
                let (at_nodes, cell) = values.split_at_mut(K * N);
                for (out, row) in at_nodes.chunks_exact_mut(K).zip(fit) {
                    out.fill(0.0);
                    for (q, weight) in row.iter().enumerate() {
                        let [strain, thermal, stress] = recovered.at(q);
                        for (o, s) in out.iter_mut().zip(of([&strain, &thermal, &stress])) {
                            *o += weight * s;
                        }
                    }
                }
                cell.copy_from_slice(&[recovered.energy(), recovered.volume()]);
            },
            |cell, values| {
                let (at_nodes, own) = values.split_at(K * N);
                let points = &block.connectivity[cell * N..(cell + 1) * N];
                for (&p, at_node) in points.iter().zip(at_nodes.chunks_exact(K)) {
                    for (sum, s) in self.values[p].iter_mut().zip(at_node) {
                        *sum += s;
                    }
                    self.cells[p] += 1.0;
                }
                energies.push([own[0], own[1]]);
            },
        );
        energies
    }
}

/// Strain, and behind it the strain energy per volume.
fn strain_and_energy([strain, thermal, stress]: [&[f64; 6]; 3]) -> [f64; 7] {
    let elastic = strain.iter().zip(thermal).map(|(e, t)| e - t);
    let twice: f64 = elastic.zip(stress).map(|(e, s)| e * s).sum();
    let [xx, yy, zz, xy, yz, xz] = *strain;
    [xx, yy, zz, xy, yz, xz, 0.5 * twice]
}

/// Stress at the body's points `[Pa]`, six components each, in the order of [`points`](Elastic::points): taken from
/// the quadrature points to the nodes of each cell by a least-squares fit of the order of the linear element, then
/// averaged over the cells of this body that meet at the point. Different materials that share points are averaged
/// too.
pub fn nodal_stress<'a>(body: &Elastic, at: impl Into<At<'a>>) -> Vec<[f64; 6]> {
    recovery(body, at.into()).stress
}

/// Strain at the body's points, six components with engineering shear strains, and behind them the strain energy per volume `[J/m³]`
/// without that of hourglass control: extrapolated and averaged as [`nodal_stress`] does. The strain across a
/// body in plane stress is not filled in.
fn nodal_strain(body: &Elastic, at: At) -> Vec<[f64; 7]> {
    let mut sums = Sums::new(body.mesh.points.len(), strain_and_energy);
    visit_parts(body, at, &mut sums);
    sums.means(body.points())
}

/// Adds `E` (points, six components) and `ENER` (points, strain energy per volume `[J/m³]`). Other bodies' points keep what is
/// there, zero at first.
pub fn strain_fields<'a>(body: &Elastic, at: impl Into<At<'a>>, out: &mut Fields) {
    let count = body.mesh.points.len();
    let all = nodal_strain(body, at.into());
    let e = out.shared("E", Location::Point, 6, count, 0.0);
    for (&p, values) in body.points().iter().zip(&all) {
        e.values[6 * p..6 * p + 6].copy_from_slice(&values[..6]);
    }
    let energy = out.shared("ENER", Location::Point, 1, count, 0.0);
    for (&p, values) in body.points().iter().zip(&all) {
        energy.values[p] = values[6];
    }
}

/// Visits every cell once.
fn recovery(body: &Elastic, at: At) -> Recovery {
    // By point of the mesh; points of other bodies stay unused.
    let mut sums = Sums::new(body.mesh.points.len(), |[_, _, stress]| *stress);
    let cells = visit_parts(body, at, &mut sums);
    Recovery {
        stress: sums.means(body.points()),
        cells,
    }
}

/// Sums values at points, and returns energy and volume of every cell, part by part.
fn visit_parts<const K: usize>(body: &Elastic, at: At, sums: &mut Sums<K>) -> Vec<Vec<[f64; 2]>> {
    (body.parts.iter().enumerate())
        .map(|(part, p)| {
            by_nodes!(
                body.mesh.blocks[p.block].kind,
                Sums::add_part(sums, body, part, at)
            )
        })
        .collect()
}

/// Adds `S` (points, six components, `[Pa]`), `MISES` (points, `[Pa]`), `SENER` (cells, strain energy per volume
/// `[J/m³]`) and `ELSE` (cells, strain energy `[J]`).
///
/// `MISES` is that of the averaged stress. Other bodies' points and cells keep what is there, zero at first.
pub fn fields(body: &Elastic, state: &State, out: &mut Fields) {
    let Recovery { stress, cells } = recovery(body, state.into());
    let count = body.mesh.points.len();
    let s = out.shared("S", Location::Point, 6, count, 0.0);
    for (&p, stress) in body.points().iter().zip(&stress) {
        s.values[6 * p..6 * p + 6].copy_from_slice(stress);
    }
    let mises = out.shared("MISES", Location::Point, 1, count, 0.0);
    for (&p, stress) in body.points().iter().zip(&stress) {
        mises.values[p] = von_mises(stress);
    }
    let starts = block_starts(body);
    let count = starts[body.mesh.blocks.len()];
    for (p, energies) in body.parts.iter().zip(&cells) {
        let density = out.shared("SENER", Location::Cell, 1, count, 0.0);
        for (v, [energy, volume]) in density.values[starts[p.block]..].iter_mut().zip(energies) {
            *v = energy / volume;
        }
        let whole = out.shared("ELSE", Location::Cell, 1, count, 0.0);
        for (v, [energy, _]) in whole.values[starts[p.block]..].iter_mut().zip(energies) {
            *v = *energy;
        }
    }
    add_heat(body, state, out);
}

/// Adds `NT` (points, temperature) and `THE` (points, six components of thermal strain), where temperatures are given.
fn add_heat(body: &Elastic, state: &State, out: &mut Fields) {
    let Some(temperatures) = &body.temperatures else {
        return;
    };
    let count = body.mesh.points.len();
    let all = temperatures.at(state.t);
    let nt = out.shared("NT", Location::Point, 1, count, 0.0);
    body.points().iter().for_each(|&p| nt.values[p] = all[p]);
    let mut sums = Sums::new(count, |[_, thermal, _]| *thermal);
    visit_parts(body, state.into(), &mut sums);
    let thermal = sums.means(body.points());
    let the = out.shared("THE", Location::Point, 6, count, 0.0);
    for (&p, thermal) in body.points().iter().zip(&thermal) {
        the.values[6 * p..6 * p + 6].copy_from_slice(thermal);
    }
}

/// The index of the first cell of each block among all cells, and the number of cells at the end.
fn block_starts(body: &Elastic) -> Vec<usize> {
    let mut starts = vec![0];
    for block in &body.mesh.blocks {
        let cells = block.connectivity.len() / block.kind.node_count();
        starts.push(starts[starts.len() - 1] + cells);
    }
    starts
}
