//! Who owns a file, a folder or a piece of work, of processes on several machines: a file that is there as long as its owner lives.
//!
//! There are two ways to own. A *lock* of the system ends with the process that has it, at once and on whatever machine it was; folders of results are owned
//! so, and where a file system knows no locks, what the file says of the owner counts. A *lease* needs only what holds on network file systems of all kinds:
//! a file is created by one of those who try at once, and a rename is seen as a whole. Who holds a lease writes another number into it every `BEAT`;
//! who waits and has seen none for `LONGEST_SILENCE`, by a clock of its own, takes the holder for dead. On the same machine it asks the system instead.
//! Leases spare work, and keep messages apart; what is written is whole without them: where two do the same after all, both are right, and the file
//! is that of the one who was last.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

/// How often the holder of a lease says that it lives.
const BEAT: Duration = Duration::from_secs(2);

/// How long nothing may be heard of it.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);

/// What a name ends with under which something is written, or put out of the way.
const ASIDE: &str = "tmp";

/// The owner of what a file stands for. It is given back when this is dropped.
#[derive(Debug)]
pub struct Owner {
    path: PathBuf,
    /// What the file says of this owner and no other.
    text: String,
    /// What the file said of who had it before and did not give it back.
    before: Vec<u8>,
    way: Way,
}

/// How something is owned.
#[derive(Debug)]
enum Way {
    /// By a lock on this file.
    Lock(File),
    /// By a beat, which ends when the sender is dropped; without it others take over after a while.
    Lease(Option<(Sender<()>, JoinHandle<()>)>),
    /// No longer: the file stays.
    Left,
}

/// Why something cannot be had.
#[derive(Debug)]
pub enum Refused {
    /// Somebody has it.
    Taken(Holder),
    /// What the system says.
    Io(io::Error),
}

impl From<io::Error> for Refused {
    fn from(e: io::Error) -> Self {
        Refused::Io(e)
    }
}

impl Owner {
    /// Takes what a file stands for that `open` opens, or makes, to be read and written; from who is `dead` in any case.
    ///
    /// # Errors
    /// [`Refused`]: somebody has it; what the system says.
    pub fn lock(
        path: PathBuf,
        open: impl Fn(&Path) -> io::Result<File>,
        dead: Option<&str>,
    ) -> Result<Owner, Refused> {
        let text = text_of_this();
        loop {
            let mut file = open(&path)?;
            let mut before = Vec::new();
            // What cannot be read says nothing.
            let _ = file.read_to_end(&mut before);
            match (file.try_lock(), Holder::parse(&before)) {
                (Ok(()), _) => {}
                (Err(TryLockError::WouldBlock), holder) => {
                    return Err(Refused::Taken(holder.unwrap_or_default()));
                }
                // Some file systems know no locks.
                (Err(TryLockError::Error(_)), Some(holder))
                    if !holder.has_ended() && dead != Some(&holder.to_string()) =>
                {
                    return Err(Refused::Taken(holder));
                }
                (Err(TryLockError::Error(_)), _) => {}
            }
            if !is_at(&file, &path) {
                // Whoever had it has just gone, and the file with him.
                continue;
            }
            write_anew(&mut file, format!("{text}\n").as_bytes())?;
            let way = Way::Lock(file);
            return Ok(Owner {
                path,
                text,
                before,
                way,
            });
        }
    }

    /// Takes a lease.
    ///
    /// # Errors
    /// [`Refused`]: another has it; there can be none, as nothing can be written there.
    pub fn lease(path: &Path) -> Result<Owner, Refused> {
        let text = text_of_this();
        let mut file = match create(path, &text) {
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {
                return Err(Refused::Taken(Holder::named_in(path).unwrap_or_default()));
            }
            made => made?,
        };
        let (over, end) = channel();
        let who = text.clone();
        let beat = Builder::new().spawn(move || {
            let mut count = 0;
            while end.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                count += 1;
                // One that cannot be written is missed by those who wait.
                let _ = say(&mut file, &who, count);
            }
        });
        Ok(Owner {
            path: path.to_path_buf(),
            text,
            before: Vec::new(),
            way: Way::Lease(beat.ok().map(|beat| (over, beat))),
        })
    }

    /// Who had it before and did not give it back.
    pub fn before(&self) -> Option<Holder> {
        Holder::parse(&self.before)
    }

    /// Whether it is still owned: the file is gone where somebody has removed it, and may be another's.
    pub fn stands(&self) -> bool {
        match &self.way {
            Way::Lock(file) => is_at(file, &self.path),
            Way::Lease(_) => {
                fs::read_to_string(&self.path).is_ok_and(|text| text.contains(&self.text))
            }
            Way::Left => false,
        }
    }

    /// Gives it back as it was found: with the name of whoever was killed with it.
    pub fn leave_as_it_was(mut self) {
        // No caller is left for an error if it cannot be written: then the name goes, too.
        if let (Some(_), Way::Lock(file)) = (self.before(), &mut self.way)
            && write_anew(file, &self.before).is_ok()
        {
            self.way = Way::Left;
        }
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        if let Way::Lease(beat) = &mut self.way
            && let Some((over, beat)) = beat.take()
        {
            drop(over);
            let _ = beat.join();
        }
        // It may be another's by now: a lease if this process was held up for so long that it was taken for dead. First the name goes, then the lock: whoever
        // opens the file in between finds it gone and tries again. No caller is left for an error.
        if self.stands() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Whether the file is still the one of this name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let same = |a: fs::Metadata, b: fs::Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    let both = file
        .metadata()
        .and_then(|a| Ok((a, fs::symlink_metadata(path)?)));
    both.is_ok_and(|(a, b)| same(a, b))
}

/// An open file cannot be removed there.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

fn write_anew(file: &mut File, text: &[u8]) -> io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    file.write_all(text)
}

/// Creates a lease with what it says in it. It is written under another name and linked, so that a process that is killed meanwhile leaves no empty lease,
/// whose holder is unknown.
fn create(path: &Path, who: &str) -> io::Result<File> {
    let new = |path: &Path| {
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        say(&mut file, who, 0).inspect_err(|_| drop(fs::remove_file(path)))?;
        Ok(file)
    };
    if path.exists() {
        return Err(ErrorKind::AlreadyExists.into());
    }
    let written = aside(path);
    let file = new(&written)?;
    let linked = fs::hard_link(&written, path);
    let _ = fs::remove_file(&written);
    match linked {
        Ok(()) => Ok(file),
        Err(e) if e.kind() == ErrorKind::AlreadyExists => Err(e),
        // A file system without links.
        Err(_) => new(path),
    }
}

/// Writes what a lease says; each time the same number of bytes.
fn say(file: &mut File, who: &str, count: u64) -> io::Result<()> {
    file.rewind()?;
    file.write_all(format!("{who} {count:012}\n").as_bytes())?;
    file.sync_data()
}

/// Whoever waits for a lease of another.
#[derive(Debug, Default)]
pub struct Waiting {
    /// What was read last, and since when it has been the same.
    last: Option<(Vec<u8>, Instant)>,
    looks: u32,
}

impl Waiting {
    /// Looks once more: whether the holder is known to live, as it has said so since the look before. A lease whose holder has ended is put out of the way,
    /// so that it can be asked for.
    pub fn look(&mut self, path: &Path) -> bool {
        let mut text = Vec::new();
        let read = File::open(path).and_then(|mut file| file.read_to_end(&mut text));
        // What is gone can be asked for.
        if read.is_err() {
            return false;
        }
        let before = self.last.as_ref().map(|(last, _)| *last == text);
        if self.is_over(&text, Instant::now()) {
            put_away(path, &text);
            self.last = None;
            return false;
        }
        before == Some(false) || Holder::parse(&text).is_some_and(|holder| holder.lives())
    }

    /// Whether a lease that says this now is that of a process that has ended.
    fn is_over(&mut self, text: &[u8], now: Instant) -> bool {
        if Holder::parse(text).is_some_and(|holder| holder.has_ended()) {
            return true;
        }
        match &self.last {
            Some((last, since)) if last == text => now.duration_since(*since) > LONGEST_SILENCE,
            _ => {
                self.last = Some((text.to_vec(), now));
                false
            }
        }
    }

    /// Waits for a while: longer from time to time, as a network file system is asked.
    pub fn pause(&mut self) {
        self.looks += 1;
        let ms = (10.0 * 1.3_f64.powi(self.looks.min(30) as i32)).min(1000.0);
        std::thread::sleep(Duration::from_millis(ms as u64));
    }
}

/// Removes a lease that says this. Of several who do so at once one moves it; if what was moved is a new one, it is put back.
fn put_away(path: &Path, text: &[u8]) {
    let aside = path.with_extension(format!("{}.{ASIDE}", token()));
    if fs::rename(path, &aside).is_err() {
        return;
    }
    let moved = fs::read(&aside).unwrap_or_default();
    if moved != text {
        // Fails where somebody has asked meanwhile: then two make the same.
        let _ = fs::hard_link(&aside, path);
    }
    let _ = fs::remove_file(&aside);
}

/// A process that owns something.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Holder {
    /// Its process number; 0 if not known.
    pub process: u32,
    /// The name of the machine; empty if not known.
    pub host: String,
    /// When it began, as the system counts: numbers of processes are used again.
    begun: u64,
    /// The machine since its start, and the space in which processes have their numbers; empty where that is not known.
    place: String,
}

impl Holder {
    /// This process.
    pub fn this() -> Self {
        let process = std::process::id();
        let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").ok();
        let space = fs::read_link("/proc/self/ns/pid").ok();
        let place = boot.zip(space).map(|(boot, space)| {
            let space = space.to_string_lossy().into_owned();
            let number: String = space.chars().filter(char::is_ascii_digit).collect();
            format!("{}/{number}", boot.trim())
        });
        let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
        let name = name.or_else(|| std::env::var("HOSTNAME").ok());
        let name = name.or_else(|| std::env::var("COMPUTERNAME").ok());
        Holder {
            process,
            host: name.unwrap_or_default().split_whitespace().collect(),
            begun: begun(process).unwrap_or_default(),
            place: place.unwrap_or_default(),
        }
    }

    /// What a file says of its owner: at least a process and the name of its machine.
    fn parse(text: &[u8]) -> Option<Self> {
        let mut words = std::str::from_utf8(text).ok()?.split_whitespace();
        let mut word = || Some(words.next()?.replace(UNKNOWN, ""));
        Some(Holder {
            process: word()?.parse().ok()?,
            host: word()?,
            begun: word()
                .and_then(|begun| begun.parse().ok())
                .unwrap_or_default(),
            place: word().unwrap_or_default(),
        })
    }

    /// What a file says of it, which [`Holder::parse`] reads.
    fn words(&self) -> String {
        let known = |word: &str| if word.is_empty() { UNKNOWN } else { word }.to_string();
        let (host, place) = (known(&self.host), known(&self.place));
        format!("{} {host} {} {place}", self.process, self.begun)
    }

    /// Who is named in a file; `None` if there is none.
    pub fn named_in(path: &Path) -> Option<Self> {
        let text = fs::read(path).ok()?;
        Some(Holder::parse(&text).unwrap_or_default())
    }

    /// Who has a lock by this file, if anybody has.
    pub fn of_lock(path: &Path) -> Option<Self> {
        let holder = Holder::named_in(path).filter(|holder| holder.process > 0)?;
        match File::open(path).ok()?.try_lock_shared() {
            Err(TryLockError::WouldBlock) => Some(holder),
            Ok(()) => None,
            Err(TryLockError::Error(_)) => (!holder.has_ended()).then_some(holder),
        }
    }

    /// Whether the system of this machine can tell of it.
    fn is_known(&self) -> bool {
        !self.place.is_empty() && self.begun > 0 && self.place == Holder::this().place
    }

    /// Whether it has ended, as far as the system can tell.
    fn has_ended(&self) -> bool {
        self.is_known() && begun(self.process) != Some(self.begun)
    }

    /// Whether it goes on, as far as the system can tell.
    fn lives(&self) -> bool {
        self.is_known() && !self.has_ended()
    }
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.process {
            0 => write!(f, "a process that has not said who it is")?,
            process => write!(f, "process {process}")?,
        }
        match self.host.as_str() {
            "" => Ok(()),
            host => write!(f, " on {host}"),
        }
    }
}

/// Stands for a word that is not known.
const UNKNOWN: &str = "?";

/// What a file says that this process owns, with a word of this one time.
fn text_of_this() -> String {
    format!("{} {}", Holder::this().words(), token())
}

/// When a process began, in the ticks of Linux; `None` if there is none that has not ended.
fn begun(process: u32) -> Option<u64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name, in brackets, may hold anything.
    let mut rest = stat[stat.rfind(')')? + 1..].split_whitespace();
    match rest.next()? {
        "Z" | "X" => None,
        _ => rest.nth(18)?.parse().ok(),
    }
}

/// A name that no other process takes, on whatever machine.
pub fn token() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let now = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
    let place = Holder::this().place;
    let host = place.bytes().fold(0_u32, |hash, byte| {
        hash.wrapping_mul(31).wrapping_add(u32::from(byte))
    });
    format!(
        "{host:08x}{:x}-{:x}-{count}",
        std::process::id(),
        now.as_nanos()
    )
}

/// Removes what killed processes left of a file that is made anew: only for whoever has the lease.
pub fn drop_leftovers(path: &Path) {
    let (Some(folder), Some(stem)) = (path.parent(), path.file_stem()) else {
        return;
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let left = name.strip_prefix(&*stem.to_string_lossy());
        if left.is_some_and(|rest| rest.starts_with('.') && rest.ends_with(&format!(".{ASIDE}"))) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The name under which a file is written before it has its own.
pub fn aside(path: &Path) -> PathBuf {
    path.with_extension(format!("{}.{ASIDE}", token()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("stickslip-owner-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_lease_is_never_seen_empty() {
        let folder = folder("whole");
        let path = folder.join("a.lease");
        let over = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            let looks = scope.spawn(|| {
                let mut seen = 0;
                while !over.load(Ordering::Relaxed) {
                    if let Ok(text) = fs::read(&path) {
                        assert!(Holder::parse(&text).is_some(), "{text:?}");
                        seen += 1;
                    }
                }
                seen
            });
            for _ in 0..100 {
                assert!(Owner::lease(&path).is_ok());
            }
            over.store(true, Ordering::Relaxed);
            assert!(looks.join().unwrap() > 0);
        });
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_lease_has_one_holder_and_is_given_back() {
        let folder = folder("one");
        let path = folder.join("a.lease");
        let Ok(lease) = Owner::lease(&path) else {
            panic!("it is free");
        };
        assert!(matches!(Owner::lease(&path), Err(Refused::Taken(_))));
        let mut waiting = Waiting::default();
        assert!(waiting.look(&path), "its holder lives");
        assert!(path.exists());
        let holder = Holder::named_in(&path).unwrap().to_string();
        let me = format!("process {} on ", std::process::id());
        assert!(holder.starts_with(&me), "{holder}");
        drop(lease);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        assert!(matches!(
            Owner::lease(&folder.join("none/a.lease")),
            Err(Refused::Io(_))
        ));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn of_many_who_ask_at_once_one_gets_it() {
        let folder = folder("many");
        for round in 0..20 {
            let path = folder.join(format!("{round}.lease"));
            let got: Vec<_> = std::thread::scope(|scope| {
                let all: Vec<_> = (0..8)
                    .map(|_| scope.spawn(|| Owner::lease(&path)))
                    .collect();
                all.into_iter().map(|one| one.join().unwrap()).collect()
            });
            let ours = got.iter().filter(|one| one.is_ok());
            assert_eq!(ours.count(), 1);
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_dead_of_this_machine_are_known_at_once_and_others_by_their_silence() {
        let mut me = Holder::this();
        assert!(!me.has_ended());
        me.begun += 1;
        assert!(me.has_ended(), "another process has this number now");
        let away = b"1 far-away 5 elsewhere/7 token 000000000000\n";
        let mut waiting = Waiting::default();
        let now = Instant::now();
        assert!(!waiting.is_over(away, now));
        assert!(!waiting.is_over(away, now + LONGEST_SILENCE / 2));
        // It beats.
        let beat = b"1 far-away 5 elsewhere/7 token 000000000001\n";
        let later = now + LONGEST_SILENCE + BEAT;
        assert!(!waiting.is_over(beat, later));
        assert!(!waiting.is_over(beat, later + LONGEST_SILENCE));
        assert!(waiting.is_over(beat, later + LONGEST_SILENCE + BEAT));
        // What is no lease of ours is one of somebody who may be writing it.
        assert!(!Waiting::default().is_over(b"", now));
    }

    #[test]
    fn a_lease_of_the_dead_goes_and_a_new_one_in_its_place_stays() {
        let folder = folder("dead");
        let path = folder.join("a.lease");
        let mut dead = Holder::this();
        dead.begun += 1;
        let text = format!("{} token 000000000000\n", dead.words());
        fs::write(&path, &text).unwrap();
        assert!(!Waiting::default().look(&path));
        assert!(!path.exists());
        // Somebody was quicker: what is there is no longer what was found dead.
        fs::write(&path, "new").unwrap();
        put_away(&path, text.as_bytes());
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        // One that has become another's is not given back.
        fs::remove_file(&path).unwrap();
        let Ok(lease) = Owner::lease(&path) else {
            panic!("it is free");
        };
        fs::write(&path, "new").unwrap();
        drop(lease);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_the_killed_left_aside_goes_and_nothing_else() {
        let folder = folder("left");
        let path = folder.join("abc.sub");
        let kept = ["abc.sub", "abcd.1-1.tmp", "abc.lease", "b.1-2.tmp"];
        for name in kept.iter().chain(&["abc.1-3.tmp", "abc.4-5-6.tmp"]) {
            fs::write(folder.join(name), "").unwrap();
        }
        fs::write(aside(&path), "").unwrap();
        drop_leftovers(&path);
        let mut left: Vec<_> = fs::read_dir(&folder).unwrap().flatten().collect();
        left.sort_by_key(std::fs::DirEntry::file_name);
        assert!(
            left.iter()
                .all(|e| kept.iter().any(|k| e.file_name() == *k))
        );
        assert_eq!(left.len(), kept.len());
        fs::remove_dir_all(folder).unwrap();
    }

    fn lock(path: &Path) -> Result<Owner, Refused> {
        let open = |path: &Path| {
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(true);
            options.truncate(false).open(path)
        };
        Owner::lock(path.to_path_buf(), open, None)
    }

    #[test]
    fn a_folder_has_one_holder_who_gives_it_back() {
        let folder = folder("lock-one");
        let path = folder.join("run.lock");
        let owner = lock(&path).unwrap();
        assert!(owner.before().is_none());
        assert_eq!(Holder::of_lock(&path), Some(Holder::this()));
        match lock(&path) {
            Err(Refused::Taken(holder)) => assert_eq!(holder, Holder::this()),
            other => panic!("{other:?}"),
        }
        drop(owner);
        assert_eq!(Holder::of_lock(&path), None);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_a_dead_process_left_is_no_obstacle() {
        let folder = folder("lock-stale");
        let path = folder.join("run.lock");
        fs::write(&path, "4194305 far-away\n").unwrap();
        assert_eq!(Holder::of_lock(&path), None);
        let owner = lock(&path).unwrap();
        let before = owner.before().unwrap();
        assert_eq!(before.to_string(), "process 4194305 on far-away");
        owner.leave_as_it_was();
        assert_eq!(fs::read_to_string(&path).unwrap(), "4194305 far-away\n");
        assert_eq!(Holder::of_lock(&path), None);
        drop(lock(&path).unwrap());
        fs::write(&path, b"\xff\xfe").unwrap();
        assert!(lock(&path).unwrap().before().is_none());
        fs::remove_dir_all(folder).unwrap();
    }
}
