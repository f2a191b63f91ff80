use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[solver]`: when an increment counts as solved, and how equations are solved. All dimensionless.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Solver {
    /// Largest out-of-balance force, as a fraction of the largest forces in the model.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Newton iterations after which an increment is cut.
    #[schemars(range(min = 1))]
    pub max_iterations: usize,
    /// Shorten Newton steps that do not reduce the residual.
    pub line_search: bool,
    /// Largest change of displacement over one increment, as a fraction of the size of the model; an increment that
    /// changes more is cut. No limit if not given.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
    /// Systems of linear equations.
    pub linear: Linear,
}

impl Default for Solver {
    fn default() -> Self {
        Solver {
            tolerance: 1e-8,
            max_iterations: 30,
            line_search: true,
            largest_change: None,
            linear: Linear::default(),
        }
    }
}

/// How systems of linear equations are solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Linear {
    /// The factorisation of the matrix is used up to this many unknowns, conjugate gradients above.
    pub direct_below: usize,
    /// Largest residual of an iterative solution, as a fraction of the right-hand side.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Iterations after which an iterative solution is given up.
    #[schemars(range(min = 1))]
    pub max_iterations: usize,
}

impl Default for Linear {
    fn default() -> Self {
        Linear {
            direct_below: 1_000_000,
            tolerance: 1e-10,
            max_iterations: 2000,
        }
    }
}
