//! Defects of functions that a program uses as laws.

use std::sync::Arc;

use stickslip::assess::doctor::DoctorCause;
use stickslip::contact::interface::with_user_laws;
use stickslip::contact::law::user::{LimitFunction, PressureFunction};
use stickslip::model::Contact;

use super::models::COMPLIANT;
use super::{examined, folder, judged};

/// How many there are.
pub const COUNT: usize = 4;

/// A function of one number at every point.
struct Each(fn(f64) -> f64);

impl LimitFunction for Each {
    fn limits(&self, pressures: &[f64], _: &[f64]) -> (Vec<f64>, Option<[Vec<f64>; 2]>) {
        (pressures.iter().map(|p| (self.0)(*p)).collect(), None)
    }
}

impl PressureFunction for Each {
    fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
        (gaps.iter().map(|g| (self.0)(*g)).collect(), None)
    }
}

fn named(name: &str, prepare: &dyn Fn(&mut Contact)) {
    let said = examined(COMPLIANT, &folder(name, &[]), prepare);
    let said = said.unwrap_or_else(|e| panic!("{name}: {e}"));
    let fault = judged(&said, (DoctorCause::FaultyLaw, "joint"), &[]);
    assert!(fault.is_none(), "{name}: {fault:?}\n{}", said.text());
}

fn limit(law: fn(f64) -> f64) -> impl Fn(&mut Contact) {
    move |contact| {
        let interface = &mut contact.interfaces[0];
        interface.definition = with_user_laws(interface, None, Some(Arc::new(Each(law))));
    }
}

fn pressure(law: fn(f64) -> f64) -> impl Fn(&mut Contact) {
    move |contact| {
        let interface = &mut contact.interfaces[0];
        interface.definition = with_user_laws(interface, Some(Arc::new(Each(law))), None);
    }
}

#[test]
fn functions_that_are_no_laws_are_named() {
    named("a negative limit", &limit(|p| -0.3 * p));
    named("a limit that falls below zero", &limit(|p| 0.3 * p - 2e7));
    named("a pressure that pulls", &pressure(|g| 1e14 * g));
    named("a penetration for a gap", &pressure(|g| 1e14 * g.max(0.0)));
}

#[test]
fn functions_that_are_laws_raise_no_alarm() {
    let sound = |contact: &mut Contact| {
        let normal = Arc::new(Each(|g| 1e14 * (-g).max(0.0)));
        let interface = &mut contact.interfaces[0];
        interface.definition =
            with_user_laws(interface, Some(normal), Some(Arc::new(Each(|p| 0.3 * p))));
    };
    let said = examined(COMPLIANT, &folder("functions", &[]), &sound).expect("a sound model");
    assert!(
        said.error.is_none() && said.findings().count() == 0,
        "{}",
        said.text()
    );
}
