//! An interface as a surface of its own: the faces that contact is checked on, and what is known at their corners.

use super::values::{MEANS, PointValues, shown_means, values};
use std::collections::BTreeMap;

use crate::contact::interface::Primary;
use crate::contact::interface::view::ContactView;
use crate::contact::law::friction::LawState;
use crate::math::{Vec3, add, add_scaled, normalize, scale, sub};
use crate::shape::ElementKind;
use crate::system::{Field, Fields, Location};

/// The surface of an interface that has the contact points, at the last committed state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    /// Reference coordinates of its points, shape `(n, 3)` `[m]`.
    pub points: Vec<Vec3>,
    /// Numbers of their nodes; zero of a place within a face.
    pub nodes: Vec<u64>,
    /// Its faces: lines in 2D, triangles and quadrilaterals in 3D, linear or quadratic; none where single points of a body were chosen.
    pub faces: Vec<(ElementKind, Vec<usize>)>,
    /// The number of the cell beneath each face; those that are not known are zero.
    pub cells: Vec<u64>,
    /// Fields at the points.
    pub fields: Fields,
}

/// The value that is not known of a point with nothing opposite.
const GAP: &str = "COPEN";

/// A corner of the sheet.
struct Corner {
    node: u64,
    x: Vec3,
    moved: Vec3,
    /// Contact points whose mean is shown here, with their weights.
    points: Vec<(usize, f64)>,
}

/// What is shown at a corner.
struct Shown {
    values: [f64; MEANS.len()],
    normal: Vec3,
    vectors: [Vec3; 3],
    status: f64,
    dissipated: f64,
    worn: f64,
    /// State variables of the friction law.
    law_state: LawState,
}

/// The surface with U, UREL, by how much it has moved more than what lies opposite now (not a number where nothing does), CPRESS, CSHEAR1/2, COPEN, CSLIP1/2, CSTATUS (0 open, 1 stick, 2 slip), CDISS, CWEAR, and as vectors CNORMAL, out of the primary,
/// CTRACTION, what acts on the secondary, CSHEAR, the part of it along the surface, and CSLIP. Tied surfaces have TNORMAL, positive in tension, TSHEAR1/2, and the vectors TTRACTION and TSHEAR instead. Where gaps are weighted over faces a corner is a contact point,
/// so that both sides of a sharp edge have values of their own; elsewhere it is a node, with the mean of the points that hang on it.
///
/// `u`: displacements; `t`: time, at which a rigid obstacle is where its motion has it.
pub fn sheet(contact: ContactView, u: &[f64], t: f64) -> Sheet {
    let (corners, faces, cells) = corners(contact, u);
    let moved = contact.displacements(u);
    let shown: Vec<Shown> = corners.iter().map(|c| shown(contact, c)).collect();
    let mut fields = Fields::default();
    let mut push = |name: &str, components: usize, values: Vec<f64>| {
        fields.all.push(Field {
            name: name.into(),
            location: Location::Point,
            components,
            values,
        });
    };
    push("U", 3, corners.iter().flat_map(|c| c.moved).collect());
    let relative = corners.iter().flat_map(|c| relative(contact, c, &moved, t));
    push("UREL", 3, relative.collect());
    for (k, &(name, _)) in shown_means(contact).iter().enumerate() {
        if contact.dofs.dim == 3 || !name.ends_with('2') {
            push(name, 1, shown.iter().map(|s| s.values[k]).collect());
        }
    }
    push("CNORMAL", 3, shown.iter().flat_map(|s| s.normal).collect());
    let vectors: &[&str] = match contact.laws.tied {
        true => &["TTRACTION", "TSHEAR"],
        false => &["CTRACTION", "CSHEAR", "CSLIP"],
    };
    for (k, name) in vectors.iter().enumerate() {
        push(name, 3, shown.iter().flat_map(|s| s.vectors[k]).collect());
    }
    if !contact.laws.tied {
        push("CSTATUS", 1, shown.iter().map(|s| s.status).collect());
        push("CDISS", 1, shown.iter().map(|s| s.dissipated).collect());
    }
    if contact.laws.wear.as_dyn().active() {
        push("CWEAR", 1, shown.iter().map(|s| s.worn).collect());
    }
    for (k, variable) in contact.laws.friction_law().states().iter().enumerate() {
        let values = shown.iter().map(|s| s.law_state[k]);
        push(variable.name, 1, values.collect());
    }
    Sheet {
        points: corners.iter().map(|c| add(c.x, contact.origin)).collect(),
        nodes: corners.iter().map(|c| c.node).collect(),
        faces,
        cells,
        fields,
    }
}

/// The corners, the faces between them, and the cells beneath these.
#[allow(clippy::type_complexity)]
fn corners(
    contact: ContactView,
    u: &[f64],
) -> (Vec<Corner>, Vec<(ElementKind, Vec<usize>)>, Vec<u64>) {
    let now = contact.coordinates(u);
    let of_point = |i: usize| {
        let p = &contact.points[i];
        let x = p.place(&contact.reference);
        Corner {
            node: p.node().map_or(0, |n| contact.node_ids[n]),
            x,
            moved: sub(p.place(&now), x),
            points: vec![(i, 1.0)],
        }
    };
    if contact.mortar.is_some() || contact.skin.is_empty() {
        let corners = (0..contact.points.len()).map(of_point).collect();
        let faces = contact.mortar.iter().flat_map(|m| &m.faces);
        let faces: Vec<_> = faces.map(|f| (f.kind, f.points.clone())).collect();
        let beneath = contact.skin.iter().map(|s| s.facet.cell);
        let mut cells: Vec<u64> = beneath.collect();
        cells.resize(faces.len(), 0);
        return (corners, faces, cells);
    }
    let facets = contact.skin.iter().map(|s| &s.facet);
    let nodes = facets.clone().flat_map(|f| f.nodes.iter().copied());
    let mut places: BTreeMap<usize, usize> = nodes.map(|n| (n, 0)).collect();
    let mut corners = Vec::with_capacity(places.len());
    for (&n, place) in &mut places {
        *place = corners.len();
        corners.push(Corner {
            node: contact.node_ids[n],
            x: contact.reference[n],
            moved: sub(now[n], contact.reference[n]),
            points: Vec::new(),
        });
    }
    for i in 0..contact.points.len() {
        for (node, w) in contact.own_weights(i).filter(|(_, w)| *w > 0.0) {
            if let Some(&place) = places.get(&node) {
                corners[place].points.push((i, w * contact.area_of(i)));
            }
        }
    }
    let faces = facets.clone().map(|f| {
        let corners = f.nodes.iter().map(|n| places[n]);
        (f.kind, corners.collect())
    });
    let faces = faces.collect();
    (corners, faces, facets.map(|f| f.cell).collect())
}

/// By how much a corner has moved more than what its points lie over now.
fn relative(contact: ContactView, corner: &Corner, moved: &[Vec3], t: f64) -> Vec3 {
    if let Primary::Rigid(_, motion) = &contact.primary {
        let now = add(corner.x, corner.moved);
        // Where the matter of the obstacle that is here now was at first.
        let first = motion.pose(0.0).outward(motion.pose(t).inward(now));
        return sub(corner.moved, sub(now, first));
    }
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for &(i, share) in &corner.points {
        for &(node, w) in contact.state.opposite.of(i) {
            sum = add_scaled(sum, share * w, moved[node]);
            total += share * w;
        }
    }
    match total > 0.0 {
        true => sub(corner.moved, scale(1.0 / total, sum)),
        false => [f64::NAN; 3],
    }
}

/// The mean of what its points say; a gap is that of those which have something opposite.
fn shown(contact: ContactView, corner: &Corner) -> Shown {
    let mut shown = Shown {
        values: [0.0; MEANS.len()],
        normal: [0.0; 3],
        vectors: [[0.0; 3]; 3],
        status: 0.0,
        dissipated: 0.0,
        worn: 0.0,
        law_state: LawState::default(),
    };
    let (mut sum, mut facing, mut largest) = (0.0, 0.0, 0.0);
    for &(i, w) in &corner.points {
        let Some(h) = contact.state.points.get(i) else {
            continue;
        };
        let values: PointValues = values(contact, i);
        sum += w;
        shown.normal = add_scaled(shown.normal, w, values.normal);
        shown.dissipated += w * h.dissipated;
        shown.worn += w * contact.state.worn.own_depth(i);
        for (total, value) in shown.law_state.iter_mut().zip(contact.state.law_state(i)) {
            *total += w * value;
        }
        if w > largest {
            (largest, shown.status) = (w, values.status);
        }
        let faces = values.gap.is_finite();
        facing += if faces { w } else { 0.0 };
        for (total, &(name, value)) in shown.values.iter_mut().zip(shown_means(contact)) {
            // A gap to nothing is no distance.
            if faces || name != GAP {
                *total += w * value(&values);
            }
        }
        for (total, v) in shown.vectors.iter_mut().zip(values.vectors) {
            *total = add_scaled(*total, w, v);
        }
    }
    shown.normal = normalize(shown.normal).unwrap_or_default();
    // Divided by nothing, what is not known is not a number.
    for (total, &(name, _)) in shown.values.iter_mut().zip(shown_means(contact)) {
        *total /= if name == GAP { facing } else { sum };
    }
    for total in &mut shown.vectors {
        *total = scale(1.0 / sum, *total);
    }
    shown.dissipated /= sum;
    shown.worn /= sum;
    shown.law_state = shown.law_state.map(|total| total / sum);
    shown
}
