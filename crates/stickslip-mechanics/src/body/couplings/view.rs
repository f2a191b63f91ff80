//! Couplings as those see them who only look: what they are, and what accepted increments have left.

use std::collections::BTreeMap;

use super::Row;
use super::definition::{Act, Coupling, CouplingsDefinition, Meets, Tie};
use super::memory::CouplingsMemory;

/// Shared references to what couplings are and to what they knew after an increment: that of now, or one that is reported later.
#[derive(Debug, Clone, Copy)]
pub struct CouplingsView<'a> {
    /// What they are.
    pub definition: &'a CouplingsDefinition,
    /// What accepted increments have left.
    pub state: &'a CouplingsMemory,
}

impl<'a> CouplingsView<'a> {
    /// What a row does at time `t`.
    pub(super) fn act(self, i: usize, coupling: &Coupling, t: f64) -> Act {
        self.definition.act(i, coupling, self.state.start[i], t)
    }

    /// The rows that hold something at time `t`: not those of dashpots, nor of gaps that are open.
    pub fn acting(self, t: f64) -> impl Iterator<Item = &'a Row> {
        let holding = self.holding(t).filter(|(_, open)| !open);
        holding.map(|(row, _)| row)
    }

    /// The rows of gaps that are open at the last accepted state, and stop what closes them at time `t`.
    pub fn stops(self, t: f64) -> impl Iterator<Item = &'a Row> {
        let holding = self.holding(t).filter(|(_, open)| *open);
        holding.map(|(row, _)| row)
    }

    /// The rows that hold something, and whether they are those of gaps that are open.
    fn holding(self, t: f64) -> impl Iterator<Item = (&'a Row, bool)> {
        self.definition.rows().filter_map(move |(i, c, row)| {
            let open = match c.tie {
                Tie::Gap { clearance, .. } => clearance > 0.0 && self.state.forces[i] >= 0.0,
                _ => false,
            };
            let holds = match self.act(i, c, t) {
                Act::Held(_) | Act::Stopped(_) => true,
                Act::Sprung(stiffness) => stiffness != 0.0,
                Act::Pulled(_) | Act::Damped(_) | Act::Idle => false,
            };
            holds.then_some((row, open))
        })
    }

    /// What small motions about the last accepted state meet at time `t`, row by row. Gaps that are closed are equations.
    pub fn linearise(self, t: f64) -> Vec<(&'a Row, Meets)> {
        let rows = self.definition.rows().filter_map(|(i, coupling, row)| {
            let gap = matches!(coupling.tie, Tie::Gap { .. });
            if gap && self.state.forces[i] >= 0.0 {
                return None;
            }
            match self.act(i, coupling, t) {
                Act::Held(_) | Act::Stopped(_) => Some((row, Meets::Equation)),
                Act::Sprung(stiffness) => Some((row, Meets::Spring(stiffness))),
                Act::Damped(coefficient) => Some((row, Meets::Dashpot(coefficient))),
                Act::Pulled(_) | Act::Idle => None,
            }
        });
        rows.collect()
    }

    /// The largest force with which a pretension draws at time `t` `[N]`; zero where lengths are held.
    pub fn tension(self, t: f64) -> f64 {
        let mut drawn: BTreeMap<&str, f64> = BTreeMap::new();
        for (i, coupling, _) in self.definition.rows() {
            if let Act::Pulled(force) = self.act(i, coupling, t) {
                *drawn.entry(&coupling.name).or_default() += force;
            }
        }
        drawn.into_values().fold(0.0, |m, f| f64::max(m, f.abs()))
    }

    /// The forces by which each pretension draws its sides together at time `t`, by dof `[N]`: those of both sides are opposite. Where lengths are held nothing
    /// is known of them.
    pub fn pulls(self, t: f64) -> BTreeMap<&'a str, Vec<(usize, f64)>> {
        let mut out: BTreeMap<&'a str, Vec<(usize, f64)>> = BTreeMap::new();
        for (i, coupling, row) in self.definition.rows() {
            if let Act::Pulled(force) = self.act(i, coupling, t) {
                let own = out.entry(&coupling.name).or_default();
                own.extend(row.terms().map(|(dof, a)| (dof, -a * force)));
            }
        }
        out
    }

    /// Energy in springs `[J]`.
    pub fn stored(self) -> f64 {
        self.state.stored
    }

    /// Work over the last increment of equations whose value changes, of springs whose stiffness does, and of forces of pretensions `[J]`.
    pub fn work(self) -> f64 {
        self.state.work
    }

    /// What dashpots took over the last increment `[J]`.
    pub fn damped(self) -> f64 {
        self.state.damped
    }

    /// The couplings, but for those to reference points, with the sum of the forces along their rows at the last accepted state `[N]`, and the mean of the sums
    /// of displacements `[m]`. A force is positive where it acts against a growing sum, as that of a stretched spring. Of pretensions they are the force that
    /// draws the sides together and the shortening.
    pub fn report(self, u: &'a [f64]) -> impl Iterator<Item = (&'a str, f64, f64)> {
        let mut first = 0;
        self.definition.all().iter().filter_map(move |coupling| {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            let (own, sign) = match &coupling.tie {
                Tie::Pretension(p) => {
                    let from = rows.len() + 1 - 2 * p.shares.len();
                    (from..from + p.shares.len(), -1.0)
                }
                _ => (0..rows.len(), 1.0),
            };
            let count = own.len() as f64;
            let forces = &self.state.forces[rows.start + own.start..rows.start + own.end];
            let force: f64 = forces.iter().sum();
            let sum: f64 = coupling.rows[own].iter().map(|r| r.sum(u)).sum();
            let said = (coupling.name.as_str(), sign * force, sum / count);
            (!coupling.referred).then_some(said)
        })
    }

    /// Adds what equations do to the displacements at the last accepted state, by dof `[N]`.
    pub fn add_equation_forces(self, out: &mut [f64]) {
        for ((_, coupling, row), force) in self.definition.rows().zip(&self.state.forces) {
            if matches!(coupling.tie, Tie::Equation { .. } | Tie::Pretension(_)) {
                row.terms().for_each(|(dof, a)| out[dof] -= a * force);
            }
        }
    }
}
