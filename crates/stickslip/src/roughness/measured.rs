use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::map::HeightMap;
use super::model::{Figures, Relief, RoughnessModel, positive};
use super::statistics::Statistics;
use super::{csv, sdf};
use crate::error::{Error, IoError};
use crate::io::input;
use crate::registry::Samples;

/// A measured map or profile: an SDF file (ISO 25178-71, as text or binary), or text with a matrix of heights or with nodes `x z` or `x y z`, a line
/// each.
///
/// Points that were not measured get the mean of those beside them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Measured {
    /// The file.
    pub file: PathBuf,
    /// Distances of nodes along a line of the file and from line to line, in its unit: for a matrix of heights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<Vec<f64>>,
    /// The file's unit of length in that of the problem, for heights and distances: 1e-6 for micrometres in a problem in metres, 1e3 for
    /// SDF, which has metres, in one in millimetres. Default: 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub unit: f64,
    /// A factor for heights alone `[-]`; below zero for a replica of the surface. Default: 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub scale: f64,
    /// What becomes of the plane nearest to all heights, mean included.
    #[serde(default, skip_serializing_if = "removed")]
    pub tilt: Tilt,
    /// Whether the map goes on beyond its edges with a copy of itself. Default: false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub repeat: bool,
}

/// What becomes of the plane nearest to all heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Tilt {
    /// It is taken away: how a sample lay under the instrument says nothing of it.
    #[default]
    Remove,
    /// Heights stay as they are in the file.
    Keep,
}

fn one() -> f64 {
    1.0
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
fn is_one(x: &f64) -> bool {
    *x == 1.0
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
fn removed(tilt: &Tilt) -> bool {
    *tilt == Tilt::Remove
}

impl Measured {
    /// The map in the problem's unit of length, levelled if wanted, and how many points had not been measured.
    ///
    /// # Errors
    /// [`Error::Io`] with what is wrong, and the line.
    pub fn map(&self, folder: &Path) -> Result<(HeightMap, usize), Error> {
        let file = folder.join(&self.file);
        let wrong = |message: String| {
            Error::Io(IoError {
                file: file.clone(),
                message,
            })
        };
        let bytes = input::read(&file, input::MOST_TEXT_BYTES).map_err(|e| Error::io(&file, e))?;
        let spacing = self.spacing.as_ref().map(|s| {
            let first = s.first().copied().unwrap_or(1.0);
            [first, s.get(1).copied().unwrap_or(first)]
        });
        let read = sdf::read(&bytes).unwrap_or_else(|| match std::str::from_utf8(&bytes) {
            Ok(text) => csv::read(text, spacing),
            Err(_) => Err("it is neither text nor an SDF file".into()),
        });
        let mut map = read.map_err(wrong)?;
        let holes = map.fill().map_err(|missing| {
            wrong(format!(
                "{missing} of {} points have no height",
                map.heights.len()
            ))
        })?;
        map.spacing = map.spacing.map(|s| s * self.unit);
        map.heights
            .iter_mut()
            .for_each(|h| *h *= self.unit * self.scale);
        map.repeat = self.repeat;
        if self.tilt == Tilt::Remove {
            map.level();
        }
        Ok((map, holes))
    }
}

impl RoughnessModel for Measured {
    fn heights(&self, folder: &Path, profile: bool) -> Result<Relief, Error> {
        let (map, holes) = self.map(folder)?;
        if profile && map.rows > 1 {
            let message = format!(
                "it is a map of {} lines; a plane model takes a profile",
                map.rows
            );
            let file = folder.join(&self.file);
            return Err(Error::Io(IoError { file, message }));
        }
        let (columns, rows) = (map.columns, map.rows);
        let figures = Figures {
            columns,
            rows,
            holes,
            statistics: Statistics::of(columns, rows, map.spacing, &map.heights),
        };
        Ok(Relief {
            measured: Some(figures),
            ..Relief::from(map)
        })
    }

    fn faults(&self, _: usize) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = positive("unit", self.unit).into_iter().collect();
        if !self.scale.is_finite() || self.scale == 0.0 {
            faults.push(("scale", format!("is {} and leaves no heights", self.scale)));
        }
        if let Some(spacing) = &self.spacing {
            if !(1..=2).contains(&spacing.len()) {
                faults.push((
                    "spacing",
                    format!("has {} numbers; give one or two", spacing.len()),
                ));
            }
            faults.extend(spacing.iter().filter_map(|s| positive("spacing", *s)));
        }
        faults
    }

    fn file(&self) -> Option<&Path> {
        Some(&self.file)
    }
}

impl Samples for Measured {
    fn samples() -> Vec<Self> {
        vec![Measured {
            file: "scan.sdf".into(),
            spacing: None,
            unit: 1.0,
            scale: 1.0,
            tilt: Tilt::Remove,
            repeat: true,
        }]
    }
}
