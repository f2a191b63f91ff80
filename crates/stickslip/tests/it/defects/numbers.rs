//! Defects of numbers: units, laws, materials, speeds.

use stickslip::assess::doctor::DoctorCause;

use super::Expected::{Found, Refused};
use super::models::{AXLE, BOLT, COMPLIANT, CUBES, HOT, LOAD, PRESS, SLIDE, THROW};
use super::{Defect, defect};

pub const NUMBERS: &[Defect] = &[
    defect(
        "friction too large by a decimal",
        PRESS,
        &[("mu = 0.3", "mu = 3")],
        Found(DoctorCause::LargeFriction, "joint"),
    ),
    defect(
        "friction above the coupling limit of a skewed material",
        LOAD,
        &[
            (
                "material.steel.isotropic = { young = 210e9, poisson = 0.3 }",
                "material.steel.anisotropic = { stiffness = [[30e9, 10e9, 10e9, 0, 0, 0], [10e9, 100e9, 10e9, 70e9, 0, 0], [10e9, 10e9, 100e9, 0, 0, 0], [0, 70e9, 0, 55e9, 0, 0], [0, 0, 0, 0, 50e9, 0], [0, 0, 0, 0, 0, 50e9]] }",
            ),
            ("mu = 0.3", "mu = 1.4"),
        ],
        Found(DoctorCause::CoulombNonUniqueness, "base"),
    ),
    defect(
        "one modulus in MPa",
        PRESS,
        &[("young = 170e9", "young = 170e3")],
        Found(DoctorCause::MixedUnits, "upper"),
    ),
    defect(
        "one modulus in GPa",
        CUBES,
        &[
            (
                "cells = [4, 4, 4] }, material = \"steel\"",
                "cells = [4, 4, 4] }, material = \"iron\"",
            ),
            (
                "step =",
                "material.iron.isotropic = { young = 170, poisson = 0.3 }\nstep =",
            ),
        ],
        Found(DoctorCause::MixedUnits, "upper"),
    ),
    defect(
        "moduli in Pa and lengths in mm",
        CUBES,
        &[
            ("young = 210e3", "young = 210e9"),
            ("to = [10, 10, 10], cells", "to = [40, 10, 10], cells"),
        ],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "moduli in MPa and lengths in m",
        PRESS,
        &[
            (
                "young = 210e9, poisson = 0.3, density = 7850",
                "young = 210e3, poisson = 0.3",
            ),
            (
                "young = 170e9, poisson = 0.3, density = 7200",
                "young = 170e3, poisson = 0.3",
            ),
        ],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "a density in tonnes",
        THROW,
        &[("density = 7850", "density = 7.85e-9")],
        Found(DoctorCause::MixedUnits, "block"),
    ),
    defect(
        "one row of a law in other units",
        PRESS,
        &[(
            "friction.coulomb",
            "normal.tabular.table = [[0, 0], [1e-7, 1e4], [2e-7, 2e7], [3e-7, 4e7]], friction.coulomb",
        )],
        Found(DoctorCause::LawTangentJump, "joint"),
    ),
    defect(
        "a thickness in millimetres",
        PRESS,
        &[(
            "model.space = \"plane-strain\"",
            "model = { space = \"plane-strain\", thickness = 20 }",
        )],
        Found(DoctorCause::MixedUnits, "model.thickness"),
    ),
    defect(
        "a density a thousand times too large in one body",
        PRESS,
        &[("density = 7850", "density = 7850e3")],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "a law that is far too soft",
        COMPLIANT,
        &[("c = 1e14", "c = 1e5")],
        Found(DoctorCause::LawOutOfRange, "joint"),
    ),
    defect(
        "a law that is stiffer than numbers go",
        COMPLIANT,
        &[("c = 1e14", "c = 1e60")],
        Found(DoctorCause::LawOutOfRange, "joint"),
    ),
    defect(
        "a power law that is far too stiff",
        COMPLIANT,
        &[(
            "normal.linear = { c = 1e14 }",
            "normal.power-law = { c = 1e60, m = 2 }",
        )],
        Found(DoctorCause::LawOutOfRange, "joint"),
    ),
    defect(
        "twenty times the speed of sound",
        THROW,
        &[("velocity = [0, -10]", "velocity = [0, -1e5]")],
        Found(DoctorCause::TooFast, "fall"),
    ),
    defect(
        "velocities in millimetres",
        THROW,
        &[("velocity = [0, -10]", "velocity = [0, -10e3]")],
        Found(DoctorCause::TooFast, "fall"),
    ),
    defect(
        "Poisson's ratio of one half",
        PRESS,
        &[(
            "young = 170e9, poisson = 0.3",
            "young = 170e9, poisson = 0.5",
        )],
        Refused("material.iron"),
    ),
    defect(
        "a negative coefficient of friction",
        PRESS,
        &[("mu = 0.3", "mu = -0.3")],
        Refused("interface.joint.friction.coulomb.mu"),
    ),
    defect(
        "modulus and Poisson's ratio exchanged",
        LOAD,
        &[(
            "young = 210e9, poisson = 0.3",
            "young = 0.3, poisson = 210e9",
        )],
        Refused("material.steel"),
    ),
    defect(
        "a coefficient of friction in per cent",
        LOAD,
        &[("mu = 0.3", "mu = 30")],
        Found(DoctorCause::LargeFriction, "base"),
    )
    .also(&[DoctorCause::CoulombNonUniqueness]),
    defect(
        "no density in a dynamic step",
        THROW,
        &[(", density = 7850", "")],
        Refused("material.steel"),
    ),
    defect(
        "a pressure in pascals among megapascals",
        CUBES,
        &[(
            "step =",
            "load.weight = { set = \"upper.right\", pressure.value = 1e9 }\nstep =",
        )],
        Found(DoctorCause::LargeStrain, "weight"),
    ),
    defect(
        "wear a million times too fast",
        SLIDE,
        &[
            (
                "friction.coulomb = { mu = 0.3 }",
                "friction.coulomb = { mu = 0.3 }, wear.archard.coefficient = 2.9e-8",
            ),
            (
                "{ name = \"press\" }, { name = \"slide\" }",
                "{ name = \"press\", increments.fixed = 2 }, { name = \"slide\", increments.fixed = 2 }",
            ),
        ],
        Found(DoctorCause::LawOutOfRange, "interface.joint.wear.archard"),
    ),
    defect(
        "Archard's coefficient without the hardness",
        SLIDE,
        &[
            (
                "friction.coulomb = { mu = 0.3 }",
                "friction.coulomb = { mu = 0.3 }, wear.archard.coefficient = 1e-4",
            ),
            (
                "{ name = \"press\" }, { name = \"slide\" }",
                "{ name = \"press\", increments.fixed = 2 }, { name = \"slide\", increments.fixed = 2 }",
            ),
        ],
        Found(DoctorCause::LawOutOfRange, "interface.joint.wear.archard"),
    ),
    defect(
        "wear over energy a million times too fast, of the primary",
        SLIDE,
        &[
            (
                "friction.coulomb = { mu = 0.3 }",
                "friction.coulomb = { mu = 0.3 }, wear.dissipated-energy = { coefficient = 3e-14, primary-coefficient = 3e-7 }",
            ),
            (
                "{ name = \"press\" }, { name = \"slide\" }",
                "{ name = \"press\", increments.fixed = 2 }, { name = \"slide\", increments.fixed = 2 }",
            ),
        ],
        Found(DoctorCause::LawOutOfRange, "its primary, body lower"),
    ),
    defect(
        "an expansion in millionths",
        HOT,
        &[("expansion = 12e-6", "expansion = 12")],
        Found(DoctorCause::LargeStrain, "body.upper.material"),
    )
    .also(&[DoctorCause::TooLargeSlip, DoctorCause::LostProjection]),
    defect(
        "a roughness in metres",
        PRESS,
        &[(
            "mu = 0.3 }",
            "mu = 0.3 }, roughness.wave = { amplitude = 5e-3, wavelength = [0.02] }",
        )],
        Found(DoctorCause::LargeStrain, "interface.joint.roughness"),
    )
    .also(&[DoctorCause::InitialOverlap]),
    defect(
        "blocks that are strained by a tenth",
        PRESS,
        &[("y = -1e-5", "y = -4e-3")],
        Found(DoctorCause::LargeStrain, "body upper is strained"),
    ),
    defect(
        "waves that are shorter than two cells",
        PRESS,
        &[(
            "mu = 0.3 }",
            "mu = 0.3 }, roughness.wave = { amplitude = 1e-7, wavelength = [1e-4] }",
        )],
        Found(
            DoctorCause::UnresolvedRoughness,
            "interface.joint.roughness",
        ),
    ),
    defect(
        "a bolt of eight newtons",
        BOLT,
        &[("force = 8e3", "force = 8")],
        Found(DoctorCause::LooseBolt, "step.1.pretension.left"),
    ),
    defect(
        "a bolt that pushes",
        BOLT,
        &[("force = 8e3", "force = -8e3")],
        Found(DoctorCause::LooseBolt, "step.1.pretension.left"),
    ),
    defect(
        "an axle in millimetres",
        AXLE,
        &[("point = [0, -0.02]", "point = [0, -20]")],
        Found(DoctorCause::MixedUnits, "reference.axle.point"),
    )
    // So far away rounding of rotations is felt.
    .also(&[DoctorCause::NotConverged, DoctorCause::Chatter]),
    defect(
        "an axle that turns in degrees",
        AXLE,
        &[("rotation-z = 0.5", "rotation-z = 30")],
        Found(DoctorCause::MixedUnits, "support.turn"),
    ),
];
