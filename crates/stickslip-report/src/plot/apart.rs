//! Bodies that touch, drawn apart so that the surfaces between them are seen, and how much of these is seen.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::io::vtu::PointFields;
use stickslip::math::{cross, distance, dot, norm, symmetric_eigen};

use super::camera::{Camera, Frame, View, unit};
use super::raster::{Corner, Raster};
use super::zoom::{self, Mirror};
use crate::colour::Scale;
use crate::field::Field;
use crate::sheet::Sheet;
use crate::skin::Skin;

type Vec3 = [f64; 3];

/// Two surfaces that touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The interface.
    pub name: String,
    /// The body with the contact points, and the one opposite; none where that is an obstacle.
    pub bodies: [Option<usize>; 2],
    /// The middles of its faces that press, of all where none does: where they are with displacements as they are drawn, and the normal out of the body opposite.
    points: Vec<(Vec3, Vec3)>,
    /// The box around its points that press.
    pub bounds: [Vec3; 2],
    /// The sum of their pressures.
    load: f64,
}

/// Parts of the model: the largest distance between the sides of a contact.
const LARGEST_SEPARATION: f64 = 0.05;

/// Points of a contact by which the body opposite is found.
const SAMPLED_POINTS: usize = 64;

/// What touches where the field has values. `moved`: the points of the skin as they are drawn.
pub fn contacts(
    skin: &Skin,
    points: &PointFields,
    field: &Field,
    sheets: &[Sheet],
    moved: &[Vec3],
    scale: f64,
) -> Vec<Contact> {
    let carrying = sheets.iter().filter(|s| s.has(&field.array));
    let ids = points.arrays.get("NODE_ID").map(|a| &a.values);
    let local = skin.points.iter().zip(&skin.owner);
    let owners: BTreeMap<u64, usize> = local
        .filter_map(|(&p, &body)| Some((ids?[p] as u64, body as usize)))
        .collect();
    let values = points.arrays.get(&field.array);
    let of_contact: Vec<usize> = (0..skin.points.len())
        .filter(|&i| values.is_some_and(|v| !field.value(v, skin.points[i]).is_nan()))
        .collect();
    let contact = |sheet: &Sheet| {
        let pressing = sheet.pressing();
        let all = 0..sheet.grid.points.points.len();
        let used = if pressing.is_empty() {
            all.collect()
        } else {
            pressing
        };
        let nodes = sheet.numbers("NODE_ID");
        let own = (used.iter()).find_map(|&i| owners.get(&(*nodes.get(i)? as u64)));
        let placed = places(sheet, &used, scale);
        let points: Vec<Vec3> = used.iter().map(|&i| sheet.place(i, scale)).collect();
        let other = own.and_then(|&own| opposite(skin, moved, &of_contact, own, &points));
        let pressures = sheet.numbers("CPRESS");
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for x in points {
            for c in 0..3 {
                bounds[0][c] = bounds[0][c].min(x[c]);
                bounds[1][c] = bounds[1][c].max(x[c]);
            }
        }
        Contact {
            bounds,
            name: sheet.name.clone(),
            bodies: [own.copied(), other],
            load: used.iter().filter_map(|&i| pressures.get(i)).sum(),
            points: placed,
        }
    };
    carrying.map(contact).collect()
}

/// The middles of the faces of a surface that have one of these points, or the points themselves where there are no faces, with the normals there.
fn places(sheet: &Sheet, used: &[usize], scale: f64) -> Vec<(Vec3, Vec3)> {
    let mean = |points: &[usize]| {
        let (mut x, mut normal) = ([0.0; 3], [0.0; 3]);
        for &i in points {
            let (at, out) = (sheet.place(i, scale), unit(sheet.vector("CNORMAL", i)));
            for c in 0..3 {
                x[c] += at[c] / points.len() as f64;
                normal[c] += out[c];
            }
        }
        (x, unit(normal))
    };
    let used_ones: BTreeSet<usize> = used.iter().copied().collect();
    let faces = (0..sheet.grid.types.len()).map(|i| sheet.grid.cell(i));
    let faces = faces.filter(|f| f.len() > 1 && f.iter().any(|i| used_ones.contains(i)));
    let middles: Vec<(Vec3, Vec3)> = faces.map(mean).collect();
    match middles.is_empty() {
        true => used.iter().map(|i| mean(&[*i])).collect(),
        false => middles,
    }
}

/// The body whose points of contact are nearest to these, beside their own.
fn opposite(
    skin: &Skin,
    moved: &[Vec3],
    of_contact: &[usize],
    own: usize,
    points: &[Vec3],
) -> Option<usize> {
    let mut sums = vec![0.0; skin.ends.len()];
    let step = points.len().div_ceil(SAMPLED_POINTS).max(1);
    let samples = points.iter().step_by(step);
    for x in samples.clone() {
        let mut nearest = vec![f64::INFINITY; sums.len()];
        for &i in of_contact {
            let body = skin.owner[i] as usize;
            nearest[body] = nearest[body].min(distance(moved[i], *x));
        }
        for (sum, near) in sums.iter_mut().zip(nearest) {
            *sum += near;
        }
    }
    let others = (0..sums.len()).filter(|&b| b != own);
    let best = others.min_by(|&a, &b| sums[a].total_cmp(&sums[b]))?;
    let mean = sums[best] / samples.count().max(1) as f64;
    (mean <= LARGEST_SEPARATION * skin.size()).then_some(best)
}

/// The mean normal of a contact, and whether its points agree on it; of what closes around a pin the direction along the pin.
fn direction(contact: &Contact) -> (Vec3, bool) {
    let mut sum = [0.0; 3];
    let mut squares = vec![vec![0.0; 3]; 3];
    for (_, n) in &contact.points {
        for a in 0..3 {
            sum[a] += n[a];
            for b in 0..3 {
                squares[a][b] += n[a] * n[b];
            }
        }
    }
    if norm(sum) >= 0.5 * contact.points.len() as f64 {
        return (unit(sum), true);
    }
    // Ascending, a column each.
    let (_, vectors) = symmetric_eigen(&squares);
    ([0, 1, 2].map(|c| vectors[c][0]), false)
}

/// The direction in which bodies come apart, and the place of each in the row along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// A unit vector.
    pub along: Vec3,
    /// From 0, a number a body.
    pub places: Vec<usize>,
}

/// The middle of each body as it is drawn.
pub fn middles(stage: Stage) -> Vec<Vec3> {
    let mut sums = vec![([0.0; 3], 0.0); stage.bodies.len()];
    for (x, &body) in stage.moved.iter().zip(&stage.skin.owner) {
        let (sum, count) = &mut sums[body as usize];
        (0..3).for_each(|c| sum[c] += x[c]);
        *count += 1.0;
    }
    let mean = |(sum, count): (Vec3, f64)| sum.map(|x| x / f64::max(count, 1.0));
    sums.into_iter().map(mean).collect()
}

/// How bodies come apart: along the normal of the contact that carries most. First come contacts whose bodies stand in that order already, by their `middles`, then the more
/// heavily loaded ones: a bolt between its head and its nut stands above both plates or below both, and leaves the plates in their order. `None` where no two bodies touch.
pub fn row(contacts: &[Contact], middles: &[Vec3], mirrors: &[Mirror]) -> Option<Row> {
    let bodies = middles.len();
    let mut all: Vec<(&Contact, [usize; 2], Vec3, bool)> = contacts
        .iter()
        .filter_map(|c| {
            let (normal, agree) = direction(c);
            Some((c, [c.bodies[0]?, c.bodies[1]?], normal, agree))
        })
        .collect();
    // What has one normal comes before what is closed.
    all.sort_by(|a, b| b.3.cmp(&a.3).then(b.0.load.total_cmp(&a.0.load)));
    let mut along = all.first()?.2;
    // Not out of a plane of symmetry, where that leaves a direction.
    let mut within = along;
    mirrors.iter().for_each(|(axis, _)| within[*axis] = 0.0);
    if norm(within) > 0.3 {
        along = unit(within);
    }
    // Towards the eye that looks from above, so that the order is the same whichever side is the secondary.
    if dot(along, [0.3, -0.4, 1.0]) < 0.0 {
        along = along.map(|x| -x);
    }
    let stands = |(_, [own, other], normal, _): &(&Contact, [usize; 2], Vec3, bool)| {
        let apart = dot(middles[*own], along) - dot(middles[*other], along);
        apart * dot(*normal, along) > 0.0
    };
    all.sort_by_key(|one| !(one.3 && stands(one)));
    let mut places = vec![0; bodies];
    let mut above: Vec<[usize; 2]> = Vec::new();
    for (_, [own, other], normal, agree) in all {
        let up = dot(normal, along);
        let pair = if up > 0.0 { [other, own] } else { [own, other] };
        if (agree && up.abs() > 0.3) || places[own] == places[other] {
            above.push(pair);
            match stack(&above, bodies) {
                Some(found) => places = found,
                None => drop(above.pop()),
            }
        }
    }
    Some(Row { along, places })
}

/// The lowest places at which each pair has its second body above its first; `None` where pairs go round in a circle.
fn stack(above: &[[usize; 2]], bodies: usize) -> Option<Vec<usize>> {
    let mut places = vec![0; bodies];
    for _round in 0..=bodies {
        let before = places.clone();
        for &[low, high] in above {
            places[high] = places[high].max(places[low] + 1);
        }
        if before == places {
            return Some(places);
        }
    }
    None
}

/// What is drawn, as far as it hides something.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    /// The bodies.
    pub skin: &'a Skin,
    /// Which of them are drawn.
    pub bodies: &'a [bool],
    /// Their points as they are drawn.
    pub moved: &'a [Vec3],
    /// Planes of symmetry.
    pub mirrors: &'a [Mirror],
}

/// Pixels of the raster on which is found what is seen.
const COARSE: [usize; 2] = [320, 240];

/// The part of the faces in contact that is seen from a direction, on either side. `offsets`: by how much each body is moved.
pub fn in_view(stage: &Stage, contacts: &[Contact], camera: &Camera, offsets: &[Vec3]) -> f64 {
    let Stage { skin, bodies, .. } = *stage;
    let shift = |x: Vec3, body: usize| [0, 1, 2].map(|c| x[c] + offsets[body][c]);
    let moved = stage.moved.iter().zip(&skin.owner);
    let moved: Vec<Vec3> = moved.map(|(x, &body)| shift(*x, body as usize)).collect();
    let drawn = moved.iter().zip(&skin.owner);
    let drawn = drawn.filter(|(_, body)| bodies[**body as usize]);
    let bounds = zoom::around(drawn.map(|(x, _)| *x), stage.mirrors, camera);
    let frame = Frame::fit(bounds[0], bounds[1], [0.0; 2], COARSE.map(|n| n as f64));
    let mut raster = Raster::new(COARSE);
    for seen in zoom::images(stage.mirrors) {
        let place = |x: &Vec3| frame.place(camera.see(zoom::image(*x, &seen)));
        let seen: Vec<Vec3> = moved.iter().map(place).collect();
        for body in (0..bodies.len()).filter(|&b| bodies[b]) {
            for t in skin.triangles_of(body) {
                let corner = |i: u32| Corner {
                    at: seen[i as usize],
                    value: f64::NAN,
                };
                raster.triangle(t.map(corner), &Scale::default(), 1.0);
            }
        }
    }
    let by = 0.01 * skin.size();
    let sees = |x: Vec3, out: Vec3| {
        dot(out, camera.out) > 0.05 && !raster.hides(frame.place(camera.see(x)), by)
    };
    let (mut seen, mut all) = (0, 0);
    for contact in contacts {
        for &(x, normal) in &contact.points {
            let side = |k: usize, out: Vec3| {
                let body = contact.bodies[k].filter(|&b| bodies[b]);
                body.is_some_and(|b| sees(shift(x, b), out))
            };
            all += 1;
            seen += usize::from(side(0, normal.map(|v| -v)) || side(1, normal));
        }
    }
    seen as f64 / f64::from(all.max(1))
}

/// Directions from which bodies are looked at that stand in a row: half from above along it, from four sides.
pub fn views(along: Vec3) -> Vec<View> {
    let aside = if along[2].abs() > 0.7 {
        [0.62, -0.72, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let across = unit(cross(along, aside));
    let front = unit(cross(across, along));
    let from = |up: f64, k: usize| {
        let side = [front, across, front.map(|x| -x), across.map(|x| -x)][k];
        View::From([0, 1, 2].map(|c| 0.55 * up * along[c] + 0.83 * side[c]))
    };
    let all = [1.0, -1.0].into_iter();
    all.flat_map(|up| (0..4).map(move |k| (up, k)))
        .map(|(up, k)| from(up, k))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(bodies: [usize; 2], normal: Vec3, load: f64) -> Contact {
        Contact {
            name: "c".into(),
            bodies: bodies.map(Some),
            points: vec![([0.0; 3], normal); 4],
            bounds: [[0.0; 3]; 2],
            load,
        }
    }

    #[test]
    fn a_stack_comes_apart_in_its_order_whichever_side_has_the_points() {
        let (up, down) = ([0., 0., 1.], [0., 0., -1.]);
        // A bolt (0) on plates (1, 2) on a nut (3), which its thread would put above the bolt.
        let all = [
            contact([0, 1], up, 5.0),
            contact([2, 1], down, 4.0),
            contact([3, 2], down, 4.5),
            contact([3, 0], up, 0.0),
        ];
        let at = |z: f64| [0.0, 0.0, z];
        let middles = [at(0.5), at(1.0), at(-1.0), at(-2.0), at(0.0)];
        let row = row(&all, &middles, &[]).unwrap();
        assert_eq!((row.along, row.places), (up, vec![3, 2, 1, 0, 0]));
        // Head and nut of one body (0), which carry more than the joint between the plates (1, 2): these keep their order.
        let all = [
            contact([0, 1], up, 5.0),
            contact([0, 2], down, 5.0),
            contact([1, 2], up, 2.0),
        ];
        let row = super::row(&all, &[at(0.0), at(1.0), at(-1.0)], &[]).unwrap();
        assert_eq!(row.places, [2, 1, 0]);
        // Nothing comes apart from an obstacle.
        let alone = Contact {
            bodies: [Some(0), None],
            ..contact([0, 1], up, 1.0)
        };
        assert_eq!(super::row(&[alone], &[at(0.0)], &[]), None);
    }

    #[test]
    fn a_pin_is_drawn_out_of_its_hole_along_itself() {
        let around = (0..8).map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 8.0).sin_cos();
            ([cos, sin, 0.0], [cos, sin, 0.0])
        });
        let pin = Contact {
            points: around.collect(),
            ..contact([1, 0], [0.; 3], 1.0)
        };
        let row = row(&[pin], &[[0.0; 3]; 2], &[]).unwrap();
        assert!((row.along[2].abs() - 1.0).abs() < 1e-12);
        assert_ne!(row.places[0], row.places[1]);
    }
}
