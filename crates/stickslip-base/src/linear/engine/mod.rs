//! Engines: who eliminates the interiors of bodies, and keeps the factors.
//!
//! An [`Engine`] cuts a body into interior and kept dofs, which is [`Analysed`] before any arithmetic, factors it, which leaves the Schur complement of the kept
//! dofs here, and keeps an [`Interior`], which reduces forces and finds displacements, for many columns at once. Where the factor is, in this process or
//! in others, its user does not know: nothing but vectors and the Schur complement passes through here, and not even that where it is too large: then its inverse
//! stays where it is, too ([`DistributedOperator`](super::DistributedOperator)), and there are products with it. The matrix comes as a [`Matrix`](super::Matrix), which an engine takes entry by entry
//! where it is not kept, or cell by cell, to compute them where it is ([`Cells`](super::Cells)).

mod bare;
mod builtin;
mod contract;
mod mumps;
mod split;

pub use builtin::Multifrontal;
pub use contract::{Analysed, Cut, Engine, EngineReport, FactorEffort, Interior};
pub use mumps::{Mumps, MumpsOptions};
pub use split::Split;
