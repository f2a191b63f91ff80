//! Triangles and lines into pixels, the nearest in front: what is hidden is removed at every pixel.

use crate::colour::{self, Rgb, Scale};

/// Pixels of a raster for a pixel of the picture, each way.
pub const FINE: usize = 2;

/// A corner on the picture: pixels right and down, depth towards the eye; and the value there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Where.
    pub at: [f64; 3],
    /// The value; NaN if there is none.
    pub value: f64,
}

/// Pixels with depths.
pub struct Raster {
    size: [usize; 2],
    /// Red, green, blue, opacity of each pixel.
    pub pixels: Vec<u8>,
    depth: Vec<f32>,
}

impl Raster {
    /// An empty picture, nothing of it opaque.
    pub fn new(size: [usize; 2]) -> Self {
        Raster {
            size,
            pixels: vec![0; 4 * size[0] * size[1]],
            depth: vec![f32::NEG_INFINITY; size[0] * size[1]],
        }
    }

    /// A triangle, coloured by the values at its corners and darkened by `light`. A status is that of the nearest corner; a triangle
    /// with a corner without a value has none.
    pub fn triangle(&mut self, t: [Corner; 3], scale: &Scale, light: f64) {
        let [a, b, c] = t.map(|corner| corner.at);
        let double = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if double == 0.0 || !double.is_finite() {
            return;
        }
        let part = |c: usize| {
            let (low, high) = ([a, b, c_of(t, 2)], self.size[c] as f64);
            let least = low.iter().map(|p| p[c]).fold(f64::INFINITY, f64::min);
            let most = low.iter().map(|p| p[c]).fold(f64::NEG_INFINITY, f64::max);
            let first = (least - 0.5).ceil().clamp(0.0, high);
            let last = (most - 0.5).floor().clamp(-1.0, high - 1.0);
            (first as i64, last as i64)
        };
        let ((x0, x1), (y0, y1)) = (part(0), part(1));
        let known = t.iter().all(|corner| !corner.value.is_nan());
        for y in y0..=y1 {
            for x in x0..=x1 {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let wb = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / double;
                let wc = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / double;
                let weights = [1.0 - wb - wc, wb, wc];
                if weights.iter().any(|w| *w < -1e-9) {
                    continue;
                }
                let z = weights[0] * a[2] + wb * b[2] + wc * c[2];
                let value = match (known, scale.status) {
                    (false, _) => f64::NAN,
                    (true, true) => nearest(&t, weights),
                    (true, false) => (0..3).map(|i| weights[i] * t[i].value).sum(),
                };
                let colour = scale.colour(value).map(|v| (f64::from(v) * light) as u8);
                self.set(x as usize, y as usize, z, colour, 1.0);
            }
        }
    }

    /// Whether something is in front of a point by more than this depth.
    pub fn hides(&self, [x, y, z]: [f64; 3], by: f64) -> bool {
        let within = |v: f64, c: usize| (0.0..self.size[c] as f64).contains(&v);
        within(x, 0)
            && within(y, 1)
            && f64::from(self.depth[y as usize * self.size[0] + x as usize]) > z + by
    }

    /// A line of this width, `lift` nearer to the eye than its ends say; it is mixed with what is there by `strength`.
    pub fn line(&mut self, [a, b]: [[f64; 3]; 2], width: f64, lift: f64, ink: Rgb, strength: f64) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if !length.is_finite() {
            return;
        }
        let half = width.max(1.0) / 2.0;
        let clamp = |v: f64, most: usize| v.clamp(0.0, most as f64) as usize;
        let (x0, x1) = (
            clamp((a[0].min(b[0]) - half - 0.5).floor(), self.size[0]),
            clamp((a[0].max(b[0]) + half + 0.5).ceil(), self.size[0]),
        );
        let (y0, y1) = (
            clamp((a[1].min(b[1]) - half - 0.5).floor(), self.size[1]),
            clamp((a[1].max(b[1]) + half + 0.5).ceil(), self.size[1]),
        );
        for y in y0..y1 {
            for x in x0..x1 {
                let (px, py) = (x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]);
                let along = match length > 0.0 {
                    true => ((px * dx + py * dy) / (length * length)).clamp(0.0, 1.0),
                    false => 0.0,
                };
                let away = (px - along * dx).hypot(py - along * dy);
                // The part of the pixel that is covered: a thin line would have gaps otherwise.
                let cover = (half + 0.5 - away).clamp(0.0, 1.0) * width.min(1.0);
                if cover > 0.0 {
                    let z = a[2] + along * (b[2] - a[2]) + lift;
                    self.set(x, y, z, ink, strength * cover);
                }
            }
        }
    }

    fn set(&mut self, x: usize, y: usize, z: f64, colour: Rgb, strength: f64) {
        let i = y * self.size[0] + x;
        let z = z as f32;
        if z < self.depth[i] {
            return;
        }
        let pixel = &mut self.pixels[4 * i..4 * i + 4];
        if strength >= 1.0 {
            self.depth[i] = z;
            pixel[..3].copy_from_slice(&colour);
            pixel[3] = 255;
            return;
        }
        // Over what is there; where nothing is, the part that is covered becomes the opacity.
        let under = f64::from(pixel[3]) / 255.0 * (1.0 - strength);
        let opacity = strength + under;
        if opacity <= 0.0 {
            return;
        }
        for (p, c) in pixel[..3].iter_mut().zip(colour) {
            *p = ((f64::from(*p) * under + f64::from(c) * strength) / opacity).round() as u8;
        }
        pixel[3] = (255.0 * opacity).round() as u8;
    }
}

fn c_of(t: [Corner; 3], i: usize) -> [f64; 3] {
    t[i].at
}

/// The status with the largest weight.
fn nearest(t: &[Corner; 3], weights: [f64; 3]) -> f64 {
    let mut sums = [0.0; colour::STATUSES.len()];
    for (corner, w) in t.iter().zip(weights) {
        sums[corner.value.round().clamp(0.0, colour::TIED as f64) as usize] += w;
    }
    let mut best = 0;
    for i in 1..sums.len() {
        if sums[i] > sums[best] {
            best = i;
        }
    }
    best as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(x: [[f64; 3]; 3], values: [f64; 3]) -> [Corner; 3] {
        [0, 1, 2].map(|i| Corner {
            at: x[i],
            value: values[i],
        })
    }

    const SCALE: Scale = Scale {
        range: [0.0, 1.0],
        signed: false,
        status: false,
        carried: false,
        bands: None,
        threshold: None,
    };

    fn pixel(r: &Raster, x: usize, y: usize) -> [u8; 4] {
        *r.pixels[4 * (y * r.size[0] + x)..].first_chunk().unwrap()
    }

    #[test]
    fn the_nearer_triangle_is_seen_whatever_comes_first() {
        let square = |z: f64| [[0., 0., z], [20., 0., z], [0., 20., z]];
        for order in [[0.0, 1.0], [1.0, 0.0]] {
            let mut r = Raster::new([10, 10]);
            for z in order {
                r.triangle(corners(square(z), [z; 3]), &SCALE, 1.0);
            }
            assert_eq!(pixel(&r, 3, 4)[..3], colour::ORDERED[8]);
        }
    }

    #[test]
    fn every_pixel_within_is_filled_once_and_none_outside() {
        let mut r = Raster::new([12, 12]);
        let [a, b, c, d] = [[1., 1., 0.], [11., 1., 0.], [11., 11., 0.], [1., 11., 0.]];
        r.triangle(corners([a, b, c], [0.5; 3]), &SCALE, 1.0);
        r.triangle(corners([a, c, d], [0.5; 3]), &SCALE, 1.0);
        for y in 0..12 {
            for x in 0..12 {
                let inside = (1..11).contains(&x) && (1..11).contains(&y);
                assert_eq!(pixel(&r, x, y)[3] == 255, inside, "{x} {y}");
            }
        }
    }

    #[test]
    fn a_status_is_not_mixed_and_a_missing_value_is_grey() {
        let status = Scale {
            status: true,
            ..SCALE
        };
        let x = [[0., 0., 0.], [40., 0., 0.], [0., 40., 0.]];
        let mut r = Raster::new([20, 20]);
        r.triangle(corners(x, [0., 2., 2.]), &status, 1.0);
        let seen: std::collections::BTreeSet<[u8; 4]> = (0..400)
            .map(|i| pixel(&r, i % 20, i / 20))
            .filter(|p| p[3] > 0)
            .collect();
        let stick = colour::STATUSES[1].1;
        assert_eq!(seen.len(), 2);
        assert!(seen.iter().all(|p| p[..3] != stick));
        let mut r = Raster::new([20, 20]);
        r.triangle(corners(x, [0., f64::NAN, 2.]), &SCALE, 1.0);
        assert_eq!(pixel(&r, 2, 2)[..3], colour::NOTHING);
    }

    #[test]
    fn what_is_not_on_the_picture_is_passed_over() {
        let mut r = Raster::new([5, 5]);
        let far = [[-1e9, 7., 0.], [1e9, -1e9, 0.], [f64::NAN, 1., 0.]];
        r.triangle(corners(far, [0.; 3]), &SCALE, 1.0);
        r.line([[f64::NAN; 3], [1.; 3]], 1.0, 0.0, [0; 3], 1.0);
        r.line([[-50., -50., 0.], [-60., 70., 0.]], 1.0, 0.0, [0; 3], 1.0);
        assert!(r.pixels.iter().all(|p| *p == 0));
    }
}
