//! A result folder: every written state, the history, the tables and the summary.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::case::Case;
use crate::csv::{self, Table};
use crate::mesh::Mesh;
use crate::vec3::{Vec3, add};
use crate::vtu::{self, Grid};

/// The fields of one time.
#[derive(Debug, Clone)]
pub struct State {
    /// Time.
    pub t: f64,
    /// The row of the history that belongs to it.
    pub row: Option<usize>,
    /// Displacements.
    pub u: Vec<Vec3>,
    /// All fields.
    pub grid: Grid,
}

impl State {
    /// Places of the points after displacement.
    pub fn places(&self) -> Vec<Vec3> {
        self.grid
            .points
            .iter()
            .zip(&self.u)
            .map(|(x, u)| add(*x, *u))
            .collect()
    }
}

/// A result folder.
#[derive(Debug)]
pub struct Results {
    /// The problem as it was run.
    pub case: Case,
    /// Its mesh.
    pub mesh: Mesh,
    /// The written states in order of time.
    pub states: Vec<State>,
    /// `history.csv`.
    pub history: Table,
    /// `interfaces/NAME.csv`, of the last state.
    pub tables: BTreeMap<String, Table>,
    /// `summary.json`.
    pub summary: Value,
}

impl Results {
    /// Reads a folder.
    pub fn read(folder: &Path) -> Result<Results, String> {
        let text = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
        };
        let case = Case::read(&folder.join("problem.toml"))?;
        let history = csv::read(&folder.join("history.csv"))?;
        let summary = serde_json::from_str(&text("summary.json")?).map_err(|e| e.to_string())?;
        let times = history.column("TIME").unwrap_or(&[]).to_vec();
        let mut states = Vec::new();
        for line in text("fields.pvd")?
            .lines()
            .filter(|l| l.contains("<DataSet"))
        {
            let of = |key: &str| line.split(&format!("{key}=\"")).nth(1)?.split('"').next();
            let (Some(t), Some(file)) = (of("timestep"), of("file")) else {
                return Err("fields.pvd has a line without time or file".into());
            };
            let t: f64 = t
                .parse()
                .map_err(|_| "fields.pvd has a time that is no number")?;
            let grid = vtu::read(&folder.join(file))?;
            let near = |s: &f64| (s - t).abs() <= 1e-12 * t.abs().max(1e-300);
            states.push(State {
                t,
                row: times.iter().position(near),
                u: grid.vector("U"),
                grid,
            });
        }
        let first = states.first().ok_or("no fields were written")?;
        let mesh = Mesh::new(&first.grid, &case)?;
        let mut tables = BTreeMap::new();
        for (name, _) in case.named("interface") {
            let path = folder.join("interfaces").join(format!("{name}.csv"));
            tables.insert(name.to_string(), csv::read(&path)?);
        }
        Ok(Results {
            case,
            mesh,
            states,
            history,
            tables,
            summary,
        })
    }

    /// Whether the summary says that the points of an interface are those of the side that is named primary.
    pub fn exchanged(&self, interface: &str) -> bool {
        let all = self.summary["interfaces"].as_array();
        let mut all = all.into_iter().flatten();
        all.any(|i| i["name"] == interface && i["exchanged"] == true)
    }

    /// The state before this one, if no increment lies between them: the one that was written, or that of rest at the start.
    pub fn before(&self, i: usize) -> Option<Before<'_>> {
        let row = self.states[i].row?;
        if i > 0 && self.states[i - 1].row? + 1 == row {
            return Some(Before::Written(&self.states[i - 1]));
        }
        (i == 0 && row == 0).then_some(Before::Start)
    }

    /// A number of the history at a state.
    pub fn at(&self, head: &str, state: &State) -> f64 {
        state.row.map_or(0.0, |row| self.history.at(head, row))
    }
}

/// What was before a state.
#[derive(Debug, Clone, Copy)]
pub enum Before<'a> {
    /// A state with fields.
    Written(&'a State),
    /// The start.
    Start,
}
