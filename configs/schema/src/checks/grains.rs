//! What only a model of grains is checked for.

use engine::contact::Slot;
use engine::grains::Space;

use super::{Common, metres, seconds};
use crate::absorbing;
use crate::diagnostics::{Diagnostic, Span};
use crate::limits;
use crate::model::{BedSource, BottomKind, Container, GrainModel, LawChoice, SidesKind, StartX};
use crate::read::BodyPlaces;
use crate::stability;

/// The way of an intruder in a step that is surely short enough, in radii of the smallest grain.
const SAFE_WAY: f64 = 0.1;

/// Diameters of the largest grain that a periodic box is at least wide.
const GRAINS_ACROSS: f64 = 6.0;

/// Diameters of the largest grain between an intruder and its image in a periodic side, at least.
const GRAINS_BESIDE: f64 = 4.0;

pub(super) struct GrainChecks<'a> {
    pub(super) grains: GrainModel<'a>,
    pub(super) common: Common<'a>,
}

impl GrainChecks<'_> {
    pub(super) fn all(&self) {
        self.sizes();
        self.boundaries();
        self.links();
        self.derived_quantities();
        self.common.number_of_conditions();
        if !self.common.reader.failed() {
            self.start_positions();
            self.room();
            self.way_of_a_step();
            self.effects_of_space();
            self.steps();
            self.targets();
        }
    }

    fn sizes(&self) {
        let Container { width, depth, .. } = self.grains.medium.container;
        let in_space = self.grains.medium.space == Space::Spatial;
        let too_wide = |what: &str, diameter: f64, places: BodyPlaces| {
            let does_not_fit = |length: f64, side: Option<Span>, which: &str| {
                self.common.reader.report(
                    Diagnostic::error(format!("the {what} does not fit into the box"))
                        .at(places.diameter, format!("{} wide", metres(diameter)))
                        .with(side, format!("the box is {} {which}", metres(length))),
                );
            };
            if diameter >= width {
                does_not_fit(width, self.common.places.width, "wide");
            } else if in_space && diameter >= depth {
                does_not_fit(depth, self.common.places.depth, "deep");
            }
        };
        if let Some(diameter) = self.common.intruder_diameter() {
            too_wide("intruder", diameter, self.common.places.intruder);
        }
        if let BedSource::Settle(settle) = &self.grains.medium.bed.source {
            for (kind, places) in settle.grains.iter().zip(&self.common.places.grains) {
                too_wide("grain", kind.sizes.largest(), *places);
            }
        }
    }

    /// Refuses a container that no memory holds, however few its grains are.
    fn room(&self) {
        if self.grains.container_bytes() <= limits::CONTAINER_BYTES {
            return;
        }
        let Container { width, .. } = self.grains.medium.container;
        self.common.reader.report(
            Diagnostic::error("the container is too large for cells of the size of its grains")
                .at(self.common.places.width, format!("{} wide", metres(width)))
                .help(format!(
                    "its {} grains cover the floor of one that is {} wide",
                    self.grains.n_grains(),
                    metres(self.grains.width_of_a_layer())
                )),
        );
    }

    /// Refuses a step in which the intruder would pass grains without touching them.
    fn way_of_a_step(&self) {
        let Some(step) = stability::time_step(self.grains) else { return };
        let model = self.grains.model;
        let impacts = model.conditions();
        let speed = impacts.iter().fold(0.0_f64, |speed, impact| speed.max(impact.speed));
        let radius = 0.5 * self.grains.smallest_grain();
        if speed * step <= radius {
            return;
        }
        let listed = model.conditions.as_ref().and_then(|lists| lists.speed.as_ref());
        let place = listed.and_then(|speeds| speeds.iter().position(|one| *one >= speed));
        let places = self.common.places;
        let span = match place {
            Some(place) => places.condition_speed.get(place).copied().flatten(),
            None => places.speed,
        };
        self.common.reader.report(
            Diagnostic::error(format!(
                "the intruder moves {} in a step, farther than the radius {} of the smallest grain",
                metres(speed * step),
                metres(radius)
            ))
            .at(span, format!("{speed} m/s"))
            .with(places.time_step, format!("a step of {}", seconds(step)))
            .help(format!(
                "it would pass grains without touching them; write a time step of \"{}\" or less",
                seconds(SAFE_WAY * radius / speed)
            )),
        );
    }

    /// Refuses what a periodic side or a layer cannot be.
    fn boundaries(&self) {
        let container = &self.grains.medium.container;
        let absorbs =
            container.sides == SidesKind::Absorbing || container.bottom == BottomKind::Absorbing;
        if absorbs
            && container.absorbing_rate.is_none()
            && absorbing::wave_speed(self.grains).is_none()
        {
            let law = &self.grains.medium.contact_law;
            self.common.reader.report(
                Diagnostic::error(format!(
                    "the law `{}` does not say how fast waves are",
                    law.entry.name
                ))
                .at(law.span, "has no collision time")
                .help("give container.absorbing_rate"),
            );
        }
        if container.sides != SidesKind::Periodic {
            return;
        }
        let grain = self.grains.largest_grain();
        let intruder = self.grains.extent();
        let mut axes = vec![("wide", container.width, self.common.places.width)];
        if self.grains.medium.space == Space::Spatial {
            axes.push(("deep", container.depth, self.common.places.depth));
        }
        for (which, length, span) in axes {
            let refuse = |needed: f64, why: &str| {
                self.common.reader.report(
                    Diagnostic::error(format!("the periodic box is too narrow for {why}"))
                        .at(span, format!("{} {which}", metres(length)))
                        .help(format!("expected at least {}", metres(needed))),
                );
            };
            if length < GRAINS_ACROSS * grain {
                refuse(GRAINS_ACROSS * grain, "its grains, which would touch their own images");
            } else if length <= intruder + GRAINS_BESIDE * grain {
                refuse(
                    intruder + GRAINS_BESIDE * grain,
                    "the intruder, which would feel its own image",
                );
            }
        }
    }

    /// Links have round ends, and a chain moves in the x–z plane.
    fn links(&self) {
        let (intruder, places) = (&self.grains.model.intruder, self.common.places);
        let param = |name| intruder.params.iter().find(|(key, _)| *key == name);
        if let (Some((_, length)), Some((_, diameter))) = (param("length"), param("diameter"))
            && length <= diameter
        {
            self.common.reader.report(
                Diagnostic::error("a link is longer than it is thick")
                    .at(places.intruder.diameter, format!("{} thick", metres(diameter)))
                    .help(format!(
                        "its length, round ends included, is {}; a sphere has the shape \"sphere\"",
                        metres(length)
                    )),
            );
        }
        let spin = self.grains.model.impact.spin;
        if intruder.shape.links.is_some() && (spin.x != 0.0 || spin.z != 0.0) {
            self.common.reader.report(
                Diagnostic::error("a chain moves in the x–z plane")
                    .at(places.spin, "turns it out of that")
                    .help("write its spin as one number, counter-clockwise positive"),
            );
        }
        let forces = self.grains.medium.grain_forces.iter();
        let mut fluids = forces.filter(|force| force.is_of_a_fluid());
        if let (Some(fluid), true) = (fluids.next(), intruder.shape.slender) {
            self.common.reader.report(
                Diagnostic::error("no link is modelled in a fluid")
                    .at(fluid.span, "its drag is that of a sphere")
                    .help("leave it out, or take an intruder of one piece: sphere, cylinder, hemisphere, cone"),
            );
        }
    }

    fn derived_quantities(&self) {
        let (model, medium) = (self.grains.model, self.grains.medium);
        let stiffness =
            medium.contact_law.params.iter().find(|(key, _)| *key == "normal_stiffness");
        let mut bodies: Vec<(&str, f64, f64, BodyPlaces)> = Vec::new();
        if let BedSource::Settle(settle) = &medium.bed.source {
            for (kind, places) in settle.grains.iter().zip(&self.common.places.grains) {
                let (smallest, largest) = (kind.sizes.smallest(), kind.sizes.largest());
                let extremes =
                    if smallest < largest { vec![smallest, largest] } else { vec![smallest] };
                for diameter in extremes {
                    bodies.push(("grain", diameter, kind.mass(medium.space, diameter), *places));
                }
                let total = kind.total_mass(medium.space);
                if kind.count > 0 {
                    let inputs = [("mass", places.mass), ("count of grains", places.count)];
                    self.common.derived("the mass of all grains", total, inputs);
                }
            }
        }
        if let Some(diameter) = self.common.intruder_diameter() {
            bodies.push(("intruder", diameter, model.intruder.mass, self.common.places.intruder));
        }
        for (name, diameter, mass, places) in bodies {
            let inputs = [("diameter", places.diameter), ("mass", places.mass)];
            let inertia = 0.25 * medium.inertia_coefficient() * mass * diameter * diameter;
            self.common.derived(&format!("the moment of inertia of the {name}"), inertia, inputs);
            self.common.derived(&format!("the mass of the {name}"), mass, inputs);
            if medium.gravity > 0.0 {
                let inputs = [("mass", places.mass), ("gravity", self.common.places.gravity)];
                let weight = mass * medium.gravity;
                self.common.derived(&format!("the weight of the {name}"), weight, inputs);
            }
            if let Some((_, stiffness)) = stiffness {
                let place = ("stiffness", self.common.places.normal_stiffness);
                let inputs = [place, ("mass", places.mass)];
                let rate = stiffness / mass;
                self.common.derived(&format!("the collision rate of the {name}"), rate, inputs);
                let inputs = [place, ("diameter", places.diameter)];
                let energy = stiffness * diameter * diameter;
                self.common.derived(&format!("the elastic energy of the {name}"), energy, inputs);
            }
        }
        self.common.impact_energy();
        if let Some(step) = stability::time_step(self.grains) {
            let factor = ("factor", self.common.places.time_step_factor);
            self.common.derived(
                "the time step",
                step,
                [("time step", self.common.places.time_step), factor],
            );
            let steps = model.run.duration / step;
            if steps.is_nan() || steps > limits::STEPS {
                self.common.reader.report(
                    Diagnostic::error(format!("the run would take {steps:.1e} steps"))
                        .at(self.common.places.duration, "this long")
                        .with(self.common.places.time_step, "in steps of this")
                        .help(format!("at most {:.0e} are accepted", limits::STEPS)),
                );
            }
            if step > model.run.duration {
                self.common.reader.report(
                    Diagnostic::error("the time step is longer than the run")
                        .at(self.common.places.time_step, seconds(step))
                        .with(self.common.places.duration, seconds(model.run.duration)),
                );
            }
        }
    }

    /// In a plane grains turn about one axis only, which lies in every contact plane.
    fn effects_of_space(&self) {
        let medium = self.grains.medium;
        let settling: &[LawChoice] = match &medium.bed.source {
            BedSource::Settle(settle) => &settle.effects,
            BedSource::Csv(_) => &[],
        };
        for effect in medium.effects.iter().chain(settling) {
            if medium.space == Space::Planar && effect.entry.slot == Slot::Twisting {
                let name = effect.entry.name;
                self.common.reader.report(
                    Diagnostic::error(format!("`{name}` does nothing in a planar bed"))
                        .at(effect.span, "discs cannot twist about the normal of a contact")
                        .help("leave it out, or make the bed one of spheres: dimension = 3"),
                );
            }
        }
    }

    fn start_positions(&self) {
        let width = self.grains.medium.container.width;
        // Through a periodic side the intruder may stand.
        let radius = match self.grains.medium.container.sides {
            SidesKind::Periodic => 0.0,
            SidesKind::Wall | SidesKind::Absorbing => self.grains.half_width(),
        };
        let inside = |x: f64| x >= radius && x <= width - radius;
        let outside = |x: f64, span: Option<Span>| {
            if !inside(x) {
                self.common.reader.report(
                    Diagnostic::error("the intruder would start outside of the box")
                        .at(span, format!("its centre at {}", metres(x)))
                        .with(
                            self.common.places.width,
                            format!("the box is {} wide", metres(width)),
                        )
                        .help(format!(
                            "to keep clear of the sides, the centre may be from {} to {}",
                            metres(radius),
                            metres(width - radius)
                        )),
                );
            }
        };
        if let Some(x) = self.grains.medium.start.x {
            outside(x, self.common.places.x);
        }
        let lists = self.grains.model.conditions.as_ref();
        if let Some(x) = lists.and_then(|lists| lists.x.as_ref()) {
            for (x, span) in x.iter().zip(&self.common.places.condition_x) {
                outside(*x, *span);
            }
        }
        let draws = self.grains.model.conditions().iter().any(|one| one.x == StartX::Drawn);
        if self.common.places.x_range.is_some() || draws {
            let (from, to) = self.grains.medium.start.x_range;
            let span = self.common.places.x_range.or(self.common.places.positions);
            outside(from, span);
            if inside(from) {
                outside(to, span);
            }
        }
    }

    fn steps(&self) {
        let run = stability::time_step(self.grains);
        let times = stability::times(self.grains);
        self.step_against(run, times.collision, self.common.places.time_step, true);
        if self.common.places.preparation_time_step.is_some() {
            let step = stability::preparation_steps(self.grains).map(|steps| steps.settling);
            let (times, span) = (
                stability::preparation_times(self.grains),
                self.common.places.preparation_time_step,
            );
            self.step_against(step, times.collision, span, false);
            self.step_against_damping(step, times.damping, span);
        }
        self.step_against_damping(run, times.damping, self.common.places.time_step);
    }

    fn step_against_damping(&self, step: Option<f64>, relaxation: Option<f64>, span: Option<Span>) {
        let (Some(step), Some(relaxation)) = (step, relaxation) else {
            return;
        };
        let steps = relaxation / step;
        let message = format!("the damping of a contact acts within {steps:.1} steps");
        let diagnostic = if steps < stability::FEWEST_STEPS_PER_DAMPING_TIME {
            Diagnostic::error(message)
        } else if steps < stability::FEW_STEPS_PER_DAMPING_TIME {
            Diagnostic::warning(message)
        } else {
            return;
        };
        let advice = seconds(relaxation / stability::STEPS_PER_DAMPING_TIME);
        self.common.reader.report(
            diagnostic
                .at(
                    span.or(self.common.places.time_step_factor),
                    format!("a step of {}", seconds(step)),
                )
                .help(format!(
                    "damping overshoots and the bed never comes to rest; write \"{advice}\" or \
                     less, or \"auto\""
                )),
        );
    }

    fn step_against(
        &self,
        step: Option<f64>,
        collision: Option<f64>,
        span: Option<Span>,
        is_run: bool,
    ) {
        let (Some(step), Some(collision)) = (step, collision) else {
            return;
        };
        let per_collision = collision / step;
        let message = format!("the shortest collision takes only {per_collision:.1} steps");
        let diagnostic = if per_collision < stability::FEWEST_STEPS_PER_COLLISION {
            Diagnostic::error(message)
        } else if per_collision < stability::FEW_STEPS_PER_COLLISION {
            Diagnostic::warning(message)
        } else {
            return;
        };
        let advice = seconds(collision / stability::STEPS_PER_COLLISION);
        let diagnostic = diagnostic
            .at(
                span.or(self.common.places.time_step_factor),
                format!("a step of {}", seconds(step)),
            )
            .with(
                self.common.places.normal_stiffness,
                format!("with the lightest pair, a collision of {}", seconds(collision)),
            );
        let factor = self.common.places.time_step_factor.filter(|_| is_run && span.is_some());
        self.common.reader.report(
            diagnostic
                .with(factor, "multiplies the step")
                .help(format!("write \"{advice}\" or less, \"auto\", or a smaller stiffness")),
        );
    }

    fn targets(&self) {
        let BedSource::Settle(settle) = &self.grains.medium.bed.source else {
            return;
        };
        let bed = &self.grains.medium.bed;
        let (Some(fraction), Some(height)) = (bed.target_packing_fraction, bed.target_height)
        else {
            return;
        };
        let space = self.grains.medium.space;
        let contents = settle.grains.iter().map(|kind| kind.count as f64 * kind.content(space));
        let base = self.grains.medium.container.without_layers().base_area(space);
        let implied = contents.sum::<f64>() / (base * height);
        if implied > 1.0 {
            let most = settle.grains.iter().enumerate().max_by_key(|(_, kind)| kind.count);
            let (at, count) = most.map_or((0, 0), |(at, kind)| (at, kind.count));
            let places = &self.common.places;
            let share = fraction / implied * count as f64;
            self.common.reader.report(
                Diagnostic::error(format!(
                    "the grains do not fit into the bed: its height would mean a packing fraction of \
                     {implied:.3}"
                ))
                .at(places.grains.get(at).and_then(|grain| grain.count), "so many grains")
                .with(places.target_height, "the height that they are to fill")
                .help(format!(
                    "about {share:.0} of them would fill it to {fraction}; or is the box wider, or \
                     the bed higher?"
                )),
            );
            return;
        }
        if (implied / fraction - 1.0).abs() > 0.03 {
            self.common.reader.report(
                Diagnostic::warning("the two targets of the bed contradict each other")
                    .at(self.common.places.target_packing_fraction, "the packing fraction")
                    .with(
                        self.common.places.target_height,
                        format!("this height means a packing fraction of {implied:.3}"),
                    ),
            );
        }
    }
}
