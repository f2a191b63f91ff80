//! Which points of interfaces lie on planes of symmetry: supports say so.

use crate::body::Space;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::math::{Vec3, norm, normalize, sub};
use crate::model::Support;
use crate::system::{Course, Dofs, Links};
use crate::tolerance::NEGLIGIBLE;

/// What supports hold where it is in all steps.
pub(super) struct Held<'a> {
    links: &'a Links,
    dofs: Dofs,
    /// By dof.
    held: Vec<bool>,
    /// Nothing moves across the axis `x = 0`.
    axis: bool,
}

impl<'a> Held<'a> {
    pub fn new(links: &'a Links, dofs: Dofs, supports: &[Support], space: Space) -> Self {
        let steps = supports.first().map_or(0, |s| s.schedule.pieces.len());
        let mut held = vec![steps > 0; dofs.count()];
        for step in 0..steps {
            let mut now = vec![false; dofs.count()];
            for support in supports {
                let acts = support.schedule.pieces[step].course != Course::Off;
                let still = support.entries.iter().filter(|e| e.hold || e.value == 0.0);
                for entry in still.filter(|_| acts) {
                    now[entry.dof] = true;
                }
            }
            for (all, now) in held.iter_mut().zip(now) {
                *all &= now;
            }
        }
        Held {
            links,
            dofs,
            held,
            axis: space == Space::Axisymmetric,
        }
    }

    /// Whether a point, of a rigid body too, does not move along an axis.
    fn still(&self, point: usize, c: usize) -> bool {
        let dof = self.dofs.of(point, c);
        match self.links.row_at_start(dof) {
            Some(row) => row.iter().all(|&(q, w)| w == 0.0 || self.held[q]),
            None => self.held[dof],
        }
    }
}

/// Marks the points of weighted interfaces that lie on planes of symmetry: planes across an axis on which both surfaces end, and none of whose points leaves it.
/// `angle`: the largest between faces of one smooth surface `[rad]`, so that image and original are one.
pub(super) fn mark(interface: &mut InterfaceDefinition, held: &Held, angle: f64) {
    let reference = interface.reference.clone();
    let nodes = || reference.iter().copied();
    let low = nodes().fold([f64::INFINITY; 3], |m, x| {
        std::array::from_fn(|c| m[c].min(x[c]))
    });
    let high = nodes().fold([f64::NEG_INFINITY; 3], |m, x| {
        std::array::from_fn(|c| m[c].max(x[c]))
    });
    let near = NEGLIGIBLE * norm(sub(high, low));
    for c in 0..interface.dofs.dim {
        for plane in [low[c], high[c]] {
            let on: Vec<bool> = nodes().map(|x| (x[c] - plane).abs() <= near).collect();
            if high[c] - low[c] > near && symmetric(interface, held, c, plane, &on) {
                cross_out(interface, c, &on, (0.5 * angle).sin());
            }
        }
    }
}

/// Whether the plane of these nodes, across axis `c`, is one of symmetry.
fn symmetric(
    interface: &InterfaceDefinition,
    held: &Held,
    c: usize,
    plane: f64,
    on: &[bool],
) -> bool {
    let Primary::Facets(facets) = &interface.primary else {
        return false;
    };
    let (theirs, own) = on.split_at(interface.primary_nodes);
    let reach = theirs.contains(&true) && own.contains(&true);
    let on_axis = held.axis && c == 0 && plane == 0.0;
    let still = |(&node, &on): (&usize, &bool)| !on || on_axis || held.still(node, c);
    let within = |nodes: &[usize]| nodes.iter().all(|&n| on[n]);
    let faces = interface.mortar.iter().flat_map(|m| &m.faces);
    reach
        && interface.nodes.iter().zip(on).all(still)
        && !facets.iter().any(|f| within(&f.nodes))
        && !faces.into_iter().any(|f| within(&f.nodes))
}

/// The points at these nodes have nothing across axis `c`, if their normal has no more than `most`.
fn cross_out(interface: &mut InterfaceDefinition, c: usize, on: &[bool], most: f64) {
    let mesh = interface.mesh_mut();
    let Some(mortar) = &mut mesh.mortar else {
        return;
    };
    let level = |normal: &mut Vec3| {
        normal[c] = 0.0;
        *normal = normalize(*normal).unwrap_or(*normal);
    };
    let mut marked = vec![false; mesh.points.len()];
    for (point, marked) in mesh.points.iter_mut().zip(&mut marked) {
        *marked = point.node().is_some_and(|n| on[n]) && point.normal[c].abs() <= most;
        if *marked {
            point.across.0[c] = true;
            level(&mut point.normal);
        }
    }
    for face in &mut mortar.faces {
        for (normal, &point) in face.normals.iter_mut().zip(&face.points) {
            if marked[point] {
                level(normal);
            }
        }
    }
}
