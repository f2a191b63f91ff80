//! What of the results goes into the `.frd` file, and when.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use super::history::Row;
use crate::assess::view::View;
use crate::error::Error;
use crate::io::frd::{Block, Layout, Moment, Results, Shape, Tally};
use crate::system::{Field, Fields, Location};

/// The file of a problem whose caller names none.
pub(crate) const NAME: &str = "fields.frd";

/// What a block of the file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// `DISP`: displacement.
    Displacement,
    /// `VELO`: velocity, where a step is dynamic.
    Velocity,
    /// `STRESS`: stress, averaged at the points within a body.
    Stress,
    /// `TOSTRAIN`: strain, averaged as stress; shear strains are those of the tensor.
    Strain,
    /// `FORC`: what the elements resist with: the reaction at supports, the load where there is one.
    Force,
    /// `ENER`: strain energy per volume, averaged as stress.
    Energy,
    /// `NDTEMP`: temperature, where some are given.
    Temperature,
    /// `CONTACT`: gap, slip, pressure and shear at the points of interfaces.
    Contact,
}

impl Quantity {
    /// Every quantity, in the order of the file.
    pub const ALL: [Quantity; 8] = [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::Stress,
        Quantity::Strain,
        Quantity::Force,
        Quantity::Energy,
        Quantity::Temperature,
        Quantity::Contact,
    ];
}

/// At which of the times at which fields are written. The end of a step always counts.
#[derive(Debug, Clone, PartialEq)]
pub enum Due {
    /// After every so many increments.
    Every(usize),
    /// At these times `[the problem's unit of time]`.
    At(Vec<f64>),
}

/// Quantities, and when they are written.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Quantities.
    pub quantities: Vec<Quantity>,
    /// When.
    pub due: Due,
}

/// The `.frd` file of a run, if its problem asks for one.
#[derive(Debug, Clone, PartialEq)]
pub struct FrdPlan {
    /// Its name in the folder of results.
    pub name: String,
    /// What is written in each step; everything whenever fields are, if not given.
    pub steps: Option<Vec<Vec<Request>>>,
}

impl Default for FrdPlan {
    fn default() -> Self {
        FrdPlan {
            name: NAME.into(),
            steps: None,
        }
    }
}

/// How far a file has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub(crate) struct Reached {
    pub tally: Tally,
    /// Step and increment of the last output.
    pub last: (usize, usize),
}

/// Writes the `.frd` file.
#[derive(Debug)]
pub(crate) struct Writer {
    plan: FrdPlan,
    /// The thread that writes has it as well.
    file: Option<Arc<Mutex<Results>>>,
    /// The file is there, from before this process.
    there: bool,
    reached: Reached,
    moment: Moment,
    /// A step ends here.
    ends: bool,
}

/// What is to be written of an output.
pub(crate) struct Job {
    file: Arc<Mutex<Results>>,
    moment: Moment,
    quantities: Vec<Quantity>,
    /// Fields that are in this file only.
    own: Fields,
}

impl Writer {
    /// Starts a file, or goes on with one that has come so far.
    pub fn new(plan: &FrdPlan, reached: Option<Reached>) -> Writer {
        Writer {
            plan: plan.clone(),
            file: None,
            there: reached.is_some(),
            reached: reached.unwrap_or_default(),
            moment: Moment {
                step: 0,
                increment: 0,
                time: 0.0,
            },
            ends: false,
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.plan.name
    }

    /// How far it has come, when nothing is being written.
    pub fn reached(&self) -> Reached {
        self.reached
    }

    /// Takes in where the analysis stands.
    pub fn see(&mut self, view: &View, row: &Row) {
        let column = |name: &str| row.get(name).unwrap_or(0.0);
        self.moment = Moment {
            step: column("STEP") as usize,
            increment: column("INC") as usize,
            time: column("TIME"),
        };
        let step = view.model.steps.get(self.moment.step.saturating_sub(1));
        self.ends = step.is_some_and(|s| self.moment.time >= s.end * (1.0 - 1e-12));
    }

    /// What is to be written now; `owners` has the number of its body for every cell.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be started.
    pub fn job(
        &mut self,
        view: &View,
        directory: &Path,
        owners: impl Fn() -> Vec<usize>,
    ) -> Result<Option<Job>, Error> {
        let now = (self.moment.step, self.moment.increment);
        let quantities = self.due(view);
        // Before the first increment there is nothing that a step or an increment could be named for.
        if quantities.is_empty() || now.0 == 0 || now == self.reached.last {
            return Ok(None);
        }
        let Some(file) = self.open(view, directory, owners)? else {
            return Ok(None);
        };
        self.reached.last = now;
        self.reached.tally.outputs += 1;
        Ok(Some(Job {
            file,
            moment: self.moment,
            own: own_fields(view, &quantities),
            quantities,
        }))
    }

    /// Quantities that are due and that there are.
    fn due(&self, view: &View) -> Vec<Quantity> {
        let near = |t: &f64| (t - self.moment.time).abs() <= 1e-9 * self.moment.time.abs();
        let due = |request: &&Request| match &request.due {
            _ if self.ends => true,
            Due::Every(n) => self.moment.increment.is_multiple_of((*n).max(1)),
            Due::At(times) => times.iter().any(near),
        };
        let mut wanted = match &self.plan.steps {
            None => Quantity::ALL.to_vec(),
            Some(steps) => {
                let step = steps.get(self.moment.step.saturating_sub(1));
                let requests = step.into_iter().flatten().filter(due);
                requests.flat_map(|r| r.quantities.clone()).collect()
            }
        };
        wanted.sort_unstable();
        wanted.dedup();
        wanted.retain(|quantity| match quantity {
            Quantity::Velocity => view.model.moves(),
            Quantity::Temperature => view.model.actions.heat.is_some(),
            Quantity::Contact => !view.contact.interfaces.is_empty(),
            _ => true,
        });
        wanted
    }

    /// The file, started where there is none yet; none if the problem asks for none.
    fn open(
        &mut self,
        view: &View,
        directory: &Path,
        owners: impl Fn() -> Vec<usize>,
    ) -> Result<Option<Arc<Mutex<Results>>>, Error> {
        let Some(encoding) = view.model.reports.output.frd else {
            return Ok(None);
        };
        if let Some(file) = &self.file {
            return Ok(Some(Arc::clone(file)));
        }
        let model = view.model;
        let names: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
        let layout = Layout::new(&model.mesh, &model.title, &names, &owners(), encoding);
        let path = directory.join(&self.plan.name);
        let file = match self.there {
            true => Results::resume(&path, layout, self.reached.tally)?,
            false => Results::create(&path, layout)?,
        };
        let file = Arc::new(Mutex::new(file));
        Ok(Some(Arc::clone(self.file.insert(file))))
    }

    /// Takes note of what has been written.
    pub fn written(&mut self) {
        if let Some(file) = &self.file {
            let file = file.lock().unwrap_or_else(PoisonError::into_inner);
            self.reached.tally = file.tally();
        }
    }
}

impl Job {
    /// Writes it, with the fields that are in other files, too.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn write(&self, fields: &Fields) -> Result<(), Error> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let points = file.layout().points().to_vec();
        let field = |name: &str| fields.get(name).or_else(|| self.own.get(name));
        let blocks = self.quantities.iter();
        let blocks: Vec<Block> = blocks
            .filter_map(|&quantity| block(quantity, &points, &field))
            .collect();
        file.add(&self.moment, &blocks)
    }
}

/// Fields that only this file has.
fn own_fields(view: &View, quantities: &[Quantity]) -> Fields {
    let mut out = Fields::default();
    let model = view.model;
    let strain = [Quantity::Strain, Quantity::Energy];
    if quantities.iter().any(|q| strain.contains(q)) {
        let strained = view.strained();
        for body in &model.bodies {
            body.strain_fields(&strained, &mut out);
        }
        view.turn_tensors(&mut out);
    }
    if quantities.contains(&Quantity::Force) {
        let mut forces = view.internal_forces();
        (model.frames).turn_out(&view.frame.state.u, &mut forces);
        let points = 0..model.mesh.points.len();
        out.all.push(Field {
            name: "FORC".into(),
            location: Location::Point,
            components: 3,
            values: points.flat_map(|p| model.dofs.vector(&forces, p)).collect(),
        });
    }
    out
}

const STRESSES: &[&str] = &["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"];
const STRAINS: &[&str] = &["EXX", "EYY", "EZZ", "EXY", "EYZ", "EZX"];

/// Components of `CONTACT`, with their signs there: shear is that on the primary, so that it has the sign of the slip.
const CONTACT: [(&str, f64); 6] = [
    ("COPEN", 1.0),
    ("CSLIP1", 1.0),
    ("CSLIP2", 1.0),
    ("CPRESS", 1.0),
    ("CSHEAR1", -1.0),
    ("CSHEAR2", -1.0),
];

/// The block of a quantity.
fn block<'a>(
    quantity: Quantity,
    points: &[usize],
    field: &impl Fn(&str) -> Option<&'a Field>,
) -> Option<Block> {
    let at = |name: &'static str, source: &str, components: &'static [&'static str], shape| {
        plain(field(source)?, points, name, components, shape)
    };
    match quantity {
        Quantity::Displacement => at("DISP", "U", &["D1", "D2", "D3"], Shape::Vector),
        Quantity::Velocity => at("VELO", "V", &["V1", "V2", "V3"], Shape::Vector),
        Quantity::Force => at("FORC", "FORC", &["F1", "F2", "F3"], Shape::Vector),
        Quantity::Stress => at("STRESS", "S", STRESSES, Shape::Tensor),
        Quantity::Temperature => at("NDTEMP", "NT", &["T"], Shape::Scalar),
        Quantity::Energy => at("ENER", "ENER", &["ENER"], Shape::Scalar),
        Quantity::Strain => {
            let mut block = at("TOSTRAIN", "E", STRAINS, Shape::Tensor)?;
            for strain in block.values.chunks_exact_mut(6) {
                strain[3..].iter_mut().for_each(|shear| *shear *= 0.5);
            }
            Some(block)
        }
        Quantity::Contact => contact(points, field),
    }
}

fn plain(
    field: &Field,
    points: &[usize],
    name: &'static str,
    components: &'static [&'static str],
    shape: Shape,
) -> Option<Block> {
    let count = shape.count();
    let values = points
        .iter()
        .flat_map(|&p| &field.values[count * p..count * (p + 1)]);
    Some(Block {
        name,
        components,
        shape,
        points: points.to_vec(),
        values: values.copied().collect(),
    })
}

/// Values at points of interfaces; where there are none there is no line either. Plane problems have no second direction.
fn contact<'a>(points: &[usize], field: &impl Fn(&str) -> Option<&'a Field>) -> Option<Block> {
    let pressure = field("CPRESS")?;
    let there = |p: &usize| !pressure.values[*p].is_nan();
    let points: Vec<usize> = points.iter().copied().filter(there).collect();
    let columns = CONTACT.map(|(name, sign)| (field(name), sign));
    let value = |p: usize, (column, sign): (Option<&Field>, f64)| {
        column.map_or(0.0, |column| sign * column.values[p])
    };
    let values = points.iter().flat_map(|&p| columns.map(|c| value(p, c)));
    Some(Block {
        name: "CONTACT",
        components: &["COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"],
        shape: Shape::Tensor,
        values: values.collect(),
        points,
    })
}
