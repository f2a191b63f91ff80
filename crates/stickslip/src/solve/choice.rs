//! Which way to solve is the cheapest, by counts that are known before any arithmetic.

use crate::linear::{BlockCsr, Symbolic};
use crate::machine::available_memory;
use crate::model::definition::{Solution, Step};
use crate::model::scene::Scene;
use crate::newton::condensed::Cost;
use crate::number::figure;

/// Multiplications and additions of dense matrices in a second. Only ratios of these rates matter, and they differ little between machines.
const DENSE_RATE: f64 = 3e10;

/// Entries of a matrix that memory delivers in a second.
const MEMORY_RATE: f64 = 1.2e9;

/// Newton iterations of a quasi-static and of a dynamic increment. In the tested examples of more than four increments they are 0.9 to 9.3, with a mean of 4.5,
/// and up to 3.0, with a mean of 1.2. With twice and half of these values 116 short
/// cases (see [`tolerance`](crate::tolerance)) have the same digits but for one, which half of them solves by the sparse matrix.
const NEWTON: [f64; 2] = [2.5, 1.5];
/// Krylov iterations of a Newton iteration of condensed bodies: 0.2 to 9.8 in the same examples, with a mean of 2.4.
const KRYLOV_ITERATIONS: f64 = 6.0;
/// Newton iterations of a quasi-static increment in which bodies turn on axles, as their contact goes on to other points in each: 5.6 and 4.9 in the examples `gear-pair` and
/// `geneva-drive`, 6.5 in `rolling-wheel` and `bentall-johnson`.
const NEWTON_TURNING: f64 = 6.0;

/// Newton iterations that one factor of the gaps serves: it is kept while points keep their status.
const NEWTON_A_FACTOR: f64 = 6.0;

/// Krylov iterations of a Newton iteration with the sparse matrix: press-and-slide in slip took 7, and a slab with its whole face in
/// contact 12.
const SPARSE_KRYLOV: f64 = 10.0;
/// Newton iterations that one factor of the sparse matrix serves: 5 and 3 in the same problems.
const SPARSE_NEWTON_A_FACTOR: f64 = 4.0;

/// Least part of the arithmetic of a factor with the candidates last that one in an order of its own takes.
const FREE_ORDER: f64 = 0.25;
/// Time of a solution with the factor of the sparse matrix over that of reading it twice: 1.8 in the same problems.
const SPARSE_SOLVE: f64 = 1.8;

/// Increments whose interiors are found in one sweep. Fixed, so that no number depends on when somebody looks.
pub(crate) const TOGETHER: usize = 16;

/// Vectors by dof that an increment holds which waits for its interior: displacements, and what is swept to find it.
const VECTORS: usize = 2;

/// Seconds of a multigrid hierarchy, a dof in three dimensions. The shapes of `cargo xtask peers shapes` and press-and-slide up to N = 36
/// took 0.4e-5 to 1.4e-5.
const GRID_SETUP: f64 = 1e-5;
/// Seconds of an iteration of multigrid, a dof in three dimensions. The same problems took 2.3e-7 to 3.5e-7 where dense products run at
/// 4.3e10.
const GRID_CYCLE: f64 = 4.2e-7;

/// Iterations that multigrid takes for one Newton iteration: of the same problems, slabs took 4 to 6, press-and-slide 6 in stick and 10 in slip, and a ball of
/// which few points touch 22.
const GRID_CYCLES: f64 = 10.0;

/// Bytes of matrix, transformed matrix, hierarchy and Krylov vectors a dof.
const GRID_BYTES: f64 = 3500.0;

/// What is known about the way to solve.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    /// The cheapest way, never `Automatic`.
    pub method: Solution,
    /// Why.
    pub reason: String,
}

/// The cheapest way that fits into memory.
pub(crate) fn choose(scene: &Scene, cost: &Cost, matrix: &BlockCsr, held: &[bool]) -> Choice {
    let free = held.iter().filter(|h| !**h).count() as f64;
    let candidates = cost.candidates as f64;
    let [static_, moving] = increments_left(scene);
    let at_rest = match scene.model.frames.is_empty() {
        true => NEWTON[0],
        false => NEWTON_TURNING,
    };
    let iterations = static_ * at_rest + moving * NEWTON[1];
    let memory = available_memory().map(|free| free as f64);
    let points: usize = scene
        .contact
        .interfaces
        .iter()
        .map(|i| i.points.len())
        .sum();
    let bytes = cost.bytes as f64 + pending_bytes(scene) as f64 * static_.min(TOGETHER as f64);
    let what = format!(
        "{} of {free} dofs are contact candidates; {} entries, {} + {} flops, {:.2} GB",
        cost.candidates,
        figure(cost.nonzeros),
        figure(cost.factor),
        figure(cost.condense),
        bytes / 1e9
    );
    // This part of the free memory may be taken.
    let fits = |bytes: f64| memory.is_none_or(|m| bytes < 0.85 * m);
    // A product of the inverse, half of which is read, and now and then a small factor of the gaps.
    let gaps = (points * scene.model.dofs.dim) as f64;
    let gaps = gaps.min(candidates);
    let one = KRYLOV_ITERATIONS * (cost.dense + gaps * gaps) / MEMORY_RATE
        + gaps.powi(3) / (3.0 * DENSE_RATE * NEWTON_A_FACTOR);
    let sweeps = (0.25 * static_ + 2.0 * moving) * cost.nonzeros / MEMORY_RATE;
    let condensed = (cost.factor + cost.condense) / DENSE_RATE + iterations * one + sweeps;
    // With fewer candidates among all dofs no other way can be cheaper, if the inverse is not the larger part of the work. In more than
    // 20 seconds the other ways are looked at in any case: beside them it is nothing to order the sparse matrix as well.
    if candidates <= 1.0 / 12.0 * free
        && cost.condense <= cost.factor
        && fits(bytes)
        && condensed < 20.0
    {
        return Choice {
            method: Solution::Condensed,
            reason: what,
        };
    }
    let grids = GRID_SETUP * free + iterations * GRID_CYCLES * GRID_CYCLE * free;
    let mut ways = vec![(Solution::Condensed, condensed, bytes)];
    // Only now it is worth while to know what the others cost; of the sparse matrix that takes an ordering of its own.
    let refactored = 1.0 + iterations / SPARSE_NEWTON_A_FACTOR;
    let hopeless = fits(bytes) && FREE_ORDER * cost.factor / DENSE_RATE * refactored > condensed;
    if !hopeless && let Ok(symbolic) = Symbolic::analyze(matrix, held, &[]) {
        let (flops, nonzeros) = (symbolic.flops(), symbolic.factor_nonzeros() as f64);
        let sparse = flops / DENSE_RATE * refactored
            + iterations * SPARSE_KRYLOV * SPARSE_SOLVE * (2.0 * nonzeros + matrix.nnz() as f64)
                / MEMORY_RATE;
        ways.push((Solution::Sparse, sparse, 10.0 * nonzeros));
    }
    if scene.model.dofs.dim == 3 {
        ways.push((Solution::Multigrid, grids, GRID_BYTES * free));
    }
    let list: Vec<String> = ways
        .iter()
        .map(|(way, seconds, bytes)| {
            format!("{way:?} {seconds:.2} ({:.2} GB)", bytes / 1e9).to_lowercase()
        })
        .collect();
    // Where it decides nothing it differs for nothing.
    let scarce = ways.iter().any(|(_, _, bytes)| !fits(*bytes));
    let free_memory = (memory.filter(|_| scarce))
        .map_or(String::new(), |m| format!(", {:.2} GB are free", m / 1e9));
    let possible = ways.iter().filter(|(_, _, bytes)| fits(*bytes));
    let best = possible.min_by(|a, b| a.1.total_cmp(&b.1));
    // If nothing fits, the factorisation says how much it would take.
    Choice {
        method: best.map_or(Solution::Sparse, |(way, ..)| *way),
        reason: format!(
            "{what}; about {iterations:.0} iterations would cost (seconds of some machine): {}{free_memory}",
            list.join(", ")
        ),
    }
}

/// Memory that an increment takes until it is reported `[bytes]`.
fn pending_bytes(scene: &Scene) -> usize {
    let interfaces = scene.contact.interfaces.iter();
    let histories: usize = interfaces.map(|i| i.history_bytes()).sum();
    histories + VECTORS * size_of::<f64>() * scene.model.dofs.count()
}

/// Quasi-static and dynamic increments from this step on, if none is cut.
fn increments_left(scene: &Scene) -> [f64; 2] {
    let mut counts = [0.0, 0.0];
    let count = |s: &Step| {
        let length = if s.fixed || s.dynamic.is_some() {
            s.increments.initial
        } else {
            // they grow
            (s.increments.initial * s.increments.largest).sqrt()
        };
        // So many increments are counted at most.
        ((s.end - s.start) / length).clamp(1.0, 1e5)
    };
    for step in &scene.model.steps[scene.frame.step..] {
        counts[usize::from(step.dynamic.is_some())] += count(step);
    }
    counts
}

/// Whether so many bytes are free, as far as is known.
pub(crate) fn cost_fits(bytes: u64) -> bool {
    available_memory().is_none_or(|free| bytes < free)
}
