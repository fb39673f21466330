//! A drawing as an SVG document.

use std::fmt::Write as _;
use std::io;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea as _};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontFamily, FontStyle, IntoFont as _, ShapeStyle, TextStyle};

use super::Colour;
use crate::report::xml::escaped;

/// Units of the drawing in a pixel. The library draws in whole units.
const UNITS: f64 = 4.0;
/// The ratio by which the library divides the sizes of fonts.
const FONT_RATIO: f64 = 1.24;
/// Length of a dash and of the gap after it, px.
const DASH: (f64, f64) = (5.0, 4.0);
/// Width of the edge of a text, px.
const EDGE: f64 = 3.0;
/// The margin around a document of its own, and the height of its heading, px.
const MARGIN: f64 = 12.0;
const HEADING: f64 = 38.0;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Failure = DrawingAreaErrorKind<io::Error>;
pub(super) type Drawn = Result<(), Failure>;

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
    pub(super) fn draw(&self, size: (f64, f64), draw: impl FnOnce(&Area<'_>) -> Drawn) -> String {
        let mut drawn = String::new();
        {
            let (width, height) = (units(size.0).unsigned_abs(), units(size.1).unsigned_abs());
            let area = SVGBackend::with_string(&mut drawn, (width, height)).into_drawing_area();
            // Drawing into a string does not fail.
            draw(&area).and_then(|()| area.present()).ok();
        }
        // The head of the library's document ends the first line.
        let body = shortened(drawn.split_once('\n').map_or("", |(_, body)| body));
        let body = if self.has_edged_texts { body.replace("<text ", &edged_text()) } else { body };
        if self.stands_alone { self.document(size, &body) } else { self.head(size) + &body }
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
             <g transform=\"translate({} {})\">",
            units(MARGIN),
            units(HEADING - 14.0),
            units(14.0),
            escaped(&self.title),
            units(MARGIN),
            units(HEADING),
        );
        svg.push_str(body.strip_suffix("</svg>\n").unwrap_or(body));
        svg.push_str("</g>\n</svg>\n");
        svg
    }
}

/// Leaves out what is said already, and dashes the lines of the plan.
fn shortened(body: &str) -> String {
    let (dash, gap) = DASH;
    let plan = format!(" stroke=\"{}\"", Colour::Plan.light());
    let dashed = format!("{plan} stroke-dasharray=\"{} {}\"", units(dash), units(gap));
    body.replace(" opacity=\"1\"", "")
        .replace(" font-family=\"sans-serif\"", "")
        .replace(" text-anchor=\"start\"", "")
        .replace(" \"/>", "\"/>")
        .replace("\n</text>", "</text>")
        .replace(&plan, &dashed)
}

/// Returns the beginning of a text with an edge.
fn edged_text() -> String {
    format!(
        "<text paint-order=\"stroke\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" ",
        Colour::Paper.light(),
        units(EDGE)
    )
}

/// Converts px to units of the drawing.
pub(super) fn units(px: f64) -> i32 {
    (px * UNITS).round() as i32
}

/// Returns the style of a line of this width, px.
pub(super) fn stroke(colour: Colour, width: f64) -> ShapeStyle {
    colour.rgb().stroke_width(units(width).unsigned_abs())
}

/// Returns the style of a filled shape.
pub(super) fn filled(colour: Colour, opacity: f64) -> ShapeStyle {
    colour.rgb().mix(opacity).filled()
}

/// Returns the style of a text of this size, px.
pub(super) fn text(size: f64, colour: Colour, h_pos: HPos, v_pos: VPos) -> TextStyle<'static> {
    let font = (FontFamily::SansSerif, size * UNITS * FONT_RATIO, FontStyle::Normal).into_font();
    let mut style = TextStyle::from(font);
    style.color = colour.rgb().to_backend_color();
    style.pos(Pos::new(h_pos, v_pos))
}

/// Returns the estimated width of a text of this size, px.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    /// The mean widths of capital letters and of other characters, as shares of the size.
    const SHARES: (f64, f64) = (0.74, 0.57);
    let share = |c: char| if c.is_uppercase() { SHARES.0 } else { SHARES.1 };
    text.chars().map(share).sum::<f64>() * size
}
