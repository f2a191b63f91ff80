//! The ParaView collection that lists the field files by time: written, and read back.

use std::path::{Path, PathBuf};

use crate::error::{Error, IoError};

use super::vtu::{Event, Scanner, escape};
use super::write_atomically;

/// A `.pvd` file: opened in ParaView, it shows the files it lists as one animation.
#[derive(Debug, Clone)]
pub struct Collection {
    path: PathBuf,
    entries: Vec<(f64, String)>,
}

impl Collection {
    /// An empty collection to be written at `path`.
    pub fn new(path: &Path) -> Self {
        Collection {
            path: path.to_path_buf(),
            entries: Vec::new(),
        }
    }

    /// Goes on with a collection of these files; it is written anew, and removed where there are none yet.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn resume(path: &Path, entries: &[(f64, String)]) -> Result<Self, Error> {
        let mut collection = Collection::new(path);
        let Some(((t, last), before)) = entries.split_last() else {
            return match std::fs::remove_file(path) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io(path, e)),
                _ => Ok(collection),
            };
        };
        collection.entries = before.to_vec();
        collection.push(*t, last)?;
        Ok(collection)
    }

    /// Time and file of each entry.
    pub fn entries(&self) -> &[(f64, String)] {
        &self.entries
    }

    /// Adds the file of time `t`, as a path relative to the collection, and writes the collection anew.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn push(&mut self, t: f64, file: &str) -> Result<(), Error> {
        self.entries.push((t, file.to_string()));
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        );
        for (t, file) in &self.entries {
            text += &format!(
                "<DataSet timestep=\"{t:?}\" part=\"0\" file=\"{}\"/>\n",
                escape(file)
            );
        }
        text += "</Collection>\n</VTKFile>\n";
        write_atomically(&self.path, text.as_bytes())
    }
}

/// Reads a collection: time and file of each entry, in the order of the file. Names are as they are written, relative to the
/// collection.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, is malformed, or an entry has no time or no file.
pub fn read(path: &Path) -> Result<Vec<(f64, String)>, Error> {
    let bytes = super::input::read(path, super::input::TEXT).map_err(|e| Error::io(path, e))?;
    parse(&bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

fn parse(bytes: &[u8]) -> Result<Vec<(f64, String)>, String> {
    let mut scanner = Scanner::new(bytes);
    let (mut entries, mut collection) = (Vec::new(), false);
    while let Some(event) = scanner.next()? {
        match (event, scanner.path()) {
            (Event::Open(_), ["VTKFile", "Collection"]) => collection = true,
            (Event::Open(attributes), ["VTKFile", "Collection", "DataSet"]) => {
                let find = |key: &str| {
                    let found = attributes.iter().find(|(k, _)| *k == key);
                    found
                        .map(|(_, value)| value.as_str())
                        .ok_or_else(|| scanner.fault(format!("an entry has no `{key}`")))
                };
                let text = find("timestep")?;
                let time = text.trim().parse::<f64>().ok().filter(|t| t.is_finite());
                let time =
                    time.ok_or_else(|| scanner.fault(format!("the time `{text}` is no number")))?;
                entries.push((time, find("file")?.to_string()));
            }
            _ => {}
        }
    }
    match collection {
        true => Ok(entries),
        false => Err("this is no ParaView collection: it has no <Collection>".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_every_file_so_far() {
        let path = std::env::temp_dir().join(format!("stickslip-{}.pvd", std::process::id()));
        let mut collection = Collection::new(&path);
        collection.push(0.0, "fields/0000.vtu").unwrap();
        collection.push(1e-9, "fields/a&b.vtu").unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("timestep=\"0.0\" part=\"0\" file=\"fields/0000.vtu\""));
        assert!(text.contains("timestep=\"1e-9\" part=\"0\" file=\"fields/a&amp;b.vtu\""));
        let expected = [
            (0.0, "fields/0000.vtu".to_string()),
            (1e-9, "fields/a&b.vtu".to_string()),
        ];
        assert_eq!(read(&path).unwrap(), expected);
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn what_is_no_collection_is_refused() {
        for (text, message) in [
            ("", "no ParaView collection"),
            ("<VTKFile></VTKFile>", "no ParaView collection"),
            ("<VTKFile><Collection>", "ends inside <Collection>"),
            (
                "<VTKFile><Collection><DataSet file='a'/></Collection></VTKFile>",
                "line 1: an entry has no `timestep`",
            ),
            (
                "<VTKFile><Collection><DataSet timestep='x' file='a'/></Collection></VTKFile>",
                "the time `x` is no number",
            ),
        ] {
            let error = parse(text.as_bytes()).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
