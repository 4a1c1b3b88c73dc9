//! How attraction along the normal is held and booked, whatever its law.

use engine::contact::{Contact, Response};

/// Attraction at one overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    /// What it adds to F_n (N); below zero where it attracts.
    pub(crate) force: f64,
    /// What friction is measured by in addition to F_n (N).
    pub(crate) adhesive_force: f64,
    /// Energy (J) beyond that at first touch, whose derivative by the overlap is the force.
    pub(crate) stored: f64,
}

/// What a contact remembers of its attraction; zero while there is none.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Bond {
    /// One while it attracts.
    bound: f64,
    /// (N).
    force: f64,
    /// (J).
    stored: f64,
}

#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Energy {
    pub(crate) stored: f64,
    pub(crate) dissipated: f64,
}

impl Bond {
    /// Whether the two attract already.
    pub(crate) fn is_bound(&self) -> bool {
        self.bound > 0.0
    }

    /// Applies `pull`, or lets go where it is `None`.
    ///
    /// What was stored when a bond breaks is dissipated. Where the force jumps, at touch and release,
    /// its work over the step is known to half of the step only: that half, of either sign, goes with it.
    #[inline(always)]
    pub(crate) fn act(
        &mut self,
        pull: Option<Pull>,
        contact: &Contact,
        response: &mut Response,
        energy: &mut Energy,
    ) {
        let Some(pull) = pull else {
            if self.is_bound() {
                energy.dissipated += self.stored + 0.5 * self.force * contact.overlap_step;
            }
            *self = bytemuck::Zeroable::zeroed();
            return;
        };
        if !self.is_bound() {
            energy.dissipated += 0.5 * pull.force * contact.overlap_step - pull.stored;
        }
        energy.stored += pull.stored;
        *self = Self { bound: 1.0, force: pull.force, stored: pull.stored };
        response.normal_force += pull.force;
        response.adhesive_force += pull.adhesive_force;
        response.holds = true;
    }
}
