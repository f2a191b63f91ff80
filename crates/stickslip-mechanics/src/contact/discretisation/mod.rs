//! Where contact is evaluated: at weighted means over the surfaces, or at the points of one of them.

mod mortar;
mod node_to_facet;
mod rule;

pub use mortar::MortarContact;
pub use node_to_facet::NodeToFacet;
pub use rule::Discretisation;

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
