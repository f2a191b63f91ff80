//! Thermal expansion: strain from temperature, without stress.

use super::axes;
use super::check::MaterialError;
use super::stiffness::VOIGT;
use crate::math::Vec3;

/// How a material expands when it is heated.
///
/// A number is the coefficient of thermal expansion `[1/K]` in all directions, three are those along the material's axes (x, y, z where it has none).
/// A table gives them by temperature.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(
    untagged,
    expecting = "expected a coefficient, three of them along the axes of the material, or a table by temperature: { table = [[20, 11e-6], [400, 13e-6]] }"
)]
pub enum Expansion {
    /// The same in all directions and at all temperatures.
    Number(f64),
    /// Along the material's axes, at all temperatures.
    Axes([f64; 3]),
    /// By temperature.
    Table(ExpansionTable),
}

/// Coefficients of thermal expansion by temperature.
///
/// They are secants, as Abaqus and CalculiX have them: at the temperature `T` a material is `α(T) (T - zero)` longer than at `zero`. Between rows
/// they are linear, outside constant. The strain is what has come since the start: none at the initial temperature.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ExpansionTable {
    /// Rows of a temperature and one coefficient `[1/K]`, or three along the axes; temperatures increase.
    pub table: Vec<Vec<f64>>,
    /// The temperature at which the secants begin.
    #[serde(default)]
    pub zero: f64,
    /// Directions of the axes 1 and 2 in space `[1]`, where they are not those of the elastic constants.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[Vec3; 2]>,
}

/// Thermal expansion in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Dilation {
    /// Temperature and secant coefficients xx yy zz xy yz xz `[1/K]`, shears as engineering strains.
    rows: Vec<(f64, [f64; 6])>,
    zero: f64,
}

/// What is wrong with a coefficient or temperature that is not finite.
fn finite(values: &[f64]) -> Result<(), MaterialError> {
    match values.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(v) => Err(MaterialError::new(
            "expansion",
            format!("{v} is not a finite number"),
        )),
    }
}

impl Expansion {
    /// In space, for a material with these axes (rows), if it has some.
    ///
    /// # Errors
    /// A number that is not finite, a row with other than two or four numbers, temperatures that do not increase, axes that do not span a plane.
    pub fn dilation(&self, frame: Option<[Vec3; 3]>) -> Result<Dilation, MaterialError> {
        let of = |along: [f64; 3], frame| -> [f64; 6] { turned(along, frame) };
        match self {
            Expansion::Number(a) => {
                finite(&[*a])?;
                Ok(Dilation::constant(of([*a; 3], None)))
            }
            Expansion::Axes(along) => {
                finite(along)?;
                Ok(Dilation::constant(of(*along, frame)))
            }
            Expansion::Table(table) => {
                let frame = match table.axes {
                    Some(own) => Some(axes::frame(own).map_err(|e| MaterialError {
                        parameter: "expansion.axes".into(),
                        ..e
                    })?),
                    None => frame,
                };
                let mut rows: Vec<(f64, [f64; 6])> = Vec::new();
                finite(&[table.zero])?;
                for row in &table.table {
                    finite(row)?;
                    let along = match row[..] {
                        [_, a] => of([a; 3], None),
                        [_, a, b, c] => of([a, b, c], frame),
                        _ => {
                            return Err(MaterialError::new(
                                "expansion.table",
                                format!("a row has {} numbers", row.len()),
                            )
                            .help("write [temperature, coefficient], or [temperature, along axis 1, along 2, along 3]"));
                        }
                    };
                    if rows.last().is_some_and(|last| last.0 >= row[0]) {
                        return Err(MaterialError::new(
                            "expansion.table",
                            format!("the temperature {} does not follow the one before", row[0]),
                        )
                        .help("temperatures of a table increase"));
                    }
                    rows.push((row[0], along));
                }
                match rows.is_empty() {
                    true => Err(MaterialError::new("expansion.table", "the table is empty")
                        .help("write rows of [temperature, coefficient]")),
                    false => Ok(Dilation {
                        rows,
                        zero: table.zero,
                    }),
                }
            }
        }
    }
}

/// The tensor with these values along axes (rows), with engineering shears.
fn turned(along: [f64; 3], frame: Option<[Vec3; 3]>) -> [f64; 6] {
    let Some(frame) = frame else {
        let [a, b, c] = along;
        return [a, b, c, 0.0, 0.0, 0.0];
    };
    let mut out = [0.0; 6];
    for i in 0..3 {
        for j in i..3 {
            let sum: f64 = (0..3).map(|k| along[k] * frame[k][i] * frame[k][j]).sum();
            out[VOIGT[i][j]] = if i == j { sum } else { 2.0 * sum };
        }
    }
    out
}

impl Dilation {
    fn constant(coefficients: [f64; 6]) -> Self {
        Dilation {
            rows: vec![(0.0, coefficients)],
            zero: 0.0,
        }
    }

    /// Whether the strain is in proportion to the rise of temperature.
    pub fn is_linear(&self) -> bool {
        self.rows.len() == 1
    }

    /// The strain xx yy zz xy yz xz of a rise from the temperature `start`.
    pub fn strain(&self, start: f64, rise: f64) -> [f64; 6] {
        if self.is_linear() {
            return self.rows[0].1.map(|a| a * rise);
        }
        let (before, now) = (self.at(start), self.at(start + rise));
        let (from, to) = (start - self.zero, start + rise - self.zero);
        std::array::from_fn(|v| now[v] * to - before[v] * from)
    }

    /// The secants at a temperature.
    fn at(&self, t: f64) -> [f64; 6] {
        let after = self.rows.partition_point(|row| row.0 <= t);
        match (
            after.checked_sub(1).map(|i| &self.rows[i]),
            self.rows.get(after),
        ) {
            (Some(a), Some(b)) => {
                let w = (t - a.0) / (b.0 - a.0);
                std::array::from_fn(|v| a.1[v] + w * (b.1[v] - a.1[v]))
            }
            (a, b) => a.or(b).map_or([0.0; 6], |row| row.1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[&[f64]], zero: f64) -> Expansion {
        Expansion::Table(ExpansionTable {
            table: rows.iter().map(|r| r.to_vec()).collect(),
            zero,
            axes: None,
        })
    }

    #[test]
    fn secants_count_from_the_zero_and_strain_from_the_start() {
        let d = table(&[&[0.0, 10e-6], &[100.0, 12e-6]], 20.0)
            .dilation(None)
            .expect("sound");
        // α(70) (70 - 20) - α(50) (50 - 20)
        let expected = 11.4e-6 * 50.0 - 11.0e-6 * 30.0;
        let strain = d.strain(50.0, 20.0);
        assert!((strain[0] - expected).abs() < 1e-18, "{strain:?}");
        assert_eq!(strain[0], strain[2]);
        assert_eq!(d.strain(50.0, 0.0), [0.0; 6]);
        // constant outside
        let hot = d.strain(20.0, 480.0)[1];
        assert!((hot - 12e-6 * 480.0).abs() < 1e-18);
        assert!(!d.is_linear());
    }

    #[test]
    fn a_material_expands_along_its_axes() {
        let (s, c) = 0.4_f64.sin_cos();
        let frame = axes::frame([[c, s, 0.0], [-s, c, 0.0]]).expect("axes");
        let d = Expansion::Axes([3e-6, 1e-6, 2e-6])
            .dilation(Some(frame))
            .expect("sound");
        let e = d.strain(0.0, 1.0);
        // along the first axis nᵀ ε n is the first coefficient
        let along = e[0] * c * c + e[1] * s * s + e[3] * s * c;
        assert!((along - 3e-6).abs() < 1e-20);
        assert!((e[2] - 2e-6).abs() < 1e-20);
        let same = Expansion::Number(5e-6)
            .dilation(Some(frame))
            .expect("sound");
        assert_eq!(same.strain(0.0, 2.0), [1e-5, 1e-5, 1e-5, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn tables_that_mean_nothing_are_refused() {
        let message = |e: Expansion| e.dilation(None).expect_err("wrong").message;
        assert!(message(table(&[], 0.0)).contains("empty"));
        assert!(message(table(&[&[1.0]], 0.0)).contains("1 numbers"));
        let back = table(&[&[10.0, 1e-6], &[10.0, 2e-6]], 0.0);
        assert!(message(back).contains("does not follow"));
        assert!(message(Expansion::Number(f64::NAN)).contains("finite"));
    }
}
