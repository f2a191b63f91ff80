//! What is remembered of jumps over cycles from one block to the next.

/// What is known of the blocks of a step.
#[derive(Debug, Clone, Default)]
pub(super) struct Jumps {
    /// The next is to stand for so many cycles.
    pub wish: f64,
    /// By interface and place, what had been taken when the block began, and what a cycle of the block before took.
    pub start: Vec<Vec<f64>>,
    pub rates: Vec<Vec<f64>>,
    /// By interface, what cycles of the step have taken in all.
    pub total: Vec<f64>,
    /// Blocks that were kept, and those that were taken back.
    pub kept: usize,
    pub rejected: usize,
}

crate::keep!(Jumps {
    wish,
    start,
    rates,
    total,
    kept,
    rejected
});
