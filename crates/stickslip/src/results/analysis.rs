//! An analysis as observers see it.

use super::summary::Summary;
use crate::assess::View;

/// What observers look at: an analysis, and what has come of it so far.
#[derive(Clone, Copy)]
pub struct Analysis<'a> {
    /// The analysis.
    pub view: View<'a>,
    /// Energies and counts so far.
    pub summary: &'a Summary,
}

impl<'a> std::ops::Deref for Analysis<'a> {
    type Target = View<'a>;

    fn deref(&self) -> &View<'a> {
        &self.view
    }
}
