//! Rate-and-state friction: limit cycles and stability of sliders and layers, a fault before its first earthquake, and every way to compute.

use crate::{restart, support};
use stickslip::Error;
use stickslip::contact::look;
use stickslip::model::Setup;
use stickslip::results::{Analysis, Event, Observer, ResultFiles};

/// A block that gives way in shear alone, of stiffness `k` per area, over a floor that moves away beneath it at a velocity, under a pressure of 1 MPa that nothing
/// changes: a slider on a spring. `dc` and `eta` are of the law; at the start the shear is `more` times that of steady sliding.
struct Slider {
    stiffness: f64,
    dc: f64,
    eta: f64,
    velocity: f64,
    more: f64,
    evolution: &'static str,
}

/// The slider of the limit cycles, whose critical stiffness is 5e8 Pa/m.
const SLIDER: Slider = Slider {
    stiffness: 4e8,
    dc: 1e-5,
    eta: 1e4,
    velocity: 1e-5,
    more: 1.02,
    evolution: "ageing",
};

impl Slider {
    fn text(&self, step: &str) -> String {
        let Slider {
            stiffness: k,
            dc,
            eta,
            velocity,
            more,
            evolution,
        } = self;
        format!(
            r#"
format = 1
model.space = "plane-strain"
[body.block]
generate.rectangle = {{ to = [1, 1], cells = [1, 1] }}
material = "spring"
[material.spring.anisotropic]
stiffness = [[{stiff},0,0,0,0,0],[0,{k},0,0,0,0],[0,0,{k},0,0,0],[0,0,0,{k},0,0],[0,0,0,0,{k},0],[0,0,0,0,0,{k}]]
[obstacle.floor]
plane = {{ point = [0, 0], normal = [0, 1] }}
[interface.fault]
secondary = "block.bottom"
primary = "floor"
normal.linear = {{ c = 1e9 }}
initial = "offset"
initial-gap = -1e-3
primary-velocity = [-{velocity:e}, 0]
enforcement.perturbed-lagrangian = {{}}
[interface.fault.friction.rate-and-state]
f0 = 0.6
a = 0.01
b = 0.015
dc = {dc:e}
v0 = 1e-6
eta = {eta}
velocity = {velocity:e}
theta = {theta:e}
evolution = "{evolution}"
[support.top]
set = "block.top"
x = {stretch:e}
amplitude = "at once"
[amplitude."at once"]
table = [[0, 1], [1, 1]]
[support.level]
set = "block"
y = 0
[[step]]
{step}
"#,
            stiff = 1e4 * k,
            theta = dc / velocity,
            stretch = more * 1e6 * (0.6 - 0.005 * (velocity / 1e-6).ln()) / k,
        )
    }
}

/// Time, shear traction, and velocity of the first point after each increment.
#[derive(Default)]
struct Course(Vec<[f64; 3]>);

impl Observer for Course {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let (Event::Increment(_), Some(contact)) = (event, analysis.contacts().next()) else {
            return Ok(());
        };
        let state = &analysis.frame.state;
        let (names, columns) = look::table(contact, &state.u);
        let first = |name: &str| {
            let k = names.iter().position(|n| n == name);
            columns[k.unwrap_or_else(|| panic!("no {name}"))][0]
        };
        self.0.push([state.t, first("CSHEAR1").abs(), first("V")]);
        Ok(())
    }
}

fn course(text: &str) -> Vec<[f64; 3]> {
    let mut course = Course::default();
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let run = simulation.run(&mut [&mut course]);
    run.unwrap_or_else(|e| panic!("{e}"));
    course.0
}

/// Times at which the shear falls through a level.
fn falls(course: &[[f64; 3]], level: f64) -> Vec<f64> {
    let pairs = course.windows(2);
    let falls = pairs.filter(|w| w[0][1] > level && w[1][1] <= level);
    let time = |w: &[[f64; 3]]| {
        let [[from, high, _], [to, low, _]] = [w[0], w[1]];
        from + (to - from) * (high - level) / (high - low)
    };
    falls.map(time).collect()
}

/// Limit cycles that another program found to ten digits: see `VERIFICATION` of the project, a slider on a spring below its critical stiffness.
#[test]
fn a_soft_spring_has_its_limit_cycle() {
    for (stiffness, duration, period, slowest, fastest) in [
        (4e8, 290.0, 25.499_912_56, 1.068_242_3e-8, 2.339_762_8),
        (2e8, 520.0, 49.456_010_68, 5.629_880_2e-9, 6.404_86),
    ] {
        let slider = Slider {
            stiffness,
            ..SLIDER
        };
        let found = |change: f64| {
            let step = format!(
                "duration = {duration}\nincrements = {{ initial = 1e-9, smallest = 1e-14, state-change = {change} }}"
            );
            let course = course(&slider.text(&step));
            let falls = falls(&course, 5.8e5);
            let n = falls.len();
            assert!(n >= 4, "{stiffness:e}: {falls:?}");
            let last = course.iter().filter(|row| row[0] > falls[n - 2] - 1.0);
            let speeds: Vec<f64> = last.map(|row| row[2]).collect();
            let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
            let most = speeds.iter().copied().fold(0.0, f64::max);
            (falls[n - 1] - falls[n - 2], least, most)
        };
        let (coarse, ..) = found(0.1);
        assert!(
            (coarse / period - 1.0).abs() < 5e-4,
            "{stiffness:e}: {coarse}"
        );
        let (fine, least, most) = found(0.02);
        assert!((fine / period - 1.0).abs() < 3e-5, "{stiffness:e}: {fine}");
        assert!(
            (least / slowest - 1.0).abs() < 2e-3,
            "{stiffness:e}: {least:e}"
        );
        assert!((most / fastest - 1.0).abs() < 5e-3, "{stiffness:e}: {most}");
    }
}

#[test]
fn a_stiff_spring_slides_steadily() {
    for evolution in ["ageing", "slip"] {
        let slider = Slider {
            stiffness: 6e8,
            evolution,
            ..SLIDER
        };
        let step = "duration = 300\nincrements = { initial = 1e-9, smallest = 1e-14 }";
        let course = course(&slider.text(step));
        let [_, shear, speed] = course[course.len() - 1];
        assert!((speed / 1e-5 - 1.0).abs() < 1e-3, "{evolution}: {speed:e}");
        // f0 + (a - b) ln(V/V0), and radiation damping
        let steady = 1e6 * (0.6 - 0.005 * 10_f64.ln()) + 1e4 * 1e-5;
        assert!((shear / steady - 1.0).abs() < 1e-5, "{evolution}: {shear}");
    }
}

/// A layer dragged over the law becomes unstable at the height `G D_c/(σ (b - a))`, where it oscillates at `(V/D_c) √((b - a)/a)`.
#[test]
fn a_layer_is_unstable_above_its_critical_height() {
    let modulus = 2670.0 * 3464.0_f64.powi(2);
    let critical = modulus * 8e-3 / (50e6 * 0.005);
    assert!((critical - 1025.22).abs() < 0.005);
    // The slider has a fiftieth of that pressure, and of its stiffness.
    let mean_growth = |height: f64| {
        let slider = Slider {
            stiffness: modulus / height / 50.0,
            dc: 8e-3,
            eta: 0.0,
            velocity: 1e-9,
            more: 1.001,
            ..SLIDER
        };
        let step = "duration = 8e8\nincrements = { initial = 1e-5, smallest = 1e-14, largest = 3e-3, state-change = 0.05 }";
        let course = course(&slider.text(step));
        let of_shear: Vec<_> = course.iter().skip(course.len() / 4).copied().collect();
        let peaks: Vec<[f64; 3]> = (of_shear.windows(3))
            .filter(|w| w[1][1] > w[0][1] && w[1][1] >= w[2][1])
            .map(|w| w[1])
            .collect();
        let dips = of_shear
            .windows(3)
            .filter(|w| w[1][1] < w[0][1] && w[1][1] <= w[2][1]);
        let dips: Vec<[f64; 3]> = dips.map(|w| w[1]).collect();
        let heights: Vec<f64> = peaks
            .iter()
            .zip(&dips)
            .map(|(p, d)| (p[1] - d[1]).abs())
            .collect();
        let n = heights.len();
        assert!(n >= 5, "{height}: {heights:?}");
        let period = (peaks[n - 1][0] - peaks[0][0]) / (n - 1) as f64;
        let growth = (heights[n - 1] / heights[0]).powf(1.0 / (n - 1) as f64);
        (growth, std::f64::consts::TAU / period)
    };
    let (below, _) = mean_growth(0.97 * critical);
    let (at, frequency) = mean_growth(critical);
    let (above, _) = mean_growth(1.03 * critical);
    assert!(below < 0.98 && above > 1.02, "{below} {above}");
    assert!((at - 1.0).abs() < 0.01, "{at}");
    assert!(
        (frequency / 8.838_83e-8 - 1.0).abs() < 0.01,
        "{frequency:e}"
    );
}

/// Events in files are those of the limit cycle: one each period, with the speed of its peak and the slip of the period.
#[test]
fn events_of_a_limit_cycle_are_listed() {
    let step = "duration = 290\nincrements = { initial = 1e-9, smallest = 1e-14 }\n[output]\nevery = 0\nslip-events = { speed = 1e-3, modulus = 3e10 }";
    let problem = support::problem(&SLIDER.text(step));
    let folder = support::folder("events-of-a-limit-cycle");
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
    let mut files =
        ResultFiles::new(&folder, &Default::default()).unwrap_or_else(|e| panic!("{e}"));
    let run = simulation.run(&mut [&mut files]);
    run.unwrap_or_else(|e| panic!("{e}"));
    let table = stickslip::io::csv::read(&folder.join("interfaces/fault-events.csv"));
    let table = table.unwrap_or_else(|e| panic!("{e}"));
    let column = |name: &str| table.column(name).expect("a column").to_vec();
    let [onset, end, peak, potency, moment] =
        ["onset", "end", "peak-speed", "potency", "moment"].map(column);
    let n = onset.len();
    assert!(n >= 5, "{onset:?}");
    assert!(
        (onset[n - 1] - onset[n - 2] - 25.4999).abs() < 0.02,
        "{onset:?}"
    );
    assert!((peak[n - 1] / 2.3398 - 1.0).abs() < 0.02, "{peak:?}");
    assert!(end[n - 1] > onset[n - 1] && end[n - 1] - onset[n - 1] < 0.1);
    // Most of the way of the floor over a period is slipped in the event, on an area of one; the rest is creep before and after it.
    let way = 25.4999 * 1e-5;
    assert!(
        potency[n - 1] > 0.7 * way && potency[n - 1] < way,
        "{potency:?}"
    );
    assert!((moment[n - 1] / potency[n - 1] / 3e10 - 1.0).abs() < 1e-12);
}

const DRAGGED: &str = "
[material.m]
isotropic = { young = 2e7, poisson = 0.3, density = 1000 }
[interface.press.friction.rate-and-state]
f0 = 0.4
a = 0.02
b = 0.012
dc = 1e-3
v0 = 1e-3
velocity = 1e-4
";

/// A block that is pressed on a base and dragged over it, in whatever way it is computed.
fn dragged(method: &str, more: &str) -> String {
    let numbers = ["[9, 3]", "[4, 4]", "2e9", "0.03", "3"];
    let text = support::dragged(method, numbers);
    text.replace("friction.coulomb = { mu = 0.3 }\n", "") + DRAGGED + more
}

/// Points carry what the law says at their velocity and state, and the state has nearly been renewed.
fn obeys(what: &str, text: &str, tolerance: f64) {
    let problem = support::problem(text);
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{what}: {e}"));
    let run = simulation.run(&mut []);
    run.unwrap_or_else(|e| panic!("{what}: {e}"));
    let u = &simulation.view().frame.state.u;
    let (names, columns) = look::table(support::contact(&simulation), u);
    let column = |name: &str| &columns[names.iter().position(|n| n == name).expect("a column")];
    let [pressure, shear, theta, speed] = ["CPRESS", "CSHEAR1", "THETA", "V"].map(column);
    let mut slid = 0;
    for i in (0..pressure.len()).filter(|&i| pressure[i] > 0.0) {
        slid += 1;
        let state = (0.4 + 0.012 * theta[i].ln()) / 0.02;
        let mu = 0.02 * (speed[i] / 2e-3 * state.exp()).asinh();
        let off = shear[i].abs() / (mu * pressure[i]) - 1.0;
        assert!(off.abs() < tolerance, "{what}: point {i} {off:e}");
        let renewed = theta[i] * speed[i] / 1e-3;
        assert!((renewed - 1.0).abs() < 0.2, "{what}: {renewed:e}");
        assert!((speed[i] / 0.015 - 1.0).abs() < 0.3, "{what}: {}", speed[i]);
    }
    assert!(slid >= 3, "{what}: {slid} points");
}

const STEP: &str = "[[step]]\nduration = 3\nincrements = { initial = 1e-4, state-change = 0.4 }\n";

#[test]
fn points_obey_the_law_in_every_way_to_compute() {
    for method in ["condensed", "sparse", "multigrid"] {
        for discretisation in ["mortar", "node-to-facet"] {
            let more = format!("[interface.press.discretisation.{discretisation}]\n{STEP}");
            let what = format!("{method} {discretisation}");
            obeys(&what, &dragged(method, &more), 1e-6);
        }
    }
    for enforcement in [
        "penalty = {}",
        "perturbed-lagrangian = {}",
        "augmented-lagrangian = {}",
    ] {
        let text = dragged("sparse", STEP).replace(
            "normal.linear = { c = 2e9 }",
            &format!("enforcement.{enforcement}"),
        );
        obeys(enforcement, &text, 1e-6);
    }
    let motion = "[body.block.rayleigh]\nmass = 20\n[[step]]\nduration = 3\n";
    for scheme in [
        "generalised-alpha = { rho = 0.6 }",
        "central-difference = {}",
    ] {
        let more = format!("{motion}dynamic.scheme.{scheme}\n");
        obeys(scheme, &dragged("sparse", &more), 1e-6);
    }
}

#[test]
fn a_run_goes_on_from_a_checkpoint() {
    for method in ["condensed", "sparse"] {
        let problem = support::problem(&dragged(method, STEP));
        let setup = || -> Setup {
            let built = problem.build(std::path::Path::new("."));
            built.unwrap_or_else(|e| panic!("{e}"))
        };
        restart::check_setups(method, &setup, 3);
    }
}

#[test]
fn parameters_and_other_laws_that_do_not_fit_are_refused() {
    let law = "a = 0.02\n";
    for (from, to, part) in [
        (law, "a = -1\n", "positive"),
        (
            law,
            "a = { along = [0, 0], table = [[0, 1]] }\n",
            "direction",
        ),
        (
            law,
            "a = { along = [0, 1], table = [[1, 1], [0, 1]] }\n",
            "ascending",
        ),
        (law, "a = 0.02\ntheta = 1\nratio = 0.5\n", "excludes"),
        (law, "a = 0.02\nevolution = \"other\"\n", "evolution"),
    ] {
        let complaint = support::complaint(&dragged("sparse", STEP).replace(from, to));
        assert!(complaint.contains(part), "{complaint}");
    }
    let events = "output.slip-events.speed = 1e-3\n";
    let none = events.to_string()
        + &support::dragged("sparse", ["[9, 3]", "[4, 4]", "2e9", "0.03", "3"])
        + STEP;
    assert!(support::complaint(&none).contains("keeps its speed"));
    let negative = "output.slip-events.speed = -1\n".to_string() + &dragged("sparse", STEP);
    let complaint = support::complaint(&negative);
    assert!(complaint.contains("greater than 0"), "{complaint}");
    let regularised = dragged("sparse", STEP).replace(
        "normal.linear",
        "slip.regularised.epsilon = 1e-3\nnormal.linear",
    );
    let complaint = support::complaint(&regularised);
    assert!(complaint.contains("nothing to regularise"), "{complaint}");
    let modes = dragged("sparse", STEP) + "[[step]]\ncomplex-modes = { count = 2 }\n";
    let complaint = support::complaint(&modes);
    assert!(complaint.contains("keeps a state"), "{complaint}");
}

/// Grid lines from `start` to `end` whose distances grow from `first` by a factor.
fn growing(start: f64, end: f64, first: f64, factor: f64) -> Vec<f64> {
    let (mut lines, mut size) = (vec![start], first);
    while lines[lines.len() - 1] + 1.5 * size < end {
        lines.push(lines[lines.len() - 1] + size);
        size *= factor;
    }
    lines.push(end);
    lines
}

/// Benchmark BP1-QD of SEAS, one side of the fault: cells of 400 m down to 18 km, a box of 400 km. Displacement out of the plane is that along the fault here: with stiffnesses that
/// are all the shear modulus, and none across, the plane problem with no displacement across the fault is the antiplane one. Slip is twice the displacement, so `D_c`, velocities and one over η are
/// halved.
fn fault(duration: f64) -> String {
    let modulus = 2670.0 * 3464.0_f64.powi(2);
    let eta = modulus / 2.0 / 3464.0;
    let asinh = (1e-9 / 2e-6 * ((0.6 + 0.015 * 1e3_f64.ln()) / 0.025).exp()).asinh();
    let shear = 50e6 * 0.025 * asinh + eta * 1e-9;
    assert!((shear / 26.546_122_4e6 - 1.0).abs() < 5e-9);
    let mut depths = growing(0.0, 18e3, 400.0, 1.0);
    depths.extend(growing(18e3, 40e3, 440.0, 1.1).into_iter().skip(1));
    let last = depths[depths.len() - 1] - depths[depths.len() - 2];
    depths.extend(growing(40e3, 400e3, 1.2 * last, 1.2).into_iter().skip(1));
    let y: Vec<f64> = depths.iter().rev().map(|d| -d).collect();
    let x = growing(0.0, 400e3, 400.0, 1.15);
    format!(
        r#"
format = 1
model.space = "plane-strain"
[body.crust]
generate.rectangle = {{ x = {x:?}, y = {y:?} }}
material = "rock"
[material.rock.anisotropic]
stiffness = [[{g},0,0,0,0,0],[0,{g},0,0,0,0],[0,0,{g},0,0,0],[0,0,0,{g},0,0],[0,0,0,0,{g},0],[0,0,0,0,0,{g}]]
[set.fault]
of = "crust.left"
box = {{ from = [-1, -40001], to = [1, 1] }}
[set.deep]
of = "crust.left"
box = {{ from = [-1, -1e9], to = [1, -39999] }}
[obstacle.mirror]
plane = {{ point = [0, 0], normal = [1, 0] }}
[interface.fault]
secondary = "fault"
primary = "mirror"
normal.linear = {{ c = 5e8 }}
initial = "offset"
initial-gap = -0.1
kinematics.small-sliding = {{}}
enforcement.perturbed-lagrangian = {{}}
[interface.fault.friction.rate-and-state]
f0 = 0.6
a = {{ along = [0, -1], table = [[15e3, 0.010], [18e3, 0.025]] }}
b = 0.015
dc = 4e-3
v0 = 0.5e-6
eta = {eta2}
velocity = 0.5e-9
ratio = {ratio}
[support.plane]
set = "crust"
x = 0
[load.far]
set = "crust.right"
traction = {{ value = [0, {shear}] }}
amplitude = "prestress"
[support.creep]
set = "deep"
y = {way}
amplitude = "creep"
[amplitude.prestress]
table = [[0, 0], [1, 1]]
[amplitude.creep]
table = [[0, 0], [1, 0], [{end}, 1]]
[[step]]
name = "prestress"
duration = 1
increments.fixed = 2
[[step]]
name = "creep"
duration = {duration}
increments = {{ initial = 1e-7, smallest = 1e-18, state-change = 0.2 }}
"#,
        g = modulus,
        eta2 = 2.0 * eta,
        ratio = (shear - eta * 1e-9) / 50e6,
        way = 0.5e-9 * duration,
        end = duration + 1.0,
    )
}

/// The fault before its first earthquake: velocity, shear and state at 7.5 km depth after 10, 50 and 100 years are those of boundary elements of a half-space.
#[test]
fn a_fault_creeps_from_below_before_its_first_earthquake() {
    let year = 365.25 * 86400.0;
    for (years, velocity, traction) in [
        (10.0, -15.7263, 26.7392),
        (50.0, -16.2110, 27.3882),
        (100.0, -15.9601, 28.1970),
    ] {
        let problem = support::problem(&fault(years * year));
        let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        let run = simulation.run(&mut []);
        run.unwrap_or_else(|e| panic!("{e}"));
        let contact = support::contact(&simulation);
        let (names, columns) = look::table(contact, &simulation.view().frame.state.u);
        let [shear, speed, theta] = ["CSHEAR1", "V", "THETA"].map(|name| {
            let k = names.iter().position(|n| n == name);
            &columns[k.expect("a column")]
        });
        // Between the two points beside it.
        let mut near: Vec<(f64, usize)> = contact
            .places()
            .iter()
            .enumerate()
            .map(|(i, p)| (p[1] + 7500.0, i))
            .collect();
        near.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let [(d0, i), (d1, j)] = [near[0], near[1]];
        let between = |of: &dyn Fn(usize) -> f64| of(i) + (of(j) - of(i)) * d0 / (d0 - d1);
        let log_velocity = between(&|i| (2.0 * speed[i]).log10());
        assert!(
            (log_velocity - velocity).abs() < 5e-3,
            "{years}: {log_velocity}"
        );
        let megapascals = between(&|i| shear[i].abs() / 1e6);
        assert!(
            (megapascals - traction).abs() < 5e-3,
            "{years}: {megapascals}"
        );
        if years == 100.0 {
            let log_theta = between(&|i| theta[i].log10());
            assert!((log_theta - 9.4991).abs() < 1e-4, "{log_theta}");
        }
    }
}
