//! What the problem file says of forces on the nodes: loads, springs, equations, and supports that have let go.

use crate::bulk::Bulk;
use crate::case::text_of;
use crate::loads::{self, Coupling, Row};
use crate::results::{Results, State};
use crate::vec3::{Vec3, along};

/// Forces on the nodes that the problem file says.
pub struct External {
    /// Name, keys and forces at factor 1 of each load.
    loads: Vec<(String, toml::Table, Vec<Vec3>)>,
    /// Springs to ground with the name of their load.
    grounded: Vec<(String, toml::Table, Row)>,
    /// Springs and equations.
    pub couplings: Vec<Coupling>,
}

impl External {
    /// Integrates all loads; an error says what is not covered.
    pub fn new(results: &Results, bulk: &Bulk) -> Result<External, String> {
        let Results { case, mesh, .. } = results;
        let density = |cell: usize| bulk.materials[mesh.owner[cell]].density;
        let (mut of_loads, mut grounded) = (Vec::new(), Vec::new());
        for (name, load) in case.named("load") {
            let unknown = || {
                format!(
                    "load {name}: {} on a set that only the mesh file knows",
                    loads::kind_of(load)
                )
            };
            if load.contains_key("spring") {
                let springs = loads::grounded(case, mesh, load).ok_or_else(unknown)?;
                grounded.push((name.to_string(), load.clone(), springs));
            } else {
                let forces = loads::forces(case, mesh, load, &density).ok_or_else(unknown)?;
                of_loads.push((name.to_string(), load.clone(), forces));
            }
        }
        let couplings: Option<Vec<Coupling>> = loads::couplings(case, mesh).into_iter().collect();
        let couplings = couplings.ok_or("a coupling whose points are not known here")?;
        if !case.named("temperature").is_empty() {
            return Err("temperatures, whose strains are not known here".into());
        }
        if !case.named("pretension").is_empty() {
            return Err("pretensions, whose cuts are not known here".into());
        }
        if !case.named("mass").is_empty() {
            return Err("point masses".into());
        }
        if case
            .named("body")
            .iter()
            .any(|(_, b)| b.contains_key("rotation"))
        {
            return Err("bodies that turn by any angle".into());
        }
        let unknown = ["wear", "worn", "roughness"];
        let interfaces = case.named("interface");
        let mut found = unknown
            .iter()
            .filter(|key| interfaces.iter().any(|(_, i)| i.contains_key(**key)));
        if let Some(key) = found.next() {
            return Err(format!(
                "interfaces with `{key}`, whose gaps are not known here"
            ));
        }
        Ok(External {
            loads: of_loads,
            grounded,
            couplings,
        })
    }

    /// Forces of the loads at a time.
    pub fn at(&self, results: &Results, t: f64) -> Vec<Vec3> {
        let mut out = vec![[0.0; 3]; results.mesh.points.len()];
        for (name, load, forces) in &self.loads {
            let factor = results.case.load_factor(name, load, t);
            for (o, f) in out.iter_mut().zip(forces) {
                *o = along(*o, factor, *f);
            }
        }
        out
    }

    /// Forces of all springs at displacements, and their energy. A spring comes and goes with its step as a load does, but is there from
    /// the start if the first step has it.
    pub fn springs(&self, results: &Results, t: f64, u: &[Vec3]) -> (Vec<Vec3>, f64) {
        let case = &results.case;
        let mut out = vec![[0.0; 3]; u.len()];
        let mut energy = 0.0;
        for (name, load, springs) in &self.grounded {
            let factor = match case.steps[0].lists("loads", name) && case.step_at(t) == 0 {
                true => 1.0,
                false => case.load_factor(name, load, t),
            };
            for &((node, axis), k) in springs {
                out[node][axis] -= factor * k * u[node][axis];
                energy += 0.5 * factor * k * u[node][axis].powi(2);
            }
        }
        for coupling in &self.couplings {
            let Some(k) = coupling.stiffness else {
                continue;
            };
            for row in &coupling.rows {
                let sum: f64 = row.iter().map(|((n, i), f)| f * u[*n][*i]).sum();
                energy += 0.5 * k * sum * sum;
                for ((node, axis), factor) in row {
                    out[*node][*axis] -= k * sum * factor;
                }
            }
        }
        (out, energy)
    }

    /// Takes what equations carry out of the rest: with the factors `A` of all rows the part `Aᵀ λ` that is nearest to it, by conjugate
    /// gradients on `A Aᵀ λ = A r` (Hestenes and Stiefel 1952), as rows may say the same twice.
    pub fn without_equations(&self, rest: &mut [Vec3]) {
        let equations = self.couplings.iter().filter(|c| c.stiffness.is_none());
        let rows: Vec<&loads::Row> = equations.flat_map(|c| &c.rows).collect();
        let sums = |x: &[Vec3]| -> Vec<f64> {
            rows.iter()
                .map(|row| row.iter().map(|((n, i), f)| f * x[*n][*i]).sum())
                .collect()
        };
        let spread = |lambda: &[f64], out: &mut [Vec3], sign: f64| {
            for (row, l) in rows.iter().zip(lambda) {
                for ((node, axis), factor) in *row {
                    out[*node][*axis] += sign * l * factor;
                }
            }
        };
        let square = |a: &[f64]| a.iter().map(|x| x * x).sum::<f64>();
        let mut residual = sums(rest);
        let (mut direction, first) = (residual.clone(), square(&residual));
        for _ in 0..2 * rows.len() {
            let now = square(&residual);
            if now <= 1e-28 * first {
                break;
            }
            let mut moved = vec![[0.0; 3]; rest.len()];
            spread(&direction, &mut moved, 1.0);
            let gained = sums(&moved);
            let with: f64 = direction.iter().zip(&gained).map(|(d, g)| d * g).sum();
            let step = now / with;
            let scaled: Vec<f64> = direction.iter().map(|d| step * d).collect();
            spread(&scaled, rest, -1.0);
            residual
                .iter_mut()
                .zip(&gained)
                .for_each(|(r, g)| *r -= step * g);
            let next = square(&residual) / now;
            direction
                .iter_mut()
                .zip(&residual)
                .for_each(|(d, r)| *d = r + next * *d);
        }
    }

    /// Takes what is left of the reactions of supports that have let go out of the rest: over the first step at rest without them they
    /// fall to zero.
    pub fn without_released(&self, results: &Results, state: &State, rest: &mut [Vec3]) {
        let case = &results.case;
        let step = case.step_at(state.t);
        let start = case.steps[step].start;
        let near = |s: &&State| (s.t - start).abs() <= 1e-9 * start;
        let Some(before) = results.states.iter().find(near).filter(|_| step > 0) else {
            return;
        };
        let share = (case.steps[step].end - state.t) / (case.steps[step].end - start);
        let (then, now) = (before.grid.vector("RF"), state.grid.vector("RF"));
        for (name, support) in case.named("support") {
            let acted = case.steps[step - 1].lists("supports", name);
            if !acted || case.steps[step].lists("supports", name) {
                continue;
            }
            let set = text_of(support, "set").and_then(|s| results.mesh.set(case, s));
            for p in set.unwrap_or_default() {
                for axis in 0..case.space.dim() {
                    if then[p][axis] != 0.0 && now[p][axis] == 0.0 {
                        rest[p][axis] -= share * then[p][axis];
                    }
                }
            }
        }
    }
}
