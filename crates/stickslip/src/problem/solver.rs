use serde::{Deserialize, Serialize};

use crate::model::Solution;
use crate::newton::condensed::engine::EngineModel;

/// `[solver]`: convergence criteria and solvers. All dimensionless.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Solver {
    /// Largest out-of-balance force, relative to the largest of reactions, external forces and contact forces.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1)))]
    pub tolerance: f64,
    /// Newton iterations after which an increment is cut.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub max_iterations: usize,
    /// Halvings of a Newton step that does not reduce the out-of-balance forces; 0 takes every step in full.
    pub line_search: usize,
    /// Largest change of displacement over one increment, as a fraction of the size of the model; an increment that
    /// changes more is cut. No limit if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
    /// Largest residual of the energy balance, relative to the energy stored and dissipated, that counts as good; the summary says whether it was
    /// kept.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub energy_limit: f64,
    /// Whether unconstrained bodies under load are moved in quasi-static steps until they touch, and stabilised by weak springs until contact is
    /// established and the springs carry nothing.
    pub follow_loose_bodies: bool,
    /// How the systems of Newton's method are solved.
    pub method: Solution,
    /// The linear solver that factors condensed bodies, and keeps the factors.
    #[serde(skip_serializing_if = "is_usual")]
    pub engine: EngineModel,
    /// Systems of linear equations.
    pub linear: Linear,
}

/// What a problem file need not say.
fn is_usual(engine: &EngineModel) -> bool {
    *engine == EngineModel::default()
}

impl Default for Solver {
    fn default() -> Self {
        let settings = crate::newton::Settings::default();
        Solver {
            tolerance: settings.tolerance,
            max_iterations: settings.max_iterations,
            line_search: settings.line_search,
            largest_change: None,
            energy_limit: 0.01,
            follow_loose_bodies: true,
            method: Solution::default(),
            engine: EngineModel::default(),
            linear: Linear::default(),
        }
    }
}

/// `[solver.linear]`: how systems of linear equations are solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", schemars(rename = "LinearSolver"))]
pub struct Linear {
    /// Largest residual of a linear system, as a fraction of its right-hand side.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1)))]
    pub tolerance: f64,
    /// Krylov iterations with one factorisation after which the matrix is factored anew.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub patience: usize,
}

impl Default for Linear {
    fn default() -> Self {
        let settings = crate::newton::Settings::default();
        Linear {
            tolerance: settings.linear_tolerance,
            patience: settings.krylov_patience,
        }
    }
}
