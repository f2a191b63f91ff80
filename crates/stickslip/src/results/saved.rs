//! Checkpoints as files: `checkpoint_N.bin` in the folder of results, N the increments accepted until then.
//!
//! A file holds all that `resume` needs: the problem and the files it was read from with their digests, how far the files of results had come, and the
//! state. It is written aside, synced and renamed, so that under its name there is a whole one or none; the last two are kept. In front stand a
//! mark, the version of the program, and a digest of the rest: what was cut or changed is found before anything is made of it.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::observer::Snapshot;
use crate::error::{Error, IoError};
use crate::keep::{Keep, Kept};
use crate::linear::Digest;

/// What a run was called with.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Source {
    /// The problem as it was run, as the text of a problem file.
    pub problem: String,
    /// The file that was named, a problem file or a deck, and the values that were changed.
    pub file: String,
    /// `path=value`.
    pub overrides: Vec<String>,
    /// All files that were read, with digests of what was in them.
    pub inputs: Vec<(String, [u64; 2])>,
    /// Folder of factors.
    pub cache: Option<String>,
}

/// How far the files of results had come.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Positions {
    /// Fields written, by time.
    pub fields: Vec<(f64, String)>,
    /// Lengths of files that grow `[bytes]`.
    pub lengths: Vec<(String, u64)>,
    /// Columns of the history.
    pub columns: usize,
}

/// A checkpoint with all that is needed to go on from it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Saved {
    /// What the run was called with.
    pub source: Source,
    /// The state.
    pub snapshot: Snapshot,
    pub(crate) positions: Positions,
}

crate::keep!(Source {
    problem,
    file,
    overrides,
    inputs,
    cache
});
crate::keep!(Positions {
    fields,
    lengths,
    columns
});
crate::keep!(Saved {
    source,
    snapshot,
    positions
});

/// What a checkpoint begins with, in the version of its layout.
const MARK: &[u8; 16] = b"stickslip state1";

/// How many are kept.
const KEPT: usize = 2;

/// The increments in the name of a checkpoint; `None` of other names.
pub(super) fn number(name: &str) -> Option<usize> {
    let digits = name.strip_prefix("checkpoint_")?.strip_suffix(".bin")?;
    digits.parse().ok()
}

/// The checkpoints in a folder, newest first: increments and path.
pub fn checkpoints(directory: &Path) -> Vec<(usize, PathBuf)> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    let mut all: Vec<(usize, PathBuf)> = entries
        .filter_map(|e| Some((number(e.file_name().to_str()?)?, e.path())))
        .collect();
    all.sort();
    all.reverse();
    all
}

/// A digest of what is in a file.
///
/// # Errors
/// [`Error::Io`] if it cannot be read.
pub fn digest_of(path: &Path) -> Result<[u64; 2], Error> {
    let bytes = fs::read(path).map_err(|e| Error::io(path, e))?;
    let mut digest = Digest::default();
    digest.bytes(&bytes);
    Ok(digest.finish())
}

fn fault(path: &Path, message: impl Into<String>) -> Error {
    Error::Io(IoError {
        file: path.to_path_buf(),
        message: message.into(),
    })
}

impl Saved {
    /// Writes it into a folder, and removes all but the last two.
    pub(crate) fn write(&self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(format!("checkpoint_{}.bin", self.snapshot.increments));
        let aside = directory.join(".checkpoint.tmp");
        let written = put(&aside, &self.to_bytes()).and_then(|()| fs::rename(&aside, &path));
        if let Err(e) = written.and_then(|()| sync(directory)) {
            // The first error is the one to report.
            let _ = fs::remove_file(&aside);
            return Err(fault(
                &path,
                format!("the checkpoint cannot be written: {e}; the one before stays"),
            ));
        }
        // Those of an attempt that is over: the run went on from an earlier one.
        let (later, earlier): (Vec<_>, Vec<_>) = checkpoints(directory)
            .into_iter()
            .partition(|(n, _)| *n > self.snapshot.increments);
        for (_, old) in later.iter().chain(earlier.iter().skip(KEPT)) {
            fs::remove_file(old).map_err(|e| Error::io(old, e))?;
        }
        Ok(())
    }

    fn to_bytes(&self) -> Vec<u8> {
        let mut content = Vec::new();
        self.keep(&mut content);
        let mut out = MARK.to_vec();
        env!("CARGO_PKG_VERSION").to_string().keep(&mut out);
        digest(&content).keep(&mut out);
        out.append(&mut content);
        out
    }

    /// The checkpoint in a file.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, is none, of another version, or damaged.
    pub fn read(path: &Path) -> Result<Saved, Error> {
        let bytes = fs::read(path).map_err(|e| Error::io(path, e))?;
        let Some(rest) = bytes.strip_prefix(MARK) else {
            let known = bytes.starts_with(&MARK[..15]);
            return Err(fault(
                path,
                match known {
                    true => {
                        "the checkpoint has another layout than this version of stickslip reads: resume with the version that wrote it"
                    }
                    false => "this is no checkpoint, or it is damaged at its beginning",
                },
            ));
        };
        let damaged = || fault(path, "the checkpoint is damaged: it is cut, or was changed");
        let mut kept = Kept::new(rest);
        let version = String::back(&mut kept).map_err(|_| damaged())?;
        if version != env!("CARGO_PKG_VERSION") {
            return Err(fault(
                path,
                format!(
                    "the checkpoint was written by stickslip {version}, and this is {}: resume with that version",
                    env!("CARGO_PKG_VERSION")
                ),
            ));
        }
        let wanted = <[u64; 2]>::back(&mut kept).map_err(|_| damaged())?;
        if digest(kept.rest()) != wanted {
            return Err(damaged());
        }
        let saved = Saved::back(&mut kept).map_err(|_| damaged())?;
        match kept.is_empty() {
            true => Ok(saved),
            false => Err(damaged()),
        }
    }

    /// The newest checkpoint of a folder from which a run can go on, or that after `from` increments; with notes about those that are passed over.
    ///
    /// # Errors
    /// [`Error::Io`] if there is none.
    pub fn find(directory: &Path, from: Option<usize>) -> Result<(Saved, Vec<String>), Error> {
        let all = checkpoints(directory);
        let numbers = || -> String {
            let all: Vec<String> = all.iter().map(|(n, _)| n.to_string()).collect();
            all.join(", ")
        };
        if !directory.is_dir() {
            return Err(fault(
                directory,
                "this is no folder of results: name the folder that `run` wrote, `<file>.out` if not chosen by --output",
            ));
        }
        if all.is_empty() {
            return Err(fault(
                directory,
                "there is no checkpoint in this folder: run the problem again; `output.checkpoint` says when one is written",
            ));
        }
        let mut notes = Vec::new();
        let mut first = None;
        for (n, path) in &all {
            if from.is_some_and(|from| from != *n) {
                continue;
            }
            let read = Saved::read(path);
            match read.and_then(|saved| saved.positions.check(directory).map(|()| saved)) {
                Ok(saved) => return Ok((saved, notes)),
                Err(e) => {
                    notes.push(format!("{e}; the checkpoint before it is tried"));
                    first.get_or_insert(e);
                }
            }
        }
        Err(first.unwrap_or_else(|| {
            let message = format!(
                "there is no checkpoint after {} increments: there are those after {}",
                from.unwrap_or_default(),
                numbers()
            );
            fault(directory, message)
        }))
    }

    /// Whether the files that the problem was read from are what they were.
    ///
    /// # Errors
    /// [`Error::Io`] of the first that is not; the problem file itself is compared by its keys.
    pub fn check_inputs(&self) -> Result<(), Error> {
        for (name, wanted) in &self.source.inputs {
            let path = Path::new(name);
            let main = *name == self.source.file && !name.to_ascii_lowercase().ends_with(".inp");
            if !main && digest_of(path)? != *wanted {
                return Err(fault(
                    path,
                    "this file has changed since the run began: a run goes on from the files it began with, so bring the old one back, or run again",
                ));
            }
        }
        Ok(())
    }
}

impl Positions {
    /// Whether the files in a folder have come at least so far.
    fn check(&self, directory: &Path) -> Result<(), Error> {
        for (name, length) in &self.lengths {
            let path = directory.join(name);
            let there = fs::metadata(&path).map_err(|e| Error::io(&path, e))?.len();
            if there < *length {
                return Err(fault(&path, "the file is shorter than at the checkpoint"));
            }
        }
        for (_, name) in &self.fields {
            let path = directory.join(name);
            fs::metadata(&path).map_err(|e| Error::io(&path, e))?;
        }
        Ok(())
    }

    /// Cuts files back to where they were.
    pub(crate) fn restore(&self, directory: &Path) -> Result<(), Error> {
        for (name, length) in &self.lengths {
            let path = directory.join(name);
            let file = File::options().write(true).open(&path);
            let cut = file.and_then(|f| f.set_len(*length));
            cut.map_err(|e| Error::io(&path, e))?;
        }
        Ok(())
    }
}

fn digest(content: &[u8]) -> [u64; 2] {
    let mut digest = Digest::default();
    digest.bytes(content);
    digest.finish()
}

fn put(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// The name in a folder is on disk, too. Elsewhere than on Unix folders cannot be synced.
fn sync(directory: &Path) -> std::io::Result<()> {
    match cfg!(unix) {
        true => File::open(directory)?.sync_all(),
        false => Ok(()),
    }
}
