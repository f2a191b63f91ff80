//! Rigid obstacles as lines: they have no cells, and a body that touches nothing in the picture would be a riddle.

use stickslip::contact::obstacle::Motion;
use stickslip::problem::Obstacle;

use crate::skin::Skin;

type Vec3 = [f64; 3];

/// Lines on an obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Points on it, where it is without its motion `[length]`.
    points: Vec<Vec3>,
    /// Lines between them.
    pub lines: Vec<[u32; 2]>,
    motion: Option<Motion>,
}

impl Outline {
    /// Its points at a time.
    pub fn at(&self, time: f64) -> Vec<Vec3> {
        match &self.motion {
            None => self.points.clone(),
            Some(motion) => {
                let pose = motion.pose(time);
                self.points.iter().map(|x| pose.outward(*x)).collect()
            }
        }
    }

    /// Whether it moves.
    pub fn moves(&self) -> bool {
        self.motion.is_some()
    }
}

/// Outlines of the obstacles of a problem: the parts that are near the bodies. Whatever the shape, they are the feet of lines around
/// the bodies. An obstacle that this version does not know is passed over.
pub fn outlines(problem: &toml::Table, skin: &Skin) -> Vec<Outline> {
    let Some(table) = problem.get("obstacle").and_then(toml::Value::as_table) else {
        return Vec::new();
    };
    let around = around(skin);
    let known = table.values().filter_map(|value| {
        let obstacle: Obstacle = value.clone().try_into().ok()?;
        let mut outline = Outline {
            points: Vec::new(),
            lines: Vec::new(),
            motion: obstacle.motion,
        };
        // Where the bodies are at first, seen from the obstacle.
        let pose = outline.motion.as_ref().map(|m| m.pose(0.0));
        let inward = |x: Vec3| pose.map_or(x, |p| p.inward(x));
        for line in &around {
            let mut last: Option<(Vec3, Vec3)> = None;
            for &x in line {
                let x = inward(x);
                let foot = obstacle.shape.as_dyn().foot(x).map(|f| f.point);
                if let Some(foot) = foot {
                    let next = outline.points.len() as u32;
                    outline.points.push(foot);
                    // Neighbours whose feet are far apart are on different sides.
                    let near = |(x0, f0): (Vec3, Vec3)| distance(foot, f0) <= 2.5 * distance(x, x0);
                    if last.is_some_and(near) {
                        outline.lines.push([next - 1, next]);
                    }
                    last = Some((x, foot));
                } else {
                    last = None;
                }
            }
        }
        Some(outline)
    });
    known.collect()
}

fn distance(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
}

/// Lines around the bodies: the rim of a rectangle, or grids on the sides of a box.
fn around(skin: &Skin) -> Vec<Vec<Vec3>> {
    let [low, high] = skin.bounds();
    let middle = [0, 1, 2].map(|c| (low[c] + high[c]) / 2.0);
    // Bodies that are flat in a direction get a box all the same.
    // The box around the bodies is made larger by a fifth before it is projected.
    let half = [0, 1, 2].map(|c| 1.2 * ((high[c] - low[c]) / 2.0).max(0.1 * skin.size()));
    // Coordinates from -1 to 1 within the box.
    let at = |x: Vec3| [0, 1, 2].map(|c| middle[c] + half[c] * x[c]);
    let steps = |n: usize| (0..=n).map(move |i| 2.0 * i as f64 / n as f64 - 1.0);
    let mut lines = Vec::new();
    if skin.dim == 2 {
        for side in [-1.0, 1.0] {
            lines.push(steps(48).map(|s| at([s, side, 0.0])).collect());
            lines.push(steps(48).map(|s| at([side, s, 0.0])).collect());
        }
        // In a plane problem the third coordinate is zero, whatever the box.
        for x in lines.iter_mut().flat_map(|line: &mut Vec<Vec3>| line) {
            x[2] = 0.0;
        }
        return lines;
    }
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for across in steps(8) {
                for swap in [1, 2] {
                    let line = steps(16).map(|s| {
                        let mut x = [0.0; 3];
                        x[axis] = side;
                        x[(axis + swap) % 3] = across;
                        x[(axis + 3 - swap) % 3] = s;
                        at(x)
                    });
                    lines.push(line.collect());
                }
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skin(dim: usize) -> Skin {
        let z = if dim == 3 { 2.0 } else { 0.0 };
        Skin {
            dim,
            positions: vec![[0.0, 0.0, 0.0], [4.0, 2.0, z]],
            ..Skin::default()
        }
    }

    fn outline(text: &str, dim: usize) -> Outline {
        let problem: toml::Table = text.parse().unwrap();
        let mut all = outlines(&problem, &skin(dim));
        assert_eq!(all.len(), 1);
        all.remove(0)
    }

    #[test]
    fn a_plane_is_a_line_under_the_bodies_and_moves_with_its_table() {
        let still = outline(
            "obstacle.floor.plane = { point = [0, -1], normal = [0, 1] }",
            2,
        );
        let points = still.at(3.0);
        assert!(
            points
                .iter()
                .all(|x| (x[1] + 1.0).abs() < 1e-12 && x[2] == 0.0)
        );
        assert!(points.iter().any(|x| x[0] < 0.0) && points.iter().any(|x| x[0] > 4.0));
        assert!(!still.moves() && still.lines.len() > 40);
        let moving = outline(
            "obstacle.floor = { plane = { point = [0, -1], normal = [0, 1] }, motion.translation = [[0, 0, 0], [1, 0, 0.5]] }",
            2,
        );
        assert!(moving.at(1.0).iter().all(|x| (x[1] + 0.5).abs() < 1e-12));
    }

    #[test]
    fn points_are_on_the_shape_and_what_is_not_known_is_passed_over() {
        let ball = outline(
            "obstacle.ball.sphere = { centre = [2, 1, 3], radius = 0.5 }",
            3,
        );
        for x in ball.at(0.0) {
            assert!((distance(x, [2.0, 1.0, 3.0]) - 0.5).abs() < 1e-12);
        }
        assert!(!ball.lines.is_empty());
        let strange: toml::Table = "obstacle.x.cube = { side = 1 }".parse().unwrap();
        assert!(outlines(&strange, &skin(3)).is_empty());
    }
}
