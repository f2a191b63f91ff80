//! Shape functions of a kind tabulated at its quadrature points, and their derivatives in a cell.

use std::borrow::Cow;

use super::scheme::stiffness_rule;
use super::{Formulation, Space};
use crate::math::{Mat3, Vec3, inverse};
use crate::mesh::Block;
use crate::shape::{ElementKind, QuadraturePoint, mass_rule};
use crate::system::Dofs;

/// The rule for integrals over a cell whatever its formulation: that of the stiffness in the standard one, where it integrates shape functions exactly over an undistorted
/// cell. The three points of tri6 do not around an axis: `N r` is cubic.
pub(super) fn cell_rule(kind: ElementKind, space: Space) -> Cow<'static, [QuadraturePoint]> {
    match (kind, space) {
        (ElementKind::Tri6, Space::Axisymmetric) => Cow::Owned(mass_rule(kind)),
        _ => Cow::Borrowed(stiffness_rule(kind, space, Formulation::Standard)),
    }
}

/// Shape functions and derivatives of one kind with `N` nodes at the points of its rule, component by component.
#[derive(Debug, Clone)]
pub(super) struct Table<const N: usize> {
    /// Values, one array a quadrature point.
    pub values: Vec<[f64; N]>,
    /// Derivatives by reference direction, one triple of arrays a quadrature point.
    pub gradients: Vec<[[f64; N]; 3]>,
    /// Weights.
    pub weights: Vec<f64>,
}

impl<const N: usize> Table<N> {
    /// For a kind of `N` nodes.
    pub fn new(kind: ElementKind, space: Space) -> Self {
        Self::with_rule(kind, &cell_rule(kind, space))
    }

    /// For a kind of `N` nodes and any rule.
    pub fn with_rule(kind: ElementKind, rule: &[QuadraturePoint]) -> Self {
        let mut table = Table {
            values: Vec::new(),
            gradients: Vec::new(),
            weights: Vec::new(),
        };
        let element = kind.reference();
        for point in rule {
            let mut n = [0.0; N];
            element.values(point.xi, &mut n);
            let mut d = [[0.0; 3]; N];
            element.gradients(point.xi, &mut d);
            table.values.push(n);
            table
                .gradients
                .push(std::array::from_fn(|k| std::array::from_fn(|a| d[a][k])));
            table.weights.push(point.weight);
        }
        table
    }

    /// Number of quadrature points.
    pub fn len(&self) -> usize {
        self.weights.len()
    }
}

/// Coordinates (or displacements) of a cell's nodes, component by component.
pub(super) type Nodal<const N: usize> = [[f64; N]; 3];

/// The coordinates of cell `cell` of `block`.
#[inline]
pub(super) fn coordinates<const N: usize>(points: &[Vec3], block: &Block, cell: usize) -> Nodal<N> {
    let mut x = [[0.0; N]; 3];
    for (a, &p) in block.connectivity[cell * N..(cell + 1) * N]
        .iter()
        .enumerate()
    {
        for (row, &c) in x.iter_mut().zip(&points[p]) {
            row[a] = c;
        }
    }
    x
}

/// The values of the cell's points in a dof vector, component by component.
pub(super) fn gather<const N: usize>(
    u: &[f64],
    dofs: Dofs,
    block: &Block,
    cell: usize,
) -> Nodal<N> {
    let mut out = [[0.0; N]; 3];
    for (a, &p) in block.connectivity[cell * N..(cell + 1) * N]
        .iter()
        .enumerate()
    {
        for (i, row) in out.iter_mut().enumerate().take(dofs.dim) {
            row[a] = u[dofs.of(p, i)];
        }
    }
    out
}

/// Derivatives in space at a quadrature point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point<const N: usize> {
    /// `d[k][a] = ∂N_a/∂x_k`; with axial symmetry `d[2][a] = N_a / r`.
    pub d: Nodal<N>,
    /// Volume that the point stands for: weight, Jacobian and extent.
    pub volume: f64,
    /// Jacobian.
    pub jacobian: f64,
}

/// Derivatives at quadrature point `q` of the cell with nodes `x`. A collapsed cell gives a Jacobian that is zero or
/// not finite and zero derivatives.
#[inline]
pub(super) fn point<const N: usize>(
    table: &Table<N>,
    q: usize,
    x: &Nodal<N>,
    space: Space,
) -> Point<N> {
    let dim = space.dim();
    let reference = &table.gradients[q];
    let mut j: Mat3 = [[0.0; 3]; 3];
    for i in 0..dim {
        for m in 0..dim {
            let mut sum = 0.0;
            for a in 0..N {
                sum += x[i][a] * reference[m][a];
            }
            j[i][m] = sum;
        }
    }
    if dim == 2 {
        j[2][2] = 1.0;
    }
    let mut d = [[0.0; N]; 3];
    let Some((inv, jacobian)) = inverse(&j) else {
        return Point {
            d,
            volume: 0.0,
            jacobian: crate::math::determinant(&j),
        };
    };
    for (k, row) in d.iter_mut().enumerate().take(dim) {
        for m in 0..dim {
            let factor = inv[m][k];
            for a in 0..N {
                row[a] += factor * reference[m][a];
            }
        }
    }
    let mut extent = 1.0;
    match space {
        Space::Solid => {}
        Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => extent = thickness,
        Space::Axisymmetric => {
            let n = &table.values[q];
            let radius: f64 = (0..N).map(|a| n[a] * x[0][a]).sum();
            for a in 0..N {
                d[2][a] = n[a] / radius;
            }
            extent = space.extent([radius, 0.0, 0.0]);
        }
    }
    Point {
        d,
        volume: table.weights[q] * jacobian * extent,
        jacobian,
    }
}

/// Calls `$function::<N>` with the node count of `$kind` as `N`; lines have no business among cells.
macro_rules! by_nodes {
    ($kind:expr, $($function:ident)::+ ( $($argument:expr),* $(,)? )) => {
        match $kind.node_count() {
            3 => $($function)::+::<3>($($argument),*),
            4 => $($function)::+::<4>($($argument),*),
            6 => $($function)::+::<6>($($argument),*),
            8 => $($function)::+::<8>($($argument),*),
            10 => $($function)::+::<10>($($argument),*),
            15 => $($function)::+::<15>($($argument),*),
            20 => $($function)::+::<20>($($argument),*),
            n => unreachable!("no cell has {n} nodes"),
        }
    };
}
pub(super) use by_nodes;
