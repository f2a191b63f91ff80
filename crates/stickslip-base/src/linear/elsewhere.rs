use std::sync::Arc;

use super::DistributedOperator;

/// A matrix that an engine has, or the rows and columns of it that are meant.
#[derive(Debug)]
pub(super) struct Elsewhere {
    pub by: Arc<dyn DistributedOperator>,
    /// Rows of the whole.
    pub size: usize,
    /// Those that are meant.
    pub list: Vec<u32>,
}

impl Elsewhere {
    /// Products with vectors of as many entries as rows are meant; not a number where the engine has died.
    pub fn products(&self, x: &[f64], y: &mut [f64]) {
        let (n, all) = (self.list.len().max(1), self.size.max(1));
        assert!(
            x.len() == y.len() && x.len().is_multiple_of(n),
            "length of vectors"
        );
        if x.iter().all(|x| *x == 0.0) {
            return y.fill(0.0);
        }
        let mut wide = vec![0.0; x.len() / n * all];
        for (wide, x) in wide.chunks_mut(all).zip(x.chunks(n)) {
            for (&at, x) in self.list.iter().zip(x) {
                wide[at as usize] = *x;
            }
        }
        let Ok(products) = self.by.products(&wide) else {
            return y.fill(f64::NAN);
        };
        for (products, y) in products.chunks(all).zip(y.chunks_mut(n)) {
            for (&at, y) in self.list.iter().zip(y) {
                *y = products[at as usize];
            }
        }
    }
}
