//! What a process has used.

use std::fs;

use rustix::time::{ClockId, clock_gettime};

/// CPU time (s) that this process has used so far, on all its threads.
pub(super) fn cpu_seconds() -> f64 {
    let used = clock_gettime(ClockId::ProcessCPUTime);
    used.tv_sec as f64 + 1e-9 * used.tv_nsec as f64
}

/// Memory of this process (byte).
pub(super) struct Memory {
    /// The most that it has held so far.
    pub(super) peak: u64,
    /// What it holds now.
    pub(super) held: u64,
}

/// The memory of this process; none where the system does not tell.
pub(super) fn memory() -> Option<Memory> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let bytes = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        Some(1024 * line.split_whitespace().next()?.parse::<u64>().ok()?)
    };
    Some(Memory { peak: bytes("VmHWM:")?, held: bytes("VmRSS:")? })
}
