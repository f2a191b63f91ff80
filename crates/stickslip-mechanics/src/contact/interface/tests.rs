//! Whole interfaces: what is skipped makes no difference, and the tangent is that of the force.

use std::sync::Arc;

use super::Conditions;
use super::Initial;
use super::attempt::StatusHistory;
use super::definition::{InterfaceDefinition, InterfaceMesh, Primary};
use super::parts::Interface;
use super::parts::InterfaceForce;
use super::search::Search;
use crate::contact::bounds::Bounds;
use crate::contact::enforcement::{EnforcementModel, Penalty};
use crate::contact::facet_point::FacetPoint;
use crate::contact::kinematics::KinematicsModel;
use crate::contact::law::friction::{Coulomb, FrictionModel};
use crate::contact::law::wear::{Archard, WearModel};
use crate::contact::pairing::Previous;
use crate::contact::response::{Laws, Status};
use crate::contact::surface::{ContactPoint, Facet, connect};
use crate::math::{Vec3, add_scaled};
use crate::registry::Family;
use crate::shape::ElementKind;
use crate::system::{ActiveSet, Assembler, Dofs, Force, Schedule, Stage, State};

const CELLS: usize = 4;

/// A wavy surface over the unit square, in facets of this kind, and points that lie in it or over it and beyond its edges.
pub(in crate::contact) fn sample(kind: ElementKind, kinematics: KinematicsModel) -> Interface {
    let step = kind.order();
    let line = step * CELLS + 1;
    let wavy = |x: f64, y: f64| [x, y + 0.02 * x, 0.1 * (5.0 * x).sin() * (4.0 * y).cos()];
    let at = |k: usize| k as f64 / (line - 1) as f64;
    let mut reference: Vec<Vec3> = (0..line * line)
        .map(|k| wavy(at(k % line), at(k / line)))
        .collect();
    let mut facets = Vec::new();
    for (i, j) in (0..CELLS * CELLS).map(|k| (k % CELLS, k / CELLS)) {
        let n = |a: usize, b: usize| (step * j + b) * line + step * i + a;
        let all: &[&[usize]] = match kind {
            ElementKind::Tri3 => &[&[n(0, 0), n(1, 0), n(1, 1)], &[n(0, 0), n(1, 1), n(0, 1)]],
            ElementKind::Quad4 => &[&[n(0, 0), n(1, 0), n(1, 1), n(0, 1)]],
            _ => &[&[
                n(0, 0),
                n(2, 0),
                n(2, 2),
                n(0, 2),
                n(1, 0),
                n(2, 1),
                n(1, 2),
                n(0, 1),
            ]],
        };
        facets.extend(all.iter().map(|nodes| Facet {
            kind,
            nodes: nodes.to_vec(),
            continues: Vec::new(),
            modulus: 1.0,
            cell: 0,
        }));
    }
    connect(&mut facets);
    let mut points = Vec::new();
    for k in 0..40 {
        let part = |step: f64| 1.2 * (step * k as f64).fract() - 0.1;
        let mut node = |x: f64, y: f64| {
            let depth = [0.01, -0.002, 0.3, 0.0][k % 4];
            reference.push(add_scaled(wavy(x, y), -depth, [0.0, 0.0, 1.0]));
            reference.len() - 1
        };
        let (x, y) = (part(0.618), part(0.414));
        points.push(ContactPoint {
            nodes: vec![node(x, y), node(x + 0.05, y)],
            weights: vec![0.3, 0.7],
            area: 0.1,
            stiffness: 1.0,
            normal: [0.0, 0.0, -1.0],
            size: 0.1,
            across: Default::default(),
        });
    }
    Interface::new(InterfaceDefinition {
        name: "joint".into(),
        mesh: Arc::new(InterfaceMesh {
            dofs: Dofs {
                dim: 3,
                points: reference.len(),
            },
            nodes: (0..reference.len()).collect(),
            node_ids: (0..reference.len() as u64).collect(),
            reference,
            primary_nodes: 0,
            points,
            alike: Vec::new(),
            mortar: None,
            neighbours: Vec::new(),
            skin: Vec::new(),
            primary: Primary::Facets(facets),
            opposite_wear: Default::default(),
            walls: Default::default(),
            clamped: Vec::new(),
            origin: [0.0; 3],
            relief: Vec::new(),
        }),
        share: 1.0,
        exchanged: false,
        laws: Laws {
            friction: FrictionModel::Coulomb(Coulomb { mu: 0.3, cap: None }),
            enforcement: EnforcementModel::Penalty(Penalty::default()),
            ..Laws::default()
        },
        kinematics,
        belt: Vec::new(),
        schedule: Schedule::always(),
        frames: Default::default(),
        turns: false,
        initial: Initial::default(),
    })
}

/// Displacements without a pattern.
fn moved(interface: &Interface, t: f64, size: f64) -> State {
    State {
        t,
        u: (0..interface.dofs.count())
            .map(|k| size * (12.9898 * (k as f64 + t)).sin())
            .collect(),
        ..State::default()
    }
}

/// A course of statuses shows what a point did, not how long it rested.
#[test]
fn a_course_shows_changes_only() {
    let mut flips = StatusHistory::default();
    let course = [
        Status::Open,
        Status::Stick,
        Status::Open,
        Status::Open,
        Status::Open,
        Status::Open,
    ];
    let changes: Vec<bool> = course.iter().map(|s| flips.note(*s)).collect();
    assert_eq!(changes, [false, true, true, false, false, false]);
    assert_eq!(flips.count, 2);
    let last: Vec<Status> = flips.last.iter().rev().flatten().copied().collect();
    assert_eq!(last, [Status::Open, Status::Stick, Status::Open]);
}

/// A point that slides over one facet after the other does not go back and forth, one that comes back to a facet again and again does.
#[test]
fn a_point_that_comes_back_goes_to_and_fro() {
    let visits = |facets: &[usize]| {
        let mut flips = StatusHistory::default();
        for &f in facets {
            flips.meets(Some(f));
            flips.meets(None);
        }
        flips.oscillates()
    };
    assert!(!visits(&[1, 2, 3, 4, 5, 6, 7]));
    assert!(!visits(&[1, 2, 2, 1, 1, 2]));
    assert!(visits(&[1, 2, 1, 2, 1]));
    assert!(visits(&[1, 2, 3, 1, 2, 3]));
}

#[test]
fn facets_that_are_skipped_would_not_have_been_chosen() {
    for kind in [ElementKind::Tri3, ElementKind::Quad4, ElementKind::Quad8] {
        let interface = sample(kind, KinematicsModel::default());
        let mut found = 0;
        for round in 0..4 {
            let state = moved(&interface, f64::from(round), 0.01);
            let x = interface.coordinates(&state.u);
            let mut search = Search::default();
            super::candidates::update_candidates(&interface, &mut search, &x);
            let mut bounds = Vec::new();
            super::candidates::enclose(&interface, &x, &mut bounds);
            let without: Vec<Bounds> = bounds.iter().map(|b| b.endless()).collect();
            for i in 0..interface.points.len() {
                let candidates = &search.candidates[i];
                let previous = [
                    None,
                    candidates.first().copied(),
                    candidates.last().copied(),
                ];
                for previous in previous {
                    let place = |found: Result<(usize, FacetPoint), f64>| {
                        found.map(|(f, p)| (f, p.xi.map(f64::to_bits)))
                    };
                    let previous = Previous {
                        facet: previous,
                        ..Previous::default()
                    };
                    let quick = super::candidates::closest(
                        &interface,
                        i,
                        super::candidates::Places {
                            x: &x,
                            before: &[],
                            bounds: &bounds,
                        },
                        &search,
                        previous,
                    );
                    let full = super::candidates::closest(
                        &interface,
                        i,
                        super::candidates::Places {
                            x: &x,
                            before: &[],
                            bounds: &without,
                        },
                        &search,
                        previous,
                    );
                    found += usize::from(full.is_ok());
                    assert_eq!(place(quick), place(full), "{kind}, point {i}");
                }
            }
        }
        assert!(found > 100, "{kind}");
    }
}

#[test]
fn the_tangent_is_that_of_the_force() {
    // What is worn off over the increment at hand is in it.
    let kinds = [ElementKind::Tri3, ElementKind::Quad4, ElementKind::Quad8];
    let samples = KinematicsModel::samples().into_iter();
    for (model, coefficient) in samples.flat_map(|model| [(model.clone(), 0.0), (model, 10.0)]) {
        for kind in kinds {
            if model.as_dyn().triangles() && kind != ElementKind::Tri3 {
                continue;
            }
            let mut interface = sample(kind, model.clone());
            interface.definition.laws.wear = WearModel::Archard(Archard {
                coefficient,
                primary_coefficient: 0.0,
                running_in: 0.0,
                running_in_path: 0.0,
            });
            let count = interface.dofs.count();
            let from = moved(&interface, 0.0, 1e-3);
            let mut at = moved(&interface, 1.0, 1e-3);
            let history = interface.first_history();
            let conditions = Conditions::default();
            let mut interface = interface.force(&history, &conditions);
            let mut out = Assembler::new(count);
            let mut force = |at: &State, tangent: bool, surrogate: bool| {
                let stage = Stage {
                    from: &from,
                    at,
                    dt: 1.0,
                    rate: None,
                    frames: None,
                };
                out.wants_surrogate = surrogate;
                out.reset(tangent);
                interface.prepare(&stage);
                interface.assemble(&stage, &mut out).expect("forces");
                let points = out.blocks.len();
                interface.curve(&mut out);
                let curvature = out.blocks.split_off(points);
                (out.residual.clone(), out.blocks.clone(), curvature)
            };
            // The first tangent of an attempt is another one.
            force(&at, true, true);
            let (_, blocks, curvature) = force(&at, true, false);
            assert!(blocks.len() > 8);
            assert!(blocks.iter().all(|block| block.hessian.is_empty()));
            assert_eq!(curvature.is_empty(), model.as_dyn().frozen());
            let blocks = [blocks, curvature].concat();
            assert!(blocks.iter().all(|block| block.surrogate.is_empty()));
            let largest = blocks.iter().flat_map(|b| b.tangent());
            let largest = largest.fold(0.0_f64, |m, k| m.max(k.abs()));
            let direction: Vec<f64> = (0..count).map(|k| (k as f64 * 0.7).cos()).collect();
            let mut product = vec![0.0; count];
            for block in &blocks {
                let along: Vec<f64> = block.dofs.iter().map(|&dof| direction[dof]).collect();
                let mut force = vec![0.0; along.len()];
                block.apply(&along, &mut force);
                for (&dof, f) in block.dofs.iter().zip(force) {
                    product[dof] += f;
                }
            }
            let h = 1e-8;
            let start = at.u.clone();
            let [below, above] = [-h, h].map(|h| {
                for ((u, s), d) in at.u.iter_mut().zip(&start).zip(&direction) {
                    *u = s + h * d;
                }
                force(&at, false, false).0
            });
            for (k, p) in product.iter().enumerate() {
                let difference = (above[k] - below[k]) / (2.0 * h);
                let what = format!(
                    "{} on {kind}, wear {coefficient}, dof {k}: {p} {difference}",
                    model.kind()
                );
                assert!((difference - p).abs() < 1e-5 * largest, "{what}");
            }
            // The approximation changes nothing else.
            let (_, full, curvature) = force(&State { u: start, ..at }, true, true);
            for (a, b) in blocks.iter().zip(full.iter().chain(&curvature)) {
                assert!(!b.surrogate.is_empty());
                assert_eq!((&a.rows, &a.change), (&b.rows, &b.change));
                assert_eq!(a.hessian, b.hessian);
            }
        }
    }
}

/// Points opposite the concave parts of a surface are as near to one facet as to the next: which of them they meet is a matter of geometry.
#[test]
fn numbers_of_facets_make_no_difference() {
    for kind in [ElementKind::Tri3, ElementKind::Quad4] {
        let mut ordered = sample(kind, KinematicsModel::default());
        let grid = (CELLS + 1) * (CELLS + 1);
        let InterfaceMesh {
            points, reference, ..
        } = ordered.definition.mesh_mut();
        for (k, point) in points.iter_mut().enumerate() {
            // right below a node of the surface
            let node = k % grid;
            let deep = add_scaled(reference[node], -0.004, [0.0, 0.0, 1.0]);
            reference[point.nodes[0]] = deep;
            point.nodes.truncate(1);
            point.weights = vec![1.0];
        }
        let mut reversed = ordered.clone();
        if let Primary::Facets(facets) = &mut reversed.definition.mesh_mut().primary {
            facets.reverse();
            for f in facets.iter_mut() {
                f.continues.clear();
            }
            connect(facets);
        }
        let at = State {
            t: 1.0,
            u: vec![0.0; ordered.dofs.count()],
            ..State::default()
        };
        let from = State {
            t: 0.0,
            ..at.clone()
        };
        let [a, b] = [&mut ordered, &mut reversed].map(|interface| {
            let stage = Stage {
                from: &from,
                at: &at,
                dt: 1.0,
                rate: None,
                frames: None,
            };
            let mut out = Assembler::new(interface.dofs.count());
            out.reset(false);
            let history = interface.first_history();
            let conditions = Conditions::default();
            let mut interface = interface.force(&history, &conditions);
            interface.prepare(&stage);
            interface.assemble(&stage, &mut out).expect("forces");
            out.residual
        });
        let largest = a.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(largest > 0.0);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() <= 1e-12 * largest, "{kind}: {a} {b}");
        }
    }
}

/// A tentative evaluation that is settled, and one that is given up, leave what a plain course leaves.
#[test]
fn tentative_evaluations_leave_no_trace_until_they_are_settled() {
    for enforcement in EnforcementModel::samples() {
        let mut plain = sample(ElementKind::Quad4, KinematicsModel::default());
        plain.definition.laws.enforcement = enforcement;
        let from = moved(&plain, 0.0, 1e-3);
        let [first, far, next] = [1.0, 2.0, 3.0].map(|t| State {
            t: 1.0,
            ..moved(&plain, t, 1e-3)
        });
        let du = moved(&plain, 4.0, 1e-4).u;
        let course = |interface: &mut Interface, tentative: bool, given_up: bool| {
            let history = interface.first_history();
            let conditions = Conditions::default();
            let interface = &mut interface.force(&history, &conditions);
            let mut out = Assembler::new(interface.dofs.count());
            let mut evaluate = |interface: &mut InterfaceForce, at, tangent, tentative| {
                let stage = Stage {
                    from: &from,
                    at,
                    dt: 1.0,
                    rate: None,
                    frames: None,
                };
                out.tentative = tentative;
                out.reset(tangent);
                interface.prepare(&stage);
                interface.assemble(&stage, &mut out).expect("forces");
                (out.residual.clone(), out.condensed.clone())
            };
            interface.prepare(&Stage {
                from: &from,
                at: &first,
                dt: 1.0,
                rate: None,
                frames: None,
            });
            interface.begin();
            evaluate(interface, &first, true, false);
            if given_up {
                interface.update_internal(&du, 1.0);
                evaluate(interface, &far, tentative, tentative);
            }
            interface.update_internal(&du, 0.5);
            evaluate(interface, &next, tentative, tentative);
            if tentative {
                interface.settle();
            } else {
                evaluate(interface, &next, true, false);
            }
            let tally = interface.tally();
            interface.update_internal(&du, 1.0);
            (
                evaluate(interface, &first, true, false),
                tally,
                interface.attempt.flips.clone(),
            )
        };
        for given_up in [false, true] {
            let [a, b] = [false, true].map(|t| course(&mut plain.clone(), t, given_up));
            assert_eq!((a.1, &a.2), (b.1, &b.2));
            let size = a.0.0.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
            let pairs = a.0.0.iter().zip(&b.0.0).chain(a.0.1.iter().zip(&b.0.1));
            for (a, b) in pairs {
                assert!((a - b).abs() <= 1e-9 * size, "{a} {b}");
            }
        }
    }
}

/// Passing an outer edge is seen before it is settled, in both directions and with both kinds of unknowns, and comes to an end.
#[test]
fn points_pass_edges_a_few_times_only() {
    for enforcement in EnforcementModel::samples() {
        let mut interface = sample(ElementKind::Quad4, KinematicsModel::default());
        interface.definition.laws.enforcement = enforcement;
        let dofs = interface.dofs;
        // All points of the secondary stay, or go beyond the edge together.
        let state = |interface: &Interface, way: f64| {
            let mut u = vec![0.0; dofs.count()];
            let nodes = interface.points.iter().flat_map(|p| &p.nodes);
            nodes.for_each(|&node| u[dofs.of(node, 0)] = way);
            State {
                t: 1.0,
                u,
                ..State::default()
            }
        };
        let [on, off] = [0.0, 2.0].map(|way| state(&interface, way));
        let mut out = Assembler::new(dofs.count());
        let history = interface.first_history();
        let conditions = Conditions::default();
        let mut interface = interface.force(&history, &conditions);
        let mut passes = |interface: &mut InterfaceForce, at: &State| {
            let stage = Stage {
                from: &on,
                at,
                dt: 1.0,
                rate: None,
                frames: None,
            };
            out.tentative = true;
            out.reset(true);
            interface.prepare(&stage);
            interface.assemble(&stage, &mut out).expect("forces");
            let passes = interface.passes_edges();
            interface.settle();
            passes
        };
        let stage = Stage {
            from: &on,
            at: &on,
            dt: 1.0,
            rate: None,
            frames: None,
        };
        interface.prepare(&stage);
        interface.begin();
        passes(&mut interface, &on);
        assert!(!passes(&mut interface, &on), "nothing moves");
        let course = [&off, &off, &on, &off, &on, &off];
        let seen = course.map(|at| passes(&mut interface, at));
        assert_eq!(seen, [true, false, true, true, false, false]);
    }
}
