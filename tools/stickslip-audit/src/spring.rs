//! The springs by which points stick in explicit steps, as stiff as the cells beneath: the part of the slip that they give back.

use std::collections::BTreeMap;

use crate::bulk::Bulk;
use crate::case::{Case, Space, kind, number};
use crate::cell::Material;
use crate::loads::stretch;
use crate::mesh::{Facet, Mesh};
use crate::side::{Pair, Side};
use crate::vec3::{dot, sub, unit};

/// Of what the book says of penalties: their stiffness as a multiple of that of the cells.
const PENALTY: f64 = 100.0;

/// Stiffness per area of stick in explicit steps by node of the secondary; none where the bodies beneath are rigid.
pub fn of_stick(case: &Case, mesh: &Mesh, pair: &Pair, bulk: &Bulk) -> BTreeMap<usize, f64> {
    let mut found: BTreeMap<usize, f64> = BTreeMap::new();
    let Side::Body { facets, .. } = &pair.secondary else {
        return found;
    };
    let modulus = |body: usize| constrained(&bulk.materials[body], case.space);
    let other = match &pair.primary {
        Side::Body { facets, .. } => facets.first().map(|f| f.body),
        Side::Rigid(_) => None,
    };
    let other = other.filter(|b| !bulk.rigid[*b]).map(modulus);
    let (factor, given) = penalty(case, &pair.name);
    for facet in facets.iter().filter(|f| !bulk.rigid[f.body]) {
        let softer = modulus(facet.body).min(other.unwrap_or(f64::INFINITY));
        let own = given.unwrap_or(factor * softer / height(mesh, facet));
        for node in &facet.nodes {
            let least = found.entry(*node).or_insert(own);
            *least = least.min(own);
        }
    }
    found
}

/// What a penalty multiplies the stiffness of the cells with, or has instead; other enforcements take the cells as they are.
fn penalty(case: &Case, name: &str) -> (f64, Option<f64>) {
    let table = case.of("interface", name);
    let Some(("penalty", keys)) = table.and_then(|t| kind(t, "enforcement")) else {
        return (1.0, None);
    };
    let either = |a: &str, b: &str| number(keys, a).or(number(keys, b));
    let factor = either("tangential-factor", "factor").unwrap_or(PENALTY);
    let given = number(keys, "tangential-stiffness");
    let normal = number(keys, "stiffness").filter(|_| !keys.contains_key("tangential-factor"));
    (factor, given.or(normal))
}

/// Stress over strain where the strain across is held at zero.
fn constrained(material: &Material, space: Space) -> f64 {
    let (e, nu) = (material.young, material.poisson);
    match space {
        Space::Stress(_) => e / (1.0 - nu * nu),
        _ => e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    }
}

/// How far the cell beneath reaches from a facet.
fn height(mesh: &Mesh, facet: &Facet) -> f64 {
    let corners: Vec<_> = facet.nodes.iter().map(|n| mesh.points[*n]).collect();
    let normal = unit(stretch(facet.kind, &corners, facet.kind.middle()));
    let cell = mesh.cells[facet.cell].1.iter();
    let away = cell.map(|n| dot(sub(mesh.points[*n], corners[0]), normal).abs());
    away.fold(f64::MIN_POSITIVE, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Kind;

    /// A cell of 2 x 2 x 0.5.
    #[test]
    fn stick_is_as_stiff_as_the_cell_beneath() {
        let points: Vec<_> = [0.0, 0.5]
            .iter()
            .flat_map(|z| {
                [
                    [0.0, 0.0, *z],
                    [2.0, 0.0, *z],
                    [2.0, 2.0, *z],
                    [0.0, 2.0, *z],
                ]
            })
            .collect();
        let facet = Facet {
            kind: Kind::Quad(4),
            nodes: vec![0, 1, 2, 3],
            cell: 0,
            body: 0,
        };
        let mesh = Mesh {
            points,
            cells: vec![(Kind::Hexahedron(8), (0..8).collect())],
            owner: vec![0],
            body: vec![0; 8],
            names: vec!["block".into()],
            facets: Vec::new(),
        };
        let text = |enforcement: &str| {
            format!(
                "[model]\nspace = \"solid\"\n[body.block]\nmaterial = \"soft\"\n[material.soft.isotropic]\nyoung = 3.0\npoisson = 0.0\ndensity = 1.0\n\
                 [interface.joint]\n{enforcement}\n[[step]]\nduration = 1.0\n"
            )
        };
        let pair = Pair {
            secondary: Side::Body {
                points: (0..4).collect(),
                facets: vec![facet],
            },
            ..Pair::bare("joint")
        };
        for (enforcement, stiffness) in [
            ("", 6.0),
            ("enforcement.penalty = {}", 600.0),
            ("enforcement.penalty = { factor = 7 }", 42.0),
            (
                "enforcement.penalty = { stiffness = 5, tangential-factor = 2 }",
                12.0,
            ),
            ("enforcement.penalty = { tangential-stiffness = 5 }", 5.0),
        ] {
            let case = Case::parse(&text(enforcement)).expect("a case");
            let bulk = Bulk::new(&case, &mesh).expect("a bulk");
            let found = of_stick(&case, &mesh, &pair, &bulk);
            assert_eq!(found.len(), 4);
            assert!(
                (found[&2] - stiffness).abs() < 1e-12,
                "{enforcement}: {found:?}"
            );
        }
    }
}
