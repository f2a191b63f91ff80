//! Steps and times.

use std::collections::{BTreeMap, BTreeSet};

use super::super::key;
use super::super::nearest::suggest;
use super::super::{Cycles, Increments, Interface, Problem, Step};
use super::cycles;
use super::findings::Findings;
use crate::body::loads::LoadKind;
use crate::model::MapOver;
use crate::registry::Family;
use crate::time::scheme::Method;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    if problem.step.is_empty() {
        findings.add(&["step"], "there is no step", "add a table [[step]]");
    }
    let mut names = BTreeSet::new();
    let mut start = 0.0;
    for (i, step) in problem.step.iter().enumerate() {
        let i = key::entry(i);
        let at = |last| ["step", i.as_str(), last];
        if let Some(name) = &step.name
            && !names.insert(name)
        {
            let message = format!("there is a step `{name}` already");
            findings.add(&at("name"), message, "steps need names of their own");
        }
        let p = problem;
        listed(findings, &at("supports"), &step.supports, &p.support);
        listed(findings, &at("loads"), &step.loads, &p.load);
        listed(
            findings,
            &at("temperatures"),
            &step.temperatures,
            &p.temperature,
        );
        listed(findings, &at("interfaces"), &step.interfaces, &p.interface);
        listed(findings, &at("couplings"), &step.couplings, &p.coupling);
        // Free flight is a motion as well.
        if step.dynamic.is_none() && step.modal().is_none() && idle(problem, step) {
            findings.add(
                &["step", &i],
                "nothing acts in this step: no support, no load, no temperature, no interface, no coupling",
                "list what is active, or leave the lists out to activate all that is declared",
            );
        }
        for name in step.change.keys().filter(|n| !p.interface.contains_key(*n)) {
            let names: Vec<&str> = p.interface.keys().map(String::as_str).collect();
            let message = format!("`{name}` is not among the interfaces");
            let help = suggest(name, "interfaces", &names);
            findings.add(&["step", &i, "change", name], message, help);
        }
        increments(findings, &at("increments"), &step.increments);
        start += step.duration;
        if step.cycles.is_some() {
            let span = [start - step.duration, start];
            cycles::check(findings, &at("cycles"), problem, span);
        }
        modal(findings, &i, step);
        harmonic(findings, &i, problem, step);
        sliding(findings, &i, problem, step);
        kick(findings, &i, problem, step);
    }
    output(problem, findings);
    fatigue(problem, findings);
    slip_events(problem, findings);
}

/// Rules of steps without increments.
fn modal(findings: &mut Findings, i: &str, step: &Step) {
    let given = [
        ("modes", step.modes.is_some()),
        ("complex-modes", step.complex_modes.is_some()),
        ("harmonic", step.harmonic.is_some()),
    ];
    let mut given = given.iter().filter(|(_, given)| *given);
    let Some((key, _)) = given.next() else {
        return;
    };
    if let Some((other, _)) = given.next() {
        let message = format!("a step has `{key}` or `{other}`, not both");
        let help = "give each a step of its own: they follow each other at the same state";
        return findings.add(&["step", i, other], message, help);
    }
    let of_motion = [
        ("dynamic", step.dynamic.is_some()),
        ("cycles", step.cycles.is_some()),
        ("steady", step.steady.is_some()),
        ("increments", step.increments != Increments::default()),
        ("pretension", !step.pretension.is_empty()),
        ("change", !step.change.is_empty()),
    ];
    for (other, _) in of_motion.iter().filter(|(_, given)| *given) {
        let message =
            format!("a step with `{key}` has no motion, so `{other}` has no meaning in it");
        let help = format!("give `{other}` to a step before");
        findings.add(&["step", i, other], message, help);
    }
    if let Some(modes) = &step.modes
        && let (Some(from), Some(to)) = (modes.from, modes.to)
        && from >= to
    {
        let message = format!("`from` ({from}) is not below `to` ({to})");
        findings.add(&["step", i, key, "from"], message, "");
    }
    if let Some(map) = step.complex_modes.as_ref().and_then(|m| m.map.as_ref())
        && map.from >= map.to
    {
        let message = format!("`from` ({}) is not below `to` ({})", map.from, map.to);
        findings.add(&["step", i, key, "map", "from"], message, "");
    }
    if let Some(map) = step.complex_modes.as_ref().and_then(|m| m.map.as_ref())
        && map.over == MapOver::Speed
        && map.from <= 0.0
    {
        let message = "a map over the speed begins above 0, where sliding has a direction";
        findings.add(&["step", i, key, "map", "from"], message, "`from = 0.2`");
    }
}

/// Rules of the answer to harmonic loads.
fn harmonic(findings: &mut Findings, i: &str, problem: &Problem, step: &Step) {
    let Some(harmonic) = &step.harmonic else {
        return;
    };
    let at = |key| ["step", i, "harmonic", key];
    if harmonic.loads.is_empty() {
        let help = "name loads of the problem: `loads = [\"shaker\"]`";
        findings.add(&at("loads")[..3], "no load shakes", help);
    }
    let loads = Some(harmonic.loads.clone());
    listed(findings, &at("loads"), &loads, &problem.load);
    for (k, name) in harmonic.loads.iter().enumerate() {
        let load = problem.load.get(name);
        if load.is_some_and(|l| matches!(l.kind, LoadKind::Spring(_))) {
            let message = format!("load `{name}` is a spring, which does not shake");
            findings.add(&[&at("loads")[..], &[&key::entry(k)]].concat(), message, "");
        }
    }
    for name in harmonic
        .phases
        .keys()
        .filter(|n| !harmonic.loads.contains(n))
    {
        let message = format!("`{name}` is not among the `loads` that shake");
        findings.add(&["step", i, "harmonic", "phases", name], message, "");
    }
    let range = harmonic.to.is_some() || harmonic.from != 0.0 || harmonic.bias.is_some();
    match (harmonic.frequencies.is_empty(), harmonic.to) {
        (false, _) if range => findings.add(
            &at("frequencies"),
            "`frequencies` exclude `from`, `to`, `points` and `bias`",
            "keep one of the two",
        ),
        (true, None) => findings.add(
            &at("to")[..3],
            "the frequencies are not given",
            "`from = 10, to = 500, points = 100`, or `frequencies = [50, 60]`",
        ),
        (true, Some(to)) if harmonic.from >= to => {
            let message = format!("`from` ({}) is not below `to` ({to})", harmonic.from);
            findings.add(&at("from"), message, "");
        }
        _ => {}
    }
    if harmonic
        .frequencies
        .iter()
        .any(|f| !(f.is_finite() && *f >= 0.0))
    {
        findings.add(&at("frequencies"), "frequencies are not negative", "");
    }
    if harmonic.bias.is_some_and(|b| !(b.is_finite() && b >= 1.0)) {
        let message = "`bias` is below 1: frequencies would keep away from the modes";
        findings.add(&at("bias"), message, "`bias = 3`");
    }
    if let Some(damping) = &harmonic.damping {
        let sound = |v: &f64| v.is_finite() && *v >= 0.0;
        if !damping.ratios.iter().all(sound) || !sound(&damping.mass) || !sound(&damping.stiffness)
        {
            let message = "damping of modes is not negative";
            findings.add(&at("damping"), message, "`damping.ratios = [0.02]`");
        }
    }
    if problem.probe.is_empty() && !harmonic.shapes {
        let help = "add `[probe.NAME]`, or `shapes = true`";
        findings.add(&at("")[..3], "nothing asks for the answer", help);
    }
}

/// Rules of a motion that begins along a mode.
fn kick(findings: &mut Findings, i: &str, problem: &Problem, step: &Step) {
    let Some(kick) = &step.kick else {
        return;
    };
    let before = key::index(i).and_then(|i| i.checked_sub(1));
    let before = before.and_then(|i| problem.step.get(i));
    let count = before.and_then(|s| {
        let real = s.modes.as_ref().map(|m| m.count);
        real.or(s.complex_modes.as_ref().map(|m| m.count))
    });
    let at = ["step", i, "kick"];
    let implicit = (step.dynamic.as_ref())
        .is_some_and(|d| matches!(d.scheme.as_dyn().method(), Method::Implicit(_)));
    if !implicit {
        let message = "a step that begins along a mode moves, by an implicit scheme";
        findings.add(&at, message, "`dynamic = { scheme.newmark = {} }`");
    }
    match (count, kick.mode) {
        (None, _) => findings.add(
            &at,
            "no modes are known: the step before has to look for them",
            "put a step with `complex-modes = {}` between this one and the steady one",
        ),
        (Some(count), Some(mode)) if mode > count => findings.add(
            &["step", i, "kick", "mode"],
            format!("there is no mode {mode}: the step before looks for {count}"),
            "",
        ),
        _ => {}
    }
}

/// Rules of sliding that lasts.
fn sliding(findings: &mut Findings, i: &str, problem: &Problem, step: &Step) {
    let Some(steady) = &step.steady else {
        return;
    };
    if step.dynamic.is_some() {
        let message = "in motion surfaces slide as they move: `steady` is for quasi-static steps";
        findings.add(&["step", i, "steady"], message, "leave it out");
    }
    let dim = problem.model.space.dim();
    let velocities = steady.velocity.keys().map(|name| ("velocity", name));
    let turning = steady.turning.keys().map(|name| ("turning", name));
    for (key, name) in turning.chain(velocities) {
        if !problem.interface.contains_key(name) {
            let names: Vec<&str> = problem.interface.keys().map(String::as_str).collect();
            let message = format!("`{name}` is not among the interfaces");
            let help = suggest(name, "interfaces", &names);
            findings.add(&["step", i, "steady", key, name], message, help);
        }
    }
    for (name, velocity) in &steady.velocity {
        if velocity.len() != dim || velocity.iter().any(|v| !v.is_finite()) {
            let message = format!("a velocity has {dim} components here, all finite");
            findings.add(&["step", i, "steady", "velocity", name], message, "");
        }
    }
    for (name, turning) in &steady.turning {
        let at = |last| ["step", i, "steady", "turning", name.as_str(), last];
        if !turning.centre.is_empty() && turning.centre.len() != dim {
            let message = format!("a place has {dim} coordinates here");
            findings.add(&at("centre"), message, "");
        }
        match (dim, turning.axis.len()) {
            (2, 0) => {}
            (2, _) => findings.add(
                &at("axis"),
                "in 2D the axis is across the plane",
                "leave it out",
            ),
            (_, 3) if turning.axis.iter().any(|a| *a != 0.0) => {}
            _ => findings.add(
                &at("axis"),
                "an axis has three components, not all zero",
                "`axis = [0, 0, 1]`",
            ),
        }
        if turning.speed == 0.0 || !turning.speed.is_finite() {
            findings.add(
                &at("speed"),
                "a speed that is not zero is needed: its sign says which way the surface slides",
                "",
            );
        }
    }
}

fn listed<T>(
    findings: &mut Findings,
    key: &[&str],
    list: &Option<Vec<String>>,
    table: &BTreeMap<String, T>,
) {
    let mut seen = BTreeSet::new();
    for (i, name) in list.iter().flatten().enumerate() {
        let i = key::entry(i);
        let at = [key, &[&i]].concat();
        if !table.contains_key(name) {
            let what = key.last().copied().unwrap_or_default();
            let names: Vec<&str> = table.keys().map(String::as_str).collect();
            let message = format!("`{name}` is not among the {what}");
            findings.add(&at, message, suggest(name, what, &names));
        } else if !seen.insert(name) {
            findings.add(&at, format!("`{name}` is listed twice"), "");
        }
    }
}

/// Whether a step has nothing to do.
fn idle(problem: &Problem, step: &Step) -> bool {
    fn count<T>(list: &Option<Vec<String>>, table: &BTreeMap<String, T>) -> usize {
        list.as_ref().map_or(table.len(), Vec::len)
    }
    count(&step.supports, &problem.support) == 0
        && count(&step.loads, &problem.load) == 0
        && count(&step.temperatures, &problem.temperature) == 0
        && count(&step.interfaces, &problem.interface) == 0
        && count(&step.couplings, &problem.coupling) == 0
        && problem.pretension.is_empty()
}

fn increments(findings: &mut Findings, key: &[&str], increments: &Increments) {
    let Increments {
        fixed,
        initial,
        smallest,
        largest,
        state_change: _,
    } = *increments;
    let own = Increments {
        fixed,
        ..Increments::default()
    };
    if fixed.is_some() && *increments != own {
        let message = "`fixed` excludes `initial`, `smallest`, `largest` and `state-change`";
        findings.add(key, message, "keep `fixed`, or the others");
    }
    if smallest > initial {
        let message = format!("`smallest` ({smallest}) is larger than `initial` ({initial})");
        findings.add(key, message, "");
    }
    // The default of `largest` is 1: only a value that was given can be below `initial`.
    if initial > largest {
        let message = format!("`initial` ({initial}) is larger than `largest` ({largest})");
        findings.add(key, message, "");
    }
}

fn slip_events(problem: &Problem, findings: &mut Findings) {
    let Some(events) = &problem.output.slip_events else {
        return;
    };
    let key = ["output", "slip-events"];
    let keeps = |interface: &Interface| {
        let law = interface.friction.as_dyn();
        law.speed_in(&law.initial_state([0.0; 3])).is_some()
    };
    if !problem.interface.values().any(keeps) {
        findings.add(
            &key,
            "no interface has a friction law that keeps its speed",
            "give one `friction.rate-and-state`, or remove it",
        );
    }
    for (name, value) in [("speed", Some(events.speed)), ("modulus", events.modulus)] {
        if value.is_some_and(|v| !(v > 0.0 && v.is_finite())) {
            let place = [&key[..], &[name]].concat();
            findings.add(&place, "must be positive and finite", "");
        }
    }
}

fn fatigue(problem: &Problem, findings: &mut Findings) {
    let Some(fatigue) = &problem.output.fatigue else {
        return;
    };
    let key = ["output", "fatigue"];
    if problem.step.iter().all(|s| s.cycles.is_none()) {
        findings.add(
            &key,
            "fatigue is evaluated over cycles, and no step has any",
            "give a step `cycles = { count = 1 }`, or remove it",
        );
    }
    if fatigue.criteria.is_empty() {
        findings.add(
            &[&key[..], &["criteria"]].concat(),
            "there is no criterion",
            "criteria = [{ findley = { k = 0.3 } }]; `stickslip models` lists them",
        );
    }
    if fatigue.depth.is_some_and(|d| !(d > 0.0 && d.is_finite())) {
        let depth = [&key[..], &["depth"]].concat();
        findings.add(
            &depth,
            "must be positive and finite",
            "a distance from the interfaces",
        );
    }
    for (i, model) in fatigue.criteria.iter().enumerate() {
        let number = key::entry(i);
        let place = [&key[..], &["criteria", &number]].concat();
        findings.faults(
            &[&place[..], &[model.kind()]].concat(),
            model.as_dyn().faults(),
        );
        let name = model.as_dyn().name();
        let mut before = fatigue.criteria[..i].iter();
        if before.any(|m| m.as_dyn().name() == name) {
            findings.add(
                &place,
                format!(
                    "a second criterion {name}: its fields and columns would have the same names"
                ),
                "remove one of the two",
            );
        }
    }
}

fn output(problem: &Problem, findings: &mut Findings) {
    let steps = problem.step.iter();
    let end: f64 = steps
        .map(|s| s.duration * s.cycles.map_or(1, Cycles::blocks) as f64)
        .sum();
    let mut before = 0.0;
    for (i, &time) in problem.output.times.iter().enumerate() {
        let key = ["output", "times", &key::entry(i)];
        if time <= before {
            let message = format!("{time} does not come after {before}");
            findings.add(&key, message, "times are positive and increase");
        } else if time > end * (1.0 + 1e-12) {
            let message = format!("the analysis ends at {end}, before {time}");
            findings.add(&key, message, "");
        }
        before = time;
    }
}
