//! Faults of the program itself: what is said of them, and the exit code.

use std::any::Any;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook};
use std::process::ExitCode;

use crate::failure::DEFECT;
use crate::print;

/// Says what is to be done beside what the standard library says where something that is taken for certain does not hold.
pub fn report_defects() {
    set_hook(Box::new(|info| print::err(&said(info))));
}

fn said(info: &PanicHookInfo) -> String {
    let place = info.location().map(ToString::to_string);
    format!(
        "stickslip {} panicked at {}:\n{}\n  help: this is a fault of the program, whatever the input: please report it, with these lines and the files of the problem; \
         SECURITY.md of the sources says where, if a file of somebody else has done it\n",
        env!("CARGO_PKG_VERSION"),
        place.as_deref().unwrap_or("a place that is not known"),
        message(info.payload()),
    )
}

fn message(payload: &dyn Any) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("without a message")
}

/// The exit code of a command, also of one that does not come to its end.
pub fn caught(command: impl FnOnce() -> ExitCode) -> ExitCode {
    // Nothing of it is looked at afterwards.
    catch_unwind(AssertUnwindSafe(command)).unwrap_or_else(|_| ExitCode::from(DEFECT))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number;

    #[test]
    fn a_fault_has_an_exit_code_of_its_own() {
        assert_eq!(number(caught(|| panic!("this is a test"))), DEFECT);
        assert_eq!(number(caught(|| ExitCode::from(3))), 3);
        assert_eq!(message(&"a"), "a");
        assert_eq!(message(&String::from("b")), "b");
        assert_eq!(message(&1), "without a message");
    }
}
