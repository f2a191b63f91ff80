//! Explicit dynamics: equations that hold exactly, and springs in place of rigid stops.

use std::collections::BTreeMap;

use super::all::{ExactForce, Hold};
use super::definition::Act;
use super::{Coupling, Couplings, CouplingsMemory, Row, Tie};
use crate::system::{Links, Schedule};

/// Begins explicit increments, or ends them. The energy `[J]` that springs in place of rigid stops had and that is forgotten now is returned, negative.
pub fn use_springs(couplings: &mut Couplings, memory: &mut CouplingsMemory, springs: bool) -> f64 {
    if couplings.explicit == springs {
        return 0.0;
    }
    couplings.explicit = springs;
    if springs {
        return 0.0;
    }
    couplings.keep_forces(memory)
}

/// Starts from displacements `u` of the time `t`: what an equation is off by there it goes on to be off by, and a spring in place of a stop that carries something has the force of the multiplier. What
/// the tolerance of Newton's method leaves would be a jolt.
pub fn start_explicit(couplings: &Couplings, memory: &mut CouplingsMemory, t: f64, u: &[f64]) {
    let view = couplings.view(memory);
    let rest = couplings.rows().map(|(i, coupling, row)| {
        match (view.act(i, coupling, t), view.state.forces[i] != 0.0) {
            (Act::Held(target), true) => row.sum(u) - target,
            (Act::Stopped(clearance), true) => row.sum(u) + clearance,
            _ => 0.0,
        }
    });
    memory.rest = rest.collect();
}

/// The equations that an explicit increment to the time `t` holds exactly: the number of each row, the row, and what its sum has to be.
pub fn exact_rows<'a>(
    couplings: &'a Couplings,
    memory: &'a CouplingsMemory,
    t: f64,
) -> impl Iterator<Item = (usize, &'a Row, f64)> {
    let rows = couplings.rows().filter(|_| couplings.explicit);
    let view = couplings.view(memory);
    rows.filter_map(move |(i, coupling, row)| match view.act(i, coupling, t) {
        Act::Held(target) if !couplings.hold[i].idle => Some((i, row, target + memory.rest(i))),
        _ => None,
    })
}

/// Enters the forces along rows over the increment at hand, by number, and adds those at its end to the residual.
pub fn hold_exactly(
    couplings: &mut Couplings,
    forces: &BTreeMap<usize, ExactForce>,
    residual: &mut [f64],
) {
    let mut exact = vec![ExactForce::default(); couplings.hold.len()];
    for (i, _, row) in couplings.rows() {
        let Some(force) = forces.get(&i) else {
            continue;
        };
        exact[i] = *force;
        row.terms()
            .for_each(|(dof, a)| residual[dof] += a * force.to);
    }
    couplings.exact = exact;
}

/// Takes these forces for those of the last accepted state: what acts at the start of an explicit step.
pub fn start_exactly(couplings: &Couplings, memory: &mut CouplingsMemory) {
    for (i, force) in couplings.exact.iter().enumerate() {
        if couplings.explicit && *force != ExactForce::default() {
            memory.multipliers[i] = force.to;
            memory.forces[i] = force.to;
        }
    }
}

/// The rigid stops that springs stand for in an explicit step, with the energy of these springs at the last accepted state `[J]`. What a multiplier carried
/// when the step began is in none of them.
pub fn spring_energies<'a>(
    couplings: &'a Couplings,
    memory: &CouplingsMemory,
) -> Vec<(&'a str, f64)> {
    let mut out: Vec<(&str, f64)> = Vec::new();
    for (i, coupling, _) in couplings.rows() {
        let hold = couplings.hold[i];
        let stop = matches!(coupling.tie, Tie::Gap { .. }) && coupling.tie.firm();
        if !couplings.explicit || !stop || hold.idle || hold.stiffness <= 0.0 {
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

/// Stiffnesses of the springs in place of rigid stops: with these inverse masses by dof each has at most the squared frequency `highest` `[1/s²]`, that
/// of the bodies, which makes increments shorter by a third at most; those that act at `t` share what there is. Equations of nothing that could move are idle.
pub fn fit_springs(
    couplings: &mut Couplings,
    t: f64,
    highest: f64,
    inverse_mass: &[f64],
    links: &Links,
) {
    let of = |stops: bool| {
        let counts = |i: usize, c: &Coupling| match couplings.definition.act(i, c, 0.0, t) {
            Act::Stopped(_) => 1.0,
            Act::Held(_) if !stops => 1.0,
            _ => 0.0,
        };
        squared_frequencies(couplings, &counts, inverse_mass, links)
    };
    let hold = |(all, stops): (f64, f64)| Hold {
        stiffness: if stops > 0.0 { highest / stops } else { 0.0 },
        idle: all == 0.0,
    };
    couplings.hold = of(false).into_iter().zip(of(true)).map(hold).collect();
}

/// An upper bound of the squared frequency `[1/s²]` of all springs that act from `t` on, with these inverse masses by dof.
pub fn highest_frequency(
    couplings: &Couplings,
    t: f64,
    inverse_mass: &[f64],
    links: &Links,
) -> f64 {
    let definition = &couplings.definition;
    let stiffness = |i: usize, c: &Coupling| match definition.act(i, c, 0.0, t) {
        Act::Idle | Act::Pulled(_) | Act::Damped(_) | Act::Held(_) => 0.0,
        Act::Sprung(_) => c.tie.stiffness() * most(&c.schedule),
        Act::Stopped(_) => couplings.hold[i].stiffness,
    };
    let all = squared_frequencies(couplings, &stiffness, inverse_mass, links);
    all.into_iter().fold(0.0, f64::max)
}

/// An upper bound of the rate `[1/s]` at which all dashpots that act from `t` on take velocity away, found alike.
pub fn highest_rate(couplings: &Couplings, t: f64, inverse_mass: &[f64], links: &Links) -> f64 {
    let rate = |_: usize, coupling: &Coupling| match coupling.tie {
        Tie::Dashpot { coefficient } if coupling.schedule.active(t) => {
            coefficient * most(&coupling.schedule)
        }
        _ => 0.0,
    };
    let all = squared_frequencies(couplings, &rate, inverse_mass, links);
    all.into_iter().fold(0.0, f64::max)
}

/// By row `i` a bound of its part in the squared frequencies that springs with these stiffnesses make with inverse masses `w` by dof: those of `Aᵀ K A u = ω² M u` are the
/// eigenvalues of `K A M⁻¹ Aᵀ`, none of which is above the largest of `k_i Σ_d |a_id| w_d Σ_j |a_jd|` (Gershgorin), the sum over `j` being one of the rows that have a stiffness. A factor that is
/// rounding counts as much as it is. Dofs of a rigid body move together, and count as if they were one.
fn squared_frequencies(
    couplings: &Couplings,
    stiffness: &dyn Fn(usize, &Coupling) -> f64,
    inverse_mass: &[f64],
    links: &Links,
) -> Vec<f64> {
    let place = |dof: usize| match links.of_point(dof / couplings.dim) {
        Some(body) => (true, body),
        None => (false, dof),
    };
    let gives = |dof: usize, a: f64| a.abs() * inverse_mass[dof].sqrt();
    let mut met = BTreeMap::<(bool, usize), f64>::new();
    let acting = couplings.rows().map(|(i, c, row)| (stiffness(i, c), row));
    let acting: Vec<(f64, &Row)> = acting.collect();
    for (_, row) in acting.iter().filter(|(k, _)| *k != 0.0) {
        for (dof, a) in row.terms() {
            *met.entry(place(dof)).or_default() += gives(dof, a);
        }
    }
    let of = |(k, row): &(f64, &Row)| match *k != 0.0 {
        true => {
            k * row
                .terms()
                .map(|(dof, a)| gives(dof, a) * met[&place(dof)])
                .sum::<f64>()
        }
        false => 0.0,
    };
    acting.iter().map(of).collect()
}

/// The largest factor of a spring's stiffness.
fn most(schedule: &Schedule) -> f64 {
    let ends = schedule.pieces.iter().flat_map(|p| [p.start, p.end]);
    ends.map(|t| schedule.at(t)).fold(0.0, f64::max)
}
