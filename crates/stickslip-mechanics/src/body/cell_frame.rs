//! Cells with frames of their own: the corotational formulation, for bodies that turn or bend by any angle while strains stay small.
//!
//! The frame of a cell is the rotation `R` and the centre `c` that fit its `N` nodes best: with `X` counted from their mean, `Σ (x - c) Xᵀ = R U` with a symmetric `U`. In
//! it nodes are at `y = Rᵀ (x - c) = X + w`, and the cell stores `½ wᵀ K w` with the stiffness `K` of its shape at first. The force that follows from that energy is
//!
//! ```text
//! f = R h,   h = g - ḡ - a × X,   g = K w,   a = J⁻¹ Σ y × g,   J = tr(U) 1 - U
//! ```
//!
//! Every derivative goes by the spin `ω = J⁻¹ Σ X × δx'` of the frame, where `δx' = Rᵀ δx`: `δy = δx' - δc' - ω × y` and `δf = R (δh + ω × h)`. That is the
//! element-independent corotation of [`nour_omid_rankin_1991`](stickslip_base::references::nour_omid_rankin_1991); for a whole body in place of a cell see
//! [`Corotations`](crate::system::Corotations).

use super::geometry::Nodal;
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, mat_vec, outer, scale, sub, transpose_vec,
};
use crate::system::{FramePose, frame_of};

/// The frame of one cell with `N` nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct CellFrame<const N: usize> {
    dim: usize,
    turn: Mat3,
    /// `J⁻¹`.
    resistance: Mat3,
    /// `X`.
    arms: [Vec3; N],
    /// `y`.
    now: [Vec3; N],
}

impl<const N: usize> CellFrame<N> {
    /// Of the cell with nodes `x` displaced by `u`.
    pub fn new(dim: usize, x: &Nodal<N>, u: &Nodal<N>) -> Self {
        let node = |of: &Nodal<N>, a: usize| -> Vec3 { [of[0][a], of[1][a], of[2][a]] };
        let mean = |of: &Nodal<N>| of.map(|row| row.iter().sum::<f64>() / N as f64);
        let (centre, way) = (mean(x), mean(u));
        let arms: [Vec3; N] = std::array::from_fn(|a| sub(node(x, a), centre));
        let moved: [Vec3; N] = std::array::from_fn(|a| add(arms[a], sub(node(u, a), way)));
        let mut f = [[0.0; 3]; 3];
        for (y, arm) in moved.iter().zip(&arms) {
            let dyad = outer(*y, *arm);
            f.iter_mut().zip(dyad).for_each(|(f, d)| *f = add(*f, d));
        }
        let (turn, resistance) = frame_of(dim, &f);
        CellFrame {
            dim,
            turn,
            resistance,
            arms,
            now: moved.map(|y| transpose_vec(&turn, y)),
        }
    }

    /// What is left of the displacements in the frame `[m]`.
    pub fn local(&self) -> Nodal<N> {
        let w: [Vec3; N] = std::array::from_fn(|a| sub(self.now[a], self.arms[a]));
        std::array::from_fn(|i| std::array::from_fn(|a| w[a][i]))
    }

    /// Turns a tensor xx yy zz xy yz xz out of the frame.
    pub fn turn_stress(&self, tensor: [f64; 6]) -> [f64; 6] {
        let mut turned = tensor;
        FramePose::still(self.turn, [0.0; 3], [0.0; 3]).turn_tensor(&mut turned);
        turned
    }

    /// Turns a strain with engineering shear strains out of the frame.
    pub fn turn_strain(&self, [xx, yy, zz, xy, yz, xz]: [f64; 6]) -> [f64; 6] {
        let half = self.turn_stress([xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * xz]);
        std::array::from_fn(|v| if v < 3 { half[v] } else { 2.0 * half[v] })
    }

    fn node(&self, forces: &[f64], a: usize) -> Vec3 {
        let own = &forces[a * self.dim..(a + 1) * self.dim];
        std::array::from_fn(|i| own.get(i).copied().unwrap_or(0.0))
    }

    fn put(&self, a: usize, value: Vec3, out: &mut [f64]) {
        out[a * self.dim..(a + 1) * self.dim].copy_from_slice(&value[..self.dim]);
    }

    /// `h` and `a` of forces `g` in the frame, `dim` components a node.
    fn balanced(&self, g: &[f64]) -> ([Vec3; N], Vec3) {
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        for (a, y) in self.now.iter().enumerate() {
            let force = self.node(g, a);
            sum = add(sum, force);
            moment = add(moment, cross(*y, force));
        }
        let a = mat_vec(&self.resistance, moment);
        let mean = scale(1.0 / N as f64, sum);
        let h = |n: usize| sub(sub(self.node(g, n), mean), cross(a, self.arms[n]));
        (std::array::from_fn(h), a)
    }

    /// Turns forces in the frame, `dim` components a node, to those on the nodes in space: without resultant and moment.
    pub fn outward(&self, forces: &mut [f64]) {
        let (h, _) = self.balanced(forces);
        for (a, h) in h.into_iter().enumerate() {
            self.put(a, mat_vec(&self.turn, h), forces);
        }
    }

    /// The derivative of the force in space by displacements, exact and symmetric, from the stiffness `k` in the frame, all of shape `(N dim, N dim)`; and what of it is
    /// stiffness alone, which is positive where that is, without what stresses do.
    pub fn tangents(&self, k: &[f64], exact: &mut [f64], stiff: &mut [f64]) {
        let n = N * self.dim;
        let times = |w: &[f64], out: &mut [f64]| {
            for (row, out) in k.chunks_exact(n).zip(out) {
                *out = row.iter().zip(w).map(|(k, w)| k * w).sum();
            }
        };
        let (mut w, mut g, mut dg) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        (0..N).for_each(|a| self.put(a, sub(self.now[a], self.arms[a]), &mut w));
        times(&w, &mut g);
        let (h, a) = self.balanced(&g);
        // Columns by displacements along the axes of the frame.
        let columns = exact.chunks_exact_mut(n).zip(stiff.chunks_exact_mut(n));
        for (at, (exact, stiff)) in columns.enumerate() {
            let (node, axis) = (at / self.dim, at % self.dim);
            let mut e = [0.0; 3];
            e[axis] = 1.0;
            let spin = mat_vec(&self.resistance, cross(self.arms[node], e));
            let dy: [Vec3; N] = std::array::from_fn(|i| {
                let own = if i == node { 1.0 } else { 0.0 } - 1.0 / N as f64;
                sub(scale(own, e), cross(spin, self.now[i]))
            });
            (0..N).for_each(|i| self.put(i, dy[i], &mut w));
            times(&w, &mut dg);
            let dh = self.change(&g, a, &dg, &dy);
            for (i, dh) in dh.into_iter().enumerate() {
                let out = mat_vec(&self.turn, add(dh, cross(spin, h[i])));
                self.put(i, out, exact);
            }
            self.outward(&mut dg);
            stiff.copy_from_slice(&dg);
        }
        self.turn_columns(exact);
        self.turn_columns(stiff);
    }

    /// Lets the columns of a matrix be by displacements along the axes of space in place of those of the frame, and takes away by how little rounding makes it
    /// unsymmetric.
    fn turn_columns(&self, columns: &mut [f64]) {
        let n = N * self.dim;
        for a in 0..N {
            for row in 0..n {
                let at = |i: usize| (a * self.dim + i) * n + row;
                let own = std::array::from_fn(|i| match i < self.dim {
                    true => columns[at(i)],
                    false => 0.0,
                });
                let turned = mat_vec(&self.turn, own);
                (0..self.dim).for_each(|i| columns[at(i)] = turned[i]);
            }
        }
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (columns[i * n + j] + columns[j * n + i]);
                (columns[i * n + j], columns[j * n + i]) = (mean, mean);
            }
        }
    }

    /// `δh`, where forces `g` with the spin `a` change by `dg` and places in the frame by `dy`.
    fn change(&self, g: &[f64], a: Vec3, dg: &[f64], dy: &[Vec3; N]) -> [Vec3; N] {
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        for i in 0..N {
            let (force, change) = (self.node(g, i), self.node(dg, i));
            sum = add(sum, change);
            moment = add(moment, cross(dy[i], force));
            moment = add(moment, cross(self.now[i], change));
            // δJ a
            moment = add_scaled(moment, -dot(dy[i], self.arms[i]), a);
            moment = add_scaled(moment, dot(self.arms[i], a), dy[i]);
        }
        let da = mat_vec(&self.resistance, moment);
        let mean = scale(1.0 / N as f64, sum);
        std::array::from_fn(|i| sub(sub(self.node(dg, i), mean), cross(da, self.arms[i])))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Elastic, Space, testing};
    use crate::body::cells;
    use crate::body::recover;
    use crate::linear::BlockCsr;
    use crate::math::{Vec3, add, distance, mat_vec, rotation, scale, sub};

    /// Bodies of every kind of cell whose cells have frames.
    fn bodies() -> impl Iterator<Item = Elastic> {
        let all = testing::combinations().into_iter();
        all.filter(|c| c.1 != Space::Axisymmetric)
            .map(|(kind, space, formulation)| {
                testing::patch(kind, space, formulation).corotational()
            })
    }

    fn noise(count: usize, seed: f64) -> Vec<f64> {
        let number = |i: usize| (12.9898 * (i as f64 + seed)).sin() * 43758.5453;
        (0..count).map(|i| number(i).fract()).collect()
    }

    /// The points displaced by a function of their places.
    fn displaced(body: &Elastic, at: &dyn Fn(Vec3) -> Vec3) -> Vec<f64> {
        let dim = body.space().dim();
        let points = body.mesh().points.iter();
        points
            .flat_map(|&x| sub(at(x), x).into_iter().take(dim))
            .collect()
    }

    fn axis(dim: usize) -> Vec3 {
        match dim {
            2 => [0.0, 0.0, 1.0],
            _ => [0.6, 0.0, 0.8],
        }
    }

    /// Turned by two radians and strained at random by some per cent.
    fn strained(body: &Elastic) -> Vec<f64> {
        let turn = rotation(axis(body.space().dim()), 2.0);
        let mut u = displaced(body, &|x| mat_vec(&turn, x));
        let more = noise(u.len(), 4.0);
        u.iter_mut().zip(more).for_each(|(u, n)| *u += 0.02 * n);
        u
    }

    fn force(body: &Elastic, u: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        recover::internal_force(body, u, &mut out);
        out
    }

    fn tangents(body: &Elastic, u: &[f64]) -> [BlockCsr; 2] {
        let points = body.mesh().points.len();
        let empty =
            BlockCsr::from_couplings(points, body.space().dim(), &mut |v| body.couplings(v));
        let (mut exact, mut stiff) = (empty.clone(), empty);
        body.tangents(u, &mut exact, &mut stiff);
        [exact, stiff]
    }

    fn size(v: &[f64]) -> f64 {
        v.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    #[test]
    fn forces_are_the_slope_of_the_energy_and_tangents_that_of_the_forces() {
        for body in bodies() {
            let u = strained(&body);
            let f = force(&body, &u);
            let [exact, stiff] = tangents(&body, &u);
            let way = noise(u.len(), 9.0);
            let step = 1e-6;
            let at = |s: f64| -> Vec<f64> { u.iter().zip(&way).map(|(u, w)| u + s * w).collect() };
            let (more, less) = (at(step), at(-step));
            let slope = (recover::strain_energy(&body, &more)
                - recover::strain_energy(&body, &less))
                / (2.0 * step);
            let work: f64 = f.iter().zip(&way).map(|(f, w)| f * w).sum();
            let scale = size(&f) * size(&way);
            assert!((slope - work).abs() < 1e-6 * scale, "{slope} {work}");
            let both = force(&body, &more).into_iter().zip(force(&body, &less));
            let change: Vec<f64> = both.map(|(a, b)| (a - b) / (2.0 * step)).collect();
            let mut product = vec![0.0; u.len()];
            exact.mul(&way, &mut product);
            let off: Vec<f64> = product.iter().zip(&change).map(|(a, b)| a - b).collect();
            assert!(
                size(&off) < 1e-6 * size(&change),
                "{}",
                size(&off) / size(&change)
            );
            // The other one lacks what stresses do, and is no less than nothing.
            stiff.mul(&way, &mut product);
            let off: Vec<f64> = product.iter().zip(&change).map(|(a, b)| a - b).collect();
            let lacks = size(&off) / size(&change);
            assert!(lacks > 1e-5 && lacks < 0.5, "{lacks}");
            assert!(product.iter().zip(&way).map(|(a, b)| a * b).sum::<f64>() > 0.0);
            for row in 0..u.len() {
                for column in 0..row {
                    assert_eq!(exact.entry(row, column), exact.entry(column, row));
                }
            }
        }
    }

    #[test]
    fn a_turn_strains_nothing_and_turns_forces() {
        for body in bodies() {
            let dim = body.space().dim();
            let turn = rotation(axis(dim), 2.5);
            let shift = [3.0, -1.0, if dim == 3 { 0.5 } else { 0.0 }];
            let still = displaced(&body, &|x| add(mat_vec(&turn, x), shift));
            let scale_of = size(&force(&body, &noise(still.len(), 1.0)));
            assert!(size(&force(&body, &still)) < 1e-13 * scale_of);
            // What is strained and then turned has the same forces, turned.
            let bent: Vec<f64> = noise(still.len(), 1.0).iter().map(|n| 0.02 * n).collect();
            let points = body.mesh().points.iter();
            let turned: Vec<f64> = points
                .zip(bent.chunks(dim))
                .flat_map(|(&x, u)| {
                    let u = [u[0], u[1], u.get(2).copied().unwrap_or(0.0)];
                    let place = add(mat_vec(&turn, add(x, u)), shift);
                    sub(place, x).into_iter().take(dim)
                })
                .collect();
            let (before, after) = (force(&body, &bent), force(&body, &turned));
            for (a, b) in before.chunks(dim).zip(after.chunks(dim)) {
                let full = |f: &[f64]| [f[0], f[1], f.get(2).copied().unwrap_or(0.0)];
                let off = distance(mat_vec(&turn, full(a)), full(b));
                assert!(off < 1e-11 * scale_of, "{off}");
            }
        }
    }

    #[test]
    fn stresses_and_strains_are_along_the_axes_of_space() {
        for body in bodies() {
            let dim = body.space().dim();
            // Stretched along x, and turned by a quarter about z: it is stretched along y.
            let stretch = |x: Vec3| [1.001 * x[0], x[1], x[2]];
            let quarter = |x: Vec3| [-x[1], x[0], x[2]];
            let along = displaced(&body, &|x| stretch(x));
            let turned = displaced(&body, &|x| quarter(stretch(x)));
            let (before, after) = (
                cells::stress_at_quadrature(&body, &along),
                cells::stress_at_quadrature(&body, &turned),
            );
            for (a, b) in before.iter().zip(&after) {
                for (a, b, tolerance) in [
                    (a.strain, b.strain, 1e-13),
                    (a.stress, b.stress, 1e-10 * size(&a.stress)),
                ] {
                    let [xx, yy, zz, xy, yz, xz] = a;
                    let expected = [yy, xx, zz, -xy, xz, -yz];
                    for (e, b) in expected.iter().zip(b) {
                        assert!((e - b).abs() < tolerance, "{dim} {e} {b}");
                    }
                }
            }
            assert_eq!(scale(1.0, before[0].x), after[0].x);
        }
    }
}
