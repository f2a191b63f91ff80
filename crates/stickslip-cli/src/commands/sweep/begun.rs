//! What a sweep was begun with: a file beside its table as long as the sweep goes on, by which one that goes on later knows that it is the same.

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::error::IoError;
use stickslip::io::{drop_leftovers, write_atomically};
use stickslip::results::digest_of;

use super::plan::Plan;

/// Where a sweep stands that is to go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stand {
    /// There is nothing of it.
    New,
    /// Its table has some of its rows.
    Begun,
    /// There is a table, and nothing that says that it goes on: it ought to be complete.
    Over,
}

/// What a sweep was begun with.
pub struct Begun {
    path: PathBuf,
    table: PathBuf,
    text: String,
}

impl Begun {
    /// That of a sweep: the digests of its files.
    pub fn of(files: &[PathBuf], plan: &Plan, table: &Path) -> Result<Begun, Error> {
        let mut path = table.as_os_str().to_owned();
        path.push(".begun");
        let mut text = String::new();
        for file in files {
            let [a, b] = digest_of(file)?;
            text += &format!("{a:016x}{b:016x} {}\n", file.display());
        }
        text += &format!("{} runs\n{}\n", plan.count(), plan.fixed().join("\n"));
        Ok(Begun {
            path: path.into(),
            table: table.to_path_buf(),
            text,
        })
    }

    /// Where the sweep stands.
    ///
    /// # Errors
    /// [`Error::Io`] if the table is one of another sweep.
    pub fn stand(&self) -> Result<Stand, Error> {
        if !self.table.is_file() {
            return Ok(Stand::New);
        }
        match std::fs::read_to_string(&self.path) {
            Ok(text) if text == self.text => Ok(Stand::Begun),
            Ok(_) => Err(self.fault(
                "the problem, a mesh or a fixed value has changed since this sweep began: rows of both do not belong in one table; run it anew into another file",
            )),
            Err(_) => Ok(Stand::Over),
        }
    }

    /// What is wrong with a table that ought to be complete and is not.
    pub fn unknown(&self) -> Error {
        self.fault(
            "rows are missing, and nothing beside this table says that they are of the same sweep: its file `.begun` was removed; without `--resume` it is run anew",
        )
    }

    fn fault(&self, message: &str) -> Error {
        Error::Io(IoError {
            file: self.table.clone(),
            message: message.into(),
        })
    }

    /// Leaves it beside the table, and removes what was being written when a sweep was killed.
    pub fn write(&self) -> Result<(), Error> {
        drop_leftovers(&self.table)?;
        drop_leftovers(&self.path)?;
        write_atomically(&self.path, self.text.as_bytes())
    }

    /// The sweep is complete.
    pub fn end(&self) {
        // What is left would only be told of when the sweep were to go on.
        let _ = std::fs::remove_file(&self.path);
    }
}
