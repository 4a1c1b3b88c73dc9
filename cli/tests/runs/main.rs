//! What `plunge run`, `sweep`, `bed`, `recover`, `compare` of runs, `--on` and `check` of sets promise, seen
//! from outside: bytes, folders, exit codes.

mod accelerations;
mod beds;
mod check_sets;
mod common;
mod compare_runs;
mod conditions;
mod contradictions;
mod csv;
#[cfg(unix)]
mod elsewhere;
mod export;
mod failures;
mod faults;
mod folders;
mod forces;
mod ignored;
mod imports;
mod kill;
mod log;
mod movies;
mod recover;
mod reports;
mod resistive;
mod shapes;
#[cfg(target_os = "linux")]
mod signals;
mod space;
mod streams;
mod summary;
mod sweeps;
mod tables;
mod threads;
mod view;
mod viewers;
