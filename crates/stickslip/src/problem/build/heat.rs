//! Temperatures of points, and what they make of materials.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::super::{Material, Problem};
use super::fault::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use crate::body::heat::{Spot, TemperatureKind};
use crate::body::{Elastic, Part, Space, TemperatureField, Temperatures};
use crate::error::{Diagnostic, Error};
use crate::material::{Dilation, MaterialError, Stiffness};
use crate::mesh::Mesh;
use crate::model::Body;
use crate::tolerance::ROUNDING;

/// A material over temperature.
pub(super) struct Law {
    pub stiffness: Stiffness,
    pub density: f64,
    pub dilation: Option<Arc<Dilation>>,
    /// Stiffness by temperature; empty where it is always the same.
    rows: Vec<(f64, Stiffness)>,
}

/// What the tables of materials say, by name.
pub(super) fn laws(problem: &Problem) -> Result<BTreeMap<&str, Law>, Error> {
    let law = |(name, material): (_, _)| {
        let finding = |e: MaterialError| {
            let key = format!("material.{name}");
            problem_error(vec![Diagnostic::new(key, e.to_string())])
        };
        Law::of(material).map_err(finding).map(|law| (name, law))
    };
    let all = problem.material.iter();
    all.map(|(name, material)| law((name.as_str(), material)))
        .collect()
}

impl Law {
    fn of(material: &Material) -> Result<Self, MaterialError> {
        let model = material.as_dyn();
        let stiffness = model.stiffness()?;
        let frame = model.frame()?;
        let dilation = material.expansion.as_ref();
        let dilation = dilation.map(|e| e.dilation(frame)).transpose()?;
        let mut rows = Vec::new();
        if let Some(first) = material.temperature.filter(|_| !material.at.is_empty()) {
            rows.push((first, stiffness));
        }
        for row in &material.at {
            rows.push((row.temperature, row.kind.as_dyn().stiffness()?));
        }
        Ok(Law {
            stiffness,
            density: model.density(),
            dilation: dilation.map(Arc::new),
            rows,
        })
    }

    /// The stiffness at a temperature.
    fn at(&self, t: f64) -> Stiffness {
        let after = self.rows.partition_point(|row| row.0 <= t);
        let before = after.checked_sub(1).map(|i| &self.rows[i]);
        match (before, self.rows.get(after)) {
            (Some(a), Some(b)) => {
                let w = (t - a.0) / (b.0 - a.0);
                let mean = |i: usize, j: usize| a.1[i][j] + w * (b.1[i][j] - a.1[i][j]);
                std::array::from_fn(|i| std::array::from_fn(|j| mean(i, j)))
            }
            (a, b) => a.or(b).map_or(self.stiffness, |row| row.1),
        }
    }

    /// Whether the stiffness is the same between two temperatures.
    fn is_flat(&self, [low, high]: [f64; 2]) -> bool {
        let first = self.at(low);
        let scale = first
            .as_flattened()
            .iter()
            .fold(0.0_f64, |m, c| m.max(c.abs()));
        let same = |c: Stiffness| {
            let both = c.into_iter().flatten().zip(first.into_iter().flatten());
            both.into_iter()
                .all(|(a, b)| (a - b).abs() <= ROUNDING * scale)
        };
        let within = self.rows.iter().filter(|row| low < row.0 && row.0 < high);
        same(self.at(high)) && within.into_iter().all(|row| same(row.1))
    }
}

/// Temperatures of all points; `None` where no table speaks of any.
pub(super) fn temperatures(
    problem: &Problem,
    sets: &Sets,
    mesh: &Mesh,
    space: Space,
    timeline: &Timeline,
) -> Result<Option<Temperatures>, Error> {
    let initial = problem.initial.values().any(|i| i.temperature.is_some());
    if problem.temperature.is_empty() && !initial {
        return Ok(None);
    }
    let mut start = vec![0.0; mesh.points.len()];
    let mut given: Vec<Option<&str>> = vec![None; start.len()];
    for (name, table) in &problem.initial {
        let Some(kind) = &table.temperature else {
            continue;
        };
        let key = format!("initial.{name}");
        let points = sets.points(&table.set, &format!("{key}.set"))?;
        let below = format!("{key}.temperature");
        for (p, value) in values(kind, mesh, space, &points, &below)? {
            if let Some(other) = given[p].filter(|_| start[p] != value) {
                let message = format!(
                    "node {} has the temperature {value} here, and {} by `initial.{other}`",
                    mesh.point_ids[p], start[p]
                );
                let help = "a point has one temperature at the start";
                return Err(problem_error(vec![
                    Diagnostic::new(below, message).help(help),
                ]));
            }
            (start[p], given[p]) = (value, Some(name.as_str()));
        }
    }
    let mut fields = Vec::new();
    for (name, table) in &problem.temperature {
        let key = format!("temperature.{name}");
        let points = sets.points(&table.set, &format!("{key}.set"))?;
        let below = format!("{key}.{}", crate::registry::Family::kind(&table.kind));
        fields.push((name, values(&table.kind, mesh, space, &points, &below)?));
    }
    let taken = follow(problem, mesh, &fields)?;
    let fields = fields
        .into_iter()
        .zip(taken)
        .map(|((name, entries), taken)| {
            let amplitude = problem.temperature[name].amplitude.as_deref();
            let [factor, share] = timeline.temperature(problem, name, amplitude, &taken);
            TemperatureField {
                name: name.clone(),
                entries,
                factor,
                share,
            }
        });
    let fields: Vec<TemperatureField> = fields.collect();
    let mut heated = fields.iter().flat_map(|f| &f.entries);
    let said = heated.all(|e| given[e.0].is_some());
    Ok(Some(Temperatures {
        start,
        said,
        fields,
    }))
}

/// What a field gives at points, ascending.
fn values(
    kind: &TemperatureKind,
    mesh: &Mesh,
    space: Space,
    points: &[usize],
    key: &str,
) -> Result<Vec<(usize, f64)>, Error> {
    let mut out = Vec::new();
    for &p in points {
        let spot = Spot {
            node: mesh.point_ids[p],
            x: mesh.points[p],
        };
        let Some(value) = kind.as_dyn().at(space, &spot) else {
            let message = format!("node {} of the set has no temperature", spot.node);
            let help = "give one to every node of the set, or name a smaller set";
            return Err(problem_error(vec![
                Diagnostic::new(key, message).help(help),
            ]));
        };
        out.push((p, value));
    }
    out.sort_unstable_by_key(|e| e.0);
    Ok(out)
}

/// In which steps a field with an amplitude takes the place of each field at once. Two fields that act on a point in one step contradict each other.
fn follow(
    problem: &Problem,
    mesh: &Mesh,
    fields: &[(&String, Vec<(usize, f64)>)],
) -> Result<Vec<Vec<bool>>, Error> {
    let acts = |name: &str, step: usize| {
        let list = problem.step[step].temperatures.as_ref();
        list.is_none_or(|names| names.iter().any(|n| n == name))
    };
    let mut taken = vec![vec![false; problem.step.len()]; fields.len()];
    for step in 0..problem.step.len() {
        let mut owner: Vec<Option<&str>> = vec![None; mesh.points.len()];
        for (name, entries) in fields.iter().filter(|f| acts(f.0, step)) {
            for &(p, _) in entries {
                if let Some(other) = owner[p].replace(name) {
                    let message = format!(
                        "in step {} node {} has a temperature by this table and by `temperature.{other}`",
                        step + 1,
                        mesh.point_ids[p]
                    );
                    let help = "name sets that have no point in common, or list in each step the `temperatures` that act";
                    let key = format!("temperature.{name}");
                    return Err(problem_error(vec![
                        Diagnostic::new(key, message).help(help),
                    ]));
                }
            }
        }
        let sudden = |name: &str| problem.temperature[name].amplitude.is_some();
        for ((name, entries), taken) in fields.iter().zip(&mut taken) {
            if acts(name, step) {
                continue;
            }
            let next = entries
                .iter()
                .filter(|(p, _)| owner[*p].is_some_and(sudden));
            let count = next.count();
            taken[step] = count > 0;
            if step > 0 && acts(name, step - 1) && (1..entries.len()).contains(&count) {
                let message = format!(
                    "in step {} a temperature with an amplitude takes its place at some of its points only",
                    step + 1
                );
                let help = "give the points that go on in another way a table of their own";
                let key = format!("temperature.{name}");
                return Err(problem_error(vec![
                    Diagnostic::new(key, message).help(help),
                ]));
            }
        }
    }
    Ok(taken)
}

/// The bodies with their temperatures, and with the elastic constants of those at the start.
pub(super) fn warm(
    problem: &Problem,
    bodies: Vec<Body>,
    temperatures: Temperatures,
    materials: &[Vec<String>],
    laws: &BTreeMap<&str, Law>,
) -> Result<(Vec<Body>, Arc<Temperatures>), Error> {
    let all = Arc::new(temperatures);
    let extremes = all.extremes();
    let mut out = Vec::new();
    for (body, materials) in bodies.into_iter().zip(materials) {
        if body.rigid.is_some() {
            out.push(body);
            continue;
        }
        let mut parts = body.elastic.parts().to_vec();
        for (part, material) in parts.iter_mut().zip(materials) {
            let law = &laws[material.as_str()];
            if !law.rows.is_empty() {
                grade(problem, &body, part, material, law, &all, &extremes)?;
            }
        }
        let old = body.elastic;
        let elastic = Elastic::new(
            body.name.clone(),
            old.mesh().clone(),
            old.space(),
            old.formulation(),
            parts,
        );
        let elastic = elastic.map_err(|e| problem_error(vec![e]))?;
        out.push(Body {
            elastic: elastic.heated(all.clone()),
            ..body
        });
    }
    Ok((out, all))
}

/// Gives cells the stiffness of their temperature at the start.
fn grade(
    problem: &Problem,
    body: &Body,
    part: &mut Part,
    material: &str,
    law: &Law,
    all: &Temperatures,
    extremes: &[[f64; 2]],
) -> Result<(), Error> {
    let block = &body.elastic.mesh().blocks[part.block];
    let nodes = block.connectivity.chunks_exact(block.kind.node_count());
    let mut cells = Vec::new();
    for nodes in nodes {
        let mean = |of: &dyn Fn(usize) -> f64| -> f64 {
            nodes.iter().map(|&p| of(p)).sum::<f64>() / nodes.len() as f64
        };
        let start = mean(&|p| all.start[p]);
        let [low, high] = [0, 1].map(|i| start + mean(&|p| extremes[p][i]));
        if !law.is_flat([low, high]) {
            let message = format!(
                "the elastic constants depend on temperature, and that of body `{}` goes from {low} to {high}: bodies have one stiffness throughout the analysis",
                body.name
            );
            let help = match problem.temperature.is_empty() {
                true => "give constants that hold at all temperatures",
                false => {
                    "give the constants at one temperature, the one that matters most, without `at`; or constants that are the same over the range"
                }
            };
            let key = format!("material.{material}.at");
            return Err(problem_error(vec![
                Diagnostic::new(key, message).help(help),
            ]));
        }
        cells.push(law.at(start));
    }
    if let Some(first) = cells.first().copied() {
        part.stiffness = first;
        part.cells = match cells.iter().all(|c| *c == first) {
            true => None,
            false => Some(Arc::new(cells)),
        };
    }
    Ok(())
}
