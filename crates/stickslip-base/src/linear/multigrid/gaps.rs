use super::super::BlockCsr;
use super::super::block_csr::ROWS_PER_TASK;
use super::super::pattern::Pattern;
use rayon::prelude::*;

/// The change of variables `u = T x` that makes contact local: at secondary points the displacement is replaced by the
/// gap vector `g = u_s - Σ N_m u_m` to the facet they meet; all other points keep theirs.
///
/// A stiff contact between points and facets couples points that no multigrid puts together. In the new variables its
/// matrix is one block on the diagonal of each secondary point, which a smoother inverts exactly.
#[derive(Debug, Clone)]
pub struct GapVariables {
    block: usize,
    /// Dofs that are zero in all vectors.
    fixed: Vec<bool>,
    /// Points with gap variables, ascending.
    points: Vec<u32>,
    /// Where the terms of a gap point start.
    starts: Vec<usize>,
    /// Facet points and their weights.
    terms: Vec<(u32, f64)>,
    /// Place of a point in `points`; `NONE` for others.
    places: Vec<u32>,
    /// The places of the gap points that lean on a point, and the weights there.
    facets_starts: Vec<usize>,
    facets: Vec<(u32, f64)>,
}

const NONE: u32 = u32::MAX;

/// Blocks of one row before those of the same column are added up.
#[derive(Default)]
struct Row {
    /// Column, and where its block starts.
    entries: Vec<(u32, u32)>,
    blocks: Vec<f64>,
}

impl Row {
    /// Appends a block times a factor for each of its entries.
    fn push(&mut self, column: u32, b: usize, block: &[f64], factor: impl Fn(usize, usize) -> f64) {
        self.entries.push((column, self.blocks.len() as u32));
        let entries = block.iter().enumerate();
        self.blocks
            .extend(entries.map(|(k, v)| factor(k / b, k % b) * v));
    }
}

impl GapVariables {
    /// Gap variables at secondary points, each given with the points of its facet and their weights \[1\], on a mesh
    /// of `fixed.len() / block` points.
    ///
    /// A chain is not allowed: no point can be secondary and belong to a facet. Of secondary points that break
    /// this, and of those named twice, the first in the list wins; see [`is_gap`](GapVariables::is_gap). Fixed dofs
    /// are zero before and after every map; a fixed component of a secondary point has no gap variable.
    ///
    /// # Panics
    /// If a point does not exist.
    pub fn new(block: usize, fixed: &[bool], pairs: &[(usize, Vec<(usize, f64)>)]) -> GapVariables {
        let count = fixed.len() / block;
        let mut leaned_on = vec![false; count];
        let mut accepted: Vec<(u32, usize)> = Vec::new();
        let mut places = vec![NONE; count];
        for (pair, (point, terms)) in pairs.iter().enumerate() {
            let chained = terms.iter().any(|&(m, _)| m == *point || places[m] != NONE);
            if chained || leaned_on[*point] || places[*point] != NONE {
                continue;
            }
            places[*point] = 0;
            terms.iter().for_each(|&(m, _)| leaned_on[m] = true);
            accepted.push((*point as u32, pair));
        }
        accepted.sort_unstable();
        let (mut points, mut starts, mut terms) = (Vec::new(), vec![0], Vec::new());
        for (place, &(point, pair)) in accepted.iter().enumerate() {
            places[point as usize] = place as u32;
            points.push(point);
            terms.extend(pairs[pair].1.iter().map(|&(m, weight)| (m as u32, weight)));
            starts.push(terms.len());
        }

        let mut facets_starts = vec![0; count + 1];
        for &(m, _) in &terms {
            facets_starts[m as usize + 1] += 1;
        }
        for i in 0..count {
            facets_starts[i + 1] += facets_starts[i];
        }
        let mut next = facets_starts.clone();
        let mut facets = vec![(0, 0.0); terms.len()];
        for (place, ends) in starts.windows(2).enumerate() {
            for &(m, weight) in &terms[ends[0]..ends[1]] {
                facets[next[m as usize]] = (place as u32, weight);
                next[m as usize] += 1;
            }
        }
        GapVariables {
            block,
            fixed: fixed.to_vec(),
            points,
            starts,
            terms,
            places,
            facets_starts,
            facets,
        }
    }

    /// The points with gap variables, ascending.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.points.iter().map(|&point| point as usize)
    }

    /// Whether this point has gap variables.
    pub fn is_gap(&self, point: usize) -> bool {
        self.places[point] != NONE
    }

    /// Facet points and weights of a point; empty if it has no gap variables.
    pub fn facet(&self, point: usize) -> impl ExactSizeIterator<Item = (usize, f64)> + '_ {
        let terms = match self.places[point] {
            NONE => &[],
            place => self.terms(place),
        };
        terms.iter().map(|&(m, weight)| (m as usize, weight))
    }

    /// Facet points and weights of the gap point at a place.
    fn terms(&self, place: u32) -> &[(u32, f64)] {
        &self.terms[self.starts[place as usize]..self.starts[place as usize + 1]]
    }

    /// Gap points that lean on a point, by place, and the weights.
    fn facets(&self, point: usize) -> &[(u32, f64)] {
        &self.facets[self.facets_starts[point]..self.facets_starts[point + 1]]
    }

    /// Gap vectors become displacements: `x := T x`, in place over all dofs.
    ///
    /// # Panics
    /// If `x` has not one entry a dof.
    pub fn apply(&self, x: &mut [f64]) {
        self.lean(x, 1.0);
    }

    /// Displacements become gap vectors: `x := T⁻¹ x`, in place over all dofs.
    ///
    /// # Panics
    /// If `x` has not one entry a dof.
    pub fn to_gaps(&self, x: &mut [f64]) {
        self.lean(x, -1.0);
    }

    fn lean(&self, x: &mut [f64], sign: f64) {
        let b = self.block;
        assert_eq!(x.len(), self.fixed.len(), "length of a vector");
        for (place, &point) in self.points.iter().enumerate() {
            for c in 0..b {
                let dof = point as usize * b + c;
                if !self.fixed[dof] {
                    let terms = self.terms(place as u32).iter();
                    let sum: f64 = terms.map(|&(m, w)| w * x[m as usize * b + c]).sum();
                    x[dof] += sign * sum;
                }
            }
        }
    }

    /// Forces on displacements become forces on the new variables: `f := Tᵀ f`, in place over all dofs.
    ///
    /// # Panics
    /// If `f` has not one entry a dof.
    pub fn transpose(&self, f: &mut [f64]) {
        let b = self.block;
        assert_eq!(f.len(), self.fixed.len(), "length of a vector");
        for (place, &point) in self.points.iter().enumerate() {
            for &(m, weight) in self.terms(place as u32) {
                for c in 0..b {
                    let (from, to) = (point as usize * b + c, m as usize * b + c);
                    if !self.fixed[from] && !self.fixed[to] {
                        f[to] += weight * f[from];
                    }
                }
            }
        }
    }

    /// The stiffness in the new variables, `Tᵀ K T`. Rows and columns of fixed dofs keep what is there: leave them
    /// out later.
    ///
    /// # Panics
    /// If the matrix has other points or another block size.
    pub fn transform(&self, matrix: &BlockCsr) -> BlockCsr {
        let b = self.block;
        assert_eq!(
            (matrix.rows(), matrix.block_size()),
            (self.fixed.len(), b),
            "not the mesh of the gap variables"
        );
        let points = matrix.points();
        let tasks: Vec<usize> = (0..points).step_by(ROWS_PER_TASK).collect();
        let parts: Vec<(Vec<usize>, Vec<u32>, Vec<f64>)> = tasks
            .into_par_iter()
            .map(|first| {
                let rows = first..(first + ROWS_PER_TASK).min(points);
                let mut part = (Vec::new(), Vec::new(), Vec::new());
                let mut sum = Row::default();
                for row in rows {
                    let before = part.1.len();
                    self.transformed_row(matrix, row, &mut sum, &mut part.1, &mut part.2);
                    part.0.push(part.1.len() - before);
                }
                part
            })
            .collect();
        let total: usize = parts.iter().map(|part| part.1.len()).sum();
        let mut pattern = Pattern {
            starts: Vec::with_capacity(points + 1),
            columns: Vec::with_capacity(total),
        };
        let mut values = Vec::with_capacity(total * b * b);
        pattern.starts.push(0);
        let mut end = 0;
        for (lengths, columns, blocks) in parts {
            for length in lengths {
                end += length;
                pattern.starts.push(end);
            }
            pattern.columns.extend_from_slice(&columns);
            values.extend_from_slice(&blocks);
        }
        BlockCsr::from_parts(pattern, b, values)
    }

    /// Appends one row of `Tᵀ K T`.
    fn transformed_row(
        &self,
        matrix: &BlockCsr,
        row: usize,
        sum: &mut Row,
        columns: &mut Vec<u32>,
        values: &mut Vec<f64>,
    ) {
        let neighbours = matrix.neighbours(row);
        let facets = self.facets(row);
        if facets.is_empty() && !neighbours.iter().any(|&j| self.is_gap(j as usize)) {
            columns.extend_from_slice(neighbours);
            values.extend_from_slice(matrix.row_blocks(row));
            return;
        }
        let b = self.block;
        let size = b * b;
        sum.entries.clear();
        sum.blocks.clear();
        let first = columns.len();
        self.half_row(matrix, row, sum, |_| 1.0);
        for &(place, weight) in facets {
            let point = self.points[place as usize] as usize;
            // A fixed component of the secondary point does not lean on the facet.
            self.half_row(matrix, point, sum, |r| {
                if self.fixed[point * b + r] {
                    0.0
                } else {
                    weight
                }
            });
        }
        sum.entries.sort_unstable();
        for &(column, at) in &sum.entries {
            let block = &sum.blocks[at as usize..at as usize + size];
            if columns.len() > first && columns.last() == Some(&column) {
                let last = values.len() - size;
                for (v, b) in values[last..].iter_mut().zip(block) {
                    *v += b;
                }
            } else {
                columns.push(column);
                values.extend_from_slice(block);
            }
        }
    }

    /// Adds a row of `K T`, its lines scaled.
    fn half_row(&self, matrix: &BlockCsr, row: usize, sum: &mut Row, scale: impl Fn(usize) -> f64) {
        let b = self.block;
        let blocks = matrix.row_blocks(row).chunks_exact(b * b);
        for (&j, block) in matrix.neighbours(row).iter().zip(blocks) {
            sum.push(j, b, block, |r, _| scale(r));
            let place = self.places[j as usize];
            if place == NONE {
                continue;
            }
            for &(m, weight) in self.terms(place) {
                sum.push(m, b, block, |r, c| {
                    let free = !self.fixed[j as usize * b + c];
                    if free { scale(r) * weight } else { 0.0 }
                });
            }
        }
    }
}
