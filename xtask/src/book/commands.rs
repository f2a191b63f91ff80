//! The page of the command line: the help of every command as it is printed.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// The page, from what the binary says of itself.
pub fn page(binary: &Path) -> Result<String, String> {
    let mut page = String::from(
        "# The command line\n\n<!-- Generated from `stickslip COMMAND --help` by `cargo xtask book`. -->\n\n",
    );
    page +=
        "Results and listings go to standard output, progress and diagnostics to standard error.\n";
    sections(&mut page, binary, &[])?;
    Ok(page)
}

/// The page of what goes with what, as the binary prints it.
pub fn combinations(binary: &Path) -> Result<String, String> {
    let output = Command::new(binary)
        .args(["models", "--matrix"])
        .output()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    Ok(format!(
        "# What goes with what\n\n<!-- Generated from `stickslip models --matrix` by `cargo xtask book`. -->\n\n\
         Columns are kinds of bodies, and friction laws with a state. A number refers to the reason below; `stickslip check` refuses these combinations.\n\n{}",
        String::from_utf8_lossy(&output.stdout)
    ))
}

/// The help of a command, and of the commands within it.
fn sections(page: &mut String, binary: &Path, command: &[&str]) -> Result<(), String> {
    let all = help(binary, command)?;
    let name = [&["stickslip"], command].concat().join(" ");
    section(page, &name, &all);
    let names = all
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .take_while(|line| !line.trim().is_empty());
    for name in names.filter_map(|line| line.split_whitespace().next()) {
        if name != "help" {
            sections(page, binary, &[command, &[name]].concat())?;
        }
    }
    Ok(())
}

fn section(page: &mut String, title: &str, help: &str) {
    let _ = write!(page, "\n## {title}\n\n```text\n{}\n```\n", help.trim_end());
}

fn help(binary: &Path, command: &[&str]) -> Result<String, String> {
    let output = Command::new(binary)
        .args(command)
        .arg("--help")
        .output()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    // Lines of blanks are nobody's meaning.
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    // The binary may have another name where it was built.
    let name = binary.file_name().unwrap_or_default().to_string_lossy();
    Ok(lines
        .join("\n")
        .replace(&format!("Usage: {name}"), "Usage: stickslip"))
}
