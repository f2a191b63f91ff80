//! How increments are solved: one [`Solver`](solver::Solver) that owns matrix, factors, Newton's method and the way to solve.
//!
//! # Floating bodies
//!
//! A body that supports leave free and that touches nothing has a singular matrix. In quasi-static steps `follow.rs` helps where a
//! contact normal could resist one of the free motions; where none could, the error stays.
//!
//! - *Approach* (`closure.rs`). Bodies that touch nothing are moved as rigid ones along the resultant of their loads, at speeds
//!   like those of free bodies from rest, until surfaces that come nearer touch (`Interface::meeting`); what has met moves on together. A push that
//!   turns a body as well is left to contact. This costs no strain and no energy: it changes the last accepted state before the increment is tried.
//! - *Anchors* (`body/anchors.rs`). Where a system is singular all the same, or a body has been moved, points of the body are held by weak springs. They
//!   are one more contact force, so that both bulks solve with them. After each equilibrium the anchors move to where the points have come
//!   (`augment`), and get weaker as there is less force left: the proximal point method. It ends when Newton has nothing left to do after a move; then the springs
//!   carry nothing. A motion that nothing resists and nothing drives stays where it is. Where supports carry the body in an increment, its anchors begin where they
//!   carry it (`carried.rs`): the springs are for the other motions.
//! - A long way with the anchors is made without strain as well: the rigid part of it changes the last state, and the increment is computed once more.
//!   A body that does not come to rest in a hundred rounds is reported like an unconstrained one.
//! - *Release* (`released.rs`). Where the load of a body goes, every place without contact is one of equilibrium, and Newton's method would end in one
//!   by chance: the body is anchored beforehand, and stays where it was.
//! - *Bounds*. In an increment an unconstrained body goes no further than ten times the gaps there are, what is prescribed and what it is strained, and one cell; beyond
//!   that it was thrown, and the increment is cut. What not even contact could hold (`model/rigid/held.rs`) is refused when a step begins, with what drives it
//!   (`model/rigid/drivers.rs`).

pub(crate) mod accepted;
mod by_cells;
pub(crate) mod carried;
pub(crate) mod checks;
pub(crate) mod choice;
pub(crate) mod condensed;
pub(crate) mod condenser;
pub(crate) mod floating_bodies;
pub(crate) mod follow;
pub(crate) mod inertia;
pub(crate) mod iteration;
mod pressed;
pub(crate) mod released;
pub(crate) mod solver;
pub(crate) mod spin;
pub(crate) mod state;
pub(crate) mod work;
