use std::sync::Arc;

use super::grids::BodyPoints;
use super::linearised::{Linearised, Recipe};
use crate::linear::BlockCsr;
use crate::system::StepFailure;

/// The factors, or multigrid hierarchies, of several matrices, told apart by keys.
#[derive(Debug, Default)]
pub struct Factors {
    /// The last used last.
    kept: Vec<(u64, Linearised)>,
    /// Set where multigrid is to be used.
    points: Option<Arc<BodyPoints>>,
    notes: Vec<String>,
}

/// What factors were made of: enough to make them again, with the same bits.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct FactorsRecipe {
    kept: Vec<(u64, Recipe)>,
}

/// Most matrices whose factors are kept.
pub const MOST_FACTORS: usize = 4;

/// Most matrices whose hierarchies are kept.
const MOST_HIERARCHIES: usize = 2;

impl Factors {
    /// Hierarchies over these points in place of factors. Where multigrid fails, factors take over, and [`notes`](Factors::notes) tell why.
    pub fn multigrid(points: BodyPoints) -> Self {
        Factors {
            points: Some(Arc::new(points)),
            ..Factors::default()
        }
    }

    /// The factor for the matrix with this key. The least recently used one is dropped when there are too many.
    pub fn of(&mut self, key: u64) -> &mut Linearised {
        let last = match self.kept.iter().position(|(k, _)| *k == key) {
            Some(i) => self.kept.remove(i),
            None => {
                // the symbolic factorisation serves all
                let like = self.kept.last().map(|(_, l)| l.without_factor());
                let new = || self.points.clone().map(Linearised::multigrid);
                (key, like.or_else(new).unwrap_or_default())
            }
        };
        let most = if last.1.uses_multigrid() {
            MOST_HIERARCHIES
        } else {
            MOST_FACTORS
        };
        while self.kept.len() >= most {
            self.notes.extend(self.kept[0].1.note());
            self.kept.remove(0);
        }
        self.kept.push(last);
        let i = self.kept.len() - 1;
        &mut self.kept[i].1
    }

    /// Whether they are hierarchies.
    pub fn are_hierarchies(&self) -> bool {
        self.points.is_some()
    }

    /// What they were made of; without numbers of those whose matrix is not `used` any more.
    pub fn recipe(&self, used: &dyn Fn(u64) -> bool) -> FactorsRecipe {
        let kept = self.kept.iter();
        FactorsRecipe {
            kept: kept.map(|(key, l)| (*key, l.recipe(used(*key)))).collect(),
        }
    }

    /// Makes them again: `matrix` gives those that are used still, `like` has the pattern of all of them. Without hierarchies over `points` they are
    /// factors.
    ///
    /// # Errors
    /// As when they were made first.
    pub fn again<'a>(
        recipe: FactorsRecipe,
        matrix: &dyn Fn(u64) -> Option<&'a BlockCsr>,
        like: &BlockCsr,
        points: Option<BodyPoints>,
    ) -> Result<Self, StepFailure> {
        let points = points.map(Arc::new);
        let mut kept = Vec::new();
        for (key, recipe) in recipe.kept {
            let made = Linearised::again(recipe, matrix(key), like, points.as_ref())?;
            kept.push((key, made));
        }
        Ok(Factors {
            kept,
            points,
            notes: Vec::new(),
        })
    }

    /// What a user should know and has not been told yet.
    pub fn notes(&mut self) -> Vec<String> {
        let made = self.kept.iter_mut().filter_map(|(_, l)| l.note());
        self.notes.drain(..).chain(made).collect()
    }
}
