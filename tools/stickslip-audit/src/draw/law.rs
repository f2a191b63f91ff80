//! The laws of the interface of a problem.

use super::random::{Random, digits};

/// What laws are scaled with, so that each of them matters.
pub struct Scale {
    /// Whether lengths are metres.
    pub metres: bool,
    /// A pressure as it will be.
    pub pressure: f64,
    /// The approach of the bodies.
    pub approach: f64,
    /// A distance that the bodies slide in one unit of time.
    pub slide: f64,
}

/// Keys of a table `[interface.NAME]`, and what they are in a word each.
pub struct Laws {
    /// The keys.
    pub text: String,
    /// For the description.
    pub words: String,
    /// The coefficient of friction.
    pub mu: f64,
    /// Whether the normal law gives way.
    pub compliant: bool,
}

/// Draws the laws.
pub fn laws(random: &mut Random, scale: &Scale) -> Laws {
    let (normal, mut text, penetration) = normal(random, scale);
    let mu = match random.chance(0.08) {
        true => 0.0,
        false => random.between(0.02, 1.0),
    };
    let mut words = normal.to_string();
    if mu > 0.0 {
        let (friction, line) = friction(random, scale, mu, penetration);
        text.push_str(&line);
        words.push_str(&format!(", {friction} {mu}"));
        if random.chance(0.15) {
            let epsilon = digits(scale.slide * random.spread(0.01, 0.3));
            text.push_str(&format!("slip.regularised = {{ epsilon = {epsilon:e} }}\n"));
            words.push_str(", regularised");
        }
    } else {
        words.push_str(", no friction");
    }
    Laws {
        text,
        words,
        mu,
        compliant: normal != "unilateral",
    }
}

/// A normal law: its name, its line and the penetration that belongs to the pressure of the scale, if the law has powers.
fn normal(random: &mut Random, scale: &Scale) -> (&'static str, String, Option<f64>) {
    let p = scale.pressure;
    let yields = digits(scale.approach * random.spread(1e-3, 0.3));
    match random.whole(1, 20) {
        1..=10 => ("unilateral", String::new(), None),
        // The micro-contact law is written for metres.
        17..=18 if scale.metres => {
            let sigma = random.spread(5e-7, 3e-6);
            let c1 = digits(p * random.spread(100.0, 1000.0));
            let line = format!(
                "normal.micro-contact = {{ c1 = {c1:e}, c2 = -0.2, sigma = {sigma:e}, slope = 0.1 }}\n"
            );
            ("micro-contact", line, None)
        }
        11..=13 | 17..=18 => {
            let c = digits(p / yields);
            let line = format!("normal.linear = {{ c = {c:e} }}\n");
            ("linear", line, Some(yields))
        }
        16 => {
            let p0 = digits(p * random.spread(0.01, 1.0));
            let line = format!("normal.exponential = {{ p0 = {p0:e}, c0 = {yields:e} }}\n");
            ("exponential", line, None)
        }
        14..=15 => {
            let m = random.between(1.2, 3.0);
            let c = digits(p / yields.powf(m));
            let line = format!("normal.power-law = {{ c = {c:e}, m = {m} }}\n");
            ("power-law", line, Some(yields))
        }
        _ => {
            let rows = [[0.0, 0.0], [0.5, 0.25], [1.0, 1.0], [2.0, 4.0]];
            let rows = rows.map(|[d, q]| format!("[{:e}, {:e}]", d * yields, q * p));
            let line = format!("normal.tabular = {{ table = [{}] }}\n", rows.join(", "));
            ("tabular", line, Some(yields))
        }
    }
}

/// A friction law: its name and its line.
fn friction(
    random: &mut Random,
    scale: &Scale,
    mu: f64,
    penetration: Option<f64>,
) -> (&'static str, String) {
    let p = scale.pressure;
    let v = scale.slide;
    let kinetic = digits(mu * random.between(0.6, 1.0));
    match random.whole(1, 20) {
        1..=7 => ("coulomb", format!("friction.coulomb = {{ mu = {mu} }}\n")),
        8..=9 => {
            let cap = digits(0.7 * mu * p);
            let line = format!("friction.coulomb = {{ mu = {mu}, cap = {cap:e} }}\n");
            ("capped coulomb", line)
        }
        10..=12 => {
            let line =
                format!("friction.static-kinetic = {{ static = {mu}, kinetic = {kinetic} }}\n");
            ("static-kinetic", line)
        }
        13..=14 => {
            let decay = digits(random.spread(0.3, 3.0) / v);
            let line = format!(
                "friction.exponential-decay = {{ static = {mu}, kinetic = {kinetic}, decay = {decay:e} }}\n"
            );
            ("exponential-decay", line)
        }
        15..=16 => {
            let velocity = digits(v * random.between(0.2, 1.0));
            let viscous = match random.chance(0.5) {
                true => digits(0.05 * mu * p / v),
                false => 0.0,
            };
            let exponent = random.pick(&[1, 2]);
            let line = format!(
                "friction.stribeck = {{ static = {mu}, kinetic = {kinetic}, velocity = {velocity:e}, exponent = {exponent}, \
                 viscous = {viscous:e} }}\n"
            );
            ("stribeck", line)
        }
        17..=18 if penetration.is_some() => {
            let d = penetration.unwrap_or(1.0);
            let m = random.between(1.0, 2.0);
            let c = digits(mu * p / d.powf(m));
            let line = format!("friction.power-law = {{ c = {c:e}, m = {m} }}\n");
            ("power-law", line)
        }
        _ => {
            let low = digits(0.9 * kinetic);
            let line = format!(
                "friction.tabular = {{ pressures = [{:e}, {:e}], speeds = [0, {v:e}], mu = [[{mu}, {kinetic}], [{kinetic}, {low}]] }}\n",
                digits(0.5 * p),
                digits(2.0 * p)
            );
            ("tabular", line)
        }
    }
}
