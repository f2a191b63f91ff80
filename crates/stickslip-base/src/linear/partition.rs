//! Which cells go to which of some processes: as many to each, and few points that are in several.

use std::sync::PoisonError;

use super::ordering::METIS;

/// Cells by the points that they couple.
#[derive(Debug, Clone)]
pub(super) struct CellList {
    /// Where the points of a cell start; length `cells + 1`.
    starts: Vec<i32>,
    points: Vec<i32>,
    /// One more than the largest point.
    count: i32,
}

impl Default for CellList {
    fn default() -> Self {
        CellList {
            starts: vec![0],
            points: Vec::new(),
            count: 0,
        }
    }
}

impl CellList {
    /// Adds a cell; its points are counted from the first of the body on. What does not fit the 32-bit indices of METIS cannot be dealt by it.
    pub fn push(&mut self, points: impl Iterator<Item = usize>) {
        for point in points {
            let point = i32::try_from(point).unwrap_or(i32::MAX - 1);
            self.points.push(point);
            self.count = self.count.max(point + 1);
        }
        let end = i32::try_from(self.points.len()).unwrap_or(i32::MAX);
        self.starts.push(end);
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The cells of each of so many processes, ascending. Two cells are neighbours if they have `common` points in common: those of a face. Where METIS does not serve,
    /// each process gets as many that follow each other.
    pub fn deal(&mut self, parts: usize, common: usize) -> Vec<Vec<u32>> {
        let cells = self.len();
        let dealt = match parts > 1 && parts < cells {
            true => self.by_metis(parts, common),
            false => None,
        };
        let share = cells.div_ceil(parts).max(1);
        let mut out = vec![Vec::new(); parts];
        for cell in 0..cells {
            let part = dealt.as_ref().map_or(cell / share, |d| d[cell] as usize);
            out[part].push(cell as u32);
        }
        out
    }

    /// The part of each cell; `None` if METIS fails or the list is too large for it.
    fn by_metis(&mut self, parts: usize, common: usize) -> Option<Vec<i32>> {
        let mut cells = i32::try_from(self.len()).ok()?;
        i32::try_from(self.points.len()).ok()?;
        let points = usize::try_from(self.count)
            .ok()
            .filter(|_| self.count < i32::MAX)?;
        // What a cell costs is the square of its points.
        let squares = self.starts.windows(2).map(|w| (w[1] - w[0]).pow(2));
        let mut weights: Vec<i32> = squares.collect();
        let (mut parts, mut common) = (i32::try_from(parts).ok()?, common as i32);
        let mut cut = 0;
        let mut of_cell = vec![0i32; self.len()];
        let mut of_point = vec![0i32; points];
        let status = {
            let _one_at_a_time = METIS.lock().unwrap_or_else(PoisonError::into_inner);
            // SAFETY: `starts` has `cells + 1` entries that index `points`, whose entries are below `count`; `weights` and the first output have `cells` entries, the
            // second `count`; null means the defaults. METIS writes to none but the outputs, and keeps no pointer.
            unsafe {
                metis_sys::METIS_PartMeshDual(
                    &mut cells,
                    &mut self.count,
                    self.starts.as_mut_ptr(),
                    self.points.as_mut_ptr(),
                    weights.as_mut_ptr(),
                    std::ptr::null_mut(),
                    &mut common,
                    &mut parts,
                    std::ptr::null_mut(),
                    std::ptr::null_mut(),
                    &mut cut,
                    of_cell.as_mut_ptr(),
                    of_point.as_mut_ptr(),
                )
            }
        };
        let sound = status == metis_sys::rstatus_et_METIS_OK
            && of_cell.iter().all(|part| (0..parts).contains(part));
        sound.then_some(of_cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plate of `n × n` quadrilaterals.
    fn plate(n: usize) -> CellList {
        let mut list = CellList::default();
        for (i, j) in (0..n * n).map(|c| (c % n, c / n)) {
            let first = j * (n + 1) + i;
            list.push([first, first + 1, first + n + 2, first + n + 1].into_iter());
        }
        list
    }

    #[test]
    fn each_process_gets_its_part_of_the_cells_and_few_points_of_others() {
        let n = 24;
        for parts in [1, 2, 3, 5, 8] {
            let mut list = plate(n);
            let dealt = list.deal(parts, 2);
            let mut all: Vec<u32> = dealt.concat();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..(n * n) as u32));
            let (mut most, mut points) = (0, 0);
            for cells in &dealt {
                assert!(cells.is_sorted());
                most = most.max(cells.len());
                let of_cell = |&c: &u32| &list.points[4 * c as usize..4 * c as usize + 4];
                let mut own: Vec<i32> = cells.iter().flat_map(of_cell).copied().collect();
                own.sort_unstable();
                own.dedup();
                points += own.len();
            }
            assert!(
                most as f64 <= 1.05 * (n * n) as f64 / parts as f64,
                "{most} of {parts}"
            );
            let shared = points - (n + 1).pow(2);
            assert!(shared <= 2 * n * (parts - 1), "{shared} shared by {parts}");
        }
    }

    #[test]
    fn more_processes_than_cells_are_dealt_one_each() {
        let dealt = plate(2).deal(6, 2);
        let counts: Vec<usize> = dealt.iter().map(Vec::len).collect();
        assert_eq!(counts, [1, 1, 1, 1, 0, 0]);
        assert_eq!(CellList::default().deal(3, 2), vec![Vec::<u32>::new(); 3]);
    }
}
