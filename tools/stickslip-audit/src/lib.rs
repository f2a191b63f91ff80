//! An audit of result folders that shares no code with the solver.
//!
//! [`audit`](audit::audit) reads what a run has written (fields, history, tables of interfaces, the problem as it was run) and measures
//! what a right result must obey, by shape functions, rules, laws and projections of its own: the balance at every node, the friction
//! cone, complementarity and laws, action and reaction, energies, and where the surfaces really are. [`verdict`] compares this with what
//! the program said of its result.

pub mod audit;
pub mod balance;
pub mod bulk;
pub mod case;
pub mod cell;
pub mod compare;
pub mod contact;
pub mod csv;
pub mod draw;
pub mod element;
pub mod energy;
pub mod external;
pub mod figure;
pub mod inertia;
pub mod law;
pub mod loads;
pub mod lone;
pub mod mesh;
pub mod mix;
pub mod motion;
pub mod overlap;
pub mod results;
pub mod side;
pub mod spring;
pub mod vec3;
pub mod verdict;
pub mod vtu;
