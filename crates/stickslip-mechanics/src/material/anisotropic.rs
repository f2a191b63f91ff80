use super::check::{self, MaterialError};
use super::elasticity::Elasticity;
use super::stiffness::{Stiffness, VOIGT};
use crate::registry::Samples;

/// The full tensor `a_ijkl` of [`pop_1995`](stickslip_base::references::pop_1995), eq. (2).
///
/// The symmetries `a_ijkl = a_jikl = a_klij` and ellipticity are checked.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Anisotropic {
    /// The stiffness `[Pa]`, stresses and engineering strains in the order xx yy zz xy yz xz: six rows of six, or a
    /// list of 36 numbers (row by row), of 21 (the upper triangle, row by row), or of 81 (`a_ijkl`, the last index
    /// fastest).
    pub stiffness: Entries,
    /// Mass per volume `[kg/m³]`; needed for gravity and dynamics only.
    #[serde(default)]
    pub density: f64,
}

/// Entries of a stiffness, in rows or in one list.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(
    untagged,
    expecting = "expected six rows of six numbers, or a list of 21, 36 or 81 numbers"
)]
pub enum Entries {
    /// Row by row.
    Rows(Vec<Vec<f64>>),
    /// 21, 36 or 81 numbers.
    List(Vec<f64>),
}

const KEY: &str = "stiffness";

fn from_list(list: &[f64]) -> Result<Stiffness, MaterialError> {
    let mut c = [[0.0; 6]; 6];
    match list.len() {
        36 => {
            for (row, values) in c.iter_mut().zip(list.chunks(6)) {
                row.copy_from_slice(values);
            }
        }
        21 => {
            let mut next = list.iter();
            for i in 0..6 {
                for j in i..6 {
                    c[i][j] = next.next().copied().unwrap_or(f64::NAN);
                    c[j][i] = c[i][j];
                }
            }
        }
        81 => return from_tensor(list),
        n => {
            return Err(MaterialError::new(KEY, format!("the stiffness has {n} entries"))
                .help("give 6 rows of 6 numbers, or a list of 21 (upper triangle), 36 or 81 (a_ijkl) numbers"));
        }
    }
    Ok(c)
}

/// From all `a_ijkl`, which must have the minor symmetries; major symmetry is checked by the caller.
fn from_tensor(a: &[f64]) -> Result<Stiffness, MaterialError> {
    let at = |i: usize, j: usize, k: usize, l: usize| a[((i * 3 + j) * 3 + k) * 3 + l];
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut c = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                for l in 0..3 {
                    let x = at(i, j, k, l);
                    for y in [at(j, i, k, l), at(i, j, l, k)] {
                        if (x - y).abs() > 1e-6 * largest {
                            let name = format!("a_{}{}{}{}", i + 1, j + 1, k + 1, l + 1);
                            return Err(MaterialError::new(
                                KEY,
                                format!("{name} = {x} differs from {y}, its minor counterpart"),
                            )
                            .help("a_ijkl = a_jikl = a_ijlk must hold: stress and strain are symmetric"));
                        }
                    }
                    c[VOIGT[i][j]][VOIGT[k][l]] = x;
                }
            }
        }
    }
    Ok(c)
}

impl Elasticity for Anisotropic {
    fn stiffness(&self) -> Result<Stiffness, MaterialError> {
        let mut c = match &self.stiffness {
            Entries::Rows(rows) => {
                if rows.len() != 6 || rows.iter().any(|r| r.len() != 6) {
                    return Err(MaterialError::new(
                        KEY,
                        format!(
                            "the stiffness has {} rows of {:?} numbers",
                            rows.len(),
                            rows.iter().map(Vec::len).collect::<Vec<_>>()
                        ),
                    )
                    .help("give 6 rows of 6 numbers"));
                }
                from_list(&rows.concat())?
            }
            Entries::List(list) => from_list(list)?,
        };
        check::symmetric(&mut c, KEY)?;
        check::elliptic(&c, KEY)?;
        Ok(c)
    }

    fn density(&self) -> f64 {
        self.density
    }
}

impl Samples for Anisotropic {
    fn samples() -> Vec<Self> {
        // A monoclinic crystal, the plane x-y a plane of symmetry, so that it suits plane problems too.
        let rows = [
            [86.8e9, 7.0e9, 11.9e9, -1.8e9, 0.0, 0.0],
            [7.0e9, 106.0e9, 9.0e9, 3.4e9, 0.0, 0.0],
            [11.9e9, 9.0e9, 95.0e9, 1.2e9, 0.0, 0.0],
            [-1.8e9, 3.4e9, 1.2e9, 39.9e9, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 57.9e9, 5.7e9],
            [0.0, 0.0, 0.0, 0.0, 5.7e9, 49.0e9],
        ];
        vec![Anisotropic {
            stiffness: Entries::Rows(rows.iter().map(|r| r.to_vec()).collect()),
            density: 2650.0,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(stiffness: Entries) -> Result<Stiffness, MaterialError> {
        Anisotropic {
            stiffness,
            density: 0.0,
        }
        .stiffness()
    }

    #[test]
    fn all_ways_to_write_it_agree() {
        let sample = Anisotropic::samples().remove(0);
        let c = sample.stiffness().expect("sound");
        let flat = c.concat();
        let upper: Vec<f64> = (0..6).flat_map(|i| c[i][i..].to_vec()).collect();
        let mut tensor = Vec::new();
        for ij in VOIGT.concat() {
            for kl in VOIGT.concat() {
                tensor.push(c[ij][kl]);
            }
        }
        for list in [flat, upper, tensor] {
            assert_eq!(of(Entries::List(list)).expect("sound"), c);
        }
    }

    #[test]
    fn symmetry_ellipticity_and_shape_are_checked() {
        let c = Anisotropic::samples()[0].stiffness().expect("sound");
        let mut skew = c;
        skew[0][1] *= 2.0;
        let e = of(Entries::List(skew.concat())).expect_err("unsymmetric");
        assert!(e.message.contains("not symmetric") && e.message.contains("(1, 2)"));

        let mut indefinite = [[0.0; 6]; 6];
        for (i, row) in indefinite.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        indefinite[0][1] = 1.5;
        indefinite[1][0] = 1.5;
        let e = of(Entries::List(indefinite.concat())).expect_err("indefinite");
        assert!((e.smallest_eigenvalue.expect("given") + 0.5).abs() < 1e-14);
        assert!(
            e.to_string()
                .contains("smallest eigenvalue of the stiffness is -0.5")
        );

        assert!(
            of(Entries::List(vec![1.0; 20]))
                .expect_err("length")
                .message
                .contains("20 entries")
        );
        assert!(of(Entries::Rows(vec![vec![1.0; 6]; 5])).is_err());
        let mut tensor = vec![0.0; 81];
        tensor[1] = 1.0;
        assert!(
            of(Entries::List(tensor))
                .expect_err("minor")
                .message
                .contains("a_1112")
        );
        assert!(of(Entries::List(vec![f64::NAN; 36])).is_err());
    }
}
