use std::path::Path;

use crate::error::Error;

/// Heights over a plane.
pub trait Heights: Send + Sync {
    /// Height at a place `[s, t]` `[m]`; `None` where there is none.
    fn at(&self, place: [f64; 2]) -> Option<f64>;
}

/// A source of heights.
pub trait RoughnessModel {
    /// The heights of a surface, files looked for relative to `folder`. `profile`: along one axis only, as on the surfaces of a plane model.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::Mesh`] for a file that cannot be read or used.
    fn heights(&self, folder: &Path, profile: bool) -> Result<Box<dyn Heights>, Error>;

    /// What is wrong with its parameters in a space of `dim` dimensions: the key, and how a sentence goes on that begins with it.
    fn faults(&self, dim: usize) -> Vec<(&'static str, String)>;

    /// The file that it reads, if it reads one.
    fn file(&self) -> Option<&Path> {
        None
    }
}

/// Says that a number is not above zero, if so.
pub(super) fn positive(key: &'static str, value: f64) -> Option<(&'static str, String)> {
    let wrong = !(value.is_finite() && value > 0.0);
    wrong.then(|| (key, format!("is {value} and has to be above zero")))
}
