use crate::error::Diagnostic;
use crate::keep::Keep;
use crate::math::Vec3;
use crate::mesh::Mesh;

/// How the coordinates of the mesh stand for a body in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Space {
    /// Two dimensions, no strain across the plane.
    PlaneStrain {
        /// Extent across the plane `[m]`.
        thickness: f64,
    },
    /// Two dimensions, no stress across the plane.
    PlaneStress {
        /// Extent across the plane `[m]`.
        thickness: f64,
    },
    /// Two dimensions turned about the y axis: x is the radius. Integrals run over the full `2π`, forces are those of
    /// the whole ring; points on the axis are allowed. The zz components of stress and strain are the hoop's.
    Axisymmetric,
    /// Three dimensions.
    Solid,
}

/// How the elements make strains of displacements.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, Keep,
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// Fully integrated displacement elements.
    #[default]
    Standard,
    /// The dilatation is replaced by its mean over the cell (B-bar,
    /// [`hughes_1980`](stickslip_base::references::hughes_1980)), so that nearly incompressible bodies do not lock.
    ///
    /// Works with any material and with axial symmetry (the mean is weighted by the radius). Not for plane stress,
    /// where the strain across the plane is free and nothing locks. Cells with constant strain (tri3, tet4) are not
    /// changed by it.
    ///
    /// Meant for quad4 and hex8. A single quadratic cell in space or around an axis has motions without energy besides
    /// its rigid ones (conformal maps such as `(a·x) x - |x|² a / 2`: no shear, and a dilatation of zero mean);
    /// neighbours stop them, as they do not fit together.
    MeanDilatation,
    /// Reduced integration, as in the elements of Abaqus and CalculiX whose names end in R.
    ///
    /// quad8 and hex20 have 2 points in each direction, wedge6 has 2 along its axis (as C3D6 always has). A single such
    /// cell has motions without energy (hex20 six, quad8 one, wedge6 its torsion). Neighbours stop them, as they do not fit
    /// together, but for some of a single straight row of hex20: a beam of them wants two cells across.
    ///
    /// quad4 and hex8 have the mean strain of the cell and a stiffness against motions without
    /// one ([`flanagan_1981`](stickslip_base::references::flanagan_1981)), as small as in CalculiX. They do not lock, in bending either, but one
    /// cell through a thickness has hardly any bending stiffness: take four.
    ///
    /// Triangles, tetrahedra and wedge15 are not changed. Weight and mass are integrated as in the standard formulation.
    Reduced,
    /// quad4 and hex8 with modes inside the cell that let it bend ([`taylor_1976`](stickslip_base::references::taylor_1976)), as in C3D8I: a
    /// slender beam of one layer of cells bends as it should, if the cells are parallelepipeds. They do not lock either where the
    /// material is nearly incompressible.
    ///
    /// Other kinds of cells are not changed.
    IncompatibleModes,
}

impl Space {
    /// Dimension of the mesh: 2 or 3.
    pub fn dim(&self) -> usize {
        match self {
            Space::Solid => 3,
            _ => 2,
        }
    }

    /// What an integral over the mesh is multiplied by at `x` to become one over the body: thickness `[m]`, `2π r` `[m]`
    /// or 1.
    #[inline]
    pub fn extent(&self, x: Vec3) -> f64 {
        match self {
            Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => *thickness,
            Space::Axisymmetric => std::f64::consts::TAU * x[0],
            Space::Solid => 1.0,
        }
    }

    /// The strain component (see [`material`](crate::material)) to which displacement component `i` contributes
    /// through its derivative `k`. With axial symmetry derivative 2 is the division by the radius.
    #[inline]
    pub(super) fn component(&self, i: usize, k: usize) -> Option<usize> {
        match (self, k) {
            (Space::Solid, _) => Some(crate::material::VOIGT[i][k]),
            (Space::Axisymmetric, 2) => (i == 0).then_some(2),
            (_, 2) => None,
            _ => Some(crate::material::VOIGT[i][k]),
        }
    }

    /// How many derivatives are in use: 2 in the plane, 3 otherwise.
    pub(super) fn derivatives(&self) -> usize {
        match self {
            Space::PlaneStrain { .. } | Space::PlaneStress { .. } => 2,
            Space::Axisymmetric | Space::Solid => 3,
        }
    }

    /// Checks that these blocks of `mesh` can stand for a body in this space.
    ///
    /// # Errors
    /// The dimensions differ, the thickness is not positive, or a radius is negative.
    pub fn check(&self, mesh: &Mesh, blocks: &[usize]) -> Result<(), Diagnostic> {
        if mesh.dim != self.dim() {
            return Err(Diagnostic::new(
                "space",
                format!(
                    "the mesh has {} dimensions and the space {}",
                    mesh.dim,
                    self.dim()
                ),
            )
            .help("choose \"solid\" for a 3D mesh, and one of the plane or axisymmetric spaces for a 2D mesh"));
        }
        match self {
            Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => {
                if !(*thickness > 0.0 && thickness.is_finite()) {
                    return Err(Diagnostic::new(
                        "thickness",
                        format!("thickness = {thickness} is not positive"),
                    ));
                }
            }
            Space::Axisymmetric => {
                // Meshes made by transformations put points of the axis a rounding error beside it.
                let size = mesh.points.iter().fold(0.0_f64, |m, p| m.max(p[0].abs()));
                let blocks = blocks.iter().filter_map(|&b| mesh.blocks.get(b));
                let mut own = blocks.flat_map(|b| &b.connectivity);
                let beyond =
                    |&&i: &&usize| mesh.points.get(i).is_some_and(|p| p[0] < -1e-12 * size);
                if let Some(&i) = own.find(beyond) {
                    return Err(Diagnostic::new(
                        "space",
                        format!(
                            "point {} has the negative radius {}",
                            mesh.point_ids.get(i).copied().unwrap_or(i as u64),
                            mesh.points[i][0]
                        ),
                    )
                    .help(
                        "in an axisymmetric problem x is the radius: model the half x >= 0 only",
                    ));
                }
            }
            Space::Solid => {}
        }
        Ok(())
    }
}
