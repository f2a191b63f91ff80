//! Criteria of fretting fatigue over the cycles that are computed: the history of stress at points, what rubs on surfaces, and what they come to when a cycle is over.
//!
//! Stress is that of the nodes, in the axes of the body as meshed. A cycle is the states at the ends of its increments. In a cycle that stands for many it is that of the one that is computed.

use crate::body::fields;
use crate::contact::look;
use std::collections::{BTreeMap, HashMap, HashSet};

use rayon::prelude::*;

use super::history::Row;
use crate::assess::view::View;
use crate::fatigue::{
    Criterion, CycleIncrement, Directions, FatigueModel, Found, History, Maximum, Record, Rubbed,
    Worst, worst,
};
use crate::math::{Vec3, add, dot, norm, normalize, sub, symmetric_eigen};
use crate::model::contact::Contact;
use crate::model::definition::{Body, Model};
use crate::system::{Field, Fields, Location};
use crate::time::Trial;

type Tensor = [f64; 6];
type Compliance = [Tensor; 6];

/// What is looked at: the points of a body.
struct Lot {
    /// Index of the body.
    body: usize,
    /// Points, ascending, and where they are in the list of the body.
    points: Vec<usize>,
    places: Vec<usize>,
    /// Elastic constants, by point an index into them.
    compliances: Vec<Compliance>,
    of: Vec<usize>,
}

/// All that is looked at: functions of the model.
pub(crate) struct Watched {
    lots: Vec<Lot>,
    /// Where the stress of a point is in the record.
    index: HashMap<usize, usize>,
}

/// What is looked at; `None` where it is not asked for.
pub(crate) fn watched(model: &Model, contact: &Contact) -> Option<Watched> {
    if model.reports.output.fatigue.is_empty() {
        return None;
    }
    let interfaces = contact.interfaces.iter();
    let nodes: Vec<usize> = interfaces.flat_map(|i| i.nodes.iter().copied()).collect();
    let near = model
        .reports
        .output
        .fatigue_depth
        .map(|depth| Near::new(model, &nodes, depth));
    let mut watched = Watched {
        lots: Vec::new(),
        index: HashMap::new(),
    };
    for (body, b) in model.bodies.iter().enumerate() {
        if b.rigid.is_some() || !nodes.iter().any(|n| b.points.contains(n)) {
            continue;
        }
        let lot = Lot::new(body, b, |p| near.as_ref().is_none_or(|n| n.holds(model, p)));
        for &p in &lot.points {
            let next = watched.index.len();
            watched.index.insert(p, next);
        }
        watched.lots.push(lot);
    }
    Some(watched)
}

/// Points within a distance of others.
struct Near {
    depth: f64,
    boxes: HashMap<[i64; 3], Vec<Vec3>>,
}

impl Near {
    fn new(model: &Model, nodes: &[usize], depth: f64) -> Self {
        let mut boxes: HashMap<[i64; 3], Vec<Vec3>> = HashMap::new();
        for node in nodes.iter().collect::<HashSet<_>>() {
            let x = model.mesh.points[*node];
            boxes.entry(Self::place(x, depth)).or_default().push(x);
        }
        Near { depth, boxes }
    }

    fn place(x: Vec3, depth: f64) -> [i64; 3] {
        x.map(|x| (x / depth).floor() as i64)
    }

    fn holds(&self, model: &Model, point: usize) -> bool {
        let x = model.mesh.points[point];
        let [i, j, k] = Self::place(x, self.depth);
        let around = (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]);
        let mut others = around.filter_map(|place| self.boxes.get(&place)).flatten();
        others.any(|y| norm(sub(x, *y)) <= self.depth)
    }
}

/// Strain by stress, of a stiffness that is positive.
fn compliance(stiffness: &Compliance) -> Compliance {
    let rows: Vec<Vec<f64>> = stiffness.iter().map(|row| row.to_vec()).collect();
    let (values, vectors) = symmetric_eigen(&rows);
    let mut c = [[0.0; 6]; 6];
    for (row, v) in c.iter_mut().zip(&vectors) {
        for (entry, w) in row.iter_mut().zip(&vectors) {
            let parts = values.iter().zip(v).zip(w);
            *entry = parts.map(|((value, a), b)| a * b / value).sum();
        }
    }
    c
}

impl Lot {
    fn new(body: usize, b: &Body, wanted: impl Fn(usize) -> bool) -> Self {
        let parts = b.elastic.parts();
        // Where materials meet the first decides.
        let mut part_of = HashMap::new();
        for (i, part) in parts.iter().enumerate() {
            for &p in &b.elastic.mesh().blocks[part.block].connectivity {
                part_of.entry(p).or_insert(i);
            }
        }
        let all = b.elastic.points().iter().enumerate();
        let (places, points): (Vec<_>, Vec<_>) = all
            .filter(|(_, p)| wanted(**p))
            .map(|(i, &p)| (i, p))
            .unzip();
        Lot {
            body,
            of: points
                .iter()
                .map(|p| part_of.get(p).copied().unwrap_or(0))
                .collect(),
            compliances: parts.iter().map(|p| compliance(&p.stiffness)).collect(),
            points,
            places,
        }
    }

    fn strain(&self, i: usize, stress: &Tensor) -> Tensor {
        self.compliances[self.of[i]].map(|row| row.iter().zip(stress).map(|(c, s)| c * s).sum())
    }
}

/// What there is to note of an increment that has been accepted; `None` in steps without cycles.
pub(crate) fn increment(view: &View, watched: &Watched, trial: Trial) -> Option<CycleIncrement> {
    let step = &view.model.steps[view.step_index()];
    let cycles = step.cycles?;
    let strained = view.strained();
    let mut stresses = Vec::with_capacity(6 * watched.index.len());
    for lot in &watched.lots {
        let body = &view.model.bodies[lot.body];
        // Along axes that turn with the material, where the body turns as a whole.
        let all = fields::nodal_stress(&body.elastic, &*strained);
        stresses.extend(lot.places.iter().flat_map(|&i| all[i]));
    }
    let interfaces = view.contacts();
    Some(CycleIncrement {
        begins: cycles.begins(trial.from - step.start),
        stress: stresses,
        rubbed: interfaces.flat_map(|i| look::rubbing(i)).collect(),
    })
}

/// What was found in a cycle, place by place and criterion by criterion, where it was most.
pub(crate) fn maxima(view: &View, found: &[Found], trial: Trial) -> Vec<Maximum> {
    let step = &view.model.steps[view.step_index()];
    let block = (step.cycles).map(|c| c.block(trial.from - step.start, view.frame.block));
    let cycle = block.map_or(0, |block| block.before + block.stands_for);
    let found = found.iter();
    found.map(|found| maximum(view, found, cycle)).collect()
}

fn maximum(view: &View, found: &Found, cycle: usize) -> Maximum {
    let mut most = Maximum {
        criterion: found.name.clone(),
        step: view.step_index() + 1,
        cycle,
        ..Maximum::default()
    };
    let mesh = &view.model.mesh;
    let all = found.values.iter().enumerate();
    let largest = all.reduce(|a, b| if b.1 > a.1 { b } else { a });
    if let Some((i, &value)) = largest {
        let point = found.points[i];
        most.value = value;
        most.node = mesh.point_ids[point];
        most.place = mesh.points[point];
        most.plane = found.normals[i];
    }
    most
}

/// What all criteria say of the cycle that ends with an increment; `None` where none does.
pub(crate) fn judge(view: &View, watched: &Watched, trial: Trial) -> Option<Vec<Found>> {
    let step = &view.model.steps[view.step_index()];
    let since = [trial.from - step.start, trial.to - step.start];
    if !step.cycles.is_some_and(|cycles| cycles.ends(since)) {
        return None;
    }
    let record = &view.frame.fatigue;
    let directions = match view.model.dofs.dim {
        2 => Directions::Plane,
        _ => Directions::Space,
    };
    let criteria = view
        .model
        .reports
        .output
        .fatigue
        .iter()
        .map(FatigueModel::as_dyn);
    let rubbed = rubbed(view, watched, record);
    let found = criteria.map(|criterion| match criterion.on_surface(&Rubbed::default()) {
        Some(_) => on_surfaces(criterion, &rubbed),
        None => on_planes(criterion, watched, record, directions),
    });
    Some(found.collect())
}

fn on_planes(
    criterion: &dyn Criterion,
    watched: &Watched,
    record: &Record,
    directions: Directions,
) -> Found {
    let mut found = Found {
        name: criterion.name().into(),
        ..Found::default()
    };
    let mut first = 0;
    for lot in &watched.lots {
        let all = (0..lot.points.len()).into_par_iter().map(|i| {
            let stress: Vec<Tensor> = (record.stress.iter())
                .map(|at| tensor(at, first + i))
                .collect();
            let history = History {
                strain: stress.iter().map(|s| lot.strain(i, s)).collect(),
                stress,
            };
            worst(criterion, &history, directions).unwrap_or_default()
        });
        let all: Vec<Worst> = all.collect();
        found.points.extend(&lot.points);
        found.values.extend(all.iter().map(|w| w.value));
        found.normals.extend(all.iter().map(|w| w.normal));
        first += lot.points.len();
    }
    found
}

fn on_surfaces(criterion: &dyn Criterion, rubbed: &BTreeMap<usize, (Rubbed, Vec3)>) -> Found {
    let values = rubbed.values();
    Found {
        name: criterion.name().into(),
        points: rubbed.keys().copied().collect(),
        values: values
            .clone()
            .map(|(at, _)| criterion.on_surface(at).unwrap_or(f64::NAN))
            .collect(),
        normals: values.map(|(_, normal)| *normal).collect(),
    }
}

fn tensor(stresses: &[f64], i: usize) -> Tensor {
    let mut t = [0.0; 6];
    t.copy_from_slice(&stresses[6 * i..6 * i + 6]);
    t
}

/// What nodes of interfaces have been through; of a node in two interfaces what the first has.
fn rubbed(view: &View, watched: &Watched, record: &Record) -> BTreeMap<usize, (Rubbed, Vec3)> {
    let mut all = BTreeMap::new();
    let interfaces = view.contact.interfaces.iter();
    let nodes = interfaces.flat_map(|i| i.nodes.iter().copied());
    for (k, node) in nodes.enumerate() {
        let Some(&index) = watched.index.get(&node) else {
            continue;
        };
        let at: Vec<[Vec3; 3]> = record.rubbed.iter().map(|r| r[k]).collect();
        let normal = at.iter().fold([0.0; 3], |sum, r| add(sum, r[0]));
        let Some(normal) = normalize(normal) else {
            continue;
        };
        // From end to end of the way.
        let ends = at.iter().enumerate().flat_map(|(i, a)| {
            let others = at[..i].iter();
            others.map(move |b| sub(a[2], b[2]))
        });
        let longer = |a: Vec3, b: Vec3| if norm(b) > norm(a) { b } else { a };
        let way = ends.fold([0.0; 3], longer);
        let along = normalize(way).unwrap_or_default();
        let pulls = record.stress.iter().map(|s| {
            let [xx, yy, zz, xy, yz, xz] = tensor(s, index);
            let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            dot(rows.map(|row| dot(row, along)), along)
        });
        let rubbed = Rubbed {
            tension: pulls.fold(0.0, f64::max),
            shear: at.iter().map(|r| norm(r[1])).fold(0.0, f64::max),
            slip: norm(way),
        };
        all.entry(node).or_insert((rubbed, normal));
    }
    all
}

/// Adds columns to the row of a cycle: value, place and plane of each maximum.
pub(crate) fn add_columns(row: &mut Row, worst: &[Maximum], dim: usize) {
    for most in worst {
        let name = &most.criterion;
        row.push(name.clone(), most.value);
        for (letter, vector) in [("X", most.place), ("N", most.plane)] {
            for (c, x) in vector.iter().enumerate().take(dim) {
                row.push(format!("{name}.{letter}{}", c + 1), *x);
            }
        }
    }
}

/// Adds a field for each criterion, of the last cycle that is over, and one with the normals of the worst planes.
pub(super) fn add_fields(view: &View, fields: &mut Fields) {
    let count = view.model.mesh.points.len();
    for model in &view.model.reports.output.fatigue {
        let name = model.as_dyn().name();
        let mut values = vec![f64::NAN; count];
        let mut normals = vec![0.0; 3 * count];
        let found = view.frame.fatigue.found.iter();
        for found in found.filter(|f| f.name == name) {
            for (i, &p) in found.points.iter().enumerate() {
                values[p] = found.values[i];
                normals[3 * p..3 * p + 3].copy_from_slice(&found.normals[i]);
            }
        }
        for (name, components, values) in [
            (name.to_string(), 1, values),
            (format!("{name}_PLANE"), 3, normals),
        ] {
            fields.all.push(Field {
                name,
                location: Location::Point,
                components,
                values,
            });
        }
    }
}
