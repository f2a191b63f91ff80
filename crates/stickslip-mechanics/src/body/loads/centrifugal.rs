use super::super::facets::combine;
use super::super::geometry::{Table, by_nodes, coordinates, point};
use super::domain::{Action, Domain, LoadModel, Region, Target, mismatch};
use crate::body::Space;
use crate::error::Diagnostic;
use crate::math::{Vec3, add_scaled, dot, normalize, scale, sub};
use crate::mesh::{Block, Mesh};
use crate::registry::Samples;
use crate::shape::mass_rule;

/// Centrifugal force of bodies that turn about an axis at a constant speed: density times `ω² r`, on cells, `r` the distance from the axis where the
/// points are meshed.
///
/// An amplitude, and the growth of the load over its first step, multiply the force, which goes with the square of the speed. Point masses at the cells
/// take part.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Centrifugal {
    /// Angular speed ω `[rad/s]`.
    pub speed: f64,
    /// A point of the axis `[length]`, as many components as the space has; the origin if not given. In axial symmetry the axis is that of symmetry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Vec<f64>>,
    /// Direction of the axis `[-]`, of any length: needed in 3D. In the plane it is perpendicular to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
}

impl Centrifugal {
    /// A point of the axis and its direction.
    fn line(&self, domain: &Domain) -> Result<(Vec3, Vec3), Diagnostic> {
        let through = match &self.point {
            Some(point) => domain.vector("point", point)?,
            None => [0.0; 3],
        };
        let unused =
            |key: &str, message: &str| Err(Diagnostic::new(key, message).help("remove the key"));
        let axis = match (&self.axis, domain.space) {
            (Some(axis), Space::Solid) => {
                let axis = domain.vector("axis", axis)?;
                let zero = || Diagnostic::new("axis", "the axis has no direction");
                normalize(axis).ok_or_else(zero)?
            }
            (None, Space::Solid) => {
                return Err(Diagnostic::new("", "a centrifugal force without an axis")
                    .help("give the direction of the axis: axis = [0, 0, 1]"));
            }
            (Some(_), _) => return unused("axis", "a plane model turns about an axis across it"),
            (None, Space::Axisymmetric) => [0.0, 1.0, 0.0],
            (None, _) => [0.0, 0.0, 1.0],
        };
        if domain.space == Space::Axisymmetric && through[0] != 0.0 {
            return unused(
                "point",
                "in axial symmetry bodies turn about the axis of symmetry",
            );
        }
        Ok((through, axis))
    }
}

impl LoadModel for Centrifugal {
    fn region(&self) -> Region {
        Region::Cells
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let Target::Cells(cells) = target else {
            return Err(mismatch(Region::Cells));
        };
        if !self.speed.is_finite() {
            let message = format!("speed = {} is not finite", self.speed);
            return Err(Diagnostic::new("speed", message));
        }
        let (through, axis) = self.line(domain)?;
        domain.heavy(target, "a centrifugal force")?;
        let acceleration = |x: Vec3| {
            let from = sub(x, through);
            let radius = add_scaled(from, -dot(from, axis), axis);
            scale(self.speed * self.speed, radius)
        };
        let dofs = domain.dofs();
        let mut entries = Vec::new();
        let mut add = |p: usize, force: Vec3| {
            entries.extend((0..dofs.dim).map(|i| (dofs.of(p, i), force[i])));
        };
        for (index, block) in domain.mesh.blocks.iter().enumerate() {
            let chosen = cells.iter().filter(|c| c.block == index).map(|c| c.cell);
            let density = domain.densities.get(index).copied().unwrap_or(0.0);
            by_nodes!(
                block.kind,
                forces(
                    domain.mesh,
                    domain.space,
                    density,
                    block,
                    &mut chosen.into_iter(),
                    &acceleration,
                    &mut add
                )
            );
        }
        for (p, mass) in domain.masses_at(cells) {
            add(p, scale(mass, acceleration(domain.mesh.points[p])));
        }
        Ok(Action::Forces(combine(entries)))
    }
}

/// Visits `∫ ρ N_i a dV` of every node of the chosen cells of a block, with the acceleration `a` given by the place `[m/s²]`.
fn forces<const N: usize>(
    mesh: &Mesh,
    space: Space,
    density: f64,
    block: &Block,
    cells: &mut dyn Iterator<Item = usize>,
    acceleration: &dyn Fn(Vec3) -> Vec3,
    add: &mut dyn FnMut(usize, Vec3),
) {
    let table = Table::<N>::with_rule(block.kind, &mass_rule(block.kind));
    for cell in cells {
        let x = coordinates(&mesh.points, block, cell);
        let mut forces = [[0.0; 3]; N];
        for (q, n) in table.values.iter().enumerate() {
            let mass = density * point(&table, q, &x, space).volume;
            let place = x.map(|row| row.iter().zip(n).map(|(x, n)| x * n).sum());
            let a = acceleration(place);
            for (force, n) in forces.iter_mut().zip(n) {
                *force = add_scaled(*force, n * mass, a);
            }
        }
        let nodes = &block.connectivity[cell * N..(cell + 1) * N];
        nodes.iter().zip(forces).for_each(|(&p, f)| add(p, f));
    }
}

impl Samples for Centrifugal {
    fn samples() -> Vec<Self> {
        vec![Centrifugal {
            speed: 100.0,
            point: Some(vec![0.0, 0.1, 0.0]),
            axis: Some(vec![0.0, 0.0, 1.0]),
        }]
    }
}
