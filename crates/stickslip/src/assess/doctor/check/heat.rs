//! Temperatures that strain bodies too much, that jump in motion, or that count from an unknown temperature.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use super::common::times;
use super::strains::LARGE_STRAIN;
use crate::model::definition::Model;
use crate::number::{digits, figure};

pub(super) fn check(model: &Model) -> Vec<Finding> {
    let mut out = strained(model);
    out.extend(from_zero(model));
    out.extend(jumps(model));
    out
}

/// Bodies that temperatures strain too much.
pub(super) fn strained(model: &Model) -> Vec<Finding> {
    let Some(heat) = &model.actions.heat else {
        return Vec::new();
    };
    let temperatures = &heat.temperatures;
    let mut out = Vec::new();
    for owner in model.elastic() {
        // The largest strain, the rise that makes it and its time.
        let mut worst = (0.0_f64, 0.0, 0.0);
        for t in times(model) {
            let rises = temperatures.rises(t);
            for p in owner.points.clone() {
                for dilation in owner.elastic.parts().iter().flat_map(|p| &p.dilation) {
                    let strain = dilation.strain(temperatures.start[p], rises[p]);
                    let most = strain[..3].iter().fold(0.0_f64, |m, e| m.max(e.abs()));
                    if most > worst.0 {
                        worst = (most, rises[p], t);
                    }
                }
            }
        }
        let (strain, rise, t) = worst;
        if strain <= LARGE_STRAIN {
            continue;
        }
        let name = &owner.name;
        out.push(
            DoctorCause::LargeStrain.warning(format!(
                "body {name} expands by a strain of {strain}: it is warmer by {rise} at time {t}, and its coefficient of thermal expansion is {}",
                figure(strain / rise.abs()),
                strain = figure(strain),
                rise = digits(rise, 5),
                t = digits(t, 5),
            ))
            .blame(Suspect::key(format!("body.{name}.material"), "its `expansion`"))
            .blame(body(model, name, format!("strain {}", figure(strain))))
            .advise("check the unit of `expansion`: steel has 12e-6 per degree, not 12")
            .advise("bodies are linear, with small strains, and results beyond are not to be trusted"),
        );
    }
    out
}

/// Temperatures that are given while the temperature at the start is not given.
fn from_zero(model: &Model) -> Option<Finding> {
    let heat = model.actions.heat.as_ref()?;
    let temperatures = &heat.temperatures;
    if temperatures.said || temperatures.fields.is_empty() {
        return None;
    }
    let field = temperatures.fields.first()?;
    let largest = field
        .entries
        .iter()
        .fold(0.0_f64, |m, e| if e.1.abs() > m.abs() { e.1 } else { m });
    (largest != 0.0).then(|| {
        DoctorCause::StartTemperature.note(format!(
            "no `initial` says how warm bodies are at the start: they are free of stress at 0, so that {largest} of temperature {} is the whole rise",
            field.name
        ))
        .blame(Suspect::key(format!("temperature.{}", field.name), ""))
        .advise("where temperatures are not meant as rises, give the one of the start: `[initial.NAME]` with `set` and `temperature.uniform.value`, of all bodies")
    })
}

/// Temperatures that come or go at once, in a step in which bodies have inertia.
fn jumps(model: &Model) -> Vec<Finding> {
    let Some(heat) = &model.actions.heat else {
        return Vec::new();
    };
    let temperatures = &heat.temperatures;
    let mut out = Vec::new();
    for (i, step) in model.steps.iter().enumerate() {
        if step.dynamic.is_none() {
            continue;
        }
        let short = 1e-6 * (step.end - step.start);
        let mut before = temperatures.rises(step.start);
        if i == 0 {
            before.fill(0.0);
        }
        let after = temperatures.rises(step.start + short);
        let changed = before.iter().zip(&after).map(|(b, a)| (a - b).abs());
        let jump = changed.fold(0.0, f64::max);
        let most = before.iter().chain(&after);
        let most = most.fold(0.0_f64, |m, r| m.max(r.abs()));
        if jump <= 0.5 * most || most == 0.0 {
            continue;
        }
        let mut fields = temperatures.fields.iter();
        let moved = |f: &&crate::body::TemperatureField| {
            i == 0 || f.weights(step.start) != f.weights(step.start + short)
        };
        let name = fields.find(moved).map_or("", |f| f.name.as_str());
        out.push(
            DoctorCause::SuddenChange.warning(format!(
                "temperature {name} jumps by {jump} at the start of step {}, which is dynamic: heat takes far longer than sound, and bodies that expand at once ring like bells",
                step.name,
                jump = digits(jump, 5),
            ))
            .blame(Suspect::key(format!("temperature.{name}"), "at once"))
            .blame(Suspect::key("step", format!("step {} is dynamic", step.name)))
            .advise("heat in a quasi-static step before, or spread the rise by an `amplitude`"),
        );
    }
    out
}
