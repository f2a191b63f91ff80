//! Sets of the mesh, under the names of the deck where it has a name for them.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::mesh::{CellRef, FacetRef, Mesh};
use stickslip::problem::{Select, Set};

use super::bodies::Bodies;
use super::names::problem_name;
use crate::deck::Deck;

/// Sets that are given to the mesh, and tables of the problem that join them.
#[derive(Debug)]
pub(super) struct Sets {
    points: BTreeMap<String, Vec<u64>>,
    cells: BTreeMap<String, Vec<CellRef>>,
    facets: BTreeMap<String, Vec<FacetRef>>,
    /// Names by members.
    of_points: BTreeMap<BTreeSet<u64>, String>,
    of_cells: BTreeMap<BTreeSet<u64>, String>,
    of_facets: BTreeMap<BTreeSet<FacetRef>, String>,
    unions: BTreeMap<String, Vec<String>>,
    /// Names of sets of points that are taken.
    point_names: BTreeSet<String>,
}

/// A name that is not taken: the one wanted, or that with a number.
fn free(wanted: &str, taken: impl Fn(&str) -> bool) -> String {
    let more = (2..).map(|i| format!("{wanted}-{i}"));
    let all = std::iter::once(wanted.to_string()).chain(more);
    all.into_iter().find(|n| !taken(n)).unwrap_or_default()
}

impl Sets {
    /// With the names that the deck has.
    pub fn new(deck: &Deck, bodies: &Bodies) -> Self {
        let mut sets = Sets {
            points: BTreeMap::new(),
            cells: BTreeMap::new(),
            facets: BTreeMap::new(),
            of_points: BTreeMap::new(),
            of_cells: BTreeMap::new(),
            of_facets: BTreeMap::new(),
            unions: BTreeMap::new(),
            point_names: BTreeSet::new(),
        };
        // Two names of the deck can be one here, as points are replaced: the second gets a number.
        let mut taken = BTreeSet::new();
        for (name, nodes) in &deck.node_sets {
            let known = nodes
                .iter()
                .copied()
                .filter(|n| bodies.of_node.contains_key(n));
            let name = free(&problem_name(name), |n| taken.contains(n));
            let entry = sets.of_points.entry(known.collect());
            taken.insert(entry.or_insert(name).clone());
        }
        taken.clear();
        for (name, elements) in &deck.element_sets {
            let known = elements
                .iter()
                .copied()
                .filter(|e| bodies.of_element.contains_key(e));
            let name = free(&problem_name(name), |n| taken.contains(n));
            let entry = sets.of_cells.entry(known.collect());
            taken.insert(entry.or_insert(name).clone());
        }
        taken.clear();
        for (name, surface) in &deck.surfaces {
            let all = bodies.faces(&surface.parts);
            let all: BTreeSet<FacetRef> = all.into_values().flatten().collect();
            if !all.is_empty() {
                let name = free(&problem_name(name), |n| taken.contains(n));
                let entry = sets.of_facets.entry(all);
                taken.insert(entry.or_insert(name).clone());
            }
        }
        sets.point_names = sets.of_points.values().cloned().collect();
        sets
    }

    /// The name of a set of cells in the mesh, and of the set in the problem if there is one body only.
    pub fn cells(&mut self, bodies: &Bodies, wanted: &str, elements: Vec<u64>) -> String {
        let key: BTreeSet<u64> = elements.iter().copied().collect();
        let known = self.of_cells.get(&key).cloned();
        let name =
            known.unwrap_or_else(|| free(wanted, |n| self.of_cells.values().any(|v| v == n)));
        self.of_cells.insert(key, name.clone());
        let cells = elements
            .iter()
            .filter_map(|e| bodies.of_element.get(e).map(|c| c.0))
            .collect();
        self.cells.insert(name.clone(), cells);
        name
    }

    /// The cells by body: `body.set`, or the body where they are all of it.
    pub fn cells_of(&mut self, bodies: &Bodies, wanted: &str, elements: &[u64]) -> Vec<String> {
        let mut by: BTreeMap<usize, Vec<u64>> = BTreeMap::new();
        for e in elements {
            if let Some((_, b)) = bodies.of_element.get(e) {
                by.entry(*b).or_default().push(*e);
            }
        }
        let whole = |(b, list): (&usize, &Vec<u64>)| list.len() == bodies.all[*b].elements.len();
        if by.iter().all(whole) {
            return by.keys().map(|b| bodies.all[*b].name.clone()).collect();
        }
        let name = self.cells(bodies, wanted, elements.to_vec());
        by.keys()
            .map(|b| format!("{}.{name}", bodies.all[*b].name))
            .collect()
    }

    /// The name by which the problem finds these nodes: `body.set`, a union, or a reference point.
    pub fn points(&mut self, bodies: &Bodies, wanted: &str, nodes: &[u64]) -> String {
        if let &[node] = nodes
            && bodies.refers(node)
        {
            return bodies.references[&node].clone();
        }
        let key: BTreeSet<u64> = nodes
            .iter()
            .copied()
            .filter(|n| bodies.of_node.contains_key(n))
            .collect();
        let owners: BTreeSet<usize> = key.iter().map(|n| bodies.of_node[n]).collect();
        let list: Vec<u64> = key.iter().copied().collect();
        let known = self.of_points.get(&key).cloned();
        let name = known.unwrap_or_else(|| free(wanted, |n| self.point_names.contains(n)));
        self.point_names.insert(name.clone());
        self.of_points.insert(key, name.clone());
        self.points.insert(name.clone(), list);
        let parts: Vec<String> = owners
            .iter()
            .map(|b| format!("{}.{name}", bodies.all[*b].name))
            .collect();
        match parts.as_slice() {
            [one] => one.clone(),
            _ => {
                self.unions.insert(name.clone(), parts);
                name
            }
        }
    }

    /// The name of a set that joins others.
    pub fn union(&mut self, wanted: &str, parts: Vec<String>) -> String {
        let name = free(wanted, |n| self.point_names.contains(n));
        self.point_names.insert(name.clone());
        self.unions.insert(name.clone(), parts);
        name
    }

    /// The names by which the problem finds these faces, one a body: `(body, body.set)`.
    pub fn facets(
        &mut self,
        bodies: &Bodies,
        wanted: &str,
        by: &BTreeMap<usize, Vec<FacetRef>>,
    ) -> Vec<(usize, String)> {
        let all: BTreeSet<FacetRef> = by.values().flatten().copied().collect();
        let list: Vec<FacetRef> = by.values().flatten().copied().collect();
        let known = self.of_facets.get(&all).cloned();
        let name =
            known.unwrap_or_else(|| free(wanted, |n| self.of_facets.values().any(|v| v == n)));
        self.of_facets.insert(all, name.clone());
        self.facets.insert(name.clone(), list);
        by.keys()
            .map(|b| (*b, format!("{}.{name}", bodies.all[*b].name)))
            .collect()
    }

    /// Keeps nodes under a name.
    pub fn keep_points(&mut self, bodies: &Bodies, name: &str, nodes: &[u64]) {
        let known = nodes
            .iter()
            .copied()
            .filter(|n| bodies.of_node.contains_key(n));
        self.points.insert(name.to_string(), known.collect());
    }

    /// Keeps elements under a name.
    pub fn keep_cells(&mut self, bodies: &Bodies, name: &str, elements: &[u64]) {
        let cells = elements
            .iter()
            .filter_map(|e| bodies.of_element.get(e).map(|c| c.0));
        self.cells.insert(name.to_string(), cells.collect());
    }

    /// Keeps faces under a name.
    pub fn keep_facets(&mut self, name: &str, by: &BTreeMap<usize, Vec<FacetRef>>) {
        let list: Vec<FacetRef> = by.values().flatten().copied().collect();
        self.facets.insert(name.to_string(), list);
    }

    /// The sets of the problem that join those of several bodies.
    pub fn unions(&self) -> BTreeMap<String, Set> {
        let union = |(name, parts): (&String, &Vec<String>)| {
            let set = Set {
                of: None,
                tolerance: 1e-6,
                select: Select::Union(parts.clone()),
            };
            (name.clone(), set)
        };
        self.unions.iter().map(union).collect()
    }

    /// The mesh with the sets that were asked for.
    pub fn into_mesh(self, bodies: &Bodies) -> Mesh {
        let mut mesh = bodies.mesh.clone();
        let index: BTreeMap<u64, usize> = mesh
            .point_ids
            .iter()
            .enumerate()
            .map(|(i, n)| (*n, i))
            .collect();
        for (name, nodes) in self.points {
            let mut points: Vec<usize> =
                nodes.iter().filter_map(|n| index.get(n).copied()).collect();
            points.sort_unstable();
            mesh.point_sets.insert(name, points);
        }
        mesh.cell_sets.extend(self.cells);
        mesh.facet_sets.extend(self.facets);
        mesh
    }
}
