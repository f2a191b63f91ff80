//! `cargo bench --bench contact_points`: what search, pairing and evaluation of contact points cost, on one thread.
//!
//! The secondary is a grid of points over a surface, the primary the same surface in facets, a third of a facet aside; all points
//! are pressed in and pushed along. Counted as candidates are the facets that the search leaves to a point. Columns, in µs a point:
//!
//! - search: the tree of boxes and the candidates of all points, as after a large motion;
//! - residual, tangent: one evaluation as Newton's method asks for it, without and with tangent;
//! - lean: with tangent but without the symmetric approximation for a preconditioner;
//! - curved: with tangent and how gaps and slips curve, which bodies that are condensed ask for only where Newton's method misses it;
//!
//! and after the bar the tangent per candidate. The last column tells whether two versions of the program compute the same: the
//! norm of the contact forces. Times are the least of several runs.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use stickslip::contact::enforcement::{EnforcementModel, Penalty};
use stickslip::contact::interface::{
    Conditions, Initial, Interface, InterfaceDefinition, InterfaceMesh, Primary,
};
use stickslip::contact::kinematics::{Convective, KinematicsModel, Pop1995, SmallSliding};
use stickslip::contact::law::friction::{Coulomb, FrictionModel};
use stickslip::contact::response::Laws;
use stickslip::contact::search::Tree;
use stickslip::contact::surface::{ContactPoint, Facet, connect};
use stickslip::math::Vec3;
use stickslip::registry::Family;
use stickslip::shape::ElementKind;
use stickslip::system::{Assembler, Dofs, Force, Schedule, Stage, State};

/// Facets along an edge of the surface, and points less one.
const CELLS: usize = 27;

/// Depth to which the points are pressed in `[m]`.
const DEPTH: f64 = 1e-4;

/// The least time of several calls in seconds.
fn least(mut call: impl FnMut()) -> f64 {
    (0..40)
        .map(|_| {
            let start = Instant::now();
            call();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// A place on the surface, for coordinates along it.
fn place(x: f64, y: f64, dim: usize, curved: bool) -> Vec3 {
    let bulge = if curved {
        0.08 * (2.0 * x).sin() * (1.5 * y).cos()
    } else {
        0.0
    };
    match dim {
        2 => [x, bulge, 0.0],
        _ => [x, y, bulge],
    }
}

/// Facets with their nodes, upward.
fn facets(kind: ElementKind, curved: bool) -> (Vec<Vec3>, Vec<Facet>) {
    let dim = kind.dim() + 1;
    let step = if kind.order() == 2 { 2 } else { 1 };
    let line = step * CELLS + 1;
    let rows = if dim == 2 { 1 } else { line };
    let at = |k: usize| k as f64 / (line - 1) as f64;
    let x = (0..rows)
        .flat_map(|j| (0..line).map(move |i| (i, j)))
        .map(|(i, j)| place(at(i), if dim == 2 { 0.0 } else { at(j) }, dim, curved))
        .collect();
    let mut all = Vec::new();
    for j in 0..if dim == 2 { 1 } else { CELLS } {
        for i in 0..CELLS {
            let n = |a: usize, b: usize| (step * j + b) * line + step * i + a;
            let mut add = |nodes: &[usize]| {
                all.push(Facet {
                    kind,
                    nodes: nodes.to_vec(),
                    continues: Vec::new(),
                    modulus: 1e11,
                    cell: 0,
                });
            };
            match kind {
                // the body lies below a line that runs backwards
                ElementKind::Line2 => add(&[n(1, 0), n(0, 0)]),
                ElementKind::Tri3 => {
                    add(&[n(0, 0), n(1, 0), n(1, 1)]);
                    add(&[n(0, 0), n(1, 1), n(0, 1)]);
                }
                ElementKind::Quad4 => add(&[n(0, 0), n(1, 0), n(1, 1), n(0, 1)]),
                _ => add(&[
                    n(0, 0),
                    n(2, 0),
                    n(2, 2),
                    n(0, 2),
                    n(1, 0),
                    n(2, 1),
                    n(1, 2),
                    n(0, 1),
                ]),
            }
        }
    }
    connect(&mut all);
    (x, all)
}

fn interface(
    kind: ElementKind,
    curved: bool,
    kinematics: KinematicsModel,
    laws: Laws,
) -> Interface {
    let (mut reference, facets) = facets(kind, curved);
    let dim = kind.dim() + 1;
    let first = reference.len();
    let rows = if dim == 2 { 1 } else { CELLS + 1 };
    let normal = if dim == 2 {
        [0.0, -1.0, 0.0]
    } else {
        [0.0, 0.0, -1.0]
    };
    // away from the edges of the primary
    let at = |k: usize| 0.01 + 0.97 * k as f64 / CELLS as f64;
    let mut points = Vec::new();
    for j in 0..rows {
        for i in 0..=CELLS {
            points.push(ContactPoint {
                nodes: vec![reference.len()],
                weights: vec![1.0],
                area: 1e-3,
                stiffness: 1e12,
                normal,
                size: 1.0 / CELLS as f64,
                across: Default::default(),
            });
            reference.push(place(at(i), at(j), dim, curved));
        }
    }
    assert_eq!(first + points.len(), reference.len());
    Interface::new(InterfaceDefinition {
        name: "joint".into(),
        mesh: Arc::new(InterfaceMesh {
            dofs: Dofs {
                dim,
                points: reference.len(),
            },
            nodes: (0..reference.len()).collect(),
            node_ids: (0..reference.len() as u64).collect(),
            reference,
            neighbours: Vec::new(),
            skin: Vec::new(),
            primary_nodes: 0,
            points,
            alike: Vec::new(),
            mortar: None,
            opposite_wear: Default::default(),
            walls: Default::default(),
            clamped: Vec::new(),
            primary: Primary::Facets(facets),
            origin: [0.0; 3],
            relief: Vec::new(),
        }),
        share: 1.0,
        exchanged: false,
        laws,
        kinematics,
        belt: Vec::new(),
        schedule: Schedule::always(),
        frames: Default::default(),
        turns: false,
        initial: Initial::default(),
    })
}

/// All points of the secondary lowered and pushed.
fn state(interface: &Interface, t: f64, depth: f64, push: f64) -> State {
    let dofs = interface.dofs;
    let mut u = vec![0.0; dofs.count()];
    for point in &interface.points {
        for &node in &point.nodes {
            u[dofs.of(node, 0)] = push;
            u[dofs.of(node, dofs.dim - 1)] = -depth;
        }
    }
    State {
        t,
        u,
        ..State::default()
    }
}

/// Candidates of all points, as the interface finds them.
fn candidates(interface: &Interface) -> usize {
    let Primary::Facets(facets) = &interface.primary else {
        return 0;
    };
    let x = &interface.reference;
    let tree = Tree::build(facets.iter().map(|f| f.nodes.iter().map(|&n| x[n])));
    let size = |f: &Facet| stickslip::math::distance(x[f.nodes[0]], x[f.nodes[1]]);
    let margin = facets.iter().map(size).fold(0.0, f64::max);
    let mut found = Vec::new();
    let mut count = 0;
    for point in &interface.points {
        tree.near(point.position(x), margin, &mut found);
        count += found.len();
    }
    count
}

fn measure(name: &str, kind: ElementKind, bent: bool, kinematics: KinematicsModel, laws: Laws) {
    let mut interface = interface(kind, bent, kinematics, laws);
    let count = interface.points.len();
    let pairs = candidates(&interface) as f64 / count as f64;
    let from = state(&interface, 0.0, 0.0, 0.0);
    let at = state(&interface, 1.0, DEPTH, 2e-4);
    // A rise in between makes the search run again each time.
    let far = state(&interface, 1.0, -1.0, 0.0);
    let stage = |at| Stage {
        from: &from,
        at,
        dt: 1.0,
        rate: None,
        frames: None,
    };
    let history = interface.first_history();
    let conditions = Conditions::default();
    let mut interface = interface.force(&history, &conditions);
    let mut out = Assembler::new(interface.dofs.count());
    interface.begin();
    let mut searched = f64::INFINITY;
    for _ in 0..20 {
        interface.prepare(&stage(&far));
        let start = Instant::now();
        interface.prepare(&stage(&at));
        searched = searched.min(start.elapsed().as_secs_f64());
    }
    // Multipliers take part only once they have been solved for.
    out.reset(true);
    interface.assemble(&stage(&at), &mut out).expect("forces");
    interface.update_internal(&vec![0.0; at.u.len()], 1.0);
    let mut evaluate = |tangent: bool, surrogate: bool, curved: bool| {
        out.wants_surrogate = surrogate;
        out.reset(tangent);
        interface.prepare(&stage(&at));
        interface.assemble(&stage(&at), &mut out).expect("forces");
        if curved {
            interface.curve(&mut out);
        }
        black_box(&out);
    };
    let residual = least(|| evaluate(false, true, false));
    let tangent = least(|| evaluate(true, true, false));
    let lean = least(|| evaluate(true, false, false));
    let curved = least(|| evaluate(true, true, true));
    let norm = out.residual.iter().map(|r| r * r).sum::<f64>().sqrt();
    let tally = interface.tally().unwrap_or_default();
    let us = |seconds: f64| 1e6 * seconds / count as f64;
    println!(
        "{:6} {:6} {:14} {:12} {:5.1} | {:6.2} {:8.2} {:7.2} {:6.2} {:6.2} | {:6.3} | {:3} {:20.13e}",
        kind.name(),
        if bent { "curved" } else { "flat" },
        interface.kinematics.kind(),
        name,
        pairs,
        us(searched),
        us(residual),
        us(tangent),
        us(lean),
        us(curved),
        us(tangent) / pairs,
        tally.stick + tally.slip,
        norm
    );
}

fn main() {
    // One thread: numbers per point are those of the work. It fails only where a pool exists already.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.expect("a thread");
    let coulomb = |enforcement: EnforcementModel| Laws {
        friction: FrictionModel::Coulomb(Coulomb { mu: 0.3, cap: None }),
        enforcement,
        ..Laws::default()
    };
    let convective = KinematicsModel::Convective(Convective {});
    let all = [
        convective.clone(),
        KinematicsModel::SmallSliding(SmallSliding {}),
        KinematicsModel::Pop1995(Pop1995 {}),
    ];
    println!(
        "facet  shape  kinematics     enforcement  pairs | search residual tangent   lean curved |   pair | in contact, force"
    );
    pool.install(|| {
        use ElementKind::{Line2, Quad4, Quad8, Tri3};
        for kind in [Line2, Tri3, Quad4, Quad8] {
            for curved in [false, true] {
                for kinematics in &all {
                    if kinematics.as_dyn().triangles() && !matches!(kind, Line2 | Tri3) {
                        continue;
                    }
                    for enforcement in [
                        EnforcementModel::default(),
                        EnforcementModel::Penalty(Penalty::default()),
                    ] {
                        let name = match &enforcement {
                            EnforcementModel::Penalty(_) => "penalty",
                            _ => "default",
                        };
                        let laws = coulomb(enforcement);
                        measure(name, kind, curved, kinematics.clone(), laws);
                    }
                }
            }
        }
    });
}
