//! What a run on grains logs of the bed: how much of it moves, what collisions alone would do to the
//! intruder, and its fields and crater at chosen times.

use engine::clock::steps_in;
use engine::coarse_graining::{Plane, fields};
use engine::contact::{Encounter, Partner};
use engine::crater::crater;
use engine::grains::Space;
use engine::math::Vec3;
use engine::rebound::restitution;
use engine::record::{BodyEstimate, RecordError, RunLog, Stamp};
use engine::simulation::Simulation;

use configs::GrainModel;

/// Width of the kernel of coarse graining, in mean grain diameters.
const KERNEL_WIDTH: f64 = 2.0;

/// Distance of the points of a field, in mean grain diameters.
const SPACING: f64 = 1.0;

/// How high above the undisturbed surface fields reach, in diameters of the intruder.
const HEADROOM: f64 = 1.0;

/// What is logged of a bed besides its grains.
pub(super) struct Observables<'a> {
    /// 1 + e of a grain and the intruder at the speed of impact.
    rebound: f64,
    /// Area (m², planar m) that an upright body of this shape has below the surface at a depth (m).
    area_at: Box<dyn Fn(f64) -> f64 + 'a>,
    /// Steps at which fields are logged.
    field_steps: Vec<u64>,
}

impl<'a> Observables<'a> {
    pub(super) fn new(grains: GrainModel<'a>, simulation: &Simulation) -> Self {
        let dt = simulation.clock().dt;
        let field_steps = grains.medium.log.fields_at.iter().map(|&time| steps_in(time, dt));
        let bed = simulation.bed();
        let encounter = Encounter {
            // The intruder is much heavier, and its faces are flat to a grain.
            mass_eff: bed.grains.mass.iter().sum::<f64>() / bed.grains.len() as f64,
            radius_eff: 0.5 * bed.grains.mean_diameter(),
            speed: simulation.intruder().bodies()[0].velocity.norm(),
        };
        let restitution = restitution(bed.stages(), Partner::Intruder, &encounter);
        let intruder = &grains.model.intruder;
        let space = bed.grains.space;
        Self {
            rebound: 1.0 + restitution.unwrap_or(1.0),
            area_at: Box::new(move |depth| {
                (intruder.shape.contact_area)(&intruder.params, space, depth)
            }),
            field_steps: field_steps.collect(),
        }
    }

    /// Writes what belongs to every step, and the fields where they are due.
    pub(super) fn record(
        &self,
        at: Stamp,
        simulation: &Simulation,
        log: &mut RunLog,
    ) -> Result<(), RecordError> {
        let bed = simulation.bed();
        log.bed_activity(at, bed.moving_share())?;
        let bodies = simulation.intruder().bodies();
        for (index, (footprint, body)) in bed.footprints().iter().zip(bodies).enumerate() {
            let depth = (simulation.surface() - body.lowest()).max(0.0);
            let estimate = BodyEstimate {
                geometric_area: (self.area_at)(depth),
                force: footprint.collisional_force * self.rebound,
                magnitudes: footprint.collisional_magnitudes * self.rebound,
            };
            log.body_estimate(at, index, &estimate)?;
        }
        if self.field_steps.contains(&at.step) {
            self.record_fields(at, simulation, log)?;
        }
        Ok(())
    }

    fn record_fields(
        &self,
        at: Stamp,
        simulation: &Simulation,
        log: &mut RunLog,
    ) -> Result<(), RecordError> {
        let bed = simulation.bed();
        let grains = &bed.grains;
        let diameter = grains.mean_diameter();
        let body = &simulation.intruder().bodies()[0];
        // Through a periodic side the intruder may have left the box.
        let at_home = bed.image_inside(body.position);
        let y = match grains.space {
            Space::Planar => 0.0,
            Space::Spatial => at_home.y,
        };
        let width = body.surface().support(Vec3::x()) + body.surface().support(-Vec3::x());
        let top = simulation.surface() + HEADROOM * width;
        let plane = Plane {
            y,
            x: 0.0..bed.container().extents()[0],
            z: 0.0..top,
            spacing: SPACING * diameter,
            kernel_width: KERNEL_WIDTH * diameter,
        };
        let axis = (at_home.x, y);
        log.bed_fields(at, &fields(grains, &plane), &crater(grains, &bed.lying(), axis))
    }
}
