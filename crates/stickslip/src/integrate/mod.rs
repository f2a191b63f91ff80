//! How increments are made: integrators, each with one attempt at one increment.
//!
//! # In motion
//!
//! A step with a `dynamic` table differs in four places; Newton and the interfaces do not know which step they are in.
//!
//! - `implicit.rs` makes the matrix `A` of the increment (inertia, damping and stiffness as the scheme weighs them, kept for
//!   the last few lengths by `solve/inertia.rs`) and the forces of the bulk at the guess. Newton solves
//!   `forces + A (u - guess) + contact(u) = 0`: written as `A u` the forces would be differences of large numbers.
//! - `onset.rs` begins the step. Where points with mass touch, the forces of contact at the start are those of a short trial increment of
//!   Euler's method, after which all is put back; one that comes out in proportion to its length is an impact, and is left to the increment. Then
//!   `(M + h C) a₀ = f`, with `h` where the scheme would carry the acceleration that damping ends beyond it.
//! - `Stage::rate` says how the velocity at the end of the increment follows from the displacement. Friction looks at that velocity, not at
//!   the mean: a mass that sticks would swing about the velocity it sticks at. Points without mass, and prescribed ones, have the mean
//!   velocity, as nothing else defines one.
//! - Points of interfaces have no mass where the normal law is unilateral; the cells around them have it instead
//!   (`body/redistribution.rs`). That is what keeps contact forces from chattering and impacts from gaining energy.
//!
//! An explicit step (`explicit.rs`) needs neither Newton nor a matrix: `body/internal` gives the forces of the bodies cell by
//! cell in vector lanes, contact acts through springs, equations and ties hold exactly (`exact.rs`), and the increment follows from the highest frequency (Lanczos) and the springs in
//! contact. An analysis of explicit steps alone never assembles a stiffness.
//!
//! **Invariant:** the ledger (`model/ledger.rs`) is closed by quantities that do not know of each other: work from loads and
//! reactions, energies from the states, friction from the interfaces, and what the scheme takes from its own formula. The residual is what is
//! left of them, never an entry.
//!
//! **Invariant:** a force is evaluated from committed history and the state of evaluation, never from the previous
//! iteration. Only `commit` advances history. What an interface knows has four types: `History`, plain data that commits write, all that reports read, and all that an
//! increment keeps which waits for its report; `Attempt`, which begins anew from it; `Conditions`, what holds while it is evaluated, an argument that the solver owns; `Cache`, what can be made again and is
//! never copied. What outlives a rejected attempt is cache: candidates of the search and the factor that preconditions. The multipliers of a perturbed Lagrangian are unknowns like displacements; they change
//! through `update_internal` with the Newton step, and `begin` resets them. Five things depend on the course of an attempt: the stiffness of an augmented
//! Lagrangian is raised where updates gain little, points that keep changing status are frozen for a while, a point
//! stays on its facet while the surface is flat, a point that has twice left the outer edge stays off, and, while nothing has been in contact yet, points that just touch are given a stiffness in its first tangent, so that a body
//! under force has something to lean on.

pub(crate) mod central_difference;
mod drift;
pub(crate) mod exact;
pub(crate) mod explicit;
pub(crate) mod implicit;
pub(crate) mod impulse;
pub(crate) mod integrator;
pub(crate) mod onset;
pub(crate) mod quasi_static;
mod sight;
mod supports;
pub(crate) mod turning;
