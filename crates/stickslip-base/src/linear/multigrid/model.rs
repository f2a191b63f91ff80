//! Two blocks on top of each other, meshes not matching, with contact on the face between them: a model problem.

use super::super::BlockCsr;

/// What the points of the interface do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Status {
    Open,
    Frictionless,
    Stick,
    Slip,
}

/// A point of the upper block and the facet it meets.
#[derive(Debug, Clone)]
pub struct Pair {
    pub point: usize,
    pub terms: Vec<(usize, f64)>,
    pub normal: [f64; 3],
    pub area: f64,
}

/// The model: lower block `0 <= z <= 1` with its bottom fixed, upper block above.
pub struct Model {
    pub block: usize,
    pub matrix: BlockCsr,
    pub coordinates: Vec<[f64; 3]>,
    pub bodies: Vec<u32>,
    pub fixed: Vec<bool>,
    pub pairs: Vec<Pair>,
    pub top: Vec<usize>,
    pub young: f64,
    pub friction: f64,
    cells: usize,
    bulge: f64,
    first_upper: usize,
}

impl Model {
    /// Blocks of `n` and `n - 1` cells an edge, in 2 or 3 dimensions; the interface is a cap of height `bulge`.
    /// `aspect` stretches both along x.
    pub fn new(n: usize, dimension: usize, bulge: f64, aspect: f64) -> Model {
        let (young, poisson) = (210e9, 0.3);
        let d = dimension;
        let height =
            |x: f64, y: f64| bulge * (1.0 - (2.0 * x - 1.0).powi(2) - (2.0 * y - 1.0).powi(2));
        let mut coordinates = Vec::new();
        let mut cells: Vec<Vec<usize>> = Vec::new();
        let mut bodies = Vec::new();
        let mut first_upper = 0;
        let depth = |m: usize| if d == 3 { m } else { 0 };
        for body in 0..2 {
            let m = n - body;
            let first = coordinates.len();
            if body == 1 {
                first_upper = first;
            }
            let (mx, my, mz) = (m, depth(m), m);
            let index = |x: usize, y: usize, z: usize| first + x + (mx + 1) * (y + (my + 1) * z);
            for z in 0..=mz {
                for y in 0..=my {
                    for x in 0..=mx {
                        let (u, v) = (x as f64 / m as f64, y as f64 / m as f64);
                        let t = z as f64 / m as f64;
                        let h = height(u, if d == 3 { v } else { 0.5 });
                        // The bulge fades towards the outer faces.
                        let w = if body == 0 {
                            t + t * h
                        } else {
                            1.0 + t + (1.0 - t) * h
                        };
                        let x = u * aspect;
                        coordinates.push(if d == 3 { [x, v, w] } else { [x, w, 0.0] });
                        bodies.push(body as u32);
                    }
                }
            }
            for z in 0..mz {
                for y in 0..my.max(1) {
                    for x in 0..mx {
                        let corners = (0..1 << d).map(|k| {
                            let (i, j) = (k & 1, k >> 1 & 1);
                            if d == 3 {
                                index(x + i, y + j, z + (k >> 2))
                            } else {
                                index(x + i, 0, z + j)
                            }
                        });
                        cells.push(corners.collect());
                    }
                }
            }
        }
        let mut matrix = BlockCsr::from_couplings(coordinates.len(), d, &mut |add| {
            cells.iter().for_each(|c| add(c));
        });
        // In blocks without a bulge all elements are equal.
        let mut known: Option<(u32, Vec<f64>)> = None;
        for cell in &cells {
            let body = bodies[cell[0]];
            if bulge != 0.0 || known.as_ref().is_none_or(|k| k.0 != body) {
                known = Some((body, element(cell, &coordinates, d, young, poisson)));
            }
            if let Some((_, k)) = &known {
                matrix.add_group(cell, k);
            }
        }
        let layer = (n + 1) * (depth(n) + 1);
        let mut fixed = vec![false; matrix.rows()];
        fixed[..layer * d].fill(true);
        let upper_layer = n * (depth(n - 1) + 1);
        let count = coordinates.len();
        let mut model = Model {
            block: d,
            matrix,
            coordinates,
            bodies,
            fixed,
            pairs: Vec::new(),
            top: (count - upper_layer..count).collect(),
            young,
            friction: 0.3,
            cells: n,
            bulge,
            first_upper,
        };
        model.pairs = model.pairs_shifted([0.0; 2], aspect);
        model
    }

    /// The pairs when the upper block has moved along the interface.
    pub fn pairs_shifted(&self, shift: [f64; 2], aspect: f64) -> Vec<Pair> {
        let (n, d) = (self.cells, self.block);
        let upper = n * if d == 3 { n } else { 1 };
        let top_of_lower = self.first_upper - (n + 1) * if d == 3 { n + 1 } else { 1 };
        let place = |x: f64| {
            let scaled = (x * n as f64).clamp(0.0, n as f64);
            let cell = (scaled as usize).min(n - 1);
            (cell, scaled - cell as f64)
        };
        let pairs = (self.first_upper..self.first_upper + upper).map(|point| {
            let [x, y, _] = self.coordinates[point];
            let (u, v) = (
                x / aspect + shift[0],
                if d == 3 { y + shift[1] } else { 0.5 },
            );
            let ((i, a), (j, b)) = (place(u), place(v));
            let mut terms = vec![];
            for (dx, wx) in [(0, 1.0 - a), (1, a)] {
                if d == 2 {
                    terms.push((top_of_lower + i + dx, wx));
                    continue;
                }
                for (dy, wy) in [(0, 1.0 - b), (1, b)] {
                    terms.push((top_of_lower + i + dx + (n + 1) * (j + dy), wx * wy));
                }
            }
            let slope = |t: f64| -4.0 * self.bulge * (2.0 * t - 1.0);
            let raw = if d == 3 {
                [-slope(u) / aspect, -slope(v), 1.0]
            } else {
                [-slope(u) / aspect, 1.0, 0.0]
            };
            let length = raw.iter().map(|v| v * v).sum::<f64>().sqrt();
            Pair {
                point,
                terms,
                normal: raw.map(|v| v / length),
                area: ((n - 1) as f64).powi(1 - d as i32),
            }
        });
        pairs.collect()
    }

    /// Contact tangents `(3, 3)` of all pairs for the status of each and a stiffness of `factor E / h` an area: the
    /// exact ones and symmetric approximations.
    pub fn tangents(
        &self,
        pairs: &[Pair],
        factor: f64,
        status: &dyn Fn(&Pair) -> Status,
    ) -> Vec<([f64; 9], [f64; 9])> {
        let w = factor * self.young * self.cells as f64;
        let d = self.block;
        let all = pairs.iter().map(|pair| {
            let (mut exact, mut stand_in) = ([0.0; 9], [0.0; 9]);
            let (n, k) = (pair.normal, w * pair.area);
            let status = status(pair);
            // A slip direction that is normal to n.
            let raw = if d == 3 {
                [1.0, 0.5, 0.0]
            } else {
                [1.0, 0.0, 0.0]
            };
            let along: f64 = (0..3).map(|c| raw[c] * n[c]).sum();
            let t: [f64; 3] = std::array::from_fn(|c| raw[c] - along * n[c]);
            let length = t.iter().map(|v| v * v).sum::<f64>().sqrt();
            for r in 0..d {
                for c in 0..d {
                    let nn = n[r] * n[c];
                    let one = if r == c { 1.0 } else { 0.0 };
                    let (e, s) = match status {
                        Status::Open => (0.0, 0.0),
                        Status::Frictionless => (nn, nn),
                        Status::Stick => (one, one),
                        Status::Slip => (nn + self.friction * t[r] / length * n[c], nn),
                    };
                    exact[r * d + c] = k * e;
                    stand_in[r * d + c] = k * s;
                }
            }
            (exact, stand_in)
        });
        all.collect()
    }

    /// `y += Σ rowsᵀ C rows x`
    pub fn add_contact(
        &self,
        pairs: &[Pair],
        tangents: &[([f64; 9], [f64; 9])],
        x: &[f64],
        y: &mut [f64],
    ) {
        let d = self.block;
        for (pair, (exact, _)) in pairs.iter().zip(tangents) {
            for r in 0..d {
                let mut force = 0.0;
                for c in 0..d {
                    let lean: f64 = pair.terms.iter().map(|&(m, w)| w * x[m * d + c]).sum();
                    force += exact[r * d + c] * (x[pair.point * d + c] - lean);
                }
                y[pair.point * d + r] += force;
                for &(m, w) in &pair.terms {
                    y[m * d + r] -= w * force;
                }
            }
        }
    }

    /// `y = A x` on the free dofs, contact included.
    pub fn product(
        &self,
        pairs: &[Pair],
        tangents: &[([f64; 9], [f64; 9])],
        x: &[f64],
        y: &mut [f64],
    ) {
        self.matrix.mul(x, y);
        self.add_contact(pairs, tangents, x, y);
        for (y, &f) in y.iter_mut().zip(&self.fixed) {
            if f {
                *y = 0.0;
            }
        }
    }
}

/// The stiffness of a linear quadrilateral (plane strain) or hexahedron.
fn element(
    cell: &[usize],
    coordinates: &[[f64; 3]],
    d: usize,
    young: f64,
    poisson: f64,
) -> Vec<f64> {
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let mu = young / (2.0 * (1.0 + poisson));
    let corners = 1 << d;
    let width = corners * d;
    let mut k = vec![0.0; width * width];
    let sign = |a: usize, axis: usize| if a >> axis & 1 == 1 { 1.0 } else { -1.0 };
    for gauss in 0..corners {
        let at: Vec<f64> = (0..d).map(|axis| sign(gauss, axis) / 3f64.sqrt()).collect();
        // Derivatives over the reference cell and the Jacobian.
        let local = |a: usize, axis: usize| -> f64 {
            let factors = (0..d).map(|other| {
                if other == axis {
                    0.5 * sign(a, axis)
                } else {
                    0.5 * (1.0 + sign(a, other) * at[other])
                }
            });
            factors.product()
        };
        let mut j = [
            [0.0; 3],
            [0.0; 3],
            [0.0, 0.0, if d == 2 { 1.0 } else { 0.0 }],
        ];
        for a in 0..corners {
            for (r, line) in j.iter_mut().enumerate().take(d) {
                for c in 0..d {
                    line[c] += local(a, r) * coordinates[cell[a]][c];
                }
            }
        }
        let cofactor = |r: usize, c: usize| {
            let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
            j[r1][c1] * j[r2][c2] - j[r1][c2] * j[r2][c1]
        };
        let volume: f64 = (0..3).map(|c| j[0][c] * cofactor(0, c)).sum();
        let gradient: Vec<[f64; 3]> = (0..corners)
            .map(|a| {
                std::array::from_fn(|c| {
                    if c < d {
                        (0..d).map(|r| cofactor(r, c) / volume * local(a, r)).sum()
                    } else {
                        0.0
                    }
                })
            })
            .collect();
        for a in 0..corners {
            for b in 0..corners {
                let dot: f64 = (0..d).map(|c| gradient[a][c] * gradient[b][c]).sum();
                for r in 0..d {
                    for c in 0..d {
                        let shear =
                            gradient[a][c] * gradient[b][r] + if r == c { dot } else { 0.0 };
                        k[(a * d + r) * width + b * d + c] +=
                            volume * (lambda * gradient[a][r] * gradient[b][c] + mu * shear);
                    }
                }
            }
        }
    }
    k
}
