//! Gears of which nothing but contact holds the wheel.

use crate::support;

/// A pinion that is turned by a pitch and a wheel under a torque, with so many cells along a flank and so many increments.
fn pair(cells: usize, increments: &str) -> String {
    format!(
        r#"
        format = 1
        model = {{ space = "plane-strain", thickness = 10 }}
        reference.one = {{ point = [0, 0] }}
        reference.two = {{ point = [50, 0] }}
        body.pinion = {{ material = "steel", rotation.with = "one", generate.gear = {{ teeth = 20, module = 2, bore = 8.75, backlash = 0.05, cells = [{cells}, 4, 2, 2] }} }}
        body.wheel = {{ material = "steel", rotation.with = "two", generate.gear = {{ centre = [50, 0], teeth = 30, module = 2, bore = 13.75, angle = 3.246312408709453, cells = [{cells}, 4, 2, 2] }} }}
        material.steel.isotropic = {{ young = 2.1e5, poisson = 0.3 }}
        interface.mesh = {{ secondary = "pinion.teeth", primary = "wheel.teeth", discretisation.node-to-facet = {{}} }}
        support.pinion = {{ set = "pinion.bore", x = 0, y = 0 }}
        support.wheel = {{ set = "wheel.bore", x = 0, y = 0 }}
        support.one = {{ set = "one", x = 0, y = 0, rotation-z = 1, amplitude = "drive" }}
        support.two = {{ set = "two", x = 0, y = 0 }}
        support.held = {{ set = "two", rotation-z = 0 }}
        load.torque = {{ set = "two", moment.value = [20000] }}
        amplitude.drive.table = [[0, 0], [1, 0.0008946367455789986], [2, 0.0008946367455789986], [3, 0.3150539040986]]
        [[step]]
        name = "close"
        loads = []
        increments.fixed = 2
        [[step]]
        name = "load"
        supports = ["pinion", "wheel", "one", "two"]
        increments.fixed = 2
        [[step]]
        name = "turn"
        supports = ["pinion", "wheel", "one", "two"]
        increments = {{ {increments} }}
        [quality]
        gate = "off"
        "#
    )
}

/// Where an iteration has lost contact the moment on the wheel turns it by a facet at most, so that it meets its flank again: no increment is refused or takes long, whether bodies are
/// condensed or not, and one position is like another.
#[test]
fn a_wheel_that_contact_lets_go_comes_back_to_it() {
    let base = 30.0 * 20.0_f64.to_radians().cos();
    for method in ["condensed", "sparse"] {
        let text = pair(24, "fixed = 16") + &format!("[solver]\nmethod = \"{method}\"\n");
        let record = support::run(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let count = |column| {
            let rows = record.increments.iter().map(|(_, row)| row.get(column));
            rows.map(|x| x.expect("a column")).collect::<Vec<_>>()
        };
        let [all, one, two] = ["ITRS", "one.UR3", "two.UR3"].map(count);
        println!(
            "{method}: {} cut-backs, iterations {all:?}",
            record.cutbacks
        );
        assert_eq!(record.cutbacks, 0, "{method}");
        assert!(
            all.iter().sum::<f64>() < 15.0 * all.len() as f64,
            "{method}: {all:?}"
        );
        for (one, two) in one.iter().zip(&two) {
            let lag = base * (two + one * 20.0 / 30.0);
            assert!((0.0..0.05).contains(&lag), "{method}: {lag}");
        }
    }
}

/// With coarse flanks one node carries, and while an iteration has lost it the wheel is free: where it fits again seven teeth on, an increment was as good as any.
#[test]
fn a_wheel_under_a_torque_does_not_jump_teeth() {
    let base = 30.0 * 20.0_f64.to_radians().cos();
    for (increments, may_fail) in [
        ("fixed = 16", true),
        ("initial = 0.0625, largest = 0.0625", false),
    ] {
        let outcome = support::run(&support::problem(&pair(24, increments)));
        let record = match outcome {
            Ok(record) => record,
            Err(e) if may_fail => {
                let said = e.to_string();
                println!("{said}");
                assert!(said.contains("turned through its neighbour"), "{said}");
                continue;
            }
            Err(e) => panic!("{increments}: {e}"),
        };
        println!("{increments}: {} cut-backs", record.cutbacks);
        for (_, row) in &record.increments {
            let [one, two] = ["one.UR3", "two.UR3"].map(|c| row.get(c).expect("an angle"));
            let lag = base * (two + one * 20.0 / 30.0);
            assert!((0.0..0.05).contains(&lag), "{increments}: {lag}");
        }
    }
}
