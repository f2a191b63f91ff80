//! How much a run writes, as far as can be told before it.

use crate::contact::look;
use serde::Serialize;

use super::parts::{Run, view};
use super::restart::{attempt_state, checkpoint_with};
use crate::integrate::explicit::Explicit;
use crate::io::frd::Encoding;
use crate::model::definition::{Solution, Step};
use crate::newton::MOST_FACTORS;
use crate::results::files::fields;
use crate::results::history;
use crate::solve::choice::TOGETHER;
use crate::time::Trial;
use crate::time::scheme::Method;

/// Characters of a number in a history at most, with its comma: `-1.2345678901234567e-300,`.
const NUMBER: usize = 25;

/// Cycles that are computed where jumps are chosen, at most about.
const BLOCKS: usize = 200;

/// Characters of the line of a file of fields in `fields.pvd`, and bytes of its name in a checkpoint.
const FIELDS_LINE_BYTES: usize = 80;

/// Bytes of a point in the `.frd` file at most: seven blocks with 28 numbers.
const FRD_TEXT: usize = 7 * 14 + 28 * 12;
const FRD_BINARY: usize = 7 * 4 + 28 * 4;

/// Bytes of a checkpoint beside vectors and histories: the problem, digests, counts, what judges remember, a few hundred cut-backs.
const CHECKPOINT_REST: usize = 40_000;

/// What a run writes. Numbers of increments are those of steps in which none is cut back; sizes are upper bounds, up to five times what comes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Sizes {
    /// Increments, about.
    pub increments: u64,
    /// A checkpoint `[bytes]`; the last two are kept.
    pub checkpoint: u64,
    /// One that is written where a run is asked to stop, with the increments that wait for their interiors `[bytes]`.
    pub last_checkpoint: u64,
    /// A file of fields, with those of the surfaces of interfaces, before compression `[bytes]`.
    pub fields: u64,
    /// What the `.frd` file grows by with each, nothing if there is none `[bytes]`.
    pub frd: u64,
    /// How many of them, about.
    pub outputs: u64,
    /// A row of the history `[bytes]`.
    pub row: u64,
    /// How many of them, about.
    pub rows: u64,
}

impl Sizes {
    /// All of it `[bytes]`.
    pub fn total(&self) -> u64 {
        let fields =
            (self.outputs).saturating_mul(self.fields + self.frd + FIELDS_LINE_BYTES as u64);
        let checkpoints = 2 * self.checkpoint.max(self.last_checkpoint);
        let rows = self.rows.saturating_mul(self.row);
        checkpoints.saturating_add(fields).saturating_add(rows)
    }
}

/// How much the run will write, if it is asked before it begins.
pub(super) fn sizes(run: &Run) -> Sizes {
    let plan = &run.model.reports.output;
    let mut sizes = Sizes::default();
    for step in &run.model.steps {
        let count = increments_of(run, step);
        let landings = plan.times.iter();
        let landings = landings.filter(|t| step.start < **t && **t < step.end);
        let ends = 1 + landings.count() as u64;
        let every = |n: usize| count.checked_div(n as u64).unwrap_or(0);
        sizes.increments += count;
        sizes.outputs += (every(plan.every) + ends).min(count);
        sizes.rows += (every(plan.history_every) + ends).min(count);
    }
    let view = view!(run);
    let mesh = &run.model.mesh;
    let of_mesh = mesh
        .blocks
        .iter()
        .map(|b| b.connectivity.len() + 4 * b.cell_ids.len());
    let numbers = fields(&view)
        .all
        .iter()
        .map(|f| f.values.len())
        .sum::<usize>()
        + 4 * mesh.points.len()
        + of_mesh.sum::<usize>();
    let state = &view.frame.state;
    let surfaces = view.contacts().map(|i| look::sheet(i, &state.u, state.t));
    let surfaces = surfaces.map(|s| {
        let values = s.fields.all.iter().map(|f| f.values.len());
        // Coordinates and numbers of points, pieces of quadratic faces.
        8 * (values.sum::<usize>() + 4 * s.points.len() + 25 * s.faces.len()) + 5_000
    });
    sizes.fields = (8 * numbers + surfaces.sum::<usize>() + 10_000) as u64;
    let frd = match plan.frd {
        None => [0, 0],
        Some(Encoding::Text) => [FRD_TEXT, 10_000],
        Some(Encoding::Binary) => [FRD_BINARY, 10_000],
    };
    sizes.frd = (frd[0] * mesh.points.len() + frd[1]) as u64;
    let nothing = Trial { from: 0.0, to: 0.0 };
    let row = history::row(&view, &run.judges.around, nothing, Default::default(), 0, 0);
    sizes.row = (NUMBER * row.values.len()) as u64;
    let (checkpoint, waiting) = checkpoint_sizes(run);
    let names = sizes.outputs.saturating_mul(FIELDS_LINE_BYTES as u64);
    sizes.checkpoint = names.saturating_add(checkpoint as u64);
    sizes.last_checkpoint = sizes.checkpoint.saturating_add(waiting as u64);
    sizes
}

/// Increments of a step, if none is cut back.
fn increments_of(run: &Run, step: &Step) -> u64 {
    let increments = &step.increments;
    let length = match step.dynamic.map(|dynamic| dynamic.method) {
        Some(method @ Method::Explicit { .. }) if !step.fixed => {
            let stable = Explicit::new(&run.model, method).stable_alone();
            stable.min(increments.largest)
        }
        _ if step.fixed => increments.initial,
        // They grow.
        _ => (increments.initial * increments.largest).sqrt(),
    };
    let cycles = step.cycles.filter(|c| c.chosen().is_some());
    let span = match cycles {
        Some(cycles) => cycles.period * cycles.count.min(BLOCKS) as f64,
        None => step.end - step.start,
    };
    (span / length).clamp(1.0, 1e15).round() as u64
}

/// Bytes of a checkpoint, and of the increments that may wait in the last one.
fn checkpoint_sizes(run: &Run) -> (usize, usize) {
    let model = &run.model;
    let vector = size_of::<f64>() * model.dofs.count();
    let interfaces = run.contact.interfaces.iter();
    let histories: usize = interfaces.map(|i| i.history_bytes()).sum();
    // The direction of the last increment; velocities and accelerations; what integrators and condensed bodies take along.
    let mut vectors = 1;
    let of_kind = |wanted: fn(&Step) -> bool| model.steps.iter().any(wanted);
    if of_kind(|step| step.dynamic.is_some()) {
        vectors += 2;
    }
    if of_kind(|step| step.dynamic.is_some() && !step.is_explicit()) {
        vectors += 2;
    }
    if of_kind(Step::is_explicit) {
        vectors += 3;
    }
    let condensed = matches!(
        model.solution.method,
        Solution::Automatic | Solution::Condensed
    ) && of_kind(|step| step.dynamic.is_none());
    if condensed {
        vectors += 4 + model.actions.loads.len() + model.actions.supports.len();
    }
    // What factors were made of: one of bodies at rest, up to four in motion.
    let mut factors = 0;
    if of_kind(|step| step.dynamic.is_none()) {
        factors = 1;
    }
    if of_kind(|step| step.dynamic.is_some() && !step.is_explicit()) {
        factors = MOST_FACTORS;
    }
    let interfaces = run.contact.interfaces.iter();
    let put_in: usize = interfaces.map(|i| i.stand_in_bytes(model.dofs.dim)).sum();
    let factored = factors * (put_in + model.dofs.count());
    let now = checkpoint_with(run, attempt_state(run)).to_bytes().len();
    let waiting = match condensed {
        true => TOGETHER * (4 * vector + histories),
        false => 0,
    };
    let grown = vectors * vector + 3 * histories + factored;
    (now + grown + CHECKPOINT_REST, waiting)
}
