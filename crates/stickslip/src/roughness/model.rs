use std::path::Path;

use super::statistics::Statistics;
use crate::error::Error;

/// Heights over a plane.
pub trait Heights: Send + Sync {
    /// Height at a place `[s, t]` `[m]`; `None` where there is none.
    fn at(&self, place: [f64; 2]) -> Option<f64>;
}

/// Heights of a surface, and the figures of the map where they were measured.
pub struct Relief {
    /// Heights.
    pub heights: Box<dyn Heights>,
    /// What is known of the map; nothing where heights are none of a map.
    pub measured: Option<Figures>,
}

impl<H: Heights + 'static> From<H> for Relief {
    fn from(heights: H) -> Self {
        Relief {
            heights: Box::new(heights),
            measured: None,
        }
    }
}

/// What is known of a measured map as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Points along a line.
    pub columns: usize,
    /// Lines.
    pub rows: usize,
    /// Points that had not been measured.
    pub holes: usize,
    /// Figures of all heights, levelled as they are used.
    pub statistics: Statistics,
}

/// A source of heights.
pub trait RoughnessModel {
    /// The heights of a surface, files looked for relative to `folder`. `profile`: along one axis only, as on the surfaces of a plane model.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::Mesh`] for a file that cannot be read or used.
    fn heights(&self, folder: &Path, profile: bool) -> Result<Relief, Error>;

    /// The shortest of its waves `[length]`; `None` where it is no sum of waves.
    fn shortest(&self) -> Option<f64> {
        None
    }

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
