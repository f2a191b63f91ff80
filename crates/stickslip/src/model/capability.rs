//! What goes with what: the steps, methods, loads and supports that each formulation of a body knows, and friction with a state. Refusals of problems, the table that
//! `stickslip models --matrix` prints and the page of the book are products of this one table.

/// An enum whose variants have names, of which there is a list.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident { $( $variant:ident = $name:literal ),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum $type {
            $( #[doc = $name] $variant ),+
        }

        impl $type {
            /// All of them, in the order of the table.
            pub const ALL: &'static [$type] = &[$( $type::$variant ),+];

            /// What the table calls it.
            pub fn name(self) -> &'static str {
                match self {
                    $( $type::$variant => $name ),+
                }
            }
        }
    };
}

named! {
    /// How a body is described, or a law that not everything goes with.
    Subject {
        Linear = "small rotations",
        Axle = "`rotation.with`",
        Free = "`rotation = \"large\"`",
        Cells = "`rotation = \"corotational\"`",
        Rigid = "`rigid`",
        RigidAxle = "`rigid`, `rotation.with`",
        RigidFree = "`rigid`, `rotation = \"large\"`",
        FrictionState = "friction with a state",
    }
}

named! {
    /// Something that a problem may use and that not everything goes with.
    Feature {
        Statics = "quasi-static steps",
        CycleJumps = "jumps over `cycles`",
        Implicit = "implicit `dynamic` steps",
        Explicit = "explicit `dynamic` steps",
        Steady = "`steady` sliding",
        Modes = "`modes`",
        ComplexModes = "`complex-modes`",
        Harmonic = "`harmonic`",
        Sparse = "`method = \"sparse\"`",
        Condensed = "`method = \"condensed\"`",
        Multigrid = "`method = \"multigrid\"`",
        Axisymmetric = "`space = \"axisymmetric\"`",
        Pressure = "pressures",
        Following = "other loads that `follow`",
        Centrifugal = "`centrifugal` loads",
        GroundSpring = "springs to ground on its points",
        Temperature = "`temperature`",
        InitialTemperature = "`initial.temperature`",
        InitialDisplacement = "`initial.displacement`",
        PartialSupport = "supports of some components of its points",
        Coupling = "couplings of its points",
        SmallSliding = "`kinematics.small-sliding`",
        Tie = "`tied` interfaces",
        FrictionAxes = "`friction.orthotropic` with its surface as the primary",
    }
}

use Feature::{
    Axisymmetric, Centrifugal, ComplexModes, Condensed, Coupling, CycleJumps, Explicit, Following,
    FrictionAxes, GroundSpring, Harmonic, Implicit, InitialDisplacement, InitialTemperature, Modes,
    Multigrid, PartialSupport, SmallSliding, Steady, Temperature,
};
use Subject::{Axle, Cells, Free, FrictionState, RigidAxle, RigidFree};

/// Why some subjects do not go with some features.
#[derive(Debug)]
pub struct Limit {
    subjects: &'static [Subject],
    features: &'static [Feature],
    /// What is said of the body or the interface: its name comes before.
    pub why: &'static str,
    /// What to do.
    pub help: &'static str,
}

impl Limit {
    fn holds(&self, subject: Subject, feature: Feature) -> bool {
        self.subjects.contains(&subject) && self.features.contains(&feature)
    }
}

const LEAVE_STEP: &str = "leave this step out, or `rotation` of the body";
const NO_TEMPERATURES: &str = "leave temperatures out, or `rotation` of the body";

/// The limits, each in a sentence.
pub static LIMITS: &[Limit] = &[
    Limit {
        subjects: &[Axle, Free, Cells, RigidAxle, RigidFree],
        features: &[Axisymmetric],
        why: "turns by any angle: around an axis of symmetry nothing turns",
        help: "model the body in 3D, or remove the key",
    },
    Limit {
        subjects: &[Axle, Cells],
        features: &[Implicit, Explicit],
        why: "turns by any angle, which is known to quasi-static steps alone",
        help: LEAVE_STEP,
    },
    Limit {
        subjects: &[Axle, RigidAxle, Cells],
        features: &[Steady, Modes, ComplexModes, Harmonic],
        why: "turns by any angle, which is known to quasi-static steps alone",
        help: LEAVE_STEP,
    },
    Limit {
        subjects: &[Free, RigidFree],
        features: &[Steady, Modes, ComplexModes, Harmonic],
        why: "turns freely by any angle, which such a step does not support",
        help: LEAVE_STEP,
    },
    Limit {
        subjects: &[Axle, RigidAxle],
        features: &[Multigrid],
        why: "turns by any angle, and multigrid does not know of that",
        help: "take \"condensed\" or \"sparse\"",
    },
    Limit {
        subjects: &[Cells],
        features: &[Condensed, Multigrid],
        why: "turns cell by cell (corotational): its stiffness is not constant",
        help: "take \"sparse\", or leave the key out",
    },
    Limit {
        subjects: &[Axle, RigidAxle],
        features: &[InitialDisplacement],
        why: "turns by any angle: displacements to start from are not known in its frame",
        help: "begin with a step that leads there",
    },
    Limit {
        subjects: &[Cells],
        features: &[Temperature, InitialTemperature],
        why: "turns cell by cell, and temperatures do not turn with cells",
        help: NO_TEMPERATURES,
    },
    Limit {
        subjects: &[Free, RigidFree],
        features: &[InitialTemperature],
        why: "turns freely by any angle, and temperatures do not turn with it",
        help: NO_TEMPERATURES,
    },
    Limit {
        subjects: &[Cells],
        features: &[Following, Centrifugal],
        why: "turns cell by cell, and no load follows it but a pressure",
        help: "give the load its direction in space, or take `rotation = \"large\"`",
    },
    Limit {
        subjects: &[Axle, Free, Cells, RigidAxle, RigidFree],
        features: &[SmallSliding],
        why: "turns by any angle, and pairs are those of the start",
        help: "leave the key out",
    },
    Limit {
        subjects: &[Axle, Free, RigidAxle, RigidFree],
        features: &[GroundSpring],
        why: "turns by any angle, and springs to ground would turn with this body",
        help: "put them at the reference point that carries it, or press another body against it",
    },
    Limit {
        subjects: &[Free],
        features: &[PartialSupport],
        why: "turns freely by any angle, and its points are not held in all directions",
        help: "hold the points in all directions, let a frictionless interface guide the body, or, in quasi-static steps, take `rotation = \"corotational\"`",
    },
    Limit {
        subjects: &[RigidAxle],
        features: &[PartialSupport],
        why: "is carried by a reference point",
        help: "support the reference point",
    },
    Limit {
        subjects: &[Free, RigidFree],
        features: &[Coupling],
        why: "turns freely by any angle, and couplings do not turn with it",
        help: "tie surfaces by an interface (`tied = true`), hold points of an elastic body by a support or let it turn by `rotation = \"corotational\"` in quasi-static steps, or let a reference point carry a rigid one",
    },
    Limit {
        subjects: &[Axle, RigidAxle],
        features: &[Coupling],
        why: "turns by any angle, and is joined to something that does not turn with it",
        help: "tie surfaces by an interface (`tied = true`), or support the body in its frame and load the reference point that carries it",
    },
    Limit {
        subjects: &[Axle, Free, Cells, RigidAxle, RigidFree],
        features: &[FrictionAxes],
        why: "turns by any angle, and the axes of friction on the primary surface keep their directions in space",
        help: "let the body with the axes be one that does not turn, or take friction.coulomb",
    },
    Limit {
        subjects: &[FrictionState],
        features: &[ComplexModes, Harmonic],
        why: "has a friction law that keeps a state, which steps of small vibrations do not follow",
        help: "compute `modes`, or the motion itself in a dynamic step",
    },
    Limit {
        subjects: &[FrictionState],
        features: &[CycleJumps],
        why: "has a friction law that keeps a state, which jumps over cycles do not follow",
        help: "compute all cycles: leave `jump` out",
    },
];

/// Why a subject does not go with a feature; `None` where it does.
pub fn limit(subject: Subject, feature: Feature) -> Option<&'static Limit> {
    LIMITS.iter().find(|l| l.holds(subject, feature))
}

/// The table of what goes with what, in Markdown: a row for each feature, a column for each subject, and a note for each limit.
pub fn matrix() -> String {
    let row = |cells: &mut dyn Iterator<Item = String>| cells.collect::<Vec<_>>().join(" | ");
    let names = row(&mut Subject::ALL.iter().map(|s| s.name().to_string()));
    let mut text = format!(
        "| | {names} |\n|---|{}\n",
        "---|".repeat(Subject::ALL.len())
    );
    for &feature in Feature::ALL {
        let cell = |&subject| match LIMITS.iter().position(|l| l.holds(subject, feature)) {
            Some(k) => format!("no ({})", k + 1),
            None => "yes".into(),
        };
        let cells = row(&mut Subject::ALL.iter().map(cell));
        text += &format!("| {} | {cells} |\n", feature.name());
    }
    text += "\n";
    for (k, limit) in LIMITS.iter().enumerate() {
        text += &format!("{}. It {}. {}.\n", k + 1, limit.why, sentence(limit.help));
    }
    text
}

/// With a capital at its beginning.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_is_found_and_none_hides_another() {
        for l in LIMITS {
            for &subject in l.subjects {
                for &feature in l.features {
                    let all = LIMITS.iter().filter(|l| l.holds(subject, feature));
                    assert_eq!(all.count(), 1, "{subject:?} {feature:?}");
                }
            }
        }
        assert!(
            Feature::ALL
                .iter()
                .all(|&f| limit(Subject::Linear, f).is_none())
        );
        assert!(
            Subject::ALL
                .iter()
                .all(|&s| limit(s, Feature::Statics).is_none())
        );
    }
}
