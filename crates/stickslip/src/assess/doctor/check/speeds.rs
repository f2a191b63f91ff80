//! Motions that are too fast for the bodies, or lead away from contact.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use super::common::forced_by_loads;
use super::driven::{approach, thrown};
use super::measured::Measured;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::math::norm;
use crate::model::definition::{Body, Model};
use crate::model::scene::Scene;
use crate::number::{digits, figure};
use crate::tolerance::NEGLIGIBLE;

/// Velocity over that of sound beyond which strains are not small: an impact strains by half of it.
const LARGEST_MACH: f64 = 0.1;

/// The slowest speed of sound of the elastic bodies.
fn sound(model: &Model) -> Option<(f64, &Body)> {
    let speeds = model.elastic().flat_map(|body| {
        body.elastic.parts().iter().filter_map(move |part| {
            let modulus = body.elastic.constrained_modulus(part.block)?;
            (part.density > 0.0).then(|| ((modulus / part.density).sqrt(), body))
        })
    });
    speeds.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Velocities that come near the speed of sound, in dynamic steps.
pub(super) fn fast(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let Some((sound, slowest)) = sound(model).filter(|_| model.moves()) else {
        return Vec::new();
    };
    let mut out = Vec::new();
    let mut judge = |what: &str, name: &str, speed: f64| {
        if speed > LARGEST_MACH * sound {
            out.push(
                DoctorCause::TooFast.warning(format!(
                    "{what} {name} moves at {speed}, {:.3} times the speed of sound of body {}, {sound}: an impact at that speed strains it by \
                     {:.2}, and strains have to be small",
                    speed / sound,
                    slowest.name,
                    0.5 * speed / sound,
                    speed = digits(speed, 5),
                    sound = digits(sound, 5),
                ))
                .blame(Suspect::key(format!("{what}.{name}"), format!("velocity {}", digits(speed, 5))))
                .blame(body(model, &slowest.name, format!("speed of sound {}", digits(sound, 5))))
                .advise("check the units of velocity, of time, of modulus and of density"),
            );
        }
    };
    for initial in &model.actions.initials {
        let fastest = initial.velocities.iter();
        let fastest = fastest.fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
        judge("initial", &initial.name, fastest);
    }
    for support in &model.actions.supports {
        let value = support.entries.iter().filter(|e| !e.hold);
        let value = value.fold(0.0_f64, |m, e| m.max(e.value.abs()));
        let rate = rates(
            model,
            |t| support.schedule.at(t),
            |t| support.schedule.active(t),
        );
        judge("support", &support.name, value * rate);
    }
    for interface in &scene.contact.interfaces {
        let Primary::Rigid(_, motion) = &interface.primary else {
            continue;
        };
        let Some(p) = interface.points.first() else {
            continue;
        };
        let x = p.position(&interface.reference);
        let start = model.steps.first().map_or(0.0, |s| s.start);
        let there = motion.pose(start).inward(x);
        for c in 0..3 {
            let speed = rates(model, |t| motion.pose(t).outward(there)[c], |_| true);
            if speed > LARGEST_MACH * sound {
                judge("interface", &interface.name, speed);
                break;
            }
        }
    }
    out
}

/// The fastest change of a quantity over the dynamic steps, between the times at which it may bend.
fn rates(model: &Model, value: impl Fn(f64) -> f64, active: impl Fn(f64) -> bool) -> f64 {
    let mut fastest = 0.0_f64;
    for step in model.steps.iter().filter(|s| s.dynamic.is_some()) {
        let mut times = vec![step.start, step.end];
        times.extend(&step.milestones);
        times.retain(|t| *t >= step.start && *t <= step.end);
        times.sort_by(f64::total_cmp);
        for w in times.windows(2).filter(|w| w[1] > w[0]) {
            // A step owns its end, not its start.
            let begin = w[0] + 1e-9 * (w[1] - w[0]);
            if active(w[1]) {
                fastest = fastest.max((value(w[1]) - value(begin)).abs() / (w[1] - begin));
            }
        }
    }
    fastest
}

/// Whether equations or springs act on a body of an interface.
fn coupled(scene: &Scene, interface: &InterfaceDefinition) -> bool {
    let model = scene.model;
    let sides = super::driven::pair(model, interface);
    let mine = |p: usize| {
        let mut bodies = sides.iter().flatten();
        bodies.any(|&b| model.bodies[b].points.contains(&p))
    };
    scene.contact.couplings.points().any(mine)
}

/// An interface that everything prescribed opens.
pub(super) fn apart(
    scene: &Scene,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<Finding> {
    let model = scene.model;
    // Glued sides are meant to pull at each other, and equations and springs move bodies as supports do.
    if interface.laws.tied || coupled(scene, interface) {
        return None;
    }
    let gaps = measured.gaps.iter().enumerate().filter(|g| g.1.is_finite());
    let (i, &gap) = gaps.min_by(|a, b| a.1.total_cmp(b.1))?;
    let size = interface.points[i].size;
    let given = model
        .actions
        .initials
        .iter()
        .any(|i| !i.displacements.is_empty());
    if gap < -NEGLIGIBLE * size || given || forced_by_loads(scene) {
        return None;
    }
    let x = interface.points[i].position(&interface.reference);
    let normal = measured.nearest[i].as_ref()?.normal;
    let way = approach(scene, interface, x, normal)?;
    if way.most > NEGLIGIBLE * size || way.least > -NEGLIGIBLE * size {
        return None;
    }
    let by = |b: &&Body| thrown(model, b).is_some_and(|v| norm(v.0) > 0.0);
    let sides = super::driven::pair(model, interface);
    let flying = sides.iter().flatten().map(|&b| &model.bodies[b]).find(by);
    let who = match flying {
        Some(body) => format!("body {} flies away from it", body.name),
        None => "what is prescribed pulls its sides apart".to_string(),
    };
    let finding = DoctorCause::MovesApart
        .warning(format!(
            "interface {} never closes: {who}, by {}, and nothing brings it back",
            interface.name,
            figure(-way.least)
        ))
        .blame(Suspect::interface(
            &interface.name,
            format!("gap {} at the start", figure(gap)),
        ));
    let sides = sides.iter().flatten();
    let sides = sides.map(|&b| body(model, &model.bodies[b].name, ""));
    Some(finding.blame_all(sides).advise("check the sign of the displacement or velocity along the normal, and on which side the bodies are"))
}
