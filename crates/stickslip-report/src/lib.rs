//! What came of a run, for people: a report in one HTML file ([`report`]) and pictures without a browser ([`plot`]).
//!
//! The input is a result folder as `stickslip run` leaves it ([`Results`]); nothing is computed anew. A report opens from disk
//! without a network: the libraries for plots and the 3D view are part of this crate (`assets/`).

mod colour;
mod draw;
mod field;
mod html;
mod obstacle;
mod pack;
mod phase;
pub mod plot;
mod results;
mod shapes;
mod sheet;
mod skin;
mod units;

pub use field::NAMES;
pub use html::{Limits, Report, page, write as report};
pub use results::{Frame, Results};
