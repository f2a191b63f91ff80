//! Steps that are gone through again and again.

use super::super::key;
use super::super::{Cycles, Problem};
use super::findings::Findings;
use crate::model::Jump;

/// Amplitude tables are written out for all cycles that may be computed; at a second each so many take twelve days.
const MOST_CYCLES: usize = 1_000_000;

/// What may not change over cycles, from `span[0]` to `span[1]` in amplitude tables.
pub(super) fn check(findings: &mut Findings, key: &[&str], problem: &Problem, span: [f64; 2]) {
    let [start, end] = span;
    let step = key.get(1).and_then(|i| key::index(i));
    let Some(step) = step.and_then(|i| problem.step.get(i)) else {
        return;
    };
    let Some(cycles) = step.cycles else {
        return;
    };
    let mut add = |message: String, help: &str| findings.add(key, message, help);
    if step.dynamic.is_some() {
        let message = "cycles are gone through at rest, and the step is dynamic";
        add(message.into(), "remove `dynamic`, or `cycles`");
    }
    jumps(&mut add, cycles);
    for (name, amplitude) in &problem.amplitude {
        let Ok(table) = crate::system::Amplitude::new(amplitude.table.clone()) else {
            continue;
        };
        let (first, last) = (table.at(start), table.at(end));
        let rows = amplitude.table.iter().map(|r| r[1].abs());
        if (first - last).abs() > 1e-12 * rows.fold(0.0, f64::max) {
            add(
                format!(
                    "amplitude.{name} is {first} at the start of a cycle and {last} at its end, and the next one begins as this one did"
                ),
                "let its rows end as they begin, between the start and one duration later",
            );
        }
    }
    let moves = |rows: &[Vec<f64>]| rows.iter().any(|r| r.first().is_some_and(|&t| t > start));
    for (name, obstacle) in &problem.obstacle {
        let Some(motion) = &obstacle.motion else {
            continue;
        };
        let turns = motion.rotation.iter().flat_map(|r| &r.angle);
        if moves(&motion.translation) || turns.into_iter().any(|a| a[0] > start) {
            add(
                format!("obstacle.{name} moves by a table without cycles"),
                "move the body against it, by a support with an amplitude",
            );
        }
    }
    for (name, interface) in &problem.interface {
        let rows = interface.primary_velocity_table.as_deref();
        if rows.is_some_and(moves) {
            add(
                format!("the velocity of interface.{name} is from a table without cycles"),
                "move the body by a support with an amplitude",
            );
        }
    }
}

/// How many cycles there are, and how many of them one stands for.
fn jumps(add: &mut impl FnMut(String, &str), Cycles { count, jump }: Cycles) {
    let pair = |what: &str, n: usize| match n == 0 || n > count {
        true => Some(format!(
            "{count} cycles by {n} at a time{what}: both must be positive, and the second not larger"
        )),
        false => None,
    };
    let chosen = match jump {
        Jump::Fixed(n) => {
            if let Some(message) = pair("", n) {
                add(message, "");
            }
            let computed = count.div_ceil(n.max(1));
            if computed > MOST_CYCLES {
                let message = format!("{computed} cycles would be computed: at most {MOST_CYCLES}");
                add(message, "let one stand for several, by `jump`");
            }
            return;
        }
        Jump::Chosen(chosen) => chosen,
    };
    if !(chosen.error > 0.0 && chosen.error <= 1.0) {
        let message = format!("an error of {}", chosen.error);
        add(
            message,
            "a part of what is worn off, above zero: `error = 0.01`",
        );
    }
    if let Some(message) = pair(" at first", chosen.first) {
        add(message, "");
    }
    if chosen.largest.is_some_and(|n| n < chosen.first) {
        let message = "`largest` is smaller than `first`";
        add(message.into(), "");
    }
    if count > MOST_CYCLES {
        let message = format!("{count} cycles with jumps that are chosen: at most {MOST_CYCLES}");
        let help = "let a number of cycles be one, with a wear rate as many times as large, or give a fixed jump";
        add(message, help);
    }
}
