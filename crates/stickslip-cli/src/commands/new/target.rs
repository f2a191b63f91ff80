use std::path::PathBuf;

/// Where a problem is written to.
#[derive(Debug, clap::Args)]
pub struct Target {
    /// The problem file to write; default: the name of the kind. Expected results go to NAME.expected.toml beside it.
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}
