use serde::{Deserialize, Serialize};

use super::{Row, Tie};

use super::model::{CouplingModel, pair};
use crate::error::Diagnostic;
use crate::math::{distance, scale, sub};
use crate::mesh::Mesh;
use crate::registry::Samples;

/// A spring along the line between two points. The line is that between the points where they are meshed: their motion relative to the distance
/// has to be small.
///
/// Sets of n points stand for n springs, paired in the order of the points in the mesh; a set of one point pairs with all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxialSpring {
    /// Where it begins: `body.set`, a `[set.NAME]`, or a body.
    pub from: String,
    /// Where it ends: `body.set`, a `[set.NAME]`, or a body.
    pub to: String,
    /// Stiffness of each spring `[N/m]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub stiffness: f64,
}

impl CouplingModel for AxialSpring {
    fn sets(&self) -> Vec<(String, &str)> {
        vec![("from".into(), &self.from), ("to".into(), &self.to)]
    }

    fn rows(&self, points: &[Vec<usize>], mesh: &Mesh, dim: usize) -> Result<Vec<Row>, Diagnostic> {
        let tuples = pair(points, &self.sets())?.into_iter();
        tuples
            .map(|ends| {
                let [a, b] = [ends[0], ends[1]];
                let [from, to] = [mesh.points[a], mesh.points[b]];
                let length = distance(from, to);
                let size = mesh.diameter();
                if length <= 1e-12 * size {
                    let message = format!(
                        "nodes {} and {} lie at the same place",
                        mesh.point_ids[a], mesh.point_ids[b]
                    );
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
