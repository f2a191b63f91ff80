//! The elements of decks: wedges, reduced integration, incompatible modes, and what is printed of a cell.

use crate::support;
use std::f64::consts::TAU;
use std::sync::Arc;
use stickslip::contact::look;
use stickslip_mechanics::body::{cells, recover};
use stickslip_mechanics::mesh::{check, geometry};

use stickslip::body::{CellState, Elastic, Formulation, Part, Space};
use stickslip::linear::{BlockCsr, Factor, Symbolic};
use stickslip::material::{Elasticity, Isotropic};
use stickslip::mesh::generators::{Cuboid, Generate, Rectangle};
use stickslip::mesh::{Block, Mesh};
use stickslip::run::Simulation;
use stickslip::shape::ElementKind;
use stickslip::system::Fields;

const YOUNG: f64 = 200e9;

fn elastic(mesh: Mesh, space: Space, formulation: Formulation, poisson: f64) -> Elastic {
    let material = Isotropic {
        young: YOUNG,
        poisson,
        density: 7800.0,
    };
    let stiffness = material.stiffness().expect("sound");
    let parts = (0..mesh.blocks.len()).map(|block| Part {
        block,
        stiffness,
        density: 7800.0,
        ..Part::default()
    });
    let parts = parts.collect();
    Elastic::new("body", Arc::new(mesh), space, formulation, parts).unwrap_or_else(|e| {
        panic!("{}: {}", e.key, e.message);
    })
}

/// `u = A x` at all points.
fn linear(mesh: &Mesh, a: [[f64; 3]; 3]) -> Vec<f64> {
    let rows = |p: &[f64; 3]| a.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
    let all = mesh.points.iter();
    all.flat_map(|p| rows(p).into_iter().take(mesh.dim))
        .collect()
}

/// A box of hexahedra of which every other is split into two wedges, in different ways, with its inner points displaced.
fn hexahedra_and_wedges() -> Mesh {
    let n = 4;
    let mut mesh = Cuboid::new([0.0; 3], [1.0; 3], [n, n, n])
        .generate()
        .unwrap();
    let mut hexahedra = Vec::new();
    let mut wedges = Vec::new();
    for (c, cell) in mesh.blocks[0].connectivity.chunks(8).enumerate() {
        // Columns along x, y or z, so that no triangle meets a quadrilateral.
        let (i, j) = (c % n, c / n % n);
        match (i, j) {
            (0, 0) | (2, 1) => {
                wedges.extend([0, 1, 2, 4, 5, 6].map(|k| cell[k]));
                wedges.extend([0, 2, 3, 4, 6, 7].map(|k| cell[k]));
            }
            (1, 2) | (3, 3) => {
                wedges.extend([0, 1, 3, 4, 5, 7].map(|k| cell[k]));
                wedges.extend([1, 2, 3, 5, 6, 7].map(|k| cell[k]));
            }
            _ => hexahedra.extend_from_slice(cell),
        }
    }
    let block = |kind: ElementKind, connectivity: Vec<usize>| Block {
        kind,
        cell_ids: (0..(connectivity.len() / kind.node_count()) as u64).collect(),
        connectivity,
    };
    mesh.blocks = vec![
        block(ElementKind::Hex8, hexahedra),
        block(ElementKind::Wedge6, wedges),
    ];
    mesh.facet_sets.clear();
    for (k, p) in mesh.points.iter_mut().enumerate() {
        let inside = p.iter().all(|x| *x > 1e-9 && *x < 1.0 - 1e-9);
        if inside {
            let noise = |a: f64| 0.05 * (a * (k as f64 + 1.3)).sin();
            *p = [p[0] + noise(12.9), p[1] + noise(78.2), p[2] + noise(37.7)];
        }
    }
    check::check(&mesh).unwrap();
    mesh
}

#[test]
fn hexahedra_and_wedges_pass_the_patch_test_together_in_every_formulation() {
    for formulation in [
        Formulation::Standard,
        Formulation::MeanDilatation,
        Formulation::Reduced,
        Formulation::IncompatibleModes,
    ] {
        let body = elastic(hexahedra_and_wedges(), Space::Solid, formulation, 0.3);
        let mesh = body.mesh().clone();
        let gradient = [
            [1e-3, 4e-4, -3e-4],
            [-2e-4, -5e-4, 7e-4],
            [6e-4, 1e-4, 8e-4],
        ];
        let exact = linear(&mesh, gradient);
        // The outside is held at a linear field; inside, nothing is known.
        let held = |p: usize| {
            let x = mesh.points[p];
            x.iter().any(|x| *x < 1e-9 || *x > 1.0 - 1e-9)
        };
        let start: Vec<f64> = (0..exact.len())
            .map(|d| if held(d / 3) { exact[d] } else { 0.0 })
            .collect();
        let free: Vec<bool> = (0..exact.len()).map(|d| !held(d / 3)).collect();
        assert_eq!(free.iter().filter(|f| **f).count(), 81);
        let u = solve(&body, &start, &free, &vec![0.0; exact.len()]);
        for (u, e) in u.iter().zip(&exact) {
            assert!((u - e).abs() < 1e-12, "{formulation:?}: {u} {e}");
        }
        let first = cells::stress_at_quadrature(&body, &u)[0].stress;
        let mut count = 0;
        cells::each_cell_state(&body, &u, &mut |cell| {
            count += 1;
            for point in &cell.points {
                for (a, b) in point.stress.iter().zip(first) {
                    assert!((a - b).abs() < 1e-9 * 2e8, "{formulation:?}: {a} {b}");
                }
            }
        });
        assert_eq!(count, mesh.cell_count());
    }
}

/// `K u = f` on the free dofs, the others as in `start`.
fn solve(body: &Elastic, start: &[f64], free: &[bool], f: &[f64]) -> Vec<f64> {
    let mesh = body.mesh();
    let mut matrix = BlockCsr::from_couplings(mesh.points.len(), mesh.dim, &mut |visit| {
        body.couplings(visit);
    });
    body.stiffness(&mut matrix);
    let fixed: Vec<bool> = free.iter().map(|free| !free).collect();
    let symbolic = Arc::new(Symbolic::analyze(&matrix, &fixed, &[]).expect("small"));
    let factor = Factor::new(&symbolic, &matrix, &[])
        .unwrap_or_else(|e| panic!("{} {e:?}", mesh.blocks[0].kind));
    let mut rest = vec![0.0; start.len()];
    matrix.mul(start, &mut rest);
    for (r, f) in rest.iter_mut().zip(f) {
        *r = f - *r;
    }
    factor.solve(&mut rest);
    start.iter().zip(&rest).map(|(s, r)| s + r).collect()
}

/// Deflection of the end of a slender cantilever (10 long, 1 high) under a force there, relative to that of a beam with shear.
/// Poisson's ratio is zero, so that the clamp is that of a beam. Cells along and across, in the plane or one or two cells wide.
fn cantilever(kind: ElementKind, formulation: Formulation, cells: [usize; 2]) -> f64 {
    let (length, height) = (10.0, 1.0);
    let (mesh, space) = if kind.dim() == 3 {
        // A single row of reduced hex20 has motions without energy.
        let wide = if kind == ElementKind::Hex20 { 2 } else { 1 };
        let cuboid = Cuboid {
            element: kind,
            ..Cuboid::new(
                [0.0, -0.5, 0.0],
                [length, 0.5, height],
                [cells[0], wide, cells[1]],
            )
        };
        (cuboid.generate().unwrap(), Space::Solid)
    } else {
        let rectangle = Rectangle {
            element: kind,
            ..Rectangle::new([0.0, 0.0], [length, height], cells)
        };
        let space = Space::PlaneStress { thickness: 1.0 };
        (rectangle.generate().unwrap(), space)
    };
    let dim = mesh.dim;
    let body = elastic(mesh, space, formulation, 0.0);
    let mesh = body.mesh();
    let free: Vec<bool> = (0..dim * mesh.points.len())
        .map(|d| mesh.points[d / dim][0] > 0.0)
        .collect();
    let force = 1e6;
    let end = &mesh.facet_sets["right"];
    let mut f = vec![0.0; free.len()];
    for (p, area) in stickslip::body::tributary_areas(mesh, end, space) {
        f[dim * p + dim - 1] = force * area;
    }
    let u = solve(&body, &vec![0.0; free.len()], &free, &f);
    let work: f64 = f.iter().zip(&u).map(|(f, u)| f * u).sum();
    // F L³ / 3 E I, I = 1/12, and shear with the factor 5/6 of a rectangle
    let bending = force * length.powi(3) / (3.0 * YOUNG / 12.0);
    let shear = force * length / (5.0 / 6.0 * YOUNG / 2.0);
    work / force / (bending + shear)
}

#[test]
fn slender_beams_of_one_layer_bend_with_incompatible_modes_and_lock_without() {
    for kind in [ElementKind::Hex8, ElementKind::Quad4] {
        let locked = cantilever(kind, Formulation::Standard, [10, 1]);
        assert!(locked < 0.7, "{kind}: {locked}");
        let free = cantilever(kind, Formulation::IncompatibleModes, [10, 1]);
        assert!((free - 1.0).abs() < 0.02, "{kind}: {free}");
    }
}

#[test]
fn reduced_cells_bend_when_there_are_several_across() {
    for kind in [ElementKind::Hex8, ElementKind::Quad4] {
        // Mean strains of n layers have (1 - 1/n²) of the bending stiffness, the rest is hourglass control.
        let reduced = cantilever(kind, Formulation::Reduced, [40, 4]);
        assert!((1.0..1.08).contains(&reduced), "{kind}: {reduced}");
    }
    for kind in [ElementKind::Hex20, ElementKind::Quad8] {
        let reduced = cantilever(kind, Formulation::Reduced, [5, 1]);
        assert!((reduced - 1.0).abs() < 0.01, "{kind}: {reduced}");
    }
}

#[test]
fn quadratic_wedges_bend() {
    let bent = cantilever(ElementKind::Wedge15, Formulation::Standard, [10, 1]);
    assert!((bent - 1.0).abs() < 0.02, "{bent}");
    let stiff = cantilever(ElementKind::Wedge6, Formulation::Standard, [10, 1]);
    assert!(stiff < 0.75, "{stiff}");
    let fine = cantilever(ElementKind::Wedge6, Formulation::Standard, [80, 8]);
    assert!((0.9..1.0).contains(&fine), "{fine}");
}

#[test]
fn reduced_and_incompatible_cells_do_not_lock_where_volume_is_kept() {
    // A thick ring under inner pressure, nearly incompressible: Lamé's displacement of the bore is p a (1 + ν) b² / E (b² - a²).
    let bore = |formulation: Formulation| {
        let mesh = Rectangle::new([1.0, 0.0], [2.0, 0.125], [8, 1])
            .generate()
            .unwrap();
        let body = elastic(mesh, Space::Axisymmetric, formulation, 0.4999);
        let mesh = body.mesh();
        let mut f = vec![0.0; 2 * mesh.points.len()];
        let inside = &mesh.facet_sets["left"];
        for (p, area) in stickslip::body::tributary_areas(mesh, inside, Space::Axisymmetric) {
            f[2 * p] = 1e6 * area;
        }
        let free: Vec<bool> = (0..f.len()).map(|d| d % 2 == 0).collect();
        let u = solve(&body, &vec![0.0; f.len()], &free, &f);
        let at = (0..mesh.points.len()).find(|&p| mesh.points[p][0] == 1.0);
        u[2 * at.unwrap()] / (1e6 * 1.4999 * 4.0 / (YOUNG * 3.0))
    };
    let locked = bore(Formulation::Standard);
    assert!(locked < 0.5, "{locked}");
    for formulation in [Formulation::Reduced, Formulation::IncompatibleModes] {
        let free = bore(formulation);
        assert!((free - 1.0).abs() < 0.02, "{formulation:?}: {free}");
    }
}

#[test]
fn a_flat_ring_of_reduced_cells_resists_being_turned_over() {
    // Its section turns by φ: hoop strain φ (y - ȳ) / r, energy ½ E φ² ∫ (y - ȳ)² / r² dV.
    for layers in [1, 4] {
        let mesh = Rectangle::new([4.0, 0.0], [5.0, 0.5], [4, layers])
            .generate()
            .unwrap();
        let body = elastic(mesh, Space::Axisymmetric, Formulation::Reduced, 0.0);
        let mesh = body.mesh();
        let phi = 1e-3;
        let turn = |p: &[f64; 3]| [phi * (p[1] - 0.25), -phi * (p[0] - 4.5)];
        let u: Vec<f64> = mesh.points.iter().flat_map(turn).collect();
        let exact = 0.5 * YOUNG * phi * phi * TAU * (5.0_f64 / 4.0).ln() * 0.5_f64.powi(3) / 12.0;
        let ratio = recover::strain_energy(&body, &u) / exact;
        assert!((ratio - 1.0).abs() < 0.02, "{layers}: {ratio}");
    }
}

/// The states of all cells.
fn states(body: &Elastic, u: &[f64]) -> Vec<CellState> {
    let mut all = Vec::new();
    cells::each_cell_state(body, u, &mut |state| all.push(state.clone()));
    all
}

#[test]
fn cells_have_the_integration_points_of_calculix_in_its_order() {
    use ElementKind::*;
    use Formulation::*;
    let (g, h) = (1.0 / 3.0_f64.sqrt(), 0.6_f64.sqrt());
    let (third, sixth) = (1.0 / 3.0, 1.0 / 6.0);
    // Local coordinates of the first points, of the last one, and how many they are.
    for (kind, formulation, count, first, second, last) in [
        (Hex8, Standard, 8, [-g, -g, -g], [g, -g, -g], [g, g, g]),
        (
            Hex8,
            MeanDilatation,
            8,
            [-g, -g, -g],
            [g, -g, -g],
            [g, g, g],
        ),
        (
            Hex8,
            IncompatibleModes,
            8,
            [-g, -g, -g],
            [g, -g, -g],
            [g, g, g],
        ),
        (Hex8, Reduced, 1, [0.0; 3], [0.0; 3], [0.0; 3]),
        (Hex20, Standard, 27, [-h, -h, -h], [0.0, -h, -h], [h, h, h]),
        (Hex20, Reduced, 8, [-g, -g, -g], [g, -g, -g], [g, g, g]),
        (Tet4, Standard, 1, [0.25; 3], [0.25; 3], [0.25; 3]),
        (
            Tet10,
            Standard,
            4,
            [0.138_196_601_125; 3],
            [0.585_410_196_625, 0.138_196_601_125, 0.138_196_601_125],
            [0.138_196_601_125, 0.138_196_601_125, 0.585_410_196_625],
        ),
        (
            Wedge6,
            Standard,
            2,
            [third, third, -g],
            [third, third, g],
            [third, third, g],
        ),
        (
            Wedge6,
            Reduced,
            2,
            [third, third, -g],
            [third, third, g],
            [third, third, g],
        ),
        (
            Wedge15,
            Standard,
            9,
            [sixth, sixth, -h],
            [4.0 * sixth, sixth, -h],
            [sixth, 4.0 * sixth, h],
        ),
    ] {
        // One cell at its reference coordinates, so that places are local coordinates.
        let mesh = Mesh {
            dim: 3,
            points: kind.reference().nodes().to_vec(),
            point_ids: (1..=kind.node_count() as u64).collect(),
            blocks: vec![Block {
                kind,
                connectivity: (0..kind.node_count()).collect(),
                cell_ids: vec![1],
            }],
            ..Mesh::default()
        };
        let body = elastic(mesh, Space::Solid, formulation, 0.3);
        let mesh = body.mesh();
        let u: Vec<f64> = (0..3 * kind.node_count())
            .map(|d| 1e-3 * (12.9898 * d as f64).sin())
            .collect();
        let all = states(&body, &u);
        assert_eq!(all.len(), 1);
        let points = &all[0].points;
        assert_eq!(points.len(), count, "{kind} {formulation:?}");
        for (point, expected) in [
            (&points[0], first),
            (&points[1.min(count - 1)], second),
            (&points[count - 1], last),
        ] {
            for (x, e) in point.x.iter().zip(expected) {
                assert!(
                    (x - e).abs() < 1e-11,
                    "{kind} {formulation:?} {:?}",
                    point.x
                );
            }
        }
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        assert!((volume - geometry::measure(mesh)).abs() < 1e-12, "{kind}");
        let energy = recover::strain_energy(&body, &u);
        assert!(
            energy > 0.0 && (all[0].energy - energy).abs() <= 1e-14 * energy,
            "{kind}"
        );
    }
}

#[test]
fn energies_of_cells_are_those_of_the_stiffness() {
    for (kind, formulation) in [
        (ElementKind::Hex8, Formulation::Reduced),
        (ElementKind::Hex8, Formulation::IncompatibleModes),
        (ElementKind::Hex20, Formulation::Reduced),
        (ElementKind::Wedge6, Formulation::Reduced),
        (ElementKind::Wedge15, Formulation::Standard),
    ] {
        let cuboid = Cuboid {
            element: kind,
            ..Cuboid::new([0.0; 3], [2.0, 1.0, 1.0], [3, 2, 2])
        };
        let body = elastic(cuboid.generate().unwrap(), Space::Solid, formulation, 0.3);
        let u: Vec<f64> = (0..3 * body.mesh().points.len())
            .map(|d| 1e-3 * (12.9898 * d as f64 + 4.1).sin())
            .collect();
        let mut force = vec![0.0; u.len()];
        recover::internal_force(&body, &u, &mut force);
        let work: f64 = 0.5 * force.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let sum: f64 = states(&body, &u).iter().map(|s| s.energy).sum();
        assert!((work - sum).abs() < 1e-11 * work, "{kind}: {work} {sum}");
    }
}

#[test]
fn wedges_are_written_in_the_order_of_vtk() {
    // Seen from inside, corners 0, 1, 2 of VTK's linear wedge run the other way round than ours; its quadratic wedge is as ours.
    for (element, turned) in [(ElementKind::Wedge6, true), (ElementKind::Wedge15, false)] {
        let cuboid = Cuboid {
            element,
            ..Cuboid::new([0.0; 3], [1.0; 3], [1, 1, 1])
        };
        let mesh = cuboid.generate().unwrap();
        let path = support::folder(&format!("vtk-{element}")).join("mesh.vtu");
        stickslip::io::vtu::write(&path, &mesh, &Fields::default(), None).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let connectivity = first_integers(&bytes, "connectivity", element.node_count());
        let own = &mesh.blocks[0].connectivity[..element.node_count()];
        let mut expected: Vec<usize> = own.to_vec();
        if turned {
            expected.swap(1, 2);
            expected.swap(4, 5);
        }
        assert_eq!(connectivity, expected, "{element}");
    }
}

/// The first integers of an array in a file with appended, compressed data.
fn first_integers(file: &[u8], name: &str, count: usize) -> Vec<usize> {
    use std::io::Read;
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let start = file.windows(marker.len()).position(|w| w == marker);
    let start = start.unwrap();
    let text = std::str::from_utf8(&file[..start]).unwrap();
    let line = text.lines().find(|l| l.contains(name)).unwrap();
    let (_, offset) = line.split_once("offset=\"").unwrap();
    let offset: usize = offset.split_once('"').unwrap().0.parse().unwrap();
    let at = start + marker.len() + offset;
    let word = |k: usize| u64::from_le_bytes(*file[at + 8 * k..].first_chunk().unwrap()) as usize;
    let (blocks, packed) = (word(0), word(3));
    assert_eq!(blocks, 1);
    let data = &file[at + 32..at + 32 + packed];
    let mut bytes = Vec::new();
    flate2::read::ZlibDecoder::new(data)
        .read_to_end(&mut bytes)
        .unwrap();
    let words = bytes.chunks_exact(8).take(count);
    words
        .map(|w| u64::from_le_bytes(*w.first_chunk().unwrap()) as usize)
        .collect()
}

#[test]
fn problem_files_name_the_formulations_and_wedges() {
    for (formulation, cells) in [
        ("reduced", "hex8"),
        ("incompatible-modes", "hex8"),
        ("standard", "wedge6"),
        ("standard", "wedge15"),
        ("reduced", "hex20"),
    ] {
        let text = format!(
            r#"
format = 1
model.space = "solid"
material.m.isotropic = {{ young = 10.0, poisson = 0.3 }}
step = [{{ increments.fixed = 1 }}]
interface.joint = {{ secondary = "up.bottom", primary = "low.top", friction.coulomb.mu = 0.3 }}
load.top = {{ set = "up.top", pressure.value = 0.01 }}
[body.low]
generate.box = {{ to = [1, 1, 0.5], cells = [2, 3, 2], element = "{cells}" }}
formulation = "{formulation}"
material = "m"
[body.up]
generate.box = {{ from = [0, 0, 0.5], to = [1, 1, 1], cells = [3, 2, 2], element = "{cells}" }}
formulation = "{formulation}"
material = "m"
[support]
base = {{ set = "low.bottom", z = 0 }}
low-left = {{ set = "low.left", x = 0 }}
up-left = {{ set = "up.left", x = 0 }}
low-front = {{ set = "low.front", y = 0 }}
up-front = {{ set = "up.front", y = 0 }}
"#
        );
        let mut simulation: Simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        let (names, columns) =
            look::table(support::contact(&simulation), &simulation.frame.state.u);
        let pressure = &columns[names.iter().position(|n| n == "CPRESS").unwrap()];
        for p in pressure {
            assert!((p / 0.01 - 1.0).abs() < 1e-6, "{formulation} {cells}: {p}");
        }
    }
}

#[test]
fn balls_cannot_be_made_of_wedges() {
    let said = support::complaint(
        r#"
format = 1
model.space = "solid"
material.m.isotropic = { young = 10.0, poisson = 0.3 }
step = [{ increments.fixed = 1 }]
[body.ball]
generate.half-ball = { radius = 1, element = "wedge6" }
material = "m"
[support.base]
set = "ball.flat"
x = 0
"#,
    );
    assert!(said.contains("cannot be made of wedge6"), "{said}");
}

/// One distorted cell with prescribed displacements: the stress at its last point (xx yy zz xy xz yz, in the order of the file) and its energy
/// as CalculiX 2.20 prints them.
#[test]
fn stresses_and_energies_are_those_that_calculix_prints() {
    use ElementKind::*;
    for (kind, formulation, printed, energy) in [
        (
            Hex8,
            Formulation::Standard,
            [
                1.523662e8, 1.165649e8, 1.552822e8, 6.334130e7, 5.014436e7, 1.185365e7,
            ],
            6.215601e5,
        ),
        (
            Hex8,
            Formulation::Reduced,
            [
                1.182707e8,
                3.232135e7,
                6.099509e7,
                4.734613e7,
                2.761465e7,
                -2.487104e7,
            ],
            4.119393e5,
        ),
        (
            Hex20,
            Formulation::Standard,
            [
                8.361035e8, 9.276803e8, 8.399194e8, 1.821980e8, 1.282744e8, 3.161794e8,
            ],
            5.390917e6,
        ),
        (
            Hex20,
            Formulation::Reduced,
            [
                2.955804e8, 3.801199e8, 3.479636e8, 1.199452e7, 1.587334e7, 1.748073e8,
            ],
            4.890867e6,
        ),
        (
            Tet4,
            Formulation::Standard,
            [
                2.278092e7,
                -1.677230e8,
                -3.891646e8,
                8.472081e7,
                -4.379516e7,
                -1.821513e8,
            ],
            1.063727e5,
        ),
        (
            Tet10,
            Formulation::Standard,
            [
                -1.440430e9,
                -9.475976e8,
                -1.003793e9,
                -4.812626e8,
                -3.204635e8,
                -8.577342e7,
            ],
            6.681349e5,
        ),
        (
            Wedge6,
            Formulation::Reduced,
            [
                8.776280e7, 2.626621e8, 4.481491e7, 7.960030e7, 8.206130e6, 6.754410e7,
            ],
            1.617987e5,
        ),
        (
            Wedge15,
            Formulation::Standard,
            [
                -3.366903e8,
                -1.974974e8,
                1.751815e8,
                -1.999598e8,
                8.884774e7,
                1.453104e8,
            ],
            1.047290e6,
        ),
    ] {
        let place = |(i, p): (usize, &[f64; 3])| {
            let i = i as f64;
            [
                p[0] + 0.05 * i.sin(),
                p[1] + 0.04 * (2.0 * i).cos(),
                p[2] + 0.03 * (3.0 * i).sin(),
            ]
        };
        let nodes = kind.reference().nodes().iter().enumerate();
        let mesh = Mesh {
            dim: 3,
            points: nodes.map(place).collect(),
            point_ids: (1..=kind.node_count() as u64).collect(),
            blocks: vec![Block {
                kind,
                connectivity: (0..kind.node_count()).collect(),
                cell_ids: vec![1],
            }],
            ..Mesh::default()
        };
        let body = elastic(mesh, Space::Solid, formulation, 0.3);
        let u: Vec<f64> = (0..3 * kind.node_count())
            .map(|d| 1e-3 * (12.9898 * d as f64).sin())
            .collect();
        let state = states(&body, &u).remove(0);
        let s = state.points.last().expect("points").stress;
        let own = [s[0], s[1], s[2], s[3], s[5], s[4]];
        let size = own.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        for (a, b) in own.iter().zip(printed) {
            assert!((a - b).abs() < 1e-6 * size, "{kind}: {a} {b}");
        }
        let inside = state.energy - state.hourglass;
        assert!(
            (inside / energy - 1.0).abs() < 1e-6,
            "{kind}: {inside} {energy}"
        );
    }
}
