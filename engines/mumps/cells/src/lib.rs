//! Matrices of cells for the ranks of `stickslip-mumps`: the code that computes them in the program itself, called from C.
//!
//! What a rank is dealt comes as the bytes that [`Portion`] writes, behind the rows of its points; what it makes of it goes back entry by entry. A program of another
//! version of stickslip, whose bytes mean something else, is refused.

use std::ffi::c_void;

use rayon::ThreadPoolBuilder;
use stickslip_base::keep::{Broken, Keep, Kept};
use stickslip_base::linear::Matrix;
use stickslip_mechanics::body::Portion;

/// In place of the row of a dof that is no unknown.
const NO_ROW: u32 = u32::MAX;

/// Takes row, column and value, after what its caller has handed over for it.
type Take = extern "C" fn(*mut c_void, u32, u32, f64);

/// Hands out the lower triangle of the sum of the matrices of some cells; in equal places there is one entry a body. Returns 0; `1 + row` where an entry is no number; -1 if the words are those
/// of another version.
///
/// # Safety
/// `words` has to point to `count` words. `take` is called on the thread of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_cells(
    words: *const u64,
    count: usize,
    take: Take,
    to: *mut c_void,
) -> i64 {
    // SAFETY: the caller says so.
    let words = unsafe { std::slice::from_raw_parts(words, count) };
    // One thread a rank, which is this one: the pool takes it in. At the second call it is in already, and that is refused.
    let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    std::mem::forget(pool.build());
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let mut sink = Sink { take, to, wrong: 0 };
    let done = entries(&bytes, &mut |row, column, value| {
        sink.put(row, column, value)
    });
    if done.is_ok() { sink.wrong } else { -1 }
}

/// Where entries go.
struct Sink {
    take: Take,
    to: *mut c_void,
    /// 1 more than the row of the first that is no number.
    wrong: i64,
}

// SAFETY: entries of a matrix that is kept are handed out on the thread that asks for them.
unsafe impl Send for Sink {}

impl Sink {
    fn put(&mut self, row: u32, column: u32, value: f64) {
        if !value.is_finite() && self.wrong == 0 {
            self.wrong = 1 + i64::from(row);
        }
        (self.take)(self.to, row, column, value);
    }
}

fn entries(bytes: &[u8], visit: &mut (dyn FnMut(u32, u32, f64) + Send)) -> Result<(), Broken> {
    let portions: Vec<(Vec<u32>, Vec<u8>)> = Keep::back(&mut Kept::new(bytes))?;
    for (rows, bytes) in portions {
        let stiffness = Portion::from_bytes(&bytes)?.stiffness();
        if rows.len() != stiffness.rows() {
            return Err(Broken);
        }
        stiffness.summands(0..stiffness.points(), &mut |i, j, value| {
            let (row, column) = (rows[i], rows[j]);
            if row != NO_ROW && column <= row {
                visit(row, column, value);
            }
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    extern "C" fn count(to: *mut c_void, _: u32, _: u32, _: f64) {
        // SAFETY: it is the counter of the test.
        unsafe { *to.cast::<usize>() += 1 };
    }

    fn made(bytes: &[u8]) -> (i64, usize) {
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(8), 0);
        let word = |chunk: &[u8]| u64::from_ne_bytes(chunk.try_into().expect("eight bytes"));
        let words: Vec<u64> = padded.chunks(8).map(word).collect();
        let mut entries = 0_usize;
        let to = (&raw mut entries).cast();
        // SAFETY: the words are there, and `count` takes the counter.
        let status = unsafe { stickslip_cells(words.as_ptr(), words.len(), count, to) };
        (status, entries)
    }

    #[test]
    fn what_is_no_portion_is_refused_and_nothing_makes_nothing() {
        let mut none = Vec::new();
        Vec::<(Vec<u32>, Vec<u8>)>::new().keep(&mut none);
        assert_eq!(made(&none), (0, 0));
        let mut other = Vec::new();
        vec![(vec![0_u32, 1], b"something else".to_vec())].keep(&mut other);
        assert_eq!(made(&other), (-1, 0));
        assert_eq!(made(&[255; 64]), (-1, 0));
    }
}
