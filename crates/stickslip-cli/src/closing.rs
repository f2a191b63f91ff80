//! What is said at the end of a run: what came out, how good it is, where it is, and what to do with it.

use std::path::Path;

use stickslip::assess::doctor::Finding;
use stickslip::assess::{Figure, Gate, InterfaceSummary, Peak};
use stickslip::math::norm;
use stickslip::model::GateMode;
use stickslip::number::{digits, figure};
use stickslip::results::{Analysis, Summary};
use stickslip::tolerance::SAME;

use crate::style::{self, Look, paint, sentence, vector};
use crate::voice::say;
use stickslip::mesh::geometry;

/// What a user wants to know at the end; with `verbose` what only who works on the solver wants to know as well.
pub fn closing(analysis: &Analysis, directory: &Path, verbose: bool) {
    let s = analysis.summary;
    say(&effort(s));
    let time = digits(analysis.frame.state.t, 6);
    let dim = analysis.model.dofs.dim;
    let size = geometry::diameter(&analysis.model.mesh);
    for interface in &s.interfaces {
        for line in physics(interface, dim, size, &time) {
            say(&line);
        }
    }
    if s.explicit.mass_added > 0.0 {
        let added = figure(100.0 * s.explicit.mass_added);
        say(&format!(
            "mass scaling added {added} % to the mass of the bodies"
        ));
    }
    if verbose {
        for line in internals(analysis) {
            say(&sentence(&line));
        }
    }
    say(&quality(&s.quality));
    let folder = directory.display();
    say(&format!("results in {folder}"));
    say(&format!("  stickslip plot {folder}      a picture"));
    say(&format!(
        "  stickslip report {folder}    all of it, as a page to browse"
    ));
}

fn effort(s: &Summary) -> String {
    let events = match s.attempts.events {
        0 => String::new(),
        n => format!(", {n} halvings to locate events"),
    };
    format!(
        "{}: {} increments, {} iterations, {} cut-backs{events}, {:.2} s",
        paint(Look::Good, "done"),
        s.attempts.increments,
        s.attempts.iterations,
        s.attempts.cutbacks,
        s.cost.phases.total
    )
}

/// What an interface carries, in the units of the problem.
fn physics(i: &InterfaceSummary, dim: usize, size: f64, time: &str) -> Vec<String> {
    let kind = if i.tied { "tie" } else { "interface" };
    let mut lines = vec![format!(
        "{} {} at time {time}, forces on its secondary",
        paint(Look::Strong, kind),
        style::short(&i.name, 50)
    )];
    let mut line = |what: &str, text: String| lines.push(format!("  {what:<15}{text}"));
    let most = |peak: &Peak, now: f64, never: &str| match peak.value > 0.0 {
        true => format!(
            "{} at {}, time {}; now {}",
            figure(peak.value),
            // Places nearer to an axis than 1e-4 of the size of the model are on it: bodies are strained by more. In the unit of [`vector`].
            vector(&peak.at[..dim], 1e-4 / SAME * size),
            digits(peak.time, 6),
            figure(now)
        ),
        false => never.into(),
    };
    if let (Some(peak), Some(now)) = (&i.peak_pressure, i.pressure) {
        line("peak pressure", most(peak, now, "none: it never pressed"));
    }
    if let (Some(peak), Some(now)) = (&i.peak_traction, i.traction) {
        line("peak traction", most(peak, now, "none"));
    }
    let all = norm(i.normal_force).max(norm(i.shear_force));
    let force = |f: [f64; 3]| match norm(f) > SAME * all {
        true => format!("{} {}", figure(norm(f)), vector(&f[..dim], all)),
        false => "0".into(),
    };
    line("normal force", force(i.normal_force));
    line("shear force", force(i.shear_force));
    let area = if i.tied { "tied area" } else { "contact area" };
    line(area, figure(i.area));
    if let Some(p) = i.points {
        let points = format!("{} stick, {} slip, {} open", p.stick, p.slip, p.open);
        line("points", points);
    }
    if let Some(work) = i.friction_work {
        line("friction work", figure(work));
    }
    lines
}

/// The quality gate in a line.
fn quality(gate: &Gate) -> String {
    let word = paint(Look::Strong, "quality");
    if gate.gate == GateMode::Off {
        return format!("{word} is not judged: `quality.gate` is off");
    }
    let judged = gate.figures.iter().filter(|f| f.limit.is_some());
    let missed = gate.violations().count();
    if missed > 0 {
        let look = match gate.failed() {
            true => Look::Wrong,
            false => Look::Warning,
        };
        let limits = if missed == 1 {
            "its limit"
        } else {
            "their limits"
        };
        let missed = paint(look, &format!("{missed} of {}", judged.count()));
        return format!("{word}: {missed} figures above {limits}");
    }
    let part = |f: &Figure| f.value / f.limit.unwrap_or(f64::INFINITY);
    let nearest = judged.clone().max_by(|a, b| part(a).total_cmp(&part(b)));
    let all = judged.count();
    let head = match all {
        0 => return format!("{word}: nothing to judge"),
        1 => "the one limit is kept".to_string(),
        _ => format!("all {all} limits are kept"),
    };
    let Some(f) = nearest.filter(|f| f.value > 0.0) else {
        return format!("{word}: {head}");
    };
    let limit = digits(f.limit.unwrap_or(f64::INFINITY), 2);
    let tail = format!(", {} of {limit}", digits(f.value, 2));
    let head = format!("{head}; nearest: {} of ", f.figure);
    // The place is what may be long.
    let rest = "quality: ".len() + head.len() + tail.len();
    let place = style::short(&f.place, style::WIDTH.saturating_sub(rest).max(1));
    format!("{word}: {head}{place}{tail}")
}

/// What the solver did, and what its approximations cost.
fn internals(analysis: &Analysis) -> Vec<String> {
    let s = analysis.summary;
    let mut lines = vec![format!(
        "  factorisations: {}",
        s.cost.solver.factorisations
    )];
    if !s.attempts.friction_solvers.is_empty() {
        let each = s.attempts.friction_solvers.iter();
        let each: Vec<String> = each.map(|(name, n)| format!("{n} by {name}")).collect();
        lines.push(format!(
            "  solved as friction problems: {}",
            each.join("; ")
        ));
    }
    lines.push(phases(s));
    if s.cost.relative_to_linear > 0.0 {
        lines.push(format!(
            "  without writing {:.2} times one assembly, factorisation and solution of the same bodies ({:.2} s)",
            s.cost.relative_to_linear, s.cost.linear_solve
        ));
    }
    if analysis.model.moves() {
        lines.push(format!(
            "  energy: the error of the balance is {} of the energy stored and dissipated",
            digits(s.balance.energy_quality.residual, 2)
        ));
    }
    for i in &s.interfaces {
        lines.push(format!(
            "  {}: largest penetration {} of the cell size, {} of the elastic approach",
            i.name,
            digits(i.quality.relative_to_size, 2),
            digits(i.relative_to_approach, 2)
        ));
        if let Some(n) = &i.numerical_stiffness {
            lines.push(format!(
                "  {}: independent of the numerical stiffness to {} % (factor {})",
                i.name,
                digits(100.0 * n.independent_to, 2),
                figure(n.factor)
            ));
        }
    }
    lines
}

fn phases(s: &Summary) -> String {
    let p = &s.cost.phases;
    format!(
        "  read {:.2}, assemble {:.2}, order {:.2}, factor {:.2}, condense {:.2}, iterate {:.2}, contact {:.2}, recover {:.2}, write {:.2} s; {} flops, {:.2} GB",
        p.read,
        p.assemble,
        p.order,
        p.factor,
        p.condense,
        p.iterate,
        p.contact,
        p.recover,
        p.write,
        digits(s.cost.solver.factors.flops, 3),
        s.cost.peak_memory as f64 / 1e9
    )
}

/// Says which figures of the quality gate are above their limits.
pub fn gate(gate: &Gate, findings: &[Finding]) {
    let word = match gate.failed() {
        true => paint(Look::Wrong, "error"),
        false => paint(Look::Warning, "warning"),
    };
    for figure in gate.violations() {
        say(&sentence(&format!(
            "{word}: quality: {}",
            figure.sentence(findings)
        )));
    }
    if !gate.met {
        say("  the results are kept; `[quality]` in the problem file sets the limits");
    }
}
