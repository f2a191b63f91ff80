//! A mix: features that are drawn, and the texts of the problem that they make.

use std::collections::BTreeSet;

use super::apart::APART;
use super::feature::Feature;
use super::relation::{RELATIONS, Relation};
use super::sheet::Sheet;
use super::view::View;
use super::{bodies, drive, extras, laws, structure};
use crate::draw::{Random, digits};

/// A mix: its features, and how it is written.
pub struct Mix {
    /// The names of its features, in the order of the tables.
    pub features: BTreeSet<&'static str>,
    /// Its relations.
    pub relations: Vec<Relation>,
    /// How it is written.
    pub view: View,
    key: u64,
}

/// All features, in the order in which they add to a problem.
pub fn features() -> impl Iterator<Item = &'static Feature> {
    let structure = bodies::FEATURES
        .iter()
        .chain(laws::FEATURES)
        .chain(structure::FEATURES);
    structure.chain(drive::FEATURES).chain(extras::FEATURES)
}

/// The mix with a number of the series of a seed.
pub fn problem(seed: u64, number: u64) -> Mix {
    let key = number.wrapping_add(seed.wrapping_mul(0x1000_0000)) ^ 0x6D69_7865_7300_0000;
    let random = &mut Random::new(key);
    let features = choose(random);
    // Of solids, in metres and Pa, or in mm and MPa.
    let modulus = random.spread(1e7, 1e12);
    let speed = random.spread(300.0, 5000.0);
    let view = View {
        length: random.spread(1e-3, 10.0),
        modulus,
        density: digits(modulus / (speed * speed)),
        mirrored: false,
        shift: 0.0,
        swapped: false,
        remeshed: false,
        cut: false,
        split: false,
        renamed: false,
        unturned: false,
        exact: false,
        method: None,
    };
    let fitting: Vec<Relation> = RELATIONS
        .iter()
        .filter(|r| r.fits(&features))
        .copied()
        .collect();
    let view = match random.chance(0.5) {
        true => view,
        false => View {
            length: digits(view.length * 1e3),
            modulus: digits(view.modulus * 1e-6),
            density: digits(view.density * 1e-12),
            ..view
        },
    };
    let mut relations: Vec<Relation> = Vec::new();
    for _ in 0..2 {
        let relation = random.pick(&fitting);
        if relations.iter().all(|r| r.name != relation.name) {
            relations.push(relation);
        }
    }
    Mix {
        features,
        relations,
        view,
        key,
    }
}

impl Mix {
    /// In a line: what is not the most usual.
    pub fn words(&self) -> String {
        let plain = [
            "linear",
            "unilateral",
            "augmented",
            "mortar",
            "by-mesh",
            "no-more",
            "automatic",
            "elastic",
            "not-matching",
        ];
        let names = features()
            .map(|f| f.name)
            .filter(|n| self.features.contains(n) && !plain.contains(n));
        names.collect::<Vec<_>>().join(", ")
    }

    /// The problem file, written in a way.
    pub fn text(&self, view: View, title: &str) -> String {
        let mut sheet = Sheet::new(view, self.features.clone());
        let last_of_bodies = bodies::FEATURES.last().map_or("", |f| f.name);
        for (i, feature) in features().enumerate() {
            if self.features.contains(feature.name) {
                // Each has numbers of its own, whatever the others draw.
                let own = &mut Random::new(
                    self.key
                        .wrapping_mul(0x2545_F491_4F6C_DD1D)
                        .wrapping_add(i as u64),
                );
                (feature.add)(&mut sheet, own);
            }
            if feature.name == last_of_bodies && view.cut {
                structure::cut(&mut sheet);
            }
            if structure::FEATURES
                .last()
                .is_some_and(|f| f.name == feature.name)
            {
                structure::hold(&mut sheet);
            }
        }
        sheet.write(title)
    }
}

/// One feature of each group, and a few of the others, that go together.
fn choose(random: &mut Random) -> BTreeSet<&'static str> {
    let mut groups: Vec<&str> = Vec::new();
    for feature in features().filter(|f| !f.group.is_empty()) {
        if !groups.contains(&feature.group) {
            groups.push(feature.group);
        }
    }
    let mut chosen = loop {
        let chosen: BTreeSet<&'static str> = groups
            .iter()
            .map(|group| weighted(random, features().filter(|f| f.group == *group)))
            .collect();
        if sound(&chosen) {
            break chosen;
        }
    };
    let wanted = chosen.len() + random.whole(1, 4) as usize;
    for _ in 0..40 {
        if chosen.len() == wanted {
            break;
        }
        let mut more = chosen.clone();
        more.insert(weighted(random, features().filter(|f| f.group.is_empty())));
        if sound(&more) {
            chosen = more;
        }
    }
    chosen
}

/// Whether all that is needed is there, and nothing that cannot go together.
fn sound(chosen: &BTreeSet<&'static str>) -> bool {
    let here = || features().filter(|f| chosen.contains(f.name));
    let fits = here().all(|f| f.fits(chosen));
    fits && APART
        .iter()
        .all(|(a, b, _)| !(chosen.contains(a) && chosen.contains(b)))
}

fn weighted(random: &mut Random, rows: impl Iterator<Item = &'static Feature>) -> &'static str {
    let rows: Vec<&Feature> = rows.collect();
    let sum: f64 = rows.iter().map(|f| f.weight).sum();
    let mut rest = random.between(0.0, sum);
    for row in &rows {
        rest -= row.weight;
        if rest < 0.0 {
            return row.name;
        }
    }
    rows[0].name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_name_features_that_there_are() {
        let known: BTreeSet<&str> = features().map(|f| f.name).collect();
        let pairs = APART.iter().flat_map(|row| [row.0, row.1]);
        let needs = features().flat_map(|f| f.needs.iter().copied());
        let relations = RELATIONS
            .iter()
            .flat_map(|r| r.needs.iter().chain(r.not_with))
            .flat_map(|names| names.split(' '));
        let unknown: Vec<&str> = pairs
            .chain(needs)
            .chain(relations)
            .filter(|n| !known.contains(n))
            .collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }

    #[test]
    fn every_feature_and_every_relation_is_drawn() {
        let mixes: Vec<Mix> = (0..3000).map(|n| problem(1, n)).collect();
        let drawn: BTreeSet<&str> = mixes
            .iter()
            .flat_map(|m| m.features.iter().copied())
            .collect();
        let missing: Vec<&str> = features()
            .map(|f| f.name)
            .filter(|n| !drawn.contains(n))
            .collect();
        assert!(missing.is_empty(), "{missing:?}");
        let related: BTreeSet<&str> = mixes
            .iter()
            .flat_map(|m| &m.relations)
            .map(|r| r.name)
            .collect();
        assert_eq!(related.len(), RELATIONS.len(), "{related:?}");
    }

    #[test]
    fn a_mix_is_the_same_each_time() {
        let [a, b] = [problem(7, 3), problem(7, 3)];
        assert_eq!(a.text(a.view, ""), b.text(b.view, ""));
    }
}
