//! Checkpoints as files: `checkpoint_N.bin` in the folder of results, N the increments accepted until then.
//!
//! A file holds all that `resume` needs: the problem and the files it was read from with their digests, how far the files of results had come, and the
//! state, all of it [sealed](super::sealed). It is written aside, synced and renamed, so that under its name there is a whole one or none; the last two
//! are kept.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};

use super::frd::Reached;
use super::observer::Snapshot;
use super::sealed;
use crate::error::{Error, IoError};
use crate::io::{input, own};

/// What a run was called with.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
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
    /// What it had from the program that called the library, and no file has.
    pub lent: Lent,
}

/// What a run has from a program, and no file has.
#[derive(Debug, Clone, Default, PartialEq, Eq, crate::keep::Keep)]
pub struct Lent {
    /// Meshes, by the names that the problem has for them, with their digests.
    pub meshes: Vec<(String, [u64; 2])>,
    /// Laws that are functions: `press.friction`.
    pub laws: Vec<String>,
}

/// How far the files of results had come.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub(crate) struct Positions {
    /// Fields written, by time.
    pub fields: Vec<(f64, String)>,
    /// How many outputs there were; there are fewer fields where some were removed before the run went on.
    pub outputs: usize,
    /// How far files that grow had come.
    pub lengths: Vec<(String, Come)>,
    /// Columns of the history.
    pub columns: usize,
    /// How far the `.frd` file had come, if there is one.
    pub frd: Option<Reached>,
}

/// How far a file had come that grows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub(crate) struct Come {
    /// `[bytes]`
    pub length: u64,
    /// A digest of the last of it.
    pub tail: [u64; 2],
}

/// So much of the end of a file is looked at `[bytes]`: some rows, of which no two are alike, as each has its time.
const TAIL_BYTES: u64 = 1 << 16;

/// A digest of the last that a file has before a length.
pub(super) fn tail(mut file: &File, length: u64) -> std::io::Result<[u64; 2]> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL_BYTES)))?;
    file.take(length.min(TAIL_BYTES)).read_to_end(&mut bytes)?;
    Ok(sealed::digest(&bytes))
}

/// A checkpoint with all that is needed to go on from it.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct Saved {
    /// What the run was called with.
    pub source: Source,
    /// The state.
    pub snapshot: Snapshot,
    pub(crate) positions: Positions,
}

/// What a checkpoint is called until it is whole.
pub(super) const ASIDE: &str = ".checkpoint.tmp";

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

/// Removes the checkpoints after more than so many increments: the run goes on from an earlier one.
pub(super) fn drop_later(directory: &Path, increments: usize) -> Result<(), Error> {
    for (n, path) in checkpoints(directory) {
        if n > increments {
            fs::remove_file(&path).map_err(|e| Error::io(&path, e))?;
        }
    }
    Ok(())
}

/// Whether this is a folder, in which there may be results.
pub(super) fn check_folder(directory: &Path) -> Result<(), Error> {
    match directory.is_dir() {
        true => Ok(()),
        false => Err(fault(
            directory,
            "this is no folder of results: name the folder that `run` wrote, `<file>.out` if not chosen by --output",
        )),
    }
}

/// A digest of what is in a file.
///
/// # Errors
/// [`Error::Io`] if it cannot be read.
pub fn digest_of(path: &Path) -> Result<[u64; 2], Error> {
    let bytes = input::check(path).and_then(|()| fs::read(path));
    let bytes = bytes.map_err(|e| Error::io(path, e))?;
    Ok(sealed::digest(&bytes))
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
        let aside = directory.join(ASIDE);
        let written = put(&aside, &sealed::seal(self)).and_then(|()| fs::rename(&aside, &path));
        if let Err(e) = written.and_then(|()| sync(directory)) {
            // The first error is the one to report.
            let _ = fs::remove_file(&aside);
            return Err(fault(
                &path,
                format!(
                    "the checkpoint cannot be written: {e}; earlier ones stay, and later ones will be tried"
                ),
            ));
        }
        for (_, old) in checkpoints(directory).iter().skip(KEPT) {
            fs::remove_file(old).map_err(|e| Error::io(old, e))?;
        }
        Ok(())
    }

    /// The checkpoint in a file.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, is none, of another version, or damaged.
    pub fn read(path: &Path) -> Result<Saved, Error> {
        let bytes = input::check(path).and_then(|()| fs::read(path));
        let bytes = bytes.map_err(|e| Error::io(path, e))?;
        sealed::unseal(&bytes, "the checkpoint").map_err(|message| fault(path, message))
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
        check_folder(directory)?;
        if all.is_empty() {
            return Err(fault(
                directory,
                "there is no checkpoint in this folder: run the problem again; `output.checkpoint` says when one is written",
            ));
        }
        let mut notes = Vec::new();
        let mut first = None;
        // What goes on although fields are not there any more: who has removed some to save space may have it so, where no earlier checkpoint has all of its own.
        let mut poorer = None;
        for (n, path) in &all {
            if from.is_some_and(|from| from != *n) {
                continue;
            }
            let read = Saved::read(path);
            match read.and_then(|saved| saved.positions.check(directory).map(|()| saved)) {
                Ok(saved) => match saved.positions.gone(directory) {
                    0 => return Ok((saved, notes)),
                    gone => {
                        poorer.get_or_insert((saved, gone));
                    }
                },
                Err(e) => {
                    notes.push(format!("{e}; the checkpoint before it is tried"));
                    first.get_or_insert(e);
                }
            }
        }
        if let Some((saved, gone)) = poorer {
            notes.push(format!(
                "{}: {gone} of {} files of fields are no longer there; the run goes on, and fields.pvd lists the others",
                directory.display(),
                saved.positions.fields.len()
            ));
            return Ok((saved, notes));
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

    /// Whether files of a deck grow with the run beside those of all results.
    pub fn has_prints(&self) -> bool {
        let mut names = self.positions.lengths.iter().map(|(name, _)| name);
        names.any(|name| name != "history.csv" && name != "cycles.csv" && !name.ends_with(".frd"))
    }

    /// Whether what the run had from a program is there again.
    ///
    /// # Errors
    /// [`Error::Io`] with what is missing or another.
    pub fn check_lent(&self, directory: &Path, now: &Lent) -> Result<(), Error> {
        let before = &self.source.lent;
        let missing = (before.laws.iter()).find(|law| !now.laws.contains(law));
        let more = (now.laws.iter()).find(|law| !before.laws.contains(law));
        let mesh = (before.meshes.iter()).find(|mesh| !now.meshes.contains(mesh));
        let message = match (missing, more, mesh) {
            (Some(law), ..) => format!(
                "the law {law} of this run is a function of the program that ran it: go on from there, with the same function"
            ),
            (_, Some(law), _) => {
                format!("the run did not have a function as the law {law}: go on without it")
            }
            (.., Some((name, _))) => format!(
                "the mesh {name} of this run came from the program that ran it: go on from there, with the same mesh"
            ),
            _ => return Ok(()),
        };
        Err(fault(directory, message))
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
    /// Whether the files in a folder have come at least so far, and are up to there what they were.
    fn check(&self, directory: &Path) -> Result<(), Error> {
        for (name, come) in &self.lengths {
            is_plain(directory, name)?;
            let path = directory.join(name);
            let look = || -> std::io::Result<Option<Come>> {
                let file = own::open(&path, own::Use::Change)?;
                let length = file.metadata()?.len();
                if length < come.length {
                    return Ok(None);
                }
                Ok(Some(Come {
                    length: come.length,
                    tail: tail(&file, come.length)?,
                }))
            };
            match look().map_err(|e| Error::io(&path, e))? {
                Some(found) if found == *come => {}
                Some(_) => return Err(fault(&path, changed(&path))),
                None => return Err(fault(&path, "the file is shorter than at the checkpoint")),
            }
        }
        for (_, name) in &self.fields {
            is_plain(directory, name)?;
        }
        Ok(())
    }

    /// How many files of fields are no longer in the folder.
    fn gone(&self, directory: &Path) -> usize {
        self.fields.len() - self.there(directory).len()
    }

    /// The files of fields that are in the folder.
    pub(super) fn there(&self, directory: &Path) -> Vec<(f64, String)> {
        let fields = self.fields.iter();
        let there = fields.filter(|(_, name)| directory.join(name).is_file());
        there.cloned().collect()
    }

    /// Cuts files back to where they were.
    pub(crate) fn restore(&self, directory: &Path) -> Result<(), Error> {
        for (name, come) in &self.lengths {
            let path = directory.join(name);
            let file = own::open(&path, own::Use::Change);
            let cut = file.and_then(|f| f.set_len(come.length));
            cut.map_err(|e| Error::io(&path, e))?;
        }
        Ok(())
    }
}

/// Why a file is not what it was.
fn changed(path: &Path) -> String {
    let text = input::read_text(path).unwrap_or_default();
    let how = match text.contains("\r\n") {
        true => "its lines end with carriage returns now, as a spreadsheet writes them",
        false => "what comes next would not fit what is there",
    };
    format!(
        "the file was changed since the run wrote it: {how}; bring back the one that the run wrote, or run again"
    )
}

/// Refuses a name that leads out of the folder: a checkpoint may be somebody else's.
fn is_plain(directory: &Path, name: &str) -> Result<(), Error> {
    let mut parts = Path::new(name).components();
    match (parts.next(), parts.next()) {
        (Some(Component::Normal(_)), None) => Ok(()),
        _ => Err(fault(
            directory,
            format!("a checkpoint names `{name}`, which is no file of this folder"),
        )),
    }
}

fn put(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = own::make(path)?;
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
