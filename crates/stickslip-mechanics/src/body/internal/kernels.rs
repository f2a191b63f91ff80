//! Which kernel computes which cells of a part.

use std::collections::BTreeMap;

use super::super::medium::Medium;
use super::super::scheme::Scheme;
use super::super::{Elastic, Formulation, Space};
use super::cellwise::Cellwise;
use super::generic::Generic;
use super::hex8::{Hex8, Parallelepiped};
use super::law::{General, Isotropic, Law};
use super::sweep::{Kernel, Swept};
use super::tet4::Tet4;
use super::uniform::Uniform;
use crate::material::Stiffness;
use crate::math::{Vec3, add, cross, dot, norm, sub};
use crate::mesh::Block;
use crate::shape::ElementKind;

/// How far a hexahedron may be from one with parallel faces to be computed as one: displacement of a node over the least
/// height. Forces differ by a small multiple of it. The rounding of coordinates stays below it up to some hundred cells
/// along a side.
const PARALLEL_FACES: f64 = 2e-13;

/// The kernels for part `part` of a body, each with its cells in ascending order.
pub fn of_part(body: &Elastic, part: usize) -> Vec<(Box<dyn Kernel>, Vec<u32>)> {
    let block = &body.mesh.blocks[body.parts[part].block];
    let all = 0..(block.connectivity.len() / block.kind.node_count()) as u32;
    if body.parts[part].cells.is_none() {
        return of_cells(body, block, &body.acting[part], all.collect());
    }
    // Cells of different stiffness are as many materials.
    let mut alike: BTreeMap<Vec<u64>, Vec<u32>> = BTreeMap::new();
    for cell in all {
        let acting = body.acting_in(part, cell as usize);
        let bits = acting.as_flattened().iter().map(|c| c.to_bits());
        alike.entry(bits.collect()).or_default().push(cell);
    }
    let each = alike.into_values().flat_map(|cells| {
        let acting = body.acting_in(part, cells[0] as usize);
        of_cells(body, block, &acting, cells)
    });
    each.collect()
}

/// The kernels for some cells of a block that have one stiffness.
fn of_cells(
    body: &Elastic,
    block: &Block,
    acting: &Stiffness,
    cells: Vec<u32>,
) -> Vec<(Box<dyn Kernel>, Vec<u32>)> {
    let (kind, space, formulation) = (block.kind, body.space, body.formulation);
    let scheme = Scheme::of(kind, formulation);
    if matches!(scheme, Scheme::Uniform | Scheme::Incompatible) {
        let kernel = bilinear(kind, space, formulation, acting);
        return vec![(kernel, cells)];
    }
    if kind == ElementKind::Hex8 {
        let mean = scheme == Scheme::MeanDilatation;
        let (parallel, other) = (cells.into_iter())
            .partition(|&cell| is_parallelepiped(&body.mesh.points, block, cell));
        return vec![
            (hexahedron(acting, mean, true), parallel),
            (hexahedron(acting, mean, false), other),
        ];
    }
    vec![(simple(kind, space, formulation, acting), cells)]
}

/// quad4 and hex8 with the mean strain or modes inside the cell.
fn bilinear(
    kind: ElementKind,
    space: Space,
    formulation: Formulation,
    acting: &Stiffness,
) -> Box<dyn Kernel> {
    let uniform = Scheme::of(kind, formulation) == Scheme::Uniform;
    let general = General(*acting);
    if kind == ElementKind::Quad4 {
        let medium = Medium::<4>::new(kind, space, formulation, acting);
        return match uniform && space != Space::Axisymmetric {
            true => Box::new(Swept(Uniform::<_, 4, 2, 4>::new(medium, general))),
            false => Box::new(Swept(Cellwise::<4, 2>(medium))),
        };
    }
    let medium = Medium::<8>::new(kind, space, formulation, acting);
    match (uniform, Isotropic::of(acting)) {
        (true, Some(law)) => Box::new(Swept(Uniform::<_, 8, 3, 6>::new(medium, law))),
        (true, None) => Box::new(Swept(Uniform::<_, 8, 3, 6>::new(medium, general))),
        (false, _) => Box::new(Swept(Cellwise::<8, 3>(medium))),
    }
}

fn simple(
    kind: ElementKind,
    space: Space,
    formulation: Formulation,
    acting: &Stiffness,
) -> Box<dyn Kernel> {
    macro_rules! generic {
        ($n:literal, $d:literal) => {
            Box::new(Swept::<_, $n, $d>(Generic::<$n, $d, { 2 * $d }>::new(
                kind,
                space,
                formulation,
                acting,
            )))
        };
    }
    match (kind.node_count(), kind.dim()) {
        (3, _) => generic!(3, 2),
        (4, 2) => generic!(4, 2),
        (6, 2) => generic!(6, 2),
        (6, _) => generic!(6, 3),
        (8, 2) => generic!(8, 2),
        (4, _) => match Isotropic::of(acting) {
            Some(law) => Box::new(Swept::<_, 4, 3>(Tet4::new(law))),
            None => Box::new(Swept::<_, 4, 3>(Tet4::new(General(*acting)))),
        },
        (10, _) => generic!(10, 3),
        (15, _) => generic!(15, 3),
        (20, _) => generic!(20, 3),
        (n, _) => unreachable!("no cell has {n} nodes"),
    }
}

fn hexahedron(acting: &Stiffness, mean: bool, parallel: bool) -> Box<dyn Kernel> {
    match Isotropic::of(acting) {
        Some(law) => hexahedron_of(law, mean, parallel),
        None => hexahedron_of(General(*acting), mean, parallel),
    }
}

fn hexahedron_of<L: Law>(law: L, mean: bool, parallel: bool) -> Box<dyn Kernel> {
    match (mean, parallel) {
        (false, false) => Box::new(Swept(Hex8::<_, false>::new(law))),
        (false, true) => Box::new(Swept(Parallelepiped::<_, false>::new(law))),
        (true, false) => Box::new(Swept(Hex8::<_, true>::new(law))),
        (true, true) => Box::new(Swept(Parallelepiped::<_, true>::new(law))),
    }
}

/// Whether the faces of a hexahedron are parallel, see [`PARALLEL_FACES`].
fn is_parallelepiped(points: &[Vec3], block: &Block, cell: u32) -> bool {
    let x: [Vec3; 8] = std::array::from_fn(|a| points[block.connectivity[cell as usize * 8 + a]]);
    let edges = [1, 3, 4].map(|a| sub(x[a], x[0]));
    let [p, q, r] = edges;
    let volume = dot(p, cross(q, r));
    let largest_face = [cross(p, q), cross(q, r), cross(r, p)]
        .map(norm)
        .into_iter()
        .fold(0.0, f64::max);
    let expected = [
        (2, add(p, q)),
        (5, add(p, r)),
        (6, add(add(p, q), r)),
        (7, add(q, r)),
    ];
    expected
        .into_iter()
        .all(|(a, edge)| norm(sub(sub(x[a], x[0]), edge)) * largest_face <= PARALLEL_FACES * volume)
}
