//! Where supports hold bodies: what does not move when they turn.

use super::super::scene::Scene;
use crate::math::{Vec3, add_scaled, scale};

/// Where a body is held, by direction: the mean of the places that supports hold in it; `None` where it is free to move.
pub(crate) type Anchors = [Option<Vec3>; 3];

/// Where supports that act at `t` hold each body: at its points, as a rigid body, or at the reference points that couplings tie it to.
pub(crate) fn anchors(scene: &Scene, t: f64) -> Vec<Anchors> {
    let model = scene.model;
    let (dofs, held) = (model.dofs, scene.supported(t));
    let mut sums = vec![[([0.0; 3], 0.0); 3]; model.bodies.len()];
    let mut hold = |body: usize, point: usize, place: Vec3| {
        for (c, (sum, count)) in sums[body].iter_mut().enumerate().take(dofs.dim) {
            if held[dofs.of(point, c)] {
                *sum = add_scaled(*sum, 1.0, place);
                *count += 1.0;
            }
        }
    };
    for (b, body) in model.bodies.iter().enumerate() {
        match body.rigid {
            Some(rigid) => {
                let link = &model.links.all()[rigid.link];
                hold(b, link.hidden, link.centre);
            }
            None => {
                for point in body.points.clone() {
                    hold(b, point, model.mesh.points[point]);
                }
            }
        }
    }
    for (reference, bodies) in tied_to_references(scene, t) {
        let link = &model.links.all()[model.references[reference].link];
        for body in bodies {
            hold(body, link.hidden, link.centre);
        }
    }
    let mean = |&(sum, count): &(Vec3, f64)| (count > 0.0).then(|| scale(1.0 / count, sum));
    sums.iter()
        .map(|s| [0, 1, 2].map(|c| mean(&s[c])))
        .collect()
}

/// The bodies that couplings which act at `t` tie to each reference point.
pub(crate) fn tied_to_references(scene: &Scene, t: f64) -> Vec<(usize, Vec<usize>)> {
    let model = scene.model;
    let mut out: Vec<(usize, Vec<usize>)> = Vec::new();
    if model.references.is_empty() {
        return out;
    }
    let body_of = |point: usize| model.bodies.iter().position(|b| b.points.contains(&point));
    for row in scene.couplings().acting(t) {
        let points: Vec<usize> = (row.dofs.iter())
            .step_by(model.dofs.dim)
            .map(|&dof| model.dofs.locate(dof).0)
            .collect();
        let reference = points.iter().find_map(|&p| {
            let link = model.links.of_hidden(p)?;
            model.references.iter().position(|r| r.link == link)
        });
        let Some(reference) = reference else {
            continue;
        };
        let at = out.iter().position(|(r, _)| *r == reference);
        let at = at.unwrap_or_else(|| {
            out.push((reference, Vec::new()));
            out.len() - 1
        });
        for body in points.iter().filter_map(|&p| body_of(p)) {
            if !out[at].1.contains(&body) {
                out[at].1.push(body);
            }
        }
    }
    out
}
