//! Tables of tracking programs become measurement sets: what is found in them, what is refused, and how.

mod contact;
mod formats;
mod groups;
mod irregular;
mod layouts;
mod odd_one_out;
mod programs;
mod refusals;
mod statements;
mod world;
