//! Decks under the program that they are for: `PLUNGE_LAMMPS=lmp cargo test --workspace --test lammps`.

mod clumps;
mod crosscheck;
mod ensemble;
mod program;
mod three_grains;
