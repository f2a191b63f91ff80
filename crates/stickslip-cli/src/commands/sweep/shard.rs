//! A part of a sweep, for one of several processes on one machine or many: which runs it has, and the folder that says how far it has come.
//!
//! The folder has `shard.json`, what the sweep is, by which one that goes on or is merged knows that it is the same, and a file a run that is over. What is
//! there counts: a shard that was killed goes on with what is not. A sweep in one process has such a folder as long as it goes on.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use stickslip::Error;
use stickslip::error::IoError;
use stickslip::io::write_atomically;
use stickslip::owner::{self, Holder, Owner, Refused, Waiting};
use stickslip::results::digest_of;

use super::done::Done;
use super::plan::Plan;
use crate::failure::Failure;

/// The file that says what the sweep is.
const RECORD: &str = "shard.json";

/// The file that says who is at it.
const SHARD_LEASE: &str = "shard.lease";

/// What `shard.json` says that it is.
const SHARD_KIND: &str = "stickslip sweep shard 2";

/// One of how many parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Counted from 1.
    #[serde(rename = "shard")]
    pub index: usize,
    /// How many there are.
    pub of: usize,
}

impl Share {
    /// Reads `2/4`.
    ///
    /// # Errors
    /// What is wrong with it, and what there is.
    pub fn parse(text: &str) -> Result<Share, Failure> {
        let help = "write --shard i/n with i from 1 to n: --shard 1/4 to --shard 4/4 are the parts of four";
        let refuse =
            |what: String| Failure::Arguments(format!("--shard {text}: {what}"), help.into());
        let (index, of) = text
            .split_once('/')
            .ok_or_else(|| refuse("it does not say of how many parts".into()))?;
        let number = |word: &str| {
            let number = word.trim().parse::<usize>();
            number.map_err(|_| refuse(format!("`{}` is not a number", word.trim())))
        };
        let (index, of) = (number(index)?, number(of)?);
        match index {
            _ if of == 0 => Err(refuse("there is no part of none".into())),
            0 => Err(refuse("parts are counted from 1".into())),
            i if i > of => Err(refuse(format!("there are only {of} parts"))),
            _ => Ok(Share { index, of }),
        }
    }

    /// Its runs, counted from 0, in the order in which they are made. Runs are dealt like cards, so that parts take equally long where values that follow each other do;
    /// each part begins at another place, so that parts that come to the same body have others to factor first.
    pub fn runs(&self, count: usize) -> Vec<usize> {
        let mut runs: Vec<usize> = (self.index - 1..count).step_by(self.of).collect();
        let first = runs.len() * (self.index - 1) / self.of;
        runs.rotate_left(first);
        runs
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

/// What a sweep is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Version of the program.
    pub version: String,
    /// Names and digests of what is read, in order.
    pub files: Vec<(String, String)>,
    /// Its runs.
    #[serde(flatten)]
    pub plan: Plan,
    /// The columns that were chosen.
    pub columns: Vec<String>,
    /// Whether the result files of runs are kept.
    pub results: bool,
}

impl Sweep {
    /// That of a plan.
    ///
    /// # Errors
    /// [`Error::Io`] if a file cannot be read.
    pub fn of(
        plan: &Plan,
        files: &[PathBuf],
        columns: &[String],
        results: bool,
    ) -> Result<Sweep, Error> {
        let known = files.iter().map(|file| {
            let digest = digest_in_words(file)?;
            // Machines may have the same files in other folders.
            let name = file.file_name().unwrap_or_default();
            Ok((name.to_string_lossy().into_owned(), digest))
        });
        let mut known = known.collect::<Result<Vec<_>, Error>>()?;
        known.sort();
        Ok(Sweep {
            version: env!("CARGO_PKG_VERSION").into(),
            files: known,
            plan: plan.clone(),
            columns: columns.to_vec(),
            results,
        })
    }

    /// Whether it reads a file with this content.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read.
    pub fn reads(&self, file: &Path) -> Result<bool, Error> {
        let digest = digest_in_words(file)?;
        Ok(self.files.iter().any(|(_, known)| *known == digest))
    }

    /// The first thing in which another differs, as what that other has.
    fn differs(&self, other: &Sweep) -> Option<String> {
        if self.version != other.version {
            return Some(format!("it is of version {}", other.version));
        }
        let same = |file: &&(String, String)| !self.files.contains(file);
        if let Some((name, _)) = other.files.iter().find(same) {
            return Some(format!("its file {name} is another"));
        }
        let (plan, of_other) = (&self.plan, &other.plan);
        let parts = [
            (self.files != other.files, "its files are others"),
            (
                plan.axes != of_other.axes,
                "its axes or their values are others",
            ),
            (plan.zip != of_other.zip, "one has --zip and the other not"),
            (
                plan.fixed != of_other.fixed,
                "its values of --fix are others",
            ),
            (
                self.columns != other.columns,
                "its values of --column are others",
            ),
            (
                self.results != other.results,
                "one has --results and the other not",
            ),
        ];
        let part = parts.into_iter().find(|(differs, _)| *differs);
        part.map(|(_, what)| what.to_string())
    }

    fn to_json(&self, share: Share) -> Value {
        json!(Record {
            kind: SHARD_KIND.into(),
            share,
            sweep: self.clone(),
        })
    }

    fn from_json(value: &Value) -> Option<(Sweep, Share)> {
        let Record { kind, share, sweep } = Record::deserialize(value).ok()?;
        let sound = kind == SHARD_KIND && (1..=share.of).contains(&share.index);
        sound.then_some((sweep, share))
    }
}

/// What stands in `shard.json`.
#[derive(Serialize, Deserialize)]
struct Record {
    kind: String,
    #[serde(flatten)]
    share: Share,
    #[serde(flatten)]
    sweep: Sweep,
}

fn digest_in_words(file: &Path) -> Result<String, Error> {
    let [a, b] = digest_of(file)?;
    Ok(format!("{a:016x}{b:016x}"))
}

/// A part of a sweep with what is done of it, as its folder has it.
#[derive(Debug)]
pub struct Shard {
    pub folder: PathBuf,
    pub sweep: Sweep,
    pub share: Share,
    /// What is done, by run.
    pub done: BTreeMap<usize, Done>,
}

impl Shard {
    /// Whether a folder is that of a shard.
    pub fn is_one(folder: &Path) -> bool {
        folder.join(RECORD).is_file()
    }

    /// Reads it.
    ///
    /// # Errors
    /// [`Error::Io`] if it is none, or damaged.
    pub fn read(folder: &Path) -> Result<Shard, Error> {
        let path = folder.join(RECORD);
        let text = fs::read_to_string(&path).map_err(|e| Error::io(&path, e))?;
        let value: Value = serde_json::from_str(&text).unwrap_or_default();
        let (sweep, share) = Sweep::from_json(&value).ok_or_else(|| {
            fault(&path, "this is no record of a shard that this version can read: make the shard anew in another folder")
        })?;
        Ok(Shard {
            done: runs(folder, share.runs(sweep.plan.count()))?,
            folder: folder.to_path_buf(),
            sweep,
            share,
        })
    }

    /// Who is at it.
    pub fn holder(&self) -> Option<String> {
        let holder = Holder::named_in(&self.folder.join(SHARD_LEASE));
        holder.map(|holder| holder.to_string())
    }

    /// Why it cannot be merged with another; `None` if it can.
    pub fn foreign_to(&self, other: &Shard) -> Option<String> {
        other.sweep.differs(&self.sweep)
    }
}

/// The runs of a shard that are over.
fn runs(folder: &Path, own: Vec<usize>) -> Result<BTreeMap<usize, Done>, Error> {
    let mut done = BTreeMap::new();
    for run in own {
        let path = file_of_run(folder, run);
        match fs::read(&path) {
            Ok(bytes) => {
                let read = Done::from_json(&String::from_utf8_lossy(&bytes), run);
                let what = "this is no run of this shard: remove the file, and it is made anew";
                done.insert(run, read.ok_or_else(|| fault(&path, what))?);
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
            Err(e) => return Err(Error::io(&path, e)),
        }
    }
    Ok(done)
}

fn file_of_run(folder: &Path, run: usize) -> PathBuf {
    folder.join(format!("{:04}.json", run + 1))
}

/// Removes what has such names from a folder of a shard, in which no other process writes.
fn remove(folder: &Path, names: impl Fn(&str) -> bool) -> Result<(), Error> {
    for entry in fs::read_dir(folder).map_err(|e| Error::io(folder, e))? {
        let entry = entry.map_err(|e| Error::io(folder, e))?;
        if names(&entry.file_name().to_string_lossy()) {
            fs::remove_file(entry.path()).map_err(|e| Error::io(&entry.path(), e))?;
        }
    }
    Ok(())
}

impl Shard {
    /// A new one, or one that goes on. No other process may work on it.
    ///
    /// # Errors
    /// [`Error::Io`]; within, what it differs in from one that was begun in this folder.
    pub fn begin(
        folder: &Path,
        sweep: Sweep,
        share: Share,
    ) -> Result<Result<Shard, String>, Error> {
        fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        // What was being written when it was killed.
        remove(folder, |name| {
            name.starts_with('.') && name.ends_with(".tmp")
        })?;
        if Shard::is_one(folder) {
            let shard = Shard::read(folder)?;
            if shard.share != share {
                return Ok(Err(format!("it is that of shard {}", shard.share)));
            }
            let differs = sweep.differs(&shard.sweep);
            return Ok(differs.map_or(Ok(shard), Err));
        }
        let text = format!("{:#}\n", sweep.to_json(share));
        write_atomically(&folder.join(RECORD), text.as_bytes())?;
        Ok(Ok(Shard {
            folder: folder.to_path_buf(),
            sweep,
            share,
            done: BTreeMap::new(),
        }))
    }

    /// A run is over.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn push(&mut self, run: usize, done: Done) -> Result<(), Error> {
        let path = file_of_run(&self.folder, run);
        write_atomically(&path, format!("{}\n", done.to_json(run)).as_bytes())?;
        // A sweep in one process is soon made anew after a machine has failed.
        if self.share.of > 1 {
            let written = fs::File::open(&path).and_then(|file| file.sync_data());
            written.map_err(|e| Error::io(&path, e))?;
        }
        self.done.insert(run, done);
        Ok(())
    }

    /// Removes it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn remove(folder: &Path) -> Result<(), Error> {
        if Shard::is_one(folder) {
            remove(folder, |name| name.ends_with(".json"))?;
            // Unless there is something of somebody else.
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }
}

/// The lease of the folder of a shard, and who had it before and is dead. While it is not known whether another process is at it `waits` is told who.
///
/// # Errors
/// [`Failure`]: another process is at it; what the system says.
pub fn take(folder: &Path, waits: &dyn Fn(&str)) -> Result<(Owner, Option<String>), Failure> {
    fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
    let path = &folder.join(SHARD_LEASE);
    let mut waiting = Waiting::default();
    let mut before = None;
    loop {
        let holder = match Owner::lease(path) {
            Ok(lease) => {
                owner::drop_leftovers(path);
                return Ok((lease, before));
            }
            Err(Refused::Io(_)) => {
                let e = std::io::Error::other("it cannot be written");
                return Err(Error::io(path, e).into());
            }
            Err(Refused::Taken(holder)) => holder,
        };
        if waiting.look(path) {
            return Err(Failure::Arguments(
                format!("{}: {holder} is at this shard", folder.display()),
                "wait for it, or end it: the shard then goes on with the same command".into(),
            ));
        }
        let known = holder.process > 0;
        let holder = holder.to_string();
        if known && before.as_ref() != Some(&holder) {
            waits(&holder);
            before = Some(holder);
        }
        waiting.pause();
    }
}

/// Why a shard does not go on that was begun in this folder.
pub fn another(folder: &Path, what: &str) -> Failure {
    Failure::Arguments(
        format!("{}: this shard was begun by another sweep: {what}", folder.display()),
        "bring back what it was begun with, choose another table with -o, or remove the folder to begin anew".into(),
    )
}

pub fn fault(path: &Path, message: &str) -> Error {
    Error::Io(IoError {
        file: path.to_path_buf(),
        message: message.into(),
    })
}

/// The kind of processor, as far as instructions are chosen by it.
pub fn processor() -> String {
    let mut words = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    {
        let known = [
            ("avx2", std::arch::is_x86_feature_detected!("avx2")),
            ("fma", std::arch::is_x86_feature_detected!("fma")),
            ("avx512", std::arch::is_x86_feature_detected!("avx512f")),
        ];
        words.extend(known.iter().filter(|(_, has)| *has).map(|(word, _)| word));
    }
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::super::values::Axis;
    use super::*;

    #[test]
    fn parts_have_all_runs_once_and_begin_at_different_places() {
        for (count, of) in [(50, 4), (8, 3), (2, 5), (0, 2), (7, 1)] {
            let mut all: Vec<usize> = Vec::new();
            for index in 1..=of {
                let runs = Share { index, of }.runs(count);
                assert!(runs.len() <= count.div_ceil(of));
                all.extend(runs);
            }
            all.sort_unstable();
            assert!(all.into_iter().eq(0..count));
        }
        let second = Share { index: 2, of: 3 };
        assert_eq!(second.runs(9), [4, 7, 1]);
    }

    #[test]
    fn a_part_is_written_as_one_of_how_many() {
        assert_eq!(Share::parse("2/4").unwrap(), Share { index: 2, of: 4 });
        for (text, part) in [
            ("5/4", "there are only 4 parts"),
            ("0/4", "parts are counted from 1"),
            ("0/0", "there is no part of none"),
            ("2", "it does not say of how many parts"),
            ("a/4", "`a` is not a number"),
            ("1/-4", "`-4` is not a number"),
        ] {
            match Share::parse(text) {
                Err(Failure::Arguments(message, _)) => {
                    assert_eq!(message, format!("--shard {text}: {part}"));
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    fn sweep() -> Sweep {
        Sweep {
            version: "1".into(),
            files: vec![("a.toml".into(), "0f".into())],
            plan: Plan {
                axes: vec![Axis {
                    path: "a.'b'".into(),
                    values: vec!["1".into(), "\"x\"".into()],
                }],
                zip: false,
                fixed: vec!["c=1".into()],
            },
            columns: Vec::new(),
            results: true,
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let share = Share { index: 1, of: 2 };
        let back = Sweep::from_json(&sweep().to_json(share)).unwrap();
        assert_eq!(back, (sweep(), share));
    }

    #[test]
    fn what_differs_is_named() {
        assert_eq!(sweep().differs(&sweep()), None);
        type Change = fn(&mut Sweep);
        let changes: [(Change, &str); 6] = [
            (|s| s.version = "2".into(), "it is of version 2"),
            (|s| s.files[0].1 = "1".into(), "its file a.toml is another"),
            (
                |s| s.plan.axes[0].values[0] = "3".into(),
                "its axes or their values are others",
            ),
            (|s| s.plan.zip = true, "one has --zip and the other not"),
            (|s| s.plan.fixed.clear(), "its values of --fix are others"),
            (|s| s.results = false, "one has --results and the other not"),
        ];
        for (change, what) in changes {
            let mut other = sweep();
            change(&mut other);
            assert_eq!(sweep().differs(&other).as_deref(), Some(what));
        }
    }
}
