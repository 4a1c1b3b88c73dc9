//! What the statistics of the workbench promise, on worlds whose truth is known.

mod diagnosis;
mod laboratory;
mod world;
