//! A scene as a picture with axes, a bar of colours, and what is known of the time.

use plots::sheet::{Anchor, INK, Layer, Mark, PAPER, Sheet};

use super::forces::norm;
use super::{Impact, Look, Quantity, Scene, View, ramp};

/// Room to the left of a picture for its axis, to the right for the bar, above and below (pixels).
const LEFT: f64 = 58.0;
const RIGHT: f64 = 78.0;
const ABOVE: f64 = 44.0;
const BELOW: f64 = 44.0;

/// Height of letters (pixels).
const LETTERS: f64 = 12.0;

/// Grains are drawn a little smaller than they are, so that neighbours of one colour stay apart.
const DRAWN: f64 = 0.94;

/// Colours of bodies, their paths, and the lines of axes.
pub(crate) const BODY: [u8; 3] = [94, 107, 122];
pub(crate) const PATH: [u8; 3] = [0, 114, 178];
pub(crate) const LINES: [u8; 3] = [120, 128, 136];

/// The longest arrow in parts of the height of a picture.
const ARROW: f64 = 0.22;

/// The picture of `scene`, `width` pixels wide, its height so that lengths are the same in both directions; or of
/// the `size` given, which the bed then fills as far as it can.
pub fn sheet(
    (impact, view): (&Impact, &View),
    scene: &Scene,
    quantity: Quantity,
    size: (u32, u32),
) -> Sheet {
    let frame = Axes::new(scene, size);
    let mut layers = vec![
        Layer { clip: Some(frame.place), marks: frame.content(impact, view, scene, quantity) },
        Layer { clip: None, marks: frame.axes(impact, view) },
        Layer { clip: None, marks: frame.bar(quantity, impact.tops[quantity.index()]) },
    ];
    layers.push(Layer { clip: None, marks: frame.title(impact, scene) });
    Sheet { size, layers }
}

/// The height (pixels) of a picture of this `width` that `scene` fills.
pub fn height_for(window: &super::Extent, width: u32) -> u32 {
    let inner = f64::from(width) - LEFT - RIGHT;
    (inner * window.height() / window.width() + ABOVE + BELOW).round().max(1.0) as u32
}

/// Where things stand.
struct Axes {
    size: (f64, f64),
    /// Left, top, width, height of the window (pixels).
    place: [f64; 4],
    /// Pixels per metre.
    scale: f64,
    /// Of the window (m).
    left: f64,
    top: f64,
    u: [f64; 2],
    v: [f64; 2],
}

impl Axes {
    fn new(scene: &Scene, (width, height): (u32, u32)) -> Self {
        let size = (f64::from(width), f64::from(height));
        let room = [size.0 - LEFT - RIGHT, size.1 - ABOVE - BELOW].map(|side| side.max(1.0));
        let window = scene.window;
        let scale = (room[0] / window.width()).min(room[1] / window.height());
        let [w, h] = [scale * window.width(), scale * window.height()];
        let place = [LEFT + 0.5 * (room[0] - w), ABOVE + 0.5 * (room[1] - h), w, h];
        Self { size, place, scale, left: window.u[0], top: window.v[1], u: window.u, v: window.v }
    }

    fn at(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.place[0] + self.scale * (u - self.left), self.place[1] + self.scale * (self.top - v)]
    }

    fn content(
        &self,
        impact: &Impact,
        view: &View,
        scene: &Scene,
        quantity: Quantity,
    ) -> Vec<Mark> {
        let top = impact.tops[quantity.index()];
        // Where grains lie over each other, a darker rim tells them apart.
        let rims = view.look == Look::Above || view.slice.is_some();
        let disc = |disc: &super::Disc| {
            let centre = self.at([disc.place[0], disc.place[1]]);
            let colour = ramp(disc.values[quantity.index()], top);
            let radius = self.scale * disc.radius;
            let rim = Mark::Disc { centre, radius, colour: colour.map(rim) };
            let drawn = if rims { radius - 1.0_f64.min(0.15 * radius) } else { DRAWN * radius };
            rims.then_some(rim).into_iter().chain([Mark::Disc { centre, radius: drawn, colour }])
        };
        let mut marks = Vec::new();
        let mut bodies: Vec<_> = scene.bodies.iter().collect();
        bodies.sort_by(|a, b| a.near.total_cmp(&b.near));
        let mut discs = &scene.discs[..];
        for body in bodies {
            let below = match view.look {
                Look::Side => discs.len(),
                Look::Above => discs.partition_point(|disc| disc.place[2] < body.near),
            };
            marks.extend(discs[..below].iter().flat_map(disc));
            discs = &discs[below..];
            let corners = body.corners.iter().map(|corner| self.at(*corner)).collect();
            marks.push(Mark::Polygon { corners, colour: BODY });
        }
        marks.extend(discs.iter().flat_map(disc));
        if view.look == Look::Side {
            let points = self.u.map(|u| self.at([u, 0.0])).to_vec();
            marks.push(Mark::Line { points, colour: INK, width: 1.0, dash: 5.0 });
        }
        for path in &scene.paths {
            let points = path.iter().map(|place| self.at(*place)).collect();
            marks.push(Mark::Line { points, colour: PATH, width: 2.5, dash: 0.0 });
        }
        let longest = ARROW * self.place[3];
        for force in &scene.forces {
            marks.extend(self.arrow(force, longest / impact.forces.top().max(f64::MIN_POSITIVE)));
        }
        marks
    }

    /// An arrow of so many pixels per newton, with a light edge against grains of any colour.
    fn arrow(&self, force: &super::Force, per_newton: f64) -> Vec<Mark> {
        let from = self.at(force.at);
        let [fx, fy] = [per_newton * force.newton[0], -per_newton * force.newton[1]];
        let length = (fx * fx + fy * fy).sqrt();
        if length < 3.0 {
            return Vec::new();
        }
        let to = [from[0] + fx, from[1] + fy];
        let head = 9.0_f64.min(0.6 * length);
        let [ex, ey] = [fx / length, fy / length];
        let neck = [to[0] - head * ex, to[1] - head * ey];
        let half = 0.45 * head;
        let corners = vec![
            to,
            [neck[0] - half * ey, neck[1] + half * ex],
            [neck[0] + half * ey, neck[1] - half * ex],
        ];
        let shaft =
            |colour, width| Mark::Line { points: vec![from, neck], colour, width, dash: 0.0 };
        vec![shaft(PAPER, 5.0), shaft(INK, 2.5), Mark::Polygon { corners, colour: INK }]
    }

    fn axes(&self, impact: &Impact, view: &View) -> Vec<Mark> {
        let [x, y, w, h] = self.place;
        let (right, bottom) = (x + w, y + h);
        let border = vec![[x, y], [right, y], [right, bottom], [x, bottom], [x, y]];
        let mut marks = vec![line(border, LINES)];
        let middle = impact.axis[0];
        let across = |u: f64| 1e3 * (u - middle);
        for tick in ticks(across(self.u[0]), across(self.u[1]), w / 60.0) {
            let [at, _] = self.at([middle + 1e-3 * tick, 0.0]);
            marks.push(line(vec![[at, bottom], [at, bottom + 4.0]], LINES));
            marks.push(text([at, bottom + 13.0], number(tick), Anchor::Middle));
        }
        // Depth goes down; seen from above, the vertical axis is the second horizontal one.
        let (sign, zero, name) = match view.look {
            Look::Side => (-1.0, 0.0, "depth (mm)"),
            Look::Above => (1.0, impact.axis[1], "y from the axis (mm)"),
        };
        let values = self.v.map(|v| sign * 1e3 * (v - zero));
        let (low, high) = (values[0].min(values[1]), values[0].max(values[1]));
        for tick in ticks(low, high, h / 40.0) {
            let [_, at] = self.at([0.0, zero + 1e-3 * sign * tick]);
            marks.push(line(vec![[x - 4.0, at], [x, at]], LINES));
            marks.push(text([x - 7.0, at], number(tick), Anchor::End));
        }
        let along = [0.5 * (x + right), bottom + 31.0];
        marks.push(text(along, "x from the axis of the impact (mm)".to_owned(), Anchor::Middle));
        marks.push(Mark::Text {
            place: [x - 46.0, 0.5 * (y + bottom)],
            text: name.to_owned(),
            size: LETTERS,
            anchor: Anchor::Middle,
            upright: true,
        });
        marks
    }

    fn bar(&self, quantity: Quantity, top: f64) -> Vec<Mark> {
        const PARTS: usize = 32;
        let [x, y, w, h] = self.place;
        let (left, height) = (x + w + 12.0, h.min(220.0));
        let step = height / PARTS as f64;
        let share = |part: f64| (part / PARTS as f64).powi(2);
        let mut marks: Vec<Mark> = (0..PARTS)
            .map(|part| Mark::Box {
                place: [left, y + height - step * (part as f64 + 1.0), 12.0, step + 0.5],
                colour: ramp(share(part as f64 + 0.5) * top, top),
            })
            .collect();
        let most = quantity.factor() * top;
        for (value, place) in marks_of_a_bar(most) {
            let place = [left + 16.0, y + height * (1.0 - place)];
            marks.push(text(place, plots::short(value), Anchor::Start));
        }
        let name = format!("{} ({})", quantity.name(), quantity.unit());
        marks.push(text([self.size.0 - 4.0, y - 14.0], name, Anchor::End));
        marks
    }

    fn title(&self, impact: &Impact, scene: &Scene) -> Vec<Mark> {
        let mut words = format!("{:.1} ms after contact", 1e3 * scene.time);
        if !impact.forces.bodies.is_empty() {
            let sum = scene.forces.iter().fold([0.0; 3], |sum, force| {
                [sum[0] + force.newton[0], sum[1] + force.newton[1], 0.0]
            });
            words.push_str(&format!("; force {}", crate::numbers::with_prefix(norm(sum), "N")));
        }
        vec![Mark::Text {
            place: [self.place[0], 16.0],
            text: words,
            size: 1.15 * LETTERS,
            anchor: Anchor::Start,
            upright: false,
        }]
    }
}

/// A channel of the colour of a rim.
fn rim(channel: u8) -> u8 {
    (0.7 * f64::from(channel)) as u8
}

fn line(points: Vec<[f64; 2]>, colour: [u8; 3]) -> Mark {
    Mark::Line { points, colour, width: 1.0, dash: 0.0 }
}

fn text(place: [f64; 2], text: String, anchor: Anchor) -> Mark {
    Mark::Text { place, text, size: LETTERS, anchor, upright: false }
}

/// Round numbers between `low` and `high`, at most about `n` of them.
pub(crate) fn ticks(low: f64, high: f64, n: f64) -> Vec<f64> {
    let least = (high - low) / n.max(1.0);
    if !(least > 0.0 && least.is_finite()) {
        return Vec::new();
    }
    let power = libm::pow(10.0, libm::log10(least).floor());
    let step = [1.0, 2.0, 5.0].into_iter().map(|digit| digit * power).find(|step| *step >= least);
    let step = step.unwrap_or(10.0 * power);
    let (from, to) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (from..=to).map(|at| at as f64 * step).collect()
}

fn number(value: f64) -> String {
    plots::short(value)
}

/// Numbers of a bar up to `most` and their places in it, which go by the root: `most` itself and round ones.
fn marks_of_a_bar(most: f64) -> Vec<(f64, f64)> {
    let digits = |value: f64, text: String| text.parse().unwrap_or(value);
    let round = |part: f64| {
        let value = most * part * part;
        let value: f64 = digits(value, format!("{value:.0e}"));
        (value, if most > 0.0 { (value / most).sqrt() } else { part })
    };
    let top = digits(most, format!("{most:.1e}"));
    [0.0, 0.25, 0.5, 0.75].map(round).into_iter().chain([(top, 1.0)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_a_bar_are_round_and_stand_at_their_roots() {
        let marks = marks_of_a_bar(1.17);
        let values: Vec<f64> = marks.iter().map(|mark| mark.0).collect();
        assert_eq!(values, [0.0, 0.07, 0.3, 0.7, 1.2]);
        // A square of a root, but for rounding; the top is written in two digits.
        assert!(marks[..4].iter().all(|(value, at)| (1.17 * at * at - value).abs() < 1e-12));
    }

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(ticks(-12.0, 47.0, 6.0), [-10.0, 0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(ticks(0.0, 1.0, 2.0), [0.0, 0.5, 1.0]);
        assert!(ticks(1.0, 1.0, 5.0).is_empty() && ticks(0.0, f64::INFINITY, 5.0).is_empty());
    }
}
