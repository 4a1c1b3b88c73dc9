//! A sheet as SVG.

use std::fmt::Write as _;

use super::{Anchor, INK, Layer, Mark, PAPER, Rgb, Sheet};

/// Parts of a pixel that places are rounded to: a tenth.
const PARTS: f64 = 10.0;

/// Radii of discs are told apart by this (pixels).
const RADIUS_STEP: f64 = 0.1;

impl Sheet {
    /// The sheet as SVG on white; the same sheet gives the same bytes.
    pub fn svg(&self) -> String {
        let (w, h) = self.size;
        let mut text = format!(
            "<svg width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"{}\"/>\n",
            hex(PAPER)
        );
        self.layers.iter().for_each(|layer| layer.write(&mut text));
        text.push_str("</svg>\n");
        text
    }
}

impl Layer {
    fn write(&self, into: &mut String) {
        // Writing to a string cannot fail.
        if let Some([x, y, w, h]) = self.clip {
            let place = [x, y, w, h].map(round).map(|value| value.to_string());
            let [x, y, w, h] = &place;
            let _ = writeln!(
                into,
                "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\">"
            );
        }
        let mut marks = &self.marks[..];
        while let Some(first) = marks.first() {
            let n = marks.iter().take_while(|mark| matches!(mark, Mark::Disc { .. })).count();
            match n {
                0 => write_mark(first, into),
                n => write_discs(&marks[..n], into),
            }
            marks = &marks[n.max(1)..];
        }
        if self.clip.is_some() {
            into.push_str("</svg>\n");
        }
    }
}

/// Radius in steps, and colour.
type Group = (u32, Rgb);

/// Discs as ends of lines without length, one path for those of the same colour and radius. Where discs overlap,
/// only neighbours in the list share a path, so that their order stays.
fn write_discs(discs: &[Mark], into: &mut String) {
    let mut groups: Vec<(Group, Vec<[i64; 2]>)> = Vec::new();
    let overlap = overlapping(discs);
    let mut sorted: Vec<_> = discs.iter().filter_map(group_of).collect();
    if !overlap {
        sorted.sort_by_key(|(group, _)| *group);
    }
    for (group, place) in sorted {
        match groups.last_mut().filter(|(last, _)| *last == group) {
            Some((_, places)) => places.push(place),
            None => groups.push((group, vec![place])),
        }
    }
    into.push_str("<g fill=\"none\" stroke-linecap=\"round\" transform=\"scale(.1)\">\n");
    for ((steps, colour), places) in groups {
        let width = (2.0 * PARTS * RADIUS_STEP * f64::from(steps)).round();
        let _ = write!(into, "<path stroke=\"{}\" stroke-width=\"{width}\" d=\"", hex(colour));
        let mut at = [0, 0];
        for place in places {
            let [dx, dy] = [place[0] - at[0], place[1] - at[1]];
            let sign = if dy < 0 { "" } else { " " };
            let _ = write!(into, "m{dx}{sign}{dy}h0");
            at = place;
        }
        into.push_str("\"/>\n");
    }
    into.push_str("</g>\n");
}

/// Whether a disc lies over another by more than a contact is deep: by a tenth of the radius.
fn overlapping(discs: &[Mark]) -> bool {
    let mut round: Vec<([f64; 2], f64)> = discs
        .iter()
        .filter_map(|mark| match mark {
            Mark::Disc { centre, radius, .. } => Some((*centre, *radius)),
            _ => None,
        })
        .collect();
    round.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
    let largest = round.iter().fold(0.0_f64, |most, (_, radius)| most.max(*radius));
    round.iter().enumerate().any(|(at, (centre, radius))| {
        let near =
            round[at + 1..].iter().take_while(|(other, _)| other[0] - centre[0] < 2.0 * largest);
        near.into_iter().any(|(other, r)| {
            let [dx, dy] = [other[0] - centre[0], other[1] - centre[1]];
            let reach = radius + r - 0.1 * radius.min(*r);
            dx * dx + dy * dy < reach * reach
        })
    })
}

/// Colour, radius and place of a disc, in the steps of a file.
fn group_of(mark: &Mark) -> Option<(Group, [i64; 2])> {
    let Mark::Disc { centre, radius, colour } = mark else { return None };
    let steps = (radius / RADIUS_STEP).round().max(1.0) as u32;
    Some(((steps, *colour), centre.map(|value| (PARTS * value).round() as i64)))
}

fn write_mark(mark: &Mark, into: &mut String) {
    // Writing to a string cannot fail.
    let _ = match mark {
        Mark::Disc { .. } => Ok(()),
        Mark::Polygon { corners, colour } => writeln!(
            into,
            "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\"/>",
            points(corners),
            hex(*colour),
            hex(INK)
        ),
        Mark::Box { place, colour } => {
            let [x, y, w, h] = place.map(round);
            writeln!(
                into,
                "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{}\"/>",
                hex(*colour)
            )
        }
        Mark::Line { points: through, colour, width, dash } => {
            let dashes = match *dash > 0.0 {
                true => format!(" stroke-dasharray=\"{dash} {dash}\""),
                false => String::new(),
            };
            writeln!(
                into,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"{dashes}/>",
                points(through),
                hex(*colour)
            )
        }
        Mark::Text { place: [x, y], text, size, anchor, upright } => {
            let (x, y) = (round(*x), round(*y));
            let turn = match upright {
                true => format!(" transform=\"rotate(-90 {x} {y})\""),
                false => String::new(),
            };
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            writeln!(
                into,
                "<text x=\"{x}\" y=\"{y}\" dy=\".35em\" font-family=\"sans-serif\" font-size=\"{size}\" \
                 fill=\"{}\" text-anchor=\"{anchor}\"{turn}>{}</text>",
                hex(INK),
                crate::canvas::escaped(text)
            )
        }
    };
}

fn points(points: &[[f64; 2]]) -> String {
    let pairs = points.iter().map(|[x, y]| format!("{},{}", round(*x), round(*y)));
    pairs.collect::<Vec<_>>().join(" ")
}

fn round(value: f64) -> f64 {
    (PARTS * value).round() / PARTS
}

fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: f64, y: f64, colour: Rgb) -> Mark {
        Mark::Disc { centre: [x, y], radius: 5.0, colour }
    }

    fn sheet(marks: Vec<Mark>) -> String {
        let clip = Some([10.0, 10.0, 80.0, 80.0]);
        Sheet { size: (100, 100), layers: vec![Layer { clip, marks }] }.svg()
    }

    #[test]
    fn discs_that_touch_share_a_path_per_colour() {
        let red = [200, 0, 0];
        let svg = sheet(vec![disc(20.0, 20.0, red), disc(30.0, 20.0, INK), disc(40.0, 20.0, red)]);
        assert_eq!(svg.matches("<path").count(), 2, "{svg}");
        assert!(svg.contains("m200 200h0m200 0h0"), "{svg}");
        assert!(svg.contains("stroke-width=\"100\""), "a diameter of 10 in tenths: {svg}");
    }

    #[test]
    fn discs_that_cover_each_other_keep_their_order() {
        let (low, high) = ([1, 1, 1], [2, 2, 2]);
        let svg = sheet(vec![disc(20.0, 20.0, low), disc(24.0, 20.0, high), disc(28.0, 20.0, low)]);
        let at = |colour: Rgb| svg.find(&hex(colour)).expect("drawn");
        assert!(at(low) < at(high) && svg.matches("<path").count() == 3, "{svg}");
    }

    #[test]
    fn letters_of_a_file_cannot_become_tags() {
        let text = Mark::Text {
            place: [1.0, 2.0],
            text: "<a> & b".to_owned(),
            size: 12.0,
            anchor: Anchor::Start,
            upright: true,
        };
        let svg = sheet(vec![text]);
        assert!(svg.contains("&lt;a&gt; &amp; b") && svg.contains("rotate(-90 1 2)"), "{svg}");
    }
}
