//! Input decks in the format of Abaqus and CalculiX: read, checked, and translated to a stickslip [`Problem`](stickslip::problem::Problem).
//!
//! The road is `files → cards → Deck → Translation`:
//!
//! - [`source`] joins the included files and cuts them into cards: a keyword with parameters and its data lines.
//! - [`Deck::read`] gives every card its meaning. A keyword that matters and is not supported is an error at its line; one that does
//!   not change the answer is a note. All errors are reported at once.
//! - [`translate`](Deck::translate) makes a problem and its mesh of it: connected cells become bodies, cards become tables.
//! - [`Printer`] writes what `*NODE PRINT`, `*EL PRINT` and `*CONTACT PRINT` ask for in CalculiX's layout, [`Status`] a `.sta` file with
//!   Abaqus's columns.
//!
//! Where the two programs differ the meaning is CalculiX's; the differences are named at the items.

#![forbid(unsafe_code)]

mod deck;
mod finding;
mod keywords;
mod lint;
mod parse;
mod print;
pub mod source;
mod status;
mod translate;

pub use deck::*;
pub use finding::{DeckError, Finding, Severity};
pub use print::Printer;
pub use status::Status;
pub use translate::{Translation, read_mesh};

pub(crate) use parse::frame as parse_frame;
