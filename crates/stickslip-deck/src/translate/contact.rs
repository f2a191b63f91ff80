//! Contact pairs and ties to interfaces, interactions to laws.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::Bodies;
use super::job::Job;
use super::measure::measure;
use super::sets::Sets;
use super::toml;
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
                .map(|(b, list)| (b, sets.points(bodies, &toml::name(name), &list)))
                .collect()
        }
        faces => {
            let by = bodies.faces(faces);
            sets.facets(bodies, &toml::name(name), &by)
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
                    let name = job.fresh("interface", &toml::name(&wanted));
                    interface(job, bodies, sets, &name, pair, &interaction, [from, to]);
                    let present = present(deck, pair);
                    let acts = present.iter().zip(&steps).map(|(a, b)| *a && *b);
                    job.active
                        .push(("interfaces", name.clone(), acts.collect()));
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
                let name = job.fresh("interface", &toml::name(&tie.name));
                job.table("interface", &name, tie.place);
                job.out.line(&format!("secondary = {}", toml::text(from)));
                job.out.line(&format!("primary = {}", toml::text(to)));
                job.out.line("tied = true");
                job.out.line("kinematics.small-sliding = {}");
                by_points(job, &tie.slave);
                if tie.adjust {
                    job.out.line("initial = \"snap\"");
                }
                let distance = tie
                    .tolerance
                    .unwrap_or_else(|| TOLERANCE * face_size(job, bodies, &tie.master));
                job.out
                    .line(&format!("initial-distance = {}", toml::number(distance)));
            }
        }
    }
}

/// `POSITION TOLERANCE` of a `*TIE` that has none, relative to the size of the faces of the master (CalculiX CrunchiX manual, *Keywords in CalculiX,
/// \*TIE*).
const TOLERANCE: f64 = 0.025;

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

/// A slave surface of nodes is met by points.
fn by_points(job: &mut Job, surface: &str) -> bool {
    let surface = job.deck.surfaces.get(surface);
    let nodes = surface.is_some_and(|s| matches!(s.parts, SurfaceParts::Nodes(_)));
    if nodes {
        job.out.line("discretisation.node-to-facet = {}");
    }
    nodes
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

fn interface(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    name: &str,
    pair: &Pair,
    interaction: &Interaction,
    [from, to]: [&str; 2],
) {
    let deck = job.deck;
    job.table("interface", name, pair.place);
    job.out.line(&format!("secondary = {}", toml::text(from)));
    job.out.line(&format!("primary = {}", toml::text(to)));
    if let Some(Behavior::Tied(stiffness)) = &interaction.behavior {
        tied(job, pair, interaction, *stiffness);
        return;
    }
    if let Some(line) = normal(interaction.behavior.as_ref(), pair.by_nodes) {
        job.out.line(&line);
    }
    let nodes = deck.surfaces.get(&pair.slave);
    if compliant(interaction) && nodes.is_some_and(|s| matches!(s.parts, SurfaceParts::Nodes(_))) {
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
        job.out.line(&friction(f));
    }
    enforcement(job, interaction);
    if let Some([d, _]) = interaction.damping
        && d > 0.0
    {
        job.out.line(&format!(
            "damping.viscous = {{ coefficient = {} }}",
            toml::number(d)
        ));
    }
    if printed_by_node(deck) {
        // What is printed are the nodes of the slave, whichever side has the smaller cells.
        job.out.line("roles = \"as-named\"");
    }
    // CalculiX integrates penalty springs over the faces; on quadratic ones that is what the points of the faces do here.
    let quadratic = compliant(interaction) && curved(job, pair);
    if !by_points(job, &pair.slave) && (pair.by_nodes || quadratic) {
        job.out.line("discretisation.node-to-facet = {}");
    }
    if pair.small_sliding {
        job.out.line("kinematics.small-sliding = {}");
    }
    let clearance = deck
        .contact
        .clearances
        .iter()
        .find(|c| c.slave == pair.slave && c.master == pair.master);
    if let Some(clearance) = clearance {
        // Whatever gap the meshes have counts as this.
        job.out.line("initial = \"offset\"");
        job.out.line("initial-tolerance = 1e3");
        if clearance.value != 0.0 {
            job.out
                .line(&format!("initial-gap = {}", toml::number(clearance.value)));
        }
    } else if pair.adjust.is_some() {
        adjust(job, bodies, sets, pair);
    } else if !pair.by_nodes && begins_at_rest(deck, pair) {
        // As CalculiX does where faces meet faces: overlap goes away over the step.
        job.out.line("initial = \"ramp\"");
    }
}

/// Whether the first step in which a pair acts is a static one.
fn begins_at_rest(deck: &Deck, pair: &Pair) -> bool {
    let first = present(deck, pair).iter().position(|on| *on);
    first.is_some_and(|i| !deck.steps[i].is_dynamic())
}

/// `PRESSURE-OVERCLOSURE=TIED`: glue, or springs in all directions if it has a stiffness. CalculiX takes that against sliding from the stick slope.
fn tied(job: &mut Job, pair: &Pair, interaction: &Interaction, stiffness: Option<f64>) {
    job.out.line("tied = true");
    by_points(job, &pair.slave);
    // Springs act between the places that lie opposite at the start, however far they are stretched.
    if pair.small_sliding || stiffness.is_some() {
        job.out.line("kinematics.small-sliding = {}");
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
        Some(stick) => job.out.line(&format!(
            "enforcement.penalty = {{ stiffness = {}, tangential-stiffness = {} }}",
            toml::number(stiffness),
            toml::number(stick)
        )),
        None => job.error(
            interaction.place,
            "an interaction that is TIED by a stiffness has none against sliding",
            "write *FRICTION with a coefficient and the stick slope beneath, as CalculiX wants it; or use *TIE, which is exact",
        ),
    }
}

/// `ADJUST`: nodes of the slave surface that are moved onto the master.
fn adjust(job: &mut Job, bodies: &Bodies, sets: &mut Sets, pair: &Pair) {
    let Some(adjust) = &pair.adjust else { return };
    job.out.line("initial = \"snap\"");
    match adjust {
        Adjust::Within(distance) => job
            .out
            .line(&format!("initial-distance = {}", toml::number(*distance))),
        Adjust::Set(name) => {
            // However far: nothing in the model is farther than this.
            let x = &bodies.mesh().points;
            let far = x.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()));
            job.out
                .line(&format!("initial-distance = {}", toml::number(4.0 * far)));
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
            let set = sets.points(bodies, &toml::name(name), &nodes);
            job.out.line(&format!("initial-set = {}", toml::text(&set)));
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

/// The line of the normal law; `None` is the default, which is exact.
fn normal(behavior: Option<&Behavior>, by_nodes: bool) -> Option<String> {
    match behavior? {
        Behavior::Hard | Behavior::Tied(_) => None,
        Behavior::Linear { slope, tension } if by_nodes && *tension > 0.0 => {
            let rows: Vec<String> = smooth(*slope, *tension)
                .iter()
                .map(|r| toml::numbers(r))
                .collect();
            Some(format!(
                "normal.tabular = {{ table = [{}] }}",
                rows.join(", ")
            ))
        }
        Behavior::Linear { slope, .. } => Some(format!(
            "normal.linear = {{ c = {} }}",
            toml::number(*slope)
        )),
        Behavior::Exponential { c0, p0 } => Some(format!(
            "normal.exponential = {{ c0 = {}, p0 = {} }}",
            toml::number(*c0),
            toml::number(*p0)
        )),
        Behavior::Tabular(rows) => {
            // Pressure begins where the table last has none.
            let from = rows.iter().rposition(|r| r[1] <= 0.0).unwrap_or(0);
            let mut rows: Vec<[f64; 2]> = rows[from..].to_vec();
            if rows[0][1] > 0.0 {
                rows[0][1] = 0.0;
            }
            let rows: Vec<String> = rows.iter().map(|r| toml::numbers(r)).collect();
            Some(format!(
                "normal.tabular = {{ table = [{}] }}",
                rows.join(", ")
            ))
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
fn coefficients(rows: &[[f64; 3]]) -> String {
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
    let table: Vec<String> = pressures
        .iter()
        .map(|p| toml::numbers(&speeds.iter().map(|v| at(*p, *v)).collect::<Vec<_>>()))
        .collect();
    let mut keys = Vec::new();
    for (key, list) in [("pressures", &pressures), ("speeds", &speeds)] {
        if list.len() > 1 {
            keys.push(format!("{key} = {}", toml::numbers(list)));
        }
    }
    keys.push(format!("mu = [{}]", table.join(", ")));
    format!("friction.tabular = {{ {} }}", keys.join(", "))
}

fn friction(f: &Friction) -> String {
    if !f.table.is_empty() {
        return coefficients(&f.table);
    }
    let cap = match f.cap {
        Some(cap) => format!(", cap = {}", toml::number(cap)),
        None => String::new(),
    };
    match (f.rough, f.decay) {
        // High enough for any face that is pressed at all.
        (true, _) => "friction.coulomb = { mu = 1000.0 }".into(),
        (_, Some([kinetic, decay])) => format!(
            "friction.exponential-decay = {{ static = {}, kinetic = {}, decay = {}{cap} }}",
            toml::number(f.mu),
            toml::number(kinetic),
            toml::number(decay)
        ),
        _ => format!("friction.coulomb = {{ mu = {}{cap} }}", toml::number(f.mu)),
    }
}

/// The stiffness of sticking is taken where contact is a spring as well; hard contact is exact, and so is stick then.
fn enforcement(job: &mut Job, interaction: &Interaction) {
    let compliant = compliant(interaction);
    match interaction.friction.as_ref().and_then(|f| f.stick) {
        Some(stick) if compliant => job.out.line(&format!(
            "enforcement.penalty = {{ tangential-stiffness = {} }}",
            toml::number(stick)
        )),
        Some(_) => job.note(
            interaction.place,
            "the stick slope is left out: sticking is exact with hard contact",
        ),
        None => {}
    }
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
        let mut lines = Vec::new();
        if before.friction != after.friction {
            lines.extend(after.friction.as_ref().map(friction));
        }
        if before.behavior != after.behavior {
            let Some(line) = normal(after.behavior.as_ref(), pair.by_nodes) else {
                job.error(
                    place,
                    "an interface cannot become hard in a later step",
                    "use LINEAR, EXPONENTIAL or TABULAR",
                );
                return;
            };
            lines.push(line);
        }
        let interfaces = job
            .pairs
            .iter()
            .filter(|(_, s, m)| *s == pair.slave && *m == pair.master);
        let interfaces: Vec<String> = interfaces.map(|(n, ..)| n.clone()).collect();
        for (i, line) in interfaces
            .iter()
            .flat_map(|i| lines.iter().map(move |l| (i, l)))
        {
            job.changes.push((step, i.clone(), line.clone()));
        }
    }
}
