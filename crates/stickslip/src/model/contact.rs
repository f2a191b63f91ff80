//! What is evaluated in every iteration: interfaces and couplings.

use std::sync::Arc;

use super::capability::{Feature, Subject, limit};
use super::definition::Step;
use super::frame::{ContactMemory, Frame};
use crate::body::couplings::{Couplings, CouplingsForce, CouplingsView, explicit, force};
use crate::contact::interface::{self, Conditions, ContactView, Interface, InterfaceForce};
use crate::contact::look;
use crate::system::{Force, Stage, State};

/// Interfaces and couplings: where bodies touch and what ties their points.
pub struct Contact {
    /// Interfaces.
    pub interfaces: Vec<Interface>,
    /// Equations between displacements and springs between points.
    pub couplings: Couplings,
}

/// Interfaces and couplings as forces that go on from what they know.
pub(crate) struct ContactForces<'a> {
    pub interfaces: Vec<InterfaceForce<'a>>,
    pub couplings: CouplingsForce<'a>,
}

impl ContactForces<'_> {
    /// All of them.
    pub fn all(&mut self) -> Vec<&mut dyn Force> {
        let interfaces = self.interfaces.iter_mut();
        let mut forces: Vec<&mut dyn Force> = interfaces.map(|i| i as &mut dyn Force).collect();
        if !self.couplings.is_empty() {
            forces.push(&mut self.couplings);
        }
        forces
    }
}

impl Contact {
    /// All of them as forces that go on from what they know, interfaces under these conditions.
    pub(crate) fn forces<'a>(
        &'a mut self,
        memory: &'a ContactMemory,
        conditions: &'a [Conditions],
    ) -> ContactForces<'a> {
        let interfaces = self.interfaces.iter_mut().zip(&memory.interfaces);
        let interfaces = interfaces.zip(conditions);
        ContactForces {
            interfaces: interfaces
                .map(|((i, history), c)| i.force(history, c))
                .collect(),
            couplings: self.couplings.force(&memory.couplings),
        }
    }

    /// The interfaces after the increment of a frame, as those see them who only look.
    pub fn views<'a>(&'a self, frame: &'a Frame) -> impl ExactSizeIterator<Item = ContactView<'a>> {
        self.views_of(&frame.contacts)
    }

    /// The interfaces as those see them who only look, with what they know.
    pub fn views_of<'a>(
        &'a self,
        memory: &'a ContactMemory,
    ) -> impl ExactSizeIterator<Item = ContactView<'a>> {
        let interfaces = self.interfaces.iter().zip(&memory.interfaces);
        interfaces.map(|(interface, history)| interface.view(history))
    }

    /// The couplings after the increment of a frame.
    pub fn coupled<'a>(&'a self, frame: &'a Frame) -> CouplingsView<'a> {
        self.couplings.view(&frame.contacts.couplings)
    }

    /// What they know before anything has happened, at a state.
    pub(crate) fn begin(&mut self, stage: &Stage) -> ContactMemory {
        let interfaces = self.interfaces.iter_mut().map(|interface| {
            let mut history = interface.first_history();
            interface::glue(interface, &mut history, stage);
            history
        });
        ContactMemory {
            interfaces: interfaces.collect(),
            couplings: self.couplings.begin_analysis(stage.from.t, &stage.from.u),
        }
    }

    /// What they know after an attempt that is accepted.
    pub(crate) fn commit(
        &mut self,
        memory: &ContactMemory,
        conditions: &[Conditions],
        stage: &Stage,
    ) -> ContactMemory {
        let mut forces = self.forces(memory, conditions).interfaces;
        let next = forces.iter_mut().map(|i| interface::commit(i, stage));
        ContactMemory {
            interfaces: next.collect(),
            couplings: force::commit(&self.couplings, &memory.couplings, stage),
        }
    }

    /// Lets all of them act as springs, as explicit increments need it, or as they are; the energy that comes in by it `[J]`, one by one.
    pub(crate) fn use_springs(
        &mut self,
        memory: &mut ContactMemory,
        wanted: bool,
        mut bring: impl FnMut(f64),
    ) {
        for (interface, history) in self.interfaces.iter_mut().zip(&mut memory.interfaces) {
            bring(interface::use_springs(interface, history, wanted));
        }
        bring(explicit::use_springs(
            &mut self.couplings,
            &mut memory.couplings,
            wanted,
        ));
    }

    /// Exchanges the laws that change with a step; the energy by which they now store more `[J]`, one by one.
    pub(crate) fn change_laws(
        &mut self,
        memory: &ContactMemory,
        step: &Step,
        mut bring: impl FnMut(f64),
    ) {
        for (name, change) in &step.changes {
            let all = self.interfaces.iter_mut().zip(&memory.interfaces);
            for (interface, history) in all.filter(|(i, _)| i.name == *name) {
                let before = look::energy(interface.view(history)).stored;
                interface.definition = interface::changed(interface, change);
                bring(look::energy(interface.view(history)).stored - before);
            }
        }
    }

    /// Why a feature is not computed with the laws of the interfaces, those of the program included; `None` where it is.
    pub(crate) fn refusal(&self, feature: Feature) -> Option<String> {
        let limit = limit(Subject::FrictionState, feature)?;
        let mut interfaces = self.interfaces.iter();
        let with = interfaces.find(|i| !i.laws.friction_law().states().is_empty())?;
        Some(format!(
            "interface `{}` {}: {}",
            with.name, limit.why, limit.help
        ))
    }

    /// Gives interfaces whose friction law has changed with a step the state variables with which the new one begins.
    pub(crate) fn begin_law_states(&self, memory: &mut Arc<ContactMemory>, step: &Step) {
        let changes = step.changes.iter().filter(|(_, c)| c.friction.is_some());
        for (name, _) in changes {
            let memory = Arc::make_mut(memory);
            let all = self.interfaces.iter().zip(&mut memory.interfaces);
            for (interface, history) in all.filter(|(i, _)| i.name == *name) {
                history.begin_law(&interface.places(), interface.laws.friction_law());
            }
        }
    }

    /// Tells the interfaces that begin to act in the step at hand with which gaps they do.
    pub(crate) fn begin_acting(
        &mut self,
        memory: &mut ContactMemory,
        conditions: &[Conditions],
        step: &Step,
        state: &State,
    ) {
        let span = [step.start, step.end];
        let mut at = state.clone();
        at.t = step.start + 1e-9 * (step.end - step.start);
        let stage = Stage {
            from: state,
            at: &at,
            dt: at.t - state.t,
            rate: None,
            frames: None,
        };
        let all = self.interfaces.iter_mut().zip(&mut memory.interfaces);
        for ((interface, history), conditions) in all.zip(conditions) {
            interface::begin_acting(interface, history, conditions, &stage, span);
        }
    }
}
