//! The types of atoms in what LAMMPS reads and writes.

/// Grains.
pub(super) const GRAIN: usize = 1;

/// The intruder, of which the types from here on are parts.
pub(super) const INTRUDER: usize = 2;
