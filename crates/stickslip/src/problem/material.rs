use serde::{Deserialize, Serialize};

use crate::material::{self, Elasticity, Expansion};
use crate::registry::Family;

/// `[material.NAME]`: elastic constants, and how the material expands when it is heated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Material {
    /// Thermal expansion: a coefficient `[1/K]`, three along the axes of the material, or a table by temperature. Without it nothing expands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expansion: Option<Expansion>,
    /// The temperature at which the elastic constants hold; needed where `at` gives others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Elastic constants at higher temperatures, in ascending order. Stiffnesses in between are linear, outside constant. Each cell has those of its
    /// temperature at the start, and bodies keep theirs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<ConstantsAt>,
    /// The elastic constants.
    #[serde(flatten)]
    pub kind: material::Material,
}

/// Elastic constants at a temperature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ConstantsAt {
    /// The temperature.
    pub temperature: f64,
    /// The elastic constants. A density says nothing here: a body has that of the material.
    #[serde(flatten)]
    pub kind: material::Material,
}

impl Material {
    /// The elastic constants behind their trait.
    pub fn as_dyn(&self) -> &dyn Elasticity {
        self.kind.as_dyn()
    }

    /// The key of the kind of elastic constants.
    pub fn kind(&self) -> &'static str {
        self.kind.kind()
    }
}

impl From<material::Material> for Material {
    /// Elastic constants that hold at any temperature, of a material that does not expand.
    fn from(kind: material::Material) -> Self {
        Material {
            expansion: None,
            temperature: None,
            at: Vec::new(),
            kind,
        }
    }
}
