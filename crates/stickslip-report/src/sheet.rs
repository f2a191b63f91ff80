//! The surfaces of interfaces, with what is known at their points.

use stickslip::Error;
use stickslip::io::pvd::Part;
use stickslip::io::vtu::{self, Grid, PointArray};
use stickslip::results::OPPOSITE;

use crate::results::Results;

/// The surface of one interface at one time.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    /// The interface.
    pub name: String,
    /// Points, cells (vertices, lines, triangles, quadrilaterals) and fields.
    pub grid: Grid,
}

impl Sheet {
    fn array(&self, name: &str, components: usize) -> Option<&PointArray> {
        let array = self.grid.points.arrays.get(name);
        array.filter(|a| a.components == components)
    }

    /// Whether the file has this field.
    pub fn has(&self, name: &str) -> bool {
        self.grid.points.arrays.contains_key(name)
    }

    /// A field of one number a point; nothing where the file has none.
    pub fn numbers(&self, name: &str) -> &[f64] {
        self.array(name, 1).map_or(&[], |a| &a.values)
    }

    /// A vector at a point; zero where the file has none.
    pub fn vector(&self, name: &str, point: usize) -> [f64; 3] {
        match self.array(name, 3) {
            Some(a) => [0, 1, 2].map(|c| a.values[3 * point + c]),
            None => [0.0; 3],
        }
    }

    /// Whether its surfaces are tied: then it has tractions, and no pressure or status.
    pub fn tied(&self) -> bool {
        self.grid.points.arrays.contains_key("TNORMAL")
    }

    /// The shear traction on the secondary at a point.
    pub fn shear(&self, point: usize) -> [f64; 3] {
        self.vector(if self.tied() { "TSHEAR" } else { "CSHEAR" }, point)
    }

    /// Where a point is, displacements taken so many times.
    pub fn place(&self, point: usize, scale: f64) -> [f64; 3] {
        let (x, u) = (self.grid.points.points[point], self.vector("U", point));
        [0, 1, 2].map(|c| x[c] + scale * u[c])
    }

    /// The point with the largest pressure, and that pressure; `None` where nothing presses. Of points that press alike the first.
    pub fn peak(&self) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        for (i, &p) in self.numbers("CPRESS").iter().enumerate() {
            if p > best.map_or(0.0, |(_, most)| most * (1.0 + 1e-9)) {
                best = Some((i, p));
            }
        }
        best
    }

    /// Whether it is of a plane problem.
    pub fn flat(&self) -> bool {
        self.grid.types.iter().all(|t| *t <= 3) && self.grid.types.contains(&3)
    }

    /// The points that press: with more than a thousandth of the largest pressure, or of what is ten times the usual one, so that a single node does not count alone.
    pub fn pressing(&self) -> Vec<usize> {
        let pressures = self.numbers("CPRESS");
        let mut all: Vec<f64> = pressures.iter().copied().filter(|p| *p > 0.0).collect();
        all.sort_by(f64::total_cmp);
        let usual = all.get(all.len() / 2).copied().unwrap_or(f64::INFINITY);
        let most = all.last().map_or(usual, |most| most.min(10.0 * usual));
        let pressing = pressures
            .iter()
            .enumerate()
            .filter(|(_, p)| **p > 1e-3 * most);
        pressing.map(|(i, _)| i).collect()
    }

    /// The largest relative motion of the sides `[length]` that displacements taken larger would show: along the normal, which opens or closes gaps, and across.
    pub fn motion(&self) -> [f64; 2] {
        let mut most = [0.0f64; 2];
        for i in 0..self.grid.points.points.len() {
            let (moved, normal) = (self.vector("UREL", i), self.vector("CNORMAL", i));
            let along: f64 = (0..3).map(|c| moved[c] * normal[c]).sum();
            let whole: f64 = moved.iter().map(|v| v * v).sum();
            if whole.is_finite() {
                let across = (whole - along * along).max(0.0).sqrt();
                most = [most[0].max(along.abs()), most[1].max(across)];
            }
        }
        most
    }
}

impl Results {
    /// The surfaces of all interfaces at a frame; none in results of older versions.
    ///
    /// # Errors
    /// [`Error::Io`] if a file cannot be read or is damaged.
    pub fn sheets(&self, frame: usize) -> Result<Vec<Sheet>, Error> {
        let here = self.at(frame).filter(|part| !part.name.ends_with(OPPOSITE));
        here.map(|part| self.read(part)).collect()
    }

    /// The surface of one interface, or that opposite its contact points; `None` where there is none.
    ///
    /// # Errors
    /// As [`Results::sheets`].
    pub fn sheet(&self, frame: usize, name: &str) -> Result<Option<Sheet>, Error> {
        let part = self.at(frame).find(|part| part.name == name);
        part.map(|part| self.read(part)).transpose()
    }

    fn at(&self, frame: usize) -> impl Iterator<Item = &Part> {
        let time = self.frames[frame].time;
        self.surfaces.iter().filter(move |part| part.time == time)
    }

    fn read(&self, part: &Part) -> Result<Sheet, Error> {
        Ok(Sheet {
            name: part.name.clone(),
            grid: vtu::read_surface(&self.directory.join(&part.file))?,
        })
    }

    /// The largest pressure of each frame; zero where there are no surfaces.
    fn peaks(&self) -> Result<Vec<f64>, Error> {
        let most = |sheets: Vec<Sheet>| {
            let peaks = sheets.iter().filter_map(Sheet::peak);
            peaks.map(|(_, p)| p).fold(0.0, f64::max)
        };
        (0..self.frames.len())
            .map(|frame| self.sheets(frame).map(most))
            .collect()
    }

    /// The frame at which contact presses most; of those that come near it the last, which is where a load that is held ends. The last of all where nothing
    /// presses.
    ///
    /// # Errors
    /// As [`Results::sheets`].
    pub fn of_peak(&self) -> Result<usize, Error> {
        Ok(latest_largest(&self.peaks()?))
    }
}

/// The place of the largest number; of those that come near it the last, which is where a load that is held ends. The last of all where none is above zero.
pub fn latest_largest(numbers: &[f64]) -> usize {
    let most = numbers.iter().fold(0.0, |m: f64, n| m.max(*n));
    let near = numbers
        .iter()
        .rposition(|n| most <= 0.0 || *n >= 0.995 * most);
    near.unwrap_or(0)
}
