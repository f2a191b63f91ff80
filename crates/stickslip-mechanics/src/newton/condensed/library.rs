use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::engine::EngineModel;
use super::file;
use super::identity::{Identity, Part};
use super::substructure::Substructure;
use crate::error::Error;
use crate::linear::{Analysed, BlockCsr, Engine, LinearError};
use crate::machine::total_memory;
use crate::owner::{self, Owner, Refused, Waiting};

/// Substructures and analyses made before, for all runs of a process, and with a directory for those of others too.
///
/// What a run takes from it has the bits of what it would make itself, on machines of the same kind.
#[derive(Debug)]
pub struct Library {
    limit: u64,
    directory: Option<PathBuf>,
    shelves: Mutex<Shelves>,
}

#[derive(Debug, Default)]
struct Shelves {
    substructures: Shelf<Substructure>,
    analyses: Shelf<dyn Analysed>,
    stiffnesses: Shelf<BlockCsr>,
    engines: Vec<(EngineModel, Arc<dyn Engine>)>,
}

/// Where a substructure comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Factored.
    Made,
    /// Made before in this process.
    Memory,
    /// Read from the directory.
    Disk,
}

/// Whether this process may make a substructure.
pub(super) enum Reserved {
    /// It may, and others wait for it as long as there is a lease.
    Ours(Option<Owner>),
    /// Another process is making it.
    Theirs,
}

/// What a library has of a substructure, and what the user should know about its file.
pub(super) type Found = (Option<(Arc<Substructure>, Source)>, Option<String>);

/// What the name of a lease ends with.
const LEASE: &str = "lease";

/// Part of the memory limit that analyses may take, and matrices.
const ANALYSES: u64 = 8;
const STIFFNESSES: u64 = 4;

/// What a note about a file of the directory begins with. It says how a run went, and nothing of what came of it.
pub const CACHE_NOTE: &str = "cache file ";

/// Bytes of a gibibyte.
const GIB: u64 = 1 << 30;

impl Library {
    /// A library in memory. What was used least recently is dropped when there is more than `limit` `[bytes]`.
    pub fn new(limit: u64) -> Self {
        Library {
            limit,
            directory: None,
            shelves: Mutex::default(),
        }
    }

    /// A library that also keeps every substructure in a directory, which is made if it does not exist. Several processes may use it, on several
    /// machines: while one makes a substructure, others wait for it. Nothing is ever deleted there but what is damaged, or was left by who was killed.
    ///
    /// # Errors
    /// [`Error::Io`] if there is no such directory and it cannot be made.
    pub fn in_directory(limit: u64, directory: &Path) -> Result<Self, Error> {
        std::fs::create_dir_all(directory).map_err(|e| Error::io(directory, e))?;
        Ok(Library {
            directory: Some(directory.to_path_buf()),
            ..Library::new(limit)
        })
    }

    /// A quarter of the machine's memory `[bytes]`, 4 GiB if the system does not tell how much there is.
    pub fn usual_limit() -> u64 {
        total_memory().map_or(4 * GIB, |all| all / 4)
    }

    /// A limit for one run alone `[bytes]`: what it does not use itself is rarely asked for again.
    pub fn small_limit() -> u64 {
        Library::usual_limit().min(GIB)
    }

    fn shelves(&self) -> MutexGuard<'_, Shelves> {
        // A thread that panicked left whole entries.
        self.shelves.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn path(&self, identity: Identity) -> Option<PathBuf> {
        let directory = self.directory.as_ref()?;
        Some(directory.join(format!("{identity}.sub")))
    }

    /// The substructure of a part, if it was made before.
    pub(super) fn find(&self, identity: Identity, part: &Part) -> Found {
        let known = self.shelves().substructures.find(identity);
        if let Some(found) = known.filter(|known| known.interior.fault().is_none()) {
            return (Some((found, Source::Memory)), None);
        }
        let Some(path) = self.path(identity) else {
            return (None, None);
        };
        match file::read(&path, identity, part) {
            Ok(None) => (None, None),
            Ok(Some(read)) => {
                let read = Arc::new(read);
                self.shelve(&read);
                (Some((read, Source::Disk)), None)
            }
            Err(why) => {
                let note = format!("{CACHE_NOTE}{}: {why}; made again", path.display());
                (None, Some(note))
            }
        }
    }

    /// Asks for the right to make a substructure whose file is worth it; without a directory everybody has it.
    pub(super) fn reserve(&self, identity: Identity) -> Reserved {
        let Some(path) = self.path(identity) else {
            return Reserved::Ours(None);
        };
        match Owner::lease(&path.with_extension(LEASE)) {
            Ok(lease) => {
                owner::drop_leftovers(&path);
                Reserved::Ours(Some(lease))
            }
            Err(Refused::Taken(_)) => Reserved::Theirs,
            Err(Refused::Io(_)) => Reserved::Ours(None),
        }
    }

    /// Waits until another process has made a substructure, or has failed to, or `waits` says that it is enough: then it is to be made here, with the lease if
    /// there is one.
    pub(super) fn wait(
        &self,
        identity: Identity,
        part: &Part,
        waits: &dyn Fn() -> bool,
    ) -> (Found, Option<Owner>) {
        let mut waiting = Waiting::default();
        let mut note = None;
        loop {
            let lease = match self.reserve(identity) {
                Reserved::Ours(lease) => Some(lease),
                Reserved::Theirs => None,
            };
            // With the lease it is certain that no other process has just made it.
            let free = lease.is_some();
            let (found, why) = match note.is_none() || free {
                true => self.find(identity, part),
                false => (None, None),
            };
            note = note.or(why);
            if found.is_some() || free || !waits() {
                return ((found, note), lease.flatten());
            }
            if let Some(path) = self.path(identity) {
                waiting.look(&path.with_extension(LEASE));
            }
            waiting.pause();
        }
    }

    /// Keeps a substructure. Returns what the user should know if it could not be written.
    pub(super) fn keep(&self, substructure: &Arc<Substructure>) -> Option<String> {
        self.shelve(substructure);
        let path = self.path(substructure.identity)?;
        let Some(factor) = substructure.interior.to_file() else {
            return Some(
                "factors of this engine are not kept in files: they are where it is".into(),
            );
        };
        if substructure.root().len() <= file::SMALL_PART && factor.bytes() == 0 {
            return None;
        }
        let written = file::write(&path, (substructure, factor));
        let why = written.err()?;
        Some(format!(
            "{CACHE_NOTE}{}: not written: {why}",
            path.display()
        ))
    }

    fn shelve(&self, substructure: &Arc<Substructure>) {
        let mut shelves = self.shelves();
        let entry = Entry {
            identity: substructure.identity,
            made: Arc::clone(substructure),
            bytes: substructure.bytes(),
        };
        shelves.substructures.keep(entry, self.limit);
    }

    /// The analysis of a part, if it was made before.
    pub(super) fn analysis(&self, identity: Identity) -> Option<Arc<dyn Analysed>> {
        let known = self.shelves().analyses.find(identity);
        known.filter(|known| known.is_alive())
    }

    /// Keeps an analysis.
    pub(super) fn keep_analysis(&self, identity: Identity, ordered: &Arc<dyn Analysed>) {
        let entry = Entry {
            identity,
            made: Arc::clone(ordered),
            bytes: ordered.bytes(),
        };
        self.shelves().analyses.keep(entry, self.limit / ANALYSES);
    }

    /// An engine for all runs that ask for the same: started where there is none, or none that is alive.
    ///
    /// # Errors
    /// [`LinearError::Engine`] if it cannot be started.
    pub fn engine(&self, model: &EngineModel) -> Result<Arc<dyn Engine>, LinearError> {
        let mut shelves = self.shelves();
        shelves.engines.retain(|(_, engine)| engine.is_alive());
        if let Some((_, engine)) = shelves.engines.iter().find(|(known, _)| known == model) {
            return Ok(Arc::clone(engine));
        }
        let engine = model.as_dyn().start()?;
        shelves.engines.push((model.clone(), Arc::clone(&engine)));
        Ok(engine)
    }

    /// The matrix with this identity: what was assembled before, or what `assemble` makes.
    pub fn stiffness(
        &self,
        identity: Identity,
        assemble: impl FnOnce() -> BlockCsr,
    ) -> Arc<BlockCsr> {
        if let Some(found) = self.shelves().stiffnesses.find(identity) {
            return found;
        }
        let made = Arc::new(assemble());
        let entry = Entry {
            identity,
            made: Arc::clone(&made),
            bytes: made.bytes(),
        };
        self.shelves()
            .stiffnesses
            .keep(entry, self.limit / STIFFNESSES);
        made
    }
}

/// Things with their identity and size, the least recently used one first.
#[derive(Debug)]
struct Shelf<T: ?Sized> {
    entries: Vec<Entry<T>>,
}

/// A thing with its identity and size `[bytes]`.
#[derive(Debug)]
struct Entry<T: ?Sized> {
    identity: Identity,
    made: Arc<T>,
    bytes: u64,
}

impl<T: ?Sized> Default for Shelf<T> {
    fn default() -> Self {
        Shelf {
            entries: Vec::new(),
        }
    }
}

impl<T: ?Sized> Shelf<T> {
    fn find(&mut self, identity: Identity) -> Option<Arc<T>> {
        let at = self.entries.iter().position(|e| e.identity == identity)?;
        let entry = self.entries.remove(at);
        let found = Arc::clone(&entry.made);
        self.entries.push(entry);
        Some(found)
    }

    fn keep(&mut self, entry: Entry<T>, limit: u64) {
        self.entries.retain(|e| e.identity != entry.identity);
        self.entries.push(entry);
        let mut all: u64 = self.entries.iter().map(|e| e.bytes).sum();
        while all > limit && !self.entries.is_empty() {
            all -= self.entries.remove(0).bytes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(fixed: usize) -> Identity {
        let matrix = BlockCsr::from_couplings(4, 2, &mut |_| ());
        let marks: Vec<bool> = (0..8).map(|k| k == fixed).collect();
        let part = Part {
            matrix: &matrix,
            points: (0, 4),
            fixed: &marks,
            kept: &[true; 4],
        };
        part.analysis()
    }

    #[test]
    fn what_was_used_least_recently_goes_first() {
        let [a, b, c, d] = [0, 1, 2, 3].map(identity);
        let mut shelf = Shelf::default();
        let entry = |identity, bytes| Entry {
            identity,
            made: Arc::new(()),
            bytes,
        };
        for one in [a, b, c] {
            shelf.keep(entry(one, 10), 35);
        }
        assert!(shelf.find(a).is_some());
        shelf.keep(entry(d, 10), 35);
        assert!(shelf.find(b).is_none());
        assert!([a, c, d].iter().all(|&one| shelf.find(one).is_some()));
        // Kept again it counts once; what is too large alone is not kept at all.
        shelf.keep(entry(d, 15), 35);
        assert_eq!(shelf.entries.len(), 3);
        shelf.keep(entry(b, 36), 35);
        assert!(shelf.entries.is_empty());
    }

    #[test]
    fn limits_are_sane() {
        assert!(Library::usual_limit() >= 1 << 26);
        assert!(Library::small_limit() <= GIB);
    }
}
