//! Numbers that smell of mixed units: metres with millimetres, pascals with megapascals, kilograms with tonnes.
//!
//! Three consistent systems are common: m, N, Pa, kg; mm, N, MPa, t; in, lbf, psi, lbf s²/in. In each of them the moduli of solids and the speed of
//! sound in them lie in known ranges; what lies in none, or makes two bodies differ by the factor between units, is reported.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use super::common::diameter;
use crate::body::Space;
use crate::model::Body;
use crate::model::definition::Model;
use crate::number::{digits, figure};

/// Ratios between the units of length, stress and their squares.
const FACTORS: [f64; 3] = [1e3, 1e6, 1e9];

/// How near to such a ratio counts: like materials of which one is in other units are nearer to it. Tests of
/// planted defects pass with 2.8, and fail with 1.2. It decides what is said, and no result.
const NEAR_RATIO: f64 = 2.0;

/// Moduli from soft gels to diamond `[Pa]`.
const MODULI: [f64; 2] = [1e2, 2e12];

/// Units of stress `[Pa]` and length `[m]`: of m, N, Pa; of mm, N, MPa; of in, lbf, psi.
const SYSTEMS: [[f64; 2]; 3] = [[1.0, 1.0], [1e6, 1e-3], [6894.757, 0.0254]];

/// Speeds of sound in solids `[m/s]`.
const SOUND_SPEEDS: [f64; 2] = [10.0, 2e4];

/// Moduli above which a material in pascals is a metal, a ceramic or a hard plastic `[Pa]`. Soft plastics and rubbers have less.
const HARD_MODULUS: f64 = 1e9;

/// Speeds of sound in hard solids `[m/s]`: lead has 1200, a porous ceramic less.
const HARD_SPEEDS: [f64; 2] = [500.0, 2e4];

/// Densities of solids, foams included `[kg/m³]`.
const DENSITIES: [f64; 2] = [1.0, 3e4];

/// Ratio of the sizes of two bodies beyond which one of them is in other units: the ratio is a thousand for millimetres and metres, and
/// bodies of one model differ by a few times. Tests of planted defects fail with 900. It decides what is said, and no result.
pub(super) const SIZE_RATIO: f64 = 300.0;

/// A body in numbers.
struct Numbers<'a> {
    body: &'a Body,
    modulus: f64,
    density: f64,
    size: f64,
}

pub(super) fn check(model: &Model) -> Vec<Finding> {
    let all = numbers(model);
    let mut out = Vec::new();
    out.extend(moduli(model, &all));
    out.extend(densities(model, &all));
    out.extend(thickness(model, &all));
    out.extend(impossible(model, true));
    out
}

/// Bodies of impossible sizes or numbers; densities of bodies that are `moving` or have weight.
pub(super) fn impossible(model: &Model, moving: bool) -> Vec<Finding> {
    let all = numbers(model);
    let mut out: Vec<Finding> = sizes(model, &all).into_iter().collect();
    // One finding for several bodies of the same material would say the same thing again.
    let mut told = Vec::new();
    for numbers in &all {
        let key = (numbers.modulus.to_bits(), numbers.density.to_bits());
        if !told.contains(&key) {
            told.push(key);
            let heavy = moving || weighs(model, numbers.body);
            out.extend(alone(model, numbers, heavy));
        }
    }
    out
}

/// Whether a load acts on all points of a body, as weight does.
fn weighs(model: &Model, body: &Body) -> bool {
    model.actions.loads.iter().any(|load| {
        let points = load
            .entries
            .iter()
            .map(|(dof, _)| model.dofs.locate(*dof).0);
        let mut points: Vec<usize> = points.filter(|p| body.points.contains(p)).collect();
        points.sort_unstable();
        points.dedup();
        points.len() == body.points.len()
    })
}

fn numbers(model: &Model) -> Vec<Numbers<'_>> {
    let bodies = model.elastic().flat_map(|body| {
        let size = diameter(&model.mesh.points[body.points.clone()]);
        body.elastic.parts().iter().map(move |part| Numbers {
            body,
            modulus: body.elastic.constrained_modulus(part.block).unwrap_or(0.0),
            density: part.density,
            size,
        })
    });
    bodies.collect()
}

fn finding(message: String) -> Finding {
    DoctorCause::MixedUnits.warning(message)
        .advise("use one system throughout: m, N, Pa, kg/m³, or mm, N, MPa, t/mm³ (`body.NAME.scale` converts a mesh)")
}

/// Two bodies whose moduli differ by the ratio of two units.
fn moduli(model: &Model, all: &[Numbers]) -> Option<Finding> {
    let hard = all.iter().max_by(|a, b| a.modulus.total_cmp(&b.modulus))?;
    let soft = all.iter().min_by(|a, b| a.modulus.total_cmp(&b.modulus))?;
    let ratio = hard.modulus / soft.modulus;
    let factor = FACTORS
        .into_iter()
        .find(|f| ratio > f / NEAR_RATIO && ratio < f * NEAR_RATIO)?;
    let remark = |n: &Numbers| format!("modulus {}", figure(n.modulus));
    let found = finding(format!(
        "the moduli of bodies {} and {} differ by a factor {ratio}, near the ratio {factor} of two units",
        hard.body.name,
        soft.body.name,
        ratio = figure(ratio),
        factor = digits(factor, 1)
    ));
    // Metal on plastic is a common pair and differs by a thousand as well; plastics are light.
    let alike = hard.density > 0.0 && soft.density > 0.0 && {
        let ratio = hard.density / soft.density;
        // Densities that differ by less are those of materials of one kind.
        ratio.max(1.0 / ratio) < 2.0
    };
    let place = |n: &Numbers| body(model, &n.body.name, remark(n));
    let found = found.note_unless(factor >= 1e4 || alike);
    Some(found.blame_all([soft, hard].map(place)))
}

/// Two bodies whose densities differ by the ratio of two units.
fn densities(model: &Model, all: &[Numbers]) -> Option<Finding> {
    let given = || all.iter().filter(|n| n.density > 0.0);
    let heavy = given().max_by(|a, b| a.density.total_cmp(&b.density))?;
    let light = given().min_by(|a, b| a.density.total_cmp(&b.density))?;
    let ratio = heavy.density / light.density;
    let near = |f: &f64| ratio > f / NEAR_RATIO && ratio < f * NEAR_RATIO;
    let factor = FACTORS.into_iter().chain([1e12]).find(near)?;
    let remark = |n: &Numbers| format!("density {}", figure(n.density));
    Some(
        finding(format!(
            "the densities of bodies {} and {} differ by a factor {ratio}, near the ratio {factor} of two units",
            heavy.body.name, light.body.name,
            ratio = figure(ratio),
            factor = digits(factor, 1),
        ))
        .blame(body(model, &heavy.body.name, remark(heavy)))
        .blame(body(model, &light.body.name, remark(light))),
    )
}

/// A thickness that is far from the size of all bodies.
fn thickness(model: &Model, all: &[Numbers]) -> Option<Finding> {
    let (Space::PlaneStrain { thickness } | Space::PlaneStress { thickness }) = model.space else {
        return None;
    };
    let largest = all.iter().map(|n| n.size).reduce(f64::max)?;
    let ratio = thickness / largest;
    // A thickness outside this range, relative to the size of the largest body, is hardly in the same unit. A thickness of exactly 1 is the unit
    // of length.
    let far = !(2e-4..=50.0).contains(&ratio) && thickness != 1.0;
    far.then(|| {
        finding(format!(
            "the thickness of {thickness} is {ratio} times the size of the largest body, {largest}: is one in millimetres and the other in metres?",
            ratio = figure(ratio),
            largest = figure(largest),
        ))
        .blame(Suspect::key("model.thickness", format!("{thickness}")))
    })
}

/// Two bodies one of which is a thousand times as large.
fn sizes(model: &Model, all: &[Numbers]) -> Option<Finding> {
    let large = all.iter().max_by(|a, b| a.size.total_cmp(&b.size))?;
    let small = all.iter().min_by(|a, b| a.size.total_cmp(&b.size))?;
    let ratio = large.size / small.size;
    if ratio.is_nan() || ratio < SIZE_RATIO {
        return None;
    }
    let remark = |n: &Numbers| format!("size {}", figure(n.size));
    Some(
        finding(format!(
            "body {} is {ratio:.0} times as large as body {}: is one mesh in millimetres and the other in metres?",
            large.body.name, small.body.name
        ))
        .blame(body(model, &small.body.name, remark(small)))
        .blame(body(model, &large.body.name, remark(large))),
    )
}

/// One body whose numbers do not go together; its density where it is `heavy`.
fn alone(model: &Model, n: &Numbers, heavy: bool) -> Option<Finding> {
    let name = &n.body.name;
    let within = |x: f64, [low, high]: [f64; 2]| x >= low && x <= high;
    let plausible = |[stress, _]: &[f64; 2]| within(stress * n.modulus, MODULI);
    let (si, mm) = (plausible(&SYSTEMS[0]), plausible(&SYSTEMS[1]));
    let blame = |f: Finding, remark: String| {
        f.blame(body(model, name, remark))
            .blame(Suspect::key(format!("body.{name}.material"), ""))
    };
    if !SYSTEMS.iter().any(plausible) {
        return Some(blame(
            finding(format!(
                "body {name}: no solid has a modulus of {}, in Pa, MPa or psi",
                figure(n.modulus)
            )),
            format!("modulus {}", figure(n.modulus)),
        ));
    }
    if heavy && n.density > 0.0 {
        let speed = (n.modulus / n.density).sqrt();
        let mut systems = SYSTEMS.iter().filter(|s| plausible(s));
        if !systems.any(|[stress, length]| {
            let speeds = match stress * n.modulus >= HARD_MODULUS {
                true => HARD_SPEEDS,
                false => SOUND_SPEEDS,
            };
            let density = n.density * stress / (length * length);
            within(length * speed, speeds) && within(density, DENSITIES)
        }) {
            return Some(blame(
                finding(format!(
                    "body {name}: a modulus of {} and a density of {} give a speed of sound of {speed}: no solid has that, in kg/m³, t/mm³ or lbf s²/in⁴",
                    figure(n.modulus),
                    figure(n.density),
                    speed = figure(speed)
                )),
                format!(
                    "modulus {}, density {}",
                    figure(n.modulus),
                    figure(n.density)
                ),
            ));
        }
    }
    // A body of hard material of more than 20 m is hardly given in metres, but for rock: no machine has 100 km in millimetres either.
    let machine = n.size > 20.0 && n.size < 1e5;
    if n.modulus > HARD_MODULUS && si && !mm && machine {
        return Some(blame(
            finding(format!(
                "body {name} is {} large and its modulus {}: is the mesh in millimetres and the modulus in Pa?",
                figure(n.size),
                figure(n.modulus)
            )),
            format!("size {}, modulus {}", figure(n.size), figure(n.modulus)),
        ));
    }
    let metal = within(1e6 * n.modulus, [1e10, MODULI[1]]);
    // A metal body smaller than 0.1, with its modulus in megapascals, is hardly meshed in millimetres.
    if metal && n.size < 0.1 {
        return Some(blame(
            finding(format!(
                "body {name} is {} large and its modulus {}: is the mesh in metres and the modulus in MPa?",
                figure(n.size),
                figure(n.modulus)
            )),
            format!("size {}, modulus {}", figure(n.size), figure(n.modulus)),
        ));
    }
    None
}
