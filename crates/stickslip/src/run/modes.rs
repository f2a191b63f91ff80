//! Steps in which nothing moves: modes about the state that is reached.

use std::f64::consts::TAU;

use super::parts::{Run, view};
use crate::assess::figures::MODE_RESIDUAL;
use crate::assess::prestress;
use crate::assess::prestress::Shape;
use crate::error::{Error, RunError};
use crate::modal::{self, ModalOutcome, Mode};
use crate::model::kick::{Course, Kick, Share};
use crate::model::limits::GateMode;
use crate::model::modal::Modal;
use crate::number::{digits, figure};
use crate::results::observer::{Event, Observer};
use crate::solve::work::Work;

fn modes_about(run: &mut Run, plan: &Modal) -> Result<ModalOutcome, RunError> {
    run.solver.seen.tell(&Work::Modes);
    let (model, frame) = (&run.model, &run.frame);
    modal::compute(model, frame, &mut run.contact, &run.solver, plan)
}

/// Makes the mode ready along which a step begins. It is the one that the step before has found; a run that was taken up between the two finds it again.
///
/// # Errors
/// [`Error::Run`] if there is no such mode.
pub(super) fn find_kick(run: &mut Run, step: usize) -> Result<Option<Kick>, Error> {
    let Some(plan) = run.model.steps[step].kick else {
        return Ok(None);
    };
    let Some(previous) = step.checked_sub(1) else {
        return Ok(None);
    };
    let before = &run.model.steps[previous];
    let outcome = match (run.modes.last(), before.modal.clone()) {
        (Some(known), _) if known.step == before.name => known.clone(),
        (_, Some(modal)) => modes_about(run, &modal)?,
        (_, None) => return Ok(None),
    };
    let Some(mode) = chosen(&outcome, plan.mode) else {
        let found = outcome.modes.len();
        let message = match plan.mode {
            Some(number) => {
                format!("the initial motion needs mode {number}, but only {found} modes were found")
            }
            None => "the initial motion needs a mode, but none was found".into(),
        };
        return Err(modal::linear::fault(&run.frame, message).into());
    };
    let [re, im] = &mode.shape;
    let im = match im.is_empty() {
        true => vec![0.0; re.len()],
        false => im.clone(),
    };
    let dofs = run.model.dofs;
    let at = |x: &[f64], p: usize| dofs.vector(x, p).iter().map(|v| v * v).sum::<f64>();
    let points = 0..run.model.mesh.points.len();
    let squares = points.map(|p| at(re, p) + at(&im, p));
    let largest = squares.fold(0.0, f64::max).sqrt().max(f64::MIN_POSITIVE);
    let scaled = |x: &[f64]| x.iter().map(|v| v / largest).collect();
    Ok(Some(Kick {
        step,
        value: [mode.growth, TAU * mode.frequency],
        about: run.frame.state.u.clone(),
        shape: [scaled(re), scaled(&im)],
        images: Default::default(),
        amplitude: plan.amplitude,
        last: Share::default(),
        course: Course::at(run.model.steps[step].start),
    }))
}

/// At the end of a step that began along a mode: how it grew.
pub(super) fn tell_growth(run: &mut Run, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    let Some(kick) = &run.frame.kick else {
        return Ok(());
    };
    let growth = kick.growth(&run.model.steps[kick.step].name);
    run.solver.log.notes.push(format!(
        "{}: the mode with growth {} and frequency {} grew by {} with {}, over {:.1} cycles in which points stuck and opened as at the start; its amplitude ends at {}",
        growth.step,
        digits(growth.growth, 5),
        digits(growth.frequency, 5),
        digits(growth.measured_growth, 5),
        digits(growth.measured_frequency, 5),
        growth.cycles,
        figure(growth.amplitudes[1])));
    run.summary.vibrations.growth.push(growth);
    run.tell_notes(observers)
}

/// Judges what modes leave out: the stress that they begin from.
fn judge_modes(run: &mut Run, outcome: &mut ModalOutcome) {
    let complex = outcome.complex;
    let shape = |mode| {
        let Mode {
            frequency, shape, ..
        }: &Mode = mode;
        let parts = shape.iter().filter(|part| !part.is_empty());
        Shape {
            frequency: *frequency,
            stiffness: (!complex).then(|| (TAU * frequency).powi(2)),
            parts: parts.map(Vec::as_slice).collect(),
        }
    };
    let modes: Vec<Shape> = outcome.modes.iter().map(shape).collect();
    let (limits, gate) = (&run.model.reports.quality, &mut run.summary.quality);
    let mut notes = Vec::new();
    prestress::judge_prestress(&view!(run), &modes, limits, gate, &mut notes);
    let t = run.frame.state.t;
    let worst = (outcome.worst_residual()).filter(|_| limits.gate != GateMode::Off);
    if let Some(worst) = worst {
        let limit = limits.mode_residual;
        gate.note(&MODE_RESIDUAL, "model", [worst, 1.0], limit, t);
    }
    gate.gate = limits.gate;
    gate.settle();
    drop(modes);
    outcome.notes.extend(notes);
}

/// Finds the modes that the step at hand asks for. Its time passes, and nothing moves.
///
/// # Errors
/// [`Error::Run`] if the linearised model cannot be solved with, and what observers return.
pub(super) fn find_modes(run: &mut Run, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    let step = &run.model.steps[run.frame.step];
    let Some(plan) = step.modal.clone() else {
        return Ok(());
    };
    let end = step.end;
    let mut outcome = modes_about(run, &plan)?;
    judge_modes(run, &mut outcome);
    let notes = outcome.notes.iter();
    let name = &outcome.step;
    (run.solver.log.notes).extend(notes.map(|note| format!("{name}: {note}")));
    run.frame.state.t = end;
    run.tell(observers, || Event::Modes(&outcome))?;
    if let Some(fastest) = chosen(&outcome, None) {
        let figures = modal::FIGURES.map(String::from).into_iter();
        let size = fastest.growth.hypot(TAU * fastest.frequency);
        let grows = fastest.growth.abs() > modal::quadratic::UNSTABLE_GROWTH * size;
        let values = [if grows { fastest.growth } else { 0.0 }, fastest.frequency];
        run.summary.last.extend(figures.zip(values));
        for (k, mode) in outcome.modes.iter().take(modal::TOLD).enumerate() {
            let values = [mode.frequency, mode.growth];
            let figures = modal::figures_of_mode(k + 1).into_iter();
            run.summary.last.extend(figures.zip(values));
        }
    }
    run.summary.vibrations.modes.push(outcome.figures());
    run.modes.push(outcome);
    run.tell_notes(observers)
}

/// The mode of a number, or the one that grows fastest.
fn chosen(outcome: &ModalOutcome, number: Option<usize>) -> Option<&Mode> {
    match number {
        Some(number) => outcome.modes.get(number - 1),
        None => (outcome.modes.iter()).max_by(|a, b| a.growth.total_cmp(&b.growth)),
    }
}
