//! CPU and wall time of a program.

use std::process::Command;
use std::time::Instant;

/// What a program took.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// Processor time, user and system `[s]`.
    pub cpu: f64,
    /// Wall time `[s]`.
    pub wall: f64,
}

/// Runs a program to its end. It is an error if it cannot be run or fails.
pub fn measure(command: &mut Command) -> Result<Run, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let before = of_children()?;
    let started = Instant::now();
    let status = command
        .status()
        .map_err(|e| format!("cannot run {name}: {e}"))?;
    let wall = started.elapsed().as_secs_f64();
    if !status.success() {
        return Err(format!("{name} failed: {status}"));
    }
    Ok(Run {
        cpu: of_children()? - before,
        wall,
    })
}

/// Load averages over one, five and fifteen minutes, as the system prints them; empty where it does not.
pub fn load() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let words: Vec<&str> = text.split_whitespace().take(3).collect();
    words.join(" ")
}

/// The time of all programs run and waited for so far `[s]`.
fn of_children() -> Result<f64, String> {
    let stat = std::fs::read_to_string("/proc/self/stat")
        .map_err(|e| format!("CPU times are read from /proc/self/stat: {e}"))?;
    children_in(&stat).ok_or_else(|| "cannot read /proc/self/stat".to_string())
}

/// See proc(5): cutime and cstime are fields 16 and 17, in ticks of which Linux reports a hundred a second.
fn children_in(stat: &str) -> Option<f64> {
    // The second field is a name in parentheses that may hold blanks.
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_whitespace().skip(13);
    let user: f64 = fields.next()?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / 100.0)
}

#[cfg(test)]
mod tests {
    use super::children_in;

    #[test]
    fn reads_the_fields_of_children() {
        let stat = "42 (a b) c) S 1 2 3 4 5 6 7 8 9 10 11 12 150 50 20 0 1 0";
        assert_eq!(children_in(stat), Some(2.0));
        assert_eq!(children_in("42 (a) S 1"), None);
    }
}
