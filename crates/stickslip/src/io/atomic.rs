use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::Path;

use super::own;
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
    let written = own::make(&temporary).and_then(|mut file| file.write_all(bytes));
    let result = written.and_then(|()| fs::rename(&temporary, path));
    result.map_err(|e| {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
        Error::io(path, e)
    })
}

/// The file that is being written under this temporary name, or was when its process was killed.
pub(crate) fn meant_by(name: &str) -> Option<&str> {
    let inner = name.strip_prefix('.')?.strip_suffix(".tmp")?;
    let (name, process) = inner.rsplit_once('.')?;
    let number = !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit());
    number.then_some(name)
}

/// Removes what processes left aside that were killed while they wrote this file. Only where no other process is writing it.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be read, or what was left cannot be removed.
pub fn drop_leftovers(path: &Path) -> Result<(), Error> {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    for entry in fs::read_dir(folder).map_err(|e| Error::io(folder, e))? {
        let entry = entry.map_err(|e| Error::io(folder, e))?;
        let name = entry.file_name();
        let meant = name.to_str().and_then(meant_by);
        if meant.is_some() && meant == path.file_name().and_then(|n| n.to_str()) {
            fs::remove_file(entry.path()).map_err(|e| Error::io(&entry.path(), e))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_killed_process_left_of_a_file_goes_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("stickslip-left-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let kept = [
            "a.txt",
            ".b.txt.12.tmp",
            ".a.txt.tmp",
            ".a.txt.x.tmp",
            "a.txt.12.tmp",
        ];
        for name in kept.iter().chain(&[".a.txt.12.tmp", ".a.txt.4711.tmp"]) {
            fs::write(folder.join(name), "").unwrap();
        }
        drop_leftovers(&folder.join("a.txt")).unwrap();
        for name in kept {
            assert!(folder.join(name).exists(), "{name}");
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), kept.len());
        fs::remove_dir_all(&folder).unwrap();
    }

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
