//! What judges: quality gate, equilibrium, doctor. They look only, and nothing here changes a result.

pub(crate) mod diagnosis;
pub mod doctor;
pub(crate) mod equilibrium;
pub(crate) mod figures;
pub(crate) mod gate;
pub(crate) mod missed;
pub(crate) mod prestress;
pub(crate) mod quality;
pub(crate) mod rotation;
mod scale;
pub(crate) mod travel;
pub(crate) mod unsupported;
pub(crate) mod view;

pub use diagnosis::{BodyReport, CheckReport, FreeMode, InterfaceReport};
pub use doctor::Peak;
pub use gate::{Figure, Gate, told_apart};
pub use quality::{Imbalance, InterfaceSummary, NumericalStiffness, Points};
pub use view::View;
