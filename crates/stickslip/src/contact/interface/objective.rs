//! Interfaces whose surfaces turn: with each other nothing happens but that tractions turn too; over each other points carry their limit.

use super::*;
use crate::contact::enforcement::{EnforcementModel, Penalty};
use crate::contact::kinematics::{Pop1995, SmallSliding};
use crate::contact::law::friction::{Coulomb, FrictionModel};
use crate::contact::law::slip::{Regularised, SlipModel};
use crate::contact::mortar::Face;
use crate::contact::surface::connect;
use crate::math::{cross, dot, mat_vec, norm, rotation, sub};
use crate::shape::ElementKind;

const AROUND: usize = 48;
const LAYERS: usize = 2;

/// A drum of radius one about the z axis, its outside in facets, and a shoe of a few faces on it, as a node-to-facet contact or a mortar. In the plane a
/// circle.
fn drum(dim: usize, kinematics: KinematicsModel, mortar: bool, slip: SlipModel) -> Interface {
    let triangles = kinematics.as_dyn().triangles();
    let layers = if dim == 2 { 0 } else { LAYERS };
    let at = |radius: f64, part: f64, layer: usize| {
        let angle = std::f64::consts::TAU * part;
        let (s, c) = angle.sin_cos();
        [radius * c, radius * s, 0.15 * layer as f64]
    };
    let mut reference = Vec::new();
    for layer in 0..=layers {
        reference.extend((0..AROUND).map(|k| at(1.0, k as f64 / AROUND as f64, layer)));
    }
    let primary_nodes = reference.len();
    let node = |k: usize, layer: usize| layer * AROUND + k % AROUND;
    let facet = |kind, nodes| Facet {
        kind,
        nodes,
        continues: Vec::new(),
        modulus: 1.0,
        cell: 0,
    };
    let mut facets = Vec::new();
    for k in 0..AROUND {
        if dim == 2 {
            facets.push(facet(ElementKind::Line2, vec![node(k, 0), node(k + 1, 0)]));
        }
        for l in 0..layers {
            let [a, b, c, d] = [
                node(k, l),
                node(k + 1, l),
                node(k + 1, l + 1),
                node(k, l + 1),
            ];
            if triangles {
                facets.push(facet(ElementKind::Tri3, vec![a, b, c]));
                facets.push(facet(ElementKind::Tri3, vec![a, c, d]));
            } else {
                facets.push(facet(ElementKind::Quad4, vec![a, b, c, d]));
            }
        }
    }
    connect(&mut facets);
    // The shoe has another size of cells, and reaches into the drum.
    let columns = 4;
    let first = reference.len();
    let mut points = Vec::new();
    for layer in 0..=layers {
        for k in 0..=columns {
            let part = (3.3 + 1.2 * k as f64) / AROUND as f64;
            let x = at(0.995, part, layer);
            points.push(ContactPoint {
                nodes: vec![reference.len()],
                weights: vec![1.0],
                area: 0.01,
                stiffness: 1.0,
                normal: [-x[0], -x[1], 0.0],
                size: 0.1,
            });
            reference.push(x);
        }
    }
    let mine = |k: usize, layer: usize| first + layer * (columns + 1) + k;
    let mut faces = Vec::new();
    for k in 0..columns {
        if dim == 2 {
            faces.push((ElementKind::Line2, vec![mine(k + 1, 0), mine(k, 0)]));
        }
        for l in 0..layers {
            let nodes = vec![
                mine(k, l),
                mine(k, l + 1),
                mine(k + 1, l + 1),
                mine(k + 1, l),
            ];
            faces.push((ElementKind::Quad4, nodes));
        }
    }
    let faces = faces.into_iter().map(|(kind, nodes)| Face {
        kind,
        points: nodes.iter().map(|n| n - first).collect(),
        normals: nodes.iter().map(|&n| points[n - first].normal).collect(),
        extents: vec![1.0; nodes.len()],
        nodes,
    });
    let mortar = mortar.then(|| super::Mortar::new(faces.collect(), points.len()));
    Interface {
        name: "shoe".into(),
        dofs: Dofs {
            dim,
            points: reference.len(),
        },
        nodes: (0..reference.len()).collect(),
        node_ids: (0..reference.len() as u64).collect(),
        reference,
        primary_nodes,
        points,
        mortar,
        neighbours: Vec::new(),
        primary: Primary::Facets(facets),
        skin: Vec::new(),
        share: 1.0,
        laws: Laws {
            friction: FrictionModel::Coulomb(Coulomb { mu: 0.3, cap: None }),
            enforcement: EnforcementModel::Penalty(Penalty::default()),
            slip,
            ..Laws::default()
        },
        kinematics,
        belt: Vec::new(),
        schedule: Schedule::always(),
        edge_tolerance: 1e-3,
        initial: Initial::default(),
        memory: Memory::default(),
    }
}

/// Accepts an increment that ends where `place` puts the points of the reference.
fn accept(interface: &mut Interface, from: &State, place: impl Fn(usize, Vec3) -> Vec3) -> State {
    let mut at = State {
        t: from.t + 1.0,
        u: vec![0.0; interface.dofs.count()],
        ..State::default()
    };
    for (k, &x) in interface.reference.iter().enumerate() {
        let moved = sub(place(k, x), x);
        for (c, u) in moved.iter().enumerate().take(interface.dofs.dim) {
            at.u[interface.dofs.of(k, c)] = *u;
        }
    }
    let stage = Stage {
        from,
        at: &at,
        dt: 1.0,
        rate: None,
    };
    let mut out = Assembler::new(interface.dofs.count());
    out.reset(false);
    interface.prepare(&stage).expect("candidates");
    interface.begin();
    interface.assemble(&stage, &mut out).expect("forces");
    interface.commit(&stage);
    at
}

fn start(interface: &Interface) -> State {
    State {
        u: vec![0.0; interface.dofs.count()],
        ..State::default()
    }
}

fn all(dim: usize) -> Vec<(String, Interface)> {
    let mut out = Vec::new();
    let convective = KinematicsModel::default;
    let pop = || KinematicsModel::Pop1995(Pop1995 {});
    for (rule, slip) in [
        ("return mapping", SlipModel::default()),
        (
            "regularised",
            SlipModel::Regularised(Regularised { epsilon: 1e-3 }),
        ),
    ] {
        for (name, kinematics, mortar) in [
            ("facets", convective(), false),
            ("the paper", pop(), false),
            ("mortar", convective(), true),
        ] {
            let what = format!("{name}, {rule}, {dim}D");
            out.push((what, drum(dim, kinematics, mortar, slip.clone())));
        }
    }
    out
}

#[test]
fn a_pair_that_turns_together_keeps_its_traction() {
    for dim in [2, 3] {
        for (what, pressed) in all(dim) {
            for angle in [0.01, 0.3, 1.0] {
                let mut interface = pressed.clone();
                let origin = start(&interface);
                let drum = interface.primary_nodes;
                // pressed and sheared, within the limit at most points
                let (s, c) = 1e-4_f64.sin_cos();
                let sheared = |k: usize, x: Vec3| match k < drum {
                    true => x,
                    false => [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]],
                };
                let still = accept(&mut interface, &origin, sheared);
                let before = interface.memory.committed.clone();
                let largest = before.iter().fold(0.0_f64, |m, h| m.max(norm(h.shear)));
                let most = before.iter().fold(0.0_f64, |m, h| m.max(h.pressure));
                assert!(largest > 0.0 && most > 0.0, "{what}");
                let axis = if dim == 2 {
                    [0.0, 0.0, 1.0]
                } else {
                    [0.48, 0.6, 0.64]
                };
                let turn = rotation(axis, angle);
                let turned = |k, x| add(mat_vec(&turn, sheared(k, x)), [0.3, -0.1, 0.0]);
                accept(&mut interface, &still, turned);
                let sticks = interface.laws.slip.as_dyn().sticks();
                let points = before.iter().zip(&interface.memory.committed);
                for ((a, b), e) in points.zip(&interface.memory.last.points) {
                    assert!(norm(e.moved) < 1e-14, "{what} {angle}: {:e}", norm(e.moved));
                    // A mortar is cut along normals of the reference: its pressure knows small rotations only.
                    if interface.mortar.is_some() {
                        continue;
                    }
                    let apart = (a.pressure - b.pressure).abs();
                    assert!(apart <= 1e-10 * most, "{what}: {apart:e} of {most:e}");
                    let expected = match sticks {
                        true => mat_vec(&turn, a.shear),
                        // shear is that of the velocity: at rest there is none
                        false => [0.0; 3],
                    };
                    let apart = norm(sub(b.shear, expected));
                    assert!(
                        apart < 1e-9 * largest,
                        "{what} {angle}: {apart:e} of {largest:e}"
                    );
                    let slip = sub(b.slip, mat_vec(&turn, a.slip));
                    assert!(norm(slip) < 1e-12, "{what} {angle}: slip");
                }
            }
        }
    }
}

#[test]
fn a_point_on_a_drum_that_turns_carries_its_limit_against_its_slip() {
    for dim in [2, 3] {
        for (what, pressed) in all(dim) {
            for angle in [0.01, -0.1, 0.4, 1.0] {
                let mut interface = pressed.clone();
                let origin = start(&interface);
                let still = accept(&mut interface, &origin, |_, x| x);
                let drum = interface.primary_nodes;
                let turn = rotation([0.0, 0.0, 1.0], angle);
                let at = accept(&mut interface, &still, |k, x| match k < drum {
                    true => mat_vec(&turn, x),
                    false => x,
                });
                let x = interface.coordinates(&at.u);
                let points = interface.points.iter().zip(&interface.memory.committed);
                let mut slid = 0;
                for ((p, h), e) in points.zip(&interface.memory.last.points) {
                    if h.pressure == 0.0 {
                        continue;
                    }
                    slid += 1;
                    assert_eq!(h.status, Status::Slip, "{what} {angle}");
                    let ratio = norm(h.shear) / (0.3 * h.pressure);
                    assert!((ratio - 1.0).abs() < 1e-12, "{what} {angle}: {ratio}");
                    assert!(
                        dot(h.shear, h.normal).abs() < 1e-12 * norm(h.shear),
                        "{what}"
                    );
                    // the drum takes the point along
                    let along = scale(angle.signum(), cross([0.0, 0.0, 1.0], p.position(&x)));
                    let cosine = dot(h.shear, along) / (norm(along) * norm(h.shear));
                    // in the paper's frames friction is not opposite to slip
                    let skew = if what.starts_with("the paper") {
                        0.5
                    } else {
                        0.99
                    };
                    assert!(cosine > skew, "{what} {angle}: {cosine}");
                    if what.starts_with("mortar") {
                        let arc = norm(e.moved) / angle.abs();
                        assert!((arc - 1.0).abs() < 0.01, "{what} {angle}: {arc}");
                    }
                }
                assert!(slid >= 3, "{what} {angle}");
            }
        }
    }
}

/// Small sliding knows the directions of the reference alone, and says what is along them.
#[test]
fn small_sliding_carries_its_limit_in_the_plane_of_the_reference() {
    for mortar in [false, true] {
        let kinematics = KinematicsModel::SmallSliding(SmallSliding {});
        let mut interface = drum(3, kinematics, mortar, SlipModel::default());
        let origin = start(&interface);
        let drum = interface.primary_nodes;
        let (s, c) = 0.02_f64.sin_cos();
        accept(&mut interface, &origin, |k, x| match k < drum {
            true => [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]],
            false => x,
        });
        let slipping = (interface.memory.committed.iter()).filter(|h| h.status == Status::Slip);
        let mut slid = 0;
        for h in slipping {
            slid += 1;
            assert!((norm(h.shear) / (0.3 * h.pressure) - 1.0).abs() < 1e-12);
        }
        assert!(slid > 3);
    }
}
