//! What the history says of bodies that turn freely: where they are as wholes, and how they move.

use crate::assess::view::View;
use crate::math::{Vec3, add, cross, mat_vec, scale, sub};
use crate::system::{Dofs, Freedom, Motion, rotation_vector};

/// Displacement of the centre (`U`), rotation vector of the frame (`UR`, of elastic bodies at most half a revolution long), velocity and spin (`V`, `VR`), momentum (`P`) and angular
/// momentum about the centre (`L`) of each such body.
pub(super) fn columns(view: &View) -> Vec<(String, f64)> {
    let mut out = Vec::new();
    let (model, state) = (view.model, &view.frame.state);
    let bodies = &model.corotations;
    rigid_columns(view, &mut out);
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
        push(name, model.dofs, columns, &mut out);
    }
    out
}

fn push(
    name: &str,
    dofs: Dofs,
    columns: [([&str; 2], [Vec3; 2]); 3],
    out: &mut Vec<(String, f64)>,
) {
    for (letters, values) in columns {
        for motion in motions(dofs) {
            let (letter, axis, value) = match motion {
                Motion::Translation(i) => (letters[0], i, values[0][i]),
                Motion::Rotation(i) => (letters[1], i, values[1][i]),
            };
            out.push((format!("{name}.{letter}{}", axis + 1), value));
        }
    }
}

/// The same of rigid bodies that turn freely, whose motion is among the unknowns.
fn rigid_columns(view: &View, out: &mut Vec<(String, f64)>) {
    let (model, state) = (view.model, &view.frame.state);
    let dofs = model.dofs;
    let poses = model.frames.poses(&state.u);
    for body in &model.bodies {
        let Some((rigid, frame)) = body.rigid.zip(model.frames.of_point(body.points.start)) else {
            continue;
        };
        let link = &model.links.all()[rigid.link];
        if link.freedom == Freedom::Carried {
            continue;
        }
        let turn = poses[frame].turn;
        let at = |x: &[f64], point| match x.is_empty() {
            true => [0.0; 3],
            false => dofs.vector(x, point),
        };
        let upright = |x: Vec3| match dofs.dim {
            2 => [0.0, 0.0, x[0]],
            _ => mat_vec(&turn, x),
        };
        let (way, rate) = (at(&state.v, link.hidden), at(&state.v, link.hidden + 1));
        let spun = mat_vec(&rigid.spin, rate);
        let turned = scale(1.0 / link.length, at(&state.u, link.hidden + 1));
        let angles = match dofs.dim {
            2 => [0.0, 0.0, turned[0]],
            _ => turned,
        };
        let columns = [
            (["U", "UR"], [at(&state.u, link.hidden), angles]),
            (["V", "VR"], [way, scale(1.0 / link.length, upright(rate))]),
            (
                ["P", "L"],
                [scale(rigid.mass, way), scale(link.length, upright(spun))],
            ),
        ];
        push(&body.name, dofs, columns, out);
    }
}

/// The motions of a body as a whole that the space has.
fn motions(dofs: Dofs) -> impl Iterator<Item = Motion> {
    let turns = if dofs.dim == 2 { 2..3 } else { 0..3 };
    (0..dofs.dim)
        .map(Motion::Translation)
        .chain(turns.map(Motion::Rotation))
}
