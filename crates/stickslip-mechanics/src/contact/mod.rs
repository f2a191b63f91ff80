//! Contact: surface → search → pairing → kinematics → law → enforcement → interface → look.
//!
//! | stage | file | knows |
//! |---|---|---|
//! | surface | `surface.rs`, `crossing.rs` | points of the secondary with their areas, facets of the primary; whether they run through themselves |
//! | obstacle | `obstacle/` | rigid shapes and their motion |
//! | symmetry | `symmetry.rs` | components that points on planes of symmetry do not have |
//! | search | `search.rs`, `walls.rs` | which facets a point may meet, and how deep behind them |
//! | projection | `projection.rs`, `facet_point.rs`, `bounds.rs` | the projection of a point on a facet, and what follows from a place of it; where it lies and looks, which rules most facets out |
//! | pairing | `pairing/` | which facet a point belongs to |
//! | mortar | `mortar/` | integrals over what two surfaces have in common: gaps weighted over faces |
//! | kinematics | `kinematics/` | gap and slip with their derivatives: the [`Stencil`](kinematics::Stencil) |
//! | law, enforcement | `law/`, `enforcement/` | numbers in, numbers and derivatives out |
//! | response | `response/` | traction and its derivatives in the frame of the stencil |
//! | worn | `worn/` | depths that sliding has worn off both surfaces, and where those of the primary are kept |
//! | interface | `interface/` | the only place that scatters into residual and tangent |
//! | look | `look/` | what an interface says of itself: functions of shared references, which cannot write |
//!
//! # The stages
//!
//! - *Surface.* With a mortar, the default, every node of the secondary has one contact point for each smooth part of the surface that it lies
//!   on. Otherwise, and on obstacles, contact points are the nodes of linear faces and of all edges in 2D, with tributary areas that make a
//!   uniform pressure exact. Corners of quadratic faces in 3D have no area or a negative one. On an obstacle there is a point a node all the same, the mean over the
//!   faces around it weighted by its dual function (`mortar/dual.rs`): a weighted sum of a node and the two ends of its edge, whose gap is that sum of
//!   gaps. Against facets, without a mortar, they are quadrature points; more of them where laws yield, so that a part of a face counts as one.
//! - *Where it lies.* A gap is a small difference of coordinates. An interface counts them, those of its obstacle too, from its `origin`: the origin of space, or a round
//!   place near the middle of a model that lies more than 16 times its size away. Places and moments that leave the interface are those of space.
//! - *Sides.* Which side has the points follows from the meshes: where the cells of the secondary are larger than those of the primary by more than a quarter, `problem/build` makes the
//!   interface the other way round (`InterfaceDefinition::exchanged`), since between points that are far apart penetration of a finer surface is not detected. Inside, secondary is what has the points;
//!   what is reported (`look/`) is of the sides as the problem names them.
//! - *Between points* nothing is checked while the solution is sought. `look/between.rs` measures afterwards, from the geometry alone, how far the surfaces penetrate
//!   or stand apart there, for the quality gate.
//! - *Mortar.* `mortar/` cuts faces of the secondary and facets of the primary along each other in a plane, and integrates gap and shape functions over the
//!   pieces with dual functions as weights. The gap is measured along normals of the reference that turn with the secondary as a whole: a pair that turns as one keeps
//!   its gap, and how the surface bends does not change the directions from iteration to iteration. Pieces are divided into triangles in an order that rounding does not
//!   decide. A point is a sum over the faces around it: a mean gap, weights of nodes on both sides, the gradient of the gap. With
//!   that it is a stencil like any other; nothing after the kinematics knows of it. What is not a polynomial in space (skewed
//!   quadrilaterals) is corrected to what is known of its sum (`correct.rs`): that makes patch tests exact. Weights are made anew at every evaluation,
//!   at the reference configuration once for small sliding. Their change is not in the tangent; it is of the size of pressure over modulus.
//!   Nodes whose motion is prescribed or follows from that of others (`problem/build/held.rs` marks them), and nodes beyond the edge of the primary of which little is covered, have no multiplier: their
//!   neighbours take over (`mortar/merge.rs`). What is covered is looked at in the accepted state that an attempt starts from. Where both sides are clamped a point is open (`interface/clamped.rs`).
//! - *Planes of symmetry.* Where both surfaces end on a plane that supports hold in all steps, a point there is a sum over half of the faces that it has in the whole body.
//!   `problem/build/mirrors.rs` marks such points (`ContactPoint::across`); normal, slip and turn have no part across the plane, as with the image of what is missing.
//! - *Search* runs again when a node has moved by a quarter of the margin (the longest facet) since the last time; a
//!   candidate list is complete as long as it is used.
//! - *Walls.* A point is behind a facet down to half of the thickness of the body there, where its other face belongs to the same surface. What is deeper lies
//!   beyond the other face: the top of a block that stands on a wall is no partner of the bottom of that wall.
//! - *Pairing* takes the nearest facet; between equally near ones the one the point was on. Beyond an edge where the
//!   surface goes on a facet is extended, so that a point in a re-entrant corner is not lost; beyond an outer edge the
//!   point is free.
//! - *Kinematics* makes a `Stencil`: gap and slips with their gradients `S` over the dofs of the point, and the rows `B` along which pressure and shear act,
//!   unit vectors of a frame of now. Force and tangent are `Bᵀ t` and `Bᵀ D S + Σ tᵢ kᵢ`, whatever law made `t` and `D`.
//! - *Laws.* A normal law gives pressure from gap and its inverse `h(p)`. Damping says what a closing velocity adds to that
//!   pressure. A friction law gives only the limit. A slip rule turns limit and motion into traction. They are independent of
//!   each other.
//! - *Enforcement.* All three solve `gap - h(p) + (p - λ)/ω = 0` for `p ≥ 0`. They differ in λ: zero (penalty), an unknown
//!   that is eliminated point by point (perturbed Lagrangian), an unknown as well, pulled to its last estimate (augmented Lagrangian). With `ω = ∞` a
//!   compliant law is followed itself. So normal law, friction, slip rule, enforcement and kinematics combine freely;
//!   `problem/check` needs a handful of cross rules.
//!
//! *Laws of a program* (`law/user.rs`, `interface/user_laws.rs`) take the place of normal and friction law as functions of many points. Before an evaluation
//! the points are gone through once for each of them, which yields the questions; the function answers all of them, and the evaluation proper finds
//! them in `LawInput::answers`. Nothing else knows where a pressure came from.

pub mod bounds;
pub mod crossing;
pub mod discretisation;
pub mod enforcement;
pub mod facet_point;
pub mod interface;
pub mod kinematics;
pub mod law;
pub mod look;
pub mod mortar;
pub mod obstacle;
pub mod pairing;
pub mod projection;
pub mod response;
pub mod search;
pub mod surface;
pub mod symmetry;
pub mod walls;
pub mod worn;
