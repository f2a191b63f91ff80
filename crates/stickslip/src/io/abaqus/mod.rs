//! Meshes of Abaqus and CalculiX: what their element types, node orders and face numbers are here (Abaqus elements
//! guide, *Solid elements*; CalculiX CrunchiX manual, *Element types*), and a writer of input files (`.inp`) that hold a mesh.
//!
//! Node orders agree for every kind that is read: corners, then middles of edges as VTK has them. Faces are numbered from
//! `S1`; the tables here are Abaqus's, and are matched to [`ReferenceElement::faces`](crate::shape::ReferenceElement::faces)
//! by their corners.

mod faces;
mod types;
mod write;

pub use faces::{face_index, face_number};
pub use types::{ElementType, Integration, Space, Unsupported, element_type, node_order};
pub use write::{text, write};
