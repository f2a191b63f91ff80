//! What the history says of bodies that turn freely: where they are as wholes, and how they move.

use crate::assess::view::View;
use crate::math::{Mat3, Vec3, add, cross, norm, scale, sub};
use crate::system::{Dofs, Motion};

/// Displacement of the centre (`U`), rotation vector of the frame (`UR`, at most half a revolution long), velocity and spin (`V`, `VR`), momentum (`P`) and angular
/// momentum about the centre (`L`) of each such body.
pub(super) fn columns(view: &View) -> Vec<(String, f64)> {
    let mut out = Vec::new();
    let (model, state) = (view.model, &view.frame.state);
    let bodies = &model.corotations;
    if bodies.is_empty() {
        return out;
    }
    let still = vec![0.0; state.u.len()];
    let v = match state.v.is_empty() {
        true => &still,
        false => &state.v,
    };
    let carried = view.momenta(v);
    let turns = bodies.turns(&state.u);
    let spins = bodies.spins(&turns, v);
    for ((points, turn), [spin, velocity]) in bodies.points().zip(&turns).zip(spins) {
        let body = model.bodies.iter().find(|b| b.points == points);
        let name = body.map_or("", |b| b.name.as_str());
        let (mut momentum, mut angular) = ([0.0; 3], [0.0; 3]);
        for p in points {
            let x = add(model.mesh.points[p], model.dofs.vector(&state.u, p));
            let own = model.dofs.vector(&carried, p);
            momentum = add(momentum, own);
            angular = add(angular, cross(sub(x, turn.now), own));
        }
        let columns = [
            (
                ["U", "UR"],
                [sub(turn.now, turn.centre), rotation_vector(&turn.turn)],
            ),
            (["V", "VR"], [velocity, spin]),
            (["P", "L"], [momentum, angular]),
        ];
        for (letters, values) in columns {
            for motion in motions(model.dofs) {
                let (letter, axis, value) = match motion {
                    Motion::Translation(i) => (letters[0], i, values[0][i]),
                    Motion::Rotation(i) => (letters[1], i, values[1][i]),
                };
                out.push((format!("{name}.{letter}{}", axis + 1), value));
            }
        }
    }
    out
}

/// The motions of a body as a whole that the space has.
fn motions(dofs: Dofs) -> impl Iterator<Item = Motion> {
    let turns = if dofs.dim == 2 { 2..3 } else { 0..3 };
    (0..dofs.dim)
        .map(Motion::Translation)
        .chain(turns.map(Motion::Rotation))
}

/// The rotation vector of a rotation, at most half a revolution long.
fn rotation_vector(turn: &Mat3) -> Vec3 {
    let axial = [
        turn[2][1] - turn[1][2],
        turn[0][2] - turn[2][0],
        turn[1][0] - turn[0][1],
    ];
    let axial = scale(0.5, axial);
    let (sine, cosine) = (
        norm(axial),
        0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0),
    );
    let angle = sine.atan2(cosine);
    if sine > 1e-6 {
        return scale(angle / sine, axial);
    }
    if cosine > 0.0 {
        return axial;
    }
    // Half a revolution: R = 2 n nᵀ - 1.
    let longest = (0..3)
        .max_by(|&a, &b| turn[a][a].total_cmp(&turn[b][b]))
        .unwrap_or(0);
    let column: Vec3 =
        std::array::from_fn(|i| 0.5 * (turn[i][longest] + if i == longest { 1.0 } else { 0.0 }));
    scale(angle / norm(column).max(f64::MIN_POSITIVE), column)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{distance, rotation};

    #[test]
    fn a_rotation_vector_gives_its_rotation() {
        let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        for angle in [0.0, 1e-9, 0.3, 2.0, 3.1, std::f64::consts::PI] {
            let found = rotation_vector(&rotation(axis, angle));
            let sign = if found[0] < 0.0 { -1.0 } else { 1.0 };
            let expected = scale(sign * angle, axis);
            assert!(distance(found, expected) < 1e-8, "{angle}: {found:?}");
        }
    }
}
