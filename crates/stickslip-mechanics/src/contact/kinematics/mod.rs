//! Kinematics: gap and slip of a contact point with their first and second derivatives.
//!
//! The only place where a contact normal is made. A [`Stencil`] says by how much gap and slip change when its dofs move; the
//! response of the interface is written in its frame, so that force and tangent are
//! `Bᵀ t` and `Bᵀ D S + Σ tᵢ kᵢ` whatever law made `t` and `D`.
//!
//! `B` and `S` differ where surfaces are curved. A traction acts in the tangent plane of now and keeps its size there, so the rows `B` of the shear are
//! unit vectors of that plane. Slip is a length of way over an increment that may be long, and its gradient `S` is not of length one. A way that began
//! in another tangent plane, and tractions that were carried in it, are turned into that of now: nothing of them is lost by projection.

mod arriving;
mod average;
mod convective;
mod dual;
mod facet;
mod frame;
mod moment;
mod mortar;
mod pop;
mod rate;
mod rigid;
mod small_sliding;
mod stencil;
mod turning;

#[cfg(test)]
mod tests;

pub use arriving::arriving_slip;
pub use average::{add_average_hessian, average, mean_gap};
pub use convective::Convective;
pub use moment::NodeSums;
pub use mortar::{Carried, Gathered, MeanPoint, gather};
pub use pop::Pop1995;
pub use rate::{Moving, rate_slip};
pub use rigid::{
    ObstaclePair, RigidFoot, add_rigid_hessian, carried_over, rigid_stencil, tangents,
};
pub use small_sliding::SmallSliding;
pub use stencil::{Kinematics, Pair, Stencil};
pub use turning::{Part, of_points, rotation_of};

crate::family! {
    /// How gap and slip are measured.
    KinematicsModel: "kinematics", dyn Kinematics {
        /// Convective coordinates.
        Convective(Convective) = "convective",
        /// Small sliding.
        SmallSliding(SmallSliding) = "small-sliding",
        /// The paper's.
        Pop1995(Pop1995) = "pop-1995",
    }
}

impl Default for KinematicsModel {
    fn default() -> Self {
        KinematicsModel::Convective(Convective {})
    }
}
