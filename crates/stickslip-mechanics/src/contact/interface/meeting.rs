//! How far a motion of whole bodies may go until the surfaces of an interface touch.

use super::candidates::{closest_of_all, update_candidates};
use super::definition::Primary;
use super::initial::TOUCHING;
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::search::Search;
use super::view::ContactView;
use crate::contact::kinematics::mean_gap;
use crate::contact::surface::{Facet, triangulate};
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, sub};
use crate::tolerance::NEGLIGIBLE;

/// Where two surfaces meet along a motion.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeOfImpact {
    /// Part of the motion that can be made before surfaces that are apart may touch; infinite where they never do.
    pub way: f64,
    /// Points of the mesh that touch and come nearer: of the secondary, and of the primary where that is a body.
    pub touching: Vec<(usize, Option<usize>)>,
}

impl TimeOfImpact {
    /// Nothing is met, however far.
    fn none() -> Self {
        TimeOfImpact {
            way: f64::INFINITY,
            touching: Vec::new(),
        }
    }
}

/// Part of the largest gap of points that touch at which bodies are set down: half of it, so that rounding takes them neither into each other nor away.
/// Between 0.15 and 0.95 all short cases (see [`tolerance`](crate::tolerance)) have the same digits.
const IMPACT_GAP: f64 = 0.5;

/// Velocity of approach, relative to the largest velocity, below which surfaces slide past each other. What is left is rounding of the
/// velocities.
const NO_APPROACH: f64 = 1e-9;

/// How much of the motion `w` (by dof, added to displacements `u`) can be made at time `t` until points of the secondary touch the
/// primary.
pub fn meeting(interface: &mut InterfaceForce, u: &[f64], w: &[f64], t: f64) -> TimeOfImpact {
    let none = TimeOfImpact::none();
    let speeds: Vec<Vec3> = (interface.nodes.iter())
        .map(|&node| interface.dofs.vector(w, node))
        .collect();
    let largest = speeds.iter().map(|&v| norm(v)).fold(0.0, f64::max);
    if largest == 0.0 {
        return none;
    }
    let x = interface.coordinates(u);
    let (InterfaceInput { contact, .. }, cache) = interface.parts();
    let search = &mut cache.geometry.search;
    match &contact.primary {
        Primary::Rigid(..) => meeting_obstacle(contact, &x, &speeds, largest, t),
        Primary::Facets(_) => match meeting_of_boxes(contact, &x, &speeds, largest, t) {
            Some(0.0) => meeting_facets(contact, search, &x, &speeds, largest, t),
            Some(way) => TimeOfImpact { way, ..none },
            None => none,
        },
    }
}

fn meeting_obstacle(
    interface: ContactView,
    x: &[Vec3],
    speeds: &[Vec3],
    largest: f64,
    t: f64,
) -> TimeOfImpact {
    let mut meeting = TimeOfImpact::none();
    let Primary::Rigid(shape, motion) = &interface.primary else {
        return meeting;
    };
    let pose = motion.pose(t);
    for (i, point) in interface.points.iter().enumerate() {
        let Some(foot) = shape.as_dyn().foot(pose.inward(point.position(x))) else {
            continue;
        };
        let v = point.position(speeds);
        let closing = -dot(v, pose.turn(foot.normal));
        if closing <= NO_APPROACH * largest {
            continue;
        }
        let gap = mean_gap(shape.as_dyn(), &pose, point, x).unwrap_or(foot.gap);
        let gap = gap - interface.offset(i, t);
        if gap <= IMPACT_GAP * TOUCHING * point.size {
            meeting
                .touching
                .push((interface.nodes[point.nodes[0]], None));
            continue;
        }
        // Seen from inside, the surface is nearer than its tangent plane: no further than it is away.
        let concave = (0..3).map(|i| foot.curvature[i][i]).sum::<f64>() < 0.0;
        let speed = if concave { norm(v) } else { closing };
        meeting.way = meeting.way.min(gap / speed);
    }
    meeting
}

/// How far the motion can go until the boxes around both sides touch; `None` if they never do.
fn meeting_of_boxes(
    interface: ContactView,
    x: &[Vec3],
    speeds: &[Vec3],
    largest: f64,
    t: f64,
) -> Option<f64> {
    let Primary::Facets(facets) = &interface.primary else {
        return None;
    };
    let range = |of: &[Vec3], nodes: &mut dyn Iterator<Item = usize>| {
        nodes.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |b, n| {
            let of = of[n];
            [
                std::array::from_fn(|c| b[0][c].min(of[c])),
                std::array::from_fn(|c| b[1][c].max(of[c])),
            ]
        })
    };
    let ours = || {
        interface
            .points
            .iter()
            .flat_map(|p| p.nodes.iter().copied())
    };
    let theirs = || facets.iter().flat_map(|f| f.nodes.iter().copied());
    let (a, b) = (range(x, &mut ours()), range(x, &mut theirs()));
    let (va, vb) = (range(speeds, &mut ours()), range(speeds, &mut theirs()));
    let smallest = interface.points.iter().map(|p| p.size);
    let slack = IMPACT_GAP * TOUCHING * smallest.fold(f64::INFINITY, f64::min);
    // Surfaces that have entered each other by part of a cell have not passed each other.
    let entered = interface.points.iter().map(|p| p.size).fold(0.0, f64::max);
    // What counts as no gap.
    let offsets = (0..interface.points.len()).map(|i| interface.offset(i, t));
    let closed = offsets.fold(0.0, f64::max);
    let (mut entry, mut exit) = (0.0_f64, f64::INFINITY);
    for c in 0..interface.dofs.dim {
        for (upper, lower, v_upper, v_lower) in [(a, b, va, vb), (b, a, vb, va)] {
            let apart = upper[0][c] - lower[1][c] - closed;
            let fastest = v_lower[1][c] - v_upper[0][c];
            let slowest = v_lower[0][c] - v_upper[1][c];
            if apart > slack {
                if fastest <= NO_APPROACH * largest && apart <= entered {
                    continue;
                }
                if fastest <= NO_APPROACH * largest {
                    return None;
                }
                entry = entry.max(apart / fastest);
            } else if slowest < 0.0 {
                exit = exit.min((apart - slack) / slowest);
            }
        }
    }
    (entry <= exit).then_some(entry)
}

fn meeting_facets(
    interface: ContactView,
    search: &mut Search,
    x: &[Vec3],
    speeds: &[Vec3],
    largest: f64,
    t: f64,
) -> TimeOfImpact {
    let mut meeting = TimeOfImpact::none();
    update_candidates(interface.definition, search, x);
    let feet = closest_of_all(interface.definition, x, search);
    let facets = interface.facets();
    let margin = search.margin;
    // Where no facet is near, half of the margin of the search is gone at once.
    let stride = 0.5 * margin / (2.0 * largest);
    for (i, point) in interface.points.iter().enumerate() {
        let (position, v) = (point.position(x), point.position(speeds));
        let offset = interface.offset(i, t);
        let foot = feet[i].as_ref().ok();
        let foot = foot.map(|&(f, ref foot)| {
            let nodes = facets[f].nodes.iter().zip(&foot.n);
            let carried = nodes.fold([0.0; 3], |s, (&node, &n)| add_scaled(s, n, speeds[node]));
            let gap = dot(sub(position, foot.x), foot.normal) - offset;
            (gap, -dot(sub(v, carried), foot.normal), facets[f].nodes[0])
        });
        if let Some((gap, closing, node)) = foot
            && gap <= IMPACT_GAP * TOUCHING * point.size
            && closing > NO_APPROACH * largest
        {
            let secondary = interface.nodes[point.nodes[0]];
            let primary = interface.nodes[node];
            meeting.touching.push((secondary, Some(primary)));
            continue;
        }
        // Along the motion another facet may be met before the nearest one.
        let mut way = f64::INFINITY;
        for &f in &search.candidates[i] {
            way = way.min(along_ray(
                &facets[f], x, speeds, position, v, offset, largest,
            ));
        }
        if way * largest > IMPACT_GAP * TOUCHING * point.size {
            meeting.way = meeting.way.min(way);
        }
        // What is left to facets that are curved.
        if let Some((gap, closing, _)) = foot
            && gap > IMPACT_GAP * TOUCHING * point.size
            && closing > NO_APPROACH * largest
            && gap <= 0.1 * margin
        {
            meeting.way = meeting.way.min(gap / closing);
        }
    }
    meeting.way = meeting.way.min(stride);
    meeting
}

/// Not normalised: out of a straight edge or a triangle.
pub(in crate::contact) fn facet_normal(x: &[Vec3]) -> Vec3 {
    let along = sub(x[1], x[0]);
    match x.get(2) {
        Some(&third) => cross(along, sub(third, x[0])),
        None => [along[1], -along[0], 0.0],
    }
}

/// When a point at `position` that moves with `v` meets a facet at a distance that counts as none; infinite if it does not.
fn along_ray(
    facet: &Facet,
    x: &[Vec3],
    speeds: &[Vec3],
    position: Vec3,
    v: Vec3,
    offset: f64,
    largest: f64,
) -> f64 {
    let count = facet.nodes.len() as f64;
    let carried = facet.nodes.iter().fold([0.0; 3], |s, &n| add(s, speeds[n]));
    let v = add_scaled(v, -1.0 / count, carried);
    let mut way = f64::INFINITY;
    for piece in triangulate(vec![facet.clone()]) {
        let corners: Vec<Vec3> = piece.nodes.iter().map(|&n| x[n]).collect();
        let normal = facet_normal(&corners);
        let size = norm(normal);
        let closing = -dot(v, normal) / size;
        if closing.is_nan() || closing <= NO_APPROACH * largest {
            continue;
        }
        let s = (dot(sub(position, corners[0]), normal) / size - offset) / closing;
        if s < 0.0 || s >= way {
            continue;
        }
        let hit = add_scaled(position, s, v);
        let inside = match *corners.as_slice() {
            [a, b] => {
                let along = sub(b, a);
                let at = dot(sub(hit, a), along) / dot(along, along);
                // A ray still meets a facet this far beyond its edges.
                (-NEGLIGIBLE..=1.0 + NEGLIGIBLE).contains(&at)
            }
            [a, b, c] => {
                let part = |p: Vec3, q: Vec3| dot(cross(sub(p, hit), sub(q, hit)), normal);
                let least = part(a, b).min(part(b, c)).min(part(c, a));
                least >= -NEGLIGIBLE * size * size
            }
            _ => false,
        };
        if inside {
            way = s;
        }
    }
    way
}
