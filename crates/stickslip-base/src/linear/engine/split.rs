use super::contract::Cut;
use crate::linear::symbolic::FIXED;
use crate::linear::{BlockCsr, LinearError};

/// The free dofs of a body, those of the interior first: both in ascending order, known by their *positions*.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// First dof of the body.
    origin: usize,
    pub(super) interior: Vec<u32>,
    pub(super) root: Vec<u32>,
    /// The position of each dof of the body, or [`FIXED`].
    position: Vec<u32>,
}

impl Split {
    /// Cuts a body in two.
    ///
    /// # Errors
    /// [`LinearError::NotAnalysed`] if a free dof of the body is coupled to a free dof of another.
    pub fn new(matrix: &BlockCsr, (points, fixed, kept): Cut) -> Result<Split, LinearError> {
        let b = matrix.block_size();
        let free = |point: usize| (point * b..(point + 1) * b).filter(|&dof| !fixed[dof]);
        let (mut interior, mut root) = (Vec::new(), Vec::new());
        for point in points.clone() {
            let Some(dof) = free(point).next() else {
                continue;
            };
            let others = matrix.neighbours(point).iter().map(|&p| p as usize);
            let outside = others.filter(|other| !points.contains(other));
            if let Some(other) = outside.flat_map(free).next() {
                return Err(LinearError::NotAnalysed { dofs: [dof, other] });
            }
            let list = if kept[point] {
                &mut root
            } else {
                &mut interior
            };
            list.extend(free(point).map(|dof| dof as u32));
        }
        let origin = points.start * b;
        let mut position = vec![FIXED; points.len() * b];
        for (at, &dof) in interior.iter().chain(&root).enumerate() {
            position[dof as usize - origin] = at as u32;
        }
        Ok(Split {
            origin,
            interior,
            root,
            position,
        })
    }

    /// Free dofs.
    pub fn len(&self) -> usize {
        self.interior.len() + self.root.len()
    }

    /// Whether there is no free dof.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The dof at a position.
    pub fn dof(&self, position: usize) -> usize {
        let inner = self.interior.len();
        match self.interior.get(position) {
            Some(&dof) => dof as usize,
            None => self.root[position - inner] as usize,
        }
    }

    /// About the memory held `[bytes]`.
    pub fn bytes(&self) -> u64 {
        4 * (self.len() + self.position.len()) as u64
    }

    /// The entries in the row of a position: positions of columns, and values.
    pub fn row(&self, matrix: &BlockCsr, position: usize, mut each: impl FnMut(usize, f64)) {
        let b = matrix.block_size();
        let dof = self.dof(position);
        let (point, component) = (dof / b, dof % b);
        let blocks = matrix.row_blocks(point).chunks_exact(b * b);
        for (&other, block) in matrix.neighbours(point).iter().zip(blocks) {
            let Some(local) = (other as usize * b).checked_sub(self.origin) else {
                continue;
            };
            let Some(positions) = self.position.get(local..local + b) else {
                continue;
            };
            for (&column, &value) in positions.iter().zip(&block[component * b..]) {
                if column != FIXED {
                    each(column as usize, value);
                }
            }
        }
    }
}
