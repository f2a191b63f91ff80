//! One point alone: two or three unknowns.

use super::map::project;
use super::problem::PointLaw;
use super::small::{norm, solve};

/// The forces `r` at one point with `u = w r + q`, `w` row by row in the first `d²` entries; `None` where none is found.
pub(super) fn local(d: usize, law: &PointLaw, w: &[f64; 9], q: &[f64; 3]) -> Option<[f64; 3]> {
    let opens = q[0] >= 0.0;
    if opens && law.limit(0.0).0 == 0.0 {
        return Some([0.0; 3]);
    }
    let right = [-q[0], -q[1], -q[2]];
    let sticking = solve(d, *w, right);
    if let Some(r) = sticking
        && r[0] >= 0.0
        && law.cone(r[0]).size([r[1], r[2]]) <= law.limit(r[0]).0
    {
        return Some(r);
    }
    match d {
        2 => sliding_in_plane(law, w, q),
        _ => sliding_in_space(law, w, q).filter(|r| law.ellipse.is_none() || holds(law, w, q, r)),
    }
}

/// A motion beyond the laws over the free one that counts as none.
const SAME_MOTION: f64 = 1e-9;

/// Whether forces are those of the laws. Where nothing rubs across an axis, shear jumps with the direction of slip, and a direction in between is none.
fn holds(law: &PointLaw, w: &[f64; 9], q: &[f64; 3], r: &[f64; 3]) -> bool {
    let u = moved(3, w, q, r);
    let rho = 3.0 / (w[0] + w[4] + w[8]);
    let z = [0, 1, 2].map(|a| r[a] - rho * u[a]);
    let lawful = project(3, law, &z).forces;
    let off = [0, 1, 2].map(|a| (r[a] - lawful[a]) / rho);
    norm(&off) <= SAME_MOTION * norm(q)
}

/// The shear of a point per limit, for a direction of slip and with the opposite sign.
fn shear_against(law: &PointLaw, t: [f64; 2]) -> [f64; 2] {
    if law.ellipse.is_none() {
        return t;
    }
    let direction = law.cone(0.0).against(t);
    match direction.size > 0.0 {
        true => direction.along.map(|v| v / direction.size),
        false => [0.0; 2],
    }
}

/// Contact force under sliding with shear `-limit t`, where `t` is the direction of slip, or what belongs to it on an ellipse.
fn pressed(d: usize, law: &PointLaw, w: &[f64; 9], q: &[f64; 3], t: &[f64]) -> Option<[f64; 3]> {
    let across: f64 = (1..d).map(|a| w[a] * t[a - 1]).sum();
    let slope = w[0] - law.mu * across;
    let push = -(q[0] - law.adhesion * across);
    let force = match push <= 0.0 {
        true => 0.0,
        false if slope > 0.0 => push / slope,
        false => return None,
    };
    let (limit, _) = law.limit(force);
    let mut r = [force, 0.0, 0.0];
    for a in 1..d {
        r[a] = -limit * t[a - 1];
    }
    Some(r)
}

/// The motion of the point under its own forces.
fn moved(d: usize, w: &[f64; 9], q: &[f64; 3], r: &[f64; 3]) -> [f64; 3] {
    let mut u = *q;
    for a in 0..d {
        for b in 0..d {
            u[a] += w[a * d + b] * r[b];
        }
    }
    u
}

fn sliding_in_plane(law: &PointLaw, w: &[f64; 9], q: &[f64; 3]) -> Option<[f64; 3]> {
    [1.0, -1.0].into_iter().find_map(|t| {
        let r = pressed(2, law, w, q, &shear_against(law, [t, 0.0])[..1])?;
        let u = moved(2, w, q, &r);
        (u[1] * t >= 0.0).then_some(r)
    })
}

/// Directions among which that of slip is bracketed.
const SECTORS: usize = 24;

/// Bisections of a sector: to rounding.
const BISECTIONS: usize = 52;

/// Looks for the angle whose direction is that of the slip which it causes: the slip has no part across it, and points its way.
fn sliding_in_space(law: &PointLaw, w: &[f64; 9], q: &[f64; 3]) -> Option<[f64; 3]> {
    let at = |angle: f64| -> Option<([f64; 3], f64, f64)> {
        let t = [angle.cos(), angle.sin()];
        let r = pressed(3, law, w, q, &shear_against(law, t))?;
        let u = moved(3, w, q, &r);
        let across = t[0] * u[2] - t[1] * u[1];
        let along = t[0] * u[1] + t[1] * u[2];
        Some((r, across, along))
    };
    let sector = std::f64::consts::TAU / SECTORS as f64;
    // from the direction in which the point would go without friction
    let start = q[2].atan2(q[1]) - 0.5 * sector;
    let mut found: Option<([f64; 3], f64)> = None;
    for k in 0..SECTORS {
        let (mut low, mut high) = (start + k as f64 * sector, start + (k + 1) as f64 * sector);
        let (Some(mut below), Some(above)) = (at(low), at(high)) else {
            continue;
        };
        if below.1 * above.1 > 0.0 {
            continue;
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let Some(now) = at(middle) else { break };
            if now.1 * below.1 > 0.0 {
                (low, below) = (middle, now);
            } else {
                high = middle;
            }
        }
        let slides = below.2 >= 0.0;
        if slides && found.is_none_or(|(_, along)| below.2 > along) {
            found = Some((below.0, below.2));
        }
        if k == 0 && found.is_some() {
            break;
        }
    }
    found.map(|(r, _)| r)
}

/// A step of projection instead, which is always possible: forces that the laws allow next to `r - ρ u`.
pub(super) fn projected(d: usize, law: &PointLaw, z: &[f64; 3]) -> [f64; 3] {
    project(d, law, &z[..d]).forces
}
