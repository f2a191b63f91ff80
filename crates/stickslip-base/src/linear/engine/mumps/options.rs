/// How MUMPS is to factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MumpsOptions {
    /// Processes, 1 or more.
    pub ranks: usize,
    /// Whether factors are kept on disk.
    pub out_of_core: bool,
    /// Accuracy to which blocks of the factor are compressed, relative to the matrix \[1\].
    pub low_rank: Option<f64>,
    /// Most memory that a rank may take for a body `[bytes]`.
    pub memory: Option<u64>,
    /// Whether the compliance of the kept dofs stays with the ranks; if `None`, where it would take more than half of the memory that is free here.
    pub spread: Option<bool>,
}

impl MumpsOptions {
    /// What results depend on, as a number that is not 0.
    pub(super) fn identity(&self) -> u64 {
        let eps = self.low_rank.unwrap_or(0.0).to_bits();
        let spread = self.spread.map_or(0, |spread| 1 + u64::from(spread)) << 32;
        (eps ^ spread ^ self.ranks as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1
    }
}
