use std::sync::Arc;

use super::job::Job;

/// The number of a body, which it gives back.
#[derive(Debug)]
pub(super) struct Number {
    pub job: Arc<Job>,
    pub number: usize,
    pub factored: bool,
}

impl Drop for Number {
    fn drop(&mut self) {
        self.job.give_number(self.number, self.factored);
    }
}
