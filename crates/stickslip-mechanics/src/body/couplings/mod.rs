//! Equations between displacements, and springs between points: what the problem file names under `coupling`, one file a kind.
//!
//! A kind turns sets of points into [`Row`]s, each a weighted sum of displacements. [`Couplings`] is the force made of all of them. It stands
//! on the side of contact, so that it may connect bodies that are factored one by one, come and go with the steps, and be the same for every
//! way to solve.
//!
//! Equations between displacements and springs between points (`body/couplings`) are rows `Σ factor · u` over a few dofs, all in one contact force, so that they
//! may join bodies that are condensed one by one, come and go with steps, and work with every way to solve. A spring is a row with its stiffness. The force along the
//! row of an equation is an unknown of Newton's method, eliminated with a stiffness of 10² times what holds its points, bodies and contact
//! (`fit.rs`, from the diagonal of the matrix and from contact in series with what its other points rest on), as in a method of multipliers with an update in every iteration: at equilibrium the equation holds to rounding,
//! and equations that say the same twice do no harm. Points of couplings are always candidates. At the start of motion `couplings/motion.rs` finds the forces with which
//! accelerations obey the equations. Small motions about a state, modes and answers to harmonic forces, have no unknowns for what equations determine. In explicit steps equations hold exactly (`integrate/exact.rs`), and rigid stops are springs that have at most the highest frequency of the bodies. The energy of springs counts with that
//! of the bodies, and the work of equations whose value changes with that of the supports.
//!
//! The cut of a pretension ([`Pretension`]) is a third kind of rows, made by `[pretension]` and not by a kind of coupling: there is no unknown for the
//! shortening, which is what the rows along the normal have in common.

mod all;
mod axial_spring;
mod dashpot;
mod definition;
mod distributing;
mod drawn;
mod elimination;
mod equation;
pub mod explicit;
pub mod fit;
pub mod force;
mod gap;
mod kinematic;
mod memory;
mod model;
pub mod motion;
mod pretension;
mod row;
mod spring;
pub mod state;
mod view;

pub use all::{Couplings, CouplingsForce, ExactForce};
pub use axial_spring::AxialSpring;
pub use dashpot::Dashpot;
pub use definition::{Coupling, CouplingsDefinition, Meets, StepTimes, Tie};
pub use distributing::{Distributing, SetWeight, Weights};
pub use equation::{Equation, Term};
pub use gap::Gap;
pub use kinematic::Kinematic;
pub use memory::CouplingsMemory;
pub use model::{CouplingModel, Ground};
pub use motion::MotionStart;
pub use pretension::{Course, Draw, Pretension};
pub use row::Row;
pub use spring::Spring;
pub use state::CouplingsState;
pub use view::CouplingsView;

crate::family! {
    /// The kinds of couplings.
    CouplingKind: "coupling", dyn CouplingModel {
        /// A weighted sum of displacements has a given value.
        Equation(Equation) = "equation",
        /// A spring against a weighted sum of displacements.
        Spring(Spring) = "spring",
        /// A spring along the line between two points.
        AxialSpring(AxialSpring) = "axial-spring",
        /// A weighted sum of displacements does not fall below a value.
        Gap(Gap) = "gap",
        /// A damper against the rate of a weighted sum of displacements.
        Dashpot(Dashpot) = "dashpot",
        /// Points follow a reference point as if they were rigid with it.
        Kinematic(Kinematic) = "kinematic",
        /// A reference point follows the mean motion of points, and hands its forces on to them.
        Distributing(Distributing) = "distributing",
    }
}
