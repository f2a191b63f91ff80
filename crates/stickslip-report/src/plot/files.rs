//! The files that are written: which times they are of, what they are called, and what can be drawn on.

use std::path::{Path, PathBuf};

use stickslip::Error;

use super::picture::When;
use crate::draw::{self, Canvas};
use crate::field::{self, Interest};
use crate::results::{Results, fault};
use crate::sheet::latest_largest;

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

/// The time of interest of a field; that at which contact presses most if none is named.
fn of_interest(results: &Results, name: Option<&str>) -> Result<usize, Error> {
    let last = results.frames.len() - 1;
    if results.frames[last].phase.is_some() && name.is_none() {
        // The real part.
        return Ok(0);
    }
    let arrays = results.points(last)?.arrays;
    let field = name.and_then(|name| field::named(&field::with_invariants(&arrays), name));
    let Some(field) = field else {
        return results.of_peak();
    };
    match field.interest() {
        Interest::Pressure => results.of_peak(),
        Interest::End => Ok(last),
        Interest::Largest => {
            let largest = |frame: usize| {
                let points = results.points(frame)?;
                let array = points.arrays.get(&field.array);
                let values = array.map_or(0..0, |_| 0..points.points.len());
                let sizes = values.filter_map(|p| Some(field.value(array?, p).abs()));
                Ok(sizes.filter(|v| v.is_finite()).fold(0.0, f64::max))
            };
            let all: Result<Vec<f64>, Error> = (0..=last).map(largest).collect();
            Ok(latest_largest(&all?))
        }
    }
}

/// The frames that are wanted of a field.
pub fn chosen(results: &Results, when: When, field: Option<&str>) -> Result<Vec<usize>, Error> {
    let count = results.frames.len();
    Ok(match when {
        When::Peak => vec![of_interest(results, field)?],
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
