//! Where contact is evaluated: at weighted means over the surfaces, or at the points of one of them.

mod mortar;
mod node_to_facet;

pub use mortar::MortarContact;
pub use node_to_facet::NodeToFacet;

/// A way to discretise an interface.
pub trait Discretisation: Send + Sync {
    /// Whether gaps are weighted over faces, and then the largest angle `[°]` between faces of one smooth surface.
    fn weighted(&self) -> Option<f64> {
        None
    }

    /// Whether both surfaces are secondary, each for one half.
    fn two_sided(&self) -> bool {
        false
    }

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

crate::family! {
    /// Where contact is evaluated.
    DiscretisationModel: "discretisation", dyn Discretisation {
        /// Surface to surface.
        Mortar(MortarContact) = "mortar",
        /// The paper's contact elements.
        NodeToFacet(NodeToFacet) = "node-to-facet",
    }
}

impl Default for DiscretisationModel {
    fn default() -> Self {
        DiscretisationModel::Mortar(MortarContact::default())
    }
}
