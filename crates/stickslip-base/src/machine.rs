//! What the machine still has to give: memory, as far as the system tells.

/// Memory that this process may still take `[bytes]`: the least of what is free on the machine, what its control group leaves, and what its
/// limit of address space (`ulimit -v`) leaves. `None` where the system tells none of them.
pub fn available_memory() -> Option<u64> {
    let all = [free(), control_group(), address_space()];
    all.into_iter().flatten().min()
}

/// Memory of the machine, or of the control group if that has less `[bytes]`.
pub fn total_memory() -> Option<u64> {
    let group = group_limit().map(|(limit, _)| limit);
    let machine = keyed("/proc/meminfo", "MemTotal:");
    [machine, group].into_iter().flatten().min()
}

/// Largest resident memory of this process so far `[bytes]`; 0 if the system does not tell.
pub fn peak_memory() -> u64 {
    keyed("/proc/self/status", "VmHWM:").unwrap_or(0)
}

/// Pages that the system had to lay under addresses of this process so far, none of them read from a file; 0 if it does not tell.
pub fn page_faults() -> u64 {
    // The name of the program, in brackets, may hold anything; `minflt` is the eighth word behind it (proc_pid_stat(5)).
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let word = text
        .rsplit_once(')')
        .and_then(|(_, rest)| rest.split_whitespace().nth(7));
    word.and_then(|word| word.parse().ok()).unwrap_or(0)
}

/// A number of bytes for people.
pub fn bytes(count: u64) -> String {
    let count = count as f64;
    match count {
        c if c >= 1e9 => format!("{:.1} GB", c / 1e9),
        c if c >= 1e6 => format!("{:.1} MB", c / 1e6),
        c => format!("{:.1} kB", c / 1e3),
    }
}

fn free() -> Option<u64> {
    keyed("/proc/meminfo", "MemAvailable:")
}

/// Limit and use of the control group, of either version.
fn group_limit() -> Option<(u64, u64)> {
    let number = |path: &str| -> Option<u64> {
        let text = std::fs::read_to_string(path).ok()?;
        text.trim().parse().ok()
    };
    let folder = std::fs::read_to_string("/proc/self/cgroup").ok();
    let own = folder.as_deref().and_then(|text| {
        let line = text.lines().find_map(|l| l.strip_prefix("0::"))?;
        Some(line.trim_end_matches('/').to_string())
    });
    // In a container the own group is mounted as the root.
    let folders = [own.unwrap_or_default(), String::new()];
    let unified = folders.iter().find_map(|own| {
        let file = |name: &str| number(&format!("/sys/fs/cgroup{own}/{name}"));
        Some((file("memory.max")?, file("memory.current")?))
    });
    unified.or_else(|| {
        let file = |name: &str| number(&format!("/sys/fs/cgroup/memory/memory.{name}"));
        Some((file("limit_in_bytes")?, file("usage_in_bytes")?))
    })
}

fn control_group() -> Option<u64> {
    let (limit, used) = group_limit()?;
    Some(limit.saturating_sub(used))
}

fn address_space() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = text
        .lines()
        .find_map(|l| l.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(keyed("/proc/self/status", "VmSize:")?))
}

/// A number of kibibytes behind `key` in a table of the kernel `[bytes]`.
fn keyed(path: &str, key: &str) -> Option<u64> {
    let text = std::fs::read_to_string(path).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    let kibibytes: u64 = rest.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn the_system_tells() {
        let (total, available) = (total_memory().unwrap(), available_memory().unwrap());
        assert!(available <= total, "{available} of {total}");
        assert!(peak_memory() > 1 << 16);
        let before = page_faults();
        let pages = std::hint::black_box(vec![1u8; 1 << 26]);
        let taken = page_faults() - before;
        // 2 MB a page at the most, 4 kB at the least.
        assert!(
            (pages.len() >> 21..=(pages.len() >> 11)).contains(&(taken as usize)),
            "{taken}"
        );
    }

    #[test]
    fn bytes_have_units() {
        let of = [4, 2_500_000, 12_340_000_000].map(bytes);
        assert_eq!(of, ["0.0 kB", "2.5 MB", "12.3 GB"]);
    }
}
