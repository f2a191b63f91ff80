//! Places to look at.

use super::suspect::{LocationKind, Suspect};
use crate::contact::interface::InterfaceDefinition;
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
pub(crate) fn body(model: &Model, name: &str, remark: impl Into<String>) -> Suspect {
    let suspect = Suspect::body(name, remark);
    match model.bodies.iter().find(|b| b.name == name) {
        Some(body) => {
            let (low, high) = bounds(&model.mesh.points[body.points.clone()]);
            suspect.at(std::array::from_fn(|c| 0.5 * (low[c] + high[c])))
        }
        None => suspect,
    }
}

/// A point of the mesh as a place, by the body that it belongs to.
pub(super) fn node(model: &Model, point: usize, remark: impl Into<String>) -> Suspect {
    let body = model.bodies.iter().find(|b| b.points.contains(&point));
    let name = body.map_or(String::new(), |b| b.name.clone());
    Suspect {
        what: LocationKind::Node,
        id: Some(model.mesh.point_ids[point]),
        body: Some(name.clone()),
        name,
        remark: remark.into(),
        ..Suspect::default()
    }
    .at(model.mesh.points[point])
}

/// A point of the secondary as a place.
pub(super) fn secondary(
    interface: &InterfaceDefinition,
    i: usize,
    remark: impl Into<String>,
) -> Suspect {
    let point = &interface.points[i];
    Suspect {
        what: LocationKind::Node,
        id: point.node().map(|one| interface.node_ids[one]),
        ..Suspect::interface(&interface.name, remark)
    }
    .at(interface.place(point))
}
