//! The projection that a way over the surface is counted from.

use crate::contact::facet_point::{FACET_NODES, FacetPoint, evaluate};
use crate::contact::projection::Patch;
use crate::contact::surface::Facet;
use crate::math::Vec3;

/// The projection of a point on a facet at the last accepted state. It is kept from one evaluation to the next with the coordinates that it
/// follows from.
#[derive(Debug, Clone)]
pub struct Anchor {
    facet: usize,
    point: Vec3,
    nodes: [Vec3; FACET_NODES],
    foot: Option<FacetPoint>,
}

impl Anchor {
    /// The projection, made anew if `kept` is another one.
    pub fn at<'a>(
        kept: &'a mut Option<Anchor>,
        f: usize,
        facet: &Facet,
        before: &[Vec3],
        point: Vec3,
    ) -> Option<&'a FacetPoint> {
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let then = facet.gather(before, &mut nodes);
        let same = matches!(kept, Some(k) if k.facet == f && k.point == point
            && k.nodes[..then.len()] == *then);
        if !same {
            let foot = Patch::new(facet.kind, then).project(point);
            let foot = foot.map(|foot| evaluate(facet.kind, then, foot.xi));
            *kept = Some(Anchor {
                facet: f,
                point,
                nodes,
                foot,
            });
        }
        kept.as_ref()?.foot.as_ref()
    }
}
