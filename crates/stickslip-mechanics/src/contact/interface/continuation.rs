//! Friction made easier, for equilibria that Newton's method does not find at once.

use super::definition::Interface;
use crate::system::{Continuation, Way};

/// Stick that yields like the bodies at first, then ever more stiffly.
const STICK: &str = "softer-stick";

/// A part of the limit of friction at first, then all of it.
const LIMIT: &str = "partial-friction";

/// Parts of the limit.
const PARTS: [f64; 4] = [0.25, 0.5, 0.75, 0.9];

/// Stiffnesses of stick at which a path begins, relative to that of the bodies: what holds a body may be far softer than the body itself.
const FIRST: [f64; 4] = [1.0, 1e-3, 1e-6, 1e-9];

/// The stiffness at which a path ends, relative to that of the bodies: as stiff as the law itself.
const LAST: f64 = 3e4;

impl Continuation for Interface {
    fn ways(&self) -> Vec<Way> {
        let mut ways: Vec<Way> = FIRST
            .iter()
            .map(|&first| Way {
                name: STICK,
                values: stiffnesses(first),
            })
            .collect();
        ways.push(Way {
            name: LIMIT,
            values: PARTS.to_vec(),
        });
        ways
    }

    fn ease(&mut self, to: Option<(&'static str, f64)>) {
        let of = |name| to.filter(|(way, _)| *way == name).map(|(_, value)| value);
        self.directives.softening = of(STICK);
        self.directives.mobilised = of(LIMIT);
    }
}

/// The first one times 1, 3, 10, 30, …
fn stiffnesses(first: f64) -> Vec<f64> {
    (0..)
        .map(|k| first * 10_f64.powi(k / 2) * if k % 2 == 0 { 1.0 } else { 3.0 })
        .take_while(|&factor| factor <= LAST)
        .collect()
}
