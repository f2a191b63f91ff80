//! One run at a time in a folder: a file that says who is in it, locked as long as that process lives.

use std::fs::{File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

use crate::io::input;
use crate::io::own::{self, Use};

/// Name of the file in the folder.
pub(crate) const NAME: &str = "run.lock";

/// Who a folder belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Holder {
    /// Its process number; 0 if not known.
    pub process: u32,
    /// The machine it runs on; empty if not known.
    pub host: String,
}

impl Holder {
    /// This process.
    pub fn this() -> Self {
        let host = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
        let host = host.or_else(|| std::env::var("HOSTNAME").ok());
        let host = host.or_else(|| std::env::var("COMPUTERNAME").ok());
        Holder {
            process: std::process::id(),
            host: host.unwrap_or_default().trim().to_string(),
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let (process, host) = text.trim_end().split_once(' ')?;
        Some(Holder {
            process: process.parse().ok()?,
            host: host.to_string(),
        })
    }

    /// Whether it has ended, as far as can be told without a lock.
    fn is_over(&self) -> bool {
        let here = self.host == Holder::this().host && Path::new("/proc/self").exists();
        here && !Path::new("/proc").join(self.process.to_string()).exists()
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

/// A folder of one's own. It is given back when this is dropped, and by the system if the process is killed.
#[derive(Debug)]
pub(crate) struct Lock {
    path: PathBuf,
    file: Option<File>,
    /// Who had the folder before and did not give it back.
    pub stale: Option<Holder>,
    /// The file stays when this is dropped.
    remains: bool,
}

/// Why a folder cannot be had.
#[derive(Debug)]
pub(crate) enum Refused {
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

impl Lock {
    /// Takes the folder; from who is `dead` in any case.
    pub fn take(directory: &Path, dead: Option<&str>) -> Result<Lock, Refused> {
        Lock::take_file(directory.join(NAME), dead)
    }

    /// Takes what this file stands for.
    pub fn take_file(path: PathBuf, dead: Option<&str>) -> Result<Lock, Refused> {
        loop {
            let mut file = own::open(&path, Use::ChangeOrMake)?;
            let mut text = String::new();
            // What is no text says nothing.
            let _ = file.read_to_string(&mut text);
            let before = Holder::parse(&text);
            let unknown = || Holder {
                process: 0,
                host: String::new(),
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    return Err(Refused::Taken(before.unwrap_or_else(unknown)));
                }
                // Some file systems know no locks.
                Err(TryLockError::Error(_)) => match before {
                    Some(holder) if !holder.is_over() && dead != Some(&holder.to_string()) => {
                        return Err(Refused::Taken(holder));
                    }
                    _ => {}
                },
            }
            if !is_at(&file, &path) {
                // Whoever had it has just gone, and the file with him.
                continue;
            }
            let me = Holder::this();
            file.set_len(0)?;
            file.rewind()?;
            file.write_all(format!("{} {}\n", me.process, me.host).as_bytes())?;
            return Ok(Lock {
                path,
                file: Some(file),
                stale: before,
                remains: false,
            });
        }
    }

    /// Whether the file is still there: it is gone where somebody has removed it, and the folder may be another's.
    pub fn stands(&self) -> bool {
        let file = self.file.as_ref();
        file.is_some_and(|file| is_at(file, &self.path))
    }

    /// Gives the folder back as it was found: with the name of whoever was killed in it.
    pub fn leave_as_it_was(mut self) {
        let (Some(stale), Some(file)) = (self.stale.take(), &mut self.file) else {
            return;
        };
        let text = format!("{} {}\n", stale.process, stale.host);
        let written = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| file.write_all(text.as_bytes()));
        // Nobody is left to tell if it cannot be written: then the name goes, too.
        self.remains = written.is_ok();
    }

    /// Who is in a folder, if anybody is.
    pub fn holder(directory: &Path) -> Option<Holder> {
        let path = directory.join(NAME);
        input::check(&path).ok()?;
        let mut file = File::open(path).ok()?;
        let mut text = String::new();
        file.read_to_string(&mut text).ok()?;
        let holder = Holder::parse(&text)?;
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => Some(holder),
            Ok(()) => None,
            Err(TryLockError::Error(_)) => (!holder.is_over()).then_some(holder),
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // First the name, then the lock: whoever opens the file in between finds it gone and tries again. Nobody is left to tell if it fails.
        if !self.remains {
            let _ = std::fs::remove_file(&self.path);
        }
        self.file = None;
    }
}

/// Whether the file is still the one of this name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let same =
        |a: std::fs::Metadata, b: std::fs::Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    match (file.metadata(), std::fs::symlink_metadata(path)) {
        (Ok(a), Ok(b)) => same(a, b),
        _ => false,
    }
}

/// An open file cannot be removed there.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("stickslip-lock-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_folder_has_one_holder_who_gives_it_back() {
        let folder = folder("one");
        let lock = Lock::take(&folder, None).unwrap();
        assert!(lock.stale.is_none());
        assert_eq!(Lock::holder(&folder), Some(Holder::this()));
        match Lock::take(&folder, None) {
            Err(Refused::Taken(holder)) => assert_eq!(holder, Holder::this()),
            other => panic!("{other:?}"),
        }
        drop(lock);
        assert_eq!(Lock::holder(&folder), None);
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_a_dead_process_left_is_no_obstacle() {
        let folder = folder("stale");
        std::fs::write(folder.join(NAME), "4194305 far-away\n").unwrap();
        assert_eq!(Lock::holder(&folder), None);
        let lock = Lock::take(&folder, None).unwrap();
        let stale = lock.stale.as_ref().unwrap();
        assert_eq!(stale.to_string(), "process 4194305 on far-away");
        lock.leave_as_it_was();
        assert_eq!(
            std::fs::read_to_string(folder.join(NAME)).unwrap(),
            "4194305 far-away\n"
        );
        assert_eq!(Lock::holder(&folder), None);
        drop(Lock::take(&folder, None).unwrap());
        std::fs::write(folder.join(NAME), b"\xff\xfe").unwrap();
        assert!(Lock::take(&folder, None).unwrap().stale.is_none());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
