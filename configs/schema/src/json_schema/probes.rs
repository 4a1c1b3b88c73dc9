//! Model files that make a reader ask everything: each law, effect and shape, and each way to say what can be said
//! in several ways. They need not be complete; what they lack is missed, which is noted too.

use crate::shipped::{self, SHIPPED};

/// Headers and the lines below them; a later part stands in for an earlier one with its header.
type Parts<'a> = Vec<(&'a str, String)>;

/// The texts. The first so many also have to be read without each of their keys.
pub(super) fn models() -> (Vec<String>, usize) {
    let mut texts: Vec<String> = SHIPPED.iter().map(|shipped| shipped.text.to_owned()).collect();
    texts.extend(beds());
    texts.extend(resistances());
    let whole = texts.len();
    texts.extend(laws());
    texts.extend(shapes());
    (texts, whole)
}

fn text(parts: &[Parts<'_>]) -> String {
    let mut all: Vec<(&str, &str)> = Vec::new();
    for (header, lines) in parts.iter().flatten() {
        match all.iter_mut().find(|(known, _)| known == header) {
            Some((_, known)) => *known = lines,
            None => all.push((header, lines)),
        }
    }
    all.iter().map(|(header, lines)| format!("{header}\n{lines}\n")).collect()
}

fn part<'a>(header: &'a str, lines: &str) -> (&'a str, String) {
    (header, lines.to_owned())
}

fn common() -> Parts<'static> {
    vec![
        part("[run]", "name = 'a'\nduration = '1 s'\nseed = 1"),
        part("[impact]", "speed = '1 m/s'\nangle = '90 deg'\nspin = '1 rad/s'"),
        part("[energy]", "abort_above = 0.1"),
        part("[conditions]", "speed = ['1 m/s']\nangle = ['90 deg']"),
        part("[log]", "frames_per_s = 100"),
    ]
}

fn grains(dimension: u8) -> Parts<'static> {
    let law = shipped::find("wet-2d").map_or(String::new(), |wet| section(wet.text, "contact_law"));
    let mut parts = common();
    parts.extend([
        ("[medium]", format!("kind = 'grains'\ndimension = {dimension}\ngravity = '9.81 m/s^2'")),
        part("[run]", "name = 'a'\nduration = '1 s'\nseed = 1\ntime_step = '1 us'"),
        part(
            "[container]",
            "shape = 'box'\nwidth = '1 m'\ndepth = '1 m'\nsides = 'wall'\nbottom = 'wall'",
        ),
        part("[bed]", "source = 'settle'"),
        part("[[bed.grains]]", "count = 10\ndiameter = '1 mm'\nmass = '1 g'"),
        ("[contact_law]", law),
    ]);
    parts
}

fn resistive(dimension: u8) -> Parts<'static> {
    let density = if dimension == 2 { "20 kg/m^2" } else { "1500 kg/m^3" };
    let mut parts = common();
    parts.extend([
        (
            "[medium]",
            format!(
                "kind = 'resistive-force'\ndimension = {dimension}\nbulk_density = '{density}'\n\
                 gravity = '9.81 m/s^2'"
            ),
        ),
        part("[log]", "interval = '1 ms'\nframes_per_s = 100"),
        part("[resistance]", "name = 'two-term-vector'\ndrag = 1.0\nfriction = 9.5"),
    ]);
    parts
}

/// The lines below `[name]` of a model.
fn section(text: &str, name: &str) -> String {
    let header = format!("[{name}]");
    let lines = text.lines().skip_while(|line| *line != header).skip(1);
    lines.take_while(|line| !line.starts_with('[')).map(|line| format!("{line}\n")).collect()
}

/// Beds and impacts in all their manners.
fn beds() -> Vec<String> {
    let manners: Vec<Parts<'_>> = vec![
        vec![part("[bed]", "source = 'csv'\nfile = '-'\nfile_blake3 = ''")],
        vec![
            part("[bed]", "source = 'settle'\npreparation_time_step = 'auto'"),
            part(
                "[container]",
                "shape = 'box'\nsides = 'periodic'\nbottom = 'absorbing'\n\
                                 absorbing_thickness = '1 cm'\nabsorbing_rate = '1 1/s'",
            ),
            part("[[bed.grains]]", "count = 1\ndistribution = 'uniform'"),
            part("[intruder]", "shape = 'cylinder'\nrecessive_wall = true"),
            part(
                "[impact]",
                "spin = ['0 rad/s', '1 rad/s', '0 rad/s']\nposition = ['1 m', '1 m']\n\
                              x_range = ['1 m', '2 m']",
            ),
            part("[conditions]", "x = ['1 m']\npositions = 2"),
        ],
        vec![
            part("[container]", "shape = 'cylinder'\ndiameter = '1 m'"),
            part("[[bed.grains]]", "count = 1\ndistribution = 'lognormal'\ndiameter_min = '1 mm'"),
            part("[impact]", "x = '1 m'\ny = '1 m'"),
            part("[run]", "time_step = 'auto'"),
        ],
        vec![
            part(
                "[[bed.grains]]",
                "count = 1\ndistribution = 'list'\ndiameters = ['1 mm']\nweights = [1]",
            ),
            part("[intruder]", "shape = 'sphere'\ndensity = '1 kg/m^3'"),
        ],
        vec![part("[[bed.grains]]", "count = 1\ndiameter = '1 mm'\ndensity = '1 kg/m^3'")],
        vec![part(
            "[intrusion]",
            "speed = '1 m/s'\ndepth = '1 cm'\nangle = '90 deg'\nattitude = '1 deg'",
        )],
    ];
    in_both_dimensions(grains, &manners)
}

/// Force laws and their impacts in all their manners.
fn resistances() -> Vec<String> {
    let formula = "name = 'expression'\nid = 'own'\nsummary = 'x'\nforce = 'q'\nkind = 'drag'\n\
                   direction = 'against-motion'\nacts = 'in-bed'\n\
                   parameters.q = { value = 1, unit = 'N', range = [0, 2] }";
    let upward = formula.replace("kind = 'drag'\n", "").replace("against-motion", "up");
    let manners: Vec<Parts<'_>> = vec![
        vec![
            part("[[effect]]", formula),
            part("[[candidate]]", formula),
            part("[fit]", "free = ['resistance.drag']"),
        ],
        vec![("[[effect]]", upward.clone()), ("[[candidate]]", upward)],
        vec![part("[intrusion]", "speed = '1 m/s'\ndepth = '1 cm'\nangle = '90 deg'")],
    ];
    in_both_dimensions(resistive, &manners)
}

/// The medium of `base` with each of `manners`, as discs and as spheres; what is pushed does not fall.
fn in_both_dimensions<'a>(base: fn(u8) -> Parts<'a>, manners: &[Parts<'a>]) -> Vec<String> {
    let of = |manner: &Parts<'a>, dimension| {
        let mut parts = base(dimension);
        if manner.iter().any(|(header, _)| *header == "[intrusion]") {
            parts.retain(|(header, _)| *header != "[impact]");
        }
        text(&[parts, manner.clone()])
    };
    let of = |dimension| manners.iter().map(move |one| of(one, dimension));
    [2, 3].into_iter().flat_map(of).collect()
}

/// Every law and effect by its name alone; effects that borrow from the contact law find one that lends.
fn laws() -> Vec<String> {
    let named = |header: &'static str, name: &str| vec![(header, format!("name = '{name}'"))];
    let mut texts = Vec::new();
    for law in contact_laws::LAWS {
        let headers: &[&str] = match law.acts_on {
            contact_laws::ActsOn::ContactBase => &["[contact_law]"],
            contact_laws::ActsOn::ContactEffect => &["[[effect]]", "[[bed.effect]]"],
        };
        for header in headers {
            texts.extend(
                [2, 3].map(|dimension| text(&[grains(dimension), named(header, law.name)])),
            );
        }
    }
    for force in contact_laws::GRAIN_FORCES {
        texts.extend(
            [2, 3].map(|dimension| text(&[grains(dimension), named("[[effect]]", force.name)])),
        );
    }
    for law in resistive::RESISTANCE_LAWS {
        let header = match law.role {
            resistive::Role::Baseline => "[resistance]",
            resistive::Role::Effect(_) => "[[effect]]",
        };
        texts
            .extend([2, 3].map(|dimension| text(&[resistive(dimension), named(header, law.name)])));
    }
    texts
}

/// Every shape, where it can act.
fn shapes() -> Vec<String> {
    let mut texts = Vec::new();
    for shape in intruders::SHAPES {
        let lines = vec![("[intruder]", format!("name = 'a'\nshape = '{}'", shape.name))];
        for dimension in [2, 3] {
            texts.push(text(&[grains(dimension), lines.clone()]));
            texts.push(text(&[resistive(dimension), lines.clone()]));
        }
    }
    texts
}
