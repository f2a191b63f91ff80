//! The bodies painted onto a raster: faces, edges, and in a plane the strips along their surfaces.

use std::collections::BTreeSet;

use stickslip::io::vtu::PointFields;
use stickslip::math::cross;

use super::camera::{Camera, Frame, unit};
use super::raster::{Corner, FINE, Raster};
use super::words::{INK, SOFT};
use super::zoom::{self, Mirror};
use crate::colour::{self, Scale};
use crate::field::{self, Field};
use crate::obstacle::Outline;
use crate::skin::Skin;

type Vec3 = [f64; 3];

/// What is painted, and how.
pub struct Look {
    /// The bodies.
    pub skin: Skin,
    /// Which of them are drawn.
    pub shown: Vec<bool>,
    /// By how much each is moved aside `[length]`.
    pub offsets: Vec<Vec3>,
    /// The field in colour.
    pub field: Option<Field>,
    /// Its colours.
    pub colours: Scale,
    /// Factor of the displacements.
    pub scale: f64,
    /// From where one looks.
    pub camera: Camera,
    /// Planes of symmetry.
    pub mirrors: Vec<Mirror>,
    /// Rigid obstacles.
    pub obstacles: Vec<Outline>,
    /// Edges of the skin that are drawn where they are before any displacement.
    pub outline: Vec<[u32; 2]>,
}

/// The displacement of a point; zero where the file has none.
pub fn displacement(points: &PointFields, point: usize) -> Vec3 {
    match points.arrays.get("U").filter(|u| u.components == 3) {
        Some(u) => [0, 1, 2].map(|c| u.values[3 * point + c]),
        None => [0.0; 3],
    }
}

/// The points of a skin with so many times their displacements.
pub fn displaced(skin: &Skin, points: &PointFields, scale: f64) -> Vec<Vec3> {
    let all = skin.points.iter().zip(&skin.positions);
    all.map(|(&p, x)| {
        let u = displacement(points, p);
        [0, 1, 2].map(|c| x[c] + scale * u[c])
    })
    .collect()
}

/// The values at the points of a skin; NaN where there are none.
pub fn values(points: &PointFields, skin: &Skin, field: Option<&Field>) -> Vec<f64> {
    let array = field.and_then(|f| Some((f, points.arrays.get(&f.array)?)));
    // What is tied has no status in files.
    let tied = points.arrays.get("TNORMAL");
    let tied = tied.filter(|_| field.is_some_and(|f| f.name == field::STATUS));
    let value = |p: &usize| {
        let value = array.map_or(f64::NAN, |(f, array)| f.value(array, *p));
        match tied.is_some_and(|t| value.is_nan() && !t.values[*p].is_nan()) {
            true => colour::TIED as f64,
            false => value,
        }
    };
    skin.points.iter().map(value).collect()
}

impl Look {
    /// Whether a point of the skin is drawn.
    pub fn draws(&self, point: u32) -> bool {
        self.shown[self.skin.owner[point as usize] as usize]
    }

    /// The points of the skin where they are drawn, those that are not drawn too.
    pub fn moved(&self, points: &PointFields) -> Vec<Vec3> {
        let all = displaced(&self.skin, points, self.scale).into_iter();
        all.zip(0..).map(|(x, i)| self.beside(i, x)).collect()
    }

    /// A place on the body of a point, moved aside with it.
    fn beside(&self, point: u32, x: Vec3) -> Vec3 {
        let offset = self.offsets[self.skin.owner[point as usize] as usize];
        [0, 1, 2].map(|c| x[c] + offset[c])
    }

    /// The colours of these values: those of the field, and none where it is zero everywhere.
    pub fn colours_of(&self, values: &[f64]) -> Scale {
        let range = field::range(values.iter().copied());
        let zero = range == Some([0.0; 2]) && !self.colours.status;
        Scale {
            threshold: self.colours.threshold.or(zero.then_some(f64::MIN_POSITIVE)),
            ..self.colours
        }
    }

    /// The box of the picture's plane around what is drawn.
    pub fn bounds(&self, points: &PointFields) -> zoom::Box2 {
        let all = self.moved(points);
        let drawn = (0..all.len()).filter(|&i| self.draws(i as u32));
        zoom::around(drawn.map(|i| all[i]), &self.mirrors, &self.camera)
    }

    /// Paints the bodies at a time on a raster of this size so that a box of the picture's plane fills it; returns where points are on it, and that.
    pub fn paint(
        &self,
        points: &PointFields,
        time: f64,
        size: [usize; 2],
        bounds: zoom::Box2,
        em: f64,
    ) -> (Frame, Raster) {
        let fine = FINE as f64;
        let rim = 0.6 * em * fine;
        let room = [0, 1].map(|c| (size[c] as f64 - 2.0 * rim).max(1.0));
        let frame = Frame::fit(bounds[0], bounds[1], [rim, rim], room);
        let mut raster = Raster::new(size);
        let moved = self.moved(points);
        for seen in zoom::images(&self.mirrors) {
            self.image(points, &moved, &seen, &frame, &mut raster, em);
        }
        let still = self.outline.iter().filter(|e| self.draws(e[0]));
        for ends in still {
            let ends = ends.map(|i| self.beside(i, self.skin.positions[i as usize]));
            let ends = ends.map(|x| frame.place(self.camera.see(x)));
            raster.line(ends, 0.6 * fine, self.skin.size(), SOFT, 0.7);
        }
        for outline in &self.obstacles {
            // By the same factor as the bodies.
            let (from, to) = (outline.at(0.0), outline.at(time));
            let ends: Vec<Vec3> = from
                .iter()
                .zip(&to)
                .map(|(x, y)| [0, 1, 2].map(|c| x[c] + self.scale * (y[c] - x[c])))
                .map(|x| frame.place(self.camera.see(x)))
                .collect();
            for line in &outline.lines {
                let ends = line.map(|i| ends[i as usize]);
                raster.line(ends, 0.8 * fine, 0.0, SOFT, 0.8);
            }
        }
        (frame, raster)
    }

    /// Paints what these mirrors show of the bodies, the bodies themselves without any.
    fn image(
        &self,
        points: &PointFields,
        moved: &[Vec3],
        mirrors: &[Mirror],
        frame: &Frame,
        raster: &mut Raster,
        em: f64,
    ) {
        let fine = FINE as f64;
        let mut values = values(points, &self.skin, self.field.as_ref());
        let turns = |axis: usize| self.field.as_ref().is_some_and(|f| f.turns(axis));
        if mirrors.iter().filter(|(axis, _)| turns(*axis)).count() % 2 == 1 {
            values.iter_mut().for_each(|v| *v = -*v);
        }
        let moved: Vec<Vec3> = moved.iter().map(|x| zoom::image(*x, mirrors)).collect();
        let seen: Vec<Vec3> = (moved.iter())
            .map(|x| frame.place(self.camera.see(*x)))
            .collect();
        let flat = self.skin.dim == 2;
        let colours = self.colours_of(&values);
        for body in (0..self.skin.ends.len()).filter(|&b| self.shown[b]) {
            for t in self.skin.triangles_of(body) {
                let corners = t.map(|i| Corner {
                    at: seen[i as usize],
                    value: values[i as usize],
                });
                let light = if flat {
                    1.0
                } else {
                    self.light(t.map(|i| moved[i as usize]))
                };
                raster.triangle(corners, &colours, light.clamp(0.0, 1.0));
            }
        }
        // Edges lie in the faces: a little nearer, so that faces they bound do not hide them.
        let lift = 1e-3 * self.skin.size();
        for body in (0..self.skin.ends.len()).filter(|&b| self.shown[b]) {
            let edges = self.skin.edges_of(body);
            // Fine meshes would be black.
            let strength = (0.5 * spacing(&seen, edges) / (6.0 * fine)).clamp(0.06, 0.5);
            for e in edges {
                let ends = e.map(|i| seen[i as usize]);
                raster.line(ends, 0.5 * fine, lift, INK, strength);
            }
        }
        if flat && values.iter().any(|v| v.is_nan()) {
            let side = if mirrors.len() % 2 == 1 { -1.0 } else { 1.0 };
            self.strips(&seen, &values, side * 0.6 * em * fine, raster);
        }
    }

    /// How bright a triangle is.
    fn light(&self, [a, b, c]: [Vec3; 3]) -> f64 {
        let edge = |p: Vec3| [0, 1, 2].map(|k| p[k] - a[k]);
        let normal = unit(self.camera.see(cross(edge(b), edge(c))));
        0.70 + 0.26 * normal[2].abs() + 0.06 * normal[1] * normal[2].signum()
    }

    /// In a plane a surface is a line: the field of contact is drawn along it as a strip within the body, so that the two sides of a contact lie beside one another.
    /// `width`: its width in pixels; negative in a mirror, where the body is at the other side of its rim.
    fn strips(&self, seen: &[Vec3], values: &[f64], width: f64, raster: &mut Raster) {
        let front = self.skin.size();
        let pieces = strip_pieces(self, values);
        // The mean of both edges at a point: neighbours end at the same line.
        let mut inward = vec![[0.0; 2]; seen.len()];
        let edges: BTreeSet<[u32; 2]> = pieces.iter().map(|p| p.ends).collect();
        for ends in edges {
            let [a, b] = ends.map(|i| seen[i as usize]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
            for i in ends {
                // Pixels go down: the left of a line on paper, where the body is, is its upper side here.
                let sum = &mut inward[i as usize];
                *sum = [sum[0] + dy / length, sum[1] - dx / length];
            }
        }
        for piece in pieces {
            let [(a, n), (b, m)] = piece.ends.map(|i| {
                (
                    seen[i as usize],
                    unit([inward[i as usize][0], inward[i as usize][1], 0.0]),
                )
            });
            let at = |f: f64, deep: f64| {
                let x = |c: usize| a[c] + f * (b[c] - a[c]) + deep * (n[c] + f * (m[c] - n[c]));
                [x(0), x(1), front]
            };
            let [from, to] = piece.part.map(|f| at(f, 0.0));
            let [back, away] = piece.part.map(|f| at(f, width));
            let corner = |at: Vec3| Corner {
                at,
                value: piece.value,
            };
            raster.triangle([from, to, away].map(corner), &self.colours, 1.0);
            raster.triangle([from, away, back].map(corner), &self.colours, 1.0);
            raster.line([back, away], 0.12 * width.abs(), front, INK, 1.0);
            raster.line([from, to], 0.12 * width.abs(), front, INK, 1.0);
        }
    }
}

/// A piece of a strip that has one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The ends of the edge that it is a part of.
    pub ends: [u32; 2],
    /// Which part of the edge.
    pub part: [f64; 2],
    /// The value there.
    pub value: f64,
}

/// Pieces into which an edge of a strip is cut.
const CUTS: usize = 8;

/// The strips along surfaces of contact in a plane: where there is something to show. What a surface carries is shown where it carries something.
pub fn strip_pieces(look: &Look, values: &[f64]) -> Vec<Piece> {
    let known = |i: &u32| look.draws(*i) && !values[*i as usize].is_nan();
    let colours = look.colours_of(values);
    let mut pieces = Vec::new();
    for &ends in look.skin.rim.iter().filter(|e| e.iter().all(known)) {
        let [v, w] = ends.map(|i| values[i as usize]);
        for k in 0..CUTS {
            let f = (k as f64 + 0.5) / CUTS as f64;
            let value = match (colours.status, f < 0.5) {
                (true, true) => v,
                (true, false) => w,
                (false, _) => v + f * (w - v),
            };
            let empty = colours.carried && value <= 0.0;
            if !empty && !colours.nothing(value) {
                let part = [k, k + 1].map(|i| i as f64 / CUTS as f64);
                pieces.push(Piece { ends, part, value });
            }
        }
    }
    pieces
}

/// The mean length of edges on the picture.
fn spacing(seen: &[Vec3], edges: &[[u32; 2]]) -> f64 {
    let length = |e: &[u32; 2]| {
        let [a, b] = e.map(|i| seen[i as usize]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::Rgb;
    use crate::plot::camera::View;
    use stickslip::io::vtu::{Grid, PointArray};

    /// Two squares on one another, of which the lower carries 1 at its top and the upper less at its bottom.
    fn look(upper: f64, mirrors: Vec<Mirror>) -> (Look, Grid) {
        let x = |low: f64| {
            [
                [0., low, 0.],
                [1., low, 0.],
                [1., low + 1., 0.],
                [0., low + 1., 0.],
            ]
        };
        let mut grid = Grid::default();
        grid.points.points = [x(0.0), x(1.0)].concat();
        (grid.types, grid.offsets) = (vec![9, 9], vec![4, 8]);
        grid.connectivity = (0..8).collect();
        let none = f64::NAN;
        for (name, values) in [
            (
                "CPRESS",
                vec![none, none, 1.0, 1.0, upper, upper, none, none],
            ),
            ("BODY", vec![0.0, 1.0]),
        ] {
            let components = 1;
            let array = PointArray { components, values };
            let arrays = match name {
                "BODY" => &mut grid.cell_arrays,
                _ => &mut grid.points.arrays,
            };
            arrays.insert(name.into(), array);
        }
        let look = Look {
            skin: Skin::of(&grid),
            shown: vec![true; 2],
            offsets: vec![[0.0; 3]; 2],
            field: crate::field::fields(&grid.points.arrays).into_iter().next(),
            colours: Scale {
                range: [0.0, 1.0],
                carried: true,
                ..Scale::default()
            },
            scale: 1.0,
            camera: Camera::new(View::Iso, 2),
            mirrors,
            obstacles: Vec::new(),
            outline: Vec::new(),
        };
        (look, grid)
    }

    /// The colour so many pixels above the line between the squares, at a part of the width.
    fn above(look: &Look, grid: &Grid, part: f64, up: f64) -> Rgb {
        let bounds = look.bounds(&grid.points);
        let (frame, raster) = look.paint(&grid.points, 0.0, [200, 200], bounds, 10.0);
        let wide = bounds[0][0] + part * (bounds[1][0] - bounds[0][0]);
        let at = frame.place([wide, 1.0, 0.0]);
        let pixel = (at[1] - up) as usize * 200 + at[0] as usize;
        [0, 1, 2].map(|c| raster.pixels[4 * pixel + c])
    }

    #[test]
    fn both_sides_of_a_contact_are_seen_beside_one_another() {
        for mirrors in [vec![], vec![(0, 0.0)], vec![(0, 0.0), (1, 2.0)]] {
            let (look, grid) = look(0.25, mirrors);
            for part in [0.25, 0.7] {
                let colour = |value: f64| look.colours.colour(value);
                assert_eq!(above(&look, &grid, part, -6.0), colour(1.0));
                assert_eq!(above(&look, &grid, part, 6.0), colour(0.25));
                assert_eq!(above(&look, &grid, part, 40.0), colour::NOTHING);
            }
        }
    }

    #[test]
    fn what_carries_nothing_and_what_is_below_the_threshold_has_no_strip() {
        let (mut look, grid) = look(0.0, vec![]);
        let strips = |look: &Look| {
            let values = values(&grid.points, &look.skin, look.field.as_ref());
            strip_pieces(look, &values).len()
        };
        assert_eq!(strips(&look), CUTS);
        look.colours.carried = false;
        assert_eq!(strips(&look), 2 * CUTS);
        look.colours.threshold = Some(0.5);
        assert_eq!(strips(&look), CUTS);
        look.shown[0] = false;
        assert_eq!(strips(&look), 0);
    }
}
