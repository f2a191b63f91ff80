//! Ctrl-C, and what schedulers (SIGTERM) and terminals that close (SIGHUP) send: the analysis stops after what it is doing, and its results are complete up to there.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use stickslip::run::Interrupt;

/// Something to ask whether the user wants to stop. A second signal ends the program at once.
pub fn watch() -> Interrupt {
    let asked = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&asked);
    // Fails where somebody watches already (a second run in the same process, or Python): then Ctrl-C is theirs.
    let _ = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::SeqCst) {
            std::process::exit(i32::from(crate::failure::INTERRUPTED));
        }
        crate::progress::say("stopping; once more to stop at once");
    });
    Arc::new(move || asked.load(Ordering::SeqCst))
}
