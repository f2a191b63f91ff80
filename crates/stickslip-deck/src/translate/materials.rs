//! Materials, turned into the axes of their orientation.

use std::collections::BTreeMap;

use super::bodies::Bodies;
use super::job::Job;
use super::toml;
use crate::deck::{Deck, Elastic, Material, Orientation, Section};

/// The name of the material of a section: with an orientation it is one of its own, unless the material has no directions.
pub(super) fn of(deck: &Deck, section: &Section) -> String {
    let turned = section.orientation.as_ref().filter(|_| {
        let elastic = deck
            .materials
            .get(&section.material)
            .and_then(|m| m.elastic.as_ref());
        !matches!(elastic, Some(Elastic::Isotropic(_)) | None)
    });
    match turned {
        Some(o) => toml::name(&format!("{}-{o}", section.material)),
        None => toml::name(&section.material),
    }
}

pub(super) fn write(job: &mut Job, bodies: &Bodies) {
    let deck = job.deck;
    let mut used: BTreeMap<String, &Section> = BTreeMap::new();
    for (e, s) in &bodies.section {
        if bodies.of_element.contains_key(e) {
            let section = &deck.sections[*s];
            used.entry(of(deck, section)).or_insert(section);
        }
    }
    for (name, section) in used {
        let Some(material) = deck.materials.get(&section.material) else {
            continue;
        };
        if material.elastic.is_none() {
            let message = format!("the material {} has no *ELASTIC", section.material);
            job.error(material.place, message, "bodies are linear elastic");
            continue;
        }
        let (elastic, density) = match constants(job, bodies, material, &section.material) {
            Some((Some(elastic), density)) => (elastic, density),
            _ => continue,
        };
        let elastic = &elastic;
        let axes = section
            .orientation
            .as_ref()
            .and_then(|o| deck.orientations.get(o));
        if let Some(o) = axes
            && !o.uniform
            && !matches!(elastic, Elastic::Isotropic(_))
        {
            job.error(o.place, "the axes of an orientation must be the same everywhere; cylindrical ones turn with the place", "use SYSTEM=RECTANGULAR");
            continue;
        }
        job.table("material", &name, material.place);
        let density = match density {
            Some(d) => format!(", density = {}", toml::number(d)),
            None => String::new(),
        };
        match elastic {
            Elastic::Isotropic([young, poisson]) => job.out.line(&format!(
                "isotropic = {{ young = {}, poisson = {}{density} }}",
                toml::number(*young),
                toml::number(*poisson)
            )),
            Elastic::Engineering(v) => {
                let names = [
                    "e1", "e2", "e3", "nu12", "nu13", "nu23", "g12", "g13", "g23",
                ];
                let mut parts: Vec<String> = names
                    .iter()
                    .zip(v)
                    .map(|(n, x)| format!("{n} = {}", toml::number(*x)))
                    .collect();
                if let Some(o) = axes {
                    parts.push(format!(
                        "axes = [{}, {}]",
                        toml::numbers(&o.axes[0]),
                        toml::numbers(&o.axes[1])
                    ));
                }
                job.out.line(&format!(
                    "orthotropic = {{ {}{density} }}",
                    parts.join(", ")
                ));
            }
            Elastic::Full(c) => {
                let c = turned(c, axes);
                let rows: Vec<String> = c.iter().map(|row| toml::numbers(row)).collect();
                job.out.line(&format!(
                    "anisotropic = {{ stiffness = [{}]{density} }}",
                    rows.join(", ")
                ));
            }
        }
    }
}

/// Elastic constants and density at the temperature that the elements of the material have, which stays what it is at the start.
fn constants(
    job: &mut Job,
    bodies: &Bodies,
    material: &Material,
    name: &str,
) -> Option<(Option<Elastic>, Option<f64>)> {
    if material.elastic_at.len() < 2 && material.density_at.len() < 2 {
        return Some((material.elastic.clone(), material.density));
    }
    let deck = job.deck;
    let mut at: BTreeMap<u64, f64> = BTreeMap::new();
    for t in &deck.temperatures {
        at.extend(job.nodes(&t.target).into_iter().map(|n| (n, t.value)));
    }
    let own = bodies
        .section
        .iter()
        .filter(|(e, s)| deck.sections[**s].material == name && bodies.of_element.contains_key(e));
    let nodes = own.flat_map(|(e, _)| deck.elements[e].nodes.iter());
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in nodes {
        // CalculiX starts at zero where nothing is said.
        let t = at.get(n).copied().unwrap_or(0.0);
        (low, high) = (low.min(t), high.max(t));
    }
    if high > low {
        job.error(
            material.place,
            format!("the material {name} depends on temperature, and its elements have temperatures from {low} to {high}"),
            "give its elements one temperature by *INITIAL CONDITIONS, or a material of its own to the elements of each temperature",
        );
        return None;
    }
    let elastic = between(&material.elastic_at, low, |a, b, w| a.mix(b, w));
    let density = between(&material.density_at, low, |a, b, w| a + w * (b - a));
    Some((elastic, density))
}

/// Linear between the rows of a table over temperature, constant outside.
fn between<T: Clone>(rows: &[(f64, T)], t: f64, mix: impl Fn(&T, &T, f64) -> T) -> Option<T> {
    let after = rows.partition_point(|r| r.0 <= t);
    match (after.checked_sub(1).map(|i| &rows[i]), rows.get(after)) {
        (Some(a), Some(b)) => Some(mix(&a.1, &b.1, (t - a.0) / (b.0 - a.0))),
        (a, b) => a.or(b).map(|row| row.1.clone()),
    }
}

impl Elastic {
    /// Constants between these and others of the same kind.
    fn mix(&self, other: &Elastic, w: f64) -> Elastic {
        let mean = |a: f64, b: f64| a + w * (b - a);
        match (self, other) {
            (Elastic::Isotropic(a), Elastic::Isotropic(b)) => {
                Elastic::Isotropic(std::array::from_fn(|i| mean(a[i], b[i])))
            }
            (Elastic::Engineering(a), Elastic::Engineering(b)) => {
                Elastic::Engineering(std::array::from_fn(|i| mean(a[i], b[i])))
            }
            (Elastic::Full(a), Elastic::Full(b)) => {
                let row = |i: usize| std::array::from_fn(|j| mean(a[i][j], b[i][j]));
                Elastic::Full(Box::new(std::array::from_fn(row)))
            }
            // One *ELASTIC has rows of one kind.
            _ => self.clone(),
        }
    }
}

/// The stiffness in the global axes and in the order xx yy zz xy yz xz, from one in the order 11 22 33 12 13 23 of the material.
fn turned(c: &[[f64; 6]; 6], axes: Option<&Orientation>) -> [[f64; 6]; 6] {
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let ours = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
    let at = |i: usize, j: usize| {
        pairs
            .iter()
            .position(|p| *p == (i.min(j), i.max(j)))
            .unwrap_or(0)
    };
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let a = axes.map_or(identity, |o| o.axes);
    let mut out = [[0.0; 6]; 6];
    for (row, &(i, j)) in ours.iter().enumerate() {
        for (column, &(k, l)) in ours.iter().enumerate() {
            // Rows of `a` are the material axes: a tensor turns with one of them for each index.
            for (p, ap) in a.iter().enumerate() {
                for (q, aq) in a.iter().enumerate() {
                    for (r, ar) in a.iter().enumerate() {
                        for (s, as_) in a.iter().enumerate() {
                            out[row][column] +=
                                ap[i] * aq[j] * ar[k] * as_[l] * c[at(p, q)][at(r, s)];
                        }
                    }
                }
            }
        }
    }
    out
}
