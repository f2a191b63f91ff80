//! Loads that are given several times, late, at once, on masses. CalculiX 2.20 gives the same sums of reactions.

use crate::support::{column, cube, near, near3, refused, run, sections, translate};

/// Sums of the reactions of a cube of mass 1 that is held at its bottom, by step. What acts on held nodes itself is not in them: half of a weight.
fn reactions(name: &str, before: &str, steps: &[&str]) -> Vec<[f64; 3]> {
    let mut text = format!(
        "{}{}*ELSET, ELSET=ESAME\n1\n*SURFACE, NAME=STOP\nEN, S2\n{before}*BOUNDARY\nNBOT, 1, 3\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    for step in steps {
        text +=
            &format!("*STEP\n*STATIC\n{step}*NODE PRINT, NSET=NBOT, TOTALS=ONLY\nRF\n*END STEP\n");
    }
    let blocks = run(name, &text).all("total force");
    let three = |b: &crate::support::Block| [b.2[0][0], b.2[0][1], b.2[0][2]];
    blocks.iter().map(three).collect()
}

#[track_caller]
fn are(found: &[[f64; 3]], wanted: &[[f64; 3]]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (f, w) in found.iter().zip(wanted) {
        let scale = w.iter().fold(1.0_f64, |m, c| m.max(c.abs()));
        let close = f.iter().zip(w).all(|(a, b)| (a - b).abs() <= 1e-8 * scale);
        assert!(close, "{found:?} is not {wanted:?}");
    }
}

#[test]
fn accelerations_of_one_step_add_up() {
    for (name, cards, wanted) in [
        (
            "same",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\nEN, GRAV, 20., 1., 0., 0.\n",
            [-15.0, 0.0, 0.0],
        ),
        (
            "cards",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\n*DLOAD\nEN, GRAV, 20., 1., 0., 0.\n",
            [-15.0, 0.0, 0.0],
        ),
        (
            "across",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\nEN, GRAV, 20., 0., 1., 0.\n",
            [-5.0, -10.0, 0.0],
        ),
        (
            "against",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\nEN, GRAV, 20., -1., 0., 0.\n",
            [5.0, 0.0, 0.0],
        ),
        (
            "sets",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\nESAME, GRAV, 20., 1., 0., 0.\n",
            [-15.0, 0.0, 0.0],
        ),
        // The direction is no factor.
        (
            "length",
            "*DLOAD\nEN, GRAV, 10., 2., 0., 0.\n",
            [-5.0, 0.0, 0.0],
        ),
        // About the edge at x = y = 0: the centre is half a side away along both.
        (
            "centrif",
            "*DLOAD\nEN, CENTRIF, 10., 0., 0., 0., 0., 0., 1.\nEN, CENTRIF, 20., 0., 0., 0., 0., 0., 1.\n",
            [-7.5, -7.5, 0.0],
        ),
        (
            "force",
            "*DLOAD\nEN, BX, 10.\nEN, BX, 20.\n",
            [-15.0, 0.0, 0.0],
        ),
    ] {
        are(&reactions(&format!("adds-{name}"), "", &[cards]), &[wanted]);
    }
}

#[test]
fn a_later_step_replaces_what_has_the_same_name_and_direction() {
    let one = "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\n";
    for (name, second, wanted) in [
        (
            "same",
            "*DLOAD\nEN, GRAV, 20., 1., 0., 0.\n",
            [-10.0, 0.0, 0.0],
        ),
        ("nothing", "*DLOAD\nEN, GRAV, 0., 1., 0., 0.\n", [0.0; 3]),
        (
            "across",
            "*DLOAD\nEN, GRAV, 20., 0., 1., 0.\n",
            [-5.0, -10.0, 0.0],
        ),
        ("back", "*DLOAD\nEN, GRAV, 10., -1., 0., 0.\n", [0.0; 3]),
        (
            "set",
            "*DLOAD\nESAME, GRAV, 20., 1., 0., 0.\n",
            [-15.0, 0.0, 0.0],
        ),
        (
            "new",
            "*DLOAD, OP=NEW\nEN, GRAV, 20., 0., 1., 0.\n",
            [0.0, -10.0, 0.0],
        ),
    ] {
        are(
            &reactions(&format!("replaces-{name}"), "", &[one, second]),
            &[[-5.0, 0.0, 0.0], wanted],
        );
    }
    let found = reactions(
        "replaces-force",
        "",
        &["*DLOAD\nEN, BX, 10.\n", "*DLOAD\nESAME, BX, 20.\n"],
    );
    are(&found, &[[-5.0, 0.0, 0.0], [-10.0, 0.0, 0.0]]);
}

#[test]
fn pressures_of_one_step_add_up_and_those_of_the_next_replace_them() {
    for (name, cards) in [
        ("card", "*DLOAD\n1, P2, 10.\n1, P2, 20.\n"),
        ("cards", "*DLOAD\n1, P2, 10.\n*DLOAD\nEN, P2, 20.\n"),
        ("surface", "*DSLOAD\nSTOP, P, 10.\n*DLOAD\n1, P2, 20.\n"),
    ] {
        let found = reactions(
            &format!("pressures-{name}"),
            "",
            &[cards, "*DLOAD\n1, P2, 5.\n"],
        );
        are(&found, &[[0.0, 0.0, 30.0], [0.0, 0.0, 5.0]]);
    }
}

#[test]
fn loads_that_add_up_have_one_amplitude() {
    for load in ["*CLOAD", "*DLOAD"] {
        let data = if load == "*CLOAD" {
            "5, 3, 1."
        } else {
            "EN, GRAV, 1., 0., 0., 1."
        };
        let text = format!(
            "{}*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP\n*STATIC\n{load}\n{data}\n{load}, AMPLITUDE=A\n{data}\n*END STEP\n",
            column()
        );
        let message = refused(&text);
        assert!(message.contains("another amplitude"), "{message}");
    }
}

#[test]
fn masses_bear_the_loads_of_their_own_elements() {
    // A mass of 3 at the free corner above the origin, and one of 2 at the corner across.
    let masses = "*ELEMENT, TYPE=MASS, ELSET=EM\n9, 5\n*ELEMENT, TYPE=MASS, ELSET=EO\n10, 7\n*MASS, ELSET=EM\n3.\n*MASS, ELSET=EO\n2.\n";
    for (name, cards, wanted) in [
        (
            "masses",
            "*DLOAD\nEM, GRAV, 10., 1., 0., 0.\n",
            [-30.0, 0.0, 0.0],
        ),
        (
            "cells",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\n",
            [-5.0, 0.0, 0.0],
        ),
        (
            "both",
            "*DLOAD\nEN, GRAV, 10., 1., 0., 0.\nEM, GRAV, 10., 1., 0., 0.\n",
            [-35.0, 0.0, 0.0],
        ),
        (
            "all",
            "*DLOAD\n, GRAV, 10., 1., 0., 0.\n",
            [-55.0, 0.0, 0.0],
        ),
        (
            "centrif",
            "*DLOAD\nEO, CENTRIF, 10., 0., 0., 0., 0., 0., 1.\n",
            [-20.0, -20.0, 0.0],
        ),
    ] {
        are(
            &reactions(&format!("mass-load-{name}"), masses, &[cards]),
            &[wanted],
        );
    }
}

#[test]
fn a_time_delay_shifts_the_amplitude() {
    // A rod of 1000; the amplitude is 1 + t, and half a second late it stays 1 at first. The step after keeps the value, as in CalculiX 2.20.
    let text = |delay: &str| {
        format!(
            "{}*AMPLITUDE, NAME=A\n0., 1., 2., 3.\n*STEP\n*STATIC, DIRECT\n.25, 1.\n*CLOAD, AMPLITUDE=A{delay}\nNTOP, 3, 2.5\n\
             *NODE PRINT, NSET=NTOP\nU\n*END STEP\n*STEP\n*STATIC, DIRECT\n.5, 1.\n*NODE PRINT, NSET=NTOP\nU\n*END STEP\n",
            column()
        )
    };
    let course = run("delay", &text(", TIME DELAY=.5")).course("displacements", 3);
    let wanted = [0.01, 0.01, 0.0125, 0.015, 0.015, 0.015];
    assert_eq!(course.len(), wanted.len(), "{course:?}");
    for ((_, u), w) in course.iter().zip(wanted) {
        near(*u, w, 1e-8);
    }
    near(
        run("no-delay", &text("")).course("displacements", 3)[3].1,
        0.02,
        1e-8,
    );
    let message = refused(&text(", TIME DELAY=.5").replace("AMPLITUDE=A,", ""));
    assert!(message.contains("needs an amplitude"), "{message}");
    // What is prescribed is late as well.
    let prescribed = text(", TIME DELAY=.5")
        .replace("*CLOAD", "*BOUNDARY")
        .replace("NTOP, 3, 2.5", "NTOP, 3, 3, .01");
    near(
        run("delay-boundary", &prescribed).course("displacements", 3)[3].1,
        0.015,
        1e-8,
    );
}

#[test]
fn steps_say_whether_loads_act_at_once() {
    let text = |amplitude: &str, load: &str| {
        format!(
            "{}*STEP{amplitude}\n*STATIC, DIRECT\n.5, 1.\n{load}*NODE PRINT, NSET=NTOP\nU\n*END STEP\n\
             *STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD, OP=NEW\n*NODE PRINT, NSET=NTOP\nU\n*END STEP\n",
            column()
        )
    };
    let force = "*CLOAD\nNTOP, 3, 2.5\n";
    let values = |name: &str, text: &str| -> Vec<f64> {
        run(name, text)
            .course("displacements", 3)
            .iter()
            .map(|c| c.1)
            .collect()
    };
    for (name, amplitude, wanted) in [
        ("step-ramp", "", [0.005, 0.01, 0.005, 0.0]),
        ("step-step", ", AMPLITUDE=STEP", [0.01, 0.01, 0.005, 0.0]),
    ] {
        for (u, w) in values(name, &text(amplitude, force)).iter().zip(wanted) {
            assert!((u - w).abs() < 1e-10, "{name}: {u} is not {w}");
        }
    }
    let moved = values(
        "step-moved",
        &text(", AMPLITUDE=STEP", "*BOUNDARY\nNTOP, 3, 3, .01\n"),
    );
    near(moved[0], 0.01, 1e-10);
    let message = refused(&text(", AMPLITUDE=WAVE", force));
    assert!(message.contains("RAMP or STEP"), "{message}");
}

#[test]
fn the_smallest_increment_of_an_explicit_step_scales_masses() {
    let text = |times: &str| {
        format!(
            "{}*STEP\n*DYNAMIC, EXPLICIT\n{times}\n*CLOAD\nNTOP, 3, 1.\n*END STEP\n",
            column()
        )
    };
    let toml = translate(&text("1.E-3, 1., 1.E-2")).toml;
    assert!(toml.contains("mass-scaling = 0.01"), "{toml}");
    assert!(!toml.contains("smallest"), "{toml}");
    assert!(!translate(&text("1.E-3, 1.")).toml.contains("mass-scaling"));
}

#[test]
fn constants_are_those_of_the_temperature_at_the_start() {
    let text = |rows: &str, temperatures: &str| {
        format!(
            "{}*MATERIAL, NAME=M\n*ELASTIC\n{rows}*EXPANSION\n1.E-5\n*SOLID SECTION, ELSET=EN, MATERIAL=M\n*BOUNDARY\nN, 1, 2\nNBOT, 3, 3\n\
             {temperatures}*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 2.5\n*END STEP\n",
            cube("N", 1, 0.0)
        )
    };
    let rows = "1000., 0., 0.\n3000., 0., 100.\n";
    let at = |t: &str| format!("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, {t}\n");
    for (name, temperatures, young) in [
        ("none", String::new(), 1000.0),
        ("between", at("50."), 2000.0),
        ("beyond", at("500."), 3000.0),
        ("below", at("-20."), 1000.0),
    ] {
        near(
            run(&format!("temperature-{name}"), &text(rows, &temperatures)).u(7)[2],
            10.0 / young,
            1e-9,
        );
    }
    // Half of its nodes at 50, half at 60: the cell has the constants of 55.
    let both = at("50.") + &at("60.").replace("N,", "NTOP,");
    let graded = run("temperature-graded", &text(rows, &both));
    near(graded.u(7)[2], 10.0 / 2100.0, 1e-9);
    let dense = text(rows, &both).replace("*EXPANSION", "*DENSITY\n1., 0.\n2., 100.\n*EXPANSION");
    let message = refused(&dense);
    assert!(message.contains("temperatures from 50 to 60"), "{message}");
    let message = refused(&text("1000., 0., 100.\n3000., 0., 0.\n", ""));
    assert!(message.contains("does not follow"), "{message}");
    let message = refused(&text("1000., 0., 0., 7.\n", ""));
    assert!(message.contains("is not read"), "{message}");
}

#[test]
fn elements_print_in_global_axes_if_asked_to_and_totals_always_do() {
    let text = |global: &str| {
        format!(
            "{}*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*ORIENTATION, NAME=O\n0., 1., 0., 0., 0., 1.\n*SOLID SECTION, ELSET=EN, MATERIAL=M, ORIENTATION=O\n\
             *BOUNDARY\nN, 1, 2\nNBOT, 3, 3\n*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 2.5\n*EL PRINT, ELSET=EN{global}\nS\n*END STEP\n",
            cube("N", 1, 0.0)
        )
    };
    // The axis 2 of the material is z.
    let local = run("stress-local", &text("")).last("stresses");
    near3([local[2], local[3], local[4]], [0.0, 10.0, 0.0], 1e-6);
    let global = run("stress-global", &text(", GLOBAL=YES")).last("stresses");
    near3([global[2], global[3], global[4]], [0.0, 0.0, 10.0], 1e-6);

    // Every node has axes of its own, about the line through the middle of the cube; a force of 10 along x is held by them together.
    let held = format!(
        "{}{}*TRANSFORM, NSET=NBOT, TYPE=C\n.5, .5, 0., .5, .5, 1.\n*BOUNDARY\nNBOT, 1, 3\n*STEP\n*STATIC\n*CLOAD\nNTOP, 1, 2.5\n\
         *NODE PRINT, NSET=NBOT, TOTALS=YES\nRF\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let r = run("total-of-local", &held);
    let total = r.last("total force");
    near3([total[0], total[1], total[2]], [-10.0, 0.0, 0.0], 1e-6);
    // The single ones stay along the axes of their nodes.
    let rows = &r.all("forces")[0].2;
    let along: f64 = rows.iter().map(|row| row[1]).sum();
    assert!((along + 10.0).abs() > 1.0, "{rows:?}");
}

#[test]
fn sums_over_sets_that_name_something_twice_are_refused() {
    // CalculiX loads and prints a node as often as its set names it, Abaqus once.
    let deck =
        |sets: &str, step: &str| format!("{}{sets}*STEP\n*STATIC\n{step}*END STEP\n", column());
    let twice = "*NSET, NSET=T\n5, 6, 5\n";
    for (sets, step, what) in [
        (twice, "*CLOAD\nT, 3, 1.\n", "node 5 stands in the set T"),
        (
            "*NSET, NSET=T\n5, 6\n*NSET, NSET=T\n6\n",
            "*CLOAD\nT, 3, 1.\n",
            "node 6 stands in the set T",
        ),
        (
            "*NSET, NSET=P\n5, 6\n*NSET, NSET=T\nP, NTOP\n*NSET, NSET=U\nT\n",
            "*CLOAD\nU, 3, 1.\n",
            "stands in the set U",
        ),
        (twice, "*NODE PRINT, NSET=T, TOTALS=YES\nRF\n", "node 5"),
        (
            "*ELSET, ELSET=T\nEN, 1\n",
            "*DLOAD\nT, GRAV, 1., 0., 0., 1.\n",
            "element 1 stands in the set T",
        ),
        (
            "*ELSET, ELSET=T\nEN, 1\n",
            "*EL PRINT, ELSET=T, TOTALS=ONLY\nEVOL\n",
            "element 1",
        ),
        (
            "*SURFACE, NAME=T\nEN, S2\n1, S2\n",
            "*DSLOAD\nT, P, 1.\n",
            "face 2 of element 1 stands in the surface T",
        ),
    ] {
        let message = refused(&deck(sets, step));
        assert!(message.contains(what), "{message}");
        assert!(
            message.contains("once in Abaqus") && message.contains("name each"),
            "{message}"
        );
    }
    // What is only held, printed one by one, or made of cells that share nodes is the same either way.
    translate(&deck(
        &format!("{twice}*NSET, NSET=C, ELSET=EN\n"),
        "*BOUNDARY\nT, 3\n*NODE PRINT, NSET=T\nU\n*CLOAD\nC, 3, 1.\n",
    ));
}
