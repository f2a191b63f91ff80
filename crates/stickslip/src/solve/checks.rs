//! Solutions that are refused although Newton's method has found them.

use crate::contact::interface::ContactView;
use crate::contact::interface::{Conditions, spreads};
use crate::contact::look;
use crate::math::larger;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::number::{digits, figure};
use crate::system::{Cause, State, StepFailure};
use crate::tolerance::NEGLIGIBLE;

/// The forces of an increment whose interior was found from that of its contact candidates.
pub(crate) struct Recovered<'a> {
    /// Out of balance: what is left at free dofs, reactions at fixed ones `[N]`.
    pub forces: &'a [f64],
    /// Displacements `[m]`.
    pub u: &'a [f64],
    /// Diagonal of the matrix `[N/m]`.
    pub diagonal: &'a [f64],
    /// Prescribed dofs.
    pub fixed: &'a [bool],
    /// Sum of the squares of the forces of interfaces `[N²]`, and that of what else balances.
    pub contact: f64,
    pub others: f64,
}

impl Recovered<'_> {
    /// Refuses an interior that is not in balance: what is left at free dofs is compared with the largest of reactions, contact and what else
    /// balances, each as the root of its squares. `largest` is the largest of these in the analysis so far: where a path passes through the unloaded
    /// state, there is nothing but rounding.
    pub fn check(&self, tolerance: f64, largest: &mut f64) -> Result<(), StepFailure> {
        let (mut left, mut rounding, mut reactions) = (0.0, 0.0, 0.0_f64);
        for (i, f) in self.forces.iter().enumerate() {
            if self.fixed[i] {
                reactions += f * f;
            } else {
                left += f * f;
                rounding += (self.diagonal[i] * self.u[i]).powi(2);
            }
        }
        let size = reactions.max(self.contact).max(self.others).sqrt();
        let limit = ((10.0 * tolerance).max(NEGLIGIBLE) * size)
            // Rounding may leave so much in a recovered interior.
            .max(1e4 * f64::EPSILON * rounding.sqrt())
            // Forces below this part of the largest there were in the analysis are none.
            .max(1e-8 * *largest);
        if !(limit.is_finite() && left.sqrt() <= limit) {
            return Err(StepFailure::new(
                Cause::Interior,
                format!(
                    "the recovered interior is not in balance: {} of the forces on it",
                    digits(left.sqrt() / size, 2),
                ),
            )
            .help(
                "where the run takes factors from a folder (`--cache`), remove that first: they may be damaged; else set `solver.method = \"sparse\"`",
            ));
        }
        // Forces of an attempt that is refused are none.
        *largest = largest.max(size);
        Ok(())
    }
}

/// Refuses displacement increments that are too large.
pub(crate) fn check_change(
    model: &Model,
    pairs: impl Iterator<Item = (f64, f64)>,
) -> Result<(), StepFailure> {
    let change = pairs.fold(0.0, |m, (a, b)| larger(m, (a - b).abs()));
    // A change that is not a number is none that is allowed.
    if change.is_nan() || change > model.solution.largest_change * model.size {
        return Err(StepFailure::new(
            Cause::TooFar,
            format!(
                "two successive solutions are {change} apart, more than `largest-change` allows",
                change = figure(change)
            ),
        ));
    }
    Ok(())
}

/// Refuses a solution that bodies which turn on axles that contact alone holds can have reached through each other only.
pub(crate) fn check_way<'a>(
    model: &Model,
    contacts: impl Iterator<Item = ContactView<'a>>,
    ends: [&State; 2],
    fixed: &[bool],
) -> Result<(), StepFailure> {
    if !model.frames.any_unheld(fixed) {
        return Ok(());
    }
    for interface in contacts {
        if let Some(deep) = look::tunnels(interface, ends.map(|s| &*s.u), ends.map(|s| s.t)) {
            let message = format!(
                "interface `{}`: bodies overlap by {deep} within the increment: a body on an axle, held by contact alone, turned through its neighbour",
                interface.name,
                deep = figure(deep)
            );
            return Err(StepFailure::new(Cause::TooFar, message)
                .help("smaller increments, or finer cells where the bodies touch"));
        }
    }
    Ok(())
}

/// Refuses a solution with contact near points that do not take part.
pub(crate) fn check_candidates(
    contact: &Contact,
    conditions: &[Conditions],
) -> Result<(), StepFailure> {
    let mut interfaces = contact.interfaces.iter().zip(conditions);
    if interfaces.any(|(i, conditions)| spreads(i, conditions)) {
        return Err(StepFailure::new(
            Cause::Reach,
            "contact comes near to points that were not expected to be touched",
        ));
    }
    Ok(())
}
