//! Tables on their own: dimensions, parameters of models, what excludes what.

use super::super::key;
use super::super::reference::spin_matrix;
use super::super::{FacetShape, Initial, Interface, Material, Problem, Select, SpaceKind};
use super::findings::Findings;
use crate::body::Formulation;
use crate::contact::enforcement::Multipliers;
use crate::contact::interface::Start;
use crate::contact::law::damping::DampingModel;
use crate::contact::law::friction::FrictionModel;
use crate::contact::law::normal::NormalModel;
use crate::contact::law::slip::SlipModel;
use crate::contact::law::wear::{Feedback, WearModel, WearRate};
use crate::contact::obstacle::ObstacleShape;
use crate::math::{Mat3, determinant, normalize};
use crate::number::digits;
use crate::registry::Family;
use crate::system::{Amplitude, AmplitudeError, Component};

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    let space = problem.model.space;
    if problem.model.thickness.is_some()
        && matches!(space, SpaceKind::Axisymmetric | SpaceKind::Solid)
    {
        findings.add(
            &["model", "thickness"],
            format!(
                "a thickness has no meaning where the model is {}",
                space.name()
            ),
            "remove the key",
        );
    }
    for (name, body) in &problem.body {
        if let Some(shift) = &body.translate {
            findings.vector(problem, &["body", name, "translate"], shift);
        }
        if body.formulation == Formulation::MeanDilatation && space == SpaceKind::PlaneStress {
            findings.add(
                &["body", name, "formulation"],
                "mean-dilatation has no meaning in plane stress",
                "remove the key: where the strain across the plane is free, nothing locks",
            );
        }
    }
    rigid(problem, findings);
    materials(problem, findings);
    heat(problem, findings);
    obstacles(problem, findings);
    for (name, set) in &problem.set {
        select(problem, findings, name, &set.select);
    }
    for (name, interface) in &problem.interface {
        laws(findings, &["interface", name], interface);
        roughness(problem, findings, name, interface);
        wear(problem, findings, &["interface", name], interface);
        velocity(problem, findings, name, interface);
    }
    changes(problem, findings);
    supports(problem, findings);
    references(problem, findings);
    for (name, amplitude) in &problem.amplitude {
        times(
            findings,
            &["amplitude", name, "table"],
            amplitude.table.clone(),
        );
    }
    for (name, initial) in &problem.initial {
        let vectors = [
            ("displacement", &initial.displacement),
            ("velocity", &initial.velocity),
        ];
        for (key, value) in vectors {
            if let Some(value) = value {
                findings.vector(problem, &["initial", name, key], value);
            }
        }
        spin(problem, findings, name, initial);
    }
    for (name, probe) in &problem.probe {
        findings.vector(problem, &["probe", name, "point"], &probe.point);
    }
}

/// What a rigid body needs, and what has no meaning for it.
fn rigid(problem: &Problem, findings: &mut Findings) {
    for (name, body) in problem.body.iter().filter(|(_, b)| b.rigid) {
        for material in body.material.iter().chain(body.regions.values()) {
            let Some(model) = problem.material.get(material) else {
                continue;
            };
            let density = model.as_dyn().density();
            if density.is_nan() || density <= 0.0 {
                findings.add(
                    &["material", material, model.kind()],
                    format!("body `{name}` is rigid, but its material has no density"),
                    "give `density`: the centre of mass follows from it",
                );
            }
        }
        let unused = [
            ("formulation", body.formulation != Formulation::default()),
            ("rayleigh", body.rayleigh.is_some()),
        ];
        for (key, given) in unused {
            if given {
                findings.add(
                    &["body", name, key],
                    format!("`{key}` has no meaning for a rigid body"),
                    "remove the key, or `rigid`",
                );
            }
        }
    }
}

fn spin(problem: &Problem, findings: &mut Findings, name: &str, initial: &Initial) {
    let Initial {
        displacement,
        velocity,
        spin,
        result,
        ..
    } = initial;
    let wanted = if problem.model.space.dim() == 2 { 1 } else { 3 };
    if let Some(spin) = spin
        && spin.len() != wanted
    {
        let message = format!("expected {wanted} numbers, found {}", spin.len());
        findings.add(&["initial", name, "spin"], message, "");
    }
    let given = displacement.is_some() || velocity.is_some() || spin.is_some();
    let warm = initial.temperature.is_some();
    match (result, given) {
        (Some(_), true) => findings.add(
            &["initial", name, "result"],
            "`result` excludes `displacement`, `velocity` and `spin`",
            "keep one of the two",
        ),
        (None, false) if !warm => findings.add(
            &["initial", name],
            "nothing is given",
            "give displacement, velocity, spin, temperature or result",
        ),
        _ => {}
    }
}

fn materials(problem: &Problem, findings: &mut Findings) {
    for (name, material) in &problem.material {
        let Err(error) = material.as_dyn().check() else {
            continue;
        };
        let key = ["material", name, material.kind()];
        let eigenvalue = error.smallest_eigenvalue.map(|value| {
            format!(
                "; the smallest eigenvalue of the stiffness is {value}",
                value = digits(value, 5)
            )
        });
        let message = error.message + &eigenvalue.unwrap_or_default();
        let mut key: Vec<&str> = key.to_vec();
        key.extend(error.parameter.split('.'));
        findings.add(&key, message, error.help.unwrap_or_default());
    }
}

/// Fields of temperature, and materials by temperature.
fn heat(problem: &Problem, findings: &mut Findings) {
    let space = problem.model.space.bare();
    for (name, temperature) in &problem.temperature {
        let key = ["temperature", name, temperature.kind.kind()];
        findings.faults(&key, temperature.kind.as_dyn().faults(space));
    }
    for (name, initial) in &problem.initial {
        if let Some(kind) = &initial.temperature {
            let key = ["initial", name, "temperature", kind.kind()];
            findings.faults(&key, kind.as_dyn().faults(space));
        }
    }
    for (name, material) in &problem.material {
        if let Some(expansion) = &material.expansion
            && let Ok(frame) = material.as_dyn().frame()
            && let Err(e) = expansion.dilation(frame)
        {
            let mut key = vec!["material", name];
            key.extend(e.parameter.split('.'));
            findings.add(&key, e.message, e.help.unwrap_or_default());
        }
        constants(findings, name, material);
    }
}

/// Elastic constants at further temperatures.
fn constants(findings: &mut Findings, name: &str, material: &Material) {
    let mut before = material.temperature;
    if before.is_some() && material.at.is_empty() {
        findings.add(
            &["material", name, "temperature"],
            "the elastic constants hold at every temperature",
            "remove the key, or give those at other temperatures by `at`",
        );
    }
    if before.is_none() && !material.at.is_empty() {
        findings.add(
            &["material", name, "at"],
            "the temperature of the first elastic constants is missing",
            "give `temperature`, at which those beside it hold",
        );
    }
    for (i, row) in material.at.iter().enumerate() {
        let i = key::entry(i);
        let key = ["material", name, "at", &i];
        if before.is_some_and(|t| t >= row.temperature) {
            let message = format!(
                "the temperature {} does not follow the one before",
                row.temperature
            );
            let at = [&key[..], &["temperature"]].concat();
            findings.add(&at, message, "temperatures increase");
        }
        before = Some(row.temperature);
        if let Err(error) = row.kind.as_dyn().check() {
            let mut key = [&key[..], &[row.kind.kind()]].concat();
            key.extend(error.parameter.split('.'));
            findings.add(&key, error.message, error.help.unwrap_or_default());
        }
    }
}

fn obstacles(problem: &Problem, findings: &mut Findings) {
    let dim = problem.model.space.dim();
    for (name, obstacle) in &problem.obstacle {
        let key = ["obstacle", name, obstacle.shape.kind()];
        findings.faults(&key, obstacle.shape.as_dyn().faults(dim));
        if let Some(motion) = &obstacle.motion {
            findings.faults(&["obstacle", name, "motion"], motion.faults(dim));
        }
    }
}

fn select(problem: &Problem, findings: &mut Findings, name: &str, select: &Select) {
    let key = |last: &'static str| ["set", name, last];
    match select {
        Select::Point(point) => findings.vector(problem, &key("point"), point),
        Select::Box(region) => {
            findings.vector(problem, &["set", name, "box", "from"], &region.from);
            findings.vector(problem, &["set", name, "box", "to"], &region.to);
            if region.from.iter().zip(&region.to).any(|(a, b)| a > b) {
                let message = "`from` lies beyond `to`: the box is empty";
                findings.add(&key("box"), message, "`from` has the smaller coordinates");
            }
        }
        Select::Plane(plane) => {
            findings.vector(problem, &["set", name, "plane", "point"], &plane.point);
            direction(
                problem,
                findings,
                &["set", name, "plane", "normal"],
                &plane.normal,
            );
        }
        Select::Normal(region) => {
            let at = ["set", name, "normal", "direction"];
            direction(problem, findings, &at, &region.direction);
        }
        Select::Ball(ball) => {
            findings.vector(problem, &["set", name, "ball", "centre"], &ball.centre);
        }
        Select::Numbers(numbers) if numbers.is_empty() => {
            findings.add(&key("numbers"), "a set without points", "");
        }
        Select::Numbers(_) | Select::Union(_) => {}
    }
}

/// A vector that is not zero.
fn direction(problem: &Problem, findings: &mut Findings, at: &[&str], vector: &[f64]) {
    findings.vector(problem, at, vector);
    let whole: [f64; 3] = std::array::from_fn(|c| vector.get(c).copied().unwrap_or(0.0));
    if normalize(whole).is_none() {
        findings.add(at, "the vector is zero", "");
    }
}

/// The laws that interfaces have after a change are laws as well.
fn changes(problem: &Problem, findings: &mut Findings) {
    let mut now = problem.interface.clone();
    for (i, step) in problem.step.iter().enumerate() {
        let i = key::entry(i);
        for (name, change) in &step.change {
            let Some(interface) = now.get_mut(name) else {
                continue;
            };
            let table = ["step", i.as_str(), "change", name.as_str()];
            if interface.tied {
                let message = "the surfaces are tied: laws have no meaning";
                findings.add(&table, message, "remove the change, or `tied`");
                continue;
            }
            if let Some(normal) = &change.normal {
                interface.normal = normal.clone();
            }
            if let Some(friction) = &change.friction {
                interface.friction = friction.clone();
            }
            // What is wrong without it has been said.
            let mut found = Findings(Vec::new());
            laws(&mut found, &table, interface);
            let before = &problem.interface[name];
            let mut known = Findings(Vec::new());
            laws(&mut known, &table, before);
            found.0.retain(|f| !known.0.contains(f));
            findings.0.append(&mut found.0);
        }
    }
}

/// What is wrong with the heights of a rough surface.
fn roughness(problem: &Problem, findings: &mut Findings, name: &str, interface: &Interface) {
    let Some(roughness) = &interface.roughness else {
        return;
    };
    let key = |last| ["interface", name, "roughness", last];
    for (last, vector) in [("origin", &roughness.origin), ("along", &roughness.along)] {
        if let Some(vector) = vector {
            findings.vector(problem, &key(last), vector);
        }
    }
    let kind = &roughness.kind;
    let dim = problem.model.space.dim();
    findings.faults(&key(kind.kind()), kind.as_dyn().faults(dim));
    if interface.discretisation().as_dyn().two_sided() {
        findings.add(
            &["interface", name, "roughness"],
            "heights are those of one surface, and here each is the secondary of half of the contact",
            "choose another discretisation",
        );
    }
}

/// What is wrong with how near points have to be at the start.
fn initial(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let mut add = |key: &str, message: &str, help: &str| {
        let key: Vec<&str> = table.iter().copied().chain([key]).collect();
        findings.add(&key, message, help);
    };
    if interface.initial_tolerance.is_some() && interface.initial_distance.is_some() {
        let message = "give `initial-tolerance` or `initial-distance`, not both";
        add(
            "initial-distance",
            message,
            "the one is a fraction of the height of cells, the other a length",
        );
    }
    if interface.initial_gap.is_some() && interface.initial != Start::Offset {
        let message = "gaps count as they are unless `initial = \"offset\"`";
        add(
            "initial-gap",
            message,
            "add initial = \"offset\", or remove the key",
        );
    }
    if interface.initial_set.is_some() && interface.initial != Start::Snap {
        let message = "only `initial = \"snap\"` moves points";
        add(
            "initial-set",
            message,
            "add initial = \"snap\", or remove the key",
        );
    }
}

/// What is wrong with the laws of an interface; `table` is where they are chosen.
fn laws(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let Interface {
        normal,
        damping,
        friction,
        enforcement,
        ..
    } = interface;
    parameters(findings, table, interface);
    elements(findings, table, interface);
    flows(findings, table, interface);
    tied(findings, table, interface);
    initial(findings, table, interface);
    facets(findings, table, interface);
    let at = |key: &'static str| [table, &[key]].concat();
    // A law is asked for nothing whose parameters make no sense.
    let set_valued = normal.as_dyn().faults().is_empty() && normal.as_dyn().pressure(0.0).is_none();
    let multipliers = enforcement.as_dyn().multipliers() != Multipliers::None;
    // Two conditions for one gap: each alone would close it, and multipliers cannot share what they do.
    if interface.discretisation().as_dyn().two_sided()
        && multipliers
        && (set_valued || friction.as_dyn().frictional())
    {
        findings.add(
            &at("discretisation"),
            "two-sided contact with multipliers has more conditions than unknowns",
            "choose enforcement.penalty, or a compliant normal law without friction",
        );
    }
    // A multiplier takes whatever pressure closes the gap: damping would change nothing.
    if damping.as_dyn().active() && set_valued && multipliers {
        findings.add(
            &at("damping"),
            "damping needs a pressure that follows from the gap",
            "choose a compliant normal law or enforcement.penalty",
        );
    }
    // An exact law has no penetration of its own: what there is comes from the enforcement and means nothing.
    if friction.as_dyn().needs_penetration() && set_valued {
        findings.add(
            &at("friction"),
            format!(
                "friction `{}` depends on the penetration, which normal `{}` does not allow",
                friction.kind(),
                normal.kind()
            ),
            "choose a compliant normal law, or friction.coulomb",
        );
    }
}

/// What the models of an interface say of their own parameters.
fn parameters(findings: &mut Findings, table: &[&str], interface: &Interface) {
    fn of<F: Family>(model: &F, faults: Vec<(&'static str, String)>) -> Said {
        (F::KEY, model.kind(), faults)
    }
    type Said = (&'static str, &'static str, Vec<(&'static str, String)>);
    let i = interface;
    let discretisation = i.discretisation.iter();
    let said = [
        of(&i.normal, i.normal.as_dyn().faults()),
        of(&i.damping, i.damping.as_dyn().faults()),
        of(&i.friction, i.friction.as_dyn().faults()),
        of(&i.slip, i.slip.as_dyn().faults()),
        of(&i.wear, i.wear.as_dyn().faults()),
        of(&i.enforcement, i.enforcement.as_dyn().faults()),
    ];
    let said = said
        .into_iter()
        .chain(discretisation.map(|d| of(d, d.as_dyn().faults())));
    for (family, kind, faults) in said {
        findings.faults(&[table, &[family, kind]].concat(), faults);
    }
}

/// Contact elements of a point and a facet are a discretisation of their own.
fn elements(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let by_points = interface.kinematics.as_dyn().triangles()
        || interface.facets == Some(FacetShape::Triangles);
    if by_points && interface.discretisation().as_dyn().weighted().is_some() {
        findings.add(
            &[table, &["discretisation"]].concat(),
            "kinematics `pop-1995` and `facets = \"triangles\"` are for contact elements of a point and a facet",
            "remove the key, or write discretisation.node-to-facet = {}",
        );
    }
}

/// Laws under which surfaces always slide leave nothing to a slip rule.
fn flows(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let regularised = !interface.slip.as_dyn().sticks();
    if interface.friction.as_dyn().flows() && regularised {
        findings.add(
            &[table, &["slip"]].concat(),
            "under this friction law surfaces slide at any shear, so there is nothing to regularise",
            "remove the key",
        );
    }
}

/// Laws have no meaning where surfaces are tied.
fn tied(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let plain = Interface {
        normal: NormalModel::default(),
        damping: DampingModel::default(),
        friction: FrictionModel::default(),
        slip: SlipModel::default(),
        wear: WearModel::default(),
        primary_velocity: None,
        primary_velocity_table: None,
        ..interface.clone()
    };
    if interface.tied && interface.roughness.is_some() {
        let message =
            "surfaces that are tied keep the distances that they have: heights have no meaning";
        findings.add(
            &[table, &["roughness"]].concat(),
            message,
            "remove it, or `tied`",
        );
    }
    if interface.tied && plain != *interface {
        findings.add(
            &[table, &["tied"]].concat(),
            "laws and velocities have no meaning where surfaces are tied",
            "remove normal, damping, friction, slip and primary-velocity, or `tied`",
        );
    }
}

/// Where what is worn off cannot open the gap.
fn wear(problem: &Problem, findings: &mut Findings, table: &[&str], interface: &Interface) {
    if !interface.wear.as_dyn().active() || interface.wear_feedback == Feedback::None {
        return;
    }
    let mut add = |message: &str, help: &str| {
        findings.add(&[table, &["wear"]].concat(), message, help);
    };
    let obstacle = problem.obstacle.get(&interface.primary);
    if interface.discretisation().as_dyn().two_sided() && obstacle.is_none() {
        add(
            "two-sided contact has a depth for each half of the pressure, which the other half does not see",
            "choose another discretisation, or write wear-feedback = \"none\"",
        );
    }
    let [_, primary] = interface.wear.as_dyn().fastest();
    let belt = interface.primary_velocity.is_some() || interface.primary_velocity_table.is_some();
    if !interface.worn.is_empty() && primary != WearRate::default() && (obstacle.is_some() || belt)
    {
        add(
            "`worn` moves points of a mesh: what has been worn off an obstacle, or off a primary with `primary-velocity`, has none",
            "make the obstacle a body, or remove `worn`",
        );
    }
    if primary == WearRate::default() || !belt {
        return;
    }
    if obstacle.is_some_and(|o| !matches!(o.shape, ObstacleShape::Plane(_))) {
        add(
            "what is worn off a round obstacle goes around with it, and `primary-velocity` has one direction",
            "let the obstacle turn: `motion.rotation`",
        );
    }
    if problem.model.space == SpaceKind::Axisymmetric {
        add(
            "a surface that moves by `primary-velocity` does not turn about the axis: where its matter comes from is not known",
            "let the secondary alone wear, or write wear-feedback = \"none\"",
        );
    }
}

/// Which facets a kinematics needs.
fn facets(findings: &mut Findings, table: &[&str], interface: &Interface) {
    let triangles = interface.kinematics.as_dyn().triangles();
    if triangles && interface.facets == Some(FacetShape::Bilinear) {
        findings.add(
            &[table, &["facets"]].concat(),
            format!(
                "kinematics `{}` needs triangles",
                interface.kinematics.kind()
            ),
            "write facets = \"triangles\", or remove the key",
        );
    }
}

fn velocity(problem: &Problem, findings: &mut Findings, name: &str, interface: &Interface) {
    if let Some(velocity) = &interface.primary_velocity {
        let key = ["interface", name, "primary-velocity"];
        findings.vector(problem, &key, velocity);
        if interface.primary_velocity_table.is_some() {
            let message = "`primary-velocity` and `primary-velocity-table` exclude each other";
            findings.add(&key, message, "keep one of the two");
        }
    }
    if let Some(rows) = &interface.primary_velocity_table {
        let key = ["interface", name, "primary-velocity-table"];
        let dim = problem.model.space.dim();
        if let Some(i) = rows.iter().position(|row| row.len() != dim + 1) {
            let row = key::entry(i);
            let key = [&key[..], &[&row]].concat();
            let message = format!(
                "expected a time and {dim} components because the model is {}, found {} numbers",
                problem.model.space.name(),
                rows[i].len()
            );
            findings.add(&key, message, "");
        } else {
            times(
                findings,
                &key,
                rows.iter().map(|row| [row[0], 0.0]).collect(),
            );
        }
    }
}

fn supports(problem: &Problem, findings: &mut Findings) {
    for (name, support) in &problem.support {
        for &held in &support.hold {
            let (letter, value) = support.components()[held as usize];
            if value.is_some() {
                findings.add(
                    &["support", name, "hold"],
                    format!("`{letter}` is both held and prescribed"),
                    "keep one of the two",
                );
            }
            if !problem.model.space.has(held) {
                let message = format!("there is no component {letter} in the plane");
                findings.add(&["support", name, "hold"], message, "");
            }
        }
        let free = support.components().iter().all(|(_, x)| x.is_none());
        if free && support.hold.is_empty() {
            findings.add(
                &["support", name],
                format!("the support `{name}` holds no component"),
                "give x, y or z; 0.0 holds it fast",
            );
        }
        for (component, (letter, value)) in COMPONENTS.into_iter().zip(support.components()) {
            if value.is_some() && !problem.model.space.has(component) {
                let message = format!(
                    "there is no component {letter} because the model is {}",
                    problem.model.space.name()
                );
                findings.add(&["support", name, letter], message, "remove the key");
            }
            let given = value.is_some() || support.hold.contains(&component);
            let turns = component as usize >= 3;
            if given && turns && !problem.reference.contains_key(&support.set) {
                let key = if value.is_some() { letter } else { "hold" };
                findings.add(
                    &["support", name, key],
                    format!("`{}` has points, which cannot turn", support.set),
                    "only reference points have rotations: tie the points to one by coupling.kinematic or coupling.distributing",
                );
            }
        }
    }
}

const COMPONENTS: [Component; 6] = [
    Component::X,
    Component::Y,
    Component::Z,
    Component::RotationX,
    Component::RotationY,
    Component::RotationZ,
];

fn references(problem: &Problem, findings: &mut Findings) {
    for (name, reference) in &problem.reference {
        let point = &reference.point;
        findings.vector(problem, &["reference", name, "point"], point);
        let Some(inertia) = &reference.inertia else {
            continue;
        };
        let plane = problem.model.space.dim() == 2;
        let (wanted, help): (&[usize], _) = match plane {
            true => (&[1], "give the one about z, [zz]"),
            false => (&[3, 6], "give [xx, yy, zz] or [xx, yy, zz, xy, yz, xz]"),
        };
        let key = ["reference", name, "inertia"];
        if !wanted.contains(&inertia.len()) {
            let message = format!("{} moments of inertia", inertia.len());
            findings.add(&key, message, help);
        } else if !positive(&spin_matrix(inertia)) {
            let message = "the moments of inertia are not those of a body";
            findings.add(&key, message, "all of them about any axis must be positive");
        }
    }
}

/// Whether a symmetric matrix is positive definite, by its minors.
fn positive(m: &Mat3) -> bool {
    let second = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    m[0][0] > 0.0 && second > 0.0 && determinant(m) > 0.0
}

fn times(findings: &mut Findings, key: &[&str], table: Vec<[f64; 2]>) {
    match Amplitude::new(table) {
        Ok(_) => {}
        Err(AmplitudeError::Empty) => findings.add(key, "the table has no rows", ""),
        Err(AmplitudeError::Row(i)) => {
            let row = key::entry(i);
            let key = [key, &[&row]].concat();
            findings.add(
                &key,
                "the time does not increase",
                "each row starts with a time larger than that of the row before",
            );
        }
    }
}
