//! The guess of an increment in which supports turn bodies.
//!
//! A straight line through the last increment leads points that turn off their circle, by half the square of the angle: cells that turn are strained by that much in the guess, and contact
//! comes back on other facets. What supports turn as a whole is expected to turn with them.

use crate::math::{Mat3, Vec3, add, cross, dot, mat_vec, outer, scale, sub};
use crate::model::definition::{Body, Model};
use crate::system::{Constraints, frame_of};
use crate::tolerance::ROUNDING;

/// By how much better a rigid turn has to meet what supports prescribe than the guess as it is, or a shift without a turn: by half, in distances.
const BETTER_THAN_SHIFT: f64 = 0.25;

/// Turns bodies whose cells have frames with their supports, from the displacements `before`, where that meets the constraints better than the `guess` does.
pub(super) fn turn_with_supports(
    model: &Model,
    before: &[f64],
    constraints: &Constraints,
    guess: &mut [f64],
) {
    let turning = model.elastic().filter(|b| b.elastic.is_corotational());
    for body in turning {
        let Some(turn) = Turn::of(model, body, before, guess, constraints) else {
            continue;
        };
        for p in body.points.clone() {
            let x = add(model.mesh.points[p], model.dofs.vector(before, p));
            let moved = sub(turn.place(x), model.mesh.points[p]);
            for (c, u) in moved.iter().enumerate().take(model.dofs.dim) {
                guess[model.dofs.of(p, c)] = *u;
            }
        }
    }
}

/// A motion without strain.
struct Turn {
    from: Vec3,
    to: Vec3,
    by: Mat3,
}

impl Turn {
    fn place(&self, x: Vec3) -> Vec3 {
        add(self.to, mat_vec(&self.by, sub(x, self.from)))
    }

    /// The one that fits the points of a body which supports hold in all directions; `None` where it is no turn, or no better than the guess.
    fn of(
        model: &Model,
        body: &Body,
        before: &[f64],
        guess: &[f64],
        constraints: &Constraints,
    ) -> Option<Self> {
        let dofs = model.dofs;
        let is_held = |p: &usize| (0..dofs.dim).all(|c| constraints.fixed[dofs.of(*p, c)]);
        // Where each is, where it is going to be, and where it is expected.
        let held: Vec<[Vec3; 3]> = body
            .points
            .clone()
            .filter(is_held)
            .map(|p| {
                let all = [before, constraints.values.as_slice(), guess];
                all.map(|u| add(model.mesh.points[p], dofs.vector(u, p)))
            })
            .collect();
        let part = 1.0 / held.len().max(1) as f64;
        let mean = |k: usize| scale(part, held.iter().fold([0.0; 3], |s, x| add(s, x[k])));
        let (from, to) = (mean(0), mean(1));
        let mut fit = [[0.0; 3]; 3];
        for [x, y, _] in &held {
            let dyad = outer(sub(*y, to), sub(*x, from));
            fit.iter_mut().zip(dyad).for_each(|(f, d)| *f = add(*f, d));
        }
        let (by, _) = frame_of(dofs.dim, &with_normal(&fit, dofs.dim));
        let turn = Turn { from, to, by };
        let square = |v: Vec3| dot(v, v);
        let [mut rigid, mut shifted, mut expected, mut turned, mut arms] = [0.0; 5];
        for [x, y, guess] in &held {
            let arm = sub(*x, from);
            rigid += square(sub(turn.place(*x), *y));
            shifted += square(sub(add(to, arm), *y));
            expected += square(sub(*guess, *y));
            turned += square(sub(mat_vec(&by, arm), arm));
            arms += square(arm);
        }
        let better = rigid < BETTER_THAN_SHIFT * shifted && rigid < BETTER_THAN_SHIFT * expected;
        // A smaller turn, in squares of the arms, is none.
        (better && turned > ROUNDING * arms).then_some(turn)
    }
}

/// Points in a plane say nothing of what is across it. The matrix of cofactors of `R U` is `R` times that of `U`: with it the rotation is the same, and is known of a plane, too.
fn with_normal(fit: &Mat3, dim: usize) -> Mat3 {
    let size = fit.iter().map(|row| dot(*row, *row)).sum::<f64>().sqrt();
    if dim == 2 || size == 0.0 {
        return *fit;
    }
    let [a, b, c] = *fit;
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    std::array::from_fn(|i| add(fit[i], scale(1.0 / size, cofactors[i])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation;

    #[test]
    fn points_in_a_plane_tell_how_it_turns() {
        let by = rotation([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 0.4);
        let arms = [[1.0, 0.0, 0.0], [-1.0, 0.5, 0.0], [0.0, -0.5, 0.0]];
        let mut fit = [[0.0; 3]; 3];
        for arm in arms {
            let dyad = outer(mat_vec(&by, arm), arm);
            fit.iter_mut().zip(dyad).for_each(|(f, d)| *f = add(*f, d));
        }
        let (found, _) = frame_of(3, &with_normal(&fit, 3));
        let pairs = found.as_flattened().iter().zip(by.as_flattened());
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9),
            "{found:?}"
        );
    }
}
