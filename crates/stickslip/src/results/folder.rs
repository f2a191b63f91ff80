//! The folder of results: it belongs to one run at a time, what an earlier run left there goes before the first file is written, and no
//! file is touched that a run of this program did not write.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::frd::{self, FrdPlan};
use super::modes::is_of_modes;
use super::saved::{self, Source};
use super::summary::Status;
use crate::error::{Error, IoError};
use crate::io::{input, meant_by, own, pvd, write_atomically};
use crate::owner::{Holder, Owner, Refused};

/// What a run takes a folder with.
#[derive(Debug, Clone, Default)]
pub struct Claim {
    /// The files that the problem is read from; none of them is ever written to.
    pub inputs: Vec<PathBuf>,
    /// Names of files that are written into the folder beside the usual ones.
    pub also: Vec<String>,
    /// The `.frd` file, which is written if the problem asks for one.
    pub frd: FrdPlan,
    /// What the run was called with; without it no checkpoints are written.
    pub source: Option<Source>,
    /// What is written is the same whichever process makes it, and whatever it shares with other runs: times, counts of factors and the like are not in
    /// `summary.json`.
    pub alike: bool,
    /// A process that is known to have ended, as `process 4711 on host`: where a file system knows no locks, its folder would not be had.
    pub dead: Option<String>,
}

/// A folder that belongs to this run.
#[derive(Debug)]
pub(crate) struct Folder {
    /// Where it is.
    pub directory: PathBuf,
    /// What the user should know of what was there.
    pub notes: Vec<String>,
    /// It is free when the run has ended.
    lock: Option<Owner>,
}

impl Folder {
    /// Makes the folder, takes it, and removes what an earlier run left. From now on its `summary.json` says that a run is going on.
    ///
    /// # Errors
    /// [`Error::Io`]: what the system says; another run is in it; it holds an input, or files that no run has written, under names of results; a link leads
    /// out of it.
    pub fn take(directory: &Path, claim: &Claim) -> Result<Folder, Error> {
        fs::create_dir_all(directory).map_err(|e| no_folder(directory, e))?;
        tables_are_inside(directory)?;
        for input in &claim.inputs {
            spare(directory, input, claim)?;
        }
        let lock = hold(directory, claim.dead.as_deref())?;
        let mut notes = Vec::new();
        if let Some(holder) = lock.before() {
            notes.push(format!(
                "{}: the run before ({holder}) was killed; what it left is removed",
                directory.display()
            ));
        }
        let folder = Folder {
            directory: directory.to_path_buf(),
            notes,
            lock: Some(lock),
        };
        let old = folder.old(claim)?;
        // First what the earlier run could go on from: this one is another.
        let (kept, old): (Vec<_>, Vec<_>) = old.into_iter().partition(|path| is_checkpoint(path));
        remove(&kept)?;
        // Killed from here on, the run is known for that.
        folder.say_running()?;
        remove(&old)?;
        folder.drop_leftovers(claim)?;
        // Only if it is empty.
        let _ = fs::remove_dir(directory.join(INTERFACES));
        Ok(folder)
    }

    /// Takes a folder in which a run is to go on: what it holds stays, but what was being written when the run was killed.
    ///
    /// # Errors
    /// [`Error::Io`]: what the system says.
    pub fn take_again(mut held: FolderClaim, claim: &Claim) -> Result<Folder, Error> {
        let folder = Folder {
            directory: held.directory.clone(),
            notes: Vec::new(),
            lock: held.lock.take(),
        };
        folder.say_running()?;
        folder.drop_leftovers(claim)?;
        Ok(folder)
    }

    /// Gives the folder back: all is written.
    pub fn release(&mut self) {
        self.lock = None;
    }

    /// Whether it is still ours and what was written is still there.
    ///
    /// # Errors
    /// [`Error::Io`] if the folder, or the file that says whose it is, was removed.
    pub fn check(&self) -> Result<(), Error> {
        match &self.lock {
            Some(lock) if !lock.stands() => Err(fault(
                &self.directory,
                format!(
                    "the result folder or its {} was removed during the run: earlier results are lost. Run again with another folder (`-o DIR`)",
                    LOCK
                ),
            )),
            _ => Ok(()),
        }
    }

    /// Takes it once more: a run that was stopped goes on.
    ///
    /// # Errors
    /// Those of [`Folder::take`].
    pub fn resume(&mut self) -> Result<(), Error> {
        if self.lock.is_none() {
            self.lock = Some(hold(&self.directory, None)?);
            self.say_running()?;
        }
        Ok(())
    }

    /// Removes files of fields, and surfaces that go with none of those that are known.
    pub fn keep_fields(&self, known: &[(f64, String)]) -> Result<(), Error> {
        let numbers: BTreeSet<&str> = known.iter().filter_map(|(_, f)| number_of(f)).collect();
        let unknown = |name: &str| number_of(name).is_none_or(|n| !numbers.contains(n));
        remove(&files(&self.directory, |name| {
            is_field(name) && unknown(name)
        })?)?;
        let tables = self.directory.join(INTERFACES);
        let parts = parts(&self.directory);
        let surface = |name: &str| name.ends_with(".vtp") && is_of(&parts, name) && unknown(name);
        match tables.is_dir() {
            true => remove(&files(&tables, surface)?),
            false => Ok(()),
        }
    }

    /// Removes results that a run which was killed had written in part, aside.
    fn drop_leftovers(&self, claim: &Claim) -> Result<(), Error> {
        let own = |name: &str| {
            name == saved::ASIDE || meant_by(name).is_some_and(|name| is_result(name, claim))
        };
        remove(&files(&self.directory, own)?)?;
        let tables = self.directory.join(INTERFACES);
        let table = |name: &str| meant_by(name).is_some_and(is_of_interface);
        match tables.is_dir() {
            true => remove(&files(&tables, table)?),
            false => Ok(()),
        }
    }

    /// What is found in `summary.json` later, if the run is killed.
    fn say_running(&self) -> Result<(), Error> {
        self.say(Status::Running, "running")
    }

    /// What is found there where a fault of the program has ended the run.
    pub fn say_broken(&self) -> Result<(), Error> {
        self.say(
            Status::Failed,
            "the program has a fault: what it has said of it belongs in a report",
        )
    }

    fn say(&self, status: Status, outcome: &str) -> Result<(), Error> {
        let holder = Holder::this();
        let text = serde_json::json!({
            "status": status,
            "outcome": outcome,
            "completed": false,
            "version": env!("CARGO_PKG_VERSION"),
            "process": holder.process,
            "host": holder.host,
            "findings": [],
        });
        let path = self.directory.join("summary.json");
        write_atomically(&path, format!("{text:#}\n").as_bytes())
    }

    /// The results of an earlier run, but for its summary.
    fn old(&self, claim: &Claim) -> Result<Vec<PathBuf>, Error> {
        let mut old = results(&self.directory, claim)?;
        let summary = self.directory.join("summary.json");
        let made_here = summary.is_file();
        if let Some(first) = old.first().filter(|_| !made_here) {
            return Err(fault(
                first,
                "it would be replaced, but there is no summary.json of a run beside it: choose another folder, or remove it".into(),
            ));
        }
        let tables = self.directory.join(INTERFACES);
        let parts = parts(&self.directory);
        let own = |path: &PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str());
            path.parent() != Some(&tables) || name.is_some_and(|name| is_of(&parts, name))
        };
        old.retain(|path| *path != summary && own(path));
        Ok(old)
    }
}

/// A folder of results that no other process writes into until this is dropped. Where nothing came of it the folder is then as it was.
#[derive(Debug)]
pub struct FolderClaim {
    directory: PathBuf,
    lock: Option<Owner>,
}

impl Drop for FolderClaim {
    fn drop(&mut self) {
        if let Some(lock) = self.lock.take() {
            lock.leave_as_it_was();
        }
    }
}

impl FolderClaim {
    /// Takes a folder in which a run is to go on; nothing in it is touched yet.
    ///
    /// # Errors
    /// [`Error::Io`]: there is no such folder; another run writes there; what the system says.
    pub fn take(directory: &Path) -> Result<FolderClaim, Error> {
        saved::check_folder(directory)?;
        tables_are_inside(directory)?;
        Ok(FolderClaim {
            directory: directory.to_path_buf(),
            lock: Some(hold(directory, None)?),
        })
    }
}

/// Name of the file that says whose a folder is.
const LOCK: &str = "run.lock";

fn lock(path: PathBuf, dead: Option<&str>) -> Result<Owner, Refused> {
    Owner::lock(path, |path| own::open(path, own::Use::ChangeOrMake), dead)
}

fn hold(directory: &Path, dead: Option<&str>) -> Result<Owner, Error> {
    let path = directory.join(LOCK);
    lock(path.clone(), dead).map_err(|refused| match refused {
        Refused::Io(e) => Error::io(&path, e),
        Refused::Taken(holder) => fault(
            directory,
            format!(
                "another run writes into this folder ({holder}): wait for it, or choose another folder; if that run is over, remove {}",
                LOCK
            ),
        ),
    })
}

/// Whether a run is going on in a folder of results, and who runs it: `process 4711 on host`.
pub fn running(directory: &Path) -> Option<String> {
    let path = directory.join(LOCK);
    input::check(&path).ok()?;
    Holder::of_lock(&path).map(|holder| holder.to_string())
}

/// The folder of what is known of interfaces.
pub(crate) const INTERFACES: &str = "interfaces";

/// What follows the name of an interface in that of the surface opposite its contact points, where something wears.
pub const OPPOSITE: &str = ".opposite";

/// The collection of their surfaces.
pub(crate) const SURFACES: &str = "interfaces.pvd";

/// The file of the surface of an interface that goes with a file of fields, in the folder of interfaces: `joint_00007.vtp`.
pub(crate) fn surface_name(interface: &str, fields: &str) -> String {
    format!("{interface}{}.vtp", number_of(fields).unwrap_or_default())
}

/// The number of a file of fields or of a surface, with what parts it from the name: `_00007`.
fn number_of(name: &str) -> Option<&str> {
    let stem = name.strip_suffix(".vtu").or(name.strip_suffix(".vtp"))?;
    let number = &stem[stem.rfind('_')?..];
    let whole = number.len() > 5 && number[1..].bytes().all(|byte| byte.is_ascii_digit());
    whole.then_some(number)
}

/// The names of what has files in the folder of interfaces: those that the list of surfaces has, and those of the interfaces of the problem, as a run that was
/// killed early has no list.
fn parts(directory: &Path) -> BTreeSet<String> {
    let mut parts: BTreeSet<String> = match directory.join(SURFACES).is_file() {
        true => pvd::parts(&directory.join(SURFACES)).unwrap_or_default(),
        false => Vec::new(),
    }
    .into_iter()
    .collect();
    let problem = input::read_text(&directory.join(PROBLEM)).unwrap_or_default();
    let problem: toml::Table = problem.parse().unwrap_or_default();
    let interfaces = problem.get("interface").and_then(toml::Value::as_table);
    for name in interfaces.into_iter().flat_map(toml::Table::keys) {
        parts.insert(name.clone());
        parts.insert(format!("{name}{OPPOSITE}"));
    }
    parts
}

/// Whether a file in the folder of interfaces is that of one of these.
fn is_of(parts: &BTreeSet<String>, name: &str) -> bool {
    let stem = match number_of(name) {
        Some(number) if name.ends_with(".vtp") => {
            name.strip_suffix(&format!("{number}.vtp")).unwrap_or(name)
        }
        _ => name.strip_suffix(".csv").unwrap_or_default(),
    };
    parts.contains(stem)
}

/// Refuses a folder out of which the tables of interfaces would be written.
fn tables_are_inside(directory: &Path) -> Result<(), Error> {
    let tables = directory.join(INTERFACES);
    own::is_own_folder(&tables).map_err(|e| Error::io(&tables, e))
}

/// Whether a file in the folder of interfaces has the name of a result.
fn is_of_interface(name: &str) -> bool {
    name.ends_with(".csv") || (name.ends_with(".vtp") && number_of(name).is_some())
}

/// The problem as it was run.
const PROBLEM: &str = "problem.toml";

const FILES: &[&str] = &[
    "summary.json",
    "history.csv",
    "cycles.csv",
    "fields.pvd",
    SURFACES,
    "culprits.vtu",
    PROBLEM,
    "report.html",
    frd::NAME,
];

/// Whether a file in the folder has the name of a result.
fn is_result(name: &str, claim: &Claim) -> bool {
    let kept = saved::number(name).is_some();
    let also = claim.also.iter().chain([&claim.frd.name]);
    is_field(name)
        || is_of_modes(name)
        || kept
        || FILES.contains(&name)
        || also.into_iter().any(|also| also == name)
}

fn is_checkpoint(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| saved::number(name).is_some())
}

fn remove(paths: &[PathBuf]) -> Result<(), Error> {
    paths
        .iter()
        .try_for_each(|path| fs::remove_file(path).map_err(|e| Error::io(path, e)))
}

fn is_field(name: &str) -> bool {
    let rest = name
        .strip_prefix("fields")
        .filter(|rest| rest.ends_with(".vtu"));
    rest.is_some_and(|rest| rest.rfind('_') == Some(0) && number_of(rest).is_some())
}

/// All files in the folder that have names of results.
fn results(directory: &Path, claim: &Claim) -> Result<Vec<PathBuf>, Error> {
    let mut out = files(directory, |name| is_result(name, claim))?;
    let tables = directory.join(INTERFACES);
    if tables.is_dir() {
        out.extend(files(&tables, is_of_interface)?);
    }
    out.sort();
    Ok(out)
}

fn files(directory: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(directory).map_err(|e| Error::io(directory, e))?;
    let mut out = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|e| Error::io(directory, e))?;
        let name = entry.file_name();
        if name.to_str().is_some_and(&wanted) && !entry.path().is_dir() {
            out.push(entry.path());
        }
    }
    Ok(out)
}

/// Refuses a folder in which a result would replace an input.
fn spare(directory: &Path, input: &Path, claim: &Claim) -> Result<(), Error> {
    // What does not exist cannot be replaced.
    let (Ok(folder), Ok(file)) = (directory.canonicalize(), input.canonicalize()) else {
        return Ok(());
    };
    let name = file.file_name().and_then(|n| n.to_str());
    let name = name.unwrap_or_default();
    let replaced = match file.parent() {
        Some(parent) if parent == folder => is_result(name, claim),
        Some(parent) if parent == folder.join(INTERFACES) => is_of_interface(name),
        _ => false,
    };
    match replaced {
        true => Err(fault(
            input,
            format!(
                "the results would replace this file, from which the problem is read: choose another folder than {}",
                directory.display()
            ),
        )),
        false => Ok(()),
    }
}

fn no_folder(directory: &Path, e: std::io::Error) -> Error {
    use std::io::ErrorKind::{AlreadyExists, NotADirectory};
    match e.kind() {
        AlreadyExists | NotADirectory => fault(
            directory,
            "the results need a folder here, and a file or a link to nothing is in its way: choose another folder, or remove it".into(),
        ),
        _ => Error::io(directory, e),
    }
}

/// A file that is written again and again by one process: no other may write it meanwhile. A file beside it, with `.lock` behind the name, says so; it
/// is gone when this is dropped.
#[derive(Debug)]
pub struct FileClaim {
    _lock: Owner,
}

impl FileClaim {
    /// Takes the file, which need not exist.
    ///
    /// # Errors
    /// [`Error::Io`]: what the system says; another process has it.
    pub fn take(file: &Path) -> Result<FileClaim, Error> {
        let mut beside = file.as_os_str().to_owned();
        beside.push(".lock");
        let beside = PathBuf::from(beside);
        match lock(beside.clone(), None) {
            Ok(lock) => Ok(FileClaim { _lock: lock }),
            Err(Refused::Io(e)) => Err(Error::io(&beside, e)),
            Err(Refused::Taken(holder)) => Err(fault(
                file,
                format!(
                    "{holder} writes this file: wait for it, or choose another; if that is over, remove {}",
                    beside.display()
                ),
            )),
        }
    }
}

fn fault(path: &Path, message: String) -> Error {
    Error::Io(IoError {
        file: path.to_path_buf(),
        message,
    })
}
