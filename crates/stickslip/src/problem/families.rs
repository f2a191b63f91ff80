use serde_json::Value;

use super::{prose, schema};
use crate::body::couplings::CouplingKind;
use crate::body::heat::TemperatureKind;
use crate::body::loads::LoadKind;
use crate::contact::discretisation::DiscretisationModel;
use crate::contact::enforcement::EnforcementModel;
use crate::contact::kinematics::KinematicsModel;
use crate::contact::law::damping::DampingModel;
use crate::contact::law::friction::FrictionModel;
use crate::contact::law::normal::NormalModel;
use crate::contact::law::slip::SlipModel;
use crate::contact::law::wear::WearModel;
use crate::contact::obstacle::ObstacleShape;
use crate::fatigue::FatigueModel;
use crate::material::Material;
use crate::mesh::generators::Generator;
use crate::newton::condensed::engine::EngineModel;
use crate::registry::Family;
use crate::roughness::RoughnessKind;
use crate::time::scheme::SchemeModel;

/// A model family as the problem file sees it.
#[derive(Debug, Clone)]
pub struct FamilyListing {
    /// Its key.
    pub key: &'static str,
    /// Where it stands in the problem file.
    pub place: &'static str,
    /// Its entries, in the order of the registry.
    pub entries: Vec<ModelListing>,
}

/// One model of a family.
#[derive(Debug, Clone)]
pub struct ModelListing {
    /// Its key, the kind.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: String,
    /// The JSON schema of its parameters, with units and defaults.
    pub schema: Value,
}

/// `definition`: where the schema has the entries, the family itself or the table into which they are flattened.
fn listing<F: Family>(definition: &str, place: &'static str) -> FamilyListing {
    let model = |&name| {
        let schema = schema::of_entry(definition, name);
        ModelListing {
            name,
            summary: prose::first_sentence(schema["description"].as_str().unwrap_or_default()),
            schema,
        }
    };
    FamilyListing {
        key: F::KEY,
        place,
        entries: F::KINDS.iter().map(model).collect(),
    }
}

/// All model families of the problem file, in the order of its tables.
pub fn families() -> Vec<FamilyListing> {
    vec![
        listing::<Generator>("Generator", "[body.NAME] generate.KIND"),
        listing::<Material>("Material", "[material.NAME.KIND]"),
        listing::<ObstacleShape>("Obstacle", "[obstacle.NAME.KIND]"),
        listing::<NormalModel>("NormalModel", "[interface.NAME] normal.KIND"),
        listing::<DampingModel>("DampingModel", "[interface.NAME] damping.KIND"),
        listing::<FrictionModel>("FrictionModel", "[interface.NAME] friction.KIND"),
        listing::<SlipModel>("SlipModel", "[interface.NAME] slip.KIND"),
        listing::<RoughnessKind>("Roughness", "[interface.NAME] roughness.KIND"),
        listing::<WearModel>("WearModel", "[interface.NAME] wear.KIND"),
        listing::<EnforcementModel>("EnforcementModel", "[interface.NAME] enforcement.KIND"),
        listing::<DiscretisationModel>(
            "DiscretisationModel",
            "[interface.NAME] discretisation.KIND",
        ),
        listing::<KinematicsModel>("KinematicsModel", "[interface.NAME] kinematics.KIND"),
        listing::<LoadKind>("Load", "[load.NAME.KIND]"),
        listing::<TemperatureKind>("Temperature", "[temperature.NAME.KIND]"),
        listing::<CouplingKind>("Coupling", "[coupling.NAME.KIND]"),
        listing::<SchemeModel>("SchemeModel", "[step.dynamic] scheme.KIND"),
        listing::<FatigueModel>(
            "FatigueModel",
            "[output.fatigue] criteria = [{ KIND = {} }]",
        ),
        listing::<EngineModel>("EngineModel", "[solver] engine.KIND"),
    ]
}
