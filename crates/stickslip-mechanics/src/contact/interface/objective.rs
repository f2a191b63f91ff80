//! Interfaces whose surfaces turn: with each other nothing happens but that tractions turn too; over each other points carry their limit.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Initial;
use super::commit::commit;
use super::conditions::Conditions;
use super::definition::{InterfaceDefinition, InterfaceMesh, Primary};
use super::history::{History, PointHistory};
use super::parts::Interface;
use super::view::ContactView;
use crate::contact::enforcement::{EnforcementModel, Penalty};
use crate::contact::kinematics::{KinematicsModel, Pop1995, SmallSliding};
use crate::contact::law::friction::{Coulomb, FrictionModel};
use crate::contact::law::slip::{Regularised, SlipModel};
use crate::contact::mortar::{Face, Mortar, positive_areas};
use crate::contact::response::{Laws, Status};
use crate::contact::surface::{ContactPoint, Facet, connect, skin};
use crate::contact::worn::OppositeWear;
use crate::math::{Mat3, Vec3, add, cross, dot, mat_vec, norm, normalize, rotation, scale, sub};
use crate::shape::ElementKind;
use crate::system::{Assembler, Dofs, Force, Schedule, Stage, State};

const AROUND: usize = 48;
const LAYERS: usize = 2;

/// Radius of the shoe, which reaches into a drum of radius one.
const SHOE: f64 = 0.995;

/// Nodes of a part of a cylinder about the z axis, by angle and height in halves of the cells.
struct Sheet {
    radius: f64,
    /// Angle at the first column and between columns, in parts of the circle.
    start: f64,
    step: f64,
    /// Columns after which it closes.
    around: Option<usize>,
    known: BTreeMap<(usize, usize), usize>,
}

impl Sheet {
    fn node(&mut self, place: [usize; 2], x: &mut Vec<Vec3>) -> usize {
        let column = self.around.map_or(place[0], |n| place[0] % (2 * n));
        let (radius, part) = (self.radius, self.start + 0.5 * self.step * column as f64);
        *self.known.entry((column, place[1])).or_insert_with(|| {
            let (s, c) = (std::f64::consts::TAU * part).sin_cos();
            x.push([radius * c, radius * s, 0.075 * place[1] as f64]);
            x.len() - 1
        })
    }

    /// A face with these corners, by column and layer, and for a quadratic one the middles of its edges.
    fn face(
        &mut self,
        corners: &[(usize, usize)],
        quadratic: bool,
        x: &mut Vec<Vec3>,
    ) -> (ElementKind, Vec<usize>) {
        let mut places: Vec<_> = corners.iter().map(|c| (2 * c.0, 2 * c.1)).collect();
        if quadratic {
            let edges = if corners.len() == 2 { 1 } else { corners.len() };
            places.extend((0..edges).map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                (a.0 + b.0, a.1 + b.1)
            }));
        }
        let kind = match places.len() {
            2 => ElementKind::Line2,
            4 => ElementKind::Quad4,
            8 => ElementKind::Quad8,
            6 => ElementKind::Tri6,
            _ if corners.len() == 2 => ElementKind::Line3,
            _ => ElementKind::Tri3,
        };
        (
            kind,
            places
                .into_iter()
                .map(|(column, layer)| self.node([column, layer], x))
                .collect(),
        )
    }

    /// All faces of some columns and layers, which look away from the axis or towards it.
    fn faces(
        &mut self,
        columns: usize,
        layers: usize,
        outward: bool,
        triangles: bool,
        quadratic: bool,
        x: &mut Vec<Vec3>,
    ) -> Vec<(ElementKind, Vec<usize>)> {
        let mut out = Vec::new();
        for k in 0..columns {
            let mut all: Vec<Vec<(usize, usize)>> = Vec::new();
            if layers == 0 {
                all.push(vec![(k, 0), (k + 1, 0)]);
            }
            for l in 0..layers {
                let [a, b, c, d] = [(k, l), (k + 1, l), (k + 1, l + 1), (k, l + 1)];
                match triangles {
                    true => all.extend([vec![a, b, c], vec![a, c, d]]),
                    false => all.push(vec![a, b, c, d]),
                }
            }
            for mut corners in all {
                if !outward {
                    corners.reverse();
                }
                out.push(self.face(&corners, quadratic, x));
            }
        }
        out
    }
}

/// A drum of radius one about the z axis, its outside in facets, and a shoe of a few faces on it, as a node-to-facet contact or a mortar. In the plane a
/// circle.
fn drum(
    dim: usize,
    kinematics: KinematicsModel,
    mortar: bool,
    triangles: bool,
    quadratic: bool,
    slip: SlipModel,
) -> Followed {
    let layers = if dim == 2 { 0 } else { LAYERS };
    let sheet = |radius: f64, start: f64, step: f64, around: Option<usize>| Sheet {
        radius,
        start,
        step,
        around,
        known: BTreeMap::new(),
    };
    let part = 1.0 / AROUND as f64;
    let mut reference = Vec::new();
    let of_drum = sheet(1.0, 0.0, part, Some(AROUND)).faces(
        AROUND,
        layers,
        true,
        triangles,
        quadratic,
        &mut reference,
    );
    let facet = |(kind, nodes)| Facet {
        kind,
        nodes,
        continues: Vec::new(),
        modulus: 1.0,
        cell: 0,
    };
    let mut facets: Vec<Facet> = of_drum.into_iter().map(facet).collect();
    connect(&mut facets);
    let primary_nodes = reference.len();
    // The shoe has another size of cells, and reaches into the drum.
    let first = reference.len();
    let faces = sheet(SHOE, 3.3 * part, 1.2 * part, None).faces(
        4,
        layers,
        false,
        triangles,
        quadratic,
        &mut reference,
    );
    let inward = |x: Vec3| [-x[0], -x[1], 0.0];
    let points: Vec<ContactPoint> = (first..reference.len())
        .map(|node| ContactPoint {
            nodes: vec![node],
            weights: vec![1.0],
            area: 0.01,
            stiffness: 1.0,
            normal: normalize(inward(reference[node])).expect("off the axis"),
            size: 0.1,
            across: Default::default(),
        })
        .collect();
    let beneath = faces.iter().cloned().map(facet).collect();
    let skin = skin(beneath, &points, None);
    let faces = faces.into_iter().map(|(kind, nodes)| Face {
        kind,
        points: nodes.iter().map(|n| n - first).collect(),
        normals: nodes.iter().map(|&n| points[n - first].normal).collect(),
        extents: vec![1.0; nodes.len()],
        areas: {
            let x: Vec<Vec3> = nodes.iter().map(|&n| reference[n]).collect();
            positive_areas(kind, &x, |_| 1.0)
        },
        area: {
            let x: Vec<Vec3> = nodes.iter().map(|&n| reference[n]).collect();
            positive_areas(kind, &x, |_| 1.0).iter().sum()
        },
        held: vec![false; nodes.len()],
        depth: f64::INFINITY,
        continues: Vec::new(),
        nodes,
    });
    let mortar = mortar.then(|| Mortar::new(faces.collect(), points.len()));
    let opposite_wear = OppositeWear::new(&facets, &reference, |_| 1.0);
    let interface = Interface::new(InterfaceDefinition {
        name: "shoe".into(),
        mesh: Arc::new(InterfaceMesh {
            dofs: Dofs {
                dim,
                points: reference.len(),
            },
            nodes: (0..reference.len()).collect(),
            node_ids: (0..reference.len() as u64).collect(),
            reference,
            primary_nodes,
            points,
            alike: Vec::new(),
            mortar,
            neighbours: Vec::new(),
            primary: Primary::Facets(facets),
            skin,
            opposite_wear,
            clamped: Vec::new(),
            walls: Default::default(),
            origin: [0.0; 3],
            relief: Vec::new(),
        }),
        share: 1.0,
        exchanged: false,
        laws: Laws {
            friction: FrictionModel::Coulomb(Coulomb { mu: 0.3, cap: None }),
            enforcement: EnforcementModel::Penalty(Penalty::default()),
            slip,
            ..Laws::default()
        },
        kinematics,
        belt: Vec::new(),
        schedule: Schedule::always(),
        frames: Default::default(),
        turns: false,
        initial: Initial::default(),
    });
    Followed {
        state: interface.first_history(),
        interface,
    }
}

/// An interface with what it has been through.
#[derive(Clone)]
pub(super) struct Followed {
    interface: Interface,
    pub state: History,
}

impl std::ops::Deref for Followed {
    type Target = Interface;

    fn deref(&self) -> &Interface {
        &self.interface
    }
}

impl std::ops::DerefMut for Followed {
    fn deref_mut(&mut self) -> &mut Interface {
        &mut self.interface
    }
}

impl Followed {
    /// It as those see it who only look.
    pub fn view(&self) -> ContactView<'_> {
        self.interface.view(&self.state)
    }
}

/// Accepts an increment that ends where `place` puts the points of the reference.
pub(super) fn accept(
    interface: &mut Followed,
    from: &State,
    place: impl Fn(usize, Vec3) -> Vec3,
) -> State {
    let at = tried(interface, from, place);
    let conditions = Conditions::default();
    let mut force = interface.interface.force(&interface.state, &conditions);
    interface.state = commit(&mut force, &stage(from, &at));
    at
}

fn stage<'a>(from: &'a State, at: &'a State) -> Stage<'a> {
    Stage {
        from,
        at,
        dt: 1.0,
        rate: None,
        frames: None,
    }
}

/// Tries an increment that ends where `place` puts the points of the reference.
pub(super) fn tried(
    interface: &mut Followed,
    from: &State,
    place: impl Fn(usize, Vec3) -> Vec3,
) -> State {
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
    let stage = stage(from, &at);
    let mut out = Assembler::new(interface.dofs.count());
    out.reset(true);
    let conditions = Conditions::default();
    let mut force = interface.interface.force(&interface.state, &conditions);
    force.prepare(&stage);
    force.begin();
    force.assemble(&stage, &mut out).expect("forces");
    at
}

pub(super) fn start(interface: &Interface) -> State {
    State {
        u: vec![0.0; interface.dofs.count()],
        ..State::default()
    }
}

pub(super) fn all(dim: usize) -> Vec<(String, Followed)> {
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
        // mortar, triangles, quadratic
        for (name, kinematics, (mortar, triangles, quadratic)) in [
            ("facets", convective(), (false, false, false)),
            ("the paper", pop(), (false, true, false)),
            ("mortar", convective(), (true, false, false)),
            ("mortar of triangles", convective(), (true, true, false)),
            ("quadratic mortar", convective(), (true, false, true)),
            (
                "mortar of quadratic triangles",
                convective(),
                (true, true, true),
            ),
        ] {
            let what = format!("{name}, {rule}, {dim}D");
            out.push((
                what,
                drum(dim, kinematics, mortar, triangles, quadratic, slip.clone()),
            ));
        }
    }
    out
}

#[test]
fn a_pair_that_turns_together_keeps_its_traction() {
    for dim in [2, 3] {
        for (what, pressed) in all(dim) {
            // Surfaces that count from where they are not: one of them is rough.
            for (angle, height) in [(0.01, 0.0), (0.3, 0.0), (1.0, 0.0), (0.3, 1e-4)] {
                let mut interface = pressed.clone();
                let points = interface.points.len();
                interface.interface.definition.mesh_mut().relief = vec![height; points];
                let origin = start(&interface);
                let drum = interface.primary_nodes;
                // pressed and sheared, within the limit at most points
                let (s, c) = 1e-4_f64.sin_cos();
                let sheared = |k: usize, x: Vec3| match k < drum {
                    true => x,
                    false => [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]],
                };
                let mut state = accept(&mut interface, &origin, sheared);
                let before = interface.state.points.clone();
                let axis = if dim == 2 {
                    [0.0, 0.0, 1.0]
                } else {
                    [0.48, 0.6, 0.64]
                };
                // more than half a turn in all
                for k in 1..=4 {
                    let turn = rotation(axis, f64::from(k) * angle);
                    let away = scale(f64::from(k), [0.3, -0.1, 0.0]);
                    let turned = |k, x| add(mat_vec(&turn, sheared(k, x)), away);
                    state = accept(&mut interface, &state, turned);
                    has_turned(
                        &interface,
                        &before,
                        &turn,
                        &format!("{what}, {k} x {angle}"),
                    );
                }
            }
        }
    }
}

/// All is as it was before a turn, and has turned.
fn has_turned(interface: &Followed, before: &[PointHistory], turn: &Mat3, what: &str) {
    let largest = before.iter().fold(0.0_f64, |m, h| m.max(norm(h.shear)));
    let most = before.iter().fold(0.0_f64, |m, h| m.max(h.pressure));
    assert!(largest > 0.0 && most > 0.0, "{what}");
    let sticks = interface.laws.slip.as_dyn().sticks();
    let points = before.iter().zip(&interface.state.points);
    for ((a, b), e) in points.zip(&interface.cache.last.points) {
        assert!(norm(e.moved) < 1e-14, "{what}: {:e}", norm(e.moved));
        let apart = (a.pressure - b.pressure).abs();
        assert!(apart <= 1e-10 * most, "{what}: {apart:e} of {most:e}");
        let expected = match sticks {
            true => mat_vec(turn, a.shear),
            // shear is that of the velocity: at rest there is none
            false => [0.0; 3],
        };
        let apart = norm(sub(b.shear, expected));
        assert!(apart < 1e-10 * largest, "{what}: {apart:e} of {largest:e}");
        let slip = sub(b.slip, mat_vec(turn, a.slip));
        assert!(norm(slip) < 1e-12, "{what}: slip");
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
                let points = interface.points.iter().zip(&interface.state.points);
                let mut slid = 0;
                for ((p, h), e) in points.zip(&interface.cache.last.points) {
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
                    // Shear acts where the shoe is, and the drum moves past there.
                    if what.contains("mortar") {
                        let arc = norm(e.moved) / (SHOE * angle.abs());
                        assert!((arc - 1.0).abs() < 0.0025, "{what} {angle}: {arc}");
                    }
                }
                assert!(slid >= 3, "{what} {angle}");
            }
        }
    }
}

/// The balance of energies closes only if the slip that friction dissipates on is the one on which its forces do work: of bodies that turn and bend, each its own
/// way, a gap apart.
#[test]
fn shear_works_on_the_slip_that_friction_sees() {
    const STEP: f64 = 1e-7;
    for dim in [2, 3] {
        let smooth = |(what, _): &(String, Followed)| !what.starts_with("the paper");
        for (what, mut interface) in all(dim).into_iter().filter(smooth) {
            let origin = start(&interface);
            let still = accept(&mut interface, &origin, |_, x| x);
            let drum = interface.primary_nodes;
            let slid = |k: usize, x: Vec3, angle: f64| match k < drum {
                true => x,
                false => mat_vec(&rotation([0.0, 0.0, 1.0], angle), x),
            };
            let from = accept(&mut interface, &still, |k, x| slid(k, x, 1e-3));
            let jolt = |k: usize| {
                let phase = k as f64;
                let [a, b] = [(1.7 * phase).cos(), (2.3 * phase).sin()];
                [a, b, if dim == 3 { (0.9 * phase).cos() } else { 0.0 }]
            };
            let at = tried(&mut interface, &from, |k, x| {
                add(slid(k, x, 1e-3 + STEP), scale(0.3 * STEP, jolt(k)))
            });
            let mut sheared = 0;
            let last = &interface.cache.last;
            for (i, e) in last.points.iter().enumerate() {
                let [pressure, shear @ ..] = e.response.traction;
                let Some(tangent) = last.batch(i).tangent(e).filter(|_| pressure > 0.0) else {
                    continue;
                };
                let dofs = last.batch(i).dofs(e);
                let way: Vec<f64> = dofs.iter().map(|&d| at.u[d] - from.u[d]).collect();
                let along = |q: usize| {
                    crate::math::vector::dot(&tangent.rows[q * way.len()..][..way.len()], &way)
                };
                let work = shear[0] * along(1) + shear[1] * along(2);
                let slip = e.frames.before.map(|way| dot(way, e.moved));
                let dissipated = shear[0] * slip[0] + shear[1] * slip[1];
                let most = shear[0].hypot(shear[1]) * STEP;
                let open = (work - dissipated).abs();
                assert!(open < 1e-5 * most, "{what}: {open:e} of {most:e}");
                sheared += usize::from(most > 0.0);
            }
            assert!(sheared >= 3, "{what}");
        }
    }
}

/// Small sliding knows the directions of the reference alone, and says what is along them.
#[test]
fn small_sliding_carries_its_limit_in_the_plane_of_the_reference() {
    for mortar in [false, true] {
        let kinematics = KinematicsModel::SmallSliding(SmallSliding {});
        let mut interface = drum(3, kinematics, mortar, false, false, SlipModel::default());
        let origin = start(&interface);
        let drum = interface.primary_nodes;
        let (s, c) = 0.02_f64.sin_cos();
        accept(&mut interface, &origin, |k, x| match k < drum {
            true => [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]],
            false => x,
        });
        let slipping = (interface.state.points.iter()).filter(|h| h.status == Status::Slip);
        let mut slid = 0;
        for h in slipping {
            slid += 1;
            assert!((norm(h.shear) / (0.3 * h.pressure) - 1.0).abs() < 1e-12);
        }
        assert!(slid > 3);
    }
}
