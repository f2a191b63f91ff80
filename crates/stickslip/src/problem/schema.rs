use std::sync::LazyLock;

use serde_json::Value;

use super::Problem;

/// The JSON schema (draft 2020-12) of the problem file, for editors: put `#:schema ./stickslip.schema.json` in the
/// first line of a problem file.
pub fn schema() -> Value {
    schemars::schema_for!(Problem).to_value()
}

/// The schema, made once.
pub(super) fn shared() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(schema);
    &SCHEMA
}
