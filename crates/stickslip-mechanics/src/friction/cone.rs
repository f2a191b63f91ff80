//! The set of shear tractions that friction allows, which slip rules, the friction problem and steady sliding share.

use super::ellipse::{Ellipse, SlipDirection};

/// Corners of the polygon that stands for the set where forces are sums of given ones.
const CORNERS: usize = 24;

/// All shear tractions no longer than a limit, by its two components along the directions of a contact frame; an ellipse has this limit along its longer axis.
///
/// The frame of the paper's kinematics is not orthogonal: `skew` is the cosine of the angle between its directions and
/// lengths are measured by `|v|² = v₁² + v₂² + 2 skew v₁ v₂`. It is zero for all other kinematics.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cone {
    /// Largest shear, a traction `[Pa]` or a force `[N]`.
    pub limit: f64,
    /// Cosine of the angle between the two directions.
    pub skew: f64,
    /// Its shape where that is no circle.
    pub ellipse: Option<Ellipse>,
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
    /// Whether it is on the boundary; of a spring in series it may be inside.
    pub slides: bool,
}

/// A vector along which shear points, and the length by which it is divided: `limit along/size` is on the boundary.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Direction {
    /// The length.
    pub size: f64,
    /// The vector.
    pub along: [f64; 2],
    /// Derivative of the length with respect to the motion it is of, for a length that is not zero.
    pub toward: [f64; 2],
    /// Derivative of the vector with respect to that, row: vector.
    pub d_along: [[f64; 2]; 2],
    /// Derivatives of the length and of the vector with respect to the skew.
    pub size_with_skew: f64,
    /// See above.
    pub along_with_skew: [f64; 2],
}

/// The product of a matrix with a vector.
fn times(a: &[[f64; 2]; 2], v: [f64; 2]) -> [f64; 2] {
    a.map(|row| row[0] * v[0] + row[1] * v[1])
}

/// The product of two matrices.
fn product(a: &[[f64; 2]; 2], b: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    a.map(|row| [0, 1].map(|j| row[0] * b[0][j] + row[1] * b[1][j]))
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

    /// What of a shear counts against the limit: its length, of an ellipse that of the shear along the longer axis which is as near to the boundary.
    pub fn size(&self, v: [f64; 2]) -> f64 {
        let Some(ellipse) = &self.ellipse else {
            return self.length(v);
        };
        let [to_axes, ..] = ellipse.axes(self.skew);
        let p = times(&to_axes, v);
        let part = |i: usize| {
            if p[i] == 0.0 {
                0.0
            } else {
                p[i] / ellipse.half[i]
            }
        };
        part(0).hypot(part(1))
    }

    /// The largest shear in the direction of a shear.
    pub fn limit_along(&self, v: [f64; 2]) -> f64 {
        let size = self.size(v);
        match self.ellipse.is_some() && size > 0.0 {
            true => self.limit * (self.length(v) / size),
            false => self.limit,
        }
    }

    /// Corners of a polygon around the set, by components along as many directions as there are; in the plane its ends, and zero where shear has no direction. The set fills it
    /// but for `1 - cos(π/24)` of its size.
    pub fn corners(&self, directions: usize) -> Vec<[f64; 2]> {
        match directions {
            0 => vec![[0.0; 2]],
            1 => {
                let limit = self.limit_along([1.0, 0.0]);
                vec![[limit, 0.0], [-limit, 0.0]]
            }
            _ => {
                let step = std::f64::consts::TAU / CORNERS as f64;
                let outside = (0.5 * step).cos();
                let across = (1.0 - self.skew * self.skew).sqrt();
                let corner = |k: usize| {
                    let (sine, cosine) = (step * k as f64).sin_cos();
                    let unit = match &self.ellipse {
                        None => [cosine - self.skew / across * sine, sine / across],
                        Some(ellipse) => {
                            let [_, back, _] = ellipse.axes(self.skew);
                            times(&back, [ellipse.half[0] * cosine, ellipse.half[1] * sine])
                        }
                    };
                    unit.map(|v| self.limit * (v / outside))
                };
                (0..CORNERS).map(corner).collect()
            }
        }
    }

    /// The direction of a shear itself.
    pub fn radial(&self, v: [f64; 2]) -> Direction {
        let own = Direction {
            along: v,
            d_along: [[1.0, 0.0], [0.0, 1.0]],
            ..Direction::default()
        };
        match &self.ellipse {
            None => {
                let size = self.length(v);
                Direction {
                    size,
                    toward: self.length_slope(v, size),
                    // d|v|/dskew = v₁ v₂ / |v|
                    size_with_skew: v[0] * v[1] / size,
                    ..own
                }
            }
            Some(ellipse) => Direction {
                along: own.along,
                d_along: own.d_along,
                along_with_skew: [0.0; 2],
                ..self.scaled(ellipse, v, ellipse.half.map(|h| 1.0 / (h * h)))
            },
        }
    }

    /// The direction of the shear of a point whose sliding velocity is the opposite of a vector: by the associated rule the place of the ellipse where that is its normal, otherwise the vector itself.
    pub fn against(&self, v: [f64; 2]) -> Direction {
        match &self.ellipse {
            Some(ellipse) if ellipse.flow == SlipDirection::Associated => {
                self.scaled(ellipse, v, ellipse.half.map(|h| h * h))
            }
            _ => self.radial(v),
        }
    }

    /// The vector with components along the axes of an ellipse times factors, and its length `√(Σ factor pᵢ²)`.
    fn scaled(&self, ellipse: &Ellipse, v: [f64; 2], factors: [f64; 2]) -> Direction {
        let [to_axes, back, with_skew] = ellipse.axes(self.skew);
        let (p, turned) = (times(&to_axes, v), times(&with_skew, v));
        let scaled = [0, 1].map(|i| factors[i] * p[i]);
        let size = (scaled[0] * p[0] + scaled[1] * p[1]).sqrt();
        let both = [0, 1].map(|i| to_axes[i].map(|b| factors[i] * b));
        let along = times(&back, scaled);
        let same = times(&back, times(&with_skew, along));
        let other = times(&back, [0, 1].map(|i| factors[i] * turned[i]));
        Direction {
            size,
            along,
            toward: [0, 1].map(|j| (scaled[0] * to_axes[0][j] + scaled[1] * to_axes[1][j]) / size),
            d_along: product(&back, &both),
            size_with_skew: (scaled[0] * turned[0] + scaled[1] * turned[1]) / size,
            along_with_skew: [0, 1].map(|i| other[i] - same[i]),
        }
    }

    /// The boundary point in a direction of a length that is not zero, whose vector changes by `rate` times a motion: `limit along/size`.
    pub fn boundary(&self, direction: &Direction, rate: f64) -> BoundaryPoint {
        let length = direction.size;
        let m = direction.along.map(|v| v / length);
        let slope = direction.toward;
        let shear = m.map(|m| self.limit * m);
        let size = rate * self.limit / length;
        let stretch = direction.size_with_skew;
        let turn = direction.along_with_skew;
        BoundaryPoint {
            shear,
            d_motion: [0, 1]
                .map(|i| [0, 1].map(|j| size * (direction.d_along[i][j] - m[i] * slope[j]))),
            d_limit: m,
            d_skew: [0, 1].map(|i| (self.limit * turn[i] - shear[i] * stretch) / length),
            slides: true,
        }
    }

    /// The shear to which a trial beyond the limit returns, which changes by `rate` times a motion: the nearest point of the set, and with slip against the traction the one in its
    /// direction. Nearest is measured by lengths in the surface, whatever the frame.
    pub fn returned(&self, trial: [f64; 2], rate: f64) -> BoundaryPoint {
        match &self.ellipse {
            Some(ellipse) if ellipse.flow == SlipDirection::Associated => {
                let relieved = self.relieved(ellipse, trial, rate, 0.0);
                BoundaryPoint {
                    slides: true,
                    ..relieved
                }
            }
            _ => self.boundary(&self.radial(trial), rate),
        }
    }

    /// The shear of a spring in series with the associated rule, see `Ellipse::nearest`.
    pub fn relieved(
        &self,
        ellipse: &Ellipse,
        trial: [f64; 2],
        rate: f64,
        give: f64,
    ) -> BoundaryPoint {
        if self.limit <= 0.0 {
            let direction = self.against(trial);
            return match direction.size > 0.0 {
                true => self.boundary(&direction, rate),
                false => BoundaryPoint::default(),
            };
        }
        let [to_axes, back, with_skew] = ellipse.axes(self.skew);
        let near = ellipse.nearest(times(&to_axes, trial), self.limit, give);
        let shear = times(&back, near.shear);
        let same = times(&with_skew, shear);
        let other = times(&near.d_trial, times(&with_skew, trial));
        let d_trial = product(&back, &product(&near.d_trial, &to_axes));
        BoundaryPoint {
            shear,
            d_motion: d_trial.map(|row| row.map(|d| rate * d)),
            d_limit: times(&back, near.d_limit),
            d_skew: times(&back, [0, 1].map(|i| other[i] - same[i])),
            slides: near.slides,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle, and ellipses of both rules; the last one is a line.
    fn shapes() -> Vec<Option<Ellipse>> {
        let mut shapes = vec![None];
        for flow in [SlipDirection::Associated, SlipDirection::AgainstTraction] {
            for (half, angle) in [([1.0, 0.4], 0.0), ([1.0, 0.4], 0.7), ([0.03, 1.0], 2.0)] {
                shapes.push(Some(Ellipse { half, angle, flow }));
            }
        }
        let line = Ellipse {
            half: [1.0, 0.0],
            angle: 0.7,
            flow: SlipDirection::Associated,
        };
        shapes.push(Some(line));
        shapes
    }

    fn cones() -> impl Iterator<Item = Cone> {
        shapes().into_iter().flat_map(|ellipse| {
            [0.0, 0.4, -0.6].map(|skew| Cone {
                limit: 0.7,
                skew,
                ellipse,
            })
        })
    }

    const TRIALS: [[f64; 2]; 4] = [[1.0, 0.3], [-0.4, 2.0], [0.6, -0.9], [-0.8, -0.2]];

    #[test]
    fn the_projection_is_the_nearest_point_of_the_cone_or_that_in_its_direction() {
        for cone in cones() {
            let associated = cone
                .ellipse
                .is_none_or(|e| e.flow == SlipDirection::Associated);
            for v in TRIALS.into_iter().filter(|&v| cone.size(v) > cone.limit) {
                let at = cone.returned(v, 1.0);
                assert!(at.slides);
                if !associated {
                    let across = at.shear[0] * v[1] - at.shear[1] * v[0];
                    assert!(across.abs() < 1e-15 && at.shear[0] * v[0] > 0.0, "{cone:?}");
                    assert!((cone.size(at.shear) / cone.limit - 1.0).abs() < 1e-13);
                    continue;
                }
                let away = |t: [f64; 2]| cone.length([v[0] - t[0], v[1] - t[1]]);
                // From the corners around the set each point of the boundary is a little inside.
                for k in 0..360 {
                    let (sine, cosine) = f64::from(k).to_radians().sin_cos();
                    let other = match &cone.ellipse {
                        None => cone.boundary(&cone.radial([cosine, sine]), 1.0).shear,
                        Some(ellipse) => {
                            let [first, second] = ellipse.half;
                            let p = [first * cosine, second * sine].map(|p| cone.limit * p);
                            times(&ellipse.axes(cone.skew)[1], p)
                        }
                    };
                    assert!(away(at.shear) <= away(other) + 1e-15, "{cone:?} {v:?}");
                }
                let thin = cone.ellipse.is_some_and(|e| e.half.contains(&0.0));
                let size = cone.size(at.shear) / cone.limit;
                assert!(thin || (size - 1.0).abs() < 1e-12, "{cone:?} {v:?}: {size}");
            }
        }
    }

    /// Unit pressure, coefficients 0.5 and 0.2, slip at 30, 45 and 60 degrees from the first axis.
    #[test]
    fn shear_of_a_point_that_slides_has_its_closed_form() {
        let table = [
            (
                30.0_f64,
                [-0.487177352, -0.045003516],
                [-0.284747399, -0.164398987],
            ),
            (
                45.0,
                [-0.464238345, -0.074278135],
                [-0.185695338, -0.185695338],
            ),
            (
                60.0,
                [-0.410997468, -0.113898959],
                [-0.112508790, -0.194870941],
            ),
        ];
        for (angle, associated, against) in table {
            let (sine, cosine) = angle.to_radians().sin_cos();
            for (flow, expected) in [
                (SlipDirection::Associated, associated),
                (SlipDirection::AgainstTraction, against),
            ] {
                for turned in [0.0, 0.3, 1.0] {
                    let cone = Cone {
                        limit: 0.5,
                        skew: 0.0,
                        ellipse: Some(Ellipse {
                            half: [1.0, 0.4],
                            angle: turned,
                            flow,
                        }),
                    };
                    let (s, c) = turned.sin_cos();
                    let turn = |v: [f64; 2]| [c * v[0] - s * v[1], s * v[0] + c * v[1]];
                    let slip = turn([cosine, sine]);
                    let direction = cone.against(slip.map(|s| -s));
                    let shear = cone.boundary(&direction, 1.0).shear;
                    let expected = turn(expected);
                    for (t, e) in shear.into_iter().zip(expected) {
                        assert!((t - e).abs() < 1e-9, "{angle} {flow:?}: {shear:?}");
                    }
                    // The nearest point to what is far beyond the limit is that of the slip; against the traction it is in its direction.
                    let far = slip.map(|s| -1e9 * s);
                    let returned = cone.returned(far, 1.0).shear;
                    for (t, e) in returned.into_iter().zip(expected) {
                        assert!((t - e).abs() < 2e-9, "{angle} {flow:?}: {returned:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn corners_lie_around_the_set_and_near_it() {
        for cone in cones() {
            let thin = cone.ellipse.is_some_and(|e| e.half.contains(&0.0));
            let corners = cone.corners(2);
            let next = corners.iter().cycle().skip(1);
            for (a, b) in corners.iter().zip(next).filter(|_| !thin) {
                let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
                assert!((cone.size(middle) - cone.limit).abs() < 1e-13, "{cone:?}");
                assert!(cone.size(*a) < 1.01 * cone.limit);
            }
        }
        let mut cone = Cone {
            limit: 2.0,
            ..Cone::default()
        };
        assert_eq!(cone.corners(1), [[2.0, 0.0], [-2.0, 0.0]]);
        assert_eq!(cone.corners(0), [[0.0; 2]]);
        cone.ellipse = Some(Ellipse {
            half: [0.25, 1.0],
            angle: 0.0,
            flow: SlipDirection::Associated,
        });
        assert_eq!(cone.corners(1), [[0.5, 0.0], [-0.5, 0.0]]);
        assert_eq!(cone.limit_along([0.1, 0.0]), 0.5);
        assert_eq!(cone.limit_along([0.0, 0.1]), 2.0);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        type Shear<'a> = &'a dyn Fn(Cone, [f64; 2]) -> BoundaryPoint;
        for cone in cones() {
            let thin = cone.ellipse.is_some_and(|e| e.half.contains(&0.0));
            let associated = cone.ellipse.filter(|e| e.flow == SlipDirection::Associated);
            let mut all: Vec<(&str, Shear)> = vec![
                ("returned", &|cone, v| cone.returned(v, 2.0)),
                ("sliding", &|cone, v| cone.boundary(&cone.against(v), 2.0)),
            ];
            if associated.is_some() {
                all.push(("relieved", &|cone, v| {
                    cone.relieved(&cone.ellipse.unwrap(), v, 2.0, 0.4)
                }));
                all.push(("creeping", &|cone, v| {
                    cone.relieved(&cone.ellipse.unwrap(), v, 2.0, 7.0)
                }));
            }
            for (what, shear) in all {
                // Of a line the shear jumps at once from one end to the other: it has no derivative but zero.
                for v in TRIALS.into_iter().filter(|_| !(thin && what == "sliding")) {
                    if cone.size(v) <= cone.limit {
                        continue;
                    }
                    let at = shear(cone, v);
                    let h = 1e-6;
                    let slope =
                        |a: [f64; 2], b: [f64; 2]| [0, 1].map(|i| (b[i] - a[i]) / (2.0 * h));
                    let close = |a: [f64; 2], b: [f64; 2]| {
                        let off = [0, 1].map(|i| (a[i] - b[i]).abs() / (1.0 + b[i].abs()));
                        assert!(
                            off.iter().all(|o| *o < 2e-8),
                            "{what} {cone:?} {v:?}: {a:?} {b:?}"
                        );
                    };
                    for j in 0..2 {
                        let moved = |h: f64| {
                            let mut v = v;
                            v[j] += 2.0 * h;
                            shear(cone, v).shear
                        };
                        close(at.d_motion.map(|row| row[j]), slope(moved(-h), moved(h)));
                    }
                    let wider = |h: f64| {
                        let limit = cone.limit + h;
                        shear(Cone { limit, ..cone }, v).shear
                    };
                    close(at.d_limit, slope(wider(-h), wider(h)));
                    let turned = |h: f64| {
                        let skew = cone.skew + h;
                        shear(Cone { skew, ..cone }, v).shear
                    };
                    close(at.d_skew, slope(turned(-h), turned(h)));
                }
            }
        }
    }
}
