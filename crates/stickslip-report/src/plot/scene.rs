//! The bodies with a field in colour, as one picture.

use stickslip::Error;
use stickslip::io::vtu::{self, Grid, PointFields};

use super::bodies::{self, Shown};
use super::camera::{Camera, Frame, cross, unit};
use super::marks;
use super::picture::{Picture, Zoom};
use super::raster::{Corner, FINE, Raster};
use super::words::{INK, SOFT, shorten};
use super::{axis, legend, zoom};
use crate::colour::Scale;
use crate::draw::{Anchor, Canvas, Pen};
use crate::field::{self, Field};
use crate::obstacle::{self, Outline};
use crate::results::{Results, fault};
use crate::sheet::Sheet;
use crate::skin::Skin;
use crate::units::{Units, behind};

/// What is the same for all times: geometry, camera, colours.
pub struct Scene<'a> {
    results: &'a Results,
    skin: Skin,
    shown: Shown,
    field: Option<Field>,
    colours: Scale,
    scale: f64,
    camera: Camera,
    obstacles: Vec<Outline>,
    /// The box of the picture's plane that holds the bodies at all times.
    bounds: zoom::Box2,
    /// The part of it that is seen.
    seen: zoom::Box2,
    /// Axis and place of a plane of symmetry.
    mirror: Option<(usize, f64)>,
    /// Whether tractions are drawn as arrows.
    arrows: bool,
    units: Units,
    /// What was chosen for the reader.
    pub notes: Vec<String>,
}

fn displacement(points: &PointFields, point: usize) -> [f64; 3] {
    match points.arrays.get("U").filter(|u| u.components == 3) {
        Some(u) => [0, 1, 2].map(|c| u.values[3 * point + c]),
        None => [0.0; 3],
    }
}

fn choose(results: &Results, grid: &Grid, name: Option<&str>) -> Result<Option<Field>, Error> {
    let list = field::fields(&grid.points.arrays);
    let Some(name) = name else {
        // Rigid bodies have no stress.
        let says = |name: &&'static str| {
            let field = list.iter().find(|f| f.name == **name);
            field.is_some_and(|f| {
                let array = &grid.points.arrays[&f.array];
                let values = (0..grid.points.points.len()).map(|p| f.value(array, p));
                field::range(values).is_some_and(|[low, high]| high > low)
            })
        };
        // What contact does comes first, where it does anything.
        let name = ["CPRESS", "MISES", "U"].into_iter().find(says);
        let named = |name: &str| list.iter().find(|f| f.name == name).cloned();
        let chosen = name.and_then(named).or_else(|| named("U"));
        return Ok(chosen.or_else(|| list.first().cloned()));
    };
    let found = list
        .iter()
        .find(|f| f.name == name)
        .or_else(|| list.iter().find(|f| f.name.eq_ignore_ascii_case(name)));
    match found {
        Some(field) => Ok(Some(field.clone())),
        None => {
            let names: Vec<&str> = list.iter().map(|f| f.name.as_str()).collect();
            let meant = match stickslip::problem::nearest(name, &names) {
                Some(meant) => format!("did you mean `{meant}`? "),
                None => String::new(),
            };
            Err(fault(
                &results.directory,
                format!(
                    "there is no field `{name}`; {meant}there are {}",
                    names.join(", ")
                ),
            ))
        }
    }
}

/// What is the same for all the times that are drawn.
struct Extremes {
    /// Least and largest value of the field; zeros where there is none.
    range: [f64; 2],
    /// Largest displacement.
    largest: f64,
}

impl Extremes {
    fn of(
        results: &Results,
        frames: &[usize],
        grid: &Grid,
        skin: &Skin,
        field: Option<&Field>,
    ) -> Result<Self, Error> {
        let (mut range, mut largest) = (None::<[f64; 2]>, 0.0f64);
        for &frame in frames {
            let file = &results.frames[frame].file;
            let points = vtu::read(file)?;
            if points.points.len() != grid.points.points.len() {
                return Err(fault(
                    file,
                    "it has another number of points than the first file that is drawn",
                ));
            }
            let values = values(&points, skin, field);
            if let Some([low, high]) = field::range(values.into_iter()) {
                let [l, h] = range.unwrap_or([low, high]);
                range = Some([l.min(low), h.max(high)]);
            }
            for &p in &skin.points {
                let u = displacement(&points, p);
                largest = largest.max(u.iter().map(|v| v * v).sum::<f64>().sqrt());
            }
        }
        let range = range.unwrap_or([0.0; 2]);
        Ok(Extremes { range, largest })
    }
}

impl<'a> Scene<'a> {
    /// Reads what is to be drawn at these times.
    pub fn new(results: &'a Results, wanted: &Picture, frames: &[usize]) -> Result<Self, Error> {
        let mut grid = results.grid(frames[0])?;
        let whole = Skin::of(&grid);
        if let Some(plane) = wanted.cut {
            let [low, high] = whole.bounds();
            let middle = (low[plane.axis] + high[plane.axis]) / 2.0;
            zoom::keep_below(&mut grid, plane.axis, plane.at.unwrap_or(middle));
        }
        let skin = Skin::of(&grid);
        if skin.triangles.is_empty() {
            return Err(fault(
                &results.frames[frames[0]].file,
                match wanted.cut {
                    Some(_) => "the cut leaves no cell: its place is below the bodies",
                    None => "it has no cells that could be drawn",
                },
            ));
        }
        let field = choose(results, &grid, wanted.field.as_deref())?;
        let mut notes = Vec::new();
        let Extremes { range, largest } =
            Extremes::of(results, frames, &grid, &skin, field.as_ref())?;
        let sheets: Vec<Vec<Sheet>> = (frames.iter())
            .map(|&frame| results.sheets(frame))
            .collect::<Result<_, Error>>()?;
        let contact = field.as_ref().is_some_and(Field::of_contact);
        let scale = match (wanted.scale, contact) {
            (Some(scale), _) => scale,
            // Where contact is looked at nothing is moved to where it is not.
            (None, true) => 1.0,
            (None, false) => zoom::scale(skin.size(), largest, sheets.iter().flatten()),
        };
        let (range, signed) = field::span_of(field.as_ref(), range);
        let colours = Scale {
            range,
            signed,
            status: field.as_ref().is_some_and(|f| f.name == field::STATUS),
            carried: field.as_ref().is_some_and(Field::carried),
        };
        let first = values(&grid.points, &skin, field.as_ref());
        let names = results.bodies(skin.ends.len());
        let shown = bodies::choose(&skin, &names, wanted, &first)
            .map_err(|message| fault(&results.directory, message))?;
        notes.extend(shown.notes.iter().cloned());
        let camera = Camera::new(shown.view, skin.dim);
        let mirror = wanted.mirror.map(|plane| {
            let [low, high] = whole.bounds().map(|x| x[plane.axis]);
            let near = if low.abs() <= high.abs() { low } else { high };
            (plane.axis, plane.at.unwrap_or(near))
        });
        let box_of = |points: &PointFields, bounds: &mut zoom::Box2| {
            for (local, &p) in skin.points.iter().enumerate() {
                if !shown.bodies[skin.owner[local] as usize] {
                    continue;
                }
                let u = displacement(points, p);
                let x = [0, 1, 2].map(|c| skin.positions[local][c] + scale * u[c]);
                for x in zoom::copies(x, mirror) {
                    zoom::include(bounds, camera.see(x));
                }
            }
        };
        let mut bounds = zoom::NOTHING;
        for &frame in frames {
            box_of(&vtu::read(&results.frames[frame].file)?, &mut bounds);
        }
        let patch = zoom::patch(sheets.iter().flatten(), scale, mirror, &camera);
        let nearer = match wanted.zoom {
            Zoom::Auto if !contact => Zoom::Whole,
            nearer => nearer,
        };
        let middle = wanted.at.map(|x| camera.see(x));
        let seen =
            zoom::seen(bounds, patch, nearer, middle).map_err(|m| fault(&results.directory, m))?;
        let given = wanted.units.clone();
        let arrows = wanted.arrows.unwrap_or(contact && skin.dim == 2);
        let obstacles = obstacle::outlines(&results.problem, &skin);
        Ok(Scene {
            obstacles,
            results,
            skin,
            shown,
            field,
            colours,
            scale,
            camera,
            bounds,
            seen,
            mirror,
            arrows,
            units: given.unwrap_or_else(|| Units::of(results)),
            notes,
        })
    }

    /// Draws one of the times.
    pub fn draw(&self, frame: usize, size: [u32; 2], canvas: &mut dyn Canvas) -> Result<(), Error> {
        let points = vtu::read(&self.results.frames[frame].file)?;
        let [width, height] = size.map(f64::from);
        // All texts grow with the picture.
        let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
        let bar = 11.0 * em;
        let (top, margin) = (4.4 * em, 1.6 * em);
        let at = [margin, top];
        let area = [width - bar - 2.0 * margin, height - top - 2.6 * em];
        let area = area.map(|n| n.max(16.0));
        let sheets = self.results.sheets(frame)?;
        let (place, raster) = self.bodies(frame, &points, [at, area], self.seen, em, canvas);
        let behind_by = 0.02 * self.skin.size();
        let drawn = marks::Drawn {
            see: &|x| place.place(self.camera.see(x)),
            // In a plane nothing is behind anything.
            hides: &|seen| self.skin.dim == 3 && raster.hides(seen, behind_by),
            scale: self.scale,
            at,
            area,
            em,
        };
        if self.arrows {
            marks::arrows(&sheets, &drawn, self.skin.dim, canvas);
        }
        if self.field.as_ref().is_some_and(|f| f.array == "CPRESS") {
            let (x, most) = self.most(&points);
            marks::peak(x, most, &sheets, &drawn, &self.units, canvas);
        }
        self.headline(frame, em, [margin, width - 2.0 * margin], canvas);
        if let Some(field) = &self.field {
            let x = width - bar - 0.4 * em;
            let values = values(&points, &self.skin, Some(field));
            let shown = legend::Shown {
                field,
                unit: &behind(self.units.of_field(field)),
                colours: &self.colours,
                values: &values,
            };
            legend::bar(
                &shown,
                [x, top + 0.5 * em],
                [
                    bar,
                    if self.seen == self.bounds {
                        area[1]
                    } else {
                        area[1] - 11.0 * em
                    },
                ],
                em,
                canvas,
            );
        }
        if self.seen != self.bounds {
            let size = [bar - 1.4 * em, 9.0 * em];
            let corner = [width - bar - 0.4 * em, height - 2.6 * em - size[1]];
            self.inset(frame, &points, [corner, size], em, canvas);
        }
        legend::triad(
            &self.camera,
            self.skin.dim,
            [margin + 2.2 * em, height - 2.6 * em],
            em,
            canvas,
        );
        Ok(())
    }

    /// Title and time, from the left margin over a width.
    fn headline(&self, frame: usize, em: f64, [margin, width]: [f64; 2], canvas: &mut dyn Canvas) {
        let title = self.results.title();
        let title = shorten(&title, 1.35 * em, width);
        canvas.text(
            [margin, 2.1 * em],
            &title,
            1.35 * em,
            Anchor::Start,
            INK,
            false,
        );
        let time = self.results.frames[frame].time;
        let mut line = format!("time {}", axis::number(time, 5));
        if self.scale != 1.0 {
            line += &format!(", displacements × {}", axis::number(self.scale, 4));
        }
        if let Some(words) = &self.shown.words {
            line += &format!(", {words}");
        }
        let line = shorten(&line, em, width);
        canvas.text([margin, 3.6 * em], &line, em, Anchor::Start, SOFT, false);
    }

    /// The whole, small, with a frame around what is seen of it.
    fn inset(
        &self,
        frame: usize,
        points: &PointFields,
        [corner, size]: [[f64; 2]; 2],
        em: f64,
        canvas: &mut dyn Canvas,
    ) {
        let area = [corner, size];
        let (place, _) = self.bodies(frame, points, area, self.bounds, 0.35 * em, canvas);
        let [low, high] = self.seen.map(|x| place.place([x[0], x[1], 0.0]));
        let fine = FINE as f64;
        let [x0, x1] =
            [low, high].map(|x| (corner[0] + x[0] / fine).clamp(corner[0], corner[0] + size[0]));
        let [y0, y1] =
            [low, high].map(|x| (corner[1] + x[1] / fine).clamp(corner[1], corner[1] + size[1]));
        let line = [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]];
        canvas.line(&line, Pen::new([209, 73, 91], 0.18 * em));
    }

    /// Where the largest value of the field is on the bodies that are drawn, and that value; nothing less than zero.
    fn most(&self, points: &PointFields) -> ([f64; 3], f64) {
        let values = values(points, &self.skin, self.field.as_ref());
        let mut best = ([0.0; 3], 0.0);
        for (i, &p) in self.skin.points.iter().enumerate() {
            // Of values that are alike the first.
            if self.shown.bodies[self.skin.owner[i] as usize] && values[i] > best.1 * (1.0 + 1e-9) {
                let (x, u) = (self.skin.positions[i], displacement(points, p));
                best = ([0, 1, 2].map(|c| x[c] + self.scale * u[c]), values[i]);
            }
        }
        best
    }

    /// Paints the bodies into a rectangle so that a box of the picture's plane fills it; returns where points are on its raster, and that.
    fn bodies(
        &self,
        number: usize,
        points: &PointFields,
        [at, area]: [[f64; 2]; 2],
        bounds: zoom::Box2,
        em: f64,
        canvas: &mut dyn Canvas,
    ) -> (Frame, Raster) {
        let fine = FINE as f64;
        let size = area.map(|n| (n * fine) as usize);
        let rim = 0.6 * em * fine;
        let room = [0, 1].map(|c| (size[c] as f64 - 2.0 * rim).max(1.0));
        let frame = Frame::fit(bounds[0], bounds[1], [rim, rim], room);
        let mut raster = Raster::new(size);
        self.paint(points, &frame, &mut raster, em, false);
        if self.mirror.is_some() {
            self.paint(points, &frame, &mut raster, em, true);
        }
        let time = self.results.frames[number].time;
        for outline in &self.obstacles {
            // By the same factor as the bodies.
            let (from, to) = (outline.at(0.0), outline.at(time));
            let ends: Vec<[f64; 3]> = from
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
        canvas.picture(at, size, FINE, &raster.pixels);
        (frame, raster)
    }

    /// Paints the bodies, or what a mirror shows of them.
    fn paint(
        &self,
        points: &PointFields,
        frame: &Frame,
        raster: &mut Raster,
        em: f64,
        mirrored: bool,
    ) {
        let fine = FINE as f64;
        let mut values = values(points, &self.skin, self.field.as_ref());
        let mirror = self.mirror.filter(|_| mirrored);
        if mirror.is_some_and(|(axis, _)| self.field.as_ref().is_some_and(|f| f.turns(axis))) {
            values.iter_mut().for_each(|v| *v = -*v);
        }
        let moved: Vec<[f64; 3]> = (self.skin.points.iter())
            .zip(&self.skin.positions)
            .map(|(&p, x)| {
                let u = displacement(points, p);
                let x = [0, 1, 2].map(|c| x[c] + self.scale * u[c]);
                zoom::image(x, mirror)
            })
            .collect();
        let seen: Vec<[f64; 3]> = (moved.iter())
            .map(|x| frame.place(self.camera.see(*x)))
            .collect();
        let flat = self.skin.dim == 2;
        for body in (0..self.skin.ends.len()).filter(|&b| self.shown.bodies[b]) {
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
                raster.triangle(corners, &self.colours, light.clamp(0.0, 1.0));
            }
        }
        // Edges lie in the faces: a little nearer, so that faces they bound do not hide them.
        let lift = 1e-3 * self.skin.size();
        for body in (0..self.skin.ends.len()).filter(|&b| self.shown.bodies[b]) {
            let edges = self.skin.edges_of(body);
            // Fine meshes would be black.
            let strength = (0.5 * spacing(&seen, edges) / (6.0 * fine)).clamp(0.06, 0.5);
            for e in edges {
                let ends = e.map(|i| seen[i as usize]);
                raster.line(ends, 0.5 * fine, lift, INK, strength);
            }
        }
        if flat && values.iter().any(|v| v.is_nan()) {
            self.rim(&seen, &values, em, raster);
        }
    }

    /// How bright a triangle is.
    fn light(&self, [a, b, c]: [[f64; 3]; 3]) -> f64 {
        let edge = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
        let normal = unit(self.camera.see(cross(edge(b), edge(c))));
        0.70 + 0.26 * normal[2].abs() + 0.06 * normal[1] * normal[2].signum()
    }

    /// In a plane a surface is a line: the field of contact is drawn along it as a ribbon.
    fn rim(&self, seen: &[[f64; 3]], values: &[f64], em: f64, raster: &mut Raster) {
        let width = 0.45 * em * FINE as f64;
        let front = self.skin.size();
        let visible = |i: u32| self.shown.bodies[self.skin.owner[i as usize] as usize];
        let pieces = self
            .skin
            .rim
            .iter()
            .filter(|e| visible(e[0]) && e.iter().all(|i| !values[*i as usize].is_nan()));
        let pieces: Vec<&[u32; 2]> = pieces.collect();
        for &&[a, b] in &pieces {
            let ends = [seen[a as usize], seen[b as usize]];
            raster.line(ends, 1.35 * width, front, INK, 1.0);
        }
        const CUTS: usize = 8;
        for &&[a, b] in &pieces {
            let (x, y) = (seen[a as usize], seen[b as usize]);
            let (v, w) = (values[a as usize], values[b as usize]);
            for k in 0..CUTS {
                let at = |i: usize| {
                    let f = i as f64 / CUTS as f64;
                    [0, 1, 2].map(|c| x[c] + f * (y[c] - x[c]))
                };
                let f = (k as f64 + 0.5) / CUTS as f64;
                let value = match self.colours.status {
                    true => {
                        if f < 0.5 {
                            v
                        } else {
                            w
                        }
                    }
                    false => v + f * (w - v),
                };
                let ink = self.colours.colour(value);
                raster.line([at(k), at(k + 1)], width, front, ink, 1.0);
            }
        }
    }
}

/// The values at the points of a skin; NaN where there are none.
fn values(points: &PointFields, skin: &Skin, field: Option<&Field>) -> Vec<f64> {
    let array = field.and_then(|f| Some((f, points.arrays.get(&f.array)?)));
    let value = |p: &usize| {
        array.map_or(f64::NAN, |(f, array)| match f.component {
            Some(c) if c >= array.components => f64::NAN,
            _ => f.value(array, *p),
        })
    };
    skin.points.iter().map(value).collect()
}

/// The mean length of edges on the picture.
fn spacing(seen: &[[f64; 3]], edges: &[[u32; 2]]) -> f64 {
    let length = |e: &[u32; 2]| {
        let [a, b] = e.map(|i| seen[i as usize]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64
}
