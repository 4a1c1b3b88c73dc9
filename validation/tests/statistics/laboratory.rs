//! Measurements in the world: repeats whose beds differ, seen by a camera.

use measurements::{
    Bed, Condition, Frame, Geometry, Instrument, Kind, MeasurementSet, Role, Run, StopDefinition,
};
use rand::RngExt;
use rand_pcg::Pcg64;
use validation::benchmark::chance::normal;

use crate::world::{Effect, GRAVITY, Impact, Setting, TRUTH};

/// What is measured, and how well.
#[derive(Clone)]
pub(crate) struct Laboratory {
    pub(crate) settings: Vec<Setting>,
    /// How many of the last settings are held out.
    pub(crate) holdout: usize,
    pub(crate) repeats: usize,
    pub(crate) kind: Kind,
    /// What nature does beyond the two-term law.
    pub(crate) hidden: Vec<(Effect, f64)>,
    /// Scatter of the coefficients and of the force along the path.
    pub(crate) tau_coefficient: f64,
    pub(crate) tau_path: f64,
    /// Spacing of the grain-scale force (m); none for six nodes from the surface to the end.
    pub(crate) spacing: Option<f64>,
    pub(crate) camera: f64,
}

impl Default for Laboratory {
    /// Twelve settings of two spheres, five repeats, a bed that scatters by 5 and 12 %.
    fn default() -> Self {
        let setting = |speed, angle, mass| Setting { speed, angle, mass, diameter: 0.0254 };
        let (steel, light) = (0.0667, 0.03);
        Self {
            settings: vec![
                setting(0.8, 90.0, steel),
                setting(0.8, 35.0, steel),
                setting(1.6, 60.0, steel),
                setting(1.6, 90.0, light),
                setting(2.6, 90.0, steel),
                setting(2.6, 35.0, steel),
                setting(2.6, 60.0, light),
                setting(3.4, 60.0, steel),
                setting(1.2, 45.0, light),
                setting(3.4, 35.0, light),
                setting(2.0, 45.0, steel),
                setting(3.0, 75.0, light),
            ],
            holdout: 2,
            repeats: 5,
            kind: Kind::Trajectory,
            hidden: Vec::new(),
            tau_coefficient: 0.05,
            tau_path: 0.12,
            spacing: Some(0.008),
            camera: 1e-4,
        }
    }
}

impl Laboratory {
    pub(crate) fn hiding(effect: Effect, amplitude: f64) -> Self {
        Self { hidden: vec![(effect, amplitude)], ..Self::default() }
    }

    /// Likewise, in beds that scatter by 1 and 2.5 %: errors on held-out conditions are well above their noise.
    pub(crate) fn quiet(effect: Effect, amplitude: f64) -> Self {
        Self { tau_coefficient: 0.01, tau_path: 0.025, ..Self::hiding(effect, amplitude) }
    }

    /// The measurements, drawn with `seed`.
    pub(crate) fn measure(&self, seed: u64) -> MeasurementSet {
        let mut runs = Vec::new();
        for condition in 0..self.settings.len() {
            let mut random = Pcg64::new(u128::from(seed), condition as u128);
            for repeat in 0..self.repeats {
                runs.push(self.run(condition, repeat, &mut random));
            }
        }
        let fit = self.settings.len() - self.holdout;
        let conditions = self.settings.iter().enumerate();
        MeasurementSet {
            instrument: Instrument {
                rate: Some(650.0),
                position_sigma: Some(1e-4),
                speed_sigma_rel: Some(0.01),
                level_sigma: Some(2e-4),
                // One bed for all conditions.
                session_sigma_rel: Some(0.0),
                ..Instrument::default()
            },
            stop: StopDefinition::SpeedFivePercent,
            runs,
            ..MeasurementSet::new(
                "world",
                self.kind,
                Bed {
                    grain_diameter: Some(8e-4),
                    ..Bed::new(Geometry::Spatial, Some(1480.0), GRAVITY)
                },
                conditions
                    .map(|(at, setting)| {
                        condition(at, setting, if at < fit { Role::Fit } else { Role::Holdout })
                    })
                    .collect(),
            )
        }
    }

    fn run(&self, condition: usize, repeat: usize, random: &mut Pcg64) -> Run {
        let setting = self.settings[condition];
        let mean = self.impact(setting, &[]).path(2.5e-4).expect("the mean bed stops a sphere");
        let (nodes, reach) = match self.spacing {
            Some(spacing) => ((0.25 / spacing) as usize, 0.25),
            None => (6, mean.stop.0),
        };
        let along: Vec<f64> = (0..nodes).map(|_| self.tau_path * normal(random)).collect();
        let sideways: Vec<f64> =
            (0..nodes.div_ceil(2)).map(|_| 0.5 * self.tau_path * normal(random)).collect();
        let impact = Impact {
            coefficients: TRUTH.map(|c| c * libm::exp(self.tau_coefficient * normal(random))),
            speed: 0.01 * normal(random),
            level: 2e-4 * normal(random),
            sideways: &sideways,
            reach,
            ..self.impact(setting, &along)
        };
        let path = impact.path(2.5e-4).expect("a bed stops a sphere");
        let mut read = |value: f64| value + self.camera * normal(random);
        let frames = (-6..160).map(|k| {
            let t = f64::from(k) / 650.0;
            let (z, x) = path.at(t);
            Frame { t, z: read(z), x: read(x), sigma: None }
        });
        let frames = if self.kind == Kind::Trajectory { frames.collect() } else { Vec::new() };
        let (final_z, final_x) = (read(path.stop.0), read(path.stop.1));
        let late = (random.random::<f64>() - 0.5) / 650.0;
        Run {
            repeat: Some(repeat as i64),
            stop_time: Some(path.stop_time + late),
            final_z: Some(final_z),
            final_x: (setting.angle < 90.0).then_some(final_x),
            frames,
            ..Run::new(format!("{condition}-{repeat}"), condition)
        }
    }

    fn impact<'a>(&'a self, setting: Setting, along: &'a [f64]) -> Impact<'a> {
        Impact {
            setting,
            coefficients: TRUTH,
            effects: &self.hidden,
            speed: 0.0,
            level: 0.0,
            along,
            sideways: &[],
            reach: 1.0,
        }
    }
}

fn condition(at: usize, setting: &Setting, role: Role) -> Condition {
    Condition {
        role,
        angle_deg: setting.angle,
        ..Condition::straight_down(
            format!("c{at:02}"),
            ("sphere", setting.diameter, setting.mass),
            setting.speed,
        )
    }
}
