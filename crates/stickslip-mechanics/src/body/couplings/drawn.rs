//! Pretensions from step to step.

use std::collections::BTreeMap;
use std::ops::Range;

use super::all::{Act, Couplings};
use super::{Pretension, Row};

impl Couplings {
    /// The largest force with which a pretension draws at time `t` `[N]`; zero where lengths are held.
    pub fn tension(&self, t: f64) -> f64 {
        let mut drawn: BTreeMap<&str, f64> = BTreeMap::new();
        for (i, coupling, _) in self.rows() {
            if let Act::Pulled(force) = self.act(i, coupling, t) {
                *drawn.entry(&coupling.name).or_default() += force;
            }
        }
        drawn.into_values().fold(0.0, |m, f| f64::max(m, f.abs()))
    }

    /// The forces by which each pretension draws its sides together at time `t`, by dof `[N]`: those of both sides are opposite. Where lengths are held nothing
    /// is known of them.
    pub fn pulls(&self, t: f64) -> BTreeMap<&str, Vec<(usize, f64)>> {
        let mut out: BTreeMap<&str, Vec<(usize, f64)>> = BTreeMap::new();
        for (i, coupling, row) in self.rows() {
            if let Act::Pulled(force) = self.act(i, coupling, t) {
                let own = out.entry(&coupling.name).or_default();
                own.extend(row.terms().map(|(dof, a)| (dof, -a * force)));
            }
        }
        out
    }

    /// Begins a step of a pretension at displacements `u`. Where it changes between force and length the forces between all pairs of points stay: those of
    /// the rows that let go are handed to the others.
    pub(super) fn draw(
        &mut self,
        p: &Pretension,
        (before, middle): (Option<f64>, f64),
        (rows, own): (Range<usize>, &[Row]),
        u: &[f64],
    ) {
        let count = p.shares.len();
        let across = rows.len() + 1 - 2 * count;
        let along = rows.start + across..rows.start + across + count;
        let equal = along.end..rows.end;
        let (was, is) = (before.map(|t| p.pulled(t)), p.pulled(middle));
        let memory = &mut self.memory;
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
                    let force = std::mem::take(&mut memory.forces[e]);
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
            self.start[i] = if is { -memory.forces[i] } else { sum };
            memory.targets[i] = if is { 0.0 } else { sum };
        }
    }
}
