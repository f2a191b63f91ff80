//! `*MOTION` to sliding that lasts: how fast the master's material runs past the slave's, by interface and step.

use std::collections::BTreeMap;

use stickslip::problem::{SteadySliding, Turning};

use super::bodies::Bodies;
use super::contact::surface_nodes;
use super::job::Job;
use crate::card::Place;
use crate::deck::{Action, Deck, MaterialVelocity, Procedure, Target};

/// Velocity of the material at a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Moving {
    along: [f64; 3],
    /// A point of the axis, and the angular velocity.
    about: Option<([f64; 3], [f64; 3])>,
}

/// Velocities by node.
type Velocities = BTreeMap<u64, Moving>;

pub(super) fn write(job: &mut Job, bodies: &Bodies) {
    let deck = job.deck;
    let mut velocities = Velocities::new();
    let mut given: Option<Place> = None;
    for (i, step) in deck.steps.iter().enumerate() {
        let before = given;
        for action in &step.actions {
            if let Action::Motion(motion) = action {
                given = Some(motion.place);
                at_rest_in_its_axes(job, &motion.target, motion.place);
                set(job, &mut velocities, &motion.target, &motion.velocity);
            }
        }
        let now = given.filter(|_| given != before);
        if let (Some(place), true) = (now, step.is_modal()) {
            let help = "write *MOTION into the *STATIC step before";
            job.error(place, "nothing moves in a step that looks for modes", help);
        }
        match (&step.procedure, given) {
            (Procedure::Static { .. }, Some(place)) => slide(job, bodies, &velocities, i, place),
            (Procedure::Dynamic { .. }, Some(_)) => job.error(
                step.place,
                "*MOTION is about steady sliding, and a *DYNAMIC step would go on from it",
                "leave the step out, or move the bodies by *BOUNDARY from the first step on",
            ),
            (Procedure::ComplexFrequency { .. }, None) => job.warn(
                step.place,
                "no *MOTION says which way surfaces slide, and what does not slide does not squeal",
                "write *MOTION, TYPE=VELOCITY into the *STATIC step before",
            ),
            _ => {}
        }
    }
}

/// Directions of velocities are global ones.
fn at_rest_in_its_axes(job: &mut Job, target: &Target, place: Place) {
    if job
        .nodes(target)
        .iter()
        .any(|n| job.deck.properties.transforms.contains_key(n))
    {
        let help = "name nodes without one: only those of surfaces that touch count";
        job.error(
            place,
            "*MOTION of nodes with a *TRANSFORM is not supported",
            help,
        );
    }
}

fn set(job: &Job, velocities: &mut Velocities, target: &Target, velocity: &MaterialVelocity) {
    for node in job.nodes(target) {
        let moving = velocities.entry(node).or_default();
        match velocity {
            MaterialVelocity::Along(components, value) => {
                components.iter().for_each(|c| moving.along[*c] = *value);
            }
            MaterialVelocity::About(centre, turning) => moving.about = Some((*centre, *turning)),
        }
    }
}

/// What moves past what in a step.
fn slide(job: &mut Job, bodies: &Bodies, velocities: &Velocities, step: usize, place: Place) {
    let dim = bodies.dim();
    let mut steady = SteadySliding::default();
    for (interface, slave, master) in job.pairs.clone() {
        let sides = [slave, master].map(|name| side(job, bodies, velocities, &name, place));
        let [Some(slave), Some(master)] = sides else {
            return;
        };
        let along: [f64; 3] = std::array::from_fn(|i| master.along[i] - slave.along[i]);
        if along != [0.0; 3] {
            let velocity = along[..dim].to_vec();
            steady.velocity.insert(interface.clone(), velocity);
        }
        match relative(slave, master) {
            Ok(None) => {}
            Ok(Some((centre, turning))) => {
                steady.turning.insert(interface, turn(dim, centre, turning));
            }
            Err(message) => {
                let help = "let one of the two surfaces turn, by the difference";
                return job.error(place, message, help);
            }
        }
    }
    if steady == SteadySliding::default() {
        let help = "name the nodes of one side of a *CONTACT PAIR";
        return job.warn(place, "*MOTION moves no surface past another", help);
    }
    job.problem.step[step].steady = Some(steady);
}

/// How the primary turns against the secondary.
type Turn = Option<([f64; 3], [f64; 3])>;

fn relative(slave: Moving, master: Moving) -> Result<Turn, &'static str> {
    let turn = match (slave.about, master.about) {
        (None, about) => about,
        (Some((centre, w)), None) => Some((centre, w.map(|w| -w))),
        (Some((a, v)), Some((b, w))) if a == b => Some((a, std::array::from_fn(|i| w[i] - v[i]))),
        _ => return Err("two surfaces that touch turn about different points"),
    };
    Ok(turn.filter(|(_, w)| *w != [0.0; 3]))
}

fn turn(dim: usize, centre: [f64; 3], turning: [f64; 3]) -> Turning {
    let centre = centre[..dim].to_vec();
    if dim == 2 {
        return Turning {
            centre,
            axis: Vec::new(),
            speed: turning[2],
        };
    }
    let speed = turning.iter().map(|w| w * w).sum::<f64>().sqrt();
    Turning {
        centre,
        axis: turning.map(|w| w / speed).to_vec(),
        speed,
    }
}

/// The velocity of a surface, which all of its nodes have.
fn side(
    job: &mut Job,
    bodies: &Bodies,
    velocities: &Velocities,
    surface: &str,
    place: Place,
) -> Option<Moving> {
    let deck: &Deck = job.deck;
    let nodes = surface_nodes(deck, bodies, surface);
    let of = |n: &u64| velocities.get(n).copied().unwrap_or_default();
    let first = nodes.first().map(of).unwrap_or_default();
    if let Some(other) = nodes.iter().find(|n| of(n) != first) {
        let message = format!(
            "*MOTION does not move all nodes of the surface {surface} alike: node {} moves otherwise than node {}",
            deck.label(*other),
            nodes.first().map_or_else(String::new, |n| deck.label(*n))
        );
        let help = "name a set with all nodes of the body that moves";
        job.error(place, message, help);
        return None;
    }
    Some(first)
}
