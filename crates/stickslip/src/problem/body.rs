use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::body::Formulation;
use crate::mesh::generators::Generator;

/// `[body.NAME]`: an elastic or rigid body: its mesh and what it is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Body {
    /// The `[material.NAME]` of all cells that are in none of the `regions`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Materials by cell set of the mesh: `regions.coat = "bronze"`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, String>,
    /// Whether the body is rigid: it moves and turns as a whole, with the mass and the moments of inertia of its mesh and `density`,
    /// which it must have. It may touch, be loaded, hang on springs and be supported like any other.
    ///
    /// Its rotation is linearised about the start, as that of elastic bodies is, unless `rotation` says otherwise; above about 0.1 rad (`largest-rotation` in the
    /// summary) it shows. The stiffness of its material is still wanted: interfaces take their scale from it. A support of some
    /// of its points must hold each of its motions fully or not at all, so that a point off the centre of mass is no support. Around
    /// an axis it moves along y alone.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rigid: bool,
    /// How far the body may turn.
    #[serde(default, skip_serializing_if = "BodyRotation::is_small")]
    pub rotation: BodyRotation,
    /// Element formulation.
    #[serde(default)]
    pub formulation: Formulation,
    /// Factor on the coordinates of the mesh, applied before `translate`: 1e-3 for a mesh in mm and a problem in m.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default = "one")]
    pub scale: f64,
    /// Shift of the mesh `[length]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translate: Option<Vec<f64>>,
    /// Damping of its own in dynamic steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rayleigh: Option<Rayleigh>,
    /// Where the mesh comes from.
    #[serde(flatten)]
    pub mesh: MeshSource,
}

/// How far a body may turn.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum BodyRotation {
    /// By a few degrees: displacements and rotations are those of the linear theory.
    #[default]
    Small,
    /// By any angle, freely, in motion and at rest: the body has a frame of its own, which fits its points best, and strains are small in it. Supports hold its points
    /// altogether or not at all. At rest systems are solved sparse. An implicit scheme keeps the angular momentum where it is `generalised-alpha` with `rho = 1`, and central
    /// differences do; numerical dissipation takes spin as it does vibration. A rigid body turns with its moments of inertia; its supports hold its motions as wholes.
    Large,
    /// By any angle, cell by cell: each cell has a frame of its own, which fits its points best, and strains are small in it, so that the body may bend as far as it
    /// likes. Supports, springs, couplings and contact act on it as on any other body. Quasi-static steps; systems are solved sparse, with a matrix that is made and
    /// factored anew in most iterations.
    Corotational,
    /// By any angle, with the `[reference.NAME]` that is named: `rotation.with = "axle"`. The body is described in a frame that the reference point carries, and
    /// strains are small in it. Supports of its sets act along the axes of the frame: they hold the body *on the axle*; the axle itself is supported and turned
    /// at the reference point. What the body presses on, and loads unless they `follow`, are in space. In quasi-static steps. A rigid body needs no supports of its own,
    /// and moves in dynamic steps as well: a reference point that is held in all directions is a hinge. Off its centre of mass it has to be.
    With(String),
}

impl BodyRotation {
    /// Whether it is that of the linear theory.
    pub fn is_small(&self) -> bool {
        *self == BodyRotation::Small
    }

    /// The reference point that it turns with.
    pub fn reference(&self) -> Option<&str> {
        match self {
            BodyRotation::Small | BodyRotation::Large | BodyRotation::Corotational => None,
            BodyRotation::With(name) => Some(name),
        }
    }
}

fn one() -> f64 {
    1.0
}

/// Rayleigh damping `C = mass M + stiffness K`: the damping ratio at the angular frequency ω is `mass / (2 ω) + stiffness ω / 2`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Rayleigh {
    /// Factor of the mass matrix `[1/time]`.
    #[cfg_attr(feature = "schema", schemars(range(min = 0)))]
    pub mass: f64,
    /// Factor of the stiffness matrix `[time]`.
    #[cfg_attr(feature = "schema", schemars(range(min = 0)))]
    pub stiffness: f64,
}

/// Where the mesh of a body comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum MeshSource {
    /// Built in: `generate.rectangle = { to = [0.04, 0.02], cells = [20, 10] }`.
    Generate(Generator),
    /// From a file of Gmsh: `.msh`, format 2.2 or 4.1, ASCII or binary.
    Gmsh(GmshFile),
    /// From arrays, in Python: a `stickslip.Mesh`.
    Mesh(GivenMesh),
}

/// A mesh that a program has in memory. Its sets are those of the body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct GivenMesh {
    /// The name by which the program gives it: `Problem.from_toml(FILE, meshes={"NAME": mesh})`.
    pub name: String,
    /// The cell set that is this body; all cells if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
}

/// A mesh file of Gmsh. Its physical groups become sets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct GmshFile {
    /// The file, relative to the folder of the problem file.
    pub file: PathBuf,
    /// The physical group of cells that is this body; all cells if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
}
