//! One result folder from end to end.

use std::path::Path;

use crate::balance;
use crate::bulk::Bulk;
use crate::case::{kind, number};
use crate::contact::{self, Scale, at};
use crate::energy;
use crate::external::External;
use crate::figure::Report;
use crate::law::{Rubbing, laws, limit, pressure};
use crate::lone;
use crate::motion;
use crate::overlap;
use crate::results::Results;
use crate::side::{Pair, Side, middles};
use crate::vec3::{Vec3, along, norm};

/// Audits a result folder; an error says that it cannot be read.
pub fn audit(folder: &Path) -> Result<Report, String> {
    let results = Results::read(folder)?;
    let mut report = Report::default();
    let (case, mesh) = (&results.case, &results.mesh);
    let bulk = Bulk::new(case, mesh);
    let external = match &bulk {
        Ok(bulk) => External::new(&results, bulk),
        Err(why) => Err(why.clone()),
    };
    let mut pairs = Vec::new();
    for (name, table) in case.named("interface") {
        match Pair::new(case, mesh, name, table, results.exchanged(name)) {
            Some(pair) => pairs.push(pair),
            None => report.skip(format!(
                "interface {name}: a set that only the mesh file knows"
            )),
        }
    }
    let strain = match (&bulk, &external) {
        (Ok(bulk), Ok(external)) => {
            balance::check(&results, bulk, external, &mut report);
            energy::check(&results, bulk, external, &pairs, &mut report);
            energy::strain(&results, bulk, external)
        }
        (Err(why), _) | (_, Err(why)) => {
            report.skip(why.clone());
            results
                .states
                .iter()
                .map(|s| results.at("ALLSE", s))
                .collect()
        }
    };
    motion::check(&results, &mut report);
    contact::reactions(&results, &pairs, &mut report);
    lone::check(&results, &pairs, &mut report);
    for pair in &pairs {
        let scale = scale(&results, pair, &strain);
        contact::check(&results, pair, &scale, &mut report);
        let table = case.of("interface", &pair.name);
        let changed = |key: &&str| table.is_some_and(|t| t.contains_key(*key));
        match ["roughness", "wear", "worn"]
            .iter()
            .find(|key| changed(key))
        {
            Some(key) => {
                if let Some(height) = table.and_then(waves).filter(|_| *key == "roughness") {
                    overlap::penetration(&results, pair, &scale, height, &mut report);
                }
                report.skip(format!(
                    "where the surfaces of {} are, with `{key}`",
                    pair.name
                ));
            }
            None => overlap::check(&results, pair, &scale, bulk.as_ref().ok(), &mut report),
        }
        coarse(&results, pair, &mut report);
    }
    Ok(report)
}

/// How high the waves of a rough surface are, where it has nothing but waves.
fn waves(interface: &toml::Table) -> Option<f64> {
    let (model, table) = kind(interface, "roughness")?;
    (model == "wave")
        .then(|| number(table, "amplitude"))
        .flatten()
}

/// What the figures of an interface are relative to.
fn scale(results: &Results, pair: &Pair, strain: &[f64]) -> Scale {
    let none = std::collections::BTreeSet::new();
    let own = pair.points().unwrap_or(&none);
    let mut scale = Scale {
        pressure: f64::MIN_POSITIVE,
        limit: 0.0,
        approach: 0.0,
        slip: 0.0,
    };
    for (i, (state, strain)) in results.states.iter().zip(strain).enumerate() {
        let force = carried(pair, &state.grid.vector("CFORCE"));
        if force > 0.0 {
            scale.approach = scale.approach.max(2.0 * strain / force);
        }
        let values = at(state);
        for p in own.iter().map(|p| values[*p]).filter(|p| p.pressure > 0.0) {
            scale.pressure = scale.pressure.max(p.pressure);
            scale.approach = scale
                .approach
                .max(if p.gap.is_finite() { -p.gap } else { 0.0 });
            if let Some(laws) = laws(&results.case, &pair.name, results.case.step_at(state.t)) {
                let at = Rubbing {
                    pressure: p.pressure,
                    depth: (-p.gap).max(0.0),
                    speed: 0.0,
                    slid: false,
                };
                scale.limit = scale.limit.max(limit(laws.friction, at).unwrap_or(0.0));
            }
        }
        if let Some(crate::results::Before::Written(old)) = results.before(i) {
            let then = at(old);
            for p in own.iter().filter(|p| values[**p].status > 0.0) {
                let moved = [0, 1].map(|k| values[*p].slip[k] - then[*p].slip[k]);
                scale.slip = scale.slip.max(moved[0].hypot(moved[1]));
            }
        }
    }
    // What the law says of rounding is no pressure.
    let laws = laws(&results.case, &pair.name, 0);
    let rounding = 1e-12 * results.mesh.size(None);
    let floor = laws.and_then(|laws| pressure(laws.normal, -rounding));
    scale.pressure = scale.pressure.max(floor.unwrap_or(0.0));
    // Where all points stick slips are rounding.
    scale.slip = if scale.slip > 0.0 {
        scale.slip.max(0.1 * scale.approach)
    } else {
        0.0
    };
    if scale.approach == 0.0 {
        // Nothing was ever carried: displacements say how large the motion was.
        let moved = results.states.iter().flat_map(|s| &s.u).map(|u| norm(*u));
        scale.approach = moved.fold(1e-9 * results.mesh.size(None), f64::max);
    }
    scale
}

/// What the sides of an interface press with on each other, by the forces of the nodes on them: the lesser of two sums of magnitudes, of which either may have
/// forces of another interface in it. Of a quadratic face pressed evenly the nodes in the middle of edges carry more than all, the corners less than nothing:
/// each of the former is shared by the ends of its edge.
fn carried(pair: &Pair, force: &[Vec3]) -> f64 {
    let sum = |side: &Side| {
        let Side::Body { points, facets } = side else {
            return f64::INFINITY;
        };
        let ends = middles(facets);
        let mut at: std::collections::BTreeMap<usize, Vec3> = std::collections::BTreeMap::new();
        for node in points {
            let f = force.get(*node).copied().unwrap_or_default();
            let to = ends.get(node).map_or(vec![*node], |e| e.to_vec());
            for n in &to {
                let part = at.entry(*n).or_default();
                *part = along(*part, 1.0 / to.len() as f64, f);
            }
        }
        at.values().map(|f| norm(*f)).sum::<f64>()
    };
    sum(&pair.secondary).min(sum(&pair.primary))
}

/// How many points carry the contact where it is largest, and how rough the pressure is along the surface.
fn coarse(results: &Results, pair: &Pair, report: &mut Report) {
    let Some(own) = pair.points() else {
        return;
    };
    let mut most = (0, 0.0);
    for state in &results.states {
        let values = at(state);
        let count = own.iter().filter(|p| values[**p].pressure > 0.0).count();
        if count > most.0 {
            most = (count, state.t);
        }
        if let Side::Body { facets, .. } = &pair.secondary {
            report.note(
                "oscillation",
                &pair.name,
                roughness(facets, &values),
                state.t,
            );
        }
    }
    let enough = if results.case.space.dim() == 3 { 9 } else { 3 };
    if !pair.tied {
        report.note(
            "coarse",
            &pair.name,
            f64::from(u8::from(most.0 < enough)),
            most.1,
        );
    }
}

/// The mean difference of a pressure from that of the neighbours on the facets around it, of the mean pressure.
fn roughness(facets: &[crate::mesh::Facet], values: &[contact::Point]) -> f64 {
    let mut around: std::collections::BTreeMap<usize, Vec<usize>> =
        std::collections::BTreeMap::new();
    for facet in facets {
        for a in &facet.nodes {
            around
                .entry(*a)
                .or_default()
                .extend(facet.nodes.iter().filter(|b| *b != a));
        }
    }
    let (mut rough, mut sum) = (0.0, f64::MIN_POSITIVE);
    for (node, neighbours) in around {
        let p = values[node].pressure;
        let others: Vec<f64> = neighbours.iter().map(|n| values[*n].pressure).collect();
        let inside = p > 0.0 && neighbours.len() > 1 && others.iter().all(|q| *q > 0.0);
        if inside {
            rough += (p - others.iter().sum::<f64>() / others.len() as f64).abs();
            sum += p;
        }
    }
    rough / sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Kind;
    use crate::mesh::Facet;

    /// Forces of another interface on the same bodies are not this one's, and an even pressure on a quadratic face is what it is.
    #[test]
    fn an_interface_carries_its_own_force() {
        let face = |kind: Kind, nodes: Vec<usize>| Side::Body {
            points: nodes.iter().copied().collect(),
            facets: vec![Facet {
                kind,
                nodes,
                cell: 0,
                body: 0,
            }],
        };
        let pair = Pair {
            secondary: face(Kind::Quad(8), (0..8).collect()),
            primary: face(Kind::Quad(4), (8..12).collect()),
            ..Pair::bare("joint")
        };
        let mut force = vec![[0.0; 3]; 20];
        for k in 0..4 {
            force[k][2] = -1.0 / 12.0;
            force[4 + k][2] = 1.0 / 3.0;
            force[8 + k][2] = -0.25;
            // Another interface, twice as hard.
            force[12 + k][2] = 0.5;
            force[16 + k][2] = -0.5;
        }
        assert!((carried(&pair, &force) - 1.0).abs() < 1e-12);
        // With more on its other side too.
        force[8][0] = 3.0;
        assert!((carried(&pair, &force) - 1.0).abs() < 1e-12);
    }
}
