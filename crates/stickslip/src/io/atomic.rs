use std::ffi::OsString;
use std::fs;
use std::path::Path;

use crate::error::Error;

/// Writes a file so that a reader sees either the old one or the whole new one: under a temporary name beside it, then
/// renamed.
///
/// # Errors
/// [`Error::Io`] if the folder does not exist or cannot be written, or the disk is full. No temporary file is left.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(name);
    let result = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    result.map_err(|e| {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
        Error::io(path, e)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_and_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("stickslip-atomic-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a.txt");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        // A folder cannot be replaced by a file.
        assert!(write_atomically(&folder, b"three").is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        let missing = folder.join("missing").join("a.txt");
        let error = write_atomically(&missing, b"").unwrap_err();
        assert!(error.to_string().contains("missing"), "{error}");
        fs::remove_dir_all(&folder).unwrap();
    }
}
