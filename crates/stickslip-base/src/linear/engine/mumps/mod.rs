//! MUMPS ([Amestoy, Duff, L'Excellent and Koster 2001](crate::references::amestoy_2001)) on the ranks of an MPI job that this process starts: `mpirun -n N stickslip-mumps FOLDER`, the program in
//! `engines/mumps`, whose head describes the protocol.
//!
//! This process stays free of MPI. Bodies are factored one after the other, each on all ranks. What passes between is, for each rank, some cells, whose matrices it makes (`cells.rs`), or
//! where the matrix is kept here some of its entries; the Schur complement
//! unless it stays with the ranks (`root.rs`), and vectors, in a folder of this job alone, whose files are deleted by whoever reads them. Bits may differ from run to run: MUMPS distributes its work as it goes.
//!
//! Nothing stays behind: the job ends with the engine, the ranks end when their standard input or their parent is gone, and take the folder along if this process was killed.

mod body;
mod cells;
mod engine;
mod entries;
mod factor;
mod folder;
mod job;
mod number;
mod options;
mod program;
mod refusal;
mod root;
#[cfg(test)]
mod tests;
mod words;

pub use engine::Mumps;
pub use options::MumpsOptions;
