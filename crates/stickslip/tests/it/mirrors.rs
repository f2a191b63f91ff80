//! A half of a symmetric model has the results of the whole: at its plane of symmetry, too, where contact is weighted over faces of which the image is missing.

use crate::support;
use stickslip::Error;
use stickslip::contact::look;
use stickslip::results::{Analysis, Event, Observer};

/// Points of the first interface at the end of the last increment, as `[x, y, z, pressure, shear, shear]`, and energies.
#[derive(Default)]
struct End {
    points: Vec<[f64; 6]>,
    strain: f64,
    friction: f64,
}

impl Observer for End {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let Event::Increment(row) = event else {
            return Ok(());
        };
        let (names, columns) = look::table(
            analysis.contacts().next().expect("there is one"),
            &analysis.frame.state.u,
        );
        let wanted = ["x", "y", "z", "CPRESS", "CSHEAR1", "CSHEAR2"].map(|name| {
            let at = names.iter().position(|n| n == name).expect("a column");
            &columns[at]
        });
        let count = wanted[0].len();
        self.points = (0..count).map(|i| wanted.map(|c| c[i])).collect();
        self.strain = row.get("ALLSE").expect("an energy");
        self.friction = row.get("ALLFD").expect("an energy");
        Ok(())
    }
}

fn end(text: &str) -> End {
    let mut end = End::default();
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut [&mut end]);
    outcome.unwrap_or_else(|e| panic!("{e}\n{text}"));
    end
}

/// The half at `x ≥ 0` and the whole: the same at all points of the half, nothing across the plane, half the energies.
fn compare(name: &str, half: &str, whole: &str) {
    let (half, whole) = (end(half), end(whole));
    let largest = |k: usize| whole.points.iter().fold(0.0, |m: f64, p| m.max(p[k].abs()));
    let (pressure, shear) = (largest(3), largest(4).max(largest(5)));
    assert!(
        pressure > 0.0 && shear > 0.01 * pressure,
        "{name}: it is pressed and sheared"
    );
    let mut on_plane = 0;
    for p in &half.points {
        let near = |q: &&[f64; 6]| (0..3).all(|c| (p[c] - q[c]).abs() < 1e-9);
        let q = whole.points.iter().find(near).expect("the same mesh");
        // Beside the plane a sliver, as wide as the gap times the tilt of the face, has its facet on the other side: the area of the point is so much smaller.
        let on = p[0].abs() < 1e-9;
        let close = if on { 5e-4 } else { 1e-5 };
        assert!(
            (p[3] - q[3]).abs() < close * pressure,
            "{name}: {p:?} {q:?}"
        );
        for k in [4, 5] {
            assert!((p[k] - q[k]).abs() < 1e-4 * shear, "{name}: {p:?} {q:?}");
        }
        if on {
            assert!(p[4].abs() < 1e-9 * shear, "{name}: {p:?}");
            on_plane += usize::from(p[3] > 0.0);
        }
    }
    assert!(on_plane > 0, "{name}: points on the plane are pressed");
    let part = |half: f64, whole: f64| (2.0 * half - whole).abs() / whole;
    assert!(part(half.strain, whole.strain) < 1e-5, "{name}");
    if whole.friction > 0.0 {
        assert!(part(half.friction, whole.friction) < 1e-4, "{name}");
    }
}

/// A roller that is pressed into a softer block, with the points on either: an arc that ends on the axis.
fn roller(sides: [&str; 2], rest: &str, whole: bool) -> String {
    let [secondary, primary] = sides;
    let (from, cells) = if whole { (-2, 16) } else { (0, 8) };
    let supports = match whole {
        true => "",
        false => {
            "support.axis = { set = \"roller.axis\", x = 0 }\nsupport.left = { set = \"block.left\", x = 0 }"
        }
    };
    format!(
        r#"
format = 1
model.space = "plane-strain"
solver.method = "sparse"
quality.gate = "off"
body.roller = {{ generate.half-disc = {{ centre = [0, 3], radius = 3, symmetric = {}, size = 0.3 }}, material = "m" }}
body.block = {{ generate.rectangle = {{ from = [{from}, -2], to = [2, 0], cells = [{cells}, 8] }}, material = "n" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
material.n.isotropic = {{ young = 200.0, poisson = 0.45 }}
interface.i = {{ secondary = "{secondary}", primary = "{primary}", roles = "as-named", friction.coulomb = {{ mu = 0.3 }}, {rest} }}
support.base = {{ set = "block.bottom", x = 0, y = 0 }}
support.down = {{ set = "roller.flat", x = 0, y = -0.1 }}
{supports}
[[step]]
increments.fixed = 4
"#,
        !whole
    )
}

#[test]
fn half_a_roller_is_half_of_a_roller() {
    for sides in [["roller.arc", "block.top"], ["block.top", "roller.arc"]] {
        for rest in ["", "kinematics.small-sliding = {}"] {
            let name = format!("{sides:?} {rest}");
            compare(
                &name,
                &roller(sides, rest, false),
                &roller(sides, rest, true),
            );
        }
    }
}

/// A block that is pressed on a softer one whose mesh does not match, and dragged along the plane.
fn blocks(whole: bool) -> String {
    let (from, other) = if whole { (-1.0, -1.4) } else { (0.0, 0.0) };
    let (n, m) = if whole { (6, 8) } else { (3, 4) };
    let supports = match whole {
        true => "",
        false => {
            "support.upper = { set = \"a.left\", x = 0 }\nsupport.lower = { set = \"b.left\", x = 0 }"
        }
    };
    format!(
        r#"
format = 1
model.space = "solid"
solver.method = "sparse"
quality.gate = "off"
body.a = {{ generate.box = {{ from = [{from}, 0, 0], to = [1, 1, 1], cells = [{n}, 3, 3] }}, material = "m" }}
body.b = {{ generate.box = {{ from = [{other}, -0.4, -1], to = [1.4, 1.4, 0], cells = [{m}, 5, 3] }}, material = "n" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
material.n.isotropic = {{ young = 200.0, poisson = 0.45 }}
interface.i = {{ secondary = "a.bottom", primary = "b.top", roles = "as-named", friction.coulomb = {{ mu = 0.3 }} }}
support.base = {{ set = "b.bottom", x = 0, y = 0, z = 0 }}
support.down = {{ set = "a.top", x = 0, y = 0.02, z = -0.05 }}
{supports}
[[step]]
increments.fixed = 3
"#
    )
}

#[test]
fn half_a_block_is_half_of_a_block() {
    compare("blocks", &blocks(false), &blocks(true));
}

#[test]
fn what_only_one_side_is_held_by_is_no_plane_of_symmetry() {
    // The lower block is pulled along under the upper one, which is held at its end: that slides there.
    let text = blocks(false)
        .replace("x = 0, y = 0.02, z = -0.05", "x = 0, y = 0, z = -0.05")
        .replace("support.lower = { set = \"b.left\", x = 0 }", "")
        .replace(
            "set = \"b.bottom\", x = 0,",
            "set = \"b.bottom\", x = -0.1,",
        );
    let end = end(&text);
    let pulled = end
        .points
        .iter()
        .filter(|p| p[0].abs() < 1e-9 && p[3] > 0.0);
    let mut count = 0;
    for p in pulled {
        assert!((p[4].abs() - 0.3 * p[3]).abs() < 0.1 * p[3], "{p:?}");
        count += 1;
    }
    assert!(count > 0);
}
