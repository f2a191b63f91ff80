//! Bodies that are nearly incompressible and made of cells that lock.

use super::super::cause::DoctorCause;
use super::super::finding::{Finding, Guilty, Severity};
use super::super::places::body;
use crate::body::{Formulation, Space};
use crate::material::Stiffness;
use crate::model::definition::Model;
use crate::shape::ElementKind;

/// Poisson's ratio from which on linear cells in the standard formulation are much too stiff in bending and under contact.
const INCOMPRESSIBLE: f64 = 0.49;

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
            (poisson > INCOMPRESSIBLE && locks(kind, formulation)).then_some((kind, poisson))
        });
        if let Some((kind, poisson)) = locking {
            out.push(finding(model, &body.name, kind, poisson));
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

fn finding(model: &Model, name: &str, kind: ElementKind, poisson: f64) -> Finding {
    let advice = match kind {
        ElementKind::Tri3 | ElementKind::Tet4 => {
            "mesh the body with quad4 or hex8 and set `formulation = \"mean-dilatation\"`, or use tri6 or tet10".to_string()
        }
        _ => format!("set `body.{name}.formulation = \"mean-dilatation\"` (B-bar)"),
    };
    Finding::new(
        DoctorCause::Locking,
        Severity::Warning,
        format!(
            "body {name} is nearly incompressible (Poisson's ratio {poisson:.4}) and made of {} cells that lock: it is too stiff, and pressures are wrong by tens of per cent",
            kind.name()
        ),
    )
    .blame(body(model, name, format!("{} with Poisson's ratio {poisson:.4}", kind.name())))
    .blame(Guilty::key(format!("body.{name}.formulation"), ""))
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
