//! The files that are written: which times they are of, what they are called, and what can be drawn on.

use std::path::{Path, PathBuf};

use stickslip::Error;

use super::picture::When;
use crate::draw::{self, Canvas};
use crate::results::{Results, fault};

/// Sizes of pictures that are made `[pixels]`.
const SIZES: std::ops::RangeInclusive<u32> = 200..=8000;

/// A canvas for a file.
pub fn canvas(file: &Path, size: [u32; 2]) -> Result<Box<dyn Canvas>, Error> {
    if !size.iter().all(|n| SIZES.contains(n)) {
        let [w, h] = size;
        return Err(fault(
            file,
            format!(
                "a picture of {w}x{h} is not made: width and height are between {} and {}",
                SIZES.start(),
                SIZES.end()
            ),
        ));
    }
    draw::canvas(file, size)
        .ok_or_else(|| fault(file, "the name of a picture ends with .png or .svg"))
}

/// The frames that are wanted.
pub fn chosen(results: &Results, when: When) -> Result<Vec<usize>, Error> {
    let count = results.frames.len();
    Ok(match when {
        When::Peak => vec![results.of_peak()?],
        When::Last => vec![count - 1],
        When::All => (0..count).collect(),
        When::Number(n) if (1..=count).contains(&n) => vec![n - 1],
        When::Number(n) => {
            return Err(fault(
                &results.directory,
                format!("there is no time {n}: fields were written at {count} times"),
            ));
        }
    })
}

/// `plot.png` of time 7 is `plot_00007.png`.
pub fn numbered(file: &Path, number: usize) -> PathBuf {
    let part = |p: Option<&std::ffi::OsStr>| p.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(file.file_stem()), part(file.extension()));
    file.with_file_name(format!("{stem}_{number:05}.{ending}"))
}

/// `scar.svg` of what lies beside is `scar-opposite.svg`.
pub fn beside(file: &Path, what: &str) -> PathBuf {
    let part = |p: Option<&std::ffi::OsStr>| p.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(file.file_stem()), part(file.extension()));
    file.with_file_name(format!("{stem}-{what}.{ending}"))
}
