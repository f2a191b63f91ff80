//! What is wrong with a problem, by key.

use super::super::Problem;
use super::super::key;
use crate::error::Diagnostic;

pub(super) struct Findings(pub(super) Vec<Diagnostic>);

impl Findings {
    /// An empty help is none.
    pub(super) fn add(
        &mut self,
        key: &[&str],
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let help: String = help.into();
        self.0.push(Diagnostic {
            message: message.into(),
            key: key::join(key),
            span: None,
            help: (!help.is_empty()).then_some(help),
        });
    }

    /// What a model says about its own parameters; a parameter may be a path.
    pub(super) fn faults(&mut self, key: &[&str], faults: Vec<(&'static str, String)>) {
        for (parameter, message) in faults {
            self.0.push(Diagnostic::new(
                format!("{}.{parameter}", key::join(key)),
                format!("`{parameter}` {message}"),
            ));
        }
    }

    /// A vector must have a component a dimension, all finite.
    pub(super) fn vector(&mut self, problem: &Problem, key: &[&str], vector: &[f64]) {
        let space = problem.model.space;
        let (dim, components) = match space.dim() {
            2 => (2, "x, y"),
            n => (n, "x, y, z"),
        };
        if vector.len() != dim {
            let message = format!(
                "expected {dim} components ({components}) because the model is {}, found {}",
                space.name(),
                vector.len()
            );
            self.add(key, message, "");
        }
    }
}
