//! Explicit dynamics: springs in place of multipliers.

use std::collections::BTreeMap;

use super::all::{Act, Hold};
use super::{Couplings, Row, Tie};
use crate::system::{Links, Schedule};

impl Couplings {
    /// Enforces equations by springs, or by multipliers again. The springs start where their force is that of the multiplier. The energy `[J]` that they
    /// had and that is forgotten now is returned, negative.
    pub fn use_springs(&mut self, springs: bool) -> f64 {
        if self.explicit == springs {
            return 0.0;
        }
        self.explicit = springs;
        if springs {
            return 0.0;
        }
        self.keep_forces()
    }

    /// The couplings that springs stand for in an explicit step, with the energy of these springs at the last accepted state `[J]`. What a multiplier carried
    /// when the step began is in none of them.
    pub fn spring_energies(&self) -> Vec<(&str, f64)> {
        let mut out: Vec<(&str, f64)> = Vec::new();
        for (i, coupling, _) in self.rows() {
            let (hold, memory) = (self.hold[i], &self.memory);
            if !self.explicit || !coupling.tie.firm() || hold.idle || hold.stiffness <= 0.0 {
                continue;
            }
            let away = match memory.forces[i] == 0.0 {
                true => 0.0,
                false => memory.forces[i] - memory.multipliers[i],
            };
            let energy = away * away / (2.0 * hold.stiffness);
            match out.last_mut().filter(|(name, _)| *name == coupling.name) {
                Some((_, sum)) => *sum += energy,
                None => out.push((&coupling.name, energy)),
            }
        }
        out
    }

    /// Stiffnesses of the springs in place of equations: with these inverse masses by dof each has at most the squared frequency `highest` `[1/s²]`, that
    /// of the bodies, which makes increments shorter by a third at most; those that act at `t` share what there is.
    pub fn fit_springs(&mut self, (t, highest): (f64, f64), inverse_mass: &[f64], links: &Links) {
        let mut hold = std::mem::take(&mut self.hold);
        // Equations at the same place, or on the same rigid body, share what there is: by how much a unit of stiffness of all of them raises the squared frequency.
        let mut met = BTreeMap::<(bool, usize), f64>::new();
        let place = |dof: usize| match links.of_point(dof / self.dim) {
            Some(body) => (true, body),
            None => (false, dof),
        };
        for (i, coupling, row) in self.rows() {
            if matches!(self.act(i, coupling, t), Act::Held(_) | Act::Stopped(_)) {
                let all: f64 = row.terms().map(|(_, a)| a.abs()).sum();
                for (dof, a) in row.terms() {
                    *met.entry(place(dof)).or_default() += a.abs() * all * inverse_mass[dof];
                }
            }
        }
        for (i, _, row) in self.rows() {
            let shared = row.terms().filter_map(|(dof, _)| met.get(&place(dof)));
            let unit = shared.copied().fold(0.0, f64::max);
            hold[i] = Hold {
                stiffness: if unit > 0.0 { highest / unit } else { 0.0 },
                idle: unit == 0.0,
            };
        }
        self.hold = hold;
    }

    /// An upper bound of the squared frequency `[1/s²]` of all springs that act from `t` on, with these inverse masses by dof: by the rows of the
    /// stiffness (Gershgorin).
    pub fn highest_frequency(&self, t: f64, inverse_mass: &[f64], links: &Links) -> f64 {
        let mut rows = BTreeMap::new();
        for (i, coupling, row) in self.rows() {
            let stiffness = match self.act(i, coupling, t) {
                Act::Idle | Act::Pulled(_) | Act::Damped(_) => continue,
                Act::Sprung(_) => coupling.tie.stiffness() * most(&coupling.schedule),
                Act::Held(_) | Act::Stopped(_) => self.hold[i].stiffness,
            };
            add_row(&mut rows, row, stiffness);
        }
        self.largest(rows, inverse_mass, links)
    }

    /// An upper bound of the rate `[1/s]` at which all dashpots that act from `t` on take velocity away, found alike.
    pub fn highest_rate(&self, t: f64, inverse_mass: &[f64], links: &Links) -> f64 {
        let mut rows = BTreeMap::new();
        for (_, coupling, row) in self.rows() {
            if let Tie::Dashpot { coefficient } = coupling.tie
                && coupling.schedule.active(t)
            {
                add_row(&mut rows, row, coefficient * most(&coupling.schedule));
            }
        }
        self.largest(rows, inverse_mass, links)
    }

    /// The largest sum of a row of a matrix over the mass, those of a rigid body together.
    fn largest(&self, rows: BTreeMap<usize, f64>, inverse_mass: &[f64], links: &Links) -> f64 {
        let mut highest = 0.0_f64;
        let mut rigid = vec![0.0; links.all().len()];
        for (dof, k) in rows {
            let squared = k * inverse_mass[dof];
            match links.of_point(dof / self.dim) {
                None => highest = highest.max(squared),
                Some(body) => rigid[body] += squared,
            }
        }
        rigid.into_iter().fold(highest, f64::max)
    }
}

/// Adds the sizes in the rows of the matrix of one row with a stiffness.
fn add_row(rows: &mut BTreeMap<usize, f64>, row: &Row, stiffness: f64) {
    let all: f64 = row.terms().map(|(_, a)| a.abs()).sum();
    for (dof, a) in row.terms() {
        *rows.entry(dof).or_default() += stiffness * a.abs() * all;
    }
}

/// The largest factor of a spring's stiffness.
fn most(schedule: &Schedule) -> f64 {
    let ends = schedule.pieces.iter().flat_map(|p| [p.start, p.end]);
    ends.map(|t| schedule.at(t)).fold(0.0, f64::max)
}
