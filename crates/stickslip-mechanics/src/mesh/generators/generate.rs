//! What every generator does.

use crate::error::MeshError;
use crate::mesh::Mesh;

/// Makes a mesh from a few numbers. Points and cells are numbered from 1 in the order in which they are stored.
pub trait Generate {
    /// The mesh; it passes [`check`](crate::mesh::check::check).
    ///
    /// # Errors
    /// If the numbers make no sense, with what they should be.
    fn generate(&self) -> Result<Mesh, MeshError>;
}
