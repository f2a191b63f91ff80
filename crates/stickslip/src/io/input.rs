//! Reading whole files, within limits.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

use crate::machine;

/// Most bytes of a text that somebody writes by hand or a program writes for it: a problem file, a deck, an expectation.
pub const MOST_TEXT_BYTES: u64 = 1 << 30;

/// The part of the memory that is free which one file may take: what is made of it needs room as well.
const PART: u64 = 4;

/// Refuses what is no file: devices, some of which have no end, folders, and pipes, at whose other end there may be nobody.
///
/// # Errors
/// What the system says; that it is no file.
pub fn check(path: &Path) -> Result<()> {
    let about = std::fs::metadata(path)?;
    let what = match () {
        () if about.is_dir() => "a folder",
        () if is_device(&about) => "a device",
        () if !about.is_file() => "a pipe or a socket",
        () => return Ok(()),
    };
    let why = format!("it is {what}, not a file");
    Err(Error::new(ErrorKind::InvalidInput, why))
}

/// Reads a whole file of at most `limit` bytes that fits into memory; see [`check`].
///
/// # Errors
/// What the system says; that it is no file; that it is too large.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>> {
    // Before it is opened: the other end of a pipe would be waited for.
    check(path)?;
    let file = File::open(path)?;
    let about = file.metadata()?;
    let refuse = |why: String| Err(Error::new(ErrorKind::InvalidInput, why));
    let free = machine::available_memory();
    let limit = free.map_or(limit, |free| limit.min(free / PART));
    let too_large = |size: &str| {
        let most = machine::bytes(limit);
        refuse(format!("it has {size}, more than the {most} that are read"))
    };
    if about.len() > limit {
        return too_large(&machine::bytes(about.len()));
    }
    let mut bytes = Vec::new();
    // It may have grown meanwhile.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return too_large("no end");
    }
    Ok(bytes)
}

/// Reads a whole text, see [`read`].
///
/// # Errors
/// Those of [`read`]; that it is not UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    let bytes = read(path, MOST_TEXT_BYTES)?;
    String::from_utf8(bytes).map_err(|_| Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

#[cfg(unix)]
fn is_device(about: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = about.file_type();
    kind.is_char_device() || kind.is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: &std::fs::Metadata) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_some_size_are_read() {
        let path = std::env::temp_dir().join(format!("stickslip-input-{}", std::process::id()));
        std::fs::write(&path, b"12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        let why = |path: &Path, limit| read(path, limit).unwrap_err().to_string();
        assert!(why(&path, 4).contains("more than the"));
        assert_eq!(why(&std::env::temp_dir(), 5), "it is a folder, not a file");
        std::fs::write(&path, b"\xff").unwrap();
        assert!(read_text(&path).is_err());
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    #[cfg(unix)]
    fn a_device_is_no_file() {
        let why = read(Path::new("/dev/zero"), u64::MAX).unwrap_err();
        assert_eq!(why.to_string(), "it is a device, not a file");
    }

    #[test]
    #[cfg(unix)]
    fn nobody_is_waited_for_at_the_other_end_of_a_pipe() {
        let name = format!("stickslip-pipe-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        if !made.is_ok_and(|status| status.success()) {
            return;
        }
        let why = read(&path, MOST_TEXT_BYTES).unwrap_err().to_string();
        assert_eq!(why, "it is a pipe or a socket, not a file");
        std::fs::remove_file(path).unwrap();
    }
}
