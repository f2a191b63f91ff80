use std::sync::LazyLock;

use serde_json::Value;

/// What [`derived`] gave when the schema was written last; a test holds the two together.
const PUBLISHED: &str = include_str!("../../../../stickslip.schema.json");

/// The JSON schema (draft 2020-12) of the problem file, for editors: put `#:schema ./stickslip.schema.json` in the
/// first line of a problem file.
pub fn schema() -> Value {
    shared().clone()
}

/// The schema, read once.
pub(super) fn shared() -> &'static Value {
    static SCHEMA: LazyLock<Value> =
        LazyLock::new(|| serde_json::from_str(PUBLISHED).expect("the published schema is JSON"));
    &SCHEMA
}

/// The schema of an entry of a family, with all definitions that it may refer to. `family`: the definition that lists the entries.
pub(super) fn of_entry(family: &str, kind: &str) -> Value {
    let all = &shared()["$defs"];
    let entries = all[family]["oneOf"].as_array();
    let properties = entries
        .into_iter()
        .flatten()
        .map(|entry| &entry["properties"][kind]);
    let mut names = properties.filter_map(|property| property["$ref"].as_str());
    let name = names
        .next()
        .and_then(|path| path.rsplit('/').next())
        .unwrap_or_else(|| {
            panic!("the published schema has no {family}.{kind}: run `cargo xtask schema`")
        });
    let mut schema = all[name].clone();
    schema["$defs"] = all.clone();
    schema
}

/// The schema as it follows from the structs, with the links of their documentation taken out of its descriptions.
#[cfg(feature = "schema")]
pub fn derived() -> Value {
    let mut schema = plain(schemars::schema_for!(super::Problem).to_value());
    schema["$id"] = format!("urn:stickslip:problem-file:{}", super::FORMAT).into();
    schema
}

#[cfg(feature = "schema")]
fn plain(mut schema: Value) -> Value {
    match &mut schema {
        Value::Object(map) => {
            for (key, value) in map.iter_mut() {
                let inner = value.take();
                *value = match inner {
                    Value::String(text) if key == "description" => {
                        Value::String(super::prose::without_links(&text))
                    }
                    other => plain(other),
                };
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|v| *v = plain(v.take())),
        _ => {}
    }
    schema
}
