//! What the statistics of the workbench promise, on worlds whose truth is known.

mod angles;
mod comparison;
mod diagnosis;
mod laboratory;
mod next;
mod noise;
mod search;
mod several_beds;
mod strained;
mod where_it_fails;
mod world;
