//! What acts when: factors that jump, tables of which the analysis sees a part, and what never acts at all.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use crate::model::definition::Model;
use crate::model::scene::Scene;
use crate::number::digits;
use crate::system::{Amplitude, Course, Schedule};

/// Part of its largest value that a factor changes by when it jumps: a load that comes in two such parts comes at once. Tests of planted
/// defects pass with 0.15 and 0.9. It decides what is said, and no result.
const JUMP_OF_FACTOR: f64 = 0.5;

/// Something with a factor in time.
struct Acting<'a> {
    what: &'static str,
    name: &'a str,
    schedule: &'a Schedule,
    /// Whether it is anything but zero at factor one.
    counts: bool,
    /// Whether the factor scales something.
    scaled: bool,
}

impl<'a> Acting<'a> {
    /// Its first table.
    fn table(&self) -> Option<&'a Amplitude> {
        self.schedule.pieces.iter().find_map(|p| match &p.course {
            Course::Table(table) => Some(table),
            _ => None,
        })
    }

    /// Its amplitude as a place.
    fn amplitude(&self, remark: impl Into<String>) -> Suspect {
        Suspect::key(format!("{}.{}.amplitude", self.what, self.name), remark)
    }
}

fn all<'a>(scene: &Scene<'a>) -> Vec<Acting<'a>> {
    let actions = &scene.model.actions;
    let mut all = Vec::new();
    let mut add = |what, name: &'a str, schedule: &'a Schedule, counts| {
        all.push(Acting {
            what,
            name,
            schedule,
            counts,
            scaled: what != "interface",
        });
    };
    for load in &actions.loads {
        let counts = load.entries.iter().any(|e| e.1 != 0.0);
        add("load", &load.name, &load.schedule, counts);
    }
    for support in &actions.supports {
        let counts = support.entries.iter().any(|e| !e.hold && e.value != 0.0);
        add("support", &support.name, &support.schedule, counts);
    }
    for field in actions.heat.iter().flat_map(|h| &h.temperatures.fields) {
        let counts = field.entries.iter().any(|e| e.1 != 0.0);
        add("temperature", &field.name, &field.factor, counts);
    }
    for interface in &scene.contact.interfaces {
        add("interface", &interface.name, &interface.schedule, true);
    }
    all
}

pub(super) fn check(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let mut out = Vec::new();
    for acting in all(scene) {
        match never(model, &acting) {
            Some(finding) => out.push(finding),
            None if acting.counts && acting.scaled => {
                let short = unreached(model, &acting);
                out.extend(short.or_else(|| unread(model, &acting)));
                out.extend(jump(scene, &acting));
                out.extend(ended(model, &acting));
            }
            None => {}
        }
    }
    out
}

/// What is listed in no step, or has the factor zero throughout.
fn never(model: &Model, acting: &Acting) -> Option<Finding> {
    let Acting { what, name, .. } = acting;
    let key = format!("{what}.{name}");
    let new = |message| DoctorCause::NothingActs.warning(message);
    if model.steps.iter().all(|s| !acting.schedule.active(s.end)) {
        let found = new(format!("{what} {name} acts in no step"))
            .blame(Suspect::key(key, "listed in no step"));
        return Some(found.advise(format!("add it to `{what}s` of a step, or remove it")));
    }
    let mut times = super::common::times(model).into_iter();
    let zero = acting.scaled && acting.counts && times.all(|t| acting.schedule.at(t) == 0.0);
    zero.then(|| {
        let end = model.steps.last().map_or(0.0, |s| s.end);
        new(format!(
            "{what} {name} is zero throughout: its amplitude is zero at all times up to the end of the analysis, {end}"
        ))
        .blame(acting.amplitude(""))
        .advise("check the times of the amplitude: they count from the start of the analysis")
    })
}

/// A table whose largest value lies beyond the end of the analysis.
fn unreached(model: &Model, acting: &Acting) -> Option<Finding> {
    let end = model.steps.last().map_or(0.0, |s| s.end);
    let rows = acting.table()?.rows();
    let largest = |inside: bool| {
        let rows = rows
            .iter()
            .filter(|r| !inside || r[0] <= end * (1.0 + 1e-9));
        rows.fold(0.0_f64, |m, r| m.max(r[1].abs()))
    };
    let all = largest(false);
    let mut seen = largest(true);
    for t in super::common::times(model) {
        seen = seen.max(acting.schedule.at(t).abs());
    }
    // Part of the largest value of a table that counts as reached.
    if seen >= 0.999 * all {
        return None;
    }
    let last = rows.last().map_or(end, |r| r[0]);
    let Acting { what, name, .. } = acting;
    Some(
        DoctorCause::AmplitudeUnused.warning(format!(
            "the amplitude of {what} {name} goes on to time {last}, the analysis ends at {end}: only {:.3} of its largest value, {all}, is reached",
            seen / all
        ))
        .blame(acting.amplitude(""))
        .blame(Suspect::key("step", format!("ends at {end}")))
        .advise("make the steps as long as the amplitude, or scale its times"),
    )
}

/// A table that goes on to change behind the end of the analysis, or of the one cycle that it tells of.
fn unread(model: &Model, acting: &Acting) -> Option<Finding> {
    let end = model.steps.last().map_or(0.0, |s| s.end);
    let table = acting.table()?;
    let (rows, last) = (table.rows(), table.at(end));
    let largest = rows.iter().fold(0.0_f64, |m, r| m.max(r[1].abs()));
    let beyond = rows.iter().filter(|r| r[0] > end * (1.0 + 1e-9));
    let beyond: Vec<&[f64; 2]> = beyond.collect();
    let changes = beyond
        .iter()
        .any(|r| (r[1] - last).abs() > JUMP_OF_FACTOR * largest);
    if !changes {
        return None;
    }
    // Tables tell of one cycle, and times in them count like that.
    let once = |s: &crate::model::definition::Step| s.cycles.map_or(s.end - s.start, |c| c.period);
    let told: f64 = model.steps.iter().map(once).sum();
    let first = beyond[0][0] - (end - told);
    let Acting { what, name, .. } = acting;
    let repeated = (model.steps.iter()).find(|s| s.cycles.is_some_and(|c| c.count > 1));
    let (message, advice) = match repeated.and_then(|s| Some((s, s.cycles?))) {
        Some((step, cycles)) => (
            format!(
                "the amplitude of {what} {name} has {} rows that are never reached, the first at {first}: the steps end at {told} in its time, in which step {} with its {} cycles is one cycle of {}",
                beyond.len(),
                step.name,
                cycles.count,
                cycles.period
            ),
            "end the table after one cycle, or set the `duration` of the step (the length of one cycle) to the length of the table",
        ),
        None => (
            format!(
                "the amplitude of {what} {name} has {} rows that are never reached, the first at {first}: the analysis ends at {told}",
                beyond.len()
            ),
            "make the steps as long as the amplitude, or leave out the rows",
        ),
    };
    Some(
        DoctorCause::AmplitudeUnused
            .warning(message)
            .note_unless(repeated.is_some())
            .blame(acting.amplitude(format!("rows from {first} on")))
            .advise(advice),
    )
}

/// A factor that changes, in a quasi-static step, faster than any increment follows.
fn jump(scene: &Scene, acting: &Acting) -> Option<Finding> {
    let model = scene.model;
    let mut before = 0.0;
    let rubs = scene
        .contact
        .interfaces
        .iter()
        .any(|i| i.laws.friction_law().frictional());
    for (piece, step) in acting.schedule.pieces.iter().zip(&model.steps) {
        let from = before;
        before = acting.schedule.at(piece.end);
        let Course::Table(table) = &piece.course else {
            continue;
        };
        if step.dynamic.is_some() {
            continue;
        }
        let largest = table.rows().iter().fold(0.0_f64, |m, r| m.max(r[1].abs()));
        // Times of tables are those of one cycle.
        let length = (step.cycles).map_or(piece.end - piece.start, |cycles| cycles.period);
        let mut rows = vec![[piece.start, from], [piece.start, table.at(piece.start)]];
        let within = table.rows().iter();
        rows.extend(within.filter(|r| r[0] > piece.start && r[0] <= piece.end));
        let jumps = rows.windows(2).find(|w| {
            // In less of a step a factor may not change by half its range.
            let short = w[1][0] - w[0][0] < 1e-3 * length;
            short && (w[1][1] - w[0][1]).abs() > JUMP_OF_FACTOR * largest
        });
        let Some(w) = jumps else {
            continue;
        };
        let Acting { what, name, .. } = acting;
        return Some(
            DoctorCause::SuddenChange.warning(format!(
                "the amplitude of {what} {name} jumps from {} to {} at time {}: one increment takes all of it, however small increments are, and \
                 friction depends on the way there",
                w[0][1],
                w[1][1],
                digits(w[1][0], 5),
            ))
            .note_unless(rubs)
            .blame(acting.amplitude(format!("time {}", digits(w[1][0], 5))))
            .advise("spread the change over a part of the step, or make the step dynamic"),
        );
    }
    None
}

/// A table that ends within a dynamic step, after which its last value is held.
fn ended(model: &Model, acting: &Acting) -> Option<Finding> {
    let steps = acting.schedule.pieces.iter().zip(&model.steps);
    let mut moving = steps.filter(|(_, step)| step.dynamic.is_some());
    let (last, end) = moving.find_map(|(piece, step)| match &piece.course {
        Course::Table(table) => {
            let last = table.rows().last().filter(|_| table.rows().len() > 1)?;
            let early = last[0] < step.end - 1e-9 * (step.end - step.start);
            (early && last[1] != 0.0).then_some((last, step.end))
        }
        _ => None,
    })?;
    let Acting { what, name, .. } = acting;
    Some(
        DoctorCause::AmplitudeUnused.note(format!(
            "the amplitude of {what} {name} ends at time {}, a dynamic step at {end}: its last value, {}, is held",
            last[0], last[1]
        ))
        .blame(acting.amplitude(""))
        .advise("add a row where it should fall to zero"),
    )
}
