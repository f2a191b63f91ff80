//! Bodies that only contact can hold, in quasi-static steps: they are moved until they touch, and anchored until contact holds them.

mod closure;
mod follow;
mod rigid_part;
mod state;

pub(crate) use state::Floating;
