//! What the points of an interface carry: cone, complementarity, law, action and reaction.

use std::collections::{BTreeMap, BTreeSet};

use crate::figure::Report;
use crate::law::{Laws, Rubbing, laws, limit, pressure, smooth};
use crate::results::{Before, Results, State};
use crate::side::{Pair, Side};
use crate::vec3::{Vec3, add, norm, sub};

/// Speeds that are tried where any may be, down to 1e-16 of what an increment makes of the largest slip: the scale of a law may be that of slower steps.
const SPEEDS: i32 = 125;

/// What a point carries at a time.
#[derive(Debug, Clone, Copy, Default)]
pub struct Point {
    /// Pressure.
    pub pressure: f64,
    /// Shear along the two output directions.
    pub shear: [f64; 2],
    /// Gap.
    pub gap: f64,
    /// Accumulated slip along the same.
    pub slip: [f64; 2],
    /// 0 open, 1 stick, 2 slip.
    pub status: f64,
}

impl Point {
    /// Size of the shear.
    pub fn carried(&self) -> f64 {
        self.shear[0].hypot(self.shear[1])
    }
}

/// The points of an interface whose values stand at nodes: no other point contributes to those.
pub fn points(results: &Results, pair: &Pair) -> Vec<usize> {
    let (Some(table), Some(last)) = (results.tables.get(&pair.name), results.states.last()) else {
        return Vec::new();
    };
    let Some(own) = pair.points() else {
        return Vec::new();
    };
    let ids: BTreeMap<u64, usize> = match last.grid.fields.get("NODE_ID") {
        Some(ids) => ids
            .iter()
            .enumerate()
            .map(|(p, id)| (*id as u64, p))
            .collect(),
        None => BTreeMap::new(),
    };
    let mut shared = BTreeSet::new();
    for (name, other) in results.case.named("interface") {
        for side in ["secondary", "primary"] {
            let set = other.get(side).and_then(toml::Value::as_str);
            let set = set
                .and_then(|s| results.mesh.set(&results.case, s))
                .unwrap_or_default();
            let checked = match pair.exchanged {
                true => "primary",
                false => "secondary",
            };
            if name != pair.name || side != checked {
                shared.extend(set);
            }
        }
    }
    let (names, values) = (table.column("node").unwrap_or(&[]), at(last));
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (row, id) in names.iter().enumerate().filter(|(_, id)| !id.is_nan()) {
        // Numbers of nodes may repeat in several bodies: the place decides.
        let here = |p: &usize| {
            let x = results.mesh.points[*p];
            let y = ["x", "y", "z"].map(|h| table.at(h, row));
            norm(crate::vec3::sub(x, y)) <= 1e-9 * results.mesh.size(None)
        };
        let by_id = ids.get(&(*id as u64)).copied().filter(here);
        let node = by_id.or_else(|| own.iter().copied().find(here));
        if let Some(node) = node {
            rows.entry(node).or_default().push(row);
        }
    }
    let same =
        |a: f64, b: f64, most: f64| (a - b).abs() <= 1e-9 * most || (a.is_nan() && b.is_nan());
    let most = |head: &str| {
        let column = table.column(head).unwrap_or(&[]).iter();
        column
            .filter(|v| v.is_finite())
            .fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    };
    let (pressures, gaps) = (most("CPRESS"), most("COPEN"));
    let alone = |node: &usize, rows: &Vec<usize>| {
        let (point, row): (&Point, usize) = (&values[*node], rows[0]);
        rows.len() == 1
            && own.contains(node)
            && !shared.contains(node)
            && same(point.pressure, table.at("CPRESS", row), pressures)
            && same(point.gap, table.at("COPEN", row), gaps)
    };
    rows.iter()
        .filter(|(n, r)| alone(n, r))
        .map(|(n, _)| *n)
        .collect()
}

/// The values of all nodes of a state.
pub fn at(state: &State) -> Vec<Point> {
    let field = |name: &str| state.grid.scalar(name);
    let (p, g, s) = (field("CPRESS"), field("COPEN"), field("CSTATUS"));
    let shear = [field("CSHEAR1"), field("CSHEAR2")];
    let slip = [field("CSLIP1"), field("CSLIP2")];
    let some = |x: f64| if x.is_nan() { 0.0 } else { x };
    let point = |i: usize| Point {
        pressure: p[i],
        shear: [some(shear[0][i]), some(shear[1][i])],
        gap: g[i],
        slip: [some(slip[0][i]), some(slip[1][i])],
        status: s[i],
    };
    (0..p.len()).map(point).collect()
}

/// What pressures, limits and gaps of an interface are compared with.
pub struct Scale {
    /// Largest pressure of the run.
    pub pressure: f64,
    /// Largest shear limit of the run.
    pub limit: f64,
    /// Elastic approach: twice the strain energy over the contact force.
    pub approach: f64,
    /// Largest slip.
    pub slip: f64,
}

/// Checks what the points of an interface carry.
pub fn check(results: &Results, pair: &Pair, scale: &Scale, report: &mut Report) {
    let nodes = points(results, pair);
    let name = pair.name.as_str();
    if nodes.is_empty() && !pair.tied {
        report.skip(format!(
            "points of {name} that are no nodes, but for the last state"
        ));
    }
    let mut old: Option<(&State, Vec<Point>)> = None;
    for (i, state) in results.states.iter().enumerate() {
        let step = results.case.step_at(state.t);
        let now = at(state);
        if let (Some(laws), false) = (laws(&results.case, name, step), pair.tied) {
            let before = results.before(i);
            let before = before.map(|b| match b {
                Before::Written(_) => old.as_ref().map(|o| o.1.clone()).unwrap_or_default(),
                Before::Start => vec![Point::default(); now.len()],
            });
            let dt = results.at("DT", state);
            let inertia = results.case.steps[step].dynamic();
            let turn = turned(results, i);
            // In explicit steps it is springs that hold them.
            let springs = results.case.steps[step].explicit();
            let hard = laws.normal.name == "unilateral" && !springs;
            if hard && !pair.damped && !pair.two_sided {
                let depths = nodes.iter().filter(|n| now[**n].pressure > 0.0);
                let deepest = depths.fold(0.0_f64, |m, n| m.max(-now[*n].gap));
                report.note("yielding", name, deepest / scale.approach, state.t);
            }
            let increment = Increment {
                t: state.t,
                dt,
                inertia,
                turn,
                springs,
            };
            for node in &nodes {
                let last = before.as_ref().map(|b| b[*node]);
                one(&laws, &now[*node], last, &increment, pair, scale, report);
            }
        }
        old = Some((state, now));
    }
    if let (Some(table), Some(state), false) =
        (results.tables.get(name), results.states.last(), pair.tied)
    {
        let step = results.case.step_at(state.t);
        let Some(laws) = laws(&results.case, name, step) else {
            return;
        };
        let springs = results.case.steps[step].explicit();
        let increment = Increment {
            t: state.t,
            dt: results.at("DT", state),
            inertia: true,
            turn: 0.0,
            springs,
        };
        for row in 0..table.rows() {
            let of = |head: &str| table.at(head, row);
            let point = Point {
                pressure: of("CPRESS"),
                shear: [of("CSHEAR1"), of("CSHEAR2")],
                gap: of("COPEN"),
                slip: [of("CSLIP1"), of("CSLIP2")],
                status: of("CSTATUS"),
            };
            one(&laws, &point, None, &increment, pair, scale, report);
        }
    }
}

/// How far surfaces can have turned over the increment before a state: the largest change along the side of a cell. Nothing in the plane, where the
/// direction along a line does not turn the slip that is a length on it.
fn turned(results: &Results, i: usize) -> f64 {
    let Some(Before::Written(old)) = results.before(i).filter(|_| results.case.space.dim() == 3)
    else {
        return 0.0;
    };
    let (now, mesh) = (&results.states[i], &results.mesh);
    let moved = |n: usize| sub(now.u[n], old.u[n]);
    let sides = mesh.cells.iter().flat_map(|(_, nodes)| nodes.windows(2));
    let turns = sides.map(|side| {
        let (a, b) = (side[0], side[1]);
        norm(sub(moved(a), moved(b))) / norm(sub(mesh.points[a], mesh.points[b]))
    });
    turns.fold(0.0, f64::max)
}

/// An increment, as far as laws depend on it.
struct Increment {
    /// Its end, and its length.
    t: f64,
    dt: f64,
    /// Masses have a part in it.
    inertia: bool,
    /// How far surfaces may have turned.
    turn: f64,
    /// Springs press.
    springs: bool,
}

/// One point at one time. Without a state before only the bounds that hold at any speed are asked. Springs press where surfaces are about to part, as far as they give way.
fn one(
    laws: &Laws,
    point: &Point,
    last: Option<Point>,
    increment: &Increment,
    pair: &Pair,
    scale: &Scale,
    report: &mut Report,
) {
    let Increment {
        t,
        dt,
        inertia,
        turn,
        springs,
    } = *increment;
    let name = pair.name.as_str();
    if point.pressure.is_nan() {
        return;
    }
    let p = point.pressure.max(0.0);
    report.note("tension", name, -point.pressure / scale.pressure, t);
    // Over nothing a point has no gap, and must not carry anything.
    let open = match point.gap.is_finite() {
        true => point.gap,
        false => f64::MAX,
    };
    if laws.normal.name == "unilateral" {
        // A dashpot may press before surfaces touch.
        let product = p / scale.pressure * open.max(0.0) / scale.approach;
        if !pair.damped && !pair.two_sided && !springs {
            report.note("complementarity", name, product, t);
        }
    } else if let (Some(law), false) = (
        pressure(laws.normal, open),
        // Each of two sides has a half of the pressure.
        pair.damped || pair.two_sided,
    ) {
        report.note("law", name, (p - law).abs() / scale.pressure, t);
    }
    // What had nothing opposite has slipped since it has.
    let last = last.filter(|l| !l.pressure.is_nan());
    let moved = last.map(|l| (point.slip[0] - l.slip[0]).hypot(point.slip[1] - l.slip[1]));
    let slid = last.is_some_and(|l| l.status == 2.0);
    let depth = (-open).max(0.0);
    // In motion the law sees the velocity at the end of the increment, which the files have not: any speed may be.
    // Slip is written in directions that turn with the surface: with them all that has been slipped so far turns.
    let swung = last.map_or(0.0, |l| turn * l.slip[0].hypot(l.slip[1]));
    let speeds: Vec<f64> = match (moved, inertia) {
        (Some(moved), false) if dt > 0.0 => {
            vec![
                (moved - swung).max(0.0) / dt,
                moved / dt,
                (moved + swung) / dt,
            ]
        }
        _ => {
            let top = scale.slip / dt.max(1e-300);
            [0.0]
                .into_iter()
                .chain((0..SPEEDS).map(|k| top * 0.7f64.powi(k - 20)))
                .collect()
        }
    };
    let mut bounds = [f64::INFINITY, 0.0f64];
    for speed in speeds {
        for slid in if last.is_some() {
            vec![slid]
        } else {
            vec![false, true]
        } {
            let at = Rubbing {
                pressure: p,
                depth,
                speed,
                slid,
            };
            let Some(most) = limit(laws.friction, at) else {
                return;
            };
            bounds = [bounds[0].min(most), bounds[1].max(most)];
        }
    }
    let carried = point.carried();
    if bounds[1] == 0.0 || scale.limit == 0.0 {
        if bounds[1] < carried {
            report.note("cone", name, carried / scale.pressure, t);
        }
        return;
    }
    report.note("cone", name, (carried - bounds[1]) / scale.limit, t);
    let Some(moved) = moved.filter(|_| !inertia && dt > 0.0) else {
        if point.status == 2.0 && laws.epsilon.is_none() {
            // The least of the speeds that were tried is not quite the least.
            report.note(
                "mobilised",
                name,
                (0.98 * bounds[0] - carried) / scale.limit,
                t,
            );
        }
        return;
    };
    match laws.epsilon {
        Some(epsilon) => {
            let due = |bound: f64, moved: f64| bound * smooth(epsilon, moved / dt);
            let least = due(bounds[0], (moved - swung).max(0.0));
            let most = due(bounds[1], moved + swung);
            let off = (carried - most).max(least - carried).max(0.0);
            // A belt moves beneath a point that does not.
            if !pair.belt {
                report.note("mobilised", name, off / scale.limit, t);
            }
        }
        None if point.status == 2.0 => {
            report.note("mobilised", name, (bounds[0] - carried) / scale.limit, t);
        }
        None => {}
    }
}

/// The sums of CFORCE over the bodies of a pair, and the resultants of the history.
pub fn reactions(results: &Results, pairs: &[Pair], report: &mut Report) {
    let dim = results.case.space.dim();
    let mesh = &results.mesh;
    let mut rows = Vec::new();
    let mut largest = f64::MIN_POSITIVE;
    for state in &results.states {
        let force = state.grid.vector("CFORCE");
        let mut by_body = vec![[0.0; 3]; mesh.names.len()];
        let mut gross: f64 = 0.0;
        for (f, body) in force.iter().zip(&mesh.body) {
            by_body[*body] = add(by_body[*body], *f);
            gross += norm(*f);
        }
        largest = largest.max(0.5 * gross);
        rows.push((state, by_body));
    }
    if results.case.space != crate::case::Space::Ring {
        moments(results, pairs, largest, report);
    }
    for (state, by_body) in rows {
        // What the history says of each interface, added up by body.
        let mut said = vec![[0.0; 3]; mesh.names.len()];
        for pair in pairs {
            let mut names = vec![pair.name.clone()];
            if pair.two_sided {
                names.push(format!("{}-reverse", pair.name));
            }
            for (k, name) in names.iter().enumerate() {
                let sign = if (k == 0) != pair.exchanged {
                    1.0
                } else {
                    -1.0
                };
                let force: Vec3 = std::array::from_fn(|i| {
                    let of = |part: &str| results.at(&format!("{name}.{part}{}", i + 1), state);
                    if i < dim {
                        sign * (of("CFN") + of("CFS"))
                    } else {
                        0.0
                    }
                });
                let body = |side: &Side| match side {
                    Side::Body { points, .. } => points.first().map(|p| mesh.body[*p]),
                    Side::Rigid(_) => None,
                };
                if let Some(b) = body(&pair.secondary) {
                    said[b] = add(said[b], force);
                }
                if let Some(b) = body(&pair.primary) {
                    said[b] = crate::vec3::sub(said[b], force);
                }
            }
        }
        let ring = results.case.space == crate::case::Space::Ring;
        for (body, name) in mesh.names.iter().enumerate() {
            let mut rest = crate::vec3::sub(by_body[body], said[body]);
            if ring {
                rest[0] = 0.0; // radial forces all around add up to nothing
            }
            if state.row.is_some() {
                report.note("resultant", name, norm(rest) / largest, state.t);
            }
        }
        let elastic = pairs.iter().all(|p| matches!(p.primary, Side::Body { .. }));
        if elastic {
            let mut sum = by_body.iter().fold([0.0; 3], |s, f| add(s, *f));
            if ring {
                sum[0] = 0.0;
            }
            report.note(
                "action-reaction",
                "all bodies",
                norm(sum) / largest,
                state.t,
            );
        }
    }
}

/// The sum of the moments of CFORCE where all surfaces are those of bodies, of the largest resultant times the size of the smallest surface.
fn moments(results: &Results, pairs: &[Pair], largest: f64, report: &mut Report) {
    let x = &results.mesh.points;
    let mut size = f64::INFINITY;
    for pair in pairs {
        let (Some(own), Side::Body { .. }) = (pair.points(), &pair.primary) else {
            return;
        };
        let extent = (0..3).map(|c| {
            let along = own.iter().map(|p| x[*p][c]);
            let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            });
            high - low
        });
        size = size.min(extent.map(|e| e * e).sum::<f64>().sqrt());
    }
    if !(size > 0.0 && size.is_finite()) {
        return;
    }
    for state in &results.states {
        let force = state.grid.vector("CFORCE");
        let each = force.iter().zip(state.places());
        let sum = each.fold([0.0; 3], |s, (f, x)| {
            add(
                s,
                crate::vec3::cross(crate::vec3::sub(x, results.mesh.points[0]), *f),
            )
        });
        report.note(
            "moment",
            "all bodies",
            norm(sum) / (largest * size),
            state.t,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Law;

    /// In motion any speed may be, also that at which a law of a quasi-static step has its least limit.
    #[test]
    fn a_point_that_slips_slowly_carries_what_a_slow_law_says() {
        let text = "friction.stribeck = { static = 0.297, kinetic = 0.228, velocity = 1.56e-7, exponent = 1, viscous = 1.21e11 }";
        let table: toml::Table = text.parse().unwrap_or_default();
        let none = toml::Table::new();
        let laws = Laws {
            normal: Law {
                name: "linear",
                keys: &none,
            },
            friction: Law::of(&table, "friction").expect("it is given"),
            epsilon: None,
        };
        let scale = Scale {
            pressure: 1.2e6,
            limit: 0.297 * 1.2e6,
            approach: 1.0,
            slip: 7e-8,
        };
        let judge = |share: f64| {
            let mut report = Report::default();
            let point = Point {
                pressure: 1.2e6,
                shear: [share * 1.2e6, 0.0],
                status: 2.0,
                ..Point::default()
            };
            let pair = Pair::bare("joint");
            let before = Some(point);
            let increment = Increment {
                t: 1.0,
                dt: 1.1e-7,
                inertia: true,
                turn: 0.0,
                springs: false,
            };
            one(
                &laws,
                &point,
                before,
                &increment,
                &pair,
                &scale,
                &mut report,
            );
            let figure = report
                .figures()
                .find(|f| f.name == "mobilised")
                .map(|f| f.value);
            figure.unwrap_or(f64::NAN)
        };
        // The least limit over all speeds, 0.267 p, is at 2.3e-7 m/s.
        assert!(judge(0.267) < 1e-3, "{}", judge(0.267));
        assert!(judge(0.2) > 0.1, "{}", judge(0.2));
    }

    /// A point at the apex of two balls that turn by a thousandth: its slip of the increment, and of 3.9e-3 so far, is written in directions that turn as well.
    #[test]
    fn directions_that_turn_are_no_slip() {
        let table: toml::Table = "friction.coulomb = { mu = 0.0657 }"
            .parse()
            .unwrap_or_default();
        let none = toml::Table::new();
        let laws = Laws {
            normal: Law {
                name: "linear",
                keys: &none,
            },
            friction: Law::of(&table, "friction").expect("it is given"),
            epsilon: Some(7.24e-4),
        };
        let scale = Scale {
            pressure: 1500.0,
            limit: 98.5,
            approach: 1.0,
            slip: 4e-3,
        };
        let at = |slip: [f64; 2]| Point {
            pressure: 1500.38,
            shear: [-85.464, -20.433],
            slip,
            status: 1.0,
            ..Point::default()
        };
        let (before, now) = (at([3.7105e-3, -7.562e-4]), at([3.8293e-3, -7.243e-4]));
        let judge = |turn: f64| {
            let mut report = Report::default();
            let pair = Pair::bare("joint");
            let increment = Increment {
                t: 2.5,
                dt: 0.25,
                inertia: false,
                turn,
                springs: false,
            };
            let before = Some(before);
            one(&laws, &now, before, &increment, &pair, &scale, &mut report);
            let mut figures = report.figures();
            let found = figures.find(|f| f.name == "mobilised").map(|f| f.value);
            found.unwrap_or(f64::NAN)
        };
        assert!(judge(0.0) > 5e-3, "{}", judge(0.0));
        assert!(judge(1.2e-3) < 1e-9, "{}", judge(1.2e-3));
    }
}
