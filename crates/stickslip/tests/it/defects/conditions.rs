//! Defects of supports, loads, amplitudes and steps.

use stickslip::assess::doctor::DoctorCause;

use super::Expected::{Found, Refused};
use super::models::{BOLT, CUBES, DRAG, HOT, LANDING, LED, LOAD, PRESS, RAIL, SLIDE, THROW};
use super::{Defect, defect};

pub const CONDITIONS: &[Defect] = &[
    defect(
        "a support holds one direction too few",
        PRESS,
        &[
            ("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
            ("set = \"upper.top\", x = 0,", "set = \"upper.top\","),
        ],
        Found(DoctorCause::FreeRigidMode, "upper"),
    ),
    defect(
        "the support of the lower body is missing",
        PRESS,
        &[(
            "support.base = { set = \"lower.bottom\", x = 0, y = 0 }\n",
            "",
        )],
        Found(DoctorCause::FreeRigidMode, "lower"),
    ),
    defect(
        "a body that nothing holds",
        PRESS,
        &[(
            "step =",
            "body.loose = { generate.rectangle = { from = [0, 1], to = [0.02, 1.02], cells = [2, 2] }, material = \"steel\" }\nstep =",
        )],
        Found(DoctorCause::FreeRigidMode, "loose"),
    ),
    defect(
        "no friction where friction has to hold the block",
        LOAD,
        &[("friction.coulomb = { mu = 0.3 }", "friction.none = {}")],
        Found(DoctorCause::FreeRigidMode, "block"),
    ).also(&[DoctorCause::SlidesAway]),
    defect(
        "a cube without lateral support",
        CUBES,
        &[
            ("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
            ("x = 2e-3, y = 0, z = -2e-2", "z = -2e-2"),
        ],
        Found(DoctorCause::FreeRigidMode, "upper"),
    ),
    defect(
        "friction without anything that presses",
        PRESS,
        &[("x = 0, y = -1e-5", "x = 1e-5, y = 0")],
        Found(DoctorCause::FrictionWithoutPressure, "joint"),
    ),
    defect(
        "a prescribed displacement of zero",
        PRESS,
        &[("y = -1e-5", "y = 0")],
        Found(DoctorCause::NothingActs, "step"),
    ),
    defect(
        "a push beyond the limit of friction",
        LOAD,
        &[("traction.value = [1e7, 0]", "traction.value = [2e8, 0]")],
        Found(DoctorCause::SlidesAway, "block"),
    ),
    defect(
        "a slide over several facets in one increment",
        PRESS,
        &[
            ("x = 0, y = -1e-5", "x = 0.012, y = -1e-5"),
            (
                "step = [{ name = \"press\" }]",
                "step = [{ name = \"press\", increments = { fixed = 1 } }]\nsolver = { max-iterations = 2, tolerance = 1e-14 }",
            ),
        ],
        Found(DoctorCause::TooLargeSlip, "joint"),
    ),
    defect(
        "an explicit increment above the stable one",
        THROW,
        &[
            (
                "dynamic = {}",
                "dynamic = { scheme.central-difference = {} }",
            ),
            ("fixed = 20", "fixed = 2"),
        ],
        Found(DoctorCause::Stopped, "stable"),
    ),
    defect(
        "a support on the surface of contact",
        PRESS,
        &[("set = \"upper.top\"", "set = \"upper.bottom\"")],
        Found(DoctorCause::SupportOnContact, "top"),
    ),
    defect(
        "a support of the base on the surface of contact",
        CUBES,
        &[("set = \"lower.bottom\"", "set = \"lower.top\"")],
        Found(DoctorCause::SupportOnContact, "base"),
    ),
    defect(
        "a load on the surface of contact",
        LOAD,
        &[("set = \"block.top\"", "set = \"block.bottom\"")],
        Found(DoctorCause::LoadOnContact, "weight"),
    ).also(&[DoctorCause::SlidesAway]),
    defect(
        "both bodies move alike",
        PRESS,
        &[("set = \"lower.bottom\", x = 0, y = 0", "set = \"lower.bottom\", x = 0, y = -1e-5")],
        Found(DoctorCause::NeverCarried, "joint"),
    ),
    defect(
        "a flight that ends before the floor",
        THROW,
        &[("duration = 2e-5", "duration = 2e-7")],
        Found(DoctorCause::InitialGap, "base"),
    ),
    defect(
        "an amplitude that jumps within one increment",
        SLIDE,
        &[("[[1, 0], [2, 1]]", "[[1, 0], [1.5, 0], [1.5000001, 1], [2, 1]]")],
        Found(DoctorCause::SuddenChange, "along"),
    ),
    defect(
        "an amplitude that begins with its full value",
        SLIDE,
        &[("down.table = [[0, 0], [1, 1]]", "down.table = [[0, 1], [1, 1]]")],
        Found(DoctorCause::SuddenChange, "down"),
    ),
    defect(
        "sliding before pressing",
        SLIDE,
        &[("down.table = [[0, 0], [1, 1]]", "down.table = [[1, 0], [2, 1]]"), ("along.table = [[1, 0], [2, 1]]", "along.table = [[0, 0], [1, 1]]")],
        Found(DoctorCause::FrictionWithoutPressure, "step press"),
    ),
    defect(
        "an amplitude that goes on beyond the analysis",
        SLIDE,
        &[("down.table = [[0, 0], [1, 1]]", "down.table = [[0, 0], [1000, 1]]")],
        Found(DoctorCause::AmplitudeUnused, "down"),
    ),
    defect(
        "an amplitude that begins after the analysis",
        SLIDE,
        &[("along.table = [[1, 0], [2, 1]]", "along.table = [[10, 0], [20, 1]]")],
        Found(DoctorCause::NothingActs, "along"),
    ),
    defect(
        "a bar pressed by half its height",
        PRESS,
        &[("y = -1e-5", "y = -1e-2")],
        Found(DoctorCause::LargeStrain, "upper"),
    ),
    defect(
        "a body pulled to twice its length",
        PRESS,
        &[
            ("set = \"lower.bottom\", x = 0, y = 0", "set = \"lower.bottom\", y = 0"),
            ("support.top", "support.side = { set = \"lower.right\", x = 0.04 }\nsupport.hold = { set = \"lower.left\", x = 0 }\nsupport.top"),
        ],
        Found(DoctorCause::LargeStrain, "side"),
    ),
    defect(
        "a body thrown away from the wall",
        THROW,
        &[("velocity = [0, -10]", "velocity = [0, 10]")],
        Found(DoctorCause::MovesApart, "block"),
    ),
    defect(
        "a displacement with the wrong sign",
        PRESS,
        &[("y = -1e-5", "y = 1e-5")],
        Found(DoctorCause::MovesApart, "joint"),
    ),
    defect(
        "a pressure with the wrong sign",
        LOAD,
        &[("pressure.value = 1e8", "pressure.value = -1e8")],
        Found(DoctorCause::SlidesAway, "block"),
    ),
    defect(
        "a load that is listed in no step",
        LOAD,
        &[("name = \"load\"", "name = \"load\", loads = [\"weight\"]")],
        Found(DoctorCause::NothingActs, "push"),
    ),
    defect(
        "an interface that is listed in no step",
        PRESS,
        &[("name = \"press\"", "name = \"press\", interfaces = []")],
        Found(DoctorCause::NothingActs, "joint"),
    )
    .also(&[DoctorCause::MissingInterface]),
    defect(
        "a load under a name that is not there",
        LOAD,
        &[("name = \"load\"", "name = \"load\", loads = [\"wieght\"]")],
        Refused("wieght"),
    ),
    defect(
        "an amplitude that runs back in time",
        SLIDE,
        &[("[[1, 0], [2, 1]]", "[[2, 0], [1, 1]]")],
        Refused("amplitude.along.table"),
    ),
    defect(
        "a support of a direction that the plane has not",
        PRESS,
        &[("y = -1e-5", "y = -1e-5, z = 0")],
        Refused("support.top.z"),
    ),
    defect(
        "a step leaves out the support that presses",
        SLIDE,
        &[("{ name = \"slide\" }", "{ name = \"slide\", supports = [\"base\", \"along\"] }")],
        Found(DoctorCause::LetGo, "down"),
    ),
    defect(
        "a step leaves out the load that presses",
        LOAD,
        &[("{ name = \"load\" }", "{ name = \"load\" }, { name = \"rest\", loads = [] }")],
        Found(DoctorCause::LetGo, "weight"),
    ),
    defect(
        "an amplitude that nothing has",
        SLIDE,
        &[("step =", "amplitude.spare.table = [[0, 0], [1, 1]]\nstep =")],
        Found(DoctorCause::Unused, "amplitude.spare"),
    ),
    defect(
        "a material and a set that nothing has",
        LED,
        &[(
            "step =",
            "material.spare.isotropic = { young = 1e9, poisson = 0.3 }\nset.spare.of = \"block\"\nset.spare.box = { from = [0, 0], to = [1, 1] }\nstep =",
        )],
        Found(DoctorCause::Unused, "material.spare, set.spare"),
    ),
    defect(
        "an obstacle that no interface has",
        PRESS,
        &[("step =", "obstacle.wall.plane = { point = [0.031, 0], normal = [-1, 0] }\nstep =")],
        Found(DoctorCause::Unused, "obstacle.wall"),
    ),
    defect(
        "a velocity of nothing but the surface of contact",
        THROW,
        &[("set = \"block\", velocity", "set = \"block.bottom\", velocity")],
        Found(DoctorCause::NothingActs, "fall"),
    ),
    defect(
        "a step lets the bolt go",
        BOLT,
        &[("hold = true", "force = 0")],
        Found(DoctorCause::LetGo, "step.2.pretension.left"),
    )
    .also(&[DoctorCause::FreeRigidMode, DoctorCause::SlidesAway]),
    defect(
        "an amplitude that tells of two cycles",
        SLIDE,
        &[
            ("[[1, 0], [2, 1]]", "[[1, 0], [1.25, 1], [1.75, -1], [2, 0], [2.25, 1], [2.75, -1], [3, 0]]"),
            ("name = \"slide\"", "name = \"slide\", cycles = { count = 2 }"),
        ],
        Found(DoctorCause::AmplitudeUnused, "step slide with its 2 cycles"),
    ),
    defect(
        "an amplitude that turns round after the analysis",
        SLIDE,
        &[("[[1, 0], [2, 1]]", "[[1, 0], [2, 1], [3, -1]]")],
        Found(DoctorCause::AmplitudeUnused, "support.along.amplitude"),
    ),
    defect(
        "no temperature at the start",
        HOT,
        &[("initial.cold = { set = \"upper\", temperature.uniform.value = 20 }\n", "")],
        Found(DoctorCause::StartTemperature, "temperature.hot"),
    ),
    defect(
        "a temperature that comes at once in motion",
        THROW,
        &[(
            "step =",
            "material.steel.expansion = 12e-6\ntemperature.hot = { set = \"block\", uniform.value = 50 }\nstep =",
        )],
        Found(DoctorCause::SuddenChange, "temperature.hot"),
    ),
    defect(
        "a kinematic coupling over the surface of contact",
        PRESS,
        &[(
            "step =",
            "reference.middle.point = [0.02, 0.03]\ncoupling.lead.kinematic = { set = \"upper.bottom\", reference = \"middle\" }\nstep =",
        )],
        Found(DoctorCause::SupportOnContact, "coupling.lead"),
    )
    // A rigid face on a smooth one touches at its ends first.
    .also(&[DoctorCause::NotConverged, DoctorCause::Chatter]),
    defect(
        "both surfaces of an interface on one body",
        PRESS,
        &[("primary = \"lower.top\"", "primary = \"upper.top\"")],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    )
    .also(&[DoctorCause::MissingInterface]),
    defect(
        "a slide beyond the edge of the primary",
        SLIDE,
        &[("x = 1e-5, amplitude", "x = 0.05, amplitude")],
        Found(DoctorCause::LeftPrimary, "joint"),
    ),
    defect(
        "a step leaves out the support that holds against a load",
        LOAD,
        &[
            ("traction.value = [1e7, 0]", "traction.value = [1e8, 0]"),
            (
                "step = [{ name = \"load\" }]",
                "support.guide = { set = \"block.right\", x = 0 }\nstep = [{ name = \"load\" }, { name = \"slide\", supports = [] }]",
            ),
        ],
        Found(DoctorCause::SlidesAway, "support.guide"),
    ),
    defect(
        "a drag that comes to the limit of friction",
        DRAG,
        &[("traction.value = [2e6, 0]", "traction.value = [5e6, 0]")],
        Found(DoctorCause::SlidesAway, "upper"),
    ),
    defect(
        "a block on a round rail that nothing guides",
        RAIL,
        &[("support.guide = { set = \"block.top\", x = 0 }\n", "")],
        Found(DoctorCause::FreeRigidMode, "nothing guides body block"),
    )
    .also(&[DoctorCause::SlidesAway]),
    defect(
        "a landing that the load stands beside",
        LANDING,
        &[("step =", "load.end = { set = \"beam.right\", traction.value = [0, -1e6] }\nstep =")],
        Found(DoctorCause::SlidesAway, "tips over"),
    ),
];
