//! Arrays in the format `.npy` of NumPy, version 1.0 (NumPy reference, *numpy.lib.format*), little-endian and row by row.
//!
//! What is written is a line of text and the numbers; a crate for it would bring structured types, big-endian numbers and readers along.

use std::path::Path;

use super::write_atomically;
use crate::error::Error;

/// Numbers of an array, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Numbers {
    /// Of double precision.
    Floats(Vec<f64>),
    /// Whole ones.
    Integers(Vec<i64>),
}

/// The header ends at a multiple of this.
const ALIGNED: usize = 64;

/// Bytes before the text of the header: magic string, version and length.
const BEFORE: usize = 10;

/// Writes an array of two dimensions.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn write(path: &Path, shape: [usize; 2], numbers: &Numbers) -> Result<(), Error> {
    write_atomically(path, &bytes(shape, numbers))
}

/// The bytes of the file.
fn bytes([rows, columns]: [usize; 2], numbers: &Numbers) -> Vec<u8> {
    let kind = match numbers {
        Numbers::Floats(_) => "<f8",
        Numbers::Integers(_) => "<i8",
    };
    let mut text =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    let length = (BEFORE + text.len() + 1).next_multiple_of(ALIGNED);
    text.push_str(&" ".repeat(length - BEFORE - text.len() - 1));
    text.push('\n');
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((text.len() as u16).to_le_bytes());
    out.extend(text.as_bytes());
    match numbers {
        Numbers::Floats(all) => out.extend(all.iter().flat_map(|x| x.to_le_bytes())),
        Numbers::Integers(all) => out.extend(all.iter().flat_map(|x| x.to_le_bytes())),
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `numpy.save` of NumPy 2 writes for `[[1.5, -2.0, 0.25]]` and for `[[1], [-2]]`.
    #[test]
    fn bytes_are_those_of_numpy() {
        let head = |kind: &str, shape: &str| {
            let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
            let mut head = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
            head.extend(format!("{text:<117}\n").bytes());
            head
        };
        let mut floats = head("<f8", "(1, 3)");
        for word in [
            0x3FF8_0000_0000_0000_u64,
            0xC000_0000_0000_0000,
            0x3FD0_0000_0000_0000,
        ] {
            floats.extend(word.to_le_bytes());
        }
        assert_eq!(
            bytes([1, 3], &Numbers::Floats(vec![1.5, -2.0, 0.25])),
            floats
        );
        let mut whole = head("<i8", "(2, 1)");
        whole.extend([
            1, 0, 0, 0, 0, 0, 0, 0, 0xFE, 255, 255, 255, 255, 255, 255, 255,
        ]);
        assert_eq!(bytes([2, 1], &Numbers::Integers(vec![1, -2])), whole);
    }
}
