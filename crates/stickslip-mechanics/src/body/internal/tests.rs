use super::super::testing::*;
use super::super::{Formulation, Part, Space};
use super::*;
use crate::body::recover;
use crate::math::{Vec3, symmetric_eigen};
use crate::mesh::{Block, Mesh};
use crate::shape::ElementKind;

fn dofs_of(body: &Elastic) -> Dofs {
    Dofs {
        dim: body.mesh.dim,
        points: body.mesh.points.len(),
    }
}

fn force_of(body: &Elastic, u: &[f64]) -> Vec<f64> {
    let mut internal = InternalForce::new(&[body], dofs_of(body));
    // What was there before must not matter.
    let mut f = vec![f64::NAN; u.len()];
    internal.apply(u, &mut f);
    let once = f.clone();
    internal.apply(u, &mut f);
    assert_eq!(once, f);
    f
}

fn assert_close(f: &[f64], expected: &[f64], what: &str) {
    let size = expected.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    assert!(size > 0.0, "{what}");
    for (i, (a, b)) in f.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < 1e-12 * size, "{what}: dof {i}: {a} for {b}");
    }
}

fn check_against_matrix(body: &Elastic, what: &str) {
    let m = matrix(body);
    let u = noise(m.rows());
    let mut expected = vec![0.0; m.rows()];
    m.mul(&u, &mut expected);
    assert_close(&force_of(body, &u), &expected, what);
}

/// Slanted, so that faces are parallel but not at right angles.
fn shear(x: Vec3) -> Vec3 {
    [
        1.0 + 1.2 * x[0] + 0.4 * x[1] - 0.2 * x[2],
        0.1 * x[0] + 0.9 * x[1] + 0.3 * x[2],
        0.2 * x[1] + 0.8 * x[2],
    ]
}

#[test]
fn the_force_is_that_of_the_matrix_for_every_cell_space_and_formulation() {
    for (kind, space, formulation) in combinations() {
        for (name, map) in [
            ("distorted", distort as fn(Vec3) -> Vec3),
            ("sheared", shear),
        ] {
            for stiffness in [anisotropic(), isotropic(70e9, 0.3), isotropic(1.0, 0.499)] {
                let flat = |x: Vec3| {
                    if kind.dim() == 2 {
                        [map(x)[0], map(x)[1], 0.0]
                    } else {
                        map(x)
                    }
                };
                let mesh = grid(kind, [3, 3, 3], &flat);
                let what = format!("{} {space:?} {formulation:?} {name}", kind.name());
                check_against_matrix(&body(mesh, space, formulation, stiffness), &what);
            }
        }
    }
}

#[test]
fn hexahedra_with_parallel_faces_are_told_from_others() {
    let count = |mesh: Mesh| {
        let body = body(
            mesh,
            Space::Solid,
            Formulation::Standard,
            isotropic(1.0, 0.3),
        );
        let by_kernel = kernels::of_part(&body, 0);
        [by_kernel[0].1.len(), by_kernel[1].1.len()]
    };
    let mut mesh = grid(ElementKind::Hex8, [3, 3, 3], &shear);
    assert_eq!(count(mesh.clone()), [27, 0]);
    // Point (1, 1, 1) of the grid belongs to eight cells.
    mesh.points[21][1] += 1e-12;
    assert_eq!(count(mesh.clone()), [19, 8]);
    assert_eq!(count(grid(ElementKind::Hex8, [3, 3, 3], &distort)), [0, 27]);
}

/// Half a grid bent and half straight, of two materials.
fn mixed(formulation: Formulation) -> Elastic {
    let bend = |x: Vec3| {
        let by = (x[0] - 0.5).max(0.0);
        [x[0], x[1] + by * by * x[2], x[2] + 0.3 * by * x[1] * x[0]]
    };
    let mut mesh = grid(ElementKind::Hex8, [6, 5, 4], &bend);
    let all = std::mem::take(&mut mesh.blocks[0].connectivity);
    let (first, second) = all.split_at(8 * 45);
    mesh.blocks = [first, second]
        .map(|nodes| Block {
            kind: ElementKind::Hex8,
            connectivity: nodes.to_vec(),
            cell_ids: (1..=nodes.len() as u64 / 8).collect(),
        })
        .to_vec();
    let parts = [
        isotropic(3.0, 0.2),
        anisotropic().map(|r| r.map(|c| 1e-9 * c)),
    ]
    .into_iter()
    .enumerate()
    .map(|(block, stiffness)| Part {
        block,
        stiffness,
        density: 1.0,
        ..Part::default()
    })
    .collect();
    Elastic::new("mixed", mesh.into(), Space::Solid, formulation, parts).expect("sound")
}

#[test]
fn parts_of_different_material_and_shape_add_up() {
    for formulation in [Formulation::Standard, Formulation::MeanDilatation] {
        let body = mixed(formulation);
        assert_eq!(
            InternalForce::new(&[&body], dofs_of(&body)).kernels.len(),
            4
        );
        check_against_matrix(&body, "mixed");
    }
}

#[test]
fn bodies_add_up_and_points_of_none_are_free_of_force() {
    let base = grid(ElementKind::Tet4, [2, 2, 2], &distort);
    let half = base.blocks[0].connectivity.len() / 8 * 4;
    let (first, second) = base.blocks[0].connectivity.split_at(half);
    let mut points = base.points.clone();
    points.push([9.0; 3]);
    let mesh = std::sync::Arc::new(Mesh {
        dim: 3,
        point_ids: (1..=points.len() as u64).collect(),
        points,
        blocks: [first, second]
            .map(|nodes| Block {
                kind: ElementKind::Tet4,
                connectivity: nodes.to_vec(),
                cell_ids: (1..=nodes.len() as u64 / 4).collect(),
            })
            .to_vec(),
        ..Mesh::default()
    });
    let bodies = [(0, isotropic(1.0, 0.3)), (1, isotropic(5.0, 0.1))].map(|(block, stiffness)| {
        let part = Part {
            block,
            stiffness,
            density: 1.0,
            ..Part::default()
        };
        Elastic::new(
            "half",
            mesh.clone(),
            Space::Solid,
            Formulation::Standard,
            vec![part],
        )
        .expect("sound")
    });
    let dofs = dofs_of(&bodies[0]);
    let u = noise(dofs.count());
    let mut expected = vec![0.0; dofs.count()];
    for body in &bodies {
        recover::internal_force(body, &u, &mut expected);
    }
    let mut internal = InternalForce::new(&[&bodies[0], &bodies[1]], dofs);
    assert_eq!(internal.cells(), 48);
    let mut f = vec![f64::NAN; dofs.count()];
    internal.apply(&u, &mut f);
    assert_close(&f, &expected, "two bodies");
    assert_eq!(f[dofs.count() - 3..], [0.0; 3]);

    let mut nothing = InternalForce::new(&[], dofs);
    nothing.apply(&u, &mut f);
    assert_eq!(nothing.cells(), 0);
    assert!(f.iter().all(|&f| f == 0.0));
}

#[test]
fn one_and_three_threads_agree_to_the_bit() {
    for (kind, n, formulation) in [
        (ElementKind::Hex8, [14, 13, 12], Formulation::MeanDilatation),
        (ElementKind::Tet4, [9, 9, 9], Formulation::Standard),
        (ElementKind::Hex20, [12, 10, 9], Formulation::Standard),
        (ElementKind::Quad8, [40, 40, 1], Formulation::Standard),
    ] {
        let space = if kind.dim() == 2 {
            Space::Axisymmetric
        } else {
            Space::Solid
        };
        let body = body(
            grid(kind, n, &distort),
            space,
            formulation,
            isotropic(1.0, 0.3),
        );
        let dofs = dofs_of(&body);
        let u = noise(dofs.count());
        let run = |threads: usize| {
            let mut internal = InternalForce::new(&[&body], dofs);
            assert!(internal.cells() >= CELLS_FOR_THREADS, "{}", kind.name());
            assert!(internal.chunks.chunks.len() > 2);
            let mut f = vec![0.0; u.len()];
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("a pool");
            pool.install(|| internal.apply(&u, &mut f));
            let eigenvalue = pool.install(|| {
                largest_eigenvalue(&mut internal, &vec![1.0; u.len()], &vec![false; u.len()])
            });
            (f, eigenvalue)
        };
        let one = run(1);
        assert_eq!(one, run(3), "{}", kind.name());
        // Chunks meet: their shared points must have the forces of all.
        let mut expected = vec![0.0; u.len()];
        recover::internal_force(&body, &u, &mut expected);
        assert_close(&one.0, &expected, kind.name());
    }
}

#[test]
fn the_order_of_cells_in_the_mesh_changes_rounding_only() {
    let sorted = grid(ElementKind::Hex8, [11, 10, 10], &distort);
    let mut shuffled = sorted.clone();
    let cells = shuffled.blocks[0].cell_ids.len();
    shuffled.blocks[0].connectivity = (0..cells)
        .flat_map(|i| {
            let cell = i * 727 % cells;
            sorted.blocks[0].connectivity[8 * cell..][..8].to_vec()
        })
        .collect();
    let [a, b] = [sorted, shuffled]
        .map(|mesh| body(mesh, Space::Solid, Formulation::Standard, anisotropic()));
    let u = noise(dofs_of(&a).count());
    assert_close(&force_of(&a, &u), &force_of(&b, &u), "shuffled");
}

/// The largest eigenvalue by a dense solver.
fn exact(body: &Elastic, mass: &[f64], fixed: &[bool]) -> f64 {
    let m = matrix(body);
    let free: Vec<usize> = (0..m.rows())
        .filter(|&d| !fixed[d] && mass[d] > 0.0)
        .collect();
    let rows: Vec<Vec<f64>> = free
        .iter()
        .map(|&i| {
            free.iter()
                .map(|&j| m.entry(i, j) / (mass[i] * mass[j]).sqrt())
                .collect()
        })
        .collect();
    *symmetric_eigen(&rows).0.last().expect("free dofs")
}

#[test]
fn the_largest_eigenvalue_is_met_from_above() {
    for kind in [ElementKind::Hex8, ElementKind::Tet4, ElementKind::Quad8] {
        let space = if kind.dim() == 2 {
            PLANE_STRAIN
        } else {
            Space::Solid
        };
        let body = body(
            grid(kind, [3, 2, 2], &distort),
            space,
            Formulation::Standard,
            anisotropic(),
        );
        let mut internal = InternalForce::new(&[&body], dofs_of(&body));
        let count = dofs_of(&body).count();
        let mut mass: Vec<f64> = noise(count).iter().map(|x| 2.0 + x).collect();
        let mut fixed = vec![false; count];
        for (m, f) in [
            (None, None),
            (Some(7), None),
            (None, Some(11)),
            (Some(3), Some(12)),
        ] {
            m.inspect(|&d| mass[d] = 0.0);
            f.inspect(|&d| fixed[d] = true);
            let value = largest_eigenvalue(&mut internal, &mass, &fixed);
            let expected = exact(&body, &mass, &fixed);
            assert!(
                value >= expected * (1.0 - 1e-12) && value < 1.03 * expected,
                "{}: {value} for {expected}",
                kind.name()
            );
        }
    }
}

#[test]
fn few_free_dofs_are_enough_for_an_eigenvalue() {
    let body = patch(ElementKind::Hex8, Space::Solid, Formulation::Standard);
    let mut internal = InternalForce::new(&[&body], dofs_of(&body));
    let count = dofs_of(&body).count();
    let mass = vec![0.5; count];
    let mut fixed = vec![true; count];
    assert_eq!(largest_eigenvalue(&mut internal, &mass, &fixed), 0.0);
    fixed[4] = false;
    let one = largest_eigenvalue(&mut internal, &mass, &fixed);
    let expected = matrix(&body).entry(4, 4) / 0.5;
    assert!((one - expected).abs() < 1e-12 * expected);
    fixed[7] = false;
    fixed[8] = false;
    let three = largest_eigenvalue(&mut internal, &mass, &fixed);
    let expected = exact(&body, &mass, &fixed);
    assert!((three - expected).abs() < 1e-10 * expected);
    assert_eq!(
        largest_eigenvalue(&mut internal, &vec![0.0; count], &fixed),
        0.0
    );
}

#[test]
fn one_stiff_cell_among_many_sets_the_eigenvalue() {
    // A single thin layer: cells a hundred times thinner than the others.
    let squeeze = |x: Vec3| {
        [
            x[0],
            x[1],
            if x[2] > 0.99 {
                0.901
            } else {
                0.9 * x[2] / (11.0 / 12.0)
            },
        ]
    };
    let body = body(
        grid(ElementKind::Hex8, [4, 4, 12], &squeeze),
        Space::Solid,
        Formulation::Standard,
        isotropic(1.0, 0.3),
    );
    let count = dofs_of(&body).count();
    let mut internal = InternalForce::new(&[&body], dofs_of(&body));
    let (mass, fixed) = (vec![1.0; count], vec![false; count]);
    let value = largest_eigenvalue(&mut internal, &mass, &fixed);
    // Bounds of the largest eigenvalue from the matrix: largest diagonal entry, largest sum of a row.
    let m = matrix(&body);
    let largest_entry = m.diagonal().into_iter().fold(0.0, f64::max);
    assert!(value > largest_entry && value < 1.02 * m.norm_inf());
}
