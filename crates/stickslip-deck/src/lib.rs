//! Input decks in the format of Abaqus and CalculiX: read, checked, and translated to a stickslip [`Problem`](stickslip::problem::Problem).
//!
//! The road is `files → cards → Deck → Translation`:
//!
//! - [`source`] joins the included files and cuts them into cards: a keyword with parameters and its data lines.
//! - [`read`](read()) gives every card its meaning. One table says of every keyword and parameter whether it is read, refused at its line, or left out
//!   with a note, as it cannot change the answer; what is in no row is an error. All errors are reported at once. Parts and instances become one flat
//!   deck; [`Numbering`] tells whose a number is.
//! - [`translate`](translate()) makes a problem and its mesh of it: connected cells become bodies, cards become tables.
//! - [`Translation::frd`] says what `*NODE FILE`, `*EL FILE` and `*CONTACT FILE` ask for in the `.frd` file, which the library writes.
//! - [`Printer`] writes what `*NODE PRINT`, `*EL PRINT`, `*SECTION PRINT` and `*CONTACT PRINT` ask for in CalculiX's layout, [`Status`] a `.sta` file with
//!   Abaqus's columns.
//!
//! Where the two programs differ the meaning is CalculiX's; the differences are named at the items.
//!
//! # What differs from CalculiX
//!
//! - `HARD` contact is exact: CalculiX puts springs of fifty times Young's modulus there. Sticking without a stick slope is exact as well,
//!   and so is sticking with one under hard contact.
//! - With `NLGEOM` strains of the bodies are taken as small. With `*STATIC` elements turn by any angle, each in a frame of its own; with `*DYNAMIC` bodies that nothing
//!   holds or couples do, and rotations of all others are taken as small, as are those around an axis of symmetry and with temperatures.
//! - Interactions without `*SURFACE BEHAVIOR` are hard, as in Abaqus; CalculiX refuses them.
//! - Contact pairs without `TYPE` are `SURFACE TO SURFACE`.
//! - Linear springs on quadratic faces act at fixed points of a face, some forty; CalculiX cuts faces along each other first.
//! - The side with the smaller cells is the secondary one, whichever is the slave, unless values at slave nodes are printed.
//! - `*CONTACT PRINT` prints nodes, whose pressure is a mean around them, for pairs of faces too. The energy of the springs is printed as a sum only.
//! - Plane and axisymmetric elements are computed as such; CalculiX makes solid ones of them and prints the points of those.
//!   The strain across a plane-stress element is not printed.
//! - `*RIGID BODY` of part of an elastic body has to have its reference node prescribed.
//! - Lines and faces without section beside cells, which Gmsh writes, only carry sets; CalculiX would compute them.
//! - Several loads on one thing in one step need one amplitude, as they do in CalculiX; Abaqus would take each with its own.

#![forbid(unsafe_code)]

mod axes;
mod card;
mod deck;
mod finding;
mod fortran;
mod motion;
mod numbering;
mod parse;
mod print;
mod section;
pub mod source;
mod status;
mod taken;
mod text;
mod translate;

pub use deck::*;
pub use finding::{DeckError, Finding, Severity};
pub use numbering::Numbering;
pub use parse::{from_source, parse, read};
pub use print::Printer;
pub use status::Status;
pub use translate::{PrintPlan, Translation, read_mesh, translate};
