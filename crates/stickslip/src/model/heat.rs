//! Temperatures of the bodies, and the forces that were made of them last.

use std::sync::{Arc, Mutex};

use crate::body::Temperatures;

/// Temperatures of the bodies, and the forces made of them last.
#[derive(Debug)]
pub struct Heat {
    /// Temperatures by point of the mesh.
    pub temperatures: Arc<Temperatures>,
    pub(super) last: Mutex<Option<Arc<Pressed>>>,
}

/// Forces and energy of bodies that are held as they are meshed.
#[derive(Debug)]
pub(super) struct Pressed {
    /// Factors and shares of the fields.
    pub weights: Vec<[f64; 2]>,
    /// Forces `[N]`, by dof.
    pub force: Vec<f64>,
    /// Energy `[J]`.
    pub energy: f64,
}

impl Heat {
    /// For temperatures.
    pub fn new(temperatures: Arc<Temperatures>) -> Self {
        Heat {
            temperatures,
            last: Mutex::new(None),
        }
    }
}
