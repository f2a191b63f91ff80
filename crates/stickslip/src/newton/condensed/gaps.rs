//! The linear system of one iteration on the candidates that contact touches.

use super::condensation::Condensation;
use super::lu::{Entry, Lu};
use super::substructure::{Floating, dot, norm};
use crate::linear::{Compliance, GmresSettings, gmres};
use crate::newton::settings::Settings;
use crate::newton::statistics::Statistics;
use crate::system::{Cause, ContactBlock, StepFailure};

/// Solves `(I + K W) y = …` for the forces at the dofs that interfaces touch.
///
/// GMRES with the exact tangent is preconditioned by an exact factor of the tangent of some iteration before, without the curvature of the
/// gaps: of a matrix with a row for every gap and slip, which is small.
#[derive(Debug, Default)]
pub struct Gaps {
    active: Option<Active>,
    preconditioner: Option<Preconditioner>,
    /// The last solution took too many iterations.
    stale: bool,
}

/// The candidates that interfaces touch, and how they yield.
#[derive(Debug)]
struct Active {
    /// Positions among the candidates, ascending.
    list: Vec<usize>,
    /// Position in the list by candidate.
    place: Vec<u32>,
    /// By part: where its dofs start in the list, and its compliance among them; `None`: that of the whole part.
    starts: Vec<usize>,
    compliance: Vec<Option<Compliance>>,
}

const NONE: u32 = u32::MAX;

/// Part of the candidates below which their own compliance is cut out.
const FEW: f64 = 0.7;

/// A contact block by positions in the active list.
struct Block<'a> {
    at: Vec<u32>,
    block: &'a ContactBlock,
}

/// `B`, `C` and the factor of `[[I + C W Bᵀ, -C Z], [σ Zᵀ Bᵀ, I - σ Rᵀ Z]]`.
#[derive(Debug)]
struct Preconditioner {
    rows: Vec<Rows>,
    /// Gap rows.
    count: usize,
    lu: Lu,
    /// `Z` at the active dofs, one mode after the other, with its `σ` and part.
    modes: Vec<(f64, Vec<f64>)>,
}

/// The rows of one contact point.
#[derive(Debug)]
struct Rows {
    at: Vec<u32>,
    /// First of its gap rows and their number.
    first: usize,
    rows: Vec<f64>,
    change: Vec<f64>,
}

/// Amplification up to which the factor may be in single precision.
const SINGLE: f64 = 1e4;

/// Residual relative to the right-hand side that counts as solved if the factor is fresh.
const ROUNDING: f64 = 1e-6;

/// Tolerance above which products may be in single precision.
const SINGLE_TOLERANCE: f64 = 3e-6;

/// Gap rows up to which the factor is in double precision in any case, and up to which it is made anew every time.
const SMALL: usize = 600;
pub(super) const TINY: usize = 240;

impl Gaps {
    /// Forgets everything: the bodies have changed.
    pub fn clear(&mut self) {
        *self = Gaps::default();
    }

    /// Finds the forces `ds` with `(I + K W) ds = b` on the candidates, `K` the tangent of the interfaces less that of the artificial springs, and
    /// the displacements `W ds`. Returns both and the Krylov iterations.
    pub fn solve(
        &mut self,
        condensation: &Condensation,
        blocks: &[ContactBlock],
        b: &[f64],
        tolerance: f64,
        (settings, statistics): (&Settings, &mut Statistics),
    ) -> Result<(Vec<f64>, Vec<f64>, usize), StepFailure> {
        let floating: Vec<(usize, &Floating)> = condensation
            .parts
            .iter()
            .zip(&condensation.starts)
            .filter_map(|(part, &start)| Some((start, part.floating.as_ref()?)))
            .collect();
        if blocks.is_empty() && floating.is_empty() {
            return Ok((b.to_vec(), condensation.yielding(b), 0));
        }
        self.activate(condensation, blocks);
        let active = (self.active.as_ref()).expect("the active list was made");
        let placed: Vec<Block> = blocks
            .iter()
            .map(|b| active.place(condensation, b))
            .collect();
        let modes: Vec<Mode> = floating
            .iter()
            .flat_map(|&(start, f)| {
                (0..f.modes.len()).map(move |k| Mode {
                    start,
                    sigma: f.sigma,
                    mode: &f.modes[k],
                    z: &f.yielding[k],
                })
            })
            .collect();
        let system = Iteration {
            condensation,
            active,
            blocks: &placed,
            modes: &modes,
        };
        // K (W b) and what the springs make of b
        let at_rest = system.yielding_of_load(b);
        let rhs = system.right_hand_side(&at_rest, b);
        // The residual of this system is that of the forces themselves, which are much smaller where interfaces are stiff.
        let tolerance = (tolerance * norm(b) / norm(&rhs).max(f64::MIN_POSITIVE)).clamp(1e-14, 0.1);
        // Where next to nothing holds a body, single precision would not see what does.
        let mut single =
            tolerance >= SINGLE_TOLERANCE && modes.is_empty() && active.list.len() > SMALL;
        let mut spent = 0;
        let mut fresh = false;
        loop {
            let tiny = 3 * blocks.len() + modes.len() <= TINY;
            if self.stale || (tiny && !fresh) {
                self.preconditioner = None;
            }
            let preconditioner = match &mut self.preconditioner {
                Some(kept) => &*kept,
                missing => {
                    statistics.reduced += 1;
                    self.stale = false;
                    fresh = true;
                    missing.insert(system.preconditioner()?)
                }
            };
            let most = if fresh {
                200
            } else {
                2 * settings.krylov_patience
            };
            let mut y = vec![0.0; rhs.len()];
            let report = gmres(
                &mut |v, out| system.apply(v, out, single),
                &mut |v| system.precondition(preconditioner, v, single),
                &rhs,
                &mut y,
                GmresSettings {
                    tolerance,
                    max_iterations: most,
                    restart: most.min(60),
                },
            );
            statistics.krylov += report.iterations;
            spent += report.iterations;
            if !report.relative_residual.is_finite() {
                return Err(StepFailure::new(
                    Cause::NotFinite,
                    "the linear solution is not finite",
                ));
            }
            // With a fresh factor what is left is rounding: whether it is too much shows in the forces.
            let rounding = fresh && report.relative_residual <= ROUNDING;
            if report.converged || rounding {
                self.stale = report.iterations > settings.krylov_patience;
                let mut s = b.to_vec();
                system.add_forces(&y, &mut s);
                let u = condensation.yielding(&s);
                return Ok((s, u, spent));
            }
            if single {
                single = false;
                continue;
            }
            if fresh {
                return Err(StepFailure::new(
                    Cause::LinearSolver,
                    format!("the linear solver did not reach its tolerance in {spent} iterations"),
                )
                .help("a body may be nearly free to move; `stickslip check` lists free rigid-body modes"));
            }
            self.stale = true;
        }
    }

    /// Sees to it that the active list has the dofs of all blocks and not many more.
    fn activate(&mut self, condensation: &Condensation, blocks: &[ContactBlock]) {
        let mut touched = vec![false; condensation.size()];
        for block in blocks {
            for &dof in &block.dofs {
                if let Some(at) = condensation.place(dof) {
                    touched[at] = true;
                }
            }
        }
        let wanted = touched.iter().filter(|t| **t).count();
        if let Some(active) = &self.active {
            let covered = touched
                .iter()
                .zip(&active.place)
                .all(|(&t, &place)| !t || place != NONE);
            if covered && active.list.len() <= 2 * wanted.max(100) {
                return;
            }
        }
        self.preconditioner = None;
        // Where most of the candidates are touched a cut would save less than it costs.
        let whole = wanted as f64 > FEW * condensation.size() as f64;
        let list: Vec<usize> = (0..touched.len())
            .filter(|&i| whole || touched[i])
            .collect();
        let mut place = vec![NONE; touched.len()];
        for (k, &i) in list.iter().enumerate() {
            place[i] = k as u32;
        }
        let mut starts = Vec::new();
        let mut compliance = Vec::new();
        for (part, range) in condensation
            .parts
            .iter()
            .zip(condensation.starts.windows(2))
        {
            let own =
                list.partition_point(|&i| i < range[0])..list.partition_point(|&i| i < range[1]);
            starts.push(own.start);
            if whole {
                compliance.push(None);
                continue;
            }
            let (n, values) = (part.compliance.size(), part.compliance.values());
            let own = &list[own];
            let mut cut = Vec::with_capacity(own.len() * own.len());
            for &j in own {
                let column = &values[(j - range[0]) * n..(j - range[0] + 1) * n];
                cut.extend(own.iter().map(|&i| column[i - range[0]]));
            }
            compliance.push(Some(Compliance::from_values(own.len(), cut)));
        }
        starts.push(list.len());
        self.active = Some(Active {
            list,
            place,
            starts,
            compliance,
        });
    }
}

impl Active {
    fn place<'a>(&self, condensation: &Condensation, block: &'a ContactBlock) -> Block<'a> {
        let at = block.dofs.iter().map(|&dof| match condensation.place(dof) {
            Some(at) => self.place[at],
            None => NONE,
        });
        Block {
            at: at.collect(),
            block,
        }
    }

    fn compliance<'a>(&'a self, condensation: &'a Condensation, part: usize) -> &'a Compliance {
        match &self.compliance[part] {
            Some(own) => own,
            None => &condensation.parts[part].compliance,
        }
    }
}

/// One artificial spring.
struct Mode<'a> {
    /// First candidate of its part.
    start: usize,
    sigma: f64,
    mode: &'a [f64],
    z: &'a [f64],
}

/// The system of one iteration. Vectors hold forces at the active dofs, then one for each artificial spring.
struct Iteration<'a> {
    condensation: &'a Condensation,
    active: &'a Active,
    blocks: &'a [Block<'a>],
    modes: &'a [Mode<'a>],
}

impl Iteration<'_> {
    /// How the active dofs yield to forces at them, springs' forces left out.
    fn yielding(&self, y: &[f64], single: bool) -> Vec<f64> {
        use rayon::prelude::*;
        let parts: Vec<Vec<f64>> = (0..self.condensation.parts.len())
            .into_par_iter()
            .map(|k| {
                let range = self.active.starts[k]..self.active.starts[k + 1];
                let mut u = vec![0.0; range.len()];
                let w = self.active.compliance(self.condensation, k);
                if single {
                    w.mul_single(&y[range], &mut u);
                } else {
                    w.mul(&y[range], &mut u);
                }
                u
            })
            .collect();
        parts.concat()
    }

    /// A mode's `Z` at an active dof.
    fn z(&self, mode: &Mode, i: usize) -> f64 {
        let at = self.active.list[i];
        at.checked_sub(mode.start)
            .and_then(|k| mode.z.get(k))
            .copied()
            .unwrap_or(0.0)
    }

    /// `W b` at the active dofs. Once the bodies are in balance there are forces at active dofs only.
    fn yielding_of_load(&self, b: &[f64]) -> Vec<f64> {
        let active: Vec<f64> = self.active.list.iter().map(|&i| b[i]).collect();
        let all = norm(b);
        let rest = (all * all - dot(&active, &active)).max(0.0).sqrt();
        if rest <= 1e-9 * all {
            return self.yielding(&active, false);
        }
        let u = self.condensation.yielding(b);
        self.active.list.iter().map(|&i| u[i]).collect()
    }

    fn right_hand_side(&self, u: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        self.tangent(u, &mut out);
        out.iter_mut().for_each(|o| *o = -*o);
        for mode in self.modes {
            out.push(mode.sigma * dot(mode.z, &b[mode.start..mode.start + mode.z.len()]));
        }
        out
    }

    /// Adds `K_c u`.
    fn tangent(&self, u: &[f64], out: &mut [f64]) {
        let mut local = Vec::new();
        let mut result = Vec::new();
        for Block { at, block } in self.blocks {
            local.clear();
            local.extend(
                at.iter()
                    .map(|&k| if k == NONE { 0.0 } else { u[k as usize] }),
            );
            result.clear();
            result.resize(at.len(), 0.0);
            block.apply(&local, &mut result);
            for (&k, r) in at.iter().zip(&result) {
                if k != NONE {
                    out[k as usize] += r;
                }
            }
        }
    }

    /// How the active dofs yield to all forces of `v`.
    fn displacement(&self, v: &[f64], single: bool) -> Vec<f64> {
        let n = self.active.list.len();
        let mut u = self.yielding(&v[..n], single);
        for (mode, &beta) in self.modes.iter().zip(&v[n..]) {
            if beta != 0.0 {
                for (i, u) in u.iter_mut().enumerate() {
                    *u += beta * self.z(mode, i);
                }
            }
        }
        u
    }

    fn apply(&self, v: &[f64], out: &mut [f64], single: bool) {
        let n = self.active.list.len();
        let u = self.displacement(v, single);
        out.copy_from_slice(v);
        self.tangent(&u, &mut out[..n]);
        for (k, mode) in self.modes.iter().enumerate() {
            let mut sum = 0.0;
            for (i, y) in v[..n].iter().enumerate() {
                sum += self.z(mode, i) * y;
            }
            for (other, &beta) in self.modes.iter().zip(&v[n..]) {
                if other.start == mode.start {
                    sum += dot(mode.mode, other.z) * beta;
                }
            }
            out[n + k] -= mode.sigma * sum;
        }
    }

    /// Adds the forces of a solution to those at all candidates.
    fn add_forces(&self, y: &[f64], s: &mut [f64]) {
        let n = self.active.list.len();
        for (&i, y) in self.active.list.iter().zip(y) {
            s[i] += y;
        }
        for (mode, beta) in self.modes.iter().zip(&y[n..]) {
            for (s, m) in s[mode.start..].iter_mut().zip(mode.mode) {
                *s += beta * m;
            }
        }
    }

    fn precondition(&self, p: &Preconditioner, v: &mut [f64], single: bool) {
        let n = self.active.list.len();
        let (y, beta) = v.split_at_mut(n);
        let u = self.yielding(y, single);
        let mut q = vec![0.0; p.count + p.modes.len()];
        for rows in &p.rows {
            rows.changes(&u, &mut q);
        }
        for (k, (sigma, z)) in p.modes.iter().enumerate() {
            q[p.count + k] = beta[k] + sigma * dot(z, y);
        }
        p.lu.solve(&mut q);
        for rows in &p.rows {
            rows.take_away(&q, y);
        }
        beta.copy_from_slice(&q[p.count..]);
    }

    fn preconditioner(&self) -> Result<Preconditioner, StepFailure> {
        let mut rows = Vec::with_capacity(self.blocks.len());
        let mut count = 0;
        for Block { at, block } in self.blocks {
            let n = at.len();
            let mut point = Rows {
                at: at.clone(),
                first: count,
                rows: Vec::new(),
                change: Vec::new(),
            };
            for (row, change) in block.rows.chunks(n).zip(block.change.chunks(n)) {
                // In the plane there is one direction of slip.
                if change.iter().any(|c| *c != 0.0) && row.iter().any(|r| *r != 0.0) {
                    point.rows.extend_from_slice(row);
                    point.change.extend_from_slice(change);
                    count += 1;
                }
            }
            if count > point.first {
                rows.push(point);
            }
        }
        let modes: Vec<(f64, Vec<f64>)> = self
            .modes
            .iter()
            .map(|mode| {
                let z = (0..self.active.list.len()).map(|i| self.z(mode, i));
                (mode.sigma, z.collect())
            })
            .collect();
        let mut single = count > SMALL;
        loop {
            let (lu, amplification) = if single {
                let (matrix, amplification) = self.small_matrix::<f32>(&rows, count, &modes);
                (Lu::of(count + modes.len(), matrix), amplification)
            } else {
                let (matrix, amplification) = self.small_matrix::<f64>(&rows, count, &modes);
                (Lu::of(count + modes.len(), matrix), amplification)
            };
            if single && (amplification > SINGLE || lu.is_none()) {
                single = false;
                continue;
            }
            let Some(lu) = lu else {
                return Err(StepFailure::new(
                    Cause::Singular,
                    "the bodies and interfaces together are singular",
                ));
            };
            return Ok(Preconditioner {
                rows,
                count,
                lu,
                modes,
            });
        }
    }

    /// The small matrix, column by column, and the size of `C W Bᵀ`.
    fn small_matrix<T: Entry>(
        &self,
        rows: &[Rows],
        count: usize,
        modes: &[(f64, Vec<f64>)],
    ) -> (Vec<T>, f64) {
        use rayon::prelude::*;
        let size = count + modes.len();
        let n = self.active.list.len();
        // `Bᵀ` column by column: the points' rows spread over the active dofs
        let columns: Vec<(usize, usize)> = rows
            .iter()
            .enumerate()
            .flat_map(|(p, r)| (0..r.count()).map(move |q| (p, q)))
            .collect();
        let part_of = |i: usize| self.active.starts.partition_point(|&s| s <= i) - 1;
        let mut matrix: Vec<T> = columns
            .par_chunks(16)
            .flat_map_iter(|chunk| {
                let mut out = Vec::with_capacity(chunk.len() * size);
                let mut yielding = vec![T::of(0.0); n];
                let mut local = Vec::new();
                let mut met: Vec<usize> = Vec::new();
                for &(p, q) in chunk {
                    let r = &rows[p];
                    let width = r.at.len();
                    // W Bᵀ e
                    met.clear();
                    for (&at, &b) in r.at.iter().zip(&r.rows[q * width..(q + 1) * width]) {
                        if at == NONE || b == 0.0 {
                            continue;
                        }
                        let part = part_of(at as usize);
                        let start = self.active.starts[part];
                        let w = self.active.compliance(self.condensation, part);
                        let column = T::column(w, at as usize - start);
                        let target = &mut yielding[start..start + column.len()];
                        let b = T::of(b);
                        if met.contains(&part) {
                            T::add_scaled(target, b, column);
                        } else {
                            met.push(part);
                            T::set_scaled(target, b, column);
                        }
                    }
                    let in_part = |i: usize| {
                        met.iter().any(|&m| {
                            (self.active.starts[m]..self.active.starts[m + 1]).contains(&i)
                        })
                    };
                    let all = met.len() == self.condensation.parts.len();
                    for other in rows {
                        let width = other.at.len();
                        local.clear();
                        local.resize(width, T::of(0.0));
                        for (l, &at) in local.iter_mut().zip(&other.at) {
                            if at != NONE && (all || in_part(at as usize)) {
                                *l = yielding[at as usize];
                            }
                        }
                        for c in other.change.chunks(width) {
                            let mut sum = T::of(0.0);
                            for (c, l) in c.iter().zip(&local) {
                                sum = sum.plus(T::of(*c).times(*l));
                            }
                            out.push(sum);
                        }
                    }
                    for (sigma, z) in modes {
                        let mut sum = 0.0;
                        for (&at, &b) in r.at.iter().zip(&r.rows[q * width..(q + 1) * width]) {
                            if at != NONE {
                                sum += b * z[at as usize];
                            }
                        }
                        out.push(T::of(sigma * sum));
                    }
                }
                out.into_iter()
            })
            .collect();
        let mut amplification = 0.0_f64;
        for k in 0..count {
            let d = &mut matrix[k * size + k];
            amplification = amplification.max(d.to().abs());
            *d = d.plus(T::of(1.0));
        }
        // the columns of the springs: -C Z and I - σ Rᵀ Z
        for (k, mode) in self.modes.iter().enumerate() {
            let z = &modes[k].1;
            for r in rows {
                let width = r.at.len();
                for c in r.change.chunks(width) {
                    let mut sum = 0.0;
                    for (&at, c) in r.at.iter().zip(c) {
                        if at != NONE {
                            sum += c * z[at as usize];
                        }
                    }
                    matrix.push(T::of(-sum));
                }
            }
            for (j, other) in self.modes.iter().enumerate() {
                let unit = if j == k { 1.0 } else { 0.0 };
                let shared = if other.start == mode.start {
                    other.sigma * dot(other.mode, mode.z)
                } else {
                    0.0
                };
                matrix.push(T::of(unit - shared));
            }
        }
        (matrix, amplification)
    }
}

impl Rows {
    fn count(&self) -> usize {
        self.rows.len() / self.at.len()
    }

    /// `C u`.
    fn changes(&self, u: &[f64], q: &mut [f64]) {
        let width = self.at.len();
        for (q, c) in q[self.first..].iter_mut().zip(self.change.chunks(width)) {
            *q = 0.0;
            for (&at, c) in self.at.iter().zip(c) {
                if at != NONE {
                    *q += c * u[at as usize];
                }
            }
        }
    }

    /// `y -= Bᵀ q`.
    fn take_away(&self, q: &[f64], y: &mut [f64]) {
        let width = self.at.len();
        for (q, b) in q[self.first..].iter().zip(self.rows.chunks(width)) {
            for (&at, b) in self.at.iter().zip(b) {
                if at != NONE {
                    y[at as usize] -= b * q;
                }
            }
        }
    }
}
