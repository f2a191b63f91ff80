//! Verification of the library: one test program, so that it is linked once.

#[macro_use]
#[path = "support/examples.rs"]
mod list;
mod support;

mod advance;
mod bad_input;
mod bending;
mod condensed;
mod convergence;
mod counterfaces;
mod couplings;
mod defects;
mod dynamics;
mod elements;
mod exact;
mod examples;
mod fatigue;
mod flying;
mod frd;
mod fretting;
mod gears;
mod heat;
mod layers;
mod library;
mod loops;
mod loose;
mod malformed;
mod maps;
mod mirrors;
mod modes;
mod mortar;
mod multigrid;
mod pairing;
mod pretension;
mod price;
mod problem_files;
mod quality;
mod references;
mod restart;
mod restep;
mod rigid;
mod roughness;
mod schema;
mod spinning;
mod starts;
mod stops;
mod suggestions;
mod surfaces;
mod threads;
mod turning;
mod units;
mod vibrations;
mod wear;
mod wear_laws;
mod worn;
