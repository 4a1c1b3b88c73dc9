//! The table of cases.

use crate::case::Case;

#[path = "../cases/adhesion.rs"]
mod adhesion;
#[path = "../cases/ballistic_flight.rs"]
mod ballistic_flight;
#[path = "../cases/friction_on_incline.rs"]
mod friction_on_incline;
#[path = "../cases/grain_in_groove.rs"]
mod grain_in_groove;
#[path = "../cases/head_on_collision.rs"]
mod head_on_collision;
#[path = "../cases/hertz_collisions.rs"]
mod hertz_collisions;
#[path = "../cases/hertz_mindlin_oblique.rs"]
mod hertz_mindlin_oblique;
#[path = "../cases/hertz_mindlin_spin.rs"]
mod hertz_mindlin_spin;
#[path = "../cases/oblique_collision_energy.rs"]
mod oblique_collision_energy;
#[path = "../cases/rolling_to_rest.rs"]
mod rolling_to_rest;
#[path = "../cases/sliding_to_rolling.rs"]
mod sliding_to_rolling;
#[path = "../cases/squeezed_grain.rs"]
mod squeezed_grain;
#[path = "../cases/viscoelastic_restitution.rs"]
mod viscoelastic_restitution;

/// Every case, simple ones first.
pub static CASES: &[&Case] = &[
    &ballistic_flight::CASE,
    &head_on_collision::CASE,
    &oblique_collision_energy::CASE,
    &friction_on_incline::CASE,
    &sliding_to_rolling::CASE,
    &rolling_to_rest::CASE,
    &squeezed_grain::CASE,
    &grain_in_groove::CASE,
    &hertz_collisions::CASE,
    &hertz_mindlin_oblique::CASE,
    &hertz_mindlin_spin::CASE,
    &viscoelastic_restitution::CASE,
    &adhesion::CASE,
];
