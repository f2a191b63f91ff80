use crate::body::Space;
use crate::math::Vec3;

/// A point of a mesh that has a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// The number of the node.
    pub node: u64,
    /// Where it is meshed `[m]`.
    pub x: Vec3,
}

/// A kind of field of temperature.
pub trait TemperatureModel {
    /// The temperature of a point; `None` where the field says nothing of it.
    fn at(&self, space: Space, spot: &Spot) -> Option<f64>;

    /// What is wrong with its parameters: the key, and how a sentence goes on that begins with it.
    fn faults(&self, space: Space) -> Vec<(&'static str, String)>;
}

/// Says what is wrong with a vector, if something is.
pub(super) fn vector(key: &'static str, v: &[f64], space: Space) -> Option<(&'static str, String)> {
    let dim = space.dim();
    if v.len() != dim {
        let message = format!("has {} components, the space has {dim}", v.len());
        return Some((key, message));
    }
    finite(key, v)
}

/// Says which number is not finite, if one is.
pub(super) fn finite(key: &'static str, v: &[f64]) -> Option<(&'static str, String)> {
    let wrong = v.iter().find(|v| !v.is_finite())?;
    Some((key, format!("has {wrong}, which is not a finite number")))
}

/// Padded with zeros.
pub(super) fn vec3(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}
