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
        let lines = self.entries.iter();
        let lines = lines.map(|(t, file)| line(*t, "part=\"0\"", file));
        write_lines(&self.path, lines)
    }
}

fn line(t: f64, which: &str, file: &str) -> String {
    let file = escape(file);
    format!("<DataSet timestep=\"{t:?}\" {which} file=\"{file}\"/>\n")
}

fn write_lines(path: &Path, lines: impl Iterator<Item = String>) -> Result<(), Error> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    text.extend(lines);
    text += "</Collection>\n</VTKFile>\n";
    write_atomically(path, text.as_bytes())
}

/// Writes a collection of which every time has the same named parts: a block each. `file` says which file holds a part, by its name and that of the whole.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn write_parts(
    path: &Path,
    entries: &[(f64, String)],
    parts: &[String],
    file: impl Fn(&str, &str) -> String,
) -> Result<(), Error> {
    let each = entries.iter().flat_map(|(t, whole)| {
        parts.iter().enumerate().map({
            let file = &file;
            move |(i, part)| {
                let which = format!("part=\"{i}\" name=\"{}\"", escape(part));
                line(*t, &which, &file(part, whole))
            }
        })
    });
    write_lines(path, each)
}

/// Reads a collection: time and file of each entry, in the order of the file. Names are as they are written, relative to the
/// collection.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, is malformed, or an entry has no time or no file.
pub fn read(path: &Path) -> Result<Vec<(f64, String)>, Error> {
    let parts = read_parts(path)?.into_iter();
    Ok(parts.map(|part| (part.time, part.file)).collect())
}

/// A file of a collection.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its time `[time]`.
    pub time: f64,
    /// The name of the block; empty where it has none.
    pub name: String,
    /// The file, relative to the collection.
    pub file: String,
}

/// Reads a collection with the names of its blocks.
///
/// # Errors
/// As [`read()`].
pub fn read_parts(path: &Path) -> Result<Vec<Part>, Error> {
    let bytes =
        super::input::read(path, super::input::MOST_TEXT_BYTES).map_err(|e| Error::io(path, e))?;
    parse(&bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

/// The names of the blocks, each once, in the order of the file.
///
/// # Errors
/// As [`read()`].
pub fn parts(path: &Path) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    for part in read_parts(path)? {
        if !names.contains(&part.name) {
            names.push(part.name);
        }
    }
    Ok(names)
}

fn parse(bytes: &[u8]) -> Result<Vec<Part>, String> {
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
                let name = attributes.iter().find(|(k, _)| *k == "name");
                entries.push(Part {
                    time,
                    name: name.map_or_else(String::new, |(_, name)| name.clone()),
                    file: find("file")?.to_string(),
                });
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
        let blocks = ["a&b".to_string(), "c".to_string()];
        write_parts(&path, collection.entries(), &blocks, |part, whole| {
            format!("{part}/{whole}")
        })
        .unwrap();
        assert_eq!(parts(&path).unwrap(), blocks);
        let listed = read_parts(&path).unwrap();
        assert_eq!(listed.len(), 4);
        let second = Part {
            time: 0.0,
            name: "c".into(),
            file: "c/fields/0000.vtu".into(),
        };
        assert_eq!(listed[1], second);
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
