//! Two bodies that meet: shapes, meshes, materials, and how far and hard they are pressed.

use super::body::{Body, Form, Space};
use super::law::Scale;
use super::path::Drive;
use super::random::{Random, digits};

/// Two bodies and what laws and paths are scaled with.
pub struct Scene {
    /// The body that is held.
    pub lower: Body,
    /// The body that is moved.
    pub upper: Body,
    /// Scales of the laws.
    pub scale: Scale,
    /// How far and how hard.
    pub drive: Drive,
    /// A tenth of the size of the bodies.
    pub unit: f64,
}

/// Meshes of a space.
struct Meshes {
    linear: [&'static str; 2],
    quadratic: [&'static str; 2],
    /// Cells along the length that counts, from and to.
    cells: [f64; 2],
    /// How much longer they are where one of the bodies has quadratic elements.
    quadratic_cells: f64,
}

const PLANE: Meshes = Meshes {
    linear: ["quad4", "tri3"],
    quadratic: ["quad8", "tri6"],
    cells: [10.0, 26.0],
    quadratic_cells: 1.8,
};

const SOLID: Meshes = Meshes {
    linear: ["hex8", "tet4"],
    quadratic: ["hex20", "tet10"],
    cells: [3.5, 6.0],
    quadratic_cells: 2.0,
};

/// Draws two bodies. They are elastic and their strains small; an equilibrium exists at every time.
pub fn scene(random: &mut Random) -> Scene {
    let spaces = [
        Space::Strain,
        Space::Strain,
        Space::Stress,
        Space::Axisymmetric,
        Space::Solid,
        Space::Solid,
    ];
    let space = random.pick(&spaces);
    let solid = space == Space::Solid;
    let metres = random.chance(0.5);
    // Bodies of about a centimetre, in mm and MPa or in m and Pa.
    let (unit, modulus) = if metres { (0.01, 1e6) } else { (10.0, 1.0) };
    let forms = [
        [Form::Flat, Form::Flat],
        [Form::Flat, Form::Flat],
        [Form::Flat, Form::Half],
        [Form::Flat, Form::Round],
        [Form::Half, Form::Flat],
        [Form::Half, Form::Half],
        [Form::Round, Form::Half],
    ];
    let forms = random.pick(&forms);
    let flats = forms == [Form::Flat, Form::Flat];
    let mirrored = solid && random.chance(0.5);

    let meshes = if solid { SOLID } else { PLANE };
    let order = [random.chance(0.35), random.chance(0.35)];
    // The zone of contact of round bodies; flat ones meet on their whole width.
    let radius = if solid { 0.2 } else { 0.15 };
    let length = if flats { 1.0 } else { 3.0 * radius };
    let ratio = random.spread(1.0, 5.0);
    let cells = random.between(meshes.cells[0], meshes.cells[1]);
    let ratio_of = |side: usize, fine: usize| if side == fine { 1.0 } else { ratio };
    let fine = random.whole(0, 1) as usize;
    let coarser = match order {
        [false, false] => 1.0,
        _ => meshes.quadratic_cells,
    };
    let contrast = random.spread(1e-3, 1e3);
    let base = random.spread(3e3, 2e5);

    let mut make = |side: usize| {
        let element = match order[side] {
            true => random.pick(&meshes.quadratic),
            false => random.pick(&meshes.linear),
        };
        let cell = digits(unit * length / cells * coarser * ratio_of(side, fine));
        let upper = side == 1;
        let form = forms[side];
        let width = match form {
            Form::Flat if !flats => 5.0 * radius,
            Form::Flat if upper => random.pick(&[0.5, 0.6, 0.73, 0.8, 1.0, 1.3]),
            _ => 1.0,
        };
        let height = if flats {
            random.between(0.3, 0.6)
        } else {
            2.5 * radius
        };
        let young = match upper {
            true => base * contrast.max(1.0),
            false => base / contrast.min(1.0),
        };
        let metre = if metres { 1.0 } else { 1e-3 };
        Body {
            name: if upper { "upper" } else { "lower" },
            density: digits(7800.0 * metre * metre * metre * if metres { 1.0 } else { 1e-3 }),
            keys: String::new(),
            space,
            upper,
            form,
            element,
            mirrored,
            width: digits(unit * width),
            height: digits(unit * height),
            cell,
            zone: digits(unit * radius),
            gap: 0.0,
            young: digits(young * modulus),
            poisson: random.between(0.0, 0.45),
        }
    };
    let lower = make(0);
    let mut upper = make(1);
    if random.chance(0.5) {
        upper.gap = digits(random.between(-0.1, 0.1) * lower.cell.min(upper.cell));
    }

    let compliance = |b: &Body| (1.0 - b.poisson * b.poisson) / b.young;
    let soft = 1.0 / (compliance(&lower) + compliance(&upper));
    let closing = upper.gap.max(0.0);
    let (approach, pressure) = if flats {
        let strain = random.spread(2e-4, 1e-2);
        let soft_height = if lower.young < upper.young {
            lower.height
        } else {
            upper.height
        };
        (digits(strain * soft_height), digits(strain * soft))
    } else {
        let a = unit * radius * random.between(0.3, 0.9);
        let curvature: f64 = [&lower, &upper]
            .iter()
            .filter(|b| b.form != Form::Flat)
            .map(|b| 1.0 / b.width)
            .sum();
        (
            digits(a * a * curvature),
            digits(0.25 * soft * a * curvature),
        )
    };
    let slide = match random.chance(0.3) {
        true => unit * length * random.between(0.05, 0.2),
        false => approach * random.spread(0.1, 2.0),
    };
    let scale = Scale {
        metres,
        pressure,
        approach,
        slide,
    };
    // A coarse round body may have its facets a little behind the circle.
    let chord = match flats {
        true => 0.0,
        false => lower.cell.max(upper.cell).powi(2) / (8.0 * unit),
    };
    // On the far side of a round body, which is wider than the contact.
    let a = (approach * upper.width.min(lower.width)).sqrt();
    let share = match (flats, solid || space == Space::Axisymmetric) {
        (true, _) => 1.0,
        (false, false) => a / upper.width,
        (false, true) => (a / upper.width).powi(2),
    };
    let drive = Drive {
        press: digits(closing + approach),
        pressure: digits(pressure * share),
        slide: digits(slide),
        touch: digits(closing + chord + 0.3 * approach),
        mu: 0.0,
    };
    Scene {
        lower,
        upper,
        scale,
        drive,
        unit,
    }
}
