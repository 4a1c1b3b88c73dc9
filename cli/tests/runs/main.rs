//! What `plunge run`, `bed` and `recover` promise, seen from outside: bytes, folders, exit codes.

mod beds;
mod common;
mod conditions;
mod csv;
mod failures;
mod folders;
mod kill;
mod log;
mod recover;
mod resistive;
mod summary;
mod threads;
