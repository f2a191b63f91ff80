use std::sync::LazyLock;

use serde_json::Value;

use super::{Problem, prose};

/// The JSON schema (draft 2020-12) of the problem file, for editors: put `#:schema ./stickslip.schema.json` in the
/// first line of a problem file.
pub fn schema() -> Value {
    plain(schemars::schema_for!(Problem).to_value())
}

/// The schema, made once.
pub(super) fn shared() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(schema);
    &SCHEMA
}

/// The same schema with the links of the Rust documentation taken out of its descriptions.
pub(super) fn plain(mut schema: Value) -> Value {
    match &mut schema {
        Value::Object(map) => {
            for (key, value) in map.iter_mut() {
                let inner = value.take();
                *value = match inner {
                    Value::String(text) if key == "description" => {
                        Value::String(prose::without_links(&text))
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
