//! The input script.

use configs::engine::grains::Space;
use configs::engine::simulation::Simulation;
use configs::{GrainModel, SidesKind};

use super::data::intruder_id;
use super::law::Contacts;
use super::{DATA, INPUT};

/// How far LAMMPS looks beyond touching grains for neighbours, in mean grain diameters: the fastest of
/// several tries on beds of discs and of spheres.
const SKIN: f64 = 0.19;

/// Time between two lines about the intruder (s), as in the log of plunge to the eye.
const EVERY: f64 = 1e-4;

/// The text of the input script.
pub(super) fn text(model: GrainModel<'_>, simulation: &Simulation, contacts: &Contacts) -> String {
    let space = model.medium.space;
    let grains = &simulation.bed().grains;
    let mean_diameter = 2.0 * grains.radius.iter().sum::<f64>() / grains.len() as f64;
    let dt = simulation.clock().dt;
    let sides = if model.medium.container.sides == SidesKind::Periodic { "p" } else { "m" };
    let (up, boundary, processors, planar_dimension) = match space {
        Space::Planar => ("y", format!("{sides} fm p"), "* 1 1", "dimension 2\n"),
        Space::Spatial => ("z", format!("{sides} {sides} fm"), "* * 1", ""),
    };
    let lines = [
        header(model, space),
        format!(
            "variable steps index {}\nvariable warm_up index 0\nvariable every index {}\n\
             variable skin index {:.3e}\n",
            simulation.last_step(),
            (EVERY / dt).round().max(1.0),
            SKIN * mean_diameter
        ),
        format!(
            "units si\n{planar_dimension}atom_style sphere\natom_modify map array\n\
             boundary {boundary}\nnewton off\nprocessors {processors}\n\
             neighbor ${{skin}} multi\nneigh_modify delay 0 every 1 check yes one 20000 page 400000\n\
             comm_modify mode multi vel yes\n\
             read_data {DATA}\n\
             group grains type 1\ngroup intruder type 2\n"
        ),
        format!("{}\n", contacts.pair.join("\n")),
        format!("timestep {dt:?}\n"),
        gravity(model.medium.gravity, space),
        walls(model, space, contacts),
        integrators(model, space),
        output(simulation, up, space),
        "if \"${warm_up} > 0\" then \"run ${warm_up}\"\nrun ${steps}\n".to_owned(),
        report(space),
    ];
    lines.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn header(model: GrainModel<'_>, space: Space) -> String {
    let plane = match space {
        Space::Planar => "# x and y are x and z (up) of plunge.\n",
        Space::Spatial => "",
    };
    format!(
        "# {name}, from plunge {version}, for LAMMPS of 22 Jul 2025 or later: lmp -in {INPUT}\n\
         # -var steps N, -var warm_up N (steps before those), -var skin L (m),\n\
         # -var every N (steps between lines of intruder.csv)\n\
         {plane}\
         # What differs: contacts start without tangential springs; a sliding contact keeps the viscous\n\
         # part of its tangential force; there is no energy ledger; the run ends after `steps`, at rest\n\
         # or not. LAMMPS does not go on exactly after a restart, nor after a second `run`.\n",
        name = model.model.run.name,
        version = env!("CARGO_PKG_VERSION"),
    )
}

fn gravity(gravity: f64, space: Space) -> String {
    let down = match space {
        Space::Planar => "0 -1 0",
        Space::Spatial => "0 0 -1",
    };
    match gravity > 0.0 {
        true => format!("fix gravity all gravity {gravity:?} vector {down}\n"),
        false => String::new(),
    }
}

/// The walls, which the intruder does not feel.
fn walls(model: GrainModel<'_>, space: Space, contacts: &Contacts) -> String {
    let container = &model.medium.container;
    let wall = |name: &str, plane: &str, from: &str, to: &str| {
        format!("fix {name} grains wall/gran {} {plane} {from} {to}\n", contacts.wall)
    };
    let side =
        |name: &str, plane: &str, length: f64| wall(name, plane, "0", &format!("{length:?}"));
    let mut text = match space {
        Space::Planar => wall("bottom", "yplane", "0", "NULL"),
        Space::Spatial => wall("bottom", "zplane", "0", "NULL"),
    };
    if container.sides != SidesKind::Periodic {
        text.push_str(&side("sides", "xplane", container.width));
        if space == Space::Spatial {
            text.push_str(&side("front_and_back", "yplane", container.depth));
        }
    }
    text
}

/// In a plane grains have the moment of inertia of discs, and the intruder that of its shape.
fn integrators(model: GrainModel<'_>, space: Space) -> String {
    if space == Space::Spatial {
        return "fix motion all nve/sphere\n".to_owned();
    }
    let of_intruder = if model.model.intruder.shape.name == "disc" { " disc" } else { "" };
    format!(
        "fix motion grains nve/sphere disc\n\
         fix motion_of_intruder intruder nve/sphere{of_intruder}\n\
         fix plane all enforce2d\n"
    )
}

/// The components of position and velocity: their names here, and along which axis of LAMMPS they lie.
fn components(space: Space) -> &'static [(&'static str, &'static str)] {
    match space {
        Space::Planar => &[("x", "x"), ("z", "y")],
        Space::Spatial => &[("x", "x"), ("y", "y"), ("z", "z")],
    }
}

fn output(simulation: &Simulation, up: &str, space: Space) -> String {
    let id = intruder_id(simulation);
    let mut text = "variable time equal step*dt\n".to_owned();
    for (name, axis) in components(space) {
        text.push_str(&format!("variable {name} equal xcm(intruder,{axis})\n"));
        text.push_str(&format!("variable v{name} equal v{axis}[{id}]\n"));
    }
    let names = |of: &str, unit: &str| {
        let names = components(space).iter().map(|(name, _)| format!("{of}{name}_{unit}"));
        names.collect::<Vec<_>>().join(",")
    };
    text.push_str(&format!(
        "fix log intruder print ${{every}} \"${{time}},{}\" file intruder.csv screen no &\n  \
         title \"time_s,{},{}\"\n",
        values(space),
        names("", "m"),
        names("v", "m_per_s")
    ));
    text.push_str(&format!(
        "thermo 10000\nthermo_style custom step time v_{0} v_v{0}\n",
        if up == "y" { "z" } else { up }
    ));
    text
}

/// Position and velocity, to be filled in by LAMMPS.
fn values(space: Space) -> String {
    let names = components(space).iter().map(|(name, _)| *name);
    let positions = names.clone().map(|name| format!("${{{name}}}"));
    let velocities = names.map(|name| format!("${{v{name}}}"));
    positions.chain(velocities).collect::<Vec<_>>().join(",")
}

/// Says where the intruder is at the end.
fn report(space: Space) -> String {
    format!("print \"intruder at the end: ${{time}},{}\"\n", values(space))
}
