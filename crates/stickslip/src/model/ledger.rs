//! The energy balance: what there is, where it came from and where it went, and what is left of the balance.

use serde::Serialize;

use crate::system::Energy;

/// Energy that flows over an increment.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(crate) struct Flow {
    /// Work of loads and reactions.
    pub work: f64,
    /// Dissipated by Rayleigh damping and dashpots.
    pub damped: f64,
    /// Dissipated by the scheme.
    pub numerical: f64,
    /// Taken from masses that met what does not give way.
    pub impact: f64,
    /// What frames of bodies that turn have handed on, whichever way.
    pub transmitted: f64,
    /// By how much the strain energy is more than that without thermal strain at the end, and that of bodies which are held as they are meshed.
    pub thermal: [f64; 2],
}

/// Energies `[J]` (per unit of thickness or over 2π as the model has it).
#[derive(Debug, Clone, Copy, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct EnergyLedger {
    /// Kinetic energy of the bodies.
    pub kinetic: f64,
    /// Elastic energy of the bodies and springs.
    pub strain: f64,
    /// Recoverable energy of the interfaces.
    pub contact: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by damping of the interfaces, and by impacts of masses on what does not give way.
    pub contact_damping: f64,
    /// Dissipated by Rayleigh damping and dashpots.
    pub rayleigh_damping: f64,
    /// Dissipated by the scheme that integrates the motion; negative if it fed energy in.
    pub numerical: f64,
    /// Work that loads did on bodies on their way to where contact holds them, and that is lost there: the rule by which work is summed
    /// up lets contact act over all of an increment, also over the part in which it was open. Negative if bodies came out of a
    /// penetration.
    pub artificial: f64,
    /// Work of loads and supports, and of temperatures against what keeps bodies from expanding.
    pub external_work: f64,
    /// Work of moving primary surfaces: obstacles, belts, and overlap that is resolved.
    pub belt_work: f64,
    /// The part of both that the trapezoidal rule misses in quasi-static increments: their forces do not grow in proportion where contact opens,
    /// closes or begins to slide within an increment. It is found point by point, from pressure over gap and shear over slip.
    pub path: f64,
    /// By how much `friction` may be off at most in quasi-static increments, as it is not known when within them points began to slide. It shows in
    /// no balance; smaller increments make it smaller.
    pub uncertain: f64,
    /// What next entries count from.
    #[serde(skip)]
    pub(crate) entered: Entered,
    /// Energy brought in by initial velocities and displacements.
    pub initial: f64,
    /// Residual of the balance: energy supplied less energy stored and dissipated.
    pub residual: f64,
}

/// What has been entered so far beside the energies that are reported `[J]`.
#[derive(Debug, Clone, Copy, Default, crate::keep::Keep)]
pub(crate) struct Entered {
    /// By how much `strain` is more than it were without thermal strain. Thermal forces enter their work like loads; with this it is that of the
    /// strain itself.
    pub(crate) thermal: f64,
    /// Energy that it would take to hold all bodies as they are meshed: rounding of the strain energy is relative to it.
    held: f64,
    passed: f64,
    moved: f64,
    exceeded: f64,
    impacts: f64,
    /// Work that frames of bodies that turn have handed on so far: it is stored nowhere, and yet counts.
    transmitted: f64,
}

/// How well the balance of energies closes over the whole analysis.
#[derive(Debug, Clone, Copy, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct EnergyQuality {
    /// Largest energy stored and dissipated so far `[J]`.
    pub scale: f64,
    /// By how much the balance was open so far at most `[J]`: its residual, or spurious energy growth.
    pub largest: f64,
    /// The same relative to it `[-]`.
    pub residual: f64,
    /// What the residual should not exceed.
    pub limit: f64,
    /// Whether it did not.
    pub met: bool,
}

impl EnergyLedger {
    /// Enters an increment: its flows, and what is stored at its end.
    /// `whole`: the trapezoidal rule is left as it is.
    pub(crate) fn enter(
        &mut self,
        flow: Flow,
        [kinetic, strain]: [f64; 2],
        interfaces: &[Energy],
        whole: bool,
    ) {
        self.rayleigh_damping += flow.damped;
        self.numerical += flow.numerical;
        self.kinetic = kinetic;
        let [thermal, held] = flow.thermal;
        self.strain = strain + thermal;
        self.external_work += thermal - self.entered.thermal;
        self.entered.thermal = thermal;
        self.entered.held = held;
        let sum = |part: fn(&Energy) -> f64| interfaces.iter().map(part).sum::<f64>();
        self.contact = sum(|e| e.stored);
        self.friction = sum(|e| e.dissipated);
        self.entered.impacts += flow.impact;
        self.entered.transmitted += flow.transmitted;
        self.contact_damping = sum(|e| e.damped) + self.entered.impacts;
        self.uncertain = sum(|e| e.uncertain);
        let (passed, moved) = (sum(|e| e.path), sum(|e| e.work));
        let missed = match whole {
            true => 0.0,
            false => passed - self.entered.passed,
        };
        let excess = sum(|e| e.excess);
        self.numerical -= excess - self.entered.exceeded;
        self.entered.exceeded = excess;
        // Who drives has done it: in proportion, where several do.
        let belt = moved - self.entered.moved;
        let all = flow.work.abs() + belt.abs();
        let share = if all > 0.0 { belt.abs() / all } else { 0.0 };
        self.external_work += flow.work + (1.0 - share) * missed;
        self.belt_work += belt + share * missed;
        self.path += missed;
        (self.entered.passed, self.entered.moved) = (passed, moved);
        self.close();
    }

    /// What the interfaces have entered: stored, dissipated and fed in.
    pub(crate) fn of_interfaces(&self) -> f64 {
        self.contact + self.friction + self.contact_damping - self.entered.moved
    }

    /// Enters work lost on the way of bodies that were followed.
    pub(crate) fn lose(&mut self, work: f64) {
        self.artificial += work;
        self.close();
    }

    /// Works out the residual.
    pub(crate) fn close(&mut self) {
        self.residual = self.initial + self.external_work + self.belt_work
            - self.kinetic
            - self.strain
            - self.contact
            - self.friction
            - self.contact_damping
            - self.rayleigh_damping
            - self.numerical
            - self.artificial;
    }

    /// By how much the balance is open `[J]`: what is left of it, or spurious energy growth, by an account of the scheme or none.
    pub(crate) fn open(&self) -> f64 {
        self.residual
            .abs()
            // A quarter of what the scheme may feed in is no loss, but comes back, as the energy of a central difference is that of a state
            // half an increment away.
            .max(-(self.residual + self.numerical) / 4.0)
    }

    /// Everything stored and dissipated, and what heat could store.
    fn stored_and_dissipated(&self) -> f64 {
        self.kinetic
            + self.strain
            + self.entered.held
            + self.contact
            + self.friction
            + self.contact_damping
            + self.rayleigh_damping
            + self.numerical.abs()
            + self.entered.transmitted
    }
}

impl EnergyQuality {
    /// Takes note of the ledger after an increment.
    pub(crate) fn note(&mut self, ledger: &EnergyLedger) {
        self.scale = self.scale.max(ledger.stored_and_dissipated());
        // What is not a number is no small residual.
        let open = match ledger.residual.is_nan() {
            true => f64::INFINITY,
            false => ledger.open(),
        };
        self.largest = self.largest.max(open);
        if self.scale > 0.0 {
            self.residual = self.largest / self.scale;
        }
        self.met = self.residual <= self.limit;
    }
}
