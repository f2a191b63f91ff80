//! Translation of decks that were never text: what each card becomes in the problem.

use std::path::Path;

use stickslip::problem::Problem;

use super::translate;
use crate::card::Place;
use crate::deck::{
    Action, Boundary, Deck, Elastic, Element, Material, Procedure, Section, Step, Target,
};

/// A unit cube of one element with a material, held at its lower face.
fn cube() -> Deck {
    let mut deck = Deck::default();
    for k in 0..8_u64 {
        let [x, y] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k as usize % 4];
        deck.nodes.insert(k + 1, [x, y, (k / 4) as f64]);
    }
    deck.elements.insert(
        7,
        Element {
            kind: "C3D8".into(),
            nodes: (1..=8).collect(),
            place: Place::default(),
        },
    );
    deck.element_sets.insert("ALL".into(), vec![7]);
    deck.node_sets.insert("FOOT".into(), (1..=4).collect());
    let steel = Elastic::Isotropic([210e3, 0.3]);
    deck.properties.materials.insert(
        "STEEL".into(),
        Material {
            elastic: Some(steel.clone()),
            elastic_at: vec![(0.0, steel)],
            density: Some(7.8e-9),
            density_at: vec![(0.0, 7.8e-9)],
            ..Material::default()
        },
    );
    deck.properties.sections.push(Section {
        set: "ALL".into(),
        material: "STEEL".into(),
        orientation: None,
        thickness: None,
        place: Place::default(),
    });
    deck.supports.push(held(0.0));
    deck
}

fn held(value: f64) -> Boundary {
    Boundary {
        target: Target::Set("FOOT".into()),
        components: vec![0, 1, 2],
        value,
        amplitude: None,
        fixed: false,
        place: Place::default(),
    }
}

fn force(node: u64, component: usize, value: f64) -> Action {
    Action::Force {
        target: Target::One(node),
        component,
        value,
        amplitude: None,
        imaginary: false,
        place: Place::default(),
    }
}

fn step(procedure: Procedure, actions: Vec<Action>) -> Step {
    Step {
        procedure,
        actions,
        ..Step::default()
    }
}

fn problem(deck: &Deck) -> Problem {
    let translation = translate(deck, Path::new("cube.inp")).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(translation.mesh_name, Path::new("cube.msh"));
    Problem::from_toml(&translation.toml, None).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn cards_become_the_tables_that_they_say() {
    let mut deck = cube();
    let rest = Procedure::Static {
        times: [0.25, 2.0, 0.0, 0.5],
        direct: false,
    };
    deck.steps.push(step(rest, vec![force(8, 2, -3.0)]));
    let problem = problem(&deck);
    assert_eq!(problem.body.len(), 1);
    assert_eq!(problem.material.len(), 1);
    assert!(problem.material.values().all(|m| m.at.is_empty()));
    let supports: Vec<_> = problem.support.values().collect();
    let [support] = supports[..] else {
        panic!("{supports:?}")
    };
    assert_eq!(
        [support.x, support.y, support.z],
        [Some(0.0), Some(0.0), Some(0.0)]
    );
    assert_eq!(problem.load.len(), 1, "{:?}", problem.load);
    let [one] = problem.step.as_slice() else {
        panic!("{:?}", problem.step)
    };
    assert_eq!(one.duration, 2.0);
    assert!(one.dynamic.is_none());
}

#[test]
fn what_changes_from_step_to_step_is_listed() {
    let mut deck = cube();
    let rest = || Procedure::Static {
        times: [0.0; 4],
        direct: false,
    };
    deck.steps.push(step(rest(), vec![force(8, 2, -3.0)]));
    // Forces stay unless they are cleared; the support moves on.
    deck.steps
        .push(step(rest(), vec![Action::Boundary(held(0.1))]));
    deck.steps
        .push(step(rest(), vec![Action::ClearForces, force(7, 0, 1.0)]));
    let problem = problem(&deck);
    assert_eq!(problem.step.len(), 3);
    let acting = |step: usize| -> usize {
        let listed = problem.step[step].loads.as_ref();
        listed.map_or(problem.load.len(), Vec::len)
    };
    assert_eq!([0, 1, 2].map(acting), [1, 1, 1]);
    assert_ne!(problem.step[1].loads, problem.step[2].loads);
    let moved = problem
        .support
        .values()
        .filter(|s| s.amplitude.is_some() || s.x == Some(0.1));
    assert!(moved.count() > 0, "{:?}", problem.support);
}

#[test]
fn a_deck_without_steps_is_refused() {
    let Err(refused) = translate(&cube(), Path::new("cube.inp")) else {
        panic!("there are no steps");
    };
    let refused = format!("{refused:?}");
    assert!(refused.contains("the deck has no step"), "{refused}");
}
