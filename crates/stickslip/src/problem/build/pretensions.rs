//! Rows between the two sides of cuts through bolts, and what steps do with them.

use super::super::{Problem, Tension};
use super::cuts::BuiltCut;
use super::fault::problem_error;
use super::schedules::Timeline;
use crate::body::couplings::{Coupling, Course, Draw, Pretension, Tie};
use crate::body::{Space, area_vectors};
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, dot, scale};
use crate::mesh::Mesh;
use crate::system::Schedule;

/// The rows of all pretensions.
pub(super) fn build(
    problem: &Problem,
    cuts: &[BuiltCut],
    mesh: &Mesh,
    space: Space,
    timeline: &Timeline,
) -> Result<Vec<Coupling>, Error> {
    let mut all = Vec::new();
    for cut in cuts {
        let key = format!("pretension.{}", cut.name);
        let fault = |e: Diagnostic| problem_error(vec![e.under(&key)]);
        let rows = Pretension::rows(&cut.pairs, cut.normal, space.dim());
        let areas = area_vectors(mesh, &cut.near, space);
        let whole: f64 = areas.iter().map(|(_, v)| dot(*v, cut.normal)).sum();
        if whole <= 0.0 {
            let message = "the normal runs along the section: no force crosses it";
            return Err(fault(
                Diagnostic::new("", message).help("the normal is the direction of the bolt"),
            ));
        }
        let share = |(_, v): &(usize, Vec3)| dot(*v, scale(1.0 / whole, cut.normal));
        all.push(Coupling {
            name: cut.name.clone(),
            rows: rows.map_err(fault)?,
            tie: Tie::Pretension(Pretension {
                shares: areas.iter().map(share).collect(),
                area: whole,
                steps: steps(problem, &cut.name, timeline),
            }),
            schedule: Schedule::always(),
            referred: false,
            table: false,
        });
    }
    Ok(all)
}

/// What is done with a pretension in each step: what the step says, or what the one before did. Before anything is said it is held.
fn steps(problem: &Problem, name: &str, timeline: &Timeline) -> Vec<(f64, f64, Draw)> {
    let mut draw = Draw::Hold;
    let spans = timeline.spans.iter().zip(&problem.step);
    spans
        .map(|(&(start, end), step)| {
            if let Some(tension) = step.pretension.get(name) {
                draw = drawn(problem, tension, timeline);
            }
            (start, end, draw.clone())
        })
        .collect()
}

fn drawn(problem: &Problem, tension: &Tension, timeline: &Timeline) -> Draw {
    let course = |value: f64| Course {
        value,
        table: timeline.table(problem, tension.amplitude.as_deref()),
    };
    match (tension.force, tension.shortening) {
        (Some(force), _) => Draw::Force(course(force)),
        (None, Some(shortening)) => Draw::Shortening(course(shortening)),
        (None, None) => Draw::Hold,
    }
}
