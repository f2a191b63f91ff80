//! Files of modes: tables, shapes, maps and matrices, by the number of their step.

use std::fmt::Write;
use std::path::Path;

use super::analysis::Analysis;
use super::growth;
use crate::error::Error;
use crate::io::csv::Table;
use crate::io::vtu::PackedMesh;
use crate::io::{csv, npy, pvd, write_atomically};
use crate::modal::{Export, FrictionMap, ModalOutcome, Mode, Response, ResponseRow};
use crate::model::kick::Growth;
use crate::system::{Field, Fields, Location};

/// Beginning of the names of all of them.
const STEM: &str = "modes-";

/// Whether a name is one of them: `modes-3.csv`, `modes-3_00001.vtu`, `modes-3-map.csv`.
pub(crate) fn is_of_modes(name: &str) -> bool {
    let Some(rest) = name.strip_prefix(STEM) else {
        return false;
    };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let after = &rest[digits..];
    let ends = [".csv", ".pvd", ".vtu", ".mtx", ".npy"];
    let begins = after.starts_with(['.', '-', '_']);
    digits > 0 && begins && ends.iter().any(|end| after.ends_with(end))
}

/// Writes what a step has found into the folder of results.
pub(crate) fn write(
    directory: &Path,
    analysis: &Analysis,
    mesh: &PackedMesh,
    outcome: &ModalOutcome,
) -> Result<(), Error> {
    let stem = format!("{STEM}{}", analysis.frame.step + 1);
    if let Some(response) = &outcome.response {
        let path = directory.join(format!("{stem}-response.csv"));
        csv::write(&path, &response_table(response))?;
        if outcome.shapes {
            let rows = response.rows.iter().map(|row| (row.frequency, &row.shape));
            write_shapes(directory, &stem, analysis, mesh, rows)?;
        }
        return Ok(());
    }
    csv::write(&directory.join(format!("{stem}.csv")), &table(outcome))?;
    if let Some(map) = &outcome.map {
        csv::write(&directory.join(format!("{stem}-map.csv")), &map_table(map))?;
    }
    if !outcome.sensitivities.is_empty() {
        let path = directory.join(format!("{stem}-sensitivity.csv"));
        write_atomically(&path, sensitivities(outcome).as_bytes())?;
    }
    for matrix in &outcome.export {
        let path = directory.join(format!("{stem}-{}.mtx", matrix.name));
        write_atomically(&path, matrix_market(matrix).as_bytes())?;
    }
    for array in &outcome.arrays {
        let path = directory.join(format!("{stem}-{}.npy", array.name));
        npy::write(&path, array.shape, &array.numbers)?;
    }
    if !outcome.shapes {
        return Ok(());
    }
    let modes = outcome.modes.iter().enumerate();
    let modes = modes.map(|(k, mode)| (k as f64 + 1.0, &mode.shape));
    write_shapes(directory, &stem, analysis, mesh, modes)
}

/// Writes shapes with a list of them, by number or frequency.
fn write_shapes<'a>(
    directory: &Path,
    stem: &str,
    analysis: &Analysis,
    mesh: &PackedMesh,
    shapes: impl Iterator<Item = (f64, &'a [Vec<f64>; 2])>,
) -> Result<(), Error> {
    let mut list = pvd::Collection::new(&directory.join(format!("{stem}.pvd")));
    for (k, (at, parts)) in shapes.enumerate() {
        let name = format!("{stem}_{:05}.vtu", k + 1);
        mesh.write(&directory.join(&name), &shape(analysis, parts))?;
        list.push(at, &name)?;
    }
    Ok(())
}

/// Writes how motions grew that began along modes.
pub(crate) fn write_growth(directory: &Path, all: &[Growth]) -> Result<(), Error> {
    if all.is_empty() {
        return Ok(());
    }
    let history = csv::read(&directory.join("history.csv"))?;
    for one in all {
        let tables = [
            ("growth", growth::table(&history, one)),
            ("spectrum", growth::spectrum(&history, one)),
            ("waterfall", growth::waterfall(&history, one)),
        ];
        for (name, table) in tables {
            if let Some(table) = table {
                let path = directory.join(format!("{STEM}{}-{name}.csv", one.number));
                csv::write(&path, &table)?;
            }
        }
    }
    Ok(())
}

/// A row for each mode.
pub(crate) fn table(outcome: &ModalOutcome) -> Table {
    let modes = &outcome.modes;
    let mut table = Table::default();
    let mut column = |name: String, of: &dyn Fn(usize, &Mode) -> f64| {
        table.names.push(name);
        let values = modes.iter().enumerate().map(|(k, m)| of(k, m));
        table.columns.push(values.collect());
    };
    column("mode".into(), &|k, _| k as f64 + 1.0);
    column("frequency".into(), &|_, m| m.frequency);
    column("growth".into(), &|_, m| m.growth);
    column("damping-ratio".into(), &|_, m| m.damping_ratio);
    column("residual".into(), &|_, m| m.residual);
    for (i, direction) in outcome.directions.iter().enumerate() {
        column(format!("participation.{direction}"), &|_, m| {
            m.participation[i]
        });
        column(format!("effective-mass.{direction}"), &|_, m| {
            m.effective_mass[i]
        });
    }
    if outcome.complex {
        let names = outcome.sliding.iter().map(String::as_str);
        for (i, name) in names.chain(["damping"]).enumerate() {
            column(format!("feed.{name}"), &|_, m| m.feed[i]);
        }
    }
    table
}

/// A row for each factor: frequencies and growth rates of the modes, by frequency.
fn map_table(map: &FrictionMap) -> Table {
    let most = map.rows.iter().map(|r| r.modes.len()).max().unwrap_or(0);
    let mut table = Table::default();
    let mut column = |name: String, of: &dyn Fn(&crate::modal::MapRow) -> f64| {
        table.names.push(name);
        table.columns.push(map.rows.iter().map(of).collect());
    };
    column("factor".into(), &|r| r.factor);
    column("mu".into(), &|r| r.mu);
    column("residual".into(), &|r| r.residual);
    column("largest-growth".into(), &|r| {
        r.modes.iter().fold(f64::NEG_INFINITY, |m, v| m.max(v[1]))
    });
    for k in 0..most {
        let of = |r: &crate::modal::MapRow, q: usize| r.modes.get(k).map_or(f64::NAN, |m| m[q]);
        column(format!("frequency.{}", k + 1), &|r| of(r, 0));
        column(format!("growth.{}", k + 1), &|r| of(r, 1));
    }
    table
}

/// A row for each frequency: amplitude and phase of displacements, the phase in degrees ahead of the loads.
fn response_table(response: &Response) -> Table {
    let rows = &response.rows;
    let mut table = Table::default();
    let mut column = |name: String, of: &dyn Fn(&ResponseRow) -> f64| {
        table.names.push(name);
        table.columns.push(rows.iter().map(of).collect());
    };
    column("frequency".into(), &|r| r.frequency);
    column("residual".into(), &|r| r.residual);
    for (k, name) in response.columns.iter().enumerate() {
        let part = |r: &ResponseRow, q: usize| r.values[k][q];
        column(format!("{name}.AMPLITUDE"), &|r| {
            part(r, 0).hypot(part(r, 1))
        });
        column(format!("{name}.PHASE"), &|r| {
            part(r, 1).atan2(part(r, 0)).to_degrees()
        });
    }
    table
}

fn sensitivities(outcome: &ModalOutcome) -> String {
    let mut text = String::from("mode,of,growth,frequency\n");
    for s in &outcome.sensitivities {
        let of = match s.of.contains([',', '"']) {
            true => format!("\"{}\"", s.of.replace('"', "\"\"")),
            false => s.of.clone(),
        };
        let _ = writeln!(text, "{},{of},{:?},{:?}", s.mode, s.growth, s.frequency);
    }
    text
}

/// A sparse matrix in the exchange format of MatrixMarket.
fn matrix_market(matrix: &Export) -> String {
    let kind = if matrix.symmetric {
        "symmetric"
    } else {
        "general"
    };
    let [rows, columns] = matrix.shape;
    let mut text = format!("%%MatrixMarket matrix coordinate real {kind}\n");
    let _ = writeln!(text, "{rows} {columns} {}", matrix.entries.len());
    for (i, j, value) in &matrix.entries {
        let _ = writeln!(text, "{} {} {value:?}", i + 1, j + 1);
    }
    text
}

/// The shape of a mode as fields: `PHI`, and `PHI_IMAGINARY` of a complex one.
fn shape(analysis: &Analysis, parts: &[Vec<f64>; 2]) -> Fields {
    let model = analysis.model;
    let mut fields = Fields::default();
    for (name, values) in ["PHI", "PHI_IMAGINARY"].into_iter().zip(parts) {
        if values.is_empty() {
            continue;
        }
        let points = 0..model.mesh.points.len();
        fields.all.push(Field {
            name: name.into(),
            location: Location::Point,
            components: 3,
            values: points.flat_map(|p| model.dofs.vector(values, p)).collect(),
        });
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_modes_are_known() {
        for name in [
            "modes-1.csv",
            "modes-12_00003.vtu",
            "modes-2-map.csv",
            "modes-2-stiffness.mtx",
            "modes-2-reduced-mass.npy",
            "modes-3.pvd",
        ] {
            assert!(is_of_modes(name), "{name}");
        }
        for name in [
            "modes.csv",
            "modes-a.csv",
            "modes-1.txt",
            "my-modes-1.csv",
            "modes-1",
        ] {
            assert!(!is_of_modes(name), "{name}");
        }
    }

    #[test]
    fn matrices_are_written_as_others_read_them() {
        let matrix = Export {
            name: "mass".into(),
            shape: [2, 2],
            symmetric: true,
            entries: vec![(0, 0, 1.5), (1, 0, -2.0)],
        };
        let text = matrix_market(&matrix);
        assert_eq!(
            text,
            "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1.5\n2 1 -2.0\n"
        );
    }
}
