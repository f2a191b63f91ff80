use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::roughness::Roughness;
use crate::contact::discretisation::{DiscretisationModel, NodeToFacet};
use crate::contact::enforcement::EnforcementModel;
use crate::contact::interface::{Start, Within};
use crate::contact::kinematics::KinematicsModel;
use crate::contact::law::damping::DampingModel;
use crate::contact::law::friction::FrictionModel;
use crate::contact::law::normal::NormalModel;
use crate::contact::law::slip::SlipModel;
use crate::contact::law::wear::{Feedback, WearModel};

/// `[interface.NAME]`: two surfaces that may touch, and their laws.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Interface {
    /// The secondary (slave) surface, whose points may not penetrate the primary: `body.set` or a `[set.NAME]`. Choose the softer
    /// of the two; the more finely meshed one takes its place unless `roles` say otherwise.
    pub secondary: String,
    /// The surface that carries the normal: `body.set`, a `[set.NAME]`, or an obstacle.
    pub primary: String,
    /// Whether the surfaces keep the roles they are named for.
    #[serde(default, skip_serializing_if = "by_mesh")]
    pub roles: Roles,
    /// How the surfaces resist being pressed together.
    #[serde(default)]
    pub normal: NormalModel,
    /// What resists surfaces while they approach or part.
    #[serde(default)]
    pub damping: DampingModel,
    /// How much shear the interface carries.
    #[serde(default)]
    pub friction: FrictionModel,
    /// How stick and slip change hands.
    #[serde(default)]
    pub slip: SlipModel,
    /// What sliding wears off the surfaces: the field CWEAR, and depth and volume in the history. What is worn off opens the gap, unless `wear-feedback`
    /// says otherwise.
    #[serde(default, skip_serializing_if = "WearModel::is_none")]
    pub wear: WearModel,
    /// Whether contact feels what is worn off.
    #[serde(default, skip_serializing_if = "implicit")]
    pub wear_feedback: Feedback,
    /// Result files `fields_*.vtu` of earlier runs of the same mesh that have worn this interface, relative to the folder of the problem file, the first run first: the points of both surfaces
    /// move into their bodies by the depths in them (`CWEAR`), along the normals that the surfaces had in that run, and depths count from zero again. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub worn: Vec<PathBuf>,
    /// Heights of the secondary surface above its mesh. Default: none, it is smooth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<Roughness>,
    /// How contact and stick are enforced.
    #[serde(default)]
    pub enforcement: EnforcementModel,
    /// Where contact is evaluated. Default: `mortar`; `node-to-facet` where the kinematics is `pop-1995` or facets are `triangles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub discretisation: Option<DiscretisationModel>,
    /// The two surfaces are glued together where they lie opposite at the start, nearer than half the height of a cell (or than
    /// `initial-tolerance` or `initial-distance` say), at the distance that they have there: neither gap nor slip changes, in tension too, and laws have no meaning. For meshes that do not match. Default: false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub tied: bool,
    /// How gap and slip are measured.
    #[serde(default)]
    pub kinematics: KinematicsModel,
    /// Velocity of the material of the primary surface beyond the motion of its body, such as a belt `[length/time]`,
    /// constant. Its normal component has no effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_velocity: Option<Vec<f64>>,
    /// The same over the time of the analysis, instead of `primary-velocity`: rows `[time, vx, vy]`, in 3D
    /// `[time, vx, vy, vz]`, linear in between, constant outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_velocity_table: Option<Vec<Vec<f64>>>,
    /// How quadrilateral facets of the primary are taken; as they are if not given, unless the kinematics needs
    /// triangles. Without meaning in 2D and on obstacles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<FacetShape>,
    /// What becomes of gaps and overlaps that the meshes have when the interface begins to act.
    #[serde(default, skip_serializing_if = "as_meshed")]
    pub initial: Start,
    /// Gap up to which `initial` takes hold of a point, as a fraction of the height of the cell beneath; a tenth if not given. Without
    /// meaning for `as-meshed` and `ramp`, unless the surfaces are `tied`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_tolerance: Option<f64>,
    /// The same as a length `[length]`, instead of `initial-tolerance`. `snap` moves points that overlap by more than that out as well, up to
    /// the height of the cell.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_distance: Option<f64>,
    /// What the gap counts as at the start where `initial = "offset"` takes hold of it `[length]`: a clearance, whatever the meshes say; below zero an
    /// overlap. Default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_gap: Option<f64>,
    /// Points to which `snap` is restricted: `body.set` or a `[set.NAME]`. Default: all of the secondary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_set: Option<String>,
}

fn by_mesh(roles: &Roles) -> bool {
    *roles == Roles::ByMesh
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
fn implicit(feedback: &Feedback) -> bool {
    *feedback == Feedback::Implicit
}

fn as_meshed(start: &Start) -> bool {
    *start == Start::AsMeshed
}

impl Interface {
    /// Whether pressure follows from the gap: its surfaces are held by no multiplier along the normal.
    pub fn is_compliant(&self) -> bool {
        self.normal.as_dyn().pressure(0.0).is_some() && !self.tied
    }

    /// How near points have to be at the start, if that is said.
    pub fn within(&self) -> Option<Within> {
        let distance = self.initial_distance.map(Within::Distance);
        distance.or(self.initial_tolerance.map(Within::Fraction))
    }

    /// Where contact is evaluated.
    pub fn discretisation(&self) -> DiscretisationModel {
        let by_points =
            self.kinematics.as_dyn().triangles() || self.facets == Some(FacetShape::Triangles);
        match &self.discretisation {
            Some(model) => model.clone(),
            None if by_points => DiscretisationModel::NodeToFacet(NodeToFacet {}),
            None => DiscretisationModel::default(),
        }
    }
}

/// Which of two surfaces is the secondary one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Roles {
    /// The points of the more finely meshed surface, if the cells of the other are larger by more than a quarter where the two are nearest to each other at the
    /// start; a note says so. Forces, slip and wear are reported as of the sides as they are named. Surfaces that are tied, two-sided or moved by
    /// `initial`, rigid primaries, and primaries that wear and have a `primary-velocity`, keep their roles.
    #[default]
    ByMesh,
    /// The points of the surface that is named secondary.
    AsNamed,
}

/// How quadrilateral facets of a primary surface are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FacetShape {
    /// As the bilinear (for quadratic cells: quadratic) surfaces that they are.
    Bilinear,
    /// Split into plane triangles.
    Triangles,
}
