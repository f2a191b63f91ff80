//! A part of a sweep, for one of several processes on one machine or many: which runs it has, and the folder that says how far it has come.
//!
//! The folder has `shard.json`, what the sweep is, by which one that goes on or is merged knows that it is the same, and `rows.jsonl`, a line a run, each
//! written as a whole. What is there counts: a shard that was killed goes on with what is not.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use stickslip::Error;
use stickslip::error::IoError;
use stickslip::io::{drop_leftovers, own, write_atomically};
use stickslip::linear::Digest;
use stickslip::owner::{self, Holder, Owner, Refused, Waiting};
use stickslip::results::digest_of;

use super::plan::Plan;
use super::table::Row;
use super::values::Axis;
use crate::failure::Failure;

/// The file that says what the sweep is.
const RECORD: &str = "shard.json";

/// The file with a line a run.
const ROWS: &str = "rows.jsonl";

/// The file that says who is at it.
const LEASE: &str = "shard.lease";

/// What `shard.json` says that it is.
const KIND: &str = "stickslip sweep shard 1";

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
    /// What differs.
    pub axes: Vec<Axis>,
    /// Whether axes run side by side.
    pub zip: bool,
    /// What is the same in all runs.
    pub fixed: Vec<String>,
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
            axes: plan.axes.clone(),
            zip: plan.zip,
            fixed: plan.fixed().to_vec(),
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

    /// Number of its runs.
    pub fn count(&self) -> usize {
        match self.zip {
            true => self.axes.first().map_or(0, |axis| axis.values.len()),
            false => self.axes.iter().map(|axis| axis.values.len()).product(),
        }
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
        let parts = [
            (self.files != other.files, "its files are others"),
            (
                self.axes != other.axes,
                "its axes or their values are others",
            ),
            (self.zip != other.zip, "one has --zip and the other not"),
            (self.fixed != other.fixed, "its values of --fix are others"),
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
            kind: KIND.into(),
            share,
            sweep: self.clone(),
        })
    }

    fn from_json(value: &Value) -> Option<(Sweep, Share)> {
        let Record { kind, share, sweep } = Record::deserialize(value).ok()?;
        let sound = kind == KIND && (1..=share.of).contains(&share.index);
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

/// A run of a shard that is over.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Its row.
    #[serde(flatten)]
    pub row: Row,
    /// The columns of its history, in order; none if it did not come so far.
    pub names: Vec<String>,
    /// Whether it failed, or did not pass the quality gate.
    pub failed: bool,
    pub poor: bool,
    /// Its row in the table of what runs took.
    pub effort: String,
    /// The kind of processor: last digits may depend on it.
    pub processor: String,
}

/// A digest of a row without its own.
fn digest(row: &Value) -> String {
    let mut digest = Digest::default();
    digest.bytes(row.to_string().as_bytes());
    let [a, b] = digest.finish();
    format!("{a:016x}{b:016x}")
}

impl Done {
    fn to_json(&self, run: usize) -> Value {
        let mut value = json!(self);
        value["run"] = json!(run + 1);
        value["digest"] = json!(digest(&value));
        value
    }

    /// The run and what is known of it; `None` of a line that is damaged, were it by one digit.
    fn from_json(line: &str) -> Option<(usize, Done)> {
        let mut value: Value = serde_json::from_str(line).ok()?;
        let said = value.as_object_mut()?.remove("digest")?;
        if said.as_str()? != digest(&value) {
            return None;
        }
        let run = usize::try_from(value["run"].as_u64()?).ok()?;
        Some((run.checked_sub(1)?, Done::deserialize(&value).ok()?))
    }
}

/// The folder of a shard as it was read.
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
            done: rows(folder, &sweep, share)?,
            folder: folder.to_path_buf(),
            sweep,
            share,
        })
    }

    /// Who is at it.
    pub fn holder(&self) -> Option<String> {
        let holder = Holder::named_in(&self.folder.join(LEASE));
        holder.map(|holder| holder.to_string())
    }

    /// The file of its rows.
    pub fn rows_file(&self) -> PathBuf {
        self.folder.join(ROWS)
    }

    /// Why it cannot be merged with another; `None` if it can.
    pub fn foreign_to(&self, other: &Shard) -> Option<String> {
        other.sweep.differs(&self.sweep)
    }
}

/// The lines of a shard; one that was cut as the process that wrote it was killed is none.
fn rows(folder: &Path, sweep: &Sweep, share: Share) -> Result<BTreeMap<usize, Done>, Error> {
    let path = folder.join(ROWS);
    let text = match fs::read(&path) {
        Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        Err(e) => return Err(Error::io(&path, e)),
    };
    let mut done = BTreeMap::new();
    let count = sweep.count();
    let has = |run: usize| run < count && run % share.of == share.index - 1;
    for (i, line) in whole(&text).lines().enumerate() {
        let read = Done::from_json(line).filter(|(run, _)| has(*run));
        let (run, row) = read.ok_or_else(|| {
            let what = format!(
                "line {} is no row of this shard: remove the folder, and make the shard anew",
                i + 1
            );
            fault(&path, &what)
        })?;
        done.insert(run, row);
    }
    Ok(done)
}

/// The lines that have an end.
fn whole(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

/// A shard at which this process is.
#[derive(Debug)]
pub struct Work {
    pub shard: Shard,
    /// The process that was at it before, and was killed.
    pub dead: Option<String>,
    _lease: Owner,
}

impl Work {
    /// Takes the folder of a shard, a new one or one that goes on. While it is not known whether another process is at it `waits` is told who.
    ///
    /// # Errors
    /// [`Failure`]: another process is at it; it is of another sweep; what the system says.
    pub fn begin(
        folder: &Path,
        sweep: Sweep,
        share: Share,
        waits: &dyn Fn(&str),
    ) -> Result<Work, Failure> {
        fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        let (lease, dead) = take(&folder.join(LEASE), folder, waits)?;
        let record = folder.join(RECORD);
        drop_leftovers(&record)?;
        let shard = match Shard::is_one(folder) {
            true => {
                let shard = Shard::read(folder)?;
                if shard.share != share {
                    let what = format!("it is that of shard {}", shard.share);
                    return Err(another(folder, &what));
                }
                if let Some(what) = sweep.differs(&shard.sweep) {
                    return Err(another(folder, &what));
                }
                shard
            }
            false => {
                let text = format!("{:#}\n", sweep.to_json(share));
                write_atomically(&record, text.as_bytes())?;
                Shard {
                    folder: folder.to_path_buf(),
                    sweep,
                    share,
                    done: BTreeMap::new(),
                }
            }
        };
        shard.mend()?;
        Ok(Work {
            shard,
            dead,
            _lease: lease,
        })
    }

    /// A run is over.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn push(&mut self, run: usize, done: Done) -> Result<(), Error> {
        let path = self.shard.rows_file();
        let line = format!("{}\n", done.to_json(run));
        let file = own::open(&path, own::Use::AppendOrMake);
        let written = file.and_then(|mut file| {
            file.write_all(line.as_bytes())?;
            file.sync_data()
        });
        written.map_err(|e| Error::io(&path, e))?;
        self.shard.done.insert(run, done);
        Ok(())
    }
}

impl Shard {
    /// Takes away a line that was cut.
    fn mend(&self) -> Result<(), Error> {
        let path = self.rows_file();
        drop_leftovers(&path)?;
        let Ok(text) = fs::read(&path) else {
            return Ok(());
        };
        let end = text.iter().rposition(|byte| *byte == b'\n');
        let end = end.map_or(0, |end| end + 1);
        match end == text.len() {
            true => Ok(()),
            false => write_atomically(&path, &text[..end]),
        }
    }
}

/// The lease of a shard, and who had it before and is dead.
fn take(
    path: &Path,
    folder: &Path,
    waits: &dyn Fn(&str),
) -> Result<(Owner, Option<String>), Failure> {
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

fn another(folder: &Path, what: &str) -> Failure {
    Failure::Arguments(
        format!("{}: this shard was begun by another sweep: {what}", folder.display()),
        "bring back what it was begun with, choose another table with -o, or remove the folder to begin anew".into(),
    )
}

fn fault(path: &Path, message: &str) -> Error {
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
            axes: vec![Axis {
                path: "a.'b'".into(),
                values: vec!["1".into(), "\"x\"".into()],
            }],
            zip: false,
            fixed: vec!["c=1".into()],
            columns: Vec::new(),
            results: true,
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let share = Share { index: 1, of: 2 };
        let back = Sweep::from_json(&sweep().to_json(share)).unwrap();
        assert_eq!(back, (sweep(), share));
        let done = Done {
            row: Row {
                values: vec!["[1, 2]".into()],
                outcome: "no \"set\"\nhere".into(),
                counts: Some([1, 2, 3]),
                last: [0.1 + 0.2, -0.0, 5e-324, f64::MAX]
                    .iter()
                    .enumerate()
                    .map(|(i, x)| (format!("q{i}"), *x))
                    .collect(),
            },
            names: vec!["q1".into(), "q0".into()],
            failed: true,
            poor: false,
            effort: "1,0.5".into(),
            processor: "x".into(),
        };
        let line = done.to_json(6).to_string();
        assert!(!line.contains('\n'));
        let (run, back) = Done::from_json(&line).unwrap();
        assert_eq!((run, &back), (6, &done));
        assert_eq!(back.row.last["q1"].to_bits(), (-0.0_f64).to_bits());
        let mut unknown = Done::default();
        unknown.row.last.insert("q".into(), f64::NAN);
        let (_, back) = Done::from_json(&unknown.to_json(0).to_string()).unwrap();
        assert!(back.row.last["q"].is_nan() && back.row.counts.is_none());
        assert!(Done::from_json(&line[..line.len() - 1]).is_none());
        // A digit that was changed is found as well as a line that was cut.
        for (from, to) in [("e-324", "e-323"), ("\"run\":7", "\"run\":8"), ("q1", "q2")] {
            assert!(line.contains(from), "{line}");
            assert!(Done::from_json(&line.replace(from, to)).is_none(), "{from}");
        }
    }

    #[test]
    fn what_differs_is_named() {
        assert_eq!(sweep().differs(&sweep()), None);
        type Change = fn(&mut Sweep);
        let changes: [(Change, &str); 6] = [
            (|s| s.version = "2".into(), "it is of version 2"),
            (|s| s.files[0].1 = "1".into(), "its file a.toml is another"),
            (
                |s| s.axes[0].values[0] = "3".into(),
                "its axes or their values are others",
            ),
            (|s| s.zip = true, "one has --zip and the other not"),
            (|s| s.fixed.clear(), "its values of --fix are others"),
            (|s| s.results = false, "one has --results and the other not"),
        ];
        for (change, what) in changes {
            let mut other = sweep();
            change(&mut other);
            assert_eq!(sweep().differs(&other).as_deref(), Some(what));
        }
    }
}
