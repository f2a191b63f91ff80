//! Decks in the format of Abaqus and CalculiX, from text to results.

mod bending;
mod beyond;
mod cards;
mod changes;
mod couplings;
mod damaged;
mod elements;
mod generated;
mod habits;
mod harmonic;
mod heat;
mod instances;
mod instances_wrong;
mod loads;
mod malformed;
mod orientations;
mod points;
mod pretension;
mod reading;
mod squeal;
mod steps;
mod styles;
mod support;
mod ties;
