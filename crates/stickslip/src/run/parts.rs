//! What an analysis consists of while it runs, and how it shows itself to judges and observers.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use super::cycle_block::CycleBlock;
use super::position::Steps;
use super::queue::{Pending, TakenBack};
use crate::assess::diagnosis::{beginning, soon, start_gaps};
use crate::assess::doctor::{self, Finding, Watch};
use crate::assess::view::View;
use crate::body::{Around, around};
use crate::contact::look;
use crate::error::Error;
use crate::integrate::integrator::Integrator;
use crate::integrate::quasi_static::QuasiStatic;
use crate::modal::ModalOutcome;
use crate::model::Setup;
use crate::model::contact::Contact;
use crate::model::definition::{Model, Step};
use crate::model::frame::Frame;
use crate::model::scene::Scene;
use crate::newton::Progress;
use crate::newton::condensed::Library;
use crate::results::analysis::Analysis;
use crate::results::fatigue;
use crate::results::loops::{self, Loop};
use crate::results::observer::{Event, Observer};
use crate::results::summary::Summary;
use crate::solve::solver::Solver;
use crate::system::State;

/// What those need who judge increments and make figures of them.
pub(super) struct Judges {
    /// What interfaces did so far.
    pub watches: Vec<Watch>,
    /// The cycles at hand of interfaces, and the parts of bodies around their points by which displacements are averaged for them.
    pub loops: Vec<Loop>,
    pub shares: Vec<f64>,
    /// Points at which criteria of fatigue are asked.
    pub watched: Option<fatigue::Watched>,
    /// Bodies that no interface joins.
    pub unjoined: doctor::MissingInterface,
    /// Cells at the probes; `None` at rigid bodies.
    pub around: Vec<Option<Around>>,
}

/// An analysis that runs: what is simulated, where it stands, and what has come of it.
pub struct Run {
    /// What is simulated.
    pub model: Model,
    /// Interfaces and couplings.
    pub contact: Contact,
    /// Where it stands: the last increment that was reported.
    pub frame: Frame,
    /// Counts, energies and findings so far.
    pub summary: Summary,
    /// What steps without increments have found, in this process.
    pub modes: Vec<ModalOutcome>,
    pub(super) solver: Solver,
    pub(super) integrator: Box<dyn Integrator>,
    pub(super) steps: Steps,
    /// Accepted increments whose interiors are not known yet.
    pub(super) pending: Vec<Pending>,
    /// Those whose interiors are known, on their way to the observers.
    pub(super) recovered: Option<VecDeque<Pending>>,
    /// The last of those whose interior was found not to hold.
    pub(super) taken_back: Option<TakenBack>,
    /// The block of cycles at hand, where jumps over them are chosen.
    pub(super) block: Option<CycleBlock>,
    pub(super) judges: Judges,
    pub(super) started: Instant,
}

/// What looks at a run, with its summary and what judges remember left free.
macro_rules! view {
    ($run:ident) => {
        $crate::assess::view::View {
            scene: $crate::model::scene::Scene {
                model: &$run.model,
                contact: &$run.contact,
                frame: &$run.frame,
            },
            solver: &$run.solver,
            explicit: $crate::integrate::explicit::explicit($run.integrator.as_ref()),
        }
    };
}
pub(super) use view;

impl Run {
    /// Assembles the bulk and checks the model's own consistency.
    pub(super) fn new(setup: Setup, library: Arc<Library>) -> Self {
        let started = Instant::now();
        let Setup {
            model,
            mut contact,
            notes,
        } = setup;
        let mut solver = Solver::new(&model, contact.interfaces.len(), library);
        solver.log.notes = notes;
        let frame = start(&model, &mut contact, &solver);
        let probed = |point| {
            model
                .elastic()
                .find_map(|b| around::around(&b.elastic, point))
        };
        let mut summary = Summary::new(&model, &contact);
        summary.balance.energy = frame.ledger;
        summary.balance.energy_quality.limit = model.solution.energy_limit;
        summary.balance.energy_quality.met = true;
        summary.quality.gate = model.reports.quality.gate;
        summary.quality.met = true;
        summary.cost.phases.assemble = started.elapsed().as_secs_f64();
        let scene = Scene {
            model: &model,
            contact: &contact,
            frame: &frame,
        };
        Run {
            judges: Judges {
                around: model
                    .reports
                    .probes
                    .iter()
                    .map(|p| probed(p.point))
                    .collect(),
                unjoined: doctor::MissingInterface::new(&scene),
                loops: vec![Loop::default(); contact.interfaces.len()],
                shares: loops::shares(&model),
                watched: fatigue::watched(&model, &contact),
                watches: vec![Watch::default(); contact.interfaces.len()],
            },
            integrator: Box::new(QuasiStatic),
            steps: Steps::default(),
            modes: Vec::new(),
            pending: Vec::new(),
            recovered: None,
            taken_back: None,
            model,
            contact,
            frame,
            summary,
            solver,
            started,
            block: None,
        }
    }

    /// The simulation to look at.
    pub fn view(&self) -> View<'_> {
        view!(self)
    }

    /// The simulation to look at, with what has come of it.
    pub fn analysis(&self) -> Analysis<'_> {
        Analysis {
            view: self.view(),
            summary: &self.summary,
        }
    }

    /// Tells observers.
    pub(super) fn tell<'e>(
        &self,
        observers: &mut [&mut dyn Observer],
        event: impl Fn() -> Event<'e>,
    ) -> Result<(), Error> {
        for observer in observers.iter_mut() {
            observer.see(&self.analysis(), event())?;
        }
        Ok(())
    }

    /// Tells observers about iterations.
    pub(super) fn tell_iterations(&self, seen: &[Progress], observers: &mut [&mut dyn Observer]) {
        for p in seen {
            for observer in observers.iter_mut() {
                // An observer that cannot keep up with iterations does not stop the run.
                let _ = observer.see(&self.analysis(), Event::Iteration(p));
            }
        }
    }

    /// Tells observers what has been noted.
    pub(super) fn tell_notes(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let log = &mut self.solver.log;
        self.summary.solved_by.method = log.method.into();
        self.summary.solved_by.method_reason.clone_from(&log.reason);
        if let Some(engine) = &log.engine {
            self.summary.solved_by.engine = engine.report().into();
        }
        let notes: Vec<String> = log.notes.drain(..).collect();
        for note in notes {
            self.tell(observers, || Event::Note(&note))?;
            // Which method was chosen and why has a place of its own in the summary.
            let reason = &self.summary.solved_by.method_reason;
            if reason.is_empty() || !note.ends_with(reason.as_str()) {
                self.summary.notes.push(note);
            }
        }
        Ok(())
    }

    /// Tells observers that fields are due.
    pub(super) fn write_fields(
        &mut self,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let views = self.contact.views(&self.frame);
        let State { u, t, .. } = &self.frame.state;
        let interfaces = self.solver.conditions.iter().zip(views);
        let gaps =
            interfaces.map(|(conditions, view)| look::excluded_gaps(view, conditions, u, *t));
        let gaps: Vec<_> = gaps.collect();
        let histories = &mut Arc::make_mut(&mut self.frame.contacts).interfaces;
        for (history, gaps) in histories.iter_mut().zip(gaps) {
            history.note_gaps(&gaps);
        }
        self.tell(observers, || Event::Output)
    }

    /// What the last increment did is no guide for the next.
    pub(super) fn reset_predictor(&mut self) {
        self.frame.course.forget();
        self.solver.condenser.reset_predictor();
    }

    /// The step at hand.
    pub(super) fn step(&self) -> &Step {
        &self.model.steps[self.frame.step]
    }

    /// Gaps at the start by interface, and what the doctor finds in the model.
    pub(super) fn look(&mut self) -> (Vec<Vec<f64>>, Vec<Finding>) {
        let gaps = start_gaps(
            &self.model,
            &self.frame,
            &mut self.contact,
            &self.solver.conditions,
        );
        let findings = doctor::examine(&view!(self), &self.judges.unjoined, &gaps);
        (gaps, findings)
    }

    /// Seconds since the run started.
    pub fn elapsed(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

/// Where an analysis begins.
fn start(model: &Model, contact: &mut Contact, solver: &Solver) -> Frame {
    let n = model.dofs.count();
    let mut u = vec![0.0; n];
    for &(dof, value) in model.actions.initials.iter().flat_map(|i| &i.displacements) {
        u[dof] = value;
    }
    model.links.impose(&mut u);
    let t = model.steps.first().map_or(0.0, |s| s.start);
    let state = State {
        t,
        u,
        ..State::default()
    };
    let contacts = contact.begin(&beginning(&state, &soon(model, &state)));
    let coupled = contact.couplings.view(&contacts.couplings).stored();
    let strain = solver.strain_energy(&state.u) + coupled;
    let mut frame = Frame {
        state,
        contacts: Arc::new(contacts),
        coupled,
        forces: vec![0.0; n],
        contact: vec![0.0; n],
        load: vec![0.0; n],
        fields: model.actions.fields.iter().map(|f| f.initial()).collect(),
        ..Frame::default()
    };
    frame.ledger.initial = strain;
    frame.ledger.strain = strain;
    frame
}
