//! What the schema says about a value, and whether a value is of that kind.

use serde_json::{Map, Value as Json};
use toml::de::DeValue;

use super::tree::{Value, number};

/// What the schema says about a value, references resolved.
pub(super) struct Expected<'s> {
    /// The keyword object.
    pub(super) own: &'s Map<String, Json>,
    /// Description at the place of use or of the type.
    pub(super) description: Option<&'s str>,
    /// Keys with a meaning.
    pub(super) properties: Vec<(&'s str, &'s Json)>,
    /// Keys of which exactly one must be there.
    pub(super) kinds: Vec<(&'s str, &'s Json)>,
    /// Strings allowed.
    pub(super) words: Vec<&'s str>,
}

impl<'s> Expected<'s> {
    pub(super) fn of(root: &'s Json, schema: &'s Json) -> Self {
        static NOTHING: std::sync::LazyLock<Map<String, Json>> = std::sync::LazyLock::new(Map::new);
        let mut description = None;
        let mut schema = schema;
        // References, and the `X or null` of optional keys.
        let own = loop {
            let Some(own) = schema.as_object() else {
                break &*NOTHING;
            };
            description = description.or_else(|| own.get("description").and_then(Json::as_str));
            let reference = own.get("$ref").and_then(Json::as_str);
            let target = reference.and_then(|r| root.pointer(r.strip_prefix('#')?));
            let some = || {
                own.get("anyOf")?
                    .as_array()?
                    .iter()
                    .find(|s| s.get("type").and_then(Json::as_str) != Some("null"))
            };
            match target.or_else(some) {
                Some(next) => schema = next,
                None => break own,
            }
        };
        let entries = |map: &'s Map<String, Json>| {
            let properties = map.get("properties").and_then(Json::as_object);
            properties
                .into_iter()
                .flatten()
                .map(|(k, v)| (k.as_str(), v))
        };
        let mut kinds = Vec::new();
        let mut words: Vec<&str> = Vec::new();
        let alternatives = own.get("oneOf").and_then(Json::as_array);
        for alternative in alternatives.into_iter().flatten() {
            words.extend(alternative.get("const").and_then(Json::as_str));
            words.extend(strings(alternative.get("enum")));
            kinds.extend(alternative.as_object().into_iter().flat_map(entries));
        }
        words.extend(strings(own.get("enum")));
        Expected {
            own,
            description,
            properties: entries(own).collect(),
            kinds,
            words,
        }
    }

    pub(super) fn allows(&self, kind: &str) -> bool {
        match self.own.get("type") {
            Some(Json::String(s)) => s == kind,
            Some(Json::Array(all)) => all.iter().any(|s| s == kind),
            _ => match kind {
                "object" => !self.kinds.is_empty(),
                "string" => !self.words.is_empty(),
                _ => false,
            },
        }
    }

    pub(super) fn limit(&self, keyword: &str) -> Option<f64> {
        self.own.get(keyword).and_then(Json::as_f64)
    }

    /// In words.
    pub(super) fn name(&self) -> String {
        let names = [
            ("object", "a table"),
            ("array", "a list"),
            ("number", "a number"),
            ("integer", "a whole number"),
            ("string", "a string"),
            ("boolean", "true or false"),
        ];
        let names: Vec<&str> = names
            .iter()
            .filter(|(kind, _)| self.allows(kind))
            .map(|(_, name)| *name)
            .collect();
        names.join(" or ")
    }

    pub(super) fn takes_table(&self) -> bool {
        self.allows("object")
    }

    pub(super) fn is_list(&self) -> bool {
        self.allows("array")
    }

    /// The schema of entries with names of the user's own.
    pub(super) fn entry(&self) -> Option<&'s Json> {
        let rest = self.own.get("additionalProperties");
        rest.filter(|schema| schema.is_object())
    }

    pub(super) fn required(&self) -> Vec<&'s str> {
        strings(self.own.get("required")).collect()
    }

    /// Keys with their schemas, kinds first.
    pub(super) fn keys(&self) -> impl Iterator<Item = (&'s str, &'s Json)> {
        self.kinds.iter().chain(&self.properties).copied()
    }

    pub(super) fn child(&self, key: &str) -> Option<&'s Json> {
        let named = self.keys().find(|(name, _)| *name == key);
        named.map(|(_, schema)| schema).or_else(|| self.entry())
    }
}

/// Of several alternatives the one for a value of this type; the schema itself where there is no choice, or none is.
pub(super) fn alternative<'s>(root: &'s Json, schema: &'s Json, value: &Value) -> &'s Json {
    let kind = match value {
        DeValue::Table(_) => "object",
        DeValue::Array(_) => "array",
        DeValue::String(_) => "string",
        DeValue::Boolean(_) => "boolean",
        _ => "number",
    };
    let reference = schema.get("$ref").and_then(Json::as_str);
    if let Some(target) = reference.and_then(|r| root.pointer(r.strip_prefix('#')?)) {
        return alternative(root, target, value);
    }
    let all = schema.get("anyOf").and_then(Json::as_array);
    let fits = |s: &&'s Json| {
        let inner = alternative(root, s, value);
        Expected::of(root, inner).allows(kind)
    };
    match all.into_iter().flatten().find(fits) {
        Some(fitting) => alternative(root, fitting, value),
        None => schema,
    }
}

pub(super) fn strings(list: Option<&Json>) -> impl Iterator<Item = &str> {
    let list = list.and_then(Json::as_array).into_iter().flatten();
    list.filter_map(Json::as_str)
}

/// Whether a scalar or a list is what a schema wants, entry by entry and within its limits.
pub(super) fn accepts(root: &Json, schema: &Json, value: &Value) -> bool {
    let expected = Expected::of(root, schema);
    match value {
        DeValue::Table(_) => expected.allows("object"),
        DeValue::Array(list) => {
            let first = expected.own.get("prefixItems").and_then(Json::as_array);
            let rest = expected.own.get("items");
            let mut entries = list.iter().enumerate();
            expected.allows("array")
                && within(&expected, list.len() as f64, ["minItems", "maxItems"])
                && entries.all(|(i, entry)| {
                    let schema = first.and_then(|f| f.get(i)).or(rest);
                    schema.is_none_or(|schema| accepts(root, schema, entry.get_ref()))
                })
        }
        DeValue::String(word) => {
            expected.allows("string")
                && (expected.words.is_empty() || expected.words.contains(&&**word))
        }
        DeValue::Boolean(_) => expected.allows("boolean"),
        DeValue::Integer(_) | DeValue::Float(_) => {
            let whole = matches!(value, DeValue::Integer(_)) && expected.allows("integer");
            let exclusive = |keyword, beyond: fn(f64, f64) -> bool| {
                let limit = expected.limit(keyword);
                limit.is_none_or(|limit| number(value).is_some_and(|x| beyond(x, limit)))
            };
            (whole || expected.allows("number"))
                && number(value).is_some_and(|x| within(&expected, x, ["minimum", "maximum"]))
                && exclusive("exclusiveMinimum", |x, limit| x > limit)
                && exclusive("exclusiveMaximum", |x, limit| x < limit)
        }
        DeValue::Datetime(_) => false,
    }
}

fn within(expected: &Expected, x: f64, [least, most]: [&str; 2]) -> bool {
    expected.limit(least).is_none_or(|limit| x >= limit)
        && expected.limit(most).is_none_or(|limit| x <= limit)
}
