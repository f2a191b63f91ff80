//! Reference points: where they stand among the dofs, what resists them, and what only follows.

use std::collections::BTreeMap;

use super::super::Problem;
use super::super::reference::spin_matrix;
use super::fault::problem_error;
use super::rigid::freedom;
use super::sets::{Sets, vec3};
use crate::body::couplings::{Coupling, CouplingKind};
use crate::body::loads::{Load, Spring};
use crate::body::{Space, moments};
use crate::error::{Diagnostic, Error};
use crate::math::{Mat3, Vec3, add_scaled, distance, dot, norm, sub, symmetric_eigen};
use crate::mesh::{Mesh, geometry};
use crate::model::{Body, Reference, Rigid, Step, Support};
use crate::system::{BodyFrames, DependentNode, Dofs, Freedom, Link, Links, Motion};
use crate::tolerance::{NEGLIGIBLE, SAME};

/// The reference points by name, the first hidden point of each.
pub(super) fn numbered(problem: &Problem, first: usize) -> BTreeMap<String, usize> {
    let names = problem.reference.keys().enumerate();
    names
        .map(|(i, name)| (name.clone(), first + 2 * i))
        .collect()
}

/// The links of the reference points. Rotations count by the mean distance of the points that are tied to one.
pub(super) fn links(
    problem: &Problem,
    sets: &Sets,
    mesh: &Mesh,
    space: Space,
) -> Result<Vec<Link>, Error> {
    let mut out = Vec::new();
    for (name, reference) in &problem.reference {
        let centre = vec3(&reference.point);
        let length = reach(problem, name, centre, sets, mesh)?;
        let end = mesh.points.len();
        out.push(Link {
            points: end..end,
            centre,
            arms: Vec::new(),
            hidden: sets.reference(name).unwrap_or(end),
            length,
            freedom: freedom(space),
            framed: false,
        });
    }
    Ok(out)
}

/// The mean distance from a place of the points tied to the reference point there; half the size of the mesh where none are.
fn reach(
    problem: &Problem,
    name: &str,
    centre: Vec3,
    sets: &Sets,
    mesh: &Mesh,
) -> Result<f64, Error> {
    let (mut sum, mut count) = (0.0, 0_usize);
    let turning = problem.body.iter();
    for (body, _) in turning.filter(|(_, b)| b.rotation.reference() == Some(name)) {
        for p in sets.points(body, &format!("body.{body}"))? {
            sum += distance(mesh.points[p], centre);
            count += 1;
        }
    }
    for (coupling, table) in &problem.coupling {
        let model = CouplingKind::as_dyn(&table.kind);
        if model.reference() != Some(name) {
            continue;
        }
        for (_, set) in model.sets().iter().filter(|(_, set)| *set != name) {
            for p in sets.points(set, &format!("coupling.{coupling}"))? {
                sum += distance(mesh.points[p], centre);
                count += 1;
            }
        }
    }
    let (mean, size) = (sum / count.max(1) as f64, geometry::diameter(mesh));
    Ok(if mean > 1e-6 * size { mean } else { 0.5 * size })
}

/// What is said of reference points beside their links.
pub(super) struct Said<'a> {
    pub bodies: &'a [Body],
    pub links: &'a Links,
    pub couplings: &'a [Coupling],
    pub supports: &'a [Support],
    pub springs: &'a [Spring],
    pub masses: &'a [(usize, f64)],
    pub loads: &'a [Load],
    pub steps: &'a [Step],
    pub frames: &'a BodyFrames,
    /// The names of the reference points, whose links are the last.
    pub references: Vec<String>,
}

impl Said<'_> {
    fn dofs(&self) -> Dofs {
        self.links.dofs()
    }

    /// The reference point that has a dof.
    pub fn named(&self, dof: usize) -> Option<&str> {
        let link = self.links.of_hidden(self.dofs().locate(dof).0)?;
        let first = self.links.all().len() - self.references.len();
        (self.references.get(link.checked_sub(first)?)).map(String::as_str)
    }

    /// The one body that couplings tie to a reference point.
    fn tied(&self, link: &Link) -> Option<usize> {
        let dofs = self.dofs();
        let own = |point: usize| point == link.hidden || point == link.hidden + 1;
        let mut found = None;
        for row in self.couplings.iter().flat_map(|c| &c.rows) {
            let points = || row.dofs.iter().map(|&dof| dofs.locate(dof).0);
            if !points().any(own) {
                continue;
            }
            for point in points().filter(|p| !own(*p)) {
                let body = self.bodies.iter().position(|b| b.points.contains(&point));
                if body.is_none() || found.is_some_and(|f| Some(f) != body) {
                    return None;
                }
                found = body;
            }
        }
        found
    }

    /// Springs and masses, which resist throughout; masses where there is motion.
    fn resists(&self, dof: usize, rigid: Option<&Rigid>, link: &Link, moves: bool) -> f64 {
        let springs = self.springs.iter().flat_map(|s| s.entries());
        let sprung = springs.filter(|(d, _)| *d == dof).map(|(_, k)| *k);
        let (point, c) = self.dofs().locate(dof);
        let mass = self.masses.iter().filter(|(p, _)| *p == point);
        let mass: f64 = mass.map(|(_, m)| *m).sum::<f64>();
        let own = rigid.map_or(0.0, |r| match point == link.hidden {
            true => r.mass,
            false => r.spin[c][c],
        });
        // What a body that turns is pressed by, its frame is.
        let any =
            sprung.sum::<f64>() > 0.0 || moves && mass + own > 0.0 || self.frames.carries(link);
        f64::from(u8::from(any))
    }
}

/// The reference points of the model.
pub(super) fn build(problem: &Problem, said: &Said) -> Result<Vec<Reference>, Error> {
    let bodies = said.links.all().len() - problem.reference.len();
    let mut out = Vec::new();
    for (i, (name, table)) in problem.reference.iter().enumerate() {
        let index = bodies + i;
        let link = &said.links.all()[index];
        let own = inertia(table, index, link);
        let rigid = carried(problem, name, index, own, said)?;
        let still = said.steps.iter();
        let still: Result<Vec<_>, Error> = still
            .map(|step| unresisted(name, link, rigid.as_ref(), step, said))
            .collect();
        out.push(Reference {
            name: name.clone(),
            link: index,
            rigid,
            body: said.tied(link),
            still: still?,
        });
    }
    Ok(out)
}

/// The mass of a reference point with that of the rigid bodies it carries.
fn carried(
    problem: &Problem,
    name: &str,
    index: usize,
    own: Option<Rigid>,
    said: &Said,
) -> Result<Option<Rigid>, Error> {
    let link = &said.links.all()[index];
    let bodies = said.bodies.iter().filter(|b| b.rigid.is_some());
    let bodies = bodies.filter(|b| problem.body[&b.name].rotation.reference() == Some(name));
    let mut out = own;
    let (mut first, mut size) = ([0.0; 3], 0.0);
    for body in bodies {
        let moments = moments::mass_moments(&body.elastic);
        let arm = sub(moments.centre, link.centre);
        first = add_scaled(first, moments.mass, arm);
        size += moments.mass * (norm(arm) + moments.radius());
        let square = dot(arm, arm);
        let mut about = moments.inertia();
        for (i, row) in about.iter_mut().enumerate() {
            for (j, inertia) in row.iter_mut().enumerate() {
                let unit = if i == j { square } else { 0.0 };
                *inertia += moments.mass * (unit - arm[i] * arm[j]);
            }
        }
        let sum = out.get_or_insert(Rigid {
            link: index,
            mass: 0.0,
            spin: [[0.0; 3]; 3],
        });
        sum.mass += moments.mass;
        let more = in_order(about, link);
        let both = sum.spin.as_flattened_mut().iter_mut();
        let both = both.zip(more.as_flattened());
        both.for_each(|(sum, more)| *sum += more);
    }
    // What a reference point carries may miss that with its centre of mass by this part of its size.
    if norm(first) > NEGLIGIBLE * size {
        refuse_swinging(name, link, said)?;
    }
    Ok(out)
}

/// In motion what is carried off its centre of mass needs an axle that stays where it is: it would push that along otherwise.
fn refuse_swinging(name: &str, link: &Link, said: &Said) -> Result<(), Error> {
    let dofs = said.dofs();
    for step in said.steps.iter().filter(|s| s.dynamic.is_some()) {
        let middle = 0.5 * (step.start + step.end);
        let acting = || said.supports.iter().filter(|s| s.schedule.active(middle));
        let still = |dof: usize| {
            let mut entries = acting().flat_map(|s| &s.entries);
            entries.any(|e| e.dof == dof && (e.hold || e.value == 0.0))
        };
        let motions = link.motions(dofs).into_iter();
        let mut ways = motions.filter(|(_, m)| matches!(m, Motion::Translation(_)));
        if ways.any(|(dof, _)| !still(dof)) {
            let message = format!(
                "it carries rigid bodies off their centre of mass, and does not stand still in step {}",
                step.name
            );
            return Err(problem_error(vec![
                Diagnostic::new(format!("reference.{name}"), message)
                    .help("hold it in all directions, put it into the centre of mass, or let a body turn freely: rotation = \"large\""),
            ]));
        }
    }
    Ok(())
}

/// Moments of inertia over the square of the length of a link, in the order of its dofs.
fn in_order(moments: Mat3, link: &Link) -> Mat3 {
    let over = |x: f64| x / (link.length * link.length);
    match link.freedom {
        Freedom::Axial | Freedom::Carried => [[0.0; 3]; 3],
        Freedom::Plane => [[over(moments[2][2]), 0.0, 0.0], [0.0; 3], [0.0; 3]],
        Freedom::Space => moments.map(|row| row.map(over)),
    }
}

/// The mass of a reference point.
fn inertia(table: &super::super::Reference, index: usize, link: &Link) -> Option<Rigid> {
    if table.mass.is_none() && table.inertia.is_none() {
        return None;
    }
    let moments = spin_matrix(table.inertia.as_deref().unwrap_or_default());
    Some(Rigid {
        link: index,
        mass: table.mass.unwrap_or(0.0),
        spin: in_order(moments, link),
    })
}

/// Dofs of a reference point to leave out in a step because nothing resists them.
fn unresisted(
    name: &str,
    link: &Link,
    rigid: Option<&Rigid>,
    step: &Step,
    said: &Said,
) -> Result<Vec<usize>, Error> {
    let dofs = said.dofs();
    let motions = link.motions(dofs);
    let n = motions.len();
    let place = |dof: usize| motions.iter().position(|(d, _)| *d == dof);
    let middle = 0.5 * (step.start + step.end);
    let mut gram = vec![vec![0.0; n]; n];
    for row in said.couplings.iter().filter(|c| c.schedule.active(middle)) {
        for row in &row.rows {
            let size = row.norm();
            let own: Vec<(usize, f64)> = (row.terms())
                .filter_map(|(d, f)| Some((place(d)?, f / size)))
                .collect();
            for &(a, fa) in &own {
                own.iter().for_each(|&(b, fb)| gram[a][b] += fa * fb);
            }
        }
    }
    for support in said.supports.iter().filter(|s| s.schedule.active(middle)) {
        let held = support.entries.iter().filter_map(|e| place(e.dof));
        held.for_each(|a| gram[a][a] += 1.0);
    }
    for (a, (dof, _)) in motions.iter().enumerate() {
        gram[a][a] += said.resists(*dof, rigid, link, step.dynamic.is_some());
    }
    refuse_loads(name, &gram, link, said, step)?;
    Ok(left_out(gram).into_iter().map(|a| motions[a].0).collect())
}

/// Loads along a motion that nothing resists go nowhere.
fn refuse_loads(
    name: &str,
    gram: &[Vec<f64>],
    link: &Link,
    said: &Said,
    step: &Step,
) -> Result<(), Error> {
    let motions = link.motions(said.dofs());
    let (values, vectors) = symmetric_eigen(gram);
    let least = SAME * values.last().copied().unwrap_or(0.0).max(1.0);
    let free = values.iter().enumerate().filter(|(_, v)| **v <= least);
    for (k, _) in free {
        for load in said.loads {
            let acts = [step.start, 0.5 * (step.start + step.end), step.end];
            if acts.iter().all(|&t| load.schedule.at(t) == 0.0) {
                continue;
            }
            let own = load.entries.iter().filter_map(|(dof, f)| {
                let at = motions.iter().position(|(d, _)| d == dof)?;
                Some((vectors[at][k] * f, f.abs()))
            });
            let (along, size) = own.fold((0.0, 0.0), |s, (a, f)| (s.0 + a, s.1 + f));
            if f64::abs(along) <= SAME * size {
                continue;
            }
            let parts: Vec<String> = (motions.iter().enumerate())
                .filter(|(i, _)| vectors[*i][k].abs() > 0.1)
                .map(|(_, (_, motion))| motion.to_string())
                .collect();
            let message = format!(
                "it pushes reference point `{name}` along a motion that nothing resists in step {}: {}",
                step.name,
                parts.join(" with ")
            );
            return Err(problem_error(vec![
                Diagnostic::new(format!("load.{}", load.name), message)
                    .help("tie points of a body to it that do not lie on one line, support it, or give it a spring"),
            ]));
        }
    }
    Ok(())
}

/// What to leave out of a symmetric matrix so that the rest is regular: what is left by elimination with the largest pivots.
fn left_out(mut gram: Vec<Vec<f64>>) -> Vec<usize> {
    let n = gram.len();
    let mut left: Vec<usize> = (0..n).collect();
    let least = SAME * (0..n).fold(1.0_f64, |m, i| m.max(gram[i][i]));
    while let Some(&p) = (left.iter()).max_by(|a, b| gram[**a][**a].total_cmp(&gram[**b][**b])) {
        let pivot = gram[p][p];
        if pivot <= least {
            break;
        }
        left.retain(|i| *i != p);
        for &i in &left {
            let factor = gram[i][p] / pivot;
            for &j in &left {
                gram[i][j] -= factor * gram[p][j];
            }
        }
    }
    left
}

/// What may bear on reference points beside couplings: links, supports, springs and masses.
type Bearing<'a> = (&'a Links, &'a [Support], &'a [Spring], &'a [(usize, f64)]);

/// Takes out of couplings the rows that do nothing but say what a reference point does: those that act in all steps, and whose dof nothing else knows of.
pub(super) fn followers(
    couplings: &mut [Coupling],
    leads: &[bool],
    references: &[Reference],
    said: Bearing,
    steps: &[Step],
) -> Vec<DependentNode> {
    let (links, supports, springs, masses) = said;
    let dofs = links.dofs();
    let mut known: BTreeMap<usize, usize> = BTreeMap::new();
    let mut know = |dof: usize| *known.entry(dof).or_default() += 1;
    for (dof, _) in couplings
        .iter()
        .flat_map(|c| &c.rows)
        .flat_map(|r| r.terms())
    {
        know(dof);
    }
    let given = supports
        .iter()
        .flat_map(|s| s.entries.iter().map(|e| e.dof));
    let given = given.chain(springs.iter().flat_map(|s| s.entries().iter().map(|e| e.0)));
    given.for_each(|dof| (0..2).for_each(|_| know(dof)));
    let moves = steps.iter().any(|s| s.dynamic.is_some());
    let heavy = |dof: usize| {
        let (point, c) = dofs.locate(dof);
        let own = references.iter().filter_map(|r| r.rigid).any(|r| {
            let hidden = links.all()[r.link].hidden;
            point == hidden && r.mass > 0.0 || point == hidden + 1 && r.spin[c][c] > 0.0
        });
        moves && (own || masses.iter().any(|(p, _)| *p == point))
    };
    let mut out = Vec::new();
    for (coupling, _) in couplings.iter_mut().zip(leads).filter(|(_, l)| **l) {
        let middle = |s: &Step| 0.5 * (s.start + s.end);
        if !steps.iter().all(|s| coupling.schedule.active(middle(s))) {
            continue;
        }
        coupling.rows.retain(|row| {
            let own = |(dof, _): &(usize, f64)| links.of_hidden(dofs.locate(*dof).0).is_some();
            let mut mine = row.terms().filter(own);
            let (Some((dof, factor)), None) = (mine.next(), mine.next()) else {
                return true;
            };
            if known.get(&dof) != Some(&1) || heavy(dof) {
                return true;
            }
            let others = row.terms().filter(|(d, _)| *d != dof);
            out.push(DependentNode {
                dof,
                row: others.map(|(d, a)| (d, -a / factor)).collect(),
            });
            false
        });
    }
    out
}

/// What acts on dofs that follow acts on the points that they follow.
pub(super) fn spread(loads: &mut [Load], followers: &[DependentNode]) {
    let rows: BTreeMap<usize, &DependentNode> = followers.iter().map(|f| (f.dof, f)).collect();
    for load in loads {
        let mut all: BTreeMap<usize, f64> = BTreeMap::new();
        for &(dof, force) in &load.entries {
            match rows.get(&dof) {
                None => *all.entry(dof).or_default() += force,
                Some(follower) => {
                    for &(other, factor) in &follower.row {
                        *all.entry(other).or_default() += factor * force;
                    }
                }
            }
        }
        load.entries = all.into_iter().collect();
    }
}

/// An explicit step has no equations to solve: what couplings hold in it needs a mass.
pub(super) fn refuse_massless(
    couplings: &[Coupling],
    references: &[Reference],
    links: &Links,
    supports: &[Support],
    masses: &[(usize, f64)],
    steps: &[Step],
) -> Result<(), Error> {
    let dofs = links.dofs();
    for step in steps.iter().filter(|s| s.is_explicit()) {
        let middle = 0.5 * (step.start + step.end);
        let supported = supports.iter().filter(|s| s.schedule.active(middle));
        let supported = supported.flat_map(|s| s.entries.iter().map(|e| e.dof));
        let supported: std::collections::BTreeSet<usize> = supported.collect();
        let heavy = |reference: &Reference, dof: usize| {
            let (point, c) = dofs.locate(dof);
            let moves = point == links.all()[reference.link].hidden;
            let own = reference.rigid.is_some_and(|r| match moves {
                true => r.mass > 0.0,
                false => r.spin[c][c] > 0.0,
            });
            own || masses.iter().any(|(p, _)| *p == point)
        };
        let acting = couplings.iter().filter(|c| c.schedule.active(middle));
        for (dof, _) in acting.flat_map(|c| &c.rows).flat_map(|r| r.terms()) {
            let of = links.of_hidden(dofs.locate(dof).0);
            let Some(reference) = references.iter().find(|r| Some(r.link) == of) else {
                continue;
            };
            if !heavy(reference, dof) && !supported.contains(&dof) {
                let name = &reference.name;
                let message = format!(
                    "reference point `{name}` has no mass, or no moments of inertia, and step {} is explicit",
                    step.name
                );
                return Err(problem_error(vec![
                    Diagnostic::new(format!("reference.{name}"), message)
                        .help("give `mass` and `inertia`, choose an implicit scheme, or coupling.distributing, which needs none"),
                ]));
            }
        }
    }
    Ok(())
}
