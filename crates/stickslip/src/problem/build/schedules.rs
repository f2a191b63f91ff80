//! When what acts, and with which factor.

use super::super::{Cycles, Kick, Problem, SteadySliding};
use crate::body::couplings::Coupling;
use crate::model::{ContactAt, Cycling, Dynamic, Step};
use crate::system::{Amplitude, Course, Piece, Schedule};
use crate::time::Increments;

/// Starts and ends of the steps.
pub(super) struct Timeline {
    pub spans: Vec<(f64, f64)>,
    repeats: Vec<Repeat>,
}

/// A step with cycles, in the time of amplitude tables, in which there is one of them.
struct Repeat {
    start: f64,
    period: f64,
    blocks: usize,
}

/// Whether `name` is active in a step whose list is `list`: in all steps that have no list.
fn listed(list: Option<&Vec<String>>, name: &str) -> bool {
    list.is_none_or(|names| names.iter().any(|n| n == name))
}

impl Timeline {
    pub fn new(problem: &Problem) -> Self {
        let (mut t, mut told) = (0.0, 0.0);
        let (mut spans, mut repeats) = (Vec::new(), Vec::new());
        for step in &problem.step {
            let (start, period) = (t, step.duration);
            let blocks = step.cycles.map_or(1, Cycles::blocks);
            t = block_end(start, period, blocks);
            spans.push((start, t));
            if blocks > 1 {
                repeats.push(Repeat {
                    start: told,
                    period,
                    blocks,
                });
            }
            told += period;
        }
        Timeline { spans, repeats }
    }

    /// Amplitudes over the time of the analysis.
    pub fn table(&self, problem: &Problem, amplitude: Option<&str>) -> Option<Amplitude> {
        let rows = &problem.amplitude.get(amplitude?)?.table;
        Amplitude::new(self.unroll(rows)).ok()
    }

    /// Rows of a table in which cycles are told once, over the time in which they are computed.
    fn unroll(&self, rows: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut rows = rows.to_vec();
        // From the last to the first: what comes before is told as it was.
        for repeat in self.repeats.iter().rev() {
            let &Repeat {
                start,
                period,
                blocks,
            } = repeat;
            let end = start + period;
            let Ok(amplitude) = Amplitude::new(rows.clone()) else {
                return rows;
            };
            let of = |keep: &dyn Fn(f64) -> bool| -> Vec<[f64; 2]> {
                rows.iter().copied().filter(|r| keep(r[0])).collect()
            };
            let mut out = of(&|t| t < start);
            out.push([start, amplitude.at(start)]);
            let inside = of(&|t| t > start && t < end);
            for block in 0..blocks {
                let begins = block_end(start, period, block);
                out.extend(inside.iter().map(|&[t, v]| [begins + (t - start), v]));
                out.push([block_end(start, period, block + 1), amplitude.at(end)]);
            }
            let shift = (blocks - 1) as f64 * period;
            let after = of(&|t| t > end);
            out.extend(after.into_iter().map(|[t, v]| [t + shift, v]));
            rows = out;
        }
        rows
    }

    /// One piece a step, its course given whether the item is on and what its factor was before.
    fn schedule(
        &self,
        active: &[bool],
        mut course: impl FnMut(bool, f64, bool) -> Course,
    ) -> Schedule {
        let mut factor = 0.0;
        let mut was = false;
        let mut pieces = Vec::new();
        for (&(start, end), &on) in self.spans.iter().zip(active) {
            let course = course(on, factor, was);
            factor = match &course {
                Course::Off => 0.0,
                Course::Ramp(_, to) => *to,
                Course::Table(amplitude) => amplitude.at(end),
            };
            was = on;
            pieces.push(Piece { start, end, course });
        }
        Schedule { pieces }
    }

    /// Loads grow from zero over the first step in which they act, stay, and fall to zero over the first in which they do not; in a
    /// dynamic step they come and go at once.
    pub fn load(&self, problem: &Problem, name: &str, amplitude: Option<&str>) -> Schedule {
        let active: Vec<bool> = problem
            .step
            .iter()
            .map(|s| listed(s.loads.as_ref(), name))
            .collect();
        let table = self.table(problem, amplitude);
        let mut steps = problem.step.iter();
        self.schedule(&active, |on, factor, _| match (on, &table, steps.next()) {
            // Nothing moves, so nothing grows.
            (_, None, Some(step)) if step.modal().is_some() => Course::Ramp(factor, factor),
            (on, table, Some(step)) if step.dynamic.is_some() => match (on, table) {
                (true, Some(table)) => Course::Table(table.clone()),
                (true, None) => Course::Ramp(1.0, 1.0),
                (false, _) => Course::Off,
            },
            (true, Some(table), _) => Course::Table(table.clone()),
            (true, None, _) => Course::Ramp(factor, 1.0),
            (false, ..) if factor != 0.0 => Course::Ramp(factor, 0.0),
            (false, ..) => Course::Off,
        })
    }

    /// Factor and share (see [`Temperatures`](crate::body::Temperatures)) of a temperature, which comes and goes like a load. `taken`: steps in which
    /// something with an amplitude takes its place at once.
    pub fn temperature(
        &self,
        problem: &Problem,
        name: &str,
        amplitude: Option<&str>,
        taken: &[bool],
    ) -> [Schedule; 2] {
        let steps = problem.step.iter();
        let active: Vec<bool> = (steps.clone())
            .map(|s| listed(s.temperatures.as_ref(), name))
            .collect();
        let sudden: Vec<bool> = steps.clone().map(|s| s.dynamic.is_some()).collect();
        let still: Vec<bool> = steps.map(|s| s.modal().is_some()).collect();
        let table = self.table(problem, amplitude);
        let whole = table.as_ref().map(|_| Course::Ramp(1.0, 1.0));
        [table.map(Course::Table), whole].map(|given| {
            let mut step = 0;
            self.schedule(&active, |on, factor, _| {
                let at_once = sudden[step] || !on && taken[step];
                let still = still[step];
                step += 1;
                match (on, &given) {
                    (_, None) if still => Course::Ramp(factor, factor),
                    (true, Some(course)) => course.clone(),
                    (true, None) => Course::Ramp(if at_once { 1.0 } else { factor }, 1.0),
                    (false, _) if factor != 0.0 && !at_once => Course::Ramp(factor, 0.0),
                    (false, _) => Course::Off,
                }
            })
        })
    }

    /// Supports lead from where the points are to the value over the first step in which they act, then hold.
    pub fn support(&self, problem: &Problem, name: &str, amplitude: Option<&str>) -> Schedule {
        let active: Vec<bool> = problem
            .step
            .iter()
            .map(|s| listed(s.supports.as_ref(), name))
            .collect();
        let table = self.table(problem, amplitude);
        self.schedule(&active, |on, _, was| match (on, &table) {
            (false, _) => Course::Off,
            (true, Some(table)) => Course::Table(table.clone()),
            (true, None) => Course::Ramp(if was { 1.0 } else { 0.0 }, 1.0),
        })
    }

    /// Equations begin and end like supports.
    pub fn equation(&self, problem: &Problem, name: &str, amplitude: Option<&str>) -> Schedule {
        let table = self.table(problem, amplitude);
        let active = coupled(problem, name);
        self.schedule(&active, |on, _, was| match (on, &table) {
            (false, _) => Course::Off,
            (true, Some(table)) => Course::Table(table.clone()),
            (true, None) => Course::Ramp(if was { 1.0 } else { 0.0 }, 1.0),
        })
    }

    /// Springs that are there in the first step are there from the beginning; later they come and go like loads.
    pub fn spring(&self, problem: &Problem, name: &str, amplitude: Option<&str>) -> Schedule {
        let table = self.table(problem, amplitude);
        let active = coupled(problem, name);
        let first = problem.step.iter().position(|s| s.dynamic.is_none());
        let steps = problem.step.iter().enumerate();
        let mut sudden = steps.map(|(k, s)| s.dynamic.is_some() || Some(k) == first);
        self.schedule(&active, |on, factor, _| {
            let at_once = sudden.next().unwrap_or(false);
            match (on, &table) {
                (true, Some(table)) => Course::Table(table.clone()),
                (true, None) => Course::Ramp(if at_once { 1.0 } else { factor }, 1.0),
                (false, _) if factor != 0.0 && !at_once => Course::Ramp(factor, 0.0),
                (false, _) => Course::Off,
            }
        })
    }

    pub fn interface(&self, problem: &Problem, name: &str) -> Schedule {
        let active: Vec<bool> = problem
            .step
            .iter()
            .map(|s| listed(s.interfaces.as_ref(), name))
            .collect();
        self.schedule(&active, |on, _, _| {
            if on {
                Course::Ramp(1.0, 1.0)
            } else {
                Course::Off
            }
        })
    }

    /// The steps, with the times on which increments land: ends, output times, rows of tables. Implicit ones that do not say where in an increment
    /// interfaces act take them at `contact_at`.
    pub fn steps(&self, problem: &Problem, contact_at: ContactAt) -> Vec<Step> {
        let mut times: Vec<f64> = Vec::new();
        for amplitude in problem.amplitude.values() {
            let rows = self.unroll(&amplitude.table);
            times.extend(rows.iter().map(|row| row[0]));
        }
        for motion in problem.obstacle.values().filter_map(|o| o.motion.as_ref()) {
            times.extend(motion.translation.iter().filter_map(|row| row.first()));
            times.extend(
                motion
                    .rotation
                    .iter()
                    .flat_map(|r| r.angle.iter().map(|a| a[0])),
            );
        }
        for interface in problem.interface.values() {
            let rows = interface.primary_velocity_table.iter().flatten();
            times.extend(rows.filter_map(|row| row.first()));
        }
        problem
            .step
            .iter()
            .zip(&self.spans)
            .enumerate()
            .map(|(i, (step, &(start, end)))| {
                let part = |fraction: f64| fraction * step.duration;
                let inc = &step.increments;
                let increments = match inc.fixed {
                    Some(n) => {
                        let size = part(1.0 / n as f64);
                        Increments {
                            initial: size,
                            smallest: size,
                            largest: size,
                        }
                    }
                    None => Increments {
                        initial: part(inc.initial),
                        smallest: part(inc.smallest),
                        largest: part(inc.largest),
                    },
                };
                let within = |times: &[f64]| -> Vec<f64> {
                    let times = times.iter().copied();
                    times.filter(|&t| t > start && t < end).collect()
                };
                let mut corners = within(&times);
                let blocks = step.cycles.map_or(1, Cycles::blocks);
                corners.extend((1..blocks).map(|n| block_end(start, step.duration, n)));
                corners.push(end);
                let mut milestones = within(&problem.output.times);
                milestones.extend(&corners);
                Step {
                    name: step
                        .name
                        .clone()
                        .unwrap_or_else(|| format!("step {}", i + 1)),
                    start,
                    end,
                    increments,
                    milestones,
                    corners,
                    fixed: inc.fixed.is_some(),
                    state_change: inc.state_change,
                    cycles: step.cycles.map(|c| Cycling {
                        period: step.duration,
                        count: c.count,
                        jump: c.jump,
                    }),
                    steady: step.steady.as_ref().map(SteadySliding::plan),
                    modal: step.modal(),
                    kick: step.kick.map(Kick::plan),
                    changes: (step.change.iter())
                        .map(|(name, change)| (name.clone(), change.clone()))
                        .collect(),
                    dynamic: step.dynamic.as_ref().map(|d| Dynamic {
                        method: d.scheme.as_dyn().method(),
                        mass: d.mass,
                        contact_mass: d.contact_mass,
                        contact_at: d.contact_at.unwrap_or(contact_at),
                        error: d.error,
                        events: d.events,
                    }),
                }
            })
            .collect()
    }
}

/// Where in an increment interfaces act unless a step says so: at its stage, which is of second order, where all laws are compliant. A multiplier there
/// would have to be right on the mean over the increment, and would swing from end to end.
pub(super) fn contact_at(problem: &Problem, couplings: &[Coupling]) -> ContactAt {
    let gives_way = !problem.interface.is_empty()
        && problem.interface.values().all(|i| i.is_compliant())
        && problem.pretension.is_empty()
        && couplings.iter().all(|c| !c.tie.firm());
    match gives_way {
        true => ContactAt::Stage,
        false => ContactAt::End,
    }
}

/// Whether a coupling is active, by step.
fn coupled(problem: &Problem, name: &str) -> Vec<bool> {
    let steps = problem.step.iter();
    steps.map(|s| listed(s.couplings.as_ref(), name)).collect()
}

/// When the cycle of this number ends.
fn block_end(start: f64, period: f64, number: usize) -> f64 {
    start + number as f64 * period
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A problem of a block with two loads and these steps.
    fn problem(steps: &str) -> Problem {
        let text = format!(
            r#"
            format = 1
            [model]
            space = "plane-strain"
            [body.block]
            generate.rectangle = {{ to = [1, 1], cells = [1, 1] }}
            material = "m"
            [material.m]
            isotropic = {{ young = 1.0, poisson = 0.0, density = 1.0 }}
            [support.bottom]
            set = "block.bottom"
            x = 0
            y = 0
            [load.push]
            set = "block.top"
            pressure.value = 1.0
            [load.pulse]
            set = "block.top"
            pressure.value = 1.0
            amplitude = "pulse"
            [amplitude.pulse]
            table = [[0, 0], [0.5, 1], [1, 0]]
            {steps}
            "#
        );
        Problem::from_toml(&text, None).unwrap_or_else(|e| panic!("{e}"))
    }

    fn factors(problem: &Problem, name: &str, amplitude: Option<&str>, times: &[f64]) -> Vec<f64> {
        let schedule = Timeline::new(problem).load(problem, name, amplitude);
        times.iter().map(|t| schedule.at(*t)).collect()
    }

    #[test]
    fn loads_grow_stay_and_fall_from_step_to_step() {
        let problem = problem(
            "[[step]]\nduration = 2\n\n[[step]]\nduration = 1\n\n[[step]]\nduration = 1\nloads = [\"pulse\"]\n\n[[step]]\nduration = 1\nloads = []\n",
        );
        let times = [0.0, 1.0, 2.0, 2.5, 3.0, 3.25, 3.75, 4.0, 4.5];
        assert_eq!(
            factors(&problem, "push", None, &times),
            [0.0, 0.5, 1.0, 1.0, 1.0, 0.75, 0.25, 0.0, 0.0]
        );
    }

    #[test]
    fn loads_of_steps_in_motion_come_and_go_at_once() {
        let problem = problem(
            "[[step]]\nduration = 1\nloads = []\n[[step]]\nduration = 1\ndynamic = {}\n[[step]]\nduration = 1\nloads = []\ndynamic = {}\n",
        );
        let at = factors(&problem, "push", None, &[0.5, 1.001, 1.5, 2.0, 2.5]);
        assert_eq!(at, [0.0, 1.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn tables_say_the_factor_and_are_told_once_for_all_cycles() {
        let once = problem("[[step]]\nduration = 1\n");
        let times = [0.25, 0.5, 0.75, 1.0];
        let pulse = factors(&once, "pulse", Some("pulse"), &times);
        assert_eq!(pulse, [0.5, 1.0, 0.5, 0.0]);
        let cycles = problem("[[step]]\nduration = 1\ncycles = { count = 3, jump = 1 }\n");
        let later: Vec<f64> = times.iter().map(|t| t + 2.0).collect();
        assert_eq!(factors(&cycles, "pulse", Some("pulse"), &later), pulse);
    }
}
