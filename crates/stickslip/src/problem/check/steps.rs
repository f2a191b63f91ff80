//! Steps and times.

use std::collections::{BTreeMap, BTreeSet};

use super::super::nearest::suggest;
use super::super::{Increments, Problem, Step};
use super::findings::Findings;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    if problem.step.is_empty() {
        findings.add(&["step"], "there is no step", "add a table [[step]]");
    }
    let mut names = BTreeSet::new();
    for (i, step) in problem.step.iter().enumerate() {
        let i = i.to_string();
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
        if step.dynamic.is_none() && idle(problem, step) {
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
    }
    output(problem, findings);
}

fn listed<T>(
    findings: &mut Findings,
    key: &[&str],
    list: &Option<Vec<String>>,
    table: &BTreeMap<String, T>,
) {
    let mut seen = BTreeSet::new();
    for (i, name) in list.iter().flatten().enumerate() {
        let i = i.to_string();
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
    } = *increments;
    let own = Increments {
        fixed,
        ..Increments::default()
    };
    if fixed.is_some() && *increments != own {
        let message = "`fixed` excludes `initial`, `smallest` and `largest`";
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

fn output(problem: &Problem, findings: &mut Findings) {
    let end: f64 = problem.step.iter().map(|s| s.duration).sum();
    let mut before = 0.0;
    for (i, &time) in problem.output.times.iter().enumerate() {
        let key = ["output", "times", &i.to_string()];
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
