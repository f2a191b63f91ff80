use std::collections::BTreeMap;

use serde::Serialize;

use crate::assess::doctor::Finding;
use crate::assess::gate::Gate;
use crate::assess::quality::InterfaceSummary;
use crate::error::Error;
use crate::fatigue::Maximum;
use crate::linear::EngineReport;
use crate::machine::{page_faults, peak_memory};
use crate::modal::ModalOutcome;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::kick::Growth;
use crate::model::ledger::{EnergyLedger, EnergyQuality};
use crate::newton::condensed::CACHE_NOTE;
use crate::newton::{Fallback, Statistics};

/// What `summary.json` holds.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Summary {
    /// What was run, and how it ended.
    #[serde(flatten)]
    pub run: RunOutcome,
    /// What the doctor found, in the order in which it happened; 200 at most.
    pub findings: Vec<Finding>,
    /// How the systems of equations were solved.
    #[serde(flatten)]
    pub solved_by: SolvedBy,
    /// What else a user should know.
    pub notes: Vec<String>,
    /// Size of the problem.
    pub size: Size,
    /// Increments, accepted and rejected.
    #[serde(flatten)]
    pub attempts: AttemptCounts,
    /// The last explicit step at its start.
    #[serde(flatten)]
    pub explicit: ExplicitStart,
    /// Largest rotation of a body so far `[rad]`, an elastic one by its mean displacement gradient at the rows of the history. Rotations are
    /// linearised about the start: above about 0.1 it shows, as the body grows by the half of its square.
    pub largest_rotation: f64,
    /// Bodies that only contact can hold.
    #[serde(flatten)]
    pub loose: FollowedBodies,
    /// What the run took.
    #[serde(flatten)]
    pub cost: RunCost,
    /// The balance of energies.
    #[serde(flatten)]
    pub balance: EnergySummary,
    /// How good the solution is, and whether that is enough.
    pub quality: Gate,
    /// Interfaces at the end, which is said again at the next one.
    #[keep(again)]
    pub interfaces: Vec<InterfaceSummary>,
    /// Modes, and motions along them.
    #[serde(flatten)]
    pub vibrations: Vibrations,
    /// Where criteria of fatigue were largest in the last cycle that was computed.
    pub fatigue: Vec<Maximum>,
    /// Last row of the history.
    pub last: BTreeMap<String, f64>,
}

/// What was run, and how it ended.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct RunOutcome {
    /// Title of the problem.
    pub title: String,
    /// Version of stickslip.
    #[keep(again = env!("CARGO_PKG_VERSION"))]
    pub version: &'static str,
    /// How far the run has come. In the file it says `running` from the first moment on, so that a run that was killed is found out.
    pub status: Status,
    /// `done`, or why not.
    pub outcome: String,
    /// Whether the run reached its end.
    pub completed: bool,
}

/// How the systems of equations were solved, why so, and by whom.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct SolvedBy {
    /// How the systems of equations were solved.
    pub method: String,
    /// Why so.
    pub method_reason: String,
    /// Who factored condensed bodies.
    pub engine: EngineSummary,
}

/// Increments, accepted and rejected.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct AttemptCounts {
    /// Accepted increments.
    pub increments: usize,
    /// Newton iterations of accepted increments.
    pub iterations: usize,
    /// Attempts rejected to locate changes of status in time.
    pub events: usize,
    /// Attempts rejected for other reasons.
    pub cutbacks: usize,
    /// Blocks of cycles that were taken back because they stood for too many.
    pub cycles_taken_back: usize,
    /// Why increments were rejected, one line each.
    pub cutback_reasons: Vec<String>,
    /// What was tried when plain iteration had failed, in this order, attempt by attempt. When nothing helped the increment was cut back.
    pub fallbacks: Vec<FallbackSummary>,
    /// Accepted increments that were solved as friction problems, by the solver that they took: of several the one that comes last in the portfolio. All
    /// others are those of plain iteration, or explicit.
    pub friction_solvers: BTreeMap<String, usize>,
}

/// An explicit step at its start.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct ExplicitStart {
    /// Longest stable increment at the start of the last explicit step, with its safety `[time]`; 0 without one.
    pub stable_increment: f64,
    /// Mass added by mass scaling, relative to the mass there is.
    pub mass_added: f64,
}

/// Bodies that only contact can hold, on their way to where it does.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct FollowedBodies {
    /// Increments in which bodies that only contact can hold were moved or anchored.
    pub followed: usize,
    /// Energy left in the anchors that held such bodies in the last of them, over the strain energy.
    pub artificial_energy: f64,
}

/// What a run took: counts, times and memory.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct RunCost {
    /// Counts and times of the solver.
    pub solver: Statistics,
    /// Seconds by phase.
    pub phases: Phases,
    /// Seconds that one assembly, ordering, factorisation and solution of the same bodies takes, as measured in this run; 0 if nothing was
    /// factored.
    pub linear_solve: f64,
    /// The whole analysis without writing, over that.
    pub relative_to_linear: f64,
    /// Largest memory of the process `[bytes]`; 0 if the system does not tell.
    pub peak_memory: u64,
    /// Pages of memory that the system gave to the process, at a microsecond or two each; 0 if the system does not tell.
    pub page_faults: u64,
    /// Threads used.
    #[keep(again = rayon::current_num_threads())]
    pub threads: usize,
}

/// The balance of energies at the end.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct EnergySummary {
    /// Energies at the end.
    pub energy: EnergyLedger,
    /// How well the balance of energies closes.
    pub energy_quality: EnergyQuality,
}

/// Modes, and motions that began along them.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Vibrations {
    /// Modes, by step that looked for them.
    pub modes: Vec<ModalOutcome>,
    /// How motions that began along modes grew, by step.
    pub growth: Vec<Growth>,
}

/// Keys of what depends on the process, and beginnings of those of the solver that depend on what it shares with others as well.
const OF_PROCESS: &[&str] = &[
    "phases",
    "linear-solve",
    "relative-to-linear",
    "peak-memory",
    "page-faults",
    "threads",
];
const OF_SHARING: &[&str] = &[
    "seconds",
    "analyses",
    "factorisations",
    "substructures",
    "flops",
    "linear",
];

/// Who factored condensed bodies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct EngineSummary {
    /// Its key in the problem file; empty if nothing was condensed.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Processes that factored.
    pub ranks: usize,
    /// Whether the same problem gives the same bits again, which digests of results rely on.
    pub reproducible: bool,
    /// Largest memory of one of the processes `[bytes]`, and the sum over all of them; 0 where it is this one.
    pub memory_of_rank: u64,
    /// See `memory-of-rank`.
    pub memory_of_all: u64,
    /// Cells whose matrices each of them has made, added up over all bodies that were factored; empty where this process has made all.
    pub cells_of_ranks: Vec<u64>,
    /// What each of them was sent to make these of `[bytes]`.
    pub bytes_of_ranks: Vec<u64>,
    /// Entries of matrices of cells and springs that this process has made for them.
    pub entries_dealt: u64,
}

impl From<EngineReport> for EngineSummary {
    fn from(report: EngineReport) -> Self {
        EngineSummary {
            name: report.name.into(),
            version: report.version,
            ranks: report.ranks,
            reproducible: report.reproducible,
            memory_of_rank: report.memory_of_rank,
            memory_of_all: report.memory_of_all,
            cells_of_ranks: report.cells_of_ranks,
            bytes_of_ranks: report.bytes_of_ranks,
            entries_dealt: report.entries_dealt,
        }
    }
}

/// How far a run has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It goes on, or was killed.
    #[default]
    Running,
    /// It reached its end. Whether the result is good enough is another question: see `quality`.
    Done,
    /// It ended with an error.
    Failed,
    /// It was asked to stop.
    Interrupted,
}

/// A way other than plain iteration by which an increment was tried.
#[derive(Debug, Clone, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct FallbackSummary {
    /// Step.
    pub step: String,
    /// Start of the increment `[s]`.
    pub from: f64,
    /// Its end `[s]`.
    pub to: f64,
    /// Which way, and what came of it.
    #[serde(flatten)]
    pub tried: Fallback,
}

/// Size of a problem.
#[derive(Debug, Clone, Copy, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Size {
    /// Points.
    pub points: usize,
    /// Cells.
    pub cells: usize,
    /// Displacement dofs.
    pub dofs: usize,
    /// Points of secondary surfaces.
    pub contact_points: usize,
}

/// Seconds by phase.
#[derive(Debug, Clone, Copy, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Phases {
    /// Reading and meshing.
    pub read: f64,
    /// Assembly of the bulk.
    pub assemble: f64,
    /// Ordering and symbolic factorisation.
    pub order: f64,
    /// Numeric factorisation.
    pub factor: f64,
    /// Inverses of what partial factorisations leave.
    pub condense: f64,
    /// Linear systems of Newton's method.
    pub iterate: f64,
    /// Search, pairing and assembly of interfaces.
    pub contact: f64,
    /// Interiors of condensed bodies, and the check that they balance.
    pub recover: f64,
    /// Writing results.
    pub write: f64,
    /// Wall time of the run.
    pub total: f64,
}

impl Summary {
    /// An empty summary of this model.
    pub fn new(model: &Model, contact: &Contact) -> Self {
        Summary {
            run: RunOutcome {
                title: model.title.clone(),
                version: env!("CARGO_PKG_VERSION"),
                ..RunOutcome::default()
            },
            size: Size {
                points: model.mesh.points.len(),
                cells: model.mesh.blocks.iter().map(|b| b.cell_ids.len()).sum(),
                dofs: model.dofs.count(),
                contact_points: contact.interfaces.iter().map(|i| i.points.len()).sum(),
            },
            cost: RunCost {
                threads: rayon::current_num_threads(),
                ..RunCost::default()
            },
            ..Summary::default()
        }
    }

    /// What of it does not depend on the process that made it: without times and memory, counts of factors, which may be those of others, and what is to be
    /// said of their files.
    pub(crate) fn without_process(&self) -> serde_json::Result<serde_json::Value> {
        let mut all = serde_json::to_value(self)?;
        let Some(entries) = all.as_object_mut() else {
            return Ok(all);
        };
        for key in OF_PROCESS {
            entries.remove(*key);
        }
        if let Some(solver) = entries.get_mut("solver").and_then(|s| s.as_object_mut()) {
            solver.retain(|key, _| !OF_SHARING.iter().any(|word| key.starts_with(word)));
        }
        if let Some(notes) = entries.get_mut("notes").and_then(|n| n.as_array_mut()) {
            notes.retain(|note| !note.as_str().is_some_and(|n| n.starts_with(CACHE_NOTE)));
        }
        Ok(all)
    }

    pub(crate) fn finish(&mut self, solver: &Statistics, total: f64, error: Option<&Error>) {
        self.cost.solver = *solver;
        self.cost.phases.order = solver.seconds.order;
        self.cost.phases.factor = solver.seconds.factor;
        self.cost.phases.condense = solver.seconds.condense;
        self.cost.phases.iterate = solver.seconds.solve;
        self.cost.phases.recover = solver.seconds.recover;
        self.cost.phases.contact = solver.seconds.contact;
        self.cost.phases.total = total;
        self.cost.linear_solve = solver.linear_solve + self.cost.phases.assemble;
        if self.cost.linear_solve > 0.0 && solver.linear_solve > 0.0 {
            self.cost.relative_to_linear = (total + self.cost.phases.assemble
                - self.cost.phases.write)
                / self.cost.linear_solve;
        }
        self.run.completed = error.is_none();
        self.run.status = match error {
            None => Status::Done,
            Some(Error::Interrupted(_)) => Status::Interrupted,
            Some(_) => Status::Failed,
        };
        self.run.outcome = error.map_or("done".into(), Error::to_string);
        self.cost.peak_memory = peak_memory();
        self.cost.page_faults = page_faults();
    }
}
