//! A drawing as an SVG document.

use std::fmt::Write as _;

use super::{Colour, Point};
use crate::report::xml::escaped;

/// Units of the drawing in a pixel. Coordinates are whole units.
const UNITS: f64 = 4.0;
/// Length of a dash and of the gap after it, px.
const DASH: (f64, f64) = (5.0, 4.0);
/// Width of the edge of a text, px.
const EDGE: f64 = 3.0;
/// The margin around a document of its own, and the height of its heading, px.
const MARGIN: f64 = 12.0;
const HEADING: f64 = 38.0;

/// A picture with its texts for people who do not see it.
#[derive(Debug, Clone)]
pub(in crate::report) struct Picture {
    id: String,
    title: String,
    description: String,
    stands_alone: bool,
    /// `true` if texts have an edge in the colour of the page, because lines run under them.
    has_edged_texts: bool,
}

impl Picture {
    /// Creates a picture inside a page. `id` begins its identifiers: the pictures of a page have different ones. The
    /// title has a few words, and the description a sentence or two.
    pub(in crate::report) fn new(id: &str, title: &str, description: &str) -> Self {
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            description: description.to_owned(),
            stands_alone: false,
            has_edged_texts: false,
        }
    }

    /// Makes the picture a document of its own, with a background.
    pub(in crate::report) fn standing_alone(self) -> Self {
        Self { stands_alone: true, ..self }
    }

    /// Gives the texts an edge.
    pub(super) fn with_edged_texts(&self) -> Self {
        Self { has_edged_texts: true, ..self.clone() }
    }

    /// Returns the document of a drawing of this size, px.
    pub(super) fn draw(&self, size: (f64, f64), draw: impl FnOnce(&mut Area)) -> String {
        let edge = format!(
            " paint-order=\"stroke\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
            Colour::Paper.light(),
            units(EDGE)
        );
        let edge = if self.has_edged_texts { edge } else { String::new() };
        let mut area = Area { shapes: String::new(), edge };
        draw(&mut area);
        if self.stands_alone {
            self.document(size, &area.shapes)
        } else {
            format!("{}{}</svg>\n", self.head(size), area.shapes)
        }
    }

    /// Returns the beginning of a document of this size, px.
    fn head(&self, (width, height): (f64, f64)) -> String {
        let Self { id, title, description, .. } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-labelledby=\"{id}-title {id}-desc\" \
             width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\">\n\
             <title id=\"{id}-title\">{}</title>\n<desc id=\"{id}-desc\">{}</desc>\n",
            units(width),
            units(height),
            escaped(title),
            escaped(description),
            id = escaped(id),
        )
    }

    /// Returns a document with a background and its title as a heading.
    fn document(&self, (width, height): (f64, f64), body: &str) -> String {
        let (paper, ink) = (Colour::Paper.light(), Colour::Ink.light());
        let mut svg = self.head((width + 2.0 * MARGIN, height + MARGIN + HEADING));
        let _ = writeln!(
            svg,
            "<rect width=\"100%\" height=\"100%\" fill=\"{paper}\"/>\n\
             <text x=\"{}\" y=\"{}\" font-size=\"{}\" font-weight=\"bold\" fill=\"{ink}\">{}</text>\n\
             <g transform=\"translate({} {})\">\n{body}</g>\n</svg>",
            units(MARGIN),
            units(HEADING - 14.0),
            units(14.0),
            escaped(&self.title),
            units(MARGIN),
            units(HEADING),
        );
        svg
    }
}

/// The shapes of a drawing so far. Places are px to the right and down.
#[derive(Debug)]
pub(super) struct Area {
    shapes: String,
    /// The style of the edge of texts.
    edge: String,
}

impl Area {
    pub(super) fn line(&mut self, points: &[Point], style: &str) {
        self.path("polyline", points, style);
    }

    pub(super) fn polygon(&mut self, points: &[Point], style: &str) {
        self.path("polygon", points, style);
    }

    fn path(&mut self, shape: &str, points: &[Point], style: &str) {
        if points.is_empty() {
            return;
        }
        let _ = write!(self.shapes, "<{shape}{style} points=\"");
        for (index, (x, y)) in points.iter().enumerate() {
            let gap = if index > 0 { " " } else { "" };
            let _ = write!(self.shapes, "{gap}{},{}", units(*x), units(*y));
        }
        self.shapes.push_str("\"/>\n");
    }

    /// Draws a rectangle between two corners.
    pub(super) fn rectangle(&mut self, [one, other]: [Point; 2], style: &str) {
        let (left, top) = (units(one.0.min(other.0)), units(one.1.min(other.1)));
        let (right, bottom) = (units(one.0.max(other.0)), units(one.1.max(other.1)));
        let (width, height) = (right - left, bottom - top);
        let _ = writeln!(
            self.shapes,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"{style}/>"
        );
    }

    /// Draws two lines that cross at a place, each from `-arm` to `arm` across and up.
    pub(super) fn cross(&mut self, (x, y): Point, arm: f64, style: &str) {
        self.line(&[(x - arm, y - arm), (x + arm, y + arm)], style);
        self.line(&[(x - arm, y + arm), (x + arm, y - arm)], style);
    }

    pub(super) fn circle(&mut self, (x, y): Point, radius: f64, style: &str) {
        let (x, y, radius) = (units(x), units(y), units(radius));
        let _ = writeln!(self.shapes, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{style}/>");
    }

    /// Draws a text whose end or middle is at a place.
    pub(super) fn text(&mut self, text: &str, (x, y): Point, style: &str) {
        let (x, y, text) = (units(x), units(y), escaped(text));
        let _ = writeln!(self.shapes, "<text{} x=\"{x}\" y=\"{y}\"{style}>{text}</text>", self.edge);
    }
}

/// Converts px to units of the drawing.
fn units(px: f64) -> i32 {
    (px * UNITS).round() as i32
}

/// Returns the style of a line of this width, px. The lines of the plan are dashed.
pub(super) fn stroke(colour: Colour, width: f64) -> String {
    let (dash, gap) = DASH;
    let dashes = match colour {
        Colour::Plan => format!(" stroke-dasharray=\"{} {}\"", units(dash), units(gap)),
        _ => String::new(),
    };
    format!(" fill=\"none\" stroke=\"{}\"{dashes} stroke-width=\"{}\"", colour.light(), units(width))
}

/// Returns the style of a filled shape.
pub(super) fn filled(colour: Colour, opacity: f64) -> String {
    let opacity = if opacity < 1.0 { format!(" opacity=\"{opacity}\"") } else { String::new() };
    format!("{opacity} fill=\"{}\"", colour.light())
}

/// The part of a text that is at its place, across.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// The height of a place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
pub(super) enum Height {
    #[strum(serialize = "0.5ex")]
    Middle,
    #[strum(serialize = "0.76em")]
    Top,
}

/// Returns the style of a text of this size, px.
pub(super) fn text(size: f64, colour: Colour, anchor: Anchor, height: Height) -> String {
    let (anchor, dy): (&str, &str) = (anchor.into(), height.into());
    let (size, colour) = (units(size), colour.light());
    format!(" dy=\"{dy}\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{colour}\"")
}

/// Returns the estimated width of a text of this size, px.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    /// The mean widths of capital letters and of other characters, as shares of the size.
    const SHARES: (f64, f64) = (0.74, 0.57);
    let share = |c: char| if c.is_uppercase() { SHARES.0 } else { SHARES.1 };
    text.chars().map(share).sum::<f64>() * size
}
