//! Bodies, and bodies and obstacles, that no interface joins: they pass through each other, and nothing else would say so.

mod placed;

use std::collections::BTreeSet;

use placed::{Boundary, Overlap, Placed, TOUCHING_DISTANCE, boundaries, gap};

use super::finding::{DoctorCause, Finding};
use super::places::{body as body_at, bounds};
use super::record::note;
use super::suspect::{Severity, Suspect};
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::math::{Vec3, distance};
use crate::model::definition::{Model, Support};
use crate::model::scene::Scene;
use crate::number::figure;
use crate::system::Motion;
use crate::tolerance::SAME;

/// Points of an interface at which obstacles are compared, about.
const OBSTACLE_POINTS: usize = 20;

/// What a body is not joined to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Other {
    Body(usize),
    /// The obstacle of an interface, by its position.
    Obstacle(usize),
}

/// Two that no interface joins after some time.
#[derive(Debug, Clone)]
struct Pair {
    body: usize,
    other: Other,
    /// End of the last step in which something joins them.
    until: f64,
    /// By how much they overlap at the start of the analysis.
    start: Overlap,
    /// It has been said.
    said: bool,
}

/// All pairs that nothing joins.
#[derive(Debug, Clone, Default)]
pub(crate) struct MissingInterface {
    boundaries: Vec<Boundary>,
    pairs: Vec<Pair>,
}

impl MissingInterface {
    /// Pairs of a model, displaced by `u` at the start.
    pub fn new(scene: &Scene) -> Self {
        let model = scene.model;
        let u = &scene.displacements();
        let mut out = MissingInterface::default();
        let end = model.steps.last().map_or(0.0, |s| s.end);
        for body in 0..model.bodies.len() {
            let bodies = (0..body).map(Other::Body);
            let obstacles = (0..scene.contact.interfaces.len()).filter(|&i| first(scene, i));
            for other in bodies.chain(obstacles.map(Other::Obstacle)) {
                let until = until(scene, body, other);
                if until < end {
                    out.pairs.push(Pair {
                        body,
                        other,
                        until,
                        start: Overlap::default(),
                        said: false,
                    });
                }
            }
        }
        if out.pairs.is_empty() {
            return out;
        }
        out.boundaries = boundaries(model);
        let t = model.steps.first().map_or(0.0, |s| s.start);
        let place = Placed { scene, u, t };
        for i in 0..out.pairs.len() {
            out.pairs[i].start = out.overlap(&place, &out.pairs[i]);
        }
        out
    }

    fn overlap(&self, placed: &Placed, pair: &Pair) -> Overlap {
        let ours = &self.boundaries[pair.body];
        match pair.other {
            Other::Obstacle(i) => placed.behind(ours, &placed.scene.contact.interfaces[i]),
            Other::Body(other) => {
                let theirs = &self.boundaries[other];
                let one = placed.inside(ours, theirs);
                one.deeper(placed.inside(theirs, ours))
            }
        }
    }

    /// What the model shows before it runs.
    pub fn check(&self, scene: &Scene) -> Vec<Finding> {
        let model = scene.model;
        let u = &scene.displacements();
        let start = model.steps.first().map_or(0.0, |s| s.start);
        let mut out = Vec::new();
        for pair in self.pairs.iter().filter(|p| p.until < start) {
            let placed = Placed { scene, u, t: start };
            let names = names(scene, pair);
            let deep = pair.start.depth > TOUCHING_DISTANCE * pair.start.facet;
            let driven = model
                .steps
                .iter()
                .find_map(|s| self.driven(&placed, pair, s.end));
            let found = match (pair.other, driven) {
                (_, Some(driven)) => Some((
                    Severity::Warning,
                    format!("{names} come to overlap by {} by what supports and obstacles prescribe, and no interface joins them: they pass through each other", figure(driven.depth)),
                    driven.at,
                )),
                (Other::Body(_), _) if deep => Some((
                    Severity::Warning,
                    format!("{names} overlap by {} at the start, and no interface joins them: they pass through each other", figure(pair.start.depth)),
                    pair.start.at,
                )),
                // An obstacle may reach farther than it is meant to.
                _ => self.touching(&placed, pair).map(|at| {
                    let message = format!("{names} touch, and no interface joins them: if they move against each other they pass through each other");
                    (Severity::Note, message, at)
                }),
            };
            out.extend(found.map(|(severity, message, at)| {
                finding(scene, pair, severity, message).blame_at(at)
            }));
        }
        out
    }

    /// The overlap at `t` of bodies that supports move as wholes, where it is more than at the start.
    fn driven(&self, start: &Placed, pair: &Pair, t: f64) -> Option<Overlap> {
        let model = start.scene.model;
        let mut u = start.u.to_vec();
        let mut bodies = vec![pair.body];
        if let Other::Body(other) = pair.other {
            bodies.push(other);
        }
        let mut moved = 0.0_f64;
        for body in bodies {
            let by = prescribed(model, body, t)?;
            moved = moved.max(crate::math::norm(by));
            for p in model.bodies[body].points.clone() {
                for (c, v) in by.iter().enumerate().take(model.dofs.dim) {
                    u[model.dofs.of(p, c)] += v;
                }
            }
        }
        if let Other::Obstacle(i) = pair.other {
            moved = moved.max(start.scene.contact.interfaces[i].obstacle_way(start.t, t));
        }
        let placed = Placed {
            scene: start.scene,
            u: &u,
            t,
        };
        (moved > 0.0 && pair.was_apart())
            .then(|| self.overlap(&placed, pair))
            .filter(|found| worse(&placed, found, pair, moved))
    }

    /// A place where the two touch as they are meshed.
    fn touching(&self, placed: &Placed, pair: &Pair) -> Option<Vec3> {
        let ours = &self.boundaries[pair.body];
        match pair.other {
            Other::Body(other) => {
                let theirs = &self.boundaries[other];
                let found = placed.facing(ours, theirs);
                found.or_else(|| placed.facing(theirs, ours))
            }
            Other::Obstacle(i) => placed.standing(ours, &placed.scene.contact.interfaces[i]),
        }
    }

    /// Looks at the last accepted state: pairs that have come to overlap, once each.
    pub fn look(&mut self, scene: &Scene) -> Vec<Finding> {
        let model = scene.model;
        let (u, t) = (&scene.displacements(), scene.frame.state.t);
        let start = model.steps.first().map_or(0.0, |s| s.start);
        let mut out = Vec::new();
        for i in 0..self.pairs.len() {
            let pair = &self.pairs[i];
            if pair.said || t <= pair.until || !pair.was_apart() {
                continue;
            }
            let placed = Placed { scene, u, t };
            let found = self.overlap(&placed, pair);
            if found.depth <= pair.start.depth {
                continue;
            }
            let mut moved = spread(&placed, pair);
            if let Other::Obstacle(i) = pair.other {
                moved += scene.contact.interfaces[i].obstacle_way(start, t);
            }
            if worse(&placed, &found, pair, moved) {
                let message = format!(
                    "{} have come to overlap by {}, and no interface joins them: they pass through each other",
                    names(scene, pair),
                    figure(found.depth)
                );
                out.push(finding(scene, pair, Severity::Warning, message).blame_at(found.at));
                self.pairs[i].said = true;
            }
        }
        out
    }
}

impl Pair {
    /// Whether the two did not overlap at the start by more than facets of curved surfaces do.
    fn was_apart(&self) -> bool {
        self.start.depth <= TOUCHING_DISTANCE * self.start.facet
    }
}

/// Whether an interface is the first one with its obstacle.
fn first(scene: &Scene, i: usize) -> bool {
    let model = scene.model;
    let rigid = matches!(scene.contact.interfaces[i].primary, Primary::Rigid(..));
    rigid
        && (0..i).all(|k| {
            let other = &scene.contact.interfaces[k];
            let obstacle = matches!(other.primary, Primary::Rigid(..));
            !(obstacle && same(model, other, &scene.contact.interfaces[i]))
        })
}

/// Whether two interfaces have one obstacle. Each counts coordinates from a place of its own, so surfaces are compared where the points are.
fn same(model: &Model, a: &InterfaceDefinition, b: &InterfaceDefinition) -> bool {
    let rounding = SAME * model.size;
    let times = model.steps.iter().flat_map(|s| [s.start, s.end]);
    let asked: Vec<Vec3> = [a, b]
        .into_iter()
        .flat_map(|i| {
            let stride = i.points.len().div_ceil(OBSTACLE_POINTS).max(1);
            let points = i.points.iter().step_by(stride);
            points.map(|p| i.place(p))
        })
        .collect();
    let mut all = times.flat_map(|t| asked.iter().map(move |&x| (t, x)));
    all.all(|(t, x)| match (gap(a, x, t), gap(b, x, t)) {
        (Some(a), Some(b)) => (a.0 - b.0).abs() <= rounding,
        (None, None) => true,
        _ => false,
    })
}

/// End of the last step in which an interface or a coupling joins the two.
fn until(scene: &Scene, body: usize, other: Other) -> f64 {
    let model = scene.model;
    let mut last = f64::NEG_INFINITY;
    let mut acting = |schedule: &crate::system::Schedule| {
        let steps = model.steps.iter().filter(|s| schedule.active(s.end));
        last = steps.fold(last, |m, s| m.max(s.end));
    };
    for interface in &scene.contact.interfaces {
        let (primary, secondary) = interface.nodes.split_at(interface.primary_nodes);
        let (ours, theirs) = (owners(model, secondary), owners(model, primary));
        let joins = match other {
            Other::Body(b) => {
                ours.contains(&body) && theirs.contains(&b)
                    || ours.contains(&b) && theirs.contains(&body)
            }
            Other::Obstacle(i) => {
                let rigid = matches!(interface.primary, Primary::Rigid(..));
                rigid
                    && ours.contains(&body)
                    && same(model, interface, &scene.contact.interfaces[i])
            }
        };
        if joins {
            acting(&interface.schedule);
        }
    }
    let Other::Body(other) = other else {
        return last;
    };
    for coupling in scene.contact.couplings.all() {
        let points: Vec<usize> = (coupling.rows.iter())
            .flat_map(|r| &r.dofs)
            .map(|&dof| model.dofs.locate(dof).0)
            .collect();
        let joined = owners(model, &points);
        if joined.contains(&body) && joined.contains(&other) {
            acting(&coupling.schedule);
        }
    }
    last
}

/// The bodies of some points, hidden ones too.
fn owners(model: &Model, points: &[usize]) -> BTreeSet<usize> {
    let owner = |p: &usize| {
        model.bodies.iter().position(|b| {
            let hidden = b.rigid.map(|r| model.links.all()[r.link].hidden);
            b.points.contains(p) || hidden.is_some_and(|h| *p == h || *p == h + 1)
        })
    };
    points.iter().filter_map(owner).collect()
}

/// The displacement of a body as a whole by its supports at a time; `None` where they say different things of it, or turn it.
fn prescribed(model: &Model, body: usize, t: f64) -> Option<Vec3> {
    let body = &model.bodies[body];
    let motions = body
        .rigid
        .map(|r| model.links.all()[r.link].motions(model.dofs));
    let mut by: [Option<f64>; 3] = [None; 3];
    let acting = |s: &&Support| s.schedule.active(t);
    for support in model.actions.supports.iter().filter(acting) {
        for e in &support.entries {
            let value = match e.hold {
                true => 0.0,
                false => e.value * support.schedule.at(t),
            };
            let (point, component) = model.dofs.locate(e.dof);
            let whole = motions.iter().flatten().find(|m| m.0 == e.dof);
            let c = match whole {
                Some((_, Motion::Translation(c))) => *c,
                Some((_, Motion::Rotation(_))) if value != 0.0 => return None,
                Some(_) => continue,
                None if body.points.contains(&point) => component,
                None => continue,
            };
            if by[c].replace(value).is_some_and(|was| was != value) {
                return None;
            }
        }
    }
    Some(by.map(|v| v.unwrap_or(0.0)))
}

/// The two in words.
fn names(scene: &Scene, pair: &Pair) -> String {
    let model = scene.model;
    let body = &model.bodies[pair.body].name;
    match pair.other {
        Other::Body(other) => format!("bodies {} and {body}", model.bodies[other].name),
        Other::Obstacle(i) => format!(
            "body {body} and the obstacle of interface {}",
            scene.contact.interfaces[i].name
        ),
    }
}

fn finding(scene: &Scene, pair: &Pair, severity: Severity, message: String) -> Blamed {
    let model = scene.model;
    let body = &model.bodies[pair.body].name;
    let finding = Finding::new(DoctorCause::MissingInterface, severity, message);
    let (finding, primary) = match pair.other {
        Other::Body(other) => {
            let other = &model.bodies[other].name;
            (
                finding.blame(body_at(model, other, "")),
                format!("{other}.SURFACE"),
            )
        }
        Other::Obstacle(i) => {
            let name = &scene.contact.interfaces[i].name;
            (
                finding.blame(Suspect::interface(name, "its obstacle")),
                format!("the obstacle of {name}"),
            )
        }
    };
    Blamed(finding.advise(format!(
        "if they may meet, add `[interface.NAME]` with `secondary = \"{body}.SURFACE\"` and `primary = \"{primary}\"`, and list it where steps have `interfaces`; if they are one piece, set `tied = true` in it"
    )), body.clone())
}

/// A finding that lacks the body that overlaps.
struct Blamed(Finding, String);

impl Blamed {
    fn blame_at(self, at: Vec3) -> Finding {
        self.0.blame(Suspect::body(&self.1, "here").at(at))
    }
}

impl MissingInterface {
    /// Takes note of bodies that pass through others.
    pub fn judge(&mut self, scene: &Scene, findings: &mut Vec<Finding>) {
        for mut finding in self.look(scene) {
            let both: Vec<&str> = finding.suspects.iter().map(|g| g.name.as_str()).collect();
            let known = findings.iter().any(|f| {
                let same = |g: &Suspect| both.contains(&g.name.as_str());
                let warned = f.severity >= Severity::Warning;
                warned && f.cause == finding.cause && f.suspects.iter().all(same)
            });
            if known {
                continue;
            }
            finding.step = Some(scene.step_name().to_string());
            finding.time = Some(scene.frame.state.t);
            note(findings, finding);
        }
    }
}

/// Whether an overlap is more than at the start, and more than rounding, of two that have moved so far against each other.
fn worse(placed: &Placed, found: &Overlap, pair: &Pair, moved: f64) -> bool {
    // Two bodies have to overlap more than at the start by this part of their motion against each other.
    let least = (1e-3 * moved).max(SAME * placed.scene.model.size);
    found.depth - pair.start.depth > least
}

/// By how much displacements of the two differ `[m]`.
fn spread(placed: &Placed, pair: &Pair) -> f64 {
    let mut points = placed.scene.model.bodies[pair.body]
        .points
        .clone()
        .collect::<Vec<_>>();
    let mut moves: Vec<Vec3> = Vec::new();
    match pair.other {
        Other::Body(other) => points.extend(placed.scene.model.bodies[other].points.clone()),
        Other::Obstacle(_) => moves.push([0.0; 3]),
    }
    moves.extend(
        points
            .into_iter()
            .map(|p| placed.scene.model.dofs.vector(placed.u, p)),
    );
    let (low, high) = bounds(&moves);
    distance(low, high)
}
