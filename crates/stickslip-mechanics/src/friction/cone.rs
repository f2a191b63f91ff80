//! The set of shear tractions that friction allows, which slip rules, the friction problem and steady sliding share.

/// Corners of the polygon that stands for the set where forces are sums of given ones.
const CORNERS: usize = 24;

/// All shear tractions no longer than a limit, by its two components along the directions of a contact frame.
///
/// The frame of the paper's kinematics is not orthogonal: `skew` is the cosine of the angle between its directions and
/// lengths are measured by `|v|² = v₁² + v₂² + 2 skew v₁ v₂`. It is zero for all other kinematics.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cone {
    /// Largest shear, a traction `[Pa]` or a force `[N]`.
    pub limit: f64,
    /// Cosine of the angle between the two directions.
    pub skew: f64,
}

/// A point of the boundary and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoundaryPoint {
    /// The shear there.
    pub shear: [f64; 2],
    /// Derivative with respect to the motion that the vector follows, row: shear.
    pub d_motion: [[f64; 2]; 2],
    /// Derivative with respect to the limit.
    pub d_limit: [f64; 2],
    /// Derivative with respect to the skew.
    pub d_skew: [f64; 2],
}

impl Cone {
    /// `|v|`.
    pub fn length(&self, v: [f64; 2]) -> f64 {
        (v[0] * v[0] + v[1] * v[1] + 2.0 * self.skew * v[0] * v[1])
            .max(0.0)
            .sqrt()
    }

    /// The derivative of `|v|` with respect to `v`, for a length that is not zero.
    pub fn length_slope(&self, v: [f64; 2], length: f64) -> [f64; 2] {
        [
            (v[0] + self.skew * v[1]) / length,
            (v[1] + self.skew * v[0]) / length,
        ]
    }

    /// Corners of a polygon around the set, by components along as many directions as there are; in the plane its ends, and zero where shear has no direction. The set fills it
    /// but for `1 - cos(π/24)` of its size.
    pub fn corners(&self, directions: usize) -> Vec<[f64; 2]> {
        match directions {
            0 => vec![[0.0; 2]],
            1 => vec![[self.limit, 0.0], [-self.limit, 0.0]],
            _ => {
                let step = std::f64::consts::TAU / CORNERS as f64;
                let outside = (0.5 * step).cos();
                let across = (1.0 - self.skew * self.skew).sqrt();
                let corner = |k: usize| {
                    let (sine, cosine) = (step * k as f64).sin_cos();
                    let unit = [cosine - self.skew / across * sine, sine / across];
                    unit.map(|v| self.limit * (v / outside))
                };
                (0..CORNERS).map(corner).collect()
            }
        }
    }

    /// The boundary point in the direction of a vector of this length, which is not zero and changes by `rate` times a motion: `limit v/|v|`. For a trial traction
    /// beyond the limit it is the closest-point projection, for the opposite of a sliding velocity the shear of a point that slides.
    pub fn boundary(&self, v: [f64; 2], length: f64, rate: f64) -> BoundaryPoint {
        let m = v.map(|v| v / length);
        let slope = self.length_slope(v, length);
        let shear = m.map(|m| self.limit * m);
        let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let size = rate * self.limit / length;
        // d|v|/dskew = v₁ v₂ / |v|
        let stretch = v[0] * v[1] / length;
        BoundaryPoint {
            shear,
            d_motion: [0, 1].map(|i| [0, 1].map(|j| size * (unit(i, j) - m[i] * slope[j]))),
            d_limit: m,
            d_skew: shear.map(|t| -t * stretch / length),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projection_is_the_nearest_point_of_the_cone() {
        for skew in [0.0, 0.4, -0.6] {
            let cone = Cone { limit: 0.7, skew };
            for v in [[1.0, 0.3], [-0.4, 2.0], [0.6, -0.9]] {
                let length = cone.length(v);
                let at = cone.boundary(v, length, 1.0);
                assert!((cone.length(at.shear) - cone.limit).abs() < 1e-15);
                let away = |t: [f64; 2]| cone.length([v[0] - t[0], v[1] - t[1]]);
                for k in 0..360 {
                    let angle = f64::from(k).to_radians();
                    let other = [angle.cos(), angle.sin()];
                    let other = cone.boundary(other, cone.length(other), 1.0).shear;
                    assert!(away(at.shear) <= away(other) + 1e-15, "{skew} {v:?}");
                }
            }
        }
    }

    #[test]
    fn corners_lie_around_the_set_and_near_it() {
        for skew in [0.0, 0.5] {
            let cone = Cone { limit: 0.7, skew };
            let corners = cone.corners(2);
            let next = corners.iter().cycle().skip(1);
            for (a, b) in corners.iter().zip(next) {
                let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
                assert!((cone.length(middle) - cone.limit).abs() < 1e-14, "{skew}");
                assert!(cone.length(*a) < 1.01 * cone.limit);
            }
        }
        let cone = Cone {
            limit: 2.0,
            skew: 0.0,
        };
        assert_eq!(cone.corners(1), [[2.0, 0.0], [-2.0, 0.0]]);
        assert_eq!(cone.corners(0), [[0.0; 2]]);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let cone = Cone {
            limit: 0.7,
            skew: 0.3,
        };
        let v = [0.8, -0.5];
        let shear = |cone: Cone, v: [f64; 2]| cone.boundary(v, cone.length(v), 2.0).shear;
        let at = cone.boundary(v, cone.length(v), 2.0);
        let h = 1e-6;
        let wider = |h: f64| Cone {
            limit: cone.limit + h,
            ..cone
        };
        let turned = |h: f64| Cone {
            skew: cone.skew + h,
            ..cone
        };
        for i in 0..2 {
            let slope = |a: [f64; 2], b: [f64; 2]| (b[i] - a[i]) / (2.0 * h);
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
            for j in 0..2 {
                let moved = |h: f64| {
                    let mut v = v;
                    v[j] += 2.0 * h;
                    shear(cone, v)
                };
                close(at.d_motion[i][j], slope(moved(-h), moved(h)));
            }
            close(
                at.d_limit[i],
                slope(shear(wider(-h), v), shear(wider(h), v)),
            );
            close(
                at.d_skew[i],
                slope(shear(turned(-h), v), shear(turned(h), v)),
            );
        }
    }
}
