//! Materials, turned into the axes of their orientation.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::material::{self, Anisotropic, Entries, ExpansionTable, Isotropic, Orthotropic};
use stickslip::math::Vec3;
use stickslip::problem::{self, ConstantsAt};

use super::bodies::{Bodies, Turned};
use super::job::Job;
use super::names::problem_name;
use crate::deck::{Action, Deck, Elastic, Expansion, Local, Material, Section};

/// Unit vectors along the local axes.
type Axes = [[f64; 3]; 3];

/// The local axes of an element in its section: those at its centre, where they turn with the place.
pub(super) fn axes_of(deck: &Deck, element: u64, section: &Section) -> Option<Axes> {
    let orientation = deck
        .properties
        .orientations
        .get(section.orientation.as_ref()?)?;
    let own = orientation.elements.get(&element);
    let nodes = &deck.elements.get(&element)?.nodes;
    let sum = nodes.iter().fold([0.0; 3], |sum: [f64; 3], n| {
        let x = deck.nodes.get(n).copied().unwrap_or_default();
        std::array::from_fn(|i| sum[i] + x[i])
    });
    own.unwrap_or(&orientation.local)
        .at(sum.map(|c| c / nodes.len() as f64))
}

/// The materials of all elements, and which of them each has. One with an orientation is one of its own, unless the material has no directions; where
/// axes turn with the place there is one for each direction.
pub(super) fn assign(
    job: &mut Job,
    section_of: &BTreeMap<u64, usize>,
) -> (Vec<Turned>, BTreeMap<u64, usize>) {
    let deck = job.deck;
    let (mut all, mut of): (Vec<Turned>, BTreeMap<u64, usize>) = Default::default();
    let mut known: BTreeMap<(String, [i64; 9]), usize> = BTreeMap::new();
    let mut taken = BTreeSet::new();
    let mut centred = BTreeSet::new();
    for (element, index) in section_of {
        let section = &deck.properties.sections[*index];
        let material = deck.properties.materials.get(&section.material);
        let directed = material.is_some_and(|m| {
            let mut rows = m.elastic_at.iter();
            rows.any(|(_, e)| !matches!(e, Elastic::Isotropic(_)))
                || m.expansion.as_ref().is_some_and(Expansion::has_axes)
        });
        let orientation = section.orientation.as_ref().filter(|_| directed);
        let axes = orientation.and_then(|_| axes_of(deck, *element, section));
        let wanted = match orientation {
            Some(o) => problem_name(&format!("{}-{o}", section.material)),
            None => problem_name(&section.material),
        };
        if let Some(o) = orientation.and_then(|o| deck.properties.orientations.get(o)) {
            let round = matches!(
                o.elements.get(element).unwrap_or(&o.local),
                Local::Cylinder(_)
            );
            if round && centred.insert(o.place) {
                job.note(
                    o.place,
                    "cylindrical axes are taken at the centre of each element, as in CalculiX; Abaqus takes them at the points of integration",
                );
            }
        }
        // Axes are alike to so many digits.
        let bits = |c: f64| (c * 1e12).round() as i64;
        let key: [i64; 9] = std::array::from_fn(|i| axes.map_or(0, |a| bits(a[i / 3][i % 3])));
        let at = *known.entry((wanted.clone(), key)).or_insert_with(|| {
            let more = (2..).map(|i| format!("{wanted}-{i}"));
            let mut names = std::iter::once(wanted.clone()).chain(more);
            let name = names.find(|n| !taken.contains(n)).unwrap_or_default();
            taken.insert(name.clone());
            all.push(Turned {
                name,
                section: *index,
                axes,
            });
            all.len() - 1
        });
        of.insert(*element, at);
    }
    (all, of)
}

pub(super) fn write(job: &mut Job, bodies: &Bodies) {
    let deck = job.deck;
    let used: BTreeSet<usize> = (bodies.material.iter())
        .filter(|(e, _)| bodies.of_element.contains_key(e))
        .map(|(_, m)| *m)
        .collect();
    let mut used: Vec<&Turned> = used.into_iter().map(|m| &bodies.materials[m]).collect();
    used.sort_by(|a, b| a.name.cmp(&b.name));
    for turned_by in used {
        let (name, axes) = (&turned_by.name, &turned_by.axes);
        let section = &deck.properties.sections[turned_by.section];
        let Some(material) = deck.properties.materials.get(&section.material) else {
            continue;
        };
        if material.elastic.is_none() {
            let message = format!("the material {} has no *ELASTIC", section.material);
            job.error(material.place, message, "bodies are linear elastic");
            continue;
        }
        let axes = axes.as_ref();
        let Some(constants) = constants(job, bodies, material, &section.material) else {
            continue;
        };
        let mut rows = constants.elastic.into_iter();
        let Some((first, elastic)) = rows.next() else {
            continue;
        };
        let at: Vec<ConstantsAt> = rows
            .map(|(temperature, e)| ConstantsAt {
                temperature,
                kind: constants_along(&e, None, axes),
            })
            .collect();
        let table = problem::Material {
            expansion: material.expansion.as_ref().map(|e| e.along(axes)),
            temperature: (!at.is_empty()).then_some(first),
            at,
            kind: constants_along(&elastic, constants.density, axes),
        };
        job.add(name, material.place, table);
    }
}

/// Elastic constants in the axes of an orientation.
fn constants_along(
    elastic: &Elastic,
    density: Option<f64>,
    axes: Option<&Axes>,
) -> material::Material {
    let density = density.unwrap_or_default();
    match *elastic {
        Elastic::Isotropic([young, poisson]) => material::Material::Isotropic(Isotropic {
            young,
            poisson,
            density,
        }),
        Elastic::Engineering([e1, e2, e3, nu12, nu13, nu23, g12, g13, g23]) => {
            material::Material::Orthotropic(Orthotropic {
                e1,
                e2,
                e3,
                nu12,
                nu13,
                nu23,
                g12,
                g13,
                g23,
                density,
                axes: axes.map(directions),
            })
        }
        Elastic::Full(ref c) => {
            let rows = turned(c, axes).iter().map(|row| row.to_vec()).collect();
            material::Material::Anisotropic(Anisotropic {
                stiffness: Entries::Rows(rows),
                density,
            })
        }
    }
}

/// The axes of an orientation that a problem names.
fn directions(axes: &Axes) -> [Vec3; 2] {
    [axes[0], axes[1]]
}

impl Expansion {
    /// Whether it is along axes.
    fn has_axes(&self) -> bool {
        self.rows.iter().any(|(_, along)| along.len() > 1)
    }

    /// Expansion in the axes of an orientation.
    fn along(&self, axes: Option<&Axes>) -> material::Expansion {
        let axes = axes.filter(|_| self.has_axes());
        if let ([(_, along)], None) = (self.rows.as_slice(), axes) {
            match *along.as_slice() {
                [a] => return material::Expansion::Number(a),
                [a, b, c] => return material::Expansion::Axes([a, b, c]),
                _ => {}
            }
        }
        let row = |(t, along): &(f64, Vec<f64>)| [&[*t], along.as_slice()].concat();
        material::Expansion::Table(ExpansionTable {
            table: self.rows.iter().map(row).collect(),
            zero: self.zero,
            axes: axes.map(directions),
        })
    }
}

/// What a material has of the deck's tables over temperature.
struct Constants {
    /// By temperature, in ascending order.
    elastic: Vec<(f64, Elastic)>,
    density: Option<f64>,
}

/// Elastic constants by temperature, and density. Where its elements have one temperature throughout, a material has the constants of that; elastic
/// ones that are left are those of the temperatures of its cells.
fn constants(job: &mut Job, bodies: &Bodies, material: &Material, name: &str) -> Option<Constants> {
    if material.elastic_at.len() < 2 && material.density_at.len() < 2 {
        return Some(Constants {
            elastic: material.elastic_at.iter().take(1).cloned().collect(),
            density: material.density,
        });
    }
    let deck = job.deck;
    let at = super::temperatures::at_start(job);
    let own = bodies.section.iter().filter(|(e, s)| {
        deck.properties.sections[**s].material == name && bodies.of_element.contains_key(e)
    });
    let nodes = own.flat_map(|(e, _)| deck.elements[e].nodes.iter());
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in nodes {
        let t = at.get(n).copied().unwrap_or(0.0);
        (low, high) = (low.min(t), high.max(t));
    }
    let changes = |s: &crate::deck::Step| {
        let mut actions = s.actions.iter();
        actions.any(|a| matches!(a, Action::Temperature { .. }))
    };
    if high > low && material.density_at.len() > 1 {
        job.error(
            material.place,
            format!("the density of the material {name} depends on temperature, and its elements have temperatures from {low} to {high}"),
            "give its elements one temperature by *INITIAL CONDITIONS, or a material of its own to the elements of each temperature",
        );
        return None;
    }
    let density = between(&material.density_at, low, |a, b, w| a + w * (b - a));
    if high > low || deck.steps.iter().any(changes) {
        return Some(Constants {
            elastic: material.elastic_at.clone(),
            density,
        });
    }
    let elastic = between(&material.elastic_at, low, |a, b, w| a.mix(b, w));
    Some(Constants {
        elastic: elastic.map(|e| (low, e)).into_iter().collect(),
        density,
    })
}

/// Linear between the rows of a table over temperature, constant outside.
fn between<T: Clone>(rows: &[(f64, T)], t: f64, mix: impl Fn(&T, &T, f64) -> T) -> Option<T> {
    let after = rows.partition_point(|r| r.0 <= t);
    match (after.checked_sub(1).map(|i| &rows[i]), rows.get(after)) {
        (Some(a), Some(b)) => Some(mix(&a.1, &b.1, (t - a.0) / (b.0 - a.0))),
        (a, b) => a.or(b).map(|row| row.1.clone()),
    }
}

impl Elastic {
    /// Constants between these and others of the same kind.
    fn mix(&self, other: &Elastic, w: f64) -> Elastic {
        let mean = |a: f64, b: f64| a + w * (b - a);
        match (self, other) {
            (Elastic::Isotropic(a), Elastic::Isotropic(b)) => {
                Elastic::Isotropic(std::array::from_fn(|i| mean(a[i], b[i])))
            }
            (Elastic::Engineering(a), Elastic::Engineering(b)) => {
                Elastic::Engineering(std::array::from_fn(|i| mean(a[i], b[i])))
            }
            (Elastic::Full(a), Elastic::Full(b)) => {
                let row = |i: usize| std::array::from_fn(|j| mean(a[i][j], b[i][j]));
                Elastic::Full(Box::new(std::array::from_fn(row)))
            }
            // One *ELASTIC has rows of one kind.
            _ => self.clone(),
        }
    }
}

/// The stiffness in the global axes and in the order xx yy zz xy yz xz, from one in the order 11 22 33 12 13 23 of the material.
fn turned(c: &[[f64; 6]; 6], axes: Option<&Axes>) -> [[f64; 6]; 6] {
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let ours = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
    let at = |i: usize, j: usize| {
        pairs
            .iter()
            .position(|p| *p == (i.min(j), i.max(j)))
            .unwrap_or(0)
    };
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let a = axes.copied().unwrap_or(identity);
    let mut out = [[0.0; 6]; 6];
    for (row, &(i, j)) in ours.iter().enumerate() {
        for (column, &(k, l)) in ours.iter().enumerate() {
            // Rows of `a` are the material axes: a tensor turns with one of them for each index.
            for (p, ap) in a.iter().enumerate() {
                for (q, aq) in a.iter().enumerate() {
                    for (r, ar) in a.iter().enumerate() {
                        for (s, as_) in a.iter().enumerate() {
                            out[row][column] +=
                                ap[i] * aq[j] * ar[k] * as_[l] * c[at(p, q)][at(r, s)];
                        }
                    }
                }
            }
        }
    }
    out
}
