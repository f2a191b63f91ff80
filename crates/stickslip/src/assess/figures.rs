//! The figures of the quality gate: what each is called and says, and how its worst value is found when the largest forces of the run are known.

use std::collections::BTreeMap;

use super::doctor::{DoctorCause, Finding};

/// A figure of the gate: an amount of something that should not be, relative to a scale of the same kind. One row below, a limit in
/// [`Limits`](crate::model::limits::Limits) and a call of [`Gate::note`](super::gate::Gate) make a figure.
///
/// Where next to nothing acts, rounding and tolerances are as large as what there is, and a ratio says nothing. So amount and scale are kept
/// apart, and the scale counts as at least a part of the largest of the whole run, be it before or after.
#[derive(Debug)]
pub(crate) struct Kind {
    /// Its name, and the key of its limit in `[quality]`.
    pub name: &'static str,
    /// The scale is at least this part of its largest value at the same place.
    pub own: f64,
    /// And this part of its largest value anywhere.
    pub model: f64,
    /// What is wrong, for a sentence.
    pub what: &'static str,
    /// What may help.
    pub help: &'static str,
}

/// What may help with a figure. Where findings say what is wrong with the model itself they come first, and advice about how it is solved is withheld: of a body
/// that hangs on the wrong interface the solver cannot do better.
pub(crate) fn advice(help: &str, findings: &[Finding]) -> String {
    let about_solver = help.contains("solver.tolerance");
    // Units explain what is far too large, and nothing of how well contact or motion is resolved.
    let units = |f: &&Finding| f.cause == DoctorCause::MixedUnits;
    let others = findings.iter().filter(|f| f.explains() && !units(f));
    let units = (findings.iter()).filter(|f| f.explains() && units(f) && help.contains("unit"));
    match others.chain(units).next() {
        Some(f) if about_solver => format!(
            "look at the finding `{}` first: while it holds, the solver is not to blame",
            f.cause
        ),
        Some(f) => format!(
            "the finding `{}` may be the cause: look at it first. If the model is meant to be so: {help}",
            f.cause
        ),
        None => help.to_string(),
    }
}

/// All figures.
pub(crate) static ALL: [&Kind; 25] = [
    &PENETRATION_TO_SIZE,
    &UNDETECTED_PENETRATION,
    &UNDETECTED_APPROACH,
    &TIE_OPENING,
    &PENETRATION_TO_APPROACH,
    &ELASTIC_SLIP,
    &COMPLEMENTARITY,
    &OSCILLATION,
    &EXPLICIT_WEAR,
    &CONE_VIOLATION,
    &FRICTION_LAW,
    &ACTION_REACTION,
    &MOMENT,
    &EQUILIBRIUM,
    &ROTATION,
    &ROTATION_TO_APPROACH,
    &LOCAL_ROTATION,
    &OUTDATED_NORMALS,
    &STRAIN,
    &PRESTRESS,
    &DISPLACEMENT,
    &EXPLICIT_OPENING,
    &EXPLICIT_PENETRATION,
    &SCHEME_DISSIPATION,
    &ENERGY,
];

/// Forces below this part of the largest of their interface or body are as good as none: figures judge down to a thousandth of the load.
const LEAST_FORCE: f64 = 1e-3;

/// Forces of an interface below this part of the largest of the model are what the tolerance of Newton's method leaves.
const TRACE_OF_FORCE: f64 = 1e-6;

pub(crate) static PENETRATION_TO_SIZE: Kind = Kind {
    name: "penetration-to-size",
    own: 0.0,
    model: 0.0,
    what: "penetration of the surfaces over the size of the cell beneath",
    help: "raise the penalty factor (`interface.NAME.enforcement.penalty.factor`), or use `enforcement.augmented-lagrangian`",
};

// Of energies, which go with the square of forces.
pub(crate) static PENETRATION_TO_APPROACH: Kind = Kind {
    name: "penetration-to-approach",
    own: LEAST_FORCE * LEAST_FORCE,
    model: TRACE_OF_FORCE * TRACE_OF_FORCE,
    what: "penetration over the elastic approach; forces have about the same relative error",
    help: "raise the penalty factor (`interface.NAME.enforcement.penalty.factor`), or use `enforcement.augmented-lagrangian`",
};

pub(crate) static ELASTIC_SLIP: Kind = Kind {
    name: "elastic-slip",
    own: LEAST_FORCE * LEAST_FORCE,
    model: TRACE_OF_FORCE * TRACE_OF_FORCE,
    what: "slip of sticking points over the elastic approach",
    help: "raise the `factor` or `tangential-factor` of the enforcement, or use enforcement.augmented-lagrangian",
};

pub(crate) static COMPLEMENTARITY: Kind = Kind {
    name: "complementarity",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "pressure at open points: mean gap over the size of the cells",
    help: "lower `solver.tolerance` or the `error` of the enforcement",
};

// Of lengths. In every analysis the largest of the run are compared: while forces are small so is the contact, and any mesh is too coarse for it.
pub(crate) static UNDETECTED_PENETRATION: Kind = Kind {
    name: "undetected-penetration",
    own: 0.0,
    model: 0.0,
    what: "penetration between contact points over the size of the cell beneath",
    help: "choose the finer surface as secondary, or refine the secondary where it is touched",
};

pub(crate) static UNDETECTED_APPROACH: Kind = Kind {
    name: "undetected-approach",
    own: 0.0,
    model: 0.0,
    what: "penetration between contact points, or gap around a point that carries pressure, over itself plus the elastic approach; forces have about the same relative error",
    help: "choose the finer surface as secondary, or refine both where they touch",
};

pub(crate) static TIE_OPENING: Kind = Kind {
    name: "tie-opening",
    own: 0.0,
    model: 0.0,
    what: "tied surfaces open or slide between their points: relative to the deformation of the bodies",
    help: "choose as secondary the finer surface, and one that no support holds at its edge, or refine the secondary",
};

pub(crate) static OSCILLATION: Kind = Kind {
    name: "oscillation",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "part of the pressure that oscillates from point to point",
    help: "choose the finer or softer surface as secondary, or match the meshes; forces may be right where pressures are not",
};

// A way is what it is, however small the forces.
pub(crate) static EXPLICIT_WEAR: Kind = Kind {
    name: "explicit-wear",
    own: 0.0,
    model: 0.0,
    what: "slip of an increment over the stability limit of explicit wear; above 1 pressure and depth oscillate from point to point",
    help: "`wear-feedback = \"implicit\"`, the default, has no such limit; otherwise shorter increments, or jumps over fewer cycles",
};

pub(crate) static CONE_VIOLATION: Kind = Kind {
    name: "cone-violation",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "the shear traction violates the friction cone by this part",
    help: "lower `solver.tolerance`",
};

pub(crate) static FRICTION_LAW: Kind = Kind {
    name: "friction-law",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "shear of slipping points differs from the friction limit, or does not oppose slip, by this fraction of it",
    help: "take smaller increments; if that does not help please report it",
};

pub(crate) static ACTION_REACTION: Kind = Kind {
    name: "action-reaction",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "the forces on the two sides differ by this part",
    help: "this should not happen: please report it",
};

pub(crate) static MOMENT: Kind = Kind {
    name: "moment",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "the moments of the forces on the two sides differ by this part",
    help: "surfaces that slide far need kinematics other than small-sliding, and curved ones cells that are small beside the area in contact",
};

// Newton's method balances all forces of the model together.
pub(crate) static EQUILIBRIUM: Kind = Kind {
    name: "equilibrium",
    own: LEAST_FORCE,
    model: LEAST_FORCE,
    what: "relative out-of-balance forces and moments of the body",
    help: "lower `solver.tolerance`",
};

// Angles and ways are what they are, however small the forces.
pub(crate) static ROTATION: Kind = Kind {
    name: "rotation",
    own: 0.0,
    model: 0.0,
    what: "rotation of the body in radians; strains and rotations are assumed small",
    help: "look for a support that is missing, a load or a stiffness in the wrong unit, or make the body stiffer; a body that is meant to turn far turns with a reference point (`body.NAME.rotation.with`); a face that is meant to turn far without one is moved by supports of its points",
};

// Of energies and works, as penetration.
pub(crate) static ROTATION_TO_APPROACH: Kind = Kind {
    name: "rotation-to-approach",
    own: LEAST_FORCE * LEAST_FORCE,
    model: TRACE_OF_FORCE * TRACE_OF_FORCE,
    what: "rotations are assumed small, and the second-order term they neglect in the gap is this part of the elastic approach; pressures have about the same relative error",
    help: "allow the body large rotations: `body.NAME.rotation.with = \"POINT\"` if a reference point turns it, `rotation = \"large\"` if it turns freely, `rotation = \"corotational\"` if it bends",
};

pub(crate) static LOCAL_ROTATION: Kind = Kind {
    name: "local-rotation",
    own: 0.0,
    model: 0.0,
    what: "rotation of a cell in radians; strains and rotations are assumed small",
    help: "look for cells that hang together at a node or an edge only, or for a load or a stiffness in the wrong unit; in a body with `rotation = \"corotational\"`, where a part of a cell has turned in the frame of the cell, take smaller cells along what bends",
};

pub(crate) static STRAIN: Kind = Kind {
    name: "strain",
    own: 0.0,
    model: 0.0,
    what: "strain of the body, weighted by its energy; the theory assumes small strains, and forces have about that relative error",
    help: "look for a load or a stiffness in the wrong unit, or take another program for what strains as much as rubber does",
};

// Of frequencies.
pub(crate) static PRESTRESS: Kind = Kind {
    name: "prestress",
    own: 0.0,
    model: 0.0,
    what: "relative change of a frequency by the stress at the start, which is neglected",
    help: "use the frequencies as those of the unstressed body, or use a program with stress stiffening",
};

pub(crate) static MODE_RESIDUAL: Kind = Kind {
    name: "mode-residual",
    own: 0.0,
    model: 0.0,
    what: "relative residual of the equations of motion in the worst mode or vibration",
    help: "ask for fewer modes, or support unconstrained bodies; of vibrations, take more of the modes that they are made of",
};

pub(crate) static DISPLACEMENT: Kind = Kind {
    name: "displacement",
    own: 1.0,
    model: 0.0,
    what: "displacement of the body over the size of the model plus the prescribed displacement",
    help: "it is unconstrained: support it, lower what drives it, or look for a load in the wrong unit; if it is meant to go there, raise `quality.displacement`",
};

pub(crate) static OUTDATED_NORMALS: Kind = Kind {
    name: "outdated-normals",
    own: LEAST_FORCE,
    model: TRACE_OF_FORCE,
    what: "`small-sliding` keeps the initial normals while surfaces rotate: tangential component of the pressure over the friction limit (over the pressure without friction)",
    help: "leave out `kinematics.small-sliding` of the interface: the default follows the surfaces",
};

// Of energies, as penetration.
pub(crate) static EXPLICIT_OPENING: Kind = Kind {
    name: "explicit-opening",
    own: LEAST_FORCE * LEAST_FORCE,
    model: TRACE_OF_FORCE * TRACE_OF_FORCE,
    what: "in explicit steps stops and ties by a penalty are springs: their deformation over that of the bodies",
    help: "refine the cells beside it, whose mass and size bound these springs, tie by multipliers, which explicit steps hold exactly, or take an implicit scheme",
};

pub(crate) static EXPLICIT_PENETRATION: Kind = Kind {
    name: "explicit-penetration",
    own: LEAST_FORCE * LEAST_FORCE,
    model: TRACE_OF_FORCE * TRACE_OF_FORCE,
    what: "in explicit steps contact and stick are springs as stiff as the cells beneath: their deformation over that of the bodies",
    help: "refine the cells at the surfaces, whose mass and size bound these springs, give the interface a law that is compliant, or take an implicit scheme",
};

pub(crate) static SCHEME_DISSIPATION: Kind = Kind {
    name: "scheme-dissipation",
    own: 1.0,
    model: 1.0,
    what: "numerical dissipation of the time integration over the energy stored and dissipated; velocities are too low by half of it",
    help: "take smaller increments, or a scheme with less numerical dissipation: `rho` nearer to 1, and `dynamic.contact-at = \"stage\"` if the normal laws are compliant. Numerical dissipation should only damp the noise of the mesh, which has little energy",
};

pub(crate) static ENERGY: Kind = Kind {
    name: "energy",
    own: 1.0,
    model: 1.0,
    what: "relative error of the energy balance",
    help: "take smaller increments, or add damping where bodies bounce. In quasi-static steps the forces do not depend on the energy balance. If smaller increments do not reduce the error, contact forces act along other directions than the gaps: look at edges in contact, at small rotations, and at `small-sliding`",
};

/// What a figure came to after an increment.
#[derive(Debug, Clone, Copy, Default, crate::keep::Keep)]
struct Noted {
    amount: f64,
    scale: f64,
    time: f64,
}

/// Of all scales between two powers of two, the increments that may become the worst.
#[derive(Debug, Clone, Copy, crate::keep::Keep)]
struct Octave {
    largest: Noted,
    steepest: Noted,
}

/// A figure at a place through the run.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(crate) struct Track {
    /// The largest scale.
    pub largest: f64,
    /// By the power of two below the scale.
    octaves: BTreeMap<i32, Octave>,
    /// The largest amount in motion.
    moving: Option<Noted>,
}

/// The power of two below a number that is not negative.
fn octave(x: f64) -> i32 {
    match x > 0.0 {
        true => x.log2().floor() as i32,
        false => i32::MIN,
    }
}

fn ratio(amount: f64, scale: f64) -> f64 {
    match amount == 0.0 || scale <= 0.0 {
        true => 0.0,
        false => amount / scale,
    }
}

/// What is not a number is larger than everything, and so is what is compared with an infinity: beside that all would be nothing.
fn largest_if_not_a_number(amount: f64, scale: f64) -> [f64; 2] {
    match amount.is_nan() || !scale.is_finite() {
        true => [f64::INFINITY, 1.0],
        false => [amount, scale],
    }
}

impl Track {
    pub fn add(&mut self, amount: f64, scale: f64, time: f64) {
        let [amount, scale] = largest_if_not_a_number(amount, scale);
        let noted = Noted {
            amount,
            scale,
            time,
        };
        self.largest = self.largest.max(scale);
        let both = Octave {
            largest: noted,
            steepest: noted,
        };
        let worst = self.octaves.entry(octave(scale)).or_insert(both);
        if amount > worst.largest.amount {
            worst.largest = noted;
        }
        if ratio(amount, scale) > ratio(worst.steepest.amount, worst.steepest.scale) {
            worst.steepest = noted;
        }
    }

    pub fn add_in_motion(&mut self, amount: f64, scale: f64, time: f64) {
        let [amount, scale] = largest_if_not_a_number(amount, scale);
        self.largest = self.largest.max(scale);
        if self.moving.is_none_or(|worst| amount > worst.amount) {
            self.moving = Some(Noted {
                amount,
                scale,
                time,
            });
        }
    }

    /// The worst ratio and its time, with every scale at least the power of two below `floor`.
    pub fn worst(&self, floor: f64) -> (f64, f64) {
        let least = octave(floor);
        let of = |(&power, octave): (&i32, &Octave)| match power < least {
            true => (
                ratio(octave.largest.amount, f64::powi(2.0, least)),
                octave.largest.time,
            ),
            false => {
                let Noted {
                    amount,
                    scale,
                    time,
                } = octave.steepest;
                (ratio(amount, scale), time)
            }
        };
        let moving = self.moving.iter();
        let moving = moving.map(|n| (ratio(n.amount, self.largest.max(floor)), n.time));
        let all = self.octaves.iter().map(of).chain(moving);
        // Of equal ones the last to be noted counts least: powers are in order.
        all.fold(
            (0.0, f64::NAN),
            |worst, one| if one.0 > worst.0 { one } else { worst },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_at_a_small_force_counts_until_it_is_small_beside_the_largest() {
        let mut track = Track::default();
        track.add(0.2, 1.0, 1.0);
        assert_eq!(track.worst(1e-3 * track.largest), (0.2, 1.0));
        // To a hundredth of what comes later it counts in full.
        track.add(0.0, 100.0, 2.0);
        assert_eq!(track.worst(1e-3 * track.largest), (0.2, 1.0));
        // Beside what is a million times larger it is nothing, whichever comes first.
        track.add(0.0, 1e6, 3.0);
        let (value, time) = track.worst(1e-3 * track.largest);
        assert!(value < 5e-4 && time == 1.0, "{value:e}");
        let mut backwards = Track::default();
        for (amount, scale, time) in [(0.0, 1e6, 3.0), (0.0, 100.0, 2.0), (0.2, 1.0, 1.0)] {
            backwards.add(amount, scale, time);
        }
        assert_eq!(backwards.worst(1e3), track.worst(1e3));
    }

    #[test]
    fn what_has_nothing_to_compare_with_is_compared_with_the_floor() {
        let mut track = Track::default();
        track.add(1e-20, 0.0, 1.0);
        assert_eq!(track.worst(0.0).0, 0.0);
        track.add(0.0, 1.0, 2.0);
        assert!(track.worst(1e-3).0 < 1e-16);
        track.add(f64::NAN, 1.0, 3.0);
        assert_eq!(track.worst(1e-3), (f64::INFINITY, 3.0));
        // Forces beyond all numbers do not make their errors small.
        let mut track = Track::default();
        track.add(2e225, f64::INFINITY, 4.0);
        assert_eq!(track.worst(0.0), (f64::INFINITY, 4.0));
    }

    #[test]
    fn in_motion_the_largest_is_compared_with_the_largest() {
        let mut track = Track::default();
        track.add_in_motion(1.0, 1.0, 1.0);
        track.add_in_motion(0.5, 10.0, 2.0);
        assert_eq!(track.worst(0.0), (0.1, 1.0));
    }
}
