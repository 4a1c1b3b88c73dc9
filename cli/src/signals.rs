//! Signals: the first asks the command to end, a second ends the program at once.
//!
//! A command that can save what it has asks [`is_asked_to_stop`] between its steps, and ends by itself. One that
//! does not ask, or that is busy with something that cannot be interrupted, is ended by a thread of its own
//! within [`PATIENCE`]. That is safe at any moment: a file gets its name when it is whole, so what is there
//! afterwards is what a kill would leave.

use std::io::{self, IsTerminal as _};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;
use std::time::Duration;

use anyhow::Context as _;
use nix::sys::signal::{SigSet, SigmaskHow, Signal};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::{flag, low_level};

use crate::host;
use crate::output;

/// How long a command that asks may take to hear of a signal.
const PATIENCE: Duration = Duration::from_millis(1500);

/// How long a command that has heard may take to save a state: some hundred megabytes on a slow disk.
const SAVING: Duration = Duration::from_secs(10);

/// The signal that asked to stop; 0 for none.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// Whether the command has ever asked. It changes under [`TURN`] alone.
static IS_POLLED: AtomicBool = AtomicBool::new(false);

/// Held by what decides who ends the command: itself once it asks, else a thread that keeps it to the end, so
/// that the command begins nothing that it would have to take away.
static TURN: Mutex<()> = Mutex::new(());

/// Whether it has asked since there was a signal.
static HAS_HEARD: AtomicBool = AtomicBool::new(false);

/// Listens for signals. One that is ignored, as `nohup` has it, stays ignored. A command that a signal ends
/// says `consequence`: what is left of it, and how to go on.
pub(crate) fn listen(consequence: &'static str) -> anyhow::Result<()> {
    let signal = SIGNAL.get_or_init(Arc::default);
    let asked = Arc::new(AtomicBool::new(false));
    let ignored = ignored_signals();
    let heeded: Vec<i32> = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|number| ignored >> (number - 1) & 1 == 0)
        .collect();
    // Until every handler is there they wait: one that comes while the first is installed would be lost.
    let before = held_back(&heeded)?;
    // First, so that a signal which any handler catches reaches the thread, however early it comes.
    let mut signals = Signals::new(&heeded).context("cannot listen for signals")?;
    for number in heeded {
        // In this order: the flag that the first sets is what the second finds.
        flag::register_conditional_shutdown(number, status(number), Arc::clone(&asked))
            .and_then(|_| flag::register(number, Arc::clone(&asked)))
            .and_then(|_| {
                flag::register_usize(number, Arc::clone(signal), number.unsigned_abs() as usize)
            })
            .context("cannot listen for signals")?;
    }
    before.thread_set_mask().context("cannot listen for signals")?;
    let wait = move || {
        if let Some(number) = signals.forever().next() {
            // One that came before the flags were registered has not set it. `asked` stays its handler's alone:
            // set from here, it might end the program in the handler of this very signal.
            signal.store(number.unsigned_abs() as usize, Ordering::Relaxed);
            end(number, consequence);
        }
    };
    thread::Builder::new()
        .name("signals".to_owned())
        .spawn(wait)
        .context("cannot start a thread")?;
    Ok(())
}

/// From now on the command asks, and takes what it has begun away when it ends.
pub(crate) fn will_be_asked_for() {
    if !IS_POLLED.load(Ordering::Relaxed) {
        let _turn = TURN.lock();
        IS_POLLED.store(true, Ordering::Relaxed);
    }
}

/// Whether a signal has asked to stop, or the host.
pub(crate) fn is_asked_to_stop() -> bool {
    if let Some(host) = host::current() {
        return host.is_stopped();
    }
    will_be_asked_for();
    let is_asked = number() != 0;
    if is_asked {
        HAS_HEARD.store(true, Ordering::Relaxed);
    }
    is_asked
}

/// The exit status of a command that a signal has stopped.
pub(crate) fn exit_status() -> u8 {
    128 + number() as u8
}

fn number() -> usize {
    SIGNAL.get().map_or(0, |signal| signal.load(Ordering::Relaxed))
}

fn status(number: i32) -> i32 {
    128 + number
}

/// Ends the program, after the time in which the command can end by itself.
fn end(number: i32, consequence: &str) {
    let turn = TURN.lock();
    if IS_POLLED.load(Ordering::Relaxed) {
        drop(turn);
        thread::sleep(PATIENCE);
        if HAS_HEARD.load(Ordering::Relaxed) {
            thread::sleep(SAVING - PATIENCE);
        }
    }
    // A bar of progress stands on the last line.
    let line = if io::stderr().is_terminal() { "\n" } else { "" };
    output::to_stderr(&format!("{line}{}", words(consequence)));
    low_level::exit(status(number));
}

/// What a command says that a signal has stopped.
pub(crate) fn words(consequence: &str) -> String {
    format!("stopped by a signal; {consequence}\n")
}

/// Holds `signals` back from this thread, the only one there is; gives what it held back before.
fn held_back(signals: &[i32]) -> anyhow::Result<SigSet> {
    let numbers = signals.iter().map(|&number| Signal::try_from(number));
    let set: SigSet = numbers.collect::<Result<_, _>>().context("cannot listen for signals")?;
    set.thread_swap_mask(SigmaskHow::SIG_BLOCK).context("cannot hold signals back")
}

/// The signals that the program was started to ignore, signal n as bit n − 1, where the system says so.
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
