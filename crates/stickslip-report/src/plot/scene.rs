//! The bodies with a field in colour, as one picture.

use std::collections::BTreeMap;
use std::path::Path;

use stickslip::Error;
use stickslip::io::vtu::{Grid, PointFields};

use super::apart::{self, Contact, Stage};
use super::bodies::{self, Arrangement, Known, Shown};
use super::camera::{Camera, Frame};
use super::facts::Facts;
use super::marks;
use super::paint::{self, Look, displaced, displacement, values};
use super::picture::{Picture, Zoom};
use super::raster::{FINE, Raster};
use super::symbols::{self, Acting, Acts, Symbol};
use super::words::{INK, SOFT, shorten};
use super::{axis, legend, script, statistics, zoom};
use crate::colour::Scale;
use crate::draw::{Anchor, Canvas, Pen};
use crate::field::{self, Field};
use crate::obstacle;
use crate::results::{Results, fault};
use crate::sheet::Sheet;
use crate::skin::Skin;
use crate::units::{Units, behind};

/// What is the same for all times: geometry, camera, colours.
pub struct Scene<'a> {
    results: &'a Results,
    look: Look,
    /// For the caption.
    words: Option<String>,
    /// What touches.
    contacts: Vec<Contact>,
    in_view: Option<f64>,
    /// Whether colours were given, and whether they leave values out.
    given: bool,
    /// The box of the picture's plane that holds the bodies at all times.
    bounds: zoom::Box2,
    /// The part of it that is seen.
    seen: zoom::Box2,
    /// Supports and loads, where they are drawn.
    acting: Option<Acting>,
    /// Whether tractions are drawn as arrows.
    arrows: bool,
    units: Units,
    /// The axis and the place below which cells are drawn.
    cut: Option<(usize, f64)>,
    /// What was chosen for the reader.
    pub notes: Vec<String>,
}

/// The field that is named, or that pictures show if none is.
pub fn choose(results: &Results, grid: &Grid, name: Option<&str>) -> Result<Option<Field>, Error> {
    let list = field::with_invariants(&grid.points.arrays);
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
    match field::named(&list, name) {
        Some(field) => Ok(Some(field)),
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

/// The largest displacement at these times, of files that all have the points of the first.
fn largest(results: &Results, frames: &[usize], grid: &Grid, skin: &Skin) -> Result<f64, Error> {
    let mut largest = 0.0f64;
    for &frame in frames {
        let file = &results.frames[frame].file;
        let points = results.points(frame)?;
        if points.points.len() != grid.points.points.len() {
            return Err(fault(
                file,
                "it has another number of points than the first file that is drawn",
            ));
        }
        for &p in &skin.points {
            let u = displacement(&points, p);
            largest = largest.max(u.iter().map(|v| v * v).sum::<f64>().sqrt());
        }
    }
    Ok(largest)
}

/// What can be seen, the whole that it was cut from, and the axis and place below which cells are left.
struct Skins {
    skin: Skin,
    whole: Skin,
    cut: Option<(usize, f64)>,
}

/// What can be seen, and the whole that it was cut from.
fn skins(
    results: &Results,
    wanted: &Picture,
    grid: &mut Grid,
    frame: usize,
) -> Result<Skins, Error> {
    let whole = Skin::of(grid);
    let cut = wanted.cut.map(|plane| {
        let [low, high] = whole.bounds();
        let middle = (low[plane.axis] + high[plane.axis]) / 2.0;
        (plane.axis, plane.at.unwrap_or(middle))
    });
    if let Some((axis, at)) = cut {
        zoom::keep_below(grid, axis, at);
    }
    let skin = Skin::of(grid);
    if skin.triangles.is_empty() {
        return Err(fault(
            &results.frames[frame].file,
            match wanted.cut {
                Some(_) => "the cut leaves no cell: its place is below the bodies",
                None => "it has no cells that could be drawn",
            },
        ));
    }
    Ok(Skins { skin, whole, cut })
}

impl<'a> Scene<'a> {
    /// Reads what is to be drawn at these times.
    pub fn new(results: &'a Results, wanted: &Picture, frames: &[usize]) -> Result<Self, Error> {
        let mut grid = results.grid(frames[0])?;
        let Skins { skin, whole, cut } = skins(results, wanted, &mut grid, frames[0])?;
        let field = choose(results, &grid, wanted.field.as_deref())?;
        let sheets: Vec<Vec<Sheet>> = (frames.iter())
            .map(|&frame| results.sheets(frame))
            .collect::<Result<_, Error>>()?;
        let contact = field.as_ref().is_some_and(Field::of_contact);
        let largest = largest(results, frames, &grid, &skin)?;
        let scale = match (wanted.scale, contact) {
            (Some(scale), _) => scale,
            // Where contact is looked at nothing is moved to where it is not.
            (None, true) => 1.0,
            (None, false) if wanted.mode.is_some() => zoom::of_shape(skin.size(), largest),
            (None, false) => zoom::scale(skin.size(), largest, sheets.iter().flatten()),
        };
        let mirrors: Vec<zoom::Mirror> = (wanted.mirrors.iter())
            .map(|plane| {
                let [low, high] = whole.bounds().map(|x| x[plane.axis]);
                let near = if low.abs() <= high.abs() { low } else { high };
                (plane.axis, plane.at.unwrap_or(near))
            })
            .collect();
        let moved = displaced(&skin, &grid.points, scale);
        let contacts = field.as_ref().map_or_else(Vec::new, |field| {
            apart::contacts(&skin, &grid.points, field, &sheets[0], &moved, scale)
        });
        let units = match (&wanted.units, wanted.mode.is_some()) {
            (Some(units), _) => units.clone(),
            (None, true) => Units::default(),
            (None, false) => Units::of(results),
        };
        let known = Known {
            length: &units.length,
            names: &results.bodies(skin.ends.len()),
            values: &values(&grid.points, &skin, field.as_ref()),
            stage: Stage {
                skin: &skin,
                bodies: &vec![true; skin.ends.len()],
                moved: &moved,
                mirrors: &mirrors,
            },
            contacts: &contacts,
        };
        let chosen = bodies::choose(&known, wanted);
        let shown = chosen.map_err(|message| fault(&results.directory, message))?;
        let Shown { bodies, view, .. } = shown;
        let (acting, mut notes) = (wanted.loads)
            .then(|| Acting::read(results, grid.points.points.len()))
            .map_or((None, Vec::new()), |read| match read {
                Ok(acting) => (Some(acting), Vec::new()),
                Err(why) => (None, vec![why]),
            });
        notes.extend(shown.notes);
        let look = Look {
            outline: match wanted.loads {
                true => symbols::outline(&skin),
                false => Vec::new(),
            },
            obstacles: obstacle::outlines(&results.problem, &skin),
            camera: Camera::new(view, skin.dim),
            shown: bodies,
            offsets: shown.offsets,
            skin,
            field,
            colours: Scale::default(),
            scale,
            mirrors,
        };
        let mut scene = Scene {
            results,
            look,
            words: shown.words,
            contacts,
            in_view: shown.in_view,
            given: wanted.colours.range.is_some(),
            bounds: zoom::EMPTY_BOX,
            seen: zoom::EMPTY_BOX,
            acting,
            arrows: wanted.arrows.unwrap_or(contact && whole.dim == 2),
            units,
            cut,
            notes,
        };
        scene.survey(wanted, frames, &sheets)?;
        Ok(scene)
    }

    /// How the bodies are arranged in space.
    pub fn arrangement(&self) -> Option<Arrangement> {
        let Look {
            skin,
            shown,
            offsets,
            camera,
            ..
        } = &self.look;
        (skin.dim == 3).then(|| Arrangement {
            bodies: shown.clone(),
            offsets: offsets.clone(),
            view: camera.out,
        })
    }

    /// Chooses colours, and which part is seen, from all times.
    fn survey(
        &mut self,
        wanted: &Picture,
        frames: &[usize],
        sheets: &[Vec<Sheet>],
    ) -> Result<(), Error> {
        let look = &self.look;
        let field = look.field.as_ref();
        let (mut all, mut bounds) = (Vec::new(), zoom::EMPTY_BOX);
        for &frame in frames {
            let points = self.results.points(frame)?;
            let values = values(&points, &look.skin, field);
            let weights = statistics::weights(&look.skin, &values, &look.shown);
            let drawn = (0..values.len()).filter(|&i| look.draws(i as u32));
            let moved = look.moved(&points);
            all.extend(drawn.map(|i| (look.camera.see(moved[i]), [values[i], weights[i]])));
            let [low, high] = look.bounds(&points);
            for c in 0..2 {
                bounds[0][c] = f64::min(bounds[0][c], low[c]);
                bounds[1][c] = f64::max(bounds[1][c], high[c]);
            }
        }
        if self.acting.is_some() {
            // Room for symbols.
            let room = 0.08
                * (0..2)
                    .map(|c| bounds[1][c] - bounds[0][c])
                    .fold(0.0, f64::max);
            bounds = [bounds[0].map(|x| x - room), bounds[1].map(|x| x + room)];
        }
        let contact = field.is_some_and(Field::of_contact);
        let patch = (sheets.iter().flatten()).flat_map(|sheet| {
            let places = sheet
                .pressing()
                .into_iter()
                .flat_map(|i| self.places(sheet, i));
            places.collect::<Vec<_>>()
        });
        let patch = zoom::around(patch, &look.mirrors, &look.camera);
        let nearer = match wanted.zoom {
            Zoom::Auto if !contact => Zoom::Whole,
            nearer => nearer,
        };
        let middle = wanted.at.map(|x| look.camera.see(x));
        let seen = zoom::seen(bounds, patch, nearer, middle);
        let seen = seen.map_err(|m| fault(&self.results.directory, m))?;
        let carried = field.is_some_and(Field::carried);
        if carried {
            // Of what a surface carries the part that carries counts.
            all.retain(|(_, [value, _])| *value != 0.0);
        }
        // Colours are for what is in the picture.
        let inside = |x: [f64; 3]| (0..2).all(|c| (seen[0][c]..=seen[1][c]).contains(&x[c]));
        if all.iter().any(|(x, _)| inside(*x)) {
            all.retain(|(x, _)| inside(*x));
        }
        let all = all.into_iter().map(|(_, value)| value).collect();
        let robust = statistics::robust(all, carried).unwrap_or([0.0; 2]);
        let (range, signed) = field::span_of(field, robust);
        let colours = Scale {
            range: wanted.colours.range.unwrap_or(range),
            // Zero is in the middle of what is given only where both ends are as far from it.
            signed: wanted
                .colours
                .range
                .map_or(signed, |[low, high]| low == -high),
            status: field.is_some_and(|f| f.name == field::STATUS),
            carried,
            bands: wanted.colours.bands,
            threshold: wanted.colours.threshold,
        };
        (self.bounds, self.seen, self.look.colours) = (bounds, seen, colours);
        Ok(())
    }

    /// Where a point of contact is drawn: on its own body and on the one opposite, those of them that are drawn and face the eye.
    fn places(&self, sheet: &Sheet, point: usize) -> Vec<[f64; 3]> {
        let x = sheet.place(point, self.look.scale);
        let contact = self.contacts.iter().find(|c| c.name == sheet.name);
        let Some(contact) = contact else {
            return vec![x];
        };
        let normal = self.look.camera.see(sheet.vector("CNORMAL", point));
        // The normal points out of the body opposite.
        let sides = contact.bodies.into_iter().zip([-1.0, 1.0]);
        let faces = |side: f64| self.look.skin.dim == 2 || side * normal[2] > 0.0;
        sides
            .filter_map(|(body, side)| body.filter(|&b| self.look.shown[b] && faces(side)))
            .map(|body| [0, 1, 2].map(|c| x[c] + self.look.offsets[body][c]))
            .collect()
    }

    /// The point that presses most where a side of it is drawn, and its pressure.
    fn peak<'s>(&self, sheets: &'s [Sheet], time: f64) -> Option<(&'s Sheet, usize, f64)> {
        let field = self.look.field.as_ref();
        if field.is_none_or(|f| f.array != "CPRESS") {
            return None;
        }
        let peaks = sheets.iter().filter_map(|sheet| {
            let (point, most) = sheet.peak()?;
            let most = self.results.peak_at(&sheet.name, time).unwrap_or(most);
            (!self.places(sheet, point).is_empty()).then_some((sheet, point, most))
        });
        // Of values that are alike the first.
        peaks.reduce(|best, next| {
            if next.2 > best.2 * (1.0 + 1e-9) {
                next
            } else {
                best
            }
        })
    }

    /// What is said of one of the times.
    fn facts(&self, frame: usize, points: &PointFields, sheets: &[Sheet]) -> Facts {
        let Look { skin, colours, .. } = &self.look;
        let values = values(points, skin, self.look.field.as_ref());
        let drawn = (0..values.len()).filter(|&i| self.look.draws(i as u32));
        let extremes = field::range(drawn.clone().map(|i| values[i]));
        let mut facts = Facts {
            time: self.results.frames[frame].time,
            factor: self.look.scale,
            field: self.look.field.as_ref().map(|f| f.name.clone()),
            range: colours.range,
            extremes,
            in_view: self.in_view,
            acts: self
                .acting
                .as_ref()
                .map(|a| Acts::of(&a.at(self.results.frames[frame].time))),
            statuses: match self.results.frames[frame].phase {
                Some(_) => None,
                None => self.results.statuses_at(self.results.frames[frame].time),
            },
            strips: paint::strip_pieces(&self.look, &values).len(),
            ..Facts::default()
        };
        let names = self.results.bodies(skin.ends.len()).into_iter();
        let shown = (names.zip(&self.look.offsets)).zip(&self.look.shown);
        let shown = shown.filter(|(_, drawn)| **drawn);
        (facts.bodies, facts.offsets) = shown.map(|((name, x), _)| (name, *x)).unzip();
        let most = extremes.map_or(f64::NAN, |e| e[1]);
        if let Some(i) = drawn.clone().find(|&i| values[i] == most) {
            let u = displacement(points, skin.points[i]);
            facts.place = [0, 1, 2].map(|c| skin.positions[i][c] + u[c]);
        }
        // What points of contact have, not means over those of a node.
        if let (Some((sheet, point, most)), Some(extremes)) =
            (self.peak(sheets, facts.time), &mut facts.extremes)
        {
            (facts.peak, extremes[1], facts.place) = (Some(most), most, sheet.place(point, 1.0));
        }
        // Rounding is no place.
        let small = 1e-4 * skin.size();
        facts.place = facts.place.map(|x| if x.abs() < small { 0.0 } else { x });
        if !colours.status {
            facts.words = facts.said(self.given, skin.dim);
        }
        facts
    }

    /// A script at `file` that draws one of the times with PyVista.
    pub fn script(&self, frame: usize, wanted: &Picture, file: &Path) -> String {
        let drawn = script::Drawn {
            look: &self.look,
            wanted,
            frame: &self.results.frames[frame],
            names: &self.results.bodies(self.look.skin.ends.len()),
            title: &self.results.title(),
            cut: self.cut,
        };
        script::text(&drawn, file)
    }

    /// Draws one of the times, and returns what the picture says.
    pub fn draw(
        &self,
        frame: usize,
        size: [u32; 2],
        canvas: &mut dyn Canvas,
    ) -> Result<Facts, Error> {
        let points = self.results.points(frame)?;
        let [width, height] = size.map(f64::from);
        // All texts grow with the picture.
        let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
        let bar = 11.0 * em;
        let (top, margin) = (4.4 * em, 1.6 * em);
        let at = [margin, top];
        let area = [width - bar - 2.0 * margin, height - top - 2.6 * em];
        let area = area.map(|n| n.max(16.0));
        let sheets = self.results.sheets(frame)?;
        let facts = self.facts(frame, &points, &sheets);
        let (look, skin) = (&self.look, &self.look.skin);
        let (place, raster) = self.bodies(frame, &points, [at, area], self.seen, em, canvas);
        let behind_by = 0.02 * skin.size();
        let drawn = marks::Drawn {
            see: &|x| place.place(look.camera.see(x)),
            // In a plane nothing is behind anything.
            hides: &|seen| skin.dim == 3 && raster.hides(seen, behind_by),
            places: &|sheet, point| self.places(sheet, point),
            at,
            area,
            em,
        };
        if self.arrows {
            marks::arrows(&sheets, &drawn, skin.dim, canvas);
        }
        if let Some((sheet, point, most)) = self.peak(&sheets, facts.time) {
            marks::peak(sheet, point, most, &drawn, &self.units, canvas);
        }
        if let Some(acting) = &self.acting {
            self.symbols(&acting.at(facts.time), &points, &drawn, canvas);
        }
        self.headline(frame, em, [margin, width - 2.0 * margin], canvas);
        let inset = self.seen != self.bounds;
        if let Some(field) = &look.field {
            let x = width - bar - 0.4 * em;
            let values = values(&points, skin, Some(field));
            let shown = legend::Shown {
                field,
                unit: &behind(self.units.of_field(field)),
                colours: &look.colours,
                values: &values,
                words: &facts.words,
                statuses: facts.statuses,
            };
            let high = if inset { area[1] - 11.0 * em } else { area[1] };
            legend::bar(&shown, [x, top + 0.5 * em], [bar, high], em, canvas);
        }
        if inset {
            let size = [bar - 1.4 * em, 9.0 * em];
            let corner = [width - bar - 0.4 * em, height - 2.6 * em - size[1]];
            self.inset(frame, &points, [corner, size], em, canvas);
        }
        let corner = [margin + 2.2 * em, height - 2.6 * em];
        legend::triad(&look.camera, skin.dim, corner, em, canvas);
        Ok(facts)
    }

    /// Draws supports and loads where their points are.
    fn symbols(
        &self,
        all: &[Symbol],
        points: &PointFields,
        drawn: &marks::Drawn,
        canvas: &mut dyn Canvas,
    ) {
        let (look, skin) = (&self.look, &self.look.skin);
        let moved = look.moved(points);
        let known = skin.points.iter().copied().zip(0u32..);
        let local: BTreeMap<usize, u32> = known.collect();
        let placed = all.iter().filter_map(|symbol| {
            let place = match symbol.point {
                None => symbol.place,
                Some(point) => {
                    let i = *local.get(&point).filter(|i| look.draws(**i))?;
                    moved[i as usize]
                }
            };
            Some((*symbol, place))
        });
        let placed: Vec<(Symbol, [f64; 3])> = placed.collect();
        let boxes: Vec<[[f64; 3]; 2]> = (0..skin.ends.len()).map(|b| skin.bounds_of(b)).collect();
        // Supports stand outside of their body.
        let sign = |symbol: &Symbol| {
            let axis = (0..3).find(|&c| symbol.vector[c] != 0.0).unwrap_or(0);
            let body = symbol.point.and_then(|p| local.get(&p));
            let middle = body.map(|&i| {
                let [low, high] = boxes[skin.owner[i as usize] as usize];
                (low[axis] + high[axis]) / 2.0
            });
            if middle.is_some_and(|middle| symbol.place[axis] > middle) {
                1.0
            } else {
                -1.0
            }
        };
        symbols::draw(&placed, &sign, drawn, canvas);
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
        let frame = &self.results.frames[frame];
        let mut line = match &frame.phase {
            Some(phase) => format!("{}, phase {:.0}°", phase.label, phase.angle.to_degrees()),
            None => format!("time {}", axis::number(frame.time, 5)),
        };
        // The amplitude of a mode means nothing.
        if self.look.scale != 1.0 && frame.phase.is_none() {
            line += &format!(", displacements × {}", axis::number(self.look.scale, 4));
        }
        if let Some(words) = &self.words {
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

    /// Paints the bodies into a rectangle so that a box of the picture's plane fills it; returns where points are on its raster, and that.
    fn bodies(
        &self,
        frame: usize,
        points: &PointFields,
        [at, area]: [[f64; 2]; 2],
        bounds: zoom::Box2,
        em: f64,
        canvas: &mut dyn Canvas,
    ) -> (Frame, Raster) {
        let size = area.map(|n| (n * FINE as f64) as usize);
        let time = self.results.frames[frame].time;
        let (place, raster) = self.look.paint(points, time, size, bounds, em);
        canvas.picture(at, size, FINE, &raster.pixels);
        (place, raster)
    }
}
