//! How bad a finding is, and where to look.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::keep::Keep;
use crate::math::Vec3;
use crate::number::digits;

/// How bad it is.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, Keep,
)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Worth knowing.
    #[default]
    Note,
    /// Probably not what was meant, or an increment that had to be cut.
    Warning,
    /// The analysis cannot go on, or could not.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

/// What kind of thing is suspect.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Keep)]
#[serde(rename_all = "kebab-case")]
pub enum LocationKind {
    /// A node of a mesh, or a contact point that hangs on several.
    #[default]
    Node,
    /// A facet of a surface; its number is that of the cell behind it.
    Facet,
    /// A cell.
    Cell,
    /// A body.
    Body,
    /// An interface.
    Interface,
    /// A key of the problem file.
    Key,
}

impl fmt::Display for LocationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            LocationKind::Node => "node",
            LocationKind::Facet => "facet",
            LocationKind::Cell => "cell",
            LocationKind::Body => "body",
            LocationKind::Interface => "interface",
            LocationKind::Key => "key",
        })
    }
}

/// A place to look at.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Suspect {
    /// What it is.
    pub what: LocationKind,
    /// Name of the body, interface or key; of a node, facet or cell what it belongs to.
    pub name: String,
    /// User's number of a node or cell.
    #[serde(default)]
    pub id: Option<u64>,
    /// The body, where there is one.
    #[serde(default)]
    pub body: Option<String>,
    /// The interface, where there is one.
    #[serde(default)]
    pub interface: Option<String>,
    /// Reference coordinates `[m]`.
    #[serde(default)]
    pub position: Option<Vec3>,
    /// What it did or what it is like.
    #[serde(default)]
    pub remark: String,
}

impl Suspect {
    /// A body.
    pub fn body(name: &str, remark: impl Into<String>) -> Self {
        Suspect {
            what: LocationKind::Body,
            name: name.to_string(),
            body: Some(name.to_string()),
            remark: remark.into(),
            ..Suspect::default()
        }
    }

    /// An interface.
    pub fn interface(name: &str, remark: impl Into<String>) -> Self {
        Suspect {
            what: LocationKind::Interface,
            name: name.to_string(),
            interface: Some(name.to_string()),
            remark: remark.into(),
            ..Suspect::default()
        }
    }

    /// A key of the problem file.
    pub fn key(name: impl Into<String>, remark: impl Into<String>) -> Self {
        Suspect {
            what: LocationKind::Key,
            name: name.into(),
            remark: remark.into(),
            ..Suspect::default()
        }
    }

    /// The same at a place; one that is not finite is none.
    pub fn at(mut self, position: Vec3) -> Self {
        self.position = position.iter().all(|x| x.is_finite()).then_some(position);
        self
    }
}

impl fmt::Display for Suspect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.what)?;
        match self.id {
            Some(id) => write!(f, " {id} of {}", self.name)?,
            None => write!(f, " {}", self.name)?,
        }
        if let Some([x, y, z]) = self.position {
            write!(
                f,
                " at ({x}, {y}, {z})",
                x = digits(x, 5),
                y = digits(y, 5),
                z = digits(z, 5)
            )?;
        }
        match self.remark.as_str() {
            "" => Ok(()),
            remark => write!(f, ": {remark}"),
        }
    }
}
