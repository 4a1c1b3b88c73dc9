//! How attraction along the normal is held and booked, whatever its law.

use engine::contact::{Contact, Response};
use engine::lanes::Lanes;

/// Attraction at one overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull<R> {
    /// What it adds to F_n (N); below zero where it attracts.
    pub(crate) force: R,
    /// What friction is measured by in addition to F_n (N).
    pub(crate) adhesive_force: R,
    /// Energy (J) beyond that at first touch, whose derivative by the overlap is the force.
    pub(crate) stored: R,
}

engine::record! {
    /// What a contact remembers of its attraction; zero while there is none.
    pub(crate) struct Bond<R> {
        /// One while it attracts.
        bound: R,
        /// (N).
        force: R,
        /// (J).
        stored: R,
    }
}

engine::record! {
    /// One number (J) per channel.
    pub(crate) struct Energy<R> {
        pub(crate) stored: R,
        pub(crate) dissipated: R,
    }
}

impl<R: Lanes> Bond<R> {
    /// Whether the two attract already.
    #[inline(always)]
    pub(crate) fn is_bound(&self) -> R::Mask {
        self.bound.simd_gt(R::zero())
    }

    /// Applies `pull` where the mask `holds` says so, and lets go elsewhere.
    ///
    /// What was stored when a bond breaks is dissipated. Where the force jumps, at touch and release,
    /// its work over the step is known to half of the step only: that half, of either sign, goes with it.
    #[inline(always)]
    pub(crate) fn act<const N: usize>(
        &mut self,
        (holds, pull): (R::Mask, Pull<R>),
        contact: &Contact<R, N>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        let (zero, half) = (R::zero(), R::splat(0.5));
        let (was_bound, before) = (self.is_bound(), *self);
        let breaks = before.stored + half * before.force * contact.overlap_step;
        energy.dissipated += breaks.select(was_bound & !holds, zero);
        let forms = half * pull.force * contact.overlap_step - pull.stored;
        energy.dissipated += forms.select(holds & !was_bound, zero);
        let [bound, force, stored] =
            [R::one(), pull.force, pull.stored].map(|value| value.select(holds, zero));
        *self = Self { bound, force, stored };
        energy.stored += stored;
        response.normal_force += force;
        response.adhesive_force += pull.adhesive_force.select(holds, zero);
        response.holds = response.holds | holds;
    }
}
