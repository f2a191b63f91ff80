//! Rigid obstacles: shapes given by formulas, with a prescribed motion.

mod chart;
mod cylinder;
mod foot;
mod motion;
mod plane;
mod sphere;

pub use chart::{Chart, Place};
pub use cylinder::Cylinder;
pub use foot::{Foot, Shape};
pub use motion::{Motion, Pose, Rotation};
pub use plane::Plane;
pub use sphere::Sphere;

use crate::math::Vec3;

crate::family! {
    /// The shape of a rigid obstacle.
    ObstacleShape: "shape", dyn Shape {
        /// Half-space.
        Plane(Plane) = "plane",
        /// Cylinder (2D: circle).
        Cylinder(Cylinder) = "cylinder",
        /// Sphere.
        Sphere(Sphere) = "sphere",
    }
}

impl ObstacleShape {
    /// The same shape elsewhere.
    pub fn moved(&self, by: Vec3) -> Self {
        let mut shape = self.clone();
        moved(
            match &mut shape {
                ObstacleShape::Plane(plane) => &mut plane.point,
                ObstacleShape::Cylinder(cylinder) => &mut cylinder.centre,
                ObstacleShape::Sphere(sphere) => &mut sphere.centre,
            },
            by,
        );
        shape
    }
}

/// Moves a point given by two or three numbers.
fn moved(point: &mut [f64], by: Vec3) {
    for (x, by) in point.iter_mut().zip(by) {
        *x += by;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    #[test]
    fn derivatives_agree_with_differences() {
        for shape in ObstacleShape::samples() {
            let dyn_shape = shape.as_dyn();
            let x = [0.31, -0.22, 0.17];
            let v = [0.3, 0.5, -0.7];
            let foot = dyn_shape.foot(x).expect("the samples have a foot here");
            let slope = |f: &Foot| crate::math::mat_vec(&f.slope, v);
            let dd = dyn_shape.slope_derivative(x, v);
            let h = 1e-6;
            for j in 0..3 {
                let at = |h: f64| {
                    let mut y = x;
                    y[j] += h;
                    dyn_shape.foot(y).expect("near the first")
                };
                let (a, b) = (at(-h), at(h));
                let d = |p: f64, q: f64| (q - p) / (2.0 * h);
                assert!((d(a.gap, b.gap) - foot.normal[j]).abs() < 1e-9, "{shape:?}");
                for (i, dd) in dd.iter().enumerate() {
                    let close = |value: f64, p: f64, q: f64| {
                        assert!((value - d(p, q)).abs() < 1e-8, "{shape:?}");
                    };
                    close(foot.slope[i][j], a.point[i], b.point[i]);
                    close(foot.curvature[i][j], a.normal[i], b.normal[i]);
                    close(dd[j], slope(&a)[i], slope(&b)[i]);
                }
            }
        }
    }
}
