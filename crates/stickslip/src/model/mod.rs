//! What is simulated and where it stands: data, and what acts at a time.

pub mod capability;
pub(crate) mod conditions;
pub(crate) mod contact;
pub(crate) mod course;
pub(crate) mod cycling;
pub(crate) mod definition;
pub(crate) mod frame;
pub(crate) mod heat;
pub(crate) mod kick;
pub(crate) mod ledger;
pub(crate) mod limits;
pub(crate) mod modal;
pub(crate) mod rigid;
pub(crate) mod scene;
pub(crate) mod second_field;
pub(crate) mod setup;
pub(crate) mod thermal;

pub use contact::Contact;
pub use course::Course;
pub use cycling::{Block, ChosenJump, Cycling, Jump};
pub use definition::{
    Actions, Body, ContactAt, ContactMass, Dynamic, Initial, Model, OutputPlan, Prescribed, Probe,
    Reference, ReportPlan, Rigid, Solution, SolutionPlan, Step, Support,
};
pub use frame::{Frame, Motion};
pub use heat::Heat;
pub use kick::{Growth, Kick, Share};
pub use ledger::{EnergyLedger, EnergyQuality};
pub use limits::{GateMode, Limits};
pub use modal::{
    ComplexPlan, Frequencies, HarmonicPlan, KickPlan, MapOver, MapPlan, Modal, ModalDamping,
    RealPlan, SteadyPlan,
};
pub use scene::Scene;
pub use second_field::{FieldIncrement, SecondField};
pub use setup::Setup;
