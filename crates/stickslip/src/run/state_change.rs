//! Increments over which the state variables of friction laws change little.

use super::parts::Run;
use crate::contact::interface::{rate_of_attempt, rate_of_change};
use crate::number::digits;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;

/// The longest increment by what friction laws keep now; `None` where no law keeps anything, or increments are given.
pub(super) fn bound(run: &Run) -> Option<f64> {
    let step = run.step();
    let views = run.contact.views_of(run.solver.contacts(&run.frame));
    let rate = views.map(rate_of_change).fold(0.0, f64::max);
    (rate > 0.0 && !step.fixed).then(|| step.state_change / rate)
}

/// Refuses an increment at whose end more has changed than it can have found.
pub(super) fn check(run: &Run, trial: Trial) -> Result<(), StepFailure> {
    let step = run.step();
    let views = run.contact.views_of(run.solver.contacts(&run.frame));
    let interfaces = run.contact.interfaces.iter().zip(views);
    for (interface, view) in interfaces.filter(|_| !step.fixed) {
        let change = rate_of_attempt(interface, view) * (trial.to - trial.from);
        if change > 2.0 * step.state_change {
            let message = format!(
                "interface `{}`: the state of its friction law changes by {} of what it is over this increment",
                view.name,
                digits(change, 2)
            );
            return Err(StepFailure::new(Cause::TooFar, message)
                .help("`increments.state-change` of the step says how much may change"));
        }
    }
    Ok(())
}
