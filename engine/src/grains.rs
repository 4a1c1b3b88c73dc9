//! The grains: flat arrays, one entry per grain.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::boundary::Period;
use crate::math::Vec3;
use crate::parallel::BLOCK;

/// How many dimensions the grains live in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Space {
    /// Discs in the x–z plane.
    Planar,
    /// Spheres.
    Spatial,
}

impl Space {
    /// Volume of a grain (m³), or its area (m²) in a plane, from its diameter (m).
    #[must_use]
    pub fn grain_content(self, diameter: f64) -> f64 {
        match self {
            Self::Planar => FRAC_PI_4 * diameter * diameter,
            Self::Spatial => FRAC_PI_6 * diameter * diameter * diameter,
        }
    }

    /// Moment of inertia (kg m²) of a grain: a disc's ½ m r² or a sphere's ⅖ m r².
    #[must_use]
    pub fn grain_inertia(self, mass: f64, radius: f64) -> f64 {
        let factor = match self {
            Self::Planar => 0.5,
            Self::Spatial => 0.4,
        };
        factor * mass * radius * radius
    }

    /// Cross-section of a sphere (m²), or the diameter of a disc (m).
    #[must_use]
    pub fn grain_cross_section(self, radius: f64) -> f64 {
        match self {
            Self::Planar => 2.0 * radius,
            Self::Spatial => std::f64::consts::PI * radius * radius,
        }
    }
}

/// One grain as a recipe or a file gives it: at rest, unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grain {
    /// Centre (m).
    pub position: Vec3,
    /// (m/s).
    pub velocity: Vec3,
    /// (rad/s).
    pub spin: Vec3,
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
    /// Its name in the log, kept when grains are reordered.
    pub id: u32,
}

/// All grains of a bed.
///
/// Between steps `velocity` and `spin` belong to the same instant as `position`; inside a step they
/// are those of the half step, and `velocity_now`, `spin_now` are extrapolated to its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grains {
    /// Discs or spheres.
    pub space: Space,
    /// Names that outlive reordering.
    pub id: Vec<u32>,
    /// (m).
    pub radius: Vec<f64>,
    /// (kg).
    pub mass: Vec<f64>,
    /// (kg m²).
    pub inertia: Vec<f64>,
    /// 1/r (1/m).
    pub inverse_radius: Vec<f64>,
    /// 1/m (1/kg).
    pub inverse_mass: Vec<f64>,
    /// 1/I (1/(kg m²)).
    pub inverse_inertia: Vec<f64>,
    /// 1/(I + m r²) (1/(kg m²)), a grain's part of the inertia of rolling.
    pub rolling_mobility: Vec<f64>,
    /// Centres (m).
    pub position: Vec<Vec3>,
    /// (m/s).
    pub velocity: Vec<Vec3>,
    /// (rad/s).
    pub spin: Vec<Vec3>,
    /// Velocity extrapolated to the end of the step (m/s).
    pub velocity_now: Vec<Vec3>,
    /// Spin extrapolated to the end of the step (rad/s).
    pub spin_now: Vec<Vec3>,
    /// Force (N) and torque (N m) on each grain, gravity included.
    pub load: Vec<Load>,
    /// How the space that they live in repeats; it belongs to the container and is not stored.
    #[serde(skip)]
    pub(crate) period: Period,
}

/// Force and torque on a grain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// (N).
    pub force: Vec3,
    /// About the centre (N m).
    pub torque: Vec3,
}

impl Load {
    /// No force, no torque.
    pub const ZERO: Self =
        Self { force: Vec3::new(0.0, 0.0, 0.0), torque: Vec3::new(0.0, 0.0, 0.0) };

    /// Adds `other`.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.torque += other.torque;
    }
}

impl Grains {
    /// Grains in the given order.
    #[must_use]
    pub fn new(space: Space, list: &[Grain]) -> Self {
        let inertia = |grain: &Grain| space.grain_inertia(grain.mass, grain.radius);
        Self {
            space,
            id: list.iter().map(|grain| grain.id).collect(),
            radius: list.iter().map(|grain| grain.radius).collect(),
            mass: list.iter().map(|grain| grain.mass).collect(),
            inertia: list.iter().map(inertia).collect(),
            inverse_radius: list.iter().map(|grain| 1.0 / grain.radius).collect(),
            inverse_mass: list.iter().map(|grain| 1.0 / grain.mass).collect(),
            inverse_inertia: list.iter().map(|grain| 1.0 / inertia(grain)).collect(),
            rolling_mobility: list
                .iter()
                .map(|grain| 1.0 / (inertia(grain) + grain.mass * grain.radius * grain.radius))
                .collect(),
            position: list.iter().map(|grain| grain.position).collect(),
            velocity: list.iter().map(|grain| grain.velocity).collect(),
            spin: list.iter().map(|grain| grain.spin).collect(),
            velocity_now: list.iter().map(|grain| grain.velocity).collect(),
            spin_now: list.iter().map(|grain| grain.spin).collect(),
            load: vec![Load::ZERO; list.len()],
            period: Period::NONE,
        }
    }

    /// From grain `j` to the nearest image of grain `i` (m).
    #[inline(always)]
    pub(crate) fn apart(&self, i: usize, j: usize) -> Vec3 {
        self.period.shortest(self.position[i] - self.position[j])
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Whether all arrays hold `n` finite entries, for grains that were read from a file.
    pub(crate) fn is_consistent(&self, n: usize) -> bool {
        let scalars = [
            &self.radius,
            &self.mass,
            &self.inertia,
            &self.inverse_radius,
            &self.inverse_mass,
            &self.inverse_inertia,
            &self.rolling_mobility,
        ];
        let vectors =
            [&self.position, &self.velocity, &self.spin, &self.velocity_now, &self.spin_now];
        let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
        self.id.len() == n
            && scalars.iter().all(|list| list.len() == n && list.iter().all(|x| x.is_finite()))
            && vectors.iter().all(|list| list.len() == n && list.iter().all(finite))
            && self.load.len() == n
            && self.load.iter().all(|load| finite(&load.force) && finite(&load.torque))
    }

    /// The grains one by one.
    pub fn iter(&self) -> impl Iterator<Item = Grain> + '_ {
        (0..self.len()).map(|i| Grain {
            position: self.position[i],
            velocity: self.velocity[i],
            spin: self.spin[i],
            radius: self.radius[i],
            mass: self.mass[i],
            id: self.id[i],
        })
    }

    /// Adds `velocity` (m/s) to that of every grain.
    pub(crate) fn throw(&mut self, velocity: Vec3) {
        for of in [&mut self.velocity, &mut self.velocity_now] {
            of.iter_mut().for_each(|own| *own += velocity);
        }
    }

    /// Brings back inside, on the other side, what has left through a periodic one.
    pub(crate) fn wrap(&mut self) {
        if self.period.is_none() {
            return;
        }
        let period = self.period;
        self.position.par_chunks_mut(BLOCK).for_each(|positions| {
            for position in positions {
                *position = period.inside(*position);
            }
        });
    }

    /// Half a kick, then the drift; `dt` (s). Returns the greatest speed (m/s) of a grain.
    pub(crate) fn kick_drift(&mut self, dt: f64) -> f64 {
        let half = 0.5 * dt;
        let (inverse_mass, inverse_inertia, load) =
            (&self.inverse_mass, &self.inverse_inertia, &self.load);
        let fastest_2 = (
            self.position.par_chunks_mut(BLOCK),
            self.velocity.par_chunks_mut(BLOCK),
            self.spin.par_chunks_mut(BLOCK),
            self.velocity_now.par_chunks_mut(BLOCK),
            self.spin_now.par_chunks_mut(BLOCK),
        )
            .into_par_iter()
            .enumerate()
            .map(|(block, (position, velocity, spin, velocity_now, spin_now))| {
                let mut fastest_2 = 0.0_f64;
                for k in 0..position.len() {
                    let i = block * BLOCK + k;
                    let dv = load[i].force * (half * inverse_mass[i]);
                    let dw = load[i].torque * (half * inverse_inertia[i]);
                    velocity[k] += dv;
                    spin[k] += dw;
                    position[k] += velocity[k] * dt;
                    velocity_now[k] = velocity[k] + dv;
                    spin_now[k] = spin[k] + dw;
                    fastest_2 = fastest_2.max(velocity[k].norm_squared());
                }
                fastest_2
            })
            .max_by(f64::total_cmp);
        fastest_2.unwrap_or(0.0).sqrt()
    }
}
