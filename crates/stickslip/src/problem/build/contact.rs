//! Interfaces: surfaces of the joined mesh to contact points and facets.

use crate::contact::look;
use std::sync::Arc;

use super::super::{FacetShape, Interface as Table, Problem, Roles};
use super::fault::problem_error;
use super::held::HeldNodes;
use super::mirrors::{self, Held};
use super::schedules::Timeline;
use super::sets::Sets;
use super::surfaces::{Numbering, Surfaces};
use crate::contact::enforcement::Multipliers;
use crate::contact::interface::{Initial, InterfaceDefinition, InterfaceMesh, Primary, Start};
use crate::contact::law::wear::{Feedback, WearRate};
use crate::contact::look::neighbours;
use crate::contact::mortar::Mortar;
use crate::contact::response::Laws;
use crate::contact::surface::{ContactPoint, connect, skin, triangulate};
use crate::contact::walls::Walls;
use crate::contact::worn::{OppositeWear, TrackSampling, WearTrack};
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, norm, scale, sub};
use crate::mesh::FacetRef;
use crate::system::{Dofs, Schedule};

pub(super) fn build(
    problem: &Problem,
    sets: &Sets,
    surfaces: &Surfaces,
    timeline: &Timeline,
    held: &Held,
    held_nodes: &HeldNodes,
) -> Result<Vec<InterfaceDefinition>, Error> {
    let mut out = Vec::new();
    for (name, table) in &problem.interface {
        let make = Make {
            problem,
            sets,
            surfaces,
            table,
            held,
            held_nodes,
            schedule: timeline.interface(problem, name),
        };
        let both = table.discretisation().as_dyn().two_sided()
            && !problem.obstacle.contains_key(&table.primary);
        let key = format!("interface.{name}");
        let secondary = Side {
            name: &table.secondary,
            key: format!("{key}.secondary"),
        };
        let primary = Side {
            name: &table.primary,
            key: format!("{key}.primary"),
        };
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

/// Spacing of the points of the secondary over that of the nodes of the primary from which on the sides are exchanged. Tuned: a half-disc
/// of 4 mm cells pressed into a block was up to five times too stiff where the sides were not exchanged, and 11 % with 20 cells.
const COARSER_SECONDARY: f64 = 1.25;

/// An interface made with its sides exchanged: what the problem says of one side is said of the other.
fn exchanged(mut interface: InterfaceDefinition) -> InterfaceDefinition {
    interface.exchanged = true;
    reverse(&mut interface.belt);
    interface
}

/// The other side of a belt comes the other way.
fn reverse(belt: &mut [[f64; 4]]) {
    for v in belt.iter_mut().flat_map(|row| &mut row[1..]) {
        *v = -*v;
    }
}

/// A side of an interface: a surface, and the key that names it.
struct Side<'a> {
    name: &'a str,
    key: String,
}

/// What an interface is made from.
struct Make<'a> {
    problem: &'a Problem,
    sets: &'a Sets<'a>,
    surfaces: &'a Surfaces<'a>,
    table: &'a Table,
    held: &'a Held<'a>,
    held_nodes: &'a HeldNodes<'a>,
    schedule: Schedule,
}

impl Make<'_> {
    /// The facets of a secondary, and the points to which it is restricted: one that is met by points may be a few points
    /// of a body that make no facet. Then each stands for its share of all facets of the boundary around it.
    fn secondary_facets(
        &self,
        Side { name, key }: &Side,
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
    fn to_exchange(&self, named: &InterfaceDefinition) -> bool {
        let table = self.table;
        let settled = table.roles == Roles::AsNamed
            || table.tied
            || table.initial == Start::Snap
            || table.roughness.is_some()
            || table.initial_set.is_some()
            || goes_by(table);
        if settled {
            return false;
        }
        let bodies = self.surfaces.bodies;
        let rigid = named.nodes[..named.primary_nodes].first().is_some_and(|n| {
            let body = bodies.iter().find(|b| b.points.contains(n));
            body.is_some_and(|b| b.rigid.is_some())
        });
        !rigid && look::coarser(named).is_some_and(|ratio| ratio > COARSER_SECONDARY)
    }

    /// How an interface starts; `key` is that of its secondary.
    fn initial(&self, key: &str) -> Result<Initial, Error> {
        let table = self.table;
        let mut initial = Initial::new(table.initial, table.within());
        initial.gap = table.initial_gap.unwrap_or(0.0);
        if let Some(set) = &table.initial_set {
            let key = key.rsplit_once('.').map_or(key, |(table, _)| table);
            initial.only = Some(self.sets.points(set, &format!("{key}.initial-set"))?);
        }
        Ok(initial)
    }

    /// What the points may touch, and the points of the mesh that both sides have: the tips of a slit.
    fn opposite(
        &self,
        primary: &Side,
        facets: &[FacetRef],
        numbering: &mut Numbering,
    ) -> Result<(Primary, Vec<usize>), Error> {
        let (surfaces, table) = (self.surfaces, self.table);
        let origin = surfaces.origin();
        Ok(match self.problem.obstacle.get(primary.name) {
            Some(obstacle) => {
                let rigid = Primary::Rigid(
                    obstacle.shape.moved(scale(-1.0, origin)),
                    obstacle
                        .motion
                        .clone()
                        .unwrap_or_default()
                        .moved(scale(-1.0, origin)),
                );
                (rigid, Vec::new())
            }
            None => {
                let theirs = self.sets.facets(primary.name, &primary.key)?;
                let tips = surfaces.tips(&primary.key, facets, &theirs)?;
                surfaces.simple(&primary.key, &theirs)?;
                let mut theirs = surfaces.facets(&theirs, numbering);
                if table.kinematics.as_dyn().triangles()
                    || table.facets == Some(FacetShape::Triangles)
                {
                    theirs = triangulate(theirs);
                }
                connect(&mut theirs);
                (Primary::Facets(theirs), tips)
            }
        })
    }

    /// Where contact is evaluated, and the integrals over both sides if it is over faces; of some points of a body only these.
    fn points(
        &self,
        facets: &[FacetRef],
        opposite: &Primary,
        tips: &[usize],
        only: Option<&[usize]>,
        numbering: &mut Numbering,
    ) -> (Vec<ContactPoint>, Option<Mortar>) {
        let (surfaces, table) = (self.surfaces, self.table);
        let modulus = match opposite {
            Primary::Facets(facets) => facets.iter().map(|f| f.modulus).fold(0.0, f64::max),
            Primary::Rigid(..) => f64::INFINITY,
        };
        let discretisation = table.discretisation();
        let weighted = match opposite {
            Primary::Facets(_) => discretisation.as_dyn().weighted(),
            Primary::Rigid(..) => None,
        };
        let (points, mortar) = match weighted {
            Some(angle) => {
                let (points, mortar) =
                    surfaces.mortar(facets, tips, modulus, angle.to_radians(), numbering);
                (points, Some(mortar))
            }
            None => {
                let obstacle = matches!(opposite, Primary::Rigid(..));
                let yields = yields(table);
                let points = surfaces.points(facets, tips, modulus, obstacle, yields, numbering);
                (points, None)
            }
        };
        let points = match only {
            Some(only) => {
                let chosen = |p: &ContactPoint| {
                    let nodes = p.nodes.iter().map(|&n| numbering.nodes[n]);
                    nodes.into_iter().all(|n| only.binary_search(&n).is_ok())
                };
                points.into_iter().filter(chosen).collect()
            }
            None => points,
        };
        (points, mortar)
    }

    /// How what is worn off the primary is kept, where something wears: at its nodes; of an obstacle, and where its material moves past, on a track.
    fn opposite_wear(
        &self,
        opposite: &Primary,
        above: TrackSampling,
        key: &str,
    ) -> Result<OppositeWear, Error> {
        let wear = self.table.wear.as_dyn();
        if !wear.active() {
            return Ok(OppositeWear::default());
        }
        let extent = |at: Vec3| self.surfaces.space.extent(at);
        let facets = match opposite {
            Primary::Facets(facets) => facets,
            Primary::Rigid(..) if wear.fastest()[1] == WearRate::default() => {
                return Ok(OppositeWear::default());
            }
            Primary::Rigid(shape, _) => {
                return Ok(OppositeWear::on(WearTrack::of_obstacle(
                    shape.as_dyn(),
                    above,
                    extent,
                )));
            }
        };
        if !goes_by(self.table) {
            return Ok(OppositeWear::new(facets, above.x, extent));
        }
        let rows = belt(self.table);
        let speed = |row: &[f64; 4]| norm([row[1], row[2], row[3]]);
        let fastest = rows.iter().max_by(|a, b| speed(a).total_cmp(&speed(b)));
        let direction = fastest.map_or([1.0, 0.0, 0.0], |row| [row[1], row[2], row[3]]);
        let track = WearTrack::of_facets(facets, direction, above, extent);
        let message = "the primary wears and has a `primary-velocity`, and is not plane: where its matter is after a time is not known";
        let fault = Diagnostic::new(key, message)
            .help("make the primary an obstacle that turns by `motion.rotation`, or let the secondary alone wear");
        track
            .map(OppositeWear::on)
            .ok_or_else(|| problem_error(vec![fault]))
    }

    /// An interface between two surfaces, given with the keys that name them, which carries `share` of the pressure.
    fn interface(
        &self,
        name: String,
        secondary: &Side,
        primary: &Side,
        share: f64,
    ) -> Result<InterfaceDefinition, Error> {
        let (surfaces, table) = (self.surfaces, self.table);
        let (facets, only) = self.secondary_facets(secondary)?;
        if only.is_none() {
            surfaces.simple(&secondary.key, &facets)?;
        }
        let mut numbering = Numbering::default();
        let origin = surfaces.origin();
        let (opposite, tips) = self.opposite(primary, &facets, &mut numbering)?;
        let primary_nodes = numbering.nodes.len();
        let (points, mortar) =
            self.points(&facets, &opposite, &tips, only.as_deref(), &mut numbering);
        let (points, alike) = match mortar {
            Some(_) => (points, Vec::new()),
            None => (self.held_nodes).as_one(points, table.tied, &numbering.nodes, primary_nodes),
        };
        if points.is_empty() {
            return Err(problem_error(vec![Diagnostic::new(
                secondary.key.clone(),
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
        let neighbours = neighbours(&points, &beneath, &reference);
        // A few points chosen from a body make no surface.
        let skin = match only {
            Some(_) => Vec::new(),
            None => skin(beneath, &points, own.as_deref()),
        };
        let above = TrackSampling {
            points: &points,
            skin: &skin,
            x: &reference,
            dim: surfaces.space.dim(),
        };
        let opposite_wear = self.opposite_wear(&opposite, above, &primary.key)?;
        let mut interface = InterfaceDefinition {
            name,
            mesh: Arc::new(InterfaceMesh {
                dofs: Dofs {
                    dim: surfaces.space.dim(),
                    points: mesh.points.len(),
                },
                node_ids: nodes.iter().map(|&n| mesh.point_ids[n]).collect(),
                neighbours,
                skin,
                origin,
                nodes,
                primary_nodes,
                points,
                alike,
                mortar,
                opposite_wear,
                walls: Walls::default(),
                primary: opposite,
                reference,
                clamped: Vec::new(),
                relief: Vec::new(),
            }),
            share,
            exchanged: false,
            laws: chosen(table),
            kinematics: table.kinematics.clone(),
            belt: belt(table),
            schedule: self.schedule.clone(),
            frames: Arc::default(),
            turns: false,
            initial: self.initial(&secondary.key)?,
        };
        if let Some(angle) = table.discretisation().as_dyn().weighted() {
            mirrors::mark(&mut interface, self.held, angle.to_radians());
        }
        Ok(interface)
    }
}

/// The laws that a table chooses.
fn chosen(table: &Table) -> Laws {
    Laws {
        normal: table.normal.clone(),
        damping: table.damping.clone(),
        friction: table.friction.clone(),
        slip: table.slip.clone(),
        enforcement: table.enforcement.clone(),
        tied: table.tied,
        wear: table.wear.clone(),
        feedback: table.wear_feedback,
        user: Default::default(),
        own_friction: None,
    }
}

/// Whether the laws give way under any pressure and shear, so that there may be more points than a face has freedoms.
fn yields(table: &Table) -> bool {
    let friction = table.friction.as_dyn().frictional() && table.slip.as_dyn().sticks();
    let springs = table.enforcement.as_dyn().multipliers() == Multipliers::None;
    table.is_compliant() && (springs || !friction)
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

/// Whether the primary wears and its material moves past, so that what is worn off it goes along.
fn goes_by(table: &Table) -> bool {
    let moves = table.primary_velocity.is_some() || table.primary_velocity_table.is_some();
    let [_, primary] = table.wear.as_dyn().fastest();
    moves && primary != WearRate::default() && table.wear_feedback != Feedback::None
}
