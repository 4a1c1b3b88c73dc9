//! What a model of grains will cost, before anything is run.

use engine::clock::steps_in;
use engine::grains::Space;

use crate::model::GrainModel;
use crate::stability;

/// Memory per grain (byte), where a run has most: as it takes over a bed that has settled. A sphere has more
/// neighbours than a disc (`docs/campaigns.md`).
fn bytes_per_grain(space: Space) -> u64 {
    match space {
        Space::Planar => 1150,
        Space::Spatial => 2000,
    }
}

/// Memory that does not depend on the grains (byte).
const BYTES_FIXED: u64 = 16_000_000;
/// Speed of the engine on two cores (1/s).
const GRAIN_STEPS_PER_S: f64 = 2e7;
/// Speed of the engine on one thread beside another (1/s), where nothing was measured.
pub const RATE_PER_THREAD: f64 = 0.5 * GRAIN_STEPS_PER_S;

/// What one impact of a model will cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Grains in the bed.
    pub n_grains: u64,
    /// Impacts.
    pub n_conditions: usize,
    /// Steps of one impact at most; `None` when the law alone knows the step.
    pub steps: Option<u64>,
    /// Memory while running (byte).
    pub memory_bytes: u64,
    /// What of it the size of the container alone asks for (byte).
    pub container_bytes: u64,
    /// Time for one impact at most, the bed's preparation not counted (s).
    pub run_time_s: Option<f64>,
}

impl Estimate {
    /// The estimate for `model`.
    pub fn of(model: GrainModel<'_>) -> Self {
        let n_grains = model.n_grains();
        // At most `limits::STEPS`, so the cast is exact.
        let steps = stability::time_step(model).map(|step| steps_in(model.model.longest(), step));
        // Too large a number becomes the largest.
        let container_bytes = model.container_bytes() as u64;
        Self {
            n_grains,
            n_conditions: model.model.conditions().len(),
            steps,
            memory_bytes: n_grains
                .saturating_mul(bytes_per_grain(model.medium.space))
                .max(container_bytes)
                .saturating_add(BYTES_FIXED),
            container_bytes,
            run_time_s: steps.map(|steps| steps as f64 * n_grains as f64 / GRAIN_STEPS_PER_S),
        }
    }
}

/// Memory that this process may still take (byte), where the system says so: what is free, or what
/// the control group leaves if that is less.
pub fn available_memory_bytes() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let free = read("/proc/meminfo").and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
        Some(kilobytes.saturating_mul(1024))
    });
    let group = |limit: &str, used: &str| {
        let limit: u64 = read(limit)?.trim().parse().ok()?;
        let used: u64 = read(used)?.trim().parse().ok()?;
        Some(limit.saturating_sub(used))
    };
    let group = group("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current").or_else(|| {
        group(
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.usage_in_bytes",
        )
    });
    free.into_iter().chain(group).min()
}

/// Share of the available memory beyond which a model is refused.
pub const MEMORY_SHARE: f64 = 0.8;
