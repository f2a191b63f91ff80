//! Coordinates along an edge.

use super::lattice::MOST_CELLS;
use crate::error::MeshError;
use crate::machine;

/// How the cells of one direction grow.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Stretch {
    /// Size of the last cell over that of the first; the sizes between are a geometric sequence `[-]`.
    pub ratio: f64,
}

/// The growth of the cells in each direction; equal cells where nothing is said.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Grading {
    /// Along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<Stretch>,
    /// Along y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<Stretch>,
    /// Along z; boxes only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<Stretch>,
}

/// What the problem file says about one direction of a grid.
pub(super) struct Edge<'a> {
    pub name: &'static str,
    pub from: f64,
    pub to: Option<f64>,
    pub cells: Option<usize>,
    pub stretch: Option<Stretch>,
    pub explicit: &'a [f64],
}

impl Edge<'_> {
    /// The coordinates of the grid lines.
    pub fn coordinates(&self) -> Result<Vec<f64>, MeshError> {
        let name = self.name;
        if !self.explicit.is_empty() {
            if self.explicit.iter().any(|x| !x.is_finite()) {
                return Err(
                    MeshError::new(format!("a coordinate of \"{name}\" is not finite"))
                        .help("give finite numbers"),
                );
            }
            if self.explicit.len() < 2 || self.explicit.windows(2).any(|w| w[0] >= w[1]) {
                return Err(MeshError::new(format!(
                    "the coordinates of \"{name}\" do not increase"
                ))
                .help("give two coordinates or more, each greater than the one before"));
            }
            return Ok(self.explicit.to_vec());
        }
        let missing = |key: &str| {
            MeshError::new(format!("\"{key}\" is missing")).help(format!(
                "give \"to\" and \"cells\", or the coordinates of \"{name}\" as a list"
            ))
        };
        let to = self.to.ok_or_else(|| missing("to"))?;
        let cells = self.cells.ok_or_else(|| missing("cells"))?;
        if !(self.from.is_finite() && to.is_finite() && self.from < to) {
            return Err(MeshError::new(format!(
                "along {name} the body goes from {} to {to}",
                self.from
            ))
            .help("\"to\" must be greater than \"from\", both finite"));
        }
        if cells == 0 || cells > MOST_CELLS {
            return Err(
                MeshError::new(format!("along {name} there are {cells} cells"))
                    .help(format!("give 1 to {MOST_CELLS}")),
            );
        }
        let ratio = self.stretch.map_or(1.0, |s| s.ratio);
        if !(ratio.is_finite() && ratio > 0.0) {
            return Err(MeshError::new(format!("the grading along {name} has the ratio {ratio}"))
                .help("the ratio is the size of the last cell over that of the first, a positive number"));
        }
        let parts = geometric(cells, ratio);
        let x: Vec<f64> = parts
            .iter()
            .map(|&t| {
                if t == 1.0 {
                    to
                } else {
                    self.from + t * (to - self.from)
                }
            })
            .collect();
        if x.windows(2).any(|w| w[0] >= w[1]) {
            return Err(
                MeshError::new(format!("along {name} cells have no size left"))
                    .help("give fewer cells or a ratio nearer to one"),
            );
        }
        Ok(x)
    }
}

/// `n + 1` numbers from 0 to 1 with steps in geometric sequence, the last `ratio` times the first.
fn geometric(n: usize, ratio: f64) -> Vec<f64> {
    if ratio == 1.0 || n == 1 {
        return (0..=n).map(|i| i as f64 / n as f64).collect();
    }
    let growth = ratio.ln() / (n - 1) as f64;
    // (qⁱ - 1) / (qⁿ - 1), accurate for q near 1 as well.
    (0..=n)
        .map(|i| (growth * i as f64).exp_m1() / (growth * n as f64).exp_m1())
        .collect()
}

/// Refuses grids that no memory holds.
pub(super) fn affordable(cells: &[usize]) -> Result<(), MeshError> {
    let total = cells.iter().try_fold(1usize, |a, &b| a.checked_mul(b));
    match total {
        Some(total) if total <= MOST_CELLS => in_memory(total),
        _ => Err(
            MeshError::new(format!("the body would have more than {MOST_CELLS} cells"))
                .help("give fewer or larger cells"),
        ),
    }
}

/// Bytes of a cell and what is known about it in a model without its factors. `stickslip check` took 0.62 kB a quad4 (1.6·10⁵ of them) and
/// 2.7 kB a hex8 (1.25·10⁵): what is refused does not fit.
const CELL_BYTES: u64 = 600;

/// Refuses as many cells as do not fit into what memory is free.
fn in_memory(cells: usize) -> Result<(), MeshError> {
    let (needed, free) = (CELL_BYTES * cells as u64, machine::available_memory());
    match free {
        Some(free) if needed > free => Err(MeshError::new(format!(
            "the body would have {cells} cells, which take about {}; {} of memory are free",
            machine::bytes(needed),
            machine::bytes(free)
        ))
        .help("give fewer or larger cells")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::geometric;

    #[test]
    fn the_last_step_is_ratio_times_the_first() {
        for ratio in [1.0, 1.0 + 1e-12, 5.0, 0.2] {
            let t = geometric(6, ratio);
            assert!(t[0] == 0.0 && t[6] == 1.0);
            let (first, last) = (t[1] - t[0], t[6] - t[5]);
            assert!((last / first - ratio).abs() < 1e-9, "{ratio}");
            assert!(((t[2] - t[1]).powi(2) / (first * (t[3] - t[2])) - 1.0).abs() < 1e-9);
        }
    }
}
