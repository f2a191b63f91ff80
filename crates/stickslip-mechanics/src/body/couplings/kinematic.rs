use serde::{Deserialize, Serialize};

use super::{Row, Tie};

use super::model::{CouplingModel, Ground};
use crate::error::Diagnostic;
use crate::math::sub;
use crate::registry::Samples;
use crate::system::Component;

/// Points follow a reference point as if they were rigid with it: `u = q + θ × (x - X)`, `q` and `θ` its displacement and rotation, `X` where it is.
///
/// Rotations are small: above about 0.1 rad it shows. Between the points nothing deforms any more, in the components that follow. In explicit steps
/// it acts by springs as equations do, and the reference point needs a mass and a moment of inertia. Around an axis of symmetry a reference point moves
/// along y alone, and what follows it in x keeps its radius.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Kinematic {
    /// The points that follow: `body.set`, a `[set.NAME]`, or a body.
    pub set: String,
    /// The `[reference.NAME]` that they follow.
    pub reference: String,
    /// The displacements in which they do; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub components: Option<Vec<Component>>,
}

impl CouplingModel for Kinematic {
    fn sets(&self) -> Vec<(String, &str)> {
        vec![
            ("set".into(), &self.set),
            ("reference".into(), &self.reference),
        ]
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        let (link, _) = the_reference(&points[1], &self.reference, ground)?;
        let (dim, dofs) = (ground.dim(), ground.dofs());
        let all: Vec<usize> = match &self.components {
            None => (0..dim).collect(),
            Some(chosen) => chosen.iter().map(|c| *c as usize).collect(),
        };
        if let Some(i) = all.iter().position(|c| *c >= dim) {
            let message = "not a displacement of the points of a body";
            return Err(Diagnostic::new(format!("components.{i}"), message)
                .help("choose among x, y and, in space, z"));
        }
        if all.is_empty() {
            let message = "no component follows";
            return Err(Diagnostic::new("components", message).help("leave the key out for all"));
        }
        let mut rows = Vec::with_capacity(all.len() * points[0].len());
        for &point in &points[0] {
            let arm = sub(ground.place(point), link.centre);
            for &c in &all {
                let moved = link.row_at(dofs, arm, c).into_iter();
                let moved = moved.map(|(dof, factor)| {
                    let (point, slot) = dofs.locate(dof);
                    (point, slot, -factor)
                });
                let row = Row::new(moved.chain([(point, c, 1.0)]), dim);
                rows.push(row.map_err(|_| follows_itself())?);
            }
        }
        Ok(rows)
    }

    fn tie(&self) -> Tie {
        Tie::Equation { value: 0.0 }
    }

    fn reference(&self) -> Option<&str> {
        Some(&self.reference)
    }
}

fn follows_itself() -> Diagnostic {
    Diagnostic::new("set", "the reference point would follow itself")
        .help("name a set of points of bodies")
}

/// The reference point that was named, and its hidden point.
pub(super) fn the_reference<'a>(
    points: &[usize],
    name: &str,
    ground: Ground<'a>,
) -> Result<(&'a crate::system::Link, usize), Diagnostic> {
    let links = ground.links;
    match points {
        &[point] if point >= ground.mesh.points.len() => {
            if let Some(index) = links.of_hidden(point) {
                return Ok((&links.all()[index], point));
            }
        }
        _ => {}
    }
    let message = format!("`{name}` is no reference point");
    Err(Diagnostic::new("reference", message).help("name a table [reference.NAME]"))
}

impl Samples for Kinematic {
    fn samples() -> Vec<Self> {
        vec![Kinematic {
            set: "a.left".into(),
            reference: "hub".into(),
            components: Some(vec![Component::X, Component::Y]),
        }]
    }
}
