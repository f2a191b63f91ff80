//! A random problem of two bodies, as a problem file.

use super::body::{Body, Form, Space};
use super::law::{Scale, laws};
use super::path::{Drive, path};
use super::random::{Random, digits};

/// A problem file and what is in it.
pub struct Problem {
    /// In a line.
    pub words: String,
    /// The file.
    pub text: String,
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
    cells: [20.0, 40.0],
    quadratic_cells: 1.8,
};

const SOLID: Meshes = Meshes {
    linear: ["hex8", "tet4"],
    quadratic: ["hex20", "tet10"],
    cells: [5.0, 8.0],
    quadratic_cells: 2.0,
};

/// The problem of a seed. The bodies are elastic and their strains small; an equilibrium exists at every time.
pub fn problem(seed: u64, discretisation: Option<&str>) -> Problem {
    let random = &mut Random::new(seed);
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
        Body {
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
    let laws = laws(random, &scale);
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
        mu: laws.mu,
    };
    // Small sliding is for little slip only.
    let small = slide < 0.3 * lower.cell.min(upper.cell) && random.chance(0.3);
    let secondary = random.pick(&[[&lower, &upper], [&upper, &lower]]);
    let path = path(random, &lower, &upper, &drive);

    let mut text = format!(
        "format = 1\ntitle = \"Random problem {seed}\"\n\n[model]\nspace = \"{}\"\n\n[output]\nevery = 0\n\n",
        space.name()
    );
    for body in [&lower, &upper] {
        text.push_str(&body.text(random));
    }
    text.push_str(&format!(
        "[interface.joint]\nsecondary = \"{}\"\nprimary = \"{}\"\n{}",
        secondary[0].contact(),
        secondary[1].contact(),
        laws.text
    ));
    if small {
        text.push_str("kinematics.small-sliding = {}\n");
    }
    if let Some(word) = discretisation {
        text.push_str(&format!("discretisation.{word} = {{}}\n"));
    }
    text.push('\n');
    text.push_str(&path.text);
    let sides = secondary.map(|b| format!("{:?} {}", b.form, b.element).to_lowercase());
    let words = format!(
        "{}, {} on {}, ratio {:.1}, E {:.0e}; {}{}; {}",
        space.name(),
        sides[0],
        sides[1],
        secondary[1].cell / secondary[0].cell,
        secondary[0].young / secondary[1].young,
        laws.words,
        if small { ", small sliding" } else { "" },
        path.words
    );
    Problem { words, text }
}

#[cfg(test)]
mod tests {
    use super::problem;

    #[test]
    fn a_seed_is_one_problem() {
        for seed in 1..=50 {
            let once = problem(seed, None);
            assert_eq!(once.text, problem(seed, None).text);
            assert!(!once.text.contains("discretisation"));
            assert!(!once.text.contains("NaN") && !once.text.contains("inf"));
        }
        assert_ne!(problem(1, None).text, problem(2, None).text);
    }

    #[test]
    fn the_discretisation_is_all_that_differs() {
        let (with, without) = (problem(7, Some("mortar")), problem(7, None));
        assert_eq!(
            with.text.replace("discretisation.mortar = {}\n", ""),
            without.text
        );
    }
}
