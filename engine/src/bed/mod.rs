//! How a bed is made: grains at random without overlap, grown in place or not, settled under gravity until at rest; and
//! what can be said of a bed that is.

mod fill;
mod inflate;
mod memory;
mod report;
mod rest;
mod settling;
mod sizes;
mod tapping;

use rand::SeedableRng;
use rand_pcg::Pcg64;

pub use fill::{GrainKind, fill};
pub use inflate::{inflate, inflation_range};
pub use memory::container_bytes;
pub use report::{BedReport, surface_height};
pub use settling::{SavedSettling, Settling};
pub use sizes::SizeDistribution;

/// A generator of random numbers for one purpose: the same for the same seed and name, whatever
/// else a run draws.
pub fn random(seed: u64, purpose: &str) -> Pcg64 {
    let hash =
        blake3::Hasher::new().update(&seed.to_le_bytes()).update(purpose.as_bytes()).finalize();
    Pcg64::from_seed(*hash.as_bytes())
}
