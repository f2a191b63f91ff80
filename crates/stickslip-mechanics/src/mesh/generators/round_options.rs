//! What the round bodies have in common in the problem file.

use crate::error::MeshError;

/// Smaller cells around the contact point: equal ones out to `width`, then growing, along the surface and into the
/// depth.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Refinement {
    /// Largest size of the cells at the contact point `[length]`.
    pub finest: f64,
    /// Distance from the contact point out to which cells have that size `[length]`. Choose it a little wider than the
    /// half-width of the contact.
    #[serde(default)]
    pub width: f64,
    /// Size of a cell over that of its neighbour nearer to the contact point `[-]`.
    #[serde(default = "growth")]
    pub growth: f64,
}

fn growth() -> f64 {
    1.2
}

/// Which part of a ball is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Sector {
    /// All of it.
    #[default]
    Full,
    /// The half with x ≥ centre (see `direction`), cut at the facet set `symmetry-x`.
    Half,
    /// The quarter with x and y ≥ centre (see `direction`), cut at `symmetry-x` and `symmetry-y`.
    Quarter,
}

/// Sizes of cells.
pub(super) struct Sizes {
    coarsest: f64,
    refinement: Refinement,
}

impl Sizes {
    /// Checks the numbers of a body of this radius.
    pub fn new(
        radius: f64,
        size: Option<f64>,
        refine: Option<Refinement>,
    ) -> Result<Sizes, MeshError> {
        let positive = |name: &str, value: f64| {
            if value.is_finite() && value > 0.0 {
                return Ok(());
            }
            Err(MeshError::new(format!("\"{name}\" is {value}")).help("give a positive length"))
        };
        positive("radius", radius)?;
        let coarsest = size.unwrap_or(radius / 8.0);
        positive("size", coarsest)?;
        let refinement = refine.unwrap_or(Refinement {
            finest: coarsest,
            width: 0.0,
            growth: 1.0,
        });
        positive("finest", refinement.finest)?;
        if refinement.finest > coarsest {
            return Err(MeshError::new(format!(
                "the finest cells ({}) are larger than the others ({coarsest})",
                refinement.finest
            ))
            .help("make \"finest\" smaller than \"size\" (which is radius / 8 unless given)"));
        }
        if !(refinement.width.is_finite() && refinement.width >= 0.0) {
            return Err(MeshError::new(format!("\"width\" is {}", refinement.width))
                .help("give a length, zero or more"));
        }
        if !(refinement.growth.is_finite() && refinement.growth >= 1.0) {
            return Err(
                MeshError::new(format!("\"growth\" is {}", refinement.growth))
                    .help("give the ratio of neighbouring sizes, 1 or more; 1.1 to 1.3 is usual"),
            );
        }
        Ok(Sizes {
            coarsest,
            refinement,
        })
    }

    /// Equal cells along a length, as parts from 0 to 1.
    pub fn equal(&self, length: f64) -> Result<Vec<f64>, MeshError> {
        let n = (length / self.coarsest).ceil().max(1.0);
        if n > MOST_STEPS as f64 {
            return Err(too_many());
        }
        let n = n as usize;
        Ok((0..=n).map(|i| i as f64 / n as f64).collect())
    }

    /// Cells growing from the contact point along a length, as parts from 0 to 1.
    pub fn growing(&self, length: f64) -> Result<Vec<f64>, MeshError> {
        let Refinement {
            finest,
            width,
            growth,
        } = self.refinement;
        let mut ends = vec![0.0];
        let (mut x, mut h) = (0.0, finest);
        // Rounding must not add a sliver.
        while x < length * (1.0 - 1e-9) {
            if ends.len() > MOST_STEPS {
                return Err(too_many());
            }
            x += h;
            ends.push(x);
            if x >= width * (1.0 - 1e-9) {
                h = (h * growth).min(self.coarsest);
            }
        }
        let last = ends.len() - 1;
        // The last end lies beyond the length: all cells shrink a little.
        Ok(ends
            .iter()
            .enumerate()
            .map(|(i, e)| if i == last { 1.0 } else { e / x })
            .collect())
    }
}

const MOST_STEPS: usize = 100_000;

fn too_many() -> MeshError {
    MeshError::new(format!(
        "the body would have more than {MOST_STEPS} cells in a row"
    ))
    .help("make \"finest\" or \"size\" larger, or \"growth\" larger than 1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_start_fine_and_grow_to_the_coarsest() {
        let refine = Refinement {
            finest: 0.01,
            width: 0.1,
            growth: 1.3,
        };
        let sizes = Sizes::new(1.0, Some(0.1), Some(refine)).unwrap();
        let t = sizes.growing(0.8).unwrap();
        let steps: Vec<f64> = t.windows(2).map(|w| 0.8 * (w[1] - w[0])).collect();
        assert_eq!((t[0], t[t.len() - 1]), (0.0, 1.0));
        assert!(steps[0] <= 0.01 && steps[0] > 0.008);
        assert!(
            (steps[9] / steps[0] - 1.0).abs() < 1e-9,
            "fine out to the width"
        );
        assert!(
            steps
                .windows(2)
                .all(|w| w[1] / w[0] < 1.3 + 1e-9 && w[1] > w[0] * (1.0 - 1e-9))
        );
        assert!(steps.iter().all(|&s| s <= 0.1));
        assert_eq!(sizes.equal(0.35).unwrap().len(), 5);
    }
}
