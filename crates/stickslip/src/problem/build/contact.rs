//! Interfaces: surfaces of the joined mesh to contact points and facets.

use std::collections::BTreeMap;

use super::super::{FacetShape, Interface as Table, Problem};
use super::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use crate::body::{Space, tributary_areas};
use crate::contact::crossing::crossing;
use crate::contact::interface::{Interface, Memory, Primary, neighbours};
use crate::contact::pairing::evaluate;
use crate::contact::response::Laws;
use crate::contact::surface::{ContactPoint, Facet, connect, triangulate};
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, add_scaled, cross, norm, normalize};
use crate::mesh::{FacetRef, Mesh};
use crate::shape::ElementKind;
use crate::simulation::Body;
use crate::system::Dofs;

/// How far a point may overhang the outer edge of the primary, relative to the facet.
const EDGE_TOLERANCE: f64 = 1e-3;

pub(super) fn build(
    problem: &Problem,
    sets: &Sets,
    mesh: &Mesh,
    space: Space,
    bodies: &[Body],
    timeline: &Timeline,
) -> Result<Vec<Interface>, Error> {
    let surfaces = Surfaces {
        mesh,
        space,
        bodies,
    };
    let mut out = Vec::new();
    for (name, table) in &problem.interface {
        let key = format!("interface.{name}");
        let secondary = sets.facets(&table.secondary, &format!("{key}.secondary"))?;
        surfaces.simple(&format!("{key}.secondary"), &secondary)?;
        let mut numbering = Numbering::default();
        let kinematics = table.kinematics.as_dyn();
        let primary = match problem.obstacle.get(&table.primary) {
            Some(obstacle) => Primary::Rigid(
                obstacle.shape.clone(),
                obstacle.motion.clone().unwrap_or_default(),
            ),
            None => {
                let facets = sets.facets(&table.primary, &format!("{key}.primary"))?;
                surfaces.disjoint(&key, &secondary, &facets)?;
                surfaces.simple(&format!("{key}.primary"), &facets)?;
                let mut facets = surfaces.facets(&facets, &mut numbering);
                if kinematics.triangles() || table.facets == Some(FacetShape::Triangles) {
                    facets = triangulate(facets);
                }
                connect(&mut facets);
                Primary::Facets(facets)
            }
        };
        let modulus = match &primary {
            Primary::Facets(facets) => facets.iter().map(|f| f.modulus).fold(0.0, f64::max),
            Primary::Rigid(..) => f64::INFINITY,
        };
        let points = surfaces.points(&secondary, modulus, &mut numbering);
        if points.is_empty() {
            return Err(problem_error(vec![Diagnostic::new(
                format!("{key}.secondary"),
                "the surface is empty",
            )]));
        }
        let beneath = surfaces.facets(&secondary, &mut numbering);
        let nodes = numbering.nodes;
        let reference: Vec<Vec3> = nodes.iter().map(|&n| mesh.points[n]).collect();
        out.push(Interface {
            name: name.clone(),
            dofs: Dofs {
                dim: space.dim(),
                points: mesh.points.len(),
            },
            node_ids: nodes.iter().map(|&n| mesh.point_ids[n]).collect(),
            neighbours: neighbours(&points, &beneath, &reference),
            reference,
            nodes,
            points,
            primary,
            laws: Laws {
                normal: table.normal.clone(),
                damping: table.damping.clone(),
                friction: table.friction.clone(),
                slip: table.slip.clone(),
                enforcement: table.enforcement.clone(),
                wear: table.wear,
            },
            kinematics: table.kinematics.clone(),
            belt: belt(table),
            schedule: timeline.interface(problem, name),
            edge_tolerance: EDGE_TOLERANCE,
            memory: Memory::default(),
        });
    }
    Ok(out)
}

fn belt(table: &Table) -> Vec<[f64; 4]> {
    let at = |v: &[f64], i: usize| v.get(i).copied().unwrap_or(0.0);
    if let Some(v) = &table.primary_velocity {
        return vec![[0.0, at(v, 0), at(v, 1), at(v, 2)]];
    }
    let rows = table.primary_velocity_table.iter().flatten();
    rows.map(|r| [at(r, 0), at(r, 1), at(r, 2), at(r, 3)])
        .collect()
}

/// Mesh points to positions in the interface.
#[derive(Default)]
struct Numbering {
    nodes: Vec<usize>,
    local: BTreeMap<usize, usize>,
}

impl Numbering {
    fn of(&mut self, node: usize) -> usize {
        *self.local.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            self.nodes.len() - 1
        })
    }
}

struct Surfaces<'a> {
    mesh: &'a Mesh,
    space: Space,
    bodies: &'a [Body],
}

/// What a facet adds to its contact points.
struct Beneath {
    normal: Vec3,
    measure: f64,
    modulus: f64,
    height: f64,
}

impl Surfaces<'_> {
    fn modulus(&self, block: usize) -> f64 {
        self.bodies
            .iter()
            .find(|b| b.blocks.contains(&block))
            .and_then(|b| b.elastic.constrained_modulus(block))
            .unwrap_or(0.0)
    }

    fn coordinates(&self, nodes: &[usize]) -> Vec<Vec3> {
        nodes.iter().map(|&n| self.mesh.points[n]).collect()
    }

    /// Normal and measure of a facet, and the stiffness and height of the cell beneath.
    fn beneath(&self, facet: FacetRef) -> Beneath {
        let (kind, nodes) = self.mesh.facet_points(facet);
        let x = self.coordinates(&nodes);
        let (mut measure, mut normal) = (0.0, [0.0; 3]);
        for q in kind.reference().quadrature() {
            let p = evaluate(kind, &x, [q.xi[0], q.xi[1]]);
            let da = q.weight * norm(cross(p.a[0], p.a[1]));
            measure += da;
            normal = add_scaled(normal, da, p.normal);
        }
        let cell = self.mesh.cell_kind(facet.cell);
        // height of a prism is volume over base, of a pyramid (triangle, tetrahedron) dim times that
        let factor = if cell.is_simplex() {
            cell.dim() as f64
        } else {
            1.0
        };
        Beneath {
            normal,
            measure,
            modulus: self.modulus(facet.cell.block),
            height: factor * self.mesh.cell_measure(facet.cell) / measure,
        }
    }

    fn facets(&self, facets: &[FacetRef], numbering: &mut Numbering) -> Vec<Facet> {
        facets
            .iter()
            .map(|&f| {
                let (kind, nodes) = self.mesh.facet_points(f);
                Facet {
                    kind,
                    nodes: nodes.iter().map(|&n| numbering.of(n)).collect(),
                    continues: Vec::new(),
                    modulus: self.modulus(f.cell.block),
                    cell: self.mesh.cell_id(f.cell),
                }
            })
            .collect()
    }

    /// Contact points: the nodes, each with its share of the area; on quadratic faces in space, whose corners have no share or
    /// a negative one, quadrature points instead.
    fn points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let (curved, plain): (Vec<FacetRef>, Vec<FacetRef>) = facets.iter().partition(|&&f| {
            matches!(
                self.mesh.facet_kind(f),
                ElementKind::Tri6 | ElementKind::Quad8
            )
        });
        let mut out = self.nodal_points(&plain, primary, numbering);
        out.extend(self.quadrature_points(&curved, primary, numbering));
        out
    }

    fn nodal_points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        // sums over the facets around a node: normal, area, area × stiffness, area × height
        let mut sums: BTreeMap<usize, (Vec3, f64, f64, f64)> = BTreeMap::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (_, nodes) = self.mesh.facet_points(facet);
            let stiffness = b.modulus.min(primary) / b.height;
            for n in nodes {
                let s = sums.entry(n).or_default();
                s.0 = add_scaled(s.0, 1.0, b.normal);
                s.1 += b.measure;
                s.2 += b.measure * stiffness;
                s.3 += b.measure * b.height;
            }
        }
        tributary_areas(self.mesh, facets, self.space)
            .into_iter()
            .map(|(n, area)| {
                let (normal, measure, stiffness, height) = sums[&n];
                ContactPoint {
                    nodes: vec![numbering.of(n)],
                    weights: vec![1.0],
                    area,
                    stiffness: stiffness / measure,
                    normal: normalize(normal).unwrap_or_default(),
                    size: height / measure,
                }
            })
            .collect()
    }

    fn quadrature_points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let mut out = Vec::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (kind, nodes) = self.mesh.facet_points(facet);
            let x = self.coordinates(&nodes);
            // 2 × 2 points integrate the serendipity functions exactly; more would overconstrain the face
            let rule = match kind {
                ElementKind::Quad8 => ElementKind::Quad4.reference().quadrature(),
                _ => kind.reference().quadrature(),
            };
            let local: Vec<usize> = nodes.iter().map(|&n| numbering.of(n)).collect();
            for q in rule {
                let p = evaluate(kind, &x, [q.xi[0], q.xi[1]]);
                out.push(ContactPoint {
                    nodes: local.clone(),
                    weights: p.n[..nodes.len()].to_vec(),
                    area: q.weight * norm(cross(p.a[0], p.a[1])) * self.space.extent(p.x),
                    stiffness: b.modulus.min(primary) / b.height,
                    normal: p.normal,
                    size: b.height,
                });
            }
        }
        out
    }

    /// No facet of a surface runs through another.
    fn simple(&self, key: &str, facets: &[FacetRef]) -> Result<(), Error> {
        let mut numbering = Numbering::default();
        let surface = self.facets(facets, &mut numbering);
        let x = self.coordinates(&numbering.nodes);
        let Some((i, j)) = crossing(&surface, &x) else {
            return Ok(());
        };
        let cell = |k: usize| {
            let body = self
                .bodies
                .iter()
                .find(|b| b.blocks.contains(&facets[k].cell.block));
            format!(
                "cell {} of body {}",
                surface[k].cell,
                body.map_or("?", |b| b.name.as_str())
            )
        };
        let at = x[surface[i].nodes[0]];
        let at: Vec<String> = at[..self.space.dim()].iter().map(f64::to_string).collect();
        Err(problem_error(vec![
            Diagnostic::new(
                key,
                format!(
                    "the surface runs through itself: at {} and {}, near ({})",
                    cell(i),
                    cell(j),
                    at.join(", ")
                ),
            )
            .help(
                "mend the mesh there, or make the set smaller; two surfaces that overlap belong on the two sides of an interface",
            ),
        ]))
    }

    fn disjoint(
        &self,
        key: &str,
        secondary: &[FacetRef],
        primary: &[FacetRef],
    ) -> Result<(), Error> {
        let ours = self.mesh.points_of_facets(secondary);
        let theirs = self.mesh.points_of_facets(primary);
        let shared: Vec<String> = ours
            .iter()
            .filter(|p| theirs.binary_search(p).is_ok())
            .map(|&p| self.mesh.point_ids[p].to_string())
            .collect();
        let nodes = match shared.as_slice() {
            [] => return Ok(()),
            [one] => format!("node {one}"),
            some if some.len() <= 5 => format!("nodes {}", some.join(", ")),
            many => format!("nodes {}, … {} in all", many[..5].join(", "), many.len()),
        };
        Err(problem_error(vec![
            Diagnostic::new(
                format!("{key}.primary"),
                format!("primary and secondary share points ({nodes})"),
            )
            .help("the two surfaces must belong to different bodies or be apart; duplicate the nodes of a conforming interface"),
        ]))
    }
}
