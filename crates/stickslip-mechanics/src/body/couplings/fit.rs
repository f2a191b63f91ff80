//! The stiffness by which multipliers are eliminated.

use super::Couplings;
use super::all::Hold;
use super::elimination::{ELIMINATION_STIFFNESS, Elimination, Held, compliance, resistance};
use crate::system::{ContactBlock, Links};

/// Chooses the stiffnesses of elimination for a bulk with this diagonal, by dof: those of the cells that a row moves. A spring to ground, or a mass, at a rigid
/// body or a reference point says nothing of how stiff these are: where a row moves nothing else the stiffest counts. Rows that share a weak
/// spring would hold no more than that otherwise, and what they join could strain between them.
pub fn fit(couplings: &mut Couplings, diagonal: &[f64], fixed: &[bool], links: &Links) {
    let springs = couplings.all().iter().map(|c| c.tie.stiffness());
    let typical = diagonal.iter().copied().chain(springs).fold(0.0, f64::max);
    // Where nothing has a stiffness any will do.
    let typical = if typical > 0.0 { typical } else { 1.0 };
    let Couplings {
        definition,
        hold,
        elimination,
        ..
    } = couplings;
    let dim = definition.dim;
    elimination.held.clear();
    // How many rows move a displacement.
    let mut shared = vec![0_u32; diagonal.len()];
    for (.., row) in definition.rows() {
        for (dof, _) in links.moved(row.terms()) {
            shared[dof] += 1;
        }
    }
    for (i, _, row) in definition.rows() {
        let free = links.moved(row.terms()).into_iter();
        let free = free.filter(|(dof, a)| !fixed[*dof] && *a != 0.0);
        let (carried, cells): (Vec<Held>, Vec<Held>) = free
            .map(|(dof, a)| Held {
                dof,
                squared: a * a,
                bulk: diagonal[dof],
            })
            .partition(|h| links.of_hidden(h.dof / dim).is_some());
        let own = |h: &Held| shared[h.dof] < 2;
        let cells = match cells.iter().any(|h| own(h) && h.bulk > 0.0) {
            true => cells.into_iter().filter(own).collect(),
            false => cells,
        };
        // What has no stiffness of its own, like a rigid body, follows whatever holds it.
        let norm = row.norm();
        let compliance = compliance(&cells, |h| h.bulk);
        let stiffest = carried.iter().map(|h| h.bulk).fold(0.0, f64::max);
        let stiffness = if compliance > 0.0 {
            1.0 / compliance
        } else if stiffest > 0.0 {
            stiffest / (norm * norm)
        } else {
            typical / (norm * norm)
        };
        hold[i] = Hold {
            stiffness: ELIMINATION_STIFFNESS * stiffness,
            idle: cells.is_empty() && carried.is_empty(),
        };
        elimination.held.push(match compliance > 0.0 {
            true => cells,
            false => cells.into_iter().chain(carried).collect(),
        });
    }
    elimination.links = (!links.is_empty()).then(|| links.clone());
    let give = diagonal.iter().zip(fixed).enumerate();
    let give = give.map(|(dof, (&k, &fixed))| {
        let carried = links.of_hidden(dof / dim).is_some();
        match k > 0.0 {
            true if !fixed && !carried => 1.0 / k,
            _ => 0.0,
        }
    });
    elimination.give = give.collect();
    elimination.stiffness.clear();
}

/// Chooses them anew beside contact with these tangents. A row between points that contact holds far more firmly than the bodies do has to be firmer
/// than contact: what the row says of them contact says as well, and each takes over from the other by the ratio of their stiffnesses.
pub(super) fn fit_beside(couplings: &mut Couplings, blocks: &[ContactBlock]) {
    let Elimination {
        stiffness,
        held,
        give,
        links,
        contact,
    } = &mut couplings.elimination;
    stiffness.clear();
    stiffness.extend(couplings.hold.iter().map(|hold| hold.stiffness));
    if !held.is_empty() && held.len() == stiffness.len() && !blocks.is_empty() {
        let moved: Vec<ContactBlock> = match links {
            Some(links) => {
                let moved = blocks.iter().map(|block| links.transform(block));
                let both = moved.zip(blocks);
                both.map(|(moved, block)| moved.unwrap_or_else(|| block.clone()))
                    .collect()
            }
            None => Vec::new(),
        };
        let blocks = if links.is_some() { &moved } else { blocks };
        resistance(blocks, give, contact);
        let beside = |dof: usize| contact.get(dof).copied().unwrap_or(0.0);
        for (stiffness, held) in stiffness.iter_mut().zip(held) {
            if held.iter().any(|h| beside(h.dof) > 0.0) {
                let all = compliance(held, |h| h.bulk + beside(h.dof));
                *stiffness = stiffness.max(ELIMINATION_STIFFNESS / all);
            }
        }
    }
}

/// Forgets contact: nothing of an attempt shows in the next one.
pub(super) fn fit_alone(couplings: &mut Couplings) {
    couplings.elimination.stiffness.clear();
}
