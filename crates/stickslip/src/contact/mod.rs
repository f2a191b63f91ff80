//! Contact: surface → search → pairing → kinematics → law → enforcement → interface.
//!
//! | stage | file | knows |
//! |---|---|---|
//! | surface | `surface.rs`, `crossing.rs` | points of the secondary with their areas, facets of the primary; whether they run through themselves |
//! | obstacle | `obstacle/` | rigid shapes and their motion |
//! | search | `search.rs` | which facets a point may meet |
//! | projection | `projection.rs` | the projection of a point on a facet |
//! | pairing | `pairing/` | which facet a point belongs to |
//! | mortar | `mortar/` | integrals over what two surfaces have in common: gaps weighted over faces |
//! | kinematics | `kinematics/` | gap and slip with their derivatives: the [`Stencil`](kinematics::Stencil) |
//! | law, enforcement | `law/`, `enforcement/` | numbers in, numbers and derivatives out |
//! | response | `response/` | traction and its derivatives in the frame of the stencil |
//! | interface | `interface/` | the only place that scatters into residual and tangent |

pub mod crossing;
pub mod discretisation;
pub mod enforcement;
pub mod interface;
pub mod kinematics;
pub mod law;
pub mod mortar;
pub mod obstacle;
pub mod pairing;
pub mod projection;
pub mod response;
pub mod search;
pub mod surface;
