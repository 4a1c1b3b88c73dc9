//! A picture made of marks at places in pixels, written as SVG or painted.
//!
//! What a [`Sheet`] holds is drawn in order: a later mark lies over an earlier one. Both ways of drawing take the
//! same marks, so that a film and a figure of the same moment are the same picture.

mod paint;
mod write;

pub use paint::Pixels;

/// A colour: red, green, blue.
pub type Rgb = [u8; 3];

/// The colour of letters and lines; a page turns it with its own.
pub const INK: Rgb = [0, 0, 0];

/// The colour behind everything; likewise.
pub const PAPER: Rgb = [255, 255, 255];

/// A picture of marks.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height (pixels).
    pub size: (u32, u32),
    /// From the lowest.
    pub layers: Vec<Layer>,
}

/// Marks that may end at the edges of a rectangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    /// Left, top, width and height of what is seen (pixels); everything without.
    pub clip: Option<[f64; 4]>,
    /// From the lowest.
    pub marks: Vec<Mark>,
}

/// Something that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A filled circle.
    Disc {
        /// Its middle (pixels).
        centre: [f64; 2],
        /// (pixels).
        radius: f64,
        /// Of the whole.
        colour: Rgb,
    },
    /// A filled polygon with a border in ink.
    Polygon {
        /// Its corners (pixels).
        corners: Vec<[f64; 2]>,
        /// Inside.
        colour: Rgb,
    },
    /// A filled rectangle.
    Box {
        /// Left, top, width and height (pixels).
        place: [f64; 4],
        /// Inside.
        colour: Rgb,
    },
    /// A line through points.
    Line {
        /// (pixels).
        points: Vec<[f64; 2]>,
        /// Of the whole.
        colour: Rgb,
        /// (pixels).
        width: f64,
        /// Length of dashes and gaps (pixels); 0 for none.
        dash: f64,
    },
    /// A line of letters.
    Text {
        /// Its middle in height, and its start, middle or end in width (pixels).
        place: [f64; 2],
        /// The letters.
        text: String,
        /// Height of letters (pixels).
        size: f64,
        /// What of it stands at the place.
        anchor: Anchor,
        /// Whether it runs upwards.
        upright: bool,
    },
}

/// What of a line of letters stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its first letter.
    Start,
    /// Its middle.
    Middle,
    /// Its last letter.
    End,
}
