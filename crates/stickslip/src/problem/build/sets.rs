//! Names of sets to points, facets and cells.

use std::collections::{BTreeMap, BTreeSet};

use super::super::nearest::suggest;
use super::super::set::NormalRegion;
use super::super::{Problem, Select};
use super::fault::problem_error;
use crate::contact::facet_point::evaluate;
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, distance, dot, normalize, sub};
use crate::mesh::{CellRef, FacetRef, Mesh, geometry, select};
use crate::model::Body;
use crate::tolerance::NEGLIGIBLE;

/// Resolves names of sets against the joined mesh.
pub(super) struct Sets<'a> {
    mesh: &'a Mesh,
    bodies: &'a [Body],
    /// Facets of cuts: they bound cells, but no surface.
    inside: BTreeSet<FacetRef>,
    own: BTreeMap<String, Vec<usize>>,
    /// The facets of sets that are chosen by their normals.
    facing: BTreeMap<String, Vec<FacetRef>>,
    /// The first hidden point of each reference point.
    references: BTreeMap<String, usize>,
}

pub(super) fn vec3(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

impl<'a> Sets<'a> {
    /// The sets of a problem, and its reference points by their first hidden points; `inside` are facets of cuts.
    pub fn new(
        problem: &Problem,
        mesh: &'a Mesh,
        bodies: &'a [Body],
        inside: BTreeSet<FacetRef>,
        references: BTreeMap<String, usize>,
    ) -> Result<Self, Error> {
        let mut sets = Sets {
            references,
            mesh,
            bodies,
            inside,
            own: BTreeMap::new(),
            facing: BTreeMap::new(),
        };
        // Unions may name other sets: whatever can be resolved is, until nothing is left or nothing moves.
        let mut left: Vec<&String> = problem.set.keys().collect();
        while !left.is_empty() {
            let before = left.len();
            let mut later = Vec::new();
            for name in left {
                let set = &problem.set[name];
                let key = format!("set.{name}");
                if let Select::Union(parts) = &set.select {
                    if parts
                        .iter()
                        .any(|p| problem.set.contains_key(p) && !sets.own.contains_key(p))
                    {
                        later.push(name);
                        continue;
                    }
                    let mut points = Vec::new();
                    for part in parts {
                        points.extend(sets.points(part, &format!("{key}.union"))?);
                    }
                    points.sort_unstable();
                    points.dedup();
                    sets.own.insert(name.clone(), points);
                    continue;
                }
                let of = set.of.as_deref().unwrap_or_default();
                let from = sets.points(of, &format!("{key}.of"))?;
                let points = match &set.select {
                    Select::Normal(region) => {
                        let facets = sets.facing(region, &from);
                        let points = mesh.points_of_facets(&facets);
                        sets.facing.insert(name.clone(), facets);
                        points
                    }
                    other => sets.select(other, set.tolerance, &from),
                };
                if points.is_empty() {
                    return Err(problem_error(vec![
                        Diagnostic::new(&key, format!("no point of `{of}` lies there"))
                            .help("check the coordinates, or widen `tolerance`"),
                    ]));
                }
                sets.own.insert(name.clone(), points);
            }
            if later.len() == before {
                return Err(problem_error(vec![Diagnostic::new(
                    format!("set.{}", later[0]),
                    "the sets of this union name each other in a circle",
                )]));
            }
            left = later;
        }
        Ok(sets)
    }

    fn select(&self, select: &Select, tolerance: f64, from: &[usize]) -> Vec<usize> {
        let x = |p: usize| self.mesh.points[p];
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &p in from {
            for c in 0..3 {
                low[c] = low[c].min(x(p)[c]);
                high[c] = high[c].max(x(p)[c]);
            }
        }
        let reach = tolerance * distance(low, high);
        let keep =
            |test: &dyn Fn(usize) -> bool| from.iter().copied().filter(|&p| test(p)).collect();
        match select {
            Select::Point(place) => {
                let place = vec3(place);
                let nearest = from
                    .iter()
                    .copied()
                    .min_by(|&a, &b| distance(x(a), place).total_cmp(&distance(x(b), place)));
                nearest
                    .filter(|&p| distance(x(p), place) <= reach)
                    .into_iter()
                    .collect()
            }
            Select::Box(b) => {
                let dim = b.from.len();
                keep(&|p| {
                    (0..dim).all(|c| x(p)[c] >= b.from[c] - reach && x(p)[c] <= b.to[c] + reach)
                })
            }
            Select::Plane(plane) => {
                let n = normalize(vec3(&plane.normal)).unwrap_or_default();
                keep(&|p| dot(sub(x(p), vec3(&plane.point)), n).abs() <= reach)
            }
            Select::Ball(ball) => {
                keep(&|p| distance(x(p), vec3(&ball.centre)) <= ball.radius + reach)
            }
            Select::Numbers(numbers) => keep(&|p| numbers.contains(&self.mesh.point_ids[p])),
            Select::Union(_) | Select::Normal(_) => Vec::new(),
        }
    }

    fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|b| b.name == name)
    }

    fn unknown(&self, name: &str, key: &str, what: &str) -> Error {
        if self.references.contains_key(name) {
            let message = format!("`{name}` is a reference point, and wanted is a set of a mesh");
            let help = "it can be supported, bear nodal-force, moment, spring and mass, and stand in couplings";
            return problem_error(vec![Diagnostic::new(key, message).help(help)]);
        }
        let body = name.split('.').next().unwrap_or_default();
        let prefix = format!("{body}.");
        let mesh = self.mesh;
        let mut known: Vec<&str> = mesh
            .point_sets
            .keys()
            .chain(mesh.facet_sets.keys())
            .chain(mesh.cell_sets.keys())
            .filter(|k| k.starts_with(&prefix))
            .map(String::as_str)
            .collect();
        known.sort_unstable();
        known.dedup();
        let help = match self.own.get(name) {
            // A set of the problem file: it exists, but does not hold enough.
            Some(points) => format!(
                "`{name}` holds {} point{}; widen it until it holds all points of at least one",
                points.len(),
                if points.len() == 1 { "" } else { "s" }
            ),
            None if known.is_empty() => format!("the mesh of `{body}` has no sets"),
            None => suggest(name, &format!("sets of the mesh of `{body}`"), &known),
        };
        problem_error(vec![
            Diagnostic::new(key, format!("`{name}` has no {what}")).help(help),
        ])
    }

    /// The first hidden point of a reference point.
    pub fn reference(&self, name: &str) -> Option<usize> {
        self.references.get(name).copied()
    }

    /// The points of a set, sorted, or the first hidden point of a reference point.
    pub fn any_points(&self, name: &str, key: &str) -> Result<Vec<usize>, Error> {
        match self.reference(name) {
            Some(point) => Ok(vec![point]),
            None => self.points(name, key),
        }
    }

    /// Points of a set, sorted.
    pub fn points(&self, name: &str, key: &str) -> Result<Vec<usize>, Error> {
        let mut points = if let Some(points) = self.own.get(name) {
            points.clone()
        } else if let Some(points) = self.mesh.point_sets.get(name) {
            points.clone()
        } else if let Some(facets) = self.mesh.facet_sets.get(name) {
            self.mesh.points_of_facets(facets)
        } else if let Some(cells) = self.mesh.cell_sets.get(name) {
            self.mesh.points_of_cells(cells)
        } else if let Some(body) = self.body(name) {
            body.points.clone().collect()
        } else {
            return Err(self.unknown(name, key, "points: there is no such set"));
        };
        points.sort_unstable();
        points.dedup();
        if points.is_empty() {
            return Err(self.unknown(name, key, "points: the set is empty"));
        }
        Ok(points)
    }

    /// Boundary facets of a set: its own, or those all of whose points are in it.
    pub fn facets(&self, name: &str, key: &str) -> Result<Vec<FacetRef>, Error> {
        let own = self.facing.get(name);
        if let Some(facets) = own.or_else(|| self.mesh.facet_sets.get(name))
            && !facets.is_empty()
        {
            return Ok(facets.clone());
        }
        let points = self.points(name, key)?;
        let mut facets = select::boundary_within(self.mesh, &points);
        facets.retain(|f| !self.inside.contains(f));
        if facets.is_empty() {
            return Err(self.unknown(
                name,
                key,
                "facets: no boundary facet has all its points in it",
            ));
        }
        Ok(facets)
    }

    /// Cells of a set or body.
    pub fn cells(&self, name: &str, key: &str) -> Result<Vec<CellRef>, Error> {
        if let Some(cells) = self.mesh.cell_sets.get(name) {
            return Ok(cells.clone());
        }
        if let Some(body) = self.body(name) {
            return Ok(self
                .mesh
                .cells()
                .filter(|c| body.blocks.contains(&c.block))
                .collect());
        }
        let points = self.points(name, key)?;
        let inside = |c: &CellRef| {
            let of_cell = self.mesh.cell_points(*c);
            of_cell.iter().all(|p| points.binary_search(p).is_ok())
        };
        let cells: Vec<CellRef> = self.mesh.cells().filter(inside).collect();
        if cells.is_empty() {
            return Err(self.unknown(name, key, "cells: no cell has all its points in it"));
        }
        Ok(cells)
    }

    /// The point of a set nearest to a place.
    pub fn nearest(&self, name: &str, place: &[f64], key: &str) -> Result<usize, Error> {
        let place = vec3(place);
        let x = |p: usize| self.mesh.points[p];
        let points = self.points(name, key)?;
        let nearest = points
            .iter()
            .copied()
            .min_by(|&a, &b| distance(x(a), place).total_cmp(&distance(x(b), place)));
        Ok(nearest.unwrap_or(0))
    }

    /// The point of all bodies nearest to a place. Where surfaces touch, both have one there, and it is an error.
    pub fn nearest_of_all(&self, place: &[f64], key: &str) -> Result<usize, Error> {
        let x = vec3(place);
        let of = |body: &'a Body| {
            let point = self.nearest(&body.name, place, key)?;
            Ok((distance(self.mesh.points[point], x), point, body))
        };
        let all: Result<Vec<_>, Error> = self.bodies.iter().map(of).collect();
        let mut all = all?;
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(way, point, first), rest @ ..] = all.as_slice() else {
            return Ok(0);
        };
        let room = way + NEGLIGIBLE * geometry::diameter(self.mesh);
        if let Some((.., second)) = rest.first().filter(|(other, ..)| *other <= room) {
            let message = format!(
                "bodies `{}` and `{}` both have a point there",
                first.name, second.name
            );
            let finding = Diagnostic::new(key, message)
                .help(format!("say which is meant: `of = \"{}\"`", first.name));
            return Err(problem_error(vec![finding]));
        }
        Ok(*point)
    }

    /// The boundary facets all of whose points are in `from` and whose outward normal is within an angle of a direction.
    fn facing(&self, region: &NormalRegion, from: &[usize]) -> Vec<FacetRef> {
        let direction = normalize(vec3(&region.direction)).unwrap_or_default();
        let least = region.angle.to_radians().cos();
        let mut facets = select::boundary_within(self.mesh, from);
        facets.retain(|facet| {
            let (kind, nodes) = self.mesh.facet_points(*facet);
            let x: Vec<Vec3> = nodes.iter().map(|&p| self.mesh.points[p]).collect();
            let [s, t, _] = kind.centre();
            let normal = evaluate(kind, &x, [s, t]).normal;
            dot(normal, direction) >= least && !self.inside.contains(facet)
        });
        facets
    }
}
