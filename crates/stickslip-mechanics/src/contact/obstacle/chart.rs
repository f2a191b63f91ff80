//! Numbered places on a simple surface, on which a field can be kept where there is no mesh.
//!
//! Places stand in rows: along a plane, around a cylinder, around the parallels of a sphere, which have the fewer places the nearer they are to a pole. In a row places are equally
//! far apart, and so are rows. A field is linear between the places of a row, and between the rows. In a plane problem there is one row, and in one with an axis what turns about
//! it is a single place.

use std::f64::consts::{PI, TAU};

use crate::math::{Vec3, add_scaled, cross, dot, normalize, scale, sub};

/// The number of a place: that of its row, and where in the row it stands.
pub type Place = [i32; 2];

/// Parts into which the distance to the next place is divided where an area is summed up.
const PARTS_OF_AREA: usize = 4;

/// What the surface is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Surface {
    Plane,
    Cylinder,
    Sphere,
}

/// Numbered places on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    surface: Surface,
    /// The place from which distances and angles are counted.
    origin: Vec3,
    /// Unit vectors: along a row or where angles begin, across the first, and the normal of a plane or the axis of what is round.
    axes: [Vec3; 3],
    /// Zero of a plane.
    radius: f64,
    /// About how far places are apart `[m]`.
    spacing: f64,
    /// There is one row.
    flat: bool,
}

/// Two unit vectors that make a right-handed frame with a unit vector; in the plane the second points out of it.
fn across(n: Vec3, dim: usize) -> [Vec3; 2] {
    if dim == 2 {
        return [[n[1], -n[0], 0.0], [0.0, 0.0, 1.0]];
    }
    let least = (0..3).fold(0, |b, i| if n[i].abs() < n[b].abs() { i } else { b });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let first = normalize(add_scaled(e, -dot(e, n), n)).unwrap_or(e);
    [first, cross(n, first)]
}

impl Chart {
    /// Of a plane through a point with a unit normal, with places about `spacing` apart.
    pub fn plane(point: Vec3, normal: Vec3, dim: usize, spacing: f64) -> Self {
        let [a, b] = across(normal, dim);
        Chart {
            surface: Surface::Plane,
            // From the foot of where coordinates begin: on the axis, if there is one.
            origin: scale(dot(point, normal), normal),
            axes: [a, b, normal],
            radius: 0.0,
            spacing,
            flat: dim == 2,
        }
    }

    /// The same with rows along a direction.
    pub fn along(self, direction: Vec3) -> Self {
        let [first, _, normal] = self.axes;
        let laid = add_scaled(direction, -dot(direction, normal), normal);
        let first = match self.flat {
            true => first,
            false => normalize(laid).unwrap_or(first),
        };
        Chart {
            axes: [first, cross(normal, first), normal],
            ..self
        }
    }

    /// Of a cylinder about an axis through a point; of a circle in the plane.
    pub fn cylinder(centre: Vec3, axis: Vec3, radius: f64, dim: usize, spacing: f64) -> Self {
        let [a, b] = match dim {
            2 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            _ => across(axis, dim),
        };
        Chart {
            surface: Surface::Cylinder,
            origin: centre,
            axes: [a, b, axis],
            radius,
            spacing,
            flat: dim == 2,
        }
    }

    /// Of a sphere; of a circle in the plane.
    pub fn sphere(centre: Vec3, radius: f64, dim: usize, spacing: f64) -> Self {
        let circle = Chart::cylinder(centre, [0.0, 0.0, 1.0], radius, dim, spacing);
        match dim {
            2 => circle,
            _ => Chart {
                surface: Surface::Sphere,
                ..circle
            },
        }
    }

    /// About how far places are apart `[m]`.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Curvature of the surface `[1/m]`.
    pub fn curvature(&self) -> f64 {
        match self.surface {
            Surface::Plane => 0.0,
            _ => 1.0 / self.radius,
        }
    }

    /// Distance of the rows: of a sphere as an angle.
    fn between_rows(&self) -> f64 {
        match self.surface {
            Surface::Sphere => PI / (PI * self.radius / self.spacing).round().max(2.0),
            _ => self.spacing,
        }
    }

    /// How many places a row has around an axis; `None` of one that has no end.
    fn count(&self, row: i32) -> Option<i32> {
        let radius = match self.surface {
            Surface::Plane => return None,
            Surface::Cylinder => self.radius,
            Surface::Sphere => self.radius * (f64::from(row) * self.between_rows()).sin(),
        };
        Some(((TAU * radius / self.spacing).round() as i32).max(1))
    }

    /// Distance of the places of a row, of what is round as an angle.
    fn step(&self, row: i32) -> f64 {
        self.count(row).map_or(self.spacing, |n| TAU / f64::from(n))
    }

    /// Where a point stands, its foot on the surface: between the rows, and along them as a distance or an angle.
    fn stands(&self, x: Vec3) -> [f64; 2] {
        let r = sub(x, self.origin);
        let [a, b, c] = self.axes.map(|e| dot(r, e));
        let [row, along] = match self.surface {
            Surface::Plane => [b, a],
            Surface::Cylinder => [c, b.atan2(a)],
            Surface::Sphere => [a.hypot(b).atan2(c), b.atan2(a)],
        };
        [
            if self.flat {
                0.0
            } else {
                row / self.between_rows()
            },
            along,
        ]
    }

    /// The places around a point, with weights that add up to one. Some may be zero.
    pub fn around(&self, x: Vec3) -> [(Place, f64); 4] {
        let [row, along] = self.stands(x);
        let part = row - row.floor();
        let low = row.floor() as i32;
        let mut out = [([0; 2], 0.0); 4];
        for (pair, (row, weight)) in out.chunks_mut(2).zip([(low, 1.0 - part), (low + 1, part)]) {
            let at = along / self.step(row);
            let further = at - at.floor();
            let first = at.floor() as i32;
            let number = |i: i32| self.count(row).map_or(i, |n| i.rem_euclid(n));
            pair[0] = ([row, number(first)], weight * (1.0 - further));
            pair[1] = ([row, number(first + 1)], weight * further);
        }
        out
    }

    /// Where a place is, or one that stands between places of its row.
    pub fn position(&self, row: i32, at: f64) -> Vec3 {
        let [a, b, c] = self.axes;
        let (along, up) = (at * self.step(row), f64::from(row) * self.between_rows());
        let out = |angle: f64| add_scaled(scale(angle.cos(), a), angle.sin(), b);
        let up = if self.flat { 0.0 } else { up };
        let way = match self.surface {
            Surface::Plane => add_scaled(scale(along, a), up, b),
            Surface::Cylinder => add_scaled(scale(self.radius, out(along)), up, c),
            Surface::Sphere => add_scaled(
                scale(self.radius * up.sin(), out(along)),
                self.radius * up.cos(),
                c,
            ),
        };
        add_scaled(self.origin, 1.0, way)
    }

    /// How far the places of a row are apart `[m]`.
    pub fn apart(&self, row: i32) -> f64 {
        let radius = match self.surface {
            Surface::Plane => 1.0,
            Surface::Cylinder => self.radius,
            Surface::Sphere => self.radius * (f64::from(row) * self.between_rows()).sin(),
        };
        radius * self.step(row)
    }

    /// The next place in the row and, where rows have as many places, that in the next row, each with its distance `[m]`.
    pub fn next(&self, [row, at]: Place) -> impl Iterator<Item = (Place, f64)> {
        let beside = self.count(row).map_or(at + 1, |n| (at + 1).rem_euclid(n));
        let above = !self.flat && self.surface != Surface::Sphere;
        let above = above.then_some(([row + 1, at], self.spacing));
        std::iter::once(([row, beside], self.apart(row))).chain(above)
    }

    /// Area of a place `[m²]`: the integral of its weight. `extent`: that out of the plane where there is one row, and by how much it grows with the radius.
    pub fn area(&self, [row, at]: Place, extent: [f64; 2]) -> f64 {
        if !self.flat {
            return match self.surface {
                Surface::Sphere => self.area_on_sphere(row),
                _ => self.apart(row) * self.spacing,
            };
        }
        let extent = |r: f64| extent[0] + extent[1] * r.max(0.0);
        let parts = PARTS_OF_AREA as f64;
        let mean: f64 = (0..2 * PARTS_OF_AREA)
            .map(|k| (k as f64 + 0.5) / parts - 1.0)
            .map(|t| (1.0 - t.abs()) / parts * extent(self.position(row, f64::from(at) + t)[0]))
            .sum();
        // A place on or beyond the axis has at least this part of the area of one far from it.
        self.apart(row) * mean.max(1e-3 * extent(self.spacing))
    }

    /// Zones between parallels, weighted as rows are, divided by their places.
    fn area_on_sphere(&self, row: i32) -> f64 {
        let step = self.between_rows();
        let last = (PI / step).round() as i32;
        let zone = match row == 0 || row == last {
            true => 1.0 - step.sin() / step,
            false => (f64::from(row) * step).sin() * 2.0 * (1.0 - step.cos()) / step,
        };
        let places = self.count(row).unwrap_or(1);
        TAU * self.radius * self.radius * zone / f64::from(places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::norm;

    fn charts() -> Vec<Chart> {
        let axis = normalize([0.2, 0.1, 1.0]).unwrap();
        vec![
            Chart::plane([0.1, 0.2, 0.3], axis, 3, 0.07),
            Chart::plane([0.1, 0.2, 0.3], axis, 3, 0.07).along([1.0, 1.0, 0.0]),
            Chart::cylinder([0.1, 0.2, 0.3], axis, 0.5, 3, 0.07),
            Chart::sphere([0.1, 0.2, 0.3], 0.5, 3, 0.07),
            Chart::plane([0.1, 0.2, 0.0], [0.6, 0.8, 0.0], 2, 0.07),
            Chart::sphere([0.0, 0.2, 0.0], 0.5, 2, 0.07),
        ]
    }

    #[test]
    fn a_place_stands_where_it_is_said_to() {
        for chart in charts() {
            for row in if chart.flat { 0..1 } else { 1..20 } {
                let found = chart.around(chart.position(row, 3.0));
                let weight = |place: Place| -> f64 {
                    let same = found.iter().filter(|(p, _)| *p == place);
                    same.map(|(_, w)| w).sum()
                };
                let at = chart.count(row).map_or(3, |n| 3 % n);
                assert!(
                    (weight([row, at]) - 1.0).abs() < 1e-9,
                    "{chart:?} {row} {found:?}"
                );
                let sum: f64 = found.iter().map(|(_, w)| w).sum();
                assert!((sum - 1.0).abs() < 1e-12);
            }
        }
    }

    /// The area of a sphere, of a ring, and of a ball's zone about an axis, each summed over its places.
    #[test]
    fn areas_of_places_make_up_the_surface() {
        let all = charts();
        let (sphere, round) = (&all[3], &all[5]);
        let rows = (PI / sphere.between_rows()).round() as i32;
        let whole: f64 = (0..=rows)
            .map(|row| f64::from(sphere.count(row).unwrap()) * sphere.area([row, 0], [1.0, 0.0]))
            .sum();
        assert!((whole / (4.0 * PI * 0.25) - 1.0).abs() < 1e-12, "{whole}");
        let count = round.count(0).unwrap();
        for (extent, exact, within) in [
            ([2.0, 0.0], 2.0 * PI, 1e-12),
            // Half of a circle makes the sphere.
            ([0.0, TAU], PI, 5e-3),
        ] {
            let sum: f64 = (0..count).map(|i| round.area([0, i], extent)).sum();
            assert!((sum / exact - 1.0).abs() < within, "{sum} {exact}");
        }
    }

    #[test]
    fn next_places_are_as_far_as_they_say() {
        for chart in charts() {
            let from = chart.position(1, 2.0);
            for ([row, at], far) in chart.next([1, 2]) {
                if chart.flat {
                    continue;
                }
                let way = norm(sub(chart.position(row, f64::from(at)), from));
                assert!((way / far - 1.0).abs() < 0.2, "{chart:?}: {way} {far}");
            }
        }
    }
}
