//! The input script.

use configs::{GrainModel, SidesKind};
use engine::grains::Space;
use engine::simulation::Simulation;

use super::atom_type::INTRUDER;
use super::data::intruder_id;
use super::intruder::Intruder;
use super::law::Contacts;
use super::{BODY, DATA, DUMP, INPUT, INTRUDER_TABLE};

/// How far LAMMPS looks beyond touching grains for neighbours, in mean grain diameters: the fastest of
/// several tries on beds of discs and of spheres.
const SKIN: f64 = 0.19;

/// Time between two lines about the intruder (s), as in the log of plunge to the eye.
const EVERY: f64 = 1e-4;

/// What LAMMPS keeps of each atom in a frame.
const OF_ATOMS: &str = "id type radius mass x y z vx vy vz fx fy fz";

/// The text of the input script.
pub(super) fn text(
    model: GrainModel<'_>,
    simulation: &Simulation,
    contacts: &Contacts,
    intruder: &Intruder,
) -> String {
    let space = model.medium.space;
    let grains = &simulation.bed().grains;
    let mean_diameter = grains.mean_diameter();
    let dt = simulation.clock().dt;
    let frame = 1.0 / model.model.log.frames_per_s;
    let sides = if model.medium.container.sides == SidesKind::Periodic { "p" } else { "m" };
    let (boundary, processors, planar_dimension) = match space {
        Space::Planar => (format!("{sides} fm p"), "* 1 1", "dimension 2\n"),
        Space::Spatial => (format!("{sides} {sides} fm"), "* * 1", ""),
    };
    let lines = [
        header(model, space, intruder),
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
             group grains type 1\ngroup intruder type > 1\n{}",
            among_balls(intruder)
        ),
        format!("{}\n", contacts.pair.join("\n")),
        format!("timestep {dt:?}\n"),
        gravity(model.medium.gravity, space, intruder),
        walls(model, space, contacts),
        integrators(model, space, intruder),
        output(model, simulation, intruder),
        "if \"${warm_up} > 0\" then \"run ${warm_up}\"\nrun ${steps}\n".to_owned(),
        report(space),
    ];
    lines.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn header(model: GrainModel<'_>, space: Space, intruder: &Intruder) -> String {
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
         # or not. LAMMPS does not go on exactly after a restart, nor after a second `run`.\n{clump}",
        clump = about_clump(model, intruder),
        name = model.model.run.name,
        version = env!("CARGO_PKG_VERSION"),
    )
}

/// What a clump keeps of the body, in comments.
fn about_clump(model: GrainModel<'_>, intruder: &Intruder) -> String {
    let Some(clump) = &intruder.clump else { return String::new() };
    let [least, most] = clump.radii();
    let springs = match intruder.stiffness.len() {
        1 => "",
        _ => {
            "# R* of a contact is that of a mean grain and the body, by a factor on the springs of each\n\
             # type of ball.\n"
        }
    };
    format!(
        "# The intruder, a {shape}, is a rigid clump of {n} balls inside it, of {least:.3e} to\n\
         # {most:.3e} m, with the mass and the inertia of the body ({BODY}). It is not smooth: a mean\n\
         # grain ({grain:.3e} m) comes nearer by up to {departure:.1e} m, {share:.1} % of its radius. Where\n\
         # a grain touches several balls, each pushes with the springs and the damping of a whole\n\
         # contact, and friction starts anew on each.\n{springs}",
        shape = model.model.intruder.shape.name,
        n = clump.balls.len(),
        grain = clump.grain,
        departure = clump.departure,
        share = 100.0 * clump.departure / clump.grain,
    )
}

/// Balls of a clump do not touch each other, and are looked for as atoms of one size.
fn among_balls(intruder: &Intruder) -> String {
    if intruder.clump.is_none() {
        return String::new();
    }
    format!(
        "neigh_modify exclude group intruder intruder collection/type 2 1 {INTRUDER}*{}\n",
        intruder.last_kind()
    )
}

/// A clump has its weight as a whole.
fn gravity(gravity: f64, space: Space, intruder: &Intruder) -> String {
    if gravity <= 0.0 {
        return String::new();
    }
    let down = match space {
        Space::Planar => "0 -1 0",
        Space::Spatial => "0 0 -1",
    };
    let of =
        |name: &str, group: &str| format!("fix {name} {group} gravity {gravity:?} vector {down}");
    match &intruder.clump {
        None => format!("{}\n", of("gravity", "all")),
        Some(_) => {
            format!("{}\n{} disable\n", of("gravity", "grains"), of("weight", "intruder"))
        }
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
fn integrators(model: GrainModel<'_>, space: Space, intruder: &Intruder) -> String {
    let is_disc = model.model.intruder.shape.name == "disc";
    let weight = if model.medium.gravity > 0.0 { " gravity weight" } else { "" };
    let of_intruder = match intruder.clump {
        None if is_disc => "nve/sphere disc".to_owned(),
        None => "nve/sphere".to_owned(),
        Some(_) => format!("rigid single infile {BODY}{weight}"),
    };
    let of_intruder = format!("fix motion_of_intruder intruder {of_intruder}\n");
    match (space, &intruder.clump) {
        (Space::Spatial, None) => "fix motion all nve/sphere\n".to_owned(),
        (Space::Spatial, Some(_)) => format!("fix motion grains nve/sphere\n{of_intruder}"),
        (Space::Planar, _) => {
            format!("fix motion grains nve/sphere disc\n{of_intruder}fix plane all enforce2d\n")
        }
    }
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
fn output(model: GrainModel<'_>, simulation: &Simulation, intruder: &Intruder) -> String {
    let space = model.medium.space;
    let gravity = simulation.bed().gravity.norm();
    let up = components(space)[components(space).len() - 1].1;
    // LAMMPS takes what turns for a sphere, also where it integrates a disc.
    let inertia = if space == Space::Planar { 1.25 } else { 1.0 };
    // All balls of a clump turn alike.
    let reduced = if intruder.clump.is_some() { "ave" } else { "sum" };
    let mut text = format!(
        "compute turning intruder property/atom omegax omegay omegaz tqx tqy tqz\n\
         compute turn intruder reduce {reduced} {}\n\
         compute translation grains ke\n\
         compute sphere_rotation grains erotate/sphere\n\
         variable rotation equal {inertia}*c_sphere_rotation\n\
         variable height atom {gravity:?}*mass*{up}\n\
         compute height grains reduce sum v_height\n\
         variable time equal step*dt\n",
        (1..=6).map(|column| format!("c_turning[{column}]")).collect::<Vec<_>>().join(" ")
    );
    let columns = columns(model, simulation, intruder);
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
fn columns(model: GrainModel<'_>, simulation: &Simulation, intruder: &Intruder) -> Vec<Column> {
    let (space, id) = (model.medium.space, intruder_id(simulation));
    let is_clump = intruder.clump.is_some();
    let mut columns = Vec::new();
    for (place, (of, unit)) in [("", "m"), ("v", "m_per_s"), ("f", "N")].into_iter().enumerate() {
        for (name, axis) in components(space) {
            columns.push(Column {
                variable: format!("{of}{name}"),
                formula: match of {
                    _ if is_clump => of_clump(model, place, axis),
                    "" => format!("xcm(intruder,{axis})"),
                    of => format!("{of}{axis}[{id}]"),
                },
                name: format!("{of}{name}_{unit}"),
            });
        }
    }
    // In a plane what turns from x to z (up) turns about minus y, which is z of LAMMPS.
    let turns: &[(&str, &str, &str)] = match space {
        Space::Planar => &[("y", "-", "z")],
        Space::Spatial => &[("x", "", "x"), ("y", "", "y"), ("z", "", "z")],
    };
    for (of, word, unit) in [("w", "spin", "rad_per_s"), ("t", "torque", "N_m")] {
        columns.extend(turns.iter().map(|(name, sign, axis)| Column {
            variable: format!("{of}{name}"),
            formula: match of {
                "w" => format!("{sign}c_turn[{}]", number(axis)),
                _ if is_clump => format!("{sign}{}", of_clump(model, 3, axis)),
                _ => format!("{sign}c_turn[{}]", 3 + number(axis)),
            },
            name: format!("{word}_{name}_{unit}"),
        }));
    }
    columns
}

/// An axis of LAMMPS as its vectors count them.
fn number(axis: &str) -> usize {
    match axis {
        "x" => 1,
        "y" => 2,
        _ => 3,
    }
}

/// Along `axis` of LAMMPS, of a clump: its centre, its velocity, its force and its torque, by their
/// place among the numbers of a rigid body.
fn of_clump(model: GrainModel<'_>, place: usize, axis: &str) -> String {
    let of_body = |column: usize| format!("f_motion_of_intruder[1][{column}]");
    let value = of_body(3 * place + number(axis));
    let is_periodic = model.medium.container.sides == SidesKind::Periodic
        && axis != components(model.medium.space)[components(model.medium.space).len() - 1].1;
    match (place, is_periodic) {
        // The box has a length along every axis, and the body counts how often it has crossed it.
        (0, true) => format!("{value}+{}*l{axis}", of_body(12 + number(axis))),
        _ => value,
    }
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
