//! What is drawn: a problem file.

use super::body::Space;

/// A problem file and what is in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Draft {
    /// Its family.
    pub family: &'static str,
    /// In a line.
    pub words: String,
    /// The file.
    pub text: String,
}

/// The first tables of every problem.
pub(super) fn beginning(space: Space) -> String {
    format!(
        "format = 1\ntitle = \"@TITLE\"\n\n[model]\nspace = \"{}\"\n\n[output]\nevery = 1\n\n",
        space.name()
    )
}
