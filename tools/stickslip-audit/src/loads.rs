//! External forces on the nodes at a time, and those of springs: by own integrals over cells and facets.

use toml::Table;

use crate::case::{Case, kind, number, text_of, vector};
use crate::cell;
use crate::element::Kind;
use crate::mesh::{Facet, Mesh};
use crate::vec3::{Vec3, add, along, cross, dot, norm, scale, sub};

/// Forces of one load at factor 1, by node.
pub fn forces(
    case: &Case,
    mesh: &Mesh,
    load: &Table,
    density: &dyn Fn(usize) -> f64,
) -> Option<Vec<Vec3>> {
    let set = mesh.set(case, text_of(load, "set")?)?;
    let mut out = vec![[0.0; 3]; mesh.points.len()];
    if let Some((name, keys)) = ["traction", "pressure", "nodal-force"]
        .into_iter()
        .find_map(|name| Some((name, load.get(name)?.as_table()?)))
    {
        let value = vector(keys, "value");
        match name {
            "nodal-force" => set.iter().for_each(|p| out[*p] = value),
            _ => {
                let pressure = (name == "pressure").then(|| number(keys, "value").unwrap_or(0.0));
                for facet in mesh.facets_of(&set) {
                    add_facet(case, mesh, facet, value, pressure, &mut out);
                }
            }
        }
        return Some(out);
    }
    let (name, keys) = ["body-force", "gravity", "centrifugal"]
        .into_iter()
        .find_map(|name| Some((name, load.get(name)?.as_table()?)))?;
    for (i, (kind, nodes)) in mesh.cells.iter().enumerate() {
        if !nodes.iter().all(|n| set.contains(n)) {
            continue;
        }
        let x: Vec<Vec3> = nodes.iter().map(|n| mesh.points[*n]).collect();
        let rho = density(i);
        let field: Box<dyn Fn(Vec3) -> Vec3> = match name {
            "body-force" => {
                let f = vector(keys, "value");
                Box::new(move |_| f)
            }
            "gravity" => {
                let g = vector(keys, "acceleration");
                Box::new(move |_| scale(rho, g))
            }
            _ => centrifugal(case, keys, rho),
        };
        let parts = cell::spread(*kind, &x, case.space, &*field);
        for (node, part) in nodes.iter().zip(parts) {
            out[*node] = add(out[*node], part);
        }
    }
    Some(out)
}

fn centrifugal(case: &Case, keys: &Table, rho: f64) -> Box<dyn Fn(Vec3) -> Vec3> {
    let square = number(keys, "speed").unwrap_or(0.0).powi(2);
    if case.space == crate::case::Space::Ring {
        return Box::new(move |x| [rho * square * x[0], 0.0, 0.0]);
    }
    let point = vector(keys, "point");
    let axis = match case.space.dim() {
        2 => [0.0, 0.0, 1.0],
        _ => crate::vec3::unit(vector(keys, "axis")),
    };
    Box::new(move |x| {
        let arm = sub(x, point);
        scale(rho * square, along(arm, -dot(arm, axis), axis))
    })
}

/// Normal of a facet times its element of area, without direction.
pub fn stretch(kind: Kind, x: &[Vec3], xi: [f64; 3]) -> Vec3 {
    let d = kind.gradients(xi);
    let tangent = |k: usize| -> Vec3 {
        std::array::from_fn(|i| x.iter().zip(&d).map(|(x, d)| x[i] * d[k]).sum())
    };
    match kind.dim() {
        1 => {
            let t = tangent(0);
            [t[1], -t[0], 0.0]
        }
        _ => cross(tangent(0), tangent(1)),
    }
}

/// The place at reference coordinates.
pub fn place(kind: Kind, x: &[Vec3], xi: [f64; 3]) -> Vec3 {
    let n = kind.values(xi);
    std::array::from_fn(|i| n.iter().zip(x).map(|(n, x)| n * x[i]).sum())
}

/// 1 where the normal of [`stretch`] points out of the cell beneath, -1 where it points into it.
pub fn sense(mesh: &Mesh, facet: &Facet, at: &[Vec3]) -> f64 {
    let x: Vec<Vec3> = facet.nodes.iter().map(|n| at[*n]).collect();
    let cell = &mesh.cells[facet.cell].1;
    let sum = cell.iter().fold([0.0; 3], |sum, n| add(sum, at[*n]));
    let inside = scale(1.0 / cell.len() as f64, sum);
    let middle = facet.kind.middle();
    let out = sub(place(facet.kind, &x, middle), inside);
    dot(out, stretch(facet.kind, &x, middle)).signum()
}

fn add_facet(
    case: &Case,
    mesh: &Mesh,
    facet: &Facet,
    traction: Vec3,
    pressure: Option<f64>,
    out: &mut [Vec3],
) {
    let x: Vec<Vec3> = facet.nodes.iter().map(|n| mesh.points[*n]).collect();
    let sense = sense(mesh, facet, &mesh.points);
    for (xi, weight) in facet.kind.fine_rule() {
        let normal = scale(sense, stretch(facet.kind, &x, xi));
        let extent = weight * case.space.extent(place(facet.kind, &x, xi));
        let force = match pressure {
            Some(p) => scale(-p * extent, normal),
            None => scale(norm(normal) * extent, traction),
        };
        for (node, n) in facet.nodes.iter().zip(facet.kind.values(xi)) {
            out[*node] = along(out[*node], n, force);
        }
    }
}

/// One row of springs or equations: dofs (node, direction) and factors.
pub type Row = Vec<((usize, usize), f64)>;

/// A coupling: its rows, its stiffness if it is a spring, and the value of its equations.
pub struct Coupling {
    /// Name.
    pub name: String,
    /// Rows.
    pub rows: Vec<Row>,
    /// Stiffness of a spring.
    pub stiffness: Option<f64>,
    /// Value of an equation.
    pub value: f64,
}

/// Springs of loads: nodes and stiffnesses along the axes.
pub fn grounded(case: &Case, mesh: &Mesh, load: &Table) -> Option<Vec<((usize, usize), f64)>> {
    let keys = load.get("spring")?.as_table()?;
    let set = mesh.set(case, text_of(load, "set")?)?;
    let k = vector(keys, "stiffness");
    let entries = set
        .iter()
        .flat_map(|p| (0..case.space.dim()).map(move |i| ((*p, i), k[i])));
    Some(entries.collect())
}

/// All couplings of a case; `None` for one whose points are not known here.
pub fn couplings(case: &Case, mesh: &Mesh) -> Vec<Option<Coupling>> {
    let read = |(name, table): (&str, &Table)| {
        let (kind_name, keys) = ["equation", "spring"]
            .into_iter()
            .find_map(|k| Some((k, table.get(k)?.as_table()?)))?;
        let mut terms = Vec::new();
        for term in keys.get("terms")?.as_array()? {
            let term = term.as_table()?;
            let set = mesh.set(case, text_of(term, "set")?)?;
            let axis = ["x", "y", "z"]
                .iter()
                .position(|c| Some(*c) == text_of(term, "component"))?;
            let points: Vec<usize> = set.into_iter().collect();
            terms.push((points, axis, number(term, "factor").unwrap_or(1.0)));
        }
        let count = terms.iter().map(|t| t.0.len()).max()?;
        // A set of one point pairs with all, itself left out.
        let single: Vec<usize> = terms
            .iter()
            .filter(|t| t.0.len() == 1)
            .map(|t| t.0[0])
            .collect();
        let mut sets: Vec<Vec<usize>> = terms.iter().map(|t| t.0.clone()).collect();
        if count > 1 {
            for set in sets.iter_mut().filter(|s| s.len() > 1) {
                set.retain(|p| !single.contains(p));
            }
        }
        let count = sets.iter().map(Vec::len).max()?;
        let rows = (0..count).map(|i| {
            let entry = |(set, (_, axis, factor)): (&Vec<usize>, &(Vec<usize>, usize, f64))| {
                let point = if set.len() == 1 { set[0] } else { set[i] };
                ((point, *axis), *factor)
            };
            sets.iter().zip(&terms).map(entry).collect()
        });
        Some(Coupling {
            name: name.to_string(),
            rows: rows.collect(),
            stiffness: (kind_name == "spring").then(|| number(keys, "stiffness").unwrap_or(0.0)),
            value: number(keys, "value").unwrap_or(0.0),
        })
    };
    case.named("coupling").into_iter().map(read).collect()
}

/// The kind of a table that names one, for messages.
pub fn kind_of(load: &Table) -> &str {
    let kinds = [
        "traction",
        "pressure",
        "body-force",
        "gravity",
        "centrifugal",
        "nodal-force",
        "spring",
    ];
    let found = kinds.into_iter().find(|k| load.contains_key(*k));
    found.or(kind(load, "").map(|k| k.0)).unwrap_or("load")
}
