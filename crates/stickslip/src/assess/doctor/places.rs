//! Places of bodies.

use super::finding::Suspect;
use crate::math::Vec3;
use crate::model::definition::Model;

/// Lowest and highest coordinates.
pub(super) fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let start = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points.iter().fold(start, |(low, high), p| {
        (
            std::array::from_fn(|i| low[i].min(p[i])),
            std::array::from_fn(|i| high[i].max(p[i])),
        )
    })
}

/// A body as a place: the centre of its box.
pub(crate) fn body(model: &Model, name: &str, remark: String) -> Suspect {
    let guilty = Suspect::body(name, remark);
    match model.bodies.iter().find(|b| b.name == name) {
        Some(body) => {
            let (low, high) = bounds(&model.mesh.points[body.points.clone()]);
            guilty.at(std::array::from_fn(|c| 0.5 * (low[c] + high[c])))
        }
        None => guilty,
    }
}
