//! Supports and loads as symbols, from the problem that was run, and the outline of the bodies before any displacement.

use std::collections::BTreeMap;
use std::path::Path;

use stickslip::math::cross;
use stickslip::model::Setup;
use stickslip::problem::Problem;

use super::camera::unit;
use super::marks::{Drawn, arrow};
use super::words::{INK, SOFT};
use crate::colour::Rgb;
use crate::draw::{Anchor, Canvas, text_width};
use crate::results::Results;
use crate::skin::Skin;

type Vec3 = [f64; 3];

/// What a symbol stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A displacement that is held.
    Held,
    /// A displacement that is prescribed.
    Prescribed,
    /// A force.
    Load,
}

/// What each kind is called, and its ink.
const SYMBOL_KINDS: [(Kind, &str, Rgb); 3] = [
    (Kind::Held, "held", [47, 110, 79]),
    (Kind::Prescribed, "prescribed displacement", [117, 79, 160]),
    (Kind::Load, "load", [178, 24, 43]),
];

/// A support or a load at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symbol {
    /// What it stands for.
    pub kind: Kind,
    /// The point of the mesh; none for a reference point.
    pub point: Option<usize>,
    /// Where it is without displacements `[length]`.
    pub place: Vec3,
    /// Along the axis that is held, or the displacement at its end, or the force.
    pub vector: Vec3,
}

/// How much acts.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Acts {
    /// How many displacements are held.
    pub held: usize,
    /// How many displacements are prescribed.
    pub prescribed: usize,
    /// The sum of all loads `[force]`.
    pub force: [f64; 3],
}

impl Acts {
    /// Of symbols.
    pub fn of(symbols: &[Symbol]) -> Self {
        let count = |kind: Kind| symbols.iter().filter(|s| s.kind == kind).count();
        let loads = symbols.iter().filter(|s| s.kind == Kind::Load);
        let force = loads.fold([0.0; 3], |sum, s| [0, 1, 2].map(|c| sum[c] + s.vector[c]));
        Acts {
            held: count(Kind::Held),
            prescribed: count(Kind::Prescribed),
            force,
        }
    }
}

/// Supports and loads of a problem.
pub struct Acting {
    setup: Setup,
}

impl Acting {
    /// Builds the problem of results whose fields have this many points. Mesh files are looked for beside the folder of the results, and in it.
    pub fn read(results: &Results, points: usize) -> Result<Self, String> {
        let sorry = |why: String| format!("supports and loads are not drawn: {why}");
        let problem = Problem::from_toml(&results.problem_text, None)
            .map_err(|e| sorry(format!("the problem cannot be read: {e}")))?;
        let folder = results.directory.canonicalize();
        let folder = folder.unwrap_or_else(|_| results.directory.clone());
        let beside = folder.parent().unwrap_or(Path::new(""));
        let built = problem
            .build(beside)
            .or_else(|e| problem.build(&folder).map_err(|_| e));
        let setup = built.map_err(|e| sorry(e.to_string().lines().next().unwrap_or("").into()))?;
        match setup.model.mesh.points.len() == points {
            true => Ok(Acting { setup }),
            false => Err(sorry(
                "the fields have other points than the problem".into(),
            )),
        }
    }

    /// What acts at a time.
    pub fn at(&self, t: f64) -> Vec<Symbol> {
        let model = &self.setup.model;
        let dofs = model.dofs;
        let centres = model
            .links
            .all()
            .iter()
            .map(|link| (link.hidden, link.centre));
        let centres: BTreeMap<usize, Vec3> = centres.collect();
        let place = |point: usize| match model.mesh.points.get(point) {
            Some(x) => Some((Some(point), *x)),
            // Of rigid bodies and reference points the second hidden point has the rotations.
            None => centres.get(&point).map(|x| (None, *x)),
        };
        let mut all = Vec::new();
        for support in model
            .actions
            .supports
            .iter()
            .filter(|s| s.schedule.active(t))
        {
            for entry in &support.entries {
                let (point, component) = dofs.locate(entry.dof);
                let Some((point, place)) = place(point) else {
                    continue;
                };
                let held = entry.hold || entry.value == 0.0;
                let mut vector = [0.0; 3];
                vector[component] = if held { 1.0 } else { entry.value };
                let kind = if held { Kind::Held } else { Kind::Prescribed };
                all.push(Symbol {
                    kind,
                    point,
                    place,
                    vector,
                });
            }
        }
        let mut forces = vec![0.0; dofs.count()];
        for load in &model.actions.loads {
            load.external(t, &mut forces);
        }
        for point in 0..dofs.points {
            let vector = dofs.vector(&forces, point);
            if let Some((point, place)) = place(point).filter(|_| vector != [0.0; 3]) {
                let kind = Kind::Load;
                all.push(Symbol {
                    kind,
                    point,
                    place,
                    vector,
                });
            }
        }
        all
    }
}

/// The edges of the bodies at which faces meet at an angle, or end.
pub fn outline(skin: &Skin) -> Vec<[u32; 2]> {
    if skin.dim == 2 {
        return skin.rim.clone();
    }
    // The cosine of 30 degrees.
    const SHARP: f64 = 0.866;
    let mut edges: BTreeMap<[u32; 2], Vec<Vec3>> = BTreeMap::new();
    for t in &skin.triangles {
        let [a, b, c] = t.map(|i| skin.positions[i as usize]);
        let from = |x: Vec3| [0, 1, 2].map(|k| x[k] - a[k]);
        let normal = unit(cross(from(b), from(c)));
        for k in 0..3 {
            let (i, j) = (t[k], t[(k + 1) % 3]);
            edges.entry([i.min(j), i.max(j)]).or_default().push(normal);
        }
    }
    let smooth = |normals: &[Vec3]| match normals {
        [a, b] => (0..3).map(|k| a[k] * b[k]).sum::<f64>() > SHARP,
        _ => false,
    };
    let sharp = edges.into_iter().filter(|(_, normals)| !smooth(normals));
    sharp.map(|(edge, _)| edge).collect()
}

/// Draws symbols where they are given, those that would lie over others of their kind left out. `sign`: at which side of a point a support stands, by axis.
pub fn draw(
    symbols: &[(Symbol, Vec3)],
    sign: &dyn Fn(&Symbol) -> f64,
    drawn: &Drawn,
    canvas: &mut dyn Canvas,
) {
    let em = drawn.em;
    let size = |v: Vec3| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let loads = symbols.iter().filter(|(s, _)| s.kind == Kind::Load);
    let most = loads.map(|(s, _)| size(s.vector)).fold(0.0, f64::max);
    let mut taken: Vec<(Kind, Vec3, [f64; 2])> = Vec::new();
    for (symbol, x) in symbols {
        let Some(p) = drawn.place(*x) else {
            continue;
        };
        let way = unit(symbol.vector);
        let near = |(kind, other, q): &(Kind, Vec3, [f64; 2])| {
            let same = *kind == symbol.kind && (*kind == Kind::Load || *other == way);
            same && (q[0] - p[0]).hypot(q[1] - p[1]) < 1.5 * em
        };
        let small = symbol.kind == Kind::Load && size(symbol.vector) < 0.05 * most;
        if small || taken.iter().any(near) {
            continue;
        }
        taken.push((symbol.kind, way, p));
        let Some((_, _, ink)) = SYMBOL_KINDS.iter().find(|k| k.0 == symbol.kind) else {
            continue;
        };
        let d = drawn.towards(way);
        match symbol.kind {
            Kind::Load => {
                let long = 1.5 * em + 2.5 * em * size(symbol.vector) / most;
                arrow(
                    [p[0] - long * d[0], p[1] - long * d[1]],
                    p,
                    *ink,
                    em,
                    canvas,
                );
            }
            Kind::Prescribed => {
                let end = [p[0] + 2.2 * em * d[0], p[1] + 2.2 * em * d[1]];
                arrow(p, end, *ink, em, canvas);
            }
            Kind::Held => triangle(p, d.map(|v| v * sign(symbol)), *ink, em, canvas),
        }
    }
    keys(symbols, drawn, canvas);
}

/// A triangle with its tip at a point, that stands off along a direction.
fn triangle(p: [f64; 2], d: [f64; 2], ink: Rgb, em: f64, canvas: &mut dyn Canvas) {
    // Along the eye it would be a line.
    let length = d[0].hypot(d[1]);
    let [x, y] = if length > 0.2 {
        d.map(|v| v / length)
    } else {
        [0.0, 1.0]
    };
    let foot = [p[0] + 0.95 * em * x, p[1] + 0.95 * em * y];
    let side = |s: f64| [foot[0] - s * 0.5 * em * y, foot[1] + s * 0.5 * em * x];
    canvas.fill(&[p, side(1.0), side(-1.0)], ink);
}

/// What the symbols mean, below the drawing.
fn keys(symbols: &[(Symbol, Vec3)], drawn: &Drawn, canvas: &mut dyn Canvas) {
    let em = drawn.em;
    let y = drawn.at[1] + drawn.area[1] + 1.6 * em;
    let mut x = drawn.at[0] + 6.0 * em;
    for (kind, words, ink) in SYMBOL_KINDS {
        if symbols.iter().all(|(s, _)| s.kind != kind) {
            continue;
        }
        match kind {
            Kind::Held => triangle([x + 0.5 * em, y - 0.9 * em], [0.0, 1.0], ink, em, canvas),
            _ => arrow(
                [x - 0.7 * em, y - 0.4 * em],
                [x + em, y - 0.4 * em],
                ink,
                em,
                canvas,
            ),
        }
        canvas.text(
            [x + 1.5 * em, y],
            words,
            0.9 * em,
            Anchor::Start,
            INK,
            false,
        );
        x += text_width(words, 0.9 * em) + 4.0 * em;
    }
    canvas.text(
        [x, y],
        "grey lines: undeformed",
        0.9 * em,
        Anchor::Start,
        SOFT,
        false,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_has_twelve_edges_and_a_sheet_four() {
        let square = |z: f64| [[0., 0., z], [1., 0., z], [1., 1., z], [0., 1., z]];
        let faces = [
            [0, 3, 2, 1],
            [4, 5, 6, 7],
            [0, 1, 5, 4],
            [1, 2, 6, 5],
            [2, 3, 7, 6],
            [3, 0, 4, 7],
        ];
        let skin = |faces: &[[u32; 4]]| Skin {
            dim: 3,
            positions: [square(0.0), square(1.0)].concat(),
            triangles: (faces.iter())
                .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
                .collect(),
            ..Skin::default()
        };
        assert_eq!(outline(&skin(&faces)).len(), 12);
        assert_eq!(outline(&skin(&faces[..1])).len(), 4);
    }
}
