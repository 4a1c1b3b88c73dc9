//! Which signals this process, and so every command that it starts, ignores.

use std::fs;

/// Whether signal `number` is ignored, as SIGINT is under a shell that started the tests in the background; Linux says
/// so.
pub(crate) fn is_ignored(number: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).expect("a mask"));
    mask >> (number - 1) & 1 == 1
}
