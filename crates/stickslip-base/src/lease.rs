//! Who does what, of processes on several machines: a file that is there as long as a process is at it, so that others wait, or do something else.
//!
//! What it relies on holds on network file systems as well: a file is created by one of those who try at once, and a rename is seen as a whole. Locks of the
//! system are not used. Whoever holds a lease writes another number into it every `BEAT`; whoever waits and has seen none for `PATIENCE`, by a
//! clock of its own, takes the holder for dead. On the same machine it asks the system instead. Leases spare work, and keep messages apart; what is written
//! is whole without them: where two do the same after all, both are right, and the file is that of the one who was last.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

/// How often the holder of a lease says that it lives.
const BEAT: Duration = Duration::from_secs(2);

/// How long nothing may be heard of it.
const PATIENCE: Duration = Duration::from_secs(60);

/// What a name ends with under which something is written, or put out of the way.
const ASIDE: &str = "tmp";

/// The right to do something. It is given back when this is dropped.
#[derive(Debug)]
pub struct Lease {
    path: PathBuf,
    /// Of this lease and no other.
    token: String,
    /// Ends the beat when it is dropped.
    over: Option<Sender<()>>,
    beat: Option<JoinHandle<()>>,
}

/// What came of asking for a lease.
#[derive(Debug)]
pub enum Asked {
    /// It was free.
    Ours(Lease),
    /// Another has it.
    Theirs,
    /// There can be none, as nothing can be written there.
    Nobodys,
}

impl Lease {
    /// Who has it, for people: `process 4711 on host`; `None` if nobody has.
    pub fn holder(path: &Path) -> Option<String> {
        let text = fs::read(path).ok()?;
        Some(match Holder::parse(&text) {
            Some(holder) => format!("process {} on {}", holder.process, holder.host),
            None => "another process".into(),
        })
    }

    /// Asks for it.
    pub fn ask(path: &Path) -> Asked {
        let token = token();
        let me = format!("{} {token}", Holder::this());
        let mut file = match create(path, &me) {
            Ok(file) => file,
            Err(e) if e.kind() == ErrorKind::AlreadyExists => return Asked::Theirs,
            Err(_) => return Asked::Nobodys,
        };
        let (over, end) = channel();
        let beat = Builder::new().spawn(move || {
            let mut count = 0;
            while end.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                count += 1;
                // One that cannot be written is missed by those who wait.
                let _ = say(&mut file, &me, count);
            }
        });
        Asked::Ours(Lease {
            path: path.to_path_buf(),
            token,
            over: Some(over),
            // Without a beat others take over after a while.
            beat: beat.ok(),
        })
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        drop(self.over.take());
        if let Some(beat) = self.beat.take() {
            let _ = beat.join();
        }
        // It may be another's by now, if this process was held up for so long that it was taken for dead.
        if fs::read_to_string(&self.path).is_ok_and(|text| text.contains(&self.token)) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Creates a lease with what it says in it. It is written under another name and linked, so that a process that is killed meanwhile leaves no empty lease,
/// whose holder nobody can know.
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
            Some((last, since)) if last == text => now.duration_since(*since) > PATIENCE,
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

/// A process.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Holder {
    process: u32,
    /// When it began, as the system counts: numbers of processes are used again.
    begun: u64,
    /// The machine since its start, and the space in which processes have their numbers; `-` where that is not known.
    place: String,
    /// The name of the machine.
    host: String,
}

impl Holder {
    fn this() -> Self {
        let process = std::process::id();
        let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").ok();
        let space = fs::read_link("/proc/self/ns/pid").ok();
        let place = boot.zip(space).map(|(boot, space)| {
            let space = space.to_string_lossy().into_owned();
            let number: String = space.chars().filter(char::is_ascii_digit).collect();
            format!("{}/{number}", boot.trim())
        });
        Holder {
            process,
            begun: begun(process).unwrap_or_default(),
            place: place.unwrap_or_else(|| "-".into()),
            host: host(),
        }
    }

    fn parse(text: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(text).ok()?;
        let mut words = text.split_whitespace();
        Some(Holder {
            process: words.next()?.parse().ok()?,
            begun: words.next()?.parse().ok()?,
            place: words.next()?.to_string(),
            host: words.next()?.to_string(),
        })
    }

    /// Whether the system of this machine can tell of it.
    fn is_known(&self) -> bool {
        self.place != "-" && self.begun > 0 && self.place == Holder::this().place
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
        let Holder {
            process,
            begun,
            place,
            host,
        } = self;
        write!(f, "{process} {begun} {place} {host}")
    }
}

/// The name of this machine, in one word.
fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let name = name.or_else(|| std::env::var("HOSTNAME").ok());
    let name = name.or_else(|| std::env::var("COMPUTERNAME").ok());
    let word: String = name.unwrap_or_default().split_whitespace().collect();
    match word.is_empty() {
        true => "another-machine".into(),
        false => word,
    }
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
            std::env::temp_dir().join(format!("stickslip-lease-{name}-{}", std::process::id()));
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
                assert!(matches!(Lease::ask(&path), Asked::Ours(_)));
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
        let Asked::Ours(lease) = Lease::ask(&path) else {
            panic!("it is free");
        };
        assert!(matches!(Lease::ask(&path), Asked::Theirs));
        let mut waiting = Waiting::default();
        assert!(waiting.look(&path), "its holder lives");
        assert!(path.exists());
        let holder = Lease::holder(&path).unwrap();
        let me = format!("process {} on ", std::process::id());
        assert!(holder.starts_with(&me), "{holder}");
        drop(lease);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        assert!(matches!(
            Lease::ask(&folder.join("none/a.lease")),
            Asked::Nobodys
        ));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn of_many_who_ask_at_once_one_gets_it() {
        let folder = folder("many");
        for round in 0..20 {
            let path = folder.join(format!("{round}.lease"));
            let got: Vec<Asked> = std::thread::scope(|scope| {
                let all: Vec<_> = (0..8).map(|_| scope.spawn(|| Lease::ask(&path))).collect();
                all.into_iter().map(|one| one.join().unwrap()).collect()
            });
            let ours = got.iter().filter(|one| matches!(one, Asked::Ours(_)));
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
        let away = b"1 5 elsewhere/7 far-away token 000000000000\n";
        let mut waiting = Waiting::default();
        let now = Instant::now();
        assert!(!waiting.is_over(away, now));
        assert!(!waiting.is_over(away, now + PATIENCE / 2));
        // It beats.
        let beat = b"1 5 elsewhere/7 far-away token 000000000001\n";
        let later = now + PATIENCE + BEAT;
        assert!(!waiting.is_over(beat, later));
        assert!(!waiting.is_over(beat, later + PATIENCE));
        assert!(waiting.is_over(beat, later + PATIENCE + BEAT));
        // What is no lease of ours is one of somebody who may be writing it.
        assert!(!Waiting::default().is_over(b"", now));
    }

    #[test]
    fn a_lease_of_the_dead_goes_and_a_new_one_in_its_place_stays() {
        let folder = folder("dead");
        let path = folder.join("a.lease");
        let mut dead = Holder::this();
        dead.begun += 1;
        let text = format!("{dead} token 000000000000\n");
        fs::write(&path, &text).unwrap();
        assert!(!Waiting::default().look(&path));
        assert!(!path.exists());
        // Somebody was quicker: what is there is no longer what was found dead.
        fs::write(&path, "new").unwrap();
        put_away(&path, text.as_bytes());
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        // One that has become another's is not given back.
        fs::remove_file(&path).unwrap();
        let Asked::Ours(lease) = Lease::ask(&path) else {
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
}
