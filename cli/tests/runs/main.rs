//! What `plunge run`, `bed` and `recover` promise, seen from outside: bytes, folders, exit codes.

mod common;
mod kill;
mod threads;
