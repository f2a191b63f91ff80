//! Values of all cells of a block, computed in parallel and consumed in order.

use rayon::prelude::*;

/// Cells computed by one task.
const CELLS_PER_TASK: usize = 16;

/// Values held at a time by each of the two buffers: 2 MiB, so that what is consumed is still in the cache.
const BUFFER: usize = 1 << 18;

/// Computes `width` values for each of `cells` cells and hands them to `consume`, cell by cell in order.
///
/// `compute(first, part)` fills the values of the cells from `first` on, as many as fit `part`. While one wave of
/// cells is consumed the next is computed. What `consume` sees does not depend on the number of threads.
pub(super) fn in_order<C, S>(cells: usize, width: usize, compute: C, mut consume: S)
where
    C: Fn(usize, &mut [f64]) + Sync,
    S: FnMut(usize, &[f64]) + Send,
{
    let tasks = (BUFFER / (width * CELLS_PER_TASK)).max(1);
    let wave = (tasks * CELLS_PER_TASK).min(cells);
    let fill = |first: usize, buffer: &mut [f64]| {
        let count = wave.min(cells - first);
        buffer[..count * width]
            .par_chunks_mut(CELLS_PER_TASK * width)
            .enumerate()
            .for_each(|(task, part)| compute(first + task * CELLS_PER_TASK, part));
    };
    if cells == 0 {
        return;
    }
    let mut ready = vec![0.0; wave * width];
    let mut next = if wave < cells {
        ready.clone()
    } else {
        Vec::new()
    };
    fill(0, &mut ready);
    let mut first = 0;
    while first < cells {
        let following = first + wave;
        let count = wave.min(cells - first);
        rayon::join(
            || {
                for (c, values) in ready[..count * width].chunks_exact(width).enumerate() {
                    consume(first + c, values);
                }
            },
            || {
                if following < cells {
                    fill(following, &mut next);
                }
            },
        );
        std::mem::swap(&mut ready, &mut next);
        first = following;
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_cell_once_and_in_order() {
        for (cells, width) in [(0, 3), (1, 7), (33, 2), (5000, 1200)] {
            let mut seen = Vec::new();
            super::in_order(
                cells,
                width,
                |first, part| {
                    for (i, v) in part.iter_mut().enumerate() {
                        *v = (first * width + i) as f64;
                    }
                },
                |cell, values| {
                    assert_eq!(values[0], (cell * width) as f64);
                    assert_eq!(values[width - 1], (cell * width + width - 1) as f64);
                    seen.push(cell);
                },
            );
            assert!(seen.iter().copied().eq(0..cells));
        }
    }
}
