//! From a checked [`Problem`] to a [`Model`](crate::model::Model): meshes are made or read, names become indices.

mod axes;
mod contact;
mod contradicting;
mod couplings;
mod cuts;
mod faces;
mod fault;
mod heat;
mod held;
mod initial;
mod meshes;
mod mirrors;
mod pretensions;
mod references;
mod relief;
mod rigid;
mod schedules;
mod sets;
mod snap;
mod surfaces;
mod turning;
mod unused;
mod worn;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use super::{BodyRotation, Problem};
use crate::body::couplings::{Coupling, Couplings, Ground};
use crate::body::loads::{Action, Domain, Load, LoadKind, Pressing, Region, Spring, Target};
use crate::body::{Elastic, Space};
use crate::contact::interface::{Interface, InterfaceDefinition};
use crate::error::{Diagnostic, Error};
use crate::mesh::{FacetRef, Mesh, geometry};
use crate::model::definition::EventPlan;
use crate::model::{
    Actions, Body, Contact, Heat, Model, OutputPlan, Prescribed, Probe, Reference, ReportPlan,
    Setup, SolutionPlan, Step, Support,
};
use crate::newton::Settings;
use crate::system::{BodyFrames, Corotations, DependentNode, Dofs, Link, Links, Motion};
pub use meshes::Meshes;

use fault::problem_error;
use rigid::RigidBodies;
use schedules::Timeline;
use sets::Sets;

/// The bodies of a problem as they are built.
struct BuiltBodies {
    bodies: Vec<Body>,
    /// Those of the rigid ones.
    links: Vec<Link>,
    /// Materials of each body, by part.
    materials: Vec<Vec<String>>,
    /// By block of the mesh `[kg/m³]`.
    densities: Vec<f64>,
}

/// Meshes, bodies and names: what the rest of a problem refers to.
struct Assembled<'a> {
    mesh: &'a Arc<Mesh>,
    space: Space,
    dofs: Dofs,
    bodies: &'a [Body],
    links: &'a Links,
    frames: &'a Arc<BodyFrames>,
    densities: &'a [f64],
    sets: &'a Sets<'a>,
    timeline: &'a Timeline,
    cuts: &'a [cuts::BuiltCut],
}

impl<'a> Assembled<'a> {
    fn rigid(&self) -> RigidBodies<'a> {
        RigidBodies {
            links: self.links,
            bodies: self.bodies,
            dofs: self.dofs,
        }
    }
}

/// What acts on bodies and joins them, and when.
struct Attached {
    loads: Vec<Load>,
    springs: Vec<Spring>,
    masses: Vec<(usize, f64)>,
    couplings: Vec<Coupling>,
    supports: Vec<Support>,
    steps: Vec<Step>,
    references: Vec<Reference>,
    followers: Vec<DependentNode>,
    corotations: Corotations,
}

/// Builds a problem that was checked. `snap` and worn surfaces move points, and all that follows from coordinates is made anew.
pub fn build(problem: &Problem, folder: &Path, meshes: &Meshes) -> Result<Setup, Error> {
    let mut moves = snap::Moves::default();
    let mut setup = build_moved(problem, folder, meshes, moves.clone())?;
    for round in 0..worn::rounds(problem) {
        worn::add_round(problem, folder, round, &setup, &mut moves)?;
        setup = build_moved(problem, folder, meshes, moves.clone())?;
    }
    let start = setup.model.steps.first().map_or(0.0, |s| s.start);
    match snap::add(problem, &setup.contact.interfaces, start, &mut moves) {
        true => build_moved(problem, folder, meshes, moves),
        false => Ok(setup),
    }
}

/// What is said of an interface whose sides were exchanged.
fn exchange_note(problem: &Problem, interface: &InterfaceDefinition) -> Option<String> {
    let table = problem.interface.get(&interface.name)?;
    interface.exchanged.then(|| {
        format!(
            "interface {}: {} has the larger cells, so {} is the secondary surface in the computation; forces and slip are reported for the sides as they are named (`roles = \"as-named\"` keeps the roles)",
            interface.name, table.secondary, table.primary
        )
    })
}

/// The bodies, with the links of the rigid ones.
fn bodies(
    problem: &Problem,
    parts: Vec<meshes::BuiltBody>,
    mesh: &Arc<Mesh>,
    space: Space,
) -> Result<BuiltBodies, Error> {
    let mut bodies = Vec::new();
    let mut links = Vec::new();
    let mut materials = Vec::new();
    let mut densities = vec![0.0; mesh.blocks.len()];
    for part in parts {
        let table = &problem.body[&part.name];
        for p in &part.parts {
            densities[p.block] = p.density;
        }
        let elastic = Elastic::new(
            &part.name,
            Arc::clone(mesh),
            space,
            table.formulation,
            part.parts,
        )
        .map_err(|e| problem_error(vec![e.under(&format!("body.{}", part.name))]))?;
        let elastic = match table.rotation {
            BodyRotation::Corotational => elastic.corotational(),
            _ => elastic,
        };
        materials.push(part.materials);
        let rigid = table.rigid.then(|| {
            let hidden = mesh.points.len() + 2 * links.len();
            let (link, rigid) = rigid::link(
                &elastic,
                part.points.clone(),
                hidden,
                links.len(),
                &table.rotation,
            );
            links.push(link);
            rigid
        });
        bodies.push(Body {
            name: part.name,
            rigid,
            points: part.points,
            blocks: part.blocks,
            pieces: part.pieces,
            elastic,
            rayleigh: match table.rayleigh {
                Some(r) => [r.mass, r.stiffness],
                None => [0.0; 2],
            },
        });
    }
    Ok(BuiltBodies {
        bodies,
        links,
        materials,
        densities,
    })
}

/// What acts on the bodies and joins them, and the steps.
fn attach(problem: &Problem, built: &Assembled) -> Result<Attached, Error> {
    let &Assembled {
        mesh,
        space,
        dofs,
        bodies,
        links,
        frames,
        densities,
        sets,
        timeline,
        cuts,
    } = built;
    let rigid = built.rigid();
    let masses = masses(problem, sets, &rigid)?;
    let domain = Domain {
        masses: &masses,
        mesh,
        space,
        densities,
        links,
    };
    let (mut loads, springs) = loads(problem, sets, &domain, timeline, bodies)?;
    let ground = Ground { mesh, space, links };
    let (mut couplings, leads) = couplings::build(problem, sets, ground, timeline)?;
    let supports = supports(problem, sets, &rigid, timeline)?;
    let steps = timeline.steps(problem, schedules::contact_at(problem, &couplings));
    couplings::refuse_prescribed_stops(&couplings, &supports, links, &steps)?;
    let said = references::Said {
        bodies,
        links,
        couplings: &couplings,
        supports: &supports,
        springs: &springs,
        masses: &masses,
        loads: &loads,
        steps: &steps,
        frames,
        references: problem.reference.keys().cloned().collect(),
    };
    let corotations = turning::corotations(problem, mesh, bodies, dofs);
    turning::refuse(problem, &said, &corotations)?;
    let references = references::build(problem, &said)?;
    let followers = references::followers(
        &mut couplings,
        &leads,
        &references,
        (links, &supports, &springs, &masses),
        &steps,
    );
    references::spread(&mut loads, &followers);
    references::refuse_massless(&couplings, &references, links, &supports, &masses, &steps)?;
    couplings.extend(pretensions::build(problem, cuts, mesh, space, timeline)?);
    Ok(Attached {
        loads,
        springs,
        masses,
        couplings,
        supports,
        steps,
        references,
        followers,
        corotations,
    })
}

/// The interfaces, and what is said of the heights of their surfaces.
fn interfaces(
    problem: &Problem,
    folder: &Path,
    built: &Assembled,
    attached: &Attached,
) -> Result<(Vec<InterfaceDefinition>, Vec<String>), Error> {
    let &Assembled {
        mesh,
        space,
        dofs,
        bodies,
        links,
        frames,
        sets,
        timeline,
        ..
    } = built;
    let (supports, corotations) = (&attached.supports, &attached.corotations);
    let mut held_nodes = held::HeldNodes::new(links, dofs, supports, &attached.couplings);
    let held = mirrors::Held::new(links, dofs, supports, space);
    let surfaces = surfaces::Surfaces {
        mesh,
        space,
        bodies,
    };
    let mut interfaces = contact::build(problem, sets, &surfaces, timeline, &held, &held_nodes)?;
    held_nodes.mark(&mut interfaces);
    turning::attach(frames, corotations, &mut interfaces)?;
    turning::refuse_ties(frames, corotations, &interfaces, &attached.steps)?;
    axes::check(problem, bodies, &interfaces)?;
    let heights = relief::apply(problem, folder, &mut interfaces)?;
    Ok((interfaces, heights))
}

/// What is reported, and how it is judged.
fn reports(problem: &Problem, probes: Vec<Probe>) -> ReportPlan {
    let output = &problem.output;
    let fatigue = output.fatigue.as_ref();
    let checkpoint = &output.checkpoint;
    ReportPlan {
        probes,
        output: OutputPlan {
            every: output.every,
            times: output.times.clone(),
            frd: output.frd.encoding(),
            history_every: output.history_every,
            slip_events: output.slip_events.map(|e| EventPlan {
                speed: e.speed,
                modulus: e.modulus,
            }),
            fatigue: fatigue.map_or(Vec::new(), |f| f.criteria.clone()),
            fatigue_depth: fatigue.and_then(|f| f.depth),
            checkpoint: (checkpoint.increments, 60.0 * checkpoint.minutes),
        },
        quality: problem.quality,
    }
}

/// How increments are solved.
fn solution(problem: &Problem) -> SolutionPlan {
    let solver = &problem.solver;
    SolutionPlan {
        settings: Settings {
            tolerance: solver.tolerance,
            max_iterations: solver.max_iterations,
            line_search: solver.line_search,
            krylov_patience: solver.linear.patience,
            linear_tolerance: solver.linear.tolerance,
        },
        method: solver.method,
        engine: solver.engine.clone(),
        energy_limit: solver.energy_limit,
        follow: solver.follow_loose_bodies,
        largest_change: solver.largest_change.unwrap_or(f64::INFINITY),
    }
}

/// The model with some points of the mesh moved.
fn build_moved(
    problem: &Problem,
    folder: &Path,
    given: &Meshes,
    moves: snap::Moves,
) -> Result<Setup, Error> {
    let space = problem
        .model
        .space
        .with(problem.model.thickness.unwrap_or(1.0));
    let laws = heat::laws(problem)?;
    let mut built = meshes::build(problem, folder, given, &laws)?;
    snap::apply(&moves, &mut built.mesh)?;
    let mesh = Arc::new(built.mesh);
    let stiff = problem.body.values().filter(|b| b.rigid).count();
    let hidden = mesh.points.len() + 2 * stiff;
    let dofs = Dofs {
        dim: space.dim(),
        points: hidden + 2 * problem.reference.len(),
    };
    let referred = references::numbered(problem, hidden);
    let BuiltBodies {
        mut bodies,
        links: mut all_links,
        materials,
        densities,
    } = bodies(problem, built.bodies, &mesh, space)?;
    let inside = built.cuts.iter().flat_map(|c| c.near.iter().chain(&c.far));
    let inside: BTreeSet<FacetRef> = inside.copied().collect();
    let timeline = Timeline::new(problem);
    let sets = Sets::new(problem, &mesh, &bodies, inside.clone(), referred.clone())?;
    all_links.extend(references::links(problem, &sets, &mesh, space)?);
    let links = Links::new(dofs, all_links);
    let frames = Arc::new(turning::frames(problem, &sets, &bodies, &links));
    let temperatures = heat::temperatures(problem, &sets, &mesh, space, &timeline)?;
    let mut heat = None;
    if let Some(temperatures) = temperatures {
        let warmed = heat::warm(problem, bodies, temperatures, &materials, &laws)?;
        bodies = warmed.0;
        heat = Some(Heat::new(warmed.1));
    }
    let sets = Sets::new(problem, &mesh, &bodies, inside, referred)?;
    let built = Assembled {
        mesh: &mesh,
        space,
        dofs,
        bodies: &bodies,
        links: &links,
        frames: &frames,
        densities: &densities,
        sets: &sets,
        timeline: &timeline,
        cuts: &built.cuts,
    };
    let attached = attach(problem, &built)?;
    contradicting::refuse(&attached.supports, &attached.steps, &mesh, dofs)?;
    let rigid = built.rigid();
    let (interfaces, heights) = interfaces(problem, folder, &built, &attached)?;
    let initials = initial::build(problem, &sets, &mesh, &rigid, folder)?;
    initial::agree_with_supports(problem, &initials, &attached.supports, &mesh, &rigid)?;
    let probes = probes(problem, &sets)?;
    let mut notes = moves.notes;
    notes.extend(interfaces.iter().filter_map(|i| exchange_note(problem, i)));
    notes.extend(heights);
    let model = Model {
        title: problem.title.clone().unwrap_or_default(),
        space,
        size: geometry::diameter(&mesh),
        dofs,
        links: links.with_followers(attached.followers),
        frames,
        corotations: Arc::new(attached.corotations),
        bodies,
        references: attached.references,
        actions: Actions {
            loads: attached.loads,
            heat,
            fields: Vec::new(),
            springs: attached.springs,
            masses: attached.masses,
            supports: attached.supports,
            initials,
        },
        steps: attached.steps,
        reports: reports(problem, probes),
        solution: solution(problem),
        unused: unused::tables(problem),
        waves: relief::waves(problem),
        mesh,
    };
    Ok(Setup {
        model,
        contact: Contact {
            interfaces: interfaces.into_iter().map(Interface::new).collect(),
            couplings: Couplings::new(attached.couplings, space.dim()),
        },
        notes,
    })
}

fn loads(
    problem: &Problem,
    sets: &Sets,
    domain: &Domain,
    timeline: &Timeline,
    bodies: &[Body],
) -> Result<(Vec<Load>, Vec<Spring>), Error> {
    let turning = bodies.iter().filter(|b| b.elastic.is_corotational());
    let turning: BTreeSet<usize> = turning.flat_map(|b| b.blocks.clone()).collect();
    let (mut loads, mut springs) = (Vec::new(), Vec::new());
    for (name, load) in &problem.load {
        let key = format!("load.{name}");
        let model = LoadKind::as_dyn(&load.kind);
        let set = format!("{key}.set");
        let (points, facets, still_facets, cells);
        let mut target = match model.region() {
            Region::Points => {
                points = sets.any_points(&load.set, &set)?;
                Target::Points(&points)
            }
            Region::Facets => {
                facets = sets.facets(&load.set, &set)?;
                Target::Facets(&facets)
            }
            Region::Cells => {
                cells = sets.cells(&load.set, &set)?;
                Target::Cells(&cells)
            }
        };
        if let (LoadKind::Pressure(pressure), Target::Facets(all)) = (&load.kind, target) {
            let turns = |f: &&FacetRef| turning.contains(&f.cell.block);
            let (moving, still): (Vec<&FacetRef>, Vec<&FacetRef>) = all.iter().partition(turns);
            if !moving.is_empty() {
                let moving: Vec<FacetRef> = moving.into_iter().copied().collect();
                let action = model.action(&Target::Facets(&moving), domain);
                let at_first = action.map_err(|e| problem_error(vec![e.under(&key)]))?;
                loads.push(Load {
                    name: name.clone(),
                    entries: match at_first {
                        Action::Forces(entries) => entries,
                        Action::Springs(_) => Vec::new(),
                    },
                    schedule: timeline.load(problem, name, load.amplitude.as_deref()),
                    follows: true,
                    pressing: Some(Pressing {
                        facets: moving,
                        value: pressure.value,
                    }),
                });
                still_facets = still.into_iter().copied().collect::<Vec<_>>();
                target = Target::Facets(&still_facets);
            }
        }
        let action = model.action(&target, domain);
        match action.map_err(|e| problem_error(vec![e.under(&key)]))? {
            Action::Forces(entries) => loads.push(Load {
                name: name.clone(),
                entries,
                schedule: timeline.load(problem, name, load.amplitude.as_deref()),
                follows: load.follows(),
                pressing: None,
            }),
            Action::Springs(entries) => springs.push(Spring::new(entries)),
        }
    }
    Ok((loads, springs))
}

/// Masses at points, ascending, each once.
fn masses(problem: &Problem, sets: &Sets, rigid: &RigidBodies) -> Result<Vec<(usize, f64)>, Error> {
    let mut all = std::collections::BTreeMap::<usize, f64>::new();
    for (name, table) in &problem.mass {
        let key = format!("mass.{name}.set");
        for point in sets.any_points(&table.set, &key)? {
            if rigid.links.of_point(point).is_some() {
                let message = format!("`{}` has points of a rigid body", table.set);
                let help = "give the body a density with which it has the whole mass";
                return Err(problem_error(vec![
                    Diagnostic::new(&key, message).help(help),
                ]));
            }
            *all.entry(point).or_default() += table.mass;
        }
    }
    Ok(all.into_iter().collect())
}

fn supports(
    problem: &Problem,
    sets: &Sets,
    rigid: &RigidBodies,
    timeline: &Timeline,
) -> Result<Vec<Support>, Error> {
    let dofs = rigid.dofs;
    let mut out = Vec::new();
    for (name, support) in &problem.support {
        let points = sets.any_points(&support.set, &format!("support.{name}.set"))?;
        let mut given: Vec<(usize, f64, bool)> = support
            .components()
            .iter()
            .enumerate()
            .filter_map(|(c, (_, value))| value.map(|v| (c, v, false)))
            .collect();
        given.extend(support.hold.iter().map(|&c| (c as usize, 0.0, true)));
        let entry = |p: usize, &(c, value, hold): &(usize, f64, bool)| {
            let (dof, length) = match c.checked_sub(3) {
                None => (dofs.of(p, c), 1.0),
                // rules have seen to it that such a point turns
                Some(axis) => {
                    let link = &rigid.links.all()[rigid.links.of_hidden(p)?];
                    (link.dof(dofs, Motion::Rotation(axis))?, link.length)
                }
            };
            Some(Prescribed {
                dof,
                value: value * length,
                hold,
            })
        };
        let entries = points
            .iter()
            .flat_map(|&p| given.iter().filter_map(move |g| entry(p, g)))
            .collect();
        out.push(Support {
            name: name.clone(),
            entries: rigid::refuse(rigid.support(name, entries))?,
            schedule: timeline.support(problem, name, support.amplitude.as_deref()),
            table: support.amplitude.is_some(),
        });
    }
    Ok(out)
}

fn probes(problem: &Problem, sets: &Sets) -> Result<Vec<Probe>, Error> {
    let mut out = Vec::new();
    for (name, probe) in &problem.probe {
        let point = match &probe.of {
            Some(body) => sets.nearest(body, &probe.point, &format!("probe.{name}.of"))?,
            None => sets.nearest_of_all(&probe.point, &format!("probe.{name}"))?,
        };
        out.push(Probe {
            name: name.clone(),
            point,
        });
    }
    Ok(out)
}
