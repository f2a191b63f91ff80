//! The command from outside: one test program, so that it is linked once.

mod support;

mod audit;
mod book;
mod cluster;
mod commands;
mod convert;
mod counts;
mod cycles;
mod decks;
#[cfg(unix)]
mod demo;
mod engine;
#[cfg(unix)]
mod faults;
mod given;
mod mixes;
mod new;
mod progress;
mod reports;
mod runs;
mod shards;
#[cfg(unix)]
mod strangers;
mod sweep;
