//! The moment of the forces of a point of a mortar, both sides together.
//!
//! The sides of a point lie the gap `g` apart: a shear `τ` that acts on the secondary at `x_s` and, against it, on the primary at `x̄ = x_s - g n` leaves the moment
//! `g n × τ`. With multipliers there is next to no gap; on a soft law there is, and a pair that is in equilibrium with itself would turn. Of the same nature is what a pressure
//! leaves where a facet is not square to the line along which the gap is measured. That contact must keep angular momentum is said by
//! [Puso and Laursen 2004](stickslip_base::references::puso_2004): the gradients of gap and slip must vanish for a rotation `δx = ω × x` of both sides.
//!
//! The moment is handed over to the primary, as in a contact element (`facet`, [Laursen 2002](stickslip_base::references::laursen_2002)), where slip along `e` has the gradient
//! `(δx_s - δx̄)·e + g n·(e·∇) δx̄`. Its mean with the weights of the point is
//!
//! `Σ_k w_k e·δx_k + Σ_k (l_k·e) n·δx_k`, `l_k = 1/A ∫ Φ g ∇N_k dA`,
//!
//! with the shape functions `N_k` of the primary. As `Σ ∇N_k = 0` and `Σ x_k ⊗ ∇N_k` is the unity of the tangent plane, the second sum has no resultant, and the moment `g e × n`. All
//! points together give the primary `∫ g ∇N_k`, as the Φ add up to one, so that a uniform shear on a uniform gap still passes without error.
//!
//! Where surfaces are bent or tilted a moment is left that is smaller by the angle between them. It is taken away by forces `f_k = m_k θ × (x_k - x_m)` on the nodes of the primary, which
//! are those of least squares: with the centre `x_m` of the weights `m_k > 0` they have no resultant, and `θ` follows from the moment. The weights are areas, so that a
//! node goes and comes with none.
//!
//! Tied surfaces that keep a gap hand over the moment of that gap too. Small sliding leaves it out: forces are those of the reference configuration, where the gap is small, and a moment
//! of displaced places is what it neglects. On an obstacle, which has no nodes, shear acts at the point alone.
//!
//! The slip has the same terms, so that shear works on the slip that friction dissipates on, also where the sides turn or bend each its own way: on a soft law
//! the balance of energies was open by the distance between the sides times the angle between their turns, however short the increments.
//!
//! That the moment changes with the displacements is left out of the tangent: it is of the size of pressure over modulus, as is what else is left out there.

use crate::math::{Mat3, Vec3, add, add_scaled, cross, dot, inverse, mat_vec, norm, scale, sub};

/// What a node has in the sums around a point, beside its weight.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeSums {
    /// Gradient of the gap with respect to it: first `[m²]`, summed over faces; then `[-]`, the mean.
    pub gradient: Vec3,
    /// Gap times the gradient of its shape function along the primary, the arm of the moment of shear: first `[m²]`, then `[-]`.
    pub lever: Vec3,
    /// Its part of the areas opposite `[m²]`; zero on the secondary.
    pub reach: f64,
}

/// Adds `Σ_k (l_k·e) n` to the gradient of the slip along `e`.
pub(super) fn add_arm(e: Vec3, normal: Vec3, parts: &[NodeSums], dim: usize, row: &mut [f64]) {
    for (row, part) in row.chunks_exact_mut(dim).zip(parts) {
        add_to(row, scale(dot(part.lever, e), normal));
    }
}

/// Takes the moment about these axes, of coordinates, from each of the rows over `nodes` at `x`; those of the primary have a part in the reach.
pub(super) fn remove(
    nodes: &[(usize, f64)],
    parts: &[NodeSums],
    x: &[Vec3],
    axes: [bool; 3],
    dim: usize,
    rows: &mut [Vec<f64>; 3],
) {
    let placed = || nodes.iter().map(|&(node, _)| x[node]).zip(parts);
    let whole: f64 = parts.iter().map(|p| p.reach).sum();
    let centre = placed().fold([0.0; 3], |c, (x, p)| add_scaled(c, p.reach / whole, x));
    let kept = |v: Vec3| -> Vec3 { std::array::from_fn(|c| if axes[c] { v[c] } else { 0.0 }) };
    // Flat surfaces that touch leave none: most points end here.
    let (mut sums, mut sizes) = ([[0.0; 3]; 3], [0.0; 3]);
    for (k, (x, _)) in placed().enumerate() {
        let arm = sub(x, centre);
        let length2 = dot(arm, arm);
        for ((row, sum), size) in rows.iter().zip(&mut sums).zip(&mut sizes).take(dim) {
            let force = in_space(&row[k * dim..(k + 1) * dim]);
            *sum = add(*sum, cross(arm, force));
            *size += (length2 * dot(force, force)).sqrt();
        }
    }
    let moments: [Option<Vec3>; 3] = std::array::from_fn(|q| {
        let sum = kept(sums[q]);
        // A sum below this part of the moments of single forces is rounding.
        (norm(sum) > 1e-13 * sizes[q]).then_some(sum)
    });
    if moments.iter().all(Option::is_none) {
        return;
    }
    // Moments of f_k for unit θ about each axis; about those that are left alone anything will do.
    let inertia: Mat3 = std::array::from_fn(|c| {
        let mut axis = [0.0; 3];
        axis[c] = 1.0;
        if !axes[c] {
            return axis;
        }
        kept(placed().fold([0.0; 3], |sum, (x, p)| {
            let arm = sub(x, centre);
            add_scaled(sum, p.reach, cross(arm, cross(axis, arm)))
        }))
    });
    let Some((inverse, _)) = inverse(&inertia) else {
        return;
    };
    for (row, moment) in rows.iter_mut().zip(moments) {
        let Some(moment) = moment else { continue };
        let turn = scale(-1.0, mat_vec(&inverse, moment));
        for (row, (x, part)) in row.chunks_exact_mut(dim).zip(placed()) {
            add_to(row, scale(part.reach, cross(turn, sub(x, centre))));
        }
    }
}

fn in_space(force: &[f64]) -> Vec3 {
    std::array::from_fn(|c| force.get(c).copied().unwrap_or(0.0))
}

fn add_to(row: &mut [f64], v: Vec3) {
    for (r, v) in row.iter_mut().zip(v) {
        *r += v;
    }
}
