//! Two bodies, pressed and slid along a path.

use super::draft::{Draft, beginning};
use super::law::laws;
use super::options::{formulation, options};
use super::path::path;
use super::random::Random;
use super::scene::{Scene, scene};

/// Draws a problem of two bodies.
pub fn draw(random: &mut Random) -> Draft {
    let mut scene = scene(random);
    let laws = laws(random, &scene.scale);
    scene.drive.mu = laws.mu;
    for body in [&mut scene.lower, &mut scene.upper] {
        body.keys = format!("formulation = \"{}\"\n", formulation(random, body));
    }
    let Scene {
        lower,
        upper,
        scale,
        drive,
        ..
    } = &scene;
    let secondary = random.pick(&[[lower, upper], [upper, lower]]);
    // Small sliding is for little slip only.
    let small = scale.slide < 0.3 * lower.cell.min(upper.cell);
    let options = options(random, &laws, Some(secondary[1]), small);
    let path = path(random, lower, upper, drive);
    let mut text = beginning(upper.space);
    for body in [lower, upper] {
        text.push_str(&body.text(random));
    }
    text.push_str(&format!(
        "[interface.joint]\nsecondary = \"{}\"\nprimary = \"{}\"\n{}{}\n{}",
        secondary[0].contact(),
        secondary[1].contact(),
        laws.text,
        options.text,
        path.text
    ));
    let sides = secondary.map(|b| format!("{:?} {}", b.form, b.element).to_lowercase());
    let words = format!(
        "{}, {} on {}, ratio {:.1}, E {:.0e}; {}{}; {}",
        upper.space.name(),
        sides[0],
        sides[1],
        secondary[1].cell / secondary[0].cell,
        secondary[0].young / secondary[1].young,
        laws.words,
        options.words,
        path.words
    );
    Draft {
        family: "pair",
        words,
        text,
    }
}
