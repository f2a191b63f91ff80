//! Whole grids: cells and sets as well as points.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::MeshError;
use crate::io::gmsh::{Faces, turned};
use crate::mesh::{Block, CellRef, Mesh, geometry};
use crate::shape::ElementKind;

use super::array::Array;
use super::kinds::{Cell, cell};
use super::read::{GRID, Outline, Piece, outline};

/// Names of arrays that hold the user's numbers of points, ours first.
const POINT_IDS: [&str; 3] = ["NODE_ID", "GlobalNodeId", "GlobalPointIds"];

/// Names of arrays that hold the user's numbers of cells, ours first.
const CELL_IDS: [&str; 3] = ["ELEMENT_ID", "GlobalElementId", "GlobalCellIds"];

/// An array with more values than this counts something and makes no sets.
const MOST_SETS: usize = 256;

/// Reads a grid as a mesh.
///
/// - The mesh is three-dimensional if it has solid cells, otherwise two-dimensional: then all its points must lie in a plane of
///   constant `z`, which is set to zero. Points that no cell uses are dropped.
/// - Numbers come from `NODE_ID` and `ELEMENT_ID` (or `GlobalNodeId`, `GlobalElementId`); without them points and cells are
///   numbered from 1.
/// - Arrays of one whole number a point or cell make sets. One of zeros and ones is the set of its ones, under its own name;
///   any other makes a set `name-value` for each of its values. Cells of a dimension less than the mesh are matched to faces
///   of cells, as in [`gmsh`](crate::io::gmsh), and make facet sets.
/// - Every set of cells or facets makes a point set as well, unless there is one of its name; cells of lower dimensions make
///   point sets only.
/// - In two dimensions a mesh all of whose cells run clockwise is turned over.
///
/// # Errors
/// A file that cannot be read or is damaged, cells outside the family, connectivity that does not fit.
pub fn read_mesh(path: &Path) -> Result<Mesh, MeshError> {
    let bytes = crate::io::input::read(path, u64::MAX).map_err(|e| MeshError {
        file: Some(path.to_path_buf()),
        line: None,
        message: format!("the mesh cannot be read: {e}"),
        help: None,
    })?;
    parse_mesh(&bytes, path)
}

/// Reads a mesh from the bytes of a file; `path` is for messages only.
///
/// # Errors
/// As [`read_mesh`], but for those of the file system.
pub fn parse_mesh(bytes: &[u8], path: &Path) -> Result<Mesh, MeshError> {
    mesh(bytes).map_err(|mut error| {
        // The messages of the lower levels begin with their line.
        let place = error.message.strip_prefix("line ");
        let place = place.and_then(|rest| rest.split_once(": "));
        if let Some((Ok(line), rest)) = place.map(|(line, rest)| (line.parse(), rest)) {
            error.line = Some(line);
            error.message = rest.to_string();
        }
        error.file = Some(path.to_path_buf());
        error
    })
}

fn damaged(message: String) -> MeshError {
    MeshError::new(message).help(
        "write the grid again as an UnstructuredGrid (.vtu), with ParaView (Save Data) or meshio, say",
    )
}

fn mesh(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let outline = outline(bytes, GRID).map_err(damaged)?;
    let mut grid = Grid::default();
    for piece in &outline.pieces {
        grid.append(&outline, piece)?;
    }
    grid.mesh()
}

/// The pieces of a file, joined.
#[derive(Default)]
struct Grid {
    points: Vec<[f64; 3]>,
    elements: Vec<Element>,
    /// Points of all elements.
    nodes: Vec<usize>,
    point_data: Data,
    cell_data: Data,
}

/// A cell of any dimension.
struct Element {
    kind: Option<ElementKind>,
    /// Index of its first node in [`Grid::nodes`].
    first: usize,
}

impl Element {
    fn dim(&self) -> usize {
        self.kind.map_or(0, ElementKind::dim)
    }

    fn count(&self) -> usize {
        self.kind.map_or(1, ElementKind::node_count)
    }
}

/// Arrays of whole numbers, one a point or cell.
type Data = BTreeMap<String, Vec<i64>>;

/// Takes up the arrays of a piece behind `before` values. What is not in all pieces is left out in the end: it is too short.
fn join(
    data: &mut Data,
    outline: &Outline,
    arrays: &[Array],
    before: usize,
    count: usize,
) -> Result<(), MeshError> {
    for array in arrays.iter().filter(|a| a.whole() && a.components == 1) {
        let values = outline.values(array, count).map_err(damaged)?;
        let all = data.entry(array.name.clone()).or_default();
        if all.len() == before {
            all.extend(values.iter().map(|&value| value as i64));
        }
    }
    Ok(())
}

/// An array that makes the cells of a piece, and its line.
fn topology(
    outline: &Outline,
    piece: &Piece,
    name: &str,
    count: usize,
) -> Result<(Vec<f64>, usize), MeshError> {
    let mut fault = format!(
        "line {}: the piece has no array `{name}` in <Cells>",
        piece.line
    );
    for array in &piece.topology {
        match array {
            Ok(array) if array.name == name => {
                let values = outline.values(array, count).map_err(damaged)?;
                return Ok((values, outline.line(array)));
            }
            Ok(_) => {}
            Err(message) => fault.clone_from(message),
        }
    }
    Err(damaged(fault))
}

impl Grid {
    fn append(&mut self, outline: &Outline, piece: &Piece) -> Result<(), MeshError> {
        let base = self.points.len();
        let points = outline.points(piece).map_err(damaged)?;
        if let Some(p) = points.iter().position(|x| x.iter().any(|x| !x.is_finite())) {
            let [x, y, z] = points[p];
            let line = piece.coordinates.as_ref().map_or(1, |a| outline.line(a));
            return Err(MeshError::new(format!(
                "line {line}: point {p} (counted from 0) has a coordinate that is not finite: ({x}, {y}, {z})"
            ))
            .help("coordinates must be finite numbers: repair the grid where it was made"));
        }
        join(
            &mut self.point_data,
            outline,
            &piece.data,
            base,
            points.len(),
        )?;
        let before = self.elements.len();
        join(
            &mut self.cell_data,
            outline,
            &piece.cell_data,
            before,
            piece.cells,
        )?;
        self.points.extend(points);
        if piece.cells == 0 {
            return Ok(());
        }
        let (types, _) = topology(outline, piece, "types", piece.cells)?;
        let (offsets, line) = topology(outline, piece, "offsets", piece.cells)?;
        let total = whole(offsets[piece.cells - 1]).ok_or_else(|| {
            damaged(format!(
                "line {line}: the last of `offsets` is no count of points: {}",
                offsets[piece.cells - 1]
            ))
        })?;
        let (connectivity, line_of_nodes) = topology(outline, piece, "connectivity", total)?;
        let mut start = 0;
        for (c, (&kind, &end)) in types.iter().zip(&offsets).enumerate() {
            let end = whole(end).filter(|&end| start <= end && end <= total);
            let end = end.ok_or_else(|| {
                damaged(format!(
                    "line {line}: cell {c} (counted from 0): its entry in `offsets` is {}, where {start} to {total} is possible",
                    offsets[c]
                ))
            })?;
            let nodes = &connectivity[start..end];
            self.element(c, kind, nodes, base, piece.points)
                .map_err(|mut error| {
                    error.message = format!("line {line_of_nodes}: {}", error.message);
                    error
                })?;
            start = end;
        }
        Ok(())
    }

    /// Takes up a cell of a piece whose points begin at `base`.
    fn element(
        &mut self,
        c: usize,
        vtk_type: f64,
        nodes: &[f64],
        base: usize,
        points: usize,
    ) -> Result<(), MeshError> {
        let (kind, order): (_, &[usize]) = match cell(vtk_type) {
            Cell::Vertex => (None, &[]),
            Cell::Solid(kind, order) => (Some(kind), order),
            Cell::Refused(name, help) => {
                return Err(MeshError::new(format!(
                    "cell {c} (counted from 0) is of VTK type {vtk_type} ({name}), which is not read"
                ))
                .help(help));
            }
        };
        let element = Element {
            kind,
            first: self.nodes.len(),
        };
        if nodes.len() != element.count() {
            let name = kind.map_or("vertex", ElementKind::name);
            return Err(damaged(format!(
                "cell {c} (counted from 0) is a {name}, which has {} points, but `offsets` gives it {}",
                element.count(),
                nodes.len()
            )));
        }
        for i in 0..nodes.len() {
            let node = nodes[order.get(i).copied().unwrap_or(i)];
            let place = whole(node).filter(|&node| node < points).ok_or_else(|| {
                damaged(format!(
                    "cell {c} (counted from 0) uses point {node}, but the points are 0 to {}",
                    points.saturating_sub(1)
                ))
            })?;
            self.nodes.push(base + place);
        }
        self.elements.push(element);
        Ok(())
    }

    fn nodes(&self, element: &Element) -> &[usize] {
        &self.nodes[element.first..element.first + element.count()]
    }

    fn mesh(mut self) -> Result<Mesh, MeshError> {
        let dim = self.elements.iter().map(Element::dim).max().unwrap_or(0);
        if dim < 2 {
            return Err(
                MeshError::new("the grid has neither surface nor solid cells").help(
                    "a mesh needs triangles or quadrilaterals (in 2D), or solid cells; results of \
                 interfaces hold points only: take the file of the bodies",
                ),
            );
        }
        let index = self.drop_unused(dim);
        let count = self.points.len();
        let mut mesh = Mesh {
            dim,
            point_ids: ids(&mut self.point_data, &POINT_IDS, count, index.len(), |p| {
                index[p].is_some()
            }),
            points: std::mem::take(&mut self.points),
            ..Mesh::default()
        };
        if dim == 2 {
            flatten(&mut mesh)?;
        }
        let solid: Vec<bool> = self.elements.iter().map(|e| e.dim() == dim).collect();
        let cell_count = solid.iter().filter(|&&solid| solid).count();
        let cell_ids = ids(
            &mut self.cell_data,
            &CELL_IDS,
            cell_count,
            solid.len(),
            |e| solid[e],
        );
        let cells = self.blocks(&mut mesh, cell_ids);
        self.sets(&mut mesh, &cells, &index)?;
        Ok(mesh)
    }

    /// Leaves the points that cells of the mesh use, and returns the new place of each of the old ones.
    fn drop_unused(&mut self, dim: usize) -> Vec<Option<usize>> {
        let mut used = vec![false; self.points.len()];
        for element in self.elements.iter().filter(|e| e.dim() == dim) {
            for &node in self.nodes(element) {
                used[node] = true;
            }
        }
        let mut next = 0;
        let index: Vec<Option<usize>> = used
            .iter()
            .map(|&used| {
                next += usize::from(used);
                used.then(|| next - 1)
            })
            .collect();
        let points = self.points.iter().zip(&used);
        self.points = points.filter(|(_, used)| **used).map(|(x, _)| *x).collect();
        // Elements on other points are of lower dimension: no point of theirs may be taken for another.
        for node in &mut self.nodes {
            *node = index[*node].unwrap_or(usize::MAX);
        }
        index
    }

    fn blocks(&self, mesh: &mut Mesh, ids: Vec<u64>) -> Vec<Option<CellRef>> {
        let mut cells = vec![None; self.elements.len()];
        let mut ids = ids.into_iter();
        for (e, element) in self.elements.iter().enumerate() {
            let Some(kind) = element.kind.filter(|kind| kind.dim() == mesh.dim) else {
                continue;
            };
            let block = mesh.blocks.iter().position(|b| b.kind == kind);
            let block = block.unwrap_or_else(|| {
                mesh.blocks.push(Block {
                    kind,
                    connectivity: Vec::new(),
                    cell_ids: Vec::new(),
                });
                mesh.blocks.len() - 1
            });
            let into = &mut mesh.blocks[block];
            into.connectivity.extend_from_slice(self.nodes(element));
            into.cell_ids.extend(ids.next());
            let cell = into.cell_ids.len() - 1;
            cells[e] = Some(CellRef { block, cell });
        }
        mend_wedges(mesh);
        if mesh.dim == 2
            && mesh
                .cells()
                .all(|cell| geometry::cell_measure(mesh, cell) < 0.0)
        {
            for block in &mut mesh.blocks {
                let order = turned(block.kind);
                for cell in block.connectivity.chunks_exact_mut(order.len()) {
                    let own = cell.to_vec();
                    for (node, &from) in cell.iter_mut().zip(order) {
                        *node = own[from];
                    }
                }
            }
        }
        cells
    }

    fn sets(
        &self,
        mesh: &mut Mesh,
        cells: &[Option<CellRef>],
        index: &[Option<usize>],
    ) -> Result<(), MeshError> {
        let facets: Vec<usize> = (0..self.elements.len())
            .filter(|&e| self.elements[e].dim() + 1 == mesh.dim)
            .collect();
        let faces = self.faces(mesh, &facets);
        for (name, members) in sets_of(&self.cell_data, self.elements.len()) {
            let mut points: [Vec<usize>; 4] = Default::default();
            for e in members {
                let element = &self.elements[e];
                let nodes = self.nodes(element).iter();
                points[element.dim()].extend(nodes.filter(|&&node| node != usize::MAX));
                if let Some(cell) = cells[e] {
                    mesh.cell_sets.entry(name.clone()).or_default().push(cell);
                } else if let Ok(at) = facets.binary_search(&e) {
                    // A sheet beside the bodies has no faces.
                    if let Some(facet) = faces[at] {
                        mesh.facet_sets.entry(name.clone()).or_default().push(facet);
                    }
                }
            }
            if let Some(points) = points.into_iter().find(|points| !points.is_empty()) {
                mesh.point_sets.insert(name, points);
            }
        }
        for (name, members) in sets_of(&self.point_data, index.len()) {
            let points: Vec<usize> = members.iter().filter_map(|&p| index[p]).collect();
            if !points.is_empty() {
                mesh.point_sets.insert(name, points);
            }
        }
        mesh.point_sets.values_mut().for_each(sort);
        mesh.cell_sets.values_mut().for_each(sort);
        mesh.facet_sets.values_mut().for_each(sort);
        Ok(())
    }

    /// The face that each of these elements lies on.
    fn faces(&self, mesh: &Mesh, facets: &[usize]) -> Vec<Option<crate::mesh::FacetRef>> {
        let nodes: Vec<&[usize]> = facets
            .iter()
            .map(|&e| self.nodes(&self.elements[e]))
            .collect();
        let faces = Faces::of(mesh, &nodes);
        let owner = |nodes: &&[usize]| faces.owner(mesh, nodes, false);
        nodes.iter().map(owner).collect()
    }
}

/// Turns linear wedges over that are inside out: most other programs write them in the order of Abaqus and Gmsh, not in VTK's.
fn mend_wedges(mesh: &mut Mesh) {
    let cells = mesh.cells().filter(|&cell| {
        mesh.cell_kind(cell) == ElementKind::Wedge6 && geometry::cell_measure(mesh, cell) < 0.0
    });
    for CellRef { block, cell } in cells.collect::<Vec<_>>() {
        let nodes = &mut mesh.blocks[block].connectivity[6 * cell..6 * cell + 6];
        nodes.swap(1, 2);
        nodes.swap(4, 5);
    }
}

fn sort<T: Ord>(set: &mut Vec<T>) {
    set.sort_unstable();
    set.dedup();
}

/// A whole number that is not negative.
fn whole(value: f64) -> Option<usize> {
    // Beyond 2^53 not every whole number is an f64, and no array is that long.
    ((0.0..9e15).contains(&value) && value.fract() == 0.0).then_some(value as usize)
}

/// Numbers by the first of these arrays that has one for all of `total` entries, for the `count` entries that are kept; it is
/// taken away, as it makes no sets. Otherwise 1, 2, ….
fn ids(
    data: &mut Data,
    names: &[&str],
    count: usize,
    total: usize,
    keep: impl Fn(usize) -> bool,
) -> Vec<u64> {
    let mut found = None;
    for name in names {
        let values = data.remove(*name).filter(|values| values.len() == total);
        found = found.or(values.filter(|values| values.iter().all(|&id| id >= 0)));
    }
    match found {
        Some(values) => (0..total)
            .filter(|&i| keep(i))
            .map(|i| values[i] as u64)
            .collect(),
        None => (1..=count as u64).collect(),
    }
}

/// The sets that arrays make, with the places of their members.
fn sets_of(data: &Data, count: usize) -> Vec<(String, Vec<usize>)> {
    let mut out = Vec::new();
    for (name, values) in data.iter().filter(|(_, values)| values.len() == count) {
        let mut by_value: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        for (i, &value) in values.iter().enumerate() {
            by_value.entry(value).or_default().push(i);
            if by_value.len() > MOST_SETS {
                break;
            }
        }
        if name.is_empty() || by_value.len() > MOST_SETS {
            continue;
        }
        if by_value.keys().all(|&value| value == 0 || value == 1) {
            out.extend(by_value.remove(&1).map(|members| (name.clone(), members)));
        } else {
            let sets = by_value.into_iter();
            out.extend(sets.map(|(value, members)| (format!("{name}-{value}"), members)));
        }
    }
    out
}

/// Sets `z` to zero in a plane mesh.
fn flatten(mesh: &mut Mesh) -> Result<(), MeshError> {
    let (lo, hi) = geometry::bounding_box(mesh).unwrap_or_default();
    // Rounding of a plane that was rotated into place must pass; a surface that bends must not.
    if hi[2] - lo[2] > 1e-10 * (hi[0] - lo[0]).max(hi[1] - lo[1]) {
        return Err(MeshError::new(format!(
            "the grid has no solid cells and is not planar: z is {:e} to {:e}",
            lo[2], hi[2]
        ))
        .help("a 3D mesh needs solid cells; a 2D mesh lies in a plane z = constant"));
    }
    mesh.points.iter_mut().for_each(|x| x[2] = 0.0);
    Ok(())
}
