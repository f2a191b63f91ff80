//! Newton's method on the contact candidates alone.
//!
//! Every body is a [`Substructure`]: its interior is eliminated once, and what remains is how the dofs yield where it may touch others. A Newton
//! iteration then costs a few products with dense matrices of the size of the contact surfaces, whatever the bodies are like inside. The interior
//! is found when somebody asks for it, for many increments in one sweep.
//!
//! With `W = (S + σ R Rᵀ)⁻¹` and the forces `s` for which `u = W s`, balance at the candidates reads
//!
//! ```text
//! s - σ R Rᵀ u + contact(u) = load
//! ```
//!
//! Newton steps are sought as steps of `s`: `(I + K W) ds = -residual` with the tangent `K` of the interfaces. However stiff they are, nothing
//! in it is divided by their compliance.

mod condensation;
mod file;
mod gaps;
mod identity;
mod library;
mod lu;
mod reduced;
mod shapes;
mod substructure;

pub use condensation::{Condensation, Cost, Effort, Places, Plan, Swept};
pub use gaps::Gaps;
pub use identity::{Identity, Part};
pub use library::{Library, Source};
pub use reduced::Reduced;
pub use shapes::{Amplitudes, Shapes};
pub use substructure::{Floating, Seconds, Substructure};
