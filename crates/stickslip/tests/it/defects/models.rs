//! Sound models, of which each planted defect spoils one.

/// Two blocks of steel in the plane, the lower one held, and what is said of them.
macro_rules! blocks {
    ($more:literal) => {
        concat!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.02], to = [0.03, 0.04], cells = [6, 6] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
"#,
            $more
        )
    };
}

/// Two blocks in the plane, pressed together by a prescribed displacement. Lengths in m.
pub const PRESS: &str = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.02], to = [0.03, 0.04], cells = [6, 6] }, material = "iron" }
material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7850 }
material.iron.isotropic = { young = 170e9, poisson = 0.3, density = 7200 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#;

/// A block on a rigid floor under a pressure, held by friction alone.
pub const LOAD: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb = { mu = 0.3 } }
load.weight = { set = "block.top", pressure.value = 1e8 }
load.push = { set = "block.left", traction.value = [1e7, 0] }
step = [{ name = "load" }]
"#;

/// Two cubes in space, pressed and slid. Lengths in mm, moduli in MPa.
pub const CUBES: &str = r#"
format = 1
model.space = "solid"
body.lower = { generate.box = { to = [10, 10, 10], cells = [3, 3, 3] }, material = "steel" }
body.upper = { generate.box = { from = [1, 1, 10], to = [9, 9, 18], cells = [4, 4, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e3, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
support.top = { set = "upper.top", x = 2e-3, y = 0, z = -2e-2 }
step = [{ name = "press" }]
"#;

/// A block that is thrown at a floor.
pub const THROW: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { from = [0, 0.001], to = [0.04, 0.021], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7850 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
initial.fall = { set = "block", velocity = [0, -10] }
step = [{ name = "fall", duration = 2e-5, increments = { fixed = 20 }, dynamic = {} }]
"#;

/// Two cells of Gmsh on a floor; the mesh is written next to the case.
pub const MESHED: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { gmsh.file = "block.msh", material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
support.top = { set = "block.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#;

pub const MESH: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 \"bottom\"
1 2 \"top\"
2 3 \"steel\"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 0.02 0 0
3 0.04 0 0
4 0 0.02 0
5 0.02 0.02 0
6 0.04 0.02 0
7 0.02 0 0
8 0.02 0.02 0
$EndNodes
$Elements
6
11 1 2 1 1 1 2
12 1 2 1 1 2 3
13 1 2 2 2 4 5
14 1 2 2 2 5 6
21 3 2 3 3 1 2 5 4
22 3 2 3 3 2 3 6 5
$EndElements
";

/// Two blocks, pressed together in a first step and slid in a second one.
pub const SLIDE: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.down = { set = "upper.top", y = -1e-5, amplitude = "down" }
support.along = { set = "upper.top", x = 1e-5, amplitude = "along" }
amplitude.down.table = [[0, 0], [1, 1]]
amplitude.along.table = [[1, 0], [2, 1]]
step = [{ name = "press" }, { name = "slide" }]
"#
);

/// A ring pressed on another one. Radius and axis.
pub const RINGS: &str = r#"
format = 1
model.space = "axisymmetric"
body.a = { generate.rectangle = { from = [0.01, 0], to = [0.03, 0.01], cells = [4, 2] }, material = "steel" }
body.q = { generate.rectangle = { from = [0.012, 0.01], to = [0.028, 0.02], cells = [5, 3] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
interface.joint = { secondary = "q.bottom", primary = "a.top" }
support.base = { set = "a.bottom", x = 0, y = 0 }
support.top = { set = "q.top", x = 0, y = -1e-6 }
step = [{ name = "press" }]
"#;

/// Two blocks, the upper one with a compliant surface.
pub const COMPLIANT: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", normal.linear = { c = 1e14 }, friction.coulomb = { mu = 0.3 } }
support.top = { set = "upper.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#
);

/// Two blocks that are glued together and pulled, the upper one by an equation.
pub const GLUED: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", tied = true }
support.top = { set = "upper.top", x = 0, y = 1e-5 }
step = [{ name = "pull" }]
"#
);

/// A block that an equation alone pulls.
pub const LED: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
set.corner.of = "block"
set.corner.box = { from = [0.039, 0.019], to = [0.041, 0.021] }
support.base = { set = "block.bottom", x = 0, y = 0 }
coupling.pull.equation = { terms = [{ set = "corner", component = "x", factor = 1 }, { set = "corner", component = "y", factor = 1 }], value = 1e-6 }
step = [{ name = "pull" }]
"#;

/// Two blocks side by side, with nothing between them, pressed on a floor; the sides that touch do not move across.
pub const BESIDE: &str = r#"
format = 1
model.space = "plane-strain"
body.left = { generate.rectangle = { to = [0.02, 0.02], cells = [4, 4] }, material = "steel" }
body.right = { generate.rectangle = { from = [0.02, 0], to = [0.04, 0.02], cells = [5, 3] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.one = { secondary = "left.bottom", primary = "floor" }
interface.two = { secondary = "right.bottom", primary = "floor" }
support.still = { set = "left.right", x = 0 }
support.stiller = { set = "right.left", x = 0 }
load.weight = { set = "left.top", pressure.value = 1e7 }
load.more = { set = "right.top", pressure.value = 1e7 }
step = [{ name = "press" }]
"#;

/// Two blocks that overlap and are one by equations.
pub const PINNED: &str = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0, 0.01], to = [0.04, 0.03], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = 1e-6 }
set.line.of = "lower"
set.line.box = { from = [-0.001, 0.009], to = [0.041, 0.011] }
coupling.across.equation = { terms = [{ set = "line", component = "x", factor = 1 }, { set = "upper.bottom", component = "x", factor = -1 }] }
coupling.up.equation = { terms = [{ set = "line", component = "y", factor = 1 }, { set = "upper.bottom", component = "y", factor = -1 }] }
step = [{ name = "pull" }]
"#;

/// Two blocks, pressed by a displacement and then by a load in its place, and let go by an amplitude.
pub const HANDED: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.down = { set = "upper.top", x = 0, y = -1e-6 }
support.rail = { set = "upper.top", x = 0 }
load.weight = { set = "upper.top", pressure.value = 1e7 }
step = [{ name = "touch", supports = ["base", "down"], loads = [] }, { name = "press", supports = ["base", "rail"] }]
"#
);

/// A plate under a yoke that a bolt draws down, tightened in a first step and held in a second.
pub const BOLT: &str = r#"
format = 1
model.space = "plane-stress"
model.thickness = 0.02
body.base = { generate.rectangle = { from = [0, -0.01], to = [0.06, 0], cells = [12, 3] }, material = "steel" }
body.plate = { generate.rectangle = { from = [0.012, 0], to = [0.048, 0.01], cells = [9, 3] }, material = "steel" }
body.yoke = { generate.rectangle = { from = [0, 0.01], to = [0.06, 0.03], cells = [12, 5] }, material = "steel" }
body.left = { generate.rectangle = { from = [0, 0], to = [0.01, 0.01], cells = [3, 4] }, material = "steel" }
body.right = { generate.rectangle = { from = [0.05, 0], to = [0.06, 0.01], cells = [3, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
interface.thread = { secondary = "left.bottom", primary = "base.top", tied = true }
interface.foot = { secondary = "right.bottom", primary = "base.top", tied = true }
interface.head = { secondary = "left.top", primary = "yoke.bottom", tied = true }
interface.hinge = { secondary = "right.top", primary = "yoke.bottom", tied = true }
interface.seat = { secondary = "plate.top", primary = "yoke.bottom" }
interface.joint = { secondary = "plate.bottom", primary = "base.top", friction.coulomb = { mu = 0.2 } }
pretension.left = { of = "left", plane = { point = [0.005, 0.005], normal = [0, 1] } }
support.ground = { set = "base.bottom", x = 0, y = 0 }
support.rail = { set = "plate.right", x = 0 }
step = [{ name = "tighten", pretension.left = { force = 8e3 } }, { name = "serve", pretension.left = { hold = true } }]
"#;

/// Two blocks that are pressed together and turned by an axle, both with it.
pub const AXLE: &str = r#"
format = 1
model.space = "plane-strain"
reference.axle.point = [0, -0.02]
body.lower = { generate.rectangle = { from = [-0.02, -0.02], to = [0.02, 0], cells = [6, 3] }, material = "steel", rotation.with = "axle" }
body.upper = { generate.rectangle = { from = [-0.01, 0], to = [0.01, 0.02], cells = [4, 4] }, material = "steel", rotation.with = "axle" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.press = { set = "upper.top", x = 0, y = -1e-6 }
support.turn = { set = "axle", x = 0, y = 0, rotation-z = 0.5, amplitude = "turn" }
amplitude.turn.table = [[1, 0], [2, 1]]
step = [{ name = "press" }, { name = "turn", increments.fixed = 2 }]
"#;

/// A block on another one that is hot, and whose temperature at the start is given.
pub const HOT: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.top = { set = "upper.top", x = 0, y = -1e-5 }
material.steel.expansion = 12e-6
initial.cold = { set = "upper", temperature.uniform.value = 20 }
temperature.hot = { set = "upper", uniform.value = 50 }
step = [{ name = "heat" }]
"#
);

/// A block that is dragged over another one by a load, up to two thirds of what friction holds.
pub const DRAG: &str = blocks!(
    r#"interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
load.weight = { set = "upper.top", pressure.value = 1e7, amplitude = "down" }
load.drag = { set = "upper.left", traction.value = [2e6, 0], amplitude = "along" }
amplitude.down.table = [[0, 0], [1, 1]]
amplitude.along.table = [[0, 0], [1, 0], [2, 1]]
step = [{ name = "press", increments.fixed = 2 }, { name = "drag", increments.fixed = 5 }]
"#
);

/// A long block across a narrow one, loaded over it.
pub const LANDING: &str = r#"
format = 1
model.space = "plane-strain"
body.post = { generate.rectangle = { from = [-0.004, -0.02], to = [0.004, 0], cells = [4, 6] }, material = "steel" }
body.beam = { generate.rectangle = { from = [-0.02, 0], to = [0.02, 0.01], cells = [20, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
interface.seat = { secondary = "beam.bottom", primary = "post.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "post.bottom", x = 0, y = 0 }
load.weight = { set = "beam.top", pressure.value = 1e5 }
step = [{ name = "load" }]
"#;

/// A block on a round rail, guided where it is loaded. Its contact is narrower than its cells, which the run says.
pub const RAIL: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { from = [-0.01, 0], to = [0.01, 0.03], cells = [20, 10] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.rail.cylinder = { centre = [0, -0.01], radius = 0.01 }
interface.base = { secondary = "block.bottom", primary = "rail", friction.coulomb = { mu = 0.3 } }
load.weight = { set = "block.top", pressure.value = 1e6 }
support.guide = { set = "block.top", x = 0 }
step = [{ name = "load" }]
"#;

/// All models that have nothing wrong with them.
pub const SOUND: [(&str, &str); 18] = [
    ("bolt", BOLT),
    ("axle", AXLE),
    ("hot", HOT),
    ("drag", DRAG),
    ("landing", LANDING),
    ("beside", BESIDE),
    ("pinned", PINNED),
    ("handed", HANDED),
    ("glued", GLUED),
    ("led", LED),
    ("press", PRESS),
    ("load", LOAD),
    ("cubes", CUBES),
    ("throw", THROW),
    ("meshed", MESHED),
    ("slide", SLIDE),
    ("rings", RINGS),
    ("compliant", COMPLIANT),
];
