//! Beds and impacts that LAMMPS simulates: grains, contact law, rolling, time step and surface are those of another code.
//!
//! A run is one LAMMPS input. It drops grains through air from random places and removes the air. Once the grains rest, it
//! releases an intruder that touches the highest grain. The path of the intruder becomes a run of the set.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use configs::{BedSource, GrainModel, Material};
use engine::bed::random;
use engine::params::ParamTable;
use measurements::{MeasurementSet, SurfaceDefinition};
use rand::RngExt;
use rayon::prelude::*;
use runner::beds::{Lie, Record, STOPPED};

use super::super::chance::normal;
use super::hidden::{Hidden, LIGHTER};
use super::prepared::{DAMPED, Prepared, ROUGH, SMOOTH, SPREAD, UNROLLING};
use super::world::{Errors, SEEDS, seen};
use crate::speed::SpeedError;
use crate::speed::lammps::Lammps;

/// Speed (m/s) at which the mean grain falls through the air.
const FALL: f64 = 0.5;

/// Height of the region that grains fall from, over the height of the grains without pores.
const RAIN: f64 = 4.0;

/// Time (s) for which grains fall at that speed, and longest time after it until they rest.
const RAINING: f64 = 1.5;
const RESTING: f64 = 3.0;

/// Square of the speed (m²/s²) below which the fastest grain rests.
const AT_REST: f64 = 1e-8;

/// Share of their diameters that grains may overlap where they begin to fall.
const OVERLAP: f64 = 0.1;

/// Stiffness of the rolling spring over that of the normal spring, and its damping (kg/s).
const ROLLING: (f64, f64) = (0.5, 0.02);

/// Places over the width at which the height of the surface is taken.
const COLUMNS: usize = 2400;

/// Steps between two lines of the path.
const EVERY: usize = 2;

/// Standard deviation of the zero of depth of a set (m), and largest error of the zero of its clock (s): half a frame at
/// 500 a second.
pub(super) const LEVEL: f64 = 2e-4;
const CLOCK: f64 = 1e-3;

/// What grains do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Contacts {
    friction: f64,
    rolling: f64,
    /// Factor on both damping rates.
    damping: f64,
}

/// A world, in the words of LAMMPS.
#[derive(Clone, Debug)]
pub(super) struct World<'a> {
    model: GrainModel<'a>,
    settling: Contacts,
    impact: Contacts,
    /// Factor on the mass of grains.
    heavier: f64,
    /// Factor on gravity.
    lighter: f64,
    /// Half of the width of the spread of diameters, relative.
    spread: f64,
}

/// The end of a run: its path, and how its bed lay.
struct Hit {
    record: Record,
    lie: Lie,
}

impl<'a> World<'a> {
    /// `hidden` in the bed of `model`, which is `prepared`; none for what these inputs cannot say.
    pub(super) fn of(model: GrainModel<'a>, hidden: Hidden, prepared: Prepared) -> Option<Self> {
        let BedSource::Settle(settle) = &model.medium.bed.source else { return None };
        let own = model.medium.contact_law.params.get("friction");
        let plain = Contacts { friction: own, rolling: 0.0, damping: 1.0 };
        let friction = settle.preparation_friction.unwrap_or(own);
        let settling = Contacts { friction, ..plain };
        let mut world =
            Self { model, settling, impact: plain, heavier: 1.0, lighter: 1.0, spread: 0.0 };
        match prepared {
            Prepared::Alike => {}
            Prepared::Rough => world.settling.friction *= ROUGH,
            Prepared::Smooth => world.settling.friction *= SMOOTH,
            Prepared::Damped => world.settling.damping = DAMPED,
            Prepared::Unrolling => world.settling.rolling = UNROLLING,
            Prepared::Spread => world.spread = SPREAD,
            Prepared::Tapped => return None,
        }
        match hidden {
            Hidden::Nothing => {}
            Hidden::Unlisted => world.lighter = LIGHTER,
            Hidden::BedCandidate("grain-density", q) => world.heavier = 1.0 + q,
            Hidden::BedCandidate("rolling-resistance", q) => world.impact.rolling = q,
            Hidden::BedCandidate("grain-friction", q) => world.impact.friction *= 1.0 + q,
            Hidden::BedCandidate(..) => return None,
        }
        Some(world)
    }

    /// `repeats` runs under every condition of `set`, and how each of their beds lay; the inputs are run in `folder`.
    pub(super) fn measure(
        &self,
        lammps: &Lammps,
        set: &MeasurementSet,
        (repeats, seed): (usize, u64),
        folder: &Path,
    ) -> Result<(MeasurementSet, Vec<Lie>), SpeedError> {
        let hit = |number: usize| -> Result<Hit, SpeedError> {
            let condition = &set.conditions[number / repeats];
            let first = SEEDS as u64 * (1 + seed) + number as u64;
            let folder = folder.join(format!("run-{number}"));
            let hit = self.hit(lammps, (condition.speed, first), &folder);
            drop(fs::remove_dir_all(&folder));
            hit
        };
        let numbers = 0..repeats * set.conditions.len();
        let hits = numbers.into_par_iter().map(hit).collect::<Result<Vec<_>, _>>()?;
        let mut random = random(seed, "laboratory");
        let level = LEVEL * normal(&mut random);
        // LAMMPS knows the mean height of the surface; the set does not say that depths count from it.
        let mut set = MeasurementSet { surface: SurfaceDefinition::Mean, ..set.clone() };
        for (number, hit) in hits.iter().enumerate() {
            let errors = Errors { level, clock: CLOCK * random.random_range(-1.0..1.0) };
            let run = seen(&hit.record, (number / repeats, &set), (number, seed), errors);
            set.runs.push(run);
        }
        set.surface = SurfaceDefinition::shown_by(&set, set.coarsest_grains());
        Ok((set, hits.into_iter().map(|hit| hit.lie).collect()))
    }

    /// One impact at `speed` (m/s) on a bed of its own.
    fn hit(
        &self,
        lammps: &Lammps,
        (speed, seed): (f64, u64),
        folder: &Path,
    ) -> Result<Hit, SpeedError> {
        let at = |path: &Path| {
            let path = path.to_owned();
            move |source| SpeedError::File { path, source }
        };
        fs::create_dir_all(folder).map_err(at(folder))?;
        let path = folder.join(INPUT);
        fs::write(&path, self.input(speed, seed)).map_err(at(&path))?;
        lammps.read(folder, INPUT)?;
        let table = |name: &str| -> Result<(PathBuf, String), SpeedError> {
            let path = folder.join(name);
            let text = fs::read_to_string(&path).map_err(at(&path))?;
            Ok((path, text))
        };
        let lacks = |path: PathBuf, what: &str| SpeedError::Program {
            program: path,
            what: what.to_owned(),
            said: String::new(),
        };
        let (path, text) = table(BED)?;
        let grains = grains(&text).ok_or_else(|| lacks(path, "is no bed at rest"))?;
        let lie = self.lie(&grains);
        let (path, text) = table(PATH)?;
        let record = self.record(&text, (speed, &lie)).ok_or_else(|| lacks(path, "is no path"))?;
        Ok(Hit { record, lie })
    }

    fn input(&self, speed: f64, seed: u64) -> String {
        let medium = self.model.medium;
        let (width, gravity) = (medium.container.width, self.lighter * medium.gravity);
        let radius = self.radius();
        let mass = self.model.model.intruder.mass;
        let mut random = random(seed, "lammps");
        let mut number = || random.random_range(1..900_000_000_u32);
        let kinds = self.kinds();
        let solid: f64 = kinds.iter().map(|kind| kind.count as f64 * kind.area()).sum();
        let rain = RAIN * solid / width;
        let types = kinds.len();
        let intruder = types + 1;
        let mut grains = String::new();
        let mut weight = 0.0;
        for (at, kind) in kinds.iter().enumerate() {
            let (id, d) = (at + 1, kind.diameter);
            let (low, high) = ((1.0 - self.spread) * d, (1.0 + self.spread) * d);
            // A disc is a sphere to LAMMPS: its density is that of a sphere of its mass.
            let density = 6.0 * kind.mass * self.heavier / (PI * kind.mean_cube(self.spread));
            grains += &format!(
                "create_atoms {id} random {} {} rain overlap {} maxtry 5000\n\
                 variable d{id} atom random({low},{high},{})\n\
                 group kind{id} type {id}\nset group kind{id} diameter v_d{id}\n\
                 set group kind{id} density {density}\n",
                kind.count,
                number(),
                (1.0 - OVERLAP) * d,
                number(),
            );
            weight += kind.count as f64 * kind.mass * self.heavier;
        }
        let mean = weight / kinds.iter().map(|kind| kind.count as f64).sum::<f64>();
        let dt = self.model.time_step().unwrap_or(f64::NAN);
        let steps = |time: f64| (time / dt).ceil() as u64;
        let air = mean * gravity / FALL;
        let x = width * random.random_range(0.3..0.7);
        let params = &medium.contact_law.params;
        let pair = |contacts: Contacts| {
            format!(
                "pair_coeff 1*{types} 1*{types} {}\npair_coeff 1*{types} {intruder} {}\n\
                 pair_coeff {intruder} {intruder} {}\n",
                law(params, contacts),
                law(params, Contacts { rolling: 0.0, ..self.against("intruder_friction") }),
                law(params, Contacts { rolling: 0.0, ..self.against("intruder_friction") }),
            )
        };
        let wall = |contacts: Contacts| {
            format!(
                "fix bottom grains wall/gran granular {} yplane 0 NULL\n",
                law(params, contacts)
            )
        };
        let floor = Contacts { rolling: self.impact.rolling, ..self.against("wall_friction") };
        format!(
            "units si\ndimension 2\natom_style sphere\natom_modify map array\nboundary p fm p\nnewton off\n\
             region box block 0 {width} -0.01 {top} -0.003 0.003\ncreate_box {intruder} box\n\
             region rain block 0 {width} {radius} {rain} -0.003 0.003\n{grains}\
             group grains type 1:{types}\ncomm_modify vel yes\nneighbor {skin} bin\n\
             neigh_modify delay 0 every 1 check yes\npair_style granular\n{settling}{settling_wall}\
             timestep {dt}\nfix gravity all gravity {gravity} vector 0 -1 0\nfix motion all nve/sphere disc\n\
             fix plane all enforce2d\nfix air grains viscous {air}\nthermo 100000\nrun {raining}\nunfix air\n\
             variable fastest atom vx*vx+vy*vy\ncompute fastest grains reduce max v_fastest\n\
             variable still equal c_fastest\nfix rest all halt 100 v_still < {AT_REST} error continue\n\
             thermo_style custom step time c_fastest\nrun {resting}\nunfix rest\n\
             variable away atom \"(radius+{radius})^2-(x-{x})^2\"\n\
             variable top atom \"(v_away>0)*(y+sqrt(abs(v_away)))\"\ncompute top grains reduce max v_top\n\
             thermo_style custom step time c_top\nrun 0\nvariable start equal $(c_top)\n\
             create_atoms {intruder} single {x} ${{start}} 0\nset type {intruder} diameter {diameter}\n\
             set type {intruder} density {density}\ngroup intruder type {intruder}\n\
             velocity intruder set 0 -{speed} 0\n{impact}unfix bottom\n{impact_wall}\
             reset_timestep 0\nvariable t equal step*dt\n\
             variable x equal xcm(intruder,x)\nvariable y equal xcm(intruder,y)\n\
             variable vx equal vcm(intruder,x)\nvariable vy equal vcm(intruder,y)\n\
             dump bed grains custom 1 {BED} radius mass x y\ndump_modify bed format float %.17g\nrun 0\nundump bed\n\
             fix path all print {EVERY} \"${{t}},${{x}},${{y}},${{vx}},${{vy}}\" file {PATH} screen no\n\
             run {falling}\n",
            top = rain + 10.0 * radius,
            skin = 0.5 * radius,
            settling = pair(self.settling),
            settling_wall = wall(self.settling),
            raining = steps(RAINING),
            resting = steps(RESTING),
            diameter = 2.0 * radius,
            density = 0.75 * mass / (PI * radius * radius * radius),
            impact = pair(self.impact),
            impact_wall = wall(floor),
            falling = steps(self.model.model.run.duration),
        )
    }

    /// What grains and another body do to each other during the impact.
    fn against(&self, friction: &str) -> Contacts {
        let friction = self.model.medium.contact_law.params.get(friction);
        Contacts { friction, ..self.impact }
    }

    fn radius(&self) -> f64 {
        0.5 * self.model.model.intruder.params.get("diameter")
    }

    fn kinds(&self) -> Vec<Kind> {
        let BedSource::Settle(settle) = &self.model.medium.bed.source else { return Vec::new() };
        let kinds = settle.grains.iter().map(|kind| {
            let diameter = kind.sizes.moment(1);
            let area = 0.25 * PI * diameter * diameter;
            let mass = match kind.material {
                Material::Mass(mass) => mass,
                Material::Density(density) => density * area,
            };
            Kind { count: kind.count, diameter, mass }
        });
        kinds.collect()
    }

    /// How `grains` (radius, mass, x, y) lie; contacts are not counted.
    fn lie(&self, grains: &[[f64; 4]]) -> Lie {
        let width = self.model.medium.container.width;
        let column = |at: usize| {
            let x = width * (at as f64 + 0.5) / COLUMNS as f64;
            let top = grains.iter().filter_map(|&[radius, _, of, y]| {
                let apart = (x - of).abs();
                let apart = apart.min(width - apart);
                (apart < radius).then(|| y + (radius * radius - apart * apart).sqrt())
            });
            top.fold(0.0, f64::max)
        };
        let height = (0..COLUMNS).map(column).sum::<f64>() / COLUMNS as f64;
        let sum = |of: fn(&[f64; 4]) -> f64| grains.iter().map(of).sum::<f64>();
        Lie {
            packing_fraction: sum(|[radius, ..]| PI * radius * radius) / (width * height),
            height,
            bulk_density: sum(|[_, mass, ..]| *mass) / (width * height),
            mean_diameter: sum(|[radius, ..]| 2.0 * radius) / grains.len() as f64,
            coordination: f64::NAN,
        }
    }

    /// The impact whose path `text` is, on a bed that lies as `lie` says; `None` if it is not a path.
    fn record(&self, text: &str, (speed, lie): (f64, &Lie)) -> Option<Record> {
        let mut path: Vec<[f64; 5]> = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let numbers: Vec<f64> =
                line.split(',').map(|word| word.trim().parse().ok()).collect::<Option<_>>()?;
            let line: [f64; 5] = numbers.try_into().ok()?;
            // The state at the start is written by both of the last runs.
            if path.last().is_none_or(|last| line[0] > last[0]) {
                path.push(line);
            }
        }
        let [first, second, ..] = path[..] else { return None };
        let level = first[2];
        let turned = path.windows(2).position(|two| two[0][4] < 0.0 && two[1][4] >= 0.0);
        let slow = |line: &&[f64; 5]| libm::hypot(line[3], line[4]) < STOPPED * speed;
        let until = turned.map_or(path.len(), |at| at + 1);
        let depths = || path.iter().map(|line| level - line[2]);
        Some(Record {
            interval: second[0] - first[0],
            contact_height: level - self.radius() - lie.height,
            depth: depths().collect(),
            range: path.iter().map(|line| line[1] - first[1]).collect(),
            force: Vec::new(),
            stopping_time: turned.map(|at| path[at + 1][0]),
            slow_time: path.iter().find(slow).map(|line| line[0]),
            deepest: depths().take(until).fold(f64::NEG_INFINITY, f64::max),
            reached: 0.0,
            end: path.last()?[0],
            crater: None,
            impact_energy: 0.5 * self.model.model.intruder.mass * speed * speed,
            closure: 0.0,
            ledger: Vec::new(),
            grains: self.kinds().iter().map(|kind| kind.count).sum(),
            steps: (path.len() * EVERY) as u64,
            wall: 0.0,
        })
    }
}

/// Grains of one size and mass (m, kg).
struct Kind {
    count: u64,
    diameter: f64,
    mass: f64,
}

impl Kind {
    fn area(&self) -> f64 {
        0.25 * PI * self.diameter * self.diameter
    }

    /// Of diameters that are spread evenly by so much.
    fn mean_cube(&self, spread: f64) -> f64 {
        self.diameter.powi(3) * (1.0 + spread * spread)
    }
}

/// The file names of a run.
const INPUT: &str = "in.world";
const BED: &str = "bed.dump";
const PATH: &str = "path.csv";

/// The linear law of `params` with other `contacts`, as LAMMPS takes it.
fn law(params: &ParamTable, Contacts { friction, rolling, damping }: Contacts) -> String {
    let [stiffness, tangential, rate, tangential_rate] = [
        "normal_stiffness",
        "tangential_stiffness",
        "normal_damping_rate",
        "tangential_damping_rate",
    ]
    .map(|key| params.get(key));
    // Contacts keep as many numbers before the impact as during it: else LAMMPS would forget them all between the two.
    format!(
        "hooke {stiffness} {} tangential linear_history {tangential} {} {friction} \
         rolling sds {} {} {rolling} damping mass_velocity",
        damping * rate,
        tangential_rate / rate,
        ROLLING.0 * stiffness,
        ROLLING.1,
    )
}

/// Radius, mass and position of the grains of a dump; none for something else.
fn grains(dump: &str) -> Option<Vec<[f64; 4]>> {
    let (_, rows) = dump.split_once("ITEM: ATOMS")?;
    let numbers = |line: &str| -> Option<[f64; 4]> {
        let words = line.split_whitespace().map(|word| word.parse().ok());
        words.collect::<Option<Vec<f64>>>()?.try_into().ok()
    };
    rows.lines().skip(1).map(numbers).collect()
}

#[cfg(test)]
mod tests {
    use configs::Model;

    use super::*;
    use crate::benchmark::beds::Case;

    fn with(model: &Model, hidden: Hidden, prepared: Prepared) -> Option<World<'_>> {
        World::of(model.grains().expect("the model is of grains"), hidden, prepared)
    }

    #[test]
    fn what_is_hidden_acts_during_the_impact_alone_and_a_preparation_before_it_alone() {
        let model = Case::small(Hidden::Nothing, 0).model().unwrap();
        let rolling = Hidden::BedCandidate("rolling-resistance", 0.25);
        let input = with(&model, rolling, Prepared::Rough).unwrap().input(1.0, 7);
        let (before, during) = input.split_once("create_atoms 3 single").unwrap();
        let settling = "0.66 rolling sds 100 0.02 0 damping mass_velocity";
        assert!(before.contains(settling) && !before.contains("0.02 0.25"), "{before}");
        let grains = "pair_coeff 1*2 1*2 hooke 200 1500 tangential linear_history 200 \
                      0.3333333333333333 0.3 rolling sds 100 0.02 0.25 damping mass_velocity";
        assert!(during.contains(grains), "{during}");
        let intruder = "pair_coeff 1*2 3 hooke 200 1500 tangential linear_history 200 \
                        0.3333333333333333 0.3 rolling sds 100 0.02 0 damping mass_velocity";
        assert!(during.contains(intruder), "{during}");
    }

    #[test]
    fn every_grain_has_the_mass_of_the_model_whether_sizes_are_spread_or_not() {
        let model = Case::small(Hidden::Nothing, 0).model().unwrap();
        for (prepared, heavier) in [(Prepared::Spread, 1.0), (Prepared::Alike, 1.4)] {
            let hidden = Hidden::BedCandidate("grain-density", heavier - 1.0);
            let world = with(&model, hidden, prepared).unwrap();
            let input = world.input(1.0, 7);
            let density: f64 = input
                .split_once("set group kind1 density ")
                .unwrap()
                .1
                .lines()
                .next()
                .unwrap()
                .parse()
                .unwrap();
            // The mean of the cube of a diameter that is spread evenly by s is 1 + s² times that of the mean.
            let cube = 0.0045_f64.powi(3) * (1.0 + world.spread * world.spread);
            let mass = density * PI / 6.0 * cube;
            assert!((mass / (heavier * 4.9e-5) - 1.0).abs() < 1e-12, "{mass}");
        }
    }

    #[test]
    fn a_tapped_bed_and_other_effects_are_no_worlds_of_lammps() {
        let model = Case::small(Hidden::Nothing, 0).model().unwrap();
        assert!(with(&model, Hidden::Nothing, Prepared::Tapped).is_none());
        assert!(with(&model, Hidden::BedCandidate("pore-air", 5.0), Prepared::Alike).is_none());
    }

    #[test]
    fn one_grain_lies_as_high_as_its_area_over_the_width() {
        let model = Case::small(Hidden::Nothing, 0).model().unwrap();
        let world = with(&model, Hidden::Nothing, Prepared::Alike).unwrap();
        // Across the period, resting on the bottom: a column above the half disc below its middle counts whole.
        let dump = "ITEM: TIMESTEP\n0\nITEM: ATOMS radius mass x y\n0.01 0.004 0.119 0.01\n";
        let lie = world.lie(&grains(dump).unwrap());
        let under = 0.01 * 0.02 + 0.5 * PI * 1e-4;
        assert!((lie.height * 0.12 / under - 1.0).abs() < 1e-3, "{lie:?}");
        assert!((lie.packing_fraction - PI * 1e-4 / under).abs() < 1e-3, "{lie:?}");
        assert!((lie.bulk_density - 0.004 / under).abs() < 0.02, "{lie:?}");
        assert!(grains("ITEM: TIMESTEP\n0\n").is_none() && grains("ITEM: ATOMS\n1 2\n").is_none());
    }

    #[test]
    fn a_path_is_a_depth_below_first_contact_and_stops_where_the_intruder_turns() {
        let model = Case::small(Hidden::Nothing, 0).model().unwrap();
        let world = with(&model, Hidden::Nothing, Prepared::Alike).unwrap();
        let lie = Lie {
            packing_fraction: 0.8,
            height: 0.08,
            bulk_density: 1.0,
            mean_diameter: 0.005,
            coordination: f64::NAN,
        };
        let path = "# title\n0,0.05,0.092,0,-1\n0,0.05,0.092,0,-1\n0.0001,0.05,0.0919,0,-0.5\n\
                    0.0002,0.051,0.0918,0.01,-0.01\n0.0003,0.051,0.0919,0,0.2\n0.0004,0.051,0.09,0,-3\n";
        let record = world.record(path, (1.0, &lie)).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(record.interval, 1e-4) && record.depth.len() == 5);
        assert!(near(record.contact_height, 0.002) && near(record.range[2], 0.001));
        assert!(near(record.deepest, 0.0002), "what it does after it turned is no depth");
        assert_eq!(record.stopping_time, Some(0.0003));
        assert_eq!(record.slow_time, Some(0.0002));
        assert!(world.record("0,0.05,0.09,0\n", (1.0, &lie)).is_none());
        assert!(world.record("", (1.0, &lie)).is_none());
    }
}
