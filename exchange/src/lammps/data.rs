//! The grains and the intruder.

use std::f64::consts::PI;
use std::fmt::Write as _;

use configs::GrainModel;
use engine::grains::Space;
use engine::math::Vec3;
use engine::simulation::Simulation;

use super::atom_type::GRAIN;
use super::intruder::{Intruder, body};

/// One sphere or disc as LAMMPS reads it.
struct Atom {
    id: usize,
    kind: usize,
    radius: f64,
    mass: f64,
    position: Vec3,
    velocity: Vec3,
    spin: Vec3,
}

impl Atom {
    /// Density of a sphere of this mass (kg/m³): LAMMPS takes every atom of this style for a sphere when
    /// it reads its mass, also in a plane.
    fn density(&self) -> f64 {
        self.mass / (4.0 / 3.0 * PI * self.radius * self.radius * self.radius)
    }
}

/// The identity of the first atom of the intruder among those of `simulation`.
pub(super) fn intruder_id(simulation: &Simulation) -> usize {
    simulation.bed().grains.len() + 1
}

/// The components of `vector` along the axes of LAMMPS: in a plane, where y of LAMMPS is up, plunge is
/// turned by a quarter about x.
pub(super) fn axes(space: Space, vector: Vec3) -> [f64; 3] {
    match space {
        Space::Planar => [vector.x, vector.z, -vector.y],
        Space::Spatial => [vector.x, vector.y, vector.z],
    }
}

/// The vector whose [`axes`] these are.
pub(super) fn from_axes(space: Space, [x, y, z]: [f64; 3]) -> Vec3 {
    match space {
        // No minus before zero.
        Space::Planar => Vec3::new(x, 0.0 - z, y),
        Space::Spatial => Vec3::new(x, y, z),
    }
}

/// The text of the data file.
pub(super) fn text(model: GrainModel<'_>, simulation: &Simulation, intruder: &Intruder) -> String {
    let space = model.medium.space;
    let atoms = atoms(simulation, intruder);
    let mut text = format!(
        "{}: grains and intruder at first contact, in SI, by plunge {}\n\n{} atoms\n{} atom types\n\n",
        model.model.run.name,
        env!("CARGO_PKG_VERSION"),
        atoms.len(),
        intruder.last_kind()
    );
    for ([low, high], axis) in bounds(model, &atoms).iter().zip(["x", "y", "z"]) {
        let _ = writeln!(text, "{low:?} {high:?} {axis}lo {axis}hi");
    }
    text.push_str("\nAtoms # sphere\n\n");
    for atom in &atoms {
        let Atom { id, kind, radius, position, .. } = atom;
        let place = row(axes(space, *position));
        let _ = writeln!(text, "{id} {kind} {:?} {:?} {place}", 2.0 * radius, atom.density());
    }
    text.push_str("\nVelocities\n\n");
    for Atom { id, velocity, spin, .. } in &atoms {
        let (velocity, spin) = (row(axes(space, *velocity)), row(axes(space, *spin)));
        let _ = writeln!(text, "{id} {velocity} {spin}");
    }
    text
}

/// Three numbers in the shortest digits that read back to the same, and no minus before zero.
pub(super) fn row([x, y, z]: [f64; 3]) -> String {
    format!("{:?} {:?} {:?}", x + 0.0, y + 0.0, z + 0.0)
}

/// Where the centre of mass of the intruder is, inside the container (m).
pub(super) fn centre_of_intruder(simulation: &Simulation) -> Vec3 {
    simulation.bed().image_inside(body(simulation).position)
}

fn atoms(simulation: &Simulation, intruder: &Intruder) -> Vec<Atom> {
    let grains = simulation.bed().grains.iter().map(|grain| Atom {
        id: grain.id as usize + 1,
        kind: GRAIN,
        radius: grain.radius,
        mass: grain.mass,
        position: grain.position,
        velocity: grain.velocity,
        spin: grain.spin,
    });
    let (body, centre) = (body(simulation), centre_of_intruder(simulation));
    let members = intruder.members(simulation);
    let share = body.mass / members.len() as f64;
    let members = (intruder_id(simulation)..).zip(members).map(|(id, member)| {
        let (arm, spin) = (body.orientation * member.arm, body.spin());
        Atom {
            id,
            kind: member.kind,
            radius: member.radius,
            mass: share,
            position: centre + arm,
            velocity: body.velocity + spin.cross(&arm),
            spin,
        }
    });
    grains.chain(members).collect()
}

/// The box of LAMMPS (m): as wide as the container, and from a grain below the bottom to above everything,
/// from where LAMMPS lets it follow the highest atom.
fn bounds(model: GrainModel<'_>, atoms: &[Atom]) -> [[f64; 2]; 3] {
    let container = &model.medium.container;
    let below = -model.largest_grain();
    let top = atoms.iter().map(|atom| atom.position.z + atom.radius).fold(0.0, f64::max);
    let (width, height) = ([0.0, container.width], [below, top]);
    match model.medium.space {
        Space::Planar => [width, height, [0.5 * below, -0.5 * below]],
        Space::Spatial => [width, [0.0, container.depth], height],
    }
}
