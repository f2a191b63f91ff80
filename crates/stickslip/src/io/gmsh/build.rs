//! From the sections of a file to a mesh.

use std::collections::{BTreeMap, HashMap};

use crate::error::MeshError;
use crate::mesh::{Block, CellRef, Mesh};
use crate::shape::ElementKind;

use super::cursor::Cursor;
use super::facets::Faces;
use super::raw::{Element, Raw};

/// Stands for a node that no cell uses.
const UNUSED: usize = usize::MAX;

/// Makes the mesh; the cursor is for the places of errors.
pub(super) fn mesh(raw: Raw, cursor: &Cursor) -> Result<Mesh, MeshError> {
    let dim = raw.elements.iter().map(Element::dim).max().unwrap_or(0);
    if dim < 2 {
        return Err(cursor
            .error("the mesh has neither surface nor volume elements")
            .help(
                "mesh the geometry with gmsh -2 or -3; once there are physical groups, Gmsh saves only elements \
                 in them (or all with Mesh.SaveAll = 1)",
            ));
    }
    let nodes = resolve(&raw, cursor)?;
    let index = used(&raw, &nodes, dim);
    let nodes: Vec<usize> = nodes.into_iter().map(|node| index[node]).collect();
    let mut mesh = Mesh {
        dim,
        ..Mesh::default()
    };
    for (node, _) in raw.nodes.iter().zip(&index).filter(|(_, i)| **i != UNUSED) {
        mesh.points.push(node.x);
        mesh.point_ids.push(node.tag);
    }
    if dim == 2 {
        flatten(&raw, &index, &mut mesh, cursor)?;
    }
    let cells = blocks(&raw, &nodes, &mut mesh);
    sets(&raw, &nodes, &cells, &mut mesh, cursor)?;
    Ok(mesh)
}

fn element_nodes<'a>(element: &Element, nodes: &'a [usize]) -> &'a [usize] {
    &nodes[element.first..element.first + element.kind.map_or(1, ElementKind::node_count)]
}

/// Positions in `raw.nodes` of all nodes of elements.
fn resolve(raw: &Raw, cursor: &Cursor) -> Result<Vec<usize>, MeshError> {
    let mut position = HashMap::with_capacity(raw.nodes.len());
    for (i, node) in raw.nodes.iter().enumerate() {
        if position.insert(node.tag, i).is_some() {
            return Err(cursor
                .error_at(node.at, format!("there are two nodes {}", node.tag))
                .help("node numbers must be unique: renumber and save the mesh again"));
        }
    }
    let mut nodes = Vec::with_capacity(raw.element_nodes.len());
    for element in &raw.elements {
        for tag in element.nodes(&raw.element_nodes) {
            match position.get(tag) {
                Some(&i) => nodes.push(i),
                None => {
                    return Err(cursor
                        .error_at(
                            element.at,
                            format!("element {} refers to node {tag}, which is not in $Nodes", element.tag),
                        )
                        .help("the file is damaged, or was edited without its nodes: save it again with Gmsh"));
                }
            }
        }
    }
    Ok(nodes)
}

/// New positions of the nodes that cells use, in the order of the file.
fn used(raw: &Raw, nodes: &[usize], dim: usize) -> Vec<usize> {
    let mut index = vec![UNUSED; raw.nodes.len()];
    for element in raw.elements.iter().filter(|e| e.dim() == dim) {
        for &node in element_nodes(element, nodes) {
            index[node] = 0;
        }
    }
    let in_use = index.iter_mut().filter(|i| **i != UNUSED);
    in_use.enumerate().for_each(|(next, i)| *i = next);
    index
}

/// Sets `z` to zero in a plane mesh.
fn flatten(raw: &Raw, index: &[usize], mesh: &mut Mesh, cursor: &Cursor) -> Result<(), MeshError> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    let in_use = || raw.nodes.iter().zip(index).filter(|(_, i)| **i != UNUSED);
    for (node, _) in in_use() {
        for k in 0..3 {
            low[k] = low[k].min(node.x[k]);
            high[k] = high[k].max(node.x[k]);
        }
    }
    // Rounding of a plane that was rotated into place must pass; a surface that bends must not.
    let tolerance = 1e-10 * (high[0] - low[0]).max(high[1] - low[1]);
    for (node, &i) in in_use() {
        if node.x[2] - low[2] > tolerance {
            return Err(cursor
                .error_at(
                    node.at,
                    format!(
                        "the mesh has no volume elements and is not planar: node {} has z = {:e}, others have {:e}",
                        node.tag, node.x[2], low[2]
                    ),
                )
                .help(
                    "a 3D mesh needs volume elements (gmsh -3, and a Physical Volume if there are physical groups); \
                     a 2D mesh lies in a plane z = constant",
                ));
        }
        mesh.points[i][2] = 0.0;
    }
    Ok(())
}

/// Makes the blocks of cells and returns the cell of every element that is one.
fn blocks(raw: &Raw, nodes: &[usize], mesh: &mut Mesh) -> Vec<Option<CellRef>> {
    let clockwise = clockwise_surfaces(raw, nodes, mesh);
    let mut cells = vec![None; raw.elements.len()];
    let mut previous: Option<(usize, CellRef)> = None;
    for (e, element) in raw.elements.iter().enumerate() {
        let Some(kind) = element.kind.filter(|kind| kind.dim() == mesh.dim) else {
            continue;
        };
        let own = element_nodes(element, nodes);
        // Version 2.2 repeats an element for each of its groups, one after the other.
        if let Some((p, cell)) = previous {
            let before = &raw.elements[p];
            if before.kind == element.kind && same_nodes(element_nodes(before, nodes), own) {
                cells[e] = Some(cell);
                continue;
            }
        }
        let block = match mesh.blocks.iter().position(|b| b.kind == kind) {
            Some(block) => block,
            None => {
                mesh.blocks.push(Block {
                    kind,
                    connectivity: Vec::new(),
                    cell_ids: Vec::new(),
                });
                mesh.blocks.len() - 1
            }
        };
        let into = &mut mesh.blocks[block];
        match clockwise.get(&element.entity) {
            Some(true) => into
                .connectivity
                .extend(turned(kind).iter().map(|&i| own[i])),
            _ => into.connectivity.extend_from_slice(own),
        }
        into.cell_ids.push(element.tag);
        let cell = CellRef {
            block,
            cell: into.cell_ids.len() - 1,
        };
        cells[e] = Some(cell);
        previous = Some((e, cell));
    }
    cells
}

fn same_nodes(a: &[usize], b: &[usize]) -> bool {
    a.iter().all(|node| b.contains(node))
}

/// For each surface entity of a plane mesh, whether all its cells run clockwise.
fn clockwise_surfaces(raw: &Raw, nodes: &[usize], mesh: &Mesh) -> HashMap<i64, bool> {
    let mut clockwise = HashMap::new();
    if mesh.dim == 3 {
        return clockwise;
    }
    for element in raw.elements.iter().filter(|e| e.dim() == 2) {
        let own = element_nodes(element, nodes);
        let corners = &own[..element.kind.map_or(1, ElementKind::corner_count)];
        let turned = twice_area(corners, mesh) < 0.0;
        *clockwise.entry(element.entity).or_insert(true) &= turned;
    }
    clockwise
}

fn twice_area(corners: &[usize], mesh: &Mesh) -> f64 {
    let origin = mesh.points[corners[0]];
    let mut sum = 0.0;
    for pair in corners[1..].windows(2) {
        let (a, b) = (mesh.points[pair[0]], mesh.points[pair[1]]);
        sum += (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
    }
    sum
}

/// The nodes of a plane element in the order that turns it over.
pub(in crate::io) fn turned(kind: ElementKind) -> &'static [usize] {
    match kind {
        ElementKind::Tri3 => &[0, 2, 1],
        ElementKind::Tri6 => &[0, 2, 1, 5, 4, 3],
        ElementKind::Quad4 => &[0, 3, 2, 1],
        _ => &[0, 3, 2, 1, 7, 6, 5, 4],
    }
}

/// An element in a group and whether the group turns it over.
type Member = (usize, bool);

/// Makes the named sets.
fn sets(
    raw: &Raw,
    nodes: &[usize],
    cells: &[Option<CellRef>],
    mesh: &mut Mesh,
    cursor: &Cursor,
) -> Result<(), MeshError> {
    let mut members: BTreeMap<(usize, i64), Vec<Member>> = BTreeMap::new();
    for (e, element) in raw.elements.iter().enumerate() {
        for group in &raw.groups[element.groups] {
            members
                .entry((element.dim(), group.tag))
                .or_default()
                .push((e, group.reversed));
        }
    }
    let facets: Vec<&[usize]> = members
        .range((mesh.dim - 1, i64::MIN)..(mesh.dim, i64::MIN))
        .flat_map(|(_, elements)| elements)
        .map(|&(e, _)| element_nodes(&raw.elements[e], nodes))
        .collect();
    let faces = Faces::of(mesh, &facets);
    let mut point_sets: BTreeMap<String, (usize, Vec<usize>)> = BTreeMap::new();
    for (&(dim, tag), elements) in &members {
        let name = match raw.names.get(&(dim, tag)) {
            Some(name) => name.clone(),
            None => format!("physical-{tag}"),
        };
        let points = elements
            .iter()
            .flat_map(|&(e, _)| element_nodes(&raw.elements[e], nodes))
            .copied()
            .filter(|&node| node != UNUSED);
        let set = point_sets
            .entry(name.clone())
            .or_insert_with(|| (dim, Vec::new()));
        if set.0 == dim {
            set.1.extend(points);
        }
        if dim == mesh.dim {
            let of_group = elements.iter().filter_map(|&(e, _)| cells[e]);
            mesh.cell_sets.entry(name).or_default().extend(of_group);
        } else if dim + 1 == mesh.dim {
            let found = group_facets(raw, nodes, elements, &faces, mesh, &name, cursor)?;
            if !found.is_empty() {
                mesh.facet_sets.entry(name).or_default().extend(found);
            }
        }
    }
    for (name, (_, points)) in point_sets {
        if !points.is_empty() {
            mesh.point_sets.insert(name, points);
        }
    }
    mesh.point_sets.values_mut().for_each(sort);
    mesh.cell_sets.values_mut().for_each(sort);
    mesh.facet_sets.values_mut().for_each(sort);
    Ok(())
}

fn sort<T: Ord>(set: &mut Vec<T>) {
    set.sort_unstable();
    set.dedup();
}

/// The facets of a group: of all its elements, or none if none is the face of a cell.
fn group_facets(
    raw: &Raw,
    nodes: &[usize],
    elements: &[Member],
    faces: &Faces,
    mesh: &Mesh,
    name: &str,
    cursor: &Cursor,
) -> Result<Vec<crate::mesh::FacetRef>, MeshError> {
    let mut found = Vec::new();
    let mut stray = None;
    for &(e, reversed) in elements {
        let element = &raw.elements[e];
        match faces.owner(mesh, element_nodes(element, nodes), reversed) {
            Some(facet) => found.push(facet),
            None => stray = stray.or(Some(element)),
        }
    }
    match stray {
        Some(element) if !found.is_empty() => Err(cursor
            .error_at(
                element.at,
                format!(
                    "element {} of the physical group \"{name}\" is not a face of any cell, while others of the group are",
                    element.tag
                ),
            )
            .help("put what is not the boundary of a meshed body into a group of its own")),
        _ => Ok(found),
    }
}
