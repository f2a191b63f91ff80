//! Rotation of rigid bodies without equations: in space their inertia is no diagonal.

use crate::math::{Mat3, Vec3, dot, identity, inverse, mat_vec};
use crate::model::definition::Model;
use crate::system::{Dofs, Freedom};

/// The rotation of one rigid body, in the dofs of its second hidden point.
pub(crate) struct Spin {
    dofs: Dofs,
    point: usize,
    /// Moments of inertia over the square of the length of its link `[kg]`; of rotations that do not exist those of a unit.
    inertia: Mat3,
}

impl Spin {
    /// Of all rigid bodies that can turn.
    pub fn all(model: &Model) -> Vec<Spin> {
        let rigid = model.rigid();
        let links = model.links.all();
        rigid
            .filter(|r| {
                let still = [Freedom::Axial, Freedom::Carried];
                !still.contains(&links[r.link].freedom) && r.spin[0][0] > 0.0
            })
            .map(|r| Spin {
                dofs: model.dofs,
                point: links[r.link].hidden + 1,
                inertia: r.spin,
            })
            .collect()
    }

    /// Its dofs.
    pub fn range(&self) -> std::ops::Range<usize> {
        let first = self.dofs.of(self.point, 0);
        first..first + self.dofs.dim
    }

    /// The part of a vector by dof.
    pub fn of(&self, values: &[f64]) -> Vec3 {
        self.dofs.vector(values, self.point)
    }

    /// Acceleration by a moment in the free directions; in the others it is `known`.
    pub fn acceleration(&self, moment: Vec3, fixed: &[bool], known: Vec3) -> Vec3 {
        let mut rows = self.inertia;
        let mut b = moment;
        let unit = identity();
        for i in 0..3 {
            // a third direction that the plane does not have is held
            if i >= self.dofs.dim || fixed[self.range()][i] {
                rows[i] = unit[i];
                b[i] = known[i];
            }
        }
        inverse(&rows).map_or([0.0; 3], |(inverse, _)| mat_vec(&inverse, b))
    }

    /// `J⁻¹ m`, where nothing is held.
    pub fn turned_by(&self, moment: Vec3) -> Vec3 {
        inverse(&self.inertia).map_or([0.0; 3], |(inverse, _)| mat_vec(&inverse, moment))
    }

    /// `J a`.
    pub fn force(&self, acceleration: Vec3) -> Vec3 {
        mat_vec(&self.inertia, acceleration)
    }

    /// `aᵀ J a`.
    pub fn square(&self, a: Vec3) -> f64 {
        dot(a, self.force(a))
    }
}

/// Added to the squared frequency of a spring at a point: by how much a rigid body gives way there to a force in any direction, at
/// most `[1/kg]`. By point, zero where there is no rigid body.
pub(crate) fn mobility(model: &Model) -> Vec<f64> {
    let mut out = vec![0.0; model.dofs.points];
    for rigid in model.bodies.iter().filter_map(|b| b.rigid) {
        let link = &model.links.all()[rigid.link];
        // What is carried gives way less than it would on its own.
        let turn = match (link.freedom, model.dofs.dim) {
            (Freedom::Axial, _) => 0.0,
            (_, 2) => 1.0 / rigid.spin[0][0],
            _ => {
                let rows: Vec<Vec<f64>> = rigid.spin.iter().map(|r| r.to_vec()).collect();
                1.0 / crate::math::symmetric_eigen(&rows).0[0]
            }
        };
        for (point, &arm) in link.points.clone().zip(&link.arms) {
            let reach = dot(arm, arm) / (link.length * link.length);
            out[point] = 1.0 / rigid.mass + reach * turn;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_directions_turn_and_held_ones_do_not() {
        let spin = Spin {
            dofs: Dofs { dim: 3, points: 2 },
            point: 1,
            inertia: [[3.0, 0.4, -0.2], [0.4, 2.0, 0.3], [-0.2, 0.3, 4.0]],
        };
        let mut fixed = [false; 6];
        let moment = [1.0, -2.0, 0.5];
        let a = spin.acceleration(moment, &fixed, [0.0; 3]);
        for (f, m) in spin.force(a).iter().zip(moment) {
            assert!((f - m).abs() < 1e-14);
        }
        fixed[4] = true;
        let a = spin.acceleration(moment, &fixed, [9.0, 0.7, 9.0]);
        let f = spin.force(a);
        assert_eq!(a[1], 0.7);
        assert!((f[0] - 1.0).abs() < 1e-14 && (f[2] - 0.5).abs() < 1e-14);
        assert!((spin.square(a) - dot(a, f)).abs() < 1e-15);
    }
}
