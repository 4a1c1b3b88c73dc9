//! What a contact is and what a law makes of it: the page a physicist reads.
//!
//! A law sees a [`Contact`] at one instant, adds to its [`Response`] and books, from the same
//! intermediate values, what became of the energy. It is written once, for one contact or for eight side
//! by side ([`crate::lanes`]), in a plane or in space. The engine finds the contacts ([`geometry`]),
//! keeps their histories ([`table`]) and lowers a law to a loop over many contacts ([`crate::stage`]).

pub mod geometry;
pub mod table;

use crate::lanes::{Lanes, Record, Vector, vector_of, vector_where};
use crate::ledger::Channel;

/// What a grain touches; each kind has its own parameters of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// Another grain.
    Grain,
    /// A wall of the container.
    Wall,
    /// The intruder.
    Intruder,
}

impl Partner {
    /// Every kind, in the order of [`Partner::index`].
    pub const ALL: [Self; 3] = [Self::Grain, Self::Wall, Self::Intruder];

    /// Position in a table with one entry per kind.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// Contacts of grains i with partners j (grains, a wall or the intruder) at one instant, one in each lane.
///
/// Slips and spins have `N` components: three in space, in the world frame; in a plane one, along
/// t = y × n for slips and along y for spins. A law is the same in both: whatever lies across the normal
/// goes by [`Contact::across`], [`Contact::along`] and [`Contact::turn`].
///
/// The normal points from j to i: a repulsive force on i is `+normal_force * normal`.
/// Rates belong to the end of the step, steps to what was done during it (see [`crate::step`]).
///
/// A law sees a contact at every step in which it overlaps or is held together by a law that
/// attracts ([`Response::holds`]), and once more in the step in which it has opened, with
/// `overlap <= 0`: the force is then zero and what the contact still stored has to be booked. A law
/// that acts on overlap alone takes a contact that is held open for an opened one.
#[derive(Clone, Copy, Debug)]
pub struct Contact<R: Lanes = f64, const N: usize = 3> {
    /// n, from j to i (–); in a plane it has no component where slips and spins have theirs: zero.
    pub normal: Vector<R, N>,
    /// δ (m); zero or less once the contact has opened.
    pub overlap: R,
    /// dδ/dt (m/s), positive while the two approach.
    pub overlap_rate: R,
    /// Overlap gained in this step (m).
    pub overlap_step: R,
    /// v_t (m/s), of i relative to j at the contact point, spin included.
    pub slip_velocity: Vector<R, N>,
    /// Slip made in this step (m), turned into the present contact plane.
    pub slip_step: Vector<R, N>,
    /// ω_i − ω_j (rad/s).
    pub relative_spin: Vector<R, N>,
    /// Rotation of i relative to j in this step (rad).
    pub relative_turn: Vector<R, N>,
    /// 1/R* = 1/R_i + 1/R_j (1/m); a flat face has no curvature.
    pub inverse_radius_eff: R,
    /// The same at the end of the last step, which differs over an edge or along a cone; what it is now if
    /// the two did not overlap then.
    pub inverse_radius_eff_before: R,
    /// 1/m* = 1/m_i + 1/m_j (1/kg); a wall has infinite mass.
    pub inverse_mass_eff: R,
    /// 1/I_r = Σ 1/(I + m R²) (1/(kg m²)), I_r the inertia of rolling.
    pub rolling_mobility: R,
}

impl<R: Lanes, const N: usize> Contact<R, N> {
    /// R* (m).
    #[inline(always)]
    pub fn radius_eff(&self) -> R {
        R::one() / self.inverse_radius_eff
    }

    /// m* (kg).
    #[inline(always)]
    pub fn mass_eff(&self) -> R {
        R::one() / self.inverse_mass_eff
    }

    /// Whether the two overlap.
    #[inline(always)]
    pub fn overlaps(&self) -> R::Mask {
        self.overlap.simd_gt(R::zero())
    }

    /// The component of a slip or spin along the normal; zero in a plane.
    #[inline(always)]
    pub fn along(&self, vector: Vector<R, N>) -> R {
        if N == 1 { R::zero() } else { vector.dot(&self.normal) }
    }

    /// The part of a slip or spin across the normal; in a plane all of it.
    #[inline(always)]
    pub fn across(&self, vector: Vector<R, N>) -> Vector<R, N> {
        if N == 1 { vector } else { vector - self.normal * self.along(vector) }
    }

    /// Turns a vector that lay in an earlier contact plane into the present one, its length kept
    /// (Luding, Granul. Matter 10, 235 (2008), eq. 17).
    #[inline(always)]
    pub fn turn(&self, vector: Vector<R, N>) -> Vector<R, N> {
        if N == 1 {
            return vector;
        }
        let projected = self.across(vector);
        let projected_2 = projected.dot(&projected);
        let stretch = (vector.dot(&vector) / projected_2).simd_sqrt();
        vector_where(projected_2.simd_gt(R::zero()), projected * stretch)
    }
}

/// What the laws of contacts build up, in lanes. Force and couple act on i; j receives the opposite.
#[derive(Clone, Copy, Debug)]
pub struct Response<R: Lanes = f64, const N: usize = 3> {
    /// F_n (N), repulsion positive.
    pub normal_force: R,
    /// F_a (N), at least 0: what attraction adds to the force that friction is measured by, whose
    /// limit is μ (F_n + F_a).
    pub adhesive_force: R,
    /// Whether a law holds the contact together though it may have opened: then it is kept, with all
    /// that its laws remember, and seen again in the next step.
    pub holds: R::Mask,
    /// dF_n/dδ (N/m), which rolling resistance scales with.
    pub normal_stiffness: R,
    /// F_t (N).
    pub tangential_force: Vector<R, N>,
    /// Couple (N m) of rolling resistance; the torque of F_t about the centres is the engine's job.
    pub couple: Vector<R, N>,
}

impl<R: Lanes, const N: usize> Default for Response<R, N> {
    #[inline(always)]
    fn default() -> Self {
        Self {
            normal_force: R::zero(),
            adhesive_force: R::zero(),
            holds: R::zero().simd_lt(R::zero()),
            normal_stiffness: R::zero(),
            tangential_force: vector_of(|_| R::zero()),
            couple: vector_of(|_| R::zero()),
        }
    }
}

/// The order in which the laws of a contact act: a later one may use what an earlier one answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slot {
    /// Forces along the normal that the base law has to know of before it limits friction: adhesion,
    /// and damping of its own.
    Normal,
    /// Normal and tangential force; every bed has exactly one.
    Base,
    /// A couple against rolling, limited by the normal force.
    Rolling,
    /// A couple against twisting, limited by the normal force.
    Twisting,
}

/// A head-on collision by which the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    /// m*, with 1/m* = 1/m_i + 1/m_j (kg).
    pub mass_eff: f64,
    /// R*, with 1/R* = 1/R_i + 1/R_j (m).
    pub radius_eff: f64,
    /// Speed at which the two approach (m/s), above zero.
    pub speed: f64,
}

/// A contact law, or an effect added to one.
///
/// Force and energy are computed together: a dissipated channel takes the mean of the dissipative
/// force over the step times the displacement made in it, a stored channel takes the energy held
/// now. That is second order in the step, also where a contact opens.
pub trait ContactLaw: Send + Sync + 'static {
    /// The name in TOML.
    const NAME: &'static str;
    /// When it acts.
    const SLOT: Slot;
    /// Names and kinds of the fields of [`Self::Energy`], in order.
    const CHANNELS: &'static [Channel];
    /// Its parameters for one kind of partner.
    type Pair: Copy + Send + Sync;
    /// What it remembers of a contact, zero at first touch.
    type History<R: Lanes, const N: usize>: Record<R>;
    /// One number (J) per channel.
    type Energy<R: Lanes>: Record<R>;

    /// Its parameters for contacts of grains with `partner`.
    fn pair(&self, partner: Partner) -> Self::Pair;

    /// Adds the force of the contacts to `response` and their energy to `energy`; `dt` (s) is the step.
    fn act<R: Lanes, const N: usize>(
        pair: &Self::Pair,
        contact: &Contact<R, N>,
        dt: f64,
        history: &mut Self::History<R, N>,
        response: &mut Response<R, N>,
        energy: &mut Self::Energy<R>,
    );

    /// How long a head-on collision lasts without damping (s); `None` if this law does not decide it.
    /// Sets `time_step = "auto"`.
    fn collision_time(_pair: &Self::Pair, _encounter: &Encounter) -> Option<f64> {
        None
    }

    /// In how short a time (s) its damping brings the relative motion of two bodies to rest; `None`
    /// if it has none. Damping is explicit, so a longer step than about half of this shakes a bed.
    fn damping_time(_pair: &Self::Pair, _encounter: &Encounter) -> Option<f64> {
        None
    }

    /// How long (s) a surface wave runs through a grain of `radius` (m) and `density` (kg/m³); `None` if
    /// the law has no elastic constants. Bounds `time_step = "auto"`.
    fn wave_time(_pair: &Self::Pair, _radius: f64, _density: f64) -> Option<f64> {
        None
    }

    /// The widest gap (m) at which it still holds a contact together, for bodies of radius
    /// `radius_eff` (m) or less; 0 for a law that needs an overlap.
    fn reach(_pair: &Self::Pair, _radius_eff: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
impl Contact {
    /// One of 1 µm overlap at rest, along `normal`, between grains of some millimetres.
    pub(crate) fn pressed(normal: crate::math::Vec3) -> Self {
        let still = crate::math::Vec3::zeros();
        Self {
            normal,
            overlap: 1e-6,
            overlap_rate: 0.0,
            overlap_step: 0.0,
            slip_velocity: still,
            slip_step: still,
            relative_spin: still,
            relative_turn: still,
            inverse_radius_eff: 1e3,
            inverse_radius_eff_before: 1e3,
            inverse_mass_eff: 1e5,
            rolling_mobility: 1e9,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Vec3, cayley};

    #[test]
    fn a_spring_turns_with_its_contact_plane_and_keeps_its_length() {
        // The plane turns about the spring's own direction, which leaves it, and about the one across, which takes
        // it along.
        let spring = Vec3::new(3e-6, 0.0, 0.0);
        let about = |axis: Vec3| cayley(axis * 0.3);
        for axis in [Vec3::x(), Vec3::y()] {
            let turned = Contact::pressed(about(axis) * Vec3::z()).turn(spring);
            // A root and a quotient of numbers near one.
            assert!((turned - about(axis) * spring).norm() < 1e-15 * 3e-6 * 10.0, "{turned:?}");
        }
        // Along the normal nothing is left to turn.
        assert_eq!(Contact::pressed(Vec3::x()).turn(spring), Vec3::zeros());
    }
}
