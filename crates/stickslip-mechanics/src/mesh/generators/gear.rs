use std::f64::consts::{PI, TAU};

use super::annulus::{Annulus, positive, some};
use super::generate::Generate;
use super::grading::affordable;
use super::lattice::Key;
use super::rectangle::quad4;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

/// A spur gear with involute flanks (ISO 21771), in the plane.
///
/// Above the base circle nodes lie on the involute of the circle of radius `teeth module cos(pressure-angle) / 2`, those in the middle of edges too; below it flanks
/// are radial, without the fillet of a real tool. The first tooth is centred about `angle`. Two gears of one module mesh at a distance of
/// `module (teeth + teeth') / 2`; to the right of a gear with the angle 0 another with the angle `π + π / teeth` has a gap where that one has a tooth.
///
/// Facet sets: `bore`, `teeth` (everything outside: flanks, tips and roots).
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Gear {
    /// Centre `[length]`.
    #[serde(default)]
    pub centre: [f64; 2],
    /// Number of teeth.
    pub teeth: usize,
    /// Module: pitch diameter over number of teeth `[length]`.
    pub module: f64,
    /// Pressure angle `[rad]`.
    #[serde(default = "twenty_degrees")]
    pub pressure_angle: f64,
    /// Height of a tooth above the pitch circle over the module `[-]`.
    #[serde(default = "addendum")]
    pub addendum: f64,
    /// Depth of a gap below the pitch circle over the module `[-]`.
    #[serde(default = "dedendum")]
    pub dedendum: f64,
    /// By how much a tooth is thinner than a gap is wide, along the pitch circle `[length]`.
    #[serde(default)]
    pub backlash: f64,
    /// Radius of the bore `[length]`.
    pub bore: f64,
    /// Direction of the middle of the first tooth, from x `[rad]`.
    #[serde(default)]
    pub angle: f64,
    /// Cells along a flank, across a tooth, across a gap, and from the bore to the roots.
    pub cells: [usize; 4],
    /// Element: quad4, quad8, tri3 or tri6.
    #[serde(default = "quad4")]
    pub element: ElementKind,
}

fn twenty_degrees() -> f64 {
    20.0 * PI / 180.0
}

fn addendum() -> f64 {
    1.0
}

fn dedendum() -> f64 {
    1.25
}

/// Circles of a gear `[length]`.
struct Circles {
    pitch: f64,
    base: f64,
    tip: f64,
    root: f64,
}

impl Gear {
    fn circles(&self) -> Circles {
        let pitch = 0.5 * self.module * self.teeth as f64;
        Circles {
            pitch,
            base: pitch * self.pressure_angle.cos(),
            tip: pitch + self.addendum * self.module,
            root: pitch - self.dedendum * self.module,
        }
    }

    /// Half the angle of a tooth at a radius; below the base circle that at the base circle.
    fn half_angle(&self, circles: &Circles, radius: f64) -> f64 {
        let pressure = (circles.base / radius.max(circles.base)).min(1.0).acos();
        let thickness = PI / (2 * self.teeth) as f64 - 0.25 * self.backlash / circles.pitch;
        thickness + involute(self.pressure_angle) - involute(pressure)
    }

    /// The radius at a part of the way along a flank, by its length: that of an involute is half the base radius times the square of the angle by which it has
    /// unrolled. In equal steps of that angle the nodes amid edges would lie at a quarter of them near the base circle, where the maps of cells are singular.
    fn flank(&self, circles: &Circles, part: f64) -> f64 {
        let square = |r: f64| ((r / circles.base).powi(2) - 1.0).max(0.0);
        let (begin, end) = (square(circles.root), square(circles.tip));
        // Below the base circle the way is straight; it gets its share of the cells by length.
        let below = (circles.base - circles.root).max(0.0);
        let share = below / (below + 0.5 * circles.base * (end - begin));
        if below > 0.0 && self.cells[0] == 1 {
            return circles.root + part * (circles.tip - circles.root);
        }
        // Whole cells, so that one ends where the involute begins.
        let cells = self.cells[0] as f64;
        let share = match below > 0.0 {
            true => (share * cells).round().clamp(1.0, cells - 1.0) / cells,
            false => 0.0,
        };
        if part < share {
            return circles.root + below * part / share;
        }
        let square = begin + (end - begin) * (part - share) / (1.0 - share);
        circles.base * (1.0 + square).sqrt()
    }

    fn check(&self, circles: &Circles) -> Result<(), MeshError> {
        positive(&[("module", self.module), ("bore", self.bore)])?;
        let [flank, tooth, gap, rim] = self.cells;
        some(&[
            ("cells along a flank", flank),
            ("cells across a tooth", tooth),
            ("cells across a gap", gap),
            ("cells of the rim", rim),
        ])?;
        // Before room is made for them.
        affordable(&[
            self.teeth,
            tooth.saturating_add(gap),
            flank.saturating_add(rim),
        ])?;
        let fault = |message: String, help: &str| Err(MeshError::new(message).help(help));
        if self.teeth < 5 {
            return fault(
                format!("{} teeth make no involute gear", self.teeth),
                "give at least 5",
            );
        }
        if !(self.pressure_angle > 0.0 && self.pressure_angle < 0.25 * PI) {
            let message = format!("pressure-angle = {} is none of a gear", self.pressure_angle);
            return fault(message, "it counts in radians, 0.349 for 20 degrees");
        }
        let finite = [self.addendum, self.dedendum, self.backlash, self.angle];
        if finite.iter().any(|x| !x.is_finite()) || self.addendum <= 0.0 || self.dedendum <= 0.0 {
            return fault(
                "addendum and dedendum are heights".into(),
                "give positive numbers, as 1 and 1.25",
            );
        }
        if self.bore >= circles.root {
            let message = format!(
                "the bore, {}, reaches the root circle, {:.6}",
                self.bore, circles.root
            );
            return fault(message, "both are radii: give a smaller bore");
        }
        if self.half_angle(circles, circles.tip) <= 0.0 {
            let message = format!(
                "a tooth ends in a point below the tip circle, {:.6}",
                circles.tip
            );
            return fault(message, "give more teeth, or a smaller addendum");
        }
        let gap = PI / self.teeth as f64 - self.half_angle(circles, circles.root);
        if gap <= 0.0 {
            let message = "no gap is left between the teeth at the root circle".into();
            return fault(message, "give a smaller dedendum or more backlash");
        }
        Ok(())
    }
}

/// `tan α - α`.
fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

impl Generate for Gear {
    fn generate(&self) -> Result<Mesh, MeshError> {
        let circles = self.circles();
        self.check(&circles)?;
        let [flank, tooth, gap, rim] = self.cells;
        let pitch = tooth + gap;
        let columns = 0..self.teeth * pitch;
        let rows = columns.map(|i| match i % pitch < tooth {
            true => rim + flank,
            false => rim,
        });
        let rows: Vec<usize> = rows.collect();
        let step = TAU / self.teeth as f64;
        let at_root = self.half_angle(&circles, circles.root);
        let polar = |key: Key| -> [f64; 2] {
            let middle = self.angle + step * (key[0] / (2 * pitch)) as f64;
            let column = key[0] % (2 * pitch);
            let radius = match key[1].checked_sub(2 * rim) {
                None => {
                    let part = key[1] as f64 / (2 * rim) as f64;
                    self.bore + part * (circles.root - self.bore)
                }
                Some(j) => self.flank(&circles, j as f64 / (2 * flank) as f64),
            };
            let angle = match column.checked_sub(2 * tooth) {
                Some(c) if c > 0 => {
                    let part = c as f64 / (2 * gap) as f64;
                    at_root + part * (step - 2.0 * at_root)
                }
                _ => {
                    let half = self.half_angle(&circles, radius.max(circles.root));
                    half * (column as f64 / tooth as f64 - 1.0)
                }
            };
            [middle + angle, radius]
        };
        let mut lattice = Annulus {
            centre: self.centre,
            element: self.element,
            rows: &rows,
        }
        .lattice(polar)?;
        lattice.name_facets("bore", |k| k[1] == 0);
        let gap = |k: &Key| k[0].is_multiple_of(2 * pitch) || k[0] % (2 * pitch) >= 2 * tooth;
        lattice.name_facets("teeth", |k| {
            k[1] == 2 * (rim + flank) || k[1] >= 2 * rim && gap(k)
        });
        Ok(lattice.mesh)
    }
}

impl Samples for Gear {
    fn samples() -> Vec<Self> {
        let plain = |teeth, element| Gear {
            centre: [0.01, -0.02],
            teeth,
            module: 0.002,
            pressure_angle: twenty_degrees(),
            addendum: addendum(),
            dedendum: dedendum(),
            backlash: 0.0,
            bore: 0.01,
            angle: 0.1,
            cells: [4, 4, 2, 2],
            element,
        };
        vec![
            plain(20, ElementKind::Quad4),
            plain(20, ElementKind::Tri6),
            // The root circle lies outside the base circle.
            plain(50, ElementKind::Quad8),
            Gear {
                backlash: 1e-4,
                cells: [1, 1, 1, 1],
                ..plain(23, ElementKind::Quad4)
            },
        ]
    }
}
