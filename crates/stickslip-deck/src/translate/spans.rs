//! How long steps are.

use crate::deck::{Procedure, Step};

/// First increment, length, smallest and largest increment.
pub(super) fn times(step: &Step) -> [f64; 4] {
    match step.procedure {
        Procedure::Static { times, .. } | Procedure::Dynamic { times, .. } => times,
        // It takes no time, and next to none is left for it.
        // A step in which nothing moves is this short: amplitudes over the time of the analysis go on as if it was not there.
        _ => [0.0, 1e-6, 0.0, 0.0],
    }
}

/// How long a step lasts.
pub(super) fn duration(step: &Step) -> f64 {
    match times(step)[1] {
        t if t > 0.0 => t,
        _ => 1.0,
    }
}
