//! How an interface is evaluated, and how the elements are made.

use super::body::{Body, Form, Space};
use super::law::Laws;
use super::random::Random;

/// Keys of an interface beside its laws, and what they are in a few words.
pub struct Options {
    /// The keys.
    pub text: String,
    /// For the description.
    pub words: String,
}

/// Draws enforcement, kinematics and discretisation. `small` says whether slips are small against facets; the primary is a body unless
/// it is an obstacle.
pub fn options(random: &mut Random, laws: &Laws, primary: Option<&Body>, small: bool) -> Options {
    let (mut text, mut words) = (String::new(), String::new());
    let enforcement = random.pick(&[
        "augmented-lagrangian",
        "augmented-lagrangian",
        "augmented-lagrangian",
        "perturbed-lagrangian",
        "penalty",
    ]);
    let mut kinematics = "convective";
    if small && random.chance(0.4) {
        kinematics = "small-sliding";
    } else if random.chance(0.15) {
        let linear =
            primary.is_none_or(|b| matches!(b.element, "tri3" | "quad4" | "tet4" | "hex8"));
        if linear {
            kinematics = "pop-1995";
        }
    }
    let mut discretisation = String::new();
    if let Some(primary) = primary {
        let mortar = kinematics != "pop-1995" && random.chance(0.6);
        let both = mortar
            && random.chance(0.3)
            && (enforcement == "penalty" || laws.compliant && laws.mu == 0.0);
        discretisation = match (mortar, both) {
            (true, true) => "mortar = { two-sided = true }".into(),
            (true, false) => "mortar = {}".into(),
            (false, _) => "node-to-facet = {}".into(),
        };
        let triangles = matches!(primary.element, "hex8")
            && (kinematics == "pop-1995" || !mortar && random.chance(0.2));
        if triangles {
            text.push_str("facets = \"triangles\"\n");
        }
    }
    for (key, value) in [
        ("enforcement", format!("{enforcement} = {{}}")),
        ("kinematics", format!("{kinematics} = {{}}")),
        ("discretisation", discretisation),
    ] {
        if !value.is_empty() {
            text.push_str(&format!("{key}.{value}\n"));
            words.push_str(&format!(
                ", {}",
                value
                    .replace(" = {}", "")
                    .replace(" = { two-sided = true }", " on two sides")
            ));
        }
    }
    Options { text, words }
}

/// A formulation that suits the elements of a body.
pub fn formulation(random: &mut Random, body: &Body) -> &'static str {
    let ring = body.space == Space::Axisymmetric;
    let bilinear = matches!(body.element, "quad4" | "hex8");
    let straight = body.form == Form::Flat;
    // A single quadratic cell of reduced integration has motions without strain.
    let several = body.width.max(body.height) > 1.5 * body.cell;
    match random.whole(1, 10) {
        1..=2 if bilinear && body.space != Space::Stress => "mean-dilatation",
        3..=4 if bilinear && straight => "incompatible-modes",
        5 if several && matches!(body.element, "quad8" | "hex20") => "reduced",
        5 if bilinear && !ring => "reduced",
        _ => "standard",
    }
}
