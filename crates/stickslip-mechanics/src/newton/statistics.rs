/// Counts over an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Statistics {
    /// Newton iterations.
    pub iterations: usize,
    /// Multiplier updates.
    pub augmentations: usize,
    /// Increments solved as friction problems, or tried to, where plain iteration had failed.
    pub fallbacks: usize,
    /// Columns of the operators of friction problems.
    pub columns: usize,
    /// Symbolic factorisations.
    pub analyses: usize,
    /// Numeric factorisations.
    pub factorisations: usize,
    /// Substructures of condensed bodies.
    #[serde(flatten)]
    pub substructures: Substructures,
    /// Krylov iterations.
    pub krylov: usize,
    /// Factorisations of matrices of gaps and slips.
    pub reduced: usize,
    /// Linear systems of a condensed model whose products with the compliance of gaps and slips were kept from one before.
    pub kept_gaps: usize,
    /// Evaluations of all interfaces, with their tangents or without.
    pub evaluations: usize,
    /// Times.
    #[serde(flatten)]
    pub seconds: Seconds,
    /// Sizes of factors.
    #[serde(flatten)]
    pub factors: FactorSizes,
    /// Seconds that ordering, one factorisation and one solution of the same bodies took or would take.
    pub linear_solve: f64,
    /// Hierarchies of multigrid.
    #[serde(flatten)]
    pub hierarchies: Hierarchies,
}

/// Where substructures of condensed bodies came from.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
pub struct Substructures {
    /// Substructures factored.
    #[serde(rename = "substructures-made")]
    pub made: usize,
    /// Substructures taken from memory: of an earlier run, step or increment.
    #[serde(rename = "substructures-shared")]
    pub shared: usize,
    /// Substructures read from files.
    #[serde(rename = "substructures-read")]
    pub read: usize,
}

/// Seconds by what they were spent on.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
pub struct Seconds {
    /// Seconds in looking for substructures made before, reading them included.
    #[serde(rename = "seconds-find")]
    pub find: f64,
    /// Seconds in symbolic factorisation.
    #[serde(rename = "seconds-order")]
    pub order: f64,
    /// Seconds in numeric factorisation.
    #[serde(rename = "seconds-factor")]
    pub factor: f64,
    /// Seconds in solves.
    #[serde(rename = "seconds-solve")]
    pub solve: f64,
    /// Seconds in inverting what partial factorisations leave.
    #[serde(rename = "seconds-condense")]
    pub condense: f64,
    /// Seconds in finding interiors.
    #[serde(rename = "seconds-recover")]
    pub recover: f64,
    /// Seconds in search, pairing and assembly of interfaces.
    #[serde(rename = "seconds-contact")]
    pub contact: f64,
}

/// How large factors are, and what they cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
pub struct FactorSizes {
    /// Nonzeros of the last factor.
    #[serde(rename = "factor-nonzeros")]
    pub nonzeros: usize,
    /// Additions and multiplications of all numeric factorisations and inverses.
    pub flops: f64,
    /// Bytes of the last factor and what was condensed with it.
    #[serde(rename = "factor-bytes")]
    pub bytes: u64,
}

/// Hierarchies of multigrid.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Hierarchies {
    /// Multigrid hierarchies made.
    pub setups: usize,
    /// Hierarchies whose finest level was made anew.
    pub refreshes: usize,
    /// Levels of the last hierarchy; 0 without one.
    pub levels: usize,
    /// Scalars on all its levels over those on the finest.
    pub operator_complexity: f64,
    /// Its size `[bytes]`.
    #[serde(rename = "hierarchy-bytes")]
    pub bytes: usize,
}
