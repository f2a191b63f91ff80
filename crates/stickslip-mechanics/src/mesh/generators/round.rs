//! Discs and balls as a square or cubic core with layers around it.
//!
//! The core is a grid on `[-1, 1]^dim`, or a part of it that ends at planes of symmetry. On each outer side of the
//! core layers of cells lead to the sphere along straight rays; a core point with coordinate `X` belongs to the
//! direction with components `tan(π X / 4)`, so that equal steps of `X` are equal angles. The last direction is the
//! axis through the contact point, which is the lower pole.

use std::f64::consts::FRAC_PI_4;

use super::grading::affordable;
use super::lattice::{Diagonal, Key, Lattice, LatticeCell, MOST_CELLS, at};
use super::round_options::{Refinement, Sizes};
use crate::error::MeshError;
use crate::math::{Vec3, add_scaled, cross, dot, normalize, scale};
use crate::mesh::Mesh;
use crate::shape::ElementKind;

/// A round body, as the generators describe it.
pub(super) struct Round {
    /// 2 or 3.
    pub dim: usize,
    /// Centre of the circle or sphere `[length]`.
    pub centre: Vec3,
    /// `[length]`
    pub radius: f64,
    /// From the centre to the contact point; need not be a unit vector.
    pub direction: Vec3,
    /// Largest size of the cells `[length]`.
    pub size: Option<f64>,
    /// Smaller ones at the contact point.
    pub refine: Option<Refinement>,
    /// Their kind.
    pub element: ElementKind,
    /// Cut at the middle in each lateral direction (the last entry in 2D is of no effect).
    pub symmetric: [bool; 2],
    /// Only the half with the contact point.
    pub half: bool,
}

/// Half-width of the core over the radius: the layers keep some thickness at the core's corners.
fn waist(dim: usize) -> f64 {
    if dim == 2 { 0.5 } else { 0.42 }
}

/// Where the local directions point: lateral ones first, then away from the contact point.
struct Frame {
    axes: [Vec3; 3],
    left_handed: bool,
}

/// The lateral directions stay as near to the axes x (and y) as they can, so that a sector x ≥ 0 remains one when the
/// body is turned over; a frame may therefore be left-handed.
fn frame(dim: usize, direction: Vec3) -> Result<Frame, MeshError> {
    let Some(down) = normalize(direction) else {
        return Err(
            MeshError::new("the direction of the contact point is not a direction")
                .help("give a vector that is finite and not zero, as [0, -1]"),
        );
    };
    let up = scale(-1.0, down);
    if dim == 2 {
        let mut e = [up[1], -up[0], 0.0];
        if e[0] < 0.0 || (e[0] == 0.0 && e[1] < 0.0) {
            e = scale(-1.0, e);
        }
        let left_handed = cross(e, up)[2] < 0.0;
        return Ok(Frame {
            axes: [e, up, [0.0, 0.0, 1.0]],
            left_handed,
        });
    }
    let lateral = |wish: Vec3| normalize(add_scaled(wish, -dot(wish, up), up));
    let x = if up[0].abs() < 0.9 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let e1 = lateral(x).unwrap_or(x);
    let mut e2 = cross(up, e1);
    // The largest component decides, so that rounding does not.
    let largest = (0..3).fold(0, |m, i| {
        if e2[i].abs() > e2[m].abs() + 1e-9 {
            i
        } else {
            m
        }
    });
    let left_handed = e2[largest] < 0.0;
    if left_handed {
        e2 = scale(-1.0, e2);
    }
    Ok(Frame {
        axes: [e1, e2, up],
        left_handed,
    })
}

/// The core's coordinates and the layers, as tables of parts.
struct Tables {
    core: [Vec<f64>; 3],
    /// Whether layers lie on the low and the high side of the core.
    outer: [[bool; 2]; 3],
    /// From 0 at the core to 1 at the sphere.
    layers: Vec<f64>,
}

impl Round {
    /// The mesh with its sets.
    pub fn generate(&self) -> Result<Mesh, MeshError> {
        if self.centre.iter().any(|x| !x.is_finite()) {
            return Err(MeshError::new("the centre is not finite").help("give finite coordinates"));
        }
        let tables = self.tables()?;
        let frame = frame(self.dim, self.direction)?;
        let cells = self.cells(&tables, frame.left_handed)?;
        let mut lattice =
            Lattice::new(self.dim, self.element, Diagonal::default(), &cells, |key| {
                let local = self.position(&tables, key);
                (0..self.dim).fold(self.centre, |x, a| add_scaled(x, local[a], frame.axes[a]))
            })?;
        self.name(&tables, &mut lattice);
        Ok(lattice.mesh)
    }

    fn tables(&self) -> Result<Tables, MeshError> {
        let sizes = Sizes::new(self.radius, self.size, self.refine)?;
        // From the pole to the edge of its side of the cube are 45 degrees.
        let quarter = self.radius * FRAC_PI_4;
        let lateral = sizes.growing(quarter)?;
        let along = sizes.equal(quarter)?;
        let mut layers = sizes.growing(self.radius * (1.0 - waist(self.dim)))?;
        layers.reverse();
        for t in &mut layers {
            *t = 1.0 - *t;
        }
        let mirrored = |half: &[f64]| -> Vec<f64> {
            let low = half.iter().skip(1).rev().map(|x| -x);
            low.chain(half.iter().copied()).collect()
        };
        let mut core = [vec![0.0], vec![0.0], vec![0.0]];
        let mut outer = [[false; 2]; 3];
        for a in 0..self.dim - 1 {
            core[a] = if self.symmetric[a] {
                lateral.clone()
            } else {
                mirrored(&lateral)
            };
            outer[a] = [!self.symmetric[a], true];
        }
        let axis = self.dim - 1;
        core[axis] = mirrored(&along);
        if self.half {
            core[axis].truncate(along.len());
        }
        outer[axis] = [true, !self.half];
        Ok(Tables {
            core,
            outer,
            layers,
        })
    }

    fn cells(&self, tables: &Tables, mirrored: bool) -> Result<Vec<LatticeCell>, MeshError> {
        let dim = self.dim;
        // A direction that does not exist has one step, so that the loops below are the same in 2D and 3D.
        let n: [usize; 3] = std::array::from_fn(|a| (tables.core[a].len() - 1).max(1));
        let layers = tables.layers.len() - 1;
        affordable(&n)?;
        let mut cells = Vec::new();
        for k in 0..n[2] {
            for j in 0..n[1] {
                cells.extend((0..n[0]).map(|i| LatticeCell {
                    base: [2 * i, 2 * j, 2 * k, 0],
                    axes: [0, 1, 2],
                    reversed: mirrored,
                }));
            }
        }
        for a in 0..dim {
            for (high, _) in [false, true]
                .into_iter()
                .zip(tables.outer[a])
                .filter(|s| s.1)
            {
                let mut axes = [3; 3];
                let mut others = (0..dim).filter(|&b| b != a);
                axes.iter_mut()
                    .take(dim - 1)
                    .for_each(|axis| *axis = others.next().unwrap_or(3));
                // The directions (others, outward) are a permutation of the axes, turned round on the low side.
                let odd = if dim == 2 { a == 0 } else { a == 1 };
                let reversed = (odd == high) != mirrored;
                let (m1, m2) = (n[axes[0]], if dim == 3 { n[axes[1]] } else { 1 });
                affordable(&[m1, m2, layers])?;
                for layer in 0..layers {
                    for second in 0..m2 {
                        for first in 0..m1 {
                            let mut base: Key = [0, 0, 0, 2 * layer];
                            base[axes[0]] = 2 * first;
                            if dim == 3 {
                                base[axes[1]] = 2 * second;
                            }
                            base[a] = if high { 2 * n[a] } else { 0 };
                            cells.push(LatticeCell {
                                base,
                                axes,
                                reversed,
                            });
                        }
                    }
                }
                if cells.len() > MOST_CELLS {
                    return affordable(&[cells.len()]).map(|()| cells);
                }
            }
        }
        Ok(cells)
    }

    /// The place of a lattice position relative to the centre, in the local frame.
    fn position(&self, tables: &Tables, key: Key) -> Vec3 {
        let x: Vec3 = std::array::from_fn(|a| {
            if a < self.dim {
                at(&tables.core[a], key[a])
            } else {
                0.0
            }
        });
        let core = scale(waist(self.dim) * self.radius, x);
        let t = at(&tables.layers, key[3]);
        // Layers start at the surface of the core, where one coordinate is ±1: the direction is never zero there.
        match normalize(x.map(|x| (FRAC_PI_4 * x).tan())) {
            Some(ray) if t > 0.0 => add_scaled(scale(1.0 - t, core), t * self.radius, ray),
            _ => core,
        }
    }

    fn name(&self, tables: &Tables, lattice: &mut Lattice) {
        let axis = self.dim - 1;
        let surface = 2 * (tables.layers.len() - 1);
        lattice.name_facets("arc", |k| k[3] == surface);
        let end = 2 * (tables.core[axis].len() - 1);
        if self.half {
            lattice.name_facets("flat", |k| k[axis] == end);
        }
        let planes: &[&str] = if self.dim == 2 {
            &["axis"]
        } else {
            &["symmetry-x", "symmetry-y"]
        };
        for (a, name) in planes
            .iter()
            .enumerate()
            .filter(|&(a, _)| self.symmetric[a])
        {
            lattice.name_facets(name, |k| k[a] == 0);
        }
        let mut middle: Key = std::array::from_fn(|a| {
            let zero = tables
                .core
                .get(a)
                .and_then(|t| t.iter().position(|&x| x == 0.0));
            2 * zero.unwrap_or(0)
        });
        lattice.name_point("centre", middle);
        middle[axis] = 0;
        middle[3] = surface;
        lattice.name_point("pole", middle);
    }
}
