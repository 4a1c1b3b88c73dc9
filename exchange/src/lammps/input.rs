//! The input script.

use configs::engine::grains::Space;
use configs::engine::simulation::Simulation;
use configs::{GrainModel, SidesKind};

use super::data::intruder_id;
use super::law::Contacts;
use super::{DATA, DUMP, INPUT, INTRUDER_TABLE};

/// How far LAMMPS looks beyond touching grains for neighbours, in mean grain diameters: the fastest of
/// several tries on beds of discs and of spheres.
const SKIN: f64 = 0.19;

/// Time between two lines about the intruder (s), as in the log of plunge to the eye.
const EVERY: f64 = 1e-4;

/// What LAMMPS keeps of each atom in a frame.
const OF_ATOMS: &str = "id type radius mass x y z vx vy vz fx fy fz";

/// The text of the input script.
pub(super) fn text(model: GrainModel<'_>, simulation: &Simulation, contacts: &Contacts) -> String {
    let space = model.medium.space;
    let grains = &simulation.bed().grains;
    let mean_diameter = 2.0 * grains.radius.iter().sum::<f64>() / grains.len() as f64;
    let dt = simulation.clock().dt;
    let frame = 1.0 / model.model.log.frames_per_s;
    let sides = if model.medium.container.sides == SidesKind::Periodic { "p" } else { "m" };
    let (boundary, processors, planar_dimension) = match space {
        Space::Planar => (format!("{sides} fm p"), "* 1 1", "dimension 2\n"),
        Space::Spatial => (format!("{sides} {sides} fm"), "* * 1", ""),
    };
    let lines = [
        header(model, space),
        format!(
            "variable steps index {}\nvariable warm_up index 0\nvariable every index {}\n\
             variable frame index {}\nvariable skin index {:.3e}\n",
            simulation.last_step(),
            every(dt),
            every(dt) * (frame / (every(dt) as f64 * dt)).round().max(1.0) as u64,
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
        output(simulation, space),
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
         # -var every N (steps between lines of {INTRUDER_TABLE}),\n\
         # -var frame N (steps between frames of {DUMP}, a multiple of those), -log log.lammps\n\
         # `plunge import` makes a log of what it writes.\n\
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

/// Steps of `dt` (s) between two lines about the intruder.
fn every(dt: f64) -> u64 {
    (EVERY / dt).round().max(1.0) as u64
}

/// What LAMMPS writes of the intruder, with the energies that it knows, and of all atoms.
fn output(simulation: &Simulation, space: Space) -> String {
    let gravity = simulation.bed().gravity.norm();
    let up = components(space)[components(space).len() - 1].1;
    // LAMMPS takes what turns for a sphere, also where it integrates a disc.
    let inertia = if space == Space::Planar { 1.25 } else { 1.0 };
    let mut text = format!(
        "compute turning intruder property/atom omegax omegay omegaz tqx tqy tqz\n\
         compute turn intruder reduce sum {}\n\
         compute translation grains ke\n\
         compute sphere_rotation grains erotate/sphere\n\
         variable rotation equal {inertia}*c_sphere_rotation\n\
         variable height atom {gravity:?}*mass*{up}\n\
         compute height grains reduce sum v_height\n\
         variable time equal step*dt\n",
        (1..=6).map(|column| format!("c_turning[{column}]")).collect::<Vec<_>>().join(" ")
    );
    let columns = columns(simulation, space);
    for Column { variable, formula, .. } in &columns {
        text.push_str(&format!("variable {variable} equal {formula}\n"));
    }
    let known = ["kinetic_grains_translation_J", "kinetic_grains_rotation_J", "potential_grains_J"];
    let variables = columns.iter().map(|column| format!("v_{}", column.variable));
    let names = columns.iter().map(|column| column.name.as_str()).chain(known);
    text.push_str(&format!(
        "fix log all ave/time ${{every}} 1 ${{every}} v_time &\n  {} &\n  \
         c_translation v_rotation c_height &\n  format \",%.17g\" title1 \"\" &\n  \
         title2 \"step,time_s,{}\" &\n  file {INTRUDER_TABLE}\n\
         dump grains all custom ${{frame}} {DUMP} {OF_ATOMS}\n\
         dump_modify grains sort id time yes format float %.9g\n",
        variables.collect::<Vec<_>>().join(" "),
        names.collect::<Vec<_>>().join(",")
    ));
    text.push_str("thermo 10000\nthermo_style custom step time v_z v_vz\n");
    text
}

/// A column of the table of the intruder.
struct Column {
    /// Its variable in LAMMPS.
    variable: String,
    formula: String,
    /// Its name in the table, with the unit.
    name: String,
}

/// Position, velocity, spin, force and torque of the intruder, along the axes of plunge.
fn columns(simulation: &Simulation, space: Space) -> Vec<Column> {
    let id = intruder_id(simulation);
    let mut columns = Vec::new();
    for (of, unit) in [("", "m"), ("v", "m_per_s"), ("f", "N")] {
        for (name, axis) in components(space) {
            columns.push(Column {
                variable: format!("{of}{name}"),
                formula: match of {
                    "" => format!("xcm(intruder,{axis})"),
                    of => format!("{of}{axis}[{id}]"),
                },
                name: format!("{of}{name}_{unit}"),
            });
        }
    }
    // In a plane what turns from x to z (up) turns about minus y, which is z of LAMMPS.
    let turns: &[(&str, &str, usize)] = match space {
        Space::Planar => &[("y", "-", 3)],
        Space::Spatial => &[("x", "", 1), ("y", "", 2), ("z", "", 3)],
    };
    for (of, word, unit, from) in [("w", "spin", "rad_per_s", 0), ("t", "torque", "N_m", 3)] {
        columns.extend(turns.iter().map(|(axis, sign, column)| Column {
            variable: format!("{of}{axis}"),
            formula: format!("{sign}c_turn[{}]", from + column),
            name: format!("{word}_{axis}_{unit}"),
        }));
    }
    columns
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
