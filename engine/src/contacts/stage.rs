//! Lowers a contact law to a loop over many contacts: chosen by name once per run, inlined inside.

use super::pairs::Pairs;
use crate::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use crate::dimension::{Dimension, Planar, Spatial};
use crate::lanes::{Eight, Lanes, MOST_LANES, Record, per_lane};
use crate::ledger::Channel;
use crate::space::Space;

/// Contacts that are evaluated together, small enough to stay in the first-level cache.
pub struct Batch<'a, R: Lanes, const N: usize> {
    /// What the grains touch.
    pub partner: Partner,
    /// The contacts.
    pub contacts: &'a [Contact<R, N>],
    /// Where in the histories the record of each lane begins, for every contact.
    pub records: &'a [[u32; MOST_LANES]],
    /// What the stages before this one answered.
    pub responses: &'a mut [Response<R, N>],
}

/// The histories of a table of contacts.
pub struct Histories<'a> {
    /// Record after record, each with the numbers of all stages.
    pub values: &'a mut [f64],
    /// Where in a record those of this stage begin.
    pub offset: usize,
}

/// A contact law as the engine runs it, for so many lanes and components.
pub trait Sweep<R: Lanes, const N: usize> {
    /// Evaluates a batch of contacts; `dt` (s), `energy` (J) has one entry per channel and is added to.
    /// Without it nothing is booked: forces are the same.
    fn sweep(
        &self,
        batch: Batch<'_, R, N>,
        dt: f64,
        histories: Histories<'_>,
        energy: Option<&mut [f64]>,
    );
}

/// A contact law as the engine runs it.
pub trait ContactStage:
    Sweep<f64, 1> + Sweep<f64, 3> + Sweep<Eight, 1> + Sweep<Eight, 3> + Send + Sync
{
    /// Evaluates the contacts between grains of a block where no other law acts.
    fn sweep_pairs(&self, pairs: Pairs<'_>);
    /// The name in TOML.
    fn name(&self) -> &'static str;
    /// When it acts.
    fn slot(&self) -> Slot;
    /// The accounts it books to.
    fn channels(&self) -> &'static [Channel];
    /// How many `f64` it takes in the record of a contact.
    fn history_len(&self, space: Space) -> usize;
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
    pub fn new(law: &L) -> Self {
        const { assert!(<L::Energy<f64> as Record<f64>>::LEN == L::CHANNELS.len()) }
        Self { pairs: Partner::ALL.map(|partner| law.pair(partner)) }
    }
}

impl<L: ContactLaw> Stage<L> {
    /// Evaluates a batch, and returns what is booked: inlined, so that what nobody takes is not computed.
    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        &self,
        batch: Batch<'_, R, N>,
        dt: f64,
        mut histories: Histories<'_>,
    ) -> L::Energy<R> {
        let pair = self.pairs[batch.partner.index()];
        let mut booked = L::Energy::<R>::zero();
        let evaluated = batch.contacts.iter().zip(batch.responses).zip(batch.records);
        for ((contact, response), records) in evaluated {
            let mut history = read::<R, L::History<R, N>>(&histories, records);
            L::act(&pair, contact, dt, &mut history, response, &mut booked);
            write(&history, &mut histories, records);
        }
        booked
    }

    /// The same for contacts between grains that no other law acts on, from the places of the grains to
    /// their loads: a contact never goes through memory.
    #[inline(always)]
    fn act_alone<D: Dimension<N>, R: Lanes, const N: usize>(
        &self,
        pairs: &mut Pairs<'_>,
        near: &[u32],
    ) -> L::Energy<R> {
        let pair = self.pairs[Partner::Grain.index()];
        let mut booked = L::Energy::<R>::zero();
        for (group, here) in near.chunks_exact(R::COUNT).enumerate() {
            let ahead = (group + GROUPS_AHEAD) * R::COUNT;
            pairs.fetch::<D, N>(near.get(ahead..ahead + R::COUNT).unwrap_or_default());
            let (contact, side) = pairs.meet::<D, R, N>(here);
            let mut histories = Histories { values: pairs.table.histories_mut(), offset: 0 };
            let mut history = read::<R, L::History<R, N>>(&histories, &side.records);
            let mut response = Response::default();
            L::act(&pair, &contact, pairs.dt, &mut history, &mut response, &mut booked);
            write(&history, &mut histories, &side.records);
            pairs.settle::<D, R, N>(here, &side, &contact, &response);
        }
        booked
    }

    fn sweep_pairs_in<D: Dimension<N>, const N: usize>(&self, pairs: &mut Pairs<'_>) {
        let near = pairs.near;
        let (in_lanes, rest) = near.split_at(near.len() - near.len() % Eight::COUNT);
        if pairs.tally.energy.is_empty() {
            self.act_alone::<D, Eight, N>(pairs, in_lanes);
            self.act_alone::<D, f64, N>(pairs, rest);
        } else {
            let in_lanes = self.act_alone::<D, Eight, N>(pairs, in_lanes);
            let rest = self.act_alone::<D, f64, N>(pairs, rest);
            book(&in_lanes, &mut pairs.tally.energy);
            book(&rest, &mut pairs.tally.energy);
        }
    }
}

/// Adds what lanes have booked to `energy` (J), one entry per channel.
#[inline(always)]
fn book<R: Lanes>(booked: &impl Record<R>, energy: &mut [f64]) {
    let mut channels = energy.iter_mut();
    booked.write(&mut |part: R| {
        if let Some(total) = channels.next() {
            *total += part.sum_of_lanes();
        }
    });
}

impl<L: ContactLaw, R: Lanes, const N: usize> Sweep<R, N> for Stage<L> {
    fn sweep(
        &self,
        batch: Batch<'_, R, N>,
        dt: f64,
        histories: Histories<'_>,
        energy: Option<&mut [f64]>,
    ) {
        match energy {
            Some(energy) => book(&self.act(batch, dt, histories), energy),
            None => drop(self.act(batch, dt, histories)),
        }
    }
}

/// How many groups of contacts ahead what they need is fetched.
const GROUPS_AHEAD: usize = 2;

/// Longest record of one stage, and room for two numbers more, which are moved together.
const MOST_NUMBERS: usize = 16;

/// Room for `numbers` in a record: they are read by fours, and three are read sooner as four.
const fn room(numbers: usize) -> usize {
    if numbers % 4 == 3 { numbers + 1 } else { numbers }
}

/// How many of `numbers` in a record are read by fours, and where those end that are read by twos.
const fn parts(numbers: usize) -> (usize, usize) {
    let by_four = room(numbers) / 4 * 4;
    (by_four, if numbers < by_four { by_four } else { numbers / 2 * 2 })
}

/// Where among `n` values the rows of `room` numbers begin that lie `offset` into `records`.
///
/// # Panics
/// If one of them does not lie within: one look for all of them, where eight cost a tenth of the loop.
#[inline(always)]
fn rows_within(
    n: usize,
    offset: usize,
    records: &[u32; MOST_LANES],
    room: usize,
) -> [usize; MOST_LANES] {
    let last = records.iter().fold(0, |last, &record| record.max(last));
    assert!(last as usize + offset + room <= n, "a record outside of the histories");
    per_lane(|lane| records[lane] as usize + offset)
}

/// The records that begin at `records`, one in each lane.
#[inline(always)]
#[expect(unsafe_code, reason = "measured: see docs/performance.md")]
fn read<R: Lanes, H: Record<R>>(histories: &Histories<'_>, records: &[u32; MOST_LANES]) -> H {
    const { assert!(H::LEN <= MOST_NUMBERS - 2) }
    let values = &*histories.values;
    let begins = rows_within(values.len(), histories.offset, records, room(H::LEN));
    // SAFETY: they have just been seen to lie within.
    let rows: [&[f64]; MOST_LANES] =
        per_lane(|lane| unsafe { values.get_unchecked(begins[lane]..begins[lane] + room(H::LEN)) });
    let mut numbers = [R::zero(); MOST_NUMBERS];
    let (by_four, by_two) = parts(H::LEN);
    for at in (0..by_four).step_by(4) {
        let quads = per_lane(|lane| [0, 1, 2, 3].map(|k| rows[lane][at + k]));
        let columns = R::columns(per_lane(|lane| &quads[lane]));
        numbers[at..at + 4].copy_from_slice(&columns);
    }
    for at in (by_four..by_two).step_by(2) {
        let twos = per_lane(|lane| [0, 1].map(|k| rows[lane][at + k]));
        let columns = R::columns_of_two(per_lane(|lane| &twos[lane]));
        numbers[at..at + 2].copy_from_slice(&columns);
    }
    for at in by_two..H::LEN {
        numbers[at] = R::from_lanes(|lane| rows[lane][at]);
    }
    let mut at = 0;
    H::read(&mut || {
        at += 1;
        numbers[at - 1]
    })
}

/// Puts each lane of `history` back where [`read`] took it from.
#[inline(always)]
#[expect(unsafe_code, reason = "measured: see docs/performance.md")]
fn write<R: Lanes, H: Record<R>>(
    history: &H,
    histories: &mut Histories<'_>,
    records: &[u32; MOST_LANES],
) {
    let mut numbers = [R::zero(); MOST_NUMBERS];
    let mut at = 0;
    history.write(&mut |value: R| {
        numbers[at] = value;
        at += 1;
    });
    let (by_four, by_two) = parts(H::LEN);
    let mut quads = [[[0.0; 4]; MOST_LANES]; MOST_NUMBERS / 4];
    for (quad, at) in quads.iter_mut().zip((0..by_four).step_by(4)) {
        *quad = R::rows([0, 1, 2, 3].map(|k| numbers[at + k]));
    }
    let twos = R::rows_of_two([0, 1].map(|k| numbers[by_four + k]));
    let values = &mut *histories.values;
    let begins = rows_within(values.len(), histories.offset, records, room(H::LEN));
    for lane in 0..R::COUNT {
        // SAFETY: as in `read`.
        let row = unsafe { values.get_unchecked_mut(begins[lane]..begins[lane] + room(H::LEN)) };
        for (quad, at) in quads.iter().zip((0..by_four).step_by(4)) {
            row[at..at + 4].copy_from_slice(&quad[lane]);
        }
        for at in (by_four..by_two).step_by(2) {
            row[at..at + 2].copy_from_slice(&twos[lane]);
        }
        for at in by_two..H::LEN {
            row[at] = numbers[at].lane(lane);
        }
    }
}

impl<L: ContactLaw> ContactStage for Stage<L> {
    fn sweep_pairs(&self, mut pairs: Pairs<'_>) {
        match pairs.space() {
            Space::Planar => self.sweep_pairs_in::<Planar, 1>(&mut pairs),
            Space::Spatial => self.sweep_pairs_in::<Spatial, 3>(&mut pairs),
        }
    }

    fn name(&self) -> &'static str {
        L::NAME
    }

    fn slot(&self) -> Slot {
        L::SLOT
    }

    fn channels(&self) -> &'static [Channel] {
        L::CHANNELS
    }

    fn history_len(&self, space: Space) -> usize {
        match space {
            Space::Planar => room(<L::History<f64, 1> as Record<f64>>::LEN),
            Space::Spatial => room(<L::History<f64, 3> as Record<f64>>::LEN),
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
