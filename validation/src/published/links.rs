//! Impacts of the two-link chain under the resistive-force law, of which the article states trends alone.
//!
//! Sizes, mass, speeds, angles and two of four coefficients are assumed (`docs/validation.md`).

use configs::{LoadOptions, Model, ModelSource};
use resistive::{Assembly, Recorder, State};

use super::row::PublishedError;

/// Assumed speeds of the tips (m/s).
pub const SPEEDS: [f64; 3] = [1.5, 2.0, 2.5];

/// Assumed pairs of angles to the vertical (deg): equal ones first.
pub const ANGLES: [[f64; 2]; 2] = [[30.0, -30.0], [20.0, -40.0]];

/// Strength of gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// Time between two samples (s).
const INTERVAL: f64 = 1e-4;

/// One link in an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkCourse {
    /// Largest depth of its tip (m).
    pub depth: f64,
    /// From the first contact of its tip to its stop (s).
    pub time: f64,
    /// Energy given to the bed (J).
    pub given: f64,
    /// After its contact, the time from which on static force is the greater one (s).
    pub overtaken: f64,
    /// Share of the dynamic force in both at the stop.
    pub dynamic_at_stop: f64,
}

/// A chain in an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainCourse {
    /// By link.
    pub links: [LinkCourse; 2],
    /// Largest ratio of kinetic to potential energy, heights from the surface.
    pub ratio: f64,
}

/// The chain at `angles` (deg) whose tips come down with `speed` (m/s).
///
/// # Errors
/// If it cannot be integrated, or does not stop.
pub fn chain(angles: [f64; 2], speed: f64) -> Result<ChainCourse, PublishedError> {
    let text = model_text(angles, speed);
    let source = ModelSource::Text { name: "two-link chain".to_owned(), text, folder: ".".into() };
    let model = Model::load(source, &LoadOptions::default())?.model;
    let missing = |what: &str| PublishedError::Missing(format!("the two-link chain {what}"));
    let resistive = model.resistive().ok_or_else(|| missing("is no force law"))?;
    let impact = resistive.impact(&model.conditions()[0]);
    let assembly = impact.assembly();
    let (mut samples, mut ratio) = (Vec::new(), 0.0_f64);
    let mut recorder = Recorder::new(&impact, INTERVAL, |sample| {
        let forces = [0, 1].map(|part| {
            let part = &sample.parts[part];
            (part.dynamic.norm(), part.friction.norm())
        });
        let energies = [0, 1].map(|part| energies(assembly, part, sample.state));
        let potential = energies[0].1 + energies[1].1;
        ratio = ratio.max((energies[0].0 + energies[1].0) / potential.max(f64::MIN_POSITIVE));
        samples.push((sample.time, forces));
    });
    let ending = impact.run(model.run.duration, &mut recorder)?;
    let given = *recorder.given();
    let link = |part: usize| {
        let stop = &ending.parts[part];
        let (contact, end) = (stop.contact?, stop.vertical?);
        let own: Vec<(f64, (f64, f64))> = samples
            .iter()
            .filter(|(time, _)| *time > contact && *time <= end)
            .map(|(time, forces)| (time - contact, forces[part]))
            .collect();
        let led = own.iter().rev().find(|(_, (dynamic, friction))| dynamic > friction);
        let (_, (dynamic, friction)) = own.last()?;
        Some(LinkCourse {
            depth: stop.depth,
            time: end - contact,
            given: given[part],
            overtaken: led.map_or(0.0, |(time, _)| *time),
            dynamic_at_stop: dynamic / (dynamic + friction),
        })
    };
    let links = link(0).zip(link(1)).ok_or_else(|| missing("does not stop"))?;
    Ok(ChainCourse { links: [links.0, links.1], ratio })
}

/// Kinetic and potential energy (J) of a link, the latter above the surface.
fn energies(assembly: &dyn Assembly, part: usize, state: &State) -> (f64, f64) {
    let [translation, rotation] = assembly.kinetic_energy(part, state);
    let (height, mass) = assembly.weight_at(part, state);
    (translation + rotation, mass * GRAVITY * height)
}

/// Two links of aluminium in dry sand; coefficients in the middle of what may be assumed.
fn model_text([one, two]: [f64; 2], speed: f64) -> String {
    format!(
        "[run]\nname = \"two-link-chain\"\nduration = \"2 s\"\n\
         [medium]\nkind = \"resistive-force\"\nbulk_density = \"1600 kg/m^3\"\ngravity = \"{GRAVITY} m/s^2\"\n\
         [resistance]\nname = \"link\"\ndrag = 3.0\nhorizontal = 5.0\nplunging = 10.0\nplunging_exponent = 1.4\n\
         [intruder]\nshape = \"two-link-chain\"\nlength = \"0.2 m\"\ndiameter = \"12.7 mm\"\nmass = \"136.8 g\"\n\
         link_angle_1 = \"{one:?} deg\"\nlink_angle_2 = \"{two:?} deg\"\n\
         [impact]\nspeed = \"{speed:?} m/s\"\nangle = \"90 deg\"\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_is_that_of_the_document() {
        let course = chain(ANGLES[0], SPEEDS[0]).expect("an impact");
        assert!((course.links[0].depth - 0.0424).abs() < 5e-5, "{course:?}");
        assert!((course.links[1].time - 0.0409).abs() < 5e-5, "{course:?}");
        assert!((course.links[0].given + course.links[1].given - 0.211).abs() < 5e-4, "{course:?}");
    }
}
