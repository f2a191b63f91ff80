use serde::{Deserialize, Serialize};

use super::foot::{to_vec3, vector_fault};
use crate::math::{
    Mat3, Vec3, add, identity, mat_vec, normalize, rotation, scale, sub, transpose_vec,
};
use crate::system::Amplitude;

/// The prescribed motion of an obstacle: a rotation, then a translation, both from tables over time (linear in between,
/// constant outside).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Motion {
    /// Rows of `[time, dx, dy]` (plane problems) or `[time, dx, dy, dz]` `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub translation: Vec<Vec<f64>>,
    /// Rotation about a fixed axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
}

/// Rotation about a fixed axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Rotation {
    /// A point on the axis `[m]`.
    pub centre: Vec<f64>,
    /// Direction of the axis; out of the plane if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Rows of `[time, angle [rad]]`.
    pub angle: Vec<[f64; 2]>,
}

/// Where a moving frame is at a time: `x = turn (x' - centre) + centre + shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    turn: Mat3,
    centre: Vec3,
    shift: Vec3,
    axis: Vec3,
    angle: f64,
}

impl Pose {
    /// From space into the frame.
    pub fn inward(&self, x: Vec3) -> Vec3 {
        add(transpose_vec(&self.turn, self.arm(x)), self.centre)
    }

    /// Where the centre of rotation is.
    pub fn centre(&self) -> Vec3 {
        add(self.centre, self.shift)
    }

    /// From the frame into space.
    pub fn outward(&self, x: Vec3) -> Vec3 {
        let r = mat_vec(&self.turn, sub(x, self.centre));
        add(add(r, self.centre), self.shift)
    }

    /// The axis of rotation, the same in space and in the frame: a point on it in the frame, and its direction.
    pub fn axis(&self) -> (Vec3, Vec3) {
        (self.centre, self.axis)
    }

    /// By how much the frame has turned about its axis since another of its poses `[rad]`; turns by more than a half are counted.
    pub fn turned_since(&self, before: &Pose) -> f64 {
        self.angle - before.angle
    }

    /// A place in space as seen from the axis where that is now, in the directions of space.
    pub fn arm(&self, x: Vec3) -> Vec3 {
        sub(sub(x, self.shift), self.centre)
    }

    /// A direction of the frame in space.
    pub fn turn(&self, v: Vec3) -> Vec3 {
        mat_vec(&self.turn, v)
    }

    /// A direction of space in the frame.
    pub fn turn_back(&self, v: Vec3) -> Vec3 {
        transpose_vec(&self.turn, v)
    }
}

impl Motion {
    /// The pose at time `t`.
    pub fn pose(&self, t: f64) -> Pose {
        let mut shift = [0.0; 3];
        for (i, x) in shift.iter_mut().enumerate() {
            let table: Vec<[f64; 2]> = self
                .translation
                .iter()
                .filter_map(|row| Some([*row.first()?, *row.get(i + 1)?]))
                .collect();
            *x = Amplitude::new(table).map_or(0.0, |a| a.at(t));
        }
        let mut pose = Pose {
            turn: identity(),
            centre: [0.0; 3],
            shift,
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
        };
        if let Some(r) = &self.rotation {
            let axis = r.axis.as_deref().map_or([0.0, 0.0, 1.0], to_vec3);
            let angle = Amplitude::new(r.angle.clone()).map_or(0.0, |a| a.at(t));
            pose.centre = to_vec3(&r.centre);
            pose.axis = normalize(axis).unwrap_or(pose.axis);
            pose.angle = angle;
            pose.turn = rotation(pose.axis, angle);
        }
        pose
    }

    /// The same motion about a centre elsewhere.
    pub fn moved(&self, by: Vec3) -> Self {
        let mut motion = self.clone();
        if let Some(rotation) = &mut motion.rotation {
            super::moved(&mut rotation.centre, by);
        }
        motion
    }

    /// The way from one time to another: shift of the centre of rotation, and the angle turned about it along the axis.
    pub fn way(&self, from: f64, to: f64) -> [Vec3; 2] {
        let shift = sub(self.pose(to).shift, self.pose(from).shift);
        let turn = self.rotation.as_ref().map_or([0.0; 3], |r| {
            let axis = r.axis.as_deref().map_or([0.0, 0.0, 1.0], to_vec3);
            let axis = normalize(axis).unwrap_or([0.0, 0.0, 1.0]);
            let angle = |t| Amplitude::new(r.angle.clone()).map_or(0.0, |a| a.at(t));
            scale(angle(to) - angle(from), axis)
        });
        [shift, turn]
    }

    /// What is wrong with the tables in a space of dimension `dim`, as `(key, message)`.
    pub fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        let mut faults = Vec::new();
        let times = |rows: Vec<f64>| Amplitude::new(rows.into_iter().map(|t| [t, 0.0]).collect());
        if let Some(i) = self
            .translation
            .iter()
            .position(|row| row.len() != dim + 1 || row.iter().any(|x| !x.is_finite()))
        {
            faults.push((
                "translation",
                format!(
                    "row {} must be a time and {dim} finite displacements",
                    i + 1
                ),
            ));
        } else if !self.translation.is_empty()
            && times(self.translation.iter().map(|row| row[0]).collect()).is_err()
        {
            faults.push(("translation", "times must increase".into()));
        }
        if let Some(r) = &self.rotation {
            faults.extend(vector_fault("rotation.centre", &r.centre, dim));
            match (&r.axis, dim) {
                (Some(_), 2) => {
                    faults.push(("rotation.axis", "has no meaning in a plane problem".into()));
                }
                (None, 3) => faults.push(("rotation.axis", "is missing".into())),
                (Some(axis), _) if normalize(to_vec3(axis)).is_none() => {
                    faults.push(("rotation.axis", "is zero".into()));
                }
                _ => {}
            }
            if Amplitude::new(r.angle.clone()).is_err() {
                faults.push(("rotation.angle", "needs rows with increasing times".into()));
            }
        }
        faults
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_go_there_and_back() {
        let motion = Motion {
            translation: vec![vec![0.0, 0.0, 0.0], vec![2.0, 1.0, -1.0]],
            rotation: Some(Rotation {
                centre: vec![1.0, 0.0],
                axis: None,
                angle: vec![[0.0, 0.0], [1.0, std::f64::consts::FRAC_PI_2]],
            }),
        };
        assert!(motion.faults(2).is_empty());
        let pose = motion.pose(1.0);
        let x = pose.outward([2.0, 0.0, 0.0]);
        assert!(crate::math::distance(x, [1.5, 0.5, 0.0]) < 1e-15);
        assert!(crate::math::distance(pose.inward(x), [2.0, 0.0, 0.0]) < 1e-15);
    }
}
