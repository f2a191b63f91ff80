//! The causes that the doctor knows, one row each, and the findings made of them: plain data, for `summary.json`, for programs and for people.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::suspect::{Severity, Suspect};

/// Makes [`DoctorCause`] of rows: meaning, variant, name in files, and `mistake` where advice about how a model is solved does not help.
macro_rules! causes {
    ($($(#[doc = $meaning:literal])+ $cause:ident = $name:literal $($mistake:ident)?,)*) => {
        /// What is wrong.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum DoctorCause {
            $($(#[doc = $meaning])+ #[serde(rename = $name)] $cause,)*
        }

        impl DoctorCause {
            /// All causes, in the order of [`code`](DoctorCause::code).
            pub const ALL: &[DoctorCause] = &[$(DoctorCause::$cause),*];

            /// Whether it is a mistake in the model, so that advice about how it is solved does not help.
            pub fn is_mistake(self) -> bool {
                match self {
                    $(DoctorCause::$cause => causes!(@is $($mistake)?),)*
                }
            }

            /// Its name in files: `free-rigid-mode`.
            pub fn name(self) -> &'static str {
                match self {
                    $(DoctorCause::$cause => $name,)*
                }
            }
        }
    };
    (@is mistake) => { true };
    (@is) => { false };
}

causes! {
    /// A body can move as a whole: neither supports, nor springs, nor contact hold it.
    FreeRigidMode = "free-rigid-mode",
    /// Points go back and forth between open, stick and slip.
    Chatter = "chatter",
    /// Points slide off the outer edge of the primary and come back.
    LostProjection = "lost-projection",
    /// Points slide over a large part of a facet, or over several, in one increment.
    TooLargeSlip = "too-large-slip",
    /// The normal law has a kink between the states that the iteration goes back and forth between.
    LawTangentJump = "law-tangent-jump",
    /// A cell is inverted or has next to no volume.
    CollapsedCell = "collapsed-cell" mistake,
    /// The matrix is singular, or nearly so, although every body is held.
    NearSingularOperator = "near-singular-operator",
    /// Friction is larger than the limit up to which the solution is known to be unique.
    CoulombNonUniqueness = "coulomb-non-uniqueness",
    /// A linear system could not be solved to its tolerance.
    LinearSolver = "linear-solver",
    /// Something became NaN or infinite.
    NotFinite = "not-finite",
    /// Two successive solutions are too far apart, or the error of an increment is too large.
    TooFar = "too-far",
    /// A body slides or tips off as a whole: contact does not resist any more.
    SlidesAway = "slides-away",
    /// The iteration did not converge, for no reason that shows.
    NotConverged = "not-converged",
    /// Contact came to points that the solver had not provided for.
    BeyondReach = "beyond-reach",
    /// The run ended for a reason outside the increments.
    Stopped = "stopped",
    /// A body that contact has to hold does not touch anything, or an interface cannot close.
    InitialGap = "initial-gap",
    /// Surfaces overlap at the start.
    InitialOverlap = "initial-overlap",
    /// No point of the secondary has a facet of the primary opposite.
    NothingOpposite = "nothing-opposite",
    /// Secondary and primary do not face each other.
    NormalsNotOpposed = "normals-not-opposed" mistake,
    /// The cells of the two sides differ much in size.
    MeshMismatch = "mesh-mismatch",
    /// The primary is much softer than the secondary.
    SofterPrimary = "softer-primary",
    /// Numbers that do not go with one system of units.
    MixedUnits = "mixed-units" mistake,
    /// A coefficient of friction beyond what dry surfaces have.
    LargeFriction = "large-friction",
    /// An interface has friction, but nothing presses it together.
    FrictionWithoutPressure = "friction-without-pressure",
    /// The cells of a body do not hang together.
    DisconnectedBody = "disconnected-body",
    /// Nothing moves and nothing is loaded.
    NothingActs = "nothing-acts",
    /// A support holds the surface of contact itself.
    SupportOnContact = "support-on-contact",
    /// A load acts on the surface of contact itself.
    LoadOnContact = "load-on-contact",
    /// Two interfaces join the same surfaces at the same time.
    DoubledInterface = "doubled-interface" mistake,
    /// A factor jumps faster than increments can follow.
    SuddenChange = "sudden-change",
    /// The largest value of an amplitude lies beyond the end of the analysis.
    AmplitudeUnused = "amplitude-unused",
    /// A normal law is far softer or stiffer than the bodies, or wear faster than that of any surface.
    LawOutOfRange = "law-out-of-range" mistake,
    /// A function that is used as a law gives what no law can.
    FaultyLaw = "faulty-law" mistake,
    /// What is prescribed strains bodies more than small strains allow.
    LargeStrain = "large-strain" mistake,
    /// All that is prescribed opens an interface.
    MovesApart = "moves-apart",
    /// A velocity comes near the speed of sound.
    TooFast = "too-fast" mistake,
    /// An interface carried nothing in the whole run.
    NeverCarried = "never-carried",
    /// Fewer than three points across are in contact.
    CoarseContact = "coarse-contact",
    /// Straight facets stand off curved surfaces by a good part of their overlap.
    CoarseFacets = "coarse-facets",
    /// Surfaces have turned since the start, and small sliding does not know of it.
    TurnedNormals = "turned-normals",
    /// A body has moved by more than the size of the model.
    FarAway = "far-away",
    /// A nearly incompressible body of cells that lock.
    Locking = "locking",
    /// Bodies that no interface joins touch or pass through each other.
    MissingInterface = "missing-interface",
    /// A body is held or loaded less than in the step before.
    LetGo = "let-go",
    /// A table of the problem file that nothing uses.
    Unused = "unused",
    /// What is worn off is no small change of the surface.
    DeepWear = "deep-wear",
    /// Wear is explicit, and stable in short increments only.
    ExplicitWear = "explicit-wear",
    /// A bolt that holds nothing: it is pushed apart, or drawn together with next to nothing.
    LooseBolt = "loose-bolt" mistake,
    /// Roughness with waves that are too short for the contact points.
    UnresolvedRoughness = "unresolved-roughness",
    /// Temperatures are given, and the temperature at the start is not.
    StartTemperature = "start-temperature",
    /// Contact ended because what carried has left the primary over its edge.
    LeftPrimary = "left-primary",
    /// A rotation is prescribed that is no small one.
    LargeRotation = "large-rotation",
}

impl DoctorCause {
    /// Its number in `culprits.vtu`, from 1.
    pub fn code(self) -> usize {
        let at = Self::ALL.iter().position(|&cause| cause == self);
        at.map_or(0, |i| i + 1)
    }

    /// A finding that is worth knowing.
    pub(crate) fn note(self, message: impl Into<String>) -> Finding {
        Finding::new(self, Severity::Note, message)
    }

    /// A finding of what was probably not meant.
    pub(crate) fn warning(self, message: impl Into<String>) -> Finding {
        Finding::new(self, Severity::Warning, message)
    }

    /// A finding for which the analysis cannot go on.
    pub(crate) fn error(self, message: impl Into<String>) -> Finding {
        Finding::new(self, Severity::Error, message)
    }
}

impl fmt::Display for DoctorCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

stickslip_base::keep_by_name!(DoctorCause, one of DoctorCause::ALL, by |cause| cause.name());

/// Most places of one finding.
pub const MOST_SUSPECTS: usize = 10;

/// A finding of the doctor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Finding {
    /// What is wrong.
    pub cause: DoctorCause,
    /// How bad it is.
    pub severity: Severity,
    /// In a sentence without a final stop.
    pub message: String,
    /// Where to look, most suspect first; ten at most.
    pub suspects: Vec<Suspect>,
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
            suspects: Vec::new(),
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
            Cause::DeepWear,
            Cause::Locking,
        ];
        // An increment that was cut is of a step.
        let warned = self.severity >= Severity::Warning && self.step.is_none();
        self.cause == Cause::MissingInterface || warned && !about_mesh.contains(&self.cause)
    }

    /// Adds a place, if there is room.
    pub fn blame(mut self, suspect: Suspect) -> Self {
        if self.suspects.len() < MOST_SUSPECTS {
            self.suspects.push(suspect);
        }
        self
    }

    /// No more than a note unless it is serious.
    pub(crate) fn note_unless(mut self, serious: bool) -> Self {
        if !serious {
            self.severity = Severity::Note;
        }
        self
    }

    /// Adds places, as far as there is room.
    pub(crate) fn blame_all(self, suspects: impl IntoIterator<Item = Suspect>) -> Self {
        suspects.into_iter().fold(self, Finding::blame)
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
        for suspect in &self.suspects {
            write!(f, "\n  - {suspect}")?;
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
    use crate::keep::{Keep, Kept};

    #[test]
    fn every_cause_has_a_name_and_a_number_of_its_own() {
        let mut names: Vec<&str> = DoctorCause::ALL.iter().map(|c| c.name()).collect();
        assert_eq!(names[0], "free-rigid-mode");
        for (i, cause) in DoctorCause::ALL.iter().enumerate() {
            assert_eq!(cause.code(), i + 1);
        }
        names.sort();
        names.dedup();
        assert_eq!(names.len(), DoctorCause::ALL.len());
    }

    #[test]
    fn every_cause_comes_back_as_what_it_was() {
        for cause in DoctorCause::ALL {
            let mut bytes = Vec::new();
            cause.keep(&mut bytes);
            assert_eq!(DoctorCause::back(&mut Kept::new(&bytes)), Ok(*cause));
        }
    }

    #[test]
    fn every_cause_has_a_row_in_the_book() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../book/src/doctor.md");
        let page = std::fs::read_to_string(page).expect("the page of the doctor");
        for cause in DoctorCause::ALL {
            let row = format!("| {} | `{cause}` |", cause.code());
            assert!(page.contains(&row), "no row begins with {row}");
        }
    }

    #[test]
    fn findings_survive_their_file() {
        let finding = Finding::new(DoctorCause::Chatter, Severity::Warning, "back and forth")
            .blame(Suspect::interface("base", "").at([1.0, 2.0, 0.0]))
            .advise("smaller increments");
        let text = serde_json::to_string(&finding).expect("plain data");
        let back: Finding = serde_json::from_str(&text).expect("its own text");
        assert_eq!(back, finding);
        assert!(text.contains("\"chatter\""), "{text}");
    }
}
