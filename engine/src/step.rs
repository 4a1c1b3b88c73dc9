//! One time step of a bed: the phases, as a list.
//!
//! Velocity Verlet, with everything that dissipates made second order:
//!
//! 1. **Intruder.** A few bodies get half a kick and drift; a way that jumps over grains is refused.
//! 2. **Neighbours.** The list of near pairs is made again once something may have left it; contact
//!    histories move along.
//! 3. **Contacts.** What overlaps is found. Damping uses rates from `v*`: with `v_h` the rebound
//!    of a dashpot is first order only. Springs and the ledger use the displacement made in the
//!    step, from `v_h`, in the contact plane of the half step, turned into the new one (Vyas et al.,
//!    Comput. Phys. Commun. 310, 109524 (2025), on what goes wrong otherwise).
//!    Each law books its dissipation as mean force times displacement. The intruder gets its loads.
//! 4. **Kick, book, kick, drift.** Forces are summed in a fixed order; gravity and the drag of absorbing
//!    layers (with `v*`) are added. Half a kick brings velocities to the time of the positions, where
//!    energies are taken. Half a kick more gives the velocities `v_h = v + ½ dt a` of the next step, and
//!    positions move with them; `v* = v_h + ½ dt a` is the velocity extrapolated to the new positions. A grain
//!    that has left through a periodic side comes in on the other. The intruder gets its second half kick.
//! 5. **Ledger.** The energy of every channel is closed against the start.
//! 6. **Check.** A step that cannot be trusted is an error.
//!
//! So the grains lie in memory as the next step will find them, one pass over them a step;
//! [`crate::grains::Grains`] tells where they are and how they move between two steps.

use crate::body::Mechanism;
use crate::dimension::Stride;
use crate::error::StepError;
use crate::grain_bed::GrainBed;
use crate::ledger::Ledger;

/// Moves the bed and the intruder by one step of `dt` (s); `step` is its number, from 1.
///
/// # Errors
/// If something is no longer finite, a grain has passed through another, or the intruder through a wall or, in one
/// step, past grains.
pub(crate) fn step(
    bed: &mut GrainBed,
    intruder: &mut dyn Mechanism,
    books: &mut Books,
    step: u64,
    dt: f64,
) -> Result<(), StepError> {
    intruder.kick_drift(dt);
    bed.check_way(intruder, step, dt)?;
    bed.refresh_neighbours(intruder, dt);
    bed.evaluate_contacts(intruder, dt);
    bed.load_intruder(intruder, dt);
    bed.kick_drift(&Stride { before: 0.5 * dt, after: 0.5 * dt, drift: dt });
    intruder.kick(dt);
    books.close(bed, intruder);
    bed.check(step, dt)
}

/// Finds the forces of the initial state, opens the ledger on it and sends the grains into the first step,
/// of `dt` (s).
pub(crate) fn prime(bed: &mut GrainBed, intruder: &mut dyn Mechanism, books: &mut Books, dt: f64) {
    bed.refresh_neighbours(intruder, 0.0);
    bed.evaluate_contacts(intruder, 0.0);
    bed.load_intruder(intruder, 0.0);
    bed.kick_drift(&Stride { before: 0.0, after: 0.5 * dt, drift: dt });
    books.open(bed, intruder);
}

/// The ledger with the buffer its entries are gathered in.
pub(crate) struct Books {
    pub(crate) ledger: Ledger,
    entries: Vec<f64>,
    is_shut: bool,
}

impl Books {
    pub(crate) fn new(ledger: Ledger) -> Self {
        Self { ledger, entries: Vec::new(), is_shut: false }
    }

    /// Leaves the ledger as it is from now on.
    pub(crate) fn shut(&mut self) {
        self.is_shut = true;
    }

    fn open(&mut self, bed: &GrainBed, intruder: &dyn Mechanism) {
        bed.entries(intruder, &mut self.entries);
        self.ledger.open(&self.entries);
    }

    fn close(&mut self, bed: &GrainBed, intruder: &dyn Mechanism) {
        if self.is_shut {
            return;
        }
        bed.entries(intruder, &mut self.entries);
        self.ledger.close(&self.entries);
    }
}
