//! An analysis that is run: who owns what, how it begins and ends.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use super::checkpoint::Working;
use super::position::Steps;
use super::queue::{Pending, TakenBack};
use super::trying::Trying;
use crate::assess::diagnosis::{CheckReport, beginning, soon, start_gaps};
use crate::assess::doctor::{self, DoctorCause, Finding, Watch};
use crate::assess::quality;
use crate::assess::view::View;
use crate::body::Around;
use crate::error::Error;
use crate::friction::FrictionProblem;
use crate::integrate::integration::Integration;
use crate::integrate::quasi_static::QuasiStatic;
use crate::modal::ModalOutcome;
use crate::model::Setup;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::scene::Scene;
use crate::newton::condensed::Library;
use crate::results::analysis::Analysis;
use crate::results::fatigue;
use crate::results::loops::{self, Loop};
use crate::results::observer::{Event, Observer};
use crate::results::summary::{Phases, Summary};
use crate::solve::solver::Solver;
use crate::system::State;

/// What those need who judge increments and make figures of them.
pub(crate) struct Judges {
    /// What interfaces did so far.
    pub watches: Vec<Watch>,
    /// The cycles at hand of interfaces, and the parts of bodies around their points by which displacements are averaged for them.
    pub loops: Vec<Loop>,
    pub shares: Vec<f64>,
    /// Points at which criteria of fatigue are asked.
    pub watched: Option<fatigue::Watched>,
    /// Bodies that no interface joins.
    pub unjoined: doctor::Unjoined,
    /// Cells at the probes; `None` at rigid bodies.
    pub around: Vec<Option<Around>>,
}

/// A model being run.
pub struct Simulation {
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
    pub(crate) solver: Solver,
    pub(crate) integration: Integration,
    pub(crate) steps: Steps,
    /// Accepted increments whose interiors are not known yet.
    pub(crate) pending: Vec<Pending>,
    /// Those whose interiors are known, on their way to the observers.
    pub(crate) recovered: Option<VecDeque<Pending>>,
    /// The last of those whose interior was found not to hold.
    pub(crate) taken_back: Option<TakenBack>,
    pub(crate) judges: Judges,
    pub(crate) started: Instant,
    /// Increments at the last checkpoint, and when it was taken.
    pub(super) saved: (usize, Instant),
    /// What the attempt at hand may change, as it was at its beginning, where a run may be stopped in the middle of one.
    pub(super) before: Option<Working>,
    /// The block of cycles at hand, where jumps over them are chosen.
    pub(super) trying: Option<Trying>,
}

/// What looks at a simulation, with its summary and what judges remember left free.
macro_rules! view {
    ($simulation:ident) => {
        $crate::assess::view::View {
            scene: $crate::model::scene::Scene {
                model: &$simulation.model,
                contact: &$simulation.contact,
                frame: &$simulation.frame,
            },
            solver: &$simulation.solver,
            explicit: $simulation.integration.explicit(),
        }
    };
}
pub(crate) use view;

impl Simulation {
    /// Assembles the bulk and checks the model's own consistency.
    pub fn new(setup: Setup) -> Result<Self, Error> {
        let library = Library::new(Library::small_limit());
        Simulation::with_library(setup, Arc::new(library))
    }

    /// The same with the factors of other runs: bodies with the same matrix, unknowns and contact candidates are factored once. Results have the
    /// same bits, whoever made the factors.
    pub fn with_library(setup: Setup, library: Arc<Library>) -> Result<Self, Error> {
        let started = Instant::now();
        let Setup {
            model,
            mut contact,
            notes,
        } = setup;
        let mut solver = Solver::new(&model, contact.interfaces.len(), library);
        solver.log.notes = notes;
        let frame = start(&model, &mut contact, &solver);
        let probed = |point| model.elastic().find_map(|b| b.elastic.around(point));
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
        Ok(Simulation {
            judges: Judges {
                around: model
                    .reports
                    .probes
                    .iter()
                    .map(|p| probed(p.point))
                    .collect(),
                unjoined: doctor::Unjoined::new(&scene),
                loops: vec![Loop::default(); contact.interfaces.len()],
                shares: loops::shares(&model),
                watched: fatigue::watched(&model, &contact),
                watches: vec![Watch::default(); contact.interfaces.len()],
            },
            integration: Integration::QuasiStatic(QuasiStatic),
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
            saved: (0, started),
            before: None,
            trying: None,
        })
    }

    /// Runs all steps, or what is left of them.
    ///
    /// # Errors
    /// [`Error::Run`] if the analysis cannot go on, [`Error::Interrupted`] if it was asked to stop (see [`Simulation::set_interrupt`]), and
    /// what observers return. In each case the results so far stay, and the observers have seen [`Event::End`].
    pub fn run(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        while self.advance(observers)? {}
        Ok(())
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
    pub(crate) fn tell<'e>(
        &self,
        observers: &mut [&mut dyn Observer],
        event: impl Fn() -> Event<'e>,
    ) -> Result<(), Error> {
        for observer in observers.iter_mut() {
            observer.see(&self.analysis(), event())?;
        }
        Ok(())
    }

    /// Looks at the model without running it.
    pub fn check(&mut self) -> CheckReport {
        let (gaps, findings) = self.look();
        self.view().check(&gaps, findings)
    }

    /// Gaps at the start by interface, and what the doctor finds in the model.
    pub(crate) fn look(&mut self) -> (Vec<Vec<f64>>, Vec<Finding>) {
        let gaps = start_gaps(
            &self.model,
            &self.frame,
            &mut self.contact,
            &self.solver.conditions,
        );
        let findings = doctor::examine(&view!(self), &self.judges.unjoined, &gaps);
        (gaps, findings)
    }

    /// What is to be said at the end, well or not.
    pub(crate) fn close(
        &mut self,
        outcome: Result<bool, Error>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let outcome = match outcome {
            // The rows of the block in which it ended say why.
            Err(e) if !matches!(e, Error::Interrupted(_)) => {
                let told = self.release_block(observers);
                told.and(Err(e))
            }
            other => other,
        };
        let settled = observers.iter_mut().try_for_each(|o| o.settle());
        let outcome = outcome.and_then(|done| settled.map(|()| done));
        let outcome = outcome.map_err(|e| match e {
            Error::Run(error) => Error::Run(self.conclude(error)),
            e => e,
        });
        let total = self.elapsed();
        let view = view!(self);
        let summary = &mut self.summary;
        let statistics = &self.solver.newton.statistics;
        summary.finish(statistics, total, outcome.as_ref().err());
        summary.balance.energy = self.frame.ledger;
        let strain = self.frame.ledger.strain;
        summary.loose.artificial_energy = self.solver.floating.artificial_energy(strain);
        summary.interfaces = quality::interfaces(&view, &summary.quality, &self.judges.watches);
        let mut notes = Vec::new();
        if summary.run.completed {
            for finding in doctor::watched(&view, &self.judges.watches) {
                // Shear that is not there looks like any other.
                if finding.cause == DoctorCause::TurnedNormals {
                    notes.push(finding.message.clone());
                }
                doctor::note(&mut summary.findings, finding);
            }
        }
        if summary.attempts.increments > 0 {
            let (limits, energy) = (&self.model.reports.quality, &summary.balance.energy_quality);
            view.judge_energy(limits, energy, &mut summary.quality, &mut notes);
        }
        self.solver.log.notes.extend(notes);
        let told = self.tell_notes(observers);
        let told = told.and(self.tell(observers, || Event::End));
        // Why it ended is what to report, not that this could not be written either.
        outcome.and_then(|more| told.map(|()| more))
    }

    /// The last increment as a friction problem, if none of the ways of Newton's method led anywhere and its bodies are condensed.
    pub fn unsolved(&self) -> Option<&FrictionProblem> {
        self.solver.newton.unsolved.as_ref()
    }

    /// Seconds since the run started.
    pub fn elapsed(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Times of the phases so far.
    pub fn phases(&mut self) -> &mut Phases {
        &mut self.summary.cost.phases
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
    let strain = solver.strain_energy(model, &state.u) + coupled;
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
