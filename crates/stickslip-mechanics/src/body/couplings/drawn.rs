//! Pretensions from step to step.

use std::ops::Range;

use super::definition::StepTimes;
use super::memory::CouplingsMemory;
use super::{Pretension, Row};

/// Begins a step of a pretension at displacements `u`. Where it changes between force and length the forces between all pairs of points stay: those of
/// the rows that let go are handed to the others.
pub(super) fn draw(
    memory: &mut CouplingsMemory,
    p: &Pretension,
    times: StepTimes,
    rows: Range<usize>,
    own: &[Row],
    u: &[f64],
) {
    let count = p.shares.len();
    let across = rows.len() + 1 - 2 * count;
    let along = rows.start + across..rows.start + across + count;
    let equal = along.end..rows.end;
    let (was, is) = (times.before.map(|t| p.pulled(t)), p.pulled(times.middle));
    match (was, is) {
        (Some(false), true) => {
            let whole: f64 = memory.forces[along.clone()].iter().sum();
            for (k, share) in p.shares.iter().enumerate() {
                let i = along.start + k;
                let part = share * whole;
                if k > 0 {
                    let e = equal.start + k - 1;
                    memory.multipliers[e] = part - memory.forces[i];
                    memory.forces[e] = memory.multipliers[e];
                }
                memory.multipliers[i] = 0.0;
                memory.forces[i] = part;
            }
        }
        (Some(true), false) => {
            for k in 1..count {
                let e = equal.start + k - 1;
                let force = memory.forces[e];
                memory.forces[e] = 0.0;
                memory.multipliers[e] = 0.0;
                memory.forces[along.start] += force;
                memory.forces[along.start + k] -= force;
            }
            memory.multipliers[along.clone()].clone_from_slice(&memory.forces[along.clone()]);
        }
        _ => {}
    }
    let held = was == Some(false) && !is;
    for i in along {
        let sum = match held {
            true => memory.targets[i],
            false => own[i - rows.start].sum(u),
        };
        memory.start[i] = if is { -memory.forces[i] } else { sum };
        memory.targets[i] = if is { 0.0 } else { sum };
    }
}
