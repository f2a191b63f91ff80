//! What rows of the table of features are.

use std::collections::BTreeSet;

use super::sheet::Sheet;
use crate::draw::Random;

/// One thing that is sound by itself.
pub struct Feature {
    /// Its name.
    pub name: &'static str,
    /// The group of which each mix has exactly one; of those without a group it has a few.
    pub group: &'static str,
    /// How often it is drawn beside the others.
    pub weight: f64,
    /// Features of which it needs one, if any are named.
    pub needs: &'static [&'static str],
    /// What it adds to the problem.
    pub add: fn(&mut Sheet, &mut Random),
}

impl Feature {
    /// Whether what it needs is among those chosen.
    pub fn fits(&self, chosen: &BTreeSet<&'static str>) -> bool {
        self.needs.is_empty() || self.needs.iter().any(|need| chosen.contains(need))
    }
}

/// A row of a table.
pub const fn row(
    group: &'static str,
    name: &'static str,
    weight: f64,
    needs: &'static [&'static str],
    add: fn(&mut Sheet, &mut Random),
) -> Feature {
    Feature {
        name,
        group,
        weight,
        needs,
        add,
    }
}

/// What adds nothing to the text: others ask whether it is there.
pub fn nothing(_: &mut Sheet, _: &mut Random) {}
