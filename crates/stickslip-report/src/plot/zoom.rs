//! Which part of the bodies a picture shows, and how much larger displacements may be drawn.

use stickslip::io::vtu::Grid;

use super::camera::Camera;
use super::picture::Zoom;
use crate::sheet::Sheet;

/// Lowest and highest corner in the picture's plane.
pub type Box2 = [[f64; 2]; 2];

/// The box of nothing.
pub const EMPTY_BOX: Box2 = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

/// Parts of the model by which sides of an interface may be drawn apart along their normal, and across.
const DRAWN_APART: [f64; 2] = [0.001, 0.02];

/// Takes a point, seen by the camera, into a box.
pub fn include(bounds: &mut Box2, seen: [f64; 3]) {
    for c in 0..2 {
        bounds[0][c] = bounds[0][c].min(seen[c]);
        bounds[1][c] = bounds[1][c].max(seen[c]);
    }
}

/// A plane of symmetry: the axis that it crosses, and where.
pub type Mirror = (usize, f64);

/// What mirrors show of a point, one after the other.
pub fn image(mut x: [f64; 3], mirrors: &[Mirror]) -> [f64; 3] {
    for &(axis, at) in mirrors {
        x[axis] = 2.0 * at - x[axis];
    }
    x
}

/// All ways to look at the bodies: directly, in each of the mirrors, and in several.
pub fn images(mirrors: &[Mirror]) -> Vec<Vec<Mirror>> {
    let mut all = vec![Vec::new()];
    for mirror in mirrors {
        let more = all
            .iter()
            .map(|seen: &Vec<Mirror>| [&seen[..], &[*mirror]].concat());
        let more: Vec<Vec<Mirror>> = more.collect();
        all.extend(more);
    }
    all
}

/// Leaves only the cells whose middle is below a place on an axis.
pub fn keep_below(grid: &mut Grid, axis: usize, at: f64) {
    let kept: Vec<usize> = (0..grid.types.len())
        .filter(|&i| {
            let cell = grid.cell(i);
            let sum: f64 = cell.iter().map(|&p| grid.points.points[p][axis]).sum();
            sum < at * cell.len() as f64
        })
        .collect();
    let mut connectivity = Vec::new();
    let offsets = kept.iter().map(|&i| {
        connectivity.extend_from_slice(grid.cell(i));
        connectivity.len()
    });
    let offsets = offsets.collect();
    for array in grid.cell_arrays.values_mut() {
        let n = array.components;
        let values = kept.iter().flat_map(|&i| &array.values[n * i..n * (i + 1)]);
        array.values = values.copied().collect();
    }
    grid.types = kept.iter().map(|&i| grid.types[i]).collect();
    (grid.offsets, grid.connectivity) = (offsets, connectivity);
}

/// The box around these points and their images.
pub fn around(points: impl Iterator<Item = [f64; 3]>, mirrors: &[Mirror], camera: &Camera) -> Box2 {
    let images = images(mirrors);
    let mut bounds = EMPTY_BOX;
    for x in points {
        for seen in &images {
            include(&mut bounds, camera.see(image(x, seen)));
        }
    }
    bounds
}

/// The box that is seen.
pub fn seen(
    bounds: Box2,
    patch: Box2,
    zoom: Zoom,
    middle: Option<[f64; 3]>,
) -> Result<Box2, String> {
    let span = |b: Box2| (b[1][0] - b[0][0]).max(b[1][1] - b[0][1]);
    let centre = |b: Box2| [0, 1].map(|c| (b[0][c] + b[1][c]) / 2.0);
    let presses = patch[0][0] <= patch[1][0];
    let about = |middle: [f64; 2], half: [f64; 2]| {
        let end = |sign: f64| [0, 1].map(|c| middle[c] + sign * half[c]);
        [end(-1.0), end(1.0)]
    };
    let at = middle.map(|x| [x[0], x[1]]);
    match zoom {
        Zoom::Contact if !presses => Err(
            "nothing presses at the times that are drawn: there is no patch of contact to zoom on"
                .into(),
        ),
        Zoom::Times(times) => {
            let middle = at.unwrap_or(if presses {
                centre(patch)
            } else {
                centre(bounds)
            });
            let half = [0, 1].map(|c| (bounds[1][c] - bounds[0][c]) / 2.0 / times);
            Ok(about(middle, half))
        }
        Zoom::Auto | Zoom::Contact
            // A patch that takes more than 0.4 of the picture is seen well enough with all around it.
            if presses && (zoom == Zoom::Contact || span(patch) < 0.4 * span(bounds)) =>
        {
            // A single point presses on a spot about it.
            // Room around the patch that presses, relative to it: 0.6 at each side.
            let wide = ((0.5 + 0.6) * span(patch)).max(0.02 * span(bounds));
            Ok(about(at.unwrap_or(centre(patch)), [wide; 2]))
        }
        _ => match at {
            // All around a place is what is four times nearer.
            Some(_) => seen(bounds, patch, Zoom::Times(4.0), middle),
            None => Ok(bounds),
        },
    }
}

/// The factor of displacements at which the largest is a twentieth of the model; 1 if it is more by itself.
fn factor(size: f64, largest: f64) -> f64 {
    if largest <= 0.0 || size <= 0.0 || 20.0 * largest >= size {
        return 1.0;
    }
    // 1, 2 or 5 times a power of ten, so that it can be said.
    let wanted = size / (20.0 * largest);
    let power = 10f64.powf(wanted.log10().floor());
    let lead = wanted / power;
    let lead = [5.0, 2.0].into_iter().find(|l| lead >= *l).unwrap_or(1.0);
    (lead * power).max(1.0)
}

/// The factor of the shape of a mode, whose amplitude means nothing, at which its largest displacement is a twentieth of the model.
pub fn of_shape(size: f64, largest: f64) -> f64 {
    match largest > 0.0 && size > 0.0 {
        true => size / (20.0 * largest),
        false => 1.0,
    }
}

/// The factor of displacements that shows them well and moves no surface visibly to or from another. What sides move relative to each other is drawn that many
/// times larger too, while the gap before any displacement is not.
pub fn scale<'a>(size: f64, largest: f64, sheets: impl Iterator<Item = &'a Sheet>) -> f64 {
    let mut motion = [0.0f64; 2];
    for sheet in sheets {
        let here = sheet.motion();
        motion = [0, 1].map(|c| motion[c].max(here[c]));
    }
    let most = [0, 1].map(|c| 1.0 + DRAWN_APART[c] * size / motion[c].max(f64::MIN_POSITIVE));
    let most = most[0].min(most[1]);
    let wanted = factor(size, largest);
    if wanted <= most {
        return wanted;
    }
    // 1, 2 or 5 times a power of ten, as without a limit.
    let power = 10f64.powf(most.log10().floor());
    let lead = [5.0, 2.0].into_iter().find(|l| most / power >= *l);
    (lead.unwrap_or(1.0) * power).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_are_scaled_by_round_factors() {
        assert_eq!(factor(1.0, 1e-3), 50.0);
        assert_eq!(factor(1.0, 0.3), 1.0);
        assert_eq!(factor(2.0, 1e-6), 100_000.0);
        assert_eq!(factor(1.0, 0.0), 1.0);
        assert_eq!(factor(1.0, 0.04), 1.0);
        // A mode has no size of its own: it is made smaller as well.
        assert_eq!(of_shape(0.3, 1.0), 0.015);
        assert_eq!([of_shape(1.0, 0.0), of_shape(0.0, 1.0)], [1.0; 2]);
    }

    #[test]
    fn two_mirrors_make_a_whole_of_a_quarter() {
        let mirrors = [(0, 0.0), (1, 1.0)];
        let of = |seen: &Vec<Mirror>| image([2.0, 3.0, 4.0], seen);
        let all: Vec<[f64; 3]> = images(&mirrors).iter().map(of).collect();
        let corners = [[2., 3., 4.], [-2., 3., 4.], [2., -1., 4.], [-2., -1., 4.]];
        assert_eq!(all, corners);
        assert_eq!(images(&[]), [Vec::new()]);
    }

    const ALL: Box2 = [[0.0, 0.0], [10.0, 4.0]];

    #[test]
    fn a_small_patch_is_seen_from_near_and_a_large_one_with_all() {
        let small = [[4.0, 1.0], [5.0, 1.0]];
        let near = seen(ALL, small, Zoom::Auto, None).unwrap();
        assert!((near[0][0] - 3.4).abs() < 1e-12 && (near[1][0] - 5.6).abs() < 1e-12);
        let large = [[1.0, 1.0], [9.0, 1.0]];
        assert_eq!(seen(ALL, large, Zoom::Auto, None).unwrap(), ALL);
        assert_eq!(seen(ALL, small, Zoom::Whole, None).unwrap(), ALL);
        assert!(
            seen(ALL, EMPTY_BOX, Zoom::Contact, None)
                .unwrap_err()
                .contains("nothing presses")
        );
        let at = Some([1.0, 1.0, 0.0]);
        assert_eq!(
            seen(ALL, EMPTY_BOX, Zoom::Times(2.0), at).unwrap(),
            [[-1.5, 0.0], [3.5, 2.0]]
        );
        assert_eq!(
            seen(ALL, EMPTY_BOX, Zoom::Auto, at).unwrap(),
            [[-0.25, 0.5], [2.25, 1.5]]
        );
    }
}
