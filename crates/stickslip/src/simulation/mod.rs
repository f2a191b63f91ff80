//! A model and its run: the step loop, observers, reports.

mod accepted;
mod book;
mod central_difference;
mod choice;
pub mod compare;
mod condensed;
mod conditions;
mod contact;
mod diagnosis;
pub mod doctor;
mod drivers;
mod equilibrium;
mod explicit;
mod failures;
mod figures;
mod files;
mod floating;
mod folder;
mod frame;
mod free_bodies;
mod history;
mod implicit;
mod inertia;
mod integrator;
mod ledger;
mod limits;
mod lock;
mod model;
mod observer;
mod onset;
mod pending;
mod quality;
mod quasi_static;
mod rigid_closure;
mod run;
mod scene;
mod solver;
mod spin;
mod steps;
mod summary;
mod travel;
mod unheld;
mod unsupported;
mod view;

pub use contact::Contact;
pub use diagnosis::{BodyReport, CheckReport, FreeMode, InterfaceReport};
pub use files::{ResultFiles, fields};
pub use folder::{Claim, FileClaim, running};
pub use frame::{Frame, Motion};
pub use history::Row;
pub use ledger::EnergyLedger;
pub use limits::{GateMode, Limits};
pub use model::{
    Body, Dynamic, Initial, Model, OutputPlan, Prescribed, Probe, Rigid, Setup, Solution, Step,
    Support,
};
pub use observer::{Advance, Event, Observer};
pub use quality::{Figure, Gate, InterfaceSummary, NumericalStiffness};
pub use run::Simulation;
pub use scene::Scene;
pub use steps::Interrupt;
pub use summary::{Phases, Status, Summary};
pub use view::{Analysis, View};
