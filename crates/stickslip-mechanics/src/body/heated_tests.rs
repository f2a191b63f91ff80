//! Bodies that are heated.

use std::sync::Arc;

use super::internal::InternalForce;
use super::testing::{body, combinations, distort, grid, isotropic, matrix, noise, patch};
use super::*;
use crate::body::{around, cells, fields, recover};
use crate::material::{Dilation, Expansion, ExpansionTable};
use crate::math::vector::{dot, norm};
use crate::mesh::Mesh;
use crate::shape::ElementKind;
use crate::system::{Dofs, Schedule};

/// The body with a dilation in all parts, at 20 in the beginning and then warmer by `rise` of each point.
fn warm(body: Elastic, dilation: Dilation, rise: impl Fn(usize) -> f64) -> Elastic {
    let count = body.mesh().points.len();
    let all = Temperatures {
        start: vec![20.0; count],
        said: true,
        fields: vec![TemperatureField {
            name: "warm".into(),
            entries: (0..count).map(|p| (p, 20.0 + rise(p))).collect(),
            factor: Schedule::always(),
            share: Schedule::always(),
        }],
    };
    let parts = body.parts().iter().map(|part| Part {
        dilation: Some(Arc::new(dilation.clone())),
        ..part.clone()
    });
    Elastic::new(
        "warm",
        body.mesh().clone(),
        body.space(),
        body.formulation(),
        parts.collect(),
    )
    .expect("sound")
    .heated(Arc::new(all))
}

/// Coefficients along axes that suit a free expansion in the space: across a plane that cannot strain there is none, around an axis rings
/// grow as they do along the radius.
fn free(space: Space) -> Dilation {
    let (s, c) = 0.5_f64.sin_cos();
    let turned = Some([[c, s, 0.0], [-s, c, 0.0]]);
    let (along, axes) = match space {
        Space::PlaneStrain { .. } => ([2e-5, 1e-5, 0.0], turned),
        Space::PlaneStress { .. } => ([2e-5, 1e-5, 4e-5], turned),
        Space::Axisymmetric => ([2e-5, 1e-5, 2e-5], None),
        Space::Solid => (
            [2e-5, 1e-5, 3e-5],
            Some([[1.0, 2.0, 3.0], [0.0, 1.0, -1.0]]),
        ),
    };
    let [a, b, c] = along;
    let table = Expansion::Table(ExpansionTable {
        table: vec![vec![0.0, a, b, c]],
        zero: 0.0,
        axes,
    });
    table.dilation(None).expect("sound")
}

/// Displacements with one strain.
fn strained(mesh: &Mesh, e: [f64; 6]) -> Vec<f64> {
    let rows = [
        [e[0], 0.5 * e[3], 0.5 * e[5]],
        [0.5 * e[3], e[1], 0.5 * e[4]],
        [0.5 * e[5], 0.5 * e[4], e[2]],
    ];
    let of = |x: &[f64; 3]| rows.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
    let all = mesh.points.iter();
    all.flat_map(|x| of(x).into_iter().take(mesh.dim)).collect()
}

fn at(u: &[f64]) -> At<'_> {
    At {
        u,
        warm: Warm::AtTime(1.0),
    }
}

#[test]
fn a_body_that_is_free_to_expand_has_no_stress() {
    for (kind, space, formulation) in combinations() {
        let what = format!("{kind:?} {space:?} {formulation:?}");
        let dilation = free(space);
        let strain = dilation.strain(20.0, 80.0);
        let body = warm(patch(kind, space, formulation), dilation, |_| 80.0);
        let u = strained(body.mesh(), strain);
        let stiff = body.parts()[0].stiffness[0][0] * strain[0];
        for point in cells::stress_at_quadrature(&body, at(&u)) {
            let largest = point.stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
            assert!(largest < 1e-12 * stiff, "{what}: {:?}", point.stress);
            assert!((point.thermal[0] - strain[0]).abs() < 1e-15, "{what}");
        }
        cells::each_cell_state(&body, at(&u), &mut |cell| {
            for point in &cell.points {
                assert!(norm(&point.stress) < 1e-12 * stiff, "{what}");
            }
        });
        let mut force = vec![0.0; u.len()];
        recover::internal_force(&body, at(&u), &mut force);
        let mut held = vec![0.0; u.len()];
        recover::internal_force(&body, at(&vec![0.0; u.len()]), &mut held);
        assert!(norm(&force) < 1e-12 * norm(&held), "{what}");
        let energy = recover::strain_energy(&body, at(&vec![0.0; u.len()]));
        assert!(
            recover::strain_energy(&body, at(&u)) < 1e-12 * energy,
            "{what}"
        );
    }
}

#[test]
fn thermal_forces_are_the_derivative_of_the_energy() {
    for (kind, space, formulation) in combinations() {
        let what = format!("{kind:?} {space:?} {formulation:?}");
        let body = warm(patch(kind, space, formulation), free(space), |p| {
            30.0 * (1.7 * p as f64).sin()
        });
        let u: Vec<f64> = noise(body.mesh().points.len() * space.dim());
        let u: Vec<f64> = u.iter().map(|u| 1e-4 * u).collect();
        let rest = vec![0.0; u.len()];
        let (mut pressed, mut ku, mut all) = (rest.clone(), rest.clone(), rest.clone());
        recover::internal_force(&body, at(&rest), &mut pressed);
        matrix(&body).mul(&u, &mut ku);
        recover::internal_force(&body, at(&u), &mut all);
        let size = norm(&ku);
        for ((all, ku), pressed) in all.iter().zip(&ku).zip(&pressed) {
            assert!((all - ku - pressed).abs() < 1e-11 * size, "{what}");
        }
        let energy =
            recover::strain_energy(&body, at(&rest)) + dot(&u, &pressed) + 0.5 * dot(&u, &ku);
        let found = recover::strain_energy(&body, at(&u));
        assert!(
            (found - energy).abs() < 1e-11 * found,
            "{what}: {found} {energy}"
        );
        // On a whole body they have no resultant.
        let dim = space.dim();
        let first = if space == Space::Axisymmetric { 1 } else { 0 };
        for i in first..dim {
            let sum: f64 = pressed.iter().skip(i).step_by(dim).sum();
            assert!(sum.abs() < 1e-12 * norm(&pressed), "{what}: {sum}");
        }
    }
}

#[test]
fn a_bar_that_is_held_is_pressed_by_what_it_would_expand() {
    let (young, alpha, rise) = (200e9, 12e-6, 50.0);
    let body = body(
        grid(ElementKind::Hex8, [2, 1, 1], &|x| x),
        Space::Solid,
        Formulation::Standard,
        isotropic(young, 0.3),
    );
    let dilation = Expansion::Number(alpha).dilation(None).expect("sound");
    let body = warm(body, dilation, |_| rise);
    // Held along x, free across.
    let across = 1.3 * alpha * rise;
    let u = strained(body.mesh(), [0.0, across, across, 0.0, 0.0, 0.0]);
    for point in cells::stress_at_quadrature(&body, at(&u)) {
        assert!((point.stress[0] / (-young * alpha * rise) - 1.0).abs() < 1e-12);
        assert!(point.stress[1].abs() < 1e-10 * young * alpha * rise);
    }
}

#[test]
fn what_is_written_of_a_warm_body_is_its_temperature_and_strain() {
    let body = patch(
        ElementKind::Quad8,
        Space::PlaneStrain { thickness: 1.0 },
        Formulation::Standard,
    );
    let body = warm(body, free(body_space()), |p| p as f64);
    let state = crate::system::State {
        t: 1.0,
        u: vec![0.0; 2 * body.mesh().points.len()],
        ..Default::default()
    };
    let mut fields = crate::system::Fields::default();
    fields::fields(&body, &state, &mut fields);
    let nt = fields.get("NT").expect("temperatures");
    assert_eq!(nt.values[3], 23.0);
    let the = fields.get("THE").expect("thermal strains");
    let mean = the.values.iter().step_by(6).sum::<f64>();
    assert!(mean > 0.0 && the.components == 6);
    // Cells around a point have the stress of the whole body, warm as well.
    let dofs = Dofs {
        dim: 2,
        points: body.mesh().points.len(),
    };
    let u = noise(dofs.count());
    let around = around::around(&body, 5)
        .expect("a point")
        .stress(dofs, at(&u));
    let place = body.points().iter().position(|&p| p == 5).expect("there");
    assert_eq!(around, fields::nodal_stress(&body, at(&u))[place]);
}

fn body_space() -> Space {
    Space::PlaneStrain { thickness: 1.0 }
}

/// Cells that are softer one after the other.
fn graded(kind: ElementKind, space: Space, formulation: Formulation) -> Elastic {
    let mesh = grid(kind, [3, 2, 2], &distort);
    let count = mesh.blocks[0].cell_ids.len();
    let soft = |cell: usize| isotropic(1.0 / (1.0 + (cell % 4) as f64), 0.3);
    let part = Part {
        block: 0,
        stiffness: soft(0),
        cells: Some(Arc::new((0..count).map(soft).collect())),
        ..Part::default()
    };
    Elastic::new("graded", Arc::new(mesh), space, formulation, vec![part]).expect("sound")
}

#[test]
fn cells_of_different_stiffness_add_up_with_and_without_a_matrix() {
    for (kind, space, formulation) in combinations() {
        let what = format!("{kind:?} {space:?} {formulation:?}");
        let body = graded(kind, space, formulation);
        let dofs = Dofs {
            dim: space.dim(),
            points: body.mesh().points.len(),
        };
        let u = noise(dofs.count());
        let (mut ku, mut by_stress) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        matrix(&body).mul(&u, &mut ku);
        recover::internal_force(&body, &u, &mut by_stress);
        let mut alone = vec![0.0; u.len()];
        InternalForce::new(&[&body], dofs).apply(&u, &mut alone);
        let one = super::testing::body(
            Mesh::clone(body.mesh()),
            space,
            formulation,
            body.parts()[0].stiffness,
        );
        let mut stiff = vec![0.0; u.len()];
        matrix(&one).mul(&u, &mut stiff);
        let off = |a: &[f64], b: &[f64]| {
            let left: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            norm(&left) / norm(b)
        };
        assert!(off(&by_stress, &ku) < 1e-12, "{what}");
        assert!(off(&alone, &ku) < 1e-12, "{what}");
        assert!(off(&stiff, &ku) > 0.1, "{what}");
    }
}
