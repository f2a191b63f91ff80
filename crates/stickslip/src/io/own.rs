//! Files that are written to where they are, and folders that are written into: the one place that opens them.
//!
//! A folder of results may have come from somebody else. Nothing is written, cut or emptied through a link that lies in it, and nothing that has a name
//! elsewhere as well: who has a backup made of hard links would find it changed. What is replaced as a whole ([`write_atomically`](super::write_atomically))
//! needs none of this: a name that is given anew leaves alone what it stood for.

use std::fs::{self, File, OpenOptions};
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// What is done with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// It is read and written to anywhere, and has to be there.
    Change,
    /// It is written to at its end, and has to be there.
    Append,
    /// As [`Use::Change`]; made where there is none.
    ChangeOrMake,
    /// As [`Use::Append`]; made where there is none.
    AppendOrMake,
}

/// Opens a file to write to it.
///
/// # Errors
/// What the system says; that it is a link, no file, or has another name as well.
pub fn open(path: &Path, what: Use) -> Result<File> {
    match fs::symlink_metadata(path) {
        // Asked before it is opened: the other end of a pipe would be waited for.
        Ok(about) => is_own(&about)?,
        Err(e) if e.kind() == ErrorKind::NotFound => {}
        Err(e) => return Err(e),
    }
    let mut options = OpenOptions::new();
    match what {
        Use::Change | Use::ChangeOrMake => options.read(true).write(true),
        Use::Append | Use::AppendOrMake => options.append(true),
    };
    options.create(matches!(what, Use::ChangeOrMake | Use::AppendOrMake));
    follow_no_link(&mut options);
    let file = options.open(path)?;
    // What was put there meanwhile.
    is_own(&file.metadata()?)?;
    Ok(file)
}

/// Makes a file under a name that is nobody's: what lies there, as a process that was killed has left it, is taken away first, and a link with it.
///
/// # Errors
/// What the system says.
pub fn make(path: &Path) -> Result<File> {
    match File::create_new(path) {
        Err(e) if e.kind() == ErrorKind::AlreadyExists => {
            fs::remove_file(path)?;
            File::create_new(path)
        }
        made => made,
    }
}

/// Makes a folder within another, if it is not there.
///
/// # Errors
/// What the system says; that it is a link, or no folder.
pub fn make_folder(path: &Path) -> Result<()> {
    match fs::create_dir(path) {
        Err(e) if e.kind() == ErrorKind::AlreadyExists => is_own_folder(path),
        made => made,
    }
}

/// Whether what lies within a folder under this name may be written into: there is nothing, or a folder that is no link.
///
/// # Errors
/// What the system says; that it is a link, or no folder.
pub fn is_own_folder(path: &Path) -> Result<()> {
    match fs::symlink_metadata(path) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(()),
        Err(e) => Err(e),
        Ok(about) if about.is_symlink() => refuse(
            "this is a link to another place, and results are written into folders of their own: remove the link",
        ),
        Ok(about) if !about.is_dir() => {
            refuse("a folder is needed here: remove what is in its way")
        }
        Ok(_) => Ok(()),
    }
}

/// Whether a file may be written to, by what the system says of its name.
fn is_own(about: &fs::Metadata) -> Result<()> {
    if about.is_symlink() {
        return refuse(
            "this is a link to another file, which would be changed: remove the link, or put a copy of that file in its place",
        );
    }
    if !about.is_file() {
        return refuse("this is no file: remove it");
    }
    if names(about) > 1 {
        return refuse(
            "this file has another name as well (a hard link), and both would be changed: put a copy in its place",
        );
    }
    Ok(())
}

fn refuse(why: &str) -> Result<()> {
    Err(Error::new(ErrorKind::InvalidInput, why))
}

#[cfg(unix)]
fn names(about: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(about)
}

/// Elsewhere the standard library does not tell.
#[cfg(not(unix))]
fn names(_: &fs::Metadata) -> u64 {
    1
}

/// A link that is put there between the question and the opening is an error.
#[cfg(unix)]
fn follow_no_link(options: &mut OpenOptions) {
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, libc::O_NOFOLLOW);
}

#[cfg(not(unix))]
fn follow_no_link(_: &mut OpenOptions) {}

#[cfg(all(test, unix))]
mod tests {
    use std::io::Write;
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn nothing_is_written_through_a_link() {
        let name = format!("stickslip-own-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(folder.join("elsewhere")).unwrap();
        let victim = folder.join("victim");
        fs::write(&victim, "precious").unwrap();
        let link = folder.join("link");
        let all = [
            Use::Change,
            Use::Append,
            Use::ChangeOrMake,
            Use::AppendOrMake,
        ];
        let refused = |path: &Path, why: &str| {
            for what in all {
                let message = open(path, what).unwrap_err().to_string();
                assert!(message.contains(why), "{what:?}: {message}");
            }
        };
        // A link to nothing would be made, too.
        for target in ["victim", "nothing"] {
            symlink(folder.join(target), &link).unwrap();
            refused(&link, "a link to another file");
            fs::remove_file(&link).unwrap();
        }
        fs::hard_link(&victim, &link).unwrap();
        refused(&link, "another name as well");
        // Where all is made anew the link goes, and what it leads to stays.
        make(&link).unwrap().write_all(b"new").unwrap();
        fs::remove_file(&link).unwrap();
        symlink(&victim, &link).unwrap();
        make(&link).unwrap().write_all(b"new").unwrap();
        assert_eq!(fs::read(&link).unwrap(), b"new");
        assert_eq!(fs::read(&victim).unwrap(), b"precious");
        assert!(!folder.join("nothing").exists());
        refused(&folder, "this is no file");
        for path in ["made", "made"] {
            let mut file = open(&folder.join(path), Use::AppendOrMake).unwrap();
            file.write_all(b"row").unwrap();
        }
        assert_eq!(fs::read(folder.join("made")).unwrap(), b"rowrow");
        assert!(open(&folder.join("none"), Use::Change).is_err());

        let inside = folder.join("interfaces");
        symlink(folder.join("elsewhere"), &inside).unwrap();
        let message = make_folder(&inside).unwrap_err().to_string();
        assert!(message.contains("a link to another place"), "{message}");
        fs::remove_file(&inside).unwrap();
        make_folder(&inside).unwrap();
        make_folder(&inside).unwrap();
        assert!(make_folder(&link).is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
