//! Defects of places, surfaces and meshes.

use stickslip::assess::doctor::DoctorCause;

use super::Expected::{Found, Refused};
use super::models::{CUBES, LOAD, PRESS, RINGS, THROW};
use super::{Defect, defect, meshed};

pub const GEOMETRY: &[Defect] = &[
    defect(
        "the secondary is the far side of its body",
        PRESS,
        &[("upper.bottom", "upper.top")],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the primary is the far side of its body",
        CUBES,
        &[
            ("primary = \"lower.top\"", "primary = \"lower.bottom\""),
            ("set = \"lower.bottom\"", "set = \"lower.front\""),
        ],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the primary is a side wall",
        PRESS,
        &[("lower.top", "lower.right")],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the normal of the floor points down",
        LOAD,
        &[("normal = [0, 1]", "normal = [0, -1]")],
        Found(DoctorCause::NormalsNotOpposed, "base"),
    ),
    defect(
        "the floor lies above the block",
        LOAD,
        &[("point = [0, 0]", "point = [0, 0.05]")],
        Found(DoctorCause::NormalsNotOpposed, "base"),
    ),
    defect(
        "a gap that the prescribed displacement cannot close",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.01, 0.022], to = [0.03, 0.042]",
        )],
        Found(DoctorCause::InitialGap, "joint"),
    ),
    defect(
        "a block under load far above its floor",
        LOAD,
        &[("point = [0, 0]", "point = [0, -0.05]")],
        Found(DoctorCause::InitialGap, "block"),
    ),
    defect(
        "the bodies overlap",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.01, 0.016], to = [0.03, 0.036]",
        )],
        Found(DoctorCause::InitialOverlap, "joint"),
    ),
    defect(
        "the upper body lies beside the lower one",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.06, 0.02], to = [0.08, 0.04]",
        )],
        Found(DoctorCause::NothingOpposite, "joint"),
    ),
    meshed(
        "a cell is folded over",
        &[("5 0.02 0.02 0", "5 0.02 -0.02 0")],
        Refused("cell 21"),
    ),
    meshed(
        "a cell has collapsed",
        &[("5 0.02 0.02 0", "5 0.04 0.02 0")],
        Refused("cell 22 (quad4) has a collapsed"),
    ),
    meshed(
        "a cell is there twice",
        &[
            ("$Elements\n6", "$Elements\n7"),
            (
                "22 3 2 3 3 2 3 6 5",
                "22 3 2 3 3 2 3 6 5\n23 3 2 3 3 1 2 5 4",
            ),
        ],
        Refused("23 share one face"),
    ),
    meshed(
        "coincident nodes were not merged",
        &[
            ("22 3 2 3 3 2 3 6 5", "22 3 2 3 3 7 3 6 8"),
            ("12 1 2 1 1 2 3", "12 1 2 1 1 7 3"),
            ("14 1 2 2 2 5 6", "13 1 2 2 2 4 5"),
        ],
        Found(DoctorCause::DisconnectedBody, "block"),
    ),
    meshed(
        "a coordinate is no number",
        &[("5 0.02 0.02 0", "5 0.02 nan 0")],
        Refused("node 5"),
    ),
    defect(
        "a coarse primary against a fine secondary",
        PRESS,
        &[
            ("cells = [8, 4]", "cells = [1, 1]"),
            ("cells = [6, 6]", "cells = [12, 6]"),
        ],
        Found(DoctorCause::MeshMismatch, "lower"),
    ),
    defect(
        "a secondary that is far too coarse",
        PRESS,
        &[
            ("cells = [8, 4]", "cells = [40, 4]"),
            ("cells = [6, 6]", "cells = [2, 2]"),
        ],
        Found(DoctorCause::MeshMismatch, "joint"),
    ),
    defect(
        "one mesh in mm and one in m",
        PRESS,
        &[(
            "material = \"steel\" }",
            "material = \"steel\", scale = 1e3 }",
        )],
        Found(DoctorCause::MixedUnits, "lower"),
    )
    .also(&[
        DoctorCause::InitialOverlap,
        DoctorCause::MeshMismatch,
        DoctorCause::LostProjection,
    ]),
    defect(
        "a set that is misspelt",
        PRESS,
        &[("upper.bottom", "upper.botom")],
        Refused("upper.botom"),
    ),
    defect(
        "a body in contact with itself",
        PRESS,
        &[("primary = \"lower.top\"", "primary = \"upper.left\"")],
        Refused("interface.joint.primary"),
    ),
    meshed(
        "a cell that is next to nothing",
        &[
            ("6 0.04 0.02 0", "6 0.0200000000001 0.02 0"),
            ("3 0.04 0 0", "3 0.0200000000001 0 0"),
        ],
        Found(DoctorCause::CollapsedCell, "cell 22"),
    ),
    defect(
        "a mesh that was scaled twice",
        PRESS,
        &[(
            "material = \"steel\" }",
            "material = \"steel\", scale = 1e-3 }",
        )],
        Found(DoctorCause::MixedUnits, "lower"),
    )
    .also(&[DoctorCause::NothingOpposite]),
    defect(
        "a radius that is negative",
        RINGS,
        &[("from = [0.012, 0.01]", "from = [-0.002, 0.01]")],
        Refused("body q"),
    ),
    defect(
        "two interfaces between the same surfaces",
        PRESS,
        &[(
            "support.base",
            "interface.again = { secondary = \"upper.bottom\", primary = \"lower.top\" }\nsupport.base",
        )],
        Found(DoctorCause::DoubledInterface, "again"),
    ),
    defect(
        "the same surfaces joined both ways",
        PRESS,
        &[(
            "support.base",
            "interface.back = { secondary = \"lower.top\", primary = \"upper.bottom\" }\nsupport.base",
        )],
        Found(DoctorCause::DoubledInterface, "back"),
    ),
    defect(
        "primary and secondary are one surface",
        PRESS,
        &[("primary = \"lower.top\"", "primary = \"upper.bottom\"")],
        Refused("interface.joint.primary"),
    ),
    defect(
        "an obstacle as secondary",
        LOAD,
        &[(
            "secondary = \"block.bottom\", primary = \"floor\"",
            "secondary = \"floor\", primary = \"block.bottom\"",
        )],
        Refused("interface.base.secondary"),
    ),
    defect(
        "the wall is two metres away",
        THROW,
        &[("point = [0, 0]", "point = [0, -2]")],
        Found(DoctorCause::InitialGap, "base"),
    ),
    meshed(
        "a group of the mesh that is misspelt",
        &[("1 1 \"bottom\"", "1 1 \"botom\"")],
        Refused("interface.base.secondary"),
    ),
    meshed(
        "a node that no list has",
        &[("21 3 2 3 3 1 2 5 4", "21 3 2 3 3 1 2 5 9")],
        Refused("node 9"),
    ),
    defect(
        "two blocks are pressed together and no interface joins them",
        PRESS,
        &[(
            "interface.joint = { secondary = \"upper.bottom\", primary = \"lower.top\", friction.coulomb = { mu = 0.3 } }\n",
            "",
        )],
        Found(DoctorCause::MissingInterface, "upper"),
    ),
    defect(
        "two blocks overlap and no interface joins them",
        PRESS,
        &[
            (
                "interface.joint = { secondary = \"upper.bottom\", primary = \"lower.top\", friction.coulomb = { mu = 0.3 } }\n",
                "",
            ),
            (
                "from = [0.01, 0.02], to = [0.03, 0.04]",
                "from = [0.01, 0.012], to = [0.03, 0.032]",
            ),
        ],
        Found(DoctorCause::MissingInterface, "lower"),
    ),
    defect(
        "a block moves into a stop that no interface has",
        PRESS,
        &[
            ("x = 0, y = -1e-5", "x = 2e-5, y = -1e-5"),
            (
                "step =",
                "body.stop = { generate.rectangle = { from = [0.03001, 0.021], to = [0.034, 0.04], cells = [3, 7] }, material = \"steel\" }\nsupport.stop = { set = \"stop\", x = 0, y = 0 }\nstep =",
            ),
        ],
        Found(DoctorCause::MissingInterface, "stop"),
    ),
    defect(
        "a loaded block comes to lie in a neighbour that no interface has",
        LOAD,
        &[
            ("traction.value = [1e7, 0]", "traction.value = [1e6, 0]"),
            (
                "step =",
                "body.wall = { generate.rectangle = { from = [0.040001, 0.001], to = [0.05, 0.03], cells = [3, 9] }, material = \"steel\" }\nsupport.wall = { set = \"wall\", x = 0, y = 0 }\nstep =",
            ),
        ],
        Found(DoctorCause::MissingInterface, "wall"),
    ),
    defect(
        "a second block falls through the floor of the first",
        THROW,
        &[(
            "step =",
            "body.second = { generate.rectangle = { from = [0.05, 0.0001], to = [0.07, 0.0101], cells = [2, 1] }, material = \"steel\" }\ninitial.second = { set = \"second\", velocity = [0, -10] }\nstep =",
        )],
        Found(DoctorCause::MissingInterface, "second"),
    ),
];
