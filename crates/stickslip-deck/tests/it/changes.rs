//! What changes from step to step: contact pairs, surfaces that come apart, equations, and displacements prescribed before the first step. The numbers
//! are those of CalculiX 2.20 with the same decks; it counts finite strains, which are a thousandth here.

use crate::support::{Run, column, near, pair, refused, run};

const LINEAR: &str = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n";

/// The force on the ground beneath two cubes at the end of each step.
fn forces(run: &Run) -> Vec<f64> {
    run.all("total force").iter().map(|b| b.2[0][2]).collect()
}

#[track_caller]
fn are(found: &[f64], wanted: &[f64]) {
    let largest = wanted.iter().fold(1e-9_f64, |m, w| m.max(w.abs()));
    let close = |(f, w): (&f64, &f64)| (f - w).abs() <= 2e-3 * largest;
    assert!(
        found.len() == wanted.len() && found.iter().zip(wanted).all(close),
        "{found:?} is not {wanted:?}"
    );
}

/// Steps of one increment each with these cards.
fn steps(cards: &[&str], print: &str) -> String {
    let step = |c: &&str| format!("*STEP, NLGEOM\n*STATIC, DIRECT\n1., 1.\n{c}{print}*END STEP\n");
    cards.iter().map(step).collect()
}

const GROUND: &str = "*NODE PRINT, NSET=ABOT, TOTALS=ONLY\nRF\n";

/// A pair of cubes that cannot move sideways, through these steps.
fn cubes(name: &str, interaction: &str, cards: &[&str]) -> Vec<f64> {
    let model = pair(0.0, "SURFACE TO SURFACE", interaction);
    let text = format!("{model}*BOUNDARY\nB, 1\n{}", steps(cards, GROUND));
    forces(&run(name, &text))
}

const REMOVE: &str = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSLAVE, MASTER\n";
const ADD: &str = "*Model Change, type=CONTACT PAIR, add\nSlave, Master\n";
const PRESS: &str = "*BOUNDARY\nBTOP, 3, 3, -.001\n";

#[test]
fn a_contact_pair_is_removed_and_added() {
    let found = cubes("pair-removed", LINEAR, &[PRESS, REMOVE, "", ADD]);
    are(&found, &[0.4971431, 0.0, 0.0, 0.4971431]);
    // What is removed in the first step begins without contact.
    let first = format!("{REMOVE}{PRESS}");
    let more = "*BOUNDARY\nBTOP, 3, 3, -.002\n";
    let found = cubes("pair-added", LINEAR, &[&first, ADD, more]);
    are(&found, &[0.0, 0.4971431, 0.9935476]);
}

#[test]
fn several_pairs_change_in_one_step() {
    let model = pair(0.0, "SURFACE TO SURFACE", LINEAR)
        .replace("SLAVE, MASTER\n", "SLAVE, MASTER\nHALF, MASTER\n");
    let model = model.replace("*SURFACE INT", "*SURFACE, NAME=HALF\nEB, S1\n*SURFACE INT");
    let text = |cards: &[&str]| format!("{model}*BOUNDARY\nB, 1\n{}", steps(cards, GROUND));
    let both = format!("{}HALF, MASTER\n", REMOVE);
    let found = forces(&run("pairs-of-a-card", &text(&[PRESS, &both])));
    are(&found[1..], &[0.0]);
    let cards = format!("{REMOVE}{}", REMOVE.replace("SLAVE", "HALF"));
    let found = forces(&run("pairs-of-cards", &text(&[PRESS, &cards])));
    are(&found[1..], &[0.0]);
    // One of the two springs is left: 1 / (1/1000 + 1/1000 + 1/1e5).
    let found = forces(&run("pair-of-pairs", &text(&[PRESS, REMOVE])));
    are(&found[1..], &[0.4975124]);
}

#[test]
fn removals_that_mean_nothing_are_refused() {
    let deck = |card: &str| {
        let model = pair(0.0, "SURFACE TO SURFACE", LINEAR);
        refused(&format!("{model}*STEP\n*STATIC\n{card}*END STEP\n"))
    };
    for (card, said) in [
        (
            "*MODEL CHANGE, REMOVE\nEA\n",
            "of elements is not supported",
        ),
        (
            "*MODEL CHANGE, TYPE=ELEMENT, ADD=STRAIN FREE\nEA\n",
            "of elements is not supported",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR\nSLAVE, MASTER\n",
            "either ADD or REMOVE",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, ADD, REMOVE\nSLAVE, MASTER\n",
            "either ADD or REMOVE",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nMASTER, SLAVE\n",
            "the slave surface stands first",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSLAVE, OTHER\n",
            "contact pairs: SLAVE and MASTER",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSLAVE\n",
            "two surfaces are expected",
        ),
        (
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\n",
            "has no data line",
        ),
    ] {
        let message = deck(card);
        assert!(message.contains(said), "{card}{message}");
        assert_eq!(message.matches("error").count(), 1, "{message}");
    }
    let before = pair(0.0, "SURFACE TO SURFACE", LINEAR) + REMOVE;
    assert!(refused(&before).contains("outside of a step"));
}

#[test]
fn tied_surfaces_come_apart_in_a_later_step() {
    let tied = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E5\n*FRICTION\n.0001, 1.E5\n";
    let apart = format!("*CHANGE SURFACE BEHAVIOR, INTERACTION=SI\n{LINEAR}");
    let pull = "*BOUNDARY\nBTOP, 3, 3, .001\n";
    let found = cubes("tied-apart", tied, &[pull, &apart, PRESS]);
    are(&found, &[-0.4978819, 0.0, 0.4971431]);
    // Exact glue, which becomes hard contact.
    let tied = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n";
    let hard =
        "*CHANGE SURFACE BEHAVIOR, INTERACTION=SI\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n";
    let found = cubes("glued-apart", tied, &[pull, hard, PRESS]);
    are(&found, &[-0.5, 0.0, 0.5]);
    let later = format!("*CHANGE SURFACE BEHAVIOR, INTERACTION=SI\n{tied}");
    let model = pair(0.0, "SURFACE TO SURFACE", LINEAR);
    let message = refused(&format!("{model}{}", steps(&[PRESS, &later], GROUND)));
    assert!(message.contains("becomes TIED"), "{message}");
}

#[test]
fn a_clearance_counts_whatever_the_meshes_say() {
    let model = |gap: f64| {
        let model = pair(gap, "SURFACE TO SURFACE", LINEAR);
        let clearance = "*CLEARANCE, MASTER=MASTER, SLAVE=SLAVE, VALUE=.0004\n*BOUNDARY\nB, 1\n";
        format!("{model}{clearance}{}", steps(&[PRESS], GROUND))
    };
    are(&forces(&run("clearance", &model(0.0))), &[0.2983745]);
    are(
        &forces(&run("clearance-of-a-gap", &model(0.01))),
        &[0.2983745],
    );
}

/// Displacements along z of nodes at the end of the last step.
fn z(run: &Run, nodes: &[u64]) -> Vec<f64> {
    nodes.iter().map(|n| run.u(*n)[2]).collect()
}

#[test]
fn equations_end_in_a_step_that_removes_them() {
    let tied = "*EQUATION\n2\n6, 3, 1., 5, 3, -1.\n2\n7, 3, 1., 5, 3, -1.\n2\n8, 3, 1., 5, 3, -1.\n*NSET, NSET=NE\n6, 7\n";
    let load = "*CLOAD\n6, 3, .1\n";
    let deck = |name: &str, cards: &[&str]| {
        let all: Vec<&str> = [load].iter().chain(cards).copied().collect();
        let text = format!("{}{tied}{}", column(), steps(&all, ""));
        z(&run(name, &text), &[5, 6, 7, 8])
    };
    are(&deck("equations-held", &[]), &[9.9985e-5; 4]);
    let one = "*EQUATION, REMOVE\n6, 3\n";
    let found = deck("equation-removed", &[one]);
    are(
        &found,
        &[-1.740004e-5, 4.519780e-4, -1.740004e-5, -1.740004e-5],
    );
    let found = deck("equations-of-a-set", &["*EQUATION, REMOVE\nNE, 1, 3\n"]);
    are(&found, &[0.0, 4.569442e-4, -5.714325e-5, 0.0]);
    let all = [-7.999652e-5, 4.797897e-4, -7.999652e-5, 7.997095e-5];
    are(
        &deck("equations-removed", &[one, "*EQUATION, REMOVE ALL\n"]),
        &all,
    );
    let message = refused(&format!("{}{tied}*EQUATION, REMOVE\n6, 3\n", column()));
    assert!(message.contains("outside of a step"), "{message}");
    let within = steps(&["*EQUATION\n2\n6, 3, 1., 5, 3, -1.\n"], "");
    let message = refused(&format!("{}{within}", column()));
    assert!(
        message.contains("equations begin before the first step"),
        "{message}"
    );
}

#[test]
fn displacements_before_the_first_step_grow_over_it_and_stay() {
    let model = format!("{}*BOUNDARY\nNTOP, 3, 3, .004\n", column());
    let print = "*NODE PRINT, NSET=NTOP\nU\n*END STEP\n";
    let first = format!("*STEP, NLGEOM\n*STATIC, DIRECT\n.25, 1.\n{print}");
    let second =
        format!("*STEP, NLGEOM\n*STATIC, DIRECT\n.5, 1.\n*BOUNDARY\nNTOP, 3, 3, .008\n{print}");
    let found = run("before", &format!("{model}{first}{second}")).course("displacements", 3);
    let found: Vec<f64> = found.iter().map(|p| p.1).collect();
    are(&found, &[0.001, 0.002, 0.003, 0.004, 0.006, 0.008]);
    // By an amplitude, over the time of the step.
    let model = model.replace("*BOUNDARY\nNTOP", "*BOUNDARY, AMPLITUDE=A\nNTOP");
    let model = format!("*AMPLITUDE, NAME=A\n0., 0., 1., 3.\n{model}");
    let found = run("before-amplitude", &format!("{model}{first}")).course("displacements", 3);
    near(found[0].1, 0.003, 1e-9);
    near(found[3].1, 0.012, 1e-9);
}
