//! What the doctor found: plain data, for `summary.json`, for programs and for people.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::math::Vec3;

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DoctorCause {
    /// A body can move as a whole: neither supports, nor springs, nor contact hold it.
    FreeRigidMode,
    /// Points go to and fro between open, stick and slip.
    Chatter,
    /// Points slide off the outer edge of the primary and come back.
    LostProjection,
    /// Points slide over a large part of a facet, or over several, in one increment.
    TooLargeSlip,
    /// The normal law has a kink between the states that the iteration goes to and fro between.
    LawTangentJump,
    /// A cell is inverted or has next to no volume.
    CollapsedCell,
    /// The matrix is singular, or nearly so, although every body is held.
    NearSingularOperator,
    /// Friction is larger than the limit up to which the solution is known to be unique.
    CoulombNonUniqueness,
    /// A linear system could not be solved to its tolerance.
    LinearSolver,
    /// Something became NaN or infinite.
    NotFinite,
    /// Two successive solutions are too far apart, or the error of an increment is too large.
    TooFar,
    /// A body slides or tips off as a whole: contact does not resist any more.
    SlidesAway,
    /// The iteration did not converge, for no reason that shows.
    NotConverged,
    /// Contact came to points that the solver had not provided for.
    BeyondReach,
    /// The run ended for a reason outside the increments.
    Stopped,
    /// A body that contact has to hold does not touch anything, or an interface cannot close.
    InitialGap,
    /// Surfaces overlap at the start.
    InitialOverlap,
    /// No point of the secondary has a facet of the primary opposite.
    NothingOpposite,
    /// Secondary and primary do not face each other.
    NormalsNotOpposed,
    /// The cells of the two sides differ much in size.
    MeshMismatch,
    /// The primary is much softer than the secondary.
    SofterPrimary,
    /// Numbers that do not go with one system of units.
    MixedUnits,
    /// Supports prescribe different displacements for one point.
    ContradictingSupports,
    /// A coefficient of friction beyond what dry surfaces have.
    LargeFriction,
    /// An interface has friction, but nothing presses it together.
    FrictionWithoutPressure,
    /// The cells of a body do not hang together.
    DisconnectedBody,
    /// Nothing moves and nothing is loaded.
    NothingActs,
    /// A support holds the surface of contact itself.
    SupportOnContact,
    /// A load acts on the surface of contact itself.
    LoadOnContact,
    /// Two interfaces join the same surfaces at the same time.
    DoubledInterface,
    /// A factor jumps faster than increments can follow.
    SuddenChange,
    /// The largest value of an amplitude lies beyond the end of the analysis.
    AmplitudeUnused,
    /// A normal law is far softer or stiffer than the bodies.
    LawOutOfRange,
    /// A function that is used as a law gives what no law can.
    FaultyLaw,
    /// What is prescribed strains bodies more than small strains allow.
    LargeStrain,
    /// All that is prescribed opens an interface.
    MovesApart,
    /// A velocity comes near the speed of sound.
    TooFast,
    /// An interface carried nothing in the whole run.
    NeverCarried,
    /// Fewer than three points across are in contact.
    CoarseContact,
    /// Straight facets stand off curved surfaces by a good part of their overlap.
    CoarseFacets,
    /// Surfaces have turned since the start, and small sliding does not know of it.
    TurnedNormals,
    /// A body has moved by more than the size of the model.
    FarAway,
    /// A nearly incompressible body of cells that lock.
    Locking,
    /// Bodies that no interface joins touch or pass through each other.
    MissingInterface,
    /// A body is held or loaded less than in the step before.
    LetGo,
    /// A table of the problem file that nothing uses.
    Unused,
}

impl DoctorCause {
    /// All causes, in the order of [`code`](DoctorCause::code).
    pub const ALL: [DoctorCause; 46] = [
        DoctorCause::FreeRigidMode,
        DoctorCause::Chatter,
        DoctorCause::LostProjection,
        DoctorCause::TooLargeSlip,
        DoctorCause::LawTangentJump,
        DoctorCause::CollapsedCell,
        DoctorCause::NearSingularOperator,
        DoctorCause::CoulombNonUniqueness,
        DoctorCause::LinearSolver,
        DoctorCause::NotFinite,
        DoctorCause::TooFar,
        DoctorCause::SlidesAway,
        DoctorCause::NotConverged,
        DoctorCause::BeyondReach,
        DoctorCause::Stopped,
        DoctorCause::InitialGap,
        DoctorCause::InitialOverlap,
        DoctorCause::NothingOpposite,
        DoctorCause::NormalsNotOpposed,
        DoctorCause::MeshMismatch,
        DoctorCause::SofterPrimary,
        DoctorCause::MixedUnits,
        DoctorCause::ContradictingSupports,
        DoctorCause::LargeFriction,
        DoctorCause::FrictionWithoutPressure,
        DoctorCause::DisconnectedBody,
        DoctorCause::NothingActs,
        DoctorCause::SupportOnContact,
        DoctorCause::LoadOnContact,
        DoctorCause::DoubledInterface,
        DoctorCause::SuddenChange,
        DoctorCause::AmplitudeUnused,
        DoctorCause::LawOutOfRange,
        DoctorCause::FaultyLaw,
        DoctorCause::LargeStrain,
        DoctorCause::MovesApart,
        DoctorCause::TooFast,
        DoctorCause::NeverCarried,
        DoctorCause::CoarseContact,
        DoctorCause::CoarseFacets,
        DoctorCause::TurnedNormals,
        DoctorCause::FarAway,
        DoctorCause::Locking,
        DoctorCause::MissingInterface,
        DoctorCause::LetGo,
        DoctorCause::Unused,
    ];

    /// Whether it is a mistake in the model, so that advice about how it is solved does not help.
    pub fn is_mistake(self) -> bool {
        matches!(
            self,
            DoctorCause::CollapsedCell
                | DoctorCause::DoubledInterface
                | DoctorCause::LawOutOfRange
                | DoctorCause::FaultyLaw
                | DoctorCause::TooFast
                | DoctorCause::MixedUnits
                | DoctorCause::LargeStrain
                | DoctorCause::NormalsNotOpposed
        )
    }

    /// Its number in `culprits.vtu`, from 1.
    pub fn code(self) -> usize {
        let at = Self::ALL.iter().position(|&cause| cause == self);
        at.map_or(0, |i| i + 1)
    }

    /// Its name in files: `free-rigid-mode`.
    pub fn name(self) -> String {
        match serde_json::to_value(self) {
            Ok(serde_json::Value::String(name)) => name,
            _ => String::new(),
        }
    }
}

impl fmt::Display for DoctorCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name())
    }
}

/// How bad it is.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
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

/// What kind of thing is guilty.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum What {
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

impl fmt::Display for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            What::Node => "node",
            What::Facet => "facet",
            What::Cell => "cell",
            What::Body => "body",
            What::Interface => "interface",
            What::Key => "key",
        })
    }
}

/// A place to look at.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Guilty {
    /// What it is.
    pub what: What,
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

impl Guilty {
    /// A body.
    pub fn body(name: &str, remark: impl Into<String>) -> Self {
        Guilty {
            what: What::Body,
            name: name.to_string(),
            body: Some(name.to_string()),
            remark: remark.into(),
            ..Guilty::default()
        }
    }

    /// An interface.
    pub fn interface(name: &str, remark: impl Into<String>) -> Self {
        Guilty {
            what: What::Interface,
            name: name.to_string(),
            interface: Some(name.to_string()),
            remark: remark.into(),
            ..Guilty::default()
        }
    }

    /// A key of the problem file.
    pub fn key(name: impl Into<String>, remark: impl Into<String>) -> Self {
        Guilty {
            what: What::Key,
            name: name.into(),
            remark: remark.into(),
            ..Guilty::default()
        }
    }

    /// The same at a place; one that is not finite is none.
    pub fn at(mut self, position: Vec3) -> Self {
        self.position = position.iter().all(|x| x.is_finite()).then_some(position);
        self
    }
}

impl fmt::Display for Guilty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.what)?;
        match self.id {
            Some(id) => write!(f, " {id} of {}", self.name)?,
            None => write!(f, " {}", self.name)?,
        }
        if let Some([x, y, z]) = self.position {
            write!(f, " at ({x:.4e}, {y:.4e}, {z:.4e})")?;
        }
        match self.remark.as_str() {
            "" => Ok(()),
            remark => write!(f, ": {remark}"),
        }
    }
}

/// Most guilty places of one finding.
pub const MOST_GUILTY: usize = 10;

/// A finding of the doctor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Finding {
    /// What is wrong.
    pub cause: DoctorCause,
    /// How bad it is.
    pub severity: Severity,
    /// In a sentence without a final stop.
    pub message: String,
    /// Where to look, most guilty first; ten at most.
    pub guilty: Vec<Guilty>,
    /// What has been tried.
    #[serde(default)]
    pub tried: Vec<String>,
    /// What to try.
    #[serde(default)]
    pub advice: Vec<String>,
    /// The step; none before the run.
    #[serde(default)]
    pub step: Option<String>,
    /// Time reached when it happened `[the problem's unit of time]`; none before the run.
    #[serde(default)]
    pub time: Option<f64>,
}

impl Finding {
    /// A finding without places.
    pub fn new(cause: DoctorCause, severity: Severity, message: impl Into<String>) -> Self {
        Finding {
            cause,
            severity,
            message: message.into(),
            guilty: Vec::new(),
            tried: Vec::new(),
            advice: Vec::new(),
            step: None,
            time: None,
        }
    }

    /// Whether it says that the model is not what was meant, so that the outcome of the run is no question of how it was solved: a warning before an
    /// increment or after the last one, or bodies that nothing joins where they touch.
    pub(crate) fn explains(&self) -> bool {
        use DoctorCause as Cause;
        let about_mesh = [
            Cause::CoarseContact,
            Cause::CoarseFacets,
            Cause::MeshMismatch,
            Cause::TurnedNormals,
            Cause::Locking,
        ];
        // An increment that was cut is of a step.
        let warned = self.severity >= Severity::Warning && self.step.is_none();
        self.cause == Cause::MissingInterface || warned && !about_mesh.contains(&self.cause)
    }

    /// Adds a place, if there is room.
    pub fn blame(mut self, guilty: Guilty) -> Self {
        if self.guilty.len() < MOST_GUILTY {
            self.guilty.push(guilty);
        }
        self
    }

    /// Adds what to try.
    pub fn advise(mut self, advice: impl Into<String>) -> Self {
        self.advice.push(advice.into());
        self
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}): {}", self.severity, self.cause, self.message)?;
        for guilty in &self.guilty {
            write!(f, "\n  - {guilty}")?;
        }
        for tried in &self.tried {
            write!(f, "\n  tried: {tried}")?;
        }
        for advice in &self.advice {
            write!(f, "\n  try: {advice}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_has_a_name_and_a_number_of_its_own() {
        let mut names: Vec<String> = DoctorCause::ALL.iter().map(|c| c.name()).collect();
        assert_eq!(names[0], "free-rigid-mode");
        for (i, cause) in DoctorCause::ALL.iter().enumerate() {
            assert_eq!(cause.code(), i + 1);
        }
        names.sort();
        names.dedup();
        assert_eq!(names.len(), DoctorCause::ALL.len());
    }

    #[test]
    fn findings_survive_their_file() {
        let finding = Finding::new(DoctorCause::Chatter, Severity::Warning, "to and fro")
            .blame(Guilty::interface("base", "").at([1.0, 2.0, 0.0]))
            .advise("smaller increments");
        let text = serde_json::to_string(&finding).expect("plain data");
        let back: Finding = serde_json::from_str(&text).expect("its own text");
        assert_eq!(back, finding);
        assert!(text.contains("\"chatter\""), "{text}");
    }
}
