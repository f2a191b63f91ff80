use super::super::testing::*;
use super::super::{Space, positive_areas, tributary_areas};
use super::*;
use crate::mesh::{CellRef, FacetRef, Mesh};
use crate::registry::Family;
use crate::shape::ElementKind;
use crate::system::{Course, Links, Piece, Schedule};

fn forces(model: &dyn LoadModel, target: &Target, domain: &Domain) -> Vec<(usize, f64)> {
    match model.action(target, domain).expect("sound") {
        Action::Forces(f) => f,
        Action::Springs(_) => panic!("a spring"),
    }
}

/// The sum of the forces by component.
fn total(forces: &[(usize, f64)], dim: usize) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for &(dof, f) in forces {
        sum[dof % dim] += f;
    }
    sum
}

/// Unit square or cube with its lower left corner at x = 1, and its space.
fn cases() -> Vec<(Mesh, Space)> {
    let mut all = Vec::new();
    for kind in ElementKind::ALL {
        let spaces: &[Space] = match kind.dim() {
            2 => &[PLANE_STRAIN, Space::Axisymmetric],
            3 => &[Space::Solid],
            _ => &[],
        };
        for &space in spaces {
            all.push((grid(kind, [2, 3, 2], &|x| [1.0 + x[0], x[1], x[2]]), space));
        }
    }
    all
}

fn side(mesh: &Mesh, x: f64) -> Vec<FacetRef> {
    let at = |&p: &usize| (mesh.points[p][0] - x).abs() < 1e-9;
    mesh.boundary()
        .into_iter()
        .filter(|&f| mesh.facet_points(f).1.iter().all(at))
        .collect()
}

fn no_links() -> Links {
    let dofs = crate::system::Dofs { dim: 3, points: 0 };
    Links::new(dofs, Vec::new())
}

fn close(a: f64, b: f64, scale: f64) {
    assert!((a - b).abs() < 1e-12 * scale, "{a} {b}");
}

#[test]
fn consistent_loads_sum_to_the_total_force() {
    for (mesh, space) in cases() {
        let dim = mesh.dim;
        let domain = Domain {
            masses: &[],
            links: &no_links(),
            mesh: &mesh,
            space,
            densities: &[3.0],
        };
        // Area of the face x = 2 and volume.
        let (area, volume) = match space {
            Space::Axisymmetric => (std::f64::consts::TAU * 2.0, std::f64::consts::PI * 3.0),
            Space::Solid => (1.0, 1.0),
            _ => (0.5, 0.5),
        };
        let value = vec![5.0, -7.0, 2.0][..dim].to_vec();
        let right = side(&mesh, 2.0);
        let t = total(
            &forces(
                &Traction {
                    value: value.clone(),
                },
                &Target::Facets(&right),
                &domain,
            ),
            dim,
        );
        let p = total(
            &forces(&Pressure { value: 4.0 }, &Target::Facets(&right), &domain),
            dim,
        );
        let cells: Vec<CellRef> = mesh.cells().collect();
        let b = total(
            &forces(
                &BodyForce {
                    value: value.clone(),
                },
                &Target::Cells(&cells),
                &domain,
            ),
            dim,
        );
        let gravity = Gravity {
            acceleration: value.clone(),
        };
        let g = total(&forces(&gravity, &Target::Cells(&cells), &domain), dim);
        for i in 0..dim {
            close(t[i], area * value[i], 100.0);
            close(p[i], if i == 0 { -4.0 * area } else { 0.0 }, 100.0);
            close(b[i], volume * value[i], 100.0);
            close(g[i], 3.0 * volume * value[i], 100.0);
        }
        let points = [0, 2];
        let n = total(
            &forces(
                &NodalForce {
                    value: value.clone(),
                },
                &Target::Points(&points),
                &domain,
            ),
            dim,
        );
        close(n[1], -14.0, 10.0);

        let sum = |weights: Vec<(usize, f64)>| weights.iter().map(|w| w.1).sum::<f64>();
        close(sum(tributary_areas(&mesh, &right, space)), area, 10.0);
        let positive = positive_areas(&mesh, &right, space);
        assert!(positive.iter().all(|w| w.1 > 0.0));
        close(sum(positive), area, 10.0);
    }
}

#[test]
fn body_force_around_an_axis_is_weighted_by_the_radius() {
    // ∫ r f_z dV by the nodal forces' moment: shape functions make up r exactly, quadratic ones r² as well.
    for (mesh, space) in cases().into_iter().filter(|c| c.1 == Space::Axisymmetric) {
        let domain = Domain {
            masses: &[],
            links: &no_links(),
            mesh: &mesh,
            space,
            densities: &[1.0],
        };
        let cells: Vec<CellRef> = mesh.cells().collect();
        let model = BodyForce {
            value: vec![0.0, 1.0],
        };
        let forces = forces(&model, &Target::Cells(&cells), &domain);
        for power in 1..=mesh.blocks[0].kind.order() as i32 {
            let parts = forces.iter();
            let moment = parts.map(|&(dof, f)| f * mesh.points[dof / 2][0].powi(power));
            let n = power + 2;
            let exact = std::f64::consts::TAU * (2f64.powi(n) - 1.0) / f64::from(n);
            close(moment.sum(), exact, 10.0);
        }
    }
}

#[test]
fn pressure_all_around_is_in_balance() {
    for kind in ElementKind::ALL.into_iter().filter(|k| k.dim() >= 2) {
        let mesh = grid(kind, [2, 2, 2], &distort);
        let space = if kind.dim() == 3 {
            Space::Solid
        } else {
            PLANE_STRAIN
        };
        let domain = Domain {
            masses: &[],
            links: &no_links(),
            mesh: &mesh,
            space,
            densities: &[],
        };
        let all = mesh.boundary();
        let f = forces(&Pressure { value: 1.0 }, &Target::Facets(&all), &domain);
        for sum in total(&f, mesh.dim) {
            assert!(sum.abs() < 1e-13, "{}", kind.name());
        }
    }
}

#[test]
fn wrong_vectors_and_sets_are_refused() {
    let mesh = grid(ElementKind::Quad4, [1, 1, 0], &|x| x);
    let domain = Domain {
        masses: &[],
        links: &no_links(),
        mesh: &mesh,
        space: PLANE_STRAIN,
        densities: &[0.0],
    };
    let facets = mesh.boundary();
    let cells: Vec<CellRef> = mesh.cells().collect();
    let long = Traction {
        value: vec![1.0; 3],
    };
    let e = long
        .action(&Target::Facets(&facets), &domain)
        .expect_err("3 components");
    assert_eq!(e.key, "value");
    let nan = Pressure { value: f64::NAN };
    assert_eq!(
        nan.action(&Target::Facets(&facets), &domain)
            .expect_err("NaN")
            .key,
        "value"
    );
    let soft = GroundSpring {
        stiffness: vec![1.0, -1.0],
    };
    let e = soft
        .action(&Target::Points(&[0]), &domain)
        .expect_err("negative");
    assert_eq!(e.key, "stiffness");
    let light = Gravity {
        acceleration: vec![0.0, -9.81],
    };
    let e = light
        .action(&Target::Cells(&cells), &domain)
        .expect_err("no density");
    assert!(e.help.expect("given").contains("density"));
    // Every kind refuses a target of another kind.
    for sample in LoadKind::samples() {
        let model = sample.as_dyn();
        let wrong = match model.region() {
            Region::Facets => Target::Points(&[0]),
            _ => Target::Facets(&facets),
        };
        assert!(
            model
                .action(&wrong, &domain)
                .expect_err("wrong set")
                .message
                .contains("set of")
        );
    }
}

#[test]
fn loads_follow_their_schedule_and_springs_store_energy() {
    let load = Load {
        name: "push".into(),
        entries: vec![(1, 4.0)],
        schedule: Schedule {
            pieces: vec![Piece {
                start: 0.0,
                end: 2.0,
                course: Course::Ramp(0.0, 1.0),
            }],
        },
        follows: false,
        pressing: None,
    };
    let mut out = vec![1.0; 2];
    load.external(0.5, &mut out);
    assert_eq!(out, [1.0, 2.0]);

    let spring = Spring::new(vec![(0, 3.0), (3, 2.0)]);
    let mut f = vec![0.0; 4];
    spring.internal_force(&[2.0, 5.0, 7.0, -1.0], &mut f);
    assert_eq!(f, [6.0, 0.0, 0.0, -2.0]);
}
