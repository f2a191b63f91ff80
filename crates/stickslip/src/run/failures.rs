//! What is made of attempts that fail: notes for the summary, findings of the doctor, and the error in the end.

use super::parts::{Run, view};
use crate::assess::{diagnosis, doctor, unsupported};
use crate::error::{Error, RunError};
use crate::number::digits;
use crate::results::summary::FallbackSummary;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;

/// Most reasons of cut-backs that the summary lists.
const MOST_REASONS: usize = 200;

/// Takes note of what was tried beside plain iteration.
pub(super) fn note_fallbacks(run: &mut Run, trial: &Trial) {
    let step = &run.model.steps[run.frame.step];
    let summary = &mut run.summary;
    for tried in run.solver.newton.fallbacks.drain(..) {
        let outcome = if tried.converged {
            "converged"
        } else {
            "failed"
        };
        // Once of each kind is enough for people; the list has them all.
        if summary
            .attempts
            .fallbacks
            .iter()
            .all(|f| f.tried.kind != tried.kind)
        {
            run.solver.log.notes.push(format!(
                "{} after {}: plain iteration failed; {} {outcome} in {} iterations with {} (`fallbacks` of the summary lists all of them)",
                step.name, digits(trial.from, 6), tried.kind.name(), tried.iterations, tried.solver
            ));
        }
        if summary.attempts.fallbacks.len() < MOST_REASONS {
            summary.attempts.fallbacks.push(FallbackSummary {
                step: step.name.clone(),
                from: trial.from,
                to: trial.to,
                tried,
            });
        }
    }
}

/// Lets the doctor look at an attempt that failed.
pub(super) fn examine(
    run: &mut Run,
    trial: &Trial,
    attempt: usize,
    counters: doctor::Counters,
    failure: &StepFailure,
) {
    if failure.cause != Cause::Event {
        let finding = doctor::diagnose(&view!(run), trial, attempt, counters, failure);
        doctor::note(&mut run.summary.findings, finding);
    }
}

/// Sees to it that there is a finding about what ended the run; the error says the same.
pub(super) fn conclude(run: &mut Run, error: RunError) -> RunError {
    let findings = &run.summary.findings;
    if findings
        .iter()
        .any(|f| f.severity >= doctor::Severity::Error)
    {
        return error;
    }
    let finding = doctor::stopped(&view!(run), &error);
    let error = match finding.cause.is_mistake() {
        true => doctor::mistake(&finding, error.time),
        false => error,
    };
    doctor::note(&mut run.summary.findings, finding);
    error
}

/// Takes note of an attempt that failed.
pub(super) fn reject(run: &mut Run, trial: &Trial, failure: &StepFailure) {
    // What the last increment did is no guide any more.
    run.reset_predictor();
    let summary = &mut run.summary;
    if failure.cause == Cause::Event {
        summary.attempts.events += 1;
        return;
    }
    summary.attempts.cutbacks += 1;
    if summary.attempts.cutback_reasons.len() < MOST_REASONS {
        summary.attempts.cutback_reasons.push(format!(
            "{} ({} to {}): {}",
            run.model.steps[run.frame.step].name,
            digits(trial.from, 6),
            digits(trial.to, 6),
            failure.message
        ));
    }
}

/// The error of an increment at the end of which contact cannot balance the loads: to halve it would only find out when.
pub(super) fn refuse_unbalanced(run: &mut Run, trial: Trial) -> Option<Error> {
    let (finding, error) = doctor::refuse_unbalanced(&view!(run), trial.from, trial.to)?;
    doctor::note(&mut run.summary.findings, finding);
    Some(error.into())
}

/// The error of an increment that cannot be made smaller.
pub(super) fn give_up(run: &mut Run, failure: StepFailure, trial: &Trial) -> RunError {
    let t = run.frame.state.t;
    if let Some(finding) = run.summary.findings.last_mut() {
        finding.severity = doctor::Severity::Error;
        if finding.cause.is_mistake() {
            return doctor::mistake(finding, t);
        }
    }
    let view = run.view();
    if failure.cause == Cause::Singular {
        let free = unsupported::explain_free(&view, &failure, trial);
        return free.unwrap_or_else(|| diagnosis::explain_singular(&view, &failure));
    }
    if failure.cause == Cause::Engine {
        return failure.at(t);
    }
    if failure.cause == Cause::Memory {
        let help = Some(doctor::MORE_MEMORY.to_string());
        return StepFailure { help, ..failure }.at(t);
    }
    let otherwise = failure.otherwise.as_deref();
    let also = otherwise.map_or(String::new(), |o| format!("; {}", o.message));
    let message = format!(
        "{}: {}{also}; the increment cannot be made smaller",
        view.called(),
        failure.message
    );
    let mut culprits = otherwise.map_or_else(Vec::new, |o| o.culprits.clone());
    for own in &failure.culprits {
        if culprits.iter().all(|known| known.place != own.place) {
            culprits.push(own.clone());
        }
    }
    let failure = StepFailure {
        message,
        culprits,
        ..failure
    };
    failure.at(t)
}
