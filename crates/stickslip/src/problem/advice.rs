//! Where a value belongs that stands where a table is wanted, and a key that is not known where it stands.
//!
//! Both follow from the schema: a table with one required key takes its value there, a family in the first kind that has a place for it.
//! Where more than one key would do, [`USUAL`] says which one people mean.

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::DeValue;

use super::expected::{Expected, accepts};
use super::key;
use super::nearest::{nearest, suggest, synonym};
use super::tree::{Value, number};
use crate::number::digits;
use crate::units;

/// Where a value without a key is meant to go, by the key of the table that it stands for: the first that takes it.
pub(super) const USUAL: &[(&str, &[&str])] = &[
    ("body", &["NAME.gmsh.file"]),
    ("box", &["to"]),
    ("checkpoint", &["minutes"]),
    ("enforcement", &["penalty.stiffness"]),
    ("friction", &["coulomb.mu"]),
    ("increments", &["fixed", "initial"]),
    ("isotropic", &["young"]),
    ("material", &["NAME.isotropic.young"]),
    ("output", &["every", "times"]),
    ("penalty", &["stiffness"]),
    ("rayleigh", &["stiffness"]),
    ("rectangle", &["to"]),
    ("solver", &["method", "tolerance"]),
    ("step", &["duration"]),
];

/// Words for which there is no key, and what to do instead.
const WORDLESS: &[(&[&str], &str)] = &[
    (
        &["gap"],
        "the initial gap follows from the meshes: move a body by `body.NAME.translate = [0, 0.1]`; `interface.NAME.initial` closes or keeps an initial gap",
    ),
    (
        &["3d", "3D", "three-dimensional"],
        "three dimensions are `solid`",
    ),
    (
        &["2d", "2D", "plane"],
        "two dimensions are `plane-strain`, `plane-stress` (thin bodies, with `thickness`) or `axisymmetric`",
    ),
    (
        &["elastic", "linear-elastic", "linear"],
        "linear elasticity is `isotropic = { young = 210e9, poisson = 0.3 }`, `orthotropic` or `anisotropic`",
    ),
    (
        &[
            "plastic",
            "plasticity",
            "elastoplastic",
            "yield",
            "yield-stress",
            "hardening",
        ],
        "bodies are linear elastic: there is no plasticity",
    ),
    (
        &[
            "neo-hooke",
            "neo-hookean",
            "mooney-rivlin",
            "ogden",
            "hyperelastic",
            "rubber",
        ],
        "bodies are linear elastic, with small strains: large strains of rubber need a hyperelastic program",
    ),
    (
        &["fixed", "fix", "clamped", "clamp", "encastre"],
        "a support prescribes displacements: `x = 0, y = 0`, and `z = 0` in space, hold all of a body",
    ),
    (
        &["force", "traction", "pressure"],
        "forces and pressures are loads: `load.NAME = { set = \"body.set\", traction = { value = [0, -1e6] } }`",
    ),
    (
        &[
            "u1", "u2", "u3", "ux", "uy", "uz", "U1", "U2", "U3", "dx", "dy", "dz",
        ],
        "displacements are `x`, `y` and `z`",
    ),
    (
        &["shell", "shells", "beam", "beams", "truss", "membrane"],
        "bodies are solids, meshed in the plane or in space: there are no shells, beams or trusses",
    ),
    (
        &[
            "conductivity",
            "specific-heat",
            "heat-capacity",
            "heat",
            "thermal-conductivity",
        ],
        "there is no heat conduction: temperatures are given, by `temperature.NAME`, and `expansion` of a material makes them strain",
    ),
    (
        &["self-contact", "self"],
        "there is no self-contact of one surface: two surfaces of a body that face each other can be `secondary` and `primary`",
    ),
];

/// What to do instead of a word for which there is none here.
pub(super) fn instead(word: &str) -> Option<&'static str> {
    let known = WORDLESS.iter().find(|(words, _)| words.contains(&word));
    known.map(|(_, advice)| *advice)
}

/// What to write in place of a number with a unit. Problem files have none: one unit a number would be wrong in all files that are in millimetres, and to
/// convert all numbers it would take the dimension of every key and of every constant of a law.
pub(super) fn without_unit(text: &str) -> Option<String> {
    let (value, unit) = units::split(text).filter(|(_, unit)| !unit.is_empty())?;
    let (factor, _) = units::in_base_units(unit).ok()?;
    Some(format!(
        "numbers have no units: any consistent set will do; in metres, kilograms and seconds this is {}",
        digits(value * factor, 8)
    ))
}

/// The name of an entry of which only the user knows the name.
const NAME: &str = "NAME";

/// How many tables below one another are looked through.
const TABLE_DEPTH: usize = 6;

/// How many places a key may have to be spoken of.
const PLACES: usize = 3;

/// Longest value that is repeated.
const LONGEST_VALUE: usize = 40;

/// Whether a key takes the name of one set.
fn wants_one_set(path: &[String], expected: &Expected) -> bool {
    let sets = ["set", "secondary", "primary"];
    let key = path.last().is_some_and(|key| sets.contains(&key.as_str()));
    key && expected.allows("string") && !expected.allows("array")
}

/// What to write where a table, or a list of tables, is wanted at `path` and something else was found.
pub(super) fn place(
    root: &Json,
    path: &[String],
    expected: &Expected,
    found: &Value,
) -> Option<String> {
    let schema = Schema { root };
    if let (DeValue::Array(names), true) = (found, wants_one_set(path, expected)) {
        let names = names.iter().filter_map(|name| name.get_ref().as_str());
        let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
        return Some(format!(
            "one set is wanted here: join several by `set.all.union = [{}]`, and write `{} = \"all\"`",
            names.join(", "),
            path.last().map_or("set", String::as_str)
        ));
    }
    if let Some(example) = misnamed(&schema, path, found) {
        return Some(example);
    }
    let here = Here::of(&schema, path);
    if let Some(entries) = expected.own.get("items") {
        let entry = Expected::of(root, entries);
        let example = match found {
            _ if !entry.takes_table() => return None,
            DeValue::Table(_) => {
                return Some(format!(
                    "it is a list of tables: write `[[{}]]` above the keys of each",
                    key::join(path)
                ));
            }
            _ => schema.example(&entry, here.table(path), found),
        };
        return Some(format!("write `{}`", here.entry(&example.0, &example.1)));
    }
    if !expected.takes_table() {
        return None;
    }
    let kinds: Vec<&str> = expected.kinds.iter().map(|(k, _)| *k).collect();
    let example = schema.example(expected, here.table(path), found);
    let example = here.write(&example.0, &example.1);
    let own_name = match example.contains(NAME) {
        true => ", with a name of your own for NAME",
        false => "",
    };
    Some(match (&kinds[..], found) {
        ([], _) => format!("write `{example}`{own_name}"),
        (_, DeValue::String(_)) => {
            format!(
                "the kind is a key: `{example}`; kinds: {}",
                kinds.join(", ")
            )
        }
        _ => format!("write `{example}`; kinds: {}", kinds.join(", ")),
    })
}

/// What to do about a key that is unknown at `path` among `names`, those of the table there.
pub(super) fn elsewhere(
    root: &Json,
    path: &[String],
    table: &Expected,
    names: &[&str],
    found: &Value,
) -> String {
    let all = || suggest("", "allowed here", names);
    let Some((name, parents)) = path.split_last() else {
        return all();
    };
    let schema = Schema { root };
    let mut words = std::iter::once(name.as_str()).chain(synonym(name));
    let below = words.clone().find_map(|w| schema.written(table, w, found));
    if let Some(examples) = below {
        return format!("write {examples}; {}", all());
    }
    if nearest(name, names).is_some() {
        return suggest(name, "allowed here", names);
    }
    if let Some(advice) = instead(name) {
        return advice.into();
    }
    let whole = Expected::of(root, root);
    let away = words.find_map(|w| match found {
        DeValue::Table(_) => schema.heading(&whole, w),
        _ => schema.written(&whole, w, found),
    });
    match away.filter(|_| !parents.is_empty()) {
        Some(examples) => format!("it belongs elsewhere: {examples}; {}", all()),
        None => all(),
    }
}

/// For `material = { young = 210e9 }`: the key stands where the name of an entry is wanted.
fn misnamed(schema: &Schema, path: &[String], found: &Value) -> Option<String> {
    let (name, parents) = path.split_last()?;
    let table = schema.at(parents)?;
    let entry = Expected::of(schema.root, table.entry()?);
    let keys = schema.located(&entry, name, found).into_iter().next()?;
    let (tail, value) = schema.form(&entry, &keys, &text(found));
    let what = parents.last()?;
    let example = join(&[parents, &[NAME.to_string()], &tail].concat(), &value);
    Some(format!(
        "a name stands between the two: write `{example}`, with the name of the {what} for NAME"
    ))
}

/// How an example is written where the value stands.
struct Here {
    /// The keys that lead to it, as far as they are repeated.
    keys: Vec<String>,
    /// The value is an entry of a list.
    in_list: bool,
}

impl Here {
    fn of(schema: &Schema, path: &[String]) -> Self {
        let Some((last, parents)) = path.split_last() else {
            return Here {
                keys: Vec::new(),
                in_list: false,
            };
        };
        let above = schema.at(parents);
        if above.as_ref().is_some_and(Expected::is_list) {
            return Here {
                keys: parents.last().cloned().into_iter().collect(),
                in_list: true,
            };
        }
        // A name says more behind the kind of thing that it names.
        let named = above.is_some_and(|table| table.entry().is_some());
        let count = if named { 2 } else { 1 };
        let first = path.len().saturating_sub(count);
        let mut keys = path[first..].to_vec();
        if keys.is_empty() {
            keys.push(last.clone());
        }
        Here {
            keys,
            in_list: false,
        }
    }

    /// The word for the table: its key, or that of the tables of which it is one.
    fn table<'p>(&'p self, path: &'p [String]) -> &'p str {
        let last = path.last().map_or("", String::as_str);
        self.keys.first().map_or(last, String::as_str)
    }

    fn write(&self, keys: &[String], value: &str) -> String {
        if self.in_list {
            return self.entry(keys, value);
        }
        join(&[self.keys.as_slice(), keys].concat(), value)
    }

    /// The same as the entry of a list.
    fn entry(&self, keys: &[String], value: &str) -> String {
        let entry = match keys.is_empty() {
            true => value.to_string(),
            false => format!("{{ {} }}", join(keys, value)),
        };
        join(&self.keys, &format!("[{entry}]"))
    }
}

/// The schema, and what is looked for in it.
struct Schema<'s> {
    root: &'s Json,
}

impl<'s> Schema<'s> {
    /// What is expected at a path.
    fn at(&self, path: &[String]) -> Option<Expected<'s>> {
        let mut expected = Expected::of(self.root, self.root);
        for segment in path {
            let next = match expected.is_list() {
                true => expected.own.get("items"),
                false => expected.child(segment),
            };
            expected = Expected::of(self.root, next?);
        }
        Some(expected)
    }

    /// Keys below a table, and the value there, by which `found` can be written; `name`: what the table is called.
    fn example(&self, table: &Expected<'s>, name: &str, found: &Value) -> (Vec<String>, String) {
        if let DeValue::String(word) = found {
            let kinds: Vec<&str> = table.kinds.iter().map(|(kind, _)| *kind).collect();
            let kind = nearest(word, &kinds).map(|kind| vec![kind.to_string()]);
            if let Some(keys) = kind.or_else(|| self.named_below(table, word)) {
                return self.outline(table, &keys);
            }
        }
        if let Some(keys) = self.fit(table, name, found, TABLE_DEPTH) {
            return self.form(table, &keys, &text(found));
        }
        if let Some((keys, value)) = self.lifted(table, name, found) {
            return self.form(table, &keys, &value);
        }
        self.outline(table, &[])
    }

    /// For a number where a list of components is wanted.
    fn lifted(
        &self,
        table: &Expected<'s>,
        name: &str,
        found: &Value,
    ) -> Option<(Vec<String>, String)> {
        number(found)?;
        let mut list = toml::de::DeArray::new();
        list.push(Spanned::new(0..0, found.clone()));
        list.push(Spanned::new(0..0, found.clone()));
        let keys = self.fit(table, name, &DeValue::Array(list), TABLE_DEPTH)?;
        let last = keys.last().map_or("", String::as_str);
        // Weight points down.
        let sign = match last == "acceleration" && number(found)? > 0.0 {
            true => "-",
            false => "",
        };
        let value = format!("[0, {sign}{}]", text(found));
        Some((keys, value))
    }

    /// The keys below a table that lead to where a value belongs.
    fn fit(
        &self,
        table: &Expected<'s>,
        name: &str,
        found: &Value,
        depth: usize,
    ) -> Option<Vec<String>> {
        let usual = USUAL.iter().filter(|(key, _)| *key == name);
        let mut usual = usual.flat_map(|(_, paths)| *paths).map(|p| split(p));
        if let Some(path) = usual.find(|path| self.takes(table, path, found)) {
            return Some(path);
        }
        if depth == 0 {
            return None;
        }
        if let Some(entry) = table.entry() {
            let below = Expected::of(self.root, entry);
            let path = match accepts(self.root, entry, found) {
                true => Some(Vec::new()),
                false => self.fit(&below, name, found, depth - 1),
            };
            return path.map(|path| behind(NAME, path));
        }
        self.required_fit(table, found)
            .or_else(|| self.optional_fit(table, found, depth))
    }

    /// A required key that takes the value, here or in a kind that requires nothing else.
    fn required_fit(&self, table: &Expected<'s>, found: &Value) -> Option<Vec<String>> {
        let takes = |table: &Expected<'s>, key: &&&str| {
            let schema = table.child(key);
            schema.is_some_and(|schema| accepts(self.root, schema, found))
        };
        let required = table.required();
        if let Some(key) = required.iter().find(|key| takes(table, key)) {
            return Some(vec![key.to_string()]);
        }
        table.kinds.iter().find_map(|(kind, schema)| {
            if accepts(self.root, schema, found) {
                return Some(vec![kind.to_string()]);
            }
            let inner = Expected::of(self.root, schema);
            let required = inner.required();
            let alone = required.len() == 1 && takes(&inner, &&required[0]);
            alone.then(|| vec![kind.to_string(), required[0].to_string()])
        })
    }

    /// An optional key that takes the value: the first, or one of a table further down.
    fn optional_fit(
        &self,
        table: &Expected<'s>,
        found: &Value,
        depth: usize,
    ) -> Option<Vec<String>> {
        // What has parts that are required is no number with a decoration.
        if table.required().len() > 1 {
            return None;
        }
        let takes = |schema: &Json| accepts(self.root, schema, found);
        let taking: Vec<&str> = (table.properties.iter())
            .filter(|(_, schema)| takes(schema))
            .map(|(key, _)| *key)
            .collect();
        let below = || {
            table.keys().find_map(|(key, schema)| {
                let inner = Expected::of(self.root, schema);
                let path = inner
                    .takes_table()
                    .then(|| self.fit(&inner, key, found, depth - 1))??;
                Some(behind(key, path))
            })
        };
        match taking.first() {
            Some(first) => Some(vec![first.to_string()]),
            None => below(),
        }
    }

    /// Whether a path below a table exists and takes the value.
    fn takes(&self, table: &Expected<'s>, path: &[String], found: &Value) -> bool {
        let Some((first, rest)) = path.split_first() else {
            return false;
        };
        table.child(first).is_some_and(|schema| match rest {
            [] => accepts(self.root, schema, found),
            _ => self.takes(&Expected::of(self.root, schema), rest, found),
        })
    }

    /// Paths below a table to the keys of this name that lie least deep.
    fn named(&self, table: &Expected<'s>, name: &str) -> Vec<Vec<String>> {
        let mut level = vec![(Vec::new(), table.keys().collect::<Vec<_>>(), table.entry())];
        for _ in 0..TABLE_DEPTH {
            let mut found = Vec::new();
            let mut next = Vec::new();
            for (path, keys, entry) in level {
                let named = keys.into_iter().chain(entry.map(|schema| (NAME, schema)));
                for (key, schema) in named {
                    let here = [path.as_slice(), &[key.to_string()]].concat();
                    let inner = Expected::of(self.root, schema);
                    if key == name {
                        found.push(here.clone());
                    }
                    next.push((here, inner.keys().collect(), inner.entry()));
                }
            }
            if !found.is_empty() {
                return found;
            }
            level = next;
        }
        Vec::new()
    }

    /// The first of them that is a table of its own.
    fn named_below(&self, table: &Expected<'s>, name: &str) -> Option<Vec<String>> {
        let all = self.named(table, name);
        all.into_iter()
            .find(|path| self.table_at(table, path).is_some())
    }

    fn table_at(&self, table: &Expected<'s>, path: &[String]) -> Option<Expected<'s>> {
        let mut schema = None;
        for key in path {
            let inner = schema.map(|schema| Expected::of(self.root, schema));
            schema = Some(inner.as_ref().unwrap_or(table).child(key)?);
        }
        let inner = Expected::of(self.root, schema?);
        inner.takes_table().then_some(inner)
    }

    /// The keys by which a value can be written under this name somewhere below a table.
    fn located(&self, table: &Expected<'s>, name: &str, found: &Value) -> Vec<Vec<String>> {
        let all = self.named(table, name).into_iter();
        let taken = all.filter_map(|path| {
            if self.takes(table, &path, found) {
                return Some(path);
            }
            let inner = self.table_at(table, &path)?;
            let rest = self.fit(&inner, name, found, 1)?;
            Some([path, rest].concat())
        });
        taken.collect()
    }

    /// The same as examples, if there are not too many.
    fn written(&self, table: &Expected<'s>, name: &str, found: &Value) -> Option<String> {
        let mut examples: Vec<String> = Vec::new();
        for keys in self.located(table, name, found) {
            let (keys, value) = self.beside(table, &keys, &text(found));
            examples.push(format!("`{}`", join(&keys, &value)));
        }
        if examples.is_empty()
            && let Some(path) = self.named_below(table, name)
            && let Some(inner) = self.table_at(table, &path)
            && let Some((rest, value)) = self.lifted(&inner, name, found)
        {
            let (keys, value) = self.beside(table, &[path, rest].concat(), &value);
            examples.push(format!("`{}`", join(&keys, &value)));
        }
        let few = (1..=PLACES).contains(&examples.len());
        few.then(|| examples.join(" or "))
    }

    /// The heading of the table of this name that lies least deep.
    fn heading(&self, table: &Expected<'s>, name: &str) -> Option<String> {
        let path = self.named_below(table, name)?;
        let named = self
            .table_at(table, &path)?
            .entry()
            .map(|_| NAME.to_string());
        let all: Vec<String> = path.into_iter().chain(named).collect();
        Some(format!("`[{}]`", key::join(&all)))
    }

    /// The same as [`form`](Self::form) for a table that is there already, with what it requires or without.
    fn beside(&self, table: &Expected<'s>, keys: &[String], value: &str) -> (Vec<String>, String) {
        let Some((first, rest)) = keys.split_first() else {
            return (Vec::new(), value.to_string());
        };
        let Some(schema) = table.child(first) else {
            return (keys.to_vec(), value.to_string());
        };
        let inner = Expected::of(self.root, schema);
        let (tail, value) = self.form(&inner, rest, value);
        (behind(first, tail), value)
    }

    /// Keys and value with all that is required beside them, its values left open.
    fn form(&self, table: &Expected<'s>, keys: &[String], value: &str) -> (Vec<String>, String) {
        let Some((first, rest)) = keys.split_first() else {
            return (Vec::new(), value.to_string());
        };
        let inner = table.child(first).map(|s| Expected::of(self.root, s));
        let (tail, value) = match &inner {
            Some(inner) => self.form(inner, rest, value),
            None => (rest.to_vec(), value.to_string()),
        };
        let tail = behind(first, tail);
        let required = table.required();
        if required.iter().all(|key| key == first) {
            return (tail, value);
        }
        let own = join(&tail, &value);
        let known = required.contains(&first.as_str());
        let mut entries: Vec<String> = required
            .iter()
            .map(|key| match key == first {
                true => own.clone(),
                false => format!("{key} = …"),
            })
            .collect();
        if !known {
            entries.push(own.clone());
        }
        (Vec::new(), format!("{{ {} }}", entries.join(", ")))
    }

    /// The same without a value: what is required at the end of the keys.
    fn outline(&self, table: &Expected<'s>, keys: &[String]) -> (Vec<String>, String) {
        let end = match keys.is_empty() {
            true => None,
            false => self.table_at(table, keys),
        };
        let end = end.as_ref().unwrap_or(table);
        let required = end.required();
        let mut keys = keys.to_vec();
        if let Some(entry) = end.entry() {
            let inner = Expected::of(self.root, entry);
            let (tail, value) = match inner.takes_table() {
                true => self.outline(&inner, &[]),
                false => (Vec::new(), "…".into()),
            };
            let all = behind(NAME, tail);
            return self.form(table, &[keys, all].concat(), &value);
        }
        let optional = || end.keys().map(|(key, _)| key);
        let first = match required.first() {
            Some(first) => Some(*first),
            None if keys.is_empty() || !end.kinds.is_empty() => optional().next(),
            None => None,
        };
        match first {
            Some(first) => {
                let inner = end.child(first).map(|s| Expected::of(self.root, s));
                let inner = inner.filter(Expected::takes_table);
                keys.push(first.to_string());
                match inner.filter(|_| keys.len() < TABLE_DEPTH) {
                    Some(_) => self.outline(table, &keys),
                    None => self.form(table, &keys, "…"),
                }
            }
            None => self.form(table, &keys, "{}"),
        }
    }
}

fn behind(first: &str, rest: Vec<String>) -> Vec<String> {
    let mut all = vec![first.to_string()];
    all.extend(rest);
    all
}

fn split(path: &str) -> Vec<String> {
    path.split('.').map(str::to_string).collect()
}

fn join(keys: &[String], value: &str) -> String {
    format!("{} = {value}", key::join(keys))
}

/// A value as it was written, if it is short.
fn text(value: &Value) -> String {
    let text = match value {
        DeValue::String(word) => toml::Value::String(word.to_string()).to_string(),
        DeValue::Integer(i) if i.radix() != 10 => match number(value) {
            Some(x) => format!("{x}"),
            None => "…".into(),
        },
        DeValue::Integer(i) => i.as_str().to_string(),
        DeValue::Float(x) => x.as_str().to_string(),
        DeValue::Boolean(b) => b.to_string(),
        DeValue::Datetime(d) => d.to_string(),
        DeValue::Array(list) => {
            let entries: Vec<String> = list.iter().map(|v| text(v.get_ref())).collect();
            format!("[{}]", entries.join(", "))
        }
        DeValue::Table(_) => "{ … }".into(),
    };
    match text.chars().count() > LONGEST_VALUE {
        true => "…".into(),
        false => text,
    }
}
