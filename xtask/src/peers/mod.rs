//! `cargo xtask peers`: the same problems in stickslip and in CalculiX, one thread each, one after the other.

mod bar;
mod cpu;
mod deck;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::workspace;
use cpu::{Run, measure};

/// Cells an edge of the lower cube if the command line names none.
const SIZES: [usize; 2] = [11, 18];

/// Runs both for every size and prints the CPU times and their ratio.
pub fn compare(sizes: &[String]) -> Result<(), String> {
    let sizes: Vec<usize> = if sizes.is_empty() {
        SIZES.to_vec()
    } else {
        sizes
            .iter()
            .map(|s| s.parse().ok().filter(|n| (2..=200).contains(n)))
            .collect::<Option<_>>()
            .ok_or("sizes are whole numbers from 2 to 200")?
    };
    let case = workspace::root().join("examples/press-and-slide/case.toml");
    if !case.exists() {
        return Err(format!("{} is missing", case.display()));
    }
    let binary = workspace::stickslip()?;
    let scratch = workspace::target().join("peers");
    let with_calculix = Command::new("ccx").arg("-v").output().is_ok();
    if !with_calculix {
        println!("ccx is not installed (Debian: apt-get install calculix-ccx): stickslip alone");
    }
    println!(
        "{:>4} {:>8} {:>12} {:>12} {:>7}",
        "N", "dofs", "stickslip/s", "CalculiX/s", "ratio"
    );
    for n in sizes {
        let directory = scratch.join(n.to_string());
        fs::create_dir_all(&directory).map_err(|e| format!("{}: {e}", directory.display()))?;
        let ours = run_stickslip(&binary, &case, n, &directory)?;
        let dofs = 3 * ((n + 1).pow(3) + n.pow(3));
        if with_calculix {
            let (theirs, force) = run_calculix(n, &directory)?;
            let ratio = ours.cpu / theirs.cpu;
            println!(
                "{n:>4} {dofs:>8} {:>12.2} {:>12.2} {ratio:>7.2}",
                ours.cpu, theirs.cpu
            );
            if let Some([x, _, z]) = force {
                println!("     CalculiX: force on the top face x {x:.4e}, z {z:.4e} N");
            }
        } else {
            println!("{n:>4} {dofs:>8} {:>12.2} {:>12} {:>7}", ours.cpu, "-", "-");
        }
    }
    bars(&binary, &scratch, with_calculix)?;
    println!("results: {}", scratch.display());
    Ok(())
}

/// The impact of a bar: explicit by itself, implicit against CalculiX.
fn bars(binary: &Path, scratch: &Path, with_calculix: bool) -> Result<(), String> {
    let case = workspace::root().join("examples/steel-bar/case.toml");
    let directory = scratch.join("bar");
    fs::create_dir_all(&directory).map_err(|e| format!("{}: {e}", directory.display()))?;
    let fixed = |n: usize| format!("step.0.increments.fixed={n}");
    let explicit = bar::run_stickslip(binary, &case, &[&fixed(bar::EXPLICIT)], &directory)?;
    println!(
        "bar impact, explicit: {:.2} s, {:.2e} s a step and dof",
        explicit.cpu,
        explicit.cpu / (bar::EXPLICIT * bar::DOFS) as f64
    );
    let settings = [
        &fixed(bar::IMPLICIT) as &str,
        // springs and masses as CalculiX has them
        "step.0.dynamic={scheme={hht={}},contact-mass=\"as-meshed\"}",
    ];
    let implicit = bar::run_stickslip(binary, &case, &settings, &directory)?;
    print!("bar impact, implicit: {:.2} s", implicit.cpu);
    if with_calculix {
        let theirs = bar::run_calculix(&directory)?;
        println!(
            ", CalculiX {:.2} s, ratio {:.3}",
            theirs.cpu,
            implicit.cpu / theirs.cpu
        );
    } else {
        println!();
    }
    Ok(())
}

fn run_stickslip(binary: &Path, case: &Path, n: usize, directory: &Path) -> Result<Run, String> {
    let cells = |body: &str, n: usize| format!("body.{body}.generate.box.cells=[{n},{n},{n}]");
    let mut command = Command::new(binary);
    command
        .arg("run")
        .arg(case)
        .args(["--threads", "1", "--quiet"]);
    command.args(["--set", &cells("lower", n), "--set", &cells("upper", n - 1)]);
    command.arg("-o").arg(directory.join("stickslip.out"));
    measure(&mut command)
}

/// Runs CalculiX; also the force on the top face at the end `[N]`.
fn run_calculix(n: usize, directory: &Path) -> Result<(Run, Option<[f64; 3]>), String> {
    let deck = directory.join("calculix.inp");
    fs::write(&deck, deck::press_and_slide(n)).map_err(|e| format!("{}: {e}", deck.display()))?;
    let mut command = Command::new("ccx");
    command.args(["-i", "calculix"]).current_dir(directory);
    command.env("OMP_NUM_THREADS", "1").stdout(Stdio::null());
    let run = measure(&mut command)?;
    let printed = fs::read_to_string(directory.join("calculix.dat")).unwrap_or_default();
    Ok((run, last_total_force(&printed, "TOP")))
}

/// The last total force of a node set that CalculiX printed.
fn last_total_force(printed: &str, set: &str) -> Option<[f64; 3]> {
    let title = format!("set {set} ");
    let mut lines = printed.lines();
    let mut force = None;
    while let Some(line) = lines.next() {
        if line.contains("total force") && line.contains(&title) {
            let numbers = lines.find(|line| !line.trim().is_empty())?;
            let numbers: Vec<f64> = numbers.split_whitespace().flat_map(str::parse).collect();
            force = numbers.try_into().ok();
        }
    }
    force
}

#[cfg(test)]
mod tests {
    use super::last_total_force;

    #[test]
    fn reads_the_last_total() {
        let printed = "
 total force (fx,fy,fz) for set TOP and time  0.1000000E+01

        1.0E+00  2.0E+00 -3.0E+00

 total force (fx,fy,fz) for set BOT and time  0.2000000E+01

        7.0E+00  8.0E+00  9.0E+00

 total force (fx,fy,fz) for set TOP and time  0.2000000E+01

        4.0E+00  5.0E+00 -6.0E+00
";
        assert_eq!(last_total_force(printed, "TOP"), Some([4.0, 5.0, -6.0]));
        assert_eq!(last_total_force(printed, "SIDE"), None);
    }
}
