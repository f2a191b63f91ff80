//! What counts as a good solution: the `[quality]` table.

use serde::{Deserialize, Serialize};

/// Action on a figure above its limit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, crate::keep::Keep)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum GateMode {
    /// The run ends with exit code 2 and a sentence for each; its results are kept.
    #[default]
    Error,
    /// The sentences alone.
    Warn,
    /// Nothing is judged.
    Off,
}

/// `[quality]`: the quality gate. Every accepted increment that gives a row of the history is judged by figures that have no dimension; the worst
/// of each must not exceed its limit. `inf` switches a limit off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Limits {
    /// Action on a figure above its limit.
    pub gate: GateMode,
    /// Penetration that the normal law did not ask for, `max(h(p) - g)` over the height of the cell beneath. Not judged in an explicit
    /// step, which presses by springs.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub penetration_to_size: f64,
    /// The same penetration over the elastic approach: `2 U / F` of the elastic energy of bodies and compliant interfaces and the force of
    /// the interface, at least the mean compression of one layer of cells. In motion the largest so far of both are compared. Not judged in an explicit step.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub penetration_to_approach: f64,
    /// Elastic slip of sticking points over an increment, over the elastic approach. Not judged in dynamic steps, where a point that comes to rest
    /// sticks.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub elastic_slip: f64,
    /// Complementarity: mean gap that pressure bridges, `Σ A p max(0, g - h(p)) / Σ A p height`. Not judged in an explicit step.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub complementarity: f64,
    /// Penetration between contact points, beyond what the points say, over the height of the cell beneath: nodes of
    /// the primary in faces of the secondary, and places all over these faces in the primary. Measured from the geometry alone.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub undetected_penetration: f64,
    /// The same depth, or the distance by which the surfaces stand apart all around a point that carries pressure, over itself plus the elastic
    /// approach: the part of the approach that contact points do not see. 1 where surfaces penetrate and nothing presses them
    /// apart. The largest so far of both are compared.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub undetected_approach: f64,
    /// By how much tied surfaces come apart or slide, as the root of the mean square over places all over the secondary: over the elastic approach, or the largest displacement where
    /// that is less. Measured from the geometry alone, as a tie holds points or means over faces. The largest so far of both are compared.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub tie_opening: f64,
    /// Oscillation index of the pressure: the part of it that goes up and down from each point of the secondary to the next, over its mean;
    /// 1 for a checkerboard of zero and twice the mean.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub oscillation: f64,
    /// Way that an increment slides, times the cycles that it stands for, over the longest up to which explicit wear is stable, `4 Δx / (π k E*)`; of interfaces with
    /// `wear-feedback = "explicit"`. The limit is that of a half-plane: bodies that are softer at their surface bear more.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub explicit_wear: f64,
    /// Shear beyond the limit of friction, over the largest limit of the interface.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub cone_violation: f64,
    /// Friction obeyed: by how much the shear of points that slip is not their limit or acts along their slip, and that of points that stick is above it,
    /// over the largest limit of the interface. Found from the tractions that are reported and from how the points have moved.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub friction_law: f64,
    /// Action against reaction: sum of the forces on both sides, over the sum of the magnitudes of those on one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub action_reaction: f64,
    /// Sum of the moments of the forces on both sides, over the sum of their magnitudes on one times the size of the interface. What
    /// faces each other across a gap, or slides where sliding is taken as small, has a moment.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub moment: f64,
    /// Balance of each body: resultant force and moment of interfaces, loads, springs and supports (in motion also of inertia and damping),
    /// over the largest of them (in motion: the largest so far). Moments are taken with the positions of the reference, as the bodies are linear. Not judged in an
    /// explicit step, where accelerations are made to balance.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub equilibrium: f64,
    /// Rotation of each body and reference point in radians, of an elastic body by its mean displacement gradient. Strains and rotations are taken as small: a body that
    /// turns by `θ` grows by `θ²/2`, and forces are balanced as if it had not turned, an error of a part in a thousand to one in a hundred
    /// at 0.05.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub rotation: f64,
    /// What small rotations leave out of the gap, over the elastic approach: a body that turns by `θ` misses `½ θ × (θ × r)` at the distance `r` from where supports hold it,
    /// along the normals and in the mean over what presses. In an unconstrained direction a body goes along, and only what differs from point to point counts. In motion the
    /// largest so far of both are compared. Bodies that turn in frames miss nothing.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub rotation_to_approach: f64,
    /// Rotation of the cell of each body that turns most, in radians: parts of a body may turn where it does not as a whole. The false strain there is
    /// half the square. The limit is wider, as cells at corners turn far and carry little.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub local_rotation: f64,
    /// Strain of each body that turns in frames, of every body where this is given: the root of the mean square, weighted with the energy. Strains are taken as small, and
    /// forces are wrong by about that part. If not given: 0.05, of bodies that turn in frames alone. Decks give it where `NLGEOM` asks for large strains.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<f64>,
    /// By how much the stress that modes begin from would change their frequencies, as a part of each: half of `φᵀ K_σ φ` over `φᵀ K φ`, where `K_σ` is the stiffness of that stress
    /// against rotation, `∫ σ_ij u_k,i u_k,j`. Stress does not stiffen bodies here.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub prestress: f64,
    /// Residual of the equations of motion with a mode, or with steady vibrations, `√(rᵀ A⁻¹ r / xᵀ A x)` with the matrix `A` that is factored: the part of the displacements that is off, in
    /// the norm of energy.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub mode_residual: f64,
    /// Displacement of each body over the size of the model and the prescribed displacements. A body beyond it is lost. In dynamic steps it is a finding.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub displacement: f64,
    /// In explicit steps, where springs as stiff as the cells beneath keep surfaces apart and in stick: work of their forces along what they give way, halved, over the elastic energy of all
    /// bodies, the largest so far of both.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub explicit_penetration: f64,
    /// What the pressure of an interface with `small-sliding` has along its surfaces, which have turned while its normals stayed: beside the limit of friction, or beside itself where there is no
    /// friction. It is shear that is not there.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub outdated_normals: f64,
    /// In explicit steps, where springs stand for rigid stops and ties by a penalty: their energy over the elastic energy of all bodies, the largest so far of both. Under the same force that is what
    /// they give way over what the bodies do.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub explicit_opening: f64,
    /// Energy that the scheme has dissipated (`ALLND`), over the energy stored and dissipated, at the end. What moves is slower for it, by half that part: at the limit by one in
    /// a hundred, as much as the balance of energies may be open. What the scheme feeds in counts in `energy`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    pub scheme_dissipation: f64,
    /// Residual of the energy balance over the energy stored and dissipated (at least the work of the forces along a millionth of the model), at the end. If not given: `solver.energy-limit`. In a
    /// quasi-static analysis no force follows from the ledger: works and losses are off by that part. Above a thousandth it is a note.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "infinite" = true)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<f64>,
}

impl Limits {
    /// The limit of [`strain`](Self::strain).
    pub fn strain_limit(&self) -> f64 {
        // At this strain forces are wrong by a twentieth.
        self.strain.unwrap_or(0.05)
    }
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            gate: GateMode::Error,
            penetration_to_size: 0.01,
            penetration_to_approach: 0.01,
            elastic_slip: 0.01,
            complementarity: 1e-3,
            undetected_penetration: 0.02,
            undetected_approach: 0.15,
            tie_opening: 0.05,
            oscillation: 0.25,
            explicit_wear: 1.0,
            cone_violation: 1e-3,
            friction_law: 1e-3,
            action_reaction: 1e-9,
            moment: 1e-2,
            equilibrium: 1e-4,
            rotation: 0.05,
            rotation_to_approach: 0.05,
            local_rotation: 0.2,
            strain: None,
            prestress: 0.05,
            mode_residual: 1e-3,
            displacement: 1.0,
            outdated_normals: 0.25,
            explicit_opening: 0.05,
            explicit_penetration: 0.25,
            scheme_dissipation: 0.02,
            energy: None,
        }
    }
}
