//! The ParaView collection that lists the field files by time.

use std::path::{Path, PathBuf};

use crate::error::Error;

use super::vtu::escape;
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
        std::fs::remove_file(path).unwrap();
    }
}
