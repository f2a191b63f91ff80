//! The mesh of a result file: bodies, boundary facets, and sets found again by geometry.

use std::collections::{BTreeMap, BTreeSet};

use toml::{Table, Value};

use crate::case::{Case, number, numbers, text_of, vector};
use crate::element::Kind;
use crate::vec3::{Vec3, dot, norm, sub, unit};
use crate::vtu::Grid;

/// A side of a cell that no other cell shares.
#[derive(Debug, Clone)]
pub struct Facet {
    /// Its kind.
    pub kind: Kind,
    /// Its points.
    pub nodes: Vec<usize>,
    /// The cell beneath.
    pub cell: usize,
    /// The body of that cell.
    pub body: usize,
}

/// The mesh.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Points before any displacement.
    pub points: Vec<Vec3>,
    /// Kind and points of each cell.
    pub cells: Vec<(Kind, Vec<usize>)>,
    /// Body of each cell.
    pub owner: Vec<usize>,
    /// Body of each point.
    pub body: Vec<usize>,
    /// Names of the bodies.
    pub names: Vec<String>,
    /// Boundary of all bodies.
    pub facets: Vec<Facet>,
}

impl Mesh {
    /// From the fields of a file, and the names of the bodies from the case.
    pub fn new(grid: &Grid, case: &Case) -> Result<Mesh, String> {
        let owner: Vec<usize> = match grid.fields.get("BODY") {
            Some(bodies) => bodies.iter().map(|b| *b as usize).collect(),
            None => return Err("the fields do not say to which body a cell belongs".into()),
        };
        let mut cells = Vec::new();
        for (kind, nodes) in grid.types.iter().zip(&grid.cells) {
            let kind =
                Kind::of_vtk(*kind).ok_or(format!("cells of VTK type {kind} are not audited"))?;
            cells.push((kind, nodes.clone()));
        }
        let mut body = vec![usize::MAX; grid.points.len()];
        for ((_, nodes), owner) in cells.iter().zip(&owner) {
            for node in nodes {
                body[*node] = *owner;
            }
        }
        let mut sides: BTreeMap<Vec<usize>, Option<Facet>> = BTreeMap::new();
        for (cell, (kind, nodes)) in cells.iter().enumerate() {
            for (side, local) in kind.sides() {
                let points: Vec<usize> = local.iter().map(|i| nodes[*i]).collect();
                let mut key = points.clone();
                key.sort_unstable();
                let facet = Facet {
                    kind: side,
                    nodes: points,
                    cell,
                    body: owner[cell],
                };
                // A side that comes twice is inside.
                sides
                    .entry(key)
                    .and_modify(|known| *known = None)
                    .or_insert(Some(facet));
            }
        }
        let names = case
            .named("body")
            .iter()
            .map(|(name, _)| name.to_string())
            .collect();
        Ok(Mesh {
            points: grid.points.clone(),
            facets: sides.into_values().flatten().collect(),
            cells,
            owner,
            body,
            names,
        })
    }

    /// The diagonal of the box around a body, or around all.
    pub fn size(&self, body: Option<usize>) -> f64 {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (x, of) in self.points.iter().zip(&self.body) {
            if body.is_none_or(|b| b == *of) {
                for i in 0..3 {
                    low[i] = low[i].min(x[i]);
                    high[i] = high[i].max(x[i]);
                }
            }
        }
        norm(sub(high, low)).max(f64::MIN_POSITIVE)
    }

    /// Points of a body.
    pub fn of_body(&self, body: usize) -> BTreeSet<usize> {
        let points = self.body.iter().enumerate();
        points
            .filter(|(_, b)| **b == body)
            .map(|(p, _)| p)
            .collect()
    }

    /// The boundary facets all of whose points are in a set.
    pub fn facets_of<'a>(&'a self, set: &'a BTreeSet<usize>) -> impl Iterator<Item = &'a Facet> {
        self.facets
            .iter()
            .filter(|f| f.nodes.iter().all(|n| set.contains(n)))
    }

    /// The points of a set by its name; `None` where only the mesh file knows them.
    pub fn set(&self, case: &Case, name: &str) -> Option<BTreeSet<usize>> {
        if let Some(body) = self.names.iter().position(|n| n == name) {
            return Some(self.of_body(body));
        }
        if let Some((body, set)) = name.split_once('.') {
            let index = self.names.iter().position(|n| n == body)?;
            return self.generated(case.of("body", body)?, index, set);
        }
        let table = case.of("set", name)?;
        if let Some(parts) = table.get("union").and_then(Value::as_array) {
            let mut all = BTreeSet::new();
            for part in parts {
                all.extend(self.set(case, part.as_str()?)?);
            }
            return Some(all);
        }
        let of = text_of(table, "of")?;
        let body = of.split('.').next().unwrap_or(of);
        let index = self.names.iter().position(|n| n == body)?;
        let near = number(table, "tolerance").unwrap_or(1e-6) * self.size(Some(index));
        let inside = self.place(case, table, near)?;
        Some(
            self.set(case, of)?
                .into_iter()
                .filter(|p| inside(self.points[*p]))
                .collect(),
        )
    }

    /// Whether a point is in the place that a set describes.
    fn place(&self, case: &Case, table: &Table, near: f64) -> Option<Box<dyn Fn(Vec3) -> bool>> {
        let dim = case.space.dim();
        if table.contains_key("point") {
            let at = vector(table, "point");
            return Some(Box::new(move |x| norm(sub(x, at)) <= near));
        }
        let (key, value) = ["box", "plane", "ball"]
            .into_iter()
            .find_map(|key| Some((key, table.get(key)?.as_table()?.clone())))?;
        Some(match key {
            "box" => {
                let (from, to) = (vector(&value, "from"), vector(&value, "to"));
                Box::new(move |x| (0..dim).all(|i| x[i] >= from[i] - near && x[i] <= to[i] + near))
            }
            "plane" => {
                let (point, normal) = (vector(&value, "point"), unit(vector(&value, "normal")));
                Box::new(move |x| dot(sub(x, point), normal).abs() <= near)
            }
            _ => {
                let (centre, radius) = (vector(&value, "centre"), number(&value, "radius")?);
                Box::new(move |x| norm(sub(x, centre)) <= radius + near)
            }
        })
    }

    /// The sets of built-in meshes.
    fn generated(&self, body: &Table, index: usize, set: &str) -> Option<BTreeSet<usize>> {
        let generate = body.get("generate")?.as_table()?;
        let (shape, keys) = generate
            .iter()
            .find_map(|(k, v)| Some((k.as_str(), v.as_table()?)))?;
        let factor = number(body, "scale").unwrap_or(1.0);
        let shift = vector(body, "translate");
        let near = 1e-7 * self.size(Some(index));
        let dim = match shape {
            "box" | "ball" | "half-ball" => 3,
            _ => 2,
        };
        // Coordinates as the generator has them.
        let own =
            |p: usize| -> Vec3 { std::array::from_fn(|i| (self.points[p][i] - shift[i]) / factor) };
        let near = near / factor;
        let choose = |keep: &dyn Fn(Vec3) -> bool| -> BTreeSet<usize> {
            self.of_body(index)
                .into_iter()
                .filter(|p| keep(own(*p)))
                .collect()
        };
        if matches!(shape, "rectangle" | "box") {
            let names: &[(&str, usize, bool)] = match dim {
                2 => &[
                    ("left", 0, false),
                    ("right", 0, true),
                    ("bottom", 1, false),
                    ("top", 1, true),
                ],
                _ => &[
                    ("left", 0, false),
                    ("right", 0, true),
                    ("front", 1, false),
                    ("back", 1, true),
                    ("bottom", 2, false),
                    ("top", 2, true),
                ],
            };
            let mut all: Option<BTreeSet<usize>> = None;
            // `bottom-left` is where `bottom` and `left` meet.
            for part in set.split('-') {
                let (_, axis, far) = names.iter().find(|(name, ..)| *name == part)?;
                let line = self.of_body(index).into_iter().map(|p| own(p)[*axis]);
                let end = match far {
                    true => line.fold(f64::NEG_INFINITY, f64::max),
                    false => line.fold(f64::INFINITY, f64::min),
                };
                let found = choose(&|x| (x[*axis] - end).abs() <= near);
                all = Some(match all {
                    Some(known) => known.intersection(&found).copied().collect(),
                    None => found,
                });
            }
            return all;
        }
        let centre = vector(keys, "centre");
        let radius = number(keys, "radius")?;
        let mut towards = vector(keys, "direction");
        if numbers(keys, "direction").is_empty() {
            towards[dim - 1] = -1.0;
        }
        let towards = unit(towards);
        let pole = std::array::from_fn(|i| centre[i] + radius * towards[i]);
        Some(match set {
            "arc" => choose(&|x| (norm(sub(x, centre)) - radius).abs() <= near),
            "flat" => choose(&|x| dot(sub(x, centre), towards).abs() <= near),
            "pole" => choose(&|x| norm(sub(x, pole)) <= near),
            "centre" => choose(&|x| norm(sub(x, centre)) <= near),
            // The cut contains the line through centre and pole; with the usual directions it is a plane x or y = centre.
            "axis" if dim == 2 => {
                let across = [-towards[1], towards[0], 0.0];
                choose(&|x| dot(sub(x, centre), across).abs() <= near)
            }
            "symmetry-x" if towards[0] == 0.0 => choose(&|x| (x[0] - centre[0]).abs() <= near),
            "symmetry-y" if towards[1] == 0.0 => choose(&|x| (x[1] - centre[1]).abs() <= near),
            _ => return None,
        })
    }
}
