//! A model and its run: the step loop, observers, reports.

mod accepted;
mod choice;
pub mod compare;
mod condense;
mod conditions;
mod diagnosis;
pub mod doctor;
mod dynamic;
mod explicit;
mod files;
mod history;
mod inertia;
mod leap;
mod ledger;
mod model;
mod pending;
mod run;
mod spin;
mod statics;
mod summary;

pub use diagnosis::{BodyReport, CheckReport, FreeMode, InterfaceReport};
pub use files::{ResultFiles, fields};
pub use history::Row;
pub use ledger::EnergyLedger;
pub use model::{
    Body, Dynamic, Initial, Model, OutputPlan, Prescribed, Probe, Rigid, Solution, Step, Support,
};
pub use run::{Advance, Event, Observer, Simulation};
pub use summary::{Phases, Summary};
