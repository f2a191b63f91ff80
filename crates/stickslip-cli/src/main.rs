//! The `stickslip` command.

use std::process::ExitCode;

/// What is said where memory runs out although what was foreseen did fit.
#[cfg(unix)]
const OUT_OF_MEMORY: &str = "error: memory ran out\n  help: a coarser mesh away from the contact, fewer increments between outputs, \
     or a machine with more memory\n";

/// Ends with a message and the exit code of a run that failed instead of an abort.
///
/// Where an allocation fails the standard library says how many bytes were asked for and aborts; nothing else here aborts but a stack that
/// overflows, which it says as well.
#[cfg(unix)]
extern "C" fn aborted(_: libc::c_int) {
    // SAFETY: both calls are allowed in a handler of signals; the text is a constant of that length.
    unsafe {
        libc::write(2, OUT_OF_MEMORY.as_ptr().cast(), OUT_OF_MEMORY.len());
        libc::_exit(3);
    }
}

fn main() -> ExitCode {
    #[cfg(unix)]
    // SAFETY: the handler does nothing but write and exit.
    unsafe {
        libc::signal(libc::SIGABRT, aborted as *const () as libc::sighandler_t);
    }
    stickslip_cli::report_defects();
    stickslip_cli::main_with(std::env::args_os())
}
