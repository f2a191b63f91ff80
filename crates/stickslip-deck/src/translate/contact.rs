//! Contact pairs and ties to interfaces, interactions to laws.

use std::collections::BTreeMap;

use super::bodies::Bodies;
use super::sets::Sets;
use super::{Job, toml};
use crate::deck::{Action, Behavior, Friction, Interaction, Pair, SurfaceParts};
use crate::source::Place;

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
                        format!("node {n} of the surface {name} belongs to no body"),
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
    for c in &deck.clearances {
        let known = deck
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
        } else if c.value != 0.0 {
            job.error(
                c.place,
                "clearances other than 0 are not supported",
                "move the body by the clearance, or let the meshes have it",
            );
        }
    }
    for pair in &deck.pairs {
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
                if s == p && !single {
                    continue;
                }
                let wanted = match single {
                    true => format!("{}-{}", pair.slave, pair.master),
                    false => format!(
                        "{}-{}-{}-{}",
                        pair.slave, bodies.all[*s].name, pair.master, bodies.all[*p].name
                    ),
                };
                let name = job.fresh("interface", &toml::name(&wanted));
                interface(job, &name, pair, (from, to));
                job.pairs
                    .push((name, pair.slave.clone(), pair.master.clone()));
            }
        }
    }
    for tie in &deck.ties {
        let secondary = parts(job, bodies, sets, &tie.slave, false, tie.place);
        let primary = parts(job, bodies, sets, &tie.master, true, tie.place);
        for (s, from) in &secondary {
            for (p, to) in &primary {
                if s == p {
                    continue;
                }
                let name = job.fresh("interface", &toml::name(&tie.name));
                job.table("interface", &name, tie.place);
                job.out.line(&format!("secondary = {}", toml::text(from)));
                job.out.line(&format!("primary = {}", toml::text(to)));
                job.out.line("tied = true");
                job.out.line("kinematics.small-sliding = {}");
            }
        }
    }
    changes(job);
}

fn interface(job: &mut Job, name: &str, pair: &Pair, (from, to): (&str, &str)) {
    let deck = job.deck;
    let Some(interaction) = deck.interactions.get(&pair.interaction) else {
        return;
    };
    job.table("interface", name, pair.place);
    job.out.line(&format!("secondary = {}", toml::text(from)));
    job.out.line(&format!("primary = {}", toml::text(to)));
    if interaction.behavior == Some(Behavior::Tied) {
        job.out.line("tied = true");
        return;
    }
    if let Some(line) = normal(interaction.behavior.as_ref(), pair.by_nodes) {
        job.out.line(&line);
    }
    if let Some(f) = interaction.friction {
        job.out.line(&friction(&f));
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
    // CalculiX integrates penalty springs over the faces; on quadratic ones that is what the points of the faces do here.
    let quadratic = compliant(interaction) && curved(job, pair);
    if pair.by_nodes || quadratic {
        job.out.line("discretisation.node-to-facet = {}");
    }
    if pair.small_sliding {
        job.out.line("kinematics.small-sliding = {}");
    }
    let clearance = deck
        .clearances
        .iter()
        .find(|c| c.slave == pair.slave && c.master == pair.master);
    if clearance.is_some() {
        // Whatever gap the meshes have counts as none.
        job.out.line("initial = \"offset\"");
        job.out.line("initial-tolerance = 1e3");
    } else if let Some(distance) = pair.adjust {
        job.out.line("initial = \"snap\"");
        let size = cell_height(job, pair);
        if size > 0.0 && distance > 0.0 {
            job.out.line(&format!(
                "initial-tolerance = {}",
                toml::number(distance / size)
            ));
        }
    }
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

/// A typical height of the cells of the slave surface, to which distances are related.
fn cell_height(job: &Job, pair: &Pair) -> f64 {
    let deck = job.deck;
    let Some(SurfaceParts::Faces(faces)) = deck.surfaces.get(&pair.slave).map(|s| &s.parts) else {
        return 0.0;
    };
    let heights = faces.iter().filter_map(|(e, _)| {
        let nodes = &deck.elements.get(e)?.nodes;
        let x: Vec<[f64; 3]> = nodes.iter().map(|n| deck.nodes[n]).collect();
        let extent = |c: usize| {
            let (low, high) = x
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
                    (l.min(p[c]), h.max(p[c]))
                });
            high - low
        };
        (0..3)
            .map(extent)
            .filter(|h| *h > 0.0)
            .min_by(f64::total_cmp)
    });
    heights.max_by(f64::total_cmp).unwrap_or(0.0)
}

/// The line of the normal law; `None` is the default, which is exact.
fn normal(behavior: Option<&Behavior>, by_nodes: bool) -> Option<String> {
    match behavior? {
        Behavior::Hard | Behavior::Tied => None,
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

fn friction(f: &Friction) -> String {
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
    match interaction.friction.and_then(|f| f.stick) {
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

fn changes(job: &mut Job) {
    let deck = job.deck;
    let mut current: BTreeMap<&String, Interaction> = deck
        .interactions
        .iter()
        .map(|(n, i)| (n, i.clone()))
        .collect();
    for (step, s) in deck.steps.iter().enumerate() {
        for action in &s.actions {
            let (name, line) = match action {
                Action::ChangeFriction(name, f, place) => {
                    let Some(i) = current.get_mut(name) else {
                        continue;
                    };
                    if let (Some(now), Some(before)) = (f.stick, i.friction.and_then(|f| f.stick))
                        && now != before
                    {
                        job.warn(
                            *place,
                            "the stick slope stays that of *SURFACE INTERACTION",
                            "",
                        );
                    }
                    i.friction = Some(*f);
                    (name, friction(f))
                }
                Action::ChangeBehavior(name, b, place) => {
                    let Some(line) = normal(Some(b), false) else {
                        job.error(
                            *place,
                            "an interface cannot become hard or tied in a later step",
                            "use LINEAR, EXPONENTIAL or TABULAR",
                        );
                        continue;
                    };
                    (name, line)
                }
                _ => continue,
            };
            let interfaces: Vec<String> = deck
                .pairs
                .iter()
                .filter(|p| p.interaction == *name)
                .flat_map(|p| {
                    job.pairs
                        .iter()
                        .filter(|(_, s, m)| *s == p.slave && *m == p.master)
                        .map(|(n, ..)| n.clone())
                })
                .collect();
            for i in interfaces {
                job.changes.push((step, i, line.clone()));
            }
        }
    }
}
