use std::ops::Range;

use super::contract::Cut;
use crate::linear::ordering::NONE;
use crate::linear::{LinearError, Matrix};

/// The free dofs of a body, those of the interior first: both in ascending order, known by their *positions*.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// First dof of the body.
    origin: usize,
    pub(super) interior: Vec<u32>,
    pub(super) root: Vec<u32>,
    /// The position of each dof of the body, or [`NONE`].
    position: Vec<u32>,
}

impl Split {
    /// Cuts a body in two.
    ///
    /// # Errors
    /// [`LinearError::NotAnalysed`] if a free dof of the body is coupled to a free dof of another, in a matrix that is kept.
    pub fn new(matrix: &dyn Matrix, (points, fixed, kept): Cut) -> Result<Split, LinearError> {
        let b = matrix.block_size();
        let free = |point: usize| (point * b..(point + 1) * b).filter(|&dof| !fixed[dof]);
        let (mut interior, mut root) = (Vec::new(), Vec::new());
        for point in points.clone() {
            let Some(dof) = free(point).next() else {
                continue;
            };
            let others = matrix.kept().map_or(&[][..], |m| m.neighbours(point));
            let others = others.iter().map(|&p| p as usize);
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
        let mut position = vec![NONE; points.len() * b];
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

    /// The points of the body, with `block` dofs each.
    pub fn points(&self, block: usize) -> Range<usize> {
        self.origin / block..(self.origin + self.position.len()) / block
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

    /// The position of a dof: `None` where it is no unknown, or of another body.
    pub fn position(&self, dof: usize) -> Option<usize> {
        let position = *self.position.get(dof.checked_sub(self.origin)?)?;
        (position != NONE).then_some(position as usize)
    }

    /// Whether a dof is of the body.
    pub fn contains(&self, dof: usize) -> bool {
        dof >= self.origin && dof - self.origin < self.position.len()
    }
}
