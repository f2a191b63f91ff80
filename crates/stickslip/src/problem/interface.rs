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

/// `[interface.NAME]`: a contact pair: two surfaces that may touch, and their laws.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Interface {
    /// The secondary (slave) surface, whose points may not penetrate the primary: `body.set` or a `[set.NAME]`. Choose the softer
    /// of the two; the more finely meshed one takes its place unless `roles` say otherwise.
    pub secondary: String,
    /// The primary (master) surface, which defines the normal: `body.set`, a `[set.NAME]`, or an obstacle.
    pub primary: String,
    /// Which surface has the contact points.
    #[serde(default, skip_serializing_if = "by_mesh")]
    pub roles: Roles,
    /// The normal law: pressure as a function of the gap.
    #[serde(default)]
    pub normal: NormalModel,
    /// Contact damping: pressure as a function of the closing velocity.
    #[serde(default)]
    pub damping: DampingModel,
    /// The friction law: the largest shear traction of the interface.
    #[serde(default)]
    pub friction: FrictionModel,
    /// The slip rule: shear traction as a function of relative motion.
    #[serde(default)]
    pub slip: SlipModel,
    /// The wear law: depth in the field CWEAR, depth and volume in the history. The worn depth opens the gap, unless `wear-feedback` says otherwise.
    #[serde(default, skip_serializing_if = "WearModel::is_none")]
    pub wear: WearModel,
    /// How the worn depth changes the gap.
    #[serde(default, skip_serializing_if = "implicit")]
    pub wear_feedback: Feedback,
    /// Result files `fields_*.vtu` of earlier runs of the same mesh that have worn this interface, relative to the folder of the problem file, the first run first: the points of both surfaces
    /// move into their bodies by the depths in them (`CWEAR`), along the normals that the surfaces had in that run, and depths count from zero again. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub worn: Vec<PathBuf>,
    /// Heights of the secondary surface above its mesh. Default: none, it is smooth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<Roughness>,
    /// How the contact and sticking constraints are enforced.
    #[serde(default)]
    pub enforcement: EnforcementModel,
    /// Where contact is evaluated. Default: `mortar`; `node-to-facet` where the kinematics is `pop-1995` or facets are `triangles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub discretisation: Option<DiscretisationModel>,
    /// Ties the surfaces where they lie opposite each other at the start, closer than half the height of a cell (or than `initial-tolerance` or
    /// `initial-distance`), at their initial distance: neither gap nor slip changes, in tension too, and contact laws have no effect. For meshes that do
    /// not match. Default: false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub tied: bool,
    /// How gap and slip are measured.
    #[serde(default)]
    pub kinematics: KinematicsModel,
    /// Velocity of the material of the primary surface relative to its body, such as a belt `[length/time]`, constant. Its normal component has no
    /// effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_velocity: Option<Vec<f64>>,
    /// Velocity over the time of the analysis, instead of `primary-velocity`: rows `[time, vx, vy]`, in 3D `[time, vx, vy, vz]`, linear in between,
    /// constant outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_velocity_table: Option<Vec<Vec<f64>>>,
    /// Geometry of quadrilateral facets of the primary. Default: bilinear, unless the kinematics needs triangles. Without effect in 2D and on obstacles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<FacetShape>,
    /// Treatment of initial gaps and overlaps of the meshes.
    #[serde(default, skip_serializing_if = "as_meshed")]
    pub initial: Start,
    /// Gap up to which `initial` applies to a point, as a fraction of the height of the cell beneath; a tenth if not given. Without effect for
    /// `as-meshed` and `ramp`, unless the surfaces are `tied`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_tolerance: Option<f64>,
    /// Tolerance as a length `[length]`, instead of `initial-tolerance`. `snap` also moves points that overlap by more, up to the height of the cell.
    #[cfg_attr(feature = "schema", schemars(extend("minimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_distance: Option<f64>,
    /// Gap at the start with `initial = "offset"` `[length]`: a clearance; negative for an overlap. Default: 0.
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
    /// The more finely meshed surface, if the cells of the other are more than a quarter larger where the two are nearest at the start; a note says so.
    /// Forces, slip and wear are reported for the sides as named. Surfaces that are tied, two-sided or moved by `initial`, rigid primaries, and wearing
    /// primaries with a `primary-velocity`, keep their roles.
    #[default]
    ByMesh,
    /// The surface named `secondary`.
    AsNamed,
}

/// How quadrilateral facets of a primary surface are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FacetShape {
    /// Bilinear surfaces, for quadratic cells quadratic ones.
    Bilinear,
    /// Split into plane triangles.
    Triangles,
}
