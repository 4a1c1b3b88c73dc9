//! One target for some time, led by what is new in its answers.

use std::any::Any;
use std::collections::BTreeSet;
use std::collections::btree_map::{BTreeMap, Entry};
use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use fuzz::Target;
use fuzz::mutation::changed;
use rand::RngExt;
use rand_pcg::Pcg64;

/// How often it is looked whether a reader is still at the same input.
const LOOK: Duration = Duration::from_secs(10);

/// A reader that is at one input for so many looks does not end. One look alone may follow a sleep of the
/// machine.
const LOOKS: u32 = 6;

/// Longest input that others are made of (bytes).
const LONGEST_KEPT: usize = 1 << 16;

/// Most inputs that others are made of.
const MOST_KEPT: usize = 4096;

/// What is to be done.
pub(crate) struct Hunt<'a> {
    pub(crate) target: Target,
    pub(crate) seed: u64,
    /// Where inputs that broke something are written.
    pub(crate) out: &'a Path,
}

/// What came of it.
pub(crate) struct Tally {
    pub(crate) tried: u64,
    /// Answers that differ in more than numbers.
    pub(crate) answers: usize,
    pub(crate) slowest: Duration,
    /// Files with inputs that broke something, and how.
    pub(crate) broken: Vec<(PathBuf, String)>,
}

impl Hunt<'_> {
    /// Tries `seeds`, then changes of them and of whatever got a new answer, until `time` is up.
    pub(crate) fn run(&self, seeds: Vec<Vec<u8>>, time: Duration) -> io::Result<Tally> {
        let current = self.out.join(format!("{}.current", self.target.name));
        let heart = watched(&current);
        let start = Instant::now();
        let mut random = Pcg64::new(u128::from(self.seed), 0);
        let mut pool: Vec<Vec<u8>> = Vec::new();
        let mut waiting = seeds;
        let mut answers = BTreeSet::new();
        let mut broken: BTreeMap<String, PathBuf> = BTreeMap::new();
        let (mut tried, mut slowest) = (0, Duration::ZERO);
        while start.elapsed() < time || !waiting.is_empty() {
            let input = waiting.pop().unwrap_or_else(|| {
                let [one, other] = [(); 2].map(|()| &pool[random.random_range(0..pool.len())]);
                changed(one, other, &mut random)
            });
            // What ends the whole process, as running out of memory does, is found here.
            fs::write(&current, &input)?;
            let _ = heart.send(());
            let before = Instant::now();
            let answer = catch_unwind(AssertUnwindSafe(|| (self.target.outcome)(&input)));
            slowest = slowest.max(before.elapsed());
            tried += 1;
            match answer {
                Ok(answer) => {
                    let is_new = answers.insert(without_numbers(&answer));
                    if pool.is_empty() || is_new && input.len() <= LONGEST_KEPT {
                        match pool.len() < MOST_KEPT {
                            true => pool.push(input),
                            false => pool[random.random_range(0..MOST_KEPT)] = input,
                        }
                    }
                }
                Err(panic) => {
                    let why = words(&*panic);
                    let name = format!("{}-{}", self.target.name, broken.len());
                    if let Entry::Vacant(new) = broken.entry(without_numbers(&why)) {
                        let file = self.out.join(name);
                        fs::write(&file, &input)?;
                        fs::write(file.with_extension("txt"), why)?;
                        new.insert(file);
                    }
                }
            }
        }
        fs::remove_file(&current)?;
        let broken = broken.into_iter().map(|(why, file)| (file, why)).collect();
        Ok(Tally { tried, answers: answers.len(), slowest, broken })
    }
}

/// Ends the process where the sender has been silent for too long; the input is then in `current`.
fn watched(current: &Path) -> Sender<()> {
    let (heart, beats) = channel();
    let current = current.to_owned();
    thread::spawn(move || {
        let mut silent = 0;
        while silent < LOOKS {
            match beats.recv_timeout(LOOK) {
                Ok(()) => silent = 0,
                Err(RecvTimeoutError::Timeout) => silent += 1,
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        eprintln!("error: {}: no end after {:?}", current.display(), LOOK * LOOKS);
        std::process::exit(1);
    });
    heart
}

/// What was said as something broke.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("a panic without words").to_owned()
}

/// Kind of an answer: the letters of its sentences, without what stands between quotes or is shown of a
/// file.
fn without_numbers(answer: &str) -> String {
    const LONGEST: usize = 400;
    let is_sentence = |line: &&str| {
        !line.starts_with(|first: char| {
            first.is_whitespace() || first.is_ascii_digit() || first == '|'
        })
    };
    let sentences = answer.lines().filter(is_sentence);
    let outside = sentences.flat_map(|line| line.split(['`', '"']).step_by(2));
    let letters = outside.flat_map(str::chars).filter(|letter| letter.is_alphabetic());
    letters.take(LONGEST).collect()
}
