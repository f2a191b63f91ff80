//! Cuts through bolts: points of the mesh doubled along the sections of pretensions.

use super::super::{Problem, Section, SpaceKind};
use super::fault::problem_error;
use crate::body::{Space, area_vectors};
use crate::error::{Diagnostic, Error, MeshError};
use crate::math::{Vec3, add, dot, normalize};
use crate::mesh::{Appended, CellRef, Cut, FacetRef, Mesh, cut};

/// A cut through a body in the mesh of all bodies, see [`Cut`].
pub(super) struct BuiltCut {
    pub name: String,
    pub near: Vec<FacetRef>,
    pub far: Vec<FacetRef>,
    pub pairs: Vec<[usize; 2]>,
    /// Of length one, from the near side to the far one.
    pub normal: Vec3,
}

fn vec3(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

/// A cut in the mesh of one body, with its unit normal.
pub(super) struct BodyCut {
    name: String,
    cut: Cut,
    normal: Vec3,
}

impl BodyCut {
    /// The same in the mesh of all bodies.
    pub fn moved(self, at: &Appended) -> BuiltCut {
        let facet = |f: &FacetRef| FacetRef {
            cell: CellRef {
                block: f.cell.block + at.blocks.start,
                ..f.cell
            },
            face: f.face,
        };
        BuiltCut {
            name: self.name,
            near: self.cut.near.iter().map(facet).collect(),
            far: self.cut.far.iter().map(facet).collect(),
            pairs: (self.cut.pairs.iter())
                .map(|pair| pair.map(|p| p + at.points.start))
                .collect(),
            normal: self.normal,
        }
    }
}

/// Cuts the mesh of a body wherever pretensions do.
pub(super) fn cut(problem: &Problem, body: &str, mesh: &mut Mesh) -> Result<Vec<BodyCut>, Error> {
    let mut cuts = Vec::new();
    for (name, pretension) in &problem.pretension {
        let (of, key) = match &pretension.section {
            Section::Plane(_) => (pretension.of.as_deref().unwrap_or_default(), "plane"),
            Section::Facets(facets) => (facets.set.as_str(), "facets"),
        };
        let (owner, set) = of.split_once('.').unwrap_or((of, ""));
        if owner != body {
            continue;
        }
        let fault = |key: String| {
            move |e: MeshError| {
                let mut finding = Diagnostic::new(key, e.message);
                finding.help = e.help;
                problem_error(vec![finding])
            }
        };
        let key = format!("pretension.{name}.{key}");
        let (near, normal) = match &pretension.section {
            Section::Plane(plane) => {
                let normal = normalize(vec3(&plane.normal)).unwrap_or_default();
                let cells = match (set.is_empty(), mesh.cell_sets.get(set)) {
                    (true, _) => mesh.cells().collect(),
                    (false, Some(cells)) => cells.clone(),
                    (false, None) => {
                        let known: Vec<&str> = mesh.cell_sets.keys().map(String::as_str).collect();
                        return Err(missing(
                            format!("pretension.{name}.of"),
                            of,
                            "set of cells",
                            &known,
                        ));
                    }
                };
                let faces = cut::faces_along(mesh, &cells, vec3(&plane.point), normal);
                (faces.map_err(fault(key.clone()))?, normal)
            }
            Section::Facets(facets) => {
                let Some(given) = mesh.facet_sets.get(set).filter(|f| !f.is_empty()) else {
                    let known: Vec<&str> = mesh.facet_sets.keys().map(String::as_str).collect();
                    return Err(missing(format!("{key}.set"), of, "facets", &known));
                };
                let given = given.clone();
                let mean = mean_normal(mesh, &given);
                let wanted = facets.normal.as_deref().map(vec3).unwrap_or(mean);
                let Some(normal) = along(problem, wanted) else {
                    let message = "the facets have no normal that a bolt could run along";
                    let help = "give its direction as `normal`; with axial symmetry it is the axis";
                    let finding = Diagnostic::new(&key, message).help(help);
                    return Err(problem_error(vec![finding]));
                };
                match dot(mean, normal) < 0.0 {
                    true => (
                        cut::across(mesh, &given).map_err(fault(key.clone()))?,
                        normal,
                    ),
                    false => (given, normal),
                }
            }
        };
        cuts.push(BodyCut {
            name: name.clone(),
            cut: cut::cut(mesh, &near).map_err(fault(key))?,
            normal,
        });
    }
    Ok(cuts)
}

fn missing(key: String, name: &str, what: &str, known: &[&str]) -> Error {
    let finding = Diagnostic::new(key, format!("`{name}` is no {what} of the mesh"));
    problem_error(vec![match known {
        [] => finding.help("the mesh has none"),
        known => finding.help(format!("the mesh has: {}", known.join(", "))),
    }])
}

fn mean_normal(mesh: &Mesh, facets: &[FacetRef]) -> Vec3 {
    let space = match mesh.dim {
        2 => Space::PlaneStrain { thickness: 1.0 },
        _ => Space::Solid,
    };
    let vectors = area_vectors(mesh, facets, space).into_iter();
    vectors.fold([0.0; 3], |sum, (_, v)| add(sum, v))
}

/// The unit vector along a normal; with axial symmetry along the axis.
fn along(problem: &Problem, normal: Vec3) -> Option<Vec3> {
    match problem.model.space {
        SpaceKind::Axisymmetric => normalize([0.0, normal[1], 0.0]),
        _ => normalize(normal),
    }
}
