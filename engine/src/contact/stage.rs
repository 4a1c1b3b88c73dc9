//! Lowers a contact law to a loop over many contacts: chosen by name once per run, inlined inside.

use crate::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use crate::ledger::Channel;

/// Contacts that are evaluated together, small enough to stay in the first-level cache.
pub struct Batch<'a> {
    /// The contacts.
    pub contacts: &'a [Contact],
    /// Row of each contact in the history of its table.
    pub rows: &'a [u32],
    /// What the stages before this one answered.
    pub responses: &'a mut [Response],
}

/// A contact law as the engine runs it.
pub trait ContactStage: Send + Sync {
    /// The name in TOML.
    fn name(&self) -> &'static str;
    /// When it acts.
    fn slot(&self) -> Slot;
    /// The accounts it books to.
    fn channels(&self) -> &'static [Channel];
    /// How many `f64` it remembers of a contact.
    fn history_len(&self) -> usize;
    /// Evaluates a batch of contacts; `dt` (s), `history` holds all rows of the table, `energy` (J)
    /// has one entry per channel and is added to.
    fn sweep(&self, batch: Batch<'_>, dt: f64, history: &mut [f64], energy: &mut [f64]);
    /// Duration (s) of a head-on collision, see [`ContactLaw::collision_time`].
    fn collision_time(&self, partner: Partner, encounter: &Encounter) -> Option<f64>;
    /// Shortest relaxation (s), see [`ContactLaw::damping_time`].
    fn damping_time(&self, partner: Partner, encounter: &Encounter) -> Option<f64>;
    /// Time (s) of a surface wave, see [`ContactLaw::wave_time`].
    fn wave_time(&self, partner: Partner, radius: f64, density: f64) -> Option<f64>;
    /// Widest gap (m) of a contact, see [`ContactLaw::reach`].
    fn reach(&self, partner: Partner, radius_eff: f64) -> f64;
}

/// A law with its parameters per kind of partner.
pub struct Stage<L: ContactLaw> {
    pairs: [L::Pair; 3],
}

impl<L: ContactLaw> Stage<L> {
    /// Derives the parameters of each kind of partner.
    #[must_use]
    pub fn new(law: &L) -> Self {
        const {
            assert!(size_of::<L::Energy>() == size_of::<f64>() * L::CHANNELS.len());
            assert!(size_of::<L::History>().is_multiple_of(size_of::<f64>()));
        }
        Self { pairs: Partner::ALL.map(|partner| law.pair(partner)) }
    }
}

impl<L: ContactLaw> ContactStage for Stage<L> {
    fn name(&self) -> &'static str {
        L::NAME
    }

    fn slot(&self) -> Slot {
        L::SLOT
    }

    fn channels(&self) -> &'static [Channel] {
        L::CHANNELS
    }

    fn history_len(&self) -> usize {
        size_of::<L::History>() / size_of::<f64>()
    }

    fn sweep(&self, batch: Batch<'_>, dt: f64, history: &mut [f64], energy: &mut [f64]) {
        let history: &mut [L::History] = bytemuck::cast_slice_mut(history);
        let mut booked: L::Energy = bytemuck::Zeroable::zeroed();
        for ((contact, &row), response) in
            batch.contacts.iter().zip(batch.rows).zip(batch.responses)
        {
            let pair = &self.pairs[contact.partner.index()];
            L::act(pair, contact, dt, &mut history[row as usize], response, &mut booked);
        }
        let booked: &[f64] = bytemuck::cast_slice(std::slice::from_ref(&booked));
        for (total, part) in energy.iter_mut().zip(booked) {
            *total += part;
        }
    }

    fn collision_time(&self, partner: Partner, encounter: &Encounter) -> Option<f64> {
        L::collision_time(&self.pairs[partner.index()], encounter)
    }

    fn damping_time(&self, partner: Partner, encounter: &Encounter) -> Option<f64> {
        L::damping_time(&self.pairs[partner.index()], encounter)
    }

    fn wave_time(&self, partner: Partner, radius: f64, density: f64) -> Option<f64> {
        L::wave_time(&self.pairs[partner.index()], radius, density)
    }

    fn reach(&self, partner: Partner, radius_eff: f64) -> f64 {
        L::reach(&self.pairs[partner.index()], radius_eff)
    }
}
