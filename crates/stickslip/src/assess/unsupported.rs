//! Unconstrained bodies, for a person: before a step begins, and after an increment in which one could not be brought to rest.

use super::doctor::{DoctorCause, Finding, Suspect, body_at, let_go};
use super::view::View;
use crate::contact::look;
use crate::error::RunError;
use crate::model::rigid::drivers::named;
use crate::model::rigid::modes::modes;
use crate::model::rigid::{drivers, free_bodies, held};
use crate::number::figure;
use crate::system::StepFailure;
use crate::time::Trial;
use crate::tolerance::NEGLIGIBLE;

/// What to do about a body that has lost its hold, and about one that waits for contact.
const LOST: &str = "no equilibrium was found beyond this: lower what drives the body or raise friction, support the motion or hold it by weak \
     springs (`[load.NAME] spring = { stiffness = [...] }`), or make the step dynamic if the body is meant to slide or take off";
const WAITS: &str = "support these motions, hold them by weak springs (`[load.NAME] spring = { stiffness = [...] }`), move the bodies until \
     they touch, or prescribe a displacement instead of a force";

/// What ends a quasi-static step before it begins: a motion is free in it that nothing can hold, whatever touches.
pub(crate) fn refuse_rigid_modes(view: &View) -> Option<(Finding, RunError)> {
    let step = &view.model.steps[view.frame.step];
    let middle = 0.5 * (step.start + step.end);
    let all = modes(view.model);
    let mut refused = Vec::new();
    for motion in held::unheld(view, middle, &all, true) {
        let push = drivers::strongest(view, &all, &motion);
        let driven = push.is_felt();
        // Anchors keep a body that nothing drives where it is.
        let mut parts = all
            .iter()
            .zip(&motion)
            .filter(|(_, part)| part.abs() > NEGLIGIBLE);
        if driven || !parts.all(|(mode, _)| view.solver.floating.knows(mode.body)) {
            refused.push((motion, push, driven));
        }
    }
    // What is driven says more than what is merely free.
    refused.sort_by_key(|(_, _, driven)| !driven);
    let (first, push, driven) = refused.first()?;
    let (body, what) = drivers::describe(view, &all, first);
    let step = view.step_name().to_string();
    let called = view.called();
    let by = match driven {
        true => format!(", and {} it", named(&push.drivers(), "drives", "drive")),
        false => String::new(),
    };
    let message = format!(
        "{called}: body {body} is free to move as a rigid body ({what}): neither supports nor springs nor contact can hold it{by}"
    );
    let mut finding = DoctorCause::FreeRigidMode.error(message);
    let mut culprits = Vec::new();
    for (motion, push, driven) in &refused {
        let (body, what) = drivers::describe(view, &all, motion);
        let by: Vec<String> = match driven {
            true => push
                .drivers()
                .iter()
                .map(|d| format!("{} {}", d.key, d.what))
                .collect(),
            false => vec!["nothing drives it".into()],
        };
        let remark = format!(
            "{what} is held neither by supports nor by springs nor by contact; {}",
            by.join(", ")
        );
        culprits.push(format!("body {body}: {remark}"));
        finding = finding.blame(body_at(view.model, &body, remark));
    }
    for driver in push.drivers().into_iter().filter(|_| *driven) {
        finding = finding.blame(Suspect::key(driver.key, driver.what));
    }
    let mut help = "support these motions, or hold them by weak springs (`[load.NAME] spring = { stiffness = [...] }`); \
         if the body is meant to fly or fall, make the step dynamic"
        .to_string();
    let moved = refused
        .iter()
        .flat_map(|(motion, ..)| all.iter().zip(motion));
    let moved = moved.filter(|(_, part)| part.abs() > NEGLIGIBLE);
    let moved: Vec<String> = moved
        .map(|(mode, _)| view.model.bodies[mode.body].name.clone())
        .collect();
    for gone in let_go(view, &moved) {
        culprits.push(format!("{} {}", gone.key, gone.what));
        help = format!("{}; {help}", gone.advice);
        finding = finding.blame(Suspect::key(gone.key, gone.what));
    }
    finding = finding.advise(help.clone());
    finding.step = Some(step);
    finding.time = Some(view.frame.state.t);
    let error = RunError {
        message: finding.message.clone(),
        time: view.frame.state.t,
        culprits,
        help: Some(help),
    };
    Some((finding, error))
}

/// The error for a body that could not be brought to rest in an increment: what it does, and what drives it. `None` where no body is free.
pub(crate) fn explain_free(view: &View, failure: &StepFailure, trial: &Trial) -> Option<RunError> {
    let free = free_bodies::free_bodies(view, trial.to);
    let model = view.model;
    // A body that has been in contact has lost its hold; others wait for theirs.
    let touching: Vec<_> = free
        .iter()
        .filter(|f| f.bodies.iter().any(|&b| view.touches(b)))
        .collect();
    let lost = !touching.is_empty();
    let told: Vec<_> = match lost {
        true => touching,
        false => free.iter().collect(),
    };
    let first = told.first()?;
    let name = first.name(model);
    let called = view.called();
    let drivers = drivers::drivers(view, first.bodies[0], trial.to);
    let by = match drivers.is_empty() {
        true => String::new(),
        false => format!(", {} it", named(&drivers, "drives", "drive")),
    };
    let message = match lost {
        true => format!(
            "{called}: body {name} slides, rolls or lifts off as a whole: contact and friction do not hold it{by}"
        ),
        false => format!(
            "{called}: body {name} is free to move as a rigid body: no contact holds it yet{by}"
        ),
    };
    let mut culprits = Vec::new();
    for f in &told {
        let motions: Vec<&str> = f.motions.iter().map(|(name, _)| name.as_str()).collect();
        let held = match lost {
            true => "held by contact alone",
            false => "held neither by supports nor by springs",
        };
        let name = f.name(model);
        culprits.push(format!("body {name}: {} is {held}", motions.join(", ")));
    }
    culprits.extend(drivers.iter().map(|d| format!("{} {}", d.key, d.what)));
    if lost {
        culprits.extend(failure.culprits.iter().take(3).map(ToString::to_string));
    }
    let names = told.iter().flat_map(|f| &f.bodies);
    let names = names.map(|&b| model.bodies[b].name.clone());
    let gone = let_go(view, &names.collect::<Vec<_>>());
    culprits.extend(gone.iter().map(|g| format!("{} {}", g.key, g.what)));
    let first: String = gone.iter().map(|g| format!("{}; ", g.advice)).collect();
    Some(RunError {
        message,
        time: view.frame.state.t,
        culprits,
        help: Some(match lost {
            true => format!("{first}{LOST}"),
            false => format!("{first}{WAITS} ({})", smallest_gaps(view)),
        }),
    })
}

fn smallest_gaps(view: &View) -> String {
    let gaps = view.contacts().map(|i| {
        let smallest = look::initial_gaps(i)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        format!("{}: {smallest}", i.name, smallest = figure(smallest))
    });
    match gaps.collect::<Vec<_>>().as_slice() {
        [] => "there are no interfaces".into(),
        gaps => format!("smallest gaps at the last state: {}", gaps.join(", ")),
    }
}
