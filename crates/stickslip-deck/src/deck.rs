//! What a deck says, card by card, before it is translated.

use std::collections::BTreeMap;
use std::path::PathBuf;

use stickslip::io::frd::Encoding;
use stickslip::results::Quantity;

pub use crate::axes::{Local, Transform};
use crate::card::{Data, Place};
use crate::finding::Finding;
use crate::numbering::Numbering;
use crate::taken::Taken;

/// A deck that was read. Names are in capitals, as both programs take them, unless they were quoted.
#[derive(Debug, Clone, Default)]
pub struct Deck {
    /// Which files are read and written.
    pub output: FileOutput,
    /// How numbers of instances of parts become numbers of the deck.
    pub numbering: Numbering,
    /// Nodes by number.
    pub nodes: BTreeMap<u64, [f64; 3]>,
    /// Elements by number.
    pub elements: BTreeMap<u64, Element>,
    /// Sets of nodes, in the order of the file without repetitions.
    pub node_sets: BTreeMap<String, Vec<u64>>,
    /// Sets of elements.
    pub element_sets: BTreeMap<String, Vec<u64>>,
    /// Surfaces.
    pub surfaces: BTreeMap<String, Surface>,
    /// What elements are made of, and along which axes.
    pub properties: Properties,
    /// Functions and points of time.
    pub tables: TimeTables,
    /// What touches.
    pub contact: ContactCards,
    /// What joins nodes and surfaces, and what hangs on them.
    pub connectors: Connectors,
    /// How the analysis begins.
    pub start: StartCards,
    /// `*BOUNDARY` before the first step, which acts as if it stood in that.
    pub supports: Vec<Boundary>,
    /// The steps.
    pub steps: Vec<Step>,
    /// Warnings and notes, in the order of the lines.
    pub notes: Vec<Finding>,
    /// Names that nothing uses.
    pub(crate) unused: Vec<(Place, String)>,
}

/// What joins nodes and surfaces, and what hangs on them.
#[derive(Debug, Clone, Default)]
pub struct Connectors {
    /// `*TIE`s.
    pub ties: Vec<Tie>,
    /// `*EQUATION`s.
    pub equations: Vec<Equation>,
    /// `*RIGID BODY`s.
    pub rigid: Vec<Rigid>,
    /// `*PRE-TENSION SECTION`s.
    pub pretensions: Vec<Pretension>,
    /// `*COUPLING`s, old and new.
    pub couplings: Vec<NodeCoupling>,
    /// `*MPC`s.
    pub constraints: Vec<MultiPoint>,
    /// `*SPRING`s: stiffness of sets of spring elements.
    pub springs: Vec<SpringSection>,
    /// `*DASHPOT`s: coefficients of sets of dashpot elements.
    pub dashpots: Vec<SpringSection>,
    /// `*GAP`s.
    pub gaps: Vec<GapSection>,
    /// `*MASS`es: mass of sets of mass elements, each `(set, mass, place)`.
    pub masses: Vec<(String, f64, Place)>,
}

/// What touches, and with which laws.
#[derive(Debug, Clone, Default)]
pub struct ContactCards {
    /// `*SURFACE INTERACTION`s.
    pub interactions: BTreeMap<String, Interaction>,
    /// `*CONTACT PAIR`s.
    pub pairs: Vec<Pair>,
    /// `*CLEARANCE`s.
    pub clearances: Vec<Clearance>,
}

/// What elements are made of, and along which axes.
#[derive(Debug, Clone, Default)]
pub struct Properties {
    /// Materials.
    pub materials: BTreeMap<String, Material>,
    /// `*SOLID SECTION`s.
    pub sections: Vec<Section>,
    /// `*ORIENTATION`s.
    pub orientations: BTreeMap<String, Orientation>,
    /// `*DISTRIBUTION`s.
    pub distributions: BTreeMap<String, Distribution>,
    /// `*TRANSFORM`s by node; the last card counts.
    pub transforms: BTreeMap<u64, Transform>,
}

/// How the analysis begins.
#[derive(Debug, Clone, Default)]
pub struct StartCards {
    /// `*INITIAL CONDITIONS`.
    pub initial: Vec<InitialCondition>,
    /// `*INITIAL CONDITIONS` of temperature, in the order of the deck: the last counts at a node.
    pub temperatures: Vec<Temperature>,
}

/// Functions and points of time, by name.
#[derive(Debug, Clone, Default)]
pub struct TimeTables {
    /// `*AMPLITUDE`s.
    pub amplitudes: BTreeMap<String, Amplitude>,
    /// `*TIME POINTS` by name.
    pub time_points: BTreeMap<String, TimePoints>,
}

/// The files that a deck is read from, and what is written.
#[derive(Debug, Clone, Default)]
pub struct FileOutput {
    /// The file and those it includes.
    pub files: Vec<PathBuf>,
    /// How the `.frd` file is written; `None` if nothing asks for one.
    pub frd: Option<Encoding>,
    /// The text of `*HEADING`, its first line.
    pub title: Option<String>,
}

impl Deck {
    /// The pretension whose shortening is the first direction of a node.
    pub fn pretension(&self, node: u64) -> Option<&Pretension> {
        self.connectors.pretensions.iter().find(|p| p.node == node)
    }

    /// A number of a node or element as the deck writes it: `PART-1-1.12` in an instance.
    pub fn label(&self, number: u64) -> String {
        self.numbering.label(number)
    }

    /// Adds to what changes in the last step.
    pub(crate) fn act(&mut self, action: Action) {
        if let Some(step) = self.steps.last_mut() {
            step.actions.push(action);
        }
    }
}

/// An element.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Its type as written, in capitals: `C3D8R`.
    pub kind: String,
    /// Its nodes in the order of the deck.
    pub nodes: Vec<u64>,
    /// Where.
    pub place: Place,
}

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// What it consists of.
    pub parts: SurfaceParts,
    /// Where.
    pub place: Place,
}

/// What a surface consists of.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceParts {
    /// Faces: element and number of the face, from 1; `None` is every face on the outside (Abaqus).
    Faces(Vec<(u64, Option<usize>)>),
    /// Nodes.
    Nodes(Vec<u64>),
}

/// A material.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Material {
    /// Elastic constants at the first temperature.
    pub elastic: Option<Elastic>,
    /// Elastic constants by temperature, in the order of the deck.
    pub elastic_at: Vec<(f64, Elastic)>,
    /// Mass per volume at the first temperature.
    pub density: Option<f64>,
    /// Mass per volume by temperature, in the order of the deck.
    pub density_at: Vec<(f64, f64)>,
    /// Rayleigh damping: factors of mass and stiffness.
    pub damping: Option<[f64; 2]>,
    /// Thermal expansion.
    pub expansion: Option<Expansion>,
    /// Where.
    pub place: Place,
}

/// `*ELASTIC` at a temperature.
#[derive(Debug, Clone, PartialEq)]
pub enum Elastic {
    /// Young's modulus and Poisson's ratio.
    Isotropic([f64; 2]),
    /// E1, E2, E3, ν12, ν13, ν23, G12, G13, G23.
    Engineering([f64; 9]),
    /// The stiffness in the order 11 22 33 12 13 23, symmetric.
    Full(Box<[[f64; 6]; 6]>),
}

/// `*EXPANSION`.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// Temperature and one secant coefficient, or three along the axes of the material.
    pub rows: Vec<(f64, Vec<f64>)>,
    /// `ZERO`: the temperature at which the secants begin.
    pub zero: f64,
}

/// `*SOLID SECTION`.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Set of elements.
    pub set: String,
    /// Material.
    pub material: String,
    /// Orientation of the material.
    pub orientation: Option<String>,
    /// Thickness, where one is given.
    pub thickness: Option<f64>,
    /// Where.
    pub place: Place,
}

/// `*ORIENTATION`: the axes 1, 2 and 3 of the material.
#[derive(Debug, Clone, PartialEq)]
pub struct Orientation {
    /// Those of most elements.
    pub local: Local,
    /// Those of elements with axes of their own, by `*DISTRIBUTION`.
    pub elements: BTreeMap<u64, Local>,
    pub(crate) taken: Taken,
    /// Where.
    pub place: Place,
}

/// `*DISTRIBUTION`: points of axes by element; the first line is of all other elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    pub(crate) lines: Vec<DistributionLine>,
    /// Where.
    pub place: Place,
}

/// A line of a `*DISTRIBUTION`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DistributionLine {
    /// An element or a set of elements; none in the first line.
    pub elements: Option<Target>,
    /// Two points and the origin.
    pub points: [[f64; 3]; 3],
    pub data: Data,
}

/// `*AMPLITUDE`.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    /// Rows of time and factor.
    pub rows: Vec<[f64; 2]>,
    /// Time is that of the analysis, not of the step.
    pub total_time: bool,
    /// Where.
    pub place: Place,
}

/// `*SURFACE INTERACTION` with the cards beneath.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interaction {
    /// How it resists being pressed.
    pub behavior: Option<Behavior>,
    /// Friction.
    pub friction: Option<Friction>,
    /// Viscous damping coefficient: pressure per closing velocity, and fraction in tangential direction.
    pub damping: Option<[f64; 2]>,
    /// Where.
    pub place: Place,
}

/// `*SURFACE BEHAVIOR`.
#[derive(Debug, Clone, PartialEq)]
pub enum Behavior {
    /// `HARD`.
    Hard,
    /// `LINEAR`: stiffness per area; tension at large clearances (CalculiX, node to face), 0 if not given.
    Linear {
        /// Stiffness per area.
        slope: f64,
        /// Tension at large clearances.
        tension: f64,
    },
    /// `EXPONENTIAL`: clearance at which the pressure is a hundredth (CalculiX; 0 in Abaqus), pressure at none.
    Exponential {
        /// Clearance.
        c0: f64,
        /// Pressure at zero clearance.
        p0: f64,
    },
    /// `TABULAR`: rows of overclosure and pressure.
    Tabular(Vec<[f64; 2]>),
    /// `TIED`: the surfaces are glued, by springs of this stiffness per area if one is given.
    Tied(Option<f64>),
}

/// `*FRICTION`.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// Coefficient.
    pub mu: f64,
    /// Stiffness of sticking per area (CalculiX), if given.
    pub stick: Option<f64>,
    /// Largest shear stress (Abaqus `TAUMAX`).
    pub cap: Option<f64>,
    /// Kinetic coefficient and decay (Abaqus `EXPONENTIAL DECAY`).
    pub decay: Option<[f64; 2]>,
    /// `ROUGH`: sticks whatever the pressure.
    pub rough: bool,
    /// Rows of coefficient, slip rate and pressure, where it depends on them (Abaqus); empty otherwise.
    pub table: Vec<[f64; 3]>,
}

/// `*CONTACT PAIR`.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Slave surface, our secondary.
    pub slave: String,
    /// Master surface, our primary.
    pub master: String,
    /// `*SURFACE INTERACTION`.
    pub interaction: String,
    /// `NODE TO SURFACE`.
    pub by_nodes: bool,
    /// `SMALL SLIDING`.
    pub small_sliding: bool,
    /// `ADJUST`: which nodes of the slave surface are moved onto the master.
    pub adjust: Option<Adjust>,
    /// Where.
    pub place: Place,
}

/// `ADJUST` of a `*CONTACT PAIR`.
#[derive(Debug, Clone, PartialEq)]
pub enum Adjust {
    /// Those that are no farther than this from it, and those that overlap.
    Within(f64),
    /// Those of a set of nodes, however far.
    Set(String),
}

/// `*CLEARANCE`.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// Slave surface.
    pub slave: String,
    /// Master surface.
    pub master: String,
    /// The uniform clearance.
    pub value: f64,
    /// Where.
    pub place: Place,
}

/// `*TIE`.
#[derive(Debug, Clone, PartialEq)]
pub struct Tie {
    /// Name.
    pub name: String,
    /// Slave surface.
    pub slave: String,
    /// Master surface.
    pub master: String,
    /// `POSITION TOLERANCE`: nodes farther than this from the master stay free.
    pub tolerance: Option<f64>,
    /// Nodes that are tied are moved onto the master before, unless `ADJUST=NO`.
    pub adjust: bool,
    /// Where.
    pub place: Place,
}

/// Nodes a card is about.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// One, by number.
    One(u64),
    /// A set.
    Set(String),
}

/// A term of an `*EQUATION`.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Its nodes.
    pub target: Target,
    /// Direction, 0 to 5.
    pub component: usize,
    /// Factor.
    pub factor: f64,
}

/// `*EQUATION`: the sum of the terms is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// Its terms.
    pub terms: Vec<Term>,
    /// Where.
    pub place: Place,
}

/// `*RIGID BODY`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rigid {
    /// Set of its elements.
    pub elements: Option<String>,
    /// Set of its nodes.
    pub nodes: Option<String>,
    /// Node of its translations.
    pub reference: Option<u64>,
    /// Node of its rotations (CalculiX).
    pub rotation: Option<u64>,
    /// Where.
    pub place: Place,
}

/// `*GAP`.
#[derive(Debug, Clone, PartialEq)]
pub struct GapSection {
    /// Set of gap elements.
    pub set: String,
    /// How far they are open.
    pub clearance: f64,
    /// Along which they open, from the first node to the second; of length one, or zero for the line between them.
    pub direction: [f64; 3],
    /// Stiffness once they are closed (CalculiX), if given.
    pub stiffness: Option<f64>,
    /// Where.
    pub place: Place,
}

/// Nodes tied to a reference node: `*COUPLING`, `*KINEMATIC COUPLING`, `*DISTRIBUTING COUPLING`.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeCoupling {
    /// Its name.
    pub name: String,
    /// The reference node.
    pub reference: u64,
    /// What is tied to it.
    pub tied: Tied,
    /// How; `None` as long as neither `*KINEMATIC` nor `*DISTRIBUTING` has said it.
    pub way: Option<Way>,
    /// Directions 1 to 6 in which it ties.
    pub components: [bool; 6],
    /// The `*ORIENTATION` of the directions.
    pub orientation: Option<String>,
    /// Where.
    pub place: Place,
}

/// `*PRE-TENSION SECTION`: a cut along faces inside a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Pretension {
    /// Surface of the faces.
    pub surface: String,
    /// Node whose first direction is the shortening.
    pub node: u64,
    /// Normal; the mean one of the faces if none is given.
    pub normal: Option<[f64; 3]>,
    /// Where.
    pub place: Place,
}

/// What is tied to a reference node.
#[derive(Debug, Clone, PartialEq)]
pub enum Tied {
    /// A surface.
    Surface(String),
    /// Nodes with their weights.
    Nodes(Vec<(Target, f64)>),
}

/// How nodes are tied to a reference node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// They follow it.
    Kinematic,
    /// It follows their mean.
    Distributing,
}

/// `*MPC`.
#[derive(Debug, Clone, PartialEq)]
pub struct MultiPoint {
    /// The type, in capitals.
    pub kind: String,
    /// Its nodes in the order of the deck.
    pub nodes: Vec<u64>,
    /// Where.
    pub place: Place,
}

/// `*SPRING` or `*DASHPOT`.
#[derive(Debug, Clone, PartialEq)]
pub struct SpringSection {
    /// Set of spring elements.
    pub set: String,
    /// Directions at the first and second node, 0 to 2 (`SPRING1`, `SPRING2`).
    pub directions: Vec<usize>,
    /// Stiffness, or force per velocity.
    pub stiffness: f64,
    /// Where.
    pub place: Place,
}

/// `*INITIAL CONDITIONS` of displacement or velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialCondition {
    /// Velocity, otherwise displacement.
    pub velocity: bool,
    /// Nodes.
    pub target: Target,
    /// Direction, 0 to 2.
    pub component: usize,
    /// Value.
    pub value: f64,
    /// Where.
    pub place: Place,
}

/// A line of `*TEMPERATURE`, or of `*INITIAL CONDITIONS` of temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Temperature {
    /// Nodes.
    pub target: Target,
    /// Temperature.
    pub value: f64,
    /// Where.
    pub place: Place,
}

/// A line of `*BOUNDARY`.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Nodes.
    pub target: Target,
    /// Directions, 0 to 5 (from 3: rotations).
    pub components: Vec<usize>,
    /// Value.
    pub value: f64,
    /// Amplitude.
    pub amplitude: Option<String>,
    /// `FIXED`: held where it is.
    pub fixed: bool,
    /// Where.
    pub place: Place,
}

/// A step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// `NLGEOM`.
    pub nonlinear: bool,
    /// `PERTURBATION`.
    pub perturbation: bool,
    /// Loads without amplitude act in full from the start; `None` is the default of the procedure.
    pub abrupt: Option<bool>,
    /// How it is solved.
    pub procedure: Procedure,
    /// `*MODAL DAMPING`.
    pub damping: ModalDamping,
    /// Its cards in order.
    pub actions: Vec<Action>,
    /// What is printed.
    pub prints: Vec<Print>,
    /// What is written to the `.frd` file.
    pub filed: Vec<Filed>,
    /// Increments between outputs of fields; `None` if none are asked for.
    pub output_every: Option<usize>,
    /// `*TIME POINTS` of outputs.
    pub output_times: Vec<String>,
    /// Where.
    pub place: Place,
}

/// `*MODAL DAMPING`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModalDamping {
    /// Ratios by mode, from the first on; those behind have none.
    pub ratios: Vec<f64>,
    /// `RAYLEIGH`: relative to mass and stiffness.
    pub rayleigh: [f64; 2],
}

/// How a step is solved. Times are `[initial increment, period, smallest, largest]`, 0 for the default.
#[derive(Debug, Clone, PartialEq)]
pub enum Procedure {
    /// `*STATIC`.
    Static {
        /// Times.
        times: [f64; 4],
        /// `DIRECT`.
        direct: bool,
    },
    /// `*DYNAMIC`.
    Dynamic {
        /// Times.
        times: [f64; 4],
        /// `DIRECT`.
        direct: bool,
        /// `EXPLICIT`.
        explicit: bool,
        /// `ALPHA` of the method of Hilber, Hughes and Taylor.
        alpha: Option<f64>,
    },
    /// `*FREQUENCY`.
    Frequency {
        /// How many modes.
        count: usize,
        /// Lowest and highest frequency, 0 where not given.
        range: [f64; 2],
    },
    /// `*COMPLEX FREQUENCY` (Abaqus).
    ComplexFrequency {
        /// How many modes.
        count: usize,
        /// Highest frequency, 0 if not given.
        highest: f64,
        /// `FRICTION DAMPING`.
        friction_damping: bool,
    },
    /// `*STEADY STATE DYNAMICS`.
    Harmonic {
        /// Lowest and highest frequency.
        range: [f64; 2],
        /// How many frequencies from a mode to the next, both counted; over the whole range where there is no bias.
        points: usize,
        /// How much they crowd at the modes.
        bias: Option<f64>,
    },
}

impl Step {
    /// Whether inertia has a part in it.
    pub fn is_dynamic(&self) -> bool {
        matches!(self.procedure, Procedure::Dynamic { .. })
    }

    /// Whether it looks for modes or superposes them, and nothing moves in it.
    pub fn is_modal(&self) -> bool {
        self.procedure.is_modal()
    }

    /// Whether its loads shake.
    pub fn is_harmonic(&self) -> bool {
        matches!(self.procedure, Procedure::Harmonic { .. })
    }
}

impl Procedure {
    /// Whether it is about small vibrations, and takes no time.
    pub fn is_modal(&self) -> bool {
        !matches!(self, Procedure::Static { .. } | Procedure::Dynamic { .. })
    }
}

impl Default for Procedure {
    fn default() -> Self {
        Procedure::Static {
            times: [0.0; 4],
            direct: false,
        }
    }
}

/// What changes in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// `OP=NEW` on `*BOUNDARY`.
    ClearBoundaries,
    /// A line of `*BOUNDARY`.
    Boundary(Boundary),
    /// `OP=NEW` on `*CLOAD`.
    ClearForces,
    /// A line of `*CLOAD`.
    Force {
        /// Nodes.
        target: Target,
        /// Direction, 0 to 2.
        component: usize,
        /// Force.
        value: f64,
        /// Amplitude.
        amplitude: Option<String>,
        /// Whether it is the imaginary part of a load that shakes.
        imaginary: bool,
        /// Where.
        place: Place,
    },
    /// `OP=NEW` on `*TEMPERATURE`.
    ClearTemperatures,
    /// A line of `*TEMPERATURE`.
    Temperature {
        /// Nodes and temperature.
        of: Temperature,
        /// Amplitude.
        amplitude: Option<String>,
    },
    /// `OP=NEW` on `*DLOAD` or `*DSLOAD`.
    ClearDistributed,
    /// A line of `*DLOAD` or `*DSLOAD`.
    Distributed {
        /// What.
        load: Distributed,
        /// Amplitude.
        amplitude: Option<String>,
        /// Whether it is the imaginary part of a load that shakes.
        imaginary: bool,
        /// Where.
        place: Place,
    },
    /// A line of `*MOTION`.
    Motion(MaterialMotion),
    /// `*CHANGE FRICTION`.
    ChangeFriction(String, Friction, Place),
    /// `*CHANGE SURFACE BEHAVIOR`.
    ChangeBehavior(String, Behavior, Place),
    /// `*MODEL CHANGE` of a contact pair.
    ChangePair {
        /// Slave surface.
        slave: String,
        /// Master surface.
        master: String,
        /// `ADD`, otherwise `REMOVE`.
        add: bool,
        /// Where.
        place: Place,
    },
    /// A line of `*EQUATION, REMOVE`; no nodes mean all equations.
    RemoveEquations {
        /// Nodes of the dependent, first terms.
        target: Option<Target>,
        /// Their directions, 0 to 2.
        components: Vec<usize>,
        /// Where.
        place: Place,
    },
}

/// A line of `*MOTION`: material that runs through the mesh at nodes (Abaqus).
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialMotion {
    /// Nodes.
    pub target: Target,
    /// How fast, and which way.
    pub velocity: MaterialVelocity,
    /// Where.
    pub place: Place,
}

/// Velocity of material that runs through the mesh.
#[derive(Debug, Clone, PartialEq)]
pub enum MaterialVelocity {
    /// Along directions, 0 to 2.
    Along(Vec<usize>, f64),
    /// About an axis: a point of it, angular velocity.
    About([f64; 3], [f64; 3]),
}

/// A distributed load.
#[derive(Debug, Clone, PartialEq)]
pub enum Distributed {
    /// Pressure on faces: element and number of the face.
    Pressure(Vec<(u64, usize)>, f64),
    /// Pressure on a surface.
    Surface(String, f64),
    /// Weight: elements and the name they were given by, size of the acceleration, its direction of length one.
    Gravity(Vec<u64>, String, f64, [f64; 3]),
    /// Elements and the name they were given by, square of the angular speed, a point of the axis, its direction.
    Centrifugal(Vec<u64>, String, f64, [f64; 3], [f64; 3]),
    /// Force per volume along an axis, 0 to 2: elements, axis, force.
    Body(Vec<u64>, usize, f64),
}

/// Which totals are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Totals {
    /// None.
    #[default]
    No,
    /// Besides.
    Yes,
    /// Alone.
    Only,
}

/// `*TIME POINTS`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimePoints {
    /// The times.
    pub times: Vec<f64>,
    /// Times are those of the analysis, not of the step.
    pub total_time: bool,
}

/// When something is printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum When {
    /// Every so many increments, and at the end of the step.
    Every(usize),
    /// At the times of `*TIME POINTS`.
    Times(String),
}

/// `*NODE FILE`, `*EL FILE`, `*CONTACT FILE`, and the same with `OUTPUT`: fields in the `.frd` file.
#[derive(Debug, Clone, PartialEq)]
pub struct Filed {
    /// What has the fields.
    pub of: FieldsOf,
    /// Quantities.
    pub quantities: Vec<Quantity>,
    /// When.
    pub when: When,
}

/// What fields are asked for of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FieldsOf {
    /// `*NODE …`
    Nodes,
    /// `*EL …`, `*ELEMENT …`
    Elements,
    /// `*CONTACT …`
    Contact,
}

/// `*NODE PRINT`, `*EL PRINT`, `*CONTACT PRINT`.
#[derive(Debug, Clone, PartialEq)]
pub enum Print {
    /// At nodes.
    Node {
        /// Set.
        set: String,
        /// Quantities.
        keys: Vec<String>,
        /// Totals.
        totals: Totals,
        /// In global axes where nodes have a `*TRANSFORM`; CalculiX prints along the local ones otherwise.
        global: bool,
        /// When.
        when: When,
    },
    /// At elements.
    Element {
        /// Set.
        set: String,
        /// Quantities.
        keys: Vec<String>,
        /// Totals.
        totals: Totals,
        /// In global axes where elements have an `*ORIENTATION`; CalculiX prints along the local ones otherwise.
        global: bool,
        /// When.
        when: When,
    },
    /// What a surface carries.
    Section {
        /// Surface.
        surface: String,
        /// When.
        when: When,
    },
    /// At contact points.
    Contact {
        /// Slave and master of the pair of `CF`.
        pair: Option<(String, String)>,
        /// Quantities.
        keys: Vec<String>,
        /// Totals.
        totals: Totals,
        /// When.
        when: When,
    },
}
