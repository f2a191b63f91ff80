use std::path::PathBuf;

/// Where a problem is written to.
#[derive(Debug, clap::Args)]
pub struct Target {
    /// The problem file to write; what is expected goes beside it, to NAME.expected.toml. Default: the name of the kind.
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}
