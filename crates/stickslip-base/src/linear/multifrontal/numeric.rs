use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rayon::prelude::*;

use super::super::BlockCsr;
use super::super::error::{LinearError, zeros};
use super::super::ordering::NONE;
use super::dense::{self, Child};
use super::symbolic::Fronts;

/// Children of the root worked on at a time; their contributions are added in order.
const CHILDREN_TOGETHER: usize = 8;

/// A pivot counts as zero below this many roundings (2.2e-16) per free dof, relative to its diagonal \[1\].
///
/// Where the exact pivot is zero, rounding leaves up to one of these per dof, since on a regular mesh all cells round
/// the same way (measured on unconstrained bodies: 0.1 to 0.6, at 264 to 59 049 dofs). A sound structure that
/// keeps less would be solved with hardly a correct digit; the softest, a cantilever one element thick, gets there
/// at about two thousand elements of length.
pub const SINGULAR_ROUNDINGS: f64 = 8.0;

/// Numbers in a page of memory, or a part of one.
const PAGE: usize = 512;

/// The factor of the interior of a substructure and its couplings to the kept dofs: `L_II` and `L_CI` in
/// `K = [L_II 0; L_CI I] [I 0; 0 S] [L_II 0; L_CI I]ᵀ` with the Schur complement
/// `S = K_CC - K_CI K_II⁻¹ K_IC`.
#[derive(Debug)]
pub struct PartialFactor {
    pub(super) fronts: Arc<Fronts>,
    /// The panels of the fronts of each piece, one after the other.
    pub(super) panels: Vec<Vec<f64>>,
    pub(super) smallest_pivot: (usize, f64),
}

/// A dof and its pivot relative to the diagonal.
type Pivot = (usize, f64);

/// A number to be added to the matrix: positions of its row and of its column, the row not above.
pub(super) struct Entry {
    pub row: u32,
    pub column: u32,
    pub value: f64,
}

/// What all tasks share.
struct Work<'a> {
    fronts: &'a Fronts,
    matrix: &'a BlockCsr,
    extra: &'a [Entry],
    panels: Vec<OnceLock<Vec<f64>>>,
    buffers: &'a Workspace,
}

/// Memory that factorisations use one after the other, or side by side: fresh pages cost as much as arithmetic.
///
/// Its pieces are as long as the longest that any of the bodies asks for. What is not written to is no page, so that they need not grow and are
/// not filled with zeros.
#[derive(Debug, Default)]
pub struct Workspace {
    free: Mutex<Vec<Vec<f64>>>,
    longest: usize,
}

/// Numbers of a [`Workspace`].
#[derive(Debug)]
pub struct Numbers {
    all: Vec<f64>,
    length: usize,
}

impl Deref for Numbers {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.all[..self.length]
    }
}

impl DerefMut for Numbers {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.all[..self.length]
    }
}

impl Workspace {
    /// For factorisations that ask for so many numbers at once.
    pub fn of(longest: impl IntoIterator<Item = usize>) -> Workspace {
        Workspace {
            free: Mutex::default(),
            longest: longest.into_iter().max().unwrap_or(0),
        }
    }

    /// So many numbers of any value.
    ///
    /// # Errors
    /// [`LinearError::OutOfMemory`].
    pub fn take(&self, length: usize) -> Result<Numbers, LinearError> {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        // Of equally good ones the last that was given back: it is likely in a cache.
        let long_enough = (0..free.len()).rev().filter(|&i| free[i].len() >= length);
        let best = long_enough.min_by_key(|&i| free[i].len());
        let all = match best {
            Some(at) => free.swap_remove(at),
            None => zeros(length.max(self.longest)).or_else(|_| zeros(length))?,
        };
        Ok(Numbers { all, length })
    }

    /// Takes memory back.
    pub fn give(&self, numbers: Numbers) {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        free.push(numbers.all);
    }
}

impl PartialFactor {
    /// Factors `matrix` as analysed, and returns the Schur complement of the kept dofs too: of shape
    /// `(root, root)`, column by column, in the order of [`Fronts::root`]; the upper triangle is zero. Its memory comes from the workspace,
    /// which likes to have it back.
    /// Only one triangle of `matrix` is read: the symmetry is taken for granted.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`], [`LinearError::NotPositive`], [`LinearError::Singular`] with the dof to look at;
    /// [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `matrix` has not the points or block size analysed.
    pub fn new(
        fronts: &Arc<Fronts>,
        matrix: &BlockCsr,
        workspace: &Workspace,
    ) -> Result<(PartialFactor, Numbers), LinearError> {
        PartialFactor::with(fronts, matrix, &[], workspace)
    }

    /// The same of the matrix and `extra` entries, in the order of their columns.
    pub(super) fn with(
        fronts: &Arc<Fronts>,
        matrix: &BlockCsr,
        extra: &[Entry],
        workspace: &Workspace,
    ) -> Result<(PartialFactor, Numbers), LinearError> {
        let shape = (matrix.points(), matrix.block_size());
        assert_eq!(shape, fronts.shape, "not the matrix analysed");
        let work = Work {
            fronts,
            matrix,
            extra,
            panels: fronts.pieces.iter().map(|_| OnceLock::new()).collect(),
            buffers: workspace,
        };
        let (schur, smallest_pivot) = work.run()?;
        let (dof, ratio) = smallest_pivot;
        let free = fronts.interior.len() + fronts.root.len();
        if ratio < SINGULAR_ROUNDINGS * f64::EPSILON * free as f64 {
            return Err(LinearError::Singular { dof, ratio });
        }
        let panels = work.panels.into_iter();
        let factor = PartialFactor {
            fronts: Arc::clone(fronts),
            panels: panels.map(|p| p.into_inner().unwrap_or_default()).collect(),
            smallest_pivot,
        };
        Ok((factor, schur))
    }

    /// The analysis this factor was made with.
    pub fn fronts(&self) -> &Arc<Fronts> {
        &self.fronts
    }

    /// Bytes of the numbers of the factor.
    pub fn bytes(&self) -> u64 {
        8 * self.panels.iter().map(|p| p.len() as u64).sum::<u64>()
    }

    /// The eliminated dof with the smallest pivot relative to its diagonal, and that ratio \[1\]; infinity if
    /// nothing was eliminated.
    pub fn smallest_pivot(&self) -> (usize, f64) {
        self.smallest_pivot
    }
}

/// The smaller of two pivots, the first of equals.
fn smaller(a: Pivot, b: Pivot) -> Pivot {
    if b.1 < a.1 { b } else { a }
}

impl Work<'_> {
    /// All pieces, and the root.
    fn run(&self) -> Result<(Numbers, Pivot), LinearError> {
        let fronts = self.fronts;
        let order = fronts.root.len();
        let mut smallest = (0, f64::INFINITY);
        let mut schur: Option<Numbers> = None;
        let last: Vec<usize> = (0..fronts.pieces.len())
            .filter(|&at| fronts.pieces[at].last)
            .collect();
        for group in last.chunks(CHILDREN_TOGETHER) {
            for (&at, done) in group.iter().zip(self.pieces(group)) {
                let (contribution, pivot) = done?;
                smallest = smaller(smallest, pivot);
                let targets = fronts.targets(fronts.pieces[at].top());
                match &mut schur {
                    // Often there is one child only, coupled to all of the root: its contribution is the start.
                    None if targets.len() == order => schur = Some(contribution),
                    _ => {
                        if schur.is_none() {
                            let mut root = self.buffers.take(order * order)?;
                            root.fill(0.0);
                            schur = Some(root);
                        }
                        let values = &contribution;
                        let child = Child { targets, values };
                        if let Some(root) = &mut schur {
                            dense::add_to_root(root, order, child);
                        }
                        self.buffers.give(contribution);
                    }
                }
            }
        }
        let mut schur = match schur {
            Some(schur) => schur,
            None => {
                let mut schur = self.buffers.take(order * order)?;
                schur.fill(0.0);
                schur
            }
        };
        for (j, column) in schur.chunks_exact_mut(order.max(1)).enumerate() {
            column[..j].fill(0.0);
            let position = fronts.interior.len() + j;
            let dof = fronts.root[j] as usize;
            self.column(position, |row, value| {
                column[row - fronts.interior.len()] += value
            });
            if column[j..].iter().any(|v| !v.is_finite()) {
                return Err(LinearError::NotFinite { dof });
            }
        }
        Ok((schur, smallest))
    }

    /// Several pieces and what is below them, in any order; their contributions in the given one.
    fn pieces(&self, pieces: &[usize]) -> Vec<Result<(Numbers, Pivot), LinearError>> {
        match pieces {
            [] => Vec::new(),
            [one] => vec![self.piece(*one)],
            _ => pieces.par_iter().map(|&at| self.piece(at)).collect(),
        }
    }

    /// The contribution of a piece and of all below it, and their smallest pivot.
    fn piece(&self, at: usize) -> Result<(Numbers, Pivot), LinearError> {
        let fronts = self.fronts;
        let piece = &fronts.pieces[at];
        let below: Vec<usize> = piece.children.iter().map(|&child| child as usize).collect();
        let mut smallest = (0, f64::INFINITY);
        let mut contributions = Vec::with_capacity(below.len());
        for done in self.pieces(&below) {
            let (contribution, pivot) = done?;
            smallest = smaller(smallest, pivot);
            contributions.push(contribution);
        }

        let area = |front: usize| {
            let (columns, rows) = fronts.sizes(front);
            columns * (columns + rows)
        };
        let total: usize = piece.fronts.clone().map(area).sum();
        let mut panels = zeros(total)?;
        let mut filled = 0;
        let square = |front: usize| fronts.sizes(front).1.pow(2);
        let [even, odd] = piece.stacks(&fronts.tree, square);
        let mut stacks = [self.buffers.take(even)?, self.buffers.take(odd)?];
        let mut tops = [0; 2];
        let depths = piece.depths(&fronts.tree);
        let mut top = self.buffers.take(square(piece.top()))?;
        for front in piece.fronts.clone() {
            let parity = depths.of(front);
            let mut children: Vec<Child> = Vec::with_capacity(fronts.children(front).len());
            let [a, b] = &mut stacks;
            let (own, other) = if parity == 0 { (a, b) } else { (b, a) };
            if piece.children.is_empty() {
                let mut start = tops[1 - parity];
                for &child in fronts.children(front) {
                    start -= square(child as usize);
                }
                tops[1 - parity] = start;
                for &child in fronts.children(front) {
                    let values = &other[start..][..square(child as usize)];
                    let targets = fronts.targets(child as usize);
                    children.push(Child { targets, values });
                    start += values.len();
                }
            } else {
                for (&child, values) in fronts.children(front).iter().zip(&contributions) {
                    let targets = fronts.targets(child as usize);
                    children.push(Child { targets, values });
                }
            }
            let panel = &mut panels[filled..filled + area(front)];
            filled += panel.len();
            // A page that is read before it is written to is mapped twice.
            panel.chunks_mut(PAGE).for_each(|page| page[0] = 0.0);
            let target = if front == piece.top() {
                &mut top[..square(front)]
            } else {
                tops[parity] += square(front);
                &mut own[tops[parity] - square(front)..tops[parity]]
            };
            let pivot = self.front(front, panel, target, &children)?;
            smallest = smaller(smallest, pivot);
        }
        for buffer in contributions.into_iter().chain(stacks) {
            self.buffers.give(buffer);
        }
        let _ = self.panels[at].set(panels);
        Ok((top, smallest))
    }

    /// Eliminates a front; its smallest pivot.
    fn front(
        &self,
        front: usize,
        panel: &mut [f64],
        contribution: &mut [f64],
        children: &[Child],
    ) -> Result<Pivot, LinearError> {
        let fronts = self.fronts;
        let (columns, rows) = fronts.sizes(front);
        let height = columns + rows;
        let own = fronts.columns(front);
        let below = fronts.rows(front);
        let dof = |column: usize| fronts.interior[own.start + column] as usize;
        let mut diagonal = Vec::with_capacity(columns);
        for (j, column) in panel.chunks_exact_mut(height.max(1)).enumerate() {
            let mut finite = true;
            let mut hint = 0;
            self.column(own.start + j, |row, value| {
                finite &= value.is_finite();
                let local = if row < own.end {
                    row - own.start
                } else {
                    // Dofs of a point follow each other.
                    if below.get(hint).is_none_or(|&r| r as usize != row) {
                        hint = below.partition_point(|&r| (r as usize) < row);
                    }
                    hint += 1;
                    columns + hint - 1
                };
                column[local] += value;
            });
            if !finite {
                return Err(LinearError::NotFinite { dof: dof(j) });
            }
            diagonal.push(column[j]);
        }
        let large = dense::is_large(fronts.tree.flops_of(front));
        dense::add_to_panel(panel, columns, children, large);
        dense::factor_panel(panel, columns, large)
            .map_err(|column| LinearError::NotPositive { dof: dof(column) })?;
        dense::contribute(contribution, panel, columns, rows, children, large);
        let mut smallest = (0, f64::INFINITY);
        for (j, diagonal) in diagonal.into_iter().enumerate() {
            let pivot = panel[j * height + j];
            let ratio = pivot * pivot / diagonal;
            if ratio.is_nan() {
                return Err(LinearError::NotFinite { dof: dof(j) });
            }
            smallest = smaller(smallest, (dof(j), ratio));
        }
        Ok(smallest)
    }

    /// The entries of the matrix in the column of a position, on and below the diagonal, by position.
    #[inline]
    fn column(&self, position: usize, mut add: impl FnMut(usize, f64)) {
        let fronts = self.fronts;
        let n = fronts.interior.len();
        let dof = match fronts.interior.get(position) {
            Some(&dof) => dof,
            None => fronts.root[position - n],
        } as usize;
        let b = self.matrix.block_size();
        let (point, component) = (dof / b, dof % b);
        // By symmetry the column is read from the row of the same dof.
        let blocks = self.matrix.row_blocks(point).chunks_exact(b * b);
        for (&other, block) in self.matrix.neighbours(point).iter().zip(blocks) {
            let Some(local) = (other as usize).checked_sub(fronts.points.start) else {
                continue;
            };
            let Some(positions) = fronts.position_of.get(local * b..(local + 1) * b) else {
                continue;
            };
            for (&row, &value) in positions.iter().zip(&block[component * b..]) {
                if row != NONE && row as usize >= position {
                    add(row as usize, value);
                }
            }
        }
        let first = (self.extra).partition_point(|entry| (entry.column as usize) < position);
        for entry in &self.extra[first..] {
            if entry.column as usize != position {
                break;
            }
            add(entry.row as usize, entry.value);
        }
    }
}
