use super::Space;
use crate::math::{Vec3, add, cross, scale, sub};
use crate::mesh::Mesh;
use crate::system::Dofs;

/// A motion without strain.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidMode {
    /// `translation x`, `rotation about z`.
    pub name: String,
    /// Displacements by dof of the whole mesh, zero outside the body; a translation by one unit of length, or a
    /// rotation by one radian about the centre of the body's points.
    pub vector: Vec<f64>,
}

/// The rigid-body modes of the body with the given points: three in the plane, six in space, and with axial symmetry
/// the translation along the axis alone.
pub fn rigid_modes(mesh: &Mesh, points: &[usize], space: Space) -> Vec<RigidMode> {
    let dofs = Dofs {
        dim: space.dim(),
        points: mesh.points.len(),
    };
    let mode = |name: String, at: &dyn Fn(Vec3) -> Vec3| {
        let mut vector = vec![0.0; dofs.count()];
        for &p in points {
            let u = at(mesh.points[p]);
            for (i, &u) in u.iter().enumerate().take(dofs.dim) {
                vector[dofs.of(p, i)] = u;
            }
        }
        RigidMode { name, vector }
    };
    let unit = |i: usize| {
        let mut e = [0.0; 3];
        e[i] = 1.0;
        e
    };
    let (translations, rotations): (&[usize], &[usize]) = match space {
        Space::PlaneStrain { .. } | Space::PlaneStress { .. } => (&[0, 1], &[2]),
        Space::Axisymmetric => (&[1], &[]),
        Space::Solid => (&[0, 1, 2], &[0, 1, 2]),
    };
    let sum = points.iter().fold([0.0; 3], |s, &p| add(s, mesh.points[p]));
    let centre = scale(1.0 / points.len().max(1) as f64, sum);
    let axis = ["x", "y", "z"];
    let mut modes: Vec<RigidMode> = translations
        .iter()
        .map(|&i| mode(format!("translation {}", axis[i]), &|_| unit(i)))
        .collect();
    modes.extend(rotations.iter().map(|&i| {
        mode(format!("rotation about {}", axis[i]), &|x| {
            cross(unit(i), sub(x, centre))
        })
    }));
    modes
}
