//! Result files of CalculiX (`.frd`): written for CalculiX GraphiX, PrePoMax, FreeCAD and ccx2paraview.
//!
//! A file has a head, the nodes (`2C`) and elements (`3C`) once, and for every output one block of values at nodes a quantity (`100C`). Lines have fixed
//! columns; the layout is that of the manual of CalculiX GraphiX, section *Result Format*, and of what CalculiX 2.20 writes. As text numbers have six
//! digits; binary the coordinates are of 64 bits and values of 32, as in CalculiX's own files.
//!
//! The file is whole after each output: the line that ends it is replaced by what is added and written again behind it.

mod block;
mod columns;
mod file;
mod kinds;
mod layout;

pub use block::{Block, Moment, Shape};
pub use file::{END_LINE, Results, Tally, end_again};
pub use layout::{Encoding, Layout};
