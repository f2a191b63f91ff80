//! Text files that grow while something runs.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::Error;

use super::{own, write_atomically};

/// A file to which whole pieces of text are added. Each is on its way to the disk when it has been added, and another process may read what is there.
#[derive(Debug)]
pub struct Growing {
    path: PathBuf,
    file: File,
    /// Of whole pieces `[bytes]`.
    length: u64,
}

impl Growing {
    /// Starts the file at `path` with some text, replacing an older one.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn create(path: &Path, head: &str) -> Result<Self, Error> {
        write_atomically(path, head.as_bytes())?;
        Growing::resume(path)
    }

    /// Goes on with the file that is there.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be opened.
    pub fn resume(path: &Path) -> Result<Self, Error> {
        let open = || {
            let file = own::open(path, own::Use::Append)?;
            let length = file.metadata()?.len();
            Ok((file, length))
        };
        let (file, length) = open().map_err(|e| Error::io(path, e))?;
        Ok(Growing {
            path: path.to_path_buf(),
            file,
            length,
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a piece.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written; nothing of it is left then.
    pub fn add(&mut self, text: &str) -> Result<(), Error> {
        // In one call and unbuffered, so that a piece is there entirely or not at all.
        self.file.write_all(text.as_bytes()).map_err(|e| {
            // What a full disk has taken of it goes; the first error is the one to report.
            let _ = self.file.set_len(self.length);
            Error::io(&self.path, e)
        })?;
        self.length += text.len() as u64;
        Ok(())
    }
}
