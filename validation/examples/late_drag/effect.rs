//! The effect of `docs/user-effects.md` as a Rust type: what would be one new file in
//! `resistive/src/laws` and one line in the table there.

use configs::{LoadOptions, Model, ModelSource};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable, Range};
use intruders::AssemblyRequest;
use resistive::{Account, Flow, Immersion, Impact, Load, Motion, ResistanceLaw, Surroundings};
use resistive::{Approach, Coefficients, Facts, Kind, Needs, ResistanceEntry, Role};

/// F = −q ρ A v² z/D v̂   (N)
struct LateDrag {
    q: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "late-drag", kind: ChannelKind::Dissipated },
    flow: Flow::Dynamic,
}];

/// The line of the table.
pub(crate) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "late-drag",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::Speeds],
        separable_from: &[],
    }),
    summary: "A drag with the square of the speed that grows with the depth.",
    formula: "F = -q rho A v^2 z/D v/|v|",
    signature: "fast and deep impacts end sooner; slow ones hardly",
    source: "an example",
    params: &[ParamSpec::number("q", "drag in units of rho A v^2 z/D")
        .allowed(Range::closed(0.0, 5.0))
        .usual(0.0, 5.0)],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(LateDrag { q: given.get("q") }),
};

impl ResistanceLaw for LateDrag {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let area = at.loaded_area * at.depth.max(0.0) / at.diameter;
        load.dynamic -= motion.velocity * (self.q * bed.bulk_density * area * motion.speed);
    }
}

/// The same effect in the file of a model.
pub(crate) const MODEL: &str = r#"
[run]
name = "late-drag"
duration = "1 s"

[medium]
kind = "resistive-force"
bulk_density = "1520 kg/m^3"
gravity = "9.81 m/s^2"

[resistance]
name = "two-term-vector"
drag = 1.0
friction = 9.5

[[effect]]
name = "expression"
id = "late-drag"
summary = "drag that grows with the depth"
force = "q * rho * A * v^2 * z / D"
parameters.q = { value = 0.2, unit = "1", range = [0, 5] }

[intruder]
shape = "sphere"
diameter = "25.4 mm"
mass = "69.2 g"

[impact]
speed = "2 m/s"
angle = "60 deg"
"#;

/// The impact of [`MODEL`], and that of the same model without its effect and with [`ENTRY`] instead.
///
/// # Panics
/// If [`MODEL`] is no model of a resistive medium.
pub(crate) fn impacts() -> [Impact; 2] {
    let source = ModelSource::Text {
        name: "late-drag.toml".to_owned(),
        text: MODEL.to_owned(),
        folder: ".".into(),
    };
    let model = Model::load(source, &LoadOptions::default()).expect("the model of the docs").model;
    let resistive = model.resistive().expect("a resistive medium");
    let condition = &model.conditions()[0];
    let by_formula = resistive.impact(condition);
    let mut plain = resistive.medium.clone();
    plain.effects.clear();
    let approach = Approach { speed: condition.speed, angle: condition.angle_rad };
    let mut laws = plain.laws_at(approach);
    let numbers = ParamTable::from_iter([("q", 0.2)]);
    laws.push((ENTRY.build)(&Coefficients::new(numbers)));
    let launch = model.launch(condition);
    let made = (model.intruder.shape.assembly)(&AssemblyRequest {
        params: &model.intruder.params,
        space: plain.space,
        mass: model.intruder.mass,
        velocity: launch.velocity(),
        spin: launch.spin.y,
    });
    let by_type = Impact::new(made.assembly, laws, plain.surroundings(), made.start);
    [by_formula, by_type]
}
