//! Small vibrations about the state that an analysis has reached: real modes, modes of steady sliding, maps over friction.
//!
//! `linear` is the model linearised: a symmetric stiffness of bodies, springs, couplings and closed contacts, the mass, the damping of bodies, and what
//! friction adds, as pairs of sparse rows, one for each contact point that slides. Displacements that equations between them determine are no unknowns (`bound`). `shifted` solves with it: the symmetric part is factored once, friction is
//! a dense matrix over the sliding points (Woodbury's formula), and only that depends on the coefficient of friction. `real` and `complex` are the two
//! eigenvalue problems (`quadratic` solves the second). `reduced` is the model in the space of a few real modes, `companion` has its modes and `few` those of many
//! coefficients, for which `map` asks, and `estimate` says what they leave open; `harmonic` finds in that space the answer to forces at many frequencies.
//!
//! At a point that slides with the velocity `v` along `s`, pressure `p`, `k_n = dp/d(-g)` and the law `μ(v, p)` the secondary meets per area
//!
//! ```text
//! stiffness  k_n n nᵀ - (μ + p μ_p) k_n s nᵀ        damping  (μ p / v)(I - n nᵀ - s sᵀ) + p μ_v s sᵀ
//! ```
//!
//! as `Interface::linearise` reads off the laws themselves. There is no stiffness along the surface. What rotates does so slowly: convective and gyroscopic terms are left out.

pub(crate) mod bound;
pub(crate) mod companion;
pub(crate) mod complex;
pub(crate) mod estimate;
pub(crate) mod export;
pub(crate) mod few;
pub(crate) mod harmonic;
pub(crate) mod linear;
pub(crate) mod map;
pub(crate) mod outcome;
pub(crate) mod participation;
pub(crate) mod quadratic;
pub(crate) mod real;
pub(crate) mod reduced;
pub(crate) mod sensitivity;
pub(crate) mod shifted;

pub use outcome::{
    Array, Export, FIGURES, FrictionMap, MapRow, ModalOutcome, Mode, Response, ResponseRow,
    Sensitivity, TOLD, figures_of_mode, grows,
};

use crate::error::RunError;
use crate::model::capability::Feature;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::modal::Modal;
use crate::solve::solver::Solver;

/// Does what a step without increments asks for.
///
/// # Errors
/// If the matrix cannot be factored, or too much slides for a dense matrix.
pub(crate) fn compute(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    solver: &Solver,
    plan: &Modal,
) -> Result<ModalOutcome, RunError> {
    let feature = match plan {
        Modal::Real(_) => Feature::Modes,
        Modal::Complex(_) => Feature::ComplexModes,
        Modal::Harmonic(_) => Feature::Harmonic,
    };
    if let Some(message) = contact.refusal(feature) {
        return Err(linear::fault(frame, message));
    }
    let mut linear = linear::Linear::new(model, frame, contact, solver)?;
    if matches!(plan, Modal::Complex(plan) if !plan.friction_damping) {
        linear.drag.clear();
    }
    match plan {
        Modal::Real(plan) => real::modes(model, frame, &linear, plan),
        Modal::Complex(plan) => {
            complex::modes(model, frame, contact, &solver.conditions, &linear, plan)
        }
        Modal::Harmonic(plan) => harmonic::response(model, frame, &linear, plan),
    }
}
