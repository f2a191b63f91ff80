//! The end of an analysis, well or not.

use super::cycles::release_block;
use super::failures::conclude;
use super::parts::{Run, view};
use crate::assess::doctor::{self, DoctorCause};
use crate::assess::quality;
use crate::error::Error;
use crate::results::observer::{Event, Observer};

/// What is to be said at the end, well or not.
pub(super) fn close(
    run: &mut Run,
    outcome: Result<bool, Error>,
    observers: &mut [&mut dyn Observer],
) -> Result<bool, Error> {
    let outcome = match outcome {
        // The rows of the block in which it ended say why.
        Err(e) if !matches!(e, Error::Interrupted(_)) => {
            let told = release_block(run, observers);
            told.and(Err(e))
        }
        other => other,
    };
    let settled = observers.iter_mut().try_for_each(|o| o.settle());
    let outcome = outcome.and_then(|done| settled.map(|()| done));
    let outcome = outcome.map_err(|e| match e {
        Error::Run(error) => Error::Run(conclude(run, error)),
        e => e,
    });
    let total = run.elapsed();
    let view = view!(run);
    let summary = &mut run.summary;
    let statistics = &run.solver.newton.statistics;
    summary.finish(statistics, total, outcome.as_ref().err());
    summary.balance.energy = run.frame.ledger;
    let strain = run.frame.ledger.strain;
    summary.loose.artificial_energy = run.solver.floating.artificial_energy(strain);
    summary.interfaces = quality::interfaces(&view, &summary.quality, &run.judges.watches);
    let mut notes = Vec::new();
    if summary.run.completed {
        for finding in doctor::watched(&view, &run.judges.watches) {
            // Shear that is not there looks like any other.
            if finding.cause == DoctorCause::TurnedNormals {
                notes.push(finding.message.clone());
            }
            doctor::note(&mut summary.findings, finding);
        }
    }
    if summary.attempts.increments > 0 {
        let (limits, energy) = (&run.model.reports.quality, &summary.balance.energy_quality);
        quality::judge_energy(&view, limits, energy, &mut summary.quality, &mut notes);
    }
    run.solver.log.notes.extend(notes);
    let told = run.tell_notes(observers);
    let told = told.and(run.tell(observers, || Event::End));
    // Why it ended is what to report, not that this could not be written either.
    outcome.and_then(|more| told.map(|()| more))
}
