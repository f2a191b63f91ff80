//! Tables that others are to name, and that none does.

use std::collections::BTreeSet;

use super::super::{Problem, Select};

/// Keys of obstacles, materials, amplitudes and sets that nothing uses. All other tables act by being there.
pub(super) fn tables(problem: &Problem) -> Vec<String> {
    let bodies = problem.body.values();
    let materials = bodies.flat_map(|b| b.material.iter().chain(b.regions.values()));
    let sides = problem.interface.values();
    let obstacles = sides.map(|i| &i.primary);
    let supports = problem.support.values().map(|s| &s.amplitude);
    let loads = problem.load.values().map(|l| &l.amplitude);
    let couplings = problem.coupling.values().map(|c| &c.amplitude);
    let drawn = problem.step.iter().flat_map(|s| s.pretension.values());
    let drawn = drawn.map(|t| &t.amplitude);
    let temperatures = problem.temperature.values().map(|t| &t.amplitude);
    let amplitudes = supports.chain(loads).chain(couplings).chain(drawn);
    let amplitudes = amplitudes.chain(temperatures);
    let amplitudes = amplitudes.flatten();
    let mut out = left(problem.obstacle.keys(), "obstacle", &of(obstacles));
    out.extend(left(problem.material.keys(), "material", &of(materials)));
    out.extend(left(problem.amplitude.keys(), "amplitude", &of(amplitudes)));
    out.extend(left(problem.set.keys(), "set", &sets(problem)));
    out
}

fn of<'a>(names: impl Iterator<Item = &'a String>) -> BTreeSet<&'a str> {
    names.map(String::as_str).collect()
}

/// Names of sets that are used, those of unions too.
fn sets(problem: &Problem) -> BTreeSet<&str> {
    let mut used = of(problem.support.values().map(|s| &s.set));
    used.extend(of(problem.load.values().map(|l| &l.set)));
    used.extend(of(problem.temperature.values().map(|t| &t.set)));
    used.extend(of(problem.mass.values().map(|m| &m.set)));
    used.extend(of(problem.initial.values().map(|i| &i.set)));
    for interface in problem.interface.values() {
        used.extend([interface.primary.as_str(), interface.secondary.as_str()]);
        used.extend(interface.initial_set.as_deref());
    }
    for coupling in problem.coupling.values() {
        let named = coupling.kind.as_dyn().sets();
        used.extend(named.into_iter().map(|(_, set)| set));
    }
    for set in problem.set.values() {
        used.extend(set.of.as_deref());
        if let Select::Union(parts) = &set.select {
            used.extend(parts.iter().map(String::as_str));
        }
    }
    used
}

fn left<'a>(
    names: impl Iterator<Item = &'a String>,
    table: &str,
    used: &BTreeSet<&str>,
) -> Vec<String> {
    let unused = names.filter(|name| !used.contains(name.as_str()));
    unused.map(|name| format!("{table}.{name}")).collect()
}
