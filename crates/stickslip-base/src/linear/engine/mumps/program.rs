use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::linear::LinearError;

/// The program that runs on the ranks.
const PROGRAM: &str = "stickslip-mumps";

/// Names it, where it is not found.
const PROGRAM_VARIABLE: &str = "STICKSLIP_MUMPS";

/// The command that starts ranks, with arguments: `mpirun`, or as in `srun --mpi=pmix`. `-n N` is added.
const LAUNCHER: &str = "STICKSLIP_MPIRUN";

/// What to do where it is missing.
const BUILD: &str = "build it with `cargo xtask engine mumps`, which needs mpicc and MUMPS (Debian: `apt-get install libmumps-dev mpi-default-dev \
mpi-default-bin`), or leave `solver.engine` out";

/// Set for the ranks where the user has set nothing: ranks beside each other on few processors, as root in a container, and not all on the first processor.
const ENVIRONMENT: &[(&str, &str)] = &[
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("OMPI_MCA_hwloc_base_binding_policy", "none"),
    ("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"),
    ("OMP_NUM_THREADS", "1"),
    ("OPENBLAS_NUM_THREADS", "1"),
];

/// The program: as the environment says, or beside this one, or in `target/engines`, or along `PATH`.
fn find() -> Result<PathBuf, LinearError> {
    if let Some(named) = std::env::var_os(PROGRAM_VARIABLE) {
        let named = PathBuf::from(named);
        return match named.is_file() {
            true => Ok(named),
            false => Err(LinearError::Engine {
                message: format!("{PROGRAM_VARIABLE}: there is no file {}", named.display()),
                help: BUILD.into(),
            }),
        };
    }
    let own = std::env::current_exe().unwrap_or_default();
    // Beside this program; for what cargo builds in `target/release` or `target/debug/deps`, in `target/engines`.
    let beside = own.parent().map(Path::to_path_buf);
    let built = own.ancestors().skip(2).take(2).map(|f| f.join("engines"));
    let path = std::env::var_os("PATH").unwrap_or_default();
    let places = beside.into_iter().chain(built);
    let mut candidates = places
        .chain(std::env::split_paths(&path))
        .map(|folder| folder.join(PROGRAM));
    candidates
        .find(|candidate| candidate.is_file())
        .ok_or_else(|| LinearError::Engine {
            message: format!(
                "the engine `mumps` is a program of its own, {PROGRAM}, which is neither beside {} nor along PATH nor named by {PROGRAM_VARIABLE}",
                own.display()
            ),
            help: BUILD.into(),
        })
}

/// The command that starts the job, and its name.
///
/// # Errors
/// [`LinearError::Engine`] if there is no such program.
pub(super) fn command(ranks: usize, folder: &Path) -> Result<(Command, String), LinearError> {
    let program = find()?;
    let launcher = std::env::var(LAUNCHER).unwrap_or_else(|_| "mpirun".into());
    let mut words = launcher.split_whitespace();
    let first = words.next().unwrap_or("mpirun");
    let mut command = Command::new(first);
    let count = ranks.to_string();
    let arguments = [OsStr::new("-n"), OsStr::new(&count)];
    command.args(words).args(arguments).arg(program).arg(folder);
    command.stdin(Stdio::piped());
    command.stdout(Stdio::piped());
    command.stderr(Stdio::piped());
    for (key, value) in ENVIRONMENT {
        let set: Option<OsString> = std::env::var_os(key);
        if set.is_none() {
            command.env(key, value);
        }
    }
    // A signal from the keyboard is for this process, which ends the job when it has no more use for it.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    Ok((command, first.to_string()))
}

/// That the launcher cannot be started.
pub(super) fn no_launcher(name: &str, error: &std::io::Error) -> LinearError {
    LinearError::Engine {
        message: format!("the engine `mumps` is started by {name}, which does not start: {error}"),
        help: format!(
            "install MPI (Debian: `apt-get install mpi-default-bin`), or let {LAUNCHER} name the command that starts ranks, such as `srun --mpi=pmix`"
        ),
    }
}
