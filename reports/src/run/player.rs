//! The scenes of a run in the few bytes that a page can carry.
//!
//! Places are in steps of a grid, quantities in 255 steps of the root of their share of the greatest; what a frame
//! changes is stored, byte by byte of the same meaning for all grains, and packed by zlib. `templates/player.js`
//! reads it.

use std::io::Write as _;
use std::ops::ControlFlow;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

use super::Course;
use crate::scene::{
    Disc, Extent, Impact, Look, Outline, Quantity, STEPS, Scene, SceneError, View, ramp,
};

/// Most grains of a view.
const GRAINS: usize = 20_000;

/// Most frames.
const FRAMES: usize = 160;

/// Most bytes of the grains of all views, before they are written in letters.
const BYTES: usize = 1_500_000;

/// Steps of the grid across the widest side.
const GRID: f64 = 8192.0;

/// Steps of the grid beyond its edges, for grains that reach in.
const BEYOND: f64 = 512.0;

/// A place that is not seen.
const HIDDEN: u16 = u16::MAX;

/// What the page plays.
pub(super) struct Player {
    /// As JSON.
    pub(super) data: String,
    /// How many grains it holds in its largest view, and how many frames.
    pub(super) grains: usize,
    pub(super) frames: usize,
}

impl Player {
    pub(super) fn of(impact: &Impact, course: &Course) -> Result<Self, SceneError> {
        let frames = impact.evenly(FRAMES);
        let looks = if impact.planar { &[Look::Side][..] } else { &[Look::Side, Look::Above] };
        let mut views = Vec::new();
        let mut grains = 0;
        for look in looks {
            let view = View::of(impact, *look, None);
            let packed = Packed::of(impact, &view, &frames, BYTES / looks.len())?;
            grains = grains.max(packed.n);
            views.push(packed.json(impact, &view));
        }
        let quantity = |quantity: Quantity| {
            let top = quantity.factor() * impact.top_of(quantity);
            json!({ "name": quantity.name(), "unit": quantity.unit(), "top": top })
        };
        let along = |at: usize| (at as f64 / (STEPS - 1) as f64).powi(2);
        let colours = (0..STEPS).map(|at| ramp(along(at), 1.0));
        let colours = colours.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let times: Vec<f64> = frames.iter().map(|frame| impact.times[*frame]).collect();
        let states = |of: fn(&exchange::read::BodyState) -> f64, digits: i32| -> Vec<f64> {
            times
                .iter()
                .map(|time| to_decimals(course.first_at(*time).map_or(0.0, &of), digits))
                .collect()
        };
        let data = json!({
            "times": times.iter().map(|time| to_decimals(1e3 * time, 4)).collect::<Vec<_>>(),
            "depth": states(|state| 1e3 * state.depth, 2),
            "speed": states(|state| state.velocity.norm(), 3),
            "most": impact.forces.top(),
            "quantities": Quantity::ALL.map(quantity),
            "colours": colours.collect::<Vec<_>>(),
            "views": views,
        });
        // Only a text could hold the end of a script, and these data hold no text.
        Ok(Self { data: data.to_string().replace("</", "<\\/"), grains, frames: frames.len() })
    }
}

/// The grains of a view.
struct Packed {
    n: usize,
    data: Vec<u8>,
    grid: Grid,
    scenes: Vec<Scene>,
}

/// From places to steps.
struct Grid {
    window: Extent,
    step: f64,
    /// Of the nearness (m).
    far: f64,
    depth_step: f64,
}

impl Packed {
    fn of(
        impact: &Impact,
        view: &View,
        frames: &[usize],
        bytes: usize,
    ) -> Result<Self, SceneError> {
        let window = bounded(impact, view)?;
        let mut scenes = Vec::new();
        impact.scenes(view, &window, frames, |scene| {
            scenes.push(scene);
            ControlFlow::Continue(())
        })?;
        let (far, near) = reach(&scenes);
        let grid = Grid {
            step: window.width().max(window.height()) / GRID,
            far,
            depth_step: (near - far).max(f64::MIN_POSITIVE) / 65_000.0,
            window,
        };
        let mut ids = by_nearness(&scenes, impact, view);
        loop {
            let data = pack(&ids, &scenes, &grid, impact);
            if data.len() <= bytes || ids.len() < 2 {
                return Ok(Self { n: ids.len(), data, grid, scenes });
            }
            // A little more is left out than the bytes ask for, so that few rounds are needed.
            let fits = 0.95 * ids.len() as f64 * bytes as f64 / data.len() as f64;
            ids.truncate((fits as usize).clamp(1, ids.len() - 1));
        }
    }

    fn json(&self, impact: &Impact, view: &View) -> Value {
        let Grid { window, step, .. } = &self.grid;
        let zero = match view.look {
            Look::Side => [impact.axis[0], 0.0],
            Look::Above => impact.axis,
        };
        let extent = |extent: &Extent| {
            let side = |[from, to]: [f64; 2], zero: f64| {
                [to_decimals(1e3 * (from - zero), 3), to_decimals(1e3 * (to - zero), 3)]
            };
            json!([side(extent.u, zero[0]), side(extent.v, zero[1])])
        };
        let millimetres = |[u, v]: [f64; 2]| {
            [to_decimals(1e3 * (u - zero[0]), 2), to_decimals(1e3 * (v - zero[1]), 2)]
        };
        let outline = |body: &Outline| {
            let corners: Vec<_> = body.corners.iter().map(|corner| millimetres(*corner)).collect();
            let near = body.near.is_finite().then(|| self.grid.nearness(body.near));
            json!({ "corners": corners, "near": near })
        };
        let bodies = |scene: &Scene| scene.bodies.iter().map(outline).collect::<Vec<_>>();
        let force = |force: &crate::scene::Force| {
            let [u, v] = millimetres(force.at);
            json!([u, v, to_decimals(force.newton[0], 4), to_decimals(force.newton[1], 4)])
        };
        let forces = |scene: &Scene| scene.forces.iter().map(force).collect::<Vec<_>>();
        let paths = self.scenes.last().map_or(Vec::new(), |last| {
            last.paths
                .iter()
                .map(|path| path.iter().map(|at| millimetres(*at)).collect())
                .collect::<Vec<Vec<_>>>()
        });
        let frames: Vec<usize> = self.scenes.iter().map(|scene| scene.frame).collect();
        json!({
            "name": match view.look { Look::Side if impact.planar => "side", Look::Side => "side, cut open", Look::Above => "above" },
            "side": view.look == Look::Side,
            "near": extent(&within(&view.near, window)),
            "whole": extent(window),
            "n": self.n,
            "sorted": view.look == Look::Above || view.slice.is_some(),
            "step": 1e3 * step,
            "beyond": BEYOND,
            "largest": 1e3 * largest(&self.scenes),
            "bodies": self.scenes.iter().map(bodies).collect::<Vec<_>>(),
            "forces": self.scenes.iter().map(forces).collect::<Vec<_>>(),
            "paths": paths,
            "frames": frames,
            "grains": BASE64_STANDARD.encode(&self.data),
        })
    }
}

fn within(inner: &Extent, outer: &Extent) -> Extent {
    let side = |[a, b]: [f64; 2], [from, to]: [f64; 2]| [a.max(from), b.min(to)];
    Extent { u: side(inner.u, outer.u), v: side(inner.v, outer.v) }
}

/// The whole bed, or as much of it around the impact as holds the most grains that a page takes.
fn bounded(impact: &Impact, view: &View) -> Result<Extent, SceneError> {
    let mut first = Vec::new();
    impact.scenes(view, &view.whole, &[0], |scene| {
        first = scene.discs;
        ControlFlow::Break(())
    })?;
    if first.len() <= GRAINS {
        return Ok(view.whole);
    }
    // How much the near part has to grow, about its middle, to reach a grain.
    let Extent { u, v } = view.near;
    let share = |x: f64, [from, to]: [f64; 2]| ((2.0 * x - from - to) / (to - from)).abs();
    let mut growth: Vec<f64> =
        first.iter().map(|disc| share(disc.place[0], u).max(share(disc.place[1], v))).collect();
    let (_, factor, _) = growth.select_nth_unstable_by(GRAINS, f64::total_cmp);
    let grown = |[from, to]: [f64; 2], [low, high]: [f64; 2]| {
        let (middle, half) = (0.5 * (from + to), 0.5 * *factor * (to - from));
        [(middle - half).max(low), (middle + half).min(high)]
    };
    Ok(Extent { u: grown(u, view.whole.u), v: grown(v, view.whole.v) })
}

/// The farthest and the nearest of all discs (m).
fn reach(scenes: &[Scene]) -> (f64, f64) {
    let all = scenes.iter().flat_map(|scene| &scene.discs).map(|disc| disc.place[2]);
    all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), w| (low.min(w), high.max(w)))
}

fn largest(scenes: &[Scene]) -> f64 {
    let all = scenes.iter().flat_map(|scene| &scene.discs).map(|disc| disc.radius);
    all.fold(0.0, f64::max)
}

/// The grains that are ever seen, those first that begin next to the impact.
fn by_nearness(scenes: &[Scene], impact: &Impact, view: &View) -> Vec<u32> {
    let [u, v, _] = view.place([impact.axis[0], impact.axis[1], 0.0]);
    let mut all: Vec<(u32, f64)> = scenes
        .iter()
        .flat_map(|scene| &scene.discs)
        .map(|disc| (disc.id, (disc.place[0] - u).powi(2) + (disc.place[1] - v).powi(2)))
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.dedup_by_key(|(id, _)| *id);
    all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    all.truncate(GRAINS);
    all.into_iter().map(|(id, _)| id).collect()
}

impl Grid {
    fn place(&self, disc: &Disc) -> [u16; 3] {
        let step = |x: f64, from: f64| {
            ((x - from) / self.step + BEYOND).round().clamp(0.0, f64::from(HIDDEN - 1)) as u16
        };
        let Extent { u, v } = self.window;
        [step(disc.place[0], u[0]), step(disc.place[1], v[0]), self.nearness(disc.place[2])]
    }

    fn nearness(&self, w: f64) -> u16 {
        ((w - self.far) / self.depth_step).round().clamp(0.0, 65_000.0) as u16
    }
}

/// Radii, then frame by frame what has changed of places and quantities.
fn pack(ids: &[u32], scenes: &[Scene], grid: &Grid, impact: &Impact) -> Vec<u8> {
    let n = ids.len();
    let mut places: Vec<(u32, usize)> = ids.iter().copied().zip(0..).collect();
    places.sort_unstable();
    let mut places_before = vec![[0_u16; 3]; n];
    let mut values_before = vec![[0_u8; 3]; n];
    let mut radii = vec![0_u8; n];
    let (mut frames, widest) = (Vec::new(), largest(scenes));
    for scene in scenes {
        let mut now = places_before.clone();
        now.iter_mut().for_each(|place| place[0] = HIDDEN);
        let mut values = values_before.clone();
        for disc in &scene.discs {
            let Ok(at) = places.binary_search_by_key(&disc.id, |(id, _)| *id) else { continue };
            let at = places[at].1;
            now[at] = grid.place(disc);
            values[at] = std::array::from_fn(|of| level(disc.values[of], impact.tops[of]));
            radii[at] = (255.0 * disc.radius / widest).round() as u8;
        }
        for axis in 0..3 {
            let changes = || (0..n).map(|at| zigzag(now[at][axis], places_before[at][axis]));
            frames.extend(changes().map(|change| change as u8));
            frames.extend(changes().map(|change| (change >> 8) as u8));
        }
        for of in 0..3 {
            frames.extend((0..n).map(|at| values[at][of].wrapping_sub(values_before[at][of])));
        }
        (places_before, values_before) = (now, values);
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let written = encoder.write_all(&radii).and_then(|()| encoder.write_all(&frames));
    written.and_then(|()| encoder.finish()).unwrap_or_default()
}

fn level(value: f64, top: f64) -> u8 {
    if top > 0.0 { (255.0 * (value / top).clamp(0.0, 1.0).sqrt()).round() as u8 } else { 0 }
}

/// A change as a number that is small where the change is.
fn zigzag(now: u16, before: u16) -> u16 {
    let change = now.wrapping_sub(before) as i16;
    ((change << 1) ^ (change >> 15)) as u16
}

fn to_decimals(value: f64, digits: i32) -> f64 {
    let scale = libm::pow(10.0, f64::from(digits));
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_changes_of_either_sign_are_small_numbers() {
        assert_eq!([zigzag(5, 5), zigzag(4, 5), zigzag(6, 5), zigzag(0, u16::MAX)], [0, 1, 2, 2]);
    }
}
