//! How often the diagnosis is right: worlds in which something is hidden, measured, and diagnosed
//! blindly.
//!
//! [`hidden`] says what can be hidden, `forces`, `path` and `field` are the world, [`design`] and
//! [`laboratory`] measure in it, [`strength`] says how much an effect matters. They share nothing
//! with the models that are diagnosed: neither laws nor integrator nor noise.
//!
//! [`plan`] lists the worlds of every row, [`trial`] has one diagnosed, [`kept`] keeps what came of it, [`scores`] and
//! [`calibration`] say how often it was right, [`table`] and [`json`] write that down.

pub mod beds;
mod beyond;
pub mod calibration;
pub mod chance;
pub mod design;
pub mod document;
mod field;
pub mod forces;
pub mod hidden;
pub mod imperfection;
pub mod interval;
pub mod json;
pub mod kept;
pub mod laboratory;
pub mod next;
pub mod path;
mod peers;
pub mod plan;
pub mod score;
pub mod scores;
pub mod strength;
pub mod table;
pub mod trial;

use configs::Model;
use rayon::prelude::*;

/// Draws and diagnoses `plans`, as many at a time as there are threads; `done` is told of each. What is `kept` is not
/// diagnosed again, and what is diagnosed is kept.
///
/// # Errors
/// If the file of what is kept cannot be written.
pub fn run(
    plans: Vec<plan::Plan>,
    model: &Model,
    kept: Option<&kept::Kept>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<trial::Trial>, kept::KeptError> {
    let each = |plan| {
        let known = kept.and_then(|kept| kept.find(&plan));
        let trial = match (known, kept) {
            (Some(trial), _) => trial,
            (None, kept) => {
                let trial = trial::Trial::of(plan, model);
                kept.map_or(Ok(()), |kept| kept.keep(&trial))?;
                trial
            }
        };
        done();
        Ok(trial)
    };
    plans.into_par_iter().map(each).collect()
}
