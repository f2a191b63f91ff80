use std::fmt;

/// Why a step could not be taken.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub enum Cause {
    /// Newton's iteration did not converge.
    NotConverged,
    /// Something became NaN or infinite.
    NotFinite,
    /// The matrix is singular: a body can move freely.
    Singular,
    /// The linear solver did not reach its tolerance.
    LinearSolver,
    /// The interior of condensed bodies, found from their surfaces, does not hold.
    Interior,
    /// A cell is inverted or collapsed.
    CollapsedCell,
    /// Two successive solutions are too far apart, or the local error is too large.
    TooFar,
    /// Contact reaches points that the solver did not provide for.
    Reach,
    /// Points change status, and the time at which they do is wanted more precisely.
    Event,
    /// There is not enough memory.
    Memory,
    /// The analysis was asked to stop.
    Interrupted,
    /// The engine that keeps the factors cannot go on.
    Engine,
}

/// A place to look at.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub struct Culprit {
    /// What and where: `point 17 of base at (0.1, 0, 0)`.
    pub place: String,
    /// What it did: `open → slip → open, gap 1.2e-6, force 3.1`.
    pub what: String,
    /// The same in numbers, where it is a point of an interface.
    pub evidence: Option<Box<Evidence>>,
}

/// What a point of an interface did in an attempt that failed, in numbers.
#[derive(Debug, Clone, PartialEq, Default, crate::keep::Keep)]
pub struct Evidence {
    /// The interface.
    pub interface: String,
    /// User's number of the node, where the point is one.
    pub node: Option<u64>,
    /// Points of the mesh that the point hangs on.
    pub points: Vec<usize>,
    /// Reference coordinates `[m]`.
    pub position: [f64; 3],
    /// Unit normal of the contact, out of the primary.
    pub normal: [f64; 3],
    /// Status changes in the attempt.
    pub flips: usize,
    /// Last statuses, oldest first: `open`, `stick`, `slip`.
    pub course: Vec<&'static str>,
    /// How often it has left the outer edge of the primary.
    pub left: usize,
    /// Relative slip over the increment `[m]`.
    pub slip: f64,
    /// Size of the facet it lies on `[m]`; zero where there is none.
    pub facet: f64,
    /// User's number of the cell behind that facet.
    pub cell: Option<u64>,
    /// Gap `[m]`.
    pub gap: f64,
    /// Pressure `[Pa]`.
    pub pressure: f64,
    /// Shear traction `[Pa]`.
    pub shear: f64,
    /// Largest shear traction that the interface carries there `[Pa]`.
    pub limit: f64,
    /// Ratio of the slopes of the normal law on both sides of a kink that lies between the last two evaluations; 1 where there is none.
    pub kink: f64,
}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)
    }
}

/// A step that could not be taken: why, who, and what to try. The stepper cuts back or gives up with it.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub struct StepFailure {
    /// The kind of failure.
    pub cause: Cause,
    /// In a sentence.
    pub message: String,
    /// Where to look, most suspect first.
    pub culprits: Vec<Culprit>,
    /// What to try.
    pub help: Option<String>,
    /// The dof at which a singular system was found out.
    pub dof: Option<usize>,
    /// What became of it when it was tried as a friction problem.
    pub otherwise: Option<Box<Otherwise>>,
}

/// What became of an increment as a friction problem, where that has failed as well.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub struct Otherwise {
    /// In a sentence: which problem, who came how far.
    pub message: String,
    /// The points that are to blame, most suspect first.
    pub culprits: Vec<Culprit>,
    /// What to try.
    pub help: String,
}

impl StepFailure {
    /// A failure without places.
    pub fn new(cause: Cause, message: impl Into<String>) -> Self {
        StepFailure {
            cause,
            message: message.into(),
            culprits: Vec::new(),
            help: None,
            dof: None,
            otherwise: None,
        }
    }

    /// Adds what to try.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// As the error that ends a run at time `t`.
    pub fn at(self, t: f64) -> crate::error::RunError {
        crate::error::RunError {
            message: self.message,
            time: t,
            culprits: self.culprits.iter().map(Culprit::to_string).collect(),
            help: self.help,
        }
    }
}
