use std::sync::Arc;

use super::facets::visit_facet;
use super::testing::*;
use super::*;
use crate::body::{cells, fields, recover};
use crate::math::symmetric_eigen;
use crate::mesh::Mesh;
use crate::shape::ElementKind;
use crate::system::{Dofs, Fields, State};

/// A displacement field of constant strain, and that strain.
fn linear_field(mesh: &Mesh, space: Space) -> (Vec<f64>, [f64; 6]) {
    let a = match space {
        // Equal radial and hoop strain is the only state of constant stress that is in equilibrium.
        Space::Axisymmetric => [[2e-3, 0.0, 0.0], [0.0, -1e-3, 0.0], [0.0; 3]],
        _ => [
            [1e-3, 4e-4, -3e-4],
            [-2e-4, -5e-4, 7e-4],
            [6e-4, 1e-4, 8e-4],
        ],
    };
    let dim = mesh.dim;
    let mut u = Vec::new();
    for p in &mesh.points {
        for row in a.iter().take(dim) {
            u.push(row.iter().zip(p).map(|(a, x)| a * x).sum());
        }
    }
    let mut strain = [0.0; 6];
    for i in 0..dim {
        for k in 0..dim {
            strain[crate::material::VOIGT[i][k]] += a[i][k];
        }
    }
    if space == Space::Axisymmetric {
        strain[2] = a[0][0];
    }
    (u, strain)
}

/// A material in which a constant radial and hoop strain makes equal stresses: isotropic about the axis.
fn patch_for(kind: ElementKind, space: Space, formulation: Formulation) -> Elastic {
    match space {
        Space::Axisymmetric => body(
            grid(kind, [3, 3, 2], &distort),
            space,
            formulation,
            isotropic(70e9, 0.3),
        ),
        _ => patch(kind, space, formulation),
    }
}

#[test]
fn patches_have_constant_stress_and_balance_their_tractions() {
    for (kind, space, formulation) in combinations() {
        let body = patch_for(kind, space, formulation);
        let mesh = body.mesh().clone();
        let (u, strain) = linear_field(&mesh, space);
        let c = if space == PLANE_STRESS {
            crate::material::plane_stress(&body.parts()[0].stiffness)
        } else {
            body.parts()[0].stiffness
        };
        let stress: [f64; 6] = std::array::from_fn(|i| (0..6).map(|j| c[i][j] * strain[j]).sum());
        let size = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        let what = format!("{} {space:?} {formulation:?}", kind.name());
        for point in cells::stress_at_quadrature(&body, &u) {
            for (s, expected) in point.stress.iter().zip(stress) {
                assert!(
                    (s - expected).abs() < 1e-11 * size,
                    "{what}: {s} {expected}"
                );
            }
        }
        // Internal forces minus the tractions σ n of the constant stress: zero at every point, inside and outside.
        let dofs = Dofs {
            dim: mesh.dim,
            points: mesh.points.len(),
        };
        let mut residual = vec![0.0; dofs.count()];
        recover::internal_force(&body, &u, &mut residual);
        let force = residual.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for facet in mesh.boundary() {
            visit_facet(&mesh, space, facet, &mut |q| {
                for (&p, n) in q.points.iter().zip(q.values) {
                    for i in 0..dofs.dim {
                        let t: f64 = (0..dofs.dim)
                            .map(|k| stress[crate::material::VOIGT[i][k]] * q.normal[k])
                            .sum();
                        residual[dofs.of(p, i)] -= n * q.area * t;
                    }
                }
            });
        }
        let worst = residual.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(
            force > 0.0 && worst < 1e-11 * force,
            "{what}: {worst} of {force}"
        );
    }
}

#[test]
fn the_matrix_is_the_derivative_of_the_internal_force_and_symmetric() {
    for (kind, space, formulation) in combinations() {
        let body = patch(kind, space, formulation);
        let m = matrix(&body);
        let u = noise(m.rows());
        let mut by_matrix = vec![0.0; m.rows()];
        m.mul(&u, &mut by_matrix);
        let mut by_stress = vec![0.0; m.rows()];
        recover::internal_force(&body, &u, &mut by_stress);
        let size = by_matrix.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let what = format!("{} {space:?} {formulation:?}", kind.name());
        for (a, b) in by_matrix.iter().zip(&by_stress) {
            assert!((a - b).abs() < 1e-12 * size, "{what}: {a} {b}");
        }
        let work: f64 = by_matrix.iter().zip(&u).map(|(f, u)| 0.5 * f * u).sum();
        assert!(
            (work - recover::strain_energy(&body, &u)).abs() < 1e-12 * work,
            "{what}"
        );
        body.element_matrices(&mut |points, dense| {
            let width = points.len() * m.block_size();
            for i in 0..width {
                for j in 0..i {
                    assert_eq!(dense[i * width + j], dense[j * width + i]);
                }
            }
        });
    }
}

/// Ascending eigenvalues of the assembled matrix.
fn spectrum(body: &Elastic) -> Vec<f64> {
    let m = matrix(body);
    let rows: Vec<Vec<f64>> = (0..m.rows())
        .map(|i| (0..m.rows()).map(|j| m.entry(i, j)).collect())
        .collect();
    symmetric_eigen(&rows).0
}

#[test]
fn rigid_motions_cost_nothing_and_nothing_else_does() {
    for (kind, space, formulation) in combinations() {
        // Cells that have other motions without energy alone are tested in company, see `Formulation`.
        let alone = motions_alone(kind, formulation) == Some(0);
        for n in [[1, 1, 1], [2, 1, 1]] {
            if n[0] == 1 && !alone {
                continue;
            }
            let body = body(grid(kind, n, &distort), space, formulation, anisotropic());
            let what = format!("{} {space:?} {formulation:?}", kind.name());
            let modes = rigid_modes(body.mesh(), body.points(), space);
            let scale = 1e11 * recover::volume(&body);
            for mode in &modes {
                assert!(
                    recover::strain_energy(&body, &mode.vector) < 1e-24 * scale,
                    "{what} {}",
                    mode.name
                );
            }
            let values = spectrum(&body);
            let largest = values[values.len() - 1];
            let zeros = values.iter().filter(|v| v.abs() < 1e-9 * largest).count();
            assert_eq!(zeros, modes.len(), "{what}: {values:?}");
            assert!(values[0] > -1e-12 * largest, "{what}");
        }
    }
}

/// Motions without energy besides the rigid ones that a single cell is documented to have, see `Formulation`; `None` where their
/// number is not stated.
fn motions_alone(kind: ElementKind, formulation: Formulation) -> Option<usize> {
    use ElementKind::*;
    match (formulation, kind) {
        (Formulation::MeanDilatation, _) if kind.order() == 2 => None,
        (Formulation::Reduced, Hex20) => Some(6),
        (Formulation::Reduced, Quad8) => Some(1),
        (Formulation::Reduced, Wedge6) => Some(1),
        _ => Some(0),
    }
}

#[test]
fn one_cell_has_the_modes_without_energy_that_are_documented() {
    for (kind, space, formulation) in combinations() {
        let Some(beside) = motions_alone(kind, formulation) else {
            continue;
        };
        let mut mesh = grid(kind, [1, 1, 1], &distort);
        // Simplices come several to the cube: keep the first.
        mesh.blocks[0].connectivity.truncate(kind.node_count());
        let body = body(mesh, space, formulation, anisotropic());
        body.element_matrices(&mut |points, dense| {
            let width = points.len() * body.mesh().dim;
            let rows: Vec<Vec<f64>> = dense.chunks(width).map(<[f64]>::to_vec).collect();
            let values = symmetric_eigen(&rows).0;
            let zeros = values
                .iter()
                .filter(|v| v.abs() < 1e-9 * values[width - 1])
                .count();
            let modes = rigid_modes(body.mesh(), body.points(), space);
            assert_eq!(
                zeros,
                modes.len() + beside,
                "{} {space:?} {formulation:?}",
                kind.name()
            );
        });
    }
}

/// Radii and pressure of a thick cylinder in plane strain along its axis.
const INNER: f64 = 1.0;
const OUTER: f64 = 2.0;
const PRESSURE: f64 = 1e6;

/// Lamé's radial displacement of the cylinder under inner pressure ([`johnson_1985`](stickslip_base::references::johnson_1985)
/// gives the stresses; any textbook the rest).
fn lame(r: f64, young: f64, nu: f64) -> f64 {
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    PRESSURE * a2 * (1.0 + nu) / (young * (b2 - a2)) * ((1.0 - 2.0 * nu) * r + b2 / r)
}

/// The cylinder as an axisymmetric strip of `n` cells: the largest error of the radial displacement relative to that
/// of the inner face, and the body with its solution.
fn cylinder(
    kind: ElementKind,
    n: usize,
    nu: f64,
    formulation: Formulation,
) -> (f64, Elastic, Vec<f64>) {
    let young = 210e9;
    let height = (OUTER - INNER) / n as f64;
    let mesh = grid(kind, [n, 1, 0], &|x| {
        [INNER + (OUTER - INNER) * x[0], height * x[1], 0.0]
    });
    let body = body(mesh, Space::Axisymmetric, formulation, isotropic(young, nu));
    let mesh = body.mesh().clone();
    let inner = mesh
        .boundary()
        .into_iter()
        .filter(|&f| {
            mesh.facet_points(f)
                .1
                .iter()
                .all(|&p| mesh.points[p][0] < INNER + 1e-9)
        })
        .collect::<Vec<_>>();
    assert_eq!(inner.len(), 1);
    let mut f = vec![0.0; 2 * mesh.points.len()];
    for (p, area) in tributary_areas(&mesh, &inner, Space::Axisymmetric) {
        f[2 * p] = PRESSURE * area;
    }
    let fixed: Vec<usize> = (0..mesh.points.len()).map(|p| 2 * p + 1).collect();
    let u = solve(&body, &fixed, &f);
    let worst = mesh
        .points
        .iter()
        .enumerate()
        .map(|(p, x)| (u[2 * p] - lame(x[0], young, nu)).abs())
        .fold(0.0_f64, f64::max);
    (worst / lame(INNER, young, nu), body, u)
}

#[test]
fn thick_cylinder_converges_to_lame() {
    use ElementKind::*;
    // Interpolating `1/r` with cells of size h errs by up to max|u''| h²/8 (linear) or max|u'''| h³/(72√3)
    // (quadratic): relative to u(a), 3.6e-3 and 8.5e-5 for h = 1/8. The solution must be within twice that.
    let cases = [
        (Tri3, 3.6, 7.2e-3),
        (Quad4, 3.6, 7.2e-3),
        (Tri6, 7.0, 1.7e-4),
        (Quad8, 7.0, 1.7e-4),
    ];
    for (kind, factor, bound) in cases {
        let coarse = cylinder(kind, 8, 0.3, Formulation::Standard).0;
        let fine = cylinder(kind, 16, 0.3, Formulation::Standard).0;
        assert!(coarse < bound, "{}: {coarse}", kind.name());
        assert!(coarse > factor * fine, "{}: {coarse} {fine}", kind.name());
    }
}

#[test]
fn thick_cylinder_has_the_stresses_of_lame() {
    let (_, body, u) = cylinder(ElementKind::Quad8, 16, 0.3, Formulation::Standard);
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    let base = PRESSURE * a2 / (b2 - a2);
    for q in cells::stress_at_quadrature(&body, &u) {
        let r2 = q.x[0] * q.x[0];
        let expected = [base * (1.0 - b2 / r2), 0.6 * base, base * (1.0 + b2 / r2)];
        for (s, e) in q.stress.iter().zip(expected) {
            assert!((s - e).abs() < 5e-3 * PRESSURE, "{s} {e} at {}", q.x[0]);
        }
    }
}

#[test]
fn mean_dilatation_does_not_lock() {
    let (locked, _, _) = cylinder(ElementKind::Quad4, 8, 0.49999, Formulation::Standard);
    let (free, _, _) = cylinder(ElementKind::Quad4, 8, 0.49999, Formulation::MeanDilatation);
    assert!(free < 5e-3, "{free}");
    assert!(locked > 0.5, "{locked}");
}

#[test]
fn a_confined_block_of_hexahedra_does_not_lock() {
    // A bar of hexahedra, nearly incompressible, bent by a force at its end: the mean-dilatation result is that of a
    // slightly compressible bar within a few per cent, the standard one far stiffer.
    let tip = |nu: f64, formulation: Formulation| {
        let mesh = grid(ElementKind::Hex8, [8, 2, 2], &|x| [4.0 * x[0], x[1], x[2]]);
        let body = body(mesh, Space::Solid, formulation, isotropic(1.0, nu));
        let points = &body.mesh().points;
        let fixed: Vec<usize> = (0..points.len())
            .filter(|&p| points[p][0] == 0.0)
            .flat_map(|p| [3 * p, 3 * p + 1, 3 * p + 2])
            .collect();
        let end: Vec<usize> = (0..points.len()).filter(|&p| points[p][0] == 4.0).collect();
        let mut f = vec![0.0; 3 * points.len()];
        for &p in &end {
            f[3 * p + 2] = 1e-3 / end.len() as f64;
        }
        let u = solve(&body, &fixed, &f);
        u[3 * end[0] + 2]
    };
    let reference = tip(0.3, Formulation::Standard);
    let standard = tip(0.4999, Formulation::Standard);
    let mean = tip(0.4999, Formulation::MeanDilatation);
    assert!(standard < 0.75 * reference, "{standard} {reference}");
    assert!(
        mean > 0.95 * reference && mean < 1.2 * reference,
        "{mean} {reference}"
    );
}

#[test]
fn fields_of_a_uniform_state() {
    for (kind, space, formulation) in combinations() {
        let body = patch_for(kind, space, formulation);
        let (u, _) = linear_field(body.mesh(), space);
        let stress = cells::stress_at_quadrature(&body, &u)[0].stress;
        let mut fields = Fields::default();
        let state = State {
            u: u.clone(),
            ..State::default()
        };
        fields::fields(&body, &state, &mut fields);
        let s = fields.get("S").expect("added");
        assert_eq!(s.values.len(), 6 * body.mesh().points.len());
        let size = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        for six in s.values.chunks(6) {
            for (a, b) in six.iter().zip(stress) {
                assert!((a - b).abs() < 1e-10 * size, "{} {a} {b}", kind.name());
            }
        }
        let total: f64 = fields.get("ELSE").expect("added").values.iter().sum();
        let energy = recover::strain_energy(&body, &u);
        assert!((total - energy).abs() < 1e-12 * energy);
        let density = &fields.get("SENER").expect("added").values;
        let uniform = energy / recover::volume(&body);
        assert!(
            density
                .iter()
                .all(|d| (d - uniform).abs() < 1e-10 * uniform)
        );
        if space == PLANE_STRESS {
            assert!(
                s.values
                    .chunks(6)
                    .all(|s| s[2] == 0.0 && s[4] == 0.0 && s[5] == 0.0)
            );
        }
    }
}

#[test]
fn von_mises_of_uniaxial_and_shear_stress() {
    let body = body(
        grid(ElementKind::Hex8, [1, 1, 1], &|x| x),
        Space::Solid,
        Formulation::Standard,
        isotropic(1.0, 0.0),
    );
    for (shear, expected) in [(0.0, 2e-3), (2e-3, (4e-6_f64 + 3e-6).sqrt())] {
        let u: Vec<f64> = body
            .mesh()
            .points
            .iter()
            .flat_map(|p| [2e-3 * p[0] + shear * p[1], 0.0, 0.0])
            .collect();
        let mut fields = Fields::default();
        let state = State {
            u,
            ..State::default()
        };
        fields::fields(&body, &state, &mut fields);
        let mises = &fields.get("MISES").expect("added").values;
        assert!(mises.iter().all(|m| (m - expected).abs() < 1e-14));
    }
}

#[test]
fn one_and_four_threads_agree_to_the_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        pool.install(|| {
            let body = body(
                grid(ElementKind::Hex8, [12, 9, 9], &distort),
                Space::Solid,
                Formulation::MeanDilatation,
                isotropic(1.0, 0.45),
            );
            let m = matrix(&body);
            let u = noise(m.rows());
            let mut f = vec![0.0; m.rows()];
            recover::internal_force(&body, &u, &mut f);
            (
                m.diagonal(),
                f,
                recover::strain_energy(&body, &u),
                fields::nodal_stress(&body, &u),
            )
        })
    };
    assert_eq!(run(1), run(4));
}

#[test]
fn bad_bodies_say_what_is_wrong() {
    let make = |mesh: Mesh, space, formulation| {
        let parts = vec![Part {
            block: 0,
            stiffness: isotropic(1.0, 0.3),
            density: 0.0,
            ..Part::default()
        }];
        Elastic::new("lug", Arc::new(mesh), space, formulation, parts).expect_err("bad")
    };
    let square = || grid(ElementKind::Quad4, [2, 2, 0], &|x| x);
    let e = make(square(), PLANE_STRESS, Formulation::MeanDilatation);
    assert_eq!(e.key, "formulation");
    let e = make(square(), Space::Solid, Formulation::Standard);
    assert_eq!(e.key, "space");
    let e = make(
        square(),
        Space::PlaneStrain { thickness: 0.0 },
        Formulation::Standard,
    );
    assert_eq!(e.key, "thickness");
    let left = grid(ElementKind::Quad4, [2, 2, 0], &|x| [x[0] - 0.5, x[1], 0.0]);
    let e = make(left, Space::Axisymmetric, Formulation::Standard);
    assert!(
        e.message.contains("point 1 has the negative radius -0.5"),
        "{}",
        e.message
    );
    let mut inverted = square();
    inverted.blocks[0].connectivity.swap(8, 10);
    let e = make(inverted, PLANE_STRAIN, Formulation::Standard);
    assert!(
        e.message.contains("cell 3 (quad4) is inverted"),
        "{}",
        e.message
    );
    let mut parts = vec![];
    for block in [0, 0] {
        parts.push(Part {
            block,
            stiffness: isotropic(1.0, 0.3),
            density: 0.0,
            ..Part::default()
        });
    }
    let twice = Elastic::new(
        "lug",
        Arc::new(square()),
        PLANE_STRAIN,
        Formulation::Standard,
        parts,
    );
    assert!(twice.expect_err("twice").message.contains("twice"));
}

#[test]
fn points_on_the_axis_are_allowed() {
    let mesh = grid(ElementKind::Tri3, [2, 2, 0], &|x| x);
    let body = body(
        mesh,
        Space::Axisymmetric,
        Formulation::Standard,
        isotropic(1.0, 0.3),
    );
    assert!((recover::volume(&body) - std::f64::consts::PI).abs() < 1e-12);
    let (u, strain) = linear_field(body.mesh(), Space::Axisymmetric);
    for q in cells::stress_at_quadrature(&body, &u) {
        for (a, b) in q.strain.iter().zip(strain) {
            assert!((a - b).abs() < 1e-15);
        }
    }
}

#[test]
fn plane_strain_reports_the_stress_across_the_plane() {
    let mesh = grid(ElementKind::Quad4, [1, 1, 0], &|x| x);
    let body = body(
        mesh,
        PLANE_STRAIN,
        Formulation::Standard,
        isotropic(1.0, 0.25),
    );
    let (u, _) = linear_field(body.mesh(), PLANE_STRAIN);
    let s = cells::stress_at_quadrature(&body, &u)[0].stress;
    assert!((s[2] - 0.25 * (s[0] + s[1])).abs() < 1e-18 && s[2] != 0.0);
    assert_eq!(
        body.constrained_modulus(0),
        Some(body.parts()[0].stiffness[0][0])
    );
    assert_eq!(body.constrained_modulus(1), None);
}
