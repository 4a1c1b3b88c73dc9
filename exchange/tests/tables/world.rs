//! Drops of a ball by a law of our own, integrated here: no code of plunge takes part.

/// Gravity (m/s²).
pub(crate) const GRAVITY: f64 = 9.81;

/// Mass (kg) and the two coefficients of the force `b v² + k z`, with a constant part (kg/m, N/m, N).
const MASS: f64 = 0.067;
const LAW: [f64; 3] = [1.6, 35.0, 0.5];

/// Diameter (m).
const DIAMETER: f64 = 0.0254;

/// What of the ball the bed meets: all of it from first contact on, or its section in the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meets {
    Whole,
    Section,
}

impl Meets {
    fn share(self, depth: f64) -> f64 {
        match self {
            Self::Section if depth < 0.5 * DIAMETER => {
                4.0 * depth.max(0.0) * (DIAMETER - depth) / (DIAMETER * DIAMETER)
            }
            _ => 1.0,
        }
    }
}

/// Step (s).
const STEP: f64 = 1e-5;

/// A drop as a camera sees it.
#[derive(Clone, Debug)]
pub(crate) struct Drop {
    /// True time of first contact (s).
    pub(crate) contact: f64,
    /// True speed there (m/s).
    pub(crate) speed: f64,
    /// Times (s) and heights of the lowest point above the surface (m).
    pub(crate) readings: Vec<(f64, f64)>,
}

/// How a camera looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera {
    /// Frames per second (1/s).
    pub(crate) rate: f64,
    /// Time that the body is held (s), and that of the whole clip (s).
    pub(crate) hold: f64,
    pub(crate) duration: f64,
    /// Error of a reading (m).
    pub(crate) noise: f64,
    pub(crate) seed: u64,
}

impl Camera {
    pub(crate) const USUAL: Self =
        Self { rate: 650.0, hold: 0.2, duration: 0.9, noise: 1e-4, seed: 1 };
}

/// Numbers that are nearly normal, of variance 1.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// A ball that is held at `height` (m) above the surface, falls, and is stopped by the bed, whose coefficients
/// scatter by 3 % from run to run.
pub(crate) fn drop(height: f64, camera: Camera) -> Drop {
    drop_into(Meets::Whole, height, camera)
}

/// The same where the bed meets `meets` of the ball.
pub(crate) fn drop_into(meets: Meets, height: f64, camera: Camera) -> Drop {
    drop_onto(1.0, meets, height, camera)
}

/// The same onto a bed that is so many times as hard.
pub(crate) fn drop_onto(hard: f64, meets: Meets, height: f64, camera: Camera) -> Drop {
    let mut noise = Noise(camera.seed.wrapping_mul(7919).wrapping_add(17));
    let [b, k, c] = LAW.map(|one| hard * one * (1.0 + 0.03 * noise.normal()));
    let fall = (2.0 * height / GRAVITY).sqrt();
    let contact = camera.hold + fall;
    let speed = (2.0 * GRAVITY * height).sqrt();
    let mut depths = vec![0.0];
    let (mut depth, mut velocity) = (0.0, speed);
    while velocity > 0.0 {
        let pull = |v: f64, z: f64| GRAVITY - (meets.share(z) * (b * v * v + c) + k * z) / MASS;
        let middle = velocity + 0.5 * STEP * pull(velocity, depth);
        depth += STEP * middle;
        velocity += STEP * pull(middle, depth - 0.5 * STEP * middle);
        depths.push(depth);
    }
    let at = |t: f64| match t {
        t if t <= camera.hold => height,
        t if t <= contact => height - 0.5 * GRAVITY * (t - camera.hold) * (t - camera.hold),
        t => {
            let place = ((t - contact) / STEP).min((depths.len() - 1) as f64);
            let low = (place as usize).min(depths.len() - 2);
            let share = place - low as f64;
            -(depths[low] + share * (depths[low + 1] - depths[low]))
        }
    };
    let frames = (camera.duration * camera.rate) as usize;
    let reading = |frame: usize| {
        let t = frame as f64 / camera.rate;
        (t, at(t) + camera.noise * noise.normal())
    };
    Drop { contact, speed, readings: (0..frames).map(reading).collect() }
}
