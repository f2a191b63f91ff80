//! What is evaluated in every iteration: interfaces and couplings, with all that they remember.

use super::definition::Step;
use super::frame::{ContactMemory, Frame};
use crate::body::couplings::{Couplings, CouplingsView};
use crate::contact::interface::{self, ContactView, Interface};
use crate::system::{Force, Stage, State};

/// Interfaces and couplings: where bodies touch and what ties their points.
pub struct Contact {
    /// Interfaces.
    pub interfaces: Vec<Interface>,
    /// Equations between displacements and springs between points.
    pub couplings: Couplings,
}

impl Contact {
    /// All of them as forces.
    pub(crate) fn forces(&mut self) -> Vec<&mut dyn Force> {
        let interfaces = self.interfaces.iter_mut();
        let mut forces: Vec<&mut dyn Force> = interfaces.map(|i| i as &mut dyn Force).collect();
        if !self.couplings.is_empty() {
            forces.push(&mut self.couplings);
        }
        forces
    }

    /// The interfaces after the increment of a frame, as those see them who only look.
    pub fn views<'a>(&'a self, frame: &'a Frame) -> impl ExactSizeIterator<Item = ContactView<'a>> {
        let interfaces = self.interfaces.iter().enumerate();
        interfaces.map(|(k, interface)| ContactView {
            definition: &interface.definition,
            state: match &frame.contacts {
                Some(known) => &known.interfaces[k],
                None => &interface.state,
            },
        })
    }

    /// The couplings after the increment of a frame.
    pub fn coupled<'a>(&'a self, frame: &'a Frame) -> CouplingsView<'a> {
        let known = frame.contacts.as_ref();
        CouplingsView {
            definition: &self.couplings.definition,
            state: known.map_or(&self.couplings.memory, |known| &known.couplings),
        }
    }

    /// What interfaces and couplings have been through.
    pub(crate) fn memory(&self) -> ContactMemory {
        ContactMemory {
            interfaces: self.interfaces.iter().map(|i| i.state.clone()).collect(),
            couplings: self.couplings.memory.clone(),
        }
    }

    /// Lets them go on from that.
    pub(crate) fn go_on_from(&mut self, memory: ContactMemory) {
        for (interface, history) in self.interfaces.iter_mut().zip(memory.interfaces) {
            interface.state = history;
        }
        self.couplings.memory = memory.couplings;
    }

    /// Tells all of them that an attempt is accepted; what they knew before it.
    pub(crate) fn commit(&mut self, stage: &Stage) -> ContactMemory {
        let before = self.interfaces.iter_mut().map(|interface| {
            let next = interface::commit(interface, stage);
            std::mem::replace(&mut interface.state, next)
        });
        let before = ContactMemory {
            interfaces: before.collect(),
            couplings: self.couplings.memory.clone(),
        };
        self.couplings.commit(stage);
        before
    }

    /// Lets all of them act as springs, as explicit increments need it, or as they are; the energy that comes in by it `[J]`, one by one.
    pub(crate) fn use_springs(&mut self, wanted: bool, mut bring: impl FnMut(f64)) {
        for interface in &mut self.interfaces {
            bring(interface::use_springs(interface, wanted));
        }
        bring(self.couplings.use_springs(wanted));
    }

    /// Exchanges the laws that change with a step; the energy by which they now store more `[J]`, one by one.
    pub(crate) fn change_laws(&mut self, step: &Step, mut bring: impl FnMut(f64)) {
        for (name, change) in &step.changes {
            let all = self.interfaces.iter_mut();
            for interface in all.filter(|i| i.name == *name) {
                bring(interface::change(interface, change));
            }
        }
    }

    /// Tells the interfaces that begin to act in the step at hand with which gaps they do.
    pub(crate) fn begin_acting(&mut self, step: &Step, state: &State) {
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
        for interface in &mut self.interfaces {
            interface::begin_acting(interface, &stage, span);
        }
    }
}
