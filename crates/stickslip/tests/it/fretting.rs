//! Thousands of cycles by a few that are computed: jumps that are chosen by their error, cycles that repeat, and what each of them took.

use std::path::Path;
use stickslip::contact::look;

use crate::restart;
use crate::support::{self, Row};
use stickslip::Error;
use stickslip::assess::doctor::DoctorCause;
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::Simulation;

/// The rows of cycles.
#[derive(Default)]
pub struct Cycles(pub Vec<Row>);

impl Observer for Cycles {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        if let Event::Cycle(row) = event {
            self.0.push(row.clone());
        }
        Ok(())
    }
}

impl Cycles {
    pub fn of(simulation: &mut Simulation) -> Self {
        let mut cycles = Cycles::default();
        simulation
            .run(&mut [&mut cycles])
            .unwrap_or_else(|e| panic!("{e}"));
        cycles
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let value = |row: &Row| row.get(name).unwrap_or_else(|| panic!("no column {name}"));
        self.0.iter().map(value).collect()
    }

    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a cycle")
    }
}

/// Stiffness of the bed, mean pressure, and the part of it that varies at the start.
const BED: f64 = 1e-6;
const MEAN: f64 = 1e-9;
const VARIES: f64 = 0.8;
/// How many times the wave of the pressure falls by `e` over all cycles.
const DECADES: f64 = 3.0;
const CYCLES: usize = 1000;
/// Way of the flat in a cycle.
const WAY: f64 = 0.4;

/// A flat that goes back and forth on a layer under a constant load, without friction. The contact is a bed of springs so soft that both are rigid on it (a Winkler bed), and the surface of the
/// layer is a wave, as a gap alone.
fn bed(jump: &str, more: &str) -> Simulation {
    let k = DECADES / (BED * WAY * CYCLES as f64);
    let text = format!(
        r#"format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ to = [1, 0.25], cells = [16, 1] }}, material = "soft" }}
body.flat = {{ generate.rectangle = {{ from = [-0.5, 0.25], to = [1.5, 0.5], cells = [8, 1] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1.0, poisson = 0.3 }}
support.ground = {{ set = "layer.bottom", x = 0.0, y = 0.0 }}
reference.holder.point = [0.5, 0.5]
coupling.holder.kinematic = {{ reference = "holder", set = "flat.top" }}
support.drive = {{ set = "holder", x = 0.1, amplitude = "triangle" }}
support.turn = {{ set = "holder", rotation-z = 0.0 }}
load.press = {{ set = "holder", nodal-force = {{ value = [0, -{MEAN:?}] }} }}
amplitude.triangle.table = [[1, 0], [1.25, 1], [1.75, -1], [2, 0]]
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "fret", cycles = {{ count = {CYCLES}, jump = {jump} }}, increments = {{ fixed = 4 }} }}]
interface.joint = {{ secondary = "layer.top", primary = "flat.bottom", roles = "as-named", normal.linear = {{ c = {BED} }}, wear.archard = {{ coefficient = {k} }} }}
{more}
"#
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let interface = &mut simulation.run.contact.interfaces[0];
    let primary = interface.primary_nodes;
    for x in &mut interface.definition.mesh_mut().reference[primary..] {
        x[1] += VARIES * MEAN / BED * wave(x[0]);
    }
    simulation
}

fn wave(x: f64) -> f64 {
    (std::f64::consts::TAU * x).cos()
}

/// The part of the pressure along the wave, over its mean.
fn part(simulation: &Simulation) -> f64 {
    let (names, columns) = look::table(support::contact(simulation), &simulation.frame.state.u);
    let column = |name: &str| &columns[names.iter().position(|n| n == name).expect("a column")];
    let mut sums = [0.0; 2];
    let rows = column("x")
        .iter()
        .zip(column("CPRESS"))
        .zip(column("CNORMF"));
    for ((x, p), force) in rows {
        sums[0] += force * wave(*x);
        sums[1] += force / p * wave(*x).powi(2);
    }
    sums[0] / sums[1] / MEAN
}

#[test]
fn jumps_keep_to_the_error_that_is_asked_for() {
    let mut found = Vec::new();
    for error in [0.1, 0.02] {
        let mut simulation = bed(&format!("{{ error = {error} }}"), "");
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(simulation.summary.last["CYCLES"], CYCLES as f64);
        assert_eq!(simulation.summary.last["TIME"], 1.0 + CYCLES as f64);
        let blocks = (simulation.summary.attempts.increments - 1) / 4;
        // p = p̄ + p₁ exp(-K k s), and what is worn off differs by the difference of pressures over K.
        let off = (part(&simulation) - VARIES * (-DECADES).exp()).abs();
        let depth = off * 2.0 / std::f64::consts::PI / DECADES;
        assert!(depth < error, "{error}: {depth}");
        assert!(blocks < CYCLES / 10, "{blocks}");
        let volume = simulation.summary.last["joint.CWEARVOL"];
        let exact = DECADES * MEAN / BED;
        assert!((volume / exact - 1.0).abs() < 1e-3, "{volume} {exact}");
        found.push((depth, blocks));
    }
    // Jumps that grow by three times at most bound the error more than what is asked for.
    assert!(found[1].0 < found[0].0, "{found:?}");
}

/// A punch that goes back and forth on a layer, with friction: both surfaces wear, the corners first.
fn punch(method: &str, cycles: &str) -> String {
    format!(
        r#"format = 1
model.space = "plane-strain"
solver.method = "{method}"
body.layer = {{ generate.rectangle = {{ from = [-1, 0], to = [2, 1], cells = [24, 4] }}, material = "soft" }}
body.punch = {{ generate.rectangle = {{ from = [0, 1], to = [1, 1.5], cells = [10, 3] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1.0, poisson = 0.3 }}
support.ground = {{ set = "layer.bottom", x = 0.0, y = 0.0 }}
support.drive = {{ set = "punch.top", x = 0.02, amplitude = "triangle" }}
load.press = {{ set = "punch.top", pressure.value = 1e-3 }}
amplitude.triangle.table = [[1, 0], [1.25, 1], [1.75, -1], [2, 0], [2.5, 0], [3, 1]]
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "fret", cycles = {{ {cycles} }}, increments = {{ fixed = 4 }} }}, {{ name = "on", increments = {{ fixed = 2 }} }}]
quality.gate = "off"
[interface.joint]
secondary = "punch.bottom"
primary = "layer.top"
roles = "as-named"
friction.coulomb = {{ mu = 0.3 }}
wear.archard = {{ coefficient = 0.05, primary-coefficient = 0.02 }}
"#
    )
}

#[test]
fn blocks_that_are_taken_back_leave_no_trace_and_a_run_goes_on_with_the_same_bits() {
    for method in ["condensed", "sparse"] {
        // The first jumps are far too long.
        let cycles = "count = 200, jump = { error = 0.005, first = 40 }";
        let problem = support::problem(&punch(method, cycles));
        let mut record = support::Record::default();
        let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        simulation
            .run(&mut [&mut record])
            .unwrap_or_else(|e| panic!("{e}"));
        assert!(simulation.summary.attempts.cycles_taken_back > 0);
        let column = |name: &str| -> Vec<f64> {
            let rows = record.increments.iter();
            rows.map(|(_, row)| row.get(name).expect("a column"))
                .collect()
        };
        let (cycles, times) = (column("CYCLES"), column("TIME"));
        assert!(
            cycles.windows(2).all(|w| w[0] < w[1] || w[1] == 200.0),
            "{cycles:?}"
        );
        assert!(times.windows(2).all(|w| w[0] < w[1]), "{times:?}");
        assert_eq!(
            simulation.summary.attempts.increments,
            record.increments.len()
        );
        restart::check(method, &problem, Path::new("."), 6);
        restart::check_stopped(method, &problem, &[15, 40, 90]);
    }
}

/// Load and friction of the cylinder, half of the friction that it can take as tangential force, radius and moduli; N, mm.
pub const LOAD: f64 = 120.0;
pub const MU: f64 = 0.6;
pub const FORCE: f64 = 36.0;
const RADIUS: f64 = 6.0;
const YOUNG: f64 = 2e5;
const POISSON: f64 = 0.3;

/// Plane modulus of both bodies together, and half width of the contact.
pub fn hertz() -> (f64, f64) {
    let modulus = 0.5 * YOUNG / (1.0 - POISSON * POISSON);
    (
        modulus,
        (4.0 * LOAD * RADIUS / (std::f64::consts::PI * modulus)).sqrt(),
    )
}

/// Places from `-half` to `half` a distance `fine` apart, then by 1.3 farther each to `-far` and `far`.
fn graded(half: f64, fine: f64, far: f64) -> Vec<f64> {
    let inner = (half / fine).round() as i32;
    let mut side = Vec::new();
    let (mut x, mut step) = (half, fine);
    while x + 1.3 * step < far {
        step *= 1.3;
        x += step;
        side.push(x);
    }
    side.pop();
    side.push(far);
    let mut all: Vec<f64> = side.iter().rev().map(|x| -x).collect();
    all.extend((-inner..=inner).map(|i| f64::from(i) * fine));
    all.extend(side);
    all
}

/// A cylinder that is pressed on a flat by a constant force and pushed back and forth by another, with cells of `size` where they touch.
pub fn cylinder(size: f64, cycles: &str, increments: usize, wear: &str) -> Simulation {
    let x = graded(0.15, size, 6.0);
    let depth = graded(0.04, size, 6.0);
    let y: Vec<f64> = depth.iter().copied().filter(|y| *y <= 1e-12).collect();
    let text = format!(
        r#"format = 1
model.space = "plane-strain"
body.flat = {{ generate.rectangle = {{ x = {x:?}, y = {y:?} }}, material = "steel" }}
body.cylinder = {{ generate.half-disc = {{ centre = [0, {RADIUS}], radius = {RADIUS}, direction = [0, -1], size = 1.0, refine = {{ finest = {size}, width = 0.15, growth = 1.3 }} }}, material = "steel" }}
material.steel.isotropic = {{ young = {YOUNG}, poisson = {POISSON} }}
interface.contact = {{ secondary = "flat.top", primary = "cylinder.arc", roles = "as-named", friction.coulomb = {{ mu = {MU} }}{wear} }}
support.ground = {{ set = "flat.bottom", x = 0.0, y = 0.0 }}
reference.holder.point = [0, {RADIUS}]
coupling.holder.kinematic = {{ reference = "holder", set = "cylinder.flat" }}
support.turn = {{ set = "holder", rotation-z = 0.0 }}
support.touch = {{ set = "holder", x = 0.0, y = -0.001 }}
load.press = {{ set = "holder", nodal-force = {{ value = [0, -{LOAD}] }} }}
load.push = {{ set = "holder", nodal-force = {{ value = [{FORCE}, 0] }}, amplitude = "triangle" }}
amplitude.triangle.table = [[2, 0], [2.25, 1], [2.75, -1], [3, 0]]
step = [{{ name = "touch", loads = [], increments = {{ fixed = 1 }} }}, {{ name = "press", supports = ["ground", "turn"], increments = {{ fixed = 2 }} }}, {{ name = "fret", supports = ["ground", "turn"], cycles = {{ {cycles} }}, increments = {{ fixed = {increments} }} }}]
"#
    );
    support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"))
}

/// Energy that a cycle between `±Q` dissipates under a constant load `P`, of similar half-planes: by the principle of Ciavarella and Jäger tangential displacements are `μ (d(P) - d(P - Q/μ))`, and
/// where normal ones have the part `-P ln P / (π E*)` beside a linear one. What a loop encloses that follows from this by Masing's rule is, with `r = 1 - Q / μP`, `μ² P² / (π E*) (2 (1 - r²) + 4 r ln r)`.
fn mindlin() -> f64 {
    let r = 1.0 - FORCE / (MU * LOAD);
    let (modulus, _) = hertz();
    (MU * LOAD).powi(2) / (std::f64::consts::PI * modulus)
        * (2.0 * (1.0 - r * r) + 4.0 * r * r.ln())
}

#[test]
fn a_thousand_cycles_that_repeat_cost_a_few() {
    let mut some = cylinder(0.005, "count = 1000, jump = { error = 1e-3 }", 16, "");
    let cycles = Cycles::of(&mut some);
    let computed = cycles.0.len();
    assert!(computed <= 6, "{computed}");
    assert_eq!(cycles.last("CYCLES"), 1000.0);
    let notes = &some.summary.notes;
    assert!(
        notes.iter().any(|n| n.contains("is constant from cycle")),
        "{notes:?}"
    );
    let mut all = cylinder(0.005, "count = 4", 16, "");
    let exact = Cycles::of(&mut all).last("contact.ED");
    let energy = cycles.last("contact.ED");
    assert!((energy / exact - 1.0).abs() < 1e-5, "{energy} {exact}");
    assert!(
        (energy / mindlin() - 1.0).abs() < 0.01,
        "{energy} {}",
        mindlin()
    );
    let sum = cycles.last("contact.EDSUM");
    assert!((sum / (1000.0 * energy) - 1.0).abs() < 1e-3, "{sum}");
    assert!((cycles.last("contact.FT") / FORCE - 1.0).abs() < 5e-3);
    assert!((cycles.last("contact.FN") / LOAD - 1.0).abs() < 1e-3);
    assert_eq!(cycles.last("contact.CONDITION"), 1.0);
}

#[test]
fn a_loop_of_gross_slip_is_a_box() {
    let text = punch("condensed", "count = 3")
        .replace("x = 0.02", "x = 0.2")
        .replace("0.05, primary-coefficient = 0.02", "1e-6");
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let cycles = Cycles::of(&mut simulation);
    assert_eq!(cycles.column("CYCLES"), [1.0, 2.0, 3.0]);
    assert_eq!(cycles.column("STANDS"), [1.0; 3]);
    assert_eq!(cycles.last("joint.CONDITION"), 2.0);
    let ratio = cycles.last("joint.RATIO");
    assert!((0.8..1.0).contains(&ratio), "{ratio}");
    // Friction times the load; twice the stroke back and forth.
    let force = cycles.last("joint.FT");
    assert!((force / 3e-4 - 1.0).abs() < 1e-3, "{force}");
    let dissipated: f64 = cycles.column("joint.ED").iter().sum();
    let ledger = simulation.summary.last["joint.ALLFD"];
    let after = cycles.last("joint.EDSUM");
    assert!(
        (dissipated / after - 1.0).abs() < 1e-12 && after < ledger,
        "{dissipated} {after} {ledger}"
    );
}

/// The pressure in the middle of a contact that sticks within `c`, and the force that it carries within `x`.
fn limiting(c: f64, x: f64) -> [f64; 2] {
    let (modulus, _) = hertz();
    let pi = std::f64::consts::PI;
    let angle = (x / c).asin();
    let own = pi * modulus * c * c / (4.0 * RADIUS);
    let parabola = modulus / (2.0 * RADIUS) * (x * (c * c - x * x).sqrt() + c * c * angle);
    [
        modulus * c / (2.0 * RADIUS) + (LOAD - own) / (pi * c),
        parabola + (LOAD - own) * 2.0 / pi * angle,
    ]
}

/// What a flat and a cylinder that wear in partial slip come to: nothing presses any more where they slid, and what sticks carries all, `|x| < c` with `c² = a² (1 - Q / μP)`, by
/// `p = E* / 2R √(c² - x²) + (P - π E* c² / 4R) / (π √(c² - x²))`. Within `c` the profile is that of before, so that the pressure is Hertz's of a contact as wide as that and
/// a flat punch's, together the load; see Ciavarella and Hills 1999, and in three dimensions Popov 2014.
#[test]
fn partial_slip_wears_until_only_what_sticks_carries() {
    let (_, a) = hertz();
    let exact = a * (1.0 - FORCE / (MU * LOAD)).sqrt();
    for size in [0.0125, 0.00625] {
        let wear = ", wear.archard = { coefficient = 4e-6, primary-coefficient = 4e-6 }";
        let jumps = "count = 5000, jump = { error = 0.3, first = 2 }";
        let mut simulation = cylinder(size, jumps, 4, wear);
        let cycles = Cycles::of(&mut simulation);
        let energy = cycles.column("contact.ED");
        assert!(
            energy[energy.len() - 1] < 1e-2 * energy[0],
            "{size}: {energy:?}"
        );
        let (names, columns) =
            look::table(support::contact(&simulation), &simulation.frame.state.u);
        let column = |name: &str| &columns[names.iter().position(|n| n == name).expect("a column")];
        let (x, pressure, force) = (column("x"), column("CPRESS"), column("CNORMF"));
        let pressed = x.iter().zip(pressure).filter(|(_, p)| **p > 0.0);
        let edge = pressed.fold(0.0, |edge: f64, (x, _)| edge.max(x.abs()));
        let middle = pressure.iter().zip(x).find(|(_, x)| x.abs() < 1e-9);
        let middle = *middle.expect("a node").0;
        // Where the edge is, of a pressure that falls with it, lies between the last node that presses and the next, and within a cell or so of where it would be.
        let (mut low, mut high) = (0.5 * exact, 1.5 * exact);
        for _ in 0..60 {
            let c = 0.5 * (low + high);
            match limiting(c, 0.0)[0] > middle {
                true => low = c,
                false => high = c,
            }
        }
        let found = 0.5 * (low + high);
        assert!(
            edge < found && found < edge + size,
            "{size}: {found} {edge}"
        );
        assert!(
            (found - exact).abs() < 1.2 * size,
            "{size}: {found} {exact}"
        );
        for part in [0.25, 0.5, 0.75] {
            let place = part * exact;
            // A node stands for half a cell to each side.
            let share = |x: f64| ((place - x.abs()) / size + 0.5).clamp(0.0, 1.0);
            let within: f64 = x.iter().zip(force).map(|(x, f)| f * share(*x)).sum();
            let expected = limiting(found, place)[1];
            assert!(
                (within / expected - 1.0).abs() < 0.01,
                "{size}, {part}: {within} {expected}"
            );
        }
    }
}

fn findings(simulation: &Simulation, cause: DoctorCause) -> Vec<String> {
    let all = simulation.summary.findings.iter();
    let found = all.filter(|f| f.cause == cause);
    found.map(|f| f.message.clone()).collect()
}

#[test]
fn scars_beyond_first_order_and_the_limit_of_explicit_wear_are_told() {
    let run = |coefficients: &str| {
        let text = punch("condensed", "count = 4")
            .replace("0.05, primary-coefficient = 0.02", coefficients);
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation
    };
    let small = run("0.05, primary-coefficient = 0.02 }\nwear-feedback = \"explicit\" # {");
    assert_eq!(findings(&small, DoctorCause::DeepWear), [""; 0]);
    // Facets of 0.1, and two bodies with E / (1 - ν²) = 1 / 0.91.
    let limit = 4.0 * 0.1 / (std::f64::consts::PI * 0.07 * 0.5 / 0.91);
    let told = findings(&small, DoctorCause::ExplicitWear);
    assert!(
        told[0].contains(&stickslip::number::figure(limit)),
        "{limit} {told:?}"
    );
    let large = run("80.0, primary-coefficient = 80.0");
    let told = findings(&large, DoctorCause::DeepWear);
    assert!(told[0].contains("slope"), "{told:?}");
    assert_eq!(findings(&large, DoctorCause::ExplicitWear), [""; 0]);
}

/// Numbers from 0 to 1 that are the same each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A block that is rubbed back and forth on a floor or on another block, of random size, law, load, stroke and wear.
fn rubbed(random: &mut Random, jump: &str) -> String {
    // So low that friction does not tip it: what rocks comes down one way or the other by chance, cycle by cycle.
    let width = random.between(0.3, 1.0);
    let height = width * random.between(0.2, 0.6);
    let cells = random.between(4.0, 9.0) as usize;
    let young = 10_f64.powf(random.between(3.0, 5.0));
    let pressure = young * 10_f64.powf(random.between(-4.0, -3.3));
    let mu = random.between(0.05, 0.5);
    let stroke = width * random.between(0.01, 0.15);
    // Depth over all cycles beside how far the pressure presses.
    let rate = random.between(0.2, 4.0) * height / young / (30.0 * 4.0 * stroke);
    let primary = random.between(0.0, 1.0) * rate;
    let tilt = random.between(-0.2, 0.2) * pressure;
    let floor = random.next() < 0.5;
    let (lower, other) = match floor {
        true => (
            r#"obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }"#.to_string(),
            "floor",
        ),
        false => (
            format!(
                r#"body.lower = {{ generate.rectangle = {{ from = [{:?}, {:?}], to = [{:?}, 0], cells = [{}, 3] }}, material = "m" }}
support.ground = {{ set = "lower.bottom", x = 0, y = 0 }}"#,
                -0.5 * width,
                -height,
                1.5 * width,
                2 * cells
            ),
            "lower.top",
        ),
    };
    let discretisation = match random.next() < 0.5 {
        true => "node-to-facet",
        false => "mortar",
    };
    format!(
        r#"format = 1
model.space = "plane-strain"
body.upper = {{ generate.rectangle = {{ to = [{width:?}, {height:?}], cells = [{cells}, 3] }}, material = "m" }}
{lower}
material.m.isotropic = {{ young = {young:?}, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "{other}", roles = "as-named", discretisation.{discretisation} = {{}}, friction.coulomb = {{ mu = {mu:?} }}, wear.archard = {{ coefficient = {rate:?}, primary-coefficient = {primary:?} }} }}
support.drive = {{ set = "upper.top", x = {stroke:?}, amplitude = "go" }}
load.press = {{ set = "upper.top", pressure.value = {pressure:?} }}
load.tilt = {{ set = "upper.right", traction.value = [0, {tilt:?}] }}
amplitude.go.table = [[0, 0], [1, 0], [1.25, 1], [1.75, -1], [2, 0]]
quality.gate = "off"
output.every = 0
step = [{{ increments.fixed = 1 }}, {{ cycles = {{ count = 30, jump = {jump} }}, increments.fixed = 8 }}]
"#
    )
}

/// Depths and volumes that cycles have worn off, of each surface.
fn worn_off(simulation: &Simulation) -> [(Vec<f64>, f64); 2] {
    let interface = support::contact(simulation);
    let mut sides = [(Vec::new(), 0.0), (Vec::new(), 0.0)];
    let places = look::wear_places(interface);
    for (volume, (primary, area)) in look::taken(interface).into_iter().zip(places) {
        let side = &mut sides[usize::from(primary)];
        side.1 += volume;
        if area > 0.0 {
            side.0.push(volume / area);
        }
    }
    sides
}

#[test]
fn jumps_that_are_chosen_differ_from_every_cycle_by_no_more_than_the_error() {
    let mut computed = 0.0;
    let mut problems = 0;
    for seed in 0..20 {
        let run = |jump: &str| {
            let text = rubbed(&mut Random(seed), jump);
            let mut simulation =
                support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
            let outcome = simulation.run(&mut []);
            outcome.map(|()| simulation)
        };
        // What does not come to an end with every cycle says nothing of jumps.
        let Ok(every) = run("1") else {
            continue;
        };
        problems += 1;
        for error in [0.03, 0.1] {
            let jumped = run(&format!("{{ error = {error} }}")).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(jumped.summary.last["CYCLES"], 30.0);
            computed += (jumped.summary.attempts.increments - 1) as f64 / 8.0 / 60.0;
            for (exact, found) in worn_off(&every).iter().zip(worn_off(&jumped)) {
                let deepest = exact.0.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
                let apart = exact.0.iter().zip(&found.0).map(|(a, b)| (a - b).abs());
                let apart = apart.fold(0.0, f64::max);
                assert!(
                    apart <= error * deepest,
                    "{seed}, {error}: depth {}",
                    apart / deepest
                );
                let off = (exact.1 - found.1).abs();
                assert!(
                    off <= error * exact.1.abs(),
                    "{seed}, {error}: volume {}",
                    off / exact.1
                );
            }
        }
    }
    assert!(problems >= 15, "{problems}");
    // Cycles that were kept, beside all.
    assert!(
        computed / f64::from(problems) < 0.8,
        "{}",
        computed / f64::from(problems)
    );
}
