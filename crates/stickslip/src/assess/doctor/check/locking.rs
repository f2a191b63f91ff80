//! Bodies that are nearly incompressible and made of cells that lock.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use crate::body::{Formulation, Space};
use crate::material::Stiffness;
use crate::model::definition::Model;
use crate::shape::ElementKind;

/// The same from which on quadratic cells without a middle of their own, fully integrated, have pressures that go up and down: forces are right. Under Hertz's cylinder quad8 is 0.7 % off in
/// the largest pressure at 0.499, 11 % at 0.4999 and 50 % at 0.49999, and 0.1 % with mean dilatation.
const WAVY_PRESSURE: f64 = 0.499;

/// One finding for each body.
pub(super) fn check(model: &Model) -> Vec<Finding> {
    if matches!(model.space, Space::PlaneStress { .. }) {
        // The thickness is free to change.
        return Vec::new();
    }
    let mut out = Vec::new();
    for body in model.elastic() {
        let formulation = body.elastic.formulation();
        let mut parts = body.elastic.parts().iter();
        let locking = parts.find_map(|part| {
            let kind = model.mesh.blocks[part.block].kind;
            let poisson = poisson(&part.stiffness);
            let wrong = match locks(kind, formulation) {
                // From this Poisson's ratio on linear cells in the standard formulation are much too stiff in bending and under contact.
                true => poisson > 0.49,
                false => poisson > WAVY_PRESSURE && waves(kind, formulation),
            };
            wrong.then_some((kind, poisson))
        });
        if let Some((kind, poisson)) = locking {
            let said = match locks(kind, formulation) {
                true => "it is too stiff, and pressures are wrong by tens of per cent",
                false => {
                    "its pressures go up and down from node to node, by ten per cent and more; forces are right"
                }
            };
            out.push(finding(model, &body.name, kind, said, poisson));
        }
    }
    out
}

/// Whether the cells cannot keep their volume without keeping their shape.
fn locks(kind: ElementKind, formulation: Formulation) -> bool {
    match kind {
        // One strain in a cell: no formulation gives it more.
        ElementKind::Tri3 | ElementKind::Tet4 => true,
        ElementKind::Quad4 | ElementKind::Hex8 => formulation == Formulation::Standard,
        ElementKind::Wedge6 => !matches!(
            formulation,
            Formulation::MeanDilatation | Formulation::Reduced
        ),
        _ => false,
    }
}

/// Whether the cells keep their volume at so many points that the pressure is left with motions of its own.
fn waves(kind: ElementKind, formulation: Formulation) -> bool {
    // Incompatible modes are those of linear cells.
    matches!(kind, ElementKind::Quad8 | ElementKind::Hex20)
        && matches!(
            formulation,
            Formulation::Standard | Formulation::IncompatibleModes
        )
}

/// Poisson's ratio of the isotropic material with the same bulk modulus and mean shear modulus.
fn poisson(c: &Stiffness) -> f64 {
    let bulk = c
        .iter()
        .take(3)
        .flat_map(|row| row.iter().take(3))
        .sum::<f64>()
        / 9.0;
    // Voigt's mean, which is the shear modulus itself where the material is isotropic.
    let (axes, mixed) = (c[0][0] + c[1][1] + c[2][2], c[0][1] + c[1][2] + c[0][2]);
    let shear = (axes - mixed + 3.0 * (c[3][3] + c[4][4] + c[5][5])) / 15.0;
    (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
}

fn finding(model: &Model, name: &str, kind: ElementKind, said: &str, poisson: f64) -> Finding {
    let advice = match kind {
        ElementKind::Tri3 | ElementKind::Tet4 => {
            "mesh the body with quad4 or hex8 and set `formulation = \"mean-dilatation\"`, or use tri6 or tet10".to_string()
        }
        _ => format!("set `body.{name}.formulation = \"mean-dilatation\"` (B-bar)"),
    };
    DoctorCause::Locking.warning(format!(
        "body {name} is nearly incompressible (Poisson's ratio {poisson:.4}) and made of {} cells that lock: {said}",
        kind.name()
    ))
    .blame(body(model, name, format!("{} with Poisson's ratio {poisson:.4}", kind.name())))
    .blame(Suspect::key(format!("body.{name}.formulation"), ""))
    .advise(advice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Elasticity, Isotropic};

    #[test]
    fn an_isotropic_material_has_its_own_ratio() {
        for ratio in [0.0, 0.3, 0.49, 0.4999] {
            let material = Isotropic {
                young: 3.0,
                poisson: ratio,
                density: 0.0,
            };
            let stiffness = material.stiffness().expect("sound");
            assert!((poisson(&stiffness) - ratio).abs() < 1e-9);
        }
    }
}
