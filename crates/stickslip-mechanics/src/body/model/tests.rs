//! What every formulation of bodies has to keep, however it makes its forces.

use std::sync::Arc;

use super::{BodiesByCell, CorotatedBodies, LinearBodies};
use crate::body::testing::{PLANE_STRAIN, body, distort, grid, isotropic};
use crate::body::{Elastic, Formulation, Space};
use crate::linear::{BlockCsr, Matrix};
use crate::math::vector::{difference, dot, norm, weighted_mean};
use crate::math::{Vec3, add, mat_vec, rotation, sub};
use crate::shape::ElementKind;
use crate::system::{BodyModel, Corotations, Deformed, Dofs};

/// A block of a few cells, and the formulations of it.
struct Block {
    elastic: Elastic,
    dofs: Dofs,
}

impl Block {
    fn all() -> [Block; 2] {
        let block = |kind, space: Space| {
            let mesh = grid(kind, [2, 2, 1], &distort);
            let dofs = Dofs {
                dim: space.dim(),
                points: mesh.points.len(),
            };
            let stiffness = isotropic(3.0, 0.25);
            Block {
                elastic: body(mesh, space, Formulation::Standard, stiffness),
                dofs,
            }
        };
        [
            block(ElementKind::Quad4, PLANE_STRAIN),
            block(ElementKind::Hex8, Space::Solid),
        ]
    }

    fn places(&self) -> &[Vec3] {
        &self.elastic.mesh().points
    }

    fn empty(&self) -> BlockCsr {
        let Dofs { points, dim } = self.dofs;
        BlockCsr::from_couplings(points, dim, &mut |visit| self.elastic.couplings(visit))
    }

    /// Each formulation with its name, and whether a turn of any angle strains nothing in it.
    fn models(&self) -> Vec<(&'static str, bool, Box<dyn BodyModel>)> {
        let mut stiffness = self.empty();
        self.elastic.stiffness(&mut stiffness);
        let stiffness: Arc<dyn Matrix> = Arc::new(stiffness);
        let weights = (0..self.dofs.points).map(|p| 1.0 + p as f64).collect();
        let whole = vec![(0..self.dofs.points, weights)];
        let frames = Arc::new(Corotations::new(self.dofs, self.places(), whole));
        let by_cell = BodiesByCell {
            linear: self.empty(),
            turning: vec![self.elastic.clone().corotational()],
        };
        let linear = LinearBodies {
            stiffness: Arc::clone(&stiffness),
        };
        vec![
            ("linear", false, Box::new(linear)),
            (
                "corotated",
                true,
                Box::new(CorotatedBodies { stiffness, frames }),
            ),
            ("by cell", true, Box::new(by_cell)),
        ]
    }

    /// Displacements by a turn about an axis through the origin, and a strain of some per cent.
    fn displaced(&self, angle: f64, strain: f64) -> Vec<f64> {
        let axis = match self.dofs.dim {
            2 => [0.0, 0.0, 1.0],
            _ => [0.6, 0.0, 0.8],
        };
        let turn = rotation(axis, angle);
        let more = noise(self.dofs.count(), 3.0);
        let mut u: Vec<f64> = Vec::new();
        for &x in self.places() {
            let moved = add(sub(mat_vec(&turn, x), x), [0.3, -0.2, 0.0]);
            u.extend(&moved[..self.dofs.dim]);
        }
        u.iter().zip(more).map(|(u, n)| u + strain * n).collect()
    }
}

fn noise(count: usize, seed: f64) -> Vec<f64> {
    let number = |i: usize| (12.9898 * (i as f64 + seed)).sin() * 43758.5453;
    (0..count).map(|i| number(i).fract()).collect()
}

fn moved(u: &[f64], way: &[f64], by: f64) -> Vec<f64> {
    u.iter().zip(way).map(|(u, w)| u + by * w).collect()
}

fn energy(model: &dyn BodyModel, u: &[f64]) -> f64 {
    let forces = &model.forces(u);
    model.energy(Deformed { u, forces })
}

const STEP: f64 = 1e-6;

#[test]
fn forces_are_the_slope_of_the_energy_and_tangents_that_of_the_forces() {
    for block in Block::all() {
        let u = block.displaced(0.7, 0.02);
        let way = noise(u.len(), 9.0);
        let ends = [STEP, -STEP].map(|by| moved(&u, &way, by));
        for (name, _, model) in block.models() {
            let forces = model.forces(&u);
            let [more, less] = ends.each_ref().map(|u| energy(&*model, u));
            let slope = (more - less) / (2.0 * STEP);
            let scale = norm(&forces) * norm(&way);
            assert!((slope - dot(&forces, &way)).abs() < 1e-7 * scale, "{name}");
            let Some(body) = model.nonlinear() else {
                continue;
            };
            let mut product = vec![0.0; u.len()];
            body.tangents(&u)[0].mul(&way, &mut product);
            let [more, less] = ends.each_ref().map(|u| model.forces(u));
            let change = difference(&more, &less)
                .iter()
                .map(|f| f / (2.0 * STEP))
                .collect::<Vec<_>>();
            let off = norm(&difference(&product, &change));
            assert!(off < 1e-6 * norm(&change), "{name}: {off:e}");
            body.write_forces(&u, &mut product);
            assert_eq!(product, forces, "{name}");
        }
    }
}

#[test]
fn a_turn_of_any_angle_strains_nothing_where_bodies_turn() {
    for block in Block::all() {
        let [turned, strained] = [0.0, 0.02].map(|strain| block.displaced(1.1, strain));
        for (name, turns, model) in block.models() {
            let ratio = energy(&*model, &turned) / energy(&*model, &strained);
            match turns {
                true => assert!(ratio < 1e-20, "{name}: {ratio:e}"),
                false => assert!(ratio > 0.1, "{name}: {ratio:e}"),
            }
        }
    }
}

#[test]
fn stages_lie_between_the_ends_and_their_work_is_closed() {
    for block in Block::all() {
        let [a, b] = [block.displaced(0.2, 0.02), block.displaced(0.25, -0.01)];
        for (name, _, model) in block.models() {
            let [fa, fb] = [&a, &b].map(|u| model.forces(u));
            let ends = [(&a, &fa), (&b, &fb)].map(|(u, forces)| Deformed { u, forces });
            // Where one end has all the weight its forces are those of the stage.
            for (first, forces) in [(1.0, &fa), (0.0, &fb)] {
                let off = difference(&model.stage_forces(first, ends), forces);
                assert!(norm(&off) < 1e-12 * norm(forces), "{name} {first}");
            }
            let stage = model.stage_forces(0.3, ends);
            let work = dot(&difference(&b, &a), &stage);
            let stored = energy(&*model, &b) - energy(&*model, &a);
            let left = model.unstored_work(0.3, ends);
            assert!(
                (left - (work - stored)).abs() < 1e-12 * work.abs(),
                "{name}"
            );
            if name == "linear" {
                assert_eq!(stage, weighted_mean(0.3, &fa, &fb));
            }
        }
    }
}

#[test]
fn a_body_that_turns_as_a_whole_is_not_damped_in_its_frame() {
    for block in Block::all() {
        let u = block.displaced(0.9, 0.0);
        let later = block.displaced(0.9 + STEP, 0.0);
        let spinning: Vec<f64> = difference(&later, &u).iter().map(|v| v / STEP).collect();
        let shaking = noise(u.len(), 5.0);
        for (name, _, model) in block.models() {
            let damped = |v: &[f64]| norm(&model.damping(&|v: &[f64]| v.to_vec(), &u, v));
            assert!(damped(&shaking) > 0.1 * norm(&shaking), "{name}");
            match name {
                "corotated" => assert!(damped(&spinning) < 1e-5 * norm(&spinning), "{name}"),
                _ => assert!(damped(&spinning) > 0.1 * norm(&spinning), "{name}"),
            }
        }
    }
}
