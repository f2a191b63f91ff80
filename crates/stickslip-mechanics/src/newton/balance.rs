use std::time::Instant;

use super::statistics::Statistics;
use super::system::System;
use crate::math::larger;
use crate::system::{Assembler, Links, Stage, State, StepFailure};

/// A residual and what it is compared with.
pub(super) struct Balance {
    /// Bulk and interfaces, by dof.
    pub forces: Vec<f64>,
    /// Norm over the free dofs.
    pub norm: f64,
    /// Scale of forces.
    pub scale: f64,
    /// What rounding leaves of the forces.
    pub floor: f64,
}

impl Balance {
    /// Evaluates all forces from the state `from` at the state `at`; `out` gets those of the interfaces, with their tangents if `tangent`.
    pub fn evaluate(
        system: &mut System,
        from: &State,
        at: &State,
        out: &mut Assembler,
        tangent: bool,
        statistics: &mut Statistics,
    ) -> Result<Balance, StepFailure> {
        let started = Instant::now();
        let stage = Stage {
            from,
            at,
            dt: at.t - from.t,
            rate: system.rate,
            frames: system.frames,
        };
        out.reset(tangent);
        for force in &mut system.contact {
            force.prepare(&stage);
            force.assemble(&stage, out)?;
        }
        statistics.evaluations += 1;
        statistics.seconds.contact += started.elapsed().as_secs_f64();
        let mut forces = vec![0.0; at.u.len()];
        let others = system.bulk.forces(&at.u, &mut forces);
        // The scale is of forces on the points: what a rigid body gets from two sides may cancel.
        let contact: f64 = out.residual.iter().map(|r| r * r).sum();
        transfer(system.links, out);
        if tangent && !out.tentative {
            system.bulk.covers(out)?;
        }
        let (mut norm, mut bulk) = (0.0, 0.0);
        let fixed = system.bulk.fixed();
        for &i in system.bulk.dofs() {
            forces[i] += out.residual[i];
            if !fixed[i] {
                let stiffness = system.bulk.diagonal(i);
                // Displacements that go back to nothing keep the rounding of those that they come from.
                let size = f64::max(at.u[i].abs(), from.u[i].abs());
                // Roundings of the largest term that the force at a dof of the bulk may be off by: a row of a stiffness has terms of both
                // signs.
                bulk += (4.0 * f64::EPSILON * stiffness * size).powi(2);
                norm += forces[i] * forces[i];
            }
        }
        Ok(Balance {
            forces,
            norm: norm.sqrt(),
            scale: larger(others, contact.sqrt()),
            floor: (out.rounding + bulk).sqrt(),
        })
    }

    /// The out-of-balance force relative to the scale of forces.
    pub fn relative(&self) -> f64 {
        if self.norm == 0.0 {
            0.0
        } else {
            self.compared(self.norm)
        }
    }

    /// What is left of the residual, with what `multipliers` miss: not a number where one of them is none.
    pub fn with(&self, multipliers: f64) -> f64 {
        larger(self.norm, multipliers)
    }

    /// Whether both are no more than the force that counts as none. Forces without end balance nothing, whatever they are compared with.
    pub fn is_met(&self, multipliers: f64, target: f64) -> bool {
        target.is_finite() && self.norm <= target && multipliers <= target
    }

    /// A force relative to the scale of forces.
    pub fn compared(&self, force: f64) -> f64 {
        force / self.scale.max(f64::MIN_POSITIVE)
    }

    /// The force that counts as none.
    pub fn target(&self, tolerance: f64) -> f64 {
        (tolerance * self.scale).max(self.floor)
    }
}

/// Lets what acts on the points of rigid bodies act on the bodies.
pub(super) fn transfer(links: &Links, out: &mut Assembler) {
    if links.is_empty() {
        return;
    }
    links.transfer(&mut out.residual);
    links.transfer(&mut out.condensed);
    for block in &mut out.blocks {
        if let Some(moved) = links.transform(block) {
            *block = moved;
        }
    }
    for dofs in &mut out.couplings {
        if let Some(moved) = links.transform_dofs(dofs) {
            *dofs = moved;
        }
    }
}
