//! The summary of an impact on a resistive medium.

use configs::{Condition, ResistiveModel};
use engine::ledger::{ChannelKind, Ledger, TermKind};
use engine::math::Vec3;
use resistive::{Ending, Impact, PartStop, Sample};
use serde::{Deserialize, Serialize};

use crate::run::intrusion::Push;

use super::{
    CostSummary, DRIVE, EnergySummary, FinalEnergy, ImpactSummary, IntrusionSummary, StopSummary,
    Summary, by_channel,
};

/// The static and the dynamic part of the force, over all bodies; what was not reached is null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForceSummary {
    /// When the static part became the larger one for good.
    pub static_overtakes_s: Option<f64>,
    /// Of the whole medium, at the last sample in motion.
    #[serde(rename = "force_at_stop_N")]
    pub force_at_stop: Option<f64>,
    /// The static part of that (N).
    #[serde(rename = "static_at_stop_N")]
    pub static_at_stop: Option<f64>,
}

/// One link of a chain. Its shares of energy are those of the mechanical energy that it lost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinkSummary {
    /// First contact, from the start (s).
    pub contact_s: Option<f64>,
    /// From its own first contact.
    pub stopping_time_s: Option<f64>,
    /// Largest depth of its tip (m).
    pub depth_m: f64,
    /// Given to the medium by the force on this link.
    #[serde(rename = "given_J")]
    pub given: f64,
    /// Of what all links give.
    pub given_share: Option<f64>,
    /// Kinetic energy that it lost (J).
    #[serde(rename = "kinetic_lost_J")]
    pub kinetic_lost: f64,
    /// Potential energy that it lost (J).
    #[serde(rename = "potential_lost_J")]
    pub potential_lost: f64,
    /// Kinetic part of what it lost (–).
    pub kinetic_share: Option<f64>,
    /// Potential part of what it lost (–).
    pub potential_share: Option<f64>,
}

/// What a link has gone through, times from the start.
pub(super) struct LinkCourse {
    /// First contact (s).
    pub(super) contact: Option<f64>,
    /// (s).
    pub(super) stop: Option<f64>,
    /// (m).
    pub(super) depth: f64,
    /// To the medium (J).
    pub(super) given: f64,
    /// By all links (J).
    pub(super) given_by_all: f64,
    /// Kinetic and potential energy (J).
    pub(super) lost: [f64; 2],
}

impl LinkSummary {
    pub(super) fn new(link: LinkCourse) -> Self {
        let share = |of: f64, whole: f64| (whole != 0.0).then(|| of / whole);
        let [kinetic_lost, potential_lost] = link.lost;
        let lost = kinetic_lost + potential_lost;
        Self {
            contact_s: link.contact,
            stopping_time_s: link.stop.zip(link.contact).map(|(end, start)| end - start),
            depth_m: link.depth,
            given: link.given,
            given_share: share(link.given, link.given_by_all),
            kinetic_lost,
            potential_lost,
            kinetic_share: share(kinetic_lost, lost),
            potential_share: share(potential_lost, lost),
        }
    }
}

/// What is gathered for the summary while the impact runs.
#[derive(Default)]
pub(in crate::run) struct Watched {
    /// Values of the ledger at the start (J).
    at_start: Vec<f64>,
    /// The last sample in motion.
    last: Option<Forces>,
    static_overtakes: Option<f64>,
    push: Option<Push>,
}

/// Forces of the medium on all bodies at one time.
#[derive(Clone, Copy)]
struct Forces {
    time: f64,
    whole: f64,
    dynamic: f64,
    friction: f64,
}

/// An impact that is over.
pub(in crate::run) struct Ended {
    watched: Watched,
    ending: Ending,
    ledger: Ledger,
    /// By part (J).
    given: Vec<f64>,
    stops_with_its_tips: bool,
}

impl Watched {
    /// Of a run in which `push` is gathered, if a drive pushes the intruder.
    pub(in crate::run) fn new(push: Option<Push>) -> Self {
        Self { push, ..Self::default() }
    }

    pub(in crate::run) fn see(&mut self, sample: &Sample<'_>) {
        if sample.number == 0 {
            self.at_start.clone_from(&sample.ledger.balance().values);
        }
        let moves = sample.parts.iter().any(|part| part.part.velocity.norm() > 0.0);
        if !moves {
            return;
        }
        let (mut dynamic, mut friction) = (Vec3::zeros(), Vec3::zeros());
        for part in sample.parts {
            if let Some(push) = &mut self.push {
                push.see(part.part.immersion.depth, part.dynamic + part.friction, part.torque);
            }
            dynamic += part.dynamic;
            friction += part.friction;
        }
        let now = Forces {
            time: sample.time,
            whole: (dynamic + friction).norm(),
            dynamic: dynamic.norm(),
            friction: friction.norm(),
        };
        if now.friction <= now.dynamic {
            self.static_overtakes = None;
        } else if self.static_overtakes.is_none() {
            self.static_overtakes = Some(now.crossing(self.last));
        }
        self.last = Some(now);
    }

    /// With the end of `impact`; `given` is by part (J).
    pub(in crate::run) fn end(
        self,
        impact: &Impact,
        ending: Ending,
        ledger: Ledger,
        given: &[f64],
    ) -> Ended {
        let stops_with_its_tips = impact.assembly().ends_with_its_tips();
        Ended { watched: self, ending, ledger, given: given.to_vec(), stops_with_its_tips }
    }
}

impl Forces {
    /// When the static part became the larger one, on the line from the sample before.
    fn crossing(&self, before: Option<Self>) -> f64 {
        let Some(before) = before else { return self.time };
        let [was, is] = [before, *self].map(|one| one.friction - one.dynamic);
        before.time + (self.time - before.time) * was / (was - is)
    }
}

impl Ended {
    fn stop(&self) -> StopSummary {
        let parts = &self.ending.parts[..self.given.len()];
        // From the first contact of any part to the last stop of any.
        let contact = parts.iter().filter_map(|part| part.contact).reduce(f64::min).unwrap_or(0.0);
        let latest = |time: fn(&PartStop) -> Option<f64>| {
            let times = parts.iter().map(time).collect::<Option<Vec<f64>>>()?;
            times.into_iter().reduce(f64::max)
        };
        let after = |time: Option<f64>| time.map(|time| time - contact);
        let vertical = after(latest(|part| part.vertical));
        let horizontal = latest(|part| part.horizontal)
            .map(|time| if time > 0.0 { time - contact } else { 0.0 });
        let stopping = match self.stops_with_its_tips {
            true => vertical,
            false => vertical.zip(horizontal).map(|(z, x)| z.max(x)),
        };
        let largest = |value: fn(&PartStop) -> f64| parts.iter().map(value).fold(0.0, f64::max);
        let deepest = parts.iter().map(|part| part.depth).fold(0.0, f64::max);
        let stopped = match self.intrusion() {
            Some(intrusion) => intrusion.is_complete(deepest),
            None => self.ending.stopped,
        };
        StopSummary {
            stopped,
            stopping_time_s: stopping,
            stopping_time_z_s: vertical,
            stopping_time_x_s: horizontal,
            rest_time_s: after(self.ending.rest),
            depth_m: largest(|part| part.depth),
            range_m: largest(|part| part.range),
        }
    }

    fn intrusion(&self) -> Option<IntrusionSummary> {
        let work = by_channel(&self.ledger, ChannelKind::Input).get(DRIVE).copied();
        Some(self.watched.push.as_ref()?.summary(work.unwrap_or(0.0)))
    }

    fn forces(&self) -> ForceSummary {
        let Watched { last, static_overtakes, .. } = &self.watched;
        let last = last.filter(|_| self.ending.stopped);
        ForceSummary {
            static_overtakes_s: *static_overtakes,
            force_at_stop: last.map(|last| last.whole),
            static_at_stop: last.map(|last| last.friction),
        }
    }

    /// Energy of one kind that `part` has lost (J), or, without one, that all have.
    fn lost(&self, kind: TermKind, part: Option<usize>) -> f64 {
        let prefix = part.map_or("".to_owned(), |part| format!("link-{}", part + 1));
        let values = self.watched.at_start.iter().zip(&self.ledger.balance().values);
        let terms = self.ledger.terms().iter().zip(values);
        terms
            .filter(|(term, _)| term.kind == kind && term.name.starts_with(&prefix))
            .map(|(_, (before, after))| before - after)
            .sum()
    }

    fn links(&self) -> Vec<LinkSummary> {
        if self.given.len() == 1 {
            return Vec::new();
        }
        let all: f64 = self.given.iter().sum();
        let link = |part: usize| {
            let stop = &self.ending.parts[part];
            let lost = [TermKind::Kinetic, TermKind::Potential];
            LinkSummary::new(LinkCourse {
                contact: stop.contact,
                stop: stop.vertical,
                depth: stop.depth,
                given: self.given[part],
                given_by_all: all,
                lost: lost.map(|kind| self.lost(kind, Some(part))),
            })
        };
        (0..self.given.len()).map(link).collect()
    }

    fn energy(&self, scale: f64) -> EnergySummary {
        let ledger = &self.ledger;
        let held = |kind: TermKind| -> [f64; 2] {
            [&self.watched.at_start, &ledger.balance().values].map(|values| {
                let terms = ledger.terms().iter().zip(values);
                terms.filter(|(term, _)| term.kind == kind).map(|(_, value)| value).sum()
            })
        };
        let [before, after] = held(TermKind::Kinetic);
        // A body in a fluid moves some of it from the start.
        let [stored_before, stored] = held(TermKind::Channel(ChannelKind::Stored));
        EnergySummary {
            initial: before,
            at_end: FinalEnergy {
                intruder: after - self.lost(TermKind::Potential, None),
                grains: 0.0,
                elastic: Some(stored - stored_before),
            },
            dissipated: by_channel(ledger, ChannelKind::Dissipated),
            input: by_channel(ledger, ChannelKind::Input),
            released: Some(self.lost(TermKind::Potential, None)),
            unaccounted: Some(ledger.balance().unaccounted),
            closure: Some(ledger.closure(scale)),
        }
    }
}

impl Summary {
    /// The impact `condition`, over; its closure is counted in `scale` (J).
    pub(in crate::run) fn of_resistance(
        resistive: ResistiveModel<'_>,
        condition: &Condition,
        ended: &Ended,
        scale: f64,
        cost: CostSummary,
    ) -> Self {
        let model = resistive.model;
        Self {
            name: model.run.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: model.hash(),
            medium: model.medium.kind().to_owned(),
            impact: ImpactSummary::new(condition, 0.0),
            stop: ended.stop(),
            energy: ended.energy(scale),
            bed: None,
            forces: Some(ended.forces()),
            intrusion: ended.intrusion(),
            links: ended.links(),
            cost,
        }
    }
}
