use super::super::Space;
use super::Pressing;
use crate::mesh::Mesh;
use crate::system::Schedule;

/// A load: forces by dof, scaled in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Name for messages and histories.
    pub name: String,
    /// Forces by dof `[N]` at factor 1.
    pub entries: Vec<(usize, f64)>,
    /// The factor in time.
    pub schedule: Schedule,
    /// Whether it turns with bodies that do; others keep their direction in space.
    pub follows: bool,
    /// Of a pressure on bodies that turn cell by cell: the faces that it follows; entries are those at the start.
    pub pressing: Option<Pressing>,
}

impl Load {
    /// Adds the forces at a time to `out` `[N]`, by dof, where those that press on moving faces do so at displacements `u` `[m]`.
    pub fn external_at(&self, t: f64, mesh: &Mesh, space: Space, u: &[f64], out: &mut [f64]) {
        match &self.pressing {
            Some(pressing) => pressing.external(mesh, space, self.schedule.at(t), u, out),
            None => self.external(t, out),
        }
    }

    /// Adds the forces at a time to `out` `[N]`, by dof.
    pub fn external(&self, t: f64, out: &mut [f64]) {
        let factor = self.schedule.at(t);
        if factor != 0.0 {
            for &(dof, force) in &self.entries {
                out[dof] += factor * force;
            }
        }
    }
}

/// Springs to ground by dof. They are part of the matrix, which is assembled once, and so act throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    entries: Vec<(usize, f64)>,
}

impl Spring {
    /// From stiffnesses by dof `[N/m]`.
    pub fn new(entries: Vec<(usize, f64)>) -> Self {
        Spring { entries }
    }

    /// Stiffnesses by dof `[N/m]`.
    pub fn entries(&self) -> &[(usize, f64)] {
        &self.entries
    }

    /// Adds the internal force at the displacements `u` `[m]` to `out` `[N]`, by dof.
    pub fn internal_force(&self, u: &[f64], out: &mut [f64]) {
        for &(dof, k) in &self.entries {
            out[dof] += k * u[dof];
        }
    }
}
