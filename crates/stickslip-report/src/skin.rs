//! What can be seen of a grid: all cells in 2D, the boundary in 3D, cut into triangles, with the edges of the cells.

use std::collections::BTreeMap;

use stickslip::io::vtu::Grid;

/// Corners in order and, for quadratic faces, the midpoints behind them: positions among the points of a cell.
type Face = &'static [usize];

/// The faces of a cell by its VTK type; for cells in a plane the cell itself.
fn faces(kind: u8) -> (usize, &'static [Face]) {
    match kind {
        5 => (2, &[&[0, 1, 2]]),
        22 => (2, &[&[0, 1, 2, 3, 4, 5]]),
        9 => (2, &[&[0, 1, 2, 3]]),
        23 => (2, &[&[0, 1, 2, 3, 4, 5, 6, 7]]),
        // A quadratic quadrilateral with a centre, which is not needed.
        28 => (2, &[&[0, 1, 2, 3, 4, 5, 6, 7]]),
        10 => (3, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]),
        24 => (
            3,
            &[
                &[0, 2, 1, 6, 5, 4],
                &[0, 1, 3, 4, 8, 7],
                &[1, 2, 3, 5, 9, 8],
                &[2, 0, 3, 6, 7, 9],
            ],
        ),
        12 => (
            3,
            &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        ),
        25 | 29 => (
            3,
            &[
                &[0, 3, 2, 1, 11, 10, 9, 8],
                &[4, 5, 6, 7, 12, 13, 14, 15],
                &[0, 1, 5, 4, 8, 17, 12, 16],
                &[1, 2, 6, 5, 9, 18, 13, 17],
                &[2, 3, 7, 6, 10, 19, 14, 18],
                &[3, 0, 4, 7, 11, 16, 15, 19],
            ],
        ),
        // VTK's linear wedge has its first triangle facing out of the cell, its quadratic one facing in.
        13 => (
            3,
            &[
                &[0, 1, 2],
                &[3, 5, 4],
                &[0, 3, 4, 1],
                &[1, 4, 5, 2],
                &[2, 5, 3, 0],
            ],
        ),
        26 => (
            3,
            &[
                &[0, 2, 1, 8, 7, 6],
                &[3, 4, 5, 9, 10, 11],
                &[0, 1, 4, 3, 6, 13, 9, 12],
                &[1, 2, 5, 4, 7, 14, 10, 13],
                &[2, 0, 3, 5, 8, 12, 11, 14],
            ],
        ),
        _ => (0, &[]),
    }
}

/// Triangles of a face, as positions in it. Those of quadratic faces take the midpoints in.
fn triangles(nodes: usize) -> &'static [[usize; 3]] {
    match nodes {
        3 => &[[0, 1, 2]],
        4 => &[[0, 1, 2], [0, 2, 3]],
        6 => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        _ => &[
            [0, 4, 7],
            [4, 1, 5],
            [5, 2, 6],
            [6, 3, 7],
            [4, 5, 6],
            [4, 6, 7],
        ],
    }
}

/// Number of corners of a face.
fn corners(nodes: usize) -> usize {
    match nodes {
        3 | 6 => 3,
        _ => 4,
    }
}

/// What can be seen of the bodies. Indices of triangles and lines are positions in `points`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skin {
    /// 2 or 3; 0 if there is nothing to see.
    pub dim: usize,
    /// The points of the grid that can be seen.
    pub points: Vec<usize>,
    /// Their coordinates before any motion, shape `(n, 3)` `[length]`.
    pub positions: Vec<[f64; 3]>,
    /// Triangles, those of a body together.
    pub triangles: Vec<[u32; 3]>,
    /// Edges of cells, without diagonals, those of a body together.
    pub edges: Vec<[u32; 2]>,
    /// In 2D the edges at the rim of the bodies, the body at the left of each; empty in 3D.
    pub rim: Vec<[u32; 2]>,
    /// The body of each point.
    pub owner: Vec<u32>,
    /// Where the triangles and the edges of each body end.
    pub ends: Vec<[usize; 2]>,
}

/// A face of a cell: the body, its points.
struct Seen {
    body: usize,
    points: Vec<usize>,
}

impl Skin {
    /// The skin of a grid. The number of the body is the cell array `BODY`; without it all is one body.
    pub fn of(grid: &Grid) -> Self {
        let dim = grid.types.iter().map(|&t| faces(t).0).max().unwrap_or(0);
        let owners = grid.cell_arrays.get("BODY").map(|a| &a.values);
        let body = |i: usize| owners.map_or(0, |o| o[i].max(0.0) as usize);
        let mut seen = Vec::new();
        // By sorted corners: a face between two cells is met twice. Three corners have an end that no point has.
        let mut met: Vec<([usize; 4], usize, usize)> = Vec::new();
        for (i, &kind) in grid.types.iter().enumerate() {
            let (of, faces) = faces(kind);
            let cell = grid.cell(i);
            // Cells of a lower dimension are supports or loads of other programs; those with too few points are damaged.
            let whole = |face: &Face| face.iter().all(|&k| k < cell.len());
            if of != dim || !faces.iter().all(whole) {
                continue;
            }
            for (k, face) in faces.iter().enumerate() {
                let mut key = [usize::MAX; 4];
                let n = corners(face.len());
                for (slot, &corner) in key[..n].iter_mut().zip(&face[..n]) {
                    *slot = cell[corner];
                }
                key[..n].sort_unstable();
                met.push((key, i, k));
            }
        }
        if dim == 3 {
            met.sort_unstable();
        }
        for same in met.chunk_by(|a, b| dim == 3 && a.0 == b.0) {
            if let [(_, i, k)] = same {
                let cell = grid.cell(*i);
                let (_, faces) = faces(grid.types[*i]);
                seen.push(Seen {
                    body: body(*i),
                    points: faces[*k].iter().map(|&k| cell[k]).collect(),
                });
            }
        }
        seen.sort_by_key(|face| face.body);
        Skin::from_faces(grid, dim, &seen)
    }

    fn from_faces(grid: &Grid, dim: usize, seen: &[Seen]) -> Self {
        let mut skin = Skin {
            dim,
            ..Skin::default()
        };
        let mut known = vec![u32::MAX; grid.points.points.len()];
        let bodies = seen.last().map_or(0, |f| f.body + 1);
        let mut rest = seen;
        for body in 0..bodies {
            let (own, others) = rest.split_at(rest.partition_point(|f| f.body == body));
            rest = others;
            // How often an edge is met, once at the rim, and its direction around the cell.
            let mut edges: BTreeMap<[u32; 2], (usize, [u32; 2])> = BTreeMap::new();
            for face in own {
                let local: Vec<u32> = face
                    .points
                    .iter()
                    .map(|&p| {
                        if known[p] == u32::MAX {
                            known[p] = skin.points.len() as u32;
                            skin.points.push(p);
                            skin.positions.push(grid.points.points[p]);
                            skin.owner.push(body as u32);
                        }
                        known[p]
                    })
                    .collect();
                let nodes = local.len();
                for t in triangles(nodes) {
                    skin.triangles.push(t.map(|k| local[k]));
                }
                let n = corners(nodes);
                let mut edge = |a: u32, b: u32| {
                    let met = edges.entry([a.min(b), a.max(b)]);
                    met.or_insert((0, [a, b])).0 += 1;
                };
                for k in 0..n {
                    let (a, b) = (local[k], local[(k + 1) % n]);
                    match nodes > n {
                        true => {
                            edge(a, local[n + k]);
                            edge(local[n + k], b);
                        }
                        false => edge(a, b),
                    }
                }
            }
            if dim == 2 {
                let rim = edges.values().filter(|(times, _)| *times == 1);
                skin.rim.extend(rim.map(|(_, edge)| *edge));
            }
            skin.edges.extend(edges.into_keys());
            skin.ends.push([skin.triangles.len(), skin.edges.len()]);
        }
        skin
    }

    /// The triangles of a body.
    pub fn triangles_of(&self, body: usize) -> &[[u32; 3]] {
        let start = if body == 0 { 0 } else { self.ends[body - 1][0] };
        &self.triangles[start..self.ends[body][0]]
    }

    /// The edges of a body.
    pub fn edges_of(&self, body: usize) -> &[[u32; 2]] {
        let start = if body == 0 { 0 } else { self.ends[body - 1][1] };
        &self.edges[start..self.ends[body][1]]
    }

    /// The box around all points: lowest and highest corner.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        around(self.positions.iter())
    }

    /// The box around the points of a body.
    pub fn bounds_of(&self, body: usize) -> [[f64; 3]; 2] {
        let all = self.positions.iter().zip(&self.owner);
        around(all.filter(|(_, b)| **b as usize == body).map(|(x, _)| x))
    }

    /// The diagonal of that box `[length]`.
    pub fn size(&self) -> f64 {
        let [low, high] = self.bounds();
        let square: f64 = (0..3).map(|c| (high[c] - low[c]).powi(2)).sum();
        if square.is_finite() {
            square.sqrt()
        } else {
            0.0
        }
    }
}

fn around<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for x in points {
        for c in 0..3 {
            bounds[0][c] = bounds[0][c].min(x[c]);
            bounds[1][c] = bounds[1][c].max(x[c]);
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::io::vtu::PointFields;

    fn grid(points: Vec<[f64; 3]>, cells: &[(u8, &[usize])]) -> Grid {
        let mut grid = Grid {
            points: PointFields {
                points,
                ..PointFields::default()
            },
            ..Grid::default()
        };
        for (kind, cell) in cells {
            grid.types.push(*kind);
            grid.connectivity.extend(*cell);
            grid.offsets.push(grid.connectivity.len());
        }
        grid
    }

    fn volume(skin: &Skin) -> f64 {
        let x = |i: u32| skin.positions[i as usize];
        let triangles = skin.triangles.iter();
        triangles
            .map(|&[a, b, c]| {
                let (a, b, c) = (x(a), x(b), x(c));
                (a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]))
                    / 6.0
            })
            .sum()
    }

    /// Midpoints of these edges behind the corners.
    fn with_midpoints(mut x: Vec<[f64; 3]>, edges: &[[usize; 2]]) -> Vec<[f64; 3]> {
        for &[a, b] in edges {
            x.push([0, 1, 2].map(|c| (x[a][c] + x[b][c]) / 2.0));
        }
        x
    }

    #[test]
    fn faces_of_all_solid_cells_close_and_point_outwards() {
        let tet = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        let hex: Vec<[f64; 3]> = (0..8)
            .map(|i| {
                let (x, z) = (
                    if [1, 2].contains(&(i % 4)) { 1. } else { 0. },
                    (i / 4) as f64,
                );
                [x, if i % 4 >= 2 { 1. } else { 0. }, z]
            })
            .collect();
        // Of the linear wedge the first triangle faces out, of the quadratic one in.
        let wedge = vec![
            [0., 0., 0.],
            [0., 1., 0.],
            [1., 0., 0.],
            [0., 0., 1.],
            [0., 1., 1.],
            [1., 0., 1.],
        ];
        let inward = [0, 2, 1, 3, 5, 4].map(|i: usize| wedge[i]).to_vec();
        let tet_edges = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
        let hex_edges = [
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [4, 5],
            [5, 6],
            [6, 7],
            [7, 4],
            [0, 4],
            [1, 5],
            [2, 6],
            [3, 7],
        ];
        let wedge_edges = [
            [0, 1],
            [1, 2],
            [2, 0],
            [3, 4],
            [4, 5],
            [5, 3],
            [0, 3],
            [1, 4],
            [2, 5],
        ];
        for (kind, points, volume_of, edges) in [
            (10, tet.clone(), 1. / 6., 6),
            (24, with_midpoints(tet, &tet_edges), 1. / 6., 12),
            (12, hex.clone(), 1., 12),
            (25, with_midpoints(hex, &hex_edges), 1., 24),
            (13, wedge.clone(), 0.5, 9),
            (26, with_midpoints(inward, &wedge_edges), 0.5, 18),
        ] {
            let cell: Vec<usize> = (0..points.len()).collect();
            let skin = Skin::of(&grid(points, &[(kind, &cell)]));
            assert_eq!(skin.dim, 3);
            let found = volume(&skin);
            assert!((found - volume_of).abs() < 1e-12, "{kind}: {found}");
            assert_eq!(skin.edges.len(), edges, "{kind}");
        }
    }

    #[test]
    fn what_is_between_two_cells_is_not_seen() {
        let points = (0..12)
            .map(|i| [(i % 3) as f64, (i / 3 % 2) as f64, (i / 6) as f64])
            .collect();
        let cells: [(u8, &[usize]); 2] = [
            (12, &[0, 1, 4, 3, 6, 7, 10, 9]),
            (12, &[1, 2, 5, 4, 7, 8, 11, 10]),
        ];
        let mut grid = grid(points, &cells);
        let skin = Skin::of(&grid);
        assert_eq!(skin.triangles.len(), 2 * 10);
        assert_eq!(skin.ends, [[20, 20]]);
        assert!((volume(&skin) - 2.0).abs() < 1e-12);
        // Cells of no known kind, and bodies without cells, are passed over.
        grid.types[1] = 99;
        assert_eq!(Skin::of(&grid).triangles.len(), 12);
        grid.types[0] = 99;
        assert_eq!(Skin::of(&grid), Skin::default());
    }

    #[test]
    fn in_a_plane_all_cells_are_seen_and_the_rim_is_known() {
        let points = (0..6)
            .map(|i| [(i % 3) as f64, (i / 3) as f64, 0.])
            .collect();
        let skin = Skin::of(&grid(
            points,
            &[(9, &[0, 1, 4, 3]), (5, &[1, 2, 5]), (5, &[1, 5, 4])],
        ));
        assert_eq!(skin.dim, 2);
        assert_eq!(skin.triangles.len(), 4);
        assert_eq!(skin.edges.len(), 8);
        assert_eq!(skin.rim.len(), 6);
        // The body is at the left: around it once, against the clock.
        let around: f64 = (skin.rim.iter())
            .map(|e| e.map(|i| skin.positions[i as usize]))
            .map(|[a, b]| (a[0] * b[1] - b[0] * a[1]) / 2.0)
            .sum();
        assert!((around - 2.0).abs() < 1e-12);
        assert_eq!(skin.bounds(), [[0., 0., 0.], [2., 1., 0.]]);
    }
}
