//! Interfaces: surfaces of the joined mesh to contact points and facets.

use std::collections::BTreeMap;

use super::super::{FacetShape, Interface as Table, Problem, Roles};
use super::faces::FaceGroups;
use super::fault::problem_error;
use super::schedules::Timeline;
use super::sets::Sets;
use crate::body::{Space, tributary_areas};
use crate::contact::crossing::crossing;
use crate::contact::enforcement::Multipliers;
use crate::contact::interface::{
    Attempt, Cache, Directives, History, Initial, Interface, Primary, Start, neighbours,
};
use crate::contact::mortar::{Face, Mortar, mean_weights, positive_areas};
use crate::contact::projection::evaluate;
use crate::contact::response::Laws;
use crate::contact::surface::{ContactPoint, Facet, connect, skin, triangulate};
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, add_scaled, cross, norm, normalize, scale, sub};
use crate::mesh::{FacetRef, Mesh};
use crate::shape::{ElementKind, QuadraturePoint, mass_rule};
use crate::simulation::Body;
use crate::system::{Dofs, Schedule};

/// Multiple of its size by which a model lies away before its interfaces count coordinates from somewhere nearer.
const FAR: f64 = 16.0;

/// How far a point may overhang the outer edge of the primary, relative to the facet.
const EDGE_TOLERANCE: f64 = 1e-3;

/// Radius of a node on the axis, relative to those of its edge.
const ON_AXIS: f64 = 1e-9;

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
        let make = Make {
            problem,
            sets,
            surfaces: &surfaces,
            table,
            schedule: timeline.interface(problem, name),
        };
        let both = table.discretisation().as_dyn().two_sided()
            && !problem.obstacle.contains_key(&table.primary);
        let key = format!("interface.{name}");
        let secondary = (table.secondary.as_str(), format!("{key}.secondary"));
        let primary = (table.primary.as_str(), format!("{key}.primary"));
        if both {
            out.push(make.interface(name.clone(), &secondary, &primary, 0.5)?);
            let mut reverse =
                make.interface(format!("{name}-reverse"), &primary, &secondary, 0.5)?;
            self::reverse(&mut reverse.belt);
            out.push(reverse);
            continue;
        }
        let named = make.interface(name.clone(), &secondary, &primary, 1.0)?;
        out.push(match make.to_exchange(&named) {
            true => exchanged(make.interface(name.clone(), &primary, &secondary, 1.0)?),
            false => named,
        });
    }
    Ok(out)
}

/// Spacing of the points of the secondary over that of the nodes of the primary from which on the sides are exchanged.
const COARSER: f64 = 1.25;

/// An interface made with its sides exchanged: what the problem says of one side is said of the other.
fn exchanged(mut interface: Interface) -> Interface {
    interface.exchanged = true;
    reverse(&mut interface.belt);
    if let Some(wear) = &mut interface.laws.wear {
        std::mem::swap(&mut wear.coefficient, &mut wear.primary_coefficient);
    }
    interface
}

/// The other side of a belt comes the other way.
fn reverse(belt: &mut [[f64; 4]]) {
    for v in belt.iter_mut().flat_map(|row| &mut row[1..]) {
        *v = -*v;
    }
}

/// What an interface is made from.
struct Make<'a> {
    problem: &'a Problem,
    sets: &'a Sets<'a>,
    surfaces: &'a Surfaces<'a>,
    table: &'a Table,
    schedule: Schedule,
}

impl Make<'_> {
    /// The facets of a secondary, and the points to which it is restricted: one that is met by points may be a few points
    /// of a body that make no facet. Then each stands for its share of all facets of the boundary around it.
    fn secondary_facets(
        &self,
        (name, key): &(&str, String),
    ) -> Result<(Vec<FacetRef>, Option<Vec<usize>>), Error> {
        let found = self.sets.facets(name, key);
        let by_points = self.table.discretisation().as_dyn().weighted().is_none();
        if found.is_ok() || !by_points {
            return Ok((found?, None));
        }
        let points = self.sets.points(name, key)?;
        let mesh = self.surfaces.mesh;
        let mut facets = mesh.boundary();
        facets.retain(|&f| {
            let (_, nodes) = mesh.facet_points(f);
            nodes.iter().any(|n| points.binary_search(n).is_ok())
        });
        match facets.is_empty() {
            true => Ok((found?, None)),
            false => Ok((facets, Some(points))),
        }
    }

    /// Whether the side that is named primary becomes the secondary, because its cells are smaller: points see what is opposite them, and between points that are
    /// far apart a finer surface would enter unseen. Not where the problem says more of the points than what they are on: which of them move, which take part;
    /// and points of a rigid body, which cannot give way one by one, are no secondary.
    fn to_exchange(&self, named: &Interface) -> bool {
        let table = self.table;
        let settled = table.roles == Roles::AsNamed
            || table.tied
            || table.initial == Start::Snap
            || table.initial_set.is_some();
        if settled {
            return false;
        }
        let bodies = self.surfaces.bodies;
        let rigid = named.nodes[..named.primary_nodes].first().is_some_and(|n| {
            let body = bodies.iter().find(|b| b.points.contains(n));
            body.is_some_and(|b| b.rigid.is_some())
        });
        !rigid && named.coarser().is_some_and(|ratio| ratio > COARSER)
    }

    /// How an interface starts; `key` is that of its secondary.
    fn initial(&self, key: &str) -> Result<Initial, Error> {
        let table = self.table;
        let mut initial = Initial::new(table.initial, table.within());
        if let Some(set) = &table.initial_set {
            let key = key.rsplit_once('.').map_or(key, |(table, _)| table);
            initial.only = Some(self.sets.points(set, &format!("{key}.initial-set"))?);
        }
        Ok(initial)
    }

    /// An interface between two surfaces, given with the keys that name them, which carries `share` of the pressure.
    fn interface(
        &self,
        name: String,
        secondary: &(&str, String),
        primary: &(&str, String),
        share: f64,
    ) -> Result<Interface, Error> {
        let (surfaces, table) = (self.surfaces, self.table);
        let (facets, only) = self.secondary_facets(secondary)?;
        if only.is_none() {
            surfaces.simple(&secondary.1, &facets)?;
        }
        let mut numbering = Numbering::default();
        let origin = surfaces.origin();
        let opposite = match self.problem.obstacle.get(primary.0) {
            Some(obstacle) => Primary::Rigid(
                obstacle.shape.moved(scale(-1.0, origin)),
                obstacle
                    .motion
                    .clone()
                    .unwrap_or_default()
                    .moved(scale(-1.0, origin)),
            ),
            None => {
                let theirs = self.sets.facets(primary.0, &primary.1)?;
                surfaces.disjoint(&primary.1, &facets, &theirs)?;
                surfaces.simple(&primary.1, &theirs)?;
                let mut theirs = surfaces.facets(&theirs, &mut numbering);
                if table.kinematics.as_dyn().triangles()
                    || table.facets == Some(FacetShape::Triangles)
                {
                    theirs = triangulate(theirs);
                }
                connect(&mut theirs);
                Primary::Facets(theirs)
            }
        };
        let modulus = match &opposite {
            Primary::Facets(facets) => facets.iter().map(|f| f.modulus).fold(0.0, f64::max),
            Primary::Rigid(..) => f64::INFINITY,
        };
        let primary_nodes = numbering.nodes.len();
        let discretisation = table.discretisation();
        let weighted = match &opposite {
            Primary::Facets(_) => discretisation.as_dyn().weighted(),
            Primary::Rigid(..) => None,
        };
        let (points, mortar) = match weighted {
            Some(angle) => {
                let (points, mortar) =
                    surfaces.mortar(&facets, modulus, angle.to_radians(), &mut numbering);
                (points, Some(mortar))
            }
            None => {
                let obstacle = matches!(opposite, Primary::Rigid(..));
                let points =
                    surfaces.points(&facets, (modulus, obstacle, yields(table)), &mut numbering);
                (points, None)
            }
        };
        let points: Vec<ContactPoint> = match &only {
            Some(only) => {
                let chosen = |p: &ContactPoint| {
                    let nodes = p.nodes.iter().map(|&n| numbering.nodes[n]);
                    nodes.into_iter().all(|n| only.binary_search(&n).is_ok())
                };
                points.into_iter().filter(chosen).collect()
            }
            None => points,
        };
        if points.is_empty() {
            return Err(problem_error(vec![Diagnostic::new(
                secondary.1.clone(),
                "the surface is empty",
            )]));
        }
        let mesh = surfaces.mesh;
        let beneath = surfaces.facets(&facets, &mut numbering);
        let nodes = numbering.nodes;
        let reference: Vec<Vec3> = nodes.iter().map(|&n| sub(mesh.points[n], origin)).collect();
        let faces = mortar
            .as_ref()
            .map(|m| m.faces.iter().map(|f| f.points.clone()));
        let own: Option<Vec<Vec<usize>>> = faces.map(Iterator::collect);
        Ok(Interface {
            name,
            dofs: Dofs {
                dim: surfaces.space.dim(),
                points: mesh.points.len(),
            },
            node_ids: nodes.iter().map(|&n| mesh.point_ids[n]).collect(),
            neighbours: neighbours(&points, &beneath, &reference),
            // A few points chosen from a body make no surface.
            skin: match only {
                Some(_) => Vec::new(),
                None => skin(beneath, &points, own.as_deref()),
            },
            origin,
            reference,
            nodes,
            primary_nodes,
            points,
            mortar,
            primary: opposite,
            share,
            exchanged: false,
            laws: Laws {
                normal: table.normal.clone(),
                damping: table.damping.clone(),
                friction: table.friction.clone(),
                slip: table.slip.clone(),
                enforcement: table.enforcement.clone(),
                tied: table.tied,
                wear: table.wear,
                user: Default::default(),
            },
            kinematics: table.kinematics.clone(),
            belt: belt(table),
            schedule: self.schedule.clone(),
            edge_tolerance: EDGE_TOLERANCE,
            initial: self.initial(&secondary.1)?,
            history: History::default(),
            attempt: Attempt::default(),
            directives: Directives::default(),
            cache: Cache::default(),
        })
    }
}

/// Whether the laws give way under any pressure and shear, so that there may be more points than a face has freedoms.
fn yields(table: &Table) -> bool {
    let compliant = table.normal.as_dyn().pressure(0.0).is_some();
    let friction = table.friction.as_dyn().frictional() && table.slip.as_dyn().sticks();
    let springs = table.enforcement.as_dyn().multipliers() == Multipliers::None;
    compliant && !table.tied && (springs || !friction)
}

/// Divisions of a quadrilateral, each way, with 2 × 2 points in each part.
const DIVISIONS: usize = 3;

/// Points of a quadratic face. 2 × 2 points integrate the serendipity functions exactly, and more would overconstrain the face. Where laws yield
/// it is the pressure that is integrated, which may act on a part of the face only and would go unseen between so few.
fn face_rule(kind: ElementKind, yields: bool) -> Vec<QuadraturePoint> {
    let plain = ElementKind::Quad4.reference().quadrature();
    match (kind, yields) {
        (ElementKind::Quad8, false) => plain.to_vec(),
        (ElementKind::Line3, false) => ElementKind::Line2.reference().quadrature().to_vec(),
        (_, false) => kind.reference().quadrature().to_vec(),
        (ElementKind::Quad8, true) => {
            let h = 1.0 / DIVISIONS as f64;
            let middle = |k: usize| (2 * k + 1) as f64 * h - 1.0;
            let parts =
                (0..DIVISIONS * DIVISIONS).map(|k| [middle(k / DIVISIONS), middle(k % DIVISIONS)]);
            let points = parts.flat_map(|[s, t]| {
                plain.iter().map(move |q| QuadraturePoint {
                    xi: [s + h * q.xi[0], t + h * q.xi[1], 0.0],
                    weight: h * h * q.weight,
                })
            });
            points.collect()
        }
        (_, true) => mass_rule(kind),
    }
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

    /// Where the coordinates of interfaces are counted from: near the middle of a model that lies many times its size away from where the user counts
    /// from, with so few digits that nothing is lost where it is taken off. Never another radius.
    fn origin(&self) -> Vec3 {
        let Some(&first) = self.mesh.points.first() else {
            return [0.0; 3];
        };
        let (mut low, mut high) = (first, first);
        for x in &self.mesh.points {
            low = std::array::from_fn(|c| low[c].min(x[c]));
            high = std::array::from_fn(|c| high[c].max(x[c]));
        }
        let size = norm(sub(high, low));
        let unit = size.log2().ceil().exp2();
        std::array::from_fn(|c| {
            let middle = 0.5 * (low[c] + high[c]);
            let far = middle.abs() > FAR * size && unit.is_normal();
            let radius = c == 0 && self.space == Space::Axisymmetric;
            match far && !radius {
                true => unit * (middle / unit).round(),
                false => 0.0,
            }
        })
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
        // height of a prism is volume over base, of a pyramid (triangle, tetrahedron) dim times that, of a wedge on its side twice that
        let factor = match (cell.linear(), kind.linear()) {
            _ if cell.is_simplex() => cell.dim() as f64,
            (ElementKind::Wedge6, ElementKind::Quad4) => 2.0,
            _ => 1.0,
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

    /// Contact points: the nodes, each with its share of the area. Corners of quadratic faces in space have no share or a negative one, those of quadratic
    /// edges that are turned about an axis one in proportion to their radius, which is none on the axis: there points are means over the faces around each
    /// node on an `obstacle`, and quadrature points on facets.
    fn points(
        &self,
        facets: &[FacetRef],
        (primary, obstacle, yields): (f64, bool, bool),
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let (curved, plain): (Vec<FacetRef>, Vec<FacetRef>) = facets.iter().partition(|&&f| {
            match self.mesh.facet_kind(f) {
                ElementKind::Tri6 | ElementKind::Quad8 => true,
                // Means are those of the whole surface; quadrature points are needed where a node has nothing.
                ElementKind::Line3 => self.turned(obstacle, f),
                _ => false,
            }
        });
        let mut out = self.nodal_points(&plain, primary, numbering);
        out.extend(match obstacle {
            true => self.mean_points(&curved, primary, numbering),
            false => self.quadrature_points(&curved, (primary, yields), numbering),
        });
        out
    }

    /// Whether an edge is turned about an axis, of facets whether it begins or ends there.
    fn turned(&self, obstacle: bool, facet: FacetRef) -> bool {
        let (_, nodes) = self.mesh.facet_points(facet);
        let extents = || {
            nodes
                .iter()
                .map(|&n| self.space.extent(self.mesh.points[n]))
        };
        let most = extents().fold(0.0, f64::max);
        matches!(self.space, Space::Axisymmetric)
            && (obstacle || extents().any(|e| e <= ON_AXIS * most))
    }

    /// One point a node, the mean over the quadratic faces around it weighted by its dual function: as many points as a body can follow, with
    /// positive areas that make a uniform pressure exact. See [`mean_weights`].
    fn mean_points(
        &self,
        facets: &[FacetRef],
        primary: f64,
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let mut at: BTreeMap<usize, usize> = BTreeMap::new();
        let mut out: Vec<ContactPoint> = Vec::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (kind, nodes) = self.mesh.facet_points(facet);
            let x = self.coordinates(&nodes);
            let areas = positive_areas(kind, &x, |at| self.space.extent(at));
            let stiffness = b.modulus.min(primary) / b.height;
            for (k, &node) in nodes.iter().enumerate() {
                let i = *at.entry(node).or_insert_with(|| {
                    let (hung, weights) = mean_weights(kind, k);
                    out.push(ContactPoint {
                        nodes: hung.iter().map(|&k| numbering.of(nodes[k])).collect(),
                        weights,
                        area: 0.0,
                        stiffness: 0.0,
                        normal: [0.0; 3],
                        size: 0.0,
                    });
                    out.len() - 1
                });
                let point = &mut out[i];
                point.area += areas[k];
                point.stiffness += areas[k] * stiffness;
                point.size += areas[k] * b.height;
                point.normal = add_scaled(point.normal, areas[k] / b.measure, b.normal);
            }
        }
        for point in &mut out {
            point.stiffness /= point.area;
            point.size /= point.area;
            point.normal = normalize(point.normal).unwrap_or_default();
        }
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
        (primary, yields): (f64, bool),
        numbering: &mut Numbering,
    ) -> Vec<ContactPoint> {
        let mut out = Vec::new();
        for &facet in facets {
            let b = self.beneath(facet);
            let (kind, nodes) = self.mesh.facet_points(facet);
            let x = self.coordinates(&nodes);
            let rule = face_rule(kind, yields);
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

    /// One contact point a node and smooth part of the surface, and the faces that they are weighted over.
    fn mortar(
        &self,
        facets: &[FacetRef],
        primary: f64,
        angle: f64,
        numbering: &mut Numbering,
    ) -> (Vec<ContactPoint>, Mortar) {
        let beneath: Vec<Beneath> = facets.iter().map(|&f| self.beneath(f)).collect();
        let shapes: Vec<(ElementKind, Vec<usize>)> =
            facets.iter().map(|&f| self.mesh.facet_points(f)).collect();
        let normals: Vec<Vec3> = (beneath.iter())
            .map(|b| normalize(b.normal).unwrap_or_default())
            .collect();
        let groups = FaceGroups::new(&shapes, &normals, angle);
        let mut points: Vec<ContactPoint> = Vec::new();
        let mut known: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut faces = Vec::new();
        for (k, (kind, nodes)) in shapes.iter().enumerate() {
            let x = self.coordinates(nodes);
            let areas = positive_areas(*kind, &x, |at| self.space.extent(at));
            let b = &beneath[k];
            let stiffness = b.modulus.min(primary) / b.height;
            let mut face = Face {
                kind: *kind,
                nodes: nodes.iter().map(|&n| numbering.of(n)).collect(),
                points: Vec::new(),
                normals: groups.normals(k).to_vec(),
                extents: x.iter().map(|&x| self.space.extent(x)).collect(),
            };
            for (a, &node) in nodes.iter().enumerate() {
                let normal = face.normals[a];
                let at = *known.entry((node, groups.group(k))).or_insert_with(|| {
                    points.push(ContactPoint {
                        nodes: vec![face.nodes[a]],
                        weights: vec![1.0],
                        area: 0.0,
                        stiffness: 0.0,
                        normal,
                        size: 0.0,
                    });
                    points.len() - 1
                });
                face.points.push(at);
                let point = &mut points[at];
                point.area += areas[a];
                point.stiffness += areas[a] * stiffness;
                point.size += areas[a] * b.height;
            }
            faces.push(face);
        }
        for point in &mut points {
            point.stiffness /= point.area;
            point.size /= point.area;
        }
        let mortar = Mortar::new(faces, points.len());
        (points, mortar)
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

    /// The two sides have no point in common.
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
                key,
                format!("primary and secondary share points ({nodes})"),
            )
            .help("the two surfaces must belong to different bodies or be apart; duplicate the nodes of a conforming interface"),
        ]))
    }
}
