use super::domain::{Action, Domain, LoadModel, Region, Target, mismatch};
use crate::error::Diagnostic;
use crate::registry::Samples;
use crate::system::Motion;

/// A moment on a reference point or a rigid body, what is named by `set`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Moment {
    /// Moment about the axes `[N m]`: `[x, y, z]`, in the plane the one about z, `[z]`, over the whole thickness.
    pub value: Vec<f64>,
}

impl LoadModel for Moment {
    fn region(&self) -> Region {
        Region::Points
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let Target::Points(points) = target else {
            return Err(mismatch(Region::Points));
        };
        let links = domain.links;
        let mut turned: Vec<usize> = Vec::new();
        for &p in *points {
            match links.of_hidden(p).or_else(|| links.of_point(p)) {
                Some(link) if turned.contains(&link) => {}
                Some(link) => turned.push(link),
                None => {
                    let message = "a moment on points of a body that deforms: they cannot turn";
                    return Err(Diagnostic::new("value", message).help(
                        "put it on a [reference.NAME], and tie points to that by coupling.distributing or coupling.kinematic",
                    ));
                }
            }
        }
        let axes: &[usize] = if domain.space.dim() == 2 {
            &[2]
        } else {
            &[0, 1, 2]
        };
        let finite = self.value.iter().all(|m| m.is_finite());
        if self.value.len() != axes.len() || !finite {
            let message = format!("expected {} finite numbers", axes.len());
            return Err(Diagnostic::new("value", message).help(match axes.len() {
                1 => "give the moment about z alone, [z]",
                _ => "give three components, [x, y, z]",
            }));
        }
        let mut entries = Vec::new();
        for link in turned.into_iter().map(|i| &links.all()[i]) {
            for (&axis, &moment) in axes.iter().zip(&self.value) {
                let dof = link.dof(links.dofs(), Motion::Rotation(axis));
                match dof {
                    Some(dof) => entries.push((dof, moment / link.length)),
                    None if moment == 0.0 => {}
                    None => {
                        let message = "nothing turns around an axis of symmetry";
                        return Err(Diagnostic::new("value", message));
                    }
                }
            }
        }
        entries.retain(|e| e.1 != 0.0);
        entries.sort_by_key(|e| e.0);
        Ok(Action::Forces(entries))
    }
}

impl Samples for Moment {
    fn samples() -> Vec<Self> {
        vec![Moment { value: vec![2.5] }]
    }
}
