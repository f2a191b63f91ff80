//! Cuts through a mesh: points on some faces inside are doubled, so that the cells on both sides come apart.

use std::collections::{BTreeMap, BTreeSet};

use super::{CellRef, FacetRef, Mesh};
use crate::error::MeshError;
use crate::math::{Vec3, add, distance, dot, scale, sub};
use crate::number::digits;
use crate::tolerance::SAME;

/// A cut through a mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cut {
    /// The faces of the cells on the near side; their normals point to the far one.
    pub near: Vec<FacetRef>,
    /// The same faces of the cells on the far side.
    pub far: Vec<FacetRef>,
    /// Points on the near side, ascending, each with the one on the far side at the same place.
    pub pairs: Vec<[usize; 2]>,
}

/// The faces between cells whose centres lie on different sides of a plane, as faces of the cells against the normal; of several parts that share no
/// point the one nearest to `point`. Where faces lie on the plane these are they, elsewhere the layer of faces that is nearest.
///
/// # Errors
/// If the plane cuts none of the cells off the others.
pub fn faces_along(
    mesh: &Mesh,
    cells: &[CellRef],
    point: Vec3,
    normal: Vec3,
) -> Result<Vec<FacetRef>, MeshError> {
    let of: BTreeSet<CellRef> = cells.iter().copied().collect();
    let height = |c: &CellRef| dot(sub(centre(mesh, mesh.cell_points(*c)), point), normal);
    let heights = cells.iter().map(height);
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| {
        [low.min(h), high.max(h)]
    });
    // Cells whose centres lie on the plane are below it, whatever rounding says: otherwise it would run over some of a row and under others.
    let above = |facet: &FacetRef| height(&facet.cell) > SAME * (high - low);
    let mut found = Vec::new();
    for users in mesh.shared_faces().chunk_by(|a, b| a.0 == b.0) {
        let [(_, a), (_, b)] = users else { continue };
        if !of.contains(&a.cell) || !of.contains(&b.cell) {
            continue;
        }
        match (above(a), above(b)) {
            (false, true) => found.push(*a),
            (true, false) => found.push(*b),
            _ => {}
        }
    }
    if found.is_empty() {
        return Err(
            MeshError::new("the plane does not run between cells").help(format!(
                "along the normal the centres of cells lie from {low} to {high} of the point: move it between two layers of them",
                low = digits(low, 5),
                high = digits(high, 5),
            )),
        );
    }
    Ok(nearest_part(mesh, found, point))
}

/// The part of some faces that is nearest to a place, parts sharing no points.
fn nearest_part(mesh: &Mesh, faces: Vec<FacetRef>, place: Vec3) -> Vec<FacetRef> {
    let points: Vec<Vec<usize>> = faces.iter().map(|f| mesh.facet_points(*f).1).collect();
    let mut parts = Parts::new(mesh.points.len());
    points.iter().for_each(|list| parts.join(list));
    let away = |list: &Vec<usize>| distance(centre(mesh, list), place);
    let nearest = points.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    let wanted = nearest.map(|list| parts.root(list[0]));
    let own = faces.iter().zip(&points);
    own.filter(|(_, list)| Some(parts.root(list[0])) == wanted)
        .map(|(f, _)| *f)
        .collect()
}

fn centre(mesh: &Mesh, points: &[usize]) -> Vec3 {
    let sum = points.iter().fold([0.0; 3], |s, &p| add(s, mesh.points[p]));
    scale(1.0 / points.len().max(1) as f64, sum)
}

/// Cuts the mesh along faces inside, given as those of the cells on the near side. Points there are doubled for the cells on the far side; the new
/// ones follow all others, and are in the sets of points that the old ones are in. Their numbers follow the largest.
///
/// # Errors
/// A face that has a cell on one side only, or a cut that ends inside the mesh, so that it does not part the cells there.
pub fn cut(mesh: &mut Mesh, near: &[FacetRef]) -> Result<Cut, MeshError> {
    let mut cut = Cut {
        near: near.to_vec(),
        far: across(mesh, near)?,
        pairs: Vec::new(),
    };
    let points = mesh.points_of_facets(near);
    let sides = sides(mesh, &cut, &points)?;
    let next = mesh.point_ids.iter().max().map_or(0, |n| n + 1);
    for (&p, far) in points.iter().zip(&sides) {
        let q = mesh.points.len();
        mesh.points.push(mesh.points[p]);
        mesh.point_ids.push(next + cut.pairs.len() as u64);
        cut.pairs.push([p, q]);
        for cell in far {
            let block = &mut mesh.blocks[cell.block];
            let count = block.kind.node_count();
            let nodes = &mut block.connectivity[cell.cell * count..(cell.cell + 1) * count];
            nodes.iter_mut().filter(|n| **n == p).for_each(|n| *n = q);
        }
    }
    for set in mesh.point_sets.values_mut() {
        let of_set: BTreeSet<usize> = set.iter().copied().collect();
        let doubled = cut.pairs.iter().filter(|[p, _]| of_set.contains(p));
        set.extend(doubled.map(|[_, q]| *q));
    }
    Ok(cut)
}

/// The same faces as those of the cells on the other side.
///
/// # Errors
/// A face that has a cell on one side only.
pub fn across(mesh: &Mesh, near: &[FacetRef]) -> Result<Vec<FacetRef>, MeshError> {
    let mut other: BTreeMap<FacetRef, FacetRef> = BTreeMap::new();
    for users in mesh.shared_faces().chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a), (_, b)] = users {
            other.insert(*a, *b);
            other.insert(*b, *a);
        }
    }
    let partner = |f: &FacetRef| {
        other.get(f).copied().ok_or_else(|| {
            MeshError::new(format!(
                "a face of cell {} lies on the surface: there is nothing beyond it",
                mesh.cell_id(f.cell)
            ))
            .help("the cut runs through the inside, along faces that two cells share")
        })
    };
    near.iter().map(partner).collect()
}

/// The cells on the far side around each of the points of a cut: those that hang together there with the cells behind it.
fn sides(mesh: &Mesh, cut: &Cut, points: &[usize]) -> Result<Vec<Vec<CellRef>>, MeshError> {
    let apart: BTreeSet<FacetRef> = cut.near.iter().chain(&cut.far).copied().collect();
    // The points of the cut that each cell has on its faces.
    let of_cells = |list: &[FacetRef]| {
        let mut own: BTreeMap<CellRef, BTreeSet<usize>> = BTreeMap::new();
        for f in list {
            own.entry(f.cell)
                .or_default()
                .extend(mesh.facet_points(*f).1);
        }
        own
    };
    let (before, behind) = (of_cells(&cut.near), of_cells(&cut.far));
    let has = |own: &BTreeMap<CellRef, BTreeSet<usize>>, c: &CellRef, p: usize| {
        own.get(c).is_some_and(|list| list.contains(&p))
    };
    let mut around: BTreeMap<usize, Vec<CellRef>> =
        points.iter().map(|p| (*p, Vec::new())).collect();
    for cell in mesh.cells() {
        for p in mesh.cell_points(cell) {
            if let Some(list) = around.get_mut(p) {
                list.push(cell);
            }
        }
    }
    // Neighbours across faces that are not cut, by cell, with the points of the face.
    let mut joined: BTreeMap<CellRef, Vec<(CellRef, Vec<usize>)>> = BTreeMap::new();
    let near: BTreeSet<CellRef> = around.values().flatten().copied().collect();
    for users in mesh.shared_faces().chunk_by(|a, b| a.0 == b.0) {
        let [(_, a), (_, b)] = users else { continue };
        if apart.contains(a) || !near.contains(&a.cell) || !near.contains(&b.cell) {
            continue;
        }
        let face = mesh.facet_points(*a).1;
        joined
            .entry(a.cell)
            .or_default()
            .push((b.cell, face.clone()));
        joined.entry(b.cell).or_default().push((a.cell, face));
    }
    let at = |p: usize| -> Result<Vec<CellRef>, MeshError> {
        let mine = &around[&p];
        let mut far: BTreeSet<CellRef> = BTreeSet::new();
        let mut next: Vec<CellRef> = mine
            .iter()
            .copied()
            .filter(|c| has(&behind, c, p))
            .collect();
        while let Some(cell) = next.pop() {
            if !far.insert(cell) {
                continue;
            }
            let neighbours = joined.get(&cell).into_iter().flatten();
            next.extend(
                neighbours
                    .filter(|(_, face)| face.contains(&p))
                    .map(|(c, _)| *c),
            );
        }
        if far.iter().any(|c| has(&before, c, p)) {
            let x = mesh.points[p];
            return Err(MeshError::new(format!(
                "the cut ends inside at ({:.6}, {:.6}, {:.6}): cells hang together around it there",
                x[0], x[1], x[2]
            ))
            .help("a cut runs through the whole section, from surface to surface"));
        }
        Ok(far.into_iter().collect())
    };
    points.iter().map(|&p| at(p)).collect()
}

/// The parts of some cells that share no points, by their points, ascending; that of the lowest point first.
pub fn pieces(mesh: &Mesh, cells: &[CellRef]) -> Vec<Vec<usize>> {
    let mut joined = Parts::new(mesh.points.len());
    cells.iter().for_each(|c| joined.join(mesh.cell_points(*c)));
    let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for p in mesh.points_of_cells(cells) {
        parts.entry(joined.root(p)).or_default().push(p);
    }
    parts.into_values().collect()
}

/// Points that hang together.
struct Parts(Vec<usize>);

impl Parts {
    fn new(points: usize) -> Self {
        Parts((0..points).collect())
    }

    /// The least point of its part.
    fn root(&mut self, mut p: usize) -> usize {
        while self.0[p] != p {
            self.0[p] = self.0[self.0[p]];
            p = self.0[p];
        }
        p
    }

    fn join(&mut self, points: &[usize]) {
        for pair in points.windows(2) {
            let (a, b) = (self.root(pair[0]), self.root(pair[1]));
            self.0[a.max(b)] = a.min(b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};
    use super::*;
    use crate::mesh::check;
    use crate::mesh::combine;
    use crate::mesh::geometry;

    fn grid() -> Mesh {
        let mut mesh = Rectangle::new([0.0, 0.0], [4.0, 2.0], [4, 2])
            .generate()
            .unwrap();
        mesh.point_sets
            .insert("all".into(), (0..mesh.points.len()).collect());
        mesh
    }

    fn all(mesh: &Mesh) -> Vec<CellRef> {
        mesh.cells().collect()
    }

    #[test]
    fn a_plane_through_centres_of_cells_runs_above_them() {
        for off in [0.0, 1e-14, -1e-14] {
            let mut mesh = grid();
            // Centres are off by rounding, not all to one side.
            for (i, x) in mesh.points.iter_mut().enumerate() {
                x[0] += off * (i as f64).sin();
            }
            let faces = faces_along(&mesh, &all(&mesh), [1.5, 0.0, 0.0], [1.0, 0.0, 0.0]);
            let cut = cut(&mut mesh, &faces.unwrap()).unwrap();
            let on = |p: usize| (mesh.points[p][0] - 2.0).abs() < 1e-9;
            assert_eq!(cut.pairs.len(), 3, "{off}");
            assert!(cut.pairs.iter().all(|[p, _]| on(*p)), "{off}");
        }
    }

    #[test]
    fn a_plane_near_a_layer_of_faces_parts_the_cells_there() {
        let mut mesh = grid();
        let whole = geometry::measure(&mesh);
        let faces = faces_along(&mesh, &all(&mesh), [1.2, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let cut = cut(&mut mesh, &faces.unwrap()).unwrap();
        assert_eq!(cut.pairs.len(), 3);
        for [p, q] in &cut.pairs {
            assert_eq!(mesh.points[*p], mesh.points[*q]);
            assert_eq!(mesh.points[*p][0], 1.0);
        }
        check::check(&mesh).unwrap();
        assert_eq!(geometry::measure(&mesh), whole);
        assert_eq!(mesh.boundary().len(), 12 + 4);
        let pieces = pieces(&mesh, &all(&mesh));
        assert_eq!(pieces.iter().map(Vec::len).collect::<Vec<_>>(), [6, 12]);
        assert!(
            cut.pairs
                .iter()
                .all(|[p, q]| pieces[0].contains(p) && pieces[1].contains(q))
        );
        // Sets hold both, and so do surfaces that the cut meets.
        assert_eq!(mesh.point_sets["all"].len(), 18);
        assert_eq!(mesh.facet_set_points("bottom").unwrap().len(), 6);
        let mut ids = mesh.point_ids.clone();
        ids.dedup();
        assert_eq!(ids.len(), 18);
    }

    #[test]
    fn of_several_parts_that_a_plane_runs_through_the_nearest_is_cut() {
        let mut mesh = grid();
        // two legs below a beam: the lower row without its middle
        let legs: Vec<CellRef> = all(&mesh)
            .into_iter()
            .filter(|c| ![1, 2].contains(&c.cell))
            .collect();
        mesh = combine::extract(&mesh, &legs);
        let cells = all(&mesh);
        let faces = faces_along(&mesh, &cells, [4.0, 1.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        let cut = cut(&mut mesh, &faces).unwrap();
        let x: Vec<f64> = cut.pairs.iter().map(|[p, _]| mesh.points[*p][0]).collect();
        assert_eq!(x, [3.0, 4.0]);
        assert_eq!(pieces(&mesh, &cells).len(), 2);
    }

    #[test]
    fn cuts_that_end_inside_or_run_along_the_surface_are_refused() {
        let mesh = grid();
        let faces = faces_along(&mesh, &all(&mesh), [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]).unwrap();
        let e = cut(&mut mesh.clone(), &faces[..1]).unwrap_err();
        assert!(
            e.message.starts_with("the cut ends inside at (2.0"),
            "{e:?}"
        );
        let e = cut(&mut mesh.clone(), &mesh.facet_sets["left"]).unwrap_err();
        assert!(e.message.contains("lies on the surface"), "{e:?}");
        let e = faces_along(&mesh, &all(&mesh), [0.1, 0.0, 0.0], [1.0, 0.0, 0.0]).unwrap_err();
        assert!(e.help.unwrap().contains("from 0.4 to 3.4"));
    }
}
