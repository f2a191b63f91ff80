//! Normals of the surfaces at points of the mesh.

use crate::contact::facet_point::evaluate;
use crate::contact::interface::meeting::facet_normal;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::surface::triangulate;
use crate::math::{Vec3, add_scaled, cross, norm, normalize, scale};

/// Points of the mesh on both surfaces with the unit normal out of their body, a mean over the faces around each.
pub fn outward(definition: &InterfaceDefinition) -> Vec<(usize, Vec3)> {
    let mut sums = vec![[0.0; 3]; definition.nodes.len()];
    let own = definition.skin.iter().map(|skin| &skin.facet);
    for facet in own.chain(definition.facets()) {
        let x: Vec<Vec3> = facet
            .nodes
            .iter()
            .map(|&n| definition.reference[n])
            .collect();
        let [s, t, _] = facet.kind.centre();
        let at = evaluate(facet.kind, &x, [s, t]);
        for &n in &facet.nodes {
            sums[n] = add_scaled(sums[n], 1.0, cross(at.a[0], at.a[1]));
        }
    }
    let nodes = definition.nodes.iter().copied().zip(sums);
    nodes
        .filter_map(|(node, sum)| Some((node, normalize(sum)?)))
        .collect()
}

/// Points of the mesh and outward normals of both surfaces there, facet by facet of the primary.
pub fn normals(definition: &InterfaceDefinition) -> Vec<(usize, Vec3)> {
    let mut out = Vec::new();
    for point in &definition.points {
        out.extend(
            point
                .nodes
                .iter()
                .map(|&n| (definition.nodes[n], point.normal)),
        );
    }
    if let Primary::Facets(facets) = &definition.primary {
        for piece in triangulate(facets.clone()) {
            let x: Vec<Vec3> = piece
                .nodes
                .iter()
                .map(|&n| definition.reference[n])
                .collect();
            let normal = facet_normal(&x);
            let normal = scale(1.0 / norm(normal).max(f64::MIN_POSITIVE), normal);
            out.extend(piece.nodes.iter().map(|&n| (definition.nodes[n], normal)));
        }
    }
    out
}
