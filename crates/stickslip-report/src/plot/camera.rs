//! From space to the picture, without perspective.

use std::str::FromStr;

use stickslip::math::{cross, dot};

type Vec3 = [f64; 3];

/// From where one looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// From a corner above.
    Iso,
    /// Along an axis (0, 1, 2), from its positive side, or its negative one where the sign is negative.
    Along(usize, f64),
    /// From this direction.
    From(Vec3),
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "iso" => Ok(View::Iso),
            "x" | "+x" => Ok(View::Along(0, 1.0)),
            "y" | "+y" => Ok(View::Along(1, 1.0)),
            "z" | "+z" => Ok(View::Along(2, 1.0)),
            "-x" => Ok(View::Along(0, -1.0)),
            "-y" => Ok(View::Along(1, -1.0)),
            "-z" => Ok(View::Along(2, -1.0)),
            _ => Err(format!("`{text}` is no view: iso, x, y, z, -x, -y or -z")),
        }
    }
}

/// The vector with length one; as it is if it has none.
pub fn unit(a: Vec3) -> Vec3 {
    let length = dot(a, a).sqrt();
    match length > 0.0 {
        true => a.map(|x| x / length),
        false => a,
    }
}

/// Directions of the picture in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    right: Vec3,
    /// Upwards in the picture.
    pub up: Vec3,
    /// Towards the eye.
    pub out: Vec3,
}

impl Camera {
    /// A camera that looks at a model of this dimension; a plane one is seen from z whatever the view.
    pub fn new(view: View, dim: usize) -> Self {
        let out = match view {
            _ if dim == 2 => [0.0, 0.0, 1.0],
            View::Iso => unit([0.62, -0.72, 0.5]),
            View::Along(axis, sign) => {
                let mut out = [0.0; 3];
                out[axis] = sign;
                out
            }
            View::From(direction) => unit(direction),
        };
        let above = match out[2].abs() > 0.99 {
            true => [0.0, 1.0, 0.0],
            false => [0.0, 0.0, 1.0],
        };
        let right = unit(cross(above, out));
        Camera {
            right,
            up: cross(out, right),
            out,
        }
    }

    /// Right, up, towards the eye.
    pub fn see(&self, x: Vec3) -> Vec3 {
        [dot(self.right, x), dot(self.up, x), dot(self.out, x)]
    }
}

/// Where a point of space is on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    middle: [f64; 2],
    centre: [f64; 2],
    /// Pixels a unit of length.
    pub zoom: f64,
}

impl Frame {
    /// The frame that shows the box from `low` to `high` of the picture's plane in the rectangle at `at` of this size.
    pub fn fit(low: [f64; 2], high: [f64; 2], at: [f64; 2], size: [f64; 2]) -> Self {
        let span = |c: usize| (high[c] - low[c]).max(f64::MIN_POSITIVE);
        let zoom = (size[0] / span(0)).min(size[1] / span(1));
        Frame {
            middle: [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0],
            centre: [at[0] + size[0] / 2.0, at[1] + size[1] / 2.0],
            zoom: if zoom.is_finite() { zoom } else { 1.0 },
        }
    }

    /// Pixels from the upper left corner, and the depth towards the eye.
    pub fn place(&self, [x, y, z]: Vec3) -> Vec3 {
        [
            self.centre[0] + self.zoom * (x - self.middle[0]),
            self.centre[1] - self.zoom * (y - self.middle[1]),
            z,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_the_right_hand() {
        for (view, right, up) in [
            ("x", [0., 1., 0.], [0., 0., 1.]),
            ("-y", [1., 0., 0.], [0., 0., 1.]),
            ("z", [1., 0., 0.], [0., 1., 0.]),
            ("-z", [-1., 0., 0.], [0., 1., 0.]),
        ] {
            let camera = Camera::new(view.parse().unwrap(), 3);
            assert_eq!(camera.see(right), [1., 0., 0.], "{view}");
            assert_eq!(camera.see(up), [0., 1., 0.], "{view}");
        }
        let plane = Camera::new(View::Iso, 2);
        assert_eq!(plane.see([3., 4., 5.]), [3., 4., 5.]);
        assert!("w".parse::<View>().is_err());
    }

    #[test]
    fn the_whole_box_is_in_the_frame() {
        let frame = Frame::fit([1., 1.], [3., 2.], [10., 20.], [100., 100.]);
        assert_eq!(frame.place([1., 1., 7.]), [10., 95., 7.]);
        assert_eq!(frame.place([3., 2., 7.]), [110., 45., 7.]);
    }
}
