use serde::{Deserialize, Serialize};

use super::{Row, Tie};
use crate::mesh::geometry;

use super::model::{CouplingModel, Ground, pair};
use crate::error::Diagnostic;
use crate::math::{distance, scale, sub};
use crate::registry::Samples;

/// A spring along the line between two points. The line is that between the points where they are meshed: their motion relative to the distance
/// has to be small.
///
/// Sets of n points stand for n springs, paired in the order of the points in the mesh; a set of one point pairs with all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxialSpring {
    /// Where it begins: `body.set`, a `[set.NAME]`, a body, or a `[reference.NAME]`.
    pub from: String,
    /// Where it ends: `body.set`, a `[set.NAME]`, a body, or a `[reference.NAME]`.
    pub to: String,
    /// Stiffness of each spring `[N/m]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub stiffness: f64,
}

impl CouplingModel for AxialSpring {
    fn sets(&self) -> Vec<(String, &str)> {
        vec![("from".into(), &self.from), ("to".into(), &self.to)]
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        let (mesh, dim) = (ground.mesh, ground.dim());
        let tuples = pair(points, &self.sets())?.into_iter();
        tuples
            .map(|ends| {
                let [a, b] = [ends[0], ends[1]];
                let [from, to] = [ground.place(a), ground.place(b)];
                let length = distance(from, to);
                let size = geometry::diameter(mesh);
                if length <= 1e-12 * size {
                    let name = |p: usize| match mesh.point_ids.get(p) {
                        Some(id) => format!("node {id}"),
                        None => "the reference point".into(),
                    };
                    let message = format!("{} and {} lie at the same place", name(a), name(b));
                    let help = "between such points a `spring` says along which component it acts";
                    return Err(Diagnostic::new("to", message).help(help));
                }
                let axis = scale(1.0 / length, sub(to, from));
                let terms = (0..dim).flat_map(|c| [(a, c, -axis[c]), (b, c, axis[c])]);
                Row::new(terms, dim)
            })
            .collect()
    }

    fn tie(&self) -> Tie {
        Tie::Spring {
            stiffness: self.stiffness,
        }
    }
}

impl Samples for AxialSpring {
    fn samples() -> Vec<Self> {
        vec![AxialSpring {
            from: "a.left".into(),
            to: "b.right".into(),
            stiffness: 1e6,
        }]
    }
}
