//! The page of the book on clusters: its scripts and lines are run as they stand, with local processes for tasks of an array.

#![cfg(unix)]

use crate::support::{self, text};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What schedulers do, here and at once: each begins the tasks of an array side by side, from another folder where it does so itself.
const STUBS: [(&str, &str); 3] = [
    (
        "sbatch",
        r##"#!/bin/sh
for word in "$@"; do
  case $word in --wrap=*) exec sh -c "${word#--wrap=}" >&2;; *) script=$word;; esac
done
head -1 "$script" | grep -q '^#!' || { echo "this is no script" >&2; exit 1; }
for task in $(seq $(sed -n 's/^#SBATCH --array=1-//p' "$script")); do
  SLURM_ARRAY_TASK_ID=$task sh "$script" >&2 &
done
wait
echo 4711
"##,
    ),
    (
        "qsub",
        r##"#!/bin/sh
for word in "$@"; do script=$word; done
if [ ! -f "$script" ]; then cat > wrapped; cd / && exec sh "$OLDPWD/wrapped" >&2; fi
PBS_O_WORKDIR=$PWD; export PBS_O_WORKDIR; script=$PWD/$script
for task in $(seq $(sed -n 's/^#PBS -J 1-//p' "$script")); do
  (cd / && PBS_ARRAY_INDEX=$task exec sh "$script" >&2) &
done
wait
echo '4711[]'
"##,
    ),
    (
        "parallel",
        r##"#!/bin/sh
test "$1" = --jobs || exit 1
shift 2
line=
while [ "$1" != ::: ]; do line="$line '$1'"; shift; done
shift
for value in "$@"; do eval "$(echo "$line" | sed "s/{}/$value/g")" & done
wait
"##,
    ),
];

/// The blocks of a language in the section, in order.
fn blocks(section: &str, language: &str) -> Vec<String> {
    let mark = format!("```{language}\n");
    let begun = section.split(&mark).skip(1);
    begun
        .map(|rest| rest.split("```").next().unwrap_or_default().to_string())
        .collect()
}

fn section() -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/how-to/cluster.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let after = page.split("## Sweeps over many machines\n").nth(1);
    let section = after.expect("the section").split("\n## ").next();
    section.expect("its text").to_string()
}

/// Runs lines as a person would, with the binary and the schedulers at hand.
fn follow(lines: &str, folder: &Path, stubs: &Path) -> Output {
    let binary = Path::new(env!("CARGO_BIN_EXE_stickslip")).parent();
    let path = std::env::var("PATH").expect("a path");
    let binary = binary.expect("a folder").display();
    Command::new("sh")
        .args(["-e", "-c", lines])
        .current_dir(folder)
        .env("PATH", format!("{}:{binary}:{path}", stubs.display()))
        .output()
        .expect("a shell")
}

fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => open.push(path),
                false => {
                    let name = path.strip_prefix(folder).expect("a name").to_path_buf();
                    all.push((name, std::fs::read(&path).expect("a file")));
                }
            }
        }
    }
    all.sort();
    all
}

#[test]
fn scripts_for_schedulers_make_what_one_process_makes() {
    let section = section();
    let stubs = support::folder("cluster", "stubs");
    for (name, script) in STUBS {
        let path = stubs.join(name);
        std::fs::write(&path, script).expect("a file");
        let executable = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&path, executable).expect("a script");
    }
    let case = &blocks(&section, "toml")[0];
    let (scripts, lines): (Vec<String>, Vec<String>) = blocks(&section, "bash")
        .into_iter()
        .partition(|block| block.starts_with("#!"));
    assert_eq!((scripts.len(), lines.len()), (2, 3));
    let place = |name: &str| {
        let folder = support::place("cluster", name, case);
        std::fs::write(folder.join("slide.toml"), case).expect("a file");
        for script in &scripts {
            let name = script
                .lines()
                .find_map(|line| line.strip_prefix("# file: "));
            std::fs::write(folder.join(name.expect("a name")), script).expect("a file");
        }
        folder
    };
    let one = place("one");
    let whole = &blocks(&section, "sh")[0];
    let whole = whole
        .lines()
        .next()
        .expect("a line")
        .split(" --shard")
        .next();
    let output = follow(whole.expect("a command"), &one, &stubs);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for (i, lines) in lines.iter().enumerate() {
        let folder = place(&format!("many-{i}"));
        let output = follow(lines, &folder, &stubs);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{lines}{}",
            text(&output.stderr)
        );
        let shards = std::fs::read_dir(folder.join("slide.sweep.shards")).expect("shards");
        assert_eq!(shards.count(), 4, "{lines}");
        let read = |folder: &Path| std::fs::read(folder.join("slide.sweep.csv")).expect("a table");
        assert!(read(&folder) == read(&one), "{lines}");
        assert!(
            tree(&folder.join("runs")) == tree(&one.join("runs")),
            "{lines}"
        );
    }
}
