//! What acts in which steps: values as the steps give them, equal ones together.

use std::collections::BTreeMap;

use stickslip::body::loads::LoadKind;
use stickslip::problem::Load;

use super::courses;
use super::job::Job;
use super::names::problem_name;
use super::part::Part;
use crate::card::Place;
use crate::deck::{Deck, Target};

/// A value that acts in some of the steps.
#[derive(Debug, Clone)]
pub(super) struct Acting<T> {
    pub(super) what: T,
    pub(super) amplitude: Option<String>,
    pub(super) place: Place,
    pub(super) label: String,
    pub(super) steps: Vec<bool>,
    /// Steps to which it comes from the one before, without being given anew.
    pub(super) kept: Vec<bool>,
    /// Steps in which a value with an amplitude takes its place: it ends at once, instead of falling over the step.
    pub(super) ends: Vec<bool>,
}

impl<T> Acting<T> {
    /// When it acts.
    pub fn when(&self) -> When {
        When {
            amplitude: self.amplitude.clone(),
            steps: self.steps.clone(),
            kept: self.kept.clone(),
            ends: self.ends.clone(),
        }
    }
}

/// When a load acts.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct When {
    pub(super) amplitude: Option<String>,
    pub(super) steps: Vec<bool>,
    pub(super) kept: Vec<bool>,
    pub(super) ends: Vec<bool>,
}

/// A value as a step gives it, or the step before.
#[derive(Debug, Clone)]
pub(super) struct Given<T> {
    pub(super) what: T,
    pub(super) amplitude: Option<String>,
    pub(super) place: Place,
    /// What it was given for.
    pub(super) label: String,
    /// The step that gives it.
    pub(super) step: usize,
}

/// Values by step to values with their steps, equal ones together.
pub(super) fn collect<K: Ord + Clone, T: Clone + PartialEq>(
    by_step: &[BTreeMap<K, Given<T>>],
) -> Vec<(K, Acting<T>)> {
    let mut out: Vec<(K, Acting<T>)> = Vec::new();
    let mut at: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for (i, state) in by_step.iter().enumerate() {
        for (key, given) in state {
            let known = at.entry(key.clone()).or_default();
            let alike = |a: &Acting<T>| a.what == given.what && a.amplitude == given.amplitude;
            let same = known.iter().copied().find(|&j| alike(&out[j].1));
            let index = same.unwrap_or_else(|| {
                known.push(out.len());
                let acting = Acting {
                    what: given.what.clone(),
                    amplitude: given.amplitude.clone(),
                    place: given.place,
                    label: given.label.clone(),
                    steps: vec![false; by_step.len()],
                    kept: vec![false; by_step.len()],
                    ends: vec![false; by_step.len()],
                };
                out.push((key.clone(), acting));
                out.len() - 1
            });
            out[index].1.steps[i] = true;
            // Without an amplitude it is the same, given anew or not.
            out[index].1.kept[i] = given.step < i && given.amplitude.is_some();
        }
    }
    for (key, acting) in &mut out {
        for (i, state) in by_step.iter().enumerate().skip(1) {
            let replaced = state.get(key).is_some_and(|v| v.amplitude.is_some());
            acting.ends[i] = replaced && acting.steps[i - 1] && !acting.steps[i];
        }
    }
    out
}

/// Loads that are given several times in a step add up. CalculiX has one amplitude for the sum.
pub(super) fn two_courses(job: &mut Job, place: Place) {
    job.error(
        place,
        "what is loaded here is loaded in the same step with another amplitude",
        "loads that add up have one amplitude: write one line with one amplitude for the sum",
    );
}

/// A load, under a name that begins like this.
pub(super) fn add_load(
    job: &mut Job,
    wanted: &str,
    set: String,
    place: Place,
    when: &When,
    kind: LoadKind,
) {
    let name = job.fresh::<Load>(&problem_name(wanted));
    let mut load = Load {
        set,
        amplitude: None,
        follow: false,
        kind,
    };
    if job.part != Part::Lasting {
        job.add(&name, place, load);
        job.shaking
            .push((name.clone(), job.part, when.steps.clone()));
        // It acts in no step but as what shakes.
        job.acts::<Load>(name, vec![false; when.steps.len()]);
        return;
    }
    // From the first step on, where steps change without amplitudes as they usually do not.
    let unusual = when.amplitude.is_none() && courses::unusual(job.deck);
    load.amplitude = match (&when.amplitude, unusual || when.ends.contains(&true)) {
        (None, false) => None,
        (Some(a), false) => Some(courses::amplitude(job, a, &when.steps, &when.kept, &name)),
        (a, true) => Some(courses::ending(
            job,
            a.as_ref(),
            &when.steps,
            &when.kept,
            &when.ends,
            &name,
        )),
    };
    let steps = when.steps.iter().zip(&when.ends).map(|(a, b)| *a || *b);
    let mut steps: Vec<bool> = steps.collect();
    if unusual {
        let first = steps.iter().position(|on| *on).unwrap_or(0);
        steps[first..].fill(true);
    }
    job.add(&name, place, load);
    job.acts::<Load>(name, steps);
}

pub(super) fn label(deck: &Deck, target: &Target) -> String {
    match target {
        Target::Set(name) => name.clone(),
        Target::One(n) => format!("node-{}", deck.label(*n)),
    }
}
