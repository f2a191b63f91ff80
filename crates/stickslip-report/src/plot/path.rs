//! A field along a straight line through the bodies.

use stickslip::Error;
use stickslip::io::csv::Table;
use stickslip::io::vtu::Grid;
use stickslip::math::{add_scaled, distance, inverse, mat_vec, norm, sub};
use stickslip::shape::{ElementKind, MAX_NODES};

use super::axis;
use super::files::chosen;
use super::picture::When;
use super::scene::choose;
use crate::results::{Results, fault};

type Vec3 = [f64; 3];

/// A line through the bodies before any displacement, and what is shown along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Where it begins and ends `[length]`.
    pub ends: [Vec3; 2],
    /// The field; what pictures show if not given.
    pub field: Option<String>,
    /// Which times.
    pub when: When,
}

/// Places along the line.
const PLACES: usize = 401;

/// Newton steps that find a place in a cell; two or three do.
const MOST_STEPS: usize = 20;

/// How far out of a cell a place still belongs to it, in its reference coordinates.
const ROOM: f64 = 1e-6;

/// A place on the line: the points around it and their weights.
type Around = Vec<(usize, f64)>;

/// The table: length along the line, and a column a time; NaN where there is no body.
///
/// # Errors
/// [`Error::Io`] where there is no such field or time, or the line meets no body.
pub fn table(results: &Results, line: &Line) -> Result<Table, Error> {
    let frames = chosen(results, line.when, line.field.as_deref())?;
    let grid = results.grid(frames[0])?;
    let Some(field) = choose(results, &grid, line.field.as_deref())? else {
        return Err(fault(&results.directory, "there is no field"));
    };
    let [from, to] = line.ends;
    let length = distance(from, to);
    let place = |k: usize| k as f64 / (PLACES - 1) as f64;
    let near: Vec<(usize, [Vec3; 2])> = (0..grid.types.len())
        .map(|cell| (cell, room_of(&grid, cell)))
        .filter(|(_, [low, high])| {
            (0..3).all(|c| from[c].max(to[c]) >= low[c] && from[c].min(to[c]) <= high[c])
        })
        .collect();
    let on_line: Vec<Option<Around>> = (0..PLACES)
        .map(|k| around(&grid, &near, add_scaled(from, place(k), sub(to, from))))
        .collect();
    if on_line.iter().all(Option::is_none) {
        return Err(fault(
            &results.directory,
            "the line meets no body: its ends are places before any displacement, `0,0,0:10,0,0`",
        ));
    }
    let mut table = Table::default();
    table.names.push("S".into());
    let lengths = (0..PLACES).map(|k| place(k) * length);
    table.columns.push(lengths.collect());
    for &frame in &frames {
        let points = results.points(frame)?;
        let array = points.arrays.get(&field.array);
        let value = |around: &Option<Around>| match (around, array) {
            (Some(around), Some(array)) => {
                let parts = around.iter().map(|&(p, w)| w * field.value(array, p));
                parts.sum()
            }
            _ => f64::NAN,
        };
        let time = axis::number(results.frames[frame].time, 5);
        table.names.push(format!("{} at {time}", field.name));
        table.columns.push(on_line.iter().map(value).collect());
    }
    Ok(table)
}

/// Lowest and highest coordinates that a cell may have; quadratic ones may bulge beyond their nodes.
fn room_of(grid: &Grid, cell: usize) -> [Vec3; 2] {
    let points = grid.cell(cell).iter().map(|&p| grid.points.points[p]);
    let [low, high] = points.fold([[f64::MAX; 3], [f64::MIN; 3]], |[low, high], p| {
        [0, 1].map(|end| {
            std::array::from_fn(|c| match end {
                0 => f64::min(low[c], p[c]),
                _ => f64::max(high[c], p[c]),
            })
        })
    });
    let room = [0, 1, 2].map(|c| 0.25 * (high[c] - low[c]) + ROOM);
    [
        std::array::from_fn(|c| low[c] - room[c]),
        std::array::from_fn(|c| high[c] + room[c]),
    ]
}

/// The points of the cell that a place is in, of these cells, and their weights; `None` outside of all.
fn around(grid: &Grid, cells: &[(usize, [Vec3; 2])], x: Vec3) -> Option<Around> {
    cells.iter().find_map(|(cell, [low, high])| {
        if (0..3).any(|c| x[c] < low[c] || x[c] > high[c]) {
            return None;
        }
        let (kind, nodes) = grid.element(*cell)?;
        let places: Vec<Vec3> = nodes.iter().map(|&p| grid.points.points[p]).collect();
        let weights = weights(kind, &places, x)?;
        Some(nodes.into_iter().zip(weights).collect())
    })
}

/// Shape functions of a cell at a place in it; `None` if the place is outside.
fn weights(kind: ElementKind, nodes: &[Vec3], x: Vec3) -> Option<Vec<f64>> {
    let (reference, dim) = (kind.reference(), kind.dim());
    let (mut n, mut d) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    let (n, d) = (&mut n[..nodes.len()], &mut d[..nodes.len()]);
    let mut xi = kind.centre();
    for _ in 0..MOST_STEPS {
        reference.values(xi, n);
        reference.gradients(xi, d);
        let mut rest = x;
        // Out of the plane a plane cell is as thick as need be.
        let mut jacobian: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| f64::from(u8::from(i == j && i >= dim)))
        });
        for ((x, n), d) in nodes.iter().zip(n.iter()).zip(d.iter()) {
            for i in 0..dim {
                rest[i] -= n * x[i];
                for j in 0..dim {
                    jacobian[i][j] += x[i] * d[j];
                }
            }
        }
        (dim..3).for_each(|c| rest[c] = 0.0);
        let step = mat_vec(&inverse(&jacobian)?.0, rest);
        xi = add_scaled(xi, 1.0, step);
        if norm(step) <= 1e-12 {
            break;
        }
    }
    inside(kind, xi).then(|| {
        reference.values(xi, n);
        n.to_vec()
    })
}

/// Whether reference coordinates are those of a place in a cell.
fn inside(kind: ElementKind, xi: Vec3) -> bool {
    let line = |v: f64| v.abs() <= 1.0 + ROOM;
    let simplex =
        |xi: &[f64]| xi.iter().all(|v| *v >= -ROOM) && xi.iter().sum::<f64>() <= 1.0 + ROOM;
    match kind.linear() {
        ElementKind::Tri3 => simplex(&xi[..2]),
        ElementKind::Tet4 => simplex(&xi),
        ElementKind::Wedge6 => simplex(&xi[..2]) && line(xi[2]),
        other => xi[..other.dim()].iter().all(|v| line(*v)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_in_all_cells() {
        for kind in ElementKind::ALL.into_iter().filter(|k| k.dim() > 1) {
            // A cell that is turned, stretched and moved: places follow linearly.
            let map = |xi: Vec3| -> Vec3 {
                match kind.dim() {
                    2 => [3.0 + 2.0 * xi[0] - xi[1], 1.0 + xi[0] + 0.5 * xi[1], 0.0],
                    _ => [
                        3.0 + 2.0 * xi[0] - xi[1],
                        1.0 + xi[0] + xi[2],
                        0.5 * xi[1] + 2.0 * xi[2],
                    ],
                }
            };
            let reference = kind.reference().nodes();
            let nodes: Vec<Vec3> = reference.iter().map(|&xi| map(xi)).collect();
            let [a, b, c] = kind.centre();
            let there = [0.8 * a + 0.05, 0.9 * b, 0.7 * c];
            let weights = weights(kind, &nodes, map(there)).expect("it is inside");
            let found = reference
                .iter()
                .zip(&weights)
                .fold([0.0; 3], |sum, (xi, w)| add_scaled(sum, *w, *xi));
            assert!(
                distance(found, there) < 1e-10,
                "{kind:?} {found:?} {there:?}"
            );
            assert!(
                super::weights(kind, &nodes, map([1.2, 1.1, 0.0])).is_none(),
                "{kind:?}"
            );
        }
    }
}
