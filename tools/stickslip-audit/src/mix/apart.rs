//! What cannot go together, and why, each in one sentence.

/// Pairs of features, with the reason.
pub const APART: &[(&str, &str, &str)] = &[
    (
        "stop-across",
        "rigid-lower",
        "The corner is one of a rigid body that is held.",
    ),
    (
        "stop-across",
        "rigid-upper",
        "The corner is one of a rigid body.",
    ),
    ("stop-across", "floor", "There is no lower corner."),
    ("dashpot-across", "floor", "There is no lower corner."),
    ("spring-across", "floor", "There is no lower corner."),
    (
        "turning",
        "multigrid",
        "Grids do not include frames that turn.",
    ),
    (
        "clamp",
        "displaced",
        "A clamp holds points that the support on the top moves.",
    ),
    (
        "clamp",
        "kinematic",
        "A clamp holds points that follow the reference point.",
    ),
    (
        "clamp",
        "kinematic-force",
        "A clamp holds points that follow the reference point.",
    ),
    (
        "clamp",
        "rigid-upper",
        "A clamp holds a rigid body, which nothing moves then.",
    ),
    ("clamp", "jack", "A clamp holds both sides of the cut."),
    (
        "clamp",
        "bolt",
        "The lower body is longer beside the bolt, and both are clamped at other ends.",
    ),
    (
        "clamp",
        "side-body",
        "The side body lies where the clamp is.",
    ),
    ("clamp", "wall", "The wall stands where the clamp is."),
    ("clamp", "periodic", "A clamped side follows no other."),
    (
        "clamp",
        "kept-level",
        "A clamped end keeps the top level in one way only: it does not move.",
    ),
    (
        "clamp",
        "third-body",
        "The third body has no clamp, and nothing guides it.",
    ),
    ("clamp", "let-go", "There is no guide that lets go."),
    (
        "clamp",
        "weight",
        "The weight of a clamped body does not press.",
    ),
    (
        "symmetry",
        "axisymmetric",
        "An axis is not a plane of symmetry.",
    ),
    (
        "symmetry",
        "periodic",
        "What repeats itself has its own ends.",
    ),
    ("symmetry", "turning", "A plane of symmetry does not turn."),
    (
        "symmetry",
        "press-and-slide",
        "What is symmetric does not slide to one side.",
    ),
    ("symmetry", "loose", "A push to one side is not symmetric."),
    ("symmetry", "let-go", "There is no guide that lets go."),
    (
        "symmetry",
        "complex-modes",
        "Steady sliding to one side is not symmetric.",
    ),
    ("symmetry", "belt", "A belt to one side is not symmetric."),
    (
        "symmetry",
        "rigid-upper",
        "A rigid body is held at its plane of symmetry by the motions that are left.",
    ),
    (
        "symmetry",
        "rigid-lower",
        "A rigid body is held at its plane of symmetry by the motions that are left.",
    ),
    (
        "symmetry",
        "cycles",
        "What is symmetric does not slide back and forth.",
    ),
    (
        "axisymmetric",
        "loose",
        "There is no push to one side around an axis.",
    ),
    (
        "axisymmetric",
        "belt",
        "There is no belt to one side around an axis.",
    ),
    (
        "axisymmetric",
        "complex-modes",
        "Steady sliding to one side is not around an axis.",
    ),
    ("axisymmetric", "let-go", "There is no guide that lets go."),
    (
        "axisymmetric",
        "spring-across",
        "Corners around an axis are rings.",
    ),
    (
        "axisymmetric",
        "stop-across",
        "Corners around an axis are rings.",
    ),
    (
        "axisymmetric",
        "dashpot-across",
        "Corners around an axis are rings.",
    ),
    (
        "axisymmetric",
        "incompatible-modes",
        "Incompatible modes are for the plane and for space.",
    ),
    (
        "axisymmetric",
        "bolt",
        "A bolt beside the axis is a ring, whose force is another.",
    ),
    (
        "floor",
        "periodic",
        "A periodic body on a plane is the case of the body on a body.",
    ),
    ("floor", "bolt", "The foot of a bolt is in the lower body."),
    (
        "rigid-lower",
        "bolt",
        "The lower body is longer and elastic.",
    ),
    (
        "rigid-upper",
        "bolt",
        "The upper body is elastic in the frame.",
    ),
    (
        "rigid-upper",
        "incompatible-modes",
        "A rigid body has no formulation.",
    ),
    (
        "rigid-upper",
        "let-go",
        "A rigid body is held fully or not at all.",
    ),
    (
        "rigid-lower",
        "turning",
        "The frame of a rigid body is its own.",
    ),
    (
        "rigid-upper",
        "turning",
        "The frame of a rigid body is its own.",
    ),
    (
        "rigid-upper",
        "rayleigh",
        "A rigid body has no damping of its own.",
    ),
    (
        "rigid-upper",
        "point-mass",
        "Points of rigid bodies carry no masses.",
    ),
    ("rigid-upper", "kept-level", "A rigid body is level."),
    ("rigid-upper", "tied-cap", "The drive acts on the cap."),
    ("rigid-upper", "third-body", "The drive acts on the cap."),
    (
        "rigid-upper",
        "heated-upper",
        "A rigid body does not expand.",
    ),
    (
        "rigid-upper",
        "wears",
        "What is rigid wears as a primary only.",
    ),
    (
        "rigid-upper",
        "roughness",
        "What is rigid keeps the role of a primary.",
    ),
    ("turning", "modes", "Frames turn in quasi-static steps."),
    (
        "turning",
        "complex-modes",
        "Frames turn in quasi-static steps.",
    ),
    ("turning", "implicit", "Frames turn in quasi-static steps."),
    ("turning", "explicit", "Frames turn in quasi-static steps."),
    (
        "turning",
        "implicit-explicit",
        "Frames turn in quasi-static steps.",
    ),
    ("turning", "floor", "A plane does not turn with an axle."),
    ("turning", "wall", "A plane does not turn with an axle."),
    ("turning", "kinematic", "A body has one frame."),
    ("turning", "kinematic-force", "A body has one frame."),
    (
        "turning",
        "distributing-force",
        "A reference point in space presses no longer along the axes of the frame.",
    ),
    (
        "turning",
        "distributing-held",
        "A reference point in space presses no longer along the axes of the frame.",
    ),
    ("turning", "weight", "Weight keeps its direction in space."),
    ("turning", "loose", "A push keeps its direction in space."),
    (
        "turning",
        "side-load",
        "A load keeps its direction in space.",
    ),
    (
        "turning",
        "bed-of-springs",
        "Springs keep their direction in space.",
    ),
    (
        "turning",
        "small-sliding",
        "Small sliding keeps the normals of the start.",
    ),
    ("turning", "belt", "A belt keeps its direction in space."),
    (
        "turning",
        "spring-across",
        "A spring along x keeps its direction.",
    ),
    (
        "turning",
        "stop-across",
        "A stop along x keeps its direction.",
    ),
    (
        "turning",
        "periodic",
        "Equations are along the axes of space.",
    ),
    (
        "turning",
        "kept-level",
        "Equations are along the axes of space.",
    ),
    (
        "turning",
        "let-go",
        "In a frame that turns there is nothing to show with it.",
    ),
    ("turning", "side-body", "The side body is pressed in space."),
    (
        "turning",
        "jack",
        "A cut in a body that turns is another matter.",
    ),
    (
        "turning",
        "bolt",
        "A cut in a body that turns is another matter.",
    ),
    (
        "node-to-facet",
        "two-sided",
        "Both sides are secondary by mortars alone.",
    ),
    (
        "two-sided",
        "wears",
        "Of two sides each has half of the pressure.",
    ),
    ("two-sided", "floor", "An obstacle has no points."),
    (
        "two-sided",
        "roughness",
        "Heights are those of one surface, and each is the secondary of half of the contact.",
    ),
    (
        "two-sided",
        "complex-modes",
        "Multipliers of both sides are not determined.",
    ),
    (
        "cycles",
        "loose",
        "An unconstrained body is not driven back and forth.",
    ),
    (
        "cycles",
        "distributing-held",
        "The guide is a mean, which leaves the body free to turn.",
    ),
    (
        "cycles",
        "jack",
        "A shortening is done in steps of their own.",
    ),
    ("cycles", "bolt", "A bolted joint is not slid by its top."),
    (
        "cycles",
        "axisymmetric",
        "What is around an axis does not slide back and forth.",
    ),
    ("bolt", "tied-cap", "The cap of the bolt is in its place."),
    ("bolt", "third-body", "The cap of the bolt is in its place."),
    (
        "bolt",
        "side-body",
        "The bolt stands where the side body is.",
    ),
    (
        "bolt",
        "periodic",
        "The lower body is longer beside the bolt.",
    ),
    (
        "bolt",
        "overhang",
        "The bolt stands where the upper body ends.",
    ),
    (
        "bolt",
        "wider",
        "The bolt stands where the upper body ends.",
    ),
    ("bolt", "interference", "The cap follows by the bolt alone."),
    (
        "bolt",
        "gap-taken-away",
        "The cap follows by the bolt alone.",
    ),
    ("bolt", "let-go", "There is no guide that lets go."),
    ("tied-cap", "third-body", "There is one cap."),
    ("tied-cap", "periodic", "The cap has sides of its own."),
    ("third-body", "periodic", "The cap has sides of its own."),
    (
        "third-body",
        "jack",
        "A cut in an unconstrained body draws nothing together.",
    ),
    (
        "third-body",
        "weight",
        "The weight of the middle one is what presses.",
    ),
    ("third-body", "kept-level", "The drive acts on the cap."),
    (
        "third-body",
        "complex-modes",
        "What slides steadily drags the body between the two to the limit of what holds it on its other side.",
    ),
    (
        "weight",
        "complex-modes",
        "Friction at its limit tips over what is pressed by its weight alone and guided at its top, where it is tall.",
    ),
    (
        "pressed",
        "complex-modes",
        "Friction at its limit tips over what a load presses and a guide holds at its top, where it is tall.",
    ),
    ("tied-foot", "periodic", "The foot has sides of its own."),
    (
        "side-body",
        "periodic",
        "The side body lies against one side.",
    ),
    (
        "side-body",
        "let-go",
        "The side body pushes what nothing guides.",
    ),
    (
        "side-body",
        "loose",
        "The side body pushes what nothing guides.",
    ),
    ("wall", "periodic", "A wall stands against one side."),
    (
        "periodic",
        "jack",
        "A cut meets the sides that equations bind.",
    ),
    ("periodic", "inside", "The upper body has no neighbour."),
    ("periodic", "overhang", "The upper body has another period."),
    ("periodic", "wider", "The upper body has another period."),
    ("jack", "weight", "There is one drive."),
    (
        "gap-taken-away",
        "interference",
        "There is one way to begin.",
    ),
    (
        "loose",
        "complex-modes",
        "Steady sliding drags an unconstrained body away.",
    ),
    ("loose", "belt", "A belt drags an unconstrained body away."),
    (
        "loose",
        "side-load",
        "Friction holds an unconstrained body, and what presses it may be less than what pushes it aside.",
    ),
    (
        "loose",
        "centrifugal",
        "Friction holds an unconstrained body, and what presses it may be less than what pushes it aside.",
    ),
    (
        "let-go",
        "side-load",
        "Friction holds what is let go, and what presses it may be less than what pushes it aside.",
    ),
    (
        "let-go",
        "centrifugal",
        "Friction holds what is let go, and what presses it may be less than what pushes it aside.",
    ),
    ("loose", "distributing-held", "There is one drive."),
    (
        "loose",
        "third-body",
        "Two unconstrained bodies on each other roll.",
    ),
    (
        "spring-across",
        "stop-across",
        "Their tables have one name.",
    ),
    (
        "spring-across",
        "dashpot-across",
        "Their tables have one name.",
    ),
    (
        "stop-across",
        "dashpot-across",
        "Their tables have one name.",
    ),
    (
        "spring-across",
        "rigid-lower",
        "The corner is one of a rigid body that is held.",
    ),
    (
        "wall",
        "press-and-slide",
        "The guide moves a corner into the wall.",
    ),
    (
        "wall",
        "press-and-release",
        "The guide moves a corner into the wall.",
    ),
    ("wall", "cycles", "The guide moves a corner into the wall."),
    (
        "third-body",
        "belt",
        "An unconstrained body between two equal frictions is at its limit.",
    ),
    (
        "bolt",
        "inside",
        "The cap is longer than the upper body is wide, and bends about its edges.",
    ),
    (
        "damped-contact",
        "unilateral",
        "A dashpot needs a pressure that follows from the gap.",
    ),
    (
        "rigid-upper",
        "displaced",
        "Each support of a rigid body holds its motions fully or not at all.",
    ),
    ("multigrid", "explicit", "An explicit step has no matrix."),
    (
        "mean-dilatation",
        "plane-stress",
        "Where the strain across is free nothing locks.",
    ),
    (
        "mean-dilatation",
        "incompatible-modes",
        "A body has one formulation.",
    ),
    ("press-and-release", "weight", "Weight stays."),
];

/// Why two features cannot go together, if so.
pub fn apart(a: &str, b: &str) -> Option<&'static str> {
    let is = |row: &&(&str, &str, &str)| (row.0, row.1) == (a, b) || (row.0, row.1) == (b, a);
    APART.iter().find(is).map(|row| row.2)
}
