//! Contact pairs and ties to interfaces, interactions to laws.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::contact::discretisation::{DiscretisationModel, NodeToFacet};
use stickslip::contact::enforcement::{EnforcementModel, Penalty};
use stickslip::contact::interface::{Change, Start};
use stickslip::contact::kinematics::{KinematicsModel, SmallSliding};
use stickslip::contact::law::damping::{DampingModel, Viscous};
use stickslip::contact::law::friction::{self, Coulomb, ExponentialDecay, FrictionModel};
use stickslip::contact::law::normal::{self, Exponential, Linear, NormalModel};
use stickslip::problem::{Interface, Roles};

use super::bodies::Bodies;
use super::job::Job;
use super::measure::measure;
use super::names::problem_name;
use super::sets::Sets;
use crate::card::Place;
use crate::deck::{
    Action, Adjust, Behavior, Deck, Friction, Interaction, Pair, Print, SurfaceParts, Target,
};

/// `(body, name of the set)` of each part of a surface.
fn parts(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    name: &str,
    primary: bool,
    place: Place,
) -> Vec<(usize, String)> {
    let Some(surface) = job.deck.surfaces.get(name) else {
        return Vec::new();
    };
    match &surface.parts {
        SurfaceParts::Nodes(_) if primary => {
            job.error(
                place,
                format!("the master surface {name} consists of nodes"),
                "a master surface consists of faces; exchange the surfaces, or use TYPE=ELEMENT",
            );
            Vec::new()
        }
        SurfaceParts::Nodes(nodes) => {
            let mut by: BTreeMap<usize, Vec<u64>> = BTreeMap::new();
            for n in nodes {
                match bodies.of_node.get(n) {
                    Some(b) => by.entry(*b).or_default().push(*n),
                    None => job.error(
                        surface.place,
                        format!(
                            "node {} of the surface {name} belongs to no body",
                            job.deck.label(*n)
                        ),
                        "",
                    ),
                }
            }
            by.into_iter()
                .map(|(b, list)| (b, sets.points(bodies, &problem_name(name), &list)))
                .collect()
        }
        faces => {
            let by = bodies.faces(faces);
            sets.facets(bodies, &problem_name(name), &by)
        }
    }
}

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let deck = job.deck;
    clearances(job);
    for pair in &deck.contact.pairs {
        if pair.slave == pair.master {
            job.error(
                pair.place,
                "self-contact is not computed",
                "split the surface in two that may touch",
            );
            continue;
        }
        let secondary = parts(job, bodies, sets, &pair.slave, false, pair.place);
        let primary = parts(job, bodies, sets, &pair.master, true, pair.place);
        let single = secondary.len() * primary.len() == 1;
        for (s, from) in &secondary {
            for (p, to) in &primary {
                if s == p && !single && meet(job, bodies, &pair.slave, &pair.master, *s, pair.place)
                {
                    continue;
                }
                let wanted = match single {
                    true => format!("{}-{}", pair.slave, pair.master),
                    false => format!(
                        "{}-{}-{}-{}",
                        pair.slave, bodies.all[*s].name, pair.master, bodies.all[*p].name
                    ),
                };
                for (interaction, steps) in phases(job, pair) {
                    let name = job.fresh::<Interface>(&problem_name(&wanted));
                    let mut interface = between(from, to);
                    match interaction.behavior {
                        Some(Behavior::Tied(k)) => tie(job, &mut interface, pair, &interaction, k),
                        _ => touch(job, bodies, sets, &mut interface, pair, &interaction),
                    }
                    job.add(&name, pair.place, interface);
                    let present = present(deck, pair);
                    let acts = present.iter().zip(&steps).map(|(a, b)| *a && *b);
                    job.acts::<Interface>(name.clone(), acts.collect());
                    job.pairs
                        .push((name, pair.slave.clone(), pair.master.clone()));
                }
            }
        }
    }
    ties(job, bodies, sets);
    changes(job);
}

/// The steps in which a pair acts: in all until `*MODEL CHANGE` says otherwise.
fn present(deck: &Deck, pair: &Pair) -> Vec<bool> {
    let mut on = true;
    let steps = deck.steps.iter().map(|step| {
        for action in &step.actions {
            match action {
                Action::ChangePair {
                    slave, master, add, ..
                } if *slave == pair.slave && *master == pair.master => on = *add,
                _ => {}
            }
        }
        on
    });
    steps.collect()
}

/// Clearances are of contact pairs.
fn clearances(job: &mut Job) {
    let deck = job.deck;
    for c in &deck.contact.clearances {
        let known = deck
            .contact
            .pairs
            .iter()
            .any(|p| p.slave == c.slave && p.master == c.master);
        if !known {
            job.error(
                c.place,
                format!(
                    "no contact pair has the surfaces {} and {}",
                    c.slave, c.master
                ),
                "*CLEARANCE names the surfaces of a *CONTACT PAIR",
            );
        }
    }
}

/// The interfaces of ties.
fn ties(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let deck = job.deck;
    for tie in &deck.connectors.ties {
        let secondary = parts(job, bodies, sets, &tie.slave, false, tie.place);
        let primary = parts(job, bodies, sets, &tie.master, true, tie.place);
        for (s, from) in &secondary {
            for (p, to) in &primary {
                if s == p && meet(job, bodies, &tie.slave, &tie.master, *s, tie.place) {
                    continue;
                }
                let name = job.fresh::<Interface>(&problem_name(&tie.name));
                let usual = || TIE_TOLERANCE * face_size(job, bodies, &tie.master);
                let mut interface = between(from, to);
                interface.tied = true;
                interface.kinematics = small_sliding();
                if of_nodes(deck, &tie.slave) {
                    interface.discretisation = Some(by_points());
                }
                if tie.adjust {
                    interface.initial = Start::Snap;
                }
                interface.initial_distance = Some(tie.tolerance.unwrap_or_else(usual));
                job.add(name, tie.place, interface);
            }
        }
    }
}

/// `POSITION TOLERANCE` of a `*TIE` that has none, relative to the size of the faces of the master (CalculiX CrunchiX manual, *Keywords in CalculiX,
/// \*TIE*).
const TIE_TOLERANCE: f64 = 0.025;

/// A typical size of the faces of a surface.
fn face_size(job: &Job, bodies: &Bodies, surface: &str) -> f64 {
    let Some(surface) = job.deck.surfaces.get(surface) else {
        return 0.0;
    };
    let facets: Vec<_> = bodies
        .faces(&surface.parts)
        .into_values()
        .flatten()
        .collect();
    let (_, area) = measure(bodies, &facets);
    let mean = area / facets.len().max(1) as f64;
    if bodies.dim() == 3 { mean.sqrt() } else { mean }
}

/// Whether a surface consists of nodes: as a slave it is met by points.
fn of_nodes(deck: &Deck, surface: &str) -> bool {
    let surface = deck.surfaces.get(surface);
    surface.is_some_and(|s| matches!(s.parts, SurfaceParts::Nodes(_)))
}

fn between(secondary: &str, primary: &str) -> Interface {
    Interface {
        secondary: secondary.into(),
        primary: primary.into(),
        ..Interface::default()
    }
}

fn by_points() -> DiscretisationModel {
    DiscretisationModel::NodeToFacet(NodeToFacet {})
}

fn small_sliding() -> KinematicsModel {
    KinematicsModel::SmallSliding(SmallSliding {})
}

/// The nodes of a surface.
pub(super) fn surface_nodes(deck: &Deck, bodies: &Bodies, name: &str) -> BTreeSet<u64> {
    let Some(surface) = deck.surfaces.get(name) else {
        return BTreeSet::new();
    };
    if let SurfaceParts::Nodes(nodes) = &surface.parts {
        return nodes.iter().copied().collect();
    }
    let facets: Vec<_> = (bodies.faces(&surface.parts).into_values())
        .flatten()
        .collect();
    let mesh = bodies.mesh();
    let points = mesh.points_of_facets(&facets);
    points.into_iter().map(|p| mesh.point_ids[p]).collect()
}

/// Whether the parts of two surfaces that belong to one body have nodes in common, where nothing can be tied or touch; it is an error if so.
fn meet(
    job: &mut Job,
    bodies: &Bodies,
    slave: &str,
    master: &str,
    body: usize,
    place: Place,
) -> bool {
    let nodes = |name: &str| {
        let mut nodes = surface_nodes(job.deck, bodies, name);
        nodes.retain(|n| bodies.of_node.get(n) == Some(&body));
        nodes
    };
    let (ours, theirs) = (nodes(slave), nodes(master));
    let Some(first) = ours.intersection(&theirs).next() else {
        return false;
    };
    let count = ours.intersection(&theirs).count();
    let first = job.deck.label(*first);
    job.error(
        place,
        format!(
            "the surfaces {slave} and {master} have {count} nodes in common, such as node {first}"
        ),
        "leave the faces at these nodes out of one of the two",
    );
    true
}

/// What an interface is by its pair and interaction.
fn touch(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    interface: &mut Interface,
    pair: &Pair,
    interaction: &Interaction,
) {
    let deck = job.deck;
    let by_nodes = of_nodes(deck, &pair.slave);
    interface.normal = normal(interaction.behavior.as_ref(), pair.by_nodes).unwrap_or_default();
    if compliant(interaction) && by_nodes {
        job.warn(
            pair.place,
            format!(
                "the nodes of {} have the areas of the faces between them; CalculiX adds those of all other faces at them, Abaqus gives each an area of 1",
                pair.slave
            ),
            "where pressure depends on overclosure forces depend on it: name faces as the slave surface (TYPE=ELEMENT)",
        );
    }
    if let Some(f) = &interaction.friction {
        interface.friction = friction(f);
    }
    if let Some(stick) = stick(job, interaction) {
        interface.enforcement = penalty(None, stick);
    }
    if let Some([coefficient, _]) = interaction.damping
        && coefficient > 0.0
    {
        interface.damping = DampingModel::Viscous(Viscous { coefficient });
    }
    if printed_by_node(deck) {
        // What is printed are the nodes of the slave, whichever side has the smaller cells.
        interface.roles = Roles::AsNamed;
    }
    // CalculiX integrates penalty springs over the faces; on quadratic ones that is what the points of the faces do here.
    let quadratic = compliant(interaction) && curved(job, pair);
    if by_nodes || pair.by_nodes || quadratic {
        interface.discretisation = Some(by_points());
    }
    if pair.small_sliding {
        interface.kinematics = small_sliding();
    }
    let clearance = deck
        .contact
        .clearances
        .iter()
        .find(|c| c.slave == pair.slave && c.master == pair.master);
    if let Some(clearance) = clearance {
        // Whatever gap the meshes have counts as this.
        interface.initial = Start::Offset;
        interface.initial_tolerance = Some(1e3);
        interface.initial_gap = Some(clearance.value).filter(|v| *v != 0.0);
    } else if let Some(how) = &pair.adjust {
        adjust(job, bodies, sets, interface, pair, how);
    } else if !pair.by_nodes && begins_at_rest(deck, pair) {
        // As CalculiX does where faces meet faces: overlap goes away over the step.
        interface.initial = Start::Ramp;
    }
}

/// Whether the first step in which a pair acts is a static one.
fn begins_at_rest(deck: &Deck, pair: &Pair) -> bool {
    let first = present(deck, pair).iter().position(|on| *on);
    first.is_some_and(|i| !deck.steps[i].is_dynamic())
}

/// `PRESSURE-OVERCLOSURE=TIED`: glue, or springs in all directions if it has a stiffness. CalculiX takes that against sliding from the stick slope.
fn tie(
    job: &mut Job,
    interface: &mut Interface,
    pair: &Pair,
    interaction: &Interaction,
    stiffness: Option<f64>,
) {
    interface.tied = true;
    if of_nodes(job.deck, &pair.slave) {
        interface.discretisation = Some(by_points());
    }
    // Springs act between the places that lie opposite at the start, however far they are stretched.
    if pair.small_sliding || stiffness.is_some() {
        interface.kinematics = small_sliding();
    }
    if pair.by_nodes {
        job.error(
            pair.place,
            "PRESSURE-OVERCLOSURE=TIED is for pairs of faces",
            "write TYPE=SURFACE TO SURFACE, or *TIE",
        );
    }
    let Some(stiffness) = stiffness else { return };
    match interaction.friction.as_ref().and_then(|f| f.stick) {
        Some(stick) => interface.enforcement = penalty(Some(stiffness), stick),
        None => job.error(
            interaction.place,
            "an interaction that is TIED by a stiffness has none against sliding",
            "write *FRICTION with a coefficient and the stick slope beneath, as CalculiX wants it; or use *TIE, which is exact",
        ),
    }
}

/// Springs of the deck's own.
fn penalty(stiffness: Option<f64>, stick: f64) -> EnforcementModel {
    EnforcementModel::Penalty(Penalty {
        factor: None,
        stiffness,
        tangential_factor: None,
        tangential_stiffness: Some(stick),
    })
}

/// `ADJUST`: nodes of the slave surface that are moved onto the master.
fn adjust(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    interface: &mut Interface,
    pair: &Pair,
    adjust: &Adjust,
) {
    interface.initial = Start::Snap;
    match adjust {
        Adjust::Within(distance) => interface.initial_distance = Some(*distance),
        Adjust::Set(name) => {
            // However far: nothing in the model is farther than this.
            let x = &bodies.mesh().points;
            let far = x.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()));
            interface.initial_distance = Some(4.0 * far);
            let nodes = job.nodes(&Target::Set(name.clone()));
            if !nodes.iter().any(|n| bodies.of_node.contains_key(n)) {
                let message = format!("no node of the set {name} is part of a body");
                job.error(
                    pair.place,
                    message,
                    "ADJUST names nodes of the slave surface",
                );
                return;
            }
            interface.initial_set = Some(sets.points(bodies, &problem_name(name), &nodes));
        }
    }
}

/// Whether `*CONTACT PRINT` asks for values at the nodes of slaves.
fn printed_by_node(deck: &Deck) -> bool {
    let nodal = |print: &Print| match print {
        Print::Contact { keys, .. } => keys
            .iter()
            .any(|k| k.starts_with("CDIS") || k.starts_with("CSTR")),
        _ => false,
    };
    deck.steps.iter().any(|s| s.prints.iter().any(nodal))
}

/// Whether the law is a spring.
pub(super) fn compliant(interaction: &Interaction) -> bool {
    matches!(
        interaction.behavior,
        Some(Behavior::Linear { .. } | Behavior::Exponential { .. } | Behavior::Tabular(_))
    )
}

/// Whether the slave surface has quadratic faces of solid elements.
fn curved(job: &Job, pair: &Pair) -> bool {
    let deck = job.deck;
    let Some(SurfaceParts::Faces(faces)) = deck.surfaces.get(&pair.slave).map(|s| &s.parts) else {
        return false;
    };
    let nodes = |e: &u64| deck.elements.get(e).map_or(0, |e| e.nodes.len());
    let solid = |e: &u64| {
        deck.elements
            .get(e)
            .is_some_and(|e| e.kind.starts_with("C3D"))
    };
    faces.iter().any(|(e, _)| solid(e) && nodes(e) >= 10)
}

/// The normal law; `None` is the one that is exact.
fn normal(behavior: Option<&Behavior>, by_nodes: bool) -> Option<NormalModel> {
    let tabular = |table| NormalModel::Tabular(normal::Tabular { table });
    match behavior? {
        Behavior::Hard | Behavior::Tied(_) => None,
        Behavior::Linear { slope, tension } if by_nodes && *tension > 0.0 => {
            Some(tabular(smooth(*slope, *tension)))
        }
        Behavior::Linear { slope: c, .. } => Some(NormalModel::Linear(Linear { c: *c })),
        &Behavior::Exponential { c0, p0 } => Some(NormalModel::Exponential(Exponential { c0, p0 })),
        Behavior::Tabular(rows) => {
            // Pressure begins where the table last has none.
            let from = rows.iter().rposition(|r| r[1] <= 0.0).unwrap_or(0);
            let mut rows: Vec<[f64; 2]> = rows[from..].to_vec();
            if rows[0][1] > 0.0 {
                rows[0][1] = 0.0;
            }
            Some(tabular(rows))
        }
    }
}

/// CalculiX's linear law between nodes and faces, `p = K d (1/2 + atan(d / ε) / π)` with `ε = π σ∞ / K` (CalculiX CrunchiX manual,
/// *Node-to-face penalty contact*), as a table. Its tension at positive gaps is left out.
fn smooth(slope: f64, tension: f64) -> Vec<[f64; 2]> {
    let width = std::f64::consts::PI * tension / slope;
    let law = |d: f64| slope * d * (0.5 + (d / width).atan() / std::f64::consts::PI);
    let mut rows = vec![[0.0, 0.0]];
    let mut at = 0.1;
    while at < 2e3 {
        rows.push([at * width, law(at * width)]);
        at *= 1.25;
    }
    rows
}

/// Coefficients over pressure and slip rate, as a table of one row a pressure. The rows of the deck fill it, which its reader has seen to.
fn coefficients(rows: &[[f64; 3]]) -> friction::Tabular {
    let list = |k: usize| {
        let mut all: Vec<f64> = rows.iter().map(|r| r[k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (speeds, pressures) = (list(1), list(2));
    let at = |p: f64, v: f64| {
        rows.iter()
            .find(|r| r[1] == v && r[2] == p)
            .map_or(0.0, |r| r[0])
    };
    let row = |p: &f64| speeds.iter().map(|v| at(*p, *v)).collect();
    let mu = pressures.iter().map(row).collect();
    let several = |list: Vec<f64>| Some(list).filter(|l| l.len() > 1);
    friction::Tabular {
        mu,
        pressures: several(pressures),
        speeds: several(speeds),
    }
}

fn friction(f: &Friction) -> FrictionModel {
    if !f.table.is_empty() {
        return FrictionModel::Tabular(coefficients(&f.table));
    }
    let cap = f.cap;
    match (f.rough, f.decay) {
        // High enough for any face that is pressed at all.
        (true, _) => FrictionModel::Coulomb(Coulomb {
            mu: 1000.0,
            cap: None,
        }),
        (_, Some([kinetic, decay])) => FrictionModel::ExponentialDecay(ExponentialDecay {
            r#static: f.mu,
            kinetic,
            decay,
            cap,
        }),
        _ => FrictionModel::Coulomb(Coulomb { mu: f.mu, cap }),
    }
}

/// The stiffness of sticking is taken where contact is a spring as well; hard contact is exact, and so is stick then.
fn stick(job: &mut Job, interaction: &Interaction) -> Option<f64> {
    let stick = interaction.friction.as_ref()?.stick?;
    if !compliant(interaction) {
        job.note(
            interaction.place,
            "the stick slope is left out: sticking is exact with hard contact",
        );
        return None;
    }
    Some(stick)
}

/// The interaction of a name in each step, with the place of what changed it there.
fn courses(deck: &Deck, name: &str) -> Vec<(Interaction, Option<Place>)> {
    let Some(mut now) = deck.contact.interactions.get(name).cloned() else {
        return Vec::new();
    };
    let steps = deck.steps.iter().map(|step| {
        let mut changed = None;
        for action in &step.actions {
            match action {
                Action::ChangeFriction(n, f, place) if n == name => {
                    now.friction = Some(f.clone());
                    changed = Some(*place);
                }
                Action::ChangeBehavior(n, b, place) if n == name => {
                    now.behavior = Some(b.clone());
                    changed = Some(*place);
                }
                _ => {}
            }
        }
        (now.clone(), changed)
    });
    steps.collect()
}

/// Whether surfaces are tied by springs of the deck's own.
pub(super) fn ties_by_springs(deck: &Deck) -> bool {
    let mut used = deck
        .contact
        .pairs
        .iter()
        .filter_map(|p| deck.contact.interactions.get(&p.interaction));
    used.any(|i| matches!(i.behavior, Some(Behavior::Tied(Some(_)))))
}

fn is_tied(interaction: &Interaction) -> bool {
    matches!(interaction.behavior, Some(Behavior::Tied(_)))
}

/// What a pair is over the steps: as it begins, and, if it is tied at first, what it is once it comes apart; each with the steps of it.
fn phases(job: &Job, pair: &Pair) -> Vec<(Interaction, Vec<bool>)> {
    let Some(first) = job.deck.contact.interactions.get(&pair.interaction) else {
        return Vec::new();
    };
    let course = courses(job.deck, &pair.interaction);
    let apart = course.iter().position(|(i, _)| !is_tied(i));
    match (is_tied(first), apart) {
        // Changed before it ever acted.
        (true, Some(0)) => vec![(course[0].0.clone(), vec![true; course.len()])],
        (true, Some(at)) => {
            let later: Vec<bool> = (0..course.len()).map(|i| i >= at).collect();
            let before = later.iter().map(|l| !l).collect();
            vec![(first.clone(), before), (course[at].0.clone(), later)]
        }
        _ => vec![(first.clone(), vec![true; course.len()])],
    }
}

fn changes(job: &mut Job) {
    let deck = job.deck;
    let used: BTreeSet<&String> = deck.contact.pairs.iter().map(|p| &p.interaction).collect();
    for name in used {
        let Some(mut before) = deck.contact.interactions.get(name).cloned() else {
            continue;
        };
        for (step, (after, changed)) in courses(deck, name).into_iter().enumerate() {
            let Some(place) = changed else { continue };
            match (is_tied(&before), is_tied(&after)) {
                (false, false) => change(job, step, name, place, &before, &after),
                // It has an interface of its own from here on.
                (true, false) => {}
                (true, true) if before == after => {}
                _ => job.error(
                    place,
                    format!("the interaction {name} becomes TIED, or tied otherwise, in a later step"),
                    "surfaces are tied from the first step on, and can come apart in a later one: use LINEAR with a high stiffness and *CHANGE FRICTION",
                ),
            }
            before = after;
        }
    }
}

/// One change of an interaction: `(step, interaction, place)`, before and after.
fn change(
    job: &mut Job,
    step: usize,
    name: &str,
    place: Place,
    before: &Interaction,
    after: &Interaction,
) {
    let stick = |i: &Interaction| i.friction.as_ref().and_then(|f| f.stick);
    if compliant(before) && stick(before) != stick(after) {
        job.error(
            place,
            "the stick slope cannot change from step to step",
            "give the one of the *FRICTION beneath *SURFACE INTERACTION",
        );
    }
    let pairs = job
        .deck
        .contact
        .pairs
        .iter()
        .filter(|p| p.interaction == *name);
    for pair in pairs.collect::<Vec<_>>() {
        let mut change = Change::default();
        if before.friction != after.friction {
            change.friction = after.friction.as_ref().map(friction);
        }
        if before.behavior != after.behavior {
            change.normal = normal(after.behavior.as_ref(), pair.by_nodes);
            if change.normal.is_none() {
                job.error(
                    place,
                    "an interface cannot become hard in a later step",
                    "use LINEAR, EXPONENTIAL or TABULAR",
                );
                return;
            }
        }
        if change == Change::default() {
            continue;
        }
        let of_pair = |(_, s, m): &&(String, String, String)| *s == pair.slave && *m == pair.master;
        let changed = job.pairs.iter().filter(of_pair);
        let changed = changed.map(|(name, ..)| (name.clone(), change.clone()));
        job.problem.step[step].change.extend(changed);
    }
}
