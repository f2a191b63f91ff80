//! A run of a sweep that is over, in memory and as text.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use stickslip::linear::Digest;
use stickslip::results::Summary;

use crate::failure::{Failure, Outcome};

/// What is known of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The values of the axes.
    pub values: Vec<String>,
    /// `done`, or why not.
    pub outcome: String,
    /// Increments, iterations and cut-backs; none if the model could not be built.
    pub counts: Option<[usize; 3]>,
    /// The last row of the history.
    #[serde(with = "in_words")]
    pub last: BTreeMap<String, f64>,
}

/// Numbers as text: those of JSON know no NaN.
mod in_words {
    use std::collections::BTreeMap;

    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(
        numbers: &BTreeMap<String, f64>,
        out: S,
    ) -> Result<S::Ok, S::Error> {
        out.collect_map(numbers.iter().map(|(name, x)| (name, format!("{x:e}"))))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeMap<String, f64>, D::Error> {
        let words: BTreeMap<String, String> = Deserialize::deserialize(from)?;
        let number =
            |(name, word): (String, String)| Ok((name, word.parse().map_err(Error::custom)?));
        words.into_iter().map(number).collect()
    }
}

impl Row {
    /// Whether the run did not pass the quality gate.
    pub fn poor(&self) -> bool {
        self.outcome.starts_with("quality: ")
    }

    /// Whether it failed.
    pub fn failed(&self) -> bool {
        self.outcome != "done" && !self.poor()
    }

    /// Takes over what a summary says.
    pub fn with_summary(mut self, summary: Option<Summary>) -> Self {
        if let Some(s) = summary {
            self.counts = Some([
                s.attempts.increments,
                s.attempts.iterations,
                s.attempts.cutbacks,
            ]);
            self.last = s.last;
        }
        self
    }
}

/// A run of a shard that is over.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// Its row.
    #[serde(flatten)]
    pub row: Row,
    /// The columns of its history, in order; none if it did not come so far.
    pub names: Vec<String>,
    /// Its row in the table of what runs took.
    pub effort: String,
    /// The kind of processor: last digits may depend on it.
    pub processor: String,
}

/// A digest of a row without its own.
fn digest(row: &Value) -> String {
    let mut digest = Digest::default();
    digest.bytes(row.to_string().as_bytes());
    let [a, b] = digest.finish();
    format!("{a:016x}{b:016x}")
}

impl Done {
    /// As text of JSON, with a digest.
    pub fn to_json(&self, run: usize) -> Value {
        let mut value = json!(self);
        value["run"] = json!(run + 1);
        value["digest"] = json!(digest(&value));
        value
    }

    /// What is known of a run; `None` of a text that is of another one, or damaged, were it by one digit.
    pub fn from_json(text: &str, run: usize) -> Option<Done> {
        let mut value: Value = serde_json::from_str(text).ok()?;
        let said = value.as_object_mut()?.remove("digest")?;
        let sound = said.as_str()? == digest(&value) && value["run"] == json!(run + 1);
        sound.then(|| Done::deserialize(&value).ok())?
    }
}

/// What a sweep with these rows ends with.
pub fn ended<'a>(rows: impl Iterator<Item = &'a Row> + Clone, table: PathBuf) -> Outcome {
    let (all, poor) = (rows.clone().count(), rows.clone().any(Row::poor));
    match rows.filter(|row| row.failed()).count() {
        0 if poor => Ok(ExitCode::from(crate::failure::CHECK)),
        0 => Ok(ExitCode::SUCCESS),
        failed => Err(Failure::Runs { failed, all, table }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let done = Done {
            row: Row {
                values: vec!["[1, 2]".into()],
                outcome: "no \"set\"\nhere".into(),
                counts: Some([1, 2, 3]),
                last: [0.1 + 0.2, -0.0, 5e-324, f64::MAX]
                    .iter()
                    .enumerate()
                    .map(|(i, x)| (format!("q{i}"), *x))
                    .collect(),
            },
            names: vec!["q1".into(), "q0".into()],
            effort: "1,0.5".into(),
            processor: "x".into(),
        };
        let line = done.to_json(6).to_string();
        assert!(!line.contains('\n'));
        let back = Done::from_json(&line, 6).unwrap();
        assert_eq!(&back, &done);
        assert!(Done::from_json(&line, 5).is_none());
        assert_eq!(back.row.last["q1"].to_bits(), (-0.0_f64).to_bits());
        let mut unknown = Done::default();
        unknown.row.last.insert("q".into(), f64::NAN);
        let back = Done::from_json(&unknown.to_json(0).to_string(), 0).unwrap();
        assert!(back.row.last["q"].is_nan() && back.row.counts.is_none());
        assert!(Done::from_json(&line[..line.len() - 1], 6).is_none());
        // A digit that was changed is found as well as a line that was cut.
        for (from, to) in [("e-324", "e-323"), ("\"run\":7", "\"run\":8"), ("q1", "q2")] {
            assert!(line.contains(from), "{line}");
            let other = line.replace(from, to);
            assert!(Done::from_json(&other, 6).is_none(), "{from}");
        }
    }
}
