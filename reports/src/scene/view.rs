//! From where an impact is seen, and what of it.

use exchange::frames::{Body, Frame, Grain};

use super::{Disc, Impact, Outline, hull};

/// From where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// From the side: a planar bed as it is, one in space cut open through the axis of the impact.
    Side,
    /// From above.
    Above,
}

/// A rectangle: to the right and upward, from and to (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// To the right.
    pub u: [f64; 2],
    /// Upward.
    pub v: [f64; 2],
}

impl Extent {
    /// Width (m).
    pub fn width(&self) -> f64 {
        self.u[1] - self.u[0]
    }

    /// Height (m).
    pub fn height(&self) -> f64 {
        self.v[1] - self.v[0]
    }

    /// Whether a disc reaches into it.
    fn meets(&self, [u, v]: [f64; 2], radius: f64) -> bool {
        let within = |x: f64, [from, to]: [f64; 2]| x > from - radius && x < to + radius;
        within(u, self.u) && within(v, self.v)
    }
}

/// A way to look at an impact.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// From where.
    pub look: Look,
    /// Around the impact.
    pub near: Extent,
    /// The whole bed.
    pub whole: Extent,
    /// Of a bed in space from the side: where it is cut, and how much behind the cut is shown (m).
    pub slice: Option<[f64; 2]>,
    /// Columns of a grid from above are as wide (m).
    column: f64,
}

/// A slice shows so many mean grain diameters behind the cut.
const SLICE: f64 = 1.5;

/// Columns across a mean grain.
const COLUMNS: f64 = 3.0;

impl View {
    /// Of `impact`, with a slice of `thickness` (m), else of one and a half mean diameters.
    pub fn of(impact: &Impact, look: Look, thickness: Option<f64>) -> Self {
        let [x, y, z] = impact.extent;
        let path = |axis: usize| impact.reach(axis);
        let body = impact.body_size;
        let depth = (-path(2)[0]).max(body);
        let around = |[low, high]: [f64; 2], bed: [f64; 2]| {
            let margin = (3.0 * body).max(1.1 * depth);
            [(low - margin).max(bed[0]), (high + margin).min(bed[1])]
        };
        // Room for the arrow over a body that has just begun to sink.
        let top = (0.4 * depth).max(1.6 * body).max(0.6 * body + impact.top);
        let (near, whole) = match look {
            Look::Side => {
                let low = (-depth - body.max(0.5 * depth)).max(z[0]);
                let near = Extent { u: around(path(0), x), v: [low, top] };
                (near, Extent { u: x, v: [z[0], top] })
            }
            Look::Above => {
                let near = Extent { u: around(path(0), x), v: around(path(1), y) };
                (near, Extent { u: x, v: y })
            }
        };
        let in_space = look == Look::Side && !impact.planar;
        let thickness = thickness.unwrap_or(SLICE * impact.mean_diameter);
        Self {
            look,
            near,
            whole,
            slice: in_space.then(|| [impact.axis[1], thickness]),
            column: impact.mean_diameter / COLUMNS,
        }
    }

    /// A place of the log as this view has it: to the right, upward, and near.
    pub fn place(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.look {
            Look::Side => [x, z, -y],
            Look::Above => [x, y, z],
        }
    }

    /// The grains of `frame` that are seen within `extent`, the nearest last.
    pub(super) fn discs(&self, frame: &Frame, extent: &Extent, impact: &Impact) -> Vec<Disc> {
        let seen = match self.look {
            Look::Side => None,
            Look::Above => Some(self.uncovered(&frame.grains)),
        };
        let grains =
            frame.grains.iter().enumerate().filter(|(at, grain)| match (&seen, self.slice) {
                (Some(seen), _) => seen[*at],
                (None, Some([cut, thickness])) => {
                    let behind = f64::from(grain.position[1]) - cut;
                    // Half of it before the cut, so that the plane of the cut itself is full.
                    behind.abs() <= 0.5 * thickness
                }
                (None, None) => true,
            });
        let mut discs: Vec<Disc> = grains
            .map(|(_, grain)| self.disc(grain, impact))
            .filter(|disc| extent.meets([disc.place[0], disc.place[1]], disc.radius))
            .collect();
        if self.look == Look::Above || self.slice.is_some() {
            discs.sort_by(|a, b| a.place[2].total_cmp(&b.place[2]).then(a.id.cmp(&b.id)));
        }
        discs
    }

    fn disc(&self, grain: &Grain, impact: &Impact) -> Disc {
        let position = grain.position.map(f64::from);
        let moved = impact.displacement(grain);
        Disc {
            id: grain.id,
            place: self.place(position),
            radius: f64::from(grain.radius),
            values: [f64::from(grain.speed), f64::from(grain.force), moved],
        }
    }

    /// Which grains are seen from above: those that are the highest of a column.
    fn uncovered(&self, grains: &[Grain]) -> Vec<bool> {
        let Extent { u, v } = self.whole;
        let n = [u, v].map(|[low, high]| ((high - low) / self.column).ceil().max(1.0) as usize);
        let mut highest: Vec<Option<(f32, usize)>> = vec![None; n[0] * n[1]];
        for (at, grain) in grains.iter().enumerate() {
            let reach = f64::from(grain.radius);
            let span = |x: f32, low: f64, n: usize| {
                let place = |x: f64| ((x - low) / self.column - 0.5).ceil().max(0.0) as usize;
                place(f64::from(x) - reach).min(n)..place(f64::from(x) + reach).min(n)
            };
            let [x, y, z] = grain.position;
            for row in span(y, v[0], n[1]) {
                for column in span(x, u[0], n[0]) {
                    let cell = &mut highest[row * n[0] + column];
                    if cell.is_none_or(|(height, _)| z + grain.radius > height) {
                        *cell = Some((z + grain.radius, at));
                    }
                }
            }
        }
        let mut seen = vec![false; grains.len()];
        highest.into_iter().flatten().for_each(|(_, at)| seen[at] = true);
        seen
    }

    /// What is seen of a body. A bed that is cut open is cut through its bodies too: they lie over all grains.
    pub(super) fn outline(&self, body: &Body) -> Outline {
        let places: Vec<[f64; 3]> =
            body.surface.corners.iter().map(|corner| self.place(*corner)).collect();
        let near = match self.look {
            Look::Side => f64::INFINITY,
            Look::Above => places.iter().fold(f64::NEG_INFINITY, |near, place| near.max(place[2])),
        };
        Outline { corners: hull(places.iter().map(|[u, v, _]| [*u, *v]).collect()), near }
    }
}
