use serde::{Deserialize, Serialize};

use super::{Row, Tie};

use super::model::{CouplingModel, Ground, pair};
use crate::error::Diagnostic;
use crate::registry::Samples;
use crate::system::Component;

/// A linear equation between displacements: the sum of factor times displacement has a value. It holds exactly, not by a stiff spring.
///
/// Sets of n points stand for n equations, paired in the order of the points in the mesh; a set of one point pairs with all, itself left out. Equations that
/// say the same twice do no harm. They hold exactly in explicit steps, too.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Equation {
    /// What is summed up: `[{ set = "a.left", component = "x" }, { set = "b.right", component = "x", factor = -1 }]`.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub terms: Vec<Term>,
    /// What the sum is `[length]`; zero if not given.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub value: f64,
}

/// One displacement in a sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Term {
    /// The points: `body.set`, a `[set.NAME]`, a body, or a `[reference.NAME]`.
    pub set: String,
    /// The direction of the displacement; of a reference point its rotation as well, in rad: `rotation-z`.
    pub component: Component,
    /// What it is multiplied by `[-]`.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub factor: f64,
}

fn one() -> f64 {
    1.0
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

pub(super) fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl CouplingModel for Equation {
    fn sets(&self) -> Vec<(String, &str)> {
        sets(&self.terms)
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        if !self.value.is_finite() {
            return Err(Diagnostic::new("value", "the value is not finite"));
        }
        rows(&self.terms, points, ground)
    }

    fn tie(&self) -> Tie {
        Tie::Equation { value: self.value }
    }
}

pub(super) fn sets(terms: &[Term]) -> Vec<(String, &str)> {
    let named = terms.iter().enumerate();
    named
        .map(|(i, t)| (format!("terms.{i}.set"), t.set.as_str()))
        .collect()
}

/// One row for every tuple of points.
pub(super) fn rows(
    terms: &[Term],
    points: &[Vec<usize>],
    ground: Ground,
) -> Result<Vec<Row>, Diagnostic> {
    for (i, term) in terms.iter().enumerate() {
        if !term.factor.is_finite() {
            return Err(Diagnostic::new(
                format!("terms.{i}.factor"),
                "the factor is not finite",
            ));
        }
    }
    let tuples = pair(points, &sets(terms))?.into_iter();
    let (mut rows, mut empty) = (Vec::new(), None);
    for tuple in tuples {
        let mut sum = Vec::with_capacity(terms.len());
        for (i, (point, term)) in tuple.into_iter().zip(terms).enumerate() {
            let found = ground.term(point, term.component);
            let (point, slot, unit) =
                found.map_err(|e| Diagnostic::new(format!("terms.{i}.component"), e))?;
            sum.push((point, slot, term.factor * unit));
        }
        match Row::new(sum, ground.dim()) {
            Ok(row) => rows.push(row),
            // A single point among those that are paired with it does what it does.
            Err(e) => empty = Some(e.under("terms")),
        }
    }
    match empty {
        Some(e) if rows.is_empty() => Err(e),
        _ => Ok(rows),
    }
}

impl Samples for Equation {
    fn samples() -> Vec<Self> {
        let term = |component, factor| Term {
            set: "a.left".into(),
            component,
            factor,
        };
        vec![Equation {
            terms: vec![term(Component::X, 1.0), term(Component::Y, -0.5)],
            value: 1e-3,
        }]
    }
}
