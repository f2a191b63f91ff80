//! The limit of friction up to which the rate problem of one point has one solution.
//!
//! For one contact point with the stiffness `K = [[k_t, -k_tn], [-k_tn, k_n]]` under unilateral contact and Coulomb friction the velocity is
//! unique if and only if `μ < k_t / |k_tn|` ([`klarbring_1990`](crate::references::klarbring_1990)). `K` is the stiffness at the point with
//! everything else free (from the condensed compliance), or, where there is none, with everything else held.

use crate::assess::view::View;
use crate::math::{Vec3, cross, dot, inverse, normalize, scale, sub};

/// Candidates up to which a column of the compliance is worth its price.
const MOST_CANDIDATES: usize = 6000;

/// `k_t / |k_tn|` at a point of the mesh for a contact with this normal; infinite where normal and tangential motion are not coupled, `None`
/// where nothing is known.
pub(super) fn limit(view: &View, point: usize, normal: Vec3) -> Option<f64> {
    let block = match condensed(view, point) {
        Some(block) => block,
        None => held(view, point)?,
    };
    of_block(&block, normal, view.model.dofs.dim)
}

/// The same with all other points held, from the assembled matrix alone.
pub(super) fn local_limit(view: &View, point: usize, normal: Vec3) -> Option<f64> {
    let block = held(view, point)?;
    of_block(&block, normal, view.model.dofs.dim)
}

/// The diagonal block of the matrix.
fn held(view: &View, point: usize) -> Option<[[f64; 3]; 3]> {
    let model = view.model;
    let dim = model.dofs.dim;
    let mut block = [[0.0; 3]; 3];
    for (i, row) in block.iter_mut().enumerate().take(dim) {
        for (j, entry) in row.iter_mut().enumerate().take(dim) {
            let dofs = (model.dofs.of(point, i), model.dofs.of(point, j));
            *entry = view.solver.stiffness.at(dofs.0, dofs.1);
        }
    }
    (block[0][0] > 0.0).then_some(block)
}

/// The inverse of the block of the compliance.
fn condensed(view: &View, point: usize) -> Option<[[f64; 3]; 3]> {
    let condensation = view.solver.condenser.at_rest()?.condensation();
    let size = condensation.size();
    if size > MOST_CANDIDATES {
        return None;
    }
    let dofs = view.model.dofs;
    let mut block = crate::math::identity();
    let places: Option<Vec<usize>> = (0..dofs.dim)
        .map(|c| condensation.place(dofs.of(point, c)))
        .collect();
    let places = places?;
    for (j, &column) in places.iter().enumerate() {
        let mut force = vec![0.0; size];
        force[column] = 1.0;
        let moved = condensation.apply_compliance(&force);
        for (i, &row) in places.iter().enumerate() {
            block[i][j] = moved[row];
        }
    }
    if dofs.dim == 2 {
        // Only the plane counts, but a unit beside very small numbers would spoil the inverse.
        block[2][2] = block[0][0];
    }
    inverse(&block).map(|(block, _)| block)
}

/// The smallest `k_t / |k_tn|` over the directions in the surface.
fn of_block(block: &[[f64; 3]; 3], normal: Vec3, dim: usize) -> Option<f64> {
    let n = normalize(normal)?;
    let along = crate::math::mat_vec(block, n);
    // The direction in which pressing pushes sideways.
    let aside = sub(along, scale(dot(along, n), n));
    let Some(mut t) = normalize(aside) else {
        return Some(f64::INFINITY);
    };
    if dim == 2 {
        t = cross([0.0, 0.0, 1.0], n);
    }
    let k_t = dot(t, crate::math::mat_vec(block, t));
    let k_tn = dot(t, along).abs();
    (k_t > 0.0).then(|| k_t / k_tn.max(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_point_has_the_limit_of_the_closed_form() {
        // k_t = 1, k_tn = 0.6: μ = 5/3.
        let block = [[1.0, -0.6, 0.0], [-0.6, 2.0, 0.0], [0.0, 0.0, 1.0]];
        let limit = of_block(&block, [0.0, 1.0, 0.0], 2).expect("a stiffness");
        assert!((limit - 5.0 / 3.0).abs() < 1e-12, "{limit}");
        let turned = of_block(&block, [1.0, 0.0, 0.0], 2).expect("a stiffness");
        assert!((turned - 2.0 / 0.6).abs() < 1e-12, "{turned}");
        let free = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(of_block(&free, [0.0, 1.0, 0.0], 3).expect("a stiffness") > 1e12);
    }
}
