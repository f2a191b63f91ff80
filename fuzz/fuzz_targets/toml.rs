//! Problem files: any text gives a problem or findings that can be shown, and a problem is written and read back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use stickslip::problem::{Document, Problem};

fuzz_target!(|text: &str| {
    match Document::new(text, None).problem() {
        Err(error) => {
            assert!(!error.findings.is_empty());
            let _ = error.to_string();
            for finding in &error.findings {
                if let Some(span) = &finding.span {
                    assert!(span.start <= span.end && span.end <= text.len());
                }
            }
        }
        Ok(problem) => {
            let written = problem.to_toml().expect("a sound problem can be written");
            let again = Problem::from_toml(&written, None).expect("and read back");
            assert_eq!(again.to_toml().expect("again"), written);
        }
    }
});
