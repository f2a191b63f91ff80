//! Result files: VTK XML unstructured grids (`.vtu`) and surfaces (`.vtp`), written for ParaView and read back.
//!
//! What is written: arrays appended raw and compressed by zlib in blocks (*VTK XML formats*, `vtkZLibDataCompressor`),
//! with 64-bit headers in little-endian order.
//!
//! What is read: the points and their data ([`read`]) or the mesh ([`read_mesh`]), from that and from what other programs make of
//! the format. Arrays may be text, inline base64, or appended as raw bytes or base64; plain or compressed by zlib; with headers of 32 or 64 bits; of
//! any number type. Where only points are read cells are passed over, and their arrays are not checked. The pieces of a file are
//! joined. Big-endian files, other compressors and other types of data set are refused.

mod array;
mod grid;
mod kinds;
mod read;
mod stream;
mod surface;
mod whole;
mod write;
mod xml;

#[cfg(test)]
mod grid_tests;
#[cfg(test)]
mod tests;

pub use grid::{parse_mesh, read_mesh};
pub use read::{PointArray, PointFields, parse, read};
pub use surface::{Surface, read_surface, write_surface};
pub use whole::{Grid, read_grid};
pub use write::{PackedMesh, write, write_mesh, write_vertices};

pub(super) use write::escape;
pub(super) use xml::{Event, Scanner};
