//! A model and its run: the step loop, observers, reports.

mod accepted;
mod approach;
mod choice;
pub mod compare;
mod condense;
mod conditions;
mod diagnosis;
pub mod doctor;
mod drivers;
mod dynamic;
mod equilibrium;
mod explicit;
mod figures;
mod files;
mod folder;
mod history;
mod inertia;
mod leap;
mod ledger;
mod limits;
mod lock;
mod loose;
mod march;
mod model;
mod onset;
mod pending;
mod quality;
mod run;
mod spin;
mod statics;
mod summary;
mod travel;
mod unheld;

pub use diagnosis::{BodyReport, CheckReport, FreeMode, InterfaceReport};
pub use files::{ResultFiles, fields};
pub use folder::{Claim, FileClaim, running};
pub use history::Row;
pub use ledger::EnergyLedger;
pub use limits::{GateMode, Limits};
pub use march::Interrupt;
pub use model::{
    Body, Dynamic, Initial, Model, OutputPlan, Prescribed, Probe, Rigid, Solution, Step, Support,
};
pub use quality::{Figure, Gate};
pub use run::{Advance, Event, Observer, Simulation};
pub use summary::{NumericalStiffness, Phases, Status, Summary};
