//! Any kind of cell, with the rule and the formulation that the stiffness matrix has.

use std::f64::consts::TAU;

use pulp::Simd;

use super::super::geometry::Table;
use super::super::scheme::{Scheme, stiffness_rule};
use super::super::{Formulation, Space};
use super::lane::{Lane, Nodes};
use super::law::{General, Law};
use super::sweep::CellForce;
use super::tensor::{Vector, cofactors, shift, strain, take_mean, trace, traction};
use crate::material::Stiffness;
use crate::shape::ElementKind;

/// Cells of `N` nodes in `D` dimensions, with `V = 2 D` components of stress.
pub struct Generic<const N: usize, const D: usize, const V: usize> {
    table: Table<N>,
    law: General,
    space: Space,
    mean: bool,
}

/// The geometry at a quadrature point.
struct Place<S: Simd, const D: usize> {
    /// Cofactors of the Jacobian matrix, times weight and extent over it: gradients times volume.
    c: [Vector<S, D>; D],
    /// Volume that the point stands for.
    volume: Lane<S>,
    /// One over the radius; of use with axial symmetry only.
    curvature: Lane<S>,
}

impl<const N: usize, const D: usize, const V: usize> Generic<N, D, V> {
    /// For the stiffness as it acts in the space.
    pub fn new(
        kind: ElementKind,
        space: Space,
        formulation: Formulation,
        acting: &Stiffness,
    ) -> Self {
        Generic {
            table: Table::with_rule(kind, stiffness_rule(kind, space, formulation)),
            law: General(*acting),
            space,
            mean: Scheme::of(kind, formulation) == Scheme::MeanDilatation,
        }
    }

    fn axisymmetric(&self) -> bool {
        self.space == Space::Axisymmetric
    }

    /// `out[k] = ∂/∂ξ_k` of a field with the given nodal values at point `q`.
    #[inline(always)]
    fn by_reference<S: Simd>(
        &self,
        simd: S,
        part: usize,
        q: usize,
        nodes: &Nodes<N, D>,
    ) -> [Vector<S, D>; D] {
        let mut sums = [[Lane::splat(simd, 0.0); D]; D];
        for (a, node) in nodes.iter().enumerate() {
            for k in 0..D {
                let derivative = Lane::splat(simd, self.table.gradients[q][k][a]);
                for i in 0..D {
                    sums[k][i] =
                        derivative.times_plus(Lane::load(simd, &node[i], part), sums[k][i]);
                }
            }
        }
        sums
    }

    /// The radial component at point `q`.
    #[inline(always)]
    fn radial<S: Simd>(&self, simd: S, part: usize, q: usize, nodes: &Nodes<N, D>) -> Lane<S> {
        let mut sum = Lane::splat(simd, 0.0);
        for (value, node) in self.table.values[q].iter().zip(nodes) {
            sum = Lane::splat(simd, *value).times_plus(Lane::load(simd, &node[0], part), sum);
        }
        sum
    }

    #[inline(always)]
    fn place<S: Simd>(&self, simd: S, part: usize, q: usize, x: &Nodes<N, D>) -> Place<S, D> {
        let (mut c, determinant) = cofactors(simd, &self.by_reference(simd, part, q, x));
        let weight = self.table.weights[q];
        let mut factor = Lane::splat(simd, weight);
        let mut curvature = Lane::splat(simd, 0.0);
        match self.space {
            Space::Solid => {}
            Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => {
                factor = Lane::splat(simd, weight * thickness);
            }
            Space::Axisymmetric => {
                let radius = self.radial(simd, part, q, x);
                curvature = radius.inverse();
                factor = Lane::splat(simd, weight * TAU) * radius;
            }
        }
        for row in &mut c {
            for entry in row {
                *entry = *entry * factor;
            }
        }
        Place {
            c,
            volume: determinant * factor,
            curvature,
        }
    }

    /// Adds `Σ_k ∂N_a/∂ξ_k t_k` to the nodes, and with axial symmetry `N_a hoop` to the radial component.
    #[inline(always)]
    fn add<S: Simd>(
        &self,
        simd: S,
        part: usize,
        q: usize,
        t: &[Vector<S, D>; D],
        hoop: Lane<S>,
        nodes: &mut Nodes<N, D>,
    ) {
        for (a, node) in nodes.iter_mut().enumerate() {
            for i in 0..D {
                let mut sum = Lane::load(simd, &node[i], part);
                for k in 0..D {
                    let derivative = Lane::splat(simd, self.table.gradients[q][k][a]);
                    sum = derivative.times_plus(t[k][i], sum);
                }
                if i == 0 && self.axisymmetric() {
                    sum = Lane::splat(simd, self.table.values[q][a]).times_plus(hoop, sum);
                }
                sum.store(&mut node[i], part);
            }
        }
    }
}

impl<const N: usize, const D: usize, const V: usize> CellForce<N, D> for Generic<N, D, V> {
    #[inline(always)]
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<N, D>,
        u: &Nodes<N, D>,
        f: &mut Nodes<N, D>,
    ) {
        let zero = Lane::splat(simd, 0.0);
        let third = Lane::splat(simd, 1.0 / 3.0);
        for node in f.iter_mut() {
            for row in node {
                zero.store(row, part);
            }
        }

        // With mean dilatation: one over the volume, and the integrals of the gradients, `∫ div` of every dof.
        let mut divergence = *f;
        let (mut volume, mut dilatation) = (zero, zero);
        if self.mean {
            for q in 0..self.table.len() {
                let at = self.place(simd, part, q, x);
                volume += at.volume;
                let hoop = at.volume * at.curvature;
                self.add(simd, part, q, &at.c, hoop, &mut divergence);
            }
            for a in 0..N {
                for i in 0..D {
                    dilatation = Lane::load(simd, &divergence[a][i], part)
                        .times_plus(Lane::load(simd, &u[a][i], part), dilatation);
                }
            }
            volume = volume.inverse();
            dilatation = dilatation * volume;
        }

        let mut pressure = zero;
        for q in 0..self.table.len() {
            let at = self.place(simd, part, q, x);
            let g = self.by_reference(simd, part, q, u);
            let mut e = strain::<S, D, V, D>(simd, &g, &at.c);
            let inverse = at.volume.inverse();
            // In units of the strain times the volume, as what comes from the cofactors is.
            if self.axisymmetric() {
                e[2] = self.radial(simd, part, q, u) * at.curvature * at.volume;
            }
            if self.mean {
                let by = (dilatation * at.volume - trace(&e)) * third;
                shift(&mut e, by);
            }
            let mut stress = self.law.stress(simd, &e, inverse);
            if self.mean {
                let mean = take_mean(simd, &mut stress);
                pressure = mean.times_plus(at.volume, pressure);
            }
            let mut t = [[zero; D]; D];
            for k in 0..D {
                t[k] = traction(&stress, &at.c[k], &t[k]);
            }
            let hoop = stress[2] * at.volume * at.curvature;
            self.add(simd, part, q, &t, hoop, f);
        }
        if self.mean {
            let pressure = pressure * volume;
            for a in 0..N {
                for i in 0..D {
                    Lane::load(simd, &divergence[a][i], part)
                        .times_plus(pressure, Lane::load(simd, &f[a][i], part))
                        .store(&mut f[a][i], part);
                }
            }
        }
    }
}
