//! The series of a `run.mcap`: where the bodies were, and where the energy went.
//!
//! A log is read from its start to its last whole chunk, one chunk at a time, so that one whose
//! run was killed reads as far as it goes. Messages are decoded by the descriptors that the log
//! carries: fields are found by their names, wherever a version of plunge has put them.

mod error;
mod fields;
pub(crate) mod messages;
pub(crate) mod records;
mod series;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::Path;

use engine::record::chunk;
use mcap::records::Record;

use fields::{EnergyFields, LoadFields, StateFields};
use records::Records;

pub use error::ReadError;
pub use series::{BodyLoads, BodyState, BodyStates, Closing, EnergyBudgets};

/// What is kept of a log; the rest takes no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// The states of the bodies.
    States,
    /// The states of the bodies and the energy budget.
    StatesAndEnergy,
    /// The states of the bodies, the forces on them and the energy budget.
    All,
}

/// What a log says of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// The metadata record `run`: name, model hash, versions; empty if the log has none.
    pub metadata: BTreeMap<String, String>,
    /// The bodies, in the order in which the log introduces them.
    pub bodies: Vec<BodyStates>,
    /// The forces of the ground on bodies, as far as they were to be kept and the log has them.
    pub loads: Vec<BodyLoads>,
    /// The energy budget, if it was to be kept and the log has one.
    pub energy: Option<EnergyBudgets>,
    /// Whether the log is finished; one that is not ends with its last whole chunk.
    pub complete: bool,
}

/// Reads the log at `path`, finished or not, and keeps what `keep` says.
///
/// Besides what is kept, memory is that of one chunk.
///
/// # Errors
/// The file system's refusal, a file that is no log of a run, or damage before the end: what is
/// not whole at the end of the file is no damage.
pub fn read_run(path: &Path, keep: Keep) -> Result<RunRecord, ReadError> {
    let mut records = Records::open(path)?;
    let mut reading = Reading::new(path, keep);
    while let Some(offset) = records.advance()? {
        for (opcode, body) in records.present() {
            let damaged = |why: String| ReadError::Damaged { path: path.to_owned(), offset, why };
            let record =
                chunk::parse_record(opcode, body).map_err(|error| damaged(error.to_string()))?;
            reading.take(record, &damaged)?;
        }
    }
    let Reading { metadata, bodies, loads, energy, .. } = reading;
    if bodies.iter().all(|body| body.states.is_empty()) {
        return Err(ReadError::NoBodies { path: path.to_owned() });
    }
    Ok(RunRecord { metadata, bodies, loads, energy, complete: records.complete() })
}

/// What messages of a channel are decoded into.
enum Channel {
    /// The state of the body with this index.
    State(usize, StateFields),
    /// The forces on the body with this index among the loads.
    Load(usize, LoadFields),
    Energy(EnergyFields),
    Other,
}

/// What a channel is about.
enum Kind {
    State,
    Load,
    Energy,
}

/// A log while it is being read.
struct Reading<'a> {
    path: &'a Path,
    keep: Keep,
    /// Names and descriptors.
    schemas: BTreeMap<u16, (String, Vec<u8>)>,
    channels: BTreeMap<u16, Channel>,
    metadata: BTreeMap<String, String>,
    bodies: Vec<BodyStates>,
    loads: Vec<BodyLoads>,
    energy: Option<EnergyBudgets>,
}

impl<'a> Reading<'a> {
    fn new(path: &'a Path, keep: Keep) -> Self {
        Self {
            path,
            keep,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            metadata: BTreeMap::new(),
            bodies: Vec::new(),
            loads: Vec::new(),
            energy: None,
        }
    }

    fn take(
        &mut self,
        record: Record<'_>,
        damaged: &dyn Fn(String) -> ReadError,
    ) -> Result<(), ReadError> {
        match record {
            Record::Schema { header, data } => {
                self.schemas.entry(header.id).or_insert((header.name, data.into_owned()));
            }
            Record::Channel(channel) if !self.channels.contains_key(&channel.id) => {
                let known = self.introduce(&channel)?;
                self.channels.insert(channel.id, known);
            }
            Record::Message { header, data } => match self.channels.get(&header.channel_id) {
                Some(Channel::State(body, fields)) => {
                    let state = fields.read(&data).map_err(|e| damaged(e.to_string()))?;
                    self.bodies[*body].states.push(state);
                }
                Some(Channel::Load(body, fields)) => {
                    let (time, force) = fields.read(&data).map_err(|e| damaged(e.to_string()))?;
                    let loads = &mut self.loads[*body];
                    loads.time.push(time);
                    loads.force.push(force);
                }
                Some(Channel::Energy(fields)) => {
                    if let Some(energy) = &mut self.energy {
                        fields.read(&data, energy).map_err(|e| damaged(e.to_string()))?;
                    }
                }
                Some(Channel::Other) | None => {}
            },
            Record::Metadata(record) if record.name == "run" => self.metadata = record.metadata,
            _ => {}
        }
        Ok(())
    }

    /// Makes room for the series of `channel`, if it is one that is kept.
    fn introduce(&mut self, channel: &mcap::records::Channel) -> Result<Channel, ReadError> {
        let topic = &channel.topic;
        let refusal = |why: String| ReadError::Fields {
            path: self.path.to_owned(),
            topic: topic.clone(),
            why,
        };
        let of_body = topic.strip_prefix("/intruder/").and_then(|rest| rest.rsplit_once('/'));
        let kind = match of_body {
            Some((_, "state")) => Kind::State,
            Some((_, "load")) if self.keep == Keep::All => Kind::Load,
            None if topic == "/energy/budget" && self.keep != Keep::States => Kind::Energy,
            _ => return Ok(Channel::Other),
        };
        let body = of_body.map_or_else(String::new, |(name, _)| name.to_owned());
        let (name, descriptor) = self
            .schemas
            .get(&channel.schema_id)
            .ok_or_else(|| refusal("its messages come without a descriptor".to_owned()))?;
        let message = messages::described(name, descriptor).map_err(refusal)?;
        match kind {
            Kind::State => {
                let fields = StateFields::of(message).map_err(refusal)?;
                self.bodies.push(BodyStates { name: body, states: Vec::new() });
                Ok(Channel::State(self.bodies.len() - 1, fields))
            }
            Kind::Load => {
                let fields = LoadFields::of(message).map_err(refusal)?;
                let (time, force) = (Vec::new(), Vec::new());
                self.loads.push(BodyLoads { name: body, time, force });
                Ok(Channel::Load(self.loads.len() - 1, fields))
            }
            Kind::Energy => {
                let fields = EnergyFields::of(message).map_err(refusal)?;
                self.energy = Some(fields.empty());
                Ok(Channel::Energy(fields))
            }
        }
    }
}
