/// Counts over an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
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
    /// Substructures factored.
    pub substructures_made: usize,
    /// Substructures taken from memory: of an earlier run, step or increment.
    pub substructures_shared: usize,
    /// Substructures read from files.
    pub substructures_read: usize,
    /// Krylov iterations.
    pub krylov: usize,
    /// Factorisations of matrices of gaps and slips.
    pub reduced: usize,
    /// Linear systems of a condensed model whose products with the compliance of gaps and slips were kept from one before.
    pub kept_gaps: usize,
    /// Evaluations of all interfaces, with their tangents or without.
    pub evaluations: usize,
    /// Seconds in looking for substructures made before, reading them included.
    pub seconds_find: f64,
    /// Seconds in symbolic factorisation.
    pub seconds_order: f64,
    /// Seconds in numeric factorisation.
    pub seconds_factor: f64,
    /// Seconds in solves.
    pub seconds_solve: f64,
    /// Seconds in inverting what partial factorisations leave.
    pub seconds_condense: f64,
    /// Seconds in finding interiors.
    pub seconds_recover: f64,
    /// Seconds in search, pairing and assembly of interfaces.
    pub seconds_contact: f64,
    /// Nonzeros of the last factor.
    pub factor_nonzeros: usize,
    /// Additions and multiplications of all numeric factorisations and inverses.
    pub flops: f64,
    /// Bytes of the last factor and what was condensed with it.
    pub factor_bytes: u64,
    /// Seconds that ordering, one factorisation and one solution of the same bodies took or would take.
    pub linear_solve: f64,
    /// Multigrid hierarchies made.
    pub setups: usize,
    /// Hierarchies whose finest level was made anew.
    pub refreshes: usize,
    /// Levels of the last hierarchy; 0 without one.
    pub levels: usize,
    /// Scalars on all its levels over those on the finest.
    pub operator_complexity: f64,
    /// Its size `[bytes]`.
    pub hierarchy_bytes: usize,
}

crate::keep!(Statistics {
    iterations,
    augmentations,
    fallbacks,
    columns,
    analyses,
    factorisations,
    substructures_made,
    substructures_shared,
    substructures_read,
    krylov,
    reduced,
    kept_gaps,
    evaluations,
    seconds_find,
    seconds_order,
    seconds_factor,
    seconds_solve,
    seconds_condense,
    seconds_recover,
    seconds_contact,
    factor_nonzeros,
    flops,
    factor_bytes,
    linear_solve,
    setups,
    refreshes,
    levels,
    operator_complexity,
    hierarchy_bytes
});
