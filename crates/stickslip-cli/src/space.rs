//! Whether there is room for what a run writes.

use std::path::Path;

use stickslip::machine::bytes;
use stickslip::run::Sizes;

/// More than so many bytes are worth a word, however much is free.
const MUCH: u64 = 10_000_000_000;

/// What is to be said before a run that writes so much into a folder.
pub fn warning(sizes: &Sizes, folder: &Path) -> Option<String> {
    text(sizes, free(folder))
}

fn text(sizes: &Sizes, free: Option<u64>) -> Option<String> {
    let total = sizes.total();
    let full = free.is_some_and(|free| total > free);
    if !full && total < MUCH {
        return None;
    }
    let room = match free {
        Some(free) => format!(", and {} are free", bytes(free)),
        None => String::new(),
    };
    Some(format!(
        "warning: the results may take {}{room}: {} rows of history.csv up to {}, {} times fields up to {} each before compression; \
         `output.history-every` and `output.every` make them fewer",
        bytes(total),
        sizes.rows,
        bytes(sizes.rows.saturating_mul(sizes.row)),
        sizes.outputs,
        bytes(sizes.fields)
    ))
}

/// Bytes that are free where a folder is or will be; `None` where the system does not tell.
#[cfg(unix)]
fn free(folder: &Path) -> Option<u64> {
    use std::os::unix::ffi::OsStrExt;
    let whole = std::path::absolute(folder).ok()?;
    let there = whole.ancestors().find(|path| path.exists())?;
    let path = std::ffi::CString::new(there.as_os_str().as_bytes()).ok()?;
    // SAFETY: numbers, all of which may be zero; the path ends with a zero and lives longer than the call.
    let told = unsafe {
        let mut told: libc::statvfs = std::mem::zeroed();
        (libc::statvfs(path.as_ptr(), &mut told) == 0).then_some(told)
    }?;
    // Their types differ between systems.
    #[allow(clippy::unnecessary_cast)]
    Some(told.f_bavail as u64 * told.f_frsize as u64)
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_and_what_is_much_is_told() {
        let small = Sizes {
            rows: 1000,
            row: 100,
            ..Sizes::default()
        };
        assert_eq!(text(&small, None), None);
        assert_eq!(text(&small, Some(200_000)), None);
        let told = text(&small, Some(50_000)).unwrap_or_default();
        assert!(
            told.contains("may take 100.0 kB, and 50.0 kB are free"),
            "{told}"
        );
        let large = Sizes {
            rows: 1_000_000_000,
            ..small
        };
        assert!(text(&large, Some(u64::MAX)).is_some());
    }

    #[cfg(unix)]
    #[test]
    fn free_space_is_that_of_the_nearest_folder_there_is() {
        let here = std::env::temp_dir();
        assert!(free(&here.join("no/such/folder")).is_some());
        assert_eq!(free(Path::new("/proc")), Some(0));
    }
}
