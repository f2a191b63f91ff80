//! The bodies: stiffness and mass of all cells, and forces and energies from them.

use crate::case::{Case, kind, number, text_of};
use crate::cell::{self, Formulation, Material, Matrix};
use crate::element::Kind;
use crate::mesh::Mesh;
use crate::vec3::Vec3;

/// Matrices of the cells, and how bodies are damped.
pub struct Bulk {
    stiffness: Vec<Matrix>,
    mass: Vec<Matrix>,
    /// By body: whether it is rigid.
    pub rigid: Vec<bool>,
    /// By body: Rayleigh factors of mass and stiffness.
    pub rayleigh: Vec<[f64; 2]>,
    /// By body.
    pub materials: Vec<Material>,
}

impl Bulk {
    /// Makes the matrices; says what is not covered.
    pub fn new(case: &Case, mesh: &Mesh) -> Result<Bulk, String> {
        let (mut rigid, mut rayleigh, mut materials, mut formulations) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (name, body) in case.named("body") {
            if body.contains_key("regions") {
                return Err(format!("body {name} has several materials"));
            }
            let material = text_of(body, "material").and_then(|m| case.of("material", m));
            let material = material.ok_or(format!("body {name} has no material"))?;
            let Some(("isotropic", keys)) = kind_named(material) else {
                return Err(format!("the material of body {name} is not isotropic"));
            };
            materials.push(Material {
                young: number(keys, "young").unwrap_or(0.0),
                poisson: number(keys, "poisson").unwrap_or(0.0),
                density: number(keys, "density").unwrap_or(0.0),
            });
            rigid.push(body.get("rigid").and_then(toml::Value::as_bool) == Some(true));
            let damping = body.get("rayleigh").and_then(toml::Value::as_table);
            let factor = |key: &str| damping.and_then(|d| number(d, key)).unwrap_or(0.0);
            rayleigh.push([factor("mass"), factor("stiffness")]);
            formulations.push(Formulation::of(text_of(body, "formulation").unwrap_or("")));
        }
        let (mut stiffness, mut mass) = (Vec::new(), Vec::new());
        for ((kind, nodes), &body) in mesh.cells.iter().zip(&mesh.owner) {
            let x: Vec<Vec3> = nodes.iter().map(|n| mesh.points[*n]).collect();
            let ring = case.space == crate::case::Space::Ring;
            let formulation = formulations[body];
            if ring && formulation == Formulation::Reduced && *kind == Kind::Quad(4) {
                return Err("reduced quad4 around an axis is not audited".into());
            }
            let k = match rigid[body] {
                true => Vec::new(),
                false => cell::stiffness(*kind, &x, case.space, &materials[body], formulation),
            };
            stiffness.push(k);
            mass.push(cell::mass(*kind, &x, case.space, materials[body].density));
        }
        Ok(Bulk {
            stiffness,
            mass,
            rigid,
            rayleigh,
            materials,
        })
    }

    /// The largest entry of a stiffness.
    pub fn stiffest(&self) -> f64 {
        self.stiffness
            .iter()
            .flatten()
            .flatten()
            .fold(0.0, |m, k| m.max(k.abs()))
    }

    /// `K u` by node.
    pub fn elastic(&self, mesh: &Mesh, dim: usize, u: &[Vec3]) -> Vec<Vec3> {
        let mut out = vec![[0.0; 3]; u.len()];
        for ((_, nodes), k) in mesh.cells.iter().zip(&self.stiffness) {
            let local: Vec<f64> = nodes.iter().flat_map(|n| u[*n][..dim].to_vec()).collect();
            for (row, k) in k.iter().enumerate() {
                out[nodes[row / dim]][row % dim] +=
                    k.iter().zip(&local).map(|(k, u)| k * u).sum::<f64>();
            }
        }
        out
    }

    /// `M a` by node, with the consistent or the lumped mass (Hinton, Rock and Zienkiewicz 1976: the diagonal, scaled to the mass of
    /// the cell).
    pub fn inertia(&self, mesh: &Mesh, dim: usize, a: &[Vec3], lumped: bool) -> Vec<Vec3> {
        let mut out = vec![[0.0; 3]; a.len()];
        for ((_, nodes), m) in mesh.cells.iter().zip(&self.mass) {
            let diagonal: f64 = (0..m.len()).map(|i| m[i][i]).sum();
            let whole: f64 = m.iter().flatten().sum();
            for (i, node) in nodes.iter().enumerate() {
                for k in 0..dim {
                    out[*node][k] += match lumped {
                        true => m[i][i] * whole / diagonal.max(f64::MIN_POSITIVE) * a[*node][k],
                        false => m[i]
                            .iter()
                            .zip(nodes)
                            .map(|(m, n)| m * a[*n][k])
                            .sum::<f64>(),
                    };
                }
            }
        }
        out
    }

    /// Scales by body: `C v = α M v + β K v`.
    pub fn damping(&self, mesh: &Mesh, dim: usize, v: &[Vec3], lumped: bool) -> Vec<Vec3> {
        let factored = |which: usize| -> Vec<Vec3> {
            let scale = |(v, b): (&Vec3, &usize)| v.map(|x| x * self.rayleigh[*b][which]);
            v.iter().zip(&mesh.body).map(scale).collect()
        };
        let mut out = self.elastic(mesh, dim, &factored(1));
        for (o, m) in out
            .iter_mut()
            .zip(self.inertia(mesh, dim, &factored(0), lumped))
        {
            *o = crate::vec3::add(*o, m);
        }
        out
    }
}

fn kind_named(material: &toml::Table) -> Option<(&str, &toml::Table)> {
    let found = material
        .iter()
        .find_map(|(name, value)| Some((name.as_str(), value.as_table()?)));
    found.or_else(|| kind(material, "isotropic"))
}
