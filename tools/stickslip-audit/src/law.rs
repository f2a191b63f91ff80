//! The laws of an interface as the book states them, written down once more.

use toml::Table;

use crate::case::{Case, kind, number, numbers, rows};

/// A law of a problem file: its kind, and its keys.
#[derive(Debug, Clone, Copy)]
pub struct Law<'a> {
    /// Its kind.
    pub name: &'a str,
    /// Its keys.
    pub keys: &'a Table,
}

impl<'a> Law<'a> {
    /// That under a key of a table.
    pub fn of(table: &'a Table, key: &str) -> Option<Self> {
        let (name, keys) = kind(table, key)?;
        Some(Law { name, keys })
    }
}

/// Pressure of a normal law at a gap; `None` where the law is a constraint, or is not known here.
pub fn pressure(law: Law, gap: f64) -> Option<f64> {
    let Law { name, keys } = law;
    let of = |key: &str| number(keys, key).unwrap_or(f64::NAN);
    let depth = (-gap).max(0.0);
    Some(match name {
        "linear" => of("c") * depth,
        // Oden and Martins 1985: c δ^m.
        "power-law" => of("c") * depth.powf(of("m")),
        "tabular" => {
            let table = rows(keys.get("table"));
            let (a, b) = (&table[table.len() - 2], &table[table.len() - 1]);
            match depth > b[0] {
                true => b[1] + (depth - b[0]) * (b[1] - a[1]) / (b[0] - a[0]),
                false => crate::case::interpolate(&table, depth, 1),
            }
        }
        "exponential" => exponential(of("p0"), of("c0"), gap),
        "micro-contact" => micro_contact(keys, gap),
        _ => return None,
    })
}

/// How deep a law lets a point come that it presses with this, by halving; zero for a constraint, and for a law that is not known here.
pub fn depth(law: Law, wanted: f64) -> f64 {
    let presses = |depth: f64| pressure(law, -depth);
    let mut deep = f64::MIN_POSITIVE;
    while presses(deep).is_some_and(|p| p < wanted) && deep < 1e100 {
        deep *= 16.0;
    }
    let mut shallow = 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (shallow + deep);
        match presses(middle).is_some_and(|p| p < wanted) {
            true => shallow = middle,
            false => deep = middle,
        }
    }
    shallow
}

/// `p0 exp(-ln 100 gap / c0)` between `-5 c0` and `c0`, and its tangents beyond.
fn exponential(p0: f64, c0: f64, gap: f64) -> f64 {
    let rate = 100f64.ln() / c0;
    let at = gap.min(c0).max(-5.0 * c0);
    let p = p0 * (-rate * at).exp();
    (p * (1.0 - rate * (gap - at))).max(0.0)
}

/// Zavarise, Wriggers, Stein and Schrefler 1992, eq. 13, with the straight beginning and the parabola at the end that the book describes.
fn micro_contact(keys: &Table, gap: f64) -> f64 {
    let of = |key: &str| number(keys, key).unwrap_or(f64::NAN);
    let (c2, sigma) = (of("c2"), of("sigma"));
    let k = 1.0 + 0.0711 * c2;
    let width = 1.363 * sigma;
    let front = of("c1") * (1617646.152 * sigma / of("slope")).powf(c2) / 5.589f64.powf(k);
    let curve = |d: f64| front * (-k * d * d / (width * width)).exp();
    let slope = |d: f64| -2.0 * k * d / (width * width) * curve(d);
    let end = 5.0 * sigma;
    let reach = -2.0 * curve(end) / slope(end);
    let d = number(keys, "separation").unwrap_or(end + reach) + gap;
    let bend = width / (2.0 * k).sqrt();
    if d < bend {
        curve(bend) + slope(bend) * (d - bend)
    } else if d <= end {
        curve(d)
    } else {
        curve(end) * (1.0 - (d - end) / reach).max(0.0).powi(2)
    }
}

/// What a friction law looks at.
#[derive(Debug, Clone, Copy)]
pub struct Rubbing {
    /// Pressure.
    pub pressure: f64,
    /// Penetration.
    pub depth: f64,
    /// Speed of sliding.
    pub speed: f64,
    /// Whether the point slid at the state before.
    pub slid: bool,
}

/// The largest shear that a friction law carries; `None` for a law that is not known here.
pub fn limit(law: Law, at: Rubbing) -> Option<f64> {
    let Law { name, keys } = law;
    let of = |key: &str| number(keys, key).unwrap_or(0.0);
    let falling = |share: f64| of("kinetic") + (of("static") - of("kinetic")) * share;
    let p = at.pressure;
    let value = match name {
        "none" => 0.0,
        "coulomb" => of("mu") * p,
        // Pop 1995, eq. (6).
        "power-law" => of("c") * at.depth.powf(of("m")),
        "static-kinetic" => p * if at.slid { of("kinetic") } else { of("static") },
        "exponential-decay" => p * falling((-of("decay") * at.speed).exp()),
        "stribeck" => {
            let power = (at.speed / of("velocity")).powf(number(keys, "exponent").unwrap_or(1.0));
            p * falling((-power).exp()) + of("viscous") * at.speed
        }
        "tabular" => p * coefficient(keys, p, at.speed)?,
        _ => return None,
    };
    Some(value.min(number(keys, "cap").unwrap_or(f64::INFINITY)))
}

/// Bilinear between the entries of the table, constant outside.
fn coefficient(keys: &Table, pressure: f64, speed: f64) -> Option<f64> {
    let (pressures, speeds) = (numbers(keys, "pressures"), numbers(keys, "speeds"));
    let mut table = rows(keys.get("mu"));
    if speeds.is_empty() && table.len() == 1 {
        table = table[0].iter().map(|mu| vec![*mu]).collect();
    }
    let across = |row: &Vec<f64>| {
        let pairs: Vec<Vec<f64>> = match speeds.is_empty() {
            true => vec![vec![0.0, *row.first()?]],
            false => speeds
                .iter()
                .zip(row)
                .map(|(v, mu)| vec![*v, *mu])
                .collect(),
        };
        Some(crate::case::interpolate(&pairs, speed, 1))
    };
    let column: Option<Vec<Vec<f64>>> = table
        .iter()
        .enumerate()
        .map(|(i, row)| Some(vec![pressures.get(i).copied().unwrap_or(0.0), across(row)?]))
        .collect();
    Some(crate::case::interpolate(&column?, pressure, 1))
}

/// The part of the limit that a smooth rule carries at a speed: Pop 1995, eq. (20).
pub fn smooth(epsilon: f64, speed: f64) -> f64 {
    let r = (speed / epsilon).min(1.0);
    (2.0 - r) * r
}

/// The laws of an interface that hold in a step: `[interface.NAME]`, and what steps up to this one change.
pub struct Laws<'a> {
    /// Kind and keys of the normal law.
    pub normal: Law<'a>,
    /// Kind and keys of the friction law.
    pub friction: Law<'a>,
    /// ε of the smooth rule, if it is that.
    pub epsilon: Option<f64>,
}

/// Reads the laws that hold in a step.
pub fn laws<'a>(case: &'a Case, name: &str, step: usize) -> Option<Laws<'a>> {
    let table = case.of("interface", name)?;
    let mut normal = Law::of(table, "normal")?;
    let mut friction = Law::of(table, "friction")?;
    for step in &case.steps[..=step.min(case.steps.len() - 1)] {
        let change = step
            .table
            .get("change")
            .and_then(|c| c.get(name)?.as_table());
        if let Some(change) = change {
            normal = Law::of(change, "normal").unwrap_or(normal);
            friction = Law::of(change, "friction").unwrap_or(friction);
        }
    }
    let (rule, keys) = kind(table, "slip")?;
    let epsilon = match rule {
        "regularised" => number(keys, "epsilon"),
        _ => None,
    };
    Some(Laws {
        normal,
        friction,
        epsilon,
    })
}

#[cfg(test)]
mod tests {
    use super::{Law, Rubbing, Table, depth, limit, pressure, smooth};

    fn keys(text: &str) -> toml::Table {
        toml::from_str(text).expect("a table")
    }

    fn of<'a>(name: &'a str, keys: &'a Table) -> Law<'a> {
        Law { name, keys }
    }

    #[test]
    fn a_law_is_as_deep_as_it_presses() {
        for (name, text) in [
            ("linear", "c = 3.2e4"),
            ("power-law", "c = 1e8\nm = 2.5"),
            ("tabular", "table = [[0, 0], [1e-3, 5.0], [2e-3, 40.0]]"),
            ("exponential", "p0 = 2.0\nc0 = 1e-4"),
        ] {
            let law = keys(text);
            for wanted in [3.0, 35.0, 900.0] {
                let deep = depth(of(name, &law), wanted);
                let found = pressure(of(name, &law), -deep).unwrap_or(f64::NAN);
                assert!((found - wanted).abs() < 1e-9 * wanted, "{name}: {found}");
            }
        }
        assert_eq!(depth(of("unilateral", &keys("")), 3.0), 0.0);
    }

    #[test]
    fn the_numbers_of_the_book_come_out() {
        let law = keys("p0 = 1e7\nc0 = 1e-5");
        assert!((pressure(of("exponential", &law), 1e-5).expect("a pressure") - 1e5).abs() < 1e-6);
        let law = keys("table = [[0, 0], [1, 1], [2, 4]]");
        assert_eq!(pressure(of("tabular", &law), -3.0), Some(7.0));
        let law = keys("pressures = [0, 2]\nspeeds = [0, 1]\nmu = [[0.4, 0.2], [0.2, 0.1]]");
        let at = Rubbing {
            pressure: 1.0,
            depth: 0.0,
            speed: 0.5,
            slid: true,
        };
        assert!((limit(of("tabular", &law), at).expect("a limit") - 0.225).abs() < 1e-15);
        assert_eq!([smooth(1.0, 0.5), smooth(1.0, 3.0)], [0.75, 1.0]);
    }
}
