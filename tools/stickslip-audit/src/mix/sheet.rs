//! What a mix consists of before it is written: numbers without unit, of a body of about the size 1 and the modulus 1.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::view::View;

/// Where a problem lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// Plane strain.
    Strain,
    /// Plane stress.
    Stress,
    /// Around the axis x = 0.
    Ring,
    /// Three dimensions.
    Solid,
}

/// A rectangle, in space a box of the depth of the sheet.
#[derive(Debug, Clone)]
pub struct Block {
    /// Its name.
    pub name: &'static str,
    /// Where it begins: along x, and along the direction of pressing.
    pub from: [f64; 2],
    /// Where it ends.
    pub to: [f64; 2],
    /// Cells along the same.
    pub cells: [usize; 2],
    /// Cells along the depth.
    pub deep: usize,
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Coefficient of expansion.
    pub expansion: f64,
    /// Whether linear cells are triangles or tetrahedra.
    pub simplex: bool,
    /// Whether cells are quadratic.
    pub quadratic: bool,
    /// Further keys of its table.
    pub keys: Vec<String>,
    /// The factor by which the mesh is smaller than the body.
    pub scale: f64,
    /// Its material instead of the isotropic one, without density.
    pub material: Option<String>,
}

/// An interface.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Its name.
    pub name: &'static str,
    /// The set whose points are checked.
    pub secondary: String,
    /// The other.
    pub primary: String,
    /// Whether the other is an obstacle.
    pub obstacle: bool,
    /// Whether it is glued.
    pub tied: bool,
    /// Further keys.
    pub keys: Vec<String>,
}

/// What holds or moves a set: displacements along x, the depth and the direction of pressing.
#[derive(Debug, Clone)]
pub struct Support {
    /// Its name.
    pub name: &'static str,
    /// Its set.
    pub set: String,
    /// Displacements.
    pub along: [Option<f64>; 3],
    /// Whether rotations are held.
    pub upright: bool,
    /// Its amplitude.
    pub amplitude: Option<&'static str>,
}

/// What kind of step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Without inertia.
    Rest,
    /// With it.
    Moving,
    /// No increments: modes.
    Modes,
}

/// A step.
#[derive(Debug, Clone)]
pub struct Step {
    /// Its duration.
    pub duration: f64,
    /// The number of its increments; as the program chooses if zero.
    pub increments: usize,
    /// Its kind.
    pub motion: Motion,
    /// Further keys.
    pub keys: Vec<String>,
}

/// All of it.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// How it is written.
    pub view: View,
    /// Names of its features.
    pub features: BTreeSet<&'static str>,
    /// Its space.
    pub space: Space,
    /// Depth of bodies in space.
    pub depth: f64,
    /// Whether only x > 0 is there.
    pub half: bool,
    /// The bodies.
    pub blocks: Vec<Block>,
    /// The interfaces.
    pub joints: Vec<Joint>,
    /// The supports.
    pub supports: Vec<Support>,
    /// Amplitudes: names and rows.
    pub amplitudes: Vec<(&'static str, Vec<[f64; 2]>)>,
    /// Further tables of the file.
    pub tables: Vec<String>,
    /// The steps.
    pub steps: Vec<Step>,
    /// Keys of `solver`.
    pub solver: Vec<String>,
    /// The set by which the upper body is driven.
    pub driven: String,
    /// The set by which the lower body is held.
    pub held: String,
    /// How far the upper body is pressed down.
    pub press: f64,
    /// How far it is slid.
    pub slide: f64,
}

/// A number as it is written.
pub fn number(x: f64) -> String {
    match x == x.round() && x.abs() < 1e6 {
        true => format!("{x}"),
        false => format!("{x:e}"),
    }
}

impl Sheet {
    /// An empty one.
    pub fn new(view: View, features: BTreeSet<&'static str>) -> Sheet {
        Sheet {
            view,
            features,
            space: Space::Strain,
            depth: 0.5,
            half: false,
            blocks: Vec::new(),
            joints: Vec::new(),
            supports: Vec::new(),
            amplitudes: Vec::new(),
            tables: Vec::new(),
            steps: Vec::new(),
            solver: Vec::new(),
            driven: "upper.top".into(),
            held: "lower.bottom".into(),
            press: 0.004,
            slide: 0.003,
        }
    }

    /// Whether it has a feature.
    pub fn has(&self, feature: &str) -> bool {
        self.features.contains(feature)
    }

    /// Whether it is in space.
    pub fn solid(&self) -> bool {
        self.space == Space::Solid
    }

    /// The name of the direction of pressing.
    pub fn down(&self) -> &'static str {
        if self.solid() { "z" } else { "y" }
    }

    /// The side of a body towards greater x, as it is written.
    pub fn right(&self) -> &'static str {
        if self.view.mirrored { "left" } else { "right" }
    }

    /// The other side.
    pub fn left(&self) -> &'static str {
        if self.view.mirrored { "right" } else { "left" }
    }

    /// A body.
    pub fn block(&mut self, name: &str) -> Option<&mut Block> {
        self.blocks.iter_mut().find(|b| b.name == name)
    }

    /// Where time stands at the end of all steps.
    pub fn end(&self) -> f64 {
        self.steps.iter().map(|s| s.duration).sum()
    }

    /// A length.
    pub fn length(&self, x: f64) -> String {
        number(x * self.view.length)
    }

    /// A pressure or modulus.
    pub fn stress(&self, x: f64) -> String {
        number(x * self.view.modulus)
    }

    /// A time.
    pub fn time(&self, x: f64) -> String {
        number(x * self.view.time())
    }

    /// A place: along x and the direction of pressing, in the middle of the depth or at a part of it.
    pub fn place(&self, [x, z]: [f64; 2], deep: f64) -> String {
        let (l, s) = (self.view.length, self.view.shift);
        let across = if self.space == Space::Ring { 0.0 } else { s };
        let x = (self.view.x() * x + across) * l;
        let z = (z + s) * l;
        match self.solid() {
            true => format!(
                "[{}, {}, {}]",
                number(x),
                number((deep * self.depth + s) * l),
                number(z)
            ),
            false => format!("[{}, {}]", number(x), number(z)),
        }
    }

    /// A vector in the plane of x and pressing, times a unit.
    pub fn vector(&self, [x, z]: [f64; 2], unit: f64) -> String {
        let (x, z) = (self.view.x() * x * unit, z * unit);
        match self.solid() {
            true => format!("[{}, 0, {}]", number(x), number(z)),
            false => format!("[{}, {}]", number(x), number(z)),
        }
    }

    /// Whether it is a problem in the plane: without a thickness forces and masses are those of one unit of length of the file.
    pub fn plane(&self) -> bool {
        matches!(self.space, Space::Strain | Space::Stress)
    }

    /// The unit of force, in the plane for the thickness 1: a pressure on an area.
    pub fn force_unit(&self) -> f64 {
        match self.plane() {
            true => self.view.modulus * self.view.length,
            false => self.view.force(),
        }
    }

    /// The unit of mass, in the plane for the thickness 1: a density on a volume.
    pub fn mass_unit(&self) -> f64 {
        let axes = if self.plane() { 2 } else { 3 };
        self.view.density * self.view.length.powi(axes)
    }

    /// A force with the size of a pressure on an area.
    pub fn force(&self, part: [f64; 2]) -> String {
        self.vector(part, self.force_unit())
    }

    /// Adds a table or a line.
    pub fn table(&mut self, text: String) {
        self.tables.push(text);
    }

    /// Adds an amplitude.
    pub fn amplitude(&mut self, name: &'static str, rows: &[[f64; 2]]) {
        self.amplitudes.push((name, rows.to_vec()));
    }

    /// Adds a support.
    pub fn support(
        &mut self,
        name: &'static str,
        set: &str,
        along: [Option<f64>; 3],
        amplitude: Option<&'static str>,
    ) {
        self.supports.push(Support {
            name,
            set: set.to_string(),
            along,
            upright: false,
            amplitude,
        });
    }

    /// The name of a body or its set as it is written.
    fn named(&self, set: &str) -> String {
        if !self.view.renamed {
            return set.to_string();
        }
        let (body, rest) = set.split_once('.').unwrap_or((set, ""));
        let body = match body {
            "lower" => "z-lower",
            "upper" => "a-upper",
            "foot" => "zz-foot",
            other => other,
        };
        match rest {
            "" => body.to_string(),
            rest => format!("{body}.{rest}"),
        }
    }

    /// The problem file.
    pub fn write(&self, title: &str) -> String {
        let mut text = String::new();
        let space = match self.space {
            Space::Strain => "plane-strain",
            Space::Stress => "plane-stress",
            Space::Ring => "axisymmetric",
            Space::Solid => "solid",
        };
        let _ = writeln!(
            text,
            "format = 1\ntitle = \"{title}\"\nmodel.space = \"{space}\"\n"
        );
        // Lines without a head come first.
        for support in &self.supports {
            self.hold(support, &mut text);
        }
        for (name, rows) in &self.amplitudes {
            let rows: Vec<String> = rows
                .iter()
                .map(|[t, f]| format!("[{}, {}]", self.time(*t), number(*f)))
                .collect();
            let _ = writeln!(text, "amplitude.{name}.table = [{}]", rows.join(", "));
        }
        for table in &self.tables {
            let _ = writeln!(text, "{}", self.renamed(table));
        }
        let mut solver = self.solver.clone();
        if let Some(method) = self.view.method {
            solver.retain(|key| !key.starts_with("method"));
            solver.push(format!("method = \"{method}\""));
        }
        for key in solver {
            let _ = writeln!(text, "solver.{key}");
        }
        text.push('\n');
        for block in &self.blocks {
            self.body(block, &mut text);
        }
        for joint in &self.joints {
            let swap = self.view.swapped && !joint.obstacle;
            let (a, b) = match swap {
                true => (&joint.primary, &joint.secondary),
                false => (&joint.secondary, &joint.primary),
            };
            let primary = if joint.obstacle {
                b.clone()
            } else {
                self.named(b)
            };
            let _ = writeln!(
                text,
                "[interface.{}]\nsecondary = \"{}\"\nprimary = \"{primary}\"",
                joint.name,
                self.named(a)
            );
            if joint.tied {
                text.push_str("tied = true\n");
            }
            let kept = |key: &&String| !(self.view.exact && key.starts_with("enforcement."));
            for key in joint.keys.iter().filter(kept) {
                let _ = writeln!(text, "{key}");
            }
            text.push('\n');
        }
        for step in &self.steps {
            self.step(step, &mut text);
        }
        text
    }

    /// Names of bodies in free text.
    fn renamed(&self, text: &str) -> String {
        let mut text = text.to_string();
        for name in ["lower", "upper", "foot"] {
            for end in ["\"", "."] {
                let old = format!("\"{name}{end}");
                text = text.replace(&old, &format!("\"{}{end}", self.named(name)));
            }
        }
        text
    }

    fn body(&self, block: &Block, text: &mut String) {
        let (v, name) = (&self.view, self.named(block.name));
        let plane = !self.solid();
        let element = match (plane, block.simplex, block.quadratic) {
            (true, false, false) => "quad4",
            (true, false, true) => "quad8",
            (true, true, false) => "tri3",
            (true, true, true) => "tri6",
            (false, false, false) => "hex8",
            (false, false, true) => "hex20",
            (false, true, false) => "tet4",
            (false, true, true) => "tet10",
        };
        let (mut from, mut to) = (block.from, block.to);
        if v.mirrored {
            (from[0], to[0]) = (to[0], from[0]);
        }
        let diagonal = match (plane && block.simplex, v.mirrored) {
            (true, false) => ", diagonal = \"up\"",
            (true, true) => ", diagonal = \"down\"",
            _ => "",
        };
        let cells = match plane {
            true => format!("[{}, {}]", block.cells[0], block.cells[1]),
            false => format!("[{}, {}, {}]", block.cells[0], block.deep, block.cells[1]),
        };
        // A mesh in another unit of length.
        let mut mesh = self.clone();
        mesh.view.length /= block.scale;
        let _ = writeln!(
            text,
            "[body.{name}]\ngenerate.{} = {{ from = {}, to = {}, cells = {cells}, element = \"{element}\"{diagonal} }}\nmaterial = \"{}\"",
            if plane { "rectangle" } else { "box" },
            mesh.place(from, -0.5),
            mesh.place(to, 0.5),
            block.name
        );
        if block.scale != 1.0 {
            let _ = writeln!(text, "scale = {}", number(block.scale));
        }
        for key in &block.keys {
            let _ = writeln!(text, "{key}");
        }
        let isotropic = format!(
            "isotropic = {{ young = {}, poisson = {}, density = {} }}",
            self.stress(block.young),
            number(block.poisson),
            number(v.density)
        );
        let material = block.material.as_ref().unwrap_or(&isotropic);
        let _ = writeln!(text, "[material.{}]\n{material}", block.name);
        if block.expansion != 0.0 {
            let _ = writeln!(text, "expansion = {}", number(block.expansion));
        }
        text.push('\n');
    }

    fn hold(&self, support: &Support, text: &mut String) {
        let mut keys = Vec::new();
        let axes = match self.solid() {
            true => ["x", "y", "z"],
            false => ["x", "", "y"],
        };
        let names = support.along.iter().zip(axes).enumerate();
        for (i, (value, axis)) in names {
            if let (Some(value), false) = (value, axis.is_empty()) {
                let sign = if i == 0 { self.view.x() } else { 1.0 };
                keys.push(format!("{axis} = {}", self.length(sign * value)));
            }
        }
        if support.upright {
            match self.space {
                Space::Solid => keys.extend(["x", "y", "z"].map(|a| format!("rotation-{a} = 0"))),
                Space::Ring => {}
                _ => keys.push("rotation-z = 0".into()),
            }
        }
        if let Some(amplitude) = support.amplitude {
            keys.push(format!("amplitude = \"{amplitude}\""));
        }
        let _ = writeln!(
            text,
            "support.{} = {{ set = \"{}\", {} }}",
            support.name,
            self.named(&support.set),
            keys.join(", ")
        );
    }

    fn step(&self, step: &Step, text: &mut String) {
        let parts = match self.view.split
            && step.motion == Motion::Rest
            && step.increments.is_multiple_of(2)
        {
            true => 2,
            false => 1,
        };
        for _ in 0..parts {
            let _ = writeln!(
                text,
                "[[step]]\nduration = {}",
                self.time(step.duration / parts as f64)
            );
            let each = step.increments / parts;
            if each > 0 {
                let size = number(1.0 / each as f64);
                let _ = writeln!(
                    text,
                    "increments = {{ initial = {size}, largest = {size} }}"
                );
            }
            for key in &step.keys {
                let _ = writeln!(text, "{key}");
            }
            text.push('\n');
        }
    }
}
