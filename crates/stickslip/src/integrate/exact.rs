//! What an explicit increment holds exactly: equations between displacements, and ties.
//!
//! With the rows `A` of all that is held, forces `Aᵀ λ` act on the bodies. Two conditions give them, as in RATTLE (Andersen 1983, J. Comput. Phys. 52, 24-34), with the acceleration in place
//! of the velocity:
//!
//! ```text
//! A M⁻¹ Aᵀ λ₁ = A M⁻¹ (F₁ - f(u₁) - R(u₁))          at the end: what holds goes on holding
//! A M⁻¹ Aᵀ μ = (A u₁ - g₁) / dt,  v½ -= M⁻¹ Aᵀ μ     in the middle: what supports, values and turning rows leave of it
//! ```
//!
//! Rows that say the same twice leave `λ` undetermined, but not `Aᵀ λ`: conjugate gradients find one of all.

use std::collections::BTreeMap;

use crate::body::couplings::{ExactForce, explicit};
use crate::contact::interface::pull_ties;
use crate::contact::look;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::solve::spin::Spin;
use crate::system::{Assembler, Cause, Links, State, StepFailure};
use crate::tolerance::SAME;

/// What conjugate gradients leave of a right-hand side. Double precision gives no more.
const GRADIENTS_RESIDUAL: f64 = 1e-13;

/// Roundings of its terms that a sum may be off.
const SUM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Rows of all that is held.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
struct Rows {
    /// Numbers of the rows of couplings, which come first, and sums that they should have.
    coupled: Vec<(usize, f64)>,
    /// Interface, point and direction of the rows of ties.
    tied: Vec<[usize; 3]>,
    /// Area of the point, what is off at the state that they are of, and the size of that which it is a sum of.
    ties: Vec<[f64; 3]>,
    /// Terms of all rows, by the dofs that move, and these dofs in order.
    terms: Vec<Vec<(usize, f64)>>,
    dofs: Vec<usize>,
}

/// All that is held, and the forces that hold it.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(crate) struct Exact {
    rows: Rows,
    /// Forces along the rows.
    forces: Vec<f64>,
    /// What is shown on supports beyond that, by dof `[N]`; empty if nothing is.
    beyond: Vec<f64>,
}

/// How dofs give way to forces.
pub(crate) struct Mobility<'a> {
    /// Inverse masses, and whether supports hold the dofs.
    pub inverse: &'a [f64],
    pub fixed: &'a [bool],
    pub spins: &'a [Spin],
}

impl Mobility<'_> {
    /// Accelerations of these dofs by forces.
    fn accelerate(&self, dofs: &[usize], force: &[f64], out: &mut [f64]) {
        for &dof in dofs {
            out[dof] = match self.fixed[dof] {
                true => 0.0,
                false => self.inverse[dof] * force[dof],
            };
        }
        for spin in self.spins {
            let range = spin.range();
            let own = dofs.partition_point(|d| *d < range.start);
            let own = &dofs[own..dofs.partition_point(|d| *d < range.end)];
            if own.is_empty() {
                continue;
            }
            let turn = spin.acceleration(spin.of(force), self.fixed, [0.0; 3]);
            for &dof in own.iter().filter(|d| !self.fixed[**d]) {
                out[dof] = turn[dof - range.start];
            }
        }
    }
}

impl Rows {
    fn list_dofs(&mut self) {
        let all = self.terms.iter().flatten();
        self.dofs = all.map(|(dof, _)| *dof).collect();
        self.dofs.sort_unstable();
        self.dofs.dedup();
    }

    /// Sums of the rows.
    fn sums(&self, x: &[f64]) -> Vec<f64> {
        let sum = |terms: &Vec<(usize, f64)>| terms.iter().map(|(d, a)| a * x[*d]).sum();
        self.terms.iter().map(sum).collect()
    }

    /// The same with all terms positive.
    fn sizes(&self, x: &[f64]) -> Vec<f64> {
        let sum = |terms: &Vec<(usize, f64)>| terms.iter().map(|(d, a)| (a * x[*d]).abs()).sum();
        self.terms.iter().map(sum).collect()
    }

    /// Forces along the rows to forces by dof.
    fn spread(&self, along: &[f64], out: &mut [f64]) {
        for (terms, f) in self.terms.iter().zip(along) {
            terms.iter().for_each(|(dof, a)| out[*dof] += a * f);
        }
    }

    /// Solves `A M⁻¹ Aᵀ x = b` from `x` on, where each of `b` is a sum of terms of this `size`.
    fn solve(
        &self,
        mobility: &Mobility,
        b: &[f64],
        size: &[f64],
        x: &mut [f64],
    ) -> Result<(), StepFailure> {
        let dofs = &self.dofs;
        let count = mobility.inverse.len();
        let (mut force, mut moved) = (vec![0.0; count], vec![0.0; count]);
        let mut apply = |x: &[f64]| -> Vec<f64> {
            dofs.iter().for_each(|d| force[*d] = 0.0);
            self.spread(x, &mut force);
            mobility.accelerate(dofs, &force, &mut moved);
            self.sums(&moved)
        };
        let give: Vec<f64> = self.terms.iter().map(|t| own_give(t, mobility)).collect();
        let weighed = |r: &[f64], z: &[f64]| -> f64 {
            let of = r.iter().zip(z).zip(&give).filter(|(_, g)| **g > 0.0);
            of.map(|((r, z), g)| r * z / g).sum()
        };
        let mut r: Vec<f64> = apply(x);
        let start = weighed(&r, &r);
        for ((r, b), g) in r.iter_mut().zip(b).zip(&give) {
            // A row needs no force where supports hold all of its dofs.
            *r = if *g > 0.0 { b - *r } else { 0.0 };
        }
        let whole = weighed(size, size) + start;
        let given = weighed(b, b) + start;
        let least = (GRADIENTS_RESIDUAL * GRADIENTS_RESIDUAL * given)
            .max(SUM_ROUNDING * SUM_ROUNDING * whole);
        let precede = |r: &[f64]| -> Vec<f64> {
            let of = r.iter().zip(&give);
            of.map(|(r, g)| if *g > 0.0 { r / g } else { 0.0 })
                .collect()
        };
        let mut rest = weighed(&r, &r);
        let mut way = precede(&r);
        for _ in 0..10 * b.len() + 100 {
            if rest <= least {
                return Ok(());
            }
            let q = apply(&way);
            let along: f64 = way.iter().zip(&q).map(|(p, q)| p * q).sum();
            if along <= 0.0 {
                break;
            }
            let step = rest / along;
            for (((x, r), p), q) in x.iter_mut().zip(&mut r).zip(&way).zip(&q) {
                *x += step * p;
                *r -= step * q;
            }
            let now = weighed(&r, &r);
            let turn = now / rest;
            rest = now;
            for (p, z) in way.iter_mut().zip(precede(&r)) {
                *p = z + turn * *p;
            }
        }
        // Rows contradict each other by rounding alone.
        match rest <= SAME * SAME * whole {
            true => Ok(()),
            false => Err(contradiction()),
        }
    }
}

impl Exact {
    /// The rows that hold at time `t`, those of ties as they were at the last evaluation. What is known of the forces `before` is kept.
    pub fn gather(
        model: &Model,
        frame: &Frame,
        contact: &Contact,
        t: f64,
        before: &Exact,
    ) -> Exact {
        let contacts = &frame.contacts;
        let links = &model.links;
        let coupled = explicit::exact_rows(&contact.couplings, &contacts.couplings, t);
        let mut out = Exact::default();
        for (i, row, target) in coupled {
            let known = before.rows.coupled.get(out.rows.coupled.len());
            let terms = match known.is_some_and(|(k, _)| *k == i) {
                true => before.rows.terms[out.rows.coupled.len()].clone(),
                false => links.moved(row.terms()),
            };
            out.rows.coupled.push((i, target));
            out.rows.terms.push(terms);
            out.forces.push(contacts.couplings.exact_force(i));
        }
        let forces = before.forces[before.rows.coupled.len()..].iter();
        let mut known = before.rows.tied.iter().zip(forces);
        let interfaces = contact.interfaces.iter().zip(&contacts.interfaces);
        for (k, (interface, history)) in interfaces.enumerate() {
            for row in look::tie_rows(interface, history) {
                let of = [k, row.point, row.direction];
                // The rows of a tie are the same from one increment to the next.
                let force = known.next().filter(|(known, _)| **known == of);
                out.rows.tied.push(of);
                out.rows.ties.push([row.area, row.off, row.size]);
                out.rows.terms.push(links.moved(row.terms));
                out.forces.push(force.map_or(0.0, |(_, f)| *f));
            }
        }
        out.rows.list_dofs();
        out
    }

    /// Takes what couplings hold at time `t`.
    pub fn lead(&mut self, links: &Links, contact: &Contact, frame: &Frame, t: f64) {
        let memory = &frame.contacts.couplings;
        let rows: Vec<_> = explicit::exact_rows(&contact.couplings, memory, t).collect();
        let known = |(row, (i, _)): (&(usize, _, f64), &(usize, f64))| row.0 == *i;
        let same =
            rows.len() == self.rows.coupled.len() && rows.iter().zip(&self.rows.coupled).all(known);
        if !same {
            let count = self.rows.coupled.len();
            let before: BTreeMap<usize, f64> = (self.rows.coupled.iter().zip(&self.forces))
                .map(|((i, _), f)| (*i, *f))
                .collect();
            let force = |i: &usize| before.get(i).copied().unwrap_or(0.0);
            let terms = rows.iter().map(|(_, row, _)| links.moved(row.terms()));
            self.rows.terms.splice(..count, terms);
            let forces = rows.iter().map(|(i, ..)| force(i));
            self.forces.splice(..count, forces);
            self.rows.list_dofs();
        }
        self.rows.coupled = rows.into_iter().map(|(i, _, target)| (i, target)).collect();
    }

    /// It where a step begins and nothing is off, without forces yet; and the forces along the rows.
    pub fn begin(mut self) -> (Exact, Vec<f64>) {
        self.rows.ties.iter_mut().for_each(|[_, off, _]| *off = 0.0);
        let forces = vec![0.0; self.forces.len()];
        (Exact { forces, ..self }, self.forces)
    }

    /// Adds forces along the rows.
    pub fn add_forces(&mut self, more: &[f64]) {
        self.forces.iter_mut().zip(more).for_each(|(f, m)| *f += m);
    }

    /// Whether nothing is held.
    pub fn is_empty(&self) -> bool {
        self.rows.terms.is_empty()
    }

    /// Corrects what an increment of length `dt` leads to, displacements `u` and velocities `v` by dof, so that all holds at its end; `placed` are the displacements in space, and `from` those at the start. Forces along the rows
    /// are returned, which would do the same from the start of the increment on.
    pub fn correct(
        &self,
        mobility: &Mobility,
        links: &Links,
        dt: f64,
        from: &[f64],
        placed: &[f64],
        at: &mut State,
    ) -> Result<Vec<f64>, StepFailure> {
        let State { u, v, .. } = at;
        let ways: Vec<f64> = u.iter().zip(from).map(|(u, from)| u - from).collect();
        let (sums, along) = (self.rows.sums(placed), self.rows.sums(&ways));
        let targets = self.rows.coupled.iter().map(|(_, target)| *target);
        let coupled = sums.iter().zip(targets).map(|(sum, target)| sum - target);
        let tied = self.rows.ties.iter().zip(&along[self.rows.coupled.len()..]);
        let tied = tied.map(|([_, off, _], way)| off + way);
        let off: Vec<f64> = coupled.chain(tied).collect();
        let mut size = self.rows.sizes(placed);
        for (size, [.., of]) in size[self.rows.coupled.len()..]
            .iter_mut()
            .zip(&self.rows.ties)
        {
            *size += of;
        }
        let mut impulses = vec![0.0; off.len()];
        self.rows.solve(mobility, &off, &size, &mut impulses)?;
        let mut push = vec![0.0; u.len()];
        self.rows.spread(&impulses, &mut push);
        let mut change = vec![0.0; u.len()];
        mobility.accelerate(&self.rows.dofs, &push, &mut change);
        for &dof in &self.rows.dofs {
            u[dof] -= change[dof];
            v[dof] -= change[dof] / dt;
        }
        links.impose(u);
        links.impose(v);
        Ok(impulses.iter().map(|i| 2.0 * i / (dt * dt)).collect())
    }

    /// Lets the start of an increment have had these forces as well, which [`correct`](Self::correct) found.
    pub fn restart(&self, mobility: &Mobility, more: &[f64], from: &mut Frame) {
        let mut push = vec![0.0; from.state.a.len()];
        self.rows.spread(more, &mut push);
        let mut change = vec![0.0; push.len()];
        mobility.accelerate(&self.rows.dofs, &push, &mut change);
        for &dof in &self.rows.dofs {
            from.state.a[dof] -= change[dof];
            if mobility.fixed[dof] && !from.forces.is_empty() {
                let beyond = self.beyond.get(dof).copied().unwrap_or(0.0);
                from.forces[dof] += push[dof] - beyond;
            }
        }
    }

    /// Finds the forces with which accelerations `a`, those of dofs that are fixed left out, go along with all that is held.
    pub fn balance(&mut self, mobility: &Mobility, a: &[f64]) -> Result<(), StepFailure> {
        let free = |dof: usize| if mobility.fixed[dof] { 0.0 } else { a[dof] };
        let mut seen = vec![0.0; a.len()];
        for &dof in &self.rows.dofs {
            seen[dof] = free(dof);
        }
        let (b, size) = (self.rows.sums(&seen), self.rows.sizes(&seen));
        // The forces of the increment before are a good guess.
        self.rows.solve(mobility, &b, &size, &mut self.forces)
    }

    /// Accelerations of the dofs in question by forces `f` by dof.
    pub fn accelerations(&self, mobility: &Mobility, f: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; f.len()];
        mobility.accelerate(&self.rows.dofs, f, &mut out);
        out
    }

    /// Hands the forces to couplings and ties and adds them to the residual: `before` are those that the rows had at the start of the increment, and `more` what they had as well to hold at its end.
    pub fn act(
        &self,
        before: &Exact,
        more: &[f64],
        contact: &mut Contact,
        links: &Links,
        out: &mut Assembler,
    ) {
        let mut residual = Assembler::new(out.residual.len());
        // A value or a support that moves on with the same acceleration needs as much again.
        let extra = |k: usize| more.get(k).map_or(0.0, |m| 0.5 * m);
        let of = |(k, &(i, _)): (usize, &(usize, f64))| {
            let to = self.forces[k];
            let from = match before.rows.coupled.get(k).is_some_and(|(b, _)| *b == i) {
                true => before.forces[k] + 2.0 * extra(k),
                false => to,
            };
            let shown = to + extra(k);
            (i, ExactForce { from, to, shown })
        };
        let forces: BTreeMap<usize, ExactForce> =
            self.rows.coupled.iter().enumerate().map(of).collect();
        explicit::hold_exactly(&mut contact.couplings, &forces, &mut residual.residual);
        self.pull(contact, |_| 0.0, Some(&mut residual));
        links.transfer(&mut residual.residual);
        for (to, r) in out.residual.iter_mut().zip(&residual.residual) {
            *to += r;
        }
    }

    /// Gives ties their tractions, and more.
    fn pull(
        &self,
        contact: &mut Contact,
        more: impl Fn(usize) -> f64,
        mut out: Option<&mut Assembler>,
    ) {
        let count = self.rows.coupled.len();
        let mut tractions: Vec<Vec<(usize, [f64; 3])>> = vec![Vec::new(); contact.interfaces.len()];
        let rows = self.rows.tied.iter().zip(&self.rows.ties);
        for (k, (&[interface, point, direction], [area, ..])) in rows.enumerate() {
            // The force along a row acts against what is off; a traction presses apart.
            let traction = -(self.forces[count + k] + more(count + k)) / area;
            let of = &mut tractions[interface];
            match of.last_mut().filter(|(p, _)| *p == point) {
                Some((_, t)) => t[direction] = traction,
                None => {
                    let mut t = [0.0; 3];
                    t[direction] = traction;
                    of.push((point, t));
                }
            }
        }
        for (interface, tractions) in contact.interfaces.iter_mut().zip(&tractions) {
            if !tractions.is_empty() {
                pull_ties(interface, tractions, out.as_deref_mut());
            }
        }
    }

    /// Shows on ties and supports what moving supports and values accelerate beside what acts: half of what [`correct`](Self::correct) found, the mean over the increment.
    pub fn show(
        &mut self,
        more: &[f64],
        fixed: &[bool],
        contact: &mut Contact,
        forces: &mut [f64],
    ) {
        if more.is_empty() || more.len() != self.rows.terms.len() {
            return;
        }
        let half: Vec<f64> = more.iter().map(|m| 0.5 * m).collect();
        self.pull(contact, |k| half[k], None);
        let mut beyond = vec![0.0; forces.len()];
        self.rows.spread(&half, &mut beyond);
        for ((force, more), fixed) in forces.iter_mut().zip(&mut beyond).zip(fixed) {
            *more = if *fixed { *more } else { 0.0 };
            *force += *more;
        }
        self.beyond = beyond;
    }
}

/// How far a row gives way to a force along itself alone `[1/kg]`.
fn own_give(terms: &[(usize, f64)], mobility: &Mobility) -> f64 {
    let turning = |dof: usize| mobility.spins.iter().find(|s| s.range().contains(&dof));
    let give = |&(dof, a): &(usize, f64)| match (mobility.fixed[dof], turning(dof)) {
        (true, _) => 0.0,
        (false, Some(spin)) => {
            let mut unit = [0.0; 3];
            unit[dof - spin.range().start] = a;
            a * spin.acceleration(unit, mobility.fixed, [0.0; 3])[dof - spin.range().start]
        }
        (false, None) => a * a * mobility.inverse[dof],
    };
    terms.iter().map(give).sum()
}

fn contradiction() -> StepFailure {
    StepFailure::new(
        Cause::NotConverged,
        "equations and ties contradict each other, or the supports: no motion satisfies all of them",
    )
    .help("take away one of those that act on the same points")
}
