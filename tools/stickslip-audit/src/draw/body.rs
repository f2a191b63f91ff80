//! The two bodies of a problem: shape, mesh and the places where they are held.

use std::fmt::Write as _;

use super::random::Random;

/// Where a problem lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// Plane strain.
    Strain,
    /// Plane stress.
    Stress,
    /// Around the axis x = 0.
    Axisymmetric,
    /// 3D.
    Solid,
}

impl Space {
    /// As `model.space` has it.
    pub fn name(self) -> &'static str {
        match self {
            Space::Strain => "plane-strain",
            Space::Stress => "plane-stress",
            Space::Axisymmetric => "axisymmetric",
            Space::Solid => "solid",
        }
    }
}

/// What a body looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A rectangle or a box.
    Flat,
    /// A half-disc or a half-ball.
    Half,
    /// A disc or a ball.
    Round,
}

/// One of the bodies. The contact is at height zero, the gap above it; lengths are those of the file.
pub struct Body {
    /// The space of the problem.
    pub space: Space,
    /// Its name.
    pub name: &'static str,
    /// Whether it is above its contact.
    pub upper: bool,
    /// Its shape.
    pub form: Form,
    /// Element family.
    pub element: &'static str,
    /// Whether only x ≥ 0 is modelled.
    pub mirrored: bool,
    /// Width of a block; the radius of a round body.
    pub width: f64,
    /// Height of a block.
    pub height: f64,
    /// Size of the cells at the contact.
    pub cell: f64,
    /// Distance from the contact out to which the cells of a round body have that size.
    pub zone: f64,
    /// Height of the lowest point of the upper body.
    pub gap: f64,
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density.
    pub density: f64,
    /// Further keys of its table.
    pub keys: String,
}

impl Body {
    /// The set that may touch the other body.
    pub fn contact(&self) -> String {
        let set = match (self.form, self.upper) {
            (Form::Flat, true) => "bottom",
            (Form::Flat, false) => "top",
            _ => "arc",
        };
        format!("{}.{set}", self.name)
    }

    /// The set on the other end, by which the body is held.
    pub fn far(&self) -> String {
        match (self.form, self.upper) {
            (Form::Flat, true) => format!("{}.top", self.name),
            (Form::Flat, false) => format!("{}.bottom", self.name),
            (Form::Half, _) => format!("{}.flat", self.name),
            (Form::Round, _) => format!("{}-cap", self.name),
        }
    }

    /// The cut at x = 0, if there is one.
    pub fn cut(&self) -> Option<String> {
        let set = match self.form {
            _ if !self.halved() => return None,
            Form::Flat => "left",
            _ if self.space == Space::Axisymmetric => "axis",
            _ => "symmetry-x",
        };
        Some(format!("{}.{set}", self.name))
    }

    /// The height from the contact to the far end.
    pub fn depth(&self) -> f64 {
        match self.form {
            Form::Flat => self.height,
            _ => self.width,
        }
    }

    /// The keys of a set with the points beyond a fraction of the way from the contact to the other end.
    pub fn above(&self, fraction: f64) -> String {
        let top = match self.form {
            Form::Round => 2.0 * self.width,
            _ => self.depth(),
        };
        let sign = if self.upper { 1.0 } else { -1.0 };
        let ends = [
            self.gap + sign * fraction * top,
            self.gap + sign * 1.01 * top,
        ];
        let reach = 2.0 * self.width;
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let flat = self.space != Space::Solid;
        format!(
            "of = \"{}\"\nbox = {{ from = {}, to = {} }}",
            self.name,
            point(flat, [-reach, -reach, low]),
            point(flat, [reach, reach, high])
        )
    }

    /// The tables of the body in the problem file.
    pub fn text(&self, random: &mut Random) -> String {
        let name = self.name;
        let mut text = String::new();
        let _ = writeln!(text, "[body.{name}]\n{}", self.generator(random));
        let _ = writeln!(text, "material = \"{name}\"\n{}", self.keys);
        let _ = writeln!(
            text,
            "[material.{name}.isotropic]\nyoung = {:e}\npoisson = {}\ndensity = {:e}\n",
            self.young, self.poisson, self.density
        );
        if self.form == Form::Round {
            let _ = writeln!(text, "[set.{name}-cap]\n{}\n", self.above(0.6));
        }
        text
    }

    fn halved(&self) -> bool {
        self.mirrored || self.space == Space::Axisymmetric
    }

    fn generator(&self, random: &mut Random) -> String {
        let flat = self.space != Space::Solid;
        let sign = if self.upper { 1.0 } else { -1.0 };
        if self.form == Form::Flat {
            let left = if self.halved() {
                0.0
            } else {
                -0.5 * self.width
            };
            let right = 0.5 * self.width;
            let (low, high) = match self.upper {
                true => (self.gap, self.gap + self.height),
                false => (self.gap - self.height, self.gap),
            };
            let count = |length: f64, size: f64| (length / size).round().max(1.0);
            // Cells may be flat, so that ratios of sides are met as well.
            let tall = self.cell * random.between(1.0, 1.6);
            let cells = [
                count(right - left, self.cell),
                count(self.width, self.cell),
                count(self.height, tall),
            ];
            let diagonal = match self.element {
                "tri3" | "tri6" => {
                    let kinds = ["up", "down", "alternating", "union-jack"];
                    format!(", diagonal = \"{}\"", random.pick(&kinds))
                }
                _ => String::new(),
            };
            let kind = if flat { "rectangle" } else { "box" };
            return format!(
                "generate.{kind} = {{ from = {}, to = {}, cells = {}, element = \"{}\"{diagonal} }}",
                point(flat, [left, -right, low]),
                point(flat, [right, right, high]),
                point(flat, cells),
                self.element
            );
        }
        let kind = match (self.form, flat) {
            (Form::Half, true) => "half-disc",
            (Form::Half, false) => "half-ball",
            (_, true) => "disc",
            (_, false) => "ball",
        };
        let part = match (flat, self.halved()) {
            (_, false) => "",
            (true, true) => ", symmetric = true",
            (false, true) => ", sector = \"half\"",
        };
        let radius = self.width;
        let largest = (0.5 * radius).max(self.cell);
        let growth = if flat { 1.4 } else { 2.5 };
        format!(
            "generate.{kind} = {{ centre = {}, direction = {}, radius = {radius:e}, size = {largest:e}, element = \"{}\"{part}, \
             refine = {{ finest = {:e}, width = {:e}, growth = {growth} }} }}",
            point(flat, [0.0, 0.0, self.gap + sign * radius]),
            point(flat, [0.0, 0.0, -sign]),
            self.element,
            self.cell,
            self.zone
        )
    }
}

/// A point or vector; in the plane the last component is the second.
pub fn point(flat: bool, [x, y, z]: [f64; 3]) -> String {
    let whole = |x: f64| match x == x.round() && x.abs() < 1e6 {
        true => format!("{x}"),
        false => format!("{x:e}"),
    };
    match flat {
        true => format!("[{}, {}]", whole(x), whole(z)),
        false => format!("[{}, {}, {}]", whole(x), whole(y), whole(z)),
    }
}
