//! Engines that factor bodies, as a problem file chooses them, one file each.

mod choice;
mod multifrontal;
mod mumps;

pub use choice::EngineChoice;
pub use multifrontal::Multifrontal;
pub use mumps::Mumps;

crate::family! {
    /// The linear solver that factors condensed bodies, and keeps the factors.
    EngineModel: "engine", dyn EngineChoice {
        /// The one that is built in.
        Multifrontal(Multifrontal) = "multifrontal",
        /// MUMPS on the ranks of an MPI job.
        Mumps(Mumps) = "mumps",
    }
}

impl Default for EngineModel {
    fn default() -> Self {
        EngineModel::Multifrontal(Multifrontal {})
    }
}
