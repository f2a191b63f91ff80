//! How rigid bodies turn in space over an increment.
//!
//! A rotation vector that says how far a body has turned since the beginning is a poor unknown: it is singular at a whole revolution, and what resists its change
//! depends on it. So over an increment from the rotation `R₀` the unknown is a vector `ψ` along the axes that the body has at the start, `R₁ = R₀ exp(ψ)`,
//! and spin `Ω` and its change are along the axes of the body, in which the moments of inertia `J` stay. Newmark's relations are between these: for the
//! trapezoidal rule `ψ = dt (Ω₀ + Ω₁)/2`. That the angular momentum `R J Ω` changes by the moments is, in components that are conjugate to `ψ`,
//!
//! ```text
//! [T(ψ) J Ω₁ - T(ψ)ᵀ J Ω₀] / dt = T(ψ)ᵀ R₀ᵀ m = g
//! ```
//!
//! with the matrix `T` of the spin, `δR Rᵀ = R₀ [T δψ]×`. Without a moment that keeps the momentum, and as `Tᵀ ψ = ψ` the energy grows by `ψ · g`, exactly:
//! see the conserving algorithms of [`simo_wong_1991`](stickslip_base::references::simo_wong_1991). What it has more than `J (Ω₁ - Ω₀) / dt`, which Newmark's relations
//! give, is the gyroscopic moment here. Schemes that balance elsewhere than in the middle take it, and the axes, there.

use super::frame_pose::{exponential, product, rotation_vector, rotation_vector_near};
use super::{BodyFrames, Dofs};
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, identity, inverse, mat_vec, scale, sub, transpose_vec,
};

/// A rigid body, or what carries one, at the start of an increment.
#[derive(Debug, Clone, PartialEq)]
struct Rotor {
    /// The hidden point that has the rotation.
    point: usize,
    length: f64,
    /// `R₀`.
    base: Mat3,
    /// The rotation vector there.
    start: Vec3,
}

/// The rigid bodies that turn by any angle in space. Where there are none, as in the plane, everything here does nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IncrementalRotation {
    dofs: Dofs,
    all: Vec<Rotor>,
}

/// Velocities and momenta by dof.
pub type Carried<'a> = (&'a [f64], &'a [f64]);

impl IncrementalRotation {
    /// From where displacements `u` have led to.
    pub fn new(frames: &BodyFrames, u: &[f64]) -> Self {
        let dofs = frames.dofs();
        let spun = frames.spun().into_iter();
        let all = spun.map(|(hidden, length)| {
            let start = scale(1.0 / length, dofs.vector(u, hidden + 1));
            Rotor {
                point: hidden + 1,
                length,
                base: exponential(start).0,
                start,
            }
        });
        IncrementalRotation {
            dofs,
            all: all.collect(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The hidden points that have the rotations.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.all.iter().map(|rotor| rotor.point)
    }

    /// By what the rotation at one of them is multiplied `[m]`.
    pub fn length(&self, point: usize) -> f64 {
        let mut all = self.all.iter();
        all.find(|r| r.point == point).map_or(1.0, |r| r.length)
    }

    /// Counts the free part of a rotation that is held in part, and so goes about one axis, from the start.
    pub fn count_from_start(&self, point: usize, fixed: &[bool], u: &mut [f64]) {
        for rotor in self.all.iter().filter(|r| r.point == point) {
            let own = self.dofs.of(point, 0)..self.dofs.of(point + 1, 0);
            for (k, i) in own.enumerate().filter(|(_, i)| !fixed[*i]) {
                u[i] -= rotor.length * rotor.start[k];
            }
        }
    }

    fn each(&self, x: &mut [f64], new: impl Fn(&Rotor, Vec3) -> Vec3) {
        for rotor in &self.all {
            let value = new(rotor, self.dofs.vector(x, rotor.point));
            x[self.dofs.of(rotor.point, 0)..self.dofs.of(rotor.point + 1, 0)]
                .copy_from_slice(&value);
        }
    }

    /// `ψ` of an increment.
    fn turned(&self, rotor: &Rotor, u: &[f64]) -> Vec3 {
        scale(1.0 / rotor.length, self.dofs.vector(u, rotor.point))
    }

    /// Replaces the rotation vectors of displacements by `ψ`.
    pub fn enter(&self, u: &mut [f64]) {
        self.each(u, |rotor, u| {
            let (turn, _) = exponential(scale(1.0 / rotor.length, u));
            let columns = [0, 1, 2].map(|j| transpose_vec(&rotor.base, turn.map(|row| row[j])));
            let since = std::array::from_fn(|i| columns.map(|column| column[i]));
            scale(rotor.length, rotation_vector(&since))
        });
    }

    /// Replaces `ψ` by rotation vectors, which go on from those of the start.
    pub fn leave(&self, u: &mut [f64]) {
        self.each(u, |rotor, u| {
            let more = scale(1.0 / rotor.length, u);
            let turn = product(&rotor.base, &exponential(more).0);
            let near = add(rotor.start, mat_vec(&rotor.base, more));
            scale(rotor.length, rotation_vector_near(&turn, near))
        });
    }

    /// The same for what is prescribed: of a rotation that is held in part it is the part.
    pub fn enter_prescribed(&self, values: &mut [f64], fixed: &[bool]) {
        let mut whole = values.to_vec();
        self.enter(&mut whole);
        for rotor in &self.all {
            let own = self.dofs.of(rotor.point, 0)..self.dofs.of(rotor.point + 1, 0);
            let all = fixed[own.clone()].iter().all(|f| *f);
            for (k, i) in own.enumerate().filter(|(_, i)| fixed[*i]) {
                values[i] = match all {
                    true => whole[i],
                    false => values[i] - rotor.length * rotor.start[k],
                };
            }
        }
    }

    /// Moments along the axes of space to those of the bodies at the start.
    pub fn to_body_axes(&self, moments: &mut [f64]) {
        self.each(moments, |rotor, m| transpose_vec(&rotor.base, m));
    }

    /// Moments along the axes of the bodies at the start to components conjugate to `ψ`.
    pub fn lean(&self, u: &[f64], moments: &mut [f64]) {
        self.each(moments, |rotor, m| {
            let (_, spin) = exponential(self.turned(rotor, u));
            transpose_vec(&spin, m)
        });
    }

    /// Components conjugate to `ψ` to moments along the axes of space.
    pub fn outward(&self, u: &[f64], moments: &mut [f64]) {
        self.each(moments, |rotor, g| {
            let (_, spin) = exponential(self.turned(rotor, u));
            let upright = inverse(&spin).map_or(identity(), |(inverse, _)| inverse);
            mat_vec(&rotor.base, transpose_vec(&upright, g))
        });
    }

    /// Adds the gyroscopic moment at the stage, which lies `1 - old` of the increment `dt` after its start, to the `inertial` ones that Newmark's relations
    /// give, with velocities and momenta at both ends.
    pub fn add_gyroscopic(
        &self,
        u: &[f64],
        dt: f64,
        old: f64,
        [(v0, p0), (v1, p1)]: [Carried; 2],
        inertial: &mut [f64],
    ) {
        self.each(inertial, |rotor, own| {
            let psi = self.turned(rotor, u);
            let (_, spin) = exponential(psi);
            let at = |x: &[f64]| self.dofs.vector(x, rotor.point);
            let rates = [v0, v1].map(|v| scale(1.0 / rotor.length, at(v)));
            let momenta = [at(p0), at(p1)];
            let ahead = sub(mat_vec(&spin, momenta[1]), momenta[1]);
            let behind = sub(momenta[0], transpose_vec(&spin, momenta[0]));
            let middle = add_scaled(own, 1.0 / dt, add(ahead, behind));
            let [first, last] = [0, 1].map(|k| cross(rates[k], momenta[k]));
            let beyond = add(sub(last, first), cross(psi, middle));
            add_scaled(middle, 0.5 - old, beyond)
        });
    }

    /// Adds `Ω × J Ω` at one state to forces along the axes of the bodies, with a factor.
    pub fn add_steady(&self, factor: f64, (v, p): Carried, forces: &mut [f64]) {
        self.each(forces, |rotor, own| {
            let rate = scale(1.0 / rotor.length, self.dofs.vector(v, rotor.point));
            add_scaled(own, factor, cross(rate, self.dofs.vector(p, rotor.point)))
        });
    }

    /// `ψ` over a time in which no moment acts and the momentum along the axes of the start is `p`, and the momentum along those of the end: for `J⁻¹` as a
    /// product by dof that returns spins times lengths.
    pub fn drift(
        &self,
        p: &[f64],
        dt: f64,
        spin_of: impl Fn(usize, Vec3) -> Vec3,
    ) -> Vec<[Vec3; 2]> {
        let each = self.all.iter().map(|rotor| {
            let momentum = self.dofs.vector(p, rotor.point);
            let rate = |p: Vec3| scale(1.0 / rotor.length, spin_of(rotor.point, p));
            let first = rate(momentum);
            let mut psi = scale(dt, first);
            let mut last = momentum;
            for _ in 0..DRIFTS {
                let (turn, _) = exponential(psi);
                last = transpose_vec(&turn, momentum);
                let next = scale(0.5 * dt, add(first, rate(last)));
                let change = crate::math::distance(next, psi);
                psi = next;
                if change <= f64::EPSILON * crate::math::norm(psi) {
                    break;
                }
            }
            [scale(rotor.length, psi), last]
        });
        each.collect()
    }
}

/// Most times that the rotation of a free flight is corrected; each leaves half its angle of what was wrong.
const DRIFTS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{distance, dot, norm};
    use crate::system::{BodyFrame, Carrier};

    const J: Vec3 = [1.0, 2.5, 3.1];

    fn frames() -> BodyFrames {
        let frame = BodyFrame {
            points: 0..1,
            carrier: Carrier::Reference {
                hidden: 1,
                centre: [0.0; 3],
                length: 0.7,
                base: identity(),
            },
            rigid: true,
        };
        BodyFrames::new(Dofs { dim: 3, points: 3 }, vec![frame])
    }

    fn state(turn: Vec3) -> Vec<f64> {
        let mut u = vec![0.0; 9];
        u[6..].copy_from_slice(&scale(0.7, turn));
        u
    }

    #[test]
    fn rotations_go_in_and_out_and_go_on() {
        let mut start = state([0.0, 0.0, 9.0]);
        let spinning = IncrementalRotation::new(&frames(), &start);
        let mut seen = start.clone();
        spinning.enter(&mut seen);
        assert!(norm([seen[6], seen[7], seen[8]]) < 1e-13);
        seen[8] = 0.07;
        spinning.leave(&mut seen);
        start[8] += 0.07;
        let off = seen
            .iter()
            .zip(&start)
            .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(off < 1e-12, "{seen:?}");
    }

    #[test]
    fn moments_do_the_work_they_do_in_space() {
        // Power of a moment in space and of its components, by finite differences of the rotation.
        let spinning = IncrementalRotation::new(&frames(), &state([0.3, -1.1, 0.8]));
        let (psi, change) = ([0.21, -0.3, 0.4], [0.5, 0.2, -0.7]);
        let rotation = |s: f64| {
            product(
                &spinning.all[0].base,
                &exponential(add_scaled(psi, s, change)).0,
            )
        };
        let (a, b, middle) = (rotation(-1e-5), rotation(1e-5), rotation(0.0));
        let rate: Mat3 = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..3)
                    .map(|k| (b[i][k] - a[i][k]) / 2e-5 * middle[j][k])
                    .sum()
            })
        });
        let spin = [rate[2][1], rate[0][2], rate[1][0]];
        let moment = [0.9, -0.4, 0.6];
        let mut g = state(scale(1.0 / 0.7, moment));
        let u = state(psi);
        spinning.to_body_axes(&mut g);
        spinning.lean(&u, &mut g);
        assert!((dot([g[6], g[7], g[8]], change) - dot(moment, spin)).abs() < 1e-9);
        spinning.outward(&u, &mut g);
        assert!(distance([g[6], g[7], g[8]], moment) < 1e-13);
    }

    #[test]
    fn a_free_drift_keeps_momentum_and_energy() {
        let spinning = IncrementalRotation::new(&frames(), &state([0.0; 3]));
        let spin_of = |_: usize, p: Vec3| [p[0] / J[0], p[1] / J[1], p[2] / J[2]];
        let p = state([0.4, 3.0, -0.2]);
        let [psi, last] = spinning.drift(&p, 0.3, spin_of)[0];
        let first = [p[6], p[7], p[8]];
        let energy = |p: Vec3| dot(p, spin_of(0, p));
        assert!((energy(first) - energy(last)).abs() < 1e-14);
        let (turn, _) = exponential(scale(1.0 / 0.7, psi));
        assert!(distance(mat_vec(&turn, last), first) < 1e-14);
        assert!(distance(last, first) > 0.01);
    }
}
