//! What became of a deck.

use super::blocks::Comparison;

/// What became of a deck.
pub struct Outcome {
    /// Its name.
    pub name: String,
    /// Why it was refused: the first finding.
    pub refusal: Option<String>,
    /// Against the reference, with hard contact as it is here, and with CalculiX's stiffness as the law.
    pub found: Vec<(Variant, Comparison)>,
}

/// How a deck was run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// As it is.
    Plain,
    /// With the stiffness that CalculiX takes for hard contact.
    Stiffness,
}
