use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::block::{Block, Moment};
use super::layout::Layout;
use crate::error::{Error, IoError};
use crate::io::{own, write_atomically};

/// The last line of a file, over which the next output is written.
pub const END_LINE: &[u8] = b" 9999\n";

/// How much there is in a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub struct Tally {
    /// Outputs.
    pub outputs: usize,
    /// Blocks of values.
    pub blocks: usize,
}

/// A file to which outputs are added. It is whole after each.
#[derive(Debug)]
pub struct Results {
    path: PathBuf,
    file: File,
    layout: Layout,
    /// Up to the last line `[bytes]`.
    length: u64,
    tally: Tally,
}

impl Results {
    /// Starts a file with nodes and elements, replacing an older one.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn create(path: &Path, layout: Layout) -> Result<Self, Error> {
        write_atomically(path, &[&layout.head, END_LINE].concat())?;
        Results::resume(path, layout, Tally::default())
    }

    /// Goes on with a file that has so much in it.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be opened, or does not end as such a file does.
    pub fn resume(path: &Path, layout: Layout, tally: Tally) -> Result<Self, Error> {
        let (file, length) = open(path).map_err(|e| Error::io(path, e))?;
        let length = length.ok_or_else(|| {
            Error::Io(IoError {
                file: path.to_path_buf(),
                message: "the file does not end with 9999: it was changed since it was written"
                    .into(),
            })
        })?;
        Ok(Results {
            path: path.to_path_buf(),
            file,
            layout,
            length,
            tally,
        })
    }

    /// What all blocks have in common.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// How much there is in it.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Adds an output.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written; nothing of it is left then.
    pub fn add(&mut self, moment: &Moment, blocks: &[Block]) -> Result<(), Error> {
        let mut tally = self.tally;
        tally.outputs += 1;
        let mut bytes = Vec::new();
        for block in blocks {
            tally.blocks += 1;
            let (number, output) = (tally.blocks, tally.outputs);
            block.write(&self.layout, moment, number, output, &mut bytes);
        }
        let grown = self.length + bytes.len() as u64;
        bytes.extend(END_LINE);
        if let Err(e) = self.put(&bytes) {
            // What a full disk has taken of it goes; the first error is the one to report.
            let _ = self.file.set_len(self.length);
            let _ = self.put(END_LINE);
            return Err(Error::io(&self.path, e));
        }
        self.length = grown;
        self.tally = tally;
        Ok(())
    }

    /// Writes over the last line, in one call and unbuffered.
    fn put(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.file.seek(SeekFrom::Start(self.length))?;
        self.file.write_all(bytes)
    }
}

/// Ends a file that was cut back to the end of an output.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn end_again(path: &Path) -> Result<(), Error> {
    let end = || {
        let mut file = own::open(path, own::Use::Append)?;
        file.write_all(END_LINE)
    };
    end().map_err(|e| Error::io(path, e))
}

/// A file, and its length up to the last line if it has that.
fn open(path: &Path) -> std::io::Result<(File, Option<u64>)> {
    let mut file = own::open(path, own::Use::Change)?;
    let length = file.metadata()?.len().checked_sub(END_LINE.len() as u64);
    let Some(length) = length else {
        return Ok((file, None));
    };
    file.seek(SeekFrom::Start(length))?;
    let mut last = [0; END_LINE.len()];
    file.read_exact(&mut last)?;
    Ok((file, (last == END_LINE).then_some(length)))
}
