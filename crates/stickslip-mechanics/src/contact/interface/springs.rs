//! Explicit dynamics: springs in place of multipliers, and how stiff they are; ties that hold exactly.

use super::definition::Interface;
use crate::contact::enforcement::Multipliers;
use crate::math::norm;
use crate::system::{Assembler, Links};

/// Penetration of a point about to touch, relative to the cell beneath.
const TOUCHED: f64 = 1e-6;

/// One direction in which an explicit increment holds a point of a tie exactly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TieRow {
    /// The point.
    pub point: usize,
    /// The gap, or one of the two components of slip.
    pub direction: usize,
    /// Gradient of it, by dof.
    pub terms: Vec<(usize, f64)>,
    /// What it is, and should not be `[m]`.
    pub off: f64,
    /// Area that the point stands for `[m²]`.
    pub area: f64,
    /// What it is a sum of, rounding of which shows in it `[m]`.
    pub size: f64,
}

impl Interface {
    /// Whether explicit increments hold the interface exactly: it is a tie, and not one by a penalty, which is a spring.
    pub(super) fn holds_exactly(&self) -> bool {
        let multipliers = self.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
        self.laws.tied && self.history.springs && multipliers
    }

    /// What is to be held exactly, as it was at the last evaluation.
    pub fn tie_rows(&self) -> Vec<TieRow> {
        let mut out = Vec::new();
        if !self.holds_exactly() {
            return out;
        }
        let largest = self.reference.iter().map(|&x| norm(x)).fold(0.0, f64::max);
        let points = self.cache.last.points.iter().enumerate();
        for (i, e) in points {
            let batch = self.cache.last.batch(i);
            let Some(tangent) = batch.tangent(e) else {
                continue;
            };
            let (mut dofs, mut rows) = (batch.dofs(e).to_vec(), tangent.rows.to_vec());
            (self.cache.in_space).gradients(&mut dofs, &mut rows);
            for (direction, row) in rows.chunks_exact(dofs.len()).enumerate() {
                let terms = dofs.iter().copied().zip(row.iter().copied());
                let terms: Vec<_> = terms.filter(|(_, a)| *a != 0.0).collect();
                if !terms.is_empty() {
                    let factors: f64 = terms.iter().map(|(_, a)| a.abs()).sum();
                    out.push(TieRow {
                        point: i,
                        direction,
                        terms,
                        off: e.off[direction],
                        area: e.area,
                        size: factors * largest,
                    });
                }
            }
        }
        out
    }

    /// Lets these tractions `[Pa]`, by point and along the directions of its rows, be those of the last evaluation, and adds their forces to a residual.
    pub fn pull_ties(&mut self, tractions: &[(usize, [f64; 3])], out: Option<&mut Assembler>) {
        for &(i, traction) in tractions {
            self.cache.last.pull(i, traction);
        }
        let Some(out) = out else {
            return;
        };
        let mut spatial = Assembler::new(out.residual.len());
        for &(i, _) in tractions {
            let (batch, e) = (self.cache.last.batch(i), &self.cache.last.points[i]);
            spatial.add_residual(batch.dofs(e), batch.force(e).unwrap_or_default());
        }
        self.cache.in_space.assemble(&mut spatial, out);
    }

    /// Enforces contact and stick by springs in explicit dynamics, whatever the enforcement: those of a penalty, or as stiff as the cells
    /// beneath.
    ///
    /// What presses already goes on pressing: a spring starts where its force is that of the multiplier it replaces. The energy `[J]` that this
    /// puts into the springs is returned.
    pub fn use_springs(&mut self, springs: bool) -> f64 {
        // Every step says anew how it is integrated.
        self.directives.impulses = false;
        if self.history.springs == springs {
            return 0.0;
        }
        let before = self.stored_energy();
        self.history.springs = springs;
        self.history.rest.clear();
        let multipliers = self.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
        if springs && multipliers && self.laws.needs_normal_stiffness() {
            let exact = self.holds_exactly();
            let points = self.points.iter().zip(&self.history.points);
            self.history.rest = points
                .map(|(p, h)| {
                    if exact && h.gap.is_finite() {
                        h.gap
                    } else if h.pressure > 0.0 || self.laws.tied && h.gap.is_finite() {
                        h.gap + h.pressure / p.stiffness
                    } else {
                        0.0
                    }
                })
                .collect();
        }
        // Springs of stick come or go with the shear that there is; what holds exactly has none.
        let points = self.history.points.iter().zip(&self.points);
        let sheared: Vec<f64> = points
            .map(|(h, p)| self.sheared(h.shear, self.tangential_stiffness(p.stiffness)))
            .collect();
        let points = self.history.points.iter_mut().zip(sheared);
        points.for_each(|(h, sheared)| h.sheared = sheared);
        self.history.energy.stored = self.stored_energy();
        self.history.energy.stored - before
    }

    /// An upper bound of the squared frequency `[1/s²]` that the springs of the interface have with these inverse masses by dof: by the
    /// rows of its stiffness (Gershgorin). Springs that are not in contact count as well where they have a stiffness of their own. For
    /// a rigid body the springs at all its points add up, each with what the body gives way there, `1/m + |arm|²/I` as inverse mass.
    pub fn highest_frequency(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        if self.holds_exactly() {
            return 0.0;
        }
        let inverse = |node: usize| inverse_mass[self.dofs.of(node, 0)];
        self.highest_eigenvalue(&|i| self.stiffest(i, links), &inverse, links)
    }

    /// The same of compliant laws and springs alone, as they were pressed in the last evaluation, with inverse masses by point of the mesh: what is
    /// held by multipliers has no frequency.
    pub fn pressed_frequency(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        if self.unknown() && self.laws.needs_normal_stiffness() {
            return 0.0;
        }
        let last = &self.cache.last.points;
        let pressed = |i: usize| {
            last.get(i)
                .map_or(0.0, |e| e.response.d_gap[0][0] - e.response.d_rate[0])
        };
        self.highest_eigenvalue(&|i| pressed(i).abs(), &|node| inverse_mass[node], links)
    }

    /// An upper bound of the rate `[1/s]` at which what laws add with the velocity takes it away, in the same way.
    pub fn highest_rate(&self, inverse_mass: &[f64], links: &Links) -> f64 {
        let last = &self.cache.last.points;
        let damping = self.laws.damping.as_dyn();
        let touched = |i: usize| {
            let depth = TOUCHED * self.points[i].size;
            let own = self.laws.normal_law().pressure(-depth);
            own.map_or(self.points[i].stiffness * depth, |p| p.value)
        };
        let viscosity = |i: usize| {
            let now = last.get(i).map_or(0.0, |e| e.viscosity);
            // No frequency bounds the step on the way to a dashpot.
            match damping.active() {
                true => now.max(damping.extra(touched(i), 0.0).d_rate),
                false => now,
            }
        };
        let inverse = |node: usize| inverse_mass[self.dofs.of(node, 0)];
        self.highest_eigenvalue(&viscosity, &inverse, links)
    }

    /// The spring of a point `[Pa/m]`: what there is, and what there will be when it touches.
    fn stiffest(&self, i: usize, links: &Links) -> f64 {
        let point = &self.points[i];
        let own = if self.laws.needs_normal_stiffness() {
            self.spring(self.laws.enforcement.as_dyn().normal(), point.stiffness)
        } else {
            0.0
        };
        let now = self.cache.last.points.get(i).map_or(0.0, |e| e.slope());
        // A rigid body has no cells whose frequency would bound the step on the way to a compliant surface.
        let rigid = |&node: &usize| links.of_point(self.nodes[node]).is_some();
        let touched = || self.laws.normal_law().pressure(-TOUCHED * point.size);
        let ahead = match point.nodes.iter().any(rigid) {
            true => -touched().map_or(0.0, |p| p.slope),
            false => 0.0,
        };
        own.max(now).max(ahead)
    }

    /// A bound of the largest eigenvalue of something per area at the points over the masses.
    fn highest_eigenvalue(
        &self,
        of: &dyn Fn(usize) -> f64,
        inverse_mass: &dyn Fn(usize) -> f64,
        links: &Links,
    ) -> f64 {
        let mut rows: Vec<f64> = vec![0.0; self.nodes.len()];
        let sides = if self.rigid() { 1.0 } else { 2.0 };
        for (i, point) in self.points.iter().enumerate() {
            // Of a mortar less than the whole of a point may have something opposite.
            let whole = sides * point.area * of(i);
            if whole == 0.0 {
                continue;
            }
            for (node, w) in self.weights_of(i) {
                rows[node] += whole * w.abs();
            }
        }
        let mut highest = 0.0_f64;
        let mut rigid = vec![0.0; links.all().len()];
        for (k, &node) in rows.iter().zip(&self.nodes) {
            let own = k * inverse_mass(node);
            match links.of_point(node) {
                None => highest = highest.max(own),
                Some(body) => rigid[body] += own,
            }
        }
        rigid.into_iter().fold(highest, f64::max)
    }
}
