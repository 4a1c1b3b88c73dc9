//! The logs of a run as one sequence of messages.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use exchange::follow::{Channel, Followed, Message, Said};
use exchange::read::ReadError;
use exchange::run_files::RunFiles;

/// The logs of a run, which may go on, from their start.
pub(super) struct Logs {
    run: PathBuf,
    /// The log of the bodies and that of the grains.
    each: [Log; 2],
    /// Which log tells of a topic: each can be read without the other, so that some are in both.
    tells: BTreeMap<String, usize>,
}

#[derive(Default)]
struct Log {
    /// Nothing until its file is there.
    followed: Option<Followed>,
    /// What has been read and not yet been handed on.
    waiting: VecDeque<Message>,
    /// The numbers of the channels that the other log tells of.
    left_out: BTreeSet<u16>,
    /// The time of the last message that has been read (ns).
    newest_ns: u64,
}

/// What comes next.
#[derive(Default)]
pub(super) struct Next {
    /// Channels by their numbers; one may come again.
    pub(super) channels: Vec<(u32, Channel)>,
    /// Messages in the order of time, each with the number of its channel.
    pub(super) messages: Vec<(u32, Message)>,
}

impl Logs {
    pub(super) fn of(run: &Path) -> Self {
        Self { run: run.to_owned(), each: Default::default(), tells: BTreeMap::new() }
    }

    /// Reads on, at most a chunk of each log.
    pub(super) fn advance(&mut self) -> Result<Next, ReadError> {
        let files = RunFiles::so_far(&self.run);
        let mut next = Next::default();
        let paths = [files.log, files.grains];
        for (number, (log, path)) in self.each.iter_mut().zip(paths).enumerate() {
            log.open(&path)?;
            let Some(followed) = log.followed.as_mut().filter(|_| log.waiting.is_empty()) else {
                continue;
            };
            for said in followed.advance()? {
                match said {
                    Said::Channel(channel) => {
                        let tells = self.tells.entry(channel.topic.clone()).or_insert(number);
                        if *tells == number {
                            next.channels.push((id(number, channel.id), channel));
                        } else {
                            log.left_out.insert(channel.id);
                        }
                    }
                    Said::Message(message) => {
                        log.newest_ns = log.newest_ns.max(message.time_ns);
                        if !log.left_out.contains(&message.channel) {
                            log.waiting.push_back(message);
                        }
                    }
                }
            }
        }
        // What one log has not said yet may be older than what the other has.
        let going_on = self.each.iter().filter(|log| !log.has_ended());
        let until = going_on.map(|log| log.newest_ns).min().unwrap_or(u64::MAX);
        loop {
            let heads = self.each.iter().enumerate();
            let heads = heads.filter_map(|(n, log)| Some((log.waiting.front()?.time_ns, n)));
            let Some((_, number)) = heads.min().filter(|(time, _)| *time <= until) else {
                return Ok(next);
            };
            let log = &mut self.each[number];
            next.messages.extend(log.waiting.pop_front().map(|m| (id(number, m.channel), m)));
            if log.waiting.is_empty() {
                return Ok(next);
            }
        }
    }

    /// Whether all has been handed on, and nothing comes any more.
    pub(super) fn have_ended(&self) -> bool {
        self.each[0].followed.is_some()
            && self.each.iter().all(|log| log.has_ended() && log.waiting.is_empty())
    }
}

impl Log {
    /// Opens the log at `path`, once it is there and has begun.
    fn open(&mut self, path: &Path) -> Result<(), ReadError> {
        if self.followed.is_none() && path.is_file() {
            self.followed = match Followed::open(path) {
                Ok(followed) => Some(followed),
                Err(ReadError::NotMcap { .. }) => None,
                // It gets its last name in this moment.
                Err(ReadError::Io { source, .. })
                    if source.kind() == std::io::ErrorKind::NotFound =>
                {
                    None
                }
                Err(why) => return Err(why),
            };
        }
        Ok(())
    }

    /// Whether it has nothing more to say; one that is not there has not.
    fn has_ended(&self) -> bool {
        self.followed.as_ref().is_none_or(Followed::has_ended)
    }
}

/// The number of a channel among those of both logs.
fn id(log: usize, channel: u16) -> u32 {
    (log as u32) << 16 | u32::from(channel)
}
