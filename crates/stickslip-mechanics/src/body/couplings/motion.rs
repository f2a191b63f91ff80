//! The forces of equations at the start of motion, and how points without mass go with those that have one.

use super::definition::Act;
use super::{Couplings, CouplingsMemory};
use crate::linear::{GmresSettings, gmres};
use crate::system::{Links, StepFailure};
use crate::tolerance::ROUNDING;

/// Accelerations under forces, both by dof.
type Accelerate<'a> = &'a mut dyn FnMut(&[f64]) -> Result<Vec<f64>, StepFailure>;

/// Where a motion starts.
pub struct MotionStart<'a> {
    /// The time `[s]`.
    pub t: f64,
    /// Rigid bodies.
    pub links: &'a Links,
    /// Dofs of points without mass: rows with them are left as they are.
    pub massless: &'a [bool],
    /// Dofs without inertia that can move.
    pub bare: &'a [bool],
    /// Forces by dof, out of balance `[N]`.
    pub force: &'a [f64],
}

/// Rows that are held. Dofs without inertia stand apart: nothing but the rows says where these go, and forces on them are carried by the rows at once.
struct Held {
    /// Number of each row, and its terms of dofs with inertia.
    rows: Vec<(usize, Vec<(usize, f64)>)>,
    /// Its terms of dofs without inertia, by their position.
    bare: Vec<Vec<(usize, f64)>>,
    /// These dofs.
    dofs: Vec<usize>,
}

impl Held {
    /// Sums of the rows over dofs with inertia.
    fn sums(&self, x: &[f64]) -> Vec<f64> {
        let sum = |terms: &[(usize, f64)]| terms.iter().map(|(d, f)| f * x[*d]).sum();
        self.rows.iter().map(|(_, terms)| sum(terms)).collect()
    }

    /// Forces on all dofs, by dof of `count`.
    fn spread(&self, multipliers: &[f64], count: usize) -> Vec<f64> {
        let mut force = vec![0.0; count];
        for ((_, terms), m) in self.rows.iter().zip(multipliers) {
            terms.iter().for_each(|(d, f)| force[*d] += f * m);
        }
        for (dof, f) in self.dofs.iter().zip(self.on_bare(multipliers)) {
            force[*dof] += f;
        }
        force
    }

    /// Forces on the dofs without inertia.
    fn on_bare(&self, multipliers: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.dofs.len()];
        for (terms, m) in self.bare.iter().zip(multipliers) {
            terms.iter().for_each(|(k, f)| out[*k] += f * m);
        }
        out
    }

    /// Sums of the rows over the dofs without inertia.
    fn along_bare(&self, x: &[f64]) -> Vec<f64> {
        let sum = |terms: &Vec<(usize, f64)>| terms.iter().map(|(k, f)| f * x[*k]).sum();
        self.bare.iter().map(sum).collect()
    }

    /// The values of dofs without inertia whose [sums](Self::along_bare) have these [forces](Self::on_bare): the least squares of rows.
    fn least_squares(&self, forces: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; forces.len()];
        if forces.is_empty() {
            return out;
        }
        let mut square = vec![0.0; forces.len()];
        for (k, f) in self.bare.iter().flatten() {
            square[*k] += f * f;
        }
        gmres(
            &mut |x, result| result.copy_from_slice(&self.on_bare(&self.along_bare(x))),
            &mut |x| x.iter_mut().zip(&square).for_each(|(x, s)| *x /= s),
            forces,
            &mut out,
            GmresSettings {
                // The same of sums over the equations of dofs without inertia, which those precede, to the last digit.
                tolerance: 1e-15,
                max_iterations: forces.len().clamp(10, 200),
                restart: 60,
            },
        );
        out
    }

    /// What dofs without inertia make of the values of the others, so that the rows hold as well as they can.
    fn following(&self, x: &[f64]) -> Vec<f64> {
        let off: Vec<f64> = self.sums(x).iter().map(|s| -s).collect();
        self.least_squares(&self.on_bare(&off))
    }

    /// Takes out of multipliers what acts on dofs without inertia.
    fn release(&self, multipliers: &mut [f64]) {
        if self.dofs.is_empty() {
            return;
        }
        let carried = self.along_bare(&self.least_squares(&self.on_bare(multipliers)));
        multipliers
            .iter_mut()
            .zip(carried)
            .for_each(|(m, c)| *m -= c);
    }
}

/// The equations that act at `t`, but for those with points that are `massless`; those whose dofs are `bare` have none to be moved by.
fn held(couplings: &Couplings, t: f64, links: &Links, massless: &[bool], bare: &[bool]) -> Held {
    let mut held = Held {
        rows: Vec::new(),
        bare: Vec::new(),
        dofs: Vec::new(),
    };
    for (i, coupling, row) in couplings.rows() {
        let terms = match couplings.definition.act(i, coupling, 0.0, t) {
            Act::Held(_) => links.moved(row.terms()),
            _ => continue,
        };
        if terms.iter().all(|(dof, _)| !massless[*dof]) {
            let (apart, terms): (Vec<_>, Vec<_>) =
                terms.into_iter().partition(|(dof, _)| bare[*dof]);
            held.rows.push((i, terms));
            held.bare.push(apart);
        }
    }
    let all = held.bare.iter().flatten().map(|(dof, _)| *dof);
    let all: std::collections::BTreeSet<usize> = all.collect();
    held.dofs = all.into_iter().collect();
    for (dof, _) in held.bare.iter_mut().flatten() {
        *dof = held.dofs.partition_point(|d| d < dof);
    }
    held
}

/// Lets dofs without inertia go on as the others in the equations at `t` do: `x` are velocities or accelerations. They have no inertia of their own by
/// which they could go on otherwise, and would swing about these for ever.
pub fn follow(couplings: &Couplings, t: f64, links: &Links, bare: &[bool], x: &mut [f64]) {
    if !bare.contains(&true) {
        return;
    }
    let held = held(couplings, t, links, &vec![false; x.len()], bare);
    for (dof, value) in held.dofs.iter().zip(held.following(x)) {
        x[*dof] = value;
    }
}

/// Finds the multipliers with which accelerations `a` satisfy the equations that act at `t`, and adds their forces to the internal ones in `out` and what
/// they do to `a`. Without that the trapezoidal rule would swing about them for ever. What the `force` on dofs without inertia, which are `bare`, is out of
/// balance by the equations carry.
///
/// `accelerate` gives the accelerations that forces make, by dof. Rows with points that are massless are left as they are.
///
/// # Errors
/// Those of `accelerate`.
pub fn start_motion(
    couplings: &Couplings,
    memory: &mut CouplingsMemory,
    start: &MotionStart,
    accelerate: Accelerate<'_>,
    a: &mut [f64],
    out: &mut [f64],
) -> Result<(), StepFailure> {
    let held = held(couplings, start.t, start.links, start.massless, start.bare);
    let count = a.len();
    let carried: Vec<f64> = held.dofs.iter().map(|d| start.force[*d]).collect();
    let mut multipliers = vec![0.0; held.rows.len()];
    let mut apply = |a: &mut [f64], m: &[f64]| -> Result<(), StepFailure> {
        let change = accelerate(&held.spread(m, count))?;
        a.iter_mut().zip(change).for_each(|(a, c)| *a -= c);
        Ok(())
    };
    if carried.iter().any(|f| *f != 0.0) {
        multipliers = held.along_bare(&held.least_squares(&carried));
        apply(a, &multipliers)?;
    }
    let mut off = held.sums(a);
    held.release(&mut off);
    if off.iter().any(|x| *x != 0.0) {
        let mut failure = None;
        let mut more = vec![0.0; held.rows.len()];
        gmres(
            &mut |m, result| {
                result.fill(0.0);
                let mut a = vec![0.0; count];
                match apply(&mut a, m) {
                    Ok(()) => {
                        let sums = held.sums(&a);
                        result.iter_mut().zip(sums).for_each(|(r, s)| *r = -s);
                        held.release(result);
                    }
                    Err(e) => failure = Some(e),
                }
            },
            &mut |_| {},
            &off,
            &mut more,
            GmresSettings {
                // The accelerations of equations vanish but for rounding.
                tolerance: ROUNDING,
                max_iterations: held.rows.len().clamp(10, 400),
                restart: 60,
            },
        );
        if let Some(failure) = failure {
            return Err(failure);
        }
        held.release(&mut more);
        apply(a, &more)?;
        multipliers.iter_mut().zip(more).for_each(|(m, x)| *m += x);
    }
    for (dof, value) in held.dofs.iter().zip(held.following(a)) {
        a[*dof] = value;
    }
    for (out, f) in out.iter_mut().zip(held.spread(&multipliers, count)) {
        *out += f;
    }
    for ((i, _), m) in held.rows.iter().zip(&multipliers) {
        memory.multipliers[*i] += m;
        memory.forces[*i] = memory.multipliers[*i];
    }
    Ok(())
}
