use serde::{Deserialize, Serialize};

use super::{Row, Tie};
use crate::mesh::geometry;

use super::kinematic::the_reference;
use super::model::{CouplingModel, Ground};
use crate::body::Space;
use crate::body::facets::tributary_areas;
use crate::error::Diagnostic;
use crate::math::{
    Mat3, Vec3, add_scaled, cross, dot, identity, norm, scale, sub, symmetric_eigen,
};
use crate::registry::Samples;
use crate::system::{Dofs, Freedom, Link, Motion};

/// A reference point follows the mean motion of points: its displacement and rotation are those of the rigid motion that comes nearest to theirs, each point
/// counting by its weight. Forces and moments on it spread over them: by weight, and for a moment by weight and distance from their centre. Nothing
/// becomes stiffer.
///
/// Where the points lie on a line, or are one, nothing turns about it, and a moment there is refused. As long as the reference point bears nothing but loads the
/// coupling costs nothing; where it is supported, or tied to something else, it is six equations over all points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Distributing {
    /// The points: `body.set`, a `[set.NAME]`, or a body.
    pub set: String,
    /// The `[reference.NAME]` that follows them.
    pub reference: String,
    /// How much each point counts.
    #[serde(default, skip_serializing_if = "is_default")]
    pub weights: Weights,
}

fn is_default(weights: &Weights) -> bool {
    *weights == Weights::default()
}

/// How much points count in a mean.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// By the area of the surface that belongs to each, `∫ N dA`, so that a force acts as a constant traction. All the same where the set has no facets.
    #[default]
    Area,
    /// All the same.
    Uniform,
    /// Given by sets; points that are in none count nothing.
    Sets(Vec<SetWeight>),
}

/// What the points of a set count.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SetWeight {
    /// The points: `body.set`, a `[set.NAME]`, or a body.
    pub set: String,
    /// How much each of them counts `[-]`.
    #[cfg_attr(feature = "schema", schemars(range(min = 0)))]
    pub weight: f64,
}

impl CouplingModel for Distributing {
    fn sets(&self) -> Vec<(String, &str)> {
        let mut sets = vec![
            ("set".to_string(), self.set.as_str()),
            ("reference".to_string(), self.reference.as_str()),
        ];
        if let Weights::Sets(weights) = &self.weights {
            let named = weights.iter().enumerate();
            sets.extend(named.map(|(i, w)| (format!("weights.sets.{i}.set"), w.set.as_str())));
        }
        sets
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        let (link, _) = the_reference(&points[1], &self.reference, ground)?;
        let weights = self.weights(points, ground)?;
        let mean = Mean::of(&weights, ground, link);
        let dofs = ground.dofs();
        let motions = link.motions(dofs).into_iter();
        let shifts = motions.filter_map(|(_, motion)| match motion {
            Motion::Translation(axis) => Some(mean.shift(axis, link, dofs)),
            Motion::Rotation(_) => None,
        });
        let turns = mean.turns.iter().map(|&axis| mean.turned(axis, link, dofs));
        shifts.chain(turns).collect()
    }

    fn tie(&self) -> Tie {
        Tie::Equation { value: 0.0 }
    }

    fn reference(&self) -> Option<&str> {
        Some(&self.reference)
    }

    fn leads(&self) -> bool {
        true
    }
}

impl Distributing {
    /// Points and what they count, of sum one.
    fn weights(
        &self,
        points: &[Vec<usize>],
        ground: Ground,
    ) -> Result<Vec<(usize, f64)>, Diagnostic> {
        let uniform = || points[0].iter().map(|&p| (p, 1.0)).collect::<Vec<_>>();
        let mut weights = match &self.weights {
            Weights::Uniform => uniform(),
            Weights::Area => {
                let facets = ground.facets(&self.set, &points[0]);
                let areas = tributary_areas(ground.mesh, &facets, ground.space);
                if areas.is_empty() { uniform() } else { areas }
            }
            Weights::Sets(given) => {
                let mut all = std::collections::BTreeMap::new();
                for (set, w) in points[2..].iter().zip(given) {
                    for &p in set {
                        *all.entry(p).or_insert(0.0) += w.weight;
                    }
                }
                all.into_iter().collect()
            }
        };
        if let Some(&(bad, _)) = weights.iter().find(|(p, _)| *p >= ground.mesh.points.len()) {
            let place = ground.place(bad);
            let message = format!("a reference point, at {place:?}, among the points of a body");
            return Err(Diagnostic::new("set", message).help("name a set of points of bodies"));
        }
        let sum: f64 = weights.iter().map(|(_, w)| w).sum();
        if !(sum > 0.0 && sum.is_finite()) {
            let message = format!("the sum of all weights is {sum}");
            return Err(Diagnostic::new("weights", message).help("weights of a positive sum"));
        }
        weights.iter_mut().for_each(|(_, w)| *w /= sum);
        Ok(weights)
    }
}

/// The rigid motion that comes nearest to what points do.
struct Mean<'a> {
    weights: &'a [(usize, f64)],
    /// From the mean of the points to each of them `[m]`.
    arms: Vec<Vec3>,
    /// From the mean of the points to the reference point `[m]`.
    offset: Vec3,
    /// Inverse of `Σ w (r² 1 - r rᵀ)`, zero where nothing turns `[1/m²]`.
    inverse: Mat3,
    /// Axes about which the points turn.
    turns: Vec<Vec3>,
    /// Components that count.
    components: std::ops::Range<usize>,
}

impl<'a> Mean<'a> {
    fn of(weights: &'a [(usize, f64)], ground: Ground, link: &Link) -> Self {
        let place = |p: usize| ground.place(p);
        let centre = (weights.iter()).fold([0.0; 3], |s, &(p, w)| add_scaled(s, w, place(p)));
        let arms: Vec<Vec3> = weights.iter().map(|w| sub(place(w.0), centre)).collect();
        let mut moments = [[0.0; 3]; 3];
        for (&(_, w), r) in weights.iter().zip(&arms) {
            let squared = norm(*r).powi(2);
            for (i, row) in moments.iter_mut().enumerate() {
                for (j, m) in row.iter_mut().enumerate() {
                    *m += w * (if i == j { squared } else { 0.0 } - r[i] * r[j]);
                }
            }
        }
        // Points with a smaller second moment are one.
        let least = 1e-20 * geometry::diameter(ground.mesh).powi(2);
        if link.freedom == Freedom::Plane {
            let polar = moments[2][2];
            moments = [[0.0; 3], [0.0; 3], [0.0, 0.0, polar]];
        }
        let (inverse, turns) = match link.freedom {
            Freedom::Axial | Freedom::Carried => ([[0.0; 3]; 3], Vec::new()),
            _ => pseudo_inverse(&moments, least),
        };
        Mean {
            weights,
            offset: sub(link.centre, centre),
            inverse,
            turns,
            arms,
            components: match ground.space {
                Space::Axisymmetric => 1..2,
                _ => 0..ground.dim(),
            },
        }
    }

    /// The rotation of the points per unit of the displacement of one of them.
    fn turn(&self, i: usize, component: usize) -> Vec3 {
        let (_, w) = self.weights[i];
        let mut unit = [0.0; 3];
        unit[component] = 1.0;
        let moment = scale(w, cross(self.arms[i], unit));
        crate::math::mat_vec(&self.inverse, moment)
    }

    /// The displacement of the reference point along an axis, less what it is by those of the points.
    fn shift(&self, axis: usize, link: &Link, dofs: Dofs) -> Result<Row, Diagnostic> {
        let mut terms = vec![(link.hidden, axis, 1.0)];
        for (i, &(point, w)) in self.weights.iter().enumerate() {
            for c in self.components.clone() {
                let along = if axis == c { w } else { 0.0 };
                let factor = along + cross(self.turn(i, c), self.offset)[axis];
                if factor != 0.0 {
                    terms.push((point, c, -factor));
                }
            }
        }
        Row::new(terms, dofs.dim)
    }

    /// The rotation of the reference point about an axis, less what it is by the displacements of the points.
    fn turned(&self, axis: Vec3, link: &Link, dofs: Dofs) -> Result<Row, Diagnostic> {
        let own = (0..3).filter_map(|k| {
            let (point, slot) = dofs.locate(link.dof(dofs, Motion::Rotation(k))?);
            (axis[k] != 0.0).then_some((point, slot, axis[k]))
        });
        let mut terms: Vec<_> = own.collect();
        for (i, &(point, _)) in self.weights.iter().enumerate() {
            for c in self.components.clone() {
                let factor = link.length * dot(self.turn(i, c), axis);
                if factor != 0.0 {
                    terms.push((point, c, -factor));
                }
            }
        }
        Row::new(terms, dofs.dim)
    }
}

/// The inverse of a symmetric matrix on the directions in which it has one, and these: the axes where that is all of them.
fn pseudo_inverse(m: &Mat3, least: f64) -> (Mat3, Vec<Vec3>) {
    let rows: Vec<Vec<f64>> = m.iter().map(|r| r.to_vec()).collect();
    let (values, vectors) = symmetric_eigen(&rows);
    // Points with a smaller part of the largest second moment lie on a line.
    let least = least.max(1e-10 * values[2]);
    let (mut out, mut turns) = ([[0.0; 3]; 3], Vec::new());
    for (k, value) in values.iter().enumerate().filter(|(_, v)| **v > least) {
        turns.push(std::array::from_fn(|i| vectors[i][k]));
        for (i, row) in out.iter_mut().enumerate() {
            for (j, o) in row.iter_mut().enumerate() {
                *o += vectors[i][k] * vectors[j][k] / value;
            }
        }
    }
    match turns.len() {
        3 => (out, identity().to_vec()),
        _ => (out, turns),
    }
}

impl Samples for Distributing {
    fn samples() -> Vec<Self> {
        let of = |weights| Distributing {
            set: "a.left".into(),
            reference: "hub".into(),
            weights,
        };
        let by_sets = vec![SetWeight {
            set: "a.left".into(),
            weight: 2.0,
        }];
        vec![
            of(Weights::Area),
            of(Weights::Uniform),
            of(Weights::Sets(by_sets)),
        ]
    }
}
