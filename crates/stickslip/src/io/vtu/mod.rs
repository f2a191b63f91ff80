//! Result files: VTK XML unstructured grids (`.vtu`), written for ParaView and read back.
//!
//! What is written: arrays appended raw and compressed by zlib in blocks (*VTK XML formats*, `vtkZLibDataCompressor`),
//! with 64-bit headers in little-endian order.
//!
//! What is read: the points and their data, from that and from what other programs make of the format. Arrays may be
//! text, inline base64, or appended as raw bytes or base64; plain or compressed by zlib; with headers of 32 or 64 bits; of
//! any number type. [`read()`] passes over cells and their data, so their arrays are not checked; [`read_grid`] takes them
//! as well. The pieces of a file are joined. Big-endian files, other compressors and other types of data set are refused.

mod array;
mod grid;
mod read;
mod stream;
mod write;
mod xml;

#[cfg(test)]
mod tests;

pub use grid::{Grid, read_grid};
pub use read::{PointArray, PointFields, read};
pub use write::{write, write_vertices};

pub(super) use write::escape;
pub(super) use xml::{Event, Scanner};
