//! Tables of the problem file that nothing uses.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use crate::model::definition::Model;

pub(super) fn check(model: &Model) -> Option<Finding> {
    let unused = &model.unused;
    if unused.is_empty() {
        return None;
    }
    // What nothing can touch lets bodies through.
    let tables = match unused.len() {
        1 => "a table that nothing uses".to_string(),
        n => format!("{n} tables that nothing uses"),
    };
    let finding = DoctorCause::Unused
        .warning(format!("the problem has {tables}: {}", unused.join(", ")))
        .note_unless(unused.iter().any(|key| key.starts_with("obstacle.")));
    let finding = unused.iter().fold(finding, |f, key| {
        let remark = match key.split('.').next() {
            Some("obstacle") => "no interface has it as `primary`: bodies pass through it",
            _ => "named nowhere",
        };
        f.blame(Suspect::key(key, remark))
    });
    Some(finding.advise("name it where it is meant to act, or remove it"))
}
