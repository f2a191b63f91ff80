//! The linearised model for other programs: sparse over all unknowns, dense in the space of the map.

use super::linear::{Pair, product};
use super::outcome::{Array, Export};
use super::reduced::Reduced;
use super::shifted::{Root, Shifted};
use crate::io::npy::Numbers;
use crate::linear::BlockCsr;

/// The model condensed to few displacements `T`, and where its rows and columns belong: `TᵀMT`, `TᵀCT`, `TᵀKT` and `TᵀL`, `TᵀR` of friction; the compliance
/// `RᵀK⁻¹L` at the contact points where the stiffness alone holds everything.
pub(super) fn arrays(shifted: &Shifted, root: &Root, reduced: &Reduced) -> Vec<Array> {
    let linear = shifted.linear;
    let dim = linear.stiffness.block_size();
    let free: Vec<usize> = (0..linear.size()).filter(|&i| !linear.fixed[i]).collect();
    let r = reduced.basis.len();
    let floats = |name: &str, shape: [usize; 2], all: Vec<f64>| Array {
        name: name.into(),
        shape,
        numbers: Numbers::Floats(all),
    };
    let basis = free
        .iter()
        .flat_map(|&dof| reduced.basis.iter().map(move |x| x[dof]));
    let mut out = vec![
        floats("reduced-basis", [free.len(), r], basis.collect()),
        floats("reduced-stiffness", [r, r], reduced.stiffness.clone()),
        floats("reduced-mass", [r, r], reduced.mass.clone()),
        floats("reduced-damping", [r, r], reduced.damping.clone()),
    ];
    let places = free
        .iter()
        .flat_map(|dof| [(dof / dim) as i64, (dof % dim) as i64]);
    let integers = |name: String, all: Vec<i64>| Array {
        name,
        shape: [all.len() / 2, 2],
        numbers: Numbers::Integers(all),
    };
    out.push(integers("dofs".into(), places.collect()));
    for (name, pairs) in [("friction", &linear.friction), ("drag", &linear.drag)] {
        let points = pairs
            .iter()
            .flat_map(|p| [p.interface as i64, p.point as i64]);
        out.push(integers(format!("{name}-points"), points.collect()));
        for (side, left) in [("left", true), ("right", false)] {
            let row = |p: &Pair, x: &[f64]| product(if left { &p.left } else { &p.right }, x);
            let entries = reduced
                .basis
                .iter()
                .flat_map(|x| pairs.iter().map(move |p| row(p, x)));
            let name = format!("reduced-{name}-{side}");
            out.push(floats(&name, [r, pairs.len()], entries.collect()));
        }
    }
    if shifted.sigma == 0.0 {
        let q = root.pairs.len();
        out.push(floats("compliance", [q, q], root.compliance().to_vec()));
    }
    out
}

/// The matrices for other programs, over the unknowns.
pub(super) fn matrices(shifted: &Shifted) -> Vec<Export> {
    let linear = shifted.linear;
    let free: Vec<usize> = (0..linear.size()).filter(|&i| !linear.fixed[i]).collect();
    let mut number = vec![usize::MAX; linear.size()];
    for (k, &dof) in free.iter().enumerate() {
        number[dof] = k;
    }
    let n = free.len();
    let damping = linear.damping.as_ref().map(|c| ("damping", c));
    let both = [("stiffness", &linear.stiffness), ("mass", &linear.mass)];
    let symmetric = both
        .into_iter()
        .chain(damping)
        .map(|(name, matrix)| Export {
            name: name.into(),
            shape: [n, n],
            symmetric: true,
            entries: lower(matrix, &free, &number),
        });
    let mut out: Vec<Export> = symmetric.collect();
    let sides = [("friction", &linear.friction), ("drag", &linear.drag)];
    for (name, pairs) in sides {
        for (side, left) in [("left", true), ("right", false)] {
            let rows = pairs.iter().map(|p| if left { &p.left } else { &p.right });
            let entries = rows.enumerate().flat_map(|(k, row)| {
                let number = &number;
                row.iter().map(move |&(dof, v)| (number[dof], k, v))
            });
            out.push(Export {
                name: format!("{name}-{side}"),
                shape: [n, pairs.len()],
                symmetric: false,
                entries: entries.collect(),
            });
        }
    }
    let unknowns = free.iter().enumerate().map(|(k, &dof)| (k, 0, dof as f64));
    out.push(Export {
        name: "dofs".into(),
        shape: [n, 1],
        symmetric: false,
        entries: unknowns.collect(),
    });
    out
}

/// The lower triangle of a symmetric matrix over the unknowns.
fn lower(matrix: &BlockCsr, free: &[usize], number: &[usize]) -> Vec<(usize, usize, f64)> {
    let b = matrix.block_size();
    let mut entries = Vec::new();
    for (i, &row) in free.iter().enumerate() {
        for &point in matrix.neighbours(row / b) {
            let first = point as usize * b;
            for (k, &j) in number[first..first + b].iter().enumerate() {
                let value = if j <= i {
                    matrix.entry(row, first + k)
                } else {
                    0.0
                };
                if value != 0.0 {
                    entries.push((i, j, value));
                }
            }
        }
    }
    entries
}
